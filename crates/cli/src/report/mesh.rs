//! The mesh of a case as a page to read.

use std::fmt::Write;

use creepage::run::{BodyReport, MeshReport, StableStep};

use super::layout::{about, count, digits, heading, row};

/// The whole page.
pub fn text(report: &MeshReport) -> String {
    let number = |n: usize| count(Some(n as f64));
    if report.elements == 0 {
        let lines = report.notes.iter().map(|line| format!("  {line}\n"));
        return format!("{}\n{}", report.name, lines.collect::<String>());
    }
    let mut out = String::new();
    let _ = writeln!(
        out,
        "{}: {} elements, {} nodes",
        report.name,
        number(report.elements),
        number(report.nodes)
    );
    for body in &report.bodies {
        let BodyReport { name, elements, nodes, .. } = body;
        let [elements, nodes] = [*elements, *nodes].map(number);
        let _ = writeln!(
            out,
            "  {name:<6}{elements:>12} elements{nodes:>12} nodes   sets: {}",
            sets(body)
        );
    }
    for note in &report.notes {
        let _ = writeln!(out, "  {note}");
    }
    heading(&mut out, "Quality");
    let quality = &report.quality;
    let worst = format!("element {}", number(quality.worst_element));
    let jacobian = |value: f64| digits(Some(value), 3);
    row(&mut out, "least scaled Jacobian", &jacobian(quality.min_scaled_jacobian), "", &worst);
    let mean = jacobian(quality.mean_scaled_jacobian);
    row(&mut out, "mean scaled Jacobian", &mean, "", "1 is a brick");
    row(&mut out, "largest aspect ratio", &digits(Some(quality.max_aspect), 3), "", "");
    row(&mut out, "shortest edge", &digits(Some(1e3 * quality.min_edge), 3), "mm", "");

    heading(&mut out, "Time step");
    let ns = |step: f64| digits(Some(1e9 * step), 4);
    let step = &report.stable_dt;
    row(&mut out, "limit 2/omega_max", &ns(step.power_iteration), "ns", "by power iteration");
    row(&mut out, "bound by elements", &ns(step.bound), "ns", &weakest(step));
    row(&mut out, "step of this case", &ns(step.step), "ns", "time.factor times the limit");

    heading(&mut out, "Estimate of a run");
    let estimate = &report.estimate;
    row(&mut out, "memory", &digits(Some(estimate.memory_mb), 3), "MB", "");
    let disk = estimate.disk.total_mb;
    let short = match estimate.disk.free_mb {
        Some(free) if disk > free => format!("only {free:.0} MB are free"),
        _ => "of results".into(),
    };
    row(&mut out, "disk", &digits(Some(disk), 3), "MB", &short);
    let springs = estimate.springs_lower_the_step;
    let more = if springs { "or more: closed penalty springs lower the step" } else { "" };
    row(&mut out, "steps", &count(Some(estimate.steps)), "", more);
    let note = match estimate.run_time_s {
        Some(_) => "on this machine, for the elements and nodes alone",
        None => "not estimated for implicit steps",
    };
    row(&mut out, "rolling takes about", &about(estimate.run_time_s), "", note);

    if let Some(shared) = &report.shared {
        heading(&mut out, &format!("Shared by {} processes", shared.processes));
        let [fewest, most] = shared.elements.map(number);
        row(&mut out, "elements of each", &most, "", &format!("at most, {fewest} at least"));
        let again = digits(Some(1e2 * shared.computed_again), 3);
        row(&mut out, "computed once more", &again, "%", "of all elements");
        let sent = digits(Some(1e-3 * shared.sent as f64), 3);
        row(&mut out, "sent in a step", &sent, "kB", "by one process, at most");
        let memory = digits(Some(estimate.memory_mb), 3);
        row(&mut out, "memory of each", &memory, "MB", "as much as one process alone");
    }
    out
}

fn sets(body: &BodyReport) -> String {
    let shown =
        body.sets.iter().map(|(name, size)| format!("{name} {}", count(Some(*size as f64))));
    let shown = shown.collect::<Vec<_>>().join(", ");
    if shown.is_empty() { "-".into() } else { shown }
}

/// The element that bounds the step.
fn weakest(step: &StableStep) -> String {
    let element = count(Some(step.bound_element as f64));
    let [x, y, z] = step.bound_element_centre.map(|x| 1e3 * x);
    format!("element {element} at ({x:.1}, {y:.1}, {z:.1}) mm")
}

#[cfg(test)]
mod tests {
    use super::*;
    use creepage::run::{DiskEstimate, Estimate, QualityReport};

    #[test]
    fn the_page_names_bodies_quality_step_and_estimate_with_units() {
        let sets = [("hub", 1176), ("tread", 2352)].map(|(name, n)| (name.to_owned(), n));
        let disk = BodyReport {
            name: "disk".into(),
            elements: 27400,
            nodes: 30534,
            sets: sets.into_iter().collect(),
        };
        let page = text(&MeshReport {
            name: "quick".into(),
            elements: 41320,
            nodes: 46641,
            bodies: vec![disk],
            quality: QualityReport {
                min_scaled_jacobian: 0.4556,
                max_aspect: 25.000000000000007,
                ..QualityReport::default()
            },
            stable_dt: StableStep {
                bound: 1.8469e-7,
                bound_element: 16514,
                bound_element_centre: [0.0677, 0.009, 0.01209],
                ..StableStep::default()
            },
            estimate: Estimate {
                run_time_s: Some(3.84),
                steps: 6989.0,
                disk: DiskEstimate {
                    total_mb: 160.2,
                    free_mb: Some(99.0),
                    ..DiskEstimate::default()
                },
                ..Estimate::default()
            },
            ..MeshReport::default()
        });
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
