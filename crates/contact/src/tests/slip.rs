use super::{K, Rig, SETTINGS};
use crate::search::Listed;
use crate::{ContactTables, PenaltySettings, Stiffness};
use friction::{
    Coulomb, Exponential, FrictionLaw, Implicit, Lagged, Memory, NodeConditions, NodeFriction,
    Remembering,
};
use mesh::Padded;
use nalgebra::{Rotation3, UnitVector3, Vector3};

const DEPTH: f64 = 3e-6;

fn exponential() -> Lagged<Exponential> {
    Lagged(Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 })
}

#[test]
fn sticking_plates_are_held_by_the_tangential_stiffness() {
    let mut rig = Rig::plates(7, 5, Coulomb { mu: 0.5 });
    rig.shift([0.0, 0.0, -DEPTH]);
    let d = [3e-7, -2e-7, -DEPTH];
    let sums = rig.shift(d);
    assert_eq!(sums.slipping, 0);
    // Border nodes that have left the other plate's border carry nothing: use what is closed.
    let held = sums.normal_force / (K * DEPTH);
    for i in 0..2 {
        let expected = -0.7 * K * held * d[i];
        assert!((sums.force[0][i] / expected - 1.0).abs() < 1e-9, "{sums:?}");
    }
    let stored = 0.5 * 0.7 * K * held * (d[0] * d[0] + d[1] * d[1]);
    assert!((sums.stored_tangential / stored - 1.0).abs() < 1e-9);
}

#[test]
fn slipping_plates_bear_mu_times_the_normal_force_against_the_motion() {
    let mut rig = Rig::slider(Coulomb { mu: 0.5 }, &SETTINGS);
    rig.shift([0.0, 0.0, -DEPTH]);
    let sums = rig.shift([6e-6, 8e-6, -DEPTH]);
    assert_eq!(sums.sticking, 0);
    for (component, direction) in sums.force[0].iter().zip([-0.6, -0.8]) {
        let expected = direction * 0.5 * sums.normal_force;
        assert!((component / expected - 1.0).abs() < 1e-9, "{sums:?}");
    }
    for side in 0..2 {
        let mut table = rig.contact.nodal_table(side);
        rig.contact.nodal(&mut table);
        for i in 0..table.nodes.len() {
            if table.pressure[i] > 0.0 {
                assert!(table.shear[i].dot(&table.slip_velocity[i]) < 0.0);
                assert_eq!(table.state[i], 2);
            }
        }
    }
}

#[test]
fn a_law_of_the_same_instant_has_the_coefficient_of_the_slip_in_this_step() {
    let law = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 0.06 };
    let mut rig = Rig::slider(Implicit(law), &SETTINGS);
    rig.shift([0.0, 0.0, -DEPTH]);
    // slower from step to step
    let coefficients = [6e-6, 10e-6, 12e-6].map(|at| {
        let sums = rig.shift([at, 0.0, -DEPTH]);
        let mut table = rig.contact.nodal_table(0);
        rig.contact.nodal(&mut table);
        let loaded = (0..table.nodes.len()).find(|&i| table.pressure[i] > 0.0).unwrap();
        let mu = law.mu(table.slip_velocity[loaded].norm());
        assert!((table.mu[loaded] - mu).abs() < 1e-12 && sums.sticking == 0, "{sums:?}");
        assert!((-sums.force[0][0] / (mu * sums.normal_force) - 1.0).abs() < 1e-9, "{sums:?}");
        mu
    });
    assert!(coefficients.windows(2).all(|pair| pair[0] + 0.01 < pair[1]), "{coefficients:?}");
}

#[test]
fn nodal_shear_never_exceeds_mu_times_pressure() {
    let mut rig = Rig::slider(exponential(), &SETTINGS);
    for step in 0..200 {
        let t = f64::from(step) * 0.05;
        let depth = DEPTH * (1.0 + 0.3 * libm::sin(t));
        rig.shift([4e-6 * libm::sin(2.0 * t), 3e-6 * libm::cos(3.1 * t), -depth]);
        for side in 0..2 {
            let mut table = rig.contact.nodal_table(side);
            rig.contact.nodal(&mut table);
            for i in 0..table.nodes.len() {
                let bound = table.mu[i] * table.pressure[i];
                assert!(table.shear[i].norm() <= bound * (1.0 + 1e-14) + 1e-300);
                assert!(table.mu[i] <= 0.5 + 1e-15 && table.mu[i] >= 0.32 - 1e-15);
            }
        }
    }
}

#[test]
fn nodal_tractions_times_area_are_the_forces_on_the_surface() {
    let mut rig = Rig::slider(Coulomb { mu: 0.4 }, &SETTINGS);
    rig.shift([0.0, 0.0, -DEPTH]);
    let sums = rig.shift([5e-7, 3e-7, -DEPTH]);
    for side in 0..2 {
        let mut table = rig.contact.nodal_table(side);
        rig.contact.nodal(&mut table);
        let mut total = Vector3::zeros();
        for i in 0..table.nodes.len() {
            total += table.area[i] * table.shear[i];
            total[2] += [1.0, -1.0][side] * table.area[i] * table.pressure[i];
            let node = table.nodes[i] as usize;
            let f = rig.force[node].vector() / table.area[i];
            assert!((f[0] - table.shear[i][0]).abs() < 1e-9 * K * DEPTH);
        }
        assert!((total - sums.force[side]).norm() < 1e-11 * sums.normal_force);
    }
}

