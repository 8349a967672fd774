//! Runs with planted content: each measure returns what was planted, and the perfect one passes.
use crate::planted::*;
use creepage::check::{
    Basis, ContactHistory, Criteria, Limits, Pairing, Report, RunPaths, Span, check,
};
use output::GridFile;
use serde_json::Value;

fn measured(found: &Judged, name: &str) -> f64 {
    found.document["metrics"][name]["value"].as_f64().unwrap_or(f64::NAN)
}

#[track_caller]
fn is(found: &Judged, name: &str, expected: f64) {
    let value = measured(found, name);
    assert!(
        (value - expected).abs() <= 1e-10 * expected.abs().max(1.0),
        "{name}: {value:e}, planted {expected:e}\n{:#}",
        found.document["metrics"][name]
    );
}

/// A run whose slip is the same in every step, so that both pairings see the same.
fn steady(friction: &'static str) -> impl Fn([f64; 3], usize) -> Node {
    move |x, _| perfect(friction, x, 0)
}

#[test]
fn a_perfect_run_passes_the_limits_of_exact_methods() {
    for friction in [COULOMB, FALLING] {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), friction, "exact", 40, steady(friction));
        let found = judge(folder.path(), Report::Stricter).unwrap();
        assert!(found.checked.result.pass, "{friction}: {:#}", found.document["metrics"]);
        for (name, metric) in found.document["metrics"].as_object().unwrap() {
            // the coefficient is not recomputed: these runs do not say which slip the law was given
            let left_out = ["switching_rate", "roughness_ratio"].contains(&name.as_str());
            if !left_out && !name.starts_with("mu_error") {
                is(&found, name, 0.0);
                assert_eq!(metric["pass"], true);
            }
        }
        is(&found, "switching_rate", 0.0);
        assert_eq!(found.document["pairing"]["records_with_the_other"], 39);
        let notes = found.document["notes"].as_array().unwrap();
        let not_recomputed =
            |note: &serde_json::Value| note.as_str().unwrap().contains("no enforced_on");
        assert_eq!(notes.len(), usize::from(friction == FALLING), "{notes:?}");
        assert!(notes.iter().all(not_recomputed), "{notes:?}");
    }
}

#[test]
fn a_perfect_run_that_fluctuates_passes_in_its_own_pairing_and_has_the_roughness_of_its_law() {
    let folder = tempfile::tempdir().unwrap();
    // a tenth of a transit is 35 us: 350 records
    write_with(folder.path(), FALLING, "exact", 400, 1e-6, Leave::default(), |x, step| {
        perfect(FALLING, x, step)
    });
    let found = judge(folder.path(), Report::Only(Pairing::Before)).unwrap();
    assert!(found.checked.result.pass, "{:#}", found.document["metrics"]);
    is(&found, "roughness_ratio", 1.0);
    let law = &found.document["metrics"]["roughness_ratio"]["sides"]["bar"]["before"];
    assert!(law["deviation_law"].as_f64().unwrap() > 1e-3, "nothing fluctuates");
}

#[test]
fn slip_in_adhesion_is_found_with_its_size_node_and_time() {
    let folder = tempfile::tempdir().unwrap();
    let planted = [2e-3, 1e-3, 0.0];
    write(folder.path(), COULOMB, "exact", 10, |x, step| {
        let mut node = perfect(COULOMB, x, 0);
        if step == 7 && x.iter().zip(planted).all(|(a, b)| (a - b).abs() < 1e-9) {
            node.slip = [0.037 * SLIP, 0.0, 0.0];
        }
        node
    });
    let found = judge(folder.path(), Report::Stricter).unwrap();
    is(&found, "adhesion_slip", 0.037);
    let worst = &found.document["metrics"]["adhesion_slip"]["where"];
    for i in 0..2 {
        assert!((worst["position"][i].as_f64().unwrap() - planted[i]).abs() < 1e-12, "{worst}");
    }
    // the pairing `after` finds it at the traction before
    let time = worst["time"].as_f64().unwrap();
    assert!((time - 7.0 * DT).abs() < 1e-12 || (time - 6.0 * DT).abs() < 1e-12, "{worst}");
    assert!(!found.checked.result.pass);
    assert_eq!(found.document["metrics"]["adhesion_slip"]["pass"], false);
}

