//! `creepage check` makes the coefficient of friction again from the records: for every law it finds that of the
//! solver to round-off, and one that was planted in a copied run.

use creepage::{CaseSource, OwnLaw, RunOptions};
use output::summary::Summary;
use output::{
    Cells, FieldSpec, GridFile, GridSpec, Provenance, StaticField, TransientGrid, Values,
};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

/// A law for each of the eight, and their modes; most also with memory.
const LAWS: [&[&str]; 13] = [
    &[],
    &["law='exponential'", "dynamic=0.2"],
    &["law='exponential'", "dynamic=0.2", "memory.distance=3e-6"],
    &["law='exponential'", "dynamic=0.2", "mode='exact'"],
    &["law='slip_weakening'", "dynamic=0.2", "distance=2e-6"],
    &["law='rate_state'", "distance=2e-6"],
    &["law='rate_state'", "distance=2e-6", "state='slip'"],
    &["law='rate_state'", "distance=2e-6", "mode='lagged'"],
    &["law='prakash_clifton'", "distance=2e-6"],
    &["law='table'", "table=[[0, 0.3], [0.05, 0.25], [1, 0.2]]"],
    &["law='expression'", "expression='0.3 + 0.05*sin(2000*x) + 10*t + p*1e-11 + 0.01*exp(-6*s)'"],
    &[
        "law='expression'",
        "expression='0.2 + 0.1*exp(-6*s) + p*1e-11 + 10*t'",
        "memory.distance=3e-6",
    ],
    &["law='python'", "source='Eq. (8)'"],
];

/// Eq. (8), handed over with the run.
#[derive(Debug)]
struct Brought;

impl OwnLaw for Brought {
    fn mu(&self, slip_speeds: &[f64], mu: &mut [f64]) {
        mu.iter_mut().zip(slip_speeds).for_each(|(mu, s)| *mu = 0.2 + 0.1 * libm::exp(-6.0 * s));
    }

    fn failure(&self) -> Option<String> {
        None
    }
}

/// Rolls the small case a little way with records at every step. The preload, on which no law acts, is kept beside
/// the run.
fn roll(out: &Path, law: &[&str], contact: &[&str], more: &[&str]) {
    let friction = |set: &&str| format!("friction.{set}");
    let short = ["time.roll=0.0013", "evaluate.last=0.001", "output.fields_interval=1"];
    let sets = short.iter().chain(contact).chain(more).map(|set| (*set).to_owned());
    let sets: Vec<String> = sets.chain(law.iter().map(friction)).collect();
    let text = fs::read_to_string(runs::project("tests/small.toml")).unwrap();
    // refused with laws that have other coefficients
    let has_static = !["rate", "table", "expression", "python"]
        .iter()
        .any(|word| law.first().is_some_and(|law| law.contains(word)));
    let text = if has_static { text } else { text.replace("static = 0.3", "") };
    let brings = law.first().is_some_and(|law| law.contains("python"));
    let brought = brings.then(|| Arc::new(Brought) as Arc<dyn OwnLaw>);
    let options = RunOptions {
        case: CaseSource { path: "small.toml".into(), sets, text: Some(text) },
        out: Some(out.to_owned()),
        threads: Some(2),
        preload_cache: out.parent().map(|folder| folder.join("preloads")),
        law: brought,
        ..RunOptions::default()
    };
    let ran = creepage::run(&options, &mut ()).unwrap();
    assert_eq!(ran.exit_code(), 0, "{law:?} {contact:?}: {:?}", ran.summary);
}

const EVERY: &str = "output.contact_interval=1e-9";

fn check(run: &Path, options: &[&str]) -> (Option<i32>, Value) {
    let output = Command::new(env!("CARGO_BIN_EXE_creepage"))
        .args(["check", run.to_str().unwrap(), "--json"])
        .args(options)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    let document = serde_json::from_slice(&output.stdout);
    (output.status.code(), document.unwrap_or_else(|_| panic!("{run:?}: {said}")))
}

/// Copies a run, with `scale` of each of `fields` in its contact file, as if it had been written so: with
/// checksums that are right.
fn plant(from: &Path, to: &Path, fields: &[&str], scale: f64) {
    fs::create_dir(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
    }
    rewrite(&from.join("contact.vtkhdf"), &to.join("contact.vtkhdf"), |name, values| {
        if fields.contains(&name) {
            values.iter_mut().for_each(|value| *value *= scale);
        }
    });
    let summary = fs::read(to.join("summary.json")).unwrap();
    let summary: Summary = serde_json::from_slice(&summary).unwrap();
    let made = Provenance {
        creepage_version: summary.creepage_version.clone().unwrap(),
        case_hash: summary.case_hash.clone().unwrap(),
        created: summary.created.clone().unwrap(),
        attributes: Vec::new(),
    };
    summary.write(to, &made).unwrap();
}

