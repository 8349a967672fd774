//! The preload: both methods find one equilibrium, and rolling starts from it without a jump.

use runs::{Results, load, project, run_with, small};

/// Largest deviation of the normal force from that of the preload over the first 0.2 ms, over it.
fn jump(run: &Results) -> f64 {
    let rest = run.number("/preload/normal_force");
    let early = run.history("time").iter().zip(run.history("normal_force"));
    let early: Vec<f64> = early.filter(|(t, _)| **t <= 0.2e-3).map(|(_, n)| *n).collect();
    assert!(early.len() > 100, "{}", early.len());
    early.iter().fold(0.0, |worst: f64, n| worst.max((n / rest - 1.0).abs()))
}

#[test]
fn rolling_without_friction_starts_from_the_static_preload_without_a_jump() {
    // With the 0.8 mm elements of the case the patch spans no more than four of them, and the normal
    // force ripples by 0.5 % as nodes pass through it; at 0.5 mm by 0.2 %. On the tensor product, whose bodies ring less.
    let run = small(&[
        "mesh.grading=tensor",
        "mesh.zone.size=0.5e-3",
        "friction.static=0",
        "drive.creepage=0",
        "output.history_interval=1",
        "evaluate.last=0.002",
    ]);
    assert_eq!(run.summary["preload"]["method"], "static");
    assert!(run.number("/preload/residual") <= 1e-9);
    assert!(run.history("time").last().unwrap() > &0.2e-3);
    let jump = jump(&run);
    assert!(jump < 5e-3, "{jump}");
    // Without a preload the load acts suddenly: what the test would find if there were none.
    let sudden = small(&[
        "friction.static=0",
        "drive.creepage=0",
        "output.history_interval=1",
        "preload.method='none'",
    ]);
    let load = 10e3;
    let first = sudden.history("normal_force")[0];
    assert!((first / load - 1.0).abs() > 0.1, "{first}");
}

#[test]
fn newton_and_relaxation_find_the_same_equilibrium() {
    let sets = ["time.roll=0.0001", "output.history_interval=1"];
    let newton = small(&sets);
    let tight = ["preload.method='relaxation'", "preload.tolerance=1e-12"];
    let relaxed = small(&[&sets[..], &tight[..]].concat());
    let [a, b] = [&newton, &relaxed].map(|run| run.number("/preload/hub_displacement"));
    assert!((a - b).abs() < 1e-9, "{a} {b}");
    let [a, b] = [&newton, &relaxed].map(|run| run.number("/preload/normal_force"));
    assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
}

#[test]
fn a_preload_from_the_cache_gives_the_bits_of_one_just_found() {
    let folder = tempfile::tempdir().unwrap();
    let cache = folder.path().join("preload");
    let path = project("tests/small.toml");
    let case = |sets: &[&str]| load(&path, &[&["time.roll=0.0005"], sets].concat());
    let stiff = case(&["contact.penalty.tangential=0.4"]);
    let (plain, _) = run_with(&case(&[]), 2, None);
    let (found, log) = run_with(&case(&[]), 2, Some(&cache));
    assert!(!log.contains("taken from"), "{log}");
    let (taken, log) = run_with(&case(&[]), 1, Some(&cache));
    assert!(log.contains("preload: taken from"), "{log}");
    // Other springs along the surface, friction and step: the same preload.
    let (stiff_plain, _) = run_with(&stiff, 2, None);
    let (stiff_taken, log) = run_with(&stiff, 2, Some(&cache));
    assert!(log.contains("preload: taken from"), "{log}");
    for (a, b) in [(&plain, &found), (&plain, &taken), (&stiff_plain, &stiff_taken)] {
        assert_eq!(a.differing(b), Vec::<&str>::new());
        assert_eq!(a.summary["preload"], b.summary["preload"]);
        assert_eq!(a.summary["stability"], b.summary["stability"]);
    }
    assert!(!plain.differing(&stiff_plain).is_empty());
    // Another load: another preload.
    let (_, log) = run_with(&case(&["load.normal=9e3"]), 2, Some(&cache));
    assert!(!log.contains("taken from"), "{log}");
}

#[test]
fn a_damaged_preload_is_found_anew_and_said_so() {
    let folder = tempfile::tempdir().unwrap();
    let case = load(&project("tests/small.toml"), &["time.roll=0.0003"]);
    let (first, _) = run_with(&case, 2, Some(folder.path()));
    let entry = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
    let entry = entry.into_iter().find(|path| path.extension().unwrap() == "preload").unwrap();
    let whole = std::fs::read(&entry).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 1;
    for (damaged, word) in
        [(&flipped[..], "checksum"), (&whole[..whole.len() / 2], "checksum"), (&[], "cut off")]
    {
        std::fs::write(&entry, damaged).unwrap();
        let (again, log) = run_with(&case, 2, Some(folder.path()));
        assert!(log.contains("found anew") && log.contains(word), "{log}");
        assert_eq!(first.differing(&again), Vec::<&str>::new());
        assert_eq!(std::fs::read(&entry).unwrap(), whole, "it is mended");
    }
}
