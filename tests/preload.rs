//! The preload: both methods find one equilibrium, and rolling starts from it without a jump.
#![allow(clippy::unwrap_used)]

use runs::{Results, small};

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
    // force ripples by 0.5 % as nodes pass through it; at 0.5 mm by 0.2 %.
    let run = small(&[
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
