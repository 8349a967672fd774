//! The state before rolling: equilibrium under the load, by whichever method the case asks for.

pub(crate) mod error;
pub(crate) mod store;

use crate::hertz::hertz;
use crate::model::{DISK, Model};
use crate::progress::{Progress, Stage};
use crate::run_error::RunError;
use crate::schema::{Case, Enforcement, PreloadMethod};
use contact::{Gap, StabilityScale};
use dynamics::{Hub, Relaxation, RelaxationReport};
use error::PreloadError;
use mesh::Padded;
use serde::{Deserialize, Serialize};
use serde_json::json;
use solid::Solid;
use statics::{Axis, Contact, Ending, Iteration, Problem, Spin, Supports, Tied};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// How the preload was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum PreloadReport {
    /// By Newton's method.
    Static {
        iterations: usize,
        /// Conjugate-gradient iterations in all.
        cg_iterations: usize,
        /// Sum of the contact's normal forces (N).
        normal_force: f64,
        closed_pairs: usize,
        /// Residual over the load, before and after the normals follow the facets.
        residual: f64,
        facets: f64,
        /// Whether the residual ended at round-off, above the tolerance.
        round_off: bool,
        /// Displacement of the hub in z (m).
        hub: f64,
    },
    /// By dynamic relaxation.
    Relaxation {
        iterations: usize,
        normal_force: f64,
        /// Kinetic (fictitious) over internal energy at the end.
        kinetic_ratio: f64,
        hub: f64,
    },
}

impl PreloadReport {
    fn of_statics(report: &statics::NewtonReport, hub: f64) -> Self {
        Self::Static {
            iterations: report.last.iteration,
            cg_iterations: report.cg_iterations,
            normal_force: report.last.normal_force,
            closed_pairs: report.last.closed,
            residual: report.last.residual,
            facets: report.facets,
            round_off: report.ending == Ending::RoundOff,
            hub,
        }
    }

    fn of_relaxation(report: &RelaxationReport) -> Self {
        Self::Relaxation {
            iterations: report.iterations,
            normal_force: report.normal_force,
            kinetic_ratio: report.kinetic_ratio,
            hub: report.hub,
        }
    }
}

impl PreloadReport {
    /// Displacement of the hub in z (m).
    pub(crate) fn hub(&self) -> f64 {
        match self {
            Self::Static { hub, .. } | Self::Relaxation { hub, .. } => *hub,
        }
    }

    /// The line of the log.
    pub(crate) fn line(&self) -> String {
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

    /// The section of the summary.
    pub(crate) fn json(&self) -> serde_json::Value {
        match self {
            Self::Static {
                iterations,
                cg_iterations,
                normal_force,
                closed_pairs,
                residual,
                facets,
                hub,
                ..
            } => json!({
                "method": "static", "iterations": iterations, "cg_iterations": cg_iterations,
                "normal_force": normal_force, "closed_pairs": closed_pairs, "residual": residual,
                "facet_residual": facets, "hub_displacement": hub
            }),
            Self::Relaxation { iterations, normal_force, kinetic_ratio, hub } => json!({
                "method": "relaxation", "iterations": iterations, "normal_force": normal_force,
                "kinetic_ratio": kinetic_ratio, "hub_displacement": hub
            }),
        }
    }
}

/// What the preload found.
pub(crate) struct Preloaded {
    /// Displacements of the bodies (m).
    pub(crate) displacement: Vec<Padded>,
    /// How they were found: not at all with `preload.method = "none"`.
    pub(crate) report: Option<PreloadReport>,
    /// Normal forces (N) of exact contact on the nodes of both sides.
    pub(crate) loads: [Vec<(u32, f64)>; 2],
}

/// What the preload of a case acts on.
pub(crate) struct Bodies<'a> {
    pub(crate) case: &'a Case,
    pub(crate) model: &'a Model,
    pub(crate) solid: &'a mut Solid,
    /// What penalty springs that are a fraction of the stability limit are a fraction of.
    pub(crate) scale: StabilityScale,
    pub(crate) hub: &'a Hub,
    /// Nodes that do not move.
    pub(crate) held: &'a [u32],
}

/// The preload of a case. Says how Newton's iterations go.
pub(crate) fn preload(
    mut bodies: Bodies<'_>,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
    say: &mut (dyn FnMut(&str) -> Result<(), RunError> + Send),
) -> Result<Preloaded, RunError> {
    let Bodies { case, model, .. } = bodies;
    let clock = Instant::now();
    let elements = model.mesh.hexes.len() as f64;
    // `products` are evaluations of all elements.
    let mut look = |step: usize, products: usize, normal_force: f64| {
        observe(&Progress {
            stage: Stage::Preload,
            step: step as u64,
            steps: case.preload_iterations(),
            time: 0.0,
            end_time: case.duration(),
            normal_force,
            tangential_force: 0.0,
            element_steps_per_s: elements * products as f64 / clock.elapsed().as_secs_f64(),
        });
        !stop.load(Ordering::Relaxed)
    };
    match case.preload.method {
        PreloadMethod::Static => bodies.equilibrium(&mut look, say),
        PreloadMethod::Relaxation => bodies.relaxed(&mut look),
        PreloadMethod::None => Ok(Preloaded {
            displacement: bodies.lowered(-case.disk.lift),
            report: None,
            loads: [Vec::new(), Vec::new()],
        }),
    }
}