#[test]
fn traction_off_the_bound_by_a_factor_is_found_with_its_factor() {
    for (friction, factor) in [(COULOMB, 0.9), (FALLING, 0.7), (FALLING, 1.2)] {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), friction, "penalty", 10, |x, _| {
            let mut node = perfect(friction, x, 0);
            if node.state == 2 {
                node.shear = node.shear.map(|c| factor * c);
            }
            node
        });
        let found = judge(folder.path(), Report::Stricter).unwrap();
        is(&found, "law_error", (factor - 1.0f64).abs());
        is(&found, "law_error_own", (factor - 1.0f64).abs());
        let bar = &found.document["metrics"]["law_error"]["sides"]["bar"]["before"];
        for (statistic, expected) in [("mean", factor - 1.0), ("p95", (factor - 1.0f64).abs())] {
            assert!((bar[statistic].as_f64().unwrap() - expected).abs() < 1e-10, "{bar}");
        }
        is(&found, "direction", 0.0);
        assert!(!found.checked.result.pass);
        // all that slips violates: 2 mm of 7 behind the centre and what lies behind them
        let (mut slipping, mut contact) = (0.0, 0.0);
        for x in surfaces().points.iter().take(NX * NY) {
            if hertz(*x) > 0.02 * P0 {
                contact += 1.0;
                slipping += if x[0] > -2e-3 { 0.0 } else { 1.0 };
            }
        }
        is(&found, "violating_fraction", slipping / contact);
    }
}

#[test]
fn a_rotated_traction_is_found_with_its_angle() {
    for angle in [3.0f64, 30.0, 120.0] {
        let folder = tempfile::tempdir().unwrap();
        let (sin, cos) = libm::sincos(angle.to_radians());
        write(folder.path(), COULOMB, "penalty", 10, |x, _| {
            let mut node = perfect(COULOMB, x, 0);
            let [sx, sy, _] = node.shear;
            node.shear = [cos * sx - sin * sy, sin * sx + cos * sy, 0.0];
            node
        });
        let found = judge(folder.path(), Report::Stricter).unwrap();
        is(&found, "direction", angle);
        is(&found, "wrong_direction", if angle > 90.0 { 1.0 } else { 0.0 });
        is(&found, "dissipation", if angle > 90.0 { 1.0 } else { 0.0 });
        is(&found, "law_error", 0.0);
        assert_eq!(found.document["metrics"]["direction"]["pass"], angle < 5.0);
    }
}

#[test]
fn a_flip_flop_of_two_steps_obeys_the_bound_and_fails_by_its_direction() {
    let folder = tempfile::tempdir().unwrap();
    // Every node slips at full speed and flips sign each step; the traction follows one step late,
    // so that p_f = mu(|s|) p_n holds everywhere while the traction drives the slip.
    write(folder.path(), FALLING, "penalty", 41, |x, step| {
        let pressure = hertz(x);
        if pressure <= 0.0 {
            return OPEN;
        }
        let sign = if step % 2 == 0 { 1.0 } else { -1.0 };
        let (speed, bound) = (20.0, mu(FALLING, 20.0));
        Node {
            pressure,
            shear: [sign * bound * pressure, 0.0, 0.0],
            slip: [sign * speed, 0.0, 0.0],
            gap: 0.0,
            mu: bound,
            state: 2,
        }
    });
    let found = judge(folder.path(), Report::Stricter).unwrap();
    is(&found, "law_error", 0.0);
    is(&found, "cone", 0.0);
    is(&found, "direction", 180.0);
    is(&found, "wrong_direction", 1.0);
    is(&found, "dissipation", 1.0);
    is(&found, "violating_fraction", 1.0);
    assert!(!found.checked.result.pass);
    // paired with the slip of the step after, the same run looks right: hence both are measured
    let after = judge(folder.path(), Report::Only(Pairing::After)).unwrap();
    is(&after, "direction", 0.0);
    let before = judge(folder.path(), Report::Only(Pairing::Before)).unwrap();
    is(&before, "direction", 180.0);
}

#[test]
fn penetration_tension_complementarity_and_the_cone_have_their_planted_sizes() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "exact", 3, |x, _| {
        let mut node = perfect(COULOMB, x, 0);
        if node.pressure == P0 {
            node.gap = -0.3 * APPROACH;
            node.shear = [0.6 * P0, 0.0, 0.0];
        } else if node.pressure == 0.0 && x[0] > 9e-3 {
            node.pressure = -1e-3 * P0;
        }
        node
    });
    let found = judge(folder.path(), Report::Stricter).unwrap();
    is(&found, "penetration", 0.3);
    is(&found, "complementarity", 0.3);
    is(&found, "cone", 0.2);
    is(&found, "tension", 1e-3);
    let worst = &found.document["metrics"]["penetration"]["where"]["position"];
    assert!(worst[0].as_f64().unwrap().abs() < 1e-12, "{worst}");
}

