//! Half of a symmetric model gives what the whole gives, in numbers of the whole.

use runs::{Results, load, project, run, run_with};
use std::collections::BTreeMap;

const HALF: &str = "mesh.symmetry=half";
const EXACT: &str = "contact.enforcement=exact";
const MORTAR: &str = "contact.rows=mortar";

/// The small case with the same step and a tight preload, so that nothing but the model differs.
const ALIKE: [&str; 3] = ["time.step=4e-8", "preload.tolerance=1e-11", "time.roll=0.002"];

fn small(sets: &[&str]) -> Results {
    run(&load(&project("tests/small.toml"), &[&ALIKE, sets].concat()), 2)
}

/// Row of each recorded node by body and undeformed position.
fn places(found: &Results) -> BTreeMap<(bool, [i64; 3]), usize> {
    let points = &found.data["contact/points"];
    let disk = found.nodes_of_disk();
    let at = |row: usize| [0, 1, 2].map(|i| (points[3 * row + i] * 1e9).round() as i64);
    (0..points.len() / 3).map(|row| ((row < disk, at(row)), row)).collect()
}

/// Which nodes to compare.
#[derive(Clone, Copy, PartialEq)]
enum Nodes {
    OnPlane,
    OffPlane,
}

/// Largest difference of a field between two runs over its scale, at the same nodes, or (`mirror` -1) at their mirror
/// images.
fn difference(one: &Results, other: &Results, field: &str, nodes: Nodes, mirror: i64) -> f64 {
    let (here, there) = (places(one), places(other));
    assert_eq!(here.len(), there.len());
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (a, b) in one.contact(field).into_iter().zip(other.contact(field)) {
        let parts = a.len() / here.len();
        largest = a.iter().fold(largest, |largest, x| largest.max(x.abs()));
        let wanted = |y: i64| (y == 0) == (nodes == Nodes::OnPlane);
        for (&(body, [x, y, z]), &row) in here.iter().filter(|((_, [_, y, _]), _)| wanted(*y)) {
            let twin = there[&(body, [x, mirror * y, z])];
            for i in 0..parts {
                let sign = if i == 1 { mirror as f64 } else { 1.0 };
                let (mine, theirs) = (a[parts * row + i], sign * b[parts * twin + i]);
                worst = worst.max((mine - theirs).abs());
            }
        }
    }
    assert!(largest > 0.0, "{field}");
    worst / largest
}

/// While the whole keeps its symmetry: the first 10 us. Later round-off tells its two sides apart.
const BEGINNING: &str = "time.roll=0.0004";

#[test]
fn fields_of_the_half_are_those_of_the_whole_while_that_keeps_its_symmetry() {
    let memory =
        ["friction.law=exponential", "friction.static=0.5", "friction.memory.distance=10e-6"];
    // 5e-6 in shear, whose cause is not known; node to face has less than 1e-6
    let mortar = [&memory[..], &[MORTAR, "time.roll=0.0002"]].concat();
    for (keys, slack) in [(&["friction.law=coulomb"][..], 1e-6), (&memory, 1e-6), (&mortar, 1e-5)] {
        let sets = [&[EXACT, BEGINNING][..], keys].concat();
        let (whole, half) = (small(&sets), small(&[&sets[..], &[HALF]].concat()));
        for field in ["pressure", "shear", "displacement", "velocity"] {
            let own = difference(&whole, &whole, field, Nodes::OffPlane, -1);
            let found = difference(&whole, &half, field, Nodes::OffPlane, 1);
            assert!(own < 1e-6, "{field}: the whole is not symmetric: {own:e}");
            assert!(found < slack, "{field}: {found:e}");
        }
        // there the whole takes the normal of one of the two facets that meet under the node
        let on_plane = difference(&whole, &half, "pressure", Nodes::OnPlane, 1);
        assert!(on_plane < 1e-5, "{on_plane:e}");
    }
}

#[test]
fn numbers_of_the_half_are_those_of_the_whole_bodies() {
    // the whole prefers a side of the plane by one of the two faces under a node over an edge, springs more than means
    let enforcements = [(&[EXACT, MORTAR][..], 1e-5), (&["contact.enforcement=penalty"], 1e-4)];
    for (enforcement, slack) in enforcements {
        let whole = small(enforcement);
        let half = small(&[enforcement, &[HALF]].concat());
        for pointer in [
            "/contact/normal_force",
            "/contact/tangential_force",
            "/contact/patch_area",
            "/contact/patch_area_fitted",
            "/contact/patch_half_length",
            "/contact/patch_half_width",
            "/contact/peak_pressure",
            "/energy/kinetic",
            "/energy/internal",
            "/energy/friction_dissipated",
            "/energy/external_work",
            "/preload/normal_force",
        ] {
            let [one, other] = [&whole, &half].map(|run| run.number(pointer));
            assert!((other / one - 1.0).abs() < slack, "{enforcement:?} {pointer}: {one} {other}");
        }
        assert!(half.number("/checks/resultant_mismatch") < 1e-12);
        let [limit, of_half] = [&whole, &half].map(|run| run.number("/stability/dt_limit"));
        // the half has no motions that are not symmetric; Lanczos finds its largest frequency to 1e-3
        assert!((of_half / limit - 1.0).abs() < 2e-3, "{limit:e} {of_half:e}");
        assert!(half.number("/energy/balance_error") < 1e-4);
        assert_eq!(2.0 * half.number("/elements"), whole.number("/elements"));
        assert_eq!(half.number("/preload/closed_pairs"), whole.number("/preload/closed_pairs"));
        let [one, other] = [&whole, &half].map(|run| run.contact("area")[0].iter().sum::<f64>());
        assert!((other / one - 1.0).abs() < 1e-12, "{one} {other}");
    }
}