/// Writes a contact file again with its values changed.
fn rewrite(from: &Path, to: &Path, change: impl Fn(&str, &mut Vec<f64>)) {
    let file = GridFile::open(from).unwrap();
    let (points, cells) = (file.points().unwrap(), file.connectivity().unwrap());
    let quads = cells.as_chunks::<4>().0.to_vec();
    let attributes = ["slip_pairing", "enforced_on", "contact_rows"];
    let attributes = attributes
        .iter()
        .filter_map(|name| Some(((*name).to_owned(), file.provenance(name).ok()?)))
        .collect();
    let text = |name: &str| file.provenance(name).unwrap();
    let provenance = Provenance {
        creepage_version: text("creepage_version"),
        case_hash: text("case_hash"),
        created: text("created"),
        attributes,
    };
    let spec = |field: &output::FieldInfo| FieldSpec {
        name: field.name.clone().into(),
        units: field.units.clone().into(),
        components: field.components,
        integer: field.integer,
        on_cells: field.on_cells,
        description: "planted".into(),
    };
    let (constant, changing): (Vec<_>, Vec<_>) = file.fields().iter().partition(|f| f.constant);
    let read = |field: &output::FieldInfo, step: usize| {
        let mut values = file.read(&field.name, field.on_cells, step).unwrap();
        change(&field.name, &mut values);
        let bytes: Vec<u8> = values.iter().map(|value| *value as u8).collect();
        (values, bytes)
    };
    let fixed: Vec<_> = constant.iter().map(|field| read(field, 0)).collect();
    fn values<'a>(field: &output::FieldInfo, held: &'a (Vec<f64>, Vec<u8>)) -> Values<'a> {
        match (field.integer, field.components) {
            (true, _) => Values::Integer(&held.1),
            (false, 1) => Values::Scalar(&held.0),
            _ => Values::Vector(held.0.as_chunks::<3>().0),
        }
    }
    let constant: Vec<_> = constant
        .iter()
        .zip(&fixed)
        .map(|(field, held)| StaticField { spec: spec(field), values: values(field, held) })
        .collect();
    let specs: Vec<_> = changing.iter().map(|field| spec(field)).collect();
    let grid = GridSpec { points: &points, cells: Cells::Quads(&quads), constant: &constant };
    let _ = fs::remove_file(to);
    let mut written = TransientGrid::create(to, &grid, &specs, &provenance).unwrap();
    for (step, time) in file.times().unwrap().into_iter().enumerate() {
        let held: Vec<_> = changing.iter().map(|field| read(field, step)).collect();
        let record: Vec<_> =
            changing.iter().zip(&held).map(|(field, held)| values(field, held)).collect();
        written.append(time, &record).unwrap();
    }
}

/// Follows the `laws`, enforced by `contact`; `limit` is what its coefficients may be off.
fn laws_are_followed(laws: &[&[&str]], contact: &[&str], limit: f64) {
    let exact = contact[0].contains("exact");
    let folder = tempfile::tempdir().unwrap();
    for (number, law) in laws.iter().enumerate() {
        let run = folder.path().join(format!("run-{number}"));
        roll(&run, law, contact, &[EVERY]);
        let (_, found) = check(&run, &[]);
        let metric = &found["metrics"]["mu_error"];
        let error = metric["value"].as_f64().unwrap();
        assert!(error <= limit, "{law:?} {contact:?}: {metric:#}");
        assert_eq!((metric["pass"].as_bool(), &metric["note"]), (Some(true), &Value::Null));
        // dual functions are negative in places, and a slave over an edge pulls no node beyond it
        if exact && contact.len() == 1 {
            assert_eq!(found["metrics"]["tension"]["value"], 0.0, "{law:?}");
        }
        let known = found["law_followed"]["known"].as_f64().unwrap();
        let begins_with_pressure =
            law.iter().any(|set| set.contains("prakash") || set.contains("p*"));
        // with springs the dampers' part of the first pressure is not known, and has to be forgotten
        let least = if exact || !begins_with_pressure { 1.0 } else { 0.05 };
        assert!(known >= least, "{law:?} {contact:?}: {:#}", found["law_followed"]);
        // a coefficient with shear that believes it, and once the coefficient alone, which no law tells from another
        let plants = [&["mu", "shear"][..], &["mu"]];
        for fields in &plants[..if number > 0 { 1 } else { 2 }] {
            let copy = folder.path().join(format!("copy-{number}-{}", fields.join("-")));
            plant(&run, &copy, fields, 0.99);
            let map = copy.join("map.vtkhdf");
            let with_map = ["--map", map.to_str().unwrap()];
            let is_mapped = exact && fields.contains(&"shear");
            let (code, found) = check(&copy, if is_mapped { &with_map } else { &[] });
            let metric = &found["metrics"]["mu_error"];
            let case = format!("{law:?} {contact:?} {fields:?}: {metric:#}");
            assert_eq!((code, metric["pass"].as_bool()), (Some(1), Some(false)), "{case}");
            assert!((metric["value"].as_f64().unwrap() - 0.01).abs() < 2e-3, "{case}");
            let [used, law] = ["mu_used", "mu_law"].map(|key| metric["where"][key].as_f64());
            assert!((used.unwrap() / law.unwrap() - 0.99).abs() < 2e-3, "{case}");
            if is_mapped {
                // nor does the map believe the solver
                let map = GridFile::open(&map).unwrap();
                let planted = (0..map.steps()).any(|step| {
                    let [own, law] = ["law_error_own", "law_error"]
                        .map(|name| map.read(name, false, step).unwrap());
                    let mut ratio =
                        own.iter().zip(&law).map(|(own, law)| (1.0 + law) / (1.0 + own));
                    ratio.any(|ratio| (ratio - 0.99).abs() < 2e-3)
                });
                assert!(planted, "{case}");
            }
        }
    }
}

