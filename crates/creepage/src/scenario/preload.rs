//! How a preload was found, or why none was.

pub mod error;

use dynamics::RelaxationReport;
use output::summary;
use serde::{Deserialize, Serialize};
use statics::Ending;

pub use error::PreloadError;

/// How the preload was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum PreloadReport {
    /// By Newton's method.
    Static {
        /// Newton's iterations.
        iterations: usize,
        /// Conjugate-gradient iterations in all.
        cg_iterations: usize,
        /// Sum of the contact's normal forces (N).
        normal_force: f64,
        /// Contact points that are closed.
        closed_pairs: usize,
        /// Residual force over the load at the end (dimensionless).
        residual: f64,
        /// The same once normals that had to be held follow the facets again; zero where none were held.
        facets: f64,
        /// Whether the residual stopped falling at round-off, above the tolerance.
        round_off: bool,
        /// Displacement of the hub in z (m).
        hub: f64,
    },
    /// By dynamic relaxation.
    Relaxation {
        /// Iterations.
        iterations: usize,
        /// Sum of the contact's normal forces (N).
        normal_force: f64,
        /// Fictitious kinetic energy over internal energy at the end (dimensionless).
        kinetic_ratio: f64,
        /// Displacement of the hub in z (m).
        hub: f64,
    },
}

impl PreloadReport {
    /// With the normal force on all of the parts alike that the bodies are made of, and the displacement of the `hub` (m).
    pub(crate) fn of_statics(report: &statics::NewtonReport, multiplicity: f64, hub: f64) -> Self {
        Self::Static {
            iterations: report.last.iteration,
            cg_iterations: report.cg_iterations,
            normal_force: multiplicity * report.last.normal_force,
            closed_pairs: report.last.closed,
            residual: report.last.residual,
            facets: report.facets,
            round_off: report.ending == Ending::RoundOff,
            hub,
        }
    }

    pub(crate) fn of_relaxation(report: &RelaxationReport) -> Self {
        Self::Relaxation {
            iterations: report.iterations,
            normal_force: report.normal_force,
            kinetic_ratio: report.kinetic_ratio,
            hub: report.hub,
        }
    }

    /// Displacement of the hub in z (m).
    pub fn hub(&self) -> f64 {
        match self {
            Self::Static { hub, .. } | Self::Relaxation { hub, .. } => *hub,
        }
    }

    /// The line of the log.
    pub fn line(&self) -> String {
        let found =
            |normal: f64, hub: f64| format!("normal force {normal:.3} N, hub {:.3} um", hub * 1e6);
        match self {
            Self::Static {
                iterations,
                cg_iterations,
                normal_force,
                closed_pairs,
                residual,
                round_off,
                hub,
                ..
            } => format!(
                "preload: static, {iterations} Newton iterations with {cg_iterations} of conjugate \
                 gradients, {}, {closed_pairs} pairs closed, residual {residual:.1e} of the load{}",
                found(*normal_force, *hub),
                if *round_off { ", which is round-off" } else { "" }
            ),
            Self::Relaxation { iterations, normal_force, kinetic_ratio, hub } => format!(
                "preload: relaxation, {iterations} iterations, {}, kinetic/internal \
                 {kinetic_ratio:.1e}",
                found(*normal_force, *hub),
            ),
        }
    }

    /// As the summary has it.
    pub fn result(&self) -> summary::Preload {
        match *self {
            Self::Static {
                iterations,
                cg_iterations,
                normal_force,
                closed_pairs,
                residual,
                facets,
                hub,
                ..
            } => summary::Preload {
                method: "static".into(),
                iterations: iterations as u64,
                cg_iterations: Some(cg_iterations as u64),
                normal_force,
                closed_pairs: Some(closed_pairs as u64),
                residual: Some(residual),
                facet_residual: Some(facets),
                kinetic_ratio: None,
                hub_displacement: hub,
            },
            Self::Relaxation { iterations, normal_force, kinetic_ratio, hub } => summary::Preload {
                method: "relaxation".into(),
                iterations: iterations as u64,
                normal_force,
                kinetic_ratio: Some(kinetic_ratio),
                hub_displacement: hub,
                ..summary::Preload::default()
            },
        }
    }
}
