//! What grading sends back.
//!
//! On a mesh with lumped masses the impedance of a wave depends on the size of the elements, so that elements which grow
//! reflect, and those that are too large to carry the wave reflect all of it (Bažant 1978, Comput. Meth. Appl. Mech. Eng. 16:
//! 91–100; Celep and Bažant 1983, Int. J. Num. Meth. Eng. 19: 631–646). A plane wave runs down from the surface of a
//! block whose elements grow from h to H = 8 h, and what comes back to the surface is compared with what left it.
//!
//! *Block.* Its sides are planes of symmetry for the P wave. For the S wave, which moves along x, those of constant x are
//! planes of antisymmetry. The bottom is so deep that nothing comes back from it in time.
//!
//! *Pulse.* The surface is given an impulse. By linearity (strains of 1e-7 and below) the response to it, folded with a
//! load, is the response to that load: Ricker's wavelet of any frequency. The same impulse on a column of elements of size
//! h gives the wave that leaves. A free surface doubles the velocity of a wave that arrives: half the difference of the
//! mean velocities of both surfaces is the wave that came back. Its peak is taken over that of the wave that left.
//!
//! *Limit.* At 20 elements of size H in a wavelength, less than 1 % of the amplitude is asked for. The impedance of a row of
//! elements of size h is rho c sqrt(1 - (omega h/(2 c))^2) for small time steps. A step from h to H thus reflects
//! (k^2/16) (H^2 - h^2) of a long wave, and 3/2 of that of the peak of Ricker's wavelet, whose second derivative comes back:
//! 0.91 % at 20 elements, 0.057 % at 80.

use crate::body::{STEEL, at_rest};
use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use dynamics::{Fixed, Setup, Simulation};
use mesh::{Bar, FineZone, Grading, Mesh};
use nalgebra::Vector3;

/// Size of the elements at the surface (m); the problem has no other length.
const FINE: f64 = 1e-3;
/// Coarsest size over that at the surface.
const RATIO: usize = 8;
/// Depth of the fine zone, in its elements.
const DEPTH: usize = 4;
/// Elements across the block at the surface, 2:1: two of the coarsest size.
const ACROSS: usize = 2 * RATIO;
/// Speed of the impulse over that of the wave.
const IMPULSE: f64 = 1e-7;
/// Share of the stability limit, as in rolling with exact contact.
const FACTOR: f64 = 0.95;
/// Time from the start of the wavelet to its peak, in periods.
const PEAK: f64 = 1.4;
/// Elements of the coarsest size in the wavelength for which less than [`REQUIRED`] was asked.
const ASKED: usize = 20;
const REQUIRED: f64 = 1e-2;

/// How elements grow.
#[derive(Clone, Copy)]
struct Mesher {
    name: &'static str,
    grading: Grading,
    growth: f64,
}

const MESHERS: [Mesher; 3] = [
    Mesher { name: "tensor product, growth 1.35", grading: Grading::Tensor, growth: 1.35 },
    Mesher { name: "2:1, growth 1.2", grading: Grading::TwoToOne, growth: 1.2 },
    Mesher { name: "2:1, growth 1.35", grading: Grading::TwoToOne, growth: 1.35 },
];

/// A plane wave that runs down.
#[derive(Clone, Copy)]
struct Wave {
    name: &'static str,
    /// Direction of the motion.
    axis: usize,
    speed: f64,
    /// Directions in which the nodes of the sides of constant x do not move, and those of constant y.
    held: [[bool; 3]; 2],
}

fn waves() -> [Wave; 2] {
    let normal = [[true, false, false], [false, true, false]];
    let within = [[false, true, true], [false, true, false]];
    [
        Wave { name: "P wave", axis: 2, speed: STEEL.c_p(), held: normal },
        Wave { name: "S wave", axis: 0, speed: STEEL.c_s(), held: within },
    ]
}

pub(crate) fn run(size: Size) -> Outcome {
    run_with(size, |_, _| ())
}

