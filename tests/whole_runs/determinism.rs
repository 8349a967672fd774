//! The same case gives the same bits.

use creepage::case::Case;
use runs::{load, project, run, same_bits};

/// The smoke case with every kind of output: a window of every step, and probes.
fn smoke() -> Case {
    load(
        &project("cases/smoke.toml"),
        &[
            "output.window=[{ from = 40e-6, to = 44e-6 }]",
            "output.probes.bar=[[0.001, 0.0], [0.002, 0.002]]",
            "output.probes.disk=[[0.001, 0.0]]",
        ],
    )
}

#[test]
fn one_to_seven_threads_a_repetition_and_the_resolved_case_give_the_same_bits() {
    let case = smoke();
    let first = run(&case, 2);
    for name in ["fields/stress/0001", "contact/slip/0001", "probes/probe2_gap", "history/omega"] {
        assert!(first.data[name].iter().any(|x| *x != 0.0), "{name} holds numbers");
    }
    assert!(first.data["probes/time"].len() as f64 == first.number("/steps"));
    for threads in [1, 2, 3, 4, 7] {
        let other = run(&case, threads);
        assert_eq!(other.number("/threads"), threads as f64);
        same_bits(&first, &other);
    }
    let path = std::path::Path::new("elsewhere/case.toml");
    let again = Case::from_text(&first.resolved, path, &[]).unwrap();
    same_bits(&first, &run(&again, 2));
}

#[test]
fn exact_and_mortar_contact_with_memory_and_full_elements_give_the_same_bits_on_any_threads() {
    for rows in ["node_to_face", "mortar"] {
        let rows = format!("contact.rows={rows}");
        let mut sets = runs::kill::EXACT_WITH_MEMORY.to_vec();
        sets.extend([&rows, "element.contact_layers=full", "time.roll=0.0004"]);
        sets.push("output.fields_interval=5e-6");
        let case = load(&project("tests/small.toml"), &sets);
        let first = run(&case, 1);
        assert!(first.data["contact/shear/0001"].iter().any(|x| *x != 0.0), "{rows}");
        for threads in [2, 3, 4, 7] {
            same_bits(&first, &run(&case, threads));
        }
    }
}

#[test]
fn implicit_steps_with_falling_friction_give_the_same_bits_on_any_threads() {
    let mut sets = runs::kill::EXACT_WITH_MEMORY.to_vec();
    sets.extend(["time.integrator=implicit", "time.step=5e-6", "time.roll=0.002"]);
    let case = load(&project("tests/small.toml"), &sets);
    let first = run(&case, 1);
    assert!(first.data["contact/shear/0001"].iter().any(|x| *x != 0.0));
    for threads in [2, 3] {
        same_bits(&first, &run(&case, threads));
    }
}

#[test]
fn pinned_kernels_are_written_down_and_are_those_that_every_processor_can_follow() {
    let sets = ["deterministic=true", "time.roll=0.0004"];
    let case = load(&project("tests/small.toml"), &sets);
    let first = run(&case, 2);
    let kernels = first.summary["kernels"].as_str().unwrap();
    assert!(["avx2", "fused"].contains(&kernels), "{kernels}");
    assert!(first.resolved.contains("\ndeterministic = true\n"), "{}", first.resolved);
    let path = std::path::Path::new("elsewhere/case.toml");
    let again = Case::from_text(&first.resolved, path, &[]).unwrap();
    same_bits(&first, &run(&again, 3));
    let free = load(&project("tests/small.toml"), &sets[1..]);
    assert_ne!(free.hash(), case.hash());
    assert!(!free.to_toml().contains("deterministic"), "cases without it keep their hash");
}

#[test]
fn another_creepage_gives_other_bits_in_history_and_fields() {
    let sets = ["time.roll=0.0004", "output.fields_interval=5e-6", "preload.tolerance=1e-6"];
    let path = project("tests/small.toml");
    let run_at = |creepage: &str| run(&load(&path, &[&sets[..], &[creepage]].concat()), 2);
    let (a, b) = (run_at("drive.creepage=4e-3"), run_at("drive.creepage=4.000001e-3"));
    let differing = a.differing(&b);
    for name in ["history/omega", "fields/velocity/0002"] {
        assert!(differing.contains(&name), "{name} does not differ");
    }
    assert!(!differing.contains(&"fields/points"));
}
