//! Falling friction, Eq. (8) of Vollebregt (2017), between two half-spaces sheared in one dimension.
//!
//! Two columns of hexahedra are pressed together at p and sheared by waves that arrive from both
//! sides. With tau the shear stress that a sticking interface would bear, the balance at the interface
//! is `tau - Z s = mu(s) p`, `Z = rho c_s/2` (Andrews 1985; Ionescu and Paumier 1994). For
//! `R = p k (mu_S - mu_D)/Z > 1` it has three solutions between
//! `f_min = mu_D + (mu_S - mu_D)(1 + ln R)/R` and mu_S in units of p. With perfect delay the interface
//! sticks until tau = mu_S p, jumps to the solution in slip, and sticks again at tau = f_min p.
//!
//! Steel at 1 GPa with k = 6 s/m has R = 85.78, the speed 14.297 m/s after the jump, and f_min = 0.3314.
//! The columns bear a thousandth of that pressure with k a thousand times as large: the same R with
//! strains that stay linear, and all speeds are a thousandth.
//!
//! The stress that arrives rises slowly from below mu_S p to 0.51 p, so that an early or late onset is resolved. It
//! comes back to mu_S p, where the slip speed is that of the jump, since perfect delay keeps the
//! interface in slip. Then it falls slowly until slip ends.
//!
//! The columns are one element wide. Motion is along y. All nodes are fixed along x and, except those
//! of the interface, along z, as supports of a one-dimensional motion. Elements are
//! flat, so that the couple of the complementary shear changes the pressure by a fraction of a per mille only.
//! Poisson's ratio is zero, since pressure would push the free sides apart and fall.
//! The elements have Kelvin–Voigt damping of 0.2 time steps: the mesh rings after the jump, and falling
//! friction does not damp that. Incoming waves are given as the initial displacement and velocity of
//! `u = f(z + c t)`.

use crate::body::{SHEARED, at_rest, contact_material};
use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use contact::{ExactContact, ExactSettings, Normals, PenaltyContact, PenaltySettings, Stiffness};
use dynamics::{Fixed, Setup, Simulation};
use friction::{Exponential, FrictionLaw, Implicit, Lagged, NodeFriction};
use mesh::Padded;
use nalgebra::Vector3;
use solid::{Element, Level, Solid, Viscosity};

/// Pressure and speeds of the model over those at 1 GPa.
pub(crate) const SCALE: f64 = 1e-3;
pub(crate) const PRESSURE: f64 = 1e9 * SCALE;
pub(crate) const LAW: Exponential =
    Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 / SCALE };
/// Length of each column (m), and width over height of the elements.
pub(crate) const LENGTH: f64 = 0.4;
const FLAT: f64 = 5000.0;
/// The tolerance of implicit steps.
const SOLVED: (f64, &str) = (1e-8, "tolerance of implicit steps");
/// The tolerance of the sweeps of exact contact.
const SWEPT: (f64, &str) = (1e-12, "tolerance of the sweeps");

const SOURCE: &str = "tau - Z s = mu(s) p with perfect delay (Ionescu and Paumier 1994)";

