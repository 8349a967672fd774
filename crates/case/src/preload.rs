//! The state before rolling: equilibrium under the load, by whichever method the case asks for.

use crate::hertz::hertz;
use crate::model::{DISK, Model};
use crate::progress::{Progress, Stage};
use crate::run_error::RunError;
use crate::schema::{self, Case, PreloadMethod};
use contact::PenaltyContact;
use dynamics::{Hub, Relaxation, RelaxationError, RelaxationReport};
use mesh::Padded;
use serde_json::json;
use solid::Solid;
use statics::{Axis, Ending, Enforcement, Problem, Spin, StaticsError, Supports, Tied};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// How the preload was found.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Report {
    /// By Newton's method, with the displacement of the hub in z (m).
    Static(statics::Report, f64),
    /// By dynamic relaxation.
    Relaxation(RelaxationReport),
}

impl Report {
    /// Displacement of the hub in z (m).
    pub(crate) fn hub(&self) -> f64 {
        match self {
            Self::Static(_, hub) => *hub,
            Self::Relaxation(report) => report.hub,
        }
    }

    /// The line of the log.
    pub(crate) fn line(&self) -> String {
        let found =
            |normal: f64, hub: f64| format!("normal force {normal:.3} N, hub {:.3} um", hub * 1e6);
        match self {
            Self::Static(r, hub) => format!(
                "preload: static, {} Newton iterations with {} of conjugate gradients, {}, {} pairs \
                 closed, residual {:.1e} of the load{}",
                r.last.iteration,
                r.cg_iterations,
                found(r.last.normal_force, *hub),
                r.last.closed,
                r.last.residual,
                match r.ending {
                    Ending::Tolerance => "",
                    Ending::RoundOff => ", which is round-off",
                }
            ),
            Self::Relaxation(r) => format!(
                "preload: relaxation, {} iterations, {}, kinetic/internal {:.1e}",
                r.iterations,
                found(r.normal_force, r.hub),
                r.kinetic_ratio
            ),
        }
    }

    /// The section of the summary.
    pub(crate) fn json(&self) -> serde_json::Value {
        match self {
            Self::Static(r, hub) => json!({
                "method": "static", "iterations": r.last.iteration,
                "cg_iterations": r.cg_iterations, "normal_force": r.last.normal_force,
                "closed_pairs": r.last.closed, "residual": r.last.residual, "facet_residual": r.facets,
                "hub_displacement": hub
            }),
            Self::Relaxation(r) => json!({
                "method": "relaxation", "iterations": r.iterations,
                "normal_force": r.normal_force, "kinetic_ratio": r.kinetic_ratio,
                "hub_displacement": r.hub
            }),
        }
    }
}

