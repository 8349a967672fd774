//! From a model to a simulation at t = 0: stable step, preload, rolling velocity.

use crate::model::{BAR, DISK, Model};
use crate::preload::{self, Preloaded, preload};
use crate::progress::Progress;
use crate::run_error::RunError;
use crate::schema::{Case, DriveMode, Enforcement, LoadMode};
use contact::{Contact, Gap, PenaltyContact, StabilityScale};
use dynamics::{Hub, QuietEnd, RollingField, Setup, Simulation, Spin, Vertical};
use mesh::Padded;
use serde::Serialize;
use solid::Solid;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Lanczos steps for the largest frequency, and the margin on what they find.
const LANCZOS: usize = 40;
const MARGIN: f64 = 1.01;

/// What the stable step is made of.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Stability {
    /// Largest frequency of the bodies without contact, with margin (rad/s).
    pub(crate) omega_elastic: f64,
    /// Largest frequency with the contact springs closed after the preload, with margin (rad/s).
    pub(crate) omega_max: f64,
    /// Rigorous upper bound: element bound and contact bound combined (rad/s).
    pub(crate) omega_bound: f64,
    /// 2/omega_max (s).
    pub(crate) dt_limit: f64,
    /// Time step over that limit (dimensionless).
    pub(crate) factor: f64,
}

/// Rolling radii.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct RollingRadius {
    /// Of the undeformed disk (m).
    pub(crate) nominal: f64,
    /// V/omega at which the mean slip velocity over the preloaded patch, weighted with the
    /// pressure, vanishes (m).
    pub(crate) effective: f64,
}

/// What is known once the start is made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facts {
    pub(crate) stability: Stability,
    pub(crate) radius: RollingRadius,
    pub(crate) preload: Option<preload::Report>,
    /// Wall time of the preload (s).
    pub(crate) preload_wall: f64,
    /// Time steps to take.
    pub(crate) steps: u64,
}

/// A simulation ready to roll.
pub(crate) struct Start {
    pub(crate) simulation: Simulation,
    pub(crate) facts: Facts,
}

/// Preloads the model and sets it rolling.
pub(crate) fn start(
    case: &Case,
    model: &Model,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
    say: &mut (dyn FnMut(&str) -> Result<(), RunError> + Send),
) -> Result<Start, RunError> {
    let mut solid = model.solid(case)?;
    let inverse_mass = inverse_mass(model);
    let omega_elastic = elastic_frequency(model, &mut solid);
    let scale = StabilityScale { omega_elastic, dt: case.time.factor * 2.0 / omega_elastic };
    let mut contact = model.contact(case, scale)?;
    let hub = hub(case, model, &solid);
    let quiet: Vec<_> = model.quiet.iter().collect();
    let quiet = QuietEnd::new(&model.mesh, &quiet, &model.materials[BAR], &model.clamped);

    let clock = Instant::now();
    let nominal = case.disk.radius;
    let mut held = model.clamped.clone();
    held.extend(quiet.nodes());
    let Preloaded { displacement, report: preload, pressed } =
        preload(case, model, &mut solid, &mut contact, &hub, &held, stop, observe, say)?;
    let preload_wall = clock.elapsed().as_secs_f64();

    let exact = case.contact.enforcement == Enforcement::Exact;
    // exact contact has no stiffness
    let (omega_max, contact_bound) = if exact {
        (omega_elastic, 0.0)
    } else {
        let with_springs = |x: &[Padded], y: &mut [Padded]| {
            solid.add_stiffness_product(x, y);
            contact.stiffness_product(x, y);
        };
        let omega = solid::largest_frequency(&inverse_mass, with_springs, LANCZOS);
        (MARGIN * omega, contact.rigorous_omega_squared(&inverse_mass))
    };
    let (element_bound, _) =
        solid::element_frequency_bound(&model.mesh, &model.materials, model.elements());
    // Kelvin–Voigt stiffens the highest mode: dt <= 2/omega (sqrt(1 + xi^2) - xi), xi = eta omega/2
    let xi = 0.5 * case.damping.kelvin_voigt * omega_max;
    let limit = 2.0 / omega_max * ((1.0 + xi * xi).sqrt() - xi);
    let steps = (case.duration() / (case.time.factor * limit)).ceil().max(1.0);
    let dt = case.duration() / steps;
    let stability = Stability {
        omega_elastic,
        omega_max,
        omega_bound: (element_bound * element_bound + contact_bound).sqrt(),
        dt_limit: limit,
        factor: dt / limit,
    };

    let field = RollingField {
        disk: DISK,
        centre: hub.centre,
        speed: case.drive.speed,
        omega: case.drive.speed / nominal,
        dt,
    };
    let effective = match preload {
        Some(_) => {
            let loads =
                if exact { loads_of_slaves(model.slave(), &pressed) } else { loads(&contact) };
            effective_radius(model, &loads, &displacement, &field)
        }
        None => nominal,
    };
    let free = case.drive.speed / effective;
    let velocity =
        dynamics::rolling_field(&model.mesh, &displacement, &RollingField { omega: free, ..field });

    let mut hub = hub;
    hub.spin = spin(case, free);
    hub.vertical = match case.load.mode {
        LoadMode::Load => Vertical::Load(case.load.normal),
        LoadMode::Height => Vertical::Held,
    };
    hub.state.z = preload.map_or(case.disk.lift, |p| p.hub());
    hub.state.vx = case.drive.speed;
    hub.state.omega = free;
    let mut quiet = quiet;
    if preload.is_some() {
        let mut force = vec![Padded::ZERO; model.mass.len()];
        solid.subtract_elastic_force(&displacement, &mut force, false);
        quiet.keep_reactions(&force);
    }
    let contact: Box<dyn Contact> =
        if exact { Box::new(model.exact_contact(case)?) } else { Box::new(contact) };
    let simulation = Simulation::new(Setup {
        solid,
        contact: Some(contact),
        hub: Some(hub),
        quiet,
        held: model.clamped.clone(),
        fixed: Vec::new(),
        load: dynamics::Load::default(),
        disk: model.mesh.bodies[DISK].nodes.clone(),
        mass: model.mass.clone(),
        displacement,
        velocity,
        dt,
        omega_max: 2.0 / limit,
        mass_damping: case.damping.mass,
    });
    let radius = RollingRadius { nominal, effective };
    let facts = Facts { stability, radius, preload, preload_wall, steps: steps as u64 };
    Ok(Start { simulation, facts })
}