/// The shear stress over p of a sticking interface as a broken line of the share of the columns' length from which the
/// waves have arrived: share and stress at its corners.
#[derive(Clone, Copy)]
pub(crate) struct Waves(pub(crate) &'static [[f64; 2]]);

/// Slowly through mu_S, back to it, held there, and slowly down.
const HUMP: Waves = Waves(&[
    [0.0, 0.0],
    [0.12, 0.49],
    [0.28, 0.51],
    [HELD[0], LAW.mu_static],
    [HELD[1], LAW.mu_static],
    [1.0, 0.31],
]);
/// Shares between which mu_S is held.
const HELD: [f64; 2] = [0.32, 0.60];

impl Waves {
    pub(crate) fn stress(self, x: f64) -> f64 {
        let line = self.0.windows(2).find(|line| x < line[1][0]);
        line.map_or_else(|| self.0[self.0.len() - 1][1], |line| between(line, x))
    }

    /// The integral of [`Waves::stress`] from 0.
    fn integral(self, x: f64) -> f64 {
        let lines = self.0.windows(2).take_while(|line| line[0][0] < x);
        lines
            .map(|line| {
                let end = x.min(line[1][0]);
                0.5 * (line[0][1] + between(line, end)) * (end - line[0][0])
            })
            .sum()
    }
}

/// The value at x on the straight line through two corners.
fn between(line: &[[f64; 2]], x: f64) -> f64 {
    let ([from, low], [to, high]) = (line[0], line[1]);
    low + (high - low) * (x - from) / (to - from)
}

/// The results of one mesh. "Stuck" stresses are those that a sticking interface would bear.
struct Jumps {
    /// Stuck shear stress over p at the onset of slip.
    onset: f64,
    /// Slip speed at mu_S p (m/s, as at 1 GPa): the mean with the weight sin^2, against the ringing of the mesh.
    speed: f64,
    /// Stuck shear stress over p when slip ends.
    arrest: f64,
    /// Change of the stuck shear stress over p in a time step, at the onset and at the end.
    resolved: [f64; 2],
    /// Largest difference of the shear stress in slip from mu(s) p of the same step, over mu_S p.
    off_law: f64,
    /// Steps with more than one solution.
    non_unique: usize,
}

/// The problem with implicit steps as long as the explicit ones.
pub(crate) fn run_implicit(size: Size) -> Outcome {
    run_with(size, || Box::new(Implicit(LAW)), Some(0.5))
}

pub(crate) fn run(size: Size) -> Outcome {
    run_with(size, || Box::new(Implicit(LAW)), None)
}

/// The problem with friction of `law`, beside the closed form of [`LAW`].
pub(crate) fn run_with(
    size: Size,
    law: impl Fn() -> Box<dyn NodeFriction>,
    theta: Option<f64>,
) -> Outcome {
    let meshes: &[usize] = match size {
        Size::Quick => &[200, 400, 800],
        Size::Full => &[200, 400, 800, 1600],
    };
    let found =
        meshes.iter().map(|&n| shear(n, law(), theta)).collect::<Result<Vec<Jumps>, Cause>>()?;
    let Some(finest) = found.last() else { return Err("no mesh".into()) };
    // ringing of the mesh scatters the values
    let row = |what: &str, exact: f64, model: (f64, &str), of: fn(&Jumps) -> f64| {
        let size = |&n: &usize| LENGTH / n as f64;
        let samples = meshes.iter().map(size).zip(found.iter().map(of));
        let study = Convergence::with_known_order(samples, 1.0);
        Row::converged(what, exact, &study, model, SOURCE)
    };
    let step = |k: usize, exact: f64| {
        (finest.resolved[k] / exact, "one time step, by which the stress changes")
    };
    let counted = found.iter().all(|jumps| jumps.non_unique > 0);
    Ok(vec![
        row("stress over p at which slip begins", LAW.mu_static, step(0, LAW.mu_static), |j| {
            j.onset
        }),
        row(
            "speed after the jump (m/s at 1 GPa and k = 6 s/m)",
            speed_at_1_gpa(LAW.mu_static),
            (strain(LAW.mu_static), STRAIN),
            |j| j.speed,
        ),
        row("stress over p at which slip ends", least(), step(1, least()), |j| j.arrest)
            .at_most(0.003),
        Row::new(
            "shear of slip off mu(s) p of the same step, over mu_S p",
            [0.0, found.iter().fold(0.0, |most, j| most.max(j.off_law))],
            1.0,
            if theta.is_some() { SOLVED } else { SWEPT },
            "Eq (8) at the same instant",
        ),
        Row::new(
            "whether steps with three solutions were counted",
            [1.0, f64::from(u8::from(counted))],
            1.0,
            (0.0, "exact"),
            SOURCE,
        ),
    ])
}

/// Relative change of the slip speed by finite strain at a stress over p: pressure reduces the shear modulus G by p,
/// and so the stress tau by the share p/G; the slip speed is (tau - mu_D p)/Z.
pub(crate) fn strain(stress: f64) -> f64 {
    PRESSURE / SHEARED.shear() * stress / (stress - LAW.mu_dynamic)
}
pub(crate) const STRAIN: &str = "finite strain: pressure takes p/G off the shear stress";

/// The impedance `Z = rho c_s/2` (Pa s/m).
pub(crate) fn impedance() -> f64 {
    0.5 * SHEARED.density * SHEARED.c_s()
}

/// The least stress over p at which slip can go on.
pub(crate) fn least() -> f64 {
    let fall = LAW.mu_static - LAW.mu_dynamic;
    let r = PRESSURE * LAW.decay * fall / impedance();
    LAW.mu_dynamic + fall * (1.0 + libm::log(r)) / r
}

/// How the interface is enforced, and how finely.
pub(crate) enum Interface {
    /// Exactly, with this friction, at the time step of the columns.
    Exact(Box<dyn NodeFriction>),
    /// By springs of the areal stiffness `k` (N/m^3, normal and tangential) and friction of the step before, at a
    /// time step smaller than the stable one by `finer`.
    Penalty { k: f64, finer: f64 },
}

/// The nodes of each section of a column, which move as one: with R > 1 an implicit step has solutions besides, in which some of them
/// stick while others slip.
fn sections(reference: &[Padded]) -> Vec<[u32; 2]> {
    let half = reference.len() / 2;
    let alike = |a: usize, b: usize| a / half == b / half && reference[a][2] == reference[b][2];
    let first = |n: usize| (0..n).find(|&m| alike(m, n)).filter(|&m| m < n);
    let mut pairs: Vec<[u32; 2]> =
        (0..reference.len()).filter_map(|n| first(n).map(|m| [m as u32, n as u32])).collect();
    pairs.sort_unstable();
    pairs
}

/// The columns before the waves arrive.
pub(crate) fn columns(cells: usize, interface: Interface, waves: Waves) -> Result<Setup, Cause> {
    let h = LENGTH / cells as f64;
    let width = FLAT * h;
    let upper = mesh::block([1, 1, cells], [width, width, LENGTH]);
    let mut lower = upper.clone();
    lower.nodes.iter_mut().for_each(|x| x[2] -= LENGTH);
    let mesh = mesh::join(&[upper, lower]);
    let material = contact_material(&SHEARED);
    let surfaces = [&mesh.bodies[0].surfaces["z-"], &mesh.bodies[1].surfaces["z+"]];
    let surfaces = surfaces.map(|s| (s, material));

    // `step` is that of the columns alone
    let (mut setup, penetration, step) = match interface {
        Interface::Exact(law) => {
            let settings = ExactSettings { slave: Some(0), ..ExactSettings::default() };
            let contact = ExactContact::new(&mesh, surfaces, &settings, law)?;
            let mut setup = at_rest(&mesh, SHEARED, 0.67, None)?;
            let step = setup.dt;
            setup.system.contact = Some(contact.into());
            (setup, 0.0, step)
        }
        Interface::Penalty { k, finer } => {
            let settings = PenaltySettings {
                normal: Stiffness::Areal(k),
                tangential: Stiffness::Areal(k),
                damping: 0.1,
                curvature: false,
                normals: Normals::Averaged,
            };
            let law = Box::new(Lagged(LAW));
            let contact = PenaltyContact::new(&mesh, surfaces, &settings, None, law)?;
            let mut setup = at_rest(&mesh, SHEARED, 0.67 / finer, Some(&contact))?;
            let step = finer * setup.dt;
            setup.system.contact = Some(contact.into());
            (setup, PRESSURE / k, step)
        }
    };

    // without damping the ringing of the mesh after the jump would end slip early: falling friction does not damp it
    let viscosity = Viscosity { kelvin_voigt: 0.2 * step, ..Viscosity::default() };
    let element = Element { hourglass: 0.05 };
    setup.system.solid = Solid::new(&mesh, &[SHEARED; 2], element, viscosity, Level::detect())?;

    let at_interface = |x: Vector3<f64>| x.z.abs() < 0.5 * h;
    let approach = PRESSURE * h / SHEARED.young;
    let (c, shear) = (SHEARED.c_s(), SHEARED.shear());
    for (body, side) in [(0, 1.0), (1, -1.0)] {
        for n in mesh.bodies[body].nodes.clone() {
            let x = mesh.nodes[n];
            let inside = at_interface(x);
            setup.system.fixed.push(Fixed { node: n as u32, axes: [true, false, !inside] });
            let down = if inside { 0.0 } else { -side * approach } - 0.5 * side * penetration;
            // Half the stuck stress arrives from either side: tau = G u', v = c u' towards z = 0.
            let depth = x[2].abs() / LENGTH;
            let moved = 0.5 * PRESSURE / shear * LENGTH * waves.integral(depth);
            setup.displacement[n] = Padded::new([0.0, side * moved, down]);
            // half a step before t = 0 the wave was c dt/2 farther out
            let before = (depth - 0.5 * c * setup.dt / LENGTH).max(0.0);
            let speed = 0.5 * PRESSURE / shear * c * waves.stress(before);
            setup.velocity[n] = Padded::new([0.0, side * speed, 0.0]);
        }
    }
    Ok(setup)
}

fn shear(cells: usize, law: Box<dyn NodeFriction>, theta: Option<f64>) -> Result<Jumps, Cause> {
    let c = SHEARED.c_s();
    let mut setup = columns(cells, Interface::Exact(law), HUMP)?;
    if theta.is_some() {
        setup.system.paired = sections(setup.system.solid.reference());
    }
    let advance = c * setup.dt / LENGTH;
    let mut simulation = Simulation::new(setup);
    if let Some(theta) = theta {
        simulation.set_implicit(theta);
    }
    let mut jumps = Jumps {
        onset: f64::NAN,
        speed: f64::NAN,
        arrest: f64::NAN,
        resolved: [f64::NAN; 2],
        off_law: 0.0,
        non_unique: 0,
    };
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
        jumps.non_unique += report.contact.non_unique;
        let share = c * report.time / LENGTH;
        let stuck = HUMP.stress(share);
        let change = (HUMP.stress(share + advance) - stuck).abs();
        let slips = table.state.contains(&2);
        if slips && !slipped {
            (jumps.onset, jumps.resolved[0]) = (stuck, change);
        }
        if slipped && !slips {
            (jumps.arrest, jumps.resolved[1]) = (stuck, change);
            break;
        }
        slipped |= slips;
        for i in (0..table.state.len()).filter(|&i| table.state[i] == 2) {
            let (p, s) = (table.pressure[i], table.slip_velocity[i][1].abs());
            let off = (table.shear[i][1].abs() - LAW.mu(s) * p).abs() / (LAW.mu_static * p);
            jumps.off_law = jumps.off_law.max(off);
        }
        let phase = (share - HELD[0]) / (HELD[1] - HELD[0]);
        if (0.0..1.0).contains(&phase) {
            let weight = libm::sin(std::f64::consts::PI * phase).powi(2);
            let speeds = table.slip_velocity.iter().map(|s| s[1].abs());
            weighted += weight * speeds.sum::<f64>() / table.slip_velocity.len() as f64;
            weights += weight;
        }
    }
    jumps.speed = weighted / weights / SCALE;
    Ok(jumps)
}

