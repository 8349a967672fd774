//! The summary of a run as a page to read.

use std::fmt::Write;
use std::path::Path;

use output::summary::{Energy, HalfSpace, Mean, Status, Summary};

use super::layout::{count, digits, duration, heading, row};

/// The whole page; `slip` says what to try where much of the slip fluctuates.
pub fn text(summary: &Summary, folder: &Path, slip: Option<&str>) -> String {
    let mut out = String::new();
    title(&mut out, summary);
    // A run that ended in its preload has nothing further to tell.
    if summary.steps > 0 {
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

fn title(out: &mut String, summary: &Summary) {
    let end = match summary.status {
        Some(Status::Completed) => "completed",
        Some(Status::Interrupted) => "interrupted",
        Some(Status::Failed) | None => "stopped by its own guards",
    };
    let _ = writeln!(out, "{}: {end} after {}", summary.name, duration(Some(summary.wall_s)));
    let (threads, number) = (summary.threads, |n: u64| count(Some(n as f64)));
    let _ = writeln!(
        out,
        "  {}; {threads} thread{}{}; {} MB",
        if of_half_spaces(summary) {
            format!("half-spaces, {} points", number(summary.nodes))
        } else {
            format!("{} elements, {} nodes", number(summary.elements), number(summary.nodes))
        },
        if threads == 1 { "" } else { "s" },
        summary.kernels.as_ref().map(|name| format!(" with {name} kernels")).unwrap_or_default(),
        digits(Some(summary.peak_rss_mb), 3),
    );
    let rolled = format!(
        "  {} ms simulated in {} steps of {} ns",
        digits(Some(1e3 * summary.t_end), 5),
        number(summary.steps),
        digits(Some(1e9 * summary.dt), 4)
    );
    let _ = writeln!(out, "{}", if summary.steps > 0 { &rolled } else { "  nothing rolled" });
    let exact = summary.exact_contact.as_ref();
    if let Some((exact, rows)) = exact.and_then(|exact| Some((exact, exact.rows.as_ref()?))) {
        let damped = (exact.kelvin_voigt > 0.0).then_some(1e9 * exact.kelvin_voigt);
        let damped =
            damped.map(|time| format!(", Kelvin-Voigt damping of {} ns", digits(Some(time), 4)));
        let rows = rows.replace('_', " ");
        let _ = writeln!(out, "  exact contact, {rows} rows{}", damped.unwrap_or_default());
    }
}

/// Whether half-spaces rolled, which have neither elements nor springs.
fn of_half_spaces(summary: &Summary) -> bool {
    summary.model.as_deref() == Some("half-space")
}

/// A mean of the contact with its label, the factor to its unit, the unit, and its value between half-spaces.
struct Line(&'static str, Mean, f64, &'static str, fn(&HalfSpace) -> Option<f64>);

const CONTACT: [Line; 15] = [
    Line("normal force", Mean::NormalForce, 1e-3, "kN", |_| None),
    Line("tangential force", Mean::TangentialForce, 1e-3, "kN", |_| None),
    Line("lateral force", Mean::LateralForce, 1e-3, "kN", |_| None),
    Line("traction coefficient", Mean::TractionCoefficient, 1.0, "", |_| None),
    Line("creepage", Mean::Creepage, 1e3, "1e-3", |_| None),
    Line("patch half length", Mean::PatchHalfLength, 1e3, "mm", |hertz| hertz.half_length),
    Line("patch half width", Mean::PatchHalfWidth, 1e3, "mm", |hertz| hertz.half_width),
    Line("patch area (nodes)", Mean::PatchArea, 1e6, "mm2", |_| None),
    Line("patch area (fit)", Mean::PatchAreaFitted, 1e6, "mm2", |hertz| hertz.area),
    Line("peak pressure", Mean::PeakPressure, 1e-6, "MPa", |hertz| hertz.peak_pressure),
    Line("peak shear", Mean::PeakShear, 1e-6, "MPa", |_| None),
    Line("stick border at x", Mean::StickBorder, 1e3, "mm", |_| None),
    Line("largest penetration", Mean::MaxPenetration, 1e6, "um", |_| None),
    Line("torque", Mean::Torque, 1.0, "N m", |_| None),
    Line("power of friction", Mean::FrictionPower, 1e-3, "kW", |_| None),
];

fn contact(out: &mut String, summary: &Summary) {
    if summary.contact.patch_area.is_none_or(|area| area <= 0.0) {
        heading(out, "Contact: none in the evaluation window, or the run ended before it");
        return;
    }
    let window = summary.window.as_ref();
    let time = |end: Option<f64>| digits(scaled(end, 1e3), 4);
    let [from, to] = [window.and_then(|w| w.from), window.and_then(|w| w.to)].map(time);
    let title = format!("Contact, mean from {from} to {to} ms");
    let _ = writeln!(out, "\n{title:<44}{:>12}{:>12}{:>8}", "deviation", "half-space", "ratio");
    for Line(label, mean, factor, unit, half_space) in CONTACT {
        let reason = window.and_then(|window| window.reasons.get(&mean));
        let reason = reason.map(|reason| format!("  ({reason})")).unwrap_or_default();
        let Some(value) = summary.mean(mean) else {
            if !reason.is_empty() {
                let _ = writeln!(out, "  {label:<24}{:>12}{reason}", "-");
            }
            continue;
        };
        let deviation = window.and_then(|window| window.deviation.get(&mean).copied().flatten());
        let reference = summary.half_space.as_ref().and_then(half_space).filter(|x| *x != 0.0);
        let shown = |x: Option<f64>| x.map(|x| small(x * factor)).unwrap_or_default();
        let line = format!(
            "  {label:<24}{:>12} {unit:<5}{:>12}{:>12}{:>8}",
            shown(Some(value)),
            deviation.map(|d| format!("+- {}", digits(Some(d * factor), 2))).unwrap_or_default(),
            shown(reference),
            reference.map(|r| format!("{:.3}", value / r)).unwrap_or_default(),
        );
        let _ = writeln!(out, "{}{reason}", line.trim_end());
        if mean == Mean::Creepage {
            nominal_creepage(out, summary);
        }
    }
    let share = |part: Option<f64>| format!("{} %", digits(scaled(part, 100.0), 3));
    let _ = writeln!(
        out,
        "  by the state of friction, sticks on {} of the patch, slips on {}",
        share(summary.contact.stick_fraction),
        share(summary.contact.slip_fraction)
    );
    if summary.rolling_radius.is_some_and(|radius| radius.free.is_some()) {
        let _ = writeln!(out, "  without torque: this creepage is that of free rolling");
    }
    if !of_half_spaces(summary) {
        let _ = writeln!(
            out,
            "  normal force: the load and what moves the disk up and down; torque: T R and what turns it faster or \
             slower\n  area (nodes): whole cells of the nodes in contact"
        );
    }
    mesh_mode(out, summary);
    let hertz = summary.half_space.is_some_and(|hertz| hertz.peak_pressure.is_some());
    if hertz && !of_half_spaces(summary) {
        // only a run with exact enforcement, which has no springs, counts what that takes
        let exact = summary.exact_contact.is_some();
        let springs = if exact { "" } else { "soft penalty springs and " };
        let _ = writeln!(
            out,
            "  half-space: Hertz; {springs}coarse elements make the patch larger and the pressure \
             lower"
        );
    }
}

/// The creepage that the radius of the undeformed disk gives, beside that of the effective one.
fn nominal_creepage(out: &mut String, summary: &Summary) {
    let creepage = summary.contact.nominal_creepage.filter(|_| summary.rolling_radius.is_some());
    if let Some(creepage) = creepage {
        let (label, value) = ("creepage, nominal R", small(1e3 * creepage));
        let _ = writeln!(
            out,
            "  {label:<24}{value:>12} 1e-3   (omega R - V)/V; the line above has R_eff in place of R"
        );
    }
}

/// How much of the slip and of the elements' strain is a mode of the mesh, and what is wrong with the numbers.
fn mesh_mode(out: &mut String, summary: &Summary) {
    let mode = summary.mesh_mode.as_ref();
    if let Some((mode, slip)) = mode.and_then(|mode| Some((mode, mode.alternating_slip?))) {
        let energy = mode.hourglass_energy_in_layers.map(|part| {
            let part = digits(Some(100.0 * part), 2);
            format!("; hourglass energy below the contact {part} % of strain energy")
        });
        let _ = writeln!(
            out,
            "  {slip:.2} of the slip alternates from node to node{}",
            energy.unwrap_or_default()
        );
    }
    let of_window = summary.window.iter().flat_map(|window| &window.warnings);
    let of_mode = mode.iter().flat_map(|mode| &mode.warnings);
    let of_exact = summary.exact_contact.iter().flat_map(|exact| &exact.warnings);
    for warning in of_window.chain(of_mode).chain(of_exact) {
        let _ = writeln!(out, "  warning: {warning}");
    }
}

fn energy(out: &mut String, summary: &Summary) {
    heading(out, "Energy at the end");
    let Energy { hourglass, internal, .. } = summary.energy;
    let share = (internal > 0.0 && hourglass.is_finite())
        .then(|| format!("{:.2} % of internal", 100.0 * hourglass / internal));
    let bodies = !of_half_spaces(summary);
    let energy = &summary.energy;
    let others = energy.internal + energy.hourglass + energy.contact_stored;
    let others = others + energy.friction_dissipated + energy.damping_dissipated;
    let kinetic = (bodies && energy.kinetic > 0.0)
        .then(|| format!("of it {} J kinetic", digits(Some(energy.external_work - others), 4)));
    for (label, joules, shown, remark) in [
        ("kinetic", energy.kinetic, bodies, None),
        ("internal", energy.internal, true, None),
        ("hourglass", energy.hourglass, bodies, share),
        ("stored in contact", energy.contact_stored, bodies, None),
        ("dissipated by friction", energy.friction_dissipated, true, None),
        ("dissipated by damping", energy.damping_dissipated, bodies, None),
        ("external work", energy.external_work, true, kinetic),
    ] {
        if shown {
            row(out, label, &digits(Some(joules), 4), "J", &remark.unwrap_or_default());
        }
    }
    let remark = "of the largest energy exchanged";
    row(out, "balance error", &digits(Some(energy.balance_error), 2), "", remark);
}

fn speed(out: &mut String, summary: &Summary) {
    let stage = |name: &str| summary.stages.get(name).copied();
    heading(out, "Speed");
    let rate = Some(summary.element_steps_per_s).filter(|rate| *rate > 0.0);
    let part = if of_half_spaces(summary) { "point" } else { "element" };
    row(out, &format!("{part} and step"), &digits(rate.map(|rate| 1e9 / rate), 3), "ns", "");
    row(out, &format!("{part}-steps"), &digits(scaled(rate, 1e-6), 3), "M/s", "");
    let Some(rolling) = stage("rolling").filter(|s| *s > 0.0) else {
        return;
    };
    row(out, "rolling", &digits(Some(rolling), 3), "s", "of which");
    for name in ["internal_force", "nodes", "contact", "boundary", "exchange", "output"] {
        if let Some(seconds) = stage(name).filter(|s| *s > 0.0) {
            let label = format!("  {}", name.replace('_', " "));
            let share = format!("{:5.1} %", 100.0 * seconds / rolling);
            row(out, &label, &digits(Some(seconds), 3), "s", &share);
        }
    }
    if let Some(preload) = stage("preload").filter(|s| *s > 0.0) {
        let iterations = summary.preload.as_ref().map(|preload| preload.iterations as f64);
        let iterations = iterations.map(|n| format!("{} iterations", count(Some(n))));
        row(out, "preload", &digits(Some(preload), 3), "s", &iterations.unwrap_or_default());
    }
}

fn stability(out: &mut String, summary: &Summary) {
    let Some(stability) = &summary.stability else {
        return;
    };
    heading(out, "Stability");
    let remark = format!("{} of the limit", digits(Some(stability.factor), 3));
    row(out, "time step", &digits(Some(1e9 * summary.dt), 4), "ns", &remark);
    row(out, "stability limit", &digits(Some(1e9 * stability.dt_limit), 4), "ns", "");
}

fn how_to_look(out: &mut String, summary: &Summary, folder: &Path) {
    // a run that does not record its bodies shows its surfaces
    let quoted = |path: &Path| creepage::sweep::plan::quoted(&path.to_string_lossy());
    let run = quoted(folder);
    let files = &summary.files;
    let (grid, look) = if files.fields.is_empty() {
        (&files.contact, "colour by pressure, shear, slip_velocity or state")
    } else {
        let look = "Filters > Warp By Vector: displacement; colour by von_mises";
        (&files.fields, look)
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
        python_text(&folder.to_string_lossy()),
        folder.join("summary.json").display()
    );
}

fn scaled(x: Option<f64>, factor: f64) -> Option<f64> {
    x.map(|x| x * factor)
}

/// Text as Python reads it, which is as JSON has it.
fn python_text(text: &str) -> String {
    serde_json::to_string(text).unwrap_or_default()
}

/// Four digits; two for what is little beside the other numbers of its column.
fn small(x: f64) -> String {
    if x != 0.0 && x.abs() < 1e-3 { format!("{x:.1e}") } else { digits(Some(x), 4) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use output::summary::{ExactContact, Files, RollingRadius};
    use serde_json::json;

    fn summary() -> Summary {
        let written = json!({
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
        });
        serde_json::from_value(written).unwrap()
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
        rolled.rolling_radius = Some(RollingRadius { effective: 0.46, ..RollingRadius::default() });
        assert!(!text(&rolled, Path::new("x"), None).contains("free rolling"));
        rolled.rolling_radius =
            rolled.rolling_radius.map(|r| RollingRadius { free: Some(0.4597), ..r });
        let page = text(&rolled, Path::new("x"), None);
        assert!(
            page.contains("\n  without torque: this creepage is that of free rolling\n"),
            "{page}"
        );
    }

    #[test]
    fn the_creepage_of_both_radii_is_told_of_a_disk_and_not_of_half_spaces() {
        let mut rolled = summary();
        rolled.contact.creepage = Some(0.3e-3);
        rolled.contact.nominal_creepage = Some(3.8e-3);
        assert!(!text(&rolled, Path::new("x"), None).contains("nominal"));
        rolled.rolling_radius = Some(RollingRadius::default());
        let page = text(&rolled, Path::new("x"), None);
        let lines = "  creepage                      0.3000 1e-3\n  creepage, nominal R            3.800 1e-3   \
                     (omega R - V)/V; the line above has R_eff in place of R\n";
        assert!(page.contains(lines), "{page}");
    }

    #[test]
    fn a_force_of_zero_is_a_plain_zero_and_a_small_one_has_two_digits() {
        assert_eq!([0.0, 2.34e-7, 27.563].map(small), ["0", "2.3e-7", "27.56"]);
    }

    #[test]
    fn a_run_without_fields_shows_its_surfaces() {
        let mut surfaces = summary();
        surfaces.files = Files::without_fields();
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
        let warnings = vec!["did not converge".into()];
        exact.exact_contact =
            Some(ExactContact { most_sweeps: 100, warnings, ..ExactContact::default() });
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
        rolled.model = Some("half-space".into());
        let page = text(&rolled, Path::new("x"), None);
        for absent in ["element", "spring", "hourglass", "kinetic"] {
            assert!(!page.contains(absent), "{absent}: {page}");
        }
        assert!(page.contains("half-spaces, ") && page.contains("point and step"), "{page}");
    }

    #[test]
    fn what_is_missing_or_no_number_is_left_out_or_dashed() {
        let mut bare = summary();
        bare.half_space = None;
        bare.stability = None;
        bare.energy.kinetic = f64::NAN;
        let page = text(&bare, Path::new("x"), None);
        assert!(!page.contains("null") && !page.contains("NaN") && !page.contains("Stability"));
    }

    #[test]
    fn a_run_that_ended_in_its_preload_has_no_sections() {
        let ended = Summary { status: Some(Status::Interrupted), steps: 0, ..summary() };
        let page = text(&ended, Path::new("x"), None);
        assert!(
            page.contains("interrupted after")
                && page.contains("nothing rolled")
                && !page.contains("Energy"),
            "{page}"
        );
    }
}
