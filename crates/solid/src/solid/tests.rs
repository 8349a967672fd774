#![allow(clippy::unwrap_used)]
use super::*;
use crate::stress::cauchy;
use crate::{lumped_mass, mean_gradient};
use mesh::{HEX_CORNERS as CORNERS, seven_hex_patch};
use nalgebra::Matrix3;

mod full;

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };
const ELEMENT: Element = Element { hourglass: 0.05 };
const LEVELS: [Level; 5] = Level::ALL;

fn solid(mesh: &Mesh, level: Level) -> Solid {
    Solid::new(mesh, &[STEEL], ELEMENT, Viscosity::default(), level).unwrap()
}

/// A block whose interior and boundary nodes are shaken.
fn shaken(n: [usize; 3]) -> Mesh {
    let mut mesh = mesh::block(n, [1.0, 1.0, 1.0]);
    for (i, p) in mesh.nodes.iter_mut().enumerate() {
        let k = i as f64;
        p[0] += 0.1 / n[0] as f64 * libm::sin(1.7 * k);
        p[1] += 0.1 / n[1] as f64 * libm::sin(2.3 * k + 1.0);
        p[2] += 0.1 / n[2] as f64 * libm::sin(0.9 * k + 2.0);
    }
    mesh
}

fn field(mesh: &Mesh, amplitude: f64) -> Vec<Padded> {
    (0..mesh.nodes.len())
        .map(|i| {
            let k = i as f64;
            Padded::new([
                amplitude * libm::sin(3.1 * k),
                amplitude * libm::cos(1.9 * k + 0.5),
                amplitude * libm::sin(2.7 * k + 1.5),
            ])
        })
        .collect()
}

fn affine(mesh: &Mesh, h: Matrix3<f64>) -> Vec<Padded> {
    mesh.nodes.iter().map(|p| Padded::from(h * p)).collect()
}

fn rotation(angle: f64) -> Matrix3<f64> {
    // about (1, 2, 2)/3, minus the identity
    let n = Vector3::new(1.0, 2.0, 2.0) / 3.0;
    let (s, c) = libm::sincos(angle);
    (c - 1.0) * Matrix3::identity() + s * n.cross_matrix() + (1.0 - c) * n * n.transpose()
}

fn largest(f: &[Padded]) -> f64 {
    f.iter().flat_map(|v| v.xyz()).fold(0.0, |m: f64, c| m.max(c.abs()))
}

#[test]
fn patch_test_an_affine_displacement_leaves_interior_nodes_in_equilibrium() {
    let mesh = seven_hex_patch();
    let h = Matrix3::new(1e-3, 0.5e-3, 0.5e-3, 0.5e-3, 1e-3, 0.5e-3, 0.5e-3, 0.5e-3, 1e-3);
    let u = affine(&mesh, h);
    for level in LEVELS.into_iter().filter(|l| l.available()) {
        let mut solid = solid(&mesh, level);
        let mut f = vec![Padded::ZERO; mesh.nodes.len()];
        let sums = solid.subtract_internal_force(&u, &[], &mut f, true);
        assert!(largest(&f[..8]) > 1e6, "the outer nodes carry the stress");
        assert!(largest(&f[8..]) < 1e-12 * STEEL.young, "{:e}", largest(&f[8..]));
        assert!(sums.hourglass < 1e-20 * sums.internal, "no hourglass in an affine field");
        let mut stress = vec![[0.0; 6]; 7];
        solid.cauchy_stress(&u, &mut stress);
        for s in &stress {
            for k in 0..6 {
                assert!((s[k] - stress[0][k]).abs() < 1e-12 * STEEL.young);
            }
        }
    }
}

#[test]
fn a_rigid_rotation_through_a_full_turn_leaves_no_force_and_no_stress() {
    let mesh = seven_hex_patch();
    for level in LEVELS.into_iter().filter(|l| l.available()) {
        let mut solid = solid(&mesh, level);
        for step in 1..=24 {
            let u = affine(&mesh, rotation(std::f64::consts::TAU * f64::from(step) / 24.0));
            let mut f = vec![Padded::ZERO; mesh.nodes.len()];
            solid.subtract_internal_force(&u, &[], &mut f, false);
            assert!(largest(&f) < 1e-12 * STEEL.young, "{:e}", largest(&f));
            let mut stress = vec![[0.0; 6]; 7];
            solid.cauchy_stress(&u, &mut stress);
            assert!(stress.iter().flatten().all(|s| s.abs() < 1e-12 * STEEL.young));
        }
    }
}

