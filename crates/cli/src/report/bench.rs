//! Measured speed as a page to read.

use serde_json::Value;
use std::fmt::Write;

use super::layout::{count, digits, heading, number, row, text as word};

/// The whole page.
pub fn text(report: &Value) -> String {
    let at = |key: &str| number(report, &format!("/{key}"));
    let mut out = String::new();
    let threads = at("threads").unwrap_or(1.0);
    let _ = writeln!(
        out,
        "{}, {} elements; {threads} thread{}, {} kernels",
        match report["element"].as_str() {
            Some(element) => format!("Free block, {element}"),
            None => "Reference disk on bar".into(),
        },
        count(at("elements")),
        if threads == 1.0 { "" } else { "s" },
        word(report, "/kernels"),
    );
    heading(&mut out, "Per element");
    let ns = |key: &str| digits(at(key), 3);
    if report["element"].is_string() {
        row(&mut out, "whole step", &ns("step_ns_per_element"), "ns", "");
        let corner = digits(at("corner_after_20_steps"), 7);
        row(&mut out, "u_z of the corner", &corner, "m", "after 20 steps");
        return out;
    }
    row(&mut out, "internal force", &ns("kernel_ns_per_element"), "ns", "alone");
    row(&mut out, "whole step", &ns("step_ns_per_element"), "ns", "");
    for (label, key) in [
        ("  internal force", "internal_force_fraction"),
        ("  nodes and hub", "nodes_fraction"),
        ("  contact", "contact_fraction"),
        ("  boundary", "boundary_fraction"),
    ] {
        row(&mut out, label, &digits(at(key).map(|x| 100.0 * x), 3), "%", "of the step");
    }

    heading(&mut out, "Against this machine");
    row(&mut out, "bandwidth, triad", &ns("bandwidth_gb_s"), "GB/s", "");
    row(&mut out, "multiply-additions", &ns("peak_gflop_s"), "GFLOP/s", "in registers");
    row(&mut out, "a step must move", &ns("bytes_per_element"), "B", "per element");
    row(&mut out, "and compute", &ns("flops_per_element"), "flop", "per element");
    let least = ns("roofline_ns_per_element");
    row(&mut out, "which takes at least", &least, "ns", "per element: the roofline");
    let percent = at("roofline_fraction").map(|x| 100.0 * x);
    row(&mut out, "the step reaches", &digits(percent, 3), "%", "of the roofline");
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_page_sets_the_step_against_the_roofline() {
        let page = text(&json!({
            "threads": 1, "kernels": "avx2", "elements": 145656, "bandwidth_gb_s": 20.0,
            "kernel_ns_per_element": 18.29, "step_ns_per_element": 25.0,
            "contact_fraction": 0.08, "bytes_per_element": 300.0, "roofline_fraction": 0.6,
            "roofline_ns_per_element": 15.0,
        }));
        for line in [
            "Reference disk on bar, 145 656 elements; 1 thread, avx2 kernels",
            "  whole step                      25.0 ns",
            "    contact                       8.00 %      of the step",
            "  which takes at least            15.0 ns     per element: the roofline",
            "  the step reaches                60.0 %      of the roofline",
        ] {
            assert!(page.lines().any(|l| l == line), "{line:?} is not a line of\n{page}");
        }
    }
}
