//! Falling friction, Eq. (8) of Vollebregt (2017), between two half-spaces sheared in one dimension.
//!
//! Two columns of hexahedra are pressed together at p and sheared by waves that arrive from both
//! sides. With tau the shear stress that the stuck interface would bear, the balance at the interface
//! is `tau - Z s = mu(s) p`, `Z = rho c_s/2` (Andrews 1985; Ionescu and Paumier 1994). For
//! `R = p k (mu_S - mu_D)/Z > 1` it has three solutions between
//! `f_min = mu_D + (mu_S - mu_D)(1 + ln R)/R` and mu_S in units of p. With perfect delay the interface
//! sticks until tau = mu_S p, jumps to the solution in slip, and sticks again at tau = f_min p.
//!
//! Steel at 1 GPa with k = 6 s/m has R = 85.7, the speed 14.19 m/s after the jump, and f_min = 0.3315.
//! The columns bear a hundredth of that pressure with k a hundred times as large: the same R with
//! strains that stay linear, and all speeds are a hundredth.
//!
//! The columns are one element wide. All nodes are fixed across the plane of shear and, but for those
//! of the interface, along the normal, as the supports of a one-dimensional motion; elements are
//! flat, so that the couple of the complementary shear changes the pressure by a fraction of a per mille only.
//! The elements have Kelvin–Voigt damping of 0.2 time steps: the mesh rings after the jump, and falling
//! friction does not damp that. What moves is the node's y. Incoming waves are given as the initial state, displacement and
//! velocity of `u = f(z + c t)`.

use crate::body::{STEEL, at_rest, contact_material};
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use contact::{ExactContact, ExactSettings, Exponential, FrictionLaw, Implicit};
use dynamics::{Fixed, Simulation};
use mesh::Padded;
use solid::{Element, Level, Solid, Viscosity};

/// A hundredth of steel at 1 GPa.
const PRESSURE: f64 = 1e7;
const LAW: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 600.0 };
/// Length of each column (m) and its width over the element's height.
const LENGTH: f64 = 0.4;
const FLAT: f64 = 5000.0;
/// The stress that arrives rises to `PEAK` p over the share `RISE` of the column, stays there up to
/// the share `HOLD`, and falls to `LEFT` p over the rest.
const PEAK: f64 = 0.502;
const LEFT: f64 = 0.31;
const RISE: f64 = 0.15;
const HOLD: f64 = 0.45;

const SOURCE: &str = "tau - Z s = mu(s) p with perfect delay (Ionescu and Paumier 1994)";

/// Stress over p that the stuck interface bears when the part of the waves at the share `x` of the
/// columns has arrived.
fn arriving(x: f64) -> f64 {
    if x < RISE {
        PEAK * x / RISE
    } else if x < HOLD {
        PEAK
    } else {
        PEAK + (LEFT - PEAK) * (x - HOLD) / (1.0 - HOLD)
    }
}

/// The integral of [`arriving`] from 0.
fn integral(x: f64) -> f64 {
    let rise = 0.5 * PEAK * x.min(RISE).powi(2) / RISE;
    let hold = PEAK * (x - RISE).max(0.0);
    let fall = 0.5 * (LEFT - PEAK) * (x - HOLD).max(0.0).powi(2) / (1.0 - HOLD);
    rise + hold + fall
}

/// What the interface does.
struct Jumps {
    /// Shear stress over pressure at the onset of slip, the stuck one.
    onset: f64,
    /// Slip speed over that of the balance while the stress holds: the mean with the weight sin^2
    /// against the mesh's ringing.
    speed: f64,
    /// Stuck shear stress over p when slip ends.
    arrest: f64,
    /// Steps with more than one solution.
    manifold: usize,
}

pub(crate) fn run(size: Size) -> Outcome {
    let cells = match size {
        Size::Quick => 200,
        Size::Full => 800,
    };
    let z = 0.5 * STEEL.density * STEEL.c_s();
    let r = PRESSURE * LAW.decay * (LAW.mu_static - LAW.mu_dynamic) / z;
    let fall = LAW.mu_static - LAW.mu_dynamic;
    let least = LAW.mu_dynamic + fall * (1.0 + r.ln()) / r;
    let found = shear(cells, z)?;
    Ok(vec![
        Row::new(
            "stress over p at which slip begins",
            [LAW.mu_static, found.onset],
            LAW.mu_static,
            (0.01, "asked: 1 %"),
            SOURCE,
        ),
        Row::new(
            "speed after the jump (m/s at 1 GPa and k = 6 s/m)",
            [14.19, 14.19 * found.speed],
            14.19,
            (0.01, "asked: 1 %"),
            SOURCE,
        ),
        Row::new(
            "stress over p at which slip ends",
            [least, found.arrest],
            least,
            (0.003, "asked: 0.3 %"),
            SOURCE,
        ),
        Row::new(
            "whether steps with three solutions were counted",
            [1.0, f64::from(u8::from(found.manifold > 0))],
            1.0,
            (0.0, "exact"),
            SOURCE,
        ),
    ])
}