#[test]
fn part_of_the_surface_has_the_values_of_the_whole() {
    let mut rig = Rig::slider(Coulomb { mu: 0.4 }, &SETTINGS);
    rig.shift([0.0, 0.0, -DEPTH]);
    rig.shift([5e-7, 3e-7, -DEPTH]);
    let mut whole = rig.contact.nodal_table(0);
    rig.contact.nodal(&mut whole);
    let face = mesh::Face { nodes: [whole.nodes[8], whole.nodes[9], whole.nodes[3], 9999], hex: 0 };
    let mut part = ContactTables::nodal_table_of(&rig.contact, 0, &[face]);
    rig.contact.nodal(&mut part);
    assert_eq!(part.nodes, [whole.nodes[3], whole.nodes[8], whole.nodes[9]]);
    for (row, i) in [3, 8, 9].into_iter().enumerate() {
        assert_eq!(part.shear[row], whole.shear[i]);
        assert_eq!(part.pressure[row], whole.pressure[i]);
    }
}

#[test]
fn common_rotation_makes_no_friction_and_carries_stored_forces_along() {
    let axis = UnitVector3::new_normalize(Vector3::new(1.0, 2.0, 3.0));
    let rotation = |angle| Rotation3::from_axis_angle(&axis, angle);
    let centre = Vector3::new(3e-3, -2e-3, 5e-3);
    for slid in [[0.0, 0.0], [3e-7, -2e-7]] {
        let mut rig = Rig::plates(6, 6, Coulomb { mu: 0.5 });
        rig.shift([0.0, 0.0, -DEPTH]);
        let place = move |body: usize, x: Vector3<f64>| {
            if body == 0 { x + Vector3::new(slid[0], slid[1], -DEPTH) } else { x }
        };
        rig.step(place);
        let start = rig.apply();
        let mut end = start;
        for step in 1..=1000 {
            let turn = rotation(f64::from(step) * 2e-3);
            end = rig.step(|body, x| centre + turn * (place(body, x) - centre));
        }
        let error = (end.force[0] - rotation(2.0) * start.force[0]).norm() / start.normal_force;
        assert!(error < 1e-8, "{error:e}");
        let before = start.stored_tangential.sqrt();
        let limit = 1e-8 * start.stored_normal.sqrt();
        assert!((end.stored_tangential.sqrt() - before).abs() < limit);
    }
}

#[test]
fn work_on_a_path_is_stored_or_dissipated() {
    for mu in [0.05, 0.3, 10.0] {
        let mut rig = Rig::slider(Coulomb { mu }, &SETTINGS);
        let mut last = rig.shift([0.0, 0.0, -DEPTH]);
        let first = last;
        let (mut work, mut dissipated, mut exchanged) = (0.0, 0.0, 0.0);
        let mut at = Vector3::new(0.0, 0.0, -DEPTH);
        for step in 1..=400 {
            let t = f64::from(step) * std::f64::consts::TAU / 400.0;
            let to = Vector3::new(2e-6 * libm::sin(2.0 * t), 3e-6 * (1.0 - libm::cos(t)), -DEPTH);
            let sums = rig.shift(to);
            let share = 0.5 * (last.force[0] + sums.force[0]).dot(&(to - at));
            work += share;
            exchanged += share.abs();
            dissipated += sums.friction_work;
            assert!(sums.friction_work >= 0.0);
            (at, last) = (to, sums);
        }
        let stored = last.stored_tangential - first.stored_tangential;
        let error = (work + stored + dissipated).abs() / exchanged;
        assert!(error < 1e-10, "mu {mu}: {error:e}");
        assert!((mu > 1.0) == (dissipated == 0.0));
    }
}

#[test]
fn sliding_over_many_faces_keeps_the_force() {
    let mut rig = Rig::slider(Coulomb { mu: 0.3 }, &SETTINGS);
    rig.shift([0.0, 0.0, -DEPTH]);
    for step in 1..=4000 {
        // Ten millimetres: eleven faces of the lower plate.
        let sums = rig.shift([f64::from(step) * 2.5e-6, 0.0, -DEPTH]);
        if step > 10 {
            // The lower plate's nodes under the slider come and go; each new one takes its share
            // of the friction within k_t-distance: compare with the slaves of the slider alone.
            let mut table = rig.contact.nodal_table(0);
            rig.contact.nodal(&mut table);
            let own: f64 = rig.contact.points[0].iter().map(|p| p.friction[0]).sum();
            let expected = -0.3 * 0.5 * K * 16e-6 * DEPTH;
            assert!((own / expected - 1.0).abs() < 1e-9, "step {step}: {own} {expected}");
            assert!(rig.contact.points[0].iter().all(|p| p.state == crate::point::State::Slip));
            assert!(sums.friction_work > 0.0);
        }
    }
    let slip = rig.contact.points[0][0].slip;
    assert!((slip[0] / 1e-2 - 1.0).abs() < 1e-9 && slip[1].abs() < 1e-12, "{slip:?}");
}