#[test]
fn with_exact_enforcement_the_mu_of_every_law_is_recomputed_and_a_wrong_one_ends_with_1() {
    laws_are_followed(&LAWS, &["contact.enforcement='exact'"], 1e-14);
}

#[test]
fn with_mortar_rows_mu_is_recomputed_and_a_wrong_one_ends_with_1() {
    let contact = ["contact.enforcement='exact'", "contact.rows='mortar'"];
    // with memory, rate and state, pressure
    laws_are_followed(&[LAWS[2], LAWS[5], LAWS[8]], &contact, 1e-14);
}

#[test]
fn with_two_passes_of_springs_the_mu_of_every_law_is_recomputed_and_a_wrong_one_ends_with_1() {
    laws_are_followed(&LAWS, &["contact.enforcement='penalty'"], 5e-5);
}

const MEMORY: &[&str] = &["law='exponential'", "dynamic=0.2", "memory.distance=1e-6"];

#[test]
fn between_records_of_many_steps_a_law_with_memory_is_known_with_its_uncertainty() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    roll(&run, MEMORY, &["contact.enforcement='exact'"], &["time.roll=0.004"]);
    let (_, found) = check(&run, &[]);
    let followed = &found["law_followed"];
    assert_eq!((&followed["known"], &followed["uncertain"]), (&0.0.into(), &1.0.into()));
    assert!(found["metrics"]["mu_error"]["value"].is_null());
    let uncertain = &found["metrics"]["mu_error_uncertain"];
    assert_eq!(uncertain["pass"], true, "{uncertain:#}");
    let rms = uncertain["sides"]["disk"]["uncertainty_rms"].as_f64().unwrap();
    assert!(rms > 1e-3 && rms < 0.5, "{rms}");
    let notes = found["notes"].to_string();
    assert!(notes.contains("not every step since contact began is recorded"), "{notes}");
    // beyond the uncertainty a coefficient is found all the same
    let copy = folder.path().join("copy");
    plant(&run, &copy, &["mu"], 1.5);
    let (code, found) = check(&copy, &[]);
    assert_eq!((code, &found["metrics"]["mu_error_uncertain"]["pass"]), (Some(1), &false.into()));
}

#[test]
fn a_law_that_forgets_is_known_again_once_every_step_is_recorded_for_long_enough() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    // the floor of 10 mm/s forgets within a third of the window at rest
    let law = [MEMORY, &["memory.floor=3.0"]].concat();
    let every = "output.window=[{ from = 30e-6, to = 60e-6, every = 1 }]";
    roll(&run, &law, &["contact.enforcement='exact'"], &["time.roll=0.004", every]);
    let (_, found) = check(&run, &["--window", "50e-6:60e-6"]);
    assert_eq!(found["law_followed"]["known"], 1.0, "{:#}", found["law_followed"]);
    assert!(found["metrics"]["mu_error"]["value"].as_f64().unwrap() < 1e-9);
    let (_, found) = check(&run, &["--window", "30e-6:32e-6"]);
    assert!(found["law_followed"]["uncertain"].as_f64().unwrap() > 0.5);
}

#[test]
fn without_friction_a_check_has_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    roll(&run, &["static=0"], &["contact.enforcement='exact'"], &[]);
    let (code, found) = check(&run, &[]);
    assert_eq!((code, &found["metrics"]["cone"]["value"]), (Some(0), &0.0.into()), "{found:#}");
}
