//! Sweeps with planted trends: the verdicts find them, the figures draw what completed.
use crate::planted::*;
use creepage::report::sweep_page;
use creepage::sweep::SweepResult;
use creepage::trends::{
    ComparedSweep, SweepVerdict, Trend, creep_force_figure, sweep_figures, sweep_verdicts,
};
use serde_json::{Value, json};
use std::path::Path;

const SPRING: &str = "contact.penalty.tangential";
const MESH: &str = "mesh.zone.size";

/// A run with a plateau at 1.24 GPa, slip that falls with a power, switches that grow with the
/// logarithm of `k`, and a creepage that stays.
fn run(k: f64, h: f64) -> Value {
    let scatter = 1.0 + 0.4 * if libm::log10(k).round() as i32 % 2 == 0 { 1.0 } else { -1.0 };
    json!({
        "parameters": { SPRING: k, MESH: h }, "status": "completed", "run": "none",
        "summary": { "contact": { "traction_coefficient": 0.27 } },
        "check": {
            "pass": false,
            "patch": {
                "peak_pressure": { "mean": 1.24e9 - 30e6 / k - 1e13 * h * h, "deviation": 1e6 },
                "creepage": { "mean": 2.4e-3, "deviation": 0.0 },
            },
            "metrics": {
                "adhesion_slip": { "value": 0.3 / k.sqrt(), "deviation": 0.0 },
                "switching_rate": { "value": 0.01 + 0.004 * libm::log10(k) },
                "violating_fraction": { "value": 0.3 * scatter, "deviation": 0.01 },
            },
        },
    })
}

fn failed(k: f64, h: f64) -> Value {
    json!({ "parameters": { SPRING: k, MESH: h }, "status": "failed", "run": "none",
            "reason": "the energy grew <12 times>", "summary": null, "check": null })
}

/// What `sweep.json` holds.
fn read(document: Value) -> SweepResult {
    serde_json::from_value(document).unwrap()
}

fn verdict<'a>(all: &'a [SweepVerdict], axis: &str, measure: &str) -> &'a SweepVerdict {
    all.iter().find(|v| v.axis == axis && v.measure == measure).unwrap()
}

#[test]
fn planted_trends_get_their_verdicts_and_a_failed_run_is_no_point() {
    let runs: Vec<Value> = [0.1, 1.0, 10.0, 100.0, 1000.0].map(|k| run(k, 1e-3)).into();
    let mut runs = runs;
    runs.push(failed(1e4, 1e-3));
    let sweep = read(json!({ "parameters": [SPRING], "runs": runs }));
    let found = sweep_verdicts(Path::new("s"), &sweep);
    let of = |measure| verdict(&found, SPRING, measure);
    let Trend::Reached(limit) = &of("peak pressure (fit)").trend else {
        panic!("{:?}", of("peak pressure (fit)"));
    };
    assert!((limit.value - 1230.0).abs() < 0.5, "{limit:?}");
    assert!((limit.exponent.unwrap() - 1.0).abs() < 0.02, "{limit:?}");
    assert_eq!(of("peak pressure (fit)").points, 5);
    assert!(matches!(of("creepage").trend, Trend::Flat { .. }));
    assert!(matches!(of("T/N").trend, Trend::Flat { .. }), "from the summary");
    assert!(
        matches!(of("adhesion_slip").trend, Trend::Vanishes { exponent } if (exponent - 0.5).abs() < 1e-9)
    );
    assert!(matches!(of("switching_rate").trend, Trend::Grows { .. }));
    assert_eq!(of("violating_fraction").verdict, "cannot be told");
    assert!(found.iter().all(|v| v.measure != "wrong_direction"), "nobody measured it");
}

