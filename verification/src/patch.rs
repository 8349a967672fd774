//! The patch test, rigid rotation and hourglass modes, for which elements must be exact.
//!
//! *Patch.* Nodes of the seven-element cube of MacNeal and Harder (1985) are displaced by
//! u = H X with finite strains of 10 to 20 %. An element that passes has the same deformation
//! gradient F = I + H everywhere, hence the Cauchy stress of the St. Venant–Kirchhoff law,
//! sigma = F (lambda tr(E) I + 2G E) F^T/det F with E = (F^T F - I)/2, no force on the interior
//! nodes, and on the outer nodes of each face the resultant P N A of the first Piola stress P = F S.
//!
//! *Rotation.* Under u = (R - I) X the strain E vanishes, so that stress and force do at any angle.
//!
//! *Hourglass.* A unit cube deformed by one of its four hourglass modes, u_i = a Gamma along one axis, has no mean
//! gradient and so no stress. Only the hourglass stiffness resists, with the energy 2 kappa (lambda + 2G) a^2
//! (Flanagan and Belytschko 1981: K_h = kappa (lambda + 2G) B:B/(24 V), B:B = 3/2, q = 8 a).
//!
//! All limits are round-off: a strain of order one is a difference of numbers of order one, exact
//! to a few eps = 2.2e-16, and a force sums fewer than a thousand products; 1e-12 E leaves a factor
//! above ten.

use crate::body::{ONE_POINT, STEEL};
use crate::problem::{Outcome, Size};
use crate::row::Row;
use mesh::{Mesh, Padded, seven_hex_patch};
use nalgebra::{Matrix3, Vector3};
use solid::{Element, Level, Solid, Viscosity};

const ROUND_OFF: (f64, &str) = (1e-12, "round-off of fewer than 1000 products of order one");

/// Displacement gradient H, not symmetric, so that it turns the element as well.
const GRADIENT: Matrix3<f64> =
    Matrix3::new(0.12, 0.05, -0.08, -0.03, -0.10, 0.06, 0.07, -0.02, 0.15);

pub(crate) fn patch(_: Size) -> Outcome {
    patch_with(ONE_POINT)
}

/// The problem with the hourglass control of `element`, beside the closed form of [`ONE_POINT`].
pub(crate) fn patch_with(element: Element) -> Outcome {
    let mesh = seven_hex_patch();
    let mut solid = steel(&mesh, element)?;
    let u = affine(&mesh, GRADIENT);
    let mut force = vec![Padded::ZERO; mesh.nodes.len()];
    let sums = solid.subtract_internal_force(&u, &[], &mut force, true);
    let mut stress = vec![[0.0; 6]; mesh.hexes.len()];
    solid.cauchy_stress(&u, &mut stress);

    let source = "St. Venant-Kirchhoff law in F = I + H";
    let (second_piola, energy) = saint_venant_kirchhoff(&GRADIENT);
    let f = GRADIENT + Matrix3::identity();
    let first_piola = f * second_piola;
    let exact = cauchy(&f, &first_piola);
    let mut rows = Vec::new();
    for (k, name) in ["xx", "yy", "zz", "xy", "yz", "xz"].into_iter().enumerate() {
        // the element with the largest error
        let worst = stress.iter().map(|s| s[k]).fold(exact[k], |worst, s| {
            if (s - exact[k]).abs() >= (worst - exact[k]).abs() { s } else { worst }
        });
        let quantity = format!("sigma_{name} of the worst element (Pa)");
        rows.push(Row::new(quantity, [exact[k], worst], STEEL.young, ROUND_OFF, source));
    }
    rows.push(Row::new(
        "largest force on an interior node over E A",
        [0.0, largest(&force[8..]) / STEEL.young],
        1.0,
        ROUND_OFF,
        "equilibrium of a uniform stress",
    ));
    // the face x = 1 has unit area and normal; the force on its nodes balances P N A
    let mut resultant = Vector3::zeros();
    for (x, f) in mesh.nodes.iter().zip(&force).filter(|(x, _)| x.x == 1.0) {
        // each corner belongs to three faces: count the share of this one by its own traction
        resultant -= f.vector() - corner_share(&first_piola, *x);
    }
    for (i, name) in ["x", "y", "z"].into_iter().enumerate() {
        let quantity = format!("force on the face x = 1 along {name} (N)");
        let values = [first_piola[(i, 0)], resultant[i]];
        rows.push(Row::new(quantity, values, STEEL.young, ROUND_OFF, source));
    }
    let stored = [energy, sums.internal];
    rows.push(Row::new("strain energy (J)", stored, energy, ROUND_OFF, source));
    let hourglass = [0.0, sums.hourglass / sums.internal];
    rows.push(Row::new(
        "hourglass energy over strain energy",
        hourglass,
        1.0,
        ROUND_OFF,
        "gamma is orthogonal to every affine field (Flanagan and Belytschko 1981)",
    ));
    rows.push(Row::new(
        "energy of an hourglass mode of a cube, the worst of 12, over 2 kappa (lambda + 2G) a^2",
        [1.0, hourglass_energy(element)?],
        1.0,
        ROUND_OFF,
        "K_h = kappa (lambda + 2G) B:B/(24 V) (Flanagan and Belytschko 1981)",
    ));
    Ok(rows)
}