#[test]
fn a_smooth_traction_under_a_rough_law_has_the_planted_roughness_ratio() {
    let folder = tempfile::tempdir().unwrap();
    let ratio = 0.09;
    write_with(folder.path(), FALLING, "penalty", 200, 1e-6, Leave::default(), |x, step| {
        let mut node = perfect(FALLING, x, step);
        if node.state == 2 {
            let law = mu(FALLING, node.slip.iter().map(|c| c * c).sum::<f64>().sqrt());
            let smooth = 0.33 + ratio * (law - 0.33);
            node.shear = node.shear.map(|c| c * smooth / law);
        }
        node
    });
    let found = judge(folder.path(), Report::Stricter).unwrap();
    is(&found, "roughness_ratio", ratio);
    assert_eq!(found.document["metrics"]["roughness_ratio"]["pass"], false);
}

#[test]
fn scatter_is_the_distance_from_the_graph_of_the_law() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "penalty", 3, |x, _| {
        let mut node = perfect(COULOMB, x, 0);
        // above the graph by 0.1 where it slips, beside it by 0.2 s_c where it sticks: both off
        if node.state == 2 {
            node.shear = node.shear.map(|c| c * 1.2);
        } else if node.state == 1 {
            node.slip = [0.1 * SLIP, 0.0, 0.0];
        }
        node
    });
    is(&judge(folder.path(), Report::Stricter).unwrap(), "law_scatter", 0.1);
}

#[test]
fn switches_are_counted_per_node_and_time_of_a_shear_wave_over_an_element() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "penalty", 51, |x, step| {
        let mut node = perfect(COULOMB, x, 0);
        if node.state > 0 {
            node.state = if step % 10 < 5 { 1 } else { 2 };
        }
        node
    });
    let found = judge(folder.path(), Report::Stricter).unwrap();
    // a switch every five steps: at steps 5, 10, .. 50
    let shear_wave = (210e9 / (2.0 * 1.3) / 7800.0f64).sqrt();
    is(&found, "switching_rate", 10.0 / (50.0 * DT) * H / shear_wave);
}

#[test]
fn a_resting_patch_has_the_planted_measures() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "exact", 3, steady(COULOMB));
    let found = judge(folder.path(), Report::Stricter).unwrap();
    let mean = |name: &str| found.document["patch"][name]["mean"].as_f64().unwrap();
    for (name, planted) in [
        ("half_length", A),
        ("half_width", 5e-3),
        ("peak_pressure", P0),
        ("peak_pressure_raw", P0),
        ("centre", 0.25e-3),
    ] {
        assert!((mean(name) / planted - 1.0).abs() < 1e-9, "{name}: {}", mean(name));
    }
    let points = &surfaces().points[..NX * NY];
    let load: f64 = points.iter().map(|x| hertz(*x) * H * H).sum();
    assert!((mean("normal_force") / load - 1.0).abs() < 1e-10);
    let nodes = points.iter().map(|x| perfect(COULOMB, *x, 0));
    let drive: f64 = -nodes.map(|n| n.shear[0] * H * H).sum::<f64>();
    assert!((mean("tangential_force") / drive - 1.0).abs() < 1e-10);
    assert!((mean("traction_coefficient") / (drive / load) - 1.0).abs() < 1e-10);
    let stick = mean("stick_fraction");
    assert!((stick + mean("slip_fraction") - 1.0).abs() < 1e-12 && stick > 0.5);
    let sides: Value = found.document["metrics"]["law_error"]["sides"].clone();
    assert_eq!(sides.as_object().unwrap().keys().collect::<Vec<_>>(), ["bar", "disk", "pair"]);
}

#[test]
fn springs_that_give_under_held_nodes_are_told_from_what_the_algorithm_does() {
    let folder = tempfile::tempdir().unwrap();
    // held nodes move across their shear by a tenth of s_c; those let slip obey law and direction
    write(folder.path(), COULOMB, "penalty", 10, |x, _| {
        let mut node = perfect(COULOMB, x, 0);
        if node.state == 1 {
            let [sx, sy, _] = node.shear.map(|c| -c / (0.3 * node.pressure));
            node.slip = [-0.1 * SLIP * sy, 0.1 * SLIP * sx, 0.0];
        }
        node
    });
    let found = judge(folder.path(), Report::Stricter).unwrap();
    is(&found, "law_error_slip_state", 0.0);
    is(&found, "direction_slip_state", 0.0);
    is(&found, "adhesion_slip", 0.1);
    let metrics = &found.document["metrics"];
    for (name, pass) in [
        ("law_error_slip_state", true),
        ("direction_slip_state", true),
        ("law_error", false),
        ("direction", false),
        ("violating_fraction", false),
    ] {
        assert_eq!(metrics[name]["pass"], pass, "{name}: {:#}", metrics[name]);
    }
    for name in ["law_error", "direction", "violating_fraction"] {
        assert_eq!(metrics[name]["by_springs"], true, "{name}: {:#}", metrics[name]);
    }
}

