//! The summary of a run as a page to read.

use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use super::layout::{count, digits, duration, heading, number, row, text as word};

/// The whole page; `slip` says what to try where much of the slip fluctuates.
pub fn text(summary: &Value, folder: &Path, slip: Option<&str>) -> String {
    let mut out = String::new();
    title(&mut out, summary);
    // A run that ended in its preload has nothing further to tell.
    if number(summary, "/steps").is_some_and(|steps| steps > 0.0) {
        contact(&mut out, summary);
        if let Some(note) = slip {
            let _ = writeln!(out, "  {note}");
        }
        energy(&mut out, summary);
        speed(&mut out, summary);
        stability(&mut out, summary);
        how_to_look(&mut out, summary, folder);
    }
    out
}

fn title(out: &mut String, summary: &Value) {
    let at = |pointer| number(summary, pointer);
    let end = match word(summary, "/status") {
        "completed" => "completed",
        "interrupted" => "interrupted",
        _ => "stopped by its own guards",
    };
    let _ = writeln!(out, "{}: {end} after {}", word(summary, "/name"), duration(at("/wall_s")));
    let threads = at("/threads").unwrap_or(1.0);
    let _ = writeln!(
        out,
        "  {}; {threads} thread{}{}; {} MB",
        if of_half_spaces(summary) {
            format!("half-spaces, {} points", count(at("/nodes")))
        } else {
            format!("{} elements, {} nodes", count(at("/elements")), count(at("/nodes")))
        },
        if threads == 1.0 { "" } else { "s" },
        match word(summary, "/kernels") {
            "" => String::new(),
            kernels => format!(" with {kernels} kernels"),
        },
        digits(at("/peak_rss_mb"), 3),
    );
    let steps = at("/steps").unwrap_or(0.0);
    let rolled = format!(
        "  {} ms simulated in {} steps of {} ns",
        digits(scaled(at("/t_end"), 1e3), 5),
        count(Some(steps)),
        digits(scaled(at("/dt"), 1e9), 4)
    );
    let _ = writeln!(out, "{}", if steps > 0.0 { &rolled } else { "  nothing rolled" });
    if let Some(rows) = summary.pointer("/exact_contact/rows").and_then(Value::as_str) {
        let damped = at("/exact_contact/kelvin_voigt").filter(|time| *time > 0.0);
        let damped = damped
            .map(|time| format!(", Kelvin-Voigt damping of {} ns", digits(Some(time * 1e9), 4)));
        let _ = writeln!(
            out,
            "  exact contact, {} rows{}",
            rows.replace('_', " "),
            damped.unwrap_or_default()
        );
    }
}

/// Whether half-spaces rolled, which have neither elements nor springs.
fn of_half_spaces(summary: &Value) -> bool {
    word(summary, "/model") == "half-space"
}