#[test]
fn two_axes_have_a_map_a_line_for_each_value_of_the_other_and_a_verdict_for_each() {
    let mut runs = Vec::new();
    for h in [2e-3, 1e-3, 0.5e-3] {
        runs.extend([0.1, 1.0, 10.0, 100.0].map(|k| run(k, h)));
    }
    runs[5] = failed(1.0, 1e-3);
    let sweep = read(json!({ "parameters": [SPRING, MESH], "runs": runs }));
    let figures = sweep_figures(Path::new("s"), &sweep);
    let names: Vec<&str> = figures.iter().map(|(name, _)| name.as_str()).collect();
    let expected =
        ["measures-contact-penalty-tangential", "measures-mesh-zone-size", "map", "limits"];
    assert_eq!(names, expected);
    let spring = &figures[0].1;
    assert!(spring.caption.contains("1 of 12 runs did not complete"), "{}", spring.caption);
    let labels: Vec<&str> = spring.panels[0].series.iter().map(|s| s.label.as_str()).collect();
    assert!(labels.contains(&"mesh.zone.size = 0.002"), "{labels:?}");
    let pressure = &spring.panels[0].series;
    assert_eq!(pressure[0].points.len(), 4);
    assert_eq!(pressure[3].points.len(), 3, "the failed run is no point");
    // a bar of one deviation to each side
    let bar = &pressure[2].points[..2];
    assert!((bar[1][1] - bar[0][1] - 2.0).abs() < 1e-9, "{bar:?}");
    let cells = &figures[2].1.panels[0].fill.as_ref().unwrap().cells;
    assert_eq!(cells.len(), 11);
    let found = sweep_verdicts(Path::new("s"), &sweep);
    let pressure = found.iter().filter(|v| v.axis == MESH && v.measure == "peak pressure (fit)");
    let pressure: Vec<_> = pressure.collect();
    assert_eq!(pressure.len(), 4);
    // h = 2, 1, 0.5 mm: 40, 10, 2.5 MPa away from the limit, power 2; one value has two points only
    assert_eq!(pressure[1].verdict, "cannot be told");
    let Trend::Reached(limit) = &pressure[3].trend else {
        panic!("{:?}", pressure[3]);
    };
    assert!((limit.value - 1239.7).abs() < 1e-6, "{limit:?}");
    assert!((limit.exponent.unwrap() - 2.0).abs() < 1e-6, "{limit:?}");
}

/// A run with T/N by springs of the stiffness `k` in series with the bodies, in the time step `dt`.
fn in_series(k: &Value, dt: f64) -> Value {
    let stiffness = k.as_f64().or(k["stiffness"].as_f64()).unwrap();
    let traction = 1.0 / (3.0 + 0.1 / stiffness);
    json!({
        "parameters": { SPRING: k }, "status": "completed", "run": "none",
        "summary": { "dt": dt, "contact": { "traction_coefficient": traction },
                     "window": { "deviation": { "traction_coefficient": 0.02 } } },
    })
}

#[test]
fn springs_in_any_form_are_judged_by_their_series_and_never_two_forms_on_one_axis() {
    let of = |runs: Vec<Value>| {
        let sweep = read(json!({ "parameters": [SPRING], "runs": runs }));
        let found = sweep_verdicts(Path::new("s"), &sweep);
        let figures = sweep_figures(Path::new("s"), &sweep);
        let label = figures[0].1.panels[0].x.label.clone();
        (verdict(&found, SPRING, "T/N").clone(), label)
    };
    let numbers = [0.1, 1.0, 10.0, 100.0];
    let factors = || numbers.map(|k| in_series(&json!(k), 1e-7)).to_vec();
    let stiffnesses = numbers.map(|k| in_series(&json!({ "stiffness": k }), 1e-7)).to_vec();
    let mut mixed = factors();
    mixed.push(in_series(&json!({ "stiffness": 5.0 }), 1e-7));
    let all = [(factors(), "(-)"), (stiffnesses, "(N/m\u{b3})"), (mixed, "(-)")];
    for (runs, unit) in all {
        let (found, label) = of(runs);
        let Trend::Reached(limit) = found.trend else { panic!("{found:?}") };
        assert!((limit.value - 1.0 / 3.0).abs() < 1e-12, "{limit:?}");
        assert_eq!((limit.exponent, found.points), (None, 4));
        assert!(label.ends_with(unit), "{label}");
    }
}

