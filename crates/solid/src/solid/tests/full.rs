//! The fully integrated element, alone and beside one-point elements.

use super::*;
use crate::full_stiffness::full_stiffness;
use crate::stress::{cauchy, green};
use nalgebra::{DMatrix, DVector, SMatrix, SymmetricEigen};

const BOTH: [Volumetric; 2] = [Volumetric::Full, Volumetric::Mean];

fn full_solid(mesh: &Mesh, volumetric: Volumetric, level: Level) -> Solid {
    Solid::new(mesh, &[STEEL], volumetric, Viscosity::default(), level).unwrap()
}

/// Every third element and a run at the end.
fn some(mesh: &Mesh) -> Vec<bool> {
    let n = mesh.hexes.len();
    (0..n).map(|e| e % 3 == 1 || e >= n - n / 5).collect()
}

#[test]
fn patch_test_an_affine_displacement_leaves_interior_nodes_in_equilibrium() {
    let mesh = seven_hex_patch();
    let h = Matrix3::new(1e-3, 0.5e-3, 0.5e-3, 0.5e-3, 1e-3, 0.5e-3, 0.5e-3, 0.5e-3, 1e-3);
    let u = affine(&mesh, h);
    let expected = cauchy(&h, &STEEL);
    let full = some(&mesh);
    for level in LEVELS.into_iter().filter(|l| l.available()) {
        for volumetric in BOTH {
            for elements in [volumetric.into(), Elements::mixed(ELEMENT, &full, volumetric)] {
                let mut solid =
                    Solid::new(&mesh, &[STEEL], elements, Viscosity::default(), level).unwrap();
                let mut f = vec![Padded::ZERO; mesh.nodes.len()];
                solid.subtract_internal_force(&u, &[], &mut f, true);
                assert!(largest(&f[..8]) > 1e6, "the outer nodes carry the stress");
                assert!(largest(&f[8..]) < 1e-12 * STEEL.young, "{:e}", largest(&f[8..]));
                let mut stress = vec![[0.0; 6]; 7];
                solid.cauchy_stress(&u, &mut stress);
                for s in &stress {
                    for k in 0..6 {
                        assert!((s[k] - expected[k]).abs() < 1e-12 * STEEL.young);
                    }
                }
            }
        }
    }
}

