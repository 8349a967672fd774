//! The quantities of a summary: unit, and a name where the key alone does not say what it is.

use serde_json::{Map, Value, json};

/// A quantity of a summary by its dotted key, with its unit (`1` where it has none) and its name; the name is empty
/// where the key says it.
type Quantity = (&'static str, &'static str, &'static str);

/// All quantities; a key that ends in `.` stands for all keys of that section.
#[rustfmt::skip] // a table
const QUANTITIES: &[Quantity] = &[
    ("steps", "1", "time steps taken"),
    ("dt", "s", "time step"),
    ("t_end", "s", "simulated time reached"),
    ("elements", "1", ""),
    ("nodes", "1", ""),
    ("threads", "1", ""),
    ("wall_s", "s", "wall-clock time of the run"),
    ("element_steps_per_s", "1/s", "elements times steps over the wall-clock time of the time loop"),
    ("peak_rss_mb", "MB", "largest resident memory of the process"),
    ("time_loop_bytes_per_element", "B", "memory of the time loop over the elements"),
    ("stages.", "s", ""),
    ("energy.balance_error", "1", "error of the energy balance over the largest energy exchanged"),
    ("energy.", "J", ""),
    ("contact.normal_force", "N", "force of the bar on the disk, z, mean over the evaluation window"),
    ("contact.tangential_force", "N", "force of the bar on the disk, x, mean over the evaluation window"),
    ("contact.lateral_force", "N", "force of the bar on the disk, y, mean over the evaluation window"),
    ("contact.traction_coefficient", "1", "tangential over normal force"),
    ("contact.creepage", "1", "(omega R_eff - V)/V"),
    ("contact.patch_half_length", "m", "half axis of the patch in x"),
    ("contact.patch_half_width", "m", "half axis of the patch in y"),
    ("contact.patch_area", "m2", "area of the bar's nodes in contact"),
    ("contact.patch_area_fitted", "m2", "area of the fitted ellipse, or of a line contact's rectangle"),
    ("contact.peak_pressure", "Pa", "largest pressure of the fit of Hertz's distribution"),
    ("contact.stick_fraction", "1", "share of the patch that sticks"),
    ("contact.slip_fraction", "1", "share of the patch that slips"),
    ("window.from", "s", "start of the evaluation window"),
    ("window.to", "s", "end of the evaluation window"),
    ("window.stick_border", "m", "rear end of the longest stick zone on y = 0 from the centre of the patch"),
    ("window.peak_shear", "Pa", "largest nodal shear traction on the bar"),
    ("window.torque", "N m", "torque that the drive supplies about y"),
    ("window.max_penetration", "m", ""),
    ("window.hourglass_share", "1", "hourglass over strain energy"),
    ("window.friction_power", "W", "mean power of friction; T creepage V in steady rolling"),
    ("checks.cone_excess", "1", "largest (|shear| - mu pressure) over Hertz's peak pressure"),
    ("checks.resultant_mismatch", "1", "|sum of the contact forces on both bodies| over the normal force"),
    ("checks.contact_damping", "J", "the part of damping_dissipated that contact took"),
    ("mesh_mode.", "1", ""),
    ("half_space.half_length", "m", "a, half axis of Hertz's patch in x"),
    ("half_space.half_width", "m", "b, half axis of Hertz's patch in y"),
    ("half_space.area", "m2", "area of Hertz's patch"),
    ("half_space.peak_pressure", "Pa", "p_0, Hertz's peak pressure"),
    ("half_space.approach", "m", "delta, Hertz's approach of the bodies"),
    ("stability.omega_elastic", "rad/s", "largest frequency of the bodies without contact"),
    ("stability.omega_max", "rad/s", "largest frequency with the springs of contact closed"),
    ("stability.omega_bound", "rad/s", "rigorous upper bound of omega_max"),
    ("stability.dt_limit", "s", "longest stable time step"),
    ("stability.factor", "1", "time step over that limit"),
    ("rolling_radius.nominal", "m", "radius of the undeformed disk"),
    (
        "rolling_radius.effective",
        "m",
        "R_eff, V over the omega at which the slip averaged over the preloaded patch is zero",
    ),
    ("rolling_radius.free", "m", "V over the omega of free rolling, where drive.torque = 0"),
    ("preload.hub_displacement", "m", ""),
    ("preload.normal_force", "N", ""),
    ("preload.", "1", ""),
    ("numbers.pressure", "Pa", "p, the pressure at which the numbers hold: Hertz's peak pressure"),
    ("numbers.impedance", "Pa s/m", "rho c_s of both bodies in series"),
    ("numbers.r", "1", "R, steepness of falling friction: above 1 it has several solutions without memory"),
    ("numbers.n1", "1", "N_1 = dt^2 k_t/m*, stiffness of the friction springs in a time step"),
    ("numbers.n2", "1", "N_2, steepness of falling friction in a time step"),
    ("numbers.f_min", "1", "least coefficient of friction that the falling law reaches"),
    ("numbers.s_m", "m/s", "slip velocity at that coefficient"),
    ("numbers.s_jump", "m/s", "slip velocity to which a node jumps from rest"),
    ("numbers.slip_length", "m", "l_slip, length of the zone of slip by Carter's theory"),
    ("numbers.nucleation_length", "m", "h_n, nucleation length of friction with memory"),
    ("numbers.gamma", "1", "Gamma = l_slip/h_n"),
    ("exact_contact.kelvin_voigt", "s", "Kelvin-Voigt time constant"),
    ("exact_contact.most_sweeps", "1", "most sweeps of a step"),
    ("exact_contact.unconverged_steps", "1", "steps whose sweeps did not converge"),
    ("exact_contact.unconverged_change", "1", "largest last change of a force over the largest force"),
    ("exact_contact.manifold_node_steps", "1", "nodes times steps at which friction had several solutions"),
    ("exact_contact.steepness_node", "1", "largest steepness of friction of a node in an implicit step"),
    ("exact_contact.steepness_patch", "1", "the same of all nodes together"),
    ("exact_contact.", "1", ""),
    ("implicit.theta", "1", "parameter of the theta method"),
    ("implicit.solved", "1", "implicit steps solved"),
    ("implicit.cut", "1", "implicit steps cut"),
    ("implicit.iterations", "1", "iterations of all implicit steps"),
    ("implicit.products", "1", "products with the stiffness of all implicit steps"),
    ("spectral.megabytes", "MB", "memory of the half-spaces"),
    ("spectral.memory_steps", "1", "steps of the past that are felt"),
    ("spectral.undelayed_steps", "1", "steps in which a point that stuck began to slip although adhesion was a solution"),
    ("spectral.", "1", ""),
    ("mesh_window.travel", "m", "how far the fine zone has moved"),
    ("mesh_window.energy", "J", "brought by its moves, less what was taken"),
];

/// Unit and name of the quantity at a dotted key of a summary. Deviations and confidence intervals over the window have
/// those of the mean.
pub fn quantity(key: &str) -> Option<(&'static str, &'static str)> {
    let of = |at: &str| {
        let found = QUANTITIES.iter().find(|(path, ..)| {
            *path == at || (path.ends_with('.') && at.starts_with(path) && at.len() > path.len())
        });
        found.map(|(_, units, name)| (*units, *name))
    };
    let spread = ["window.deviation.", "window.ci95."];
    match spread.iter().find_map(|prefix| key.strip_prefix(prefix)) {
        Some(mean) => of(&format!("contact.{mean}")).or_else(|| of(&format!("window.{mean}"))),
        None => of(key),
    }
}

/// The sections `units` and `names` of a summary: unit of each number that it holds, and name of those whose key does not
/// say what they are, by their dotted keys.
pub fn described(summary: &Value) -> [Value; 2] {
    let mut found = [Map::new(), Map::new()];
    describe(summary, "", &mut found);
    found.map(|section| json!(section))
}

fn describe(value: &Value, key: &str, found: &mut [Map<String, Value>; 2]) {
    match value {
        Value::Object(entries) => {
            for (name, inner) in entries {
                let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                describe(inner, &key, found);
            }
        }
        // a number that a run does not have is null
        Value::Number(_) | Value::Null => {
            if let Some((units, name)) = quantity(key) {
                found[0].insert(key.into(), json!(units));
                if !name.is_empty() && !key.starts_with("window.deviation.") {
                    found[1].insert(key.into(), json!(name));
                }
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviation_has_the_unit_of_its_mean_and_a_checksum_has_none() {
        let units = |key: &str| quantity(key).map(|(units, _)| units);
        assert_eq!(units("window.deviation.normal_force"), Some("N"));
        assert_eq!(units("window.ci95.torque"), Some("N m"));
        assert_eq!(units("energy.internal"), Some("J"));
        assert_eq!(units("energy.balance_error"), Some("1"));
        assert_eq!(units("stages.contact"), Some("s"));
        for none in ["energy", "checksums.case.toml.bytes", "window.deviation.mass", "x"] {
            assert_eq!(units(none), None, "{none}");
        }
    }

    #[test]
    fn numbers_have_units_and_short_keys_names_beside_them() {
        let summary = json!({ "status": "completed", "dt": 1e-7, "nodes": 8,
            "numbers": { "n1": 1.4, "r": null, "expect": "nothing" }, "implicit": null });
        let [units, names] = described(&summary);
        let wanted = json!({ "dt": "s", "nodes": "1", "numbers.n1": "1", "numbers.r": "1" });
        assert_eq!(units, wanted);
        assert_eq!(names["dt"], "time step");
        assert!(names["numbers.n1"].as_str().is_some_and(|name| name.starts_with("N_1")));
        assert!(names.get("nodes").is_none());
    }
}