/// A quantity of the contact: label, key, factor to the unit, unit.
type Quantity = (&'static str, &'static str, f64, &'static str);

const CONTACT: [Quantity; 10] = [
    ("normal force", "normal_force", 1e-3, "kN"),
    ("tangential force", "tangential_force", 1e-3, "kN"),
    ("lateral force", "lateral_force", 1e-3, "kN"),
    ("traction coefficient", "traction_coefficient", 1.0, ""),
    ("creepage", "creepage", 1e3, "1e-3"),
    ("patch half length", "patch_half_length", 1e3, "mm"),
    ("patch half width", "patch_half_width", 1e3, "mm"),
    ("patch area (nodes)", "patch_area", 1e6, "mm2"),
    ("patch area (fit)", "patch_area_fitted", 1e6, "mm2"),
    ("peak pressure", "peak_pressure", 1e-6, "MPa"),
];

/// Quantities of the window that stand beside the contract's.
const WINDOW: [Quantity; 5] = [
    ("peak shear", "peak_shear", 1e-6, "MPa"),
    ("stick border at x", "stick_border", 1e3, "mm"),
    ("largest penetration", "max_penetration", 1e6, "um"),
    ("torque", "torque", 1.0, "N m"),
    ("power of friction", "friction_power", 1e-3, "kW"),
];

fn contact(out: &mut String, summary: &Value) {
    let at = |pointer: &str| number(summary, pointer);
    if at("/contact/patch_area").is_none_or(|area| area <= 0.0) {
        heading(out, "Contact: none in the evaluation window, or the run ended before it");
        return;
    }
    let time = |pointer| digits(scaled(at(pointer), 1e3), 4);
    let title = format!("Contact, mean from {} to {} ms", time("/window/from"), time("/window/to"));
    let _ = writeln!(out, "\n{title:<44}{:>12}{:>12}{:>8}", "deviation", "half-space", "ratio");
    let rows = CONTACT.iter().map(|q| ("contact", q)).chain(WINDOW.iter().map(|q| ("window", q)));
    for (section, &(label, key, factor, unit)) in rows {
        let reason = word(summary, &format!("/window/reasons/{key}"));
        let reason = if reason.is_empty() { String::new() } else { format!("  ({reason})") };
        let Some(mean) = at(&format!("/{section}/{key}")) else {
            if !reason.is_empty() {
                let _ = writeln!(out, "  {label:<24}{:>12}{reason}", "-");
            }
            continue;
        };
        let deviation = at(&format!("/window/deviation/{key}"));
        let reference = half_space(summary, key);
        let shown = |x: Option<f64>| x.map(|x| small(x * factor)).unwrap_or_default();
        let line = format!(
            "  {label:<24}{:>12} {unit:<5}{:>12}{:>12}{:>8}",
            shown(Some(mean)),
            deviation.map(|d| format!("+- {}", digits(Some(d * factor), 2))).unwrap_or_default(),
            shown(reference),
            reference.map(|r| format!("{:.3}", mean / r)).unwrap_or_default(),
        );
        let _ = writeln!(out, "{}{reason}", line.trim_end());
    }
    let share = |pointer| format!("{} %", digits(scaled(at(pointer), 100.0), 3));
    let _ = writeln!(
        out,
        "  sticks on {} of the patch, slips on {}",
        share("/contact/stick_fraction"),
        share("/contact/slip_fraction")
    );
    if at("/rolling_radius/free").is_some() {
        let _ = writeln!(out, "  without torque: this creepage is that of free rolling");
    }
    mesh_mode(out, summary);
    if at("/half_space/peak_pressure").is_some() && !of_half_spaces(summary) {
        // only a run with exact enforcement, which has no springs, counts what that takes
        let exact = summary.get("exact_contact").is_some_and(Value::is_object);
        let springs = if exact { "" } else { "soft penalty springs and " };
        let _ = writeln!(
            out,
            "  half-space: Hertz; {springs}coarse elements make the patch larger and the pressure \
             lower"
        );
    }
}

/// How much of the slip and of the elements' strain is a mode of the mesh.
fn mesh_mode(out: &mut String, summary: &Value) {
    let at = |key: &str| number(summary, &format!("/mesh_mode/{key}"));
    if let Some(slip) = at("alternating_slip") {
        let energy = at("hourglass_energy_in_layers");
        let energy = energy.map(|part| {
            let part = digits(Some(100.0 * part), 2);
            format!("; hourglass energy below the contact {part} % of strain energy")
        });
        let _ = writeln!(
            out,
            "  {slip:.2} of the slip alternates from node to node{}",
            energy.unwrap_or_default()
        );
    }
    let warnings = ["/window/warnings", "/mesh_mode/warnings", "/exact_contact/warnings"];
    let warnings = warnings.iter().filter_map(|list| summary.pointer(list)?.as_array());
    for warning in warnings.flatten().filter_map(Value::as_str) {
        let _ = writeln!(out, "  warning: {warning}");
    }
}

/// The half-space value of a quantity, where there is one.
fn half_space(summary: &Value, key: &str) -> Option<f64> {
    let at = |name: &str| number(summary, &format!("/half_space/{name}"));
    let value = match key {
        "patch_half_length" => at("half_length"),
        "patch_half_width" => at("half_width"),
        "patch_area" | "patch_area_fitted" => at("area"),
        "peak_pressure" => at("peak_pressure"),
        other => at(other),
    };
    value.filter(|x| *x != 0.0)
}

fn energy(out: &mut String, summary: &Value) {
    let at = |key: &str| number(summary, &format!("/energy/{key}"));
    heading(out, "Energy at the end");
    let of_elements_and_springs = ["kinetic", "hourglass", "contact_stored", "damping_dissipated"];
    for (label, key) in [
        ("kinetic", "kinetic"),
        ("internal", "internal"),
        ("hourglass", "hourglass"),
        ("stored in contact", "contact_stored"),
        ("dissipated by friction", "friction_dissipated"),
        ("dissipated by damping", "damping_dissipated"),
        ("external work", "external_work"),
    ] {
        if of_half_spaces(summary) && of_elements_and_springs.contains(&key) {
            continue;
        }
        let remark = match (key, at("hourglass"), at("internal")) {
            ("hourglass", Some(hourglass), Some(internal)) if internal > 0.0 => {
                format!("{:.2} % of internal", 100.0 * hourglass / internal)
            }
            _ => String::new(),
        };
        row(out, label, &digits(at(key), 4), "J", &remark);
    }
    let remark = "of the largest energy exchanged";
    row(out, "balance error", &digits(at("balance_error"), 2), "", remark);
}

fn speed(out: &mut String, summary: &Value) {
    let at = |pointer: &str| number(summary, pointer);
    let stage = |name: &str| at(&format!("/stages/{name}"));
    heading(out, "Speed");
    let rate = at("/element_steps_per_s").filter(|rate| *rate > 0.0);
    let part = if of_half_spaces(summary) { "point" } else { "element" };
    row(out, &format!("{part} and step"), &digits(rate.map(|rate| 1e9 / rate), 3), "ns", "");
    row(out, &format!("{part}-steps"), &digits(scaled(rate, 1e-6), 3), "M/s", "");
    let Some(rolling) = stage("rolling").filter(|s| *s > 0.0) else {
        return;
    };
    row(out, "rolling", &digits(Some(rolling), 3), "s", "of which");
    for name in ["internal_force", "nodes", "contact", "boundary", "output"] {
        if let Some(seconds) = stage(name) {
            let label = format!("  {}", name.replace('_', " "));
            let share = format!("{:5.1} %", 100.0 * seconds / rolling);
            row(out, &label, &digits(Some(seconds), 3), "s", &share);
        }
    }
    if let Some(preload) = stage("preload").filter(|s| *s > 0.0) {
        let iterations = match at("/preload/iterations") {
            Some(n) => format!("{} iterations", count(Some(n))),
            None => String::new(),
        };
        row(out, "preload", &digits(Some(preload), 3), "s", &iterations);
    }
}

fn stability(out: &mut String, summary: &Value) {
    let at = |pointer: &str| number(summary, pointer);
    let Some(limit) = at("/stability/dt_limit") else {
        return;
    };
    heading(out, "Stability");
    let factor = at("/stability/factor");
    let remark = format!("{} of the limit", digits(factor, 3));
    row(out, "time step", &digits(scaled(at("/dt"), 1e9), 4), "ns", &remark);
    row(out, "limit 2/omega_max", &digits(Some(limit * 1e9), 4), "ns", "");
}

fn how_to_look(out: &mut String, summary: &Value, folder: &Path) {
    let name = |name: &str| word(summary, &format!("/files/{name}"));
    // a run that does not record its bodies shows its surfaces
    let quoted = |path: &Path| creepage::sweep::plan::quoted(&path.to_string_lossy());
    let run = quoted(folder);
    let (grid, look) = if name("fields").is_empty() {
        (name("contact"), "colour by pressure, shear, slip_velocity or state")
    } else {
        let look = "Filters > Warp By Vector: displacement; colour by velocity or stress";
        (name("fields"), look)
    };
    let _ = write!(
        out,
        "\nWhat next
  creepage view {run}      the bodies and their contact, in the browser
  creepage report {run}    one page: pictures, numbers, checks
  creepage plot {run}      figures
  creepage check {run}     where the conditions of contact are violated
  paraview {}    Apply; {look}
  Python: import creepage; creepage.Run({})
  all numbers: {}
",
        quoted(&folder.join(grid)),
        Value::from(folder.to_string_lossy()),
        folder.join("summary.json").display()
    );
}

fn scaled(x: Option<f64>, factor: f64) -> Option<f64> {
    x.map(|x| x * factor)
}

/// Four digits; two for what is little beside the other numbers of its column.
fn small(x: f64) -> String {
    if x != 0.0 && x.abs() < 1e-3 { format!("{x:.1e}") } else { digits(Some(x), 4) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn summary() -> Value {
        json!({
            "name": "quick", "status": "completed", "steps": 6989, "dt": 2.2e-7, "t_end": 1.54e-3,
            "elements": 41320, "nodes": 46641, "threads": 2, "wall_s": 10.5,
            "element_steps_per_s": 4.5e7, "peak_rss_mb": 52.1, "kernels": "avx2",
            "energy": { "kinetic": 3.4e5, "internal": 4.85, "hourglass": 0.0485,
                        "balance_error": 3.3e-5 },
            "contact": { "normal_force": 1.0038e5, "patch_half_length": 7.1e-3,
                         "patch_area": 3.2e-4, "stick_fraction": 0.64, "slip_fraction": 0.36 },
            "half_space": { "half_length": 7.0e-3, "half_width": 5.0e-3, "peak_pressure": 1.2e9 },
            "window": { "from": 1.0e-3, "to": 1.5e-3, "deviation": { "normal_force": 75.0 } },
            "stages": { "rolling": 6.0, "internal_force": 4.5 },
            "stability": { "dt_limit": 3.3e-7, "factor": 0.67 },
            "files": { "fields": "fields.vtkhdf", "history": "history.h5" },
        })
    }

    #[test]
    fn the_page_has_units_deviations_half_space_ratios_and_shares() {
        let page = text(&summary(), Path::new("runs/quick"), None);
        for line in [
            "quick: completed after 10.5 s",
            "  normal force                   100.4 kN       +- 0.075",
            "  patch half length              7.100 mm                      7.000   1.014",
            "  hourglass                    0.04850 J      1.00 % of internal",
            "    internal force                4.50 s       75.0 %",
            "  time step                      220.0 ns     0.670 of the limit",
            "  creepage report runs/quick    one page: pictures, numbers, checks",
        ] {
            assert!(page.lines().any(|l| l == line), "{line:?} is not a line of\n{page}");
        }
        assert!(!page.contains("null") && !page.contains("NaN"));
    }

    #[test]
    fn the_next_commands_can_be_given_to_a_shell_whatever_the_folder_is_called() {
        let page = text(&summary(), Path::new("runs/it's \"2\" mm"), None);
        for line in [
            r#"  creepage report 'runs/it'\''s "2" mm'    one page: pictures, numbers, checks"#,
            r#"  creepage check 'runs/it'\''s "2" mm'     where the conditions of contact are violated"#,
            r#"  Python: import creepage; creepage.Run("runs/it's \"2\" mm")"#,
        ] {
            assert!(page.lines().any(|l| l == line), "{line:?} is not a line of\n{page}");
        }
        assert!(page.contains(r#"  paraview 'runs/it'\''s "2" mm/fields.vtkhdf' "#), "{page}");
    }

    #[test]
    fn a_run_without_torque_tells_the_creepage_of_free_rolling() {
        let mut rolled = summary();
        rolled["rolling_radius"] = json!({ "effective": 0.46, "free": null });
        assert!(!text(&rolled, Path::new("x"), None).contains("free rolling"));
        rolled["rolling_radius"]["free"] = json!(0.4597);
        let page = text(&rolled, Path::new("x"), None);
        assert!(
            page.contains("\n  without torque: this creepage is that of free rolling\n"),
            "{page}"
        );
    }

    #[test]
    fn a_force_of_zero_is_a_plain_zero_and_a_small_one_has_two_digits() {
        assert_eq!([0.0, 2.34e-7, 27.563].map(small), ["0", "2.3e-7", "27.56"]);
    }

    #[test]
    fn a_run_without_fields_shows_its_surfaces() {
        let mut surfaces = summary();
        surfaces["files"] =
            json!({ "fields": "", "contact": "contact.vtkhdf", "history": "history.h5" });
        let page = text(&surfaces, Path::new("runs/quick"), None);
        let look = "\n  paraview runs/quick/contact.vtkhdf    Apply; colour by pressure";
        assert!(page.contains(look) && !page.contains("fields"), "{page}");
    }

    #[test]
    fn springs_are_blamed_only_where_there_are_springs() {
        let mut exact = summary();
        let page = text(&exact, Path::new("x"), None);
        assert!(
            page.contains("half-space: Hertz; soft penalty springs and coarse elements"),
            "{page}"
        );
        exact["exact_contact"] = json!({ "most_sweeps": 100, "warnings": ["did not converge"] });
        let page = text(&exact, Path::new("x"), None);
        assert!(page.contains("\n  warning: did not converge\n"), "{page}");
        assert!(
            page.contains("half-space: Hertz; coarse elements make the patch larger"),
            "{page}"
        );
        assert!(!page.contains("spring"), "{page}");
    }

    #[test]
    fn half_spaces_are_not_said_to_have_elements_or_springs() {
        let mut rolled = summary();
        rolled["model"] = json!("half-space");
        rolled["mesh_mode"] = Value::Null;
        let page = text(&rolled, Path::new("x"), None);
        for absent in ["element", "spring", "hourglass", "kinetic"] {
            assert!(!page.contains(absent), "{absent}: {page}");
        }
        assert!(page.contains("half-spaces, ") && page.contains("point and step"), "{page}");
    }

    #[test]
    fn what_is_missing_or_no_number_is_left_out_or_dashed() {
        let mut bare = summary();
        bare["half_space"] = Value::Null;
        bare["stability"] = Value::Null;
        bare["energy"]["kinetic"] = Value::Null;
        let page = text(&bare, Path::new("x"), None);
        assert!(!page.contains("null") && !page.contains("NaN") && !page.contains("Stability"));
    }

    #[test]
    fn a_run_that_ended_in_its_preload_has_no_sections() {
        let ended = json!({ "name": "quick", "status": "interrupted", "steps": 0, "wall_s": 1.0 });
        let page = text(&ended, Path::new("x"), None);
        assert!(
            page.contains("interrupted after")
                && page.contains("nothing rolled")
                && !page.contains("Energy"),
            "{page}"
        );
    }
}