pub(crate) fn rotation(_: Size) -> Outcome {
    let mesh = seven_hex_patch();
    let mut solid = steel(&mesh, ONE_POINT)?;
    let (mut worst_stress, mut worst_force) = (0.0_f64, 0.0_f64);
    for step in 1..=24 {
        let u = affine(&mesh, turn(std::f64::consts::TAU * f64::from(step) / 24.0));
        let mut force = vec![Padded::ZERO; mesh.nodes.len()];
        solid.subtract_internal_force(&u, &[], &mut force, false);
        worst_force = worst_force.max(largest(&force));
        let mut stress = vec![[0.0; 6]; mesh.hexes.len()];
        solid.cauchy_stress(&u, &mut stress);
        worst_stress = stress.iter().flatten().fold(worst_stress, |m, s| m.max(s.abs()));
    }
    let source = "objectivity, 24 angles through 2 pi about (1, 2, 2)";
    let row = |quantity: &str, value: f64| {
        Row::new(quantity, [0.0, value / STEEL.young], 1.0, ROUND_OFF, source)
    };
    Ok(vec![row("largest stress over E", worst_stress), row("largest force over E A", worst_force)])
}

/// Energy of an hourglass mode of a unit cube over its closed form with the coefficient of [`ONE_POINT`]; of all modes
/// and axes the ratio farthest from 1.
fn hourglass_energy(element: Element) -> Result<f64, solid::SolidError> {
    let cube = mesh::block([1; 3], [1.0; 3]);
    let mut solid = steel(&cube, element)?;
    let amplitude: f64 = 1e-3;
    let exact =
        2.0 * ONE_POINT.hourglass * (STEEL.lame() + 2.0 * STEEL.shear()) * amplitude.powi(2);
    let modes: [fn(Vector3<f64>) -> f64; 4] =
        [|s| s[1] * s[2], |s| s[0] * s[2], |s| s[0] * s[1], |s| s[0] * s[1] * s[2]];
    let mut worst = 1.0_f64;
    for mode in modes {
        for axis in 0..3 {
            let moved = |x: &Vector3<f64>| {
                let mut u = [0.0; 3];
                u[axis] = amplitude * mode(x.map(|x| 2.0 * x - 1.0));
                Padded::new(u)
            };
            let u: Vec<Padded> = cube.nodes.iter().map(moved).collect();
            let mut force = vec![Padded::ZERO; u.len()];
            let sums = solid.subtract_internal_force(&u, &[], &mut force, true);
            let ratio = sums.hourglass / exact;
            if (ratio - 1.0).abs() > (worst - 1.0).abs() {
                worst = ratio;
            }
        }
    }
    Ok(worst)
}

fn steel(mesh: &Mesh, element: Element) -> Result<Solid, solid::SolidError> {
    Solid::new(mesh, &[STEEL], element, Viscosity::default(), Level::detect())
}

fn affine(mesh: &Mesh, h: Matrix3<f64>) -> Vec<Padded> {
    mesh.nodes.iter().map(|x| Padded::from(h * x)).collect()
}

/// R - I for a turn about (1, 2, 2)/3 (Rodrigues).
fn turn(angle: f64) -> Matrix3<f64> {
    let n = Vector3::new(1.0, 2.0, 2.0) / 3.0;
    let (s, c) = libm::sincos(angle);
    (c - 1.0) * Matrix3::identity() + s * n.cross_matrix() + (1.0 - c) * n * n.transpose()
}

/// S = lambda tr(E) I + 2G E with E = (F^T F - I)/2, and the energy 1/2 S:E of unit volume.
fn saint_venant_kirchhoff(h: &Matrix3<f64>) -> (Matrix3<f64>, f64) {
    let f = h + Matrix3::identity();
    let e = 0.5 * (f.transpose() * f - Matrix3::identity());
    let s = STEEL.lame() * e.trace() * Matrix3::identity() + 2.0 * STEEL.shear() * e;
    (s, 0.5 * s.dot(&e))
}

/// sigma = P F^T/det F, as xx yy zz xy yz xz.
fn cauchy(f: &Matrix3<f64>, first_piola: &Matrix3<f64>) -> [f64; 6] {
    let s = first_piola * f.transpose() / f.determinant();
    [s.m11, s.m22, s.m33, s.m12, s.m23, s.m13]
}

/// Internal force on a corner of the cube from the tractions of the two faces other than x = 1,
/// a quarter of each face's resultant.
fn corner_share(first_piola: &Matrix3<f64>, corner: Vector3<f64>) -> Vector3<f64> {
    first_piola * Vector3::new(0.0, -0.25 * (2.0 * corner.y - 1.0), -0.25 * (2.0 * corner.z - 1.0))
}

fn largest(force: &[Padded]) -> f64 {
    force.iter().flat_map(|f| f.xyz()).fold(0.0, |m: f64, c| m.max(c.abs()))
}
