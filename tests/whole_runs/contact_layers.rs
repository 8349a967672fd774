//! Runs whose contact layers are fully integrated.

use runs::{Results, load, project, run, small};

/// Largest hourglass over internal energy.
fn hourglass(run: &Results) -> f64 {
    let share = run.history("hourglass").iter().zip(run.history("internal")).map(|(h, i)| h / i);
    share.fold(0.0, f64::max)
}

#[test]
fn full_contact_layers_carry_the_load_and_halve_the_hourglass_energy() {
    let one_point = small(&["element.contact_layers='one-point'"]);
    let full = small(&["element.layers=3"]);
    assert_eq!(full.summary["status"], "completed");
    let balance = full.number("/energy/balance_error");
    assert!(balance < 1e-3, "{balance:e}");
    let normal = full.number("/contact/normal_force");
    assert!((normal / 10e3 - 1.0).abs() < 0.01, "{normal}");
    let (before, after) = (hourglass(&one_point), hourglass(&full));
    // What is left sits below and beside the fine zone.
    assert!(after < 0.5 * before, "{before} {after}");
    let pressures = [&one_point, &full].map(|run| run.number("/contact/peak_pressure"));
    assert!((pressures[1] / pressures[0] - 1.0).abs() < 0.02, "{pressures:?}");
}

#[test]
fn one_and_two_threads_and_the_resolved_case_give_the_same_bits() {
    let sets = ["time.roll=0.0004", "preload.tolerance=1e-6"];
    let case = load(&project("tests/small.toml"), &sets);
    let first = run(&case, 2);
    assert_eq!(first.differing(&run(&case, 1)), Vec::<&str>::new());
    let element = first.resolved.split("[element]").nth(1).unwrap();
    for line in ["contact_layers = \"full\"", "layers = 2", "volumetric = \"mean\""] {
        assert!(element.contains(line), "{line} is not in:\n{element}");
    }
    let path = std::path::Path::new("elsewhere/case.toml");
    let again = creepage::case::Case::from_text(&first.resolved, path, &[]).unwrap();
    assert_eq!(first.differing(&run(&again, 2)), Vec::<&str>::new());
}

#[test]
fn slip_that_the_mesh_makes_or_does_not_resolve_is_told_and_smooth_slip_is_not() {
    let rolled = |layers: &str, law: &[&str]| {
        let layers = format!("element.contact_layers={layers}");
        let sets = [&["contact.enforcement=exact", layers.as_str()], law].concat();
        let run = small(&sets);
        let share = run.number("/mesh_mode/alternating_slip");
        let warnings = run.summary["mesh_mode"]["warnings"].as_array().unwrap().clone();
        let energy = run.number("/mesh_mode/hourglass_energy_in_layers");
        (share, energy, warnings.first().map(|w| w.as_str().unwrap().to_owned()))
    };
    let smooth = rolled("full", &[]);
    assert!(smooth.0 < 0.2 && smooth.1 == 0.0 && smooth.2.is_none(), "{smooth:?}");
    // Eq (8) alone: R = 79 at the centre of this patch
    let falling = ["friction.law=exponential", "friction.dynamic=0.2", "friction.mode=exact"];
    let (share, energy, told) = rolled("full", &falling);
    assert!(share > 0.25 && energy == 0.0, "{share} {energy}");
    assert!(told.unwrap().contains("this mesh does not resolve it"));
    let (share, energy, told) = rolled("one-point", &falling);
    assert!(share > 0.25 && energy > 0.01, "{share} {energy}");
    assert!(told.unwrap().contains("a mode of the mesh, not friction"));
}
