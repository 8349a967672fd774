//! Sweep files: what they lead to. How they are refused stands in the tests of the command.

#![allow(clippy::unwrap_used)]
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::case::reference::REFERENCES;
use crate::case::schema::{Creepage, Step};
use crate::case::{Case, CaseError};
use crate::sweep::Sweep;
use crate::sweep::file::StepRule;

/// The shortest case.
const SHORT: &str = "load.normal = 100e3\ndrive.speed = 38.89\ndrive.creepage = 2.4e-3\n\
                     friction.static = 0.5\n";

/// A folder with a base case and a sweep file.
fn sweep(text: &str) -> (tempfile::TempDir, Result<Sweep, CaseError>) {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("base.toml"), SHORT).unwrap();
    let path = dir.path().join("sweep.toml");
    fs::write(&path, format!("base = \"base.toml\"\n{text}")).unwrap();
    let sweep = Sweep::load(&path);
    (dir, sweep)
}

fn cases(text: &str) -> Vec<Case> {
    let (_dir, sweep) = sweep(text);
    sweep.unwrap().points().unwrap().into_iter().map(|point| point.case).collect()
}

const TWO: &str = "[[axis]]\nkey = \"friction.static\"\nvalues = [0.2, 0.3]\n\
                   [[axis]]\nkey = \"drive.creepage\"\nvalues = [1e-3, 2e-3, 4e-3]\n";

#[test]
fn a_grid_has_every_pair_and_the_last_axis_runs_fastest() {
    let pairs: Vec<_> = cases(TWO)
        .iter()
        .map(|c| {
            (
                c.friction.number("static").unwrap(),
                c.drive.creepage.as_ref().and_then(Creepage::number).unwrap(),
            )
        })
        .collect();
    let all = [(0.2, 1e-3), (0.2, 2e-3), (0.2, 4e-3), (0.3, 1e-3), (0.3, 2e-3), (0.3, 4e-3)];
    assert_eq!(pairs, all);
}

#[test]
fn axes_with_a_nominal_value_vary_one_at_a_time_and_the_others_cross_them() {
    let axis = |key: &str, values: &str, nominal: &str| {
        format!("[[axis]]\nkey = \"{key}\"\nvalues = {values}\n{nominal}\n")
    };
    let text = axis("drive.creepage", "[1e-3, 2e-3, 4e-3]", "nominal = 2e-3")
        + &axis("drive.ramp", "[1e-4, 2e-4]", "nominal = 1e-4")
        + &axis("friction.static", "[0.2, 0.3]", "");
    let (_dir, sweep) = sweep(&text);
    let points = sweep.unwrap().points().unwrap();
    let found: Vec<[f64; 3]> = points
        .iter()
        .map(|point| {
            ["drive.creepage", "drive.ramp", "friction.static"]
                .map(|key| point.parameters[key].as_float().unwrap())
        })
        .collect();
    let alone = [[1e-3, 1e-4], [2e-3, 1e-4], [4e-3, 1e-4], [2e-3, 2e-4]];
    let all = alone.iter().flat_map(|[c, n]| [[*c, *n, 0.2], [*c, *n, 0.3]]);
    assert_eq!(found, all.collect::<Vec<_>>());
}

#[test]
fn a_whole_number_may_be_written_with_an_exponent() {
    let axis = |values: &str| format!("[[axis]]\nkey = \"output.history_interval\"\n{values}\n");
    for values in ["values = [1e2, 200]", "linear = { from = 1e2, to = 2e2, n = 2.0 }"] {
        let intervals: Vec<u64> =
            cases(&axis(values)).iter().map(|case| case.output.history_interval).collect();
        assert_eq!(intervals, [100, 200], "{values}");
    }
    assert_eq!(cases(&format!("{}[ensemble]\nmembers = 2.0\n", axis("values = [1e1]"))).len(), 2);
    for (values, words) in [
        ("values = [100, 1e2]", "100 stands twice"),
        ("values = [1.5]", "1.5 must be a whole number"),
        ("values = [1e300]", "1e300 must be a whole number"),
        ("linear = { from = 1, to = 2, n = 1.5 }", "n = 1.5 must be a whole number"),
    ] {
        let (_dir, refused) = sweep(&axis(values));
        let said = refused.map(|_| ()).unwrap_err().to_string();
        assert!(said.contains(words), "{values}: {said}");
    }
}