#[test]
fn a_rigid_rotation_through_a_full_turn_leaves_no_force_and_no_stress() {
    let mesh = seven_hex_patch();
    for level in LEVELS.into_iter().filter(|l| l.available()) {
        for volumetric in BOTH {
            let mut solid = full_solid(&mesh, volumetric, level);
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
}

/// A rotation after a deformation turns the forces and leaves the energy.
#[test]
fn a_rotation_on_top_of_a_deformation_turns_the_force() {
    let mesh = shaken([2, 2, 2]);
    let r = deformation(&rotation(2.0));
    let u = field(&mesh, 0.02);
    let turned: Vec<_> =
        mesh.nodes.iter().zip(&u).map(|(x, u)| Padded::from(r * (x + u.vector()) - x)).collect();
    for volumetric in BOTH {
        let mut solid = full_solid(&mesh, volumetric, Level::detect());
        let (mut f, mut g) = (vec![Padded::ZERO; u.len()], vec![Padded::ZERO; u.len()]);
        let still = solid.subtract_internal_force(&u, &[], &mut f, true).internal;
        let moved = solid.subtract_internal_force(&turned, &[], &mut g, true).internal;
        assert!((moved / still - 1.0).abs() < 1e-12, "{still:e} {moved:e}");
        for (f, g) in f.iter().zip(&g) {
            let error = g.vector() - r * f.vector();
            assert!(error.abs().max() < 1e-12 * STEEL.young);
        }
    }
}

#[test]
fn force_is_the_derivative_of_the_energy() {
    let mesh = shaken([2, 2, 1]);
    let full = some(&mesh);
    for volumetric in BOTH {
        for elements in [volumetric.into(), Elements::mixed(ELEMENT, &full, volumetric)] {
            let viscosity = Viscosity::default();
            let mut solid =
                Solid::new(&mesh, &[STEEL], elements, viscosity, Level::detect()).unwrap();
            let u = field(&mesh, 0.02);
            let mut f = vec![Padded::ZERO; mesh.nodes.len()];
            solid.subtract_internal_force(&u, &[], &mut f, false);
            let mut energy = |u: &[Padded]| {
                let mut scratch = vec![Padded::ZERO; u.len()];
                let sums = solid.subtract_internal_force(u, &[], &mut scratch, true);
                sums.internal + sums.hourglass
            };
            let scale = largest(&f);
            for node in 0..mesh.nodes.len() {
                for i in 0..3 {
                    let step = 1e-6;
                    let (mut plus, mut minus) = (u.clone(), u.clone());
                    plus[node].0[i] += step;
                    minus[node].0[i] -= step;
                    let slope = (energy(&plus) - energy(&minus)) / (2.0 * step);
                    let difference = slope + f[node].0[i];
                    assert!(difference.abs() < 1e-7 * scale, "{slope:e} {:e}", f[node].0[i]);
                }
            }
        }
    }
}

/// The element written out from its definition at the Gauss points: the oracle of the kernel.
fn textbook_force(
    x: &[Vector3<f64>; 8],
    u: &[Vector3<f64>; 8],
    volumetric: Volumetric,
) -> [Vector3<f64>; 8] {
    let points = gauss_points(x);
    let dilatation = points.map(|p| green(&p.displacement_gradient(u)).trace());
    let volume: f64 = points.iter().map(|p| p.volume).sum();
    let mean = points.iter().zip(dilatation).map(|(p, d)| p.volume * d).sum::<f64>() / volume;
    let mut out = [Vector3::zeros(); 8];
    for (point, own) in points.iter().zip(dilatation) {
        let h = point.displacement_gradient(u);
        let theta = if volumetric == Volumetric::Mean { mean } else { own };
        let isotropic = Matrix3::from_diagonal_element(STEEL.lame() * theta);
        let first_piola = deformation(&h) * (2.0 * STEEL.shear() * green(&h) + isotropic);
        for (out, b) in out.iter_mut().zip(&point.gradient) {
            *out += point.volume * first_piola * b;
        }
    }
    out
}

#[test]
fn every_level_agrees_with_the_textbook_element() {
    // 11 elements: a full batch and a partial one
    let mesh = shaken([11, 1, 1]);
    let u = field(&mesh, 0.01);
    for volumetric in BOTH {
        let mut expected = vec![[0.0; 3]; mesh.nodes.len()];
        for hex in &mesh.hexes {
            let x = hex.map(|n| mesh.at(n));
            let f = textbook_force(&x, &hex.map(|n| u[n as usize].vector()), volumetric);
            for (n, f) in hex.iter().zip(f) {
                (0..3).for_each(|i| expected[*n as usize][i] -= f[i]);
            }
        }
        for level in LEVELS.into_iter().filter(|l| l.available()) {
            let mut f = vec![Padded::ZERO; mesh.nodes.len()];
            full_solid(&mesh, volumetric, level).subtract_internal_force(&u, &[], &mut f, false);
            let scale = largest(&f);
            for (a, b) in f.iter().zip(&expected) {
                for i in 0..3 {
                    assert!((a.0[i] - b[i]).abs() < 1e-12 * scale, "{level:?}");
                }
                assert_eq!(a.0[3], 0.0, "the padding stays zero");
            }
        }
    }
}

#[test]
fn one_two_and_three_threads_give_the_same_bits_in_a_mixed_mesh() {
    let mesh = shaken([20, 12, 9]);
    let full = some(&mesh);
    let (u, v) = (field(&mesh, 1e-3), field(&mesh, 5.0));
    let viscosity = Viscosity { bulk_linear: 0.06, bulk_quadratic: 1.2, kelvin_voigt: 1e-8 };
    for volumetric in BOTH {
        let elements = Elements::mixed(ELEMENT, &full, volumetric);
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut solid =
                Solid::new(&mesh, &[STEEL], elements, viscosity, Level::detect()).unwrap();
            let mut f = vec![Padded::ZERO; mesh.nodes.len()];
            let sums = pool.install(|| solid.subtract_internal_force(&u, &v, &mut f, true));
            (f, sums)
        };
        let one = run(1);
        assert!(one.1.viscous_power > 0.0);
        assert_eq!(one, run(2));
        assert_eq!(one, run(3));
    }
}

/// The force of a mixed mesh is the sum of those of its parts.
#[test]
fn a_mixed_mesh_adds_up_both_formulations() {
    let mesh = shaken([5, 4, 3]);
    let full = some(&mesh);
    let (u, v) = (field(&mesh, 1e-3), field(&mesh, 5.0));
    let viscosity = Viscosity { bulk_linear: 0.06, bulk_quadratic: 1.2, kelvin_voigt: 1e-8 };
    let part = |chosen: Option<bool>, elements: Elements| {
        let mut mesh = mesh.clone();
        if let Some(chosen) = chosen {
            let mut keep = full.iter().map(|f| *f == chosen);
            mesh.hexes.retain(|_| keep.next().unwrap());
            mesh.bodies[0].hexes = 0..mesh.hexes.len();
        }
        let mut solid = Solid::new(&mesh, &[STEEL], elements, viscosity, Level::detect()).unwrap();
        let mut f = vec![Padded::ZERO; u.len()];
        let sums = solid.subtract_internal_force(&u, &v, &mut f, true);
        (f, sums)
    };
    let mixed = part(None, Elements::mixed(ELEMENT, &full, Volumetric::Mean));
    let (one_point, fully) =
        (part(Some(false), ELEMENT.into()), part(Some(true), Volumetric::Mean.into()));
    for ((m, a), b) in mixed.0.iter().zip(&one_point.0).zip(&fully.0) {
        for i in 0..3 {
            assert!((m.0[i] - a.0[i] - b.0[i]).abs() < 1e-12 * largest(&mixed.0));
        }
    }
    let close = |m: f64, a: f64, b: f64| assert!((m - a - b).abs() < 1e-12 * m, "{m} {a} {b}");
    close(mixed.1.internal, one_point.1.internal, fully.1.internal);
    close(mixed.1.viscous_power, one_point.1.viscous_power, fully.1.viscous_power);
    assert_eq!(mixed.1.hourglass, one_point.1.hourglass);
    assert_eq!(fully.1.hourglass, 0.0);
}

fn distorted() -> [Vector3<f64>; 8] {
    crate::geometry::tests::distorted()
}

fn matrix(k: [[f64; 24]; 24]) -> SMatrix<f64, 24, 24> {
    SMatrix::from_fn(|i, j| k[i][j])
}

#[test]
fn the_stiffness_is_symmetric_with_exactly_six_rigid_modes() {
    for volumetric in BOTH {
        let k = matrix(full_stiffness(&distorted(), &STEEL, volumetric));
        assert!((k - k.transpose()).abs().max() < 1e-15 * k.abs().max());
        let mut values: Vec<f64> = k.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        let top = values[23];
        assert!(values[..6].iter().all(|v| v.abs() < 1e-13 * top), "{values:?}");
        assert!(values[6] > 1e-3 * top, "no hourglass modes: {values:?}");
        let bound = crate::full_stiffness::largest_eigenvalue_bound(full_stiffness(
            &distorted(),
            &STEEL,
            volumetric,
        ));
        assert!(bound >= top && bound < 1.2 * top, "{bound:e} {top:e}");
    }
}

/// A single distorted element of the size of a millimetre.
fn single() -> Mesh {
    let mut mesh = mesh::block([1, 1, 1], [1.0, 1.0, 1.0]);
    let hex = mesh.hexes[0];
    for (n, x) in hex.into_iter().zip(distorted()) {
        mesh.nodes[n as usize] = 1e-3 * x;
    }
    mesh
}

#[test]
fn the_stiffness_is_the_linearised_force() {
    let mesh = single();
    let hex = mesh.hexes[0];
    let x = field(&mesh, 1e-13);
    for volumetric in BOTH {
        let corners = hex.map(|n| mesh.at(n));
        let k = matrix(full_stiffness(&corners, &STEEL, volumetric));
        let expected = k * SMatrix::<f64, 24, 1>::from_fn(|i, _| x[hex[i / 3] as usize].0[i % 3]);
        let mut y = vec![Padded::ZERO; 8];
        full_solid(&mesh, volumetric, Level::detect()).add_stiffness_product(&x, &mut y);
        for i in 0..24 {
            let product = y[hex[i / 3] as usize].0[i % 3];
            assert!((product - expected[i]).abs() < 1e-9 * largest(&y), "{product:e}");
        }
    }
}

#[test]
fn hourglass_displacements_are_resisted_without_hourglass_stiffness() {
    let mesh = mesh::block([1, 1, 1], [1.0, 1.0, 1.0]);
    let energy = |elements: Elements, mode: fn(Vector3<f64>) -> f64| {
        let u: Vec<_> = mesh
            .nodes
            .iter()
            .map(|x| Padded::new([1e-3 * mode(x.map(|c| 2.0 * c - 1.0)), 0.0, 0.0]))
            .collect();
        let mut solid =
            Solid::new(&mesh, &[STEEL], elements, Viscosity::default(), Level::detect()).unwrap();
        solid.subtract_internal_force(&u, &[], &mut vec![Padded::ZERO; 8], true).internal
    };
    let modes: [fn(Vector3<f64>) -> f64; 3] =
        [|x| x[0] * x[1], |x| x[1] * x[2], |x| x[0] * x[1] * x[2]];
    for mode in modes {
        assert_eq!(energy(Element { hourglass: 0.0 }.into(), mode), 0.0);
        for volumetric in BOTH {
            assert!(energy(volumetric.into(), mode) > 1e-7 * STEEL.young);
        }
    }
}

#[test]
fn the_mean_stress_balances_the_nodal_forces_of_a_deformed_element() {
    let mesh = single();
    let u = field(&mesh, 3e-5);
    for volumetric in BOTH {
        let mut solid = full_solid(&mesh, volumetric, Level::detect());
        let mut f = vec![Padded::ZERO; 8];
        solid.subtract_internal_force(&u, &[], &mut f, false);
        let mut stress = [[0.0; 6]];
        solid.cauchy_stress(&u, &mut stress);
        let now: Vec<_> = mesh.nodes.iter().zip(&u).map(|(x, u)| x + u.vector()).collect();
        let (volume, _) = mean_gradient(&mesh.hexes[0].map(|n| now[n as usize]));
        for (k, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].into_iter().enumerate()
        {
            // sum f (x) x = v mean(sigma), the virial theorem
            let virial: f64 = f.iter().zip(&now).map(|(f, x)| -f.0[i] * x[j]).sum();
            assert!((virial / volume - stress[0][k]).abs() < 1e-12 * STEEL.young);
        }
    }
}

#[test]
fn kelvin_voigt_dissipates_eta_v_k_v_and_bulk_viscosity_is_that_of_the_one_point_element() {
    let mesh = shaken([2, 2, 2]);
    let (zero, v) = (vec![Padded::ZERO; 27], field(&mesh, 1.0));
    let eta = 1e-8;
    for volumetric in BOTH {
        let viscosity = Viscosity { kelvin_voigt: eta, ..Viscosity::default() };
        let mut solid =
            Solid::new(&mesh, &[STEEL], volumetric, viscosity, Level::detect()).unwrap();
        let mut f = vec![Padded::ZERO; 27];
        let power = solid.subtract_internal_force(&zero, &v, &mut f, false).viscous_power;
        let work: f64 =
            f.iter().zip(&v).map(|(f, v)| (0..3).map(|i| -f.0[i] * v.0[i]).sum::<f64>()).sum();
        assert!((work / power - 1.0).abs() < 1e-12, "{work:e} {power:e}");
        let small: Vec<_> = v.iter().map(|v| Padded(v.0.map(|c| 1e-13 * c))).collect();
        let mut kv = vec![Padded::ZERO; 27];
        solid.add_stiffness_product(&small, &mut kv);
        for (f, kv) in f.iter().zip(&kv) {
            for i in 0..3 {
                assert!((f.0[i] + eta * 1e13 * kv.0[i]).abs() < 1e-9 * largest(&[*f]));
            }
        }
        let viscosity =
            Viscosity { bulk_linear: 0.06, bulk_quadratic: 1.2, ..Viscosity::default() };
        let squeeze = affine(&mesh, Matrix3::new(-3.0, 0.2, 0.1, 0.0, -1.0, 0.5, 0.3, 0.0, 0.4));
        let power = |elements: Elements| {
            let mut solid =
                Solid::new(&mesh, &[STEEL], elements, viscosity, Level::detect()).unwrap();
            let mut f = vec![Padded::ZERO; 27];
            (solid.subtract_internal_force(&zero, &squeeze, &mut f, false).viscous_power, f)
        };
        let (full, one_point) = (power(volumetric.into()), power(ELEMENT.into()));
        assert!((full.0 / one_point.0 - 1.0).abs() < 1e-12);
        for (a, b) in full.1.iter().zip(&one_point.1) {
            assert!((0..3).all(|i| (a.0[i] - b.0[i]).abs() < 1e-12 * largest(&one_point.1)));
        }
    }
}

#[test]
fn viscous_stresses_vanish_in_rigid_rotation() {
    let mesh = shaken([3, 3, 3]);
    let viscosity = Viscosity { kelvin_voigt: 1e-8, bulk_linear: 0.06, bulk_quadratic: 1.2 };
    let u = affine(&mesh, rotation(0.7));
    let spin: Vec<_> = mesh
        .nodes
        .iter()
        .zip(&u)
        .map(|(p, u)| Padded::from(Vector3::new(10.0, -20.0, 30.0).cross(&(p + u.vector()))))
        .collect();
    for volumetric in BOTH {
        let mut solid =
            Solid::new(&mesh, &[STEEL], volumetric, viscosity, Level::detect()).unwrap();
        let mut f = vec![Padded::ZERO; mesh.nodes.len()];
        solid.subtract_internal_force(&u, &spin, &mut f, false);
        assert!(largest(&f) < 1e-12 * STEEL.young, "{:e}", largest(&f));
    }
}

/// Central difference in the form whose energy the scheme conserves but for the rounding and the
/// work of the nonlinear force: T^n = 1/2 v^{n-1/2} . M v^{n+1/2}.
#[test]
fn a_free_vibrating_cube_keeps_its_energy() {
    let n = 4;
    let size = n as f64 * 1e-3;
    let mesh = mesh::block([n, n, n], [size; 3]);
    let mass = lumped_mass(&mesh, &[STEEL.density]);
    for volumetric in BOTH {
        let mut solid = full_solid(&mesh, volumetric, Level::detect());
        let (bound, _) = crate::element_frequency_bound(&mesh, &[STEEL], volumetric);
        let dt = 0.3 * 2.0 / bound;
        let mut u = vec![Padded::ZERO; mesh.nodes.len()];
        let mut v: Vec<_> =
            mesh.nodes.iter().map(|x| Padded::new([0.0, 0.0, -10.0 * x[2] / size])).collect();
        let (mut least, mut most, mut strain) = (f64::INFINITY, 0.0f64, 0.0f64);
        let mut f = u.clone();
        for step in 0..4000 {
            f.fill(Padded::ZERO);
            let internal = solid.subtract_internal_force(&u, &[], &mut f, true).internal;
            let mut kinetic = 0.0;
            for (((u, v), f), m) in u.iter_mut().zip(&mut v).zip(&f).zip(&mass) {
                for i in 0..3 {
                    let before = v.0[i];
                    v.0[i] += dt * f.0[i] / m;
                    kinetic += 0.5 * m * before * v.0[i];
                    u.0[i] += dt * v.0[i];
                }
            }
            if step > 0 {
                least = least.min(kinetic + internal);
                most = most.max(kinetic + internal);
                strain = strain.max(internal);
            }
        }
        assert!(strain > 0.2 * most, "it vibrates");
        assert!(most / least - 1.0 < 1e-4, "{}", most / least - 1.0);
    }
}

/// Deflection of the end of a cantilever under a shear force at its end, over that of Timoshenko's
/// beam.
fn deflection(poisson: f64, volumetric: Volumetric) -> f64 {
    let (cells, size) = ([16, 2, 4], [8.0, 1.0, 2.0]);
    let mesh = mesh::block(cells, size);
    let material = Material { young: 1.0, poisson, density: 1.0 };
    let dofs = 3 * mesh.nodes.len();
    let mut k = DMatrix::<f64>::zeros(dofs, dofs);
    for hex in &mesh.hexes {
        let element = full_stiffness(&hex.map(|n| mesh.at(n)), &material, volumetric);
        for i in 0..24 {
            for j in 0..24 {
                let at = |i: usize| 3 * hex[i / 3] as usize + i % 3;
                k[(at(i), at(j))] += element[i][j];
            }
        }
    }
    let mut load = DVector::zeros(dofs);
    let end: Vec<_> =
        (0..mesh.nodes.len()).filter(|&n| mesh.nodes[n][0] > size[0] - 1e-9).collect();
    end.iter().for_each(|n| load[3 * n + 2] = 1.0 / end.len() as f64);
    for (n, x) in mesh.nodes.iter().enumerate() {
        // Clamped against bending, but free to contract.
        let held = if x[0] < 1e-9 {
            [true, x[1] < 1e-9, (x[2] - 0.5 * size[2]).abs() < 1e-9]
        } else {
            [false; 3]
        };
        (0..3).filter(|i| held[*i]).for_each(|i| k[(3 * n + i, 3 * n + i)] = 1e12);
    }
    let u = nalgebra::Cholesky::new(k).unwrap().solve(&load);
    let mean = end.iter().map(|n| u[3 * n + 2]).sum::<f64>() / end.len() as f64;
    let inertia = size[1] * size[2].powi(3) / 12.0;
    let shear = size[0] / (5.0 / 6.0 * material.shear() * size[1] * size[2]);
    mean / (size[0].powi(3) / (3.0 * inertia) + shear)
}

#[test]
fn a_nearly_incompressible_cantilever_locks_without_the_mean_dilatation_and_not_with_it() {
    // With the mean the deflection is that of the beam whatever Poisson's ratio; without, the
    // constraint of eight points an element takes it away as the bulk modulus grows.
    let mean = [0.3, 0.499, 0.49999].map(|poisson| deflection(poisson, Volumetric::Mean));
    assert!(mean.iter().all(|ratio| (ratio - 1.0).abs() < 0.02), "{mean:?}");
    let locked = [0.3, 0.499, 0.49999].map(|poisson| deflection(poisson, Volumetric::Full));
    assert!((locked[0] - 1.0).abs() < 0.05, "{locked:?}");
    assert!(locked[1] < 0.75 && locked[2] < 0.6, "{locked:?}");
}

#[test]
fn the_frequency_bound_holds_and_is_close() {
    let mesh = shaken([4, 3, 3]);
    let full = some(&mesh);
    let mass = lumped_mass(&mesh, &[STEEL.density]);
    let inverse: Vec<_> = mass.iter().map(|m| 1.0 / m).collect();
    for volumetric in BOTH {
        for elements in [volumetric.into(), Elements::mixed(ELEMENT, &full, volumetric)] {
            let mut solid =
                Solid::new(&mesh, &[STEEL], elements, Viscosity::default(), Level::detect())
                    .unwrap();
            let omega =
                crate::largest_frequency(&inverse, |x, y| solid.add_stiffness_product(x, y), 40);
            let (bound, _) = crate::element_frequency_bound(&mesh, &[STEEL], elements);
            assert!(bound > omega && bound < 2.0 * omega, "{bound:e} {omega:e}");
            // M~ = bounds/4 makes a unit step stable: omega < 2.
            let bounds = crate::nodal_stiffness_bounds(&mesh, &[STEEL], elements);
            let fictitious: Vec<_> = bounds.iter().map(|k| 4.0 / k).collect();
            let omega =
                crate::largest_frequency(&fictitious, |x, y| solid.add_stiffness_product(x, y), 40);
            assert!(omega < 2.0 && omega > 1.0, "{omega}");
        }
    }
}

/// The assembled frequency against a dense eigenvalue of the assembled stiffness.
#[test]
fn the_largest_frequency_of_a_mixed_mesh_is_that_of_its_assembled_matrices() {
    let mesh = shaken([2, 2, 2]);
    let mass = lumped_mass(&mesh, &[STEEL.density]);
    let dofs = 3 * mesh.nodes.len();
    let mut k = DMatrix::<f64>::zeros(dofs, dofs);
    for hex in &mesh.hexes {
        let element = full_stiffness(&hex.map(|n| mesh.at(n)), &STEEL, Volumetric::Mean);
        for i in 0..24 {
            for j in 0..24 {
                let at = |i: usize| 3 * hex[i / 3] as usize + i % 3;
                k[(at(i), at(j))] += element[i][j] / (mass[at(i) / 3] * mass[at(j) / 3]).sqrt();
            }
        }
    }
    let exact = SymmetricEigen::new(k).eigenvalues.max().sqrt();
    let inverse: Vec<_> = mass.iter().map(|m| 1.0 / m).collect();
    let mut solid = full_solid(&mesh, Volumetric::Mean, Level::detect());
    let omega = crate::largest_frequency(&inverse, |x, y| solid.add_stiffness_product(x, y), 60);
    assert!((omega / exact - 1.0).abs() < 1e-6, "{omega:e} {exact:e}");
}

#[test]
fn an_element_folded_at_a_gauss_point_is_refused_if_fully_integrated_and_found_if_it_folds_later() {
    let mesh = mesh::block([1, 1, 1], [1.0, 1.0, 1.0]);
    let corner = mesh.nodes.iter().position(|x| *x == Vector3::repeat(1.0)).unwrap();
    // The corner pushed through the opposite faces: the volume stays positive.
    let push = Padded::new([-1.1; 3]);
    let mut u = vec![Padded::ZERO; 8];
    u[corner] = push;
    let (_, _, mean) = solid(&mesh, Level::detect()).smallest_jacobian(&u);
    assert!(mean > 0.0, "{mean}");
    let (element, body, jacobian) =
        full_solid(&mesh, Volumetric::Mean, Level::detect()).smallest_jacobian(&u);
    assert!((element, body) == (0, 0) && jacobian < 0.0, "{jacobian}");

    let mut folded = mesh.clone();
    (0..3).for_each(|i| folded.nodes[corner][i] += push.0[i]);
    let build = |elements: Elements| {
        Solid::new(&folded, &[STEEL], elements, Viscosity::default(), Level::Portable)
    };
    assert!(build(ELEMENT.into()).is_ok());
    let error = build(Volumetric::Full.into()).err().unwrap();
    assert!(matches!(error, SolidError::Folded { element: 0, .. }), "{error}");
}
