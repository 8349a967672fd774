//! The value of a measure in a sentence.

use crate::digits::digits;
use serde_json::Value;

/// A sentence on the measure `name`, from its entry in the document of a check.
pub(super) fn verdict(name: &str, metric: &Value) -> String {
    let Some(value) = metric["value"].as_f64() else {
        return format!("Not measured: {}.", metric["note"].as_str().unwrap_or("no data"));
    };
    let percent = |value: f64| format!("{} %", digits(100.0 * value, 3));
    let place = place(&metric["where"]);
    match name {
        "penetration" => format!(
            "The surfaces lie in each other by up to {} of the approach of the bodies{place}; a \
             method without springs has none.",
            percent(value)
        ),
        "tension" if value == 0.0 => "No node is pulled.".into(),
        "tension" => format!("Nodes are pulled by up to {} of p0{place}.", percent(value)),
        "complementarity" => format!(
            "Gap times pressure reaches {} of approach times p0{place}; one of them should be zero \
             everywhere.",
            percent(value)
        ),
        "cone" if value <= 1e-10 => "No shear exceeds the static bound.".into(),
        "cone" => format!("Shear exceeds the static bound by up to {}{place}.", percent(value)),
        "adhesion_slip" => format!(
            "Nodes whose shear is below the bound, and which should stick, slip at up to {} times \
             the rigid slip s_c{place}.",
            digits(value, 3)
        ),
        "mu_error" => format!(
            "The coefficient that the algorithm used is off that which its law gives for the recorded \
             slip, pressure, place and time by {} at most.",
            percent(value)
        ),
        "mu_error_blurred" => format!(
            "Where not every step is recorded it is off by {} (median) beyond what the missing steps leave \
             open.",
            percent(value)
        ),
        "law_error" => format!(
            "Where nodes slip, shear is off the bound \u{3bc}(|s|) p by {} (root mean square); the \
             give of springs while a node is held counts as slip.",
            percent(value)
        ),
        "law_error_let_slip" => format!(
            "Where the algorithm itself lets nodes slip, it is off by {}: this the algorithm does \
             wrong, what is beyond it the give of its springs.",
            percent(value)
        ),
        "law_error_own" => format!(
            "With the coefficient that the algorithm used it is off by {}: what remains is the \
             method's own error, not the lag of its coefficient.",
            percent(value)
        ),
        "direction" => format!(
            "Shear is off the direction against the slip by {} degrees (root mean square).",
            digits(value, 3)
        ),
        "direction_let_slip" => format!(
            "Where the algorithm itself lets nodes slip, by {} degrees.",
            digits(value, 3)
        ),
        "wrong_direction" => {
            format!("On {} of the slipping area and time shear drives the slip.", percent(value))
        }
        "mesh_mode" => format!(
            "{} of the slip alternates from node to node; beyond {} it is a mode of the mesh, or slip that the \
             mesh does not resolve.",
            percent(value),
            percent(contact::mesh_mode::MESH_MODE_LIMIT)
        ),
        "dissipation" => format!(
            "{} of the power exchanged in slip has the wrong sign: friction gives energy instead of \
             taking it.",
            percent(value)
        ),
        "violating_fraction" => {
            format!("{} of the contact area and time violates the conditions.", percent(value))
        }
        "roughness_ratio" => {
            let meaning = match value {
                v if v < 0.8 => "the traction is too smooth for the slip that it belongs to",
                v if v > 1.25 => "the traction is rougher than its law",
                _ => "traction and slip fluctuate as the law says",
            };
            format!("p_f/p fluctuates {} times as much as \u{3bc}(|s|): {meaning}.", digits(value, 3))
        }
        "law_scatter" => {
            "Root mean square distance of (|s|, p_f/p) from the law's graph, speeds in units of \
             the rigid slip s_c."
                .into()
        }
        "switching_rate" => {
            "Changes between stick and slip per node in the time a shear wave needs for an element; \
             values near 1 would be a chatter at the scale of the mesh."
                .into()
        }
        _ => String::new(),
    }
}

fn place(place: &Value) -> String {
    let at = |i: usize| place["position"][i].as_f64().map(|x| digits(1e3 * x, 3));
    match (at(0), at(1), place["time"].as_f64()) {
        (Some(x), Some(y), Some(time)) => {
            format!(" (worst at x = {x} mm, y = {y} mm, t = {} ms)", digits(1e3 * time, 5))
        }
        _ => String::new(),
    }
}
