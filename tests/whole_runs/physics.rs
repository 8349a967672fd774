//! What every run must show, on a small case.

use runs::{Results, small};

fn length(v: &[f64]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Largest (|shear| - mu p) over the Hertz pressure, from the recorded tractions.
fn cone_excess(run: &Results) -> f64 {
    let scale = run.number("/half_space/peak_pressure");
    let (shear, pressure, mu) = (run.contact("shear"), run.contact("pressure"), run.contact("mu"));
    assert!(pressure.len() > 10 && shear.len() == pressure.len() && mu.len() == pressure.len());
    let steps = shear.iter().zip(pressure).zip(mu);
    let excess = steps.flat_map(|((shear, p), mu)| {
        let shear = shear.chunks(3).map(length);
        shear.zip(p).zip(mu).map(|((t, p), mu)| (t - mu * p) / scale)
    });
    excess.fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn a_driven_disk_carries_its_load_within_the_cone_and_balances_its_energy() {
    let run = small(&[]);
    assert_eq!(run.summary["status"], "completed");
    let normal = run.number("/contact/normal_force");
    assert!((normal / 10e3 - 1.0).abs() < 0.01, "{normal}");
    assert!(run.history("normal_force").iter().all(|n| (n / 10e3 - 1.0).abs() < 0.02));
    assert!((run.number("/contact/creepage") - 4e-3).abs() < 1e-9);
    let traction = run.number("/contact/traction_coefficient");
    assert!((0.15..0.3).contains(&traction), "{traction}");
    assert!(run.number("/contact/slip_fraction") > 0.2, "part of the patch slips");
    assert!(run.number("/contact/stick_fraction") > 0.2, "part of the patch sticks");

    assert!(cone_excess(&run) < 1e-10, "{:e}", cone_excess(&run));
    assert!(run.number("/checks/resultant_mismatch") < 1e-10);
    let balance = run.number("/energy/balance_error");
    assert!(balance < 1e-3, "{balance:e}");
    let share = run.history("hourglass").iter().zip(run.history("internal")).map(|(h, i)| h / i);
    let share = share.fold(0.0, f64::max);
    assert!(share < 0.02, "{share}");
    assert!(run.number("/energy/friction_dissipated") > 0.0);
}

#[test]
fn pressure_and_shear_of_either_surface_add_up_to_the_resultant() {
    let run = small(&["time.roll=0.002", "output.contact_interval=1e-9"]);
    let area = run.contact("area")[0].to_vec();
    // The disk's faces come first, and so do its nodes.
    let first = run.contact("body")[0].iter().position(|body| *body == 1.0).unwrap();
    let bar = run.data["contact/cells"][4 * first..].iter().fold(f64::MAX, |m, n| m.min(*n));
    let bar = bar as usize;
    let steps = run.data["contact/time"].len();
    assert!(bar > 0 && bar < area.len() && steps > 500);
    let mut checked = 0;
    let (pressure, shear) = (run.contact("pressure"), run.contact("shear"));
    for (row, step) in run.history("step").iter().enumerate() {
        let step = *step as usize;
        if step >= steps {
            continue;
        }
        let (p, t) = (pressure[step], shear[step]);
        let normal = run.history("normal_force")[row];
        let tangential = run.history("tangential_force")[row];
        for (nodes, sign) in [(0..bar, 1.0), (bar..area.len(), -1.0)] {
            let force: f64 = nodes.clone().map(|i| area[i] * p[i]).sum();
            // Normals lean by up to a/R = 0.024 across the patch, which takes 3e-4 off.
            assert!((force / normal - 1.0).abs() < 1e-3, "{force} {normal}");
            let along: f64 = nodes.map(|i| area[i] * t[3 * i]).sum();
            assert!((sign * along - tangential).abs() < 0.01 * normal, "{along} {tangential}");
        }
        checked += 1;
    }
    assert!(checked > 20, "{checked}");
}

#[test]
fn friction_that_falls_steeply_with_slip_runs_to_its_end_at_the_falling_coefficient() {
    let sets = ["friction.law='exponential'", "friction.dynamic=0.1", "friction.decay=50"];
    let run = small(&sets);
    assert_eq!(run.summary["status"], "completed");
    assert!(cone_excess(&run) < 1e-10, "{:e}", cone_excess(&run));
    let used = run.contact("mu").concat();
    let least = used.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((0.1..0.101).contains(&least), "{least}");
    assert!(used.iter().all(|mu| *mu < 0.3 + 1e-15));
    let traction = run.number("/contact/traction_coefficient");
    assert!((0.05..0.2).contains(&traction), "{traction}");
    assert!(run.number("/energy/balance_error") < 1e-2);
}

#[test]
fn a_disk_that_rolls_freely_is_hardly_dragged() {
    let run = small(&["drive.creepage=0"]);
    let coefficients = run.history("traction_coefficient");
    let largest = coefficients.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
    assert!(largest < 0.02, "{largest}");
    assert!(run.number("/contact/slip_fraction") < 0.05);
}

#[test]
fn a_disk_above_its_bar_meets_no_force_and_conserves_energy() {
    let run = small(&[
        "preload.method='none'",
        "disk.lift=1e-3",
        "load.normal=10",
        "drive.creepage=0",
        "time.roll=0.004",
    ]);
    for column in ["normal_force", "tangential_force", "contact_stored", "friction_dissipated"] {
        assert!(run.history(column).iter().all(|x| *x == 0.0), "{column}");
    }
    assert!(run.contact("pressure").concat().iter().all(|p| *p == 0.0));
    assert!(run.contact("state").concat().iter().all(|s| *s == 0.0));
    // The disk starts unstrained and breathes under its own rotation: energy is exchanged.
    let exchanged = run.history("internal").iter().copied().fold(0.0, f64::max);
    assert!(exchanged > 1e-3, "{exchanged}");
    let imbalance = run.history("imbalance").iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let kinetic = run.history("kinetic")[0];
    assert!(imbalance < 1e-8 * kinetic, "{imbalance:e} J of {kinetic:e} J");
    assert!(imbalance < 1e-3 * exchanged, "{imbalance:e} J of {exchanged:e} J");
}