#[test]
fn coefficient_is_that_of_the_slip_speed_one_step_before() {
    let law = exponential();
    let mut rig = Rig::slider(law, &SETTINGS);
    rig.shift([0.0, 0.0, -DEPTH]);
    let mut x = 0.0;
    let mut before = 0.0;
    for speed in [10.0, 0.5, 3.0, 0.05] {
        x += speed * rig.dt;
        rig.shift([x, 0.0, -DEPTH]);
        for point in rig.contact.points[0].iter().filter(|p| p.is_closed()) {
            assert!((point.mu - law.0.mu(before)).abs() < 1e-7);
            assert!((point.slip_velocity.norm() - speed).abs() < 1e-6);
        }
        before = speed;
    }
}

#[test]
fn first_step_of_contact_has_no_friction_and_knows_the_speed_of_the_nodes() {
    let law = exponential();
    let mut rig = Rig::slider(law, &SETTINGS);
    rig.shift([0.0, 0.0, 1e-7]);
    let sums = rig.shift([2.0 * rig.dt, 0.0, -DEPTH]);
    assert!(sums.closed > 0);
    assert_eq!(sums.force[0][0], 0.0);
    for point in &rig.contact.points[0] {
        assert!((point.slip_velocity.norm() - 2.0).abs() < 1e-6);
        assert!((point.mu - law.0.mu(2.0)).abs() < 1e-7);
    }
}

#[test]
fn friction_spring_of_a_pair_that_opens_is_lost_to_dissipation() {
    let mut rig = Rig::plates(6, 6, Coulomb { mu: 0.5 });
    rig.shift([0.0, 0.0, -DEPTH]);
    let stored = rig.shift([3e-7, 0.0, -DEPTH]).stored_tangential;
    assert!(stored > 0.0);
    let opened = rig.shift([3e-7, 0.0, 1e-7]);
    assert_eq!(opened.closed, 0);
    assert!((opened.friction_work / stored - 1.0).abs() < 1e-14);
    assert_eq!(rig.shift([3e-7, 0.0, 1e-7]).friction_work, 0.0);
}

#[test]
fn zero_tangential_stiffness_is_contact_without_friction() {
    let settings = PenaltySettings { tangential: Stiffness::Areal(0.0), ..SETTINGS };
    let mut rig = Rig::slider(Coulomb { mu: 0.5 }, &settings);
    rig.shift([0.0, 0.0, -DEPTH]);
    let sums = rig.shift([1e-5, 0.0, -DEPTH]);
    assert_eq!(sums.force[0][0], 0.0);
    assert!(sums.stored_tangential == 0.0 && sums.friction_work == 0.0);
}

#[test]
fn the_state_of_a_law_begins_with_the_preload() {
    let steady = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
    let memory = Memory { distance: 1e-3, floor: 1e-2 };
    let mut rig = Rig::plates(7, 5, Remembering { steady, memory });
    rig.displacement[..rig.upper].fill(Padded::new([0.0, 0.0, -DEPTH]));
    rig.apply_frictionless();
    rig.apply();
    let mut table = rig.contact.nodal_table(0);
    rig.contact.nodal(&mut table);
    let pressed = (0..table.nodes.len()).filter(|&i| table.pressure[i] > 0.0);
    let used: Vec<f64> = pressed.map(|i| table.mu[i]).collect();
    assert!(!used.is_empty() && used.iter().all(|mu| (mu - 0.5).abs() < 1e-3), "{used:?}");
}

#[test]
fn a_coefficient_that_is_no_number_shows_in_the_forces() {
    let mut rig = Rig::slider(Coulomb { mu: 0.5 }, &SETTINGS);
    rig.shift([0.0, 0.0, -DEPTH]);
    assert!(rig.shift([6e-6, 0.0, -DEPTH]).force[0][0].is_finite());
    let mut rig = Rig::slider(Lost, &SETTINGS);
    rig.shift([0.0, 0.0, -DEPTH]);
    assert!(rig.shift([6e-6, 0.0, -DEPTH]).force[0][0].is_nan());
}

/// A law that loses its value.
#[derive(Debug)]
struct Lost;

impl NodeFriction for Lost {
    fn begin(&self, _: &NodeConditions) -> [f64; 2] {
        [0.0; 2]
    }

    fn advance(&self, state: [f64; 2], _: f64, _: &NodeConditions, _: f64) -> [f64; 2] {
        state
    }

    fn mu(&self, _: [f64; 2], _: f64, _: &NodeConditions) -> f64 {
        f64::NAN
    }

    fn mu_static(&self) -> f64 {
        0.5
    }
}
