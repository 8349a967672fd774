//! The mesh of a case as a page to read.

use std::fmt::Write;

use serde_json::Value;

use super::layout::{about, count, digits, heading, number, row, text as word};

/// The whole page.
pub fn text(report: &Value) -> String {
    let at = |pointer: &str| number(report, pointer);
    let mut out = String::new();
    let _ = writeln!(
        out,
        "{}: {} elements, {} nodes",
        word(report, "/name"),
        count(at("/elements")),
        count(at("/nodes"))
    );
    let none = Vec::new();
    for body in report.get("bodies").and_then(Value::as_array).unwrap_or(&none) {
        let of = |pointer: &str| count(number(body, pointer));
        let name = word(body, "/name");
        let _ = writeln!(
            out,
            "  {name:<6}{:>12} elements{:>12} nodes   sets: {}",
            of("/elements"),
            of("/nodes"),
            sets(body)
        );
    }
    for note in report.get("notes").and_then(Value::as_array).unwrap_or(&none) {
        let _ = writeln!(out, "  {}", note.as_str().unwrap_or_default());
    }
    heading(&mut out, "Quality");
    let worst = format!("element {}", count(at("/quality/worst_element")));
    let jacobian = |key: &str| digits(at(&format!("/quality/{key}")), 3);
    row(&mut out, "least scaled Jacobian", &jacobian("min_scaled_jacobian"), "", &worst);
    row(&mut out, "mean scaled Jacobian", &jacobian("mean_scaled_jacobian"), "", "1 is a brick");
    row(&mut out, "largest aspect ratio", &digits(at("/quality/max_aspect"), 3), "", "");
    let edge = at("/quality/min_edge").map(|x| 1e3 * x);
    row(&mut out, "shortest edge", &digits(edge, 3), "mm", "");

    heading(&mut out, "Time step");
    let ns = |key: &str| digits(at(&format!("/stable_dt/{key}")).map(|x| 1e9 * x), 4);
    row(&mut out, "limit 2/omega_max", &ns("power_iteration"), "ns", "by power iteration");
    row(&mut out, "bound by elements", &ns("bound"), "ns", &weakest(report));
    row(&mut out, "step of this case", &ns("step"), "ns", "time.factor times the limit");

    heading(&mut out, "Estimate of a run");
    row(&mut out, "memory", &digits(at("/estimate/memory_mb"), 3), "MB", "");
    let disk = at("/estimate/disk/total_mb");
    let free = at("/estimate/disk/free_mb");
    let short = match (disk, free) {
        (Some(disk), Some(free)) if disk > free => format!("only {free:.0} MB are free"),
        _ => "of results".into(),
    };
    row(&mut out, "disk", &digits(disk, 3), "MB", &short);
    let springs = report.pointer("/estimate/springs_lower_the_step") == Some(&Value::Bool(true));
    let more = if springs { "or more: closed penalty springs lower the step" } else { "" };
    row(&mut out, "steps", &count(at("/estimate/steps")), "", more);
    let time = at("/estimate/run_time_s");
    let note = match time {
        Some(_) => "on this machine, for the elements and nodes alone",
        None => "not estimated for implicit steps",
    };
    row(&mut out, "rolling takes about", &about(time), "", note);
    out
}

fn sets(body: &Value) -> String {
    let Some(sets) = body.get("sets").and_then(Value::as_object) else {
        return "-".into();
    };
    let shown = sets.iter().map(|(name, size)| format!("{name} {}", count(size.as_f64())));
    shown.collect::<Vec<_>>().join(", ")
}

/// The element that bounds the step.
fn weakest(report: &Value) -> String {
    let element = count(number(report, "/stable_dt/bound_element"));
    let along =
        |i: u8| number(report, &format!("/stable_dt/bound_element_centre/{i}")).map(|x| 1e3 * x);
    match [along(0), along(1), along(2)] {
        [Some(x), Some(y), Some(z)] => {
            format!("element {element} at ({x:.1}, {y:.1}, {z:.1}) mm")
        }
        _ => format!("element {element}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_page_names_bodies_quality_step_and_estimate_with_units() {
        let page = text(&json!({
            "name": "quick", "elements": 41320, "nodes": 46641,
            "bodies": [{ "name": "disk", "elements": 27400, "nodes": 30534,
                         "sets": { "hub": 1176, "tread": 2352 } }],
            "quality": { "min_scaled_jacobian": 0.4556, "max_aspect": 25.000000000000007 },
            "stable_dt": { "bound": 1.8469e-7, "bound_element": 16514,
                           "bound_element_centre": [0.0677, 0.009, 0.01209] },
            "estimate": { "run_time_s": 3.84, "steps": 6989.0,
                          "disk": { "total_mb": 160.2, "free_mb": 99.0 } },
        }));
        for line in [
            "quick: 41 320 elements, 46 641 nodes",
            "  disk        27 400 elements      30 534 nodes   sets: hub 1 176, tread 2 352",
            "  largest aspect ratio            25.0",
            "  bound by elements              184.7 ns     element 16 514 at (67.7, 9.0, 12.1) mm",
            "  disk                             160 MB     only 99 MB are free",
            "  rolling takes about              4 s        on this machine, for the elements and nodes alone",
        ] {
            assert!(page.lines().any(|l| l == line), "{line:?} is not a line of\n{page}");
        }
        assert!(!page.contains("null"));
    }
}
