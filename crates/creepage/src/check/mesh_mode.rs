//! The object `mesh_mode` of documents: slip that alternates from node to node.

use crate::check::basis::Basis;
use contact::mesh_mode::{HOURGLASS_LIMIT, LEAST_SLIP, MESH_MODE_LIMIT, MeshMode, warning};
use serde_json::{Value, json};

/// The object from a run's `summary` of the same window, else from the slip of the records.
pub(super) fn document(records: &MeshMode, summary: Option<&Value>, basis: &Basis) -> Value {
    if let Some(of_run) = summary.and_then(|summary| summary.get("mesh_mode")) {
        let mut found = of_run.clone();
        found["from"] = json!("summary");
        return found;
    }
    let speed = basis.scale("speed").map(f64::abs);
    // without a speed, a hundredth of s_c
    let least =
        speed.map(|speed| LEAST_SLIP * speed).or(basis.scale("slip_speed").map(|s| 1e-2 * s));
    let share = records.share(least.unwrap_or(0.0));
    let layers = basis.case.as_ref().and_then(|case| case.get("element")?.get("contact_layers"));
    // a case without the key is of another code, or of a version that had one-point layers by default
    let one_point = layers.and_then(toml::Value::as_str) != Some("full");
    let warnings: Vec<_> = share.and_then(|share| warning(share, one_point)).into_iter().collect();
    json!({
        "alternating_slip": share,
        "alternating_slip_limit": MESH_MODE_LIMIT,
        "hourglass_energy_in_layers": null,
        "hourglass_energy_limit": HOURGLASS_LIMIT,
        "warnings": warnings,
        "from": "contact records",
    })
}