/// The fastest solution of `stress p - Z s = mu(s) p` (m/s), as at 1 GPa.
pub(crate) fn speed_at_1_gpa(stress: f64) -> f64 {
    let z = impedance();
    let mut s = PRESSURE / z * stress;
    for _ in 0..100 {
        let excess = s + PRESSURE / z * (LAW.mu(s) - stress);
        s -= excess / (1.0 + PRESSURE / z * LAW.slope(s));
    }
    s / SCALE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_the_static_bound_steel_jumps_to_14_297_metres_per_second_and_slip_ends_at_0_3314() {
        let r = PRESSURE * LAW.decay * (LAW.mu_static - LAW.mu_dynamic) / impedance();
        assert!((r - 85.78).abs() < 5e-3, "{r}");
        assert!((speed_at_1_gpa(0.5) - 14.297).abs() < 5e-4, "{}", speed_at_1_gpa(0.5));
        assert!((speed_at_1_gpa(0.502) - 14.456).abs() < 5e-4, "{}", speed_at_1_gpa(0.502));
        assert!((least() - 0.3314).abs() < 5e-5, "{}", least());
    }

    #[test]
    fn the_displacement_of_the_waves_is_the_integral_of_their_stress() {
        for x in [0.0, 0.05, 0.12, 0.2, 0.29, 0.5, 0.61, 0.99] {
            let slope = (HUMP.integral(x + 1e-7) - HUMP.integral(x)) / 1e-7;
            assert!((slope - HUMP.stress(x + 0.5e-7)).abs() < 1e-7, "{x}: {slope}");
        }
    }
}
