//! The largest frequency of the assembled system, which sets the stable step 2/omega.

use crate::full_stiffness::{full_stiffness, largest_eigenvalue_bound};
use crate::linear::{AMPLITUDE, Vector};
use crate::material::Material;
use crate::{Element, Elements, Formulation, mean_gradient};
use mesh::{Mesh, Padded};
use nalgebra::Vector3;

/// An upper bound of the largest angular frequency (rad/s) of the free elements, hence of the assembly (Irons), and
/// the index of the element that sets it.
///
/// omega^2 <= lambda_max(K_e)/m_min with the element's least nodal mass m_min, and lambda_max(K_e) at most
/// (lambda + 2G) B_iI B_iI/V + K_h sum |gamma_a|^2 for a one-point element, (tr K_e^16)^(1/16) for a fully integrated
/// one. There is one material per body, in order; bodies beyond the last material are left out. Zero without
/// elements.
pub fn element_frequency_bound<'a>(
    mesh: &Mesh,
    materials: &[Material],
    elements: impl Into<Elements<'a>>,
) -> (f64, usize) {
    let elements = elements.into();
    let mut worst = (0.0, 0);
    for (body, material) in mesh.bodies.iter().zip(materials) {
        for e in body.hexes.clone() {
            let x = mesh.hexes[e].map(|n| mesh.at(n));
            let mass = lightest_node(&x, material.density);
            let squared = stiffness_bound(&x, material, elements.formulation(e)) / mass;
            if squared > worst.0 {
                worst = (squared, e);
            }
        }
    }
    (worst.0.sqrt(), worst.1)
}

/// The bound on lambda_max(K_e) of [`element_frequency_bound`], summed over the elements around each node (N/m), one
/// value per node. A quarter of it as fictitious mass makes a time step of one stable, for dynamic relaxation. There
/// is one material per body, in order.
pub fn nodal_stiffness_bounds<'a>(
    mesh: &Mesh,
    materials: &[Material],
    elements: impl Into<Elements<'a>>,
) -> Vec<f64> {
    let elements = elements.into();
    let mut bounds = vec![0.0; mesh.nodes.len()];
    for (body, material) in mesh.bodies.iter().zip(materials) {
        for e in body.hexes.clone() {
            let hex = mesh.hexes[e];
            let x = hex.map(|n| mesh.at(n));
            let bound = stiffness_bound(&x, material, elements.formulation(e));
            hex.iter().for_each(|&n| bounds[n as usize] += bound);
        }
    }
    bounds
}

/// Upper bound of the largest eigenvalue of an element's stiffness (N/m).
fn stiffness_bound(x: &[Vector3<f64>; 8], material: &Material, formulation: Formulation) -> f64 {
    match formulation {
        Formulation::OnePoint(element) => one_point_bound(x, material, element),
        Formulation::Full(volumetric) => {
            largest_eigenvalue_bound(full_stiffness(x, material, volumetric))
        }
    }
}

/// (lambda + 2G) B_iI B_iI/V + K_h sum |gamma_a|^2 (N/m).
fn one_point_bound(x: &[Vector3<f64>; 8], material: &Material, element: Element) -> f64 {
    let (volume, b) = mean_gradient(x);
    let squares: f64 = b.iter().flatten().map(|c| c * c).sum();
    let stretch = material.p_modulus() * squares / volume;
    let hourglass = element.hourglass * material.p_modulus() * squares / (24.0 * volume);
    let mut shapes = 0.0;
    for base in [
        [1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0],
        [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0],
    ] {
        let moment: Vector3<f64> = base.iter().zip(x).map(|(s, x)| *s * x).sum();
        for (s, b) in base.iter().zip(&b) {
            let gamma: f64 = s - b.dot(&moment) / volume;
            shapes += gamma * gamma;
        }
    }
    stretch + hourglass * shapes
}

/// Smallest lumped mass among the corners of an element (kg).
fn lightest_node(x: &[Vector3<f64>; 8], density: f64) -> f64 {
    density * crate::mass::nodal_volumes(x).into_iter().fold(f64::INFINITY, f64::min)
}

