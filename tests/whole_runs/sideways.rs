//! A disk of finite elements that drifts or turns, against two half-spaces.

use runs::{Results, small};

const SETS: &[&str] = &["contact.enforcement='exact'", "drive.creepage=0"];

/// A rim so shallow that it follows the hub within a fraction of the roll; with one as deep as the small disk's, it swings
/// about the hub's motion by as much as that of a spin of 0.3 rad/m.
const SHALLOW: &[&str] = &["disk.hub_radius=0.07"];

/// Means are over the last millimetre.
const ROLL: &[&str] =
    &["mesh.zone.size=0.5e-3", "time.roll=0.006", "evaluate.last=0.001", "drive.creepage=0"];

#[test]
fn friction_opposes_drift_and_spin_as_on_half_spaces() {
    for (key, least) in [("drive.lateral_creepage=2e-3", 0.1), ("drive.spin=0.3", 0.01)] {
        let finite_elements = small(&[SETS, SHALLOW, ROLL, &[key]].concat());
        let share = |run: Results| {
            run.number("/contact/lateral_force") / run.number("/contact/normal_force")
        };
        // half-spaces converge at first order in the spacing
        let [coarse, fine] = ["mesh.zone.size=0.4e-3", "mesh.zone.size=0.2e-3"]
            .map(|spacing| share(small(&[ROLL, &["model='half-space'", key, spacing]].concat())));
        let other = 2.0 * fine - coarse;
        let error = finite_elements.number("/energy/balance_error");
        let bodies = share(finite_elements);
        assert!(bodies < -least, "{key}: {bodies}");
        assert!((bodies / other - 1.0).abs() < 0.06, "{key}: {bodies} {other}");
        assert!(error < 1e-5, "{key}: {error:e}");
    }
}

#[test]
fn drift_and_spin_to_the_other_side_are_the_mirror_image() {
    for key in ["drive.lateral_creepage", "drive.spin"] {
        let [left, right] = ["", "-"].map(|sign| {
            let value = format!("{key}={sign}2e-3");
            let roll = ["time.roll=0.003", "evaluate.last=0.001", "damping.mass=4000"];
            small(&[SETS, &roll, &[value.as_str()]].concat())
        });
        let last = |run: &Results, column: &str| *run.history(column).last().unwrap();
        let [left_force, right_force] = [&left, &right].map(|run| last(run, "lateral_force"));
        assert!(
            left_force < 0.0 && (left_force / right_force + 1.0).abs() < 1e-3,
            "{key}: {left_force} {right_force}"
        );
        let normal = [&left, &right].map(|run| last(run, "normal_force"));
        assert!((normal[0] / normal[1] - 1.0).abs() < 1e-4, "{key}: {normal:?}");
    }
}

#[test]
fn deformation_is_without_the_drift_and_the_turn_of_the_hub() {
    let largest = |sets: &[&str]| {
        let run = small(&[SETS, &["time.roll=0.004", "evaluate.last=0.001"], sets].concat());
        let last = run.data.range("fields/deformation/".to_owned()..);
        let last = last.take_while(|(name, _)| name.starts_with("fields/deformation/")).last();
        last.unwrap().1.iter().fold(0.0_f64, |most, u| most.max(u.abs()))
    };
    let straight = largest(&[]);
    // the hub drifts by some 80 um, and turns by 2 mrad, which is 160 um at the rim
    for key in ["drive.lateral_creepage=2e-2", "drive.spin=0.5"] {
        let sideways = largest(&[key]);
        assert!(sideways < 2.0 * straight, "{key}: {sideways:e} {straight:e}");
    }
}
