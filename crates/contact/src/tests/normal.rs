use super::{K, Rig, SETTINGS};
use crate::tests::plates::plate;
use crate::{ContactError, PenaltyContact, PenaltySettings, Stiffness};
use friction::Coulomb;
use mesh::{Mesh, Padded, Surface};
use nalgebra::Vector3;

const AREA: f64 = 64e-6;
const DEPTH: f64 = 3e-6;

fn press(mut rig: Rig) -> (Rig, crate::ContactSums) {
    let sums = rig.shift([0.0, 0.0, -DEPTH]);
    (rig, sums)
}

#[test]
fn plates_pressed_uniformly_carry_stiffness_times_area_times_depth() {
    for (fine, coarse) in [(6, 6), (7, 4), (5, 11)] {
        let (_, sums) = press(Rig::plates(fine, coarse, Coulomb { mu: 0.3 }));
        let expected = K * AREA * DEPTH;
        assert!((sums.normal_force / expected - 1.0).abs() < 1e-10, "{fine} {coarse} {sums:?}");
        assert!((sums.force[0][2] / expected - 1.0).abs() < 1e-10);
        assert_eq!(sums.closed, (fine + 1).pow(2) + (coarse + 1).pow(2));
        assert!((sums.max_penetration / DEPTH - 1.0).abs() < 1e-9);
        let stored = 0.5 * K * AREA * DEPTH * DEPTH;
        assert!((sums.stored_normal / stored - 1.0).abs() < 1e-9);
    }
}

