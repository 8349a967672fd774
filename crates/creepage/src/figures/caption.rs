//! Captions with the key numbers of a case.

use super::scene::Scene;
use crate::chart::{NO_BREAK, minus};
use crate::check::basis::number_at;
use crate::check::law::Law;

/// How many instants a figure shows.
pub(super) fn instants(scene: &Scene<'_>) -> &'static str {
    match scene.instants.len() {
        1 => "one instant",
        2 => "two instants",
        _ => "three instants",
    }
}

/// The caption of a figure: the key numbers of the case, then `text`.
pub(super) fn caption(scene: &Scene<'_>, text: &str) -> String {
    let basis = scene.basis;
    let mut parts = Vec::new();
    let asked = basis.case.as_ref().and_then(|case| number_at(case, "load.normal"));
    if let Some(load) = scene.means.normal_force.or(asked) {
        parts.push(format!("N = {:.1} kN", 1e-3 * load));
    }
    if let Some(speed) = basis.scale("speed") {
        parts.push(format!("V = {} m/s", minus(&format!("{speed:.2}"))));
    }
    if let Some(creepage) = scene.means.creepage.or(basis.scale("creepage")) {
        let creepage = minus(&format!("{:.3}", 1e3 * creepage));
        parts.push(format!("creepage {creepage}\u{b7}10\u{207b}\u{b3}"));
    }
    if let Some(traction) = scene.means.traction_coefficient {
        parts.push(format!("T/N = {}", minus(&format!("{traction:.4}"))));
    }
    match basis.law {
        Some(Law::Coulomb(law)) => parts.push(format!("\u{3bc} = {}", law.mu)),
        Some(Law::Exponential(law)) => parts.push(format!(
            "\u{3bc}(|s|) = {} + {:.3} exp(\u{2212}{} s/m |s|)",
            law.mu_dynamic,
            law.mu_static - law.mu_dynamic,
            law.decay
        )),
        None => {}
    }
    if let Some(enforcement) = &basis.enforcement {
        parts.push(format!("contact by {enforcement}"));
    }
    parts.push(format!("h = {:.2} mm", 1e3 * scene.scales.size));
    if let Some(dt) = scene.scales.dt {
        parts.push(format!("dt = {:.1} ns", 1e9 * dt));
    }
    let parts: Vec<_> = parts.iter().map(|part| part.replace(' ', NO_BREAK)).collect();
    let text = text.replace(" = ", &format!("{NO_BREAK}={NO_BREAK}"));
    let text = text.replace(" ms", &format!("{NO_BREAK}ms"));
    format!("{}: {}. {text}", basis.name, parts.join(", "))
}
