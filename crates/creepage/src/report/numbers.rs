//! The characteristic numbers of a run and what they mean.

use crate::check::basis::Basis;
use crate::check::digits::digits;
use output::summary::Numbers;
use std::fmt::Write;

/// A number, its label and its meaning.
type Meaning = (fn(&Numbers) -> Option<f64>, &'static str, &'static str);

const MEANINGS: [Meaning; 9] = [
    (
        |n| n.r,
        "R = p0 k \u{394}\u{3bc}/Z",
        "above 1 the law without memory is ill-posed between elastic bodies: three states are possible at one load, \
         disturbances grow the faster the finer the mesh, and no refinement converges point by point; below 1 \
         no point jumps, but in plane strain short waves of slip still grow, slowly",
    ),
    (
        |n| n.n2,
        "N2 = dt p0 k \u{394}\u{3bc}/m*",
        "negative damping per step of falling friction against the mass of the surface layer; below 1 it is \
         a small correction to the step",
    ),
    (
        |n| n.n1,
        "N1 = dt\u{b2} k_t/m*",
        "friction spring against the mass of the surface layer, per step squared: with soft springs, \
         nodes that stick move more",
    ),
    (
        |n| n.f_min,
        "f_min/p0",
        "the least shear over pressure at which slip goes on by the law without memory",
    ),
    (
        |n| n.s_m,
        "s_m (m/s)",
        "between rest and this slip speed no state is stable by the law without memory",
    ),
    (
        |n| n.s_jump,
        "s_jump (m/s)",
        "slip speed to which a point jumps by the law without memory when it begins to slip",
    ),
    (
        |n| n.nucleation_length,
        "h_n (m)",
        "nucleation length of friction with memory: shorter zones of slip are stable",
    ),
    (
        |n| n.gamma,
        "\u{393} = l_slip/h_n",
        "zone of slip, by Carter, over the nucleation length; below 1 slip cannot run away",
    ),
    (
        |n| n.stable_memory,
        "stable d_c (m)",
        "memory of friction from which steady rolling in line contact is stable; with a shorter one slip fluctuates",
    ),
];

/// Appends the section: the numbers of the summary, and the resolution of the patch in time and space.
pub(super) fn section(out: &mut String, basis: &Basis) {
    let mut rows: Vec<(&str, f64, String)> = Vec::new();
    if let Some(numbers) = basis.summary.as_ref().and_then(|summary| summary.numbers.as_ref()) {
        for (of, name, meaning) in MEANINGS {
            rows.extend(of(numbers).map(|value| (name, value, meaning.to_owned())));
        }
    }
    let size = basis.scale("size");
    if let (Some(a), Some(speed), Some(dt)) =
        (basis.scale("half_length"), basis.scale("speed"), basis.scale("dt"))
    {
        let meaning = "time steps in which a node passes the patch".into();
        rows.push(("2a/(V dt)", 2.0 * a / speed / dt, meaning));
    }
    if let (Some(a), Some(size)) = (basis.scale("half_length"), size) {
        rows.push(("2a/h", 2.0 * a / size, "elements along the patch".into()));
    }
    if rows.is_empty() {
        return;
    }
    out.push_str("<h3>Dimensionless numbers</h3>\n<table>\n");
    for (name, value, meaning) in rows {
        let _ = writeln!(
            out,
            "<tr><td>{name}</td><td class=\"n\">{}</td><td>{meaning}</td></tr>",
            digits(value, 3)
        );
    }
    out.push_str("</table>\n");
}
