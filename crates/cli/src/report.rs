//! What a command prints when its work is done.

use std::io::Write;
use std::path::Path;

use serde_json::Value;

/// Name, printed name, factor and unit of the numbers that a summary holds in SI units.
const LABELS: &[(&str, &str, f64, &str)] = &[
    ("dt", "time step", 1e9, "ns"),
    ("t_end", "simulated time", 1e3, "ms"),
    ("wall_s", "wall time", 1.0, "s"),
    ("element_steps_per_s", "speed", 1e-6, "M element-steps/s"),
    ("peak_rss_mb", "peak memory", 1.0, "MB"),
    ("kinetic", "kinetic energy", 1.0, "J"),
    ("internal", "internal energy", 1.0, "J"),
    ("hourglass", "hourglass energy", 1.0, "J"),
    ("contact_stored", "stored in contact", 1.0, "J"),
    ("friction_dissipated", "dissipated by friction", 1.0, "J"),
    ("damping_dissipated", "dissipated by damping", 1.0, "J"),
    ("external_work", "external work", 1.0, "J"),
    ("normal_force", "normal force", 1e-3, "kN"),
    ("tangential_force", "tangential force", 1e-3, "kN"),
    ("lateral_force", "lateral force", 1e-3, "kN"),
    ("patch_half_length", "patch half length", 1e3, "mm"),
    ("patch_half_width", "patch half width", 1e3, "mm"),
    ("patch_area", "patch area", 1e6, "mm^2"),
    ("peak_pressure", "peak pressure", 1e-6, "MPa"),
];

/// Prints one JSON document on standard output.
pub fn print_json(document: &Value) {
    // Pretty-printing a value cannot fail; a reader that closed the pipe wants no more.
    let text = serde_json::to_string_pretty(document).unwrap_or_default();
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// Prints a document as a table for people.
pub fn print_table(document: &Value) {
    let mut text = String::new();
    table(document, 0, &mut text);
    let _ = write!(std::io::stdout(), "{text}");
}

/// Prints a run's summary and how to look at its results.
pub fn print_run(summary: &Value, folder: &Path) {
    print_table(summary);
    let file = |name: &str, fallback: &str| {
        let name = summary.pointer(&format!("/files/{name}")).and_then(Value::as_str);
        folder.join(name.unwrap_or(fallback)).display().to_string()
    };
    let (fields, history) = (file("fields", "fields.vtkhdf"), file("history", "history.h5"));
    let contact = file("contact", "contact.vtkhdf");
    let _ = write!(
        std::io::stdout(),
        "\nHow to look at the results\n  \
         ParaView  paraview {fields}   (Apply, then Warp By Vector with `displacement`)\n  \
         pyvista   python -c \"import vtk, pyvista; r = vtk.vtkHDFReader(); \
         r.SetFileName('{fields}'); r.UpdateInformation(); r.SetStep(r.GetNumberOfSteps() - 1); \
         r.Update(); pyvista.wrap(r.GetOutput()).plot(scalars='velocity')\"\n  \
         contact   the same with {contact}: `pressure`, `shear`, `slip_velocity`, `state`\n  \
         h5py      python -c \"import h5py; f = h5py.File('{history}'); \
         print({{k: d.attrs.get('units') for k, d in f.items()}})\"\n"
    );
}

fn table(document: &Value, indent: usize, text: &mut String) {
    let Value::Object(entries) = document else {
        text.push_str(&format!("{document}\n"));
        return;
    };
    // Plain values first, so that the eye finds the totals before the sections.
    for (key, value) in entries.iter().filter(|(_, value)| !value.is_object()) {
        let (label, value) = row(key, value);
        text.push_str(&format!("{:indent$}{label:<26} {value}\n", ""));
    }
    for (key, value) in entries.iter().filter(|(_, value)| value.is_object()) {
        text.push_str(&format!("{:indent$}{}\n", "", key.replace('_', " ")));
        table(value, indent + 2, text);
    }
}

fn row(key: &str, value: &Value) -> (String, String) {
    let plain = || key.replace('_', " ");
    let Some(number) = value.as_f64() else {
        let shown = match value {
            Value::String(word) => word.clone(),
            other => other.to_string(),
        };
        return (plain(), shown);
    };
    if let Some((_, label, factor, unit)) = LABELS.iter().find(|(name, ..)| *name == key) {
        return ((*label).to_owned(), format!("{} {unit}", digits(number * factor)));
    }
    let shown = if value.is_f64() { digits(number) } else { value.to_string() };
    (plain(), shown)
}

/// Five significant digits.
fn digits(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".into()
    } else if (1e-3..1e6).contains(&size) {
        let decimals = (4 - size.log10().floor() as i32).clamp(0, 8) as usize;
        format!("{x:.decimals$}")
    } else {
        format!("{x:.4e}")
    }
}
