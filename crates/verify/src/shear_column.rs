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
//! The columns bear a thousandth of that pressure with k a thousand times as large: the same R with
//! strains that stay linear, and all speeds are a thousandth.
//!
//! The columns are one element wide. All nodes are fixed across the plane of shear and, but for those
//! of the interface, along the normal, as the supports of a one-dimensional motion; elements are
//! flat, so that the couple of the complementary shear changes the pressure by a fraction of a per mille only, and
//! their Poisson's ratio is zero, or pressure would push the free sides apart and fall.
//! The elements have Kelvin–Voigt damping of 0.2 time steps: the mesh rings after the jump, and falling
//! friction does not damp that. What moves is the node's y. Incoming waves are given as the initial state, displacement and
//! velocity of `u = f(z + c t)`.

use crate::body::{SHEARED, at_rest, contact_material};
use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use contact::{
    ExactContact, ExactSettings, Exponential, FrictionLaw, Implicit, Lagged, PenaltyContact,
    PenaltySettings, Stiffness,
};
use dynamics::{Fixed, Setup, Simulation};
use mesh::Padded;
use solid::{Element, Level, Solid, Viscosity};

/// A thousandth of steel at 1 GPa.
pub(crate) const PRESSURE: f64 = 1e6;
pub(crate) const LAW: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6000.0 };
/// Length of each column (m) and its width over the element's height.
pub(crate) const LENGTH: f64 = 0.4;
const FLAT: f64 = 5000.0;
/// The stress that arrives rises to `PEAK` p over the share `RISE` of the column, stays there up to
/// the share `HOLD`, and falls to `LEFT` p over the rest.
pub(crate) const PEAK: f64 = 0.502;
const LEFT: f64 = 0.31;
pub(crate) const RISE: f64 = 0.15;
pub(crate) const HOLD: f64 = 0.45;

const SOURCE: &str = "tau - Z s = mu(s) p with perfect delay (Ionescu and Paumier 1994)";

/// Stress over p that the stuck interface bears when the part of the waves at the share `x` of the
/// columns has arrived.
pub(crate) fn arriving(x: f64) -> f64 {
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
    let meshes: &[usize] = match size {
        Size::Quick => &[400],
        Size::Full => &[200, 400, 800, 1600],
    };
    let found = meshes.iter().map(|&n| shear(n)).collect::<Result<Vec<Jumps>, Cause>>()?;
    let row = |what: &str, exact: f64, limit: (f64, &str), of: fn(&Jumps) -> f64| {
        let size = |&n: &usize| LENGTH / n as f64;
        let study = Convergence::new(meshes.iter().map(size).zip(found.iter().map(of)), 1.0);
        let row = Row::new(what, [exact, study.finest()], exact, limit, SOURCE);
        Row { meshes: study.samples().to_vec(), order: study.order(), ..row }
    };
    let counted = found.iter().all(|jumps| jumps.manifold > 0);
    Ok(vec![
        row("stress over p at which slip begins", LAW.mu_static, (0.01, "asked: 1 %"), |j| j.onset),
        row(
            "speed after the jump (m/s at 1 GPa and k = 6 s/m)",
            14.19,
            (0.01, "asked: 1 %"),
            |j| 14.19 * j.speed,
        ),
        row("stress over p at which slip ends", least(), (0.003, "asked: 0.3 %"), |j| j.arrest),
        Row::new(
            "whether steps with three solutions were counted",
            [1.0, f64::from(u8::from(counted))],
            1.0,
            (0.0, "exact"),
            SOURCE,
        ),
    ])
}

/// The impedance `Z = rho c_s/2` (Pa s/m).
pub(crate) fn impedance() -> f64 {
    0.5 * SHEARED.density * SHEARED.c_s()
}

/// The least stress over p at which slip can go on.
pub(crate) fn least() -> f64 {
    let fall = LAW.mu_static - LAW.mu_dynamic;
    let r = PRESSURE * LAW.decay * fall / impedance();
    LAW.mu_dynamic + fall * (1.0 + r.ln()) / r
}

