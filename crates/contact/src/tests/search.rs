use super::{K, Rig, SETTINGS};
use crate::face::{Positions, project};
use crate::search::Listed;
use crate::tests::plates::{plate, tread};
use friction::Coulomb;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

/// Every penetration that projecting all nodes on the master from all of its faces finds, against
/// the closed points.
fn closed_by_brute_force(rig: &Rig) -> [Vec<u32>; 2] {
    let position = rig.contact.trace.positions(&rig.reference, &rig.displacement);
    let positions = Positions(&position);
    [0, 1].map(|slave: usize| {
        let (own, master) = (&rig.contact.sides[slave], &rig.contact.sides[1 - slave]);
        (0..own.len() as u32)
            .filter(|&i| {
                let x = positions.at(own.node(i));
                (0..master.faces.len() as u32).step_by(7).any(|f| {
                    project(master, &positions, true, x, f, 0.0, 0.0)
                        .projection
                        .is_some_and(|projection| projection.gap < 0.0)
                })
            })
            .collect()
    })
}

fn closed(rig: &Rig) -> [Vec<u32>; 2] {
    [0, 1].map(|slave: usize| {
        let points = rig.contact.points[slave].iter();
        points.filter(|p| p.is_closed()).map(|p| p.slave).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, ..ProptestConfig::default() })]

    #[test]
    fn search_misses_no_node_of_a_disk_that_moves_smoothly(
        speed in 0.0..60.0_f64,
        spin in -120.0..120.0_f64,
        bounce in 0.0..40.0_f64,
        frequency in 0.5..3.0_f64,
        sideways in -10.0..10.0_f64,
    ) {
        let radius = 0.46;
        let mut rig = Rig::new(
            tread(radius, 0.03, 8e-3, [28, 8], 1e-3),
            plate([-15e-3, -4e-3], [15e-3, 4e-3], [31, 7], 0.0, 1e-3, true),
            &SETTINGS,
            Coulomb { mu: 0.3 },
        );
        rig.dt = 2e-7;
        let mut searches = 0;
        for step in 0..400 {
            let t = f64::from(step) * rig.dt;
            let omega = frequency * 1e5;
            let drop = bounce / omega * libm::sin(omega * t) - 1e-5;
            let centre = radius * Vector3::z();
            let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), spin * t);
            let moved = Vector3::new(speed * t, sideways * t, drop);
            let sums = rig.step(|body, x| {
                if body == 0 { centre + turn * (x - centre) + moved } else { x }
            });
            searches += usize::from(sums.searched);
            if step % 25 == 24 {
                prop_assert_eq!(closed(&rig), closed_by_brute_force(&rig));
            }
        }
        prop_assert!(searches < 400);
    }
}

#[test]
fn deep_penetration_at_the_first_call_is_found() {
    let mut rig = Rig::plates(7, 5, Coulomb { mu: 0.3 });
    let sums = rig.shift([0.0, 0.0, -3e-4]);
    assert_eq!(sums.closed, 64 + 36);
    assert!((sums.normal_force / (K * 64e-6 * 3e-4) - 1.0).abs() < 1e-9);
}

#[test]
fn resting_contact_is_searched_once() {
    let mut rig = Rig::plates(7, 5, Coulomb { mu: 0.3 });
    assert!(rig.shift([0.0, 0.0, -1e-6]).searched);
    for step in 0..500 {
        let wobble = 1e-7 * libm::sin(f64::from(step));
        assert!(!rig.shift([0.0, 0.0, -1e-6 + wobble]).searched);
    }
}

#[test]
fn common_motion_of_both_bodies_needs_no_search() {
    let mut rig = Rig::plates(7, 5, Coulomb { mu: 0.3 });
    rig.shift([0.0, 0.0, -1e-6]);
    for step in 1..500 {
        let far = 1e-5 * f64::from(step);
        let deep = |body| if body == 0 { 1e-6 } else { 0.0 };
        let sums = rig.step(|body, x| x + Vector3::new(far, 0.0, far - deep(body)));
        assert!(!sums.searched && sums.closed == 100);
    }
}

#[test]
fn positions_that_are_not_numbers_do_not_panic() {
    let mut rig = Rig::plates(7, 5, Coulomb { mu: 0.3 });
    rig.shift([0.0, 0.0, -1e-6]);
    for u in &mut rig.displacement[..20] {
        u[0] = f64::NAN;
    }
    for _ in 0..100 {
        rig.apply();
    }
    rig.step(|_, x| x + f64::NAN * Vector3::x());
    rig.contact.search = crate::search::Search::new(&rig.contact.sides);
    rig.apply();
}

#[test]
fn surfaces_that_only_one_or_two_faces_share_are_found() {
    for (along, faces) in [(7.5e-3, 1), (6.5e-3, 2)] {
        // The last faces in reach of the upper plate are neither first nor second of their side.
        let mut rig = Rig::plates(4, 8, Coulomb { mu: 0.0 });
        let sums = rig.shift([along, 7.5e-3, -1e-6]);
        assert!(sums.closed > 0, "{faces}: {sums:?}");
    }
}

#[test]
fn bodies_that_have_come_twice_as_fast_since_the_last_look_are_found_when_they_touch() {
    let mut rig = Rig::plates(4, 4, Coulomb { mu: 0.3 });
    // each may move by a margin until they touch: a tenth of it by the first look, then two tenths a step
    let margin = 0.1 * 2e-3;
    for step in 0..10 {
        let moved = if step == 0 { 0.0 } else { 0.2 * f64::from(step) - 0.1 } * margin;
        let sums = rig.step(|body, x| {
            x + (if body == 0 { 2.0 * margin - moved } else { moved }) * Vector3::z()
        });
        assert_eq!(sums.closed, if moved > margin { 50 } else { 0 }, "step {step}: {sums:?}");
    }
}
