//! Two equal bars that collide.
//!
//! Two bars of length L fly at each other, each at v, and touch at t = 0. Compression fronts run
//! away from the interface at c; behind them the material is at rest under p = rho c v. They come
//! back from the free ends as release, and the bars part at t = 2L/c with their velocities
//! exchanged: pressure, duration and velocities are those of Saint-Venant's one-dimensional impact
//! (Goldsmith 1960, "Impact", Ch. III; Johnson 1985, "Contact mechanics", Sec. 11.1).
//!
//! The bars are one element thick with nu = 0. The vibration of the mesh that is left when the bars part
//! falls with the mesh size, and the contact springs, whose areal stiffness is K/h per pass,
//! are as stiff as one element: one mesh study covers both. A front in a lattice of pitch h is
//! (h^2 L)^(1/3) wide after the distance L (Airy's front; Skalak 1957, J. Appl. Mech. 24: 59–64, for the inertia of
//! the section), so that errors fall as h^(2/3). They scatter about that, since the phase of the ringing at which the
//! bars part changes from mesh to mesh.
//!
//! Energy is conserved except in the steps in which the contact springs k close and open. In a step that brings the
//! gap from a > 0 to -g the trapezoidal work is k g (g + a)/2 and the energy
//! stored k g^2/2; the difference is at most k (g + a)^2/8.
//!
//! Exact contact has no springs. The masses of the two end faces lose the energy of their own impact,
//! which falls with the mesh size.
//!
//! The contact time is twice the mean time of the force, 2 int F t dt/int F dt, which is its length
//! for a constant force; the pressure is the mean over the middle half of 2L/c with the weight sin^2
//! against the mesh's ringing.

use crate::body::{STEEL, at_rest, contact_material, momentum};
use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use crate::waves::slender;
use contact::{ExactContact, ExactSettings, Normals, PenaltyContact, PenaltySettings, Stiffness};
use dynamics::Simulation;
use friction::Coulomb;
use mesh::Padded;
use solid::Material;

const LENGTH: f64 = 0.1;
const MATERIAL: Material = Material { poisson: 0.0, ..STEEL };
/// Strains near 1e-10: finite strain plays no part.
const SPEED: f64 = 1e-6;
const SOURCE: &str = "Saint-Venant's impact of bars, Goldsmith (1960)";

/// How contact is enforced and time is stepped.
#[derive(Clone, Copy, PartialEq)]
enum Method {
    Penalty,
    Exact,
    /// Exact contact with implicit steps of this theta, so many times as long as the explicit ones.
    Implicit {
        theta: f64,
        longer: f64,
    },
}

/// The tolerance of implicit steps.
const IMPLICIT: f64 = 1e-8;

/// The results of one mesh.
struct Collision {
    /// Contact time (s).
    duration: f64,
    /// Mean pressure (Pa).
    pressure: f64,
    /// Kinetic energy after over before.
    kinetic: f64,
    /// Mean velocity of the first bar after (m/s).
    rebound: f64,
    /// Change of momentum over that of one bar.
    momentum: f64,
    /// Largest imbalance of energy over the energy exchanged.
    balance: f64,
    /// Limit of `balance`.
    crossing: f64,
    steps: usize,
    /// Work that contact supplied in a step, the most, over the kinetic energy.
    supplied: f64,
}

pub(crate) fn run(size: Size) -> Outcome {
    study(size, Method::Penalty)
}

pub(crate) fn run_exact(size: Size) -> Outcome {
    study(size, Method::Exact)
}

/// Exact contact and implicit steps four times as long as the longest stable one.
pub(crate) fn run_implicit(size: Size) -> Outcome {
    study(size, Method::Implicit { theta: 0.5, longer: 4.0 })
}

fn study(size: Size, method: Method) -> Outcome {
    let exact = method != Method::Penalty;
    let cells: &[usize] = match size {
        Size::Quick => &[25, 100, 400],
        Size::Full => &[25, 100, 400, 1600],
    };
    let c = (MATERIAL.young / MATERIAL.density).sqrt();
    let meshes = cells.iter().map(|&n| Ok((LENGTH / n as f64, collide(n, c, method)?)));
    let meshes: Vec<(f64, Collision)> = meshes.collect::<Result<_, Cause>>()?;
    // the effect of finite strain; only exact contact is accurate enough to show it
    let strain = if exact { SPEED / c } else { 0.0 };
    let row = |quantity: &str, reference: f64, value: fn(&Collision) -> f64| {
        let values = meshes.iter().map(|(h, m)| (*h, value(m)));
        let study = Convergence::with_known_order(values, 2.0 / 3.0);
        Row::converged(quantity, reference, &study, (strain, "the strain v/c"), SOURCE)
    };
    let mut rows = vec![
        row("contact time (s), 2L/c", 2.0 * LENGTH / c, |m| m.duration),
        row("pressure (Pa), rho c v", MATERIAL.density * c * SPEED, |m| m.pressure),
        row("kinetic energy after over before", 1.0, |m| m.kinetic),
        row("velocity of the first bar after (m/s)", -SPEED, |m| m.rebound),
    ];
    let Some((_, finest)) = meshes.last() else { return Ok(rows) };
    rows.push(Row::new(
        "change of momentum over that of one bar",
        [0.0, finest.momentum],
        1.0,
        (finest.steps as f64 * f64::EPSILON, "one rounding of every velocity per step"),
        "conservation of momentum",
    ));
    if let Method::Implicit { .. } = method {
        rows.push(Row::new(
            "work that contact supplied in a step over the energy",
            [0.0, finest.supplied],
            1.0,
            (IMPLICIT, "the tolerance of implicit steps"),
            "g >= 0 at both ends of a step",
        ));
    }
    if exact {
        return Ok(rows);
    }
    rows.push(Row::new(
        "energy that nothing supplied over the energy exchanged",
        [0.0, finest.balance],
        1.0,
        (finest.crossing, "k (2 v dt)^2/8 at the closing and at the opening (module text)"),
        "conservation of energy",
    ));
    Ok(rows)
}

