//! `creepage bench` computes what it times.

use std::process::Command;

use serde_json::Value;

fn bench(args: &[&str]) -> Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
    let output = command.args(["bench", "--threads", "1", "--json"]).args(args).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Five other codes find -1.074103e-6 m for small strain; strains are 1e-4 here.
#[test]
fn the_block_that_is_timed_moves_as_in_other_codes() {
    let found = bench(&["--block", "4", "--element", "full"]);
    let corner = found["corner_after_20_steps"].as_f64().unwrap();
    assert!((corner / -1.074103e-6 - 1.0).abs() < 1e-4, "{corner:e}");
    assert!(found["step_ns_per_element"].as_f64().unwrap() > 0.0);
    let one_point = bench(&["--block", "4"])["corner_after_20_steps"].as_f64().unwrap();
    assert!((one_point / corner - 1.0).abs() < 0.05 && one_point != corner, "{one_point:e}");
}
