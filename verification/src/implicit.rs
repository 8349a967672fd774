//! Order in time of implicit steps, and the energy of a wave.
//!
//! A pulse in a bar and a block that slides under friction are computed with steps of 1, 2, 4 and 8 units on one mesh. Where the error is
//! c dt^p, differences between neighbours fall by 2^p, so that three steps give an order p; the four of them give two. The theta method is of second
//! order for theta = 1/2, else of first (Hughes 1987, "The finite element method", Sec. 8.2). With theta = 1/2 it keeps the energy of a
//! linear wave; the pulse's strain of 1e-6 changes that by less than 1e-6.

use crate::body::STEEL;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use crate::sliding::{self, Method};
use crate::waves::{bar_setup, set_off_pulse, slender};
use dynamics::Simulation;
use solid::Material;

const MATERIAL: Material = Material { poisson: 0.0, ..STEEL };
const LENGTH: f64 = 0.1;
const ELEMENTS: usize = 100;
/// An order is a whole number.
const WHOLE: (f64, &str) = (0.05, "a twentieth tells whole orders apart");
const SOURCE: &str = "the theta method, Hughes (1987)";
/// Steps of the finest run.
const STEPS: usize = 480;

pub(crate) fn order(size: Size) -> Outcome {
    let mut rows = Vec::new();
    for (theta, order) in [(0.5, 2.0), (1.0, 1.0)] {
        // damping of first order needs shorter steps before its error is c dt
        let longest = if theta > 0.5 { 1.0 / 64.0 } else { 1.0 / 16.0 };
        let waves = runs(|longer| Ok(wave(theta, longest * longer)?.0))?;
        rows.push(row(format!("order of a pulse, theta = {theta}"), order, &waves));
        let step = sliding::step(size)?;
        let slides = runs(|longer| {
            let method = Method::Implicit { theta, longer: longest * longer };
            sliding::slid(size, method, 64.0 * step)
        })?;
        rows.push(row(format!("order of a sliding block, theta = {theta}"), order, &slides));
    }
    let (_, change) = wave(0.5, 8.0)?;
    let strain = (1e-6, "the strain of the pulse");
    let kept = "energy is kept with theta = 1/2";
    rows.push(Row::new(
        "change of the energy of a pulse over it",
        [0.0, change],
        1.0,
        strain,
        kept,
    ));
    Ok(rows)
}

/// The results with steps of 1, 2, 4 and 8 units.
fn runs(of: impl Fn(f64) -> Result<Vec<f64>, Cause>) -> Result<Vec<Vec<f64>>, Cause> {
    [1.0, 2.0, 4.0, 8.0].into_iter().map(of).collect()
}

/// The order that the three finest runs give.
fn row(what: String, order: f64, runs: &[Vec<f64>]) -> Row {
    let distance =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    let [fine, coarse] = [0, 1].map(|k: usize| distance(&runs[k], &runs[k + 1]));
    Row::new(what, [order, libm::log2(coarse / fine)], 1.0, WHOLE, SOURCE)
}

/// The displacements along x (m) when a pulse has passed half the bar, with steps `longer` times the longest stable one, and the change of its
/// energy over it.
fn wave(theta: f64, longer: f64) -> Result<(Vec<f64>, f64), Cause> {
    let mesh = slender(ELEMENTS, LENGTH);
    let mut setup = bar_setup(&mesh, MATERIAL, false)?;
    let c = (MATERIAL.young / MATERIAL.density).sqrt();
    let stable = setup.dt;
    // velocities of t = 0, not of half a step before
    setup.dt = 0.0;
    set_off_pulse(&mut setup, &mesh.nodes, c, [0.3 * LENGTH, 0.1 * LENGTH], 0.0);
    setup.dt = longer * stable;
    let mut simulation = Simulation::new(setup);
    simulation.set_implicit(theta);
    let mut energies = [None, None];
    let steps = (STEPS as f64 / 8.0 / longer).round() as usize;
    for _ in 0..=steps {
        let before = simulation.displacement().to_vec();
        let report = simulation.step(true);
        let Some(energy) = report.energies else { continue };
        let energy = energy.kinetic + energy.internal + energy.hourglass;
        energies[0].get_or_insert(energy);
        energies[1] = Some(energy);
        if report.step == steps {
            let [first, last] = energies.map(|e| e.unwrap_or(f64::NAN));
            return Ok((before.iter().map(|u| u[0]).collect(), (last / first - 1.0).abs()));
        }
    }
    Err("no step".into())
}