#[test]
fn a_step_that_changes_along_an_axis_is_told_on_the_page_and_beside_the_verdicts() {
    let page = |dts: [f64; 3], rule: Value| {
        let runs: Vec<Value> =
            [0.1, 1.0, 10.0].iter().zip(dts).map(|(k, dt)| in_series(&json!(k), dt)).collect();
        let sweep = read(json!({ "parameters": [SPRING], "runs": runs, "step": { "rule": rule } }));
        let found = sweep_verdicts(Path::new("s"), &sweep);
        let page = sweep_page("kt", Path::new("s/sweep.json"), &sweep).unwrap();
        (page, verdict(&found, SPRING, "T/N").time_steps)
    };
    let (text, steps) = page([334e-9, 200e-9, 92e-9], json!("bound"));
    assert_eq!(steps, Some([92e-9, 334e-9]));
    for part in [
        "The time step differs from run to run: 92.00 to 334.0 ns",
        "times the stability limit of each run",
        "The time step changes along this axis, from 92.00 to 334.0 ns",
    ] {
        assert!(text.contains(part), "{part}");
    }
    let (text, steps) = page([92e-9; 3], json!("fixed"));
    assert_eq!(steps, None);
    assert!(text.contains("Time step of all runs: 92.00 ns") && !text.contains("changes along"));
}

/// A run of constant friction (`decay` 0) or falling friction, with springs or without.
fn limit_run(k: f64, dt: f64, enforcement: &str, decay: f64) -> Value {
    let exact = enforcement == "exact";
    let traction = if exact { 0.25 } else { 1.0 / (4.0 + 0.1 / k) } - 0.01 * decay;
    let violating = if exact { 0.0 } else { 0.96 };
    json!({
        "parameters": { SPRING: k, STEP: dt, "contact.enforcement": enforcement,
                        "friction.decay": decay },
        "status": "completed", "run": "none",
        "summary": { "dt": dt, "contact": { "traction_coefficient": traction } },
        "check": { "metrics": { "violating_fraction": { "value": violating },
                                "violating_fraction_slip_state": { "value": 0.5 * violating } } },
    })
}

const STEP: &str = "time.step";

#[test]
fn the_page_opens_with_what_springs_and_step_lead_to_beside_exact_contact() {
    let mut runs = Vec::new();
    for decay in [0.0, 6.0] {
        runs.extend([0.1, 1.0, 10.0, 100.0].map(|k| limit_run(k, 5e-8, "penalty", decay)));
        runs.extend([1e-8, 2e-8].map(|dt| limit_run(1.0, dt, "penalty", decay)));
        runs.push(limit_run(1.0, 5e-8, "exact", decay));
    }
    let parameters = [SPRING, STEP, "contact.enforcement", "friction.decay"];
    let sweep = read(json!({ "parameters": parameters, "runs": runs }));
    let page = sweep_page("limit", Path::new("s/sweep.json"), &sweep).unwrap();
    for part in [
        "<b>Does the force T/N settle?</b> As contact.penalty.tangential grows, with \
         friction.decay = 0 it settles at 0.25",
        "(exact contact: 0.2500); with friction.decay = 6 it ",
        "As time.step goes to zero, with friction.decay = 0 it settles at 0.2439",
        "Over time.step, with friction.decay = 0 on 96 % of contact area and time, on 48 % where nodes slip by the algorithm (exact contact: 0 %)",
        "id=\"limits\"",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let verdicts = sweep_verdicts(Path::new("s"), &sweep);
    let forces = verdicts.iter().filter(|v| v.measure == "T/N" && v.axis != "friction.decay");
    let labels: Vec<&str> = forces.map(|v| v.others.as_str()).collect();
    let laws = ["friction.decay = 0", "friction.decay = 6"];
    assert_eq!(labels, [laws, laws].concat(), "exact contact is no group of its own");
}

#[test]
fn profiles_are_read_from_the_runs_and_runs_without_a_file_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let mut runs = [0.1, 1.0, 10.0].map(|k| run(k, 1e-3));
    for (k, name) in ["a", "b"].into_iter().enumerate() {
        write(&folder.path().join(name), FALLING, "penalty", 5, |x, _| perfect(FALLING, x, 0));
        runs[k]["run"] = json!(name);
    }
    let sweep = read(json!({ "parameters": [SPRING], "runs": runs }));
    let figures = sweep_figures(folder.path(), &sweep);
    let (name, profiles) = &figures[1];
    assert_eq!(name, "profiles-contact-penalty-tangential");
    let [pressure, shear, slip] = &profiles.panels[..] else { panic!("{profiles:?}") };
    assert_eq!(pressure.series.len(), 2, "two of three runs have a contact history");
    for (panel, planted) in [(pressure, 1e-6 * P0), (shear, 0.0), (slip, 0.0)] {
        let most = panel.series[0].points.iter().map(|p| p[1]).filter(|v| v.is_finite());
        let most = most.fold(0.0, f64::max);
        // the planted patch rests, its centre within half a bin
        assert!(if planted > 0.0 { (most / planted - 1.0).abs() < 1e-9 } else { most > 0.0 });
    }
}

