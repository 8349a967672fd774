//! The dimensionless numbers of section 6 of the project's physics notes and what they mean.

use super::digits;
use crate::basis::{Basis, number_at};
use crate::law::Law;
use std::fmt::Write;

/// Appends the section, where the case gives what the numbers are made of.
///
/// With p0 Hertz's peak pressure, k and dmu of Eq. (8), Z = rho c_s/2 the shear radiation impedance
/// of two equal half-spaces and m* = rho d/4 the reduced mass of two surface layers of depth d
/// (the element size): R = p0 k dmu/Z, N2 = dt p0 k dmu/m*, N1 = dt^2 k_t/m*.
pub(super) fn section(out: &mut String, basis: &Basis) {
    let (Some(p0), Some(shear_wave)) = (basis.scale("peak_pressure"), basis.scale("shear_wave"))
    else {
        return;
    };
    let at = |key: &str, default: f64| {
        basis.case.as_ref().and_then(|case| number_at(case, key)).unwrap_or(default)
    };
    let density = at("material.density", 7800.0);
    let mut rows: Vec<(&str, f64, String)> = Vec::new();
    let depth = basis.scale("size");
    let surface_mass = depth.map(|d| density * d / 4.0);
    if let Some(Law::Exponential(law)) = basis.law {
        let slope = p0 * law.decay * (law.mu_static - law.mu_dynamic);
        let ratio = slope / (0.5 * density * shear_wave);
        let meaning = if ratio > 1.0 {
            "above 1 Eq. (8) alone is ill-posed between elastic bodies: three states are possible \
             at one load, disturbances grow the faster the finer the mesh, and no refinement \
             converges point by point"
        } else {
            "below 1 Eq. (8) is well posed: the bodies radiate energy faster than falling friction \
             feeds it"
        };
        rows.push(("R = p0 k \u{394}\u{3bc}/Z", ratio, meaning.into()));
        if let (Some(dt), Some(mass)) = (basis.scale("dt"), surface_mass) {
            let value = dt * slope / mass;
            let meaning = "negative damping per step of falling friction against the mass of the surface \
                           layer; below 1 it is a small correction to the step";
            rows.push(("N2 = dt p0 k \u{394}\u{3bc}/m*", value, meaning.into()));
        }
    }
    let factor = basis.case.as_ref().and_then(|c| number_at(c, "contact.penalty.tangential"));
    if let (Some(factor), Some(dt), Some(mass), Some(depth)) =
        (factor, basis.scale("dt"), surface_mass, depth)
    {
        let (young, poisson) = (at("material.young", 210e9), at("material.poisson", 0.3));
        let bulk = young / (3.0 * (1.0 - 2.0 * poisson));
        // two passes, each SF K/d
        let value = dt * dt * 2.0 * factor * bulk / depth / mass;
        let meaning = "friction spring against the mass of the surface layer, per step squared: the \
                       softer the spring, the more nodes that stick move";
        rows.push(("N1 = dt\u{b2} k_t/m*", value, meaning.into()));
    }
    if let (Some(a), Some(speed), Some(dt)) =
        (basis.scale("half_length"), basis.scale("speed"), basis.scale("dt"))
    {
        let meaning = "time steps in which a node passes the patch".into();
        rows.push(("2a/(V dt)", 2.0 * a / speed / dt, meaning));
    }
    if let (Some(a), Some(depth)) = (basis.scale("half_length"), depth) {
        rows.push(("2a/h", 2.0 * a / depth, "elements along the patch".into()));
    }
    if rows.is_empty() {
        return;
    }
    out.push_str("<h2>Dimensionless numbers</h2>\n<table>\n");
    for (name, value, meaning) in rows {
        let _ = writeln!(
            out,
            "<tr><td>{name}</td><td class=\"n\">{}</td><td>{meaning}</td></tr>",
            digits(value, 3)
        );
    }
    out.push_str("</table>\n");
}
