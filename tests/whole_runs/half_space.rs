//! Runs of half-spaces.

use creepage::figures::Reference;
use creepage::{Format, PlotOptions};
use runs::{Results, run, small};
use serde_json::{Value, json};
use std::sync::atomic::AtomicBool;

const MODEL: [&str; 2] = ["model=half-space", "mesh.zone.size=0.4e-3"];

fn rolled(sets: &[&str]) -> Results {
    small(&[&MODEL[..], sets].concat())
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[test]
fn contact_and_friction_hold_at_every_recorded_point() {
    let falling = ["friction.law=exponential", "friction.dynamic=0.2", "friction.mode=exact"];
    for law in [&[][..], &falling] {
        let results = rolled(law);
        let (shear, slip) = (results.contact("shear"), results.contact("slip_velocity"));
        let (pressure, mu) = (results.contact("pressure"), results.contact("mu"));
        let (mut slipping, mut sticking) = (0, 0);
        for (k, shear) in shear.iter().enumerate() {
            for (i, tau) in shear.chunks(3).enumerate() {
                let (p, s) = (pressure[k][i], &slip[k][3 * i..3 * i + 3]);
                let (size, bound, speed) = (length(tau), mu[k][i] * p, length(s));
                assert!(size <= bound * (1.0 + 1e-14), "{size} {bound}");
                if speed > 0.0 {
                    slipping += 1;
                    let power: f64 = tau.iter().zip(s).map(|(t, s)| t * s).sum();
                    assert!((power + bound * speed).abs() <= 1e-12 * bound * speed);
                } else {
                    sticking += usize::from(p > 0.0);
                }
            }
        }
        assert!(slipping > 300 && sticking > 1000, "{slipping} {sticking}");
    }
}

#[test]
fn what_is_recorded_is_no_part_of_the_solution() {
    let as_it_is = rolled(&[]);
    for zone in ["mesh.zone.width=0.0096", "mesh.zone.length=0.02", "mesh.window=0.006"] {
        let other = rolled(&[zone]);
        assert_eq!(as_it_is.history("tangential_force"), other.history("tangential_force"));
        assert_ne!(as_it_is.contact("pressure")[5].len(), other.contact("pressure")[5].len());
        // the patch lies where it did
        let p0 = "/contact/peak_pressure";
        assert!((as_it_is.number(p0) / other.number(p0) - 1.0).abs() < 1e-9, "{zone}");
    }
}

#[test]
fn inertia_changes_the_force_of_slow_rolling_by_less_than_a_thousandth() {
    let force = |sets: &[&str]| rolled(sets).number("/contact/traction_coefficient");
    let (with, without) = (force(&[]), force(&["half_space.inertia=false", "time.factor=0.05"]));
    assert!((with / without - 1.0).abs() < 1e-3, "{with} {without}");
    // waves are as fast as the patch only where it runs: the comparison can fail
    let fast = ["drive.speed=450", "drive.ramp=2.6e-6", "output.contact_interval=1e-6"];
    let slow = [&fast[..], &["half_space.inertia=false", "time.factor=0.05"]].concat();
    let (with, without) = (force(&fast), force(&slow));
    assert!((with / without - 1.0).abs() > 3e-3, "{with} {without}");
}

#[test]
fn half_spaces_expect_of_falling_friction_what_elements_do_but_for_the_layer_that_they_lack() {
    let law = [
        "friction.law=exponential",
        "friction.dynamic=0.2",
        "friction.memory.distance=2e-6",
        "time.roll=0.0004",
    ];
    let [elements, half_spaces, slow] =
        [small(&law), rolled(&law), rolled(&[&law[..], &["half_space.inertia=false"]].concat())];
    for key in
        ["pressure", "impedance", "r", "slip_length", "nucleation_length", "gamma", "stable_memory"]
    {
        let at = format!("/numbers/{key}");
        let [one, other] = [&elements, &half_spaces].map(|run| run.number(&at));
        assert!((other / one - 1.0).abs() < 1e-12, "{key}: {one} {other}");
    }
    let [at, without] = [&half_spaces, &slow].map(|run| &run.summary["numbers"]);
    assert!(at["n1"].is_null() && at["n2"].is_null(), "there is no layer of elements: {at}");
    assert!(without["r"].is_null(), "without waves there is no impedance: {without}");
    assert_eq!(without["gamma"], at["gamma"]);
    // across rolling bodies of Poisson's ratio 0.3 are softer by 1 - 0.3
    let across = rolled(&[&law[..], &["drive.creepage=0", "drive.lateral_creepage=1e-3"]].concat());
    let along = rolled(&[&law[..], &["drive.creepage=1e-3"]].concat());
    for key in ["slip_length", "nucleation_length"] {
        let [one, other] = [&along, &across].map(|run| run.number(&format!("/numbers/{key}")));
        assert!((other / one - 0.7).abs() < 1e-12, "{key}: {one} {other}");
    }
}

#[test]
fn slip_in_line_contact_bursts_with_less_memory_than_rolling_needs_to_be_stable_and_not_with_more()
{
    let path = runs::project("cases/half-space/line-falling.toml");
    let rolled = |distance: f64| {
        let memory = format!("friction.memory.distance={distance}");
        let case = runs::load(&path, &["mesh.zone.size=0.5e-3", "mesh.window=0.03", &memory]);
        let results = run(&case, 1);
        let records = results.contact("slip_velocity");
        let last = records[3 * records.len() / 4..].iter();
        let largest = last.flat_map(|slip| slip.chunks(3)).map(length).fold(0.0, f64::max);
        (results.number("/numbers/stable_memory"), largest)
    };
    let (stable, bursts) = rolled(3e-6);
    let (same, steady) = rolled(7e-6);
    assert_eq!(stable, same);
    assert!(stable > 4.5e-6 && stable < 5.2e-6, "{stable}");
    // with constant friction slip is 0.43 m/s at the rear end
    assert!(bursts > 0.8 && steady < 0.45, "{bursts} {steady}");
}

#[test]
fn the_number_of_threads_changes_no_bit_of_half_spaces() {
    let case = runs::load(&runs::project("tests/small.toml"), &MODEL);
    let (one, three) = (run(&case, 1), run(&case, 3));
    assert_eq!(one.differing(&three), Vec::<&str>::new());
}

#[test]
fn a_disturbance_of_the_pressure_changes_the_force_by_as_little_and_by_its_seed() {
    let force = |sets: &[&str]| rolled(sets).history("tangential_force").to_vec();
    let as_it_is = force(&[]);
    let disturbed = |seed: &str| force(&["preload.disturbance=1e-6", seed]);
    let (one, two) = (disturbed("preload.seed=1"), disturbed("preload.seed=2"));
    let apart = |a: &[f64], b: &[f64]| {
        let top = a.iter().fold(0.0_f64, |top, x| top.max(x.abs()));
        a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / top
    };
    for pair in [[&as_it_is, &one], [&as_it_is, &two], [&one, &two]] {
        let apart = apart(pair[0], pair[1]);
        assert!(apart > 1e-10 && apart < 1e-6, "{apart}");
    }
    assert_eq!(one, disturbed("preload.seed=1"));
}

#[test]
fn a_creepage_that_a_table_holds_is_that_of_a_number() {
    for model in [&["contact.enforcement=exact", "time.roll=0.002"][..], &MODEL] {
        let with = |sets: &[&str]| small(&[model, sets].concat());
        let number = with(&["drive.creepage=4e-3", "drive.ramp=0"]);
        let table = with(&["drive.creepage=[[0,4e-3],[1e-3,4e-3]]"]);
        let other = with(&["drive.creepage=[[0,0],[30e-6,4e-3]]"]);
        for column in ["creepage", "tangential_force", "friction_dissipated"] {
            assert_eq!(number.history(column), table.history(column), "{model:?}: {column}");
            assert_ne!(number.history(column), other.history(column), "{model:?}: {column}");
        }
        let last = |run: &Results| run.history("creepage").last().copied().unwrap();
        assert!((last(&other) / last(&number) - 1.0).abs() < 1e-9, "{model:?}");
    }
}

#[test]
fn the_reference_beside_a_run_is_its_steady_state_and_is_computed_once() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let sets = ["mesh.zone.size=0.25e-3", "half_space.inertia=false", "time.factor=0.5"];
    let case = runs::load(&runs::project("tests/small.toml"), &[&MODEL[..1], &sets].concat());
    let stop = AtomicBool::new(false);
    creepage::run::run(&case, &runs::options(&out, 2), &stop, &mut |_| {}).unwrap();
    let plot = || {
        let reference = Some(Reference::HalfSpace);
        let format = vec![Format::Svg];
        creepage::plot(&PlotOptions { run: out.clone(), reference, format, ..Default::default() })
            .unwrap();
    };
    let place = out.join("reference-half-space.json");
    let kept = || serde_json::from_slice::<Value>(&std::fs::read(&place).unwrap()).unwrap();
    let force = |of: &Value| of["traction_coefficient"].as_f64().unwrap();
    let inputs = "young poisson density half_length half_width peak_pressure mu creepage lateral_creepage spin";
    let mut of: serde_json::Map<_, _> =
        inputs.split(' ').map(|name| (name.to_owned(), 1.0.into())).collect();
    of.insert("creepage_version".into(), "".into());
    let other = json!({ "of": of, "spacing": 1.0, "traction_coefficient": 9.0, "centreline": [] });
    std::fs::write(&place, other.to_string()).unwrap();
    plot();
    let mut found = kept();
    let run = runs::results(&out).number("/contact/traction_coefficient");
    assert!((run / force(&found) - 1.0).abs() < 0.015, "{run} {found}");
    found["traction_coefficient"] = 8.0.into();
    std::fs::write(&place, found.to_string()).unwrap();
    plot();
    assert_eq!(force(&kept()), 8.0, "it was computed again");
}