#[test]
fn a_zip_takes_the_values_together() {
    let zip = format!("mode = \"zip\"\n{}", TWO.replace(", 4e-3", ""));
    let pairs: Vec<_> = cases(&zip)
        .iter()
        .map(|c| {
            (
                c.friction.number("static").unwrap(),
                c.drive.creepage.as_ref().and_then(Creepage::number).unwrap(),
            )
        })
        .collect();
    assert_eq!(pairs, [(0.2, 1e-3), (0.3, 2e-3)]);
}

#[test]
fn spans_hold_their_ends_to_the_bit_and_are_even_between() {
    let axis = |span: &str| {
        let text = format!("[[axis]]\nkey = \"friction.static\"\n{span}\n");
        cases(&text)
            .iter()
            .map(|case| case.friction.number("static").unwrap())
            .collect::<Vec<f64>>()
    };
    let log = axis("log = { from = 0.003, to = 3.0, n = 4 }");
    assert_eq!((log[0], log[3]), (0.003, 3.0));
    assert!((log[1] / 0.03 - 1.0).abs() < 1e-14 && (log[2] / 0.3 - 1.0).abs() < 1e-14, "{log:?}");
    assert_eq!(axis("linear = { from = 0, to = 1, n = 5 }"), [0.0, 0.25, 0.5, 0.75, 1.0]);
}

#[test]
fn a_key_follows_an_axis_by_factor_and_power() {
    let text = "[[axis]]\nkey = \"mesh.zone.size\"\nvalues = [1e-3, 2e-3]\n\
                [[derive]]\nkey = \"output.contact_interval\"\nfrom = \"mesh.zone.size\"\n\
                factor = 5.0\npower = 2.0\n[[derive]]\nkey = \"time.step\"\nrule = \"bound\"\n";
    let intervals: Vec<f64> = cases(text).iter().map(|c| c.output.contact_interval).collect();
    assert_eq!(intervals, [5.0 * 1e-3_f64.powi(2), 5.0 * 2e-3_f64.powi(2)]);
}

#[test]
fn springs_may_be_swept_in_any_form_and_keys_set_for_all() {
    let text = "[set]\nfriction.static = 0.4\n[[axis]]\nkey = \"contact.penalty.tangential\"\n\
                values = [0.1, { stiffness = 1e13 }]\n[[derive]]\nkey = \"time.step\"\n\
                rule = \"fixed\"\n";
    let (_dir, sweep) = sweep(text);
    let sweep = sweep.unwrap();
    assert_eq!(sweep.step, Some(StepRule::Fixed));
    let points = sweep.points().unwrap();
    assert!(points.iter().all(|point| point.case.friction.number("static") == Some(0.4)));
    assert_eq!(points[1].parameters["contact.penalty.tangential"]["stiffness"], 1e13.into());
    assert_eq!(points[1].name, "001-tangential-stiffness-1e13");
}

#[test]
fn a_step_for_all_is_set_and_a_rule_beside_it_refused() {
    let text = "[set]\ntime.step = 1e-7\n[[axis]]\nkey = \"friction.static\"\nvalues = [0.1]\n";
    assert_eq!(cases(text)[0].step(), Step::Absolute(1e-7));
    let (_dir, both) = sweep(&format!("{text}[[derive]]\nkey = \"time.step\"\nrule = \"fixed\"\n"));
    let error = both.unwrap_err().to_string();
    assert!(error.contains("sweep.toml:8") && error.contains("[set]"), "{error}");
}

#[test]
fn a_rule_for_the_step_replaces_an_absolute_step_of_the_base() {
    let text = "[[axis]]\nkey = \"friction.static\"\nvalues = [0.1]\n";
    let (dir, plain) = sweep(text);
    fs::write(dir.path().join("base.toml"), format!("{SHORT}time.step = 1e-7\n")).unwrap();
    let step = |sweep: Sweep| sweep.points().unwrap()[0].case.step();
    assert_eq!(step(plain.unwrap()), Step::Absolute(1e-7));
    let path = dir.path().join("sweep.toml");
    let rule = "[[derive]]\nkey = \"time.step\"\nrule = \"bound\"\n";
    fs::write(&path, format!("base = \"base.toml\"\n{text}{rule}")).unwrap();
    assert_eq!(step(Sweep::load(&path).unwrap()), Step::Fraction(0.67));
}

const KT: &str = "[[axis]]\nkey = \"contact.penalty.tangential\"\nvalues = [0.1, 1.0]\n";