/// The problem with a fault planted in the masses (kg) of the meshes whose elements grow.
pub(crate) fn run_with(size: Size, fault: impl Fn(&Mesh, &mut [f64])) -> Outcome {
    let elements: &[usize] = match size {
        Size::Quick => &[10, ASKED],
        Size::Full => &[5, 10, ASKED, 40, 80],
    };
    let mut rows = Vec::new();
    for wave in waves() {
        let found = reflections(&wave, elements, &fault)?;
        for (mesher, found) in MESHERS.iter().zip(found) {
            rows.push(row(&format!("{}, {}", wave.name, mesher.name), elements, &found)?);
        }
    }
    Ok(rows)
}

fn row(what: &str, elements: &[usize], found: &[f64]) -> Result<Row, Cause> {
    let asked = elements.iter().position(|&n| n == ASKED).ok_or("the wavelength asked for")?;
    // sizes of the coarsest element for a wavelength of 1 m
    let sizes = elements.iter().map(|&n| 1.0 / n as f64);
    let study = Convergence::new(sizes.zip(found.iter().copied()), 2.0);
    let quantity =
        format!("{what}: amplitude sent back at {ASKED} elements a wavelength, over the wave's");
    let limit = (REQUIRED, "asked of this problem");
    let source = "nothing comes back where elements are alike";
    let row = Row::new(quantity, [0.0, found[asked]], 1.0, limit, source);
    Ok(Row { meshes: study.samples().to_vec(), order: study.order(), ..row })
}

/// For each mesher the amplitude that comes back over that which left, for wavelengths of `elements` coarsest elements.
fn reflections(
    wave: &Wave,
    elements: &[usize],
    fault: impl Fn(&Mesh, &mut [f64]),
) -> Result<Vec<Vec<f64>>, Cause> {
    let coarsest = RATIO as f64 * FINE;
    let longest = elements.iter().fold(0, |a, &b| a.max(b)) as f64 * coarsest;
    // the wavelet, and the way through the layers that grow and back
    let way = 2.0 * PEAK * longest + 12.0 * coarsest;
    let height = (0.51 * way / FINE).ceil() * FINE;
    let mut setups = vec![setup(&column(height)?, wave)?];
    for mesher in &MESHERS {
        let mesh = block(mesher, height)?;
        let mut graded = setup(&mesh, wave)?;
        fault(&mesh, &mut graded.system.mass);
        setups.push(graded);
    }
    let dt = setups.iter().map(|setup| setup.dt).fold(f64::INFINITY, f64::min);
    let steps = (way / (wave.speed * dt)).ceil() as usize;
    let speeds = setups.into_iter().map(|setup| surface_speed(Setup { dt, ..setup }, wave, steps));
    let speeds: Vec<Vec<f64>> = speeds.collect();
    let (uniform, graded) = speeds.split_first().ok_or("no mesh")?;
    let of_mesh = |graded: &Vec<f64>| {
        let back: Vec<f64> = graded.iter().zip(uniform).map(|(g, u)| 0.5 * (g - u)).collect();
        let reflection = |&n: &usize| {
            let period = n as f64 * coarsest / (wave.speed * dt);
            largest(&back, period) / largest(uniform, period)
        };
        elements.iter().map(reflection).collect()
    };
    Ok(graded.iter().map(of_mesh).collect())
}

/// The block whose elements grow with depth.
fn block(mesher: &Mesher, height: f64) -> Result<Mesh, Cause> {
    let across = match mesher.grading {
        Grading::Tensor => 1,
        Grading::TwoToOne => ACROSS,
    };
    bar(mesher, across, height, DEPTH as f64 * FINE)
}

/// A column of elements of one size.
fn column(height: f64) -> Result<Mesh, Cause> {
    bar(&MESHERS[0], 1, height, height)
}

fn bar(mesher: &Mesher, across: usize, height: f64, depth: f64) -> Result<Mesh, Cause> {
    let width = across as f64 * FINE;
    let shape = Bar { length: width, width, height, crown: None, start: 0.0 };
    let zone = FineZone {
        size: FINE,
        length: width,
        width,
        depth,
        start: 0.0,
        growth: mesher.growth,
        // round-off must not keep columns from reaching it
        coarsest: RATIO as f64 * FINE * (1.0 + 1e-9),
        grading: mesher.grading,
    };
    Ok(mesh::bar(&shape, &zone)?)
}