#[test]
fn a_law_that_the_algorithm_itself_breaks_is_not_put_down_to_springs() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "penalty", 10, |x, _| {
        let mut node = perfect(COULOMB, x, 0);
        if node.state == 2 {
            node.shear = node.shear.map(|c| 0.9 * c);
        }
        node
    });
    let found = judge(folder.path(), Report::Stricter).unwrap();
    is(&found, "law_error_slip_state", 0.1);
    is(&found, "direction_slip_state", 0.0);
    let metrics = &found.document["metrics"];
    assert_eq!(metrics["law_error_slip_state"]["pass"], false);
    assert!(metrics["law_error"].get("by_springs").is_none(), "{:#}", metrics["law_error"]);
}

#[test]
fn the_deviation_over_the_window_is_that_of_what_was_planted_record_by_record() {
    let folder = tempfile::tempdir().unwrap();
    // every second record is off its bound by 20 %, the others by none
    write(folder.path(), COULOMB, "penalty", 40, |x, step| {
        let mut node = perfect(COULOMB, x, 0);
        if node.state == 2 && step % 2 == 0 {
            node.shear = node.shear.map(|c| 0.8 * c);
        }
        node
    });
    let found = judge(folder.path(), Report::Only(Pairing::Before)).unwrap();
    is(&found, "law_error", 0.2 / 2f64.sqrt());
    let deviation = found.document["metrics"]["law_error"]["deviation"].as_f64().unwrap();
    assert!((deviation - 0.1).abs() < 1e-10, "{deviation}");
    // in those records all that slips violates, in the others nothing does
    let of = |x: &[f64; 3]| (hertz(*x) > 0.01 * P0).then(|| perfect(COULOMB, *x, 0).state == 2);
    let slips: Vec<bool> = surfaces().points[..NX * NY].iter().filter_map(of).collect();
    let share = slips.iter().filter(|slips| **slips).count() as f64 / slips.len() as f64;
    is(&found, "violating_fraction", 0.5 * share);
    let metric = &found.document["metrics"]["violating_fraction"];
    assert!((metric["deviation"].as_f64().unwrap() - 0.5 * share).abs() < 1e-10, "{metric:#}");
    assert!((metric["where"]["value"].as_f64().unwrap() - share).abs() < 1e-10, "{metric:#}");
    assert_eq!(metric["where"]["time"], 0.0, "the first of the worst records");
}

#[test]
fn a_file_without_the_coefficient_says_that_it_lacks_it() {
    let folder = tempfile::tempdir().unwrap();
    let leave = Leave { mu: true, ..Leave::default() };
    write_with(folder.path(), COULOMB, "penalty", 3, DT, leave, steady(COULOMB));
    let found = judge(folder.path(), Report::Stricter).unwrap();
    for name in ["law_error_own", "mu_error", "mu_error_blurred"] {
        let metric = &found.document["metrics"][name];
        assert_eq!(metric["value"], Value::Null, "{name}");
        assert_eq!(metric["note"], "the file has no field mu", "{name}");
    }
    is(&found, "law_error", 0.0);
}

#[test]
fn scales_that_nobody_states_are_those_of_the_pressure_of_the_last_record() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "exact", 4, |x, step| {
        let node = perfect(COULOMB, x, 0);
        let part = if step < 3 { 1.0 } else { 0.5 };
        Node { pressure: part * node.pressure, shear: node.shear.map(|c| part * c), ..node }
    });
    let case = folder.path().join("case.toml");
    let stated = std::fs::read_to_string(&case).unwrap();
    let left: Vec<&str> = stated
        .lines()
        .filter(|line| !line.starts_with("peak_pressure") && !line.starts_with("half_length"))
        .collect();
    std::fs::write(&case, left.join("\n")).unwrap();
    let found = judge(folder.path(), Report::Stated).unwrap();
    for (name, expected) in [("peak_pressure", 0.5 * P0), ("half_length", A), ("half_width", 5e-3)]
    {
        let scale = &found.document["scales"][name];
        assert!(
            (scale["value"].as_f64().unwrap() / expected - 1.0).abs() < 1e-9,
            "{name}: {scale}"
        );
        assert_eq!(scale["from"], "pressure of the last record");
    }
}

