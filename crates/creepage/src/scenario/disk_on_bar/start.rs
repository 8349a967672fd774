//! From a model to a simulation at t = 0: stable step, preload, rolling velocity.

use super::bodies;
use super::disturbance::disturb;
use super::guards::limits;
use super::preload::{Bodies, Preloaded, preload};
use super::store;
use super::window::window;
use crate::case::schema::{Case, Creepage, Drive, DriveMode, Enforcement, LoadMode, Step};
use crate::scenario::error::ScenarioError;
use crate::scenario::model::{BAR, DISK, Model};
use crate::scenario::numbers::numbers;
use crate::scenario::progress::Progress;
use crate::scenario::start::{InitialState, KeptState, RollingRadius, Stability, Start};
use contact::{ContactStep, Method, PenaltyContact, StabilityScale};
use dynamics::{
    Fixed, Hub, QuietEnd, RollingField, Setup, Sideways, Simulation, SimulationState, Spin, System,
    Vertical, Window,
};
use mesh::Padded;
use output::NotWritten;
use solid::Solid;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The bodies at rest under the load, and what limits the time step.
struct PreloadedState {
    solid: Solid,
    /// The springs of penalty contact, closed where the bodies touch; none of exact contact.
    springs: Option<PenaltyContact>,
    hub: Hub,
    quiet: QuietEnd,
    preloaded: Preloaded,
    preload_wall: f64,
    omega_elastic: f64,
    omega_max: f64,
    /// What contact adds to the rigorous bound of the squared frequency (1/s^2).
    contact_bound: f64,
    /// Longest stable step (s).
    limit: f64,
}

/// Longest stable step (s) of a case in its preloaded state. The preload is taken from the folder `cache` if it is
/// there.
///
/// # Errors
/// A mesh that cannot be made, a preload that is not found, a `stop`.
pub fn stable_limit(
    case: &Case,
    cache: Option<&Path>,
    stop: &AtomicBool,
) -> Result<f64, ScenarioError> {
    let model = bodies::model(case)?;
    Ok(preloaded_state(case, &model, cache, stop, &mut |_| {}, &mut |_| Ok(()))?.limit)
}

/// Preloads the model, or takes the preload from `cache`.
fn preloaded_state(
    case: &Case,
    model: &Model,
    cache: Option<&Path>,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
    say: &mut (dyn FnMut(&str) -> Result<(), NotWritten> + Send),
) -> Result<PreloadedState, ScenarioError> {
    let mut solid = model.solid(case)?;
    let inverse_mass = model.inverse_mass();
    let omega_elastic = model.elastic_frequency(&mut solid);
    let scale = scale(case, omega_elastic);
    let hub = hub(case, model, &solid);
    let quiet = quiet(model);

    let clock = Instant::now();
    let mut held = model.clamped.clone();
    held.extend(quiet.nodes());
    let mut preloaded = store::kept(case, model, cache, stop, say, &mut |say| {
        let bodies = Bodies { case, model, solid: &mut solid, scale, hub: &hub, held: &held };
        preload(bodies, stop, observe, say)
    })?;
    disturb(case, model, &mut preloaded.displacement);
    for &[first, second] in &model.paired {
        // equal only to the preload's tolerance until now
        preloaded.displacement[second as usize] = preloaded.displacement[first as usize];
    }
    // The state of the contact is made of the displacements alone, so that a preload from the cache and one just
    // found lead to the same bits.
    let springs = match case.contact.enforcement {
        Enforcement::Penalty => {
            let mut springs = model.penalty_contact(case, scale)?;
            // closes the springs that touch, for the stable step
            let at = springs.trace().positions(solid.reference(), &preloaded.displacement);
            springs.apply_frictionless(&at, &mut vec![Padded::ZERO; at.len()]);
            Some(springs)
        }
        Enforcement::Exact => None,
    };
    let preload_wall = clock.elapsed().as_secs_f64();

    let (omega_max, contact_bound) = match &springs {
        Some(springs) => {
            let omega = model.largest_frequency(|x, y| {
                solid.add_stiffness_product(x, y);
                springs.stiffness_product(x, y);
            });
            (omega, springs.rigorous_omega_squared(&inverse_mass))
        }
        None => (omega_elastic, 0.0),
    };
    let limit = case.stable_limit(omega_max);
    Ok(PreloadedState {
        solid,
        springs,
        hub,
        quiet,
        preloaded,
        preload_wall,
        omega_elastic,
        omega_max,
        contact_bound,
        limit,
    })
}