/// Inverse masses with held and carried nodes at zero.
fn inverse_mass(model: &Model) -> Vec<f64> {
    let mut inverse: Vec<f64> = model.mass.iter().map(|m| 1.0 / m).collect();
    model.clamped.iter().chain(&model.hub).for_each(|&n| inverse[n as usize] = 0.0);
    inverse
}

/// Largest frequency of the bodies without contact, with its margin (rad/s).
pub(crate) fn elastic_frequency(model: &Model, solid: &mut Solid) -> f64 {
    MARGIN
        * solid::largest_frequency(
            &inverse_mass(model),
            |x, y| solid.add_stiffness_product(x, y),
            LANCZOS,
        )
}

fn hub(case: &Case, model: &Model, solid: &Solid) -> Hub {
    Hub::new(
        [0.0, 0.0, case.disk.radius],
        &model.hub,
        solid.reference(),
        &model.mass,
        case.load.hub_mass,
        spin(case, case.drive.speed / case.disk.radius),
        Vertical::Load(case.load.normal),
    )
}

fn spin(case: &Case, free: f64) -> Spin {
    let ramp = case.drive.ramp;
    match case.drive.mode {
        DriveMode::Creepage => {
            Spin::Creepage { free, creepage: case.drive.creepage.unwrap_or(0.0), ramp }
        }
        DriveMode::Torque => Spin::Torque { torque: case.drive.torque.unwrap_or(0.0), ramp },
    }
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
    let velocity =
        dynamics::rolling_field(&model.mesh, displacement, &RollingField { dt: 0.0, ..*field });
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

/// The same where the nodes of `slave` bear `pressed`.
fn loads_of_slaves(slave: usize, pressed: &[(Gap, f64)]) -> [Vec<(u32, f64)>; 2] {
    let mut loads = [Vec::new(), Vec::new()];
    for (gap, force) in pressed {
        loads[slave].push((gap.node, *force));
        let corners = gap.corners.iter().zip(gap.weights);
        loads[1 - slave].extend(corners.map(|(&n, weight)| (n, weight * force)));
    }
    loads
}
