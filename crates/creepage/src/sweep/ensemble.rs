//! Ensembles: runs of one point of a sweep that differ by a disturbance of the preload alone, and the means over
//! them with their confidence intervals.

use output::confidence::interval;
use serde_json::{Map, Value, json};

/// Key of the axis of an ensemble's members.
pub(crate) const AXIS: &str = "preload.seed";
/// Key and size of the disturbance by which they differ, unless the file sets it.
pub(crate) const DISTURBANCE: (&str, f64) = ("preload.disturbance", 1e-9);

/// JSON pointers to the objects of a run over whose numbers means are taken.
const OF_RUN: [&str; 2] = ["/summary/contact", "/summary/window"];

/// The points of a sweep with an ensemble, in the order of their first members; none without an ensemble.
///
/// A point looks like a run: its `summary` and `check` hold the means over the members that completed, and `ci95`
/// half the width of the 95 % confidence interval of these means (Student 1908).
pub(super) fn points(document: &Value) -> Vec<Value> {
    if document["ensemble"].is_null() {
        return Vec::new();
    }
    let runs = document["runs"].as_array().map(Vec::as_slice).unwrap_or_default();
    let mut points: Vec<(Map<String, Value>, Vec<&Value>)> = Vec::new();
    for run in runs {
        let mut parameters = run["parameters"].as_object().cloned().unwrap_or_default();
        parameters.remove(AXIS);
        match points.iter_mut().find(|(known, _)| *known == parameters) {
            Some((_, members)) => members.push(run),
            None => points.push((parameters, vec![run])),
        }
    }
    points.into_iter().map(|(parameters, members)| point(parameters, &members)).collect()
}

fn point(parameters: Map<String, Value>, members: &[&Value]) -> Value {
    let completed: Vec<&Value> =
        members.iter().copied().filter(|run| run["status"] == "completed").collect();
    let [contact, window] = OF_RUN.map(|at| means(&completed, at));
    let halves: Map<String, Value> = contact
        .iter()
        .chain(&window)
        .map(|(name, [_, half])| (name.clone(), json!(half)))
        .collect();
    let only_means = |found: &[(String, [f64; 2])]| -> Map<String, Value> {
        found.iter().map(|(name, [mean, _])| (name.clone(), json!(mean))).collect()
    };
    let mut window_means = only_means(&window);
    window_means.insert("ci95".into(), Value::Object(halves));
    json!({
        "parameters": parameters,
        "members": members.iter().map(|run| &run["name"]).collect::<Vec<_>>(),
        "completed": completed.len(),
        // one member alone has no interval
        "status": if completed.len() > 1 { "completed" } else { "failed" },
        "run": completed.first().map(|run| &run["run"]),
        // the members differ in their step by no more than their disturbance
        "summary": {
            "dt": completed.first().map(|run| &run["summary"]["dt"]),
            "contact": only_means(&contact),
            "window": window_means,
        },
        "check": {
            "metrics": of_entries(&completed, "/check/metrics", "value"),
            "patch": of_entries(&completed, "/check/patch", "mean"),
            "slip_zone": of_entries(&completed, "/check/slip_zone", "value"),
        },
    })
}

/// Name, mean and half width of the confidence interval of the numbers in the object at `at`, where all members
/// have them.
fn means(members: &[&Value], at: &str) -> Vec<(String, [f64; 2])> {
    let first = members.first().and_then(|run| run.pointer(at)).and_then(Value::as_object);
    let mean = |name: &String| {
        let of = |run: &&Value| run.pointer(at)?.get(name)?.as_f64();
        Some((name.clone(), interval(&members.iter().map(of).collect::<Option<Vec<_>>>()?)?))
    };
    first.into_iter().flat_map(|object| object.keys()).filter_map(mean).collect()
}

/// The same of the number `key` in each entry of the object at `at`.
fn of_entries(members: &[&Value], at: &str, key: &str) -> Map<String, Value> {
    let first = members.first().and_then(|run| run.pointer(at)).and_then(Value::as_object);
    let entry = |name: &String| {
        let of = |run: &&Value| run.pointer(at)?.get(name)?.get(key)?.as_f64();
        let values = members.iter().map(of).collect::<Option<Vec<_>>>()?;
        let [mean, half] = interval(&values)?;
        Some((name.clone(), json!({ key: mean, "ci95": half })))
    };
    first.into_iter().flat_map(|object| object.keys()).filter_map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(seed: u64, step: f64, traction: f64) -> Value {
        json!({
            "name": format!("{seed}-{step}"), "run": format!("runs/{seed}"), "status": "completed",
            "parameters": { "time.factor": step, AXIS: seed },
            "summary": { "dt": 1e-7 * step,
                         "contact": { "traction_coefficient": traction, "creepage": null },
                         "window": { "torque": 2.0 * traction, "deviation": { "torque": 9.0 } } },
            "check": { "metrics": { "law_error": { "value": 0.1, "limit": 0.02 } }, "patch": {} },
        })
    }

    #[test]
    fn a_point_holds_the_mean_of_its_members_and_the_interval_of_that_mean() {
        let runs = [run(1, 0.5, 0.2), run(2, 0.5, 0.3), run(3, 0.5, 0.4), run(1, 0.25, 0.7)];
        let document = json!({ "ensemble": AXIS, "runs": runs });
        let points = points(&document);
        let at = |point: &Value, pointer: &str| point.pointer(pointer).and_then(Value::as_f64);
        assert_eq!(points.len(), 2);
        let close = |found: Option<f64>, wanted: f64| {
            assert!(
                found.is_some_and(|found| (found - wanted).abs() < 1e-12),
                "{found:?} {wanted}"
            );
        };
        close(at(&points[0], "/summary/contact/traction_coefficient"), 0.3);
        assert_eq!(at(&points[0], "/summary/dt"), Some(0.5e-7));
        let half = 4.303 * 0.1 / 3.0_f64.sqrt();
        close(at(&points[0], "/summary/window/ci95/traction_coefficient"), half);
        close(at(&points[0], "/summary/window/ci95/torque"), 2.0 * half);
        close(at(&points[0], "/check/metrics/law_error/ci95"), 0.0);
        assert!(points[0]["summary"]["contact"].get("creepage").is_none(), "no member has one");
        assert_eq!(points[0]["parameters"], json!({ "time.factor": 0.5 }));
        assert_eq!((&points[1]["status"], &points[1]["completed"]), (&json!("failed"), &json!(1)));
        assert!(super::points(&json!({ "ensemble": null, "runs": [] })).is_empty());
    }
}