#[test]
fn a_node_on_the_plane_stays_on_it_and_neither_slip_nor_friction_of_a_slave_crosses_it() {
    for enforcement in [&[EXACT][..], &[EXACT, MORTAR], &["contact.enforcement=penalty"]] {
        let law = ["friction.law=exponential", "friction.static=0.5", HALF];
        let half = small(&[enforcement, &law].concat());
        let points = &half.data["contact/points"];
        // the slaves of exact contact are the disk's nodes; of springs those of both bodies, which are masters too
        let slaves = half.nodes_of_disk();
        let on_plane: Vec<usize> = (0..slaves).filter(|row| points[3 * row + 1] == 0.0).collect();
        assert!(!on_plane.is_empty());
        let mut slipped = 0.0_f64;
        for field in ["displacement", "velocity", "shear", "slip", "slip_velocity"] {
            for record in half.contact(field) {
                for row in &on_plane {
                    assert_eq!(record[3 * row + 1], 0.0, "{enforcement:?} {field}");
                    slipped = slipped.max(record[3 * row].abs());
                }
            }
        }
        assert!(slipped > 0.0);
    }
}

#[test]
fn torque_hub_mass_and_probes_are_of_the_whole_bodies() {
    let sets = [
        EXACT,
        "drive.mode=torque",
        "drive.torque=150",
        "load.hub_mass=3.0",
        "output.probes.bar=[[0.001, -0.0008]]",
    ];
    let file = tempfile::tempdir().unwrap();
    let path = file.path().join("torque.toml");
    let text = std::fs::read_to_string(project("tests/small.toml")).unwrap();
    std::fs::write(&path, text.replace("creepage = 4e-3", "")).unwrap();
    let of = |more: &[&str]| run(&load(&path, &[&ALIKE[..], &sets, more].concat()), 2);
    let (whole, half) = (of(&[]), of(&[HALF]));
    for column in ["torque", "omega", "hub_z", "normal_force", "tangential_force", "kinetic"] {
        let (one, other) = (whole.history(column), half.history(column));
        let scale = one.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
        let worst = one.iter().zip(other).fold(0.0_f64, |w, (a, b)| w.max((a - b).abs()));
        assert!(worst < 1e-5 * scale, "{column}: {worst:e} of {scale:e}");
    }
    let probe = |run: &Results, column: &str| {
        run.data[&format!("probes/probe0_{column}")]
            .iter()
            .fold(0.0_f64, |s, x| if x.abs() > s.abs() { *x } else { s })
    };
    for column in ["pressure", "shear_x", "shear_y"] {
        let [one, other] = [&whole, &half].map(|run| probe(run, column));
        assert!(one != 0.0 && (other / one - 1.0).abs() < 1e-3, "{column}: {one} {other}");
    }
}

#[test]
fn a_zone_of_an_odd_number_of_elements_gets_one_more_and_the_log_says_so() {
    let odd = [EXACT, HALF, "mesh.zone.width=5.6e-3", "time.roll=0.0002"];
    let (_, log) = run_with(&load(&project("tests/small.toml"), &odd), 1, None);
    assert!(log.contains("the fine zone is 6.4 mm wide"), "{log}");
}

#[test]
fn both_gradings_and_surfaces_without_curvature_roll_at_the_default_step_as_the_whole_does() {
    for more in
        [&["contact.curvature=false"][..], &["mesh.grading=two_to_one"], &["contact.rows=mortar"]]
    {
        let sets = [&[EXACT, "time.roll=0.002", "load.mode=height"][..], more].concat();
        let of = |sets: &[&str]| run(&load(&project("tests/small.toml"), sets), 2);
        let (whole, half) = (of(&sets), of(&[&sets[..], &[HALF]].concat()));
        for pointer in
            ["/contact/normal_force", "/contact/tangential_force", "/contact/peak_pressure"]
        {
            let [one, other] = [&whole, &half].map(|run| run.number(pointer));
            assert!((other / one - 1.0).abs() < 1e-3, "{more:?} {pointer}: {one} {other}");
        }
        assert!(half.number("/energy/balance_error") < 1e-4);
    }
}

#[test]
fn the_log_says_that_what_is_not_symmetric_is_suppressed() {
    let case = load(&project("tests/small.toml"), &[EXACT, HALF, "time.roll=0.0002"]);
    let (found, log) = run_with(&case, 1, None);
    assert!(log.contains("fluctuations without this symmetry are suppressed"), "{log}");
    assert_eq!(found.summary["symmetry"], "half");
}