#[test]
fn force_is_the_derivative_of_the_energy() {
    let mesh = shaken([2, 2, 1]);
    let mut solid = solid(&mesh, Level::Portable);
    let u = field(&mesh, 0.02);
    let mut f = vec![Padded::ZERO; mesh.nodes.len()];
    solid.subtract_internal_force(&u, &[], &mut f, false);
    let mut energy = |u: &[Padded]| {
        let mut scratch = vec![Padded::ZERO; u.len()];
        let sums = solid.subtract_internal_force(u, &[], &mut scratch, true);
        sums.internal + sums.hourglass
    };
    let scale = largest(&f);
    for node in [0, 5, 11, 17] {
        for i in 0..3 {
            let step = 1e-6;
            let (mut plus, mut minus) = (u.clone(), u.clone());
            plus[node].0[i] += step;
            minus[node].0[i] -= step;
            let slope = (energy(&plus) - energy(&minus)) / (2.0 * step);
            assert!((slope + f[node].0[i]).abs() < 1e-7 * scale, "{slope:e} {:e}", f[node].0[i]);
        }
    }
}

/// The element written out from its definition, without modes: the oracle of the kernel.
fn textbook_force(x: &[Vector3<f64>; 8], u: &[Vector3<f64>; 8]) -> [Vector3<f64>; 8] {
    let (volume, b) = mean_gradient(x);
    let (h, _) = displacement_gradient(x, u);
    let f = deformation(&h);
    let stress = {
        let det = f.determinant();
        let sigma = cauchy(&h, &STEEL);
        // first Piola P = det F sigma F^-T
        let [xx, yy, zz, xy, yz, xz] = sigma;
        let sigma = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let inverse = f.try_inverse().unwrap();
        det * sigma * inverse.transpose()
    };
    let squares: f64 = b.iter().flatten().map(|c| c * c).sum();
    let stiffness = ELEMENT.hourglass * STEEL.p_modulus() * squares / (24.0 * volume);
    let bases = [
        CORNERS.map(|c| c[1] * c[2]),
        CORNERS.map(|c| c[2] * c[0]),
        CORNERS.map(|c| c[0] * c[1]),
        CORNERS.map(|c| c[0] * c[1] * c[2]),
    ];
    let mut out = b.map(|b| stress * b);
    for base in bases {
        let moment: Vector3<f64> = (0..8).map(|n| base[n] * x[n]).sum();
        let gamma: Vec<f64> = (0..8).map(|n| base[n] - b[n].dot(&moment) / volume).collect();
        let q: Vector3<f64> = (0..8).map(|n| gamma[n] * (x[n] + u[n])).sum();
        for n in 0..8 {
            out[n] += stiffness * gamma[n] * q;
        }
    }
    out
}

#[test]
fn every_level_agrees_with_the_textbook_element() {
    // 11 elements: a full batch and a partial one
    let mesh = shaken([11, 1, 1]);
    let u = field(&mesh, 0.01);
    let mut expected = vec![[0.0; 3]; mesh.nodes.len()];
    for hex in &mesh.hexes {
        let f = textbook_force(&hex.map(|n| mesh.at(n)), &hex.map(|n| u[n as usize].vector()));
        for (n, f) in hex.iter().zip(f) {
            for i in 0..3 {
                expected[*n as usize][i] -= f[i];
            }
        }
    }
    for level in LEVELS.into_iter().filter(|l| l.available()) {
        let mut f = vec![Padded::ZERO; mesh.nodes.len()];
        solid(&mesh, level).subtract_internal_force(&u, &[], &mut f, false);
        let scale = largest(&f);
        for (a, b) in f.iter().zip(&expected) {
            for i in 0..3 {
                assert!((a.0[i] - b[i]).abs() < 1e-12 * scale, "{level:?}");
            }
            assert_eq!(a.0[3], 0.0, "the padding stays zero");
        }
    }
}

#[test]
fn one_to_seven_threads_give_the_same_bits() {
    let mesh = shaken([20, 12, 9]);
    let u = field(&mesh, 1e-3);
    let v = field(&mesh, 5.0);
    let viscosity = Viscosity { bulk_linear: 0.06, bulk_quadratic: 1.2, kelvin_voigt: 1e-8 };
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut solid = Solid::new(&mesh, &[STEEL], ELEMENT, viscosity, Level::detect()).unwrap();
        let mut f = vec![Padded::ZERO; mesh.nodes.len()];
        let sums = pool.install(|| solid.subtract_internal_force(&u, &v, &mut f, true));
        (f, sums)
    };
    let one = run(1);
    assert!(one.1.viscous_power > 0.0);
    for threads in [2, 3, 4, 7] {
        assert_eq!(one, run(threads));
    }
}

