//! A fine zone that follows the contact gives what one gives that is as long as the roll.

use runs::{Results, load, project, run};

/// The small case, exact contact, half a model; two moves of 3.2 mm in its roll of 8 mm. Beside the zone the elements of a
/// tensor product stay small: with those of `two_to_one`, which differ in size from one zone to the other, the mean normal
/// force differs by 0.5 %.
const SMALL: [&str; 8] = [
    "mesh.grading=tensor",
    "contact.enforcement=exact",
    "mesh.symmetry=half",
    "time.step=4e-8",
    "evaluate.last=0.004",
    "output.probes.bar=[[0.0064, 0.0]]",
    // nodes of either zone at the same places
    "mesh.zone.start=-0.0032",
    "mesh.zone.length=0.0144",
];
const WINDOW: &str = "mesh.window=0.0096";

fn small(sets: &[&str], threads: usize) -> Results {
    run(&load(&project("tests/small.toml"), &[&SMALL, sets].concat()), threads)
}

/// Relative difference of a number of two summaries.
fn apart(a: &Results, b: &Results, pointer: &str) -> f64 {
    (a.number(pointer) / b.number(pointer) - 1.0).abs()
}

#[test]
fn forces_patch_and_material_points_are_those_of_a_zone_as_long_as_the_roll() {
    let [fixed, window] = [&[][..], &[WINDOW]].map(|sets| small(sets, 2));
    let travelled = &window.data["history/window_x"];
    let moves = travelled.windows(2).filter(|x| x[1] > x[0]).count();
    assert_eq!(moves, 2);
    assert!(fixed.data["history/window_x"].iter().all(|x| *x == 0.0));
    assert!(window.data["history/hub_x"].windows(2).all(|x| x[1] > x[0]));
    for (name, limit) in [
        ("/contact/normal_force", 5e-4),
        ("/contact/traction_coefficient", 1e-3),
        // a count of nodes, of which the patch has 14: a tenth of one
        ("/contact/stick_fraction", 7e-3),
        ("/contact/peak_pressure", 2e-4),
        ("/contact/patch_half_length", 3e-4),
    ] {
        let apart = apart(&window, &fixed, name);
        assert!(apart < limit, "{name}: {apart:e}");
    }
    let error = window.number("/energy/balance_error");
    assert!(error < 1e-5, "{error:e}");

    // the point enters the zone during the roll, and its pressure is that of the same material
    let [fixed, window] = [&fixed, &window].map(|run| &run.data["probes/probe0_pressure"]);
    assert!(window[0].is_nan() && !fixed[0].is_nan());
    let largest = |p: &[f64]| p.iter().fold(0.0, |most: f64, p| most.max(*p));
    let apart = largest(window) / largest(fixed) - 1.0;
    assert!(apart.abs() < 4e-3, "{apart:e}");
}

#[test]
fn a_move_sends_no_wave_to_the_contact() {
    let [fixed, window] = [&[][..], &[WINDOW]].map(|sets| small(sets, 2));
    // records of 0.4 us
    let after = 60;
    for (force, limit) in [("history/normal_force", 5.0), ("history/tangential_force", 2.0)] {
        let change: Vec<f64> =
            window.data[force].iter().zip(&fixed.data[force]).map(|(a, b)| a - b).collect();
        let mut moves = 0;
        for (k, x) in window.data["history/window_x"].windows(2).enumerate() {
            if x[1] > x[0] {
                moves += 1;
                let change = &change[k..k + after];
                let mean = change.iter().sum::<f64>() / after as f64;
                let square = change.iter().map(|c| (c - mean).powi(2)).sum::<f64>();
                let rms = (square / after as f64).sqrt();
                assert!(rms < limit, "{force} of 10 kN and 2.5 kN at record {k}: {rms} N");
            }
        }
        assert_eq!(moves, 2);
    }
}

#[test]
fn springs_and_mortar_rows_are_carried_along() {
    for kind in ["contact.enforcement=penalty", "contact.rows=mortar"] {
        let [fixed, window] = [&[kind][..], &[kind, WINDOW]].map(|sets| small(sets, 2));
        let apart = apart(&window, &fixed, "/contact/traction_coefficient");
        assert!(apart < 2.5e-3, "{kind}: {apart:e}");
    }
}

#[test]
fn a_following_zone_gives_the_same_bits_on_any_number_of_threads() {
    let [one, two] = [1, 2].map(|threads| small(&[WINDOW, "mesh.grading=two_to_one"], threads));
    assert_eq!(one.differing(&two), Vec::<&str>::new());
}

#[test]
fn places_of_friction_are_those_of_the_start() {
    // mu falls along the bar from .3 to .14 over the roll
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    let text = std::fs::read_to_string(project("tests/small.toml")).unwrap();
    let law = "law = \"expression\"\nexpression = \"0.3 - 20*x\"";
    std::fs::write(&case, text.replace("static = 0.3", law)).unwrap();
    let rolled = |sets: &[&str]| run(&load(&case, &[&SMALL, sets].concat()), 2);
    let [fixed, window] = [&[][..], &[WINDOW]].map(rolled);
    let apart = apart(&window, &fixed, "/contact/traction_coefficient");
    assert!(apart < 4e-3, "{apart:e}");
}
