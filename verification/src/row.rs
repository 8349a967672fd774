//! A computed quantity beside its reference.

use crate::Convergence;
use crate::convergence::Sample;
use serde::Serialize;

/// One quantity of a problem. `reference` and `computed` have the unit that `quantity` names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Name of the problem.
    pub name: &'static str,
    /// The quantity, with its unit.
    pub quantity: String,
    /// Reference value.
    pub reference: f64,
    /// Computed value.
    pub computed: f64,
    /// |computed - reference| over a scale of the quantity (dimensionless).
    pub error: f64,
    /// Largest error that passes (dimensionless).
    pub limit: f64,
    /// Whether it passes.
    pub pass: bool,
    /// Where the reference comes from.
    pub source: String,
    /// Where the limit comes from.
    pub limit_from: String,
    /// The same quantity on each mesh, coarse to fine; empty where there is no mesh study.
    pub meshes: Vec<Sample>,
    /// Observed order of convergence, if three meshes show one.
    pub order: Option<f64>,
    /// The fields from which the quantity was computed, coarse to fine, for a figure; empty for most quantities.
    #[serde(skip)]
    pub fields: Vec<Field>,
}

/// Values at the points of a rectangular grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Label of the mesh or method.
    pub name: String,
    /// Mesh size (m).
    pub size: f64,
    /// Grid lines along x (m).
    pub x: Vec<f64>,
    /// Grid lines along y (m).
    pub y: Vec<f64>,
    /// The values, x fastest; infinite or NaN where there is none.
    pub values: Vec<f64>,
}

impl Field {
    /// The value at a point (m) inside the grid, bilinear in its cell.
    ///
    /// # Panics
    /// If the grid has fewer than two lines along an axis, or fewer values than points.
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let place = |line: &[f64], x: f64| {
            let last = line.len().saturating_sub(2);
            let cell = line.partition_point(|p| *p <= x).saturating_sub(1).min(last);
            (cell, (x - line[cell]) / (line[cell + 1] - line[cell]))
        };
        let ((i, a), (j, b)) = (place(&self.x, x), place(&self.y, y));
        let value = |i: usize, j: usize| self.values[i + self.x.len() * j];
        // a weight of zero must hide an infinite value
        let mix = |low: f64, high: f64, share: f64| match share {
            0.0 => low,
            1.0 => high,
            _ => (1.0 - share) * low + share * high,
        };
        let line = |j: usize| mix(value(i, j), value(i + 1, j), a);
        mix(line(j), line(j + 1), b)
    }
}

impl Row {
    /// A quantity whose error is |computed - reference| over `scale`, in the unit of the quantity, with a limit on that
    /// error and where the limit comes from. An error that is not a number does not pass.
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
            // false for NaN
            pass: error <= limit,
            source: source.into(),
            limit_from: limit_from.into(),
            meshes: Vec::new(),
            order: None,
            fields: Vec::new(),
        }
    }

    /// A quantity on the finest of several meshes, with the error relative to `reference`, which must not be zero. The
    /// limit is the uncertainty that the meshes show, relative to the reference, plus that of the
    /// `model`: by how much the computed problem differs from the model of the reference, as a share, and why.
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

    /// A quantity extrapolated to a mesh size of zero; arguments and limit as of [`Row::converged`].
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

    /// The same row with the limit reduced to `required` where it is larger.
    pub(crate) fn at_most(self, required: f64) -> Self {
        if self.limit <= required {
            return self;
        }
        let limit_from = format!("asked: {required:e}, less than by {}", self.limit_from);
        Self { limit: required, pass: self.error <= required, limit_from, ..self }
    }

    /// A quantity with a prescribed limit on its error relative to the reference; `values` are reference and computed
    /// value.
    pub fn asked(quantity: impl Into<String>, values: [f64; 2], limit: f64, source: &str) -> Self {
        Self::new(quantity, values, values[0], (limit, "asked of this problem"), source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_bilinear_between_its_points_and_hides_what_has_no_weight() {
        let (x, y) = (vec![0.0, 1.0, 3.0], vec![0.0, 2.0]);
        let values = y.iter().flat_map(|y| x.iter().map(move |x| 1.0 + x + 10.0 * y + x * y));
        let mut field = Field {
            name: String::new(),
            size: 1.0,
            values: values.collect(),
            x: x.clone(),
            y: y.clone(),
        };
        for [a, b] in [[0.0, 0.0], [0.5, 0.5], [2.5, 1.7], [3.0, 2.0]] {
            assert!((field.at([a, b]) - (1.0 + a + 10.0 * b + a * b)).abs() < 1e-12);
        }
        field.values[2] = f64::INFINITY;
        assert_eq!(field.at([1.0, 0.0]), 2.0);
        assert_eq!(field.at([1.5, 0.0]), f64::INFINITY);
        assert!(field.at([3.0, 2.0]).is_finite());
    }
}
