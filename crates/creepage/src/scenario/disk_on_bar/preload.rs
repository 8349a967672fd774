//! The state before rolling: equilibrium under the load, by whichever method the case asks for.

use crate::case::hertz::hertz;
use crate::case::schema::{Case, Enforcement, PreloadMethod};
use crate::scenario::error::ScenarioError;
use crate::scenario::model::{DISK, Model};
use crate::scenario::preload::{PreloadError, PreloadReport};
use crate::scenario::progress::{Progress, Stage};
use contact::{Gap, StabilityScale};
use dynamics::{Hub, Relaxation};
use mesh::Padded;
use output::NotWritten;
use solid::Solid;
use statics::{Axis, Contact, Iteration, Problem, Spin, Supports, Tied};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// The preloaded state.
pub(super) struct Preloaded {
    /// Displacements of the bodies (m).
    pub(super) displacement: Vec<Padded>,
    /// How they were found; none with `preload.method = "none"`.
    pub(super) report: Option<PreloadReport>,
    /// Nodes of both sides with their normal force (N) in exact contact; empty with penalty contact.
    pub(super) loads: [Vec<(u32, f64)>; 2],
}

/// What the preload of a case acts on.
pub(super) struct Bodies<'a> {
    pub(super) case: &'a Case,
    pub(super) model: &'a Model,
    pub(super) solid: &'a mut Solid,
    /// The scale of penalty springs that are a fraction of the stability limit.
    pub(super) scale: StabilityScale,
    pub(super) hub: &'a Hub,
    /// Nodes that do not move.
    pub(super) held: &'a [u32],
}

/// The preload of a case; `say` takes a line for each of Newton's iterations.
pub(super) fn preload(
    mut bodies: Bodies<'_>,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
    say: &mut (dyn FnMut(&str) -> Result<(), NotWritten> + Send),
) -> Result<Preloaded, ScenarioError> {
    let Bodies { case, model, .. } = bodies;
    let clock = Instant::now();
    let elements = model.mesh.hexes.len() as f64;
    // `products` are evaluations of all elements.
    let mut watch = |step: usize, products: usize, normal_force: f64| {
        observe(&Progress {
            stage: Stage::Preload,
            step: step as u64,
            steps: case.preload_iterations(),
            time: 0.0,
            end_time: case.duration(),
            normal_force,
            tangential_force: 0.0,
            element_steps_per_s: elements * products as f64 / clock.elapsed().as_secs_f64(),
            cost: None,
        });
        !stop.load(Ordering::Relaxed)
    };
    match case.preload.method {
        PreloadMethod::Static => bodies.equilibrium(&mut watch, say),
        PreloadMethod::Relaxation => bodies.relaxed(&mut watch),
        PreloadMethod::None => Ok(Preloaded {
            displacement: bodies.lowered(-case.disk.lift),
            report: None,
            loads: [Vec::new(), Vec::new()],
        }),
    }
}

/// Called with the iteration, the evaluations of all elements so far, and the normal force (N); false to stop.
type Watch<'a> = dyn FnMut(usize, usize, f64) -> bool + 'a;

impl Bodies<'_> {
    /// Displacements (m) of undeformed bodies with the disk lowered by `by` (m).
    fn lowered(&self, by: f64) -> Vec<Padded> {
        let mut u = vec![Padded::ZERO; self.model.mass.len()];
        u[self.model.mesh.bodies[DISK].nodes.clone()].iter_mut().for_each(|u| u[2] = -by);
        u
    }

    /// How far irregular surfaces lie over the smooth ones at the first point of contact (m).
    fn height(&self) -> f64 {
        let irregular = self.model.surfaces.iter().filter_map(|side| side.irregularity.as_ref());
        irregular.map(|surface| surface.heights.at(0.0, 0.0)).sum()
    }

    /// By Newton's method.
    fn equilibrium(
        &mut self,
        watch: &mut Watch<'_>,
        say: &mut (dyn FnMut(&str) -> Result<(), NotWritten> + Send),
    ) -> Result<Preloaded, ScenarioError> {
        let (case, model, hub) = (self.case, self.model, self.hub);
        let omega = rolling_omega(case);
        let load = omega * omega * hub.counterweight[1] - case.load.normal / model.multiplicity;
        let axes = [Axis::Moved(0.0), Axis::Moved(0.0), Axis::Loaded(load)];
        let group = Tied { nodes: hub.nodes.clone(), axes };
        let supports = Supports {
            held: self.held.to_vec(),
            tied: vec![group],
            sliding: model.sliding.clone(),
        };
        let problem = Problem {
            mesh: &model.mesh,
            supports: &supports,
            spin: Some(Spin {
                centre: hub.centre,
                omega,
                nodes: model.mesh.bodies[DISK].nodes.clone(),
                mass: &model.mass,
                hub: 0,
            }),
            tolerance: case.preload_tolerance(),
            max_iterations: case.preload_iterations() as usize,
        };
        let start = self.lowered(start_depth(case) - self.height());
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
            let now = &Iteration { normal_force: model.multiplicity * now.normal_force, ..*now };
            said = say(&line(now));
            said.is_ok() && watch(now.iteration, products, now.normal_force)
        });
        said?;
        let found = found.map_err(PreloadError::from)?;
        let height = found.displacement[hub.nodes[0] as usize][2];
        Ok(Preloaded {
            displacement: found.displacement,
            report: Some(PreloadReport::of_statics(&found.report, model.multiplicity, height)),
            loads: loads_of_slaves(model.slave(), &found.pressed),
        })
    }

    /// By dynamic relaxation.
    fn relaxed(&mut self, watch: &mut Watch<'_>) -> Result<Preloaded, ScenarioError> {
        let (case, model) = (self.case, self.model);
        let stiffness =
            solid::nodal_stiffness_bounds(&model.mesh, &model.materials, model.elements());
        let setup = Relaxation {
            hub: self.hub,
            load: case.load.normal,
            held: self.held,
            upper: model.mesh.bodies[DISK].nodes.clone(),
            omega: rolling_omega(case),
            mass: &model.mass,
            stiffness: &stiffness,
            start: self.height() - start_depth(case),
            tolerance: case.preload_tolerance(),
            max_iterations: case.preload_iterations() as usize,
        };
        let mut contact = model.penalty_contact(case, self.scale)?;
        let (u, report) = dynamics::relax(self.solid, &mut contact, &setup, |now| {
            watch(now.iterations, now.iterations, now.normal_force)
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

/// How deep the undeformed disk is lowered into the bar before the iterations (m): Hertz's approach; in line
/// contact, for which it is not defined, the sagitta of the disk over the half length of the patch.
fn start_depth(case: &Case) -> f64 {
    let patch = hertz(case);
    if patch.approach > 0.0 { patch.approach } else { patch.a * patch.a / (2.0 * case.disk.radius) }
}

/// Angular velocity of rolling, whose centrifugal force acts during the preload (rad/s).
fn rolling_omega(case: &Case) -> f64 {
    case.drive.speed / case.disk.radius
}