/// Preloads the model, or takes the preload from the folder `cache`, and gives it the velocities of free rolling.
///
/// `observe` is called as the preload goes on, `say` takes lines for the log, and `stop` ends the preload.
///
/// # Errors
/// Elements or contact that cannot be set up; a preload that is not found or is stopped; `time.step` above the
/// stability limit; a log that cannot be written.
pub fn start(
    case: &Case,
    model: &Model,
    cache: Option<&Path>,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
    say: &mut (dyn FnMut(&str) -> Result<(), NotWritten> + Send),
) -> Result<Start, ScenarioError> {
    let PreloadedState {
        mut solid,
        springs,
        hub,
        quiet,
        preloaded: Preloaded { displacement, report: preload, loads: pressed },
        preload_wall,
        omega_elastic,
        omega_max,
        contact_bound,
        limit,
    } = preloaded_state(case, model, cache, stop, observe, say)?;
    let nominal = case.disk.radius;
    let (element_bound, _) =
        solid::element_frequency_bound(&model.mesh, &model.materials, model.elements());
    if let Step::Absolute(step) = case.step()
        && step > limit
        && case.theta().is_none()
    {
        return Err(ScenarioError::Step { step, limit });
    }
    let steps = (case.duration() / case.step().under(limit)).ceil().max(1.0);
    let dt = case.duration() / steps;
    let stability = Stability {
        omega_elastic,
        omega_max,
        omega_bound: (element_bound * element_bound + contact_bound).sqrt(),
        dt_limit: limit,
        factor: dt / limit,
    };

    let field = RollingField {
        upper: DISK,
        centre: hub.centre,
        speed: case.drive.speed,
        omega: case.drive.speed / nominal,
        // implicit steps begin with the velocities of t = 0
        dt: if case.theta().is_some() { 0.0 } else { dt },
    };
    let effective = match preload {
        Some(_) => {
            let loads = springs.as_ref().map_or(pressed, loads);
            effective_radius(model, &loads, &displacement, &field)
        }
        None => nominal,
    };
    let free = case.drive.speed / effective;
    let velocity = rolling_field(model, &displacement, &RollingField { omega: free, ..field });

    let mut hub = hub;
    hub.state.z = preload.map_or(case.disk.lift, |p| p.hub());
    hub.state.vx = case.drive.speed;
    hub.state.omega = free;
    let mut quiet = quiet;
    if preload.is_some() {
        let mut force = vec![Padded::ZERO; model.mass.len()];
        solid.subtract_elastic_force(&displacement, &mut force, false);
        quiet.keep_reactions(&force);
    }
    let contact: Method = match springs {
        Some(springs) => springs.into(),
        None => model.exact_contact(case)?.into(),
    };
    let radius = RollingRadius { nominal, effective };
    let found = KeptState { stability, radius, preload, preload_wall, steps: steps as u64 };
    let window = window(case, model, &mut solid)?;
    let system = System {
        contact: Some(contact),
        hub: Some(hub),
        quiet,
        ..System::free(solid, model.mass.clone())
    };
    Ok(assemble(case, model, found, window, system, [displacement, velocity]))
}

/// The simulation in the `state` of a checkpoint, with what was `found` when it began.
///
/// # Errors
/// Elements or contact that cannot be set up; a state of another model.
pub fn restart(
    case: &Case,
    model: &Model,
    found: KeptState,
    state: &SimulationState,
) -> Result<Start, ScenarioError> {
    let mut solid = model.solid(case)?;
    let window = window(case, model, &mut solid)?;
    set_up(case, model, found, state, (solid, window))
}

/// The same without the moves of a zone that follows the contact: for a process that takes the state after a move from
/// another, and for a copy that only times steps.
///
/// # Errors
/// Those of [`restart`].
pub fn restart_without_moves(
    case: &Case,
    model: &Model,
    found: KeptState,
    state: &SimulationState,
) -> Result<Start, ScenarioError> {
    set_up(case, model, found, state, (model.solid(case)?, None))
}

