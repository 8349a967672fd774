//! What a quiet end sends back.
//!
//! Lysmer and Kuhlemeyer (1969), J. Eng. Mech. Div. ASCE 95: 859–877: a dashpot rho c_p per area
//! absorbs a plane P wave at normal incidence entirely. On a mesh the lumped end node is half a
//! layer of mass ahead of the dashpot, and the reflection falls with (k h)^2. A Gaussian pulse
//! (waves.rs) runs to the end x+ of the column; when all of it has arrived, the largest velocity left
//! is compared with the pulse's, and the energy left with its energy.
//!
//! *nu = 0*: free sides, the bar speed is c_p. *nu = 0.3*: sides on rollers. *Bar*: free sides and
//! nu = 0.3: the bar wave runs at sqrt(E/rho) and meets the dashpot rho c_p A of the confined wave, so
//! that by theory R = (c_p - c)/(c_p + c) of its amplitude comes back: quiet ends are quiet for P
//! waves only.
//!
//! The ladder asks 1 % of a quiet end, hence 1e-4 of the energy; where the mesh study shows less, less is the limit.
//! The amplitude falls with h^2, the energy with h^4.

use crate::body::STEEL;
use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use crate::waves::{bar_setup, set_off_pulse, slender};
use dynamics::{QuietEnd, Simulation};
use mesh::Padded;
use solid::Material;

const LENGTH: f64 = 0.2;
const WIDTH: f64 = 0.075 * LENGTH;

/// Amplitude and energy that are asked of a quiet end, and their order.
const ASKED: [(&str, f64, f64); 2] = [("amplitude", 1e-2, 2.0), ("energy", 1e-4, 4.0)];
const SOURCE: &str = "Lysmer and Kuhlemeyer (1969)";

pub(crate) fn run(size: Size) -> Outcome {
    let cells: &[usize] = match size {
        Size::Quick => &[50, 100],
        Size::Full => &[100, 200, 400],
    };
    let mut rows = Vec::new();
    for (what, poisson, confined) in [("nu = 0", 0.0, false), ("nu = 0.3, confined", 0.3, true)] {
        let material = Material { poisson, ..STEEL };
        let meshes = reflections(cells, material, confined, material.c_p())?;
        for (k, (name, asked, order)) in ASKED.into_iter().enumerate() {
            let study = Convergence::new(meshes.iter().map(|(h, r)| (*h, r[k])), order);
            let quantity = format!("{what}: {name} sent back over the pulse's");
            let from = study.explain();
            let limit = (study.uncertainty(), from.as_str());
            let row = Row::new(quantity, [0.0, study.finest()], 1.0, limit, SOURCE).at_most(asked);
            rows.push(Row { meshes: study.samples().to_vec(), order: study.order(), ..row });
        }
    }
    let c = (STEEL.young / STEEL.density).sqrt();
    let exact = (STEEL.c_p() - c) / (STEEL.c_p() + c);
    let meshes = reflections(cells, STEEL, false, c)?;
    rows.push(Row::converged(
        "bar wave at nu = 0.3: root of the energy sent back over the pulse's",
        exact,
        &Convergence::new(meshes.iter().map(|(h, r)| (*h, r[1].sqrt())), 2.0),
        (0.0, ""),
        "(c_p - c)/(c_p + c): the dashpot of the confined wave at the end of a bar",
    ));
    Ok(rows)
}

/// Amplitude and energy that come back, over those of the pulse, by mesh size.
fn reflections(
    cells: &[usize],
    material: Material,
    confined: bool,
    c: f64,
) -> Result<Vec<(f64, [f64; 2])>, Cause> {
    let one = |&n: &usize| Ok((LENGTH / n as f64, reflection(n, material, confined, c)?));
    cells.iter().map(one).collect()
}

fn reflection(n: usize, material: Material, confined: bool, c: f64) -> Result<[f64; 2], Cause> {
    let mesh = slender(n, LENGTH);
    let mut setup = bar_setup(&mesh, material, confined)?;
    setup.system.quiet = QuietEnd::new(&mesh, &[&mesh.bodies[0].surfaces["x+"]], &material, &[]);
    let contraction = if confined { 0.0 } else { material.poisson };
    set_off_pulse(&mut setup, &mesh.nodes, c, [0.5 * LENGTH, WIDTH], contraction);
    let fastest = |v: &[Padded]| v.iter().map(|v| v.0[0].abs()).fold(0.0, f64::max);
    let pulse = fastest(&setup.velocity);
    let mut simulation = Simulation::new(setup);
    let energy = |simulation: &mut Simulation| {
        let energies = simulation.step(true).energies.unwrap_or_default();
        energies.kinetic + energies.internal + energies.hourglass
    };
    let start = energy(&mut simulation);
    // the pulse has left the end by six of its widths
    while simulation.time() < LENGTH / c {
        simulation.step(false);
    }
    let left = fastest(simulation.velocity());
    let end = energy(&mut simulation);
    Ok([left / pulse, end / start])
}
