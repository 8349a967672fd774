//! Plane waves in a bar and in a confined column.
//!
//! *Speed.* A Gaussian pulse u = a exp(-((x - x_0 - c t)/s)^2) runs along the bar; at two stations
//! the mean time of passage is the centroid of the particle velocity's square, and the distance
//! over the difference of the means is the speed of the pulse.
//!
//! *Stress.* The bar hits a rigid wall at v. Behind the front that runs back from the wall
//! at c the material is at rest under the stress sigma = rho c v: the bar loses the momentum rho A c t v in the time t
//! (Kolsky 1953, "Stress waves in solids", Ch. III; Achenbach 1973, Sec. 3.1). The stress is the
//! mean over the half of the bar next to the wall, with the weight sin^2 (2 pi x/L) against the
//! ringing of the mesh behind the front, when the front is at three quarters.
//! Finite strain changes the stress by the factor 1 - 3/4 v/c (the St. Venant–Kirchhoff shock:
//! sigma = rho U v with the shock speed U, U^2 = c^2 (1 - 3/2 v/c)); at v = 1 um/s that is 1e-10.
//!
//! *Bar*: free sides, nu = 0.3, c = sqrt(E/rho). The section is one element, so that a finer mesh is
//! also a more slender bar: the dispersion of the mesh and that of lateral inertia (Pochhammer;
//! Love 1927, art. 278: 1 - c/c_0 proportional to (nu k r)^2) vanish together with h^2.
//!
//! *Column*: sides on rollers, c_p = sqrt((lambda + 2G)/rho). The rollers are `dynamics::Fixed`:
//! their nodes do not move along the normal.

use crate::body::{STEEL, at_rest, rollers};
use crate::convergence::Convergence;
use crate::problem::{Outcome, Size};
use crate::row::Row;
use dynamics::{Setup, Simulation};
use mesh::{Mesh, Padded};
use nalgebra::Vector3;
use solid::{Material, SolidError};

/// Length of the bar (m).
const LENGTH: f64 = 0.4;
/// Share of the stability limit: the same on all meshes, so that time and space refine together.
const FACTOR: f64 = 0.6;

pub(crate) fn bar(size: Size) -> Outcome {
    let c = (STEEL.young / STEEL.density).sqrt();
    rows(size, false, c, "bar", "c = sqrt(E/rho), Kolsky (1953)")
}

pub(crate) fn column(size: Size) -> Outcome {
    rows(size, true, STEEL.c_p(), "column", "c_p = sqrt((lambda + 2G)/rho), Achenbach (1973)")
}

fn rows(size: Size, confined: bool, c: f64, what: &str, source: &str) -> Outcome {
    let cells: &[usize] = match size {
        Size::Quick => &[50, 100, 200],
        Size::Full => &[100, 200, 400, 800],
    };
    let mut speeds = Vec::new();
    let mut stresses = Vec::new();
    let impact = 1e-6;
    for &n in cells {
        let h = LENGTH / n as f64;
        speeds.push((h, pulse_speed(n, confined, c)?));
        stresses.push((h, impact_stress(n, confined, c, impact)?));
    }
    let none = (0.0, "");
    Ok(vec![
        Row::converged(
            format!("speed of a pulse in the {what} (m/s)"),
            c,
            &Convergence::new(speeds, 2.0),
            none,
            source,
        ),
        Row::converged(
            format!("stress behind the front of an impact at {impact} m/s, {what} (Pa)"),
            STEEL.density * c * impact,
            &Convergence::new(stresses, 1.0),
            none,
            "sigma = rho c v, Kolsky (1953)",
        ),
    ])
}

/// A bar of `n` elements along x.
pub(crate) fn slender(n: usize, length: f64) -> Mesh {
    let h = length / n as f64;
    mesh::block([n, 1, 1], [length, h, h])
}

/// The bar, its sides free or on rollers.
pub(crate) fn bar_setup(
    mesh: &Mesh,
    material: Material,
    confined: bool,
) -> Result<Setup, SolidError> {
    let mut setup = at_rest(mesh, material, FACTOR, None)?;
    if confined {
        for (side, axis) in [("y-", 1), ("y+", 1), ("z-", 2), ("z+", 2)] {
            setup.system.fixed.extend(rollers(mesh, side, axis));
        }
    }
    Ok(setup)
}