#[test]
fn the_map_shows_the_measures_of_nodes_in_contact_and_nothing_at_others() {
    let folder = tempfile::tempdir().unwrap();
    // 10 % above the bound at nodes that slip, 0.5 % of p0 at nodes outside, which is no contact
    write(folder.path(), COULOMB, "penalty", 2, |x, _| {
        let mut node = perfect(COULOMB, x, 0);
        if node.state == 2 {
            node.shear = node.shear.map(|c| 1.1 * c);
        } else if node.pressure == 0.0 {
            (node.pressure, node.gap) = (5e-3 * P0, -0.2 * APPROACH);
        }
        node
    });
    let (paths, map) = (RunPaths::of(folder.path()).unwrap(), folder.path().join("map.vtkhdf"));
    let mut basis = Basis::read(&paths).unwrap();
    let limits = Limits::for_enforcement(basis.enforcement.as_deref());
    let options = Criteria { window: None, limits, report: Report::Stated, map: Some(&map) };
    check(&paths, &mut basis, &options).unwrap();
    let file = GridFile::open(&map).unwrap();
    assert_eq!(file.times().unwrap(), [0.0, DT]);
    let of = |field: &str| file.read(field, false, 1).unwrap();
    let [penetration, ratio, error, cone] =
        ["penetration", "traction_ratio", "law_error", "cone"].map(of);
    let (speed, violates) = (of("slip_speed"), of("violates"));
    for (row, x) in surfaces().points.iter().enumerate() {
        let node = perfect(COULOMB, *x, 0);
        let near = |found: f64, exact: f64| (found - exact).abs() < 1e-9;
        if node.pressure == 0.0 {
            assert!(near(penetration[row], 0.2), "{x:?}");
            assert!(
                [ratio[row], error[row], cone[row], speed[row]].iter().all(|v| v.is_nan()),
                "{x:?}"
            );
            assert_eq!(violates[row], 0.0, "{x:?}");
        } else if node.state == 2 {
            let expected = [0.0, 0.55, 0.1, 0.1];
            let found = [penetration[row], ratio[row], error[row], cone[row]];
            assert!(found.iter().zip(expected).all(|(a, b)| near(*a, b)), "{x:?}: {found:?}");
            assert_eq!(violates[row], 1.0, "{x:?}");
        } else {
            assert!(
                near(ratio[row], 0.3) && near(cone[row], 0.0) && near(speed[row], 0.0),
                "{x:?}"
            );
            assert!(error[row].is_nan() && violates[row] == 0.0, "{x:?}");
        }
    }
}

#[test]
fn transits_end_with_the_window_of_the_run_where_its_last_record_lies_within_an_interval_before() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "exact", 40, steady(COULOMB));
    let last = 39.0 * DT;
    // half of the records
    let transits = 20.0 * DT / (2.0 * A / SPEED);
    for (end_of_run, end) in [(last + 0.9 * DT, last + 0.9 * DT), (last + 1.1 * DT, last)] {
        let paths = RunPaths::of(folder.path()).unwrap();
        let mut basis = Basis::read(&paths).unwrap();
        basis.window = Some([0.0, end_of_run]);
        let limits = Limits::for_enforcement(basis.enforcement.as_deref());
        let window = Some(Span::Transits(transits));
        let options = Criteria { window, limits, report: Report::Stated, map: None };
        let found = check(&paths, &mut basis, &options).unwrap().result.window;
        for (found, expected) in found.iter().zip([end - 20.0 * DT, end]) {
            assert!((found - expected).abs() < 1e-12, "{end_of_run:e}: {found:e} {expected:e}");
        }
    }
}

#[test]
fn a_record_that_is_read_alone_is_that_of_the_stream() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), FALLING, "exact", 4, |x, step| perfect(FALLING, x, step));
    let history = ContactHistory::open(&folder.path().join("contact.vtkhdf")).unwrap();
    let mut index = 0;
    let streamed = history.stream(0..4, |frame| {
        assert!(frame.motion.is_some() && frame.gap.is_some() && frame.state.is_some());
        assert_eq!(format!("{:?}", history.record(index)?), format!("{frame:?}"));
        index += 1;
        Ok(())
    });
    streamed.unwrap();
    assert_eq!(index, 4);
}