/// The simulation in the `state` of a checkpoint.
fn set_up(
    case: &Case,
    model: &Model,
    found: KeptState,
    state: &SimulationState,
    (solid, window): (Solid, Option<Window>),
) -> Result<Start, ScenarioError> {
    let contact: Method = match case.contact.enforcement {
        Enforcement::Exact => model.exact_contact(case)?.into(),
        Enforcement::Penalty => {
            let scale = scale(case, found.stability.omega_elastic);
            model.penalty_contact(case, scale)?.into()
        }
    };
    let system = System {
        contact: Some(contact),
        hub: Some(hub(case, model, &solid)),
        quiet: quiet(model),
        ..System::free(solid, model.mass.clone())
    };
    let rest = vec![Padded::ZERO; model.mass.len()];
    let mut start = assemble(case, model, found, window, system, [rest.clone(), rest]);
    start.simulation.restore(state)?;
    Ok(start)
}

/// The simulation of a `system` of bodies, contact, hub and quiet ends, with its boundary conditions and the limits of
/// its guards.
fn assemble(
    case: &Case,
    model: &Model,
    found: KeptState,
    window: Option<Window>,
    mut system: System,
    [displacement, velocity]: [Vec<Padded>; 2],
) -> Start {
    let KeptState { stability, radius, preload, preload_wall, steps } = found;
    let dt = case.duration() / steps as f64;
    if let Some(hub) = &mut system.hub {
        hub.spin = spin(case, model, case.drive.speed / radius.effective);
        hub.vertical = match case.load.mode {
            LoadMode::Load => Vertical::Load(case.load.normal / model.multiplicity),
            LoadMode::Height => Vertical::Held,
        };
        hub.sideways = sideways(case);
    }
    let system = System {
        held: model.clamped.clone(),
        fixed: model
            .sliding
            .iter()
            .map(|&node| Fixed { node, axes: [false, true, false] })
            .collect(),
        paired: model.paired.clone(),
        names: ["disk", "bar"],
        upper: model.mesh.bodies[DISK].nodes.clone(),
        mass_damping: case.damping.mass,
        multiplicity: model.multiplicity,
        ..system
    };
    let dt_limit = stability.dt_limit;
    let mut simulation = Simulation::new(Setup { system, displacement, velocity, dt, dt_limit });
    if let Some(theta) = case.theta() {
        simulation.set_implicit(theta);
    }
    simulation.set_limits(limits(case, model));
    if let Some(window) = window {
        simulation.set_window(window);
    }
    let numbers = numbers(case, model, dt);
    let facts = InitialState { stability, radius, preload, preload_wall, numbers, steps };
    Start { simulation, facts }
}

/// The scale of penalty springs that are a fraction of the stability limit.
fn scale(case: &Case, omega_elastic: f64) -> StabilityScale {
    StabilityScale { omega_elastic, dt: case.step().under(2.0 / omega_elastic) }
}

fn quiet(model: &Model) -> QuietEnd {
    let ends: Vec<_> = model.quiet.iter().collect();
    QuietEnd::new(&model.mesh, &ends, &model.materials[BAR], &model.clamped)
}

fn hub(case: &Case, model: &Model, solid: &Solid) -> Hub {
    Hub::new(
        [0.0, 0.0, case.axle_height()].into(),
        &model.hub,
        solid.reference(),
        &model.mass,
        case.load.hub_mass / model.multiplicity,
        spin(case, model, case.drive.speed / case.disk.radius),
        Vertical::Load(case.load.normal / model.multiplicity),
    )
    .balanced(model.mesh.bodies[DISK].nodes.clone(), solid.reference(), &model.mass)
}

/// What turns the hub. The position of a wheel with profiles adds what it slips where it turns by `disk.radius`.
fn spin(case: &Case, model: &Model, free: f64) -> Spin {
    let ramp = case.drive.ramp();
    let by_position = model.position.map_or(0.0, |position| position.longitudinal);
    match case.drive.mode {
        DriveMode::Creepage => match &case.drive.creepage {
            Some(Creepage::Table(points)) => {
                let creepage = points.iter().map(|[t, creepage]| [*t, creepage + by_position]);
                Spin::Table { free, creepage: creepage.collect() }
            }
            Some(Creepage::Number(creepage)) => {
                Spin::Creepage { free, creepage: creepage + by_position, ramp }
            }
            None => Spin::Creepage { free, creepage: by_position, ramp },
        },
        DriveMode::Torque => {
            Spin::Torque { torque: case.drive.torque.unwrap_or(0.0) / model.multiplicity, ramp }
        }
    }
}