#[test]
fn the_page_has_table_reasons_and_verdicts_and_a_document_that_is_no_sweep_is_refused() {
    let runs = [run(0.1, 1e-3), run(1.0, 1e-3), run(10.0, 1e-3), failed(100.0, 1e-3)];
    let mut sweep = read(json!({ "parameters": [SPRING], "runs": runs }));
    sweep.runs[0].name = Some("000-tangential-0.1".into());
    let page = sweep_page("kt", Path::new("s/sweep.json"), &sweep).unwrap();
    for part in [
        "creepage run s/cases/000-tangential-0.1.toml --out s/again/000-tangential-0.1",
        "4 runs over contact.penalty.tangential; 3 completed",
        "failed: the energy grew &lt;12 times&gt;",
        "<td>settles</td>",
        "Cannot be told (scatter): the values differ by no more than the scatter",
        "three points determine the fit",
        "id=\"measures-contact-penalty-tangential\"",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let folder = tempfile::tempdir().unwrap();
    for bad in [
        json!({}),
        json!({ "parameters": [] }),
        json!(3),
        json!({ "runs": [] }),
        json!({ "parameters": [3, SPRING], "runs": [3, null, { "parameters": 4, "run": 5 }] }),
    ] {
        std::fs::write(folder.path().join("sweep.json"), bad.to_string()).unwrap();
        let refused = creepage::sweep_table(folder.path()).unwrap_err().to_string();
        assert!(refused.contains("sweep.json") && refused.contains("is no sweep"), "{refused}");
    }
    // words as values, no runs at all: nothing to draw, no harm
    for odd in [
        json!({ "parameters": ["friction.law"], "runs": [
            { "parameters": { "friction.law": "coulomb" }, "status": "completed" },
            { "parameters": { "friction.law": "exponential" }, "status": "completed" }] }),
        json!({ "parameters": [SPRING], "runs": [] }),
    ] {
        let odd = read(odd);
        assert!(sweep_figures(Path::new("s"), &odd).is_empty());
        assert!(sweep_page("s", Path::new("s/sweep.json"), &odd).is_ok());
    }
}

/// A run of a creep-force curve: T/N = `plateau` (1 - exp(-creepage/2e-3)).
fn creep(creepage: f64, distance: f64, plateau: f64) -> Value {
    let ratio = plateau * (1.0 - libm::exp(-creepage / 2e-3));
    json!({
        "parameters": { CREEPAGE: creepage, MEMORY: distance }, "status": "completed", "run": "none",
        "summary": { "contact": { "traction_coefficient": ratio } }, "check": null,
    })
}

const CREEPAGE: &str = "drive.creepage";
const MEMORY: &str = "friction.memory.distance";

fn creep_sweep(plateau: f64) -> Value {
    let points = [1e-3, 4e-3, 2e-3].iter().flat_map(|c| [(*c, 1e-5), (*c, 3e-6)]);
    let runs: Vec<Value> = points.map(|(c, d)| creep(c, d, plateau)).collect();
    json!({ "parameters": [MEMORY, CREEPAGE], "runs": runs })
}

#[test]
fn a_sweep_over_creepage_has_its_creep_force_curve_with_a_line_for_each_law() {
    let sweep = read(creep_sweep(0.3));
    let figures = sweep_figures(Path::new("s"), &sweep);
    let (_, curve) = figures.iter().find(|(name, _)| name == "creep-force").unwrap();
    let [panel] = &curve.panels[..] else { panic!("{} panels", curve.panels.len()) };
    let named: Vec<&str> =
        panel.series.iter().map(|s| s.label.as_str()).filter(|l| !l.is_empty()).collect();
    assert_eq!(named.len(), 2, "{named:?}");
    let x: Vec<f64> = panel.series[0].points.iter().map(|p| p[0]).collect();
    assert_eq!(x, [1.0, 2.0, 4.0], "by rising creepage");
    assert!((panel.series[0].points[1][1] - 0.3 * (1.0 - libm::exp(-1.0))).abs() < 1e-15);
}

#[test]
fn curves_of_several_methods_stand_in_one_panel_for_each_law() {
    let sweeps = [0.3, 0.28, 0.27].map(|plateau| read(creep_sweep(plateau)));
    let names = ["elements", "half-spaces", "quasi-static"];
    let compared: Vec<ComparedSweep<'_>> = names
        .iter()
        .zip(&sweeps)
        .map(|(name, result)| ComparedSweep {
            name: (*name).into(),
            folder: Path::new("s"),
            result,
        })
        .collect();
    let (_, figure) = creep_force_figure(&compared).unwrap();
    assert_eq!(figure.panels.len(), 2);
    let labels = |k: usize| -> Vec<String> {
        let labels = figure.panels[k].series.iter().map(|s| s.label.clone());
        labels.filter(|label| !label.is_empty()).collect()
    };
    assert_eq!(labels(0), names);
    assert!(labels(1).is_empty(), "a legend once");
    assert!(figure.panels.iter().all(|panel| panel.series.len() == 9));
}

#[test]
fn a_creep_force_curve_through_zero_tells_the_creepage_of_free_rolling_and_shows_it_all() {
    // a polymer wheel on steel: T/N -.053 at creepage 0
    let mut sweep = creep_sweep(0.3);
    let of = |creepage: f64, traction: f64| {
        let mut run = creep(1e-3, 1e-5, 0.3);
        run["parameters"][CREEPAGE] = json!(creepage);
        run["summary"]["contact"]["traction_coefficient"] = json!(traction);
        run
    };
    sweep["runs"] = json!([of(-1e-3, -0.149), of(0.0, -0.053), of(1e-3, 0.043)]);
    let sweep = read(sweep);
    let compared = [ComparedSweep { name: "".into(), folder: Path::new("s"), result: &sweep }];
    let (_, figure) = creep_force_figure(&compared).unwrap();
    // 53/96 of the way, by hand
    assert!(
        figure.caption.contains("T = 0, by interpolation, at creepage 0.552e-3"),
        "{}",
        figure.caption
    );
    let panel = &figure.panels[0];
    assert!(panel.x.range.unwrap()[0] <= -1.0 && panel.y.range.unwrap()[0] <= -0.149);
    // none where the curve has one sign
    let sweep = read(creep_sweep(0.3));
    let compared = [ComparedSweep { name: "".into(), folder: Path::new("s"), result: &sweep }];
    assert!(!creep_force_figure(&compared).unwrap().1.caption.contains("T = 0"));
}

#[test]
fn a_sweep_without_creepage_has_no_creep_force_curve() {
    let sweep = read(json!({ "parameters": [SPRING], "runs": [run(1.0, 1e-3), run(10.0, 1e-3)] }));
    let compared = [ComparedSweep { name: "kt".into(), folder: Path::new("s"), result: &sweep }];
    assert!(creep_force_figure(&compared).is_none());
}

/// A sweep of two members of one point, as the version with free JSON documents wrote it.
const WRITTEN: &str = include_str!("../fixtures/sweep-written-before.json");

#[test]
fn a_sweep_with_summaries_and_checks_that_was_written_before_reads_back_with_every_key_and_value() {
    fn same(written: &Value, again: &Value, at: &str) {
        match (written, again) {
            (Value::Object(written), Value::Object(again)) => {
                for (key, value) in written {
                    let found = again.get(key).unwrap_or_else(|| panic!("{at}/{key} is gone"));
                    same(value, found, &format!("{at}/{key}"));
                }
            }
            (Value::Array(written), Value::Array(again)) => {
                assert_eq!(written.len(), again.len(), "{at}");
                for (i, (written, again)) in written.iter().zip(again).enumerate() {
                    same(written, again, &format!("{at}/{i}"));
                }
            }
            _ => assert_eq!(written, again, "{at}"),
        }
    }
    let result: SweepResult = serde_json::from_str(WRITTEN).unwrap();
    same(&serde_json::from_str(WRITTEN).unwrap(), &serde_json::to_value(&result).unwrap(), "");
    assert!(result.runs.iter().all(|run| run.completed()) && result.points.len() == 1);
}