/// Largest angular frequency (rad/s) of M^-1 K by `iterations` Lanczos steps on M^-1/2 K M^-1/2.
///
/// `inverse_mass` holds one value per node (1/kg); zero holds the node. `product(x, y)` adds K x (N) to y; the entries
/// of x are at most [`AMPLITUDE`], so that the force of the elements may take the place of K x. The value approaches the
/// true one from below: 40 steps bring it within about 1 %, a margin that the caller must add. The start vector is
/// fixed, so that the result is reproducible. Zero if all nodes are held.
pub fn largest_frequency(
    inverse_mass: &[f64],
    mut product: impl FnMut(&[Padded], &mut [Padded]),
    iterations: usize,
) -> f64 {
    let n = inverse_mass.len();
    let root: Vec<f64> = inverse_mass.iter().map(|m| m.sqrt()).collect();
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = || {
        // xorshift64: any start vector that is not orthogonal to the highest mode will do
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let mut q: Vec<Padded> = root
        .iter()
        .map(|r| if *r > 0.0 { Padded::new([random(), random(), random()]) } else { Padded::ZERO })
        .collect();
    let length = inner(&q, &q).sqrt();
    if length == 0.0 {
        return 0.0;
    }
    q.scale(1.0 / length);
    let mut previous = vec![Padded::ZERO; n];
    let mut x = vec![Padded::ZERO; n];
    let mut y = vec![Padded::ZERO; n];
    let (mut alphas, mut betas) = (Vec::new(), Vec::new());
    let mut beta = 0.0;
    for _ in 0..iterations.max(1) {
        let largest = q
            .iter()
            .zip(&root)
            .fold(0.0, |m: f64, (q, r)| q.xyz().into_iter().fold(m, |m, c| m.max((c * r).abs())));
        let small = AMPLITUDE / largest;
        for ((x, q), r) in x.iter_mut().zip(&q).zip(&root) {
            *x = Padded(q.0.map(|c| c * r * small));
        }
        y.fill(Padded::ZERO);
        product(&x, &mut y);
        for (y, r) in y.iter_mut().zip(&root) {
            *y = Padded(y.0.map(|c| c * r / small));
        }
        let alpha = inner(&y, &q);
        for ((y, q), p) in y.iter_mut().zip(&q).zip(&previous) {
            for i in 0..3 {
                y.0[i] -= alpha * q.0[i] + beta * p.0[i];
            }
        }
        alphas.push(alpha);
        beta = inner(&y, &y).sqrt();
        if beta <= 1e-14 * alpha.abs() {
            break;
        }
        betas.push(beta);
        std::mem::swap(&mut previous, &mut q);
        std::mem::swap(&mut q, &mut y);
        q.scale(1.0 / beta);
    }
    largest_eigenvalue(&alphas, &betas).max(0.0).sqrt()
}

/// Largest eigenvalue of the symmetric tridiagonal matrix with this diagonal and off-diagonal: by bisection, as the
/// shifted matrix is definite exactly above it.
fn largest_eigenvalue(diagonal: &[f64], off: &[f64]) -> f64 {
    let n = diagonal.len();
    let radius = |i: usize| {
        let left = if i > 0 { off[i - 1].abs() } else { 0.0 };
        let right = if i + 1 < n { off[i].abs() } else { 0.0 };
        left + right
    };
    let mut high = (0..n).map(|i| diagonal[i] + radius(i)).fold(f64::NEG_INFINITY, f64::max);
    let mut low = diagonal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let all_below = |shift: f64| {
        let mut pivot = shift - diagonal[0];
        if pivot <= 0.0 {
            return false;
        }
        for i in 1..n {
            pivot = shift - diagonal[i] - off[i - 1] * off[i - 1] / pivot;
            if pivot <= 0.0 {
                return false;
            }
        }
        true
    };
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if all_below(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

fn inner(a: &[Padded], b: &[Padded]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.vector().dot(&b.vector())).sum()
}