#[test]
fn matched_plates_pressed_uniformly_have_one_pressure_everywhere() {
    let (rig, _) = press(Rig::plates(6, 6, Coulomb { mu: 0.3 }));
    for side in 0..2 {
        let mut table = rig.contact.nodal_table(side);
        rig.contact.nodal(&mut table);
        assert_eq!(table.nodes.len(), 49);
        for (p, gap) in table.pressure.iter().zip(&table.gap) {
            assert!((p / (K * DEPTH) - 1.0).abs() < 1e-9);
            assert!((gap / DEPTH + 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn actions_equal_reactions_and_their_moments_balance() {
    let (rig, sums) = press(Rig::plates(7, 4, Coulomb { mu: 0.3 }));
    let (mut total, mut moment) = (Vector3::zeros(), Vector3::zeros());
    for (i, f) in rig.force.iter().enumerate() {
        total += f.vector();
        let x = rig.reference[i].vector() + rig.displacement[i].vector();
        moment += x.cross(&f.vector());
    }
    assert!(total.norm() < 1e-14 * sums.normal_force, "{total:?}");
    assert!(moment.norm() < 1e-12 * sums.normal_force * 8e-3, "{moment:?}");
    for i in 0..3 {
        assert!((sums.force[0][i] + sums.force[1][i]).abs() <= 1e-14 * sums.normal_force);
    }
}

#[test]
fn separated_plates_do_not_feel_one_another() {
    let mut rig = Rig::plates(6, 6, Coulomb { mu: 0.3 });
    for gap in [1e-9, 1e-4, 5e-3] {
        let sums = rig.shift([0.0, 0.0, gap]);
        assert_eq!((sums.closed, sums.normal_force), (0, 0.0));
        assert!(rig.force.iter().all(|f| *f == Padded::ZERO));
    }
}

/// Plates with the same cells, of which those below are unequally deep; the upper one is moved by `x`
/// and pressed in equilibrium, after it was pressed at all the `x` before.
fn on_unequal_elements(x: &[f64]) -> f64 {
    let settings = PenaltySettings { normal: Stiffness::Factor(0.1), ..SETTINGS };
    let (mut mesh, surface) = plate([0.0, 0.0], [8e-3, 8e-3], [8, 8], 0.0, 1e-3, true);
    for node in mesh.nodes.iter_mut().filter(|node| node[2] < 0.0) {
        let phase: f64 = 900.0 * node[0] + 400.0 * node[1];
        node[2] *= 1.0 + 0.4 * libm::sin(phase);
    }
    let upper = plate([2e-3, 2e-3], [6e-3, 6e-3], [4, 4], 0.0, 1e-3, false);
    let mut rig = Rig::new(upper, (mesh, surface), &settings, Coulomb { mu: 0.3 });
    let mut found = f64::NAN;
    for &x in x {
        let moved = Padded::new([x, x, -DEPTH]);
        rig.displacement[..rig.upper].fill(moved);
        rig.contact.expect_jump();
        let sums = rig.apply_frictionless();
        found = sums.normal_force;
    }
    found
}

#[test]
fn force_in_equilibrium_changes_little_where_nodes_cross_the_edges_of_unequal_faces() {
    let (behind, ahead) = (on_unequal_elements(&[-1e-8]), on_unequal_elements(&[1e-8]));
    assert!((behind / ahead - 1.0).abs() < 1e-5, "{behind} {ahead}");
}

#[test]
fn force_in_equilibrium_is_that_of_the_positions_alone() {
    let straight = on_unequal_elements(&[4e-4]);
    let over_other_faces = on_unequal_elements(&[1.5e-3, -7e-4, 4e-4]);
    assert!((over_other_faces / straight - 1.0).abs() < 1e-12);
}

#[test]
fn scale_gives_bulk_modulus_over_depth_in_each_pass() {
    let settings = PenaltySettings { normal: Stiffness::Factor(0.1), ..SETTINGS };
    let mut rig = Rig::slider(Coulomb { mu: 0.3 }, &settings);
    let sums = rig.shift([0.0, 0.0, -DEPTH]);
    // Pass 0 has 36 slaves on the whole upper plate; pass 1 those lower nodes that lie under it.
    let upper = 0.1 * 175e9 / 1e-3 * 16e-6 * DEPTH;
    let cell = 20e-3 / 23.0 * 8e-3 / 9.0;
    let lower = 0.1 * 175e9 / 1e-3 * cell * (sums.closed - 36) as f64 * DEPTH;
    assert!((sums.normal_force / (upper + lower) - 1.0).abs() < 1e-9, "{sums:?}");
}

#[test]
fn a_node_that_slides_off_the_border_books_what_its_spring_held() {
    let mut rig = Rig::slider(Coulomb { mu: 0.0 }, &SETTINGS);
    let before = rig.shift([0.0, 0.0, -DEPTH]);
    // one row of four lower nodes leaves the upper plate, none enters
    let after = rig.shift([0.5e-3, 0.0, -DEPTH]);
    assert_eq!(before.closed - after.closed, 4);
    let cell = 20e-3 / 23.0 * 8e-3 / 9.0;
    let held = 4.0 * 0.5 * (0.5 * K * cell) * DEPTH * DEPTH;
    assert!((after.damping_work / held - 1.0).abs() < 1e-9, "{after:?} {held}");
    assert!(((before.stored_normal - after.stored_normal) / held - 1.0).abs() < 1e-8);
}

#[test]
fn frictionless_call_gives_the_same_normal_forces() {
    let (mut rig, sums) = press(Rig::plates(7, 4, Coulomb { mu: 0.0 }));
    let mut other = Rig::plates(7, 4, Coulomb { mu: 0.5 });
    other.displacement.clone_from(&rig.displacement);
    let alone = other.apply_frictionless();
    assert_eq!(alone.normal_force, sums.normal_force);
    assert_eq!(other.force, rig.force);
    rig.apply();
    assert_eq!(other.force, rig.force);
}

#[test]
fn damper_resists_closing_by_its_fraction_of_critical_and_its_work_is_booked() {
    let settings = PenaltySettings { damping: 0.1, ..SETTINGS };
    let plate = |up| crate::tests::plates::plate([0.0, 0.0], [8e-3, 8e-3], [6, 6], 0.0, 1e-3, up);
    let mut rig = Rig::new(plate(false), plate(true), &settings, Coulomb { mu: 0.3 });
    rig.shift([0.0, 0.0, -DEPTH]);
    let closing = 0.4;
    let sums = rig.shift([0.0, 0.0, -DEPTH - closing * rig.dt]);
    // Matched nodes: weight one on one corner, so 1/m_red = 1e3 + 1e3.
    let mut expected = 0.0;
    for area in rig.contact.nodal_table(0).area {
        let k = 0.5 * K * area;
        let damper = 0.1 * 2.0 * (k / 2e3_f64).sqrt() * closing;
        expected += 2.0 * (k * (DEPTH + closing * rig.dt) + damper);
    }
    assert!((sums.normal_force / expected - 1.0).abs() < 1e-7, "{sums:?} {expected}");
    assert!(sums.damping_work > 0.0);
    let steady = rig.shift([0.0, 0.0, -DEPTH - closing * rig.dt]);
    assert!(steady.damping_work.abs() < 1e-9 * sums.damping_work);
    // Parting fast: the damper may release the surfaces but never pull them.
    let parting = rig.shift([0.0, 0.0, -0.01 * DEPTH]);
    assert_eq!(parting.normal_force, 0.0);
}

#[test]
fn stiffness_product_is_the_change_of_force() {
    let (mut rig, _) = press(Rig::plates(5, 4, Coulomb { mu: 1e3 }));
    let n = rig.reference.len();
    let x: Vec<Padded> = (0..n)
        .map(|i| {
            let s = i as f64;
            Padded::new([
                libm::sin(1.3 * s) * 1e-12,
                libm::cos(2.1 * s) * 1e-12,
                libm::sin(0.7 * s) * 1e-12,
            ])
        })
        .collect();
    rig.apply();
    let before = rig.force.clone();
    let mut product = vec![Padded::ZERO; n];
    rig.contact.stiffness_product(&x, &mut product);
    for (u, x) in rig.displacement.iter_mut().zip(&x) {
        *u += x.vector();
    }
    rig.apply();
    let scale = product.iter().map(|p| p.vector().norm()).fold(0.0, f64::max);
    for i in 0..n {
        for c in 0..3 {
            let change = before[i][c] - rig.force[i][c];
            // The normals turn with the faces: forces of k_n g turn by 1e-12/1e-3.
            assert!((change - product[i][c]).abs() < 5e-3 * scale, "{change} {}", product[i][c]);
        }
    }
}

#[test]
fn diagonal_bounds_hold_for_the_largest_eigenvalue() {
    for (fine, coarse) in [(6, 6), (8, 6), (9, 4)] {
        let (rig, _) = press(Rig::plates(fine, coarse, Coulomb { mu: 0.3 }));
        let n = rig.reference.len();
        let mut bound = vec![0.0; n];
        rig.contact.nodal_stiffness_bound(&mut bound);
        // Largest eigenvalue of bound^-1 K and of M^-1 K by power iteration.
        let eigenvalue = |inverse: &[f64]| {
            let mut x: Vec<Padded> =
                (0..n).map(|i| Padded::new([0.1, 0.2, libm::sin(1.7 * i as f64)])).collect();
            let mut value = 0.0;
            for _ in 0..400 {
                let mut y = vec![Padded::ZERO; n];
                rig.contact.stiffness_product(&x, &mut y);
                value = 0.0;
                for i in 0..n {
                    x[i] = (y[i].vector() * inverse[i]).into();
                    value = x[i].vector().norm().max(value);
                }
                x.iter_mut().for_each(|v| *v = (v.vector() / value).into());
            }
            value
        };
        let by_bound: Vec<f64> =
            bound.iter().map(|b| if *b > 0.0 { 1.0 / b } else { 0.0 }).collect();
        let largest = eigenvalue(&by_bound);
        assert!(largest <= 1.0 + 1e-9 && largest > 0.5, "{largest}");
        let exact = eigenvalue(&rig.inverse_mass);
        let rigorous = rig.contact.rigorous_omega_squared(&rig.inverse_mass);
        assert!(exact <= rigorous * (1.0 + 1e-9) && rigorous < 2.0 * exact, "{exact} {rigorous}");
    }
}

#[test]
fn wrong_settings_are_refused() {
    let mesh = Mesh::default();
    let surfaces =
        || [(&EMPTY, crate::tests::plates::STEEL), (&EMPTY, crate::tests::plates::STEEL)];
    static EMPTY: Surface = Surface { faces: Vec::new(), smooth: None, irregularity: None };
    let refused = |settings: PenaltySettings, mu: f64| {
        PenaltyContact::new(&mesh, surfaces(), &settings, None, Box::new(Coulomb { mu }))
            .unwrap_err()
    };
    let named = |e: ContactError| match e {
        ContactError::Value { name, .. } => name,
        other => panic!("{other}"),
    };
    let normal = PenaltySettings { normal: Stiffness::Factor(-0.1), ..SETTINGS };
    assert_eq!(named(refused(normal, 0.3)), "the normal contact stiffness");
    let tangential = PenaltySettings { tangential: Stiffness::Areal(f64::NAN), ..SETTINGS };
    assert_eq!(named(refused(tangential, 0.3)), "the tangential contact stiffness");
    let damping = PenaltySettings { damping: 3.0, ..SETTINGS };
    assert_eq!(named(refused(damping, 0.3)), "the contact damping");
    assert_eq!(named(refused(SETTINGS, -0.3)), "the coefficient of friction");
    let fraction = PenaltySettings { normal: Stiffness::Stability(0.5), ..SETTINGS };
    assert_eq!(refused(fraction, 0.3), ContactError::NoStabilityScale);
    assert_eq!(refused(SETTINGS, 0.3), ContactError::EmptySurface { side: 0 });
}