/// Why no preload was found.
#[derive(Debug, thiserror::Error)]
pub enum PreloadError {
    /// By Newton's method.
    #[error("static preload: {0}")]
    Static(#[from] StaticsError),
    /// By dynamic relaxation.
    #[error(transparent)]
    Relaxation(#[from] RelaxationError),
}

impl PreloadError {
    /// Whether it was asked to stop.
    pub fn is_interruption(&self) -> bool {
        matches!(
            self,
            Self::Static(StaticsError::Interrupted)
                | Self::Relaxation(RelaxationError::Interrupted)
        )
    }

    /// What to do about it.
    pub(crate) fn remedy(&self) -> &'static str {
        const MESH: &str = "look at the quality of the mesh with `creepage mesh`; lower \
                            contact.penalty.normal, or mesh.growth";
        const INTERRUPTED: &str = "the disk had not begun to roll, so there are no results yet";
        match self {
            Self::Relaxation(RelaxationError::Slow { .. }) => {
                "raise preload.max_iterations, or raise preload.tolerance to a ratio that it \
                 reaches"
            }
            Self::Relaxation(RelaxationError::BlowUp { .. }) => MESH,
            Self::Static(StaticsError::Slow { .. } | StaticsError::Linear { .. }) => {
                "raise preload.max_iterations, or try preload.method = \"relaxation\""
            }
            Self::Static(StaticsError::Inverted { .. } | StaticsError::Flat { .. }) => {
                "lower load.normal; `creepage mesh` tells what Hertz's contact expects of it"
            }
            Self::Static(StaticsError::Open { .. }) => {
                "give a load.normal that presses the disk on the bar"
            }
            Self::Relaxation(RelaxationError::Interrupted)
            | Self::Static(StaticsError::Interrupted) => INTERRUPTED,
            Self::Static(_) => MESH,
        }
    }
}

/// What the preload found.
pub(crate) struct Preloaded {
    /// Displacements of the bodies (m).
    pub(crate) displacement: Vec<Padded>,
    /// How they were found: not at all with `preload.method = "none"`.
    pub(crate) report: Option<Report>,
    /// Slaves of exact contact under pressure, and their normal force (N).
    pub(crate) pressed: Vec<(contact::Gap, f64)>,
}

/// The preload of a case. Says how Newton's iterations go. Leaves penalty contact in the state of the
/// preload.
pub(crate) fn preload(
    case: &Case,
    model: &Model,
    solid: &mut Solid,
    contact: &mut PenaltyContact,
    hub: &Hub,
    held: &[u32],
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
    say: &mut (dyn FnMut(&str) -> Result<(), RunError> + Send),
) -> Result<Preloaded, RunError> {
    let disk = model.mesh.bodies[DISK].nodes.clone();
    let lowered = |by: f64| {
        let mut u = vec![Padded::ZERO; model.mass.len()];
        u[disk.clone()].iter_mut().for_each(|u| u[2] = -by);
        u
    };
    let clock = Instant::now();
    let most = case.preload_iterations();
    let elements = model.mesh.hexes.len() as f64;
    // `products` are evaluations of all elements.
    let mut look = |step: usize, products: usize, normal_force: f64| {
        observe(&Progress {
            stage: Stage::Preload,
            step: step as u64,
            steps: most,
            time: 0.0,
            end_time: case.duration(),
            normal_force,
            tangential_force: 0.0,
            element_steps_per_s: elements * products as f64 / clock.elapsed().as_secs_f64(),
        });
        !stop.load(Ordering::Relaxed)
    };
    match case.preload.method {
        PreloadMethod::Static => {
            let group = Tied {
                nodes: hub.nodes.clone(),
                axes: [Axis::Moved(0.0), Axis::Moved(0.0), Axis::Loaded(-case.load.normal)],
            };
            let supports = Supports { held: held.to_vec(), tied: vec![group] };
            let problem = Problem {
                mesh: &model.mesh,
                supports: &supports,
                spin: Some(Spin {
                    centre: hub.centre,
                    omega: spin(case),
                    nodes: disk.clone(),
                    mass: &model.mass,
                    hub: 0,
                }),
                enforcement: match case.contact.enforcement {
                    schema::Enforcement::Penalty => Enforcement::Penalty,
                    schema::Enforcement::Exact => Enforcement::Exact { slave: model.slave() },
                },
                tolerance: case.preload_tolerance(),
                max_iterations: most as usize,
            };
            let start = lowered(hertz(case).approach);
            let mut products = 0;
            let mut said = Ok(());
            let found = statics::solve(solid, Some(contact), &problem, &start, |now| {
                products += now.cg_iterations + 1;
                said = say(&format!(
                    "preload {:2}: residual {:.1e} of the load, normal force {:.1} N, {} pairs closed, \
                     {} iterations of conjugate gradients, step {:.2}",
                    now.iteration,
                    now.residual,
                    now.normal_force,
                    now.closed,
                    now.cg_iterations,
                    now.step
                ));
                said.is_ok() && look(now.iteration, products, now.normal_force)
            });
            said?;
            let found = found.map_err(PreloadError::from)?;
            let height = found.displacement[hub.nodes[0] as usize][2];
            Ok(Preloaded {
                displacement: found.displacement,
                report: Some(Report::Static(found.report, height)),
                pressed: found.pressed,
            })
        }
        PreloadMethod::Relaxation => {
            let setup = Relaxation {
                hub,
                load: case.load.normal,
                held,
                disk: disk.clone(),
                omega: spin(case),
                mass: &model.mass,
                stiffness: &solid::nodal_stiffness_bounds(
                    &model.mesh,
                    &model.materials,
                    model.elements(),
                ),
                start: -hertz(case).approach,
                tolerance: case.preload_tolerance(),
                max_iterations: most as usize,
            };
            let (u, report) = dynamics::relax(solid, contact, &setup, |now| {
                look(now.iterations, now.iterations, now.normal_force)
            })
            .map_err(PreloadError::from)?;
            let report = Some(Report::Relaxation(report));
            Ok(Preloaded { displacement: u, report, pressed: Vec::new() })
        }
        PreloadMethod::None => {
            let u = lowered(-case.disk.lift);
            // closes the pairs that touch, for the stable step
            let mut unused = u.clone();
            contact.apply_frictionless(solid.reference(), &u, &mut unused);
            Ok(Preloaded { displacement: u, report: None, pressed: Vec::new() })
        }
    }
}

/// Angular velocity whose centrifugal force acts during the preload (rad/s).
fn spin(case: &Case) -> f64 {
    case.drive.speed / case.disk.radius
}
