//! The numbers of short runs, bit for bit: what a change of structure must leave as it is.
//!
//! `tests/bits.json` holds the SHA-256 of every dataset. A change that is meant to move bits writes them anew:
//!
//! ```sh
//! BLESS=1 cargo test --release -p creepage-tests bits::
//! ```

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use runs::{Results, load, project, run};
use sha2::{Digest, Sha256};
use slider::{Method, Parameters};

/// A name, a case file and what is set over it.
type Short = (&'static str, &'static str, &'static [&'static str]);

const SMALL: &str = "tests/small.toml";
const SLICE: &str = "cases/verdict/slice.toml";

/// Kernels that every processor follows, a given step, and snapshots.
const SMALL_SETS: &[&str] = &[
    "friction.static=0.5",
    "deterministic=true",
    "mesh.zone.size=0.8e-3",
    "time.step=8e-8",
    "time.roll=0.002",
    "drive.ramp=20e-6",
    "element.contact_layers=full",
    "output.fields_interval=40e-6",
    "output.contact_interval=10e-6",
    "evaluate.last=0.001",
];

const SLICE_SETS: &[&str] = &[
    "deterministic=true",
    "mesh.zone.size=2e-3",
    "mesh.zone.length=0.03",
    "time.step=2e-7",
    "time.roll=0.012",
    "drive.creepage=0.02",
    "drive.ramp=30e-6",
    "element.contact_layers=full",
    "output.fields_interval=60e-6",
    "output.contact_interval=20e-6",
];

const RUNS: [Short; 16] = [
    ("penalty, Coulomb", SMALL, &["contact.enforcement=penalty"]),
    ("exact, Coulomb", SMALL, &["contact.enforcement=exact"]),
    ("mortar, Coulomb", SMALL, &["contact.enforcement=exact", "contact.rows=mortar"]),
    (
        "penalty, Eq (8) lagged",
        SMALL,
        &["contact.enforcement=penalty", "friction.law=exponential", "friction.mode=lagged"],
    ),
    (
        "exact, Eq (8) lagged",
        SMALL,
        &["contact.enforcement=exact", "friction.law=exponential", "friction.mode=lagged"],
    ),
    (
        "exact, Eq (8) at the same instant",
        SMALL,
        &["contact.enforcement=exact", "friction.law=exponential", "friction.mode=exact"],
    ),
    (
        "mortar, memory",
        SMALL,
        &[
            "contact.enforcement=exact",
            "contact.rows=mortar",
            "friction.law=exponential",
            "friction.memory.distance=2e-6",
        ],
    ),
    (
        "penalty, memory",
        SMALL,
        &[
            "contact.enforcement=penalty",
            "friction.law=exponential",
            "friction.memory.distance=2e-6",
        ],
    ),
    (
        "exact, rate and state",
        SMALL,
        &["contact.enforcement=exact", "friction.law=rate_state", "friction.distance=2e-6"],
    ),
    (
        "penalty, rate and state",
        SMALL,
        &[
            "contact.enforcement=penalty",
            "friction.law=rate_state",
            "friction.distance=2e-6",
            "friction.state=slip",
        ],
    ),
    (
        "exact, formula",
        SMALL,
        &[
            "contact.enforcement=exact",
            "friction.law=expression",
            "friction.expression=\"0.2 + 0.1*exp(-6*s)\"",
        ],
    ),
    (
        "penalty, one-point elements, torque, relaxation",
        SMALL,
        &[
            "contact.enforcement=penalty",
            "element.contact_layers=one-point",
            "preload.method=relaxation",
            "drive.mode=torque",
            "drive.torque=100.0",
            "damping.mass=4000",
        ],
    ),
    ("slice, penalty, Coulomb", SLICE, &["contact.enforcement=penalty"]),
    ("slice, exact, Coulomb", SLICE, &["contact.enforcement=exact"]),
    (
        "slice, exact, memory",
        SLICE,
        &["contact.enforcement=exact", "friction.law=exponential", "friction.memory.distance=2e-6"],
    ),
    (
        "slice, penalty, Prakash-Clifton",
        SLICE,
        &["contact.enforcement=penalty", "friction.law=prakash_clifton", "friction.distance=2e-6"],
    ),
];

fn sum(values: impl IntoIterator<Item = f64>) -> String {
    let mut sum = Sha256::new();
    values.into_iter().for_each(|x| sum.update(x.to_le_bytes()));
    sum.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// By dataset, all steps of a grid's field together.
fn sums(run: &Results) -> BTreeMap<String, String> {
    let mut whole: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (name, values) in &run.data {
        let stem = match name.rsplit_once('/') {
            Some((stem, step)) if step.parse::<u32>().is_ok() => stem,
            _ => name,
        };
        whole.entry(stem.to_owned()).or_default().extend(values);
    }
    whole.into_iter().map(|(name, values)| (name, sum(values))).collect()
}

/// Position, velocity, slip velocity, friction force and coefficient of the 1-D slider after every step.
fn slider_sums() -> BTreeMap<String, String> {
    let sums = Method::ALL.map(|method| {
        let mut values = Vec::new();
        let p = Parameters::default();
        let observe = |t: f64, s: &slider::State| {
            values.extend([t, s.x, s.v, s.slip, s.friction, s.mu]);
            if values.len() < 50_000 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        slider::run(&p, method, observe).unwrap();
        (method.name().to_owned(), sum(values))
    });
    sums.into_iter().collect()
}

#[test]
fn short_runs_have_the_bits_that_are_written_down() {
    let mut found = BTreeMap::new();
    for (name, case, sets) in RUNS {
        let short = if case == SLICE { SLICE_SETS } else { SMALL_SETS };
        let run = run(&load(&project(case), &[short, sets].concat()), 2);
        assert_eq!(run.summary["status"], "completed", "{name}");
        let last = |field| run.contact(field).last().unwrap().to_vec();
        assert!(last("shear").iter().any(|x| *x != 0.0), "{name}: friction acts");
        assert!(last("state").contains(&2.0), "{name}: nodes slip");
        found.insert(name.to_owned(), sums(&run));
    }
    found.insert("slider".to_owned(), slider_sums());
    let file = project("tests/bits.json");
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&file, serde_json::to_string_pretty(&found).unwrap() + "\n").unwrap();
    }
    let text = std::fs::read_to_string(&file).unwrap();
    let expected: BTreeMap<String, BTreeMap<String, String>> = serde_json::from_str(&text).unwrap();
    assert!(found.keys().eq(expected.keys()), "other runs: {:?}", found.keys());
    let moved: Vec<String> = found
        .iter()
        .flat_map(|(run, sums)| {
            let before = &expected[run];
            let moved = sums.iter().filter(move |(name, sum)| before.get(*name) != Some(*sum));
            let lost = before.keys().filter(|name| !sums.contains_key(*name));
            moved.map(|(name, _)| name).chain(lost).map(move |name| format!("{run}: {name}"))
        })
        .collect();
    assert!(moved.is_empty(), "bits have moved in\n{}", moved.join("\n"));
}