/// A look at a step, after so many evaluations of all elements, with the normal force (N); false to stop.
type Look<'a> = dyn FnMut(usize, usize, f64) -> bool + 'a;

impl Bodies<'_> {
    /// Displacements (m) of bodies at rest with the disk lowered by `by` (m).
    fn lowered(&self, by: f64) -> Vec<Padded> {
        let mut u = vec![Padded::ZERO; self.model.mass.len()];
        u[self.model.mesh.bodies[DISK].nodes.clone()].iter_mut().for_each(|u| u[2] = -by);
        u
    }

    /// By Newton's method.
    fn equilibrium(
        &mut self,
        look: &mut Look<'_>,
        say: &mut (dyn FnMut(&str) -> Result<(), RunError> + Send),
    ) -> Result<Preloaded, RunError> {
        let (case, model, hub) = (self.case, self.model, self.hub);
        let group = Tied {
            nodes: hub.nodes.clone(),
            axes: [Axis::Moved(0.0), Axis::Moved(0.0), Axis::Loaded(-case.load.normal)],
        };
        let supports = Supports { held: self.held.to_vec(), tied: vec![group] };
        let problem = Problem {
            mesh: &model.mesh,
            supports: &supports,
            plane_strain: case.mesh.plane_strain,
            spin: Some(Spin {
                centre: hub.centre,
                omega: spin(case),
                nodes: model.mesh.bodies[DISK].nodes.clone(),
                mass: &model.mass,
                hub: 0,
            }),
            tolerance: case.preload_tolerance(),
            max_iterations: case.preload_iterations() as usize,
        };
        let start = self.lowered(start_depth(case));
        let (mut springs, mut gaps);
        let contact = match case.contact.enforcement {
            Enforcement::Penalty => {
                springs = model.penalty_contact(case, self.scale)?;
                Contact::Penalty(&mut springs)
            }
            Enforcement::Exact => {
                gaps = model.gaps(case)?;
                Contact::Multipliers(&mut gaps)
            }
        };
        let mut products = 0;
        let mut said = Ok(());
        let found = statics::solve(self.solid, contact, &problem, &start, |now| {
            products += now.cg_iterations + 1;
            said = say(&line(now));
            said.is_ok() && look(now.iteration, products, now.normal_force)
        });
        said?;
        let found = found.map_err(PreloadError::from)?;
        let height = found.displacement[hub.nodes[0] as usize][2];
        Ok(Preloaded {
            displacement: found.displacement,
            report: Some(PreloadReport::of_statics(&found.report, height)),
            loads: loads_of_slaves(model.slave(), &found.pressed),
        })
    }

    /// By dynamic relaxation.
    fn relaxed(&mut self, look: &mut Look<'_>) -> Result<Preloaded, RunError> {
        let (case, model) = (self.case, self.model);
        let stiffness =
            solid::nodal_stiffness_bounds(&model.mesh, &model.materials, model.elements());
        let setup = Relaxation {
            hub: self.hub,
            load: case.load.normal,
            held: self.held,
            disk: model.mesh.bodies[DISK].nodes.clone(),
            omega: spin(case),
            mass: &model.mass,
            stiffness: &stiffness,
            start: -start_depth(case),
            tolerance: case.preload_tolerance(),
            max_iterations: case.preload_iterations() as usize,
        };
        let mut contact = model.penalty_contact(case, self.scale)?;
        let (u, report) = dynamics::relax(self.solid, &mut contact, &setup, |now| {
            look(now.iterations, now.iterations, now.normal_force)
        })
        .map_err(PreloadError::from)?;
        let report = Some(PreloadReport::of_relaxation(&report));
        Ok(Preloaded { displacement: u, report, loads: [Vec::new(), Vec::new()] })
    }
}

/// The line of the log of one of Newton's iterations.
fn line(now: &Iteration) -> String {
    format!(
        "preload {:2}: residual {:.1e} of the load, normal force {:.1} N, {} pairs closed, \
         {} iterations of conjugate gradients, step {:.2}",
        now.iteration, now.residual, now.normal_force, now.closed, now.cg_iterations, now.step
    )
}

/// Normal forces (N) on the nodes of both sides where the slaves of exact contact bear `pressed`.
fn loads_of_slaves(slave: usize, pressed: &[(Gap, f64)]) -> [Vec<(u32, f64)>; 2] {
    let mut loads = [Vec::new(), Vec::new()];
    for (gap, force) in pressed {
        loads[slave].push((gap.node, *force));
        loads[1 - slave].extend(gap.projection.iter().map(|&(n, weight)| (n, weight * force)));
    }
    loads
}

/// How deep the undeformed disk is lowered into the bar before Newton's iterations (m): Hertz's approach; in line
/// contact, where there is none, what the half length of the patch needs.
fn start_depth(case: &Case) -> f64 {
    let patch = hertz(case);
    if patch.approach > 0.0 { patch.approach } else { patch.a * patch.a / (2.0 * case.disk.radius) }
}

/// Angular velocity whose centrifugal force acts during the preload (rad/s).
fn spin(case: &Case) -> f64 {
    case.drive.speed / case.disk.radius
}