/// What moves the hub sideways, if anything does.
fn sideways(case: &Case) -> Option<Sideways> {
    let &Drive { speed, lateral_creepage, spin, .. } = &case.drive;
    let (ramp, behind) = (case.drive.ramp(), case.patch_behind());
    let sideways = Sideways { speed, lateral_creepage, spin, ramp, behind };
    (lateral_creepage != 0.0 || spin != 0.0).then_some(sideways)
}

/// Velocity of every node (m/s) of the preloaded bodies that roll, half a step before t = 0.
fn rolling_field(model: &Model, displacement: &[Padded], field: &RollingField) -> Vec<Padded> {
    let [disk, bar] = model.materials;
    let is_alike = disk.young == bar.young && disk.poisson == bar.poisson;
    if is_alike {
        return dynamics::rolling_field(&model.mesh, displacement, field);
    }
    let [tread, top] = &model.zones;
    dynamics::rolling_field_of_unlike(&model.mesh, [tread, top], displacement, field)
}

/// Effective rolling radius of the preloaded state: with the disk turning at `field.omega`, the
/// mean forward velocities of both surfaces, weighted with the pressure, are V - omega R_d on the
/// disk and -V e on the bar; they agree at V/omega = R_d/(1 + e).
fn effective_radius(
    model: &Model,
    loads: &[Vec<(u32, f64)>; 2],
    displacement: &[Padded],
    field: &RollingField,
) -> f64 {
    let velocity = rolling_field(model, displacement, &RollingField { dt: 0.0, ..*field });
    let mean = |side: usize| {
        let (mut sum, mut weight) = (0.0, 0.0);
        for &(n, load) in &loads[side] {
            sum += load * velocity[n as usize].0[0];
            weight += load;
        }
        sum / weight
    };
    let disk = (field.speed - mean(DISK)) / field.omega;
    disk / (1.0 - mean(BAR) / field.speed)
}

/// Normal forces (N) on the nodes of both sides.
fn loads(contact: &PenaltyContact) -> [Vec<(u32, f64)>; 2] {
    [DISK, BAR].map(|side| {
        let mut table = contact.nodal_table(side);
        contact.nodal(&mut table);
        let force = table.pressure.iter().zip(&table.area).map(|(p, a)| p * a);
        table.nodes.iter().copied().zip(force).collect()
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use solid::Level;

    /// The preloaded bodies of the tests' small case, by element kernels of `level`.
    fn preloaded(sets: &[&str], level: Level) -> PreloadedState {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/small.toml");
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let case = Case::load(&file, &sets).unwrap();
        let mut model = bodies::model(&case).unwrap();
        model.kernels = level;
        let stop = AtomicBool::new(false);
        preloaded_state(&case, &model, None, &stop, &mut |_| {}, &mut |_| Ok(())).unwrap()
    }

    /// Of the displacement of every node and of the stable step.
    fn bits(state: &PreloadedState) -> Vec<u64> {
        let displacement = &state.preloaded.displacement;
        let numbers = displacement.iter().flat_map(|u| u.0).chain([state.limit]);
        numbers.map(f64::to_bits).collect()
    }

    #[test]
    fn the_static_preload_has_the_same_bits_by_every_kernel_of_the_pinned_arithmetic() {
        if Level::pinned() == Level::Fused {
            eprintln!("warning: no vectors; there is no second kernel to compare with");
            return;
        }
        for sets in [
            &["element.contact_layers=one-point"][..],
            &["contact.enforcement=exact", "contact.rows=mortar", "element.contact_layers=full"],
        ] {
            let [wide, plain] =
                [Level::pinned(), Level::Fused].map(|level| bits(&preloaded(sets, level)));
            assert_eq!(wide, plain, "{sets:?}");
            // a kernel that rounds in another order shows: the comparison can fail
            assert_ne!(wide, bits(&preloaded(sets, Level::Portable)), "{sets:?}");
        }
    }
}
