//! Every friction law rolls, with springs and exactly: the energy balances, friction only dissipates, and
//! the shear stays below the coefficient that the law gave.

use std::path::Path;

use runs::{Results, load, project, run_with, small};

const LAWS: [&[&str]; 8] = [
    &["friction.law=polach", "friction.ratio=0.4", "friction.decay=6"],
    &["friction.law=slip_weakening", "friction.dynamic=0.2", "friction.distance=2e-6"],
    &["friction.law=rate_state", "friction.distance=2e-6"],
    &["friction.law=rate_state", "friction.distance=2e-6", "friction.state=slip"],
    &["friction.law=prakash_clifton", "friction.distance=2e-6"],
    &["friction.law=table", "friction.table=[[0, 0.3], [0.05, 0.25], [1, 0.2]]"],
    &["friction.law=expression", "friction.expression=\"0.2 + 0.1*exp(-6*s)\""],
    &["friction.law=expression", "friction.expression=\"0.3 + 0.05*sin(2000*x)\""],
];

/// Rolls with a law; the preload, on which no law acts, is kept in `preloads`.
fn rolled(law: &[&str], enforcement: &str, preloads: &Path) -> Results {
    let enforcement = format!("contact.enforcement={enforcement}");
    let sets = [&[enforcement.as_str(), "time.roll=0.004"], law].concat();
    let (run, _) = run_with(&load(&project("tests/small.toml"), &sets), 2, Some(preloads));
    assert_eq!(run.summary["status"], "completed", "{law:?} {enforcement}: {:#}", run.summary);
    println!(
        "{law:?} {enforcement}: balance {:.2e}, dissipated {:.3e} J, T/N {:.4}",
        run.number("/energy/balance_error"),
        run.number("/energy/friction_dissipated"),
        run.number("/contact/traction_coefficient"),
    );
    run
}

#[test]
fn every_law_rolls_and_its_energy_balances() {
    let preloads = tempfile::tempdir().unwrap();
    for law in LAWS {
        for enforcement in ["penalty", "exact"] {
            let run = rolled(law, enforcement, preloads.path());
            assert!(run.number("/energy/balance_error") < 1e-4, "{law:?} {enforcement}");
            assert!(run.number("/energy/friction_dissipated") >= 0.0, "{law:?} {enforcement}");
            let worked = run.history("friction_dissipated");
            let most = worked.last().unwrap();
            // never handed back but for rounding
            assert!(worked.windows(2).all(|w| w[1] >= w[0] - 1e-9 * most), "{law:?} {enforcement}");
        }
    }
}

#[test]
fn a_formula_that_writes_a_known_law_rolls_as_that_law() {
    let preloads = tempfile::tempdir().unwrap();
    // R < 1: where rounding does not grow
    let law = ["friction.law=exponential", "friction.dynamic=0.2", "friction.decay=0.05"];
    let same = ["friction.law=expression", "friction.expression=\"0.2 + 0.1*exp(-0.05*s)\""];
    for enforcement in ["penalty", "exact"] {
        let [a, b] = [&law[..], &same].map(|law| rolled(law, enforcement, preloads.path()));
        let [a, b] = [a, b].map(|run| run.number("/contact/traction_coefficient"));
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn a_formula_that_loses_its_value_on_the_way_stops_the_run_with_a_diagnosis() {
    // no number within 0.2 mm of x = 1.8 mm, where a node of the bar is, between the places at which it was tried
    let formula = "friction.expression=\"0.2 + sqrt(abs(x - 1.8e-3) - 2e-4)\"";
    for enforcement in ["contact.enforcement=penalty", "contact.enforcement=exact"] {
        let run = small(&["friction.law=expression", formula, enforcement, "time.roll=0.004"]);
        assert_eq!(run.summary["status"], "failed", "{enforcement}");
        let said = run.summary["diagnosis"].as_str().unwrap();
        assert!(said.contains("gives no coefficient of friction"), "{said}");
    }
}

#[test]
fn exact_contact_is_stable_up_to_the_limit_of_the_elements_with_every_law() {
    let preloads = tempfile::tempdir().unwrap();
    let falling = ["friction.law=exponential", "friction.static=0.5"];
    let rough: [&[&str]; 6] = [
        &["friction.mode=exact"],
        &["friction.mode=lagged"],
        &["friction.memory.distance=2e-6"],
        &["damping.kelvin_voigt=1e-8"],
        // four times the load: the peak pressure is near 2.7 GPa
        &["load.normal=40e3"],
        // dropped from 5 um: it hits the bar
        &["preload.method=none", "disk.lift=5e-6", "drive.creepage=0"],
    ];
    let cases = LAWS.iter().map(|law| law.to_vec());
    for law in cases.chain(rough.iter().map(|more| [&falling[..], more].concat())) {
        let sets = ["contact.enforcement=exact", "time.factor=0.99", "time.roll=0.003"];
        let case = load(&project("tests/small.toml"), &[&sets, &law[..]].concat());
        let (run, _) = run_with(&case, 2, Some(preloads.path()));
        assert_eq!(run.summary["status"], "completed", "{law:?}: {:#}", run.summary);
        let normal = run.history("normal_force").iter().fold(0.0_f64, |most, x| most.max(*x));
        assert!(normal > 1e3, "{law:?}: nothing is pressed, {normal} N");
        assert!(run.number("/stability/factor") > 0.985, "{law:?}");
        let error = run.number("/energy/balance_error");
        assert!(error < 1e-4, "{law:?}: {error:e}");
    }
}