/// How the interface is enforced, and how finely.
#[derive(Clone, Copy)]
pub(crate) enum Interface {
    /// Exactly, at the time step of the columns.
    Exact,
    /// By springs of the areal stiffness `k` (N/m^3, normal and tangential) and friction of the step before, at a
    /// time step smaller than the stable one by `finer`.
    Penalty { k: f64, finer: f64 },
}

/// The columns before the waves arrive.
pub(crate) fn columns(cells: usize, interface: Interface) -> Result<Setup, Cause> {
    let h = LENGTH / cells as f64;
    let width = FLAT * h;
    let upper = mesh::block([1, 1, cells], [width, width, LENGTH]);
    let mut lower = upper.clone();
    lower.nodes.iter_mut().for_each(|x| x[2] -= LENGTH);
    let mesh = mesh::join(&[upper, lower]);
    let material = contact_material(&SHEARED);
    let surfaces = [&mesh.bodies[0].surfaces["z-"], &mesh.bodies[1].surfaces["z+"]];
    let surfaces = surfaces.map(|s| (s, material));

    let (mut setup, penetration) = match interface {
        Interface::Exact => {
            let settings = ExactSettings { slave: Some(0), ..ExactSettings::default() };
            let contact = ExactContact::new(&mesh, surfaces, &settings, Box::new(Implicit(LAW)))?;
            let setup = at_rest(&mesh, SHEARED, 0.67, None)?;
            (Setup { contact: Some(Box::new(contact)), ..setup }, 0.0)
        }
        Interface::Penalty { k, finer } => {
            let settings = PenaltySettings {
                normal: Stiffness::Areal(k),
                tangential: Stiffness::Areal(k),
                damping: 0.1,
                curvature: false,
            };
            let law = Box::new(Lagged(LAW));
            let contact = PenaltyContact::new(&mesh, surfaces, &settings, None, law)?;
            let setup = at_rest(&mesh, SHEARED, 0.67 / finer, Some(&contact))?;
            (Setup { contact: Some(Box::new(contact)), ..setup }, PRESSURE / k)
        }
    };

    // a little damping, or the mesh's ringing after the jump ends slip early: with falling friction
    // nothing else damps the interface
    let step = match interface {
        Interface::Exact => setup.dt,
        Interface::Penalty { finer, .. } => finer * setup.dt,
    };
    let viscosity = Viscosity { kelvin_voigt: 0.2 * step, ..Viscosity::default() };
    let element = Element { hourglass: 0.05 };
    setup.solid = Solid::new(&mesh, &[SHEARED; 2], element, viscosity, Level::detect())?;

    let at_interface = |x: [f64; 3]| x[2].abs() < 0.5 * h;
    let approach = PRESSURE * h / SHEARED.young;
    let (c, shear) = (SHEARED.c_s(), SHEARED.shear());
    for (body, side) in [(0, 1.0), (1, -1.0)] {
        for n in mesh.bodies[body].nodes.clone() {
            let x = mesh.nodes[n];
            let inside = at_interface(x);
            setup.fixed.push(Fixed { node: n as u32, axes: [true, false, !inside] });
            let down = if inside { 0.0 } else { -side * approach } - 0.5 * side * penetration;
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
    Ok(setup)
}

fn shear(cells: usize) -> Result<Jumps, Cause> {
    let c = SHEARED.c_s();
    let setup = columns(cells, Interface::Exact)?;
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
    jumps.speed = weighted / weights / balance(PEAK);
    Ok(jumps)
}

/// The fastest solution of `stress p - Z s = mu(s) p` (m/s).
pub(crate) fn balance(stress: f64) -> f64 {
    let z = impedance();
    let mut s = PRESSURE / z * stress;
    for _ in 0..100 {
        let excess = s + PRESSURE / z * (LAW.mu(s) - stress);
        s -= excess / (1.0 + PRESSURE / z * LAW.slope(s));
    }
    s
}
