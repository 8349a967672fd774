//! Measured speed as a page to read.

use creepage::run::{BenchResult, BlockBench, ReferenceBench};

use super::layout::{count, digits, heading, row};

/// The whole page.
pub fn text(result: &BenchResult) -> String {
    match result {
        BenchResult::Reference(found) => reference(found),
        BenchResult::Block(found) => block(found),
    }
}

/// What was measured on: the first line.
fn title(what: &str, elements: f64, threads: usize, kernels: &str) -> String {
    let s = if threads == 1 { "" } else { "s" };
    let elements = count(Some(elements));
    format!("{what}, {elements} elements; {threads} thread{s}, {kernels} kernels\n")
}

fn block(found: &BlockBench) -> String {
    let what = format!("Free block, {}", found.element);
    let mut out = title(&what, found.elements as f64, found.threads, found.kernels);
    heading(&mut out, "Per element");
    row(&mut out, "whole step", &digits(Some(found.step_ns_per_element), 3), "ns", "");
    let corner = digits(Some(found.corner_after_20_steps), 7);
    row(&mut out, "u_z of the corner", &corner, "m", "after 20 steps");
    out
}

fn reference(found: &ReferenceBench) -> String {
    let what = "Reference disk on bar";
    let mut out = title(what, found.elements as f64, found.threads, found.kernels);
    heading(&mut out, "Per element");
    let rows = |out: &mut String, rows: &[Line]| {
        for Line(label, value, unit, remark) in rows {
            row(out, label, &digits(Some(*value), 3), unit, remark);
        }
    };
    rows(
        &mut out,
        &[
            Line("internal force", found.kernel_ns_per_element, "ns", "alone"),
            Line("whole step", found.step_ns_per_element, "ns", ""),
            Line("  internal force", 100.0 * found.internal_force_fraction, "%", "of the step"),
            Line("  nodes and hub", 100.0 * found.nodes_fraction, "%", "of the step"),
            Line("  contact", 100.0 * found.contact_fraction, "%", "of the step"),
            Line("  boundary", 100.0 * found.boundary_fraction, "%", "of the step"),
        ],
    );
    heading(&mut out, "Against this machine");
    let least = found.roofline_ns_per_element;
    rows(
        &mut out,
        &[
            Line("bandwidth, triad", found.bandwidth_gb_s, "GB/s", ""),
            Line("multiply-additions", found.peak_gflop_s, "GFLOP/s", "in registers"),
            Line("a step must move", found.bytes_per_element, "B", "per element"),
            Line("and compute", found.flops_per_element, "flop", "per element"),
            Line("which takes at least", least, "ns", "per element: the roofline"),
            Line("the step reaches", 100.0 * found.roofline_fraction, "%", "of the roofline"),
        ],
    );
    out
}

/// A number with its label, unit and a remark.
struct Line(&'static str, f64, &'static str, &'static str);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_sets_the_step_against_the_roofline() {
        let page = text(&BenchResult::Reference(ReferenceBench {
            threads: 1,
            kernels: "avx2",
            elements: 145_656,
            bandwidth_gb_s: 20.0,
            kernel_ns_per_element: 18.29,
            step_ns_per_element: 25.0,
            contact_fraction: 0.08,
            bytes_per_element: 300.0,
            roofline_fraction: 0.6,
            roofline_ns_per_element: 15.0,
            ..ReferenceBench::default()
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
