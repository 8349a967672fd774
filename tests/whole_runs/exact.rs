//! Whole runs with exact enforcement: bits, balance, the hand-over from the preload, and the law.

use runs::{Results, load, project, run, small};

const EXACT: &str = "contact.enforcement='exact'";
const MORTAR: &str = "contact.rows='mortar'";
const EVERY: &str = "output.history_interval=1";

/// Nodal vectors of a record's field, as lengths.
fn lengths(run: &Results, field: &str) -> Vec<f64> {
    let flat = &run.data[field];
    flat.chunks(3).map(|v| v.iter().map(|c| c * c).sum::<f64>().sqrt()).collect()
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let sets = [
        EXACT,
        "time.roll=0.001",
        "evaluate.last=0.001",
        "friction.law='exponential'",
        "friction.static=0.5",
        "friction.mode='exact'",
    ];
    for sets in [&sets[..], &[&sets[..], &[MORTAR]].concat()] {
        let case = load(&project("tests/small.toml"), sets);
        let [one, two, three] = [1, 2, 3].map(|threads| run(&case, threads));
        assert!(one.number("/contact/tangential_force") > 0.0);
        assert_eq!(one.differing(&two), Vec::<&str>::new());
        assert_eq!(one.differing(&three), Vec::<&str>::new());
    }
}

#[test]
fn energy_balances_and_friction_only_takes() {
    for sets in [&[EXACT, EVERY][..], &[EXACT, EVERY, MORTAR]] {
        let run = small(sets);
        let error = run.number("/energy/balance_error");
        assert!(error < 1e-4, "{error:e}");
        let heat = run.history("friction_dissipated");
        assert!(heat.windows(2).all(|w| w[1] >= w[0]));
        assert!(heat.last().unwrap() > &0.0);
        assert!(run.number("/checks/resultant_mismatch") < 1e-12);
        assert!(run.number("/exact_contact/most_sweeps") < 40.0);
        let integrals = run.number("/exact_contact/mortar_integrals");
        assert_eq!(integrals > 0.0, sets.contains(&MORTAR));
    }
}

#[test]
fn implicit_steps_roll_as_explicit_ones_by_either_rows() {
    for rows in ["contact.rows='node_to_face'", MORTAR] {
        let explicit = small(&[EXACT, rows, "time.roll=0.002"]);
        let implicit = ["time.integrator=implicit", "time.step=0.5e-6", "time.roll=0.002"];
        let implicit = small(&[&[EXACT, rows][..], &implicit].concat());
        // five explicit steps make one implicit, which damps what changes within it
        for (pointer, slack) in [
            ("/contact/normal_force", 2e-3),
            ("/contact/tangential_force", 1e-2),
            ("/contact/peak_pressure", 5e-3),
        ] {
            let [one, other] = [&explicit, &implicit].map(|run| run.number(pointer));
            assert!((other / one - 1.0).abs() < slack, "{rows} {pointer}: {one} {other}");
        }
        assert_eq!(implicit.number("/exact_contact/unconverged_steps"), 0.0);
        assert_eq!(implicit.number("/exact_contact/mortar_integrals") > 0.0, rows == MORTAR);
    }
}

#[test]
fn rolling_starts_from_the_static_preload_without_a_jump() {
    // Ten elements across the patch: with seven (0.5 mm) the force ripples by 0.65 % as nodes pass, with
    // ten by 0.2 %.
    let sets = [
        EXACT,
        EVERY,
        "mesh.zone.size=0.35e-3",
        "friction.static=0",
        "drive.creepage=0",
        "evaluate.last=0.002",
        "time.roll=0.004",
    ];
    for sets in [&sets[..], &[&sets[..], &[MORTAR]].concat()] {
        let run = small(sets);
        let rest = run.number("/preload/normal_force");
        let early = run.history("time").iter().zip(run.history("normal_force"));
        let early: Vec<f64> = early.filter(|(t, _)| **t <= 0.1e-3).map(|(_, n)| *n).collect();
        assert!((early[0] / rest - 1.0).abs() < 1e-3, "{}", early[0]);
        let jump = early.iter().fold(0.0, |worst: f64, n| worst.max((n / rest - 1.0).abs()));
        assert!(jump < 5e-3, "{jump}");
    }
}

#[test]
fn shear_is_the_bound_where_nodes_slip_and_slip_is_nil_where_they_stick() {
    let run = small(&[EXACT]);
    let record = "0030";
    let at = |field: &str| format!("contact/{field}/{record}");
    let (shear, slip) = (lengths(&run, &at("shear")), lengths(&run, &at("slip_velocity")));
    let (pressure, state) = (&run.data[&at("pressure")], &run.data[&at("state")]);
    // the disk's nodes, which are slaves, come first; the bar begins at the edge of its crown
    let slaves = run.data["contact/points"].chunks(3).position(|x| x[2] < -1e-9).unwrap();
    let (mut sticks, mut slips) = (0, 0);
    for i in 0..slaves {
        match state[i] as u8 {
            1 => {
                assert!(slip[i] < 1e-8, "{:e}", slip[i]);
                sticks += 1;
            }
            2 => {
                assert!((shear[i] / (0.3 * pressure[i]) - 1.0).abs() < 1e-12);
                slips += 1;
            }
            _ => assert_eq!(pressure[i], 0.0),
        }
    }
    assert!(sticks > 3 && slips > 3, "{sticks} {slips}");
}