#[test]
fn plain_rust_gives_the_bits_of_the_vectors_in_every_element_with_energies_and_viscosity() {
    let vectors = Level::pinned();
    if vectors == Level::Fused {
        return;
    }
    let mesh = shaken([7, 5, 3]);
    let (u, v) = (field(&mesh, 1e-3), field(&mesh, 5.0));
    let viscosity = Viscosity { bulk_linear: 0.06, bulk_quadratic: 1.2, kelvin_voigt: 1e-8 };
    let full: Vec<bool> = (0..mesh.hexes.len()).map(|i| i % 3 == 0).collect();
    for volumetric in [Volumetric::Mean, Volumetric::Full] {
        for viscosity in [viscosity, Viscosity::default()] {
            let run = |level| {
                let elements = Elements::mixed(ELEMENT, &full, volumetric);
                let mut solid = Solid::new(&mesh, &[STEEL], elements, viscosity, level).unwrap();
                [false, true].map(|energies| {
                    let mut f = vec![Padded::ZERO; mesh.nodes.len()];
                    let sums = solid.subtract_internal_force(&u, &v, &mut f, energies);
                    (f, [sums.internal, sums.hourglass, sums.viscous_power].map(f64::to_bits))
                })
            };
            let fused = run(Level::Fused);
            assert_eq!(fused, run(vectors));
            assert_ne!(fused[1], run(Level::Portable)[1], "which rounds twice");
        }
    }
}

#[test]
fn viscous_stresses_dissipate_and_vanish_in_rigid_rotation() {
    let mesh = shaken([3, 3, 3]);
    let viscosity = Viscosity { kelvin_voigt: 1e-8, bulk_linear: 0.06, bulk_quadratic: 1.2 };
    let mut solid = Solid::new(&mesh, &[STEEL], ELEMENT, viscosity, Level::detect()).unwrap();
    let mut f = vec![Padded::ZERO; mesh.nodes.len()];
    let u = affine(&mesh, rotation(0.7));
    // velocity of a rotation of the turned body: omega x (X + u)
    let omega = Vector3::new(10.0, -20.0, 30.0);
    let spin: Vec<_> = mesh
        .nodes
        .iter()
        .zip(&u)
        .map(|(p, u)| Padded::from(omega.cross(&(p + u.vector()))))
        .collect();
    solid.subtract_internal_force(&u, &spin, &mut f, false);
    assert!(largest(&f) < 1e-12 * STEEL.young, "{:e}", largest(&f));
    let sums = solid.subtract_internal_force(&u, &field(&mesh, 1.0), &mut f, false);
    assert!(sums.viscous_power > 0.0);
}

#[test]
fn linear_bulk_viscosity_of_a_compressed_cube_is_b1_rho_cp_h_rate() {
    let h = 2e-3;
    let mesh = mesh::block([1, 1, 1], [h, h, h]);
    let viscosity = Viscosity { bulk_linear: 0.06, ..Viscosity::default() };
    let mut solid = Solid::new(&mesh, &[STEEL], ELEMENT, viscosity, Level::detect()).unwrap();
    let rate = -3.0;
    let v = affine(&mesh, Matrix3::from_diagonal(&Vector3::new(rate, 0.0, 0.0)));
    let u = vec![Padded::ZERO; 8];
    let mut f = vec![Padded::ZERO; 8];
    solid.subtract_internal_force(&u, &v, &mut f, false);
    let q = 0.06 * STEEL.density * STEEL.c_p() * h * rate.abs();
    let face = f.iter().zip(&mesh.nodes).filter(|(_, p)| p[0] > h / 2.0).map(|(f, _)| f.0[0]);
    assert!((face.sum::<f64>() - q * h * h).abs() < 1e-12 * q * h * h);
}

#[test]
fn the_frequency_of_a_free_cube_and_of_a_block_match_known_step_limits() {
    // A free cube: 0.734 h/c_p; an assembled 6^3 block: 0.98 h/c_p (design notes, computed by
    // dense eigenvalues of the same element). The bound is below both.
    let h = 1e-3;
    for (n, expected) in [(1, 0.734), (6, 0.98)] {
        let size = n as f64 * h;
        let mesh = mesh::block([n, n, n], [size, size, size]);
        let mass = lumped_mass(&mesh, &[STEEL.density]);
        let inverse: Vec<_> = mass.iter().map(|m| 1.0 / m).collect();
        let mut solid = solid(&mesh, Level::detect());
        let omega =
            crate::largest_frequency(&inverse, |x, y| solid.add_stiffness_product(x, y), 40);
        let step = 2.0 / omega * STEEL.c_p() / h;
        assert!((step - expected).abs() < 0.01, "{n}: {step}");
        let (bound, _) = crate::element_frequency_bound(&mesh, &[STEEL], ELEMENT);
        assert!(bound > omega && bound < 2.0 * omega);
    }
}

#[test]
fn an_inside_out_element_is_refused_by_name() {
    let mut mesh = mesh::block([2, 1, 1], [1.0, 1.0, 1.0]);
    mesh.hexes[1].swap(0, 4);
    mesh.hexes[1].swap(1, 5);
    mesh.hexes[1].swap(2, 6);
    mesh.hexes[1].swap(3, 7);
    let error = Solid::new(&mesh, &[STEEL], ELEMENT, Viscosity::default(), Level::Portable);
    assert!(matches!(error, Err(SolidError::Inverted { element: 1, .. })));
}