fn shear(cells: usize, z: f64) -> Result<Jumps, Cause> {
    let h = LENGTH / cells as f64;
    let width = FLAT * h;
    let upper = mesh::block([1, 1, cells], [width, width, LENGTH]);
    let mut lower = upper.clone();
    lower.nodes.iter_mut().for_each(|x| x[2] -= LENGTH);
    let mesh = mesh::join(&[upper, lower]);
    let mut setup = at_rest(&mesh, STEEL, 0.67, None)?;

    // a little damping, or the mesh's ringing after the jump ends slip early: with falling friction
    // nothing else damps the interface
    let viscosity = Viscosity { kelvin_voigt: 0.2 * setup.dt, ..Viscosity::default() };
    let element = Element { hourglass: 0.05 };
    setup.solid = Solid::new(&mesh, &[STEEL; 2], element, viscosity, Level::detect())?;

    let at_interface = |x: [f64; 3]| x[2].abs() < 0.5 * h;
    let oedometer =
        STEEL.young * (1.0 - STEEL.poisson) / ((1.0 + STEEL.poisson) * (1.0 - 2.0 * STEEL.poisson));
    let approach = PRESSURE * h / oedometer;
    let (c, shear) = (STEEL.c_s(), STEEL.shear());
    for (body, side) in [(0, 1.0), (1, -1.0)] {
        for n in mesh.bodies[body].nodes.clone() {
            let x = mesh.nodes[n];
            let inside = at_interface(x);
            setup.fixed.push(Fixed { node: n as u32, axes: [true, false, !inside] });
            let down = if inside { 0.0 } else { -side * approach };
            // Half the stuck stress arrives from either side: tau = G u', v = c u' towards z = 0.
            let depth = x[2].abs() / LENGTH;
            let moved = 0.5 * PRESSURE / shear * LENGTH * integral(depth);
            setup.displacement[n] = Padded::new([0.0, side * moved, down]);
            // half a step before t = 0 the wave was c dt/2 farther out
            let before = (depth - 0.5 * c * setup.dt / LENGTH).max(0.0);
            let speed = 0.5 * PRESSURE / shear * c * arriving(before);
            setup.velocity[n] = Padded::new([0.0, side * speed, 0.0]);
        }
    }
    let material = contact_material(&STEEL);
    let surfaces = [&mesh.bodies[0].surfaces["z-"], &mesh.bodies[1].surfaces["z+"]];
    let settings = ExactSettings { slave: Some(0), ..ExactSettings::default() };
    let contact = ExactContact::new(
        &mesh,
        surfaces.map(|s| (s, material)),
        &settings,
        Box::new(Implicit(LAW)),
    )?;
    setup.contact = Some(Box::new(contact));

    let mut simulation = Simulation::new(setup);
    let mut jumps = Jumps { onset: f64::NAN, speed: f64::NAN, arrest: f64::NAN, manifold: 0 };
    let mut table = match simulation.contact() {
        Some(contact) => contact.nodal_table(0),
        None => return Err("no contact".into()),
    };
    let mut slipped = false;
    let (mut weighted, mut weights) = (0.0, 0.0);
    while simulation.time() < 0.99 * LENGTH / c {
        let report = simulation.step(false);
        if let Some(contact) = simulation.contact() {
            contact.nodal(&mut table);
        }
        jumps.manifold += report.contact.manifold;
        let stuck = arriving(c * report.time / LENGTH);
        let slips = table.state.contains(&2);
        if slips && !slipped {
            jumps.onset = stuck;
        }
        if slipped && !slips {
            jumps.arrest = stuck;
            break;
        }
        slipped |= slips;
        let phase = (c * report.time / LENGTH - RISE) / (HOLD - RISE);
        if (0.0..1.0).contains(&phase) {
            let weight = (std::f64::consts::PI * phase).sin().powi(2);
            let speeds = table.slip_velocity.iter().map(|s| s[1].abs());
            weighted += weight * speeds.sum::<f64>() / table.slip_velocity.len() as f64;
            weights += weight;
        }
    }
    jumps.speed = weighted / weights / balance(PEAK, z);
    Ok(jumps)
}

/// The fastest solution of `stress p - Z s = mu(s) p` (m/s).
fn balance(stress: f64, z: f64) -> f64 {
    let mut s = PRESSURE / z * stress;
    for _ in 0..100 {
        let excess = s + PRESSURE / z * (LAW.mu(s) - stress);
        s -= excess / (1.0 + PRESSURE / z * LAW.slope(s));
    }
    s
}