/// Sets the initial state of a Gaussian pulse of displacement at `centre` (m), with the width `width` (m), that runs to
/// +x at the speed `c` (m/s): the velocity is -c du/dx half a step before t = 0. The sides contract by
/// u_y = -`contraction` du/dx (y - y_0): Poisson's ratio for free sides, zero for held ones.
pub(crate) fn set_off_pulse(
    setup: &mut Setup,
    nodes: &[Vector3<f64>],
    c: f64,
    [centre, width]: [f64; 2],
    contraction: f64,
) {
    // strains of 1e-6 and below: finite strain plays no part
    let amplitude = 1e-6 * width;
    let middle = [1, 2].map(|i: usize| 0.5 * nodes.iter().map(|x| x[i]).fold(0.0, f64::max));
    for (i, x) in nodes.iter().enumerate() {
        let from_axis = [x[1] - middle[0], x[2] - middle[1]];
        let slopes = |s: f64| {
            let u = amplitude * libm::exp(-s * s);
            [u, -2.0 * s / width * u, (4.0 * s * s - 2.0) / (width * width) * u]
        };
        let s = (x[0] - centre) / width;
        let [u, strain, _] = slopes(s);
        setup.displacement[i] = Padded::new([
            u,
            -contraction * strain * from_axis[0],
            -contraction * strain * from_axis[1],
        ]);
        // half a step earlier the pulse stood further left; d/dt = -c d/dx
        let [_, strain, bend] = slopes(s + 0.5 * c * setup.dt / width);
        let rate = contraction * c * bend;
        setup.velocity[i] = Padded::new([-c * strain, rate * from_axis[0], rate * from_axis[1]]);
    }
}

fn pulse_speed(n: usize, confined: bool, c: f64) -> Result<f64, SolidError> {
    let mesh = slender(n, LENGTH);
    let mut setup = bar_setup(&mesh, STEEL, confined)?;
    let contraction = if confined { 0.0 } else { STEEL.poisson };
    set_off_pulse(&mut setup, &mesh.nodes, c, [0.2 * LENGTH, 0.04 * LENGTH], contraction);
    let dt = setup.dt;
    let mut simulation = Simulation::new(setup);
    let stations = [0.4 * LENGTH, 0.7 * LENGTH];
    let layers = stations.map(|x| layer(&mesh, x));
    let (mut weight, mut moment) = ([0.0; 2], [0.0; 2]);
    // from 0.2 L until the pulse has passed 0.7 L, before it comes back from the end
    while simulation.time() < 0.7 * LENGTH / c {
        simulation.step(false);
        // velocities stand at the half step before
        let time = simulation.time() - 0.5 * dt;
        for (station, layer) in layers.iter().enumerate() {
            let v: f64 = layer.iter().map(|&i| simulation.velocity()[i].0[0]).sum();
            weight[station] += v * v;
            moment[station] += v * v * time;
        }
    }
    Ok((stations[1] - stations[0]) / (moment[1] / weight[1] - moment[0] / weight[0]))
}

/// Nodes of the section at x.
fn layer(mesh: &Mesh, x: f64) -> Vec<usize> {
    let near = |p: &Vector3<f64>| (p[0] - x).abs() < 1e-9 * LENGTH;
    (0..mesh.nodes.len()).filter(|&i| near(&mesh.nodes[i])).collect()
}

fn impact_stress(n: usize, confined: bool, c: f64, speed: f64) -> Result<f64, SolidError> {
    let mesh = slender(n, LENGTH);
    let mut setup = bar_setup(&mesh, STEEL, confined)?;
    setup.system.fixed.extend(rollers(&mesh, "x-", 0));
    setup.velocity.fill(Padded::new([-speed, 0.0, 0.0]));
    let mut simulation = Simulation::new(setup);
    while simulation.time() < 0.75 * LENGTH / c {
        simulation.step(false);
    }
    let mut stress = vec![[0.0; 6]; mesh.hexes.len()];
    simulation.solid().cauchy_stress(simulation.displacement(), &mut stress);
    let (mut sum, mut weights) = (0.0, 0.0);
    for (element, s) in stress[..n / 2].iter().enumerate() {
        let weight = libm::sin(std::f64::consts::TAU * (element as f64 + 0.5) / n as f64).powi(2);
        sum -= weight * s[0];
        weights += weight;
    }
    Ok(sum / weights)
}