#[test]
fn beside_an_axis_that_changes_the_limit_no_key_of_the_time_but_the_step_says_what_the_step_does() {
    let with = |more: &str| sweep(&format!("{KT}{more}")).1;
    let factor = "[[axis]]\nkey = \"time.factor\"\nvalues = [0.3, 0.6]\n";
    let roll = "[[axis]]\nkey = \"time.roll\"\nvalues = [0.01, 0.02]\n";
    for more in [factor, roll, "[set]\ntime.factor = 0.5\n"] {
        let error = with(more).unwrap_err().to_string();
        assert!(
            error.contains("contact.penalty.tangential changes the stability limit"),
            "{error}"
        );
    }
    let bound = "[[derive]]\nkey = \"time.step\"\nrule = \"bound\"\n";
    let steps: Vec<Step> =
        cases(&format!("{KT}{factor}{bound}")).iter().map(|case| case.step()).collect();
    assert_eq!(steps, [0.3, 0.6, 0.3, 0.6].map(Step::Fraction));
    assert_eq!(cases(&format!("{KT}{roll}{bound}")).len(), 4);
    let fixed = bound.replace("bound", "fixed");
    let error = with(&format!("{factor}{fixed}")).unwrap_err().to_string();
    assert!(error.contains("all runs the same step, but an axis varies time.factor"), "{error}");
    let step = "[[axis]]\nkey = \"time.step\"\nvalues = [1e-8, 2e-8]\n";
    assert_eq!(cases(&format!("{KT}{step}")).len(), 4);
}

#[test]
fn a_spring_that_is_a_fraction_of_the_limit_is_no_constant_of_a_sweep_of_the_step() {
    let set = "[set]\ncontact.penalty.tangential = { stability = 0.5 }\n";
    for (key, values) in [("time.factor", "0.2, 0.4"), ("time.step", "1e-8, 2e-8")] {
        let axis = format!("[[axis]]\nkey = \"{key}\"\nvalues = [{values}]\n");
        let (_dir, tied) = sweep(&format!("{set}{axis}"));
        let error = tied.unwrap().points().unwrap_err().to_string();
        assert!(error.contains("contact.penalty.tangential is a fraction"), "{error}");
        assert_eq!(cases(&axis).len(), 2);
        let exact = format!("{set}contact.enforcement = \"exact\"\n{axis}");
        assert_eq!(cases(&exact).len(), 2, "there is no spring");
    }
}

#[test]
fn a_step_and_its_fraction_take_one_another_back_and_are_refused_together() {
    let both = format!("{SHORT}time.step = 1e-7\ntime.factor = 0.5\n");
    let path = Path::new("short.toml");
    let error = Case::from_text(&both, path, &[]).unwrap_err().to_string();
    assert!(error.contains("both given"), "{error}");
    let one = format!("{SHORT}time.step = 1e-7\n");
    let case = Case::from_text(&one, path, &["time.factor=0.5".into()]).unwrap();
    assert_eq!((case.step(), case.time.step), (Step::Fraction(0.5), None));
    let again = Case::from_text(&case.to_toml(), path, &["time.step=2e-8".into()]).unwrap();
    assert_eq!((again.step(), again.time.factor), (Step::Absolute(2e-8), None));
    assert_eq!(Case::from_text(&again.to_toml(), path, &[]).unwrap(), again);
}

#[test]
fn every_sweep_of_the_project_resolves_and_its_runs_have_names_of_their_own() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/sweeps");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let sweeps: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .filter(|path| fs::read_to_string(path).unwrap().contains("[[axis]]"))
        .collect();
    assert_eq!(sweeps.len(), 14, "{sweeps:?}");
    for path in sweeps {
        let sweep = Sweep::load(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let points = sweep.points().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let names: BTreeSet<_> = points.iter().map(|point| &point.name).collect();
        assert_eq!(names.len(), points.len());
        assert!(points.len() >= 4, "{}", path.display());
    }
}

#[test]
fn a_reference_sweep_has_the_runs_of_its_file() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let hashes = |path: &Path| -> Vec<String> {
        let points = Sweep::load(path).unwrap().points().unwrap();
        points.iter().map(|point| point.case.hash()).collect()
    };
    for sweep in REFERENCES.iter().filter(|of| of.is_sweep()) {
        let held = hashes(Path::new(sweep.name));
        assert_eq!(held, hashes(&folder.join(sweep.file())), "{}", sweep.name);
    }
}
