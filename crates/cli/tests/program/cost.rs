//! What a run says before its first step and after its last.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

const CASE: &str = "load.normal = 100e3\ndrive.speed = 38.89\ndrive.creepage = 2.4e-3\n\
                    friction.static = 0.5\n";

fn run(folder: &Path, more: &[&str]) -> Output {
    std::fs::write(folder.join("wheel.toml"), CASE).unwrap();
    let args = ["run", "wheel.toml", "--force", "--set", "mesh.zone.size=4e-3"];
    let rolls = ["--set", "time.roll=1e-3", "--set", "drive.ramp=0.0"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
    command.args(args).args(rolls).args(more).current_dir(folder);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output
}

/// Numbers in groups of three digits, as the program prints them.
fn grouped(n: u64) -> String {
    if n < 1000 { n.to_string() } else { format!("{} {:03}", n / 1000, n % 1000) }
}

#[test]
fn a_run_tells_its_cost_before_it_rolls_and_what_to_do_next_after_it() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &[]);
    let said = String::from_utf8_lossy(&output.stderr);
    let summary = std::fs::read_to_string(folder.path().join("runs/wheel/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let count = |key: &str| grouped(summary[key].as_u64().unwrap());
    let line = format!("{} elements, {} steps of ", count("elements"), count("steps"));
    let told: Vec<&str> = said.lines().filter(|l| l.contains(" elements, ")).collect();
    assert!(told.len() == 1 && told[0].starts_with(&line), "{line:?} is not in {told:?}");
    assert!(told[0].contains("on this machine") && told[0].ends_with(" MB of results"), "{said}");
    let time = told[0].split(" ns: ").nth(1).unwrap().split(" on this").next().unwrap();
    let time = time.trim_start_matches("about ");
    let whole = |text: &str| text.split(' ').next().unwrap().parse::<u32>().is_ok();
    assert!(time == "less than 1 s" || whole(time), "more digits than an estimate has: {time}");
    let page = String::from_utf8_lossy(&output.stdout);
    let next = page.split("What next").nth(1).unwrap();
    for command in ["view", "report", "plot", "check"] {
        assert!(next.contains(&format!("creepage {command} runs/wheel ")), "{next}");
    }
}

#[test]
fn a_quiet_run_says_nothing_of_its_cost() {
    let folder = tempfile::tempdir().unwrap();
    assert!(run(folder.path(), &["--quiet"]).stderr.is_empty());
}
