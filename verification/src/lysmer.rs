//! The reflection of a wave at a quiet end.
//!
//! Lysmer and Kuhlemeyer (1969), J. Eng. Mech. Div. ASCE 95: 859–877: a dashpot rho c_p per area
//! absorbs a plane P wave at normal incidence entirely. On a mesh the lumped mass of the end node, half a
//! layer, is in front of the dashpot, and the reflection falls with (k h)^2. A Gaussian pulse
//! (waves.rs) runs to the end x+ of the column. When all of it has arrived, the largest velocity that is left
//! is compared with that of the pulse, and the energy that is left with its energy.
//!
//! *nu = 0*: free sides, the bar speed is c_p. *nu = 0.3*: sides on rollers. *Bar*: free sides and
//! nu = 0.3. The bar wave runs at c = sqrt(E/rho) and meets the dashpot rho c_p A of the confined wave, so
//! that in theory R = (c_p - c)/(c_p + c) of its amplitude is reflected: quiet ends absorb P waves only.
//!
//! A quiet end must reflect less than 1 % of the amplitude, hence 1e-4 of the energy; where the mesh study gives a
//! smaller uncertainty, that is the limit. The amplitude falls with h^2, the energy with h^4.

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

/// Largest reflected amplitude and energy that pass, as shares of the pulse's, and their orders of convergence.
const REQUIRED: [(&str, f64, f64); 2] = [("amplitude", 1e-2, 2.0), ("energy", 1e-4, 4.0)];
const SOURCE: &str = "Lysmer and Kuhlemeyer (1969)";

pub(crate) fn run(_: Size) -> Outcome {
    // a third of a second; on coarser meshes the pulse is five elements wide
    let cells = &[100, 200, 400];
    let mut rows = Vec::new();
    for (what, poisson, confined) in [("nu = 0", 0.0, false), ("nu = 0.3, confined", 0.3, true)] {
        let material = Material { poisson, ..STEEL };
        let meshes = reflections(cells, material, confined, material.c_p())?;
        for (k, (name, required, order)) in REQUIRED.into_iter().enumerate() {
            let study = Convergence::new(meshes.iter().map(|(h, r)| (*h, r[k])), order);
            let quantity = format!("{what}: {name} sent back over the pulse's");
            let from = study.explain();
            let limit = (study.uncertainty(), from.as_str());
            let row =
                Row::new(quantity, [0.0, study.finest()], 1.0, limit, SOURCE).at_most(required);
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

/// Reflected amplitude and energy over those of the pulse, with the mesh size (m).
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
    // by then the reflection of the pulse's middle would be more than six of its widths away from the end
    while simulation.time() < LENGTH / c {
        simulation.step(false);
    }
    let left = fastest(simulation.velocity());
    let end = energy(&mut simulation);
    Ok([left / pulse, end / start])
}
