//! Figure 3 shows the half-space's shear for cases that have a reference, scaled to them.
use crate::planted::*;
use creepage::check::{Basis, RunPaths};
use creepage::figures::{Choice, figures};
use std::path::Path;

/// The reference in the figure of a planted run whose case is given: its name and its points (mm, MPa).
fn reference(
    folder: &Path,
    friction: &str,
    case: &str,
    traction: f64,
) -> Option<(String, Vec<[f64; 2]>)> {
    write(folder, friction, "penalty", 3, |x, _| perfect(friction, x, 0));
    let text = format!(
        "[drive]\nspeed = {SPEED:?}\ncreepage = {CREEPAGE:?}\n[friction]\n{friction}\n{case}"
    );
    std::fs::write(folder.join("case.toml"), text).unwrap();
    let summary = format!(
        "{{\"contact\": {{\"traction_coefficient\": {traction}}}, \"window\": {{\"from\": 0, \"to\": 1}}}}"
    );
    std::fs::write(folder.join("summary.json"), summary).unwrap();
    let paths = RunPaths::of(folder).unwrap();
    let mut basis = Basis::read(&paths).unwrap();
    let all = figures(&paths, &mut basis, None, &Choice::default()).unwrap();
    let figure = all.into_iter().find(|named| named.stem == "figure-3-tractions").unwrap().figure;
    let series = &figure.panels[0].series;
    let found = series.iter().find(|series| series.label.contains("CONTACT"))?;
    assert!(figure.caption.contains("CONTACT"));
    Some((found.label.clone(), found.points.clone()))
}

const MATERIAL: &str = "[material]\npoisson = 0.3\n";

fn scales(a: f64, b: f64) -> String {
    format!("[scales]\npeak_pressure = 2.47512e9\nhalf_length = {a:?}\nhalf_width = {b:?}\n")
}

#[test]
fn the_reference_of_a_wheel_of_twice_the_size_and_pressure_is_scaled() {
    let folder = tempfile::tempdir().unwrap();
    let case = format!("{MATERIAL}{}", scales(14.3234e-3, 10.7744e-3));
    let (label, points) = reference(folder.path(), COULOMB, &case, -0.267).unwrap();
    assert!(label.contains("T/N = 0.280"), "{label}");
    let peak = points.iter().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
    // CONTACT: 552 MPa at x = -3.2 mm, on a grid of 0.1 mm here
    assert!((peak[1] / (2.0 * 551.4) - 1.0).abs() < 0.01, "{peak:?}");
    assert!((peak[0] + 6.5).abs() < 0.2, "{peak:?}");
}

#[test]
fn other_laws_shapes_materials_and_tractions_have_none() {
    let folder = tempfile::tempdir().unwrap();
    let own = scales(7.1617e-3, 5.3872e-3);
    let of = |friction, case: &str, traction| reference(folder.path(), friction, case, traction);
    assert!(of(COULOMB, &format!("{MATERIAL}{own}"), 0.15).is_some());
    assert!(of(FALLING, &format!("{MATERIAL}{own}"), 0.28).is_none());
    assert!(of(COULOMB, &format!("[material]\npoisson = 0.25\n{own}"), 0.28).is_none());
    assert!(of(COULOMB, &own, 0.28).is_none(), "of unknown material");
    assert!(of(COULOMB, &format!("{MATERIAL}{}", scales(6e-3, 6e-3)), 0.28).is_none());
    assert!(of(COULOMB, &format!("{MATERIAL}{own}"), 0.21).is_none());
}
