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
        "Reference disk on bar, {} elements; {threads} thread{}, {} kernels",
        count(at("elements")),
        if threads == 1.0 { "" } else { "s" },
        word(report, "/kernels"),
    );
    heading(&mut out, "Per element");
    let ns = |key: &str| digits(at(key), 3);
    row(&mut out, "internal force", &ns("kernel_ns_per_element"), "ns", "");
    let contact = match at("contact_fraction") {
        Some(share) => format!("contact {:.1} % of it", 100.0 * share),
        None => String::new(),
    };
    row(&mut out, "whole step", &ns("step_ns_per_element"), "ns", &contact);

    heading(&mut out, "Against the memory of this machine");
    row(&mut out, "bandwidth, triad", &digits(at("bandwidth_gb_s"), 3), "GB/s", "");
    row(&mut out, "a step must move", &digits(at("bytes_per_element"), 3), "B", "per element");
    // bytes over GB/s are nanoseconds
    let least = at("bytes_per_element").zip(at("bandwidth_gb_s")).map(|(b, rate)| b / rate);
    row(&mut out, "which takes at least", &digits(least, 3), "ns", "per element: the roofline");
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
        }));
        for line in [
            "Reference disk on bar, 145 656 elements; 1 thread, avx2 kernels",
            "  whole step                      25.0 ns     contact 8.0 % of it",
            "  which takes at least            15.0 ns     per element: the roofline",
            "  the step reaches                60.0 %      of the roofline",
        ] {
            assert!(page.lines().any(|l| l == line), "{line:?} is not a line of\n{page}");
        }
    }
}
