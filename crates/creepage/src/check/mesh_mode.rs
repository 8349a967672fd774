//! Slip that alternates from node to node, over the window of a check.

use crate::check::basis::Basis;
use crate::check::result::MeshModeFound;
use contact::mesh_mode::{HOURGLASS_LIMIT, LEAST_SLIP, MESH_MODE_LIMIT, MeshMode, warning};
use output::summary::{self, Summary};

/// What a run's `summary` of the same window says, else what the slip of the records shows.
pub(super) fn found(records: &MeshMode, summary: Option<&Summary>, basis: &Basis) -> MeshModeFound {
    if let Some(mode) = summary.and_then(|summary| summary.mesh_mode.clone()) {
        return MeshModeFound { mode, from: "summary".into() };
    }
    let speed = basis.scale("speed").map(f64::abs);
    // without a speed, a hundredth of s_c
    let least =
        speed.map(|speed| LEAST_SLIP * speed).or(basis.scale("slip_speed").map(|s| 1e-2 * s));
    let share = records.share(least.unwrap_or(0.0));
    let layers = basis.case.as_ref().and_then(|case| case.get("element")?.get("contact_layers"));
    // a case without the key is of another code, or of a version that had one-point layers by default
    let one_point = layers.and_then(toml::Value::as_str) != Some("full");
    let warned = share.and_then(|share| warning(share, one_point));
    MeshModeFound {
        mode: summary::MeshMode {
            alternating_slip: share,
            alternating_slip_limit: MESH_MODE_LIMIT,
            hourglass_energy_in_layers: None,
            hourglass_energy_limit: HOURGLASS_LIMIT,
            warnings: warned.into_iter().map(str::to_owned).collect(),
        },
        from: "contact records".into(),
    }
}
