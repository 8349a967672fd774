//! Irregular surfaces: corrugation of the bar, a disk out of round.

use runs::{Results, load, project, run};

/// The small case with exact contact, half a model; a zone that follows it moves twice in the roll of 8 mm.
const SMALL: [&str; 7] = [
    "mesh.grading=tensor",
    "contact.enforcement=exact",
    "mesh.symmetry=half",
    "time.step=4e-8",
    "evaluate.last=0.004",
    "mesh.zone.start=-0.0032",
    "mesh.zone.length=0.0144",
];
const WINDOW: &str = "mesh.window=0.0096";
const IRREGULAR: [&str; 2] = [
    "bar.surface={ formula = \"2e-6*cos(2*pi*x/0.008)\" }",
    "disk.out_of_round={ formula = \"2e-6*sin(40*angle)\" }",
];
const LEVEL: [&str; 2] = [
    "bar.surface={ points = [[-1, 0], [1, 0]] }",
    "disk.out_of_round={ points = [[-1, 0], [1, 0]] }",
];

fn small(sets: &[&str], threads: usize) -> Results {
    run(&load(&project("tests/small.toml"), &[&SMALL, sets].concat()), threads)
}

/// Root mean square of the difference of a column of two histories.
fn apart(a: &Results, b: &Results, name: &str) -> f64 {
    let (a, b) = (&a.data[name], &b.data[name]);
    assert_eq!(a.len(), b.len());
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (square / a.len() as f64).sqrt()
}

#[test]
fn a_zone_that_follows_the_contact_meets_the_same_irregularities_as_one_as_long_as_the_roll() {
    let [level, fixed, window] =
        [&[][..], &IRREGULAR, &[IRREGULAR[0], IRREGULAR[1], WINDOW]].map(|sets| small(sets, 2));
    let moves = window.data["history/window_x"].windows(2).filter(|x| x[1] > x[0]).count();
    assert_eq!(moves, 2);
    for name in ["history/normal_force", "history/hub_z"] {
        let (effect, difference) = (apart(&fixed, &level, name), apart(&window, &fixed, name));
        println!("{name}: {effect:e} {difference:e}");
        assert!(difference < 0.05 * effect, "{name}: {difference:e} of {effect:e}");
    }
    for run in [&fixed, &window] {
        let error = run.number("/energy/balance_error");
        assert!(error < 1e-5, "{error:e}");
    }
}

#[test]
fn a_rail_whose_heights_rise_across_presses_the_wheel_aside_by_their_slope() {
    let slope = 5e-3;
    let rising = format!("bar.surface={{ formula = \"{slope}*y\" }}");
    let free = [
        "mesh.symmetry=whole",
        "disk.crown_radius=0.06",
        "friction.static=1e-5",
        "drive.creepage=0",
        "time.roll=0.003",
        "evaluate.last=0.001",
    ];
    let [level, tilted] = [&[][..], &[rising.as_str()]].map(|sets| {
        let run = small(&[&free, sets].concat(), 2);
        let [aside, up] =
            ["lateral_force", "normal_force"].map(|name| run.number(&format!("/contact/{name}")));
        aside / up
    });
    assert!(level.abs() < 1e-6, "{level:e}");
    // crowns of 60 mm touch where they are equally steep, half as steep as the heights; with half the elements' size 0.023 is left
    let ratio = -tilted / (0.5 * slope);
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
}

#[test]
fn irregular_surfaces_give_the_same_bits_on_any_number_of_threads() {
    let sets = [IRREGULAR[0], IRREGULAR[1], WINDOW, "time.roll=0.004"];
    let [one, two] = [1, 2].map(|threads| small(&sets, threads));
    assert_eq!(one.differing(&two), Vec::<&str>::new());
}

#[test]
fn surfaces_without_height_give_the_bits_of_smooth_ones() {
    for kind in ["contact.enforcement=exact", "contact.enforcement=penalty", "contact.rows=mortar"]
    {
        let [roll, last] = ["time.roll=0.001", "evaluate.last=0.0005"];
        let smooth = small(&[kind, roll, last], 2);
        let level = small(&[kind, roll, last, LEVEL[0], LEVEL[1]], 2);
        assert_eq!(smooth.differing(&level), Vec::<&str>::new(), "{kind}");
    }
}