/// The block at rest but for the impulse.
fn setup(mesh: &Mesh, wave: &Wave) -> Result<Setup, Cause> {
    let mut setup = at_rest(mesh, STEEL, FACTOR, None)?;
    for side in 0..2 {
        let ends = mesh.nodes.iter().map(|x| x[side]);
        let (from, to) = ends.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        let at_side = |x: &Vector3<f64>| (x[side] - from).min(to - x[side]) < 1e-6 * FINE;
        let nodes = (0..mesh.nodes.len()).filter(|&n| at_side(&mesh.nodes[n]));
        let held = nodes.map(|n| Fixed { node: n as u32, axes: wave.held[side] });
        setup.system.fixed.extend(held);
    }
    for node in top(mesh.nodes.iter().map(|x| x[2])) {
        setup.velocity[node].0[wave.axis] = IMPULSE * wave.speed;
    }
    Ok(setup)
}

/// Nodes at the surface, z = 0.
fn top(heights: impl Iterator<Item = f64>) -> Vec<usize> {
    heights.enumerate().filter(|(_, z)| z.abs() < 1e-6 * FINE).map(|(n, _)| n).collect()
}

/// Mean velocity of the surface in each step (m/s), weighted by mass: that of the plane wave.
fn surface_speed(setup: Setup, wave: &Wave, steps: usize) -> Vec<f64> {
    let moved = setup.velocity.iter().map(|v| v.0[wave.axis] != 0.0);
    let surface: Vec<usize> =
        moved.enumerate().filter(|(_, moved)| *moved).map(|(n, _)| n).collect();
    let weights: Vec<f64> = surface.iter().map(|&n| setup.system.mass[n]).collect();
    let total: f64 = weights.iter().sum();
    let mut simulation = Simulation::new(setup);
    let one = |_| {
        simulation.step(false);
        let velocity = simulation.velocity();
        let sum: f64 =
            surface.iter().zip(&weights).map(|(&n, w)| w * velocity[n].0[wave.axis]).sum();
        sum / total
    };
    (0..steps).map(one).collect()
}

/// The largest value of the response to a load that is Ricker's wavelet with a period of `period` steps.
fn largest(impulse: &[f64], period: f64) -> f64 {
    let ricker = |i: usize| {
        let a = std::f64::consts::PI * (i as f64 / period - PEAK);
        (1.0 - 2.0 * a * a) * libm::exp(-a * a)
    };
    let load: Vec<f64> = (0..(2.0 * PEAK * period) as usize).map(ricker).collect();
    let folded = |end: usize| {
        let from = (end + 1).saturating_sub(load.len());
        impulse[from..=end].iter().rev().zip(&load).map(|(g, p)| g * p).sum::<f64>()
    };
    (0..impulse.len()).map(|end| folded(end).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_has_elements_of_the_coarsest_size() {
        for mesher in &MESHERS {
            let mesh = block(mesher, 0.2).unwrap();
            let least = mesh.nodes.iter().map(|x| x[2]).fold(0.0, f64::min);
            let lowest = mesh
                .hexes
                .iter()
                .filter(|hex| hex.iter().any(|&n| mesh.nodes[n as usize][2] < least + 1e-6 * FINE));
            let coarsest = RATIO as f64 * FINE;
            let width = if mesher.grading == Grading::Tensor { FINE } else { coarsest };
            for hex in lowest {
                // what is left over joins the last layer
                for (axis, size, slack) in
                    [(0, width, 1e-6), (1, width, 1e-6), (2, coarsest, 0.4 * coarsest)]
                {
                    let x = hex.map(|n| mesh.nodes[n as usize][axis]);
                    let extent = x.iter().fold(f64::MIN, |a, &b| a.max(b))
                        - x.iter().fold(f64::MAX, |a, &b| a.min(b));
                    assert!((extent - size).abs() < slack, "{}: {axis} {extent}", mesher.name);
                }
            }
        }
    }
}