fn collide(n: usize, c: f64, method: Method) -> Result<Collision, Cause> {
    let left = slender(n, LENGTH);
    let mut right = left.clone();
    right.nodes.iter_mut().for_each(|x| x[0] += LENGTH);
    let mesh = mesh::join(&[left, right]);
    let h = LENGTH / n as f64;
    let settings = PenaltySettings {
        normal: Stiffness::Factor(1.0),
        tangential: Stiffness::Factor(1.0),
        damping: 0.0,
        curvature: false,
        normals: Normals::Averaged,
    };
    let material = contact_material(&MATERIAL);
    let surfaces = [&mesh.bodies[0].surfaces["x+"], &mesh.bodies[1].surfaces["x-"]];
    let contact = PenaltyContact::new(
        &mesh,
        surfaces.map(|s| (s, material)),
        &settings,
        None,
        Box::new(Coulomb { mu: 0.0 }),
    )?;
    let mut setup = at_rest(&mesh, MATERIAL, 0.8, Some(&contact))?;
    let [first, second] = [0, 1].map(|b: usize| mesh.bodies[b].nodes.clone());
    setup.velocity[first.clone()].fill(Padded::new([SPEED, 0.0, 0.0]));
    setup.velocity[second].fill(Padded::new([-SPEED, 0.0, 0.0]));
    setup.system.contact = Some(if method != Method::Penalty {
        let settings = ExactSettings { slave: Some(0), ..ExactSettings::default() };
        let law = Box::new(Coulomb { mu: 0.0 });
        ExactContact::new(&mesh, surfaces.map(|s| (s, material)), &settings, law)?.into()
    } else {
        contact.into()
    });
    let masses = setup.system.mass.clone();
    let bar: f64 = masses[first.clone()].iter().sum();
    if let Method::Implicit { longer, .. } = method {
        setup.dt *= longer;
    }
    let dt = setup.dt;
    let before = momentum(&masses, &setup.velocity, 0..masses.len());
    let time = 2.0 * LENGTH / c;

    let mut simulation = Simulation::new(setup);
    if let Method::Implicit { theta, .. } = method {
        simulation.set_implicit(theta);
    }
    let (mut supplied, mut taken) = (0.0_f64, 0.0);
    let (mut impulse, mut moment, mut weighted, mut weights) = (0.0, 0.0, 0.0, 0.0);
    let mut kinetic = [None, None];
    while simulation.time() < 1.5 * time {
        let report = simulation.step(true);
        if report.unsolved.is_some() {
            return Err("a step was not solved".into());
        }
        let now = simulation.ledger().contact_damping;
        supplied = supplied.max(taken - now);
        taken = now;
        let force = report.contact.force[1][0];
        impulse += force;
        moment += force * report.time;
        let phase = (report.time / time - 0.25) / 0.5;
        if (0.0..1.0).contains(&phase) {
            let weight = libm::sin(std::f64::consts::PI * phase).powi(2);
            weighted += weight * force;
            weights += weight;
        }
        if let Some(energies) = report.energies {
            kinetic[0].get_or_insert(energies.kinetic);
            kinetic[1] = Some(energies.kinetic);
        }
    }
    let after = momentum(&masses, simulation.velocity(), 0..masses.len());
    let rebound = momentum(&masses, simulation.velocity(), first)[0] / bar;
    let [start, end] = kinetic.map(|k| k.unwrap_or(f64::NAN));
    Ok(Collision {
        duration: 2.0 * moment / impulse,
        pressure: weighted / weights / (h * h),
        kinetic: end / start,
        rebound,
        momentum: (after[0] - before[0]).abs() / (bar * SPEED),
        balance: simulation.ledger().balance_error(),
        // 2 k (2 v dt)^2/8 with k = 2 K A/h over rho A L v^2
        crossing: 2.0 * MATERIAL.bulk() * dt * dt / (h * MATERIAL.density * LENGTH),
        steps: simulation.steps(),
        supplied: supplied / start,
    })
}
