//! Finite elements that follow the profiles of a wheel and a rail.

use runs::{Results, load, project, run};

const SMALL: [&str; 4] =
    ["mesh.grading=tensor", "contact.enforcement=exact", "time.step=4e-8", "evaluate.last=0.002"];
/// Slope of the cone.
const SLOPE: f64 = 0.05;

fn small(sets: &[&str]) -> Results {
    run(&load(&project("tests/small.toml"), &[&SMALL, sets].concat()), 2)
}

/// A key of points (mm) as a profile.
fn profile(key: &str, at: impl Fn(f64) -> f64) -> String {
    let points = (-150..=150).map(|i| 0.1 * f64::from(i));
    let points: Vec<String> = points.map(|y| format!("[{}, {}]", 1e-3 * y, 1e-3 * at(y))).collect();
    format!("{key}=[{}]", points.join(", "))
}

fn cone() -> String {
    profile("disk.profile", |y| SLOPE * y)
}

fn contact(run: &Results, name: &str) -> f64 {
    run.number(&format!("/contact/{name}"))
}

#[test]
fn a_rail_whose_profile_is_a_circle_rolls_as_one_with_that_crown() {
    let arc = profile("bar.profile", |y| 60.0 - (3600.0 - y * y).sqrt());
    let short = "time.roll=0.003";
    let (crowned, profiled) = (small(&[short]), small(&[short, &arc]));
    // points are smoothed by 1 um rms; the tangential force still rises after 3 mm
    for (name, limit) in [
        ("peak_pressure", 1e-4),
        ("patch_half_length", 1e-4),
        ("patch_half_width", 1e-4),
        ("tangential_force", 1e-3),
    ] {
        let [a, b] = [&crowned, &profiled].map(|run| contact(run, name));
        assert!((b / a - 1.0).abs() < limit, "{name}: {a} {b}");
    }
}

#[test]
fn a_cone_without_friction_is_pressed_aside_by_its_slope() {
    let run = small(&[&cone(), "friction.static=1e-5", "drive.creepage=0", "time.roll=0.003"]);
    let [aside, up] = ["lateral_force", "normal_force"].map(|name| contact(&run, name));
    // z of a profile is down: the cone is thicker at larger y, and the rail presses it there
    assert!((aside / up / SLOPE - 1.0).abs() < 2e-3, "{aside} {up}");
}

#[test]
fn a_cone_has_the_creepage_of_its_circle_in_a_fixed_zone_and_in_one_that_follows_the_contact() {
    let cone = cone();
    let (fixed, window) = (small(&[&cone]), small(&[&cone, "mesh.window=0.0096"]));
    // the rail's crown of 60 mm is as steep as the cone at y = 3 mm, where the cone is thicker by 0.15 mm
    let thicker = SLOPE * 0.06 * SLOPE / (1.0 + SLOPE * SLOPE).sqrt();
    for run in [&fixed, &window] {
        let creepage = contact(run, "creepage");
        assert!((creepage - 0.004 - thicker / 0.08).abs() < 5e-6, "{creepage}");
        // half-spaces without inertia, with points every 0.1 mm
        let ratio = contact(run, "traction_coefficient") / 0.2918;
        assert!((ratio - 1.0).abs() < 0.025, "{ratio}");
    }
    let [a, b] = [&fixed, &window].map(|run| contact(run, "tangential_force"));
    assert!((b / a - 1.0).abs() < 5e-3, "{a} {b}");
}
