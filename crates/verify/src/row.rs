//! A computed quantity beside its reference.

use crate::Convergence;
use crate::convergence::Sample;
use serde::Serialize;

/// One quantity of a problem.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Name of the problem.
    pub name: &'static str,
    /// The quantity, with its unit.
    pub quantity: String,
    /// What it should be.
    pub reference: f64,
    /// What it is.
    pub computed: f64,
    /// |computed - reference|, over the scale of the quantity.
    pub error: f64,
    /// Largest error that passes.
    pub limit: f64,
    /// Whether it passes.
    pub pass: bool,
    /// Where the reference comes from.
    pub source: String,
    /// Where the limit comes from.
    pub limit_from: String,
    /// The same quantity on each mesh, coarse to fine; empty for one mesh.
    pub meshes: Vec<Sample>,
    /// Observed order of convergence, if three meshes show one.
    pub order: Option<f64>,
}

impl Row {
    /// A quantity whose error is measured against `scale`, with a limit that does not come from a
    /// mesh study.
    pub fn new(
        quantity: impl Into<String>,
        [reference, computed]: [f64; 2],
        scale: f64,
        (limit, limit_from): (f64, &str),
        source: &str,
    ) -> Self {
        let error = (computed - reference).abs() / scale.abs();
        Self {
            name: "",
            quantity: quantity.into(),
            reference,
            computed,
            error,
            limit,
            // an error that is not a number fails
            pass: error <= limit,
            source: source.into(),
            limit_from: limit_from.into(),
            meshes: Vec::new(),
            order: None,
        }
    }

    /// A quantity on the finest of several meshes; the limit is the uncertainty that they show,
    /// relative to the reference, plus `model`, the share that the reference's own model may
    /// differ, which a measurement of its own must have shown.
    pub fn converged(
        quantity: impl Into<String>,
        reference: f64,
        convergence: &Convergence,
        model: (f64, &str),
        source: &str,
    ) -> Self {
        let computed = convergence.finest();
        Self::with_meshes(quantity.into(), [reference, computed], convergence, model, source)
    }

    /// A quantity extrapolated to a mesh size of zero; the limit is that of [`Row::converged`].
    pub fn extrapolated(
        quantity: &str,
        reference: f64,
        convergence: &Convergence,
        model: (f64, &str),
        source: &str,
    ) -> Self {
        let quantity = format!("{quantity}, extrapolated to h = 0");
        let computed = convergence.extrapolated();
        Self::with_meshes(quantity, [reference, computed], convergence, model, source)
    }

    fn with_meshes(
        quantity: String,
        values: [f64; 2],
        convergence: &Convergence,
        (model, model_from): (f64, &str),
        source: &str,
    ) -> Self {
        let reference = values[0];
        let uncertainty = convergence.uncertainty() / reference.abs();
        let mut from = convergence.explain();
        if model > 0.0 {
            from += &format!("; and {:.2} % for {model_from}", 100.0 * model);
        }
        let limit = (uncertainty + model, from.as_str());
        let row = Self::new(quantity, values, reference, limit, source);
        Self { meshes: convergence.samples().to_vec(), order: convergence.order(), ..row }
    }

    /// A quantity with the largest error that the specification of this program asks for.
    pub fn asked(quantity: impl Into<String>, values: [f64; 2], limit: f64, source: &str) -> Self {
        Self::new(quantity, values, values[0], (limit, "asked of this problem"), source)
    }
}
