//! `creepage sweep`: bad input before anything runs, failed runs, kills and going on, plans.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use runs::heeding_signals;
use serde_json::Value;

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");
const PROGRAM: &str = env!("CARGO_BIN_EXE_creepage");

/// A folder with a small case, half a second a run, and a sweep file.
struct Place {
    dir: tempfile::TempDir,
}

impl Place {
    fn new(sweep: &str) -> Self {
        let dir = tempfile::tempdir().unwrap();
        let case = fs::read_to_string(CASE).unwrap().replace("roll = 0.008", "roll = 0.001");
        fs::write(dir.path().join("base.toml"), case).unwrap();
        fs::write(dir.path().join("sweep.toml"), sweep).unwrap();
        Self { dir }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    /// `creepage sweep sweep.toml` in the folder.
    fn command(&self, args: &[&str]) -> Command {
        let mut command = heeding_signals(PROGRAM);
        command.current_dir(self.dir.path()).args(["sweep", "sweep.toml"]).args(args);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn sweep(&self, args: &[&str]) -> Output {
        self.command(args).output().unwrap()
    }

    fn results(&self, folder: &str) -> Value {
        json(&self.path(folder).join("sweep.json"))
    }
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[track_caller]
fn refused(place: &Place, args: &[&str], words: &[&str]) {
    let output = place.sweep(args);
    let said = said(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(output.stdout.is_empty());
    assert!(!said.contains("panicked"), "{said}");
    for word in words {
        assert!(said.contains(word), "{word:?} is not in:\n{said}");
    }
}

const AXIS: &str = "base = \"base.toml\"\n\n[[axis]]\nkey = \"friction.static\"\n";
const KT: &str = "base = \"base.toml\"\n[[axis]]\nkey = \"contact.penalty.tangential\"\n\
                  values = [0.05, 0.2]\n";

#[test]
fn a_bad_sweep_file_is_refused_with_its_line_before_anything_is_written() {
    let after_axis = |line: &str| format!("{AXIS}{line}\n");
    let cases: Vec<(String, &[&str])> = vec![
        (after_axis("values = []"), &["sweep.toml:5", "empty"]),
        (after_axis("values = [\"slippery\"]"), &["sweep.toml:5", "\"slippery\"", "a number"]),
        (after_axis("values = [0.1, -0.3]"), &["sweep.toml:5", "-0.3", "at least 0"]),
        (after_axis("values = [0.1, 0.1]"), &["sweep.toml:5", "twice"]),
        (after_axis("values = 0.1"), &["sweep.toml:5", "list"]),
        (after_axis("value = [0.1]"), &["sweep.toml:5", "unknown key", "did you mean `values`"]),
        (after_axis("log = { from = 0.0, to = 1.0, n = 3 }"), &["sweep.toml:5", "positive"]),
        (after_axis("log = { from = 0.1, to = 1.0, n = 1 }"), &["sweep.toml:5", "from 2 to"]),
        (after_axis("linear = { from = 0.1, to = 1.0 }"), &["sweep.toml:5", "n is missing"]),
        (
            after_axis("values = [0.1, 0.2]\nnominal = 0.3"),
            &["sweep.toml:6", "there are: 0.1, 0.2"],
        ),
        (
            format!("mode = \"zip\"\n{AXIS}values = [0.1]\nnominal = 0.1\n"),
            &["sweep.toml:7", "no axis varies alone"],
        ),
        (after_axis(""), &["sweep.toml:4", "one of values, log and linear"]),
        ("base = \"base.toml\"\n".into(), &["sweep.toml", "no axis"]),
        (after_axis("values = [0.1]\n[ensemble]\nmembers = 1"), &["sweep.toml:7", "from 2 to"]),
        (after_axis("values = [0.1]\n[ensemble]\nseed = 3"), &["sweep.toml:6", "ensemble.members"]),
        (after_axis("values = [0.1]\n[ensemble]\nmember = 8"), &["sweep.toml:7", "`members`"]),
        (
            format!("mode = \"zip\"\n{AXIS}values = [0.1]\n[ensemble]\nmembers = 8\n"),
            &["sweep.toml:7", "repeats every point"],
        ),
        (
            AXIS.replace("friction.static", "friction.statik") + "values = [0.1]\n",
            &["sweep.toml:4", "unknown key friction.statik", "did you mean `static`"],
        ),
        (AXIS.replace("friction.static", "name") + "values = [\"x\"]\n", &["cannot be swept"]),
        (AXIS.replace("base.toml", "gone.toml") + "values = [0.1]\n", &["sweep.toml:1", "no file"]),
        (AXIS.replace("\"base.toml\"", "3") + "values = [0.1]\n", &["sweep.toml:1", "in quotes"]),
        (AXIS.replace("base =", "bass =") + "values = [0.1]\n", &["sweep.toml:1", "`base`"]),
        (after_axis("values = [0.1"), &["sweep.toml:5", "TOML"]),
        (KT.into(), &["sweep.toml:3", "stability limit", "[[derive]]"]),
        (
            format!("{KT}[[axis]]\nkey = \"time.factor\"\nvalues = [0.3, 0.6]\n"),
            &["sweep.toml:3", "stability limit", "rule = \"fixed\"", "[set] with time.step"],
        ),
        (
            format!("{KT}[[derive]]\nkey = \"time.step\"\nrule = \"both\"\n"),
            &["sweep.toml:7", "\"bound\" or \"fixed\""],
        ),
        (
            format!(
                "mode = \"zip\"\n{AXIS}values = [0.1]\n[[axis]]\nkey = \"friction.law\"\n\
                     values = [\"coulomb\", \"exponential\"]\n"
            ),
            &["sweep.toml:8", "has 2 values and the first has 1"],
        ),
        (
            after_axis("values = [0.1]\n[set]\nfriction.static = 0.2"),
            &["sweep.toml:4", "friction.static is given twice"],
        ),
        (
            after_axis("values = [0.1]\n[set]\noutput.window = [{ from = 1, to = 99 }]"),
            &["sweep.toml:7", "output.window"],
        ),
        (after_axis("values = [0.1]\n[set]\nfriction.dinamic = 0.2"), &["sweep.toml:7", "dynamic"]),
        (
            "base = \"base.toml\"\n[[axis]]\nkey = \"mesh.zone.length\"\nvalues = [0.014, 0.3]\n\
             [[derive]]\nkey = \"time.step\"\nrule = \"bound\"\n"
                .into(),
            &["sweep.toml:4", "mesh.zone.length = 0.3", "bar.length"],
        ),
    ];
    for (text, words) in cases {
        let place = Place::new(&text);
        refused(&place, &["--out", "out"], words);
        assert!(!place.path("out").exists(), "{text}");
    }
}

#[test]
fn the_members_of_an_ensemble_differ_and_their_point_has_an_interval() {
    let place = Place::new(&format!(
        "{AXIS}values = [0.2, 0.3]\n[ensemble]\nmembers = 3\n[set]\ncontact.enforcement = \"exact\"\n"
    ));
    let output = place.sweep(&["--out", "here"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let results = place.results("here");
    let at = |value: &Value, pointer: &str| value.pointer(pointer).unwrap().as_f64().unwrap();
    let runs = results["runs"].as_array().unwrap();
    let seeds: Vec<f64> = runs.iter().map(|run| at(run, "/parameters/preload.seed")).collect();
    assert_eq!(seeds, [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]);
    let traction = "/summary/contact/traction_coefficient";
    let of = |run: usize| at(&runs[run], traction);
    assert!(of(0) != of(1) && of(1) != of(2), "the members are one run");
    // smooth friction, early on: as close as the disturbance of 1e-9 is small
    assert!((of(0) / of(1) - 1.0).abs() < 1e-5, "{} {}", of(0), of(1));
    let points = results["points"].as_array().unwrap();
    assert_eq!(points.len(), 2);
    assert_eq!(points[0]["parameters"], serde_json::json!({ "friction.static": 0.2 }));
    let mean = (of(0) + of(1) + of(2)) / 3.0;
    assert!((at(&points[0], traction) - mean).abs() < 1e-15);
    let half = at(&points[0], "/summary/window/ci95/traction_coefficient");
    assert!(half > 0.0 && half < 1e-5 * mean, "{half}");
    let table = fs::read_to_string(place.path("here/sweep.csv")).unwrap();
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| lines[0].iter().position(|heading| *heading == name).unwrap();
    assert_eq!(
        (lines.len(), lines[7][0], lines[8][column("status")]),
        (9, "mean of 3", "ensemble")
    );
    assert_eq!(lines[7][column("traction_coefficient_ci95")].parse::<f64>().unwrap(), half);
    assert_eq!(lines[7][column("torque_sd")], "", "deviations over a window are of a run");
    // a run has the interval of its batches in time, if they give one
    let number = |line: usize, name: &str| lines[line][column(name)].parse::<f64>().ok();
    let of_batches = runs[0].pointer("/check/patch/traction_coefficient/ci95").unwrap();
    assert_eq!(number(1, "traction_coefficient_ci95"), of_batches.as_f64());
    let slip = "/check/slip_zone/mean/value";
    assert_eq!(number(1, "slip_zone_mean"), Some(at(&runs[0], slip)));
    let mean = (at(&runs[0], slip) + at(&runs[1], slip) + at(&runs[2], slip)) / 3.0;
    assert!((number(7, "slip_zone_mean").unwrap() / mean - 1.0).abs() < 1e-12);
    assert!(number(7, "slip_zone_mean_ci95").is_some_and(|half| half > 0.0));
}

#[test]
fn a_folder_that_is_not_this_sweeps_is_refused() {
    let place = Place::new(&format!("{AXIS}values = [0.1, 0.2]\n"));
    assert_eq!(place.sweep(&["--out", "out", "--plan", "plan.sh"]).status.code(), Some(0));
    refused(&place, &["--out", "out"], &["already holds this sweep", "--resume"]);
    fs::write(place.path("sweep.toml"), format!("{AXIS}values = [0.1, 0.3]\n")).unwrap();
    for more in [&["--resume"][..], &[], &["--collect"]] {
        let args = [&["--out", "out"], more].concat();
        refused(&place, &args, &["sweep.toml:4", "another sweep", "friction.static"]);
    }
    fs::create_dir(place.path("mine")).unwrap();
    fs::write(place.path("mine/notes.txt"), "mine").unwrap();
    for more in [&["--resume"][..], &[], &["--force"], &["--collect"]] {
        refused(&place, &[&["--out", "mine"], more].concat(), &["holds no sweep"]);
    }
    refused(&place, &["--out", "out", "--jobs", "0"], &["1 to 1024"]);
    refused(&place, &["--out", "new", "--memory", "1"], &["memory", "MB"]);
    refused(&place, &["--out", "new", "--memory", "-1"], &["positive"]);
}

#[test]
fn a_failed_run_is_told_with_its_reason_and_the_others_complete() {
    let place = Place::new(
        "base = \"base.toml\"\n[[axis]]\nkey = \"time.factor\"\nvalues = [0.5, 1.6, 0.67]\n",
    );
    let output = place.sweep(&["--out", "out", "--jobs", "2", "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    let results = place.results("out");
    assert_eq!(results, serde_json::from_slice::<Value>(&output.stdout).unwrap());
    let runs = results["runs"].as_array().unwrap();
    let statuses: Vec<_> = runs.iter().map(|run| run["status"].as_str().unwrap()).collect();
    assert_eq!(statuses, ["completed", "failed", "completed"]);
    let reason = runs[1]["reason"].as_str().unwrap();
    assert!(reason.contains("times the stability limit"), "{reason}");
    assert_eq!(runs[1]["summary"]["diagnosis"], reason);
    assert!(runs[0]["check"]["metrics"]["violating_fraction"]["value"].is_number());
    assert_eq!(runs[2]["parameters"]["time.factor"], 0.67);
    let folder = place.path("out").join(runs[0]["run"].as_str().unwrap());
    assert_eq!(runs[0]["summary"], json(&folder.join("summary.json")));
    let table = fs::read_to_string(place.path("out/sweep.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 4);
    assert!(lines[0].starts_with("name,time.factor,status,dt,"), "{}", lines[0]);
    assert!(lines[2].starts_with("001-factor-1.6,1.6,failed,"), "{}", lines[2]);
    // A failed run is done: going on does not repeat it.
    let again = place.sweep(&["--out", "out", "--resume"]);
    assert_eq!(again.status.code(), Some(1), "{}", said(&again));
    assert_eq!(place.results("out"), results);
}

#[test]
fn a_step_above_the_limit_is_refused_with_the_limit_and_does_not_stop_the_others() {
    let place =
        Place::new("base = \"base.toml\"\n[[axis]]\nkey = \"time.step\"\nvalues = [5e-7, 6e-8]\n");
    let output = place.sweep(&["--out", "out"]);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    let results = place.results("out");
    let runs = results["runs"].as_array().unwrap();
    let reason = runs[0]["reason"].as_str().unwrap();
    assert!(reason.contains("5.0000e-7 s is above the stability limit of 1."), "{reason}");
    assert_eq!(runs[0]["status"], "failed");
    assert!(runs[1]["summary"]["dt"].as_f64().unwrap() <= 6e-8);
    let run = ["run", "base.toml", "--set", "time.step=5e-7"];
    let alone = Command::new(PROGRAM).current_dir(place.dir.path()).args(run).output().unwrap();
    assert_eq!(alone.status.code(), Some(2), "{}", said(&alone));
    assert!(said(&alone).contains("--set: time.step = 5.0000e-7"), "{}", said(&alone));
    // A run that did not come to its end has no results to show.
    let table = fs::read_to_string(place.path("out/sweep.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let at = rows[0].iter().position(|name| *name == "peak_pressure").unwrap();
    assert!(rows[1][at].is_empty() && !rows[2][at].is_empty());
}

/// The sweep of the kill tests: four runs that share a preload and a step.
fn four() -> Place {
    Place::new(
        "base = \"base.toml\"\n[[axis]]\nkey = \"contact.penalty.tangential\"\n\
         values = [0.03, 0.1, 0.3, 1.0]\n[[derive]]\nkey = \"time.step\"\nrule = \"fixed\"\n",
    )
}

/// The results without what is documented to differ, and the table without those columns.
fn repeated(place: &Place, folder: &str) -> (Value, Vec<Vec<String>>) {
    let mut results = place.results(folder);
    let timed: Vec<String> = serde_json::from_value(results["not_repeated"].clone()).unwrap();
    for run in results["runs"].as_array_mut().unwrap() {
        let summary = run["summary"].as_object_mut().unwrap();
        timed.iter().for_each(|name| assert!(summary.remove(name).is_some(), "{name}"));
    }
    let table = fs::read_to_string(place.path(folder).join("sweep.csv")).unwrap();
    let lines = table.lines().map(|line| line.split(',').map(str::to_owned).collect());
    let mut rows: Vec<Vec<String>> = lines.collect();
    let kept: Vec<bool> = rows[0].iter().map(|name| !timed.contains(name)).collect();
    assert_eq!(kept.iter().filter(|kept| !**kept).count(), 3, "wall_s, peak_rss_mb, threads");
    for row in &mut rows {
        let mut at = kept.iter();
        row.retain(|_| *at.next().unwrap());
    }
    (results, rows)
}

#[test]
fn a_sweep_killed_again_and_again_ends_with_the_bits_of_one_that_was_not() {
    let place = four();
    let output = place.sweep(&["--out", "whole", "--jobs", "2"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let mut chance = 0x2545_f491_4f6c_dd1d_u64 ^ u64::from(std::process::id());
    let mut kills = 0;
    let code = loop {
        let more: &[&str] = if kills == 0 { &[] } else { &["--resume"] };
        let mut child = place.command(&["--out", "cut", "--jobs", "2"]).args(more).spawn().unwrap();
        for _ in 0..3 {
            chance ^= chance << 13;
            chance ^= chance >> 7;
            chance ^= chance << 17;
        }
        let clock = Instant::now();
        let life = Duration::from_millis(50 + chance % 1500);
        while clock.elapsed() < life && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        if let Some(exit) = child.try_wait().unwrap() {
            break exit.code();
        }
        // After five kills it may live.
        if kills == 5 {
            break child.wait().unwrap().code();
        }
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
    };
    assert_eq!(code, Some(0), "after {kills} kills");
    assert!(kills > 0, "no kill fell into the sweep");
    assert_eq!(repeated(&place, "cut"), repeated(&place, "whole"), "after {kills} kills");
}

#[test]
fn a_sweep_leaves_the_same_bits_on_any_number_of_threads_with_its_kernels_pinned() {
    let place = Place::new(
        "base = \"base.toml\"\n[set]\ntime.roll = 2e-4\n\
         [[axis]]\nkey = \"contact.enforcement\"\nvalues = [\"penalty\", \"exact\"]\n\
         [[derive]]\nkey = \"time.step\"\nrule = \"fixed\"\n",
    );
    let sweep = |threads: &str| {
        let output = place.sweep(&["--out", threads, "--threads", threads, "--deterministic"]);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        let runs = place.results(threads)["runs"].clone();
        let runs = runs.as_array().unwrap().iter();
        let folders = runs.map(|run| place.path(threads).join(run["run"].as_str().unwrap()));
        folders.map(|folder| runs::results(&folder)).collect::<Vec<_>>()
    };
    let first = sweep("1");
    assert_eq!(first.len(), 2);
    for run in &first {
        assert!(run.resolved.contains("\ndeterministic = true\n"));
        assert!(["avx2", "neon", "fused"].contains(&run.summary["kernels"].as_str().unwrap()));
    }
    for threads in ["2", "3", "4", "7"] {
        for (a, b) in first.iter().zip(sweep(threads)) {
            assert_eq!(a.differing(&b), Vec::<&str>::new(), "{threads} threads");
            assert_eq!(a.resolved, b.resolved);
        }
    }
}

#[test]
fn runs_end_with_their_killed_sweep() {
    let place = four();
    let mut child = place.command(&["--out", "out", "--jobs", "2"]).spawn().unwrap();
    let run = place.path("out/runs/000-tangential-0.03");
    let clock = Instant::now();
    while !run.join("history.h5").exists() {
        assert!(clock.elapsed() < Duration::from_secs(60), "no run begins");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    std::thread::sleep(Duration::from_secs(3));
    assert!(!run.join("summary.json").exists(), "the run went on to its end");
}

#[test]
fn ctrl_c_ends_the_runs_in_order_and_resume_goes_on() {
    let place = four();
    let child = place.command(&["--out", "out", "--jobs", "1"]).spawn().unwrap();
    let clock = Instant::now();
    while !place.path("out/runs/001-tangential-0.1/history.h5").exists() {
        assert!(clock.elapsed() < Duration::from_secs(60), "no run begins");
        std::thread::sleep(Duration::from_millis(2));
    }
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    let results = place.results("out");
    let status = |i: usize| results["runs"][i]["status"].as_str().unwrap();
    assert_eq!(status(0), "completed");
    assert_eq!(status(1), "interrupted");
    assert_eq!(status(3), "not begun");
    let output = place.sweep(&["--out", "out", "--resume"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

#[test]
fn a_plan_run_by_a_shell_and_collected_gives_the_bits_of_the_sweep() {
    let place = four();
    let output = place.sweep(&["--out", "whole"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let planned = place.sweep(&["--out", "planned", "--plan", "runs.sh"]);
    assert_eq!(planned.status.code(), Some(0), "{}", said(&planned));
    let before = place.sweep(&["--out", "planned", "--collect"]);
    assert_eq!(before.status.code(), Some(1), "nothing has run yet");
    assert_eq!(place.results("planned")["runs"][0]["status"], "not begun");
    let plan = fs::read_to_string(place.path("runs.sh")).unwrap();
    assert_eq!(plan.lines().count(), 4);
    for line in plan.lines() {
        let shell = Command::new("sh")
            .args(["-c", line])
            .env("CREEPAGE", PROGRAM)
            .current_dir(place.dir.path())
            .output()
            .unwrap();
        assert!(shell.status.success(), "{line}: {}", said(&shell));
    }
    // Two of the runs come back from elsewhere.
    fs::create_dir(place.path("node")).unwrap();
    for name in ["002-tangential-0.3", "003-tangential-1"] {
        fs::rename(place.path("planned/runs").join(name), place.path("node").join(name)).unwrap();
    }
    let collected = place.sweep(&["--out", "planned", "--collect", "node"]);
    assert_eq!(collected.status.code(), Some(0), "{}", said(&collected));
    let ((mut there, table), (mut here, whole)) =
        (repeated(&place, "planned"), repeated(&place, "whole"));
    assert!(there["runs"][3]["run"].as_str().unwrap().ends_with("node/003-tangential-1"));
    for results in [&mut there, &mut here] {
        results["runs"].as_array_mut().unwrap().iter_mut().for_each(|run| {
            run["run"].take();
        });
    }
    assert_eq!(there, here);
    assert_eq!(table, whole);
}

/// The script of the project for Slurm, with a stub in the place of `sbatch`.
fn slurm(place: &Place, environment: &[(&str, &str)], words: &[&str]) -> Output {
    use std::os::unix::fs::PermissionsExt;
    let stub = place.path("bin/sbatch");
    fs::create_dir_all(stub.parent().unwrap()).unwrap();
    fs::write(&stub, "#!/bin/sh\nprintf '%s\\n' \"$@\" > submitted\n").unwrap();
    fs::set_permissions(&stub, fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", place.path("bin").display(), std::env::var("PATH").unwrap());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/sweeps/slurm.sh");
    assert!(Command::new("bash").args(["-n", script]).status().unwrap().success());
    let mut command = Command::new("bash");
    command.arg(script).args(words).env("PATH", path).env("CREEPAGE", PROGRAM);
    command.env_remove("SLURM_ARRAY_TASK_ID").envs(environment.iter().copied());
    command.current_dir(place.dir.path()).output().unwrap()
}

#[test]
fn the_slurm_script_asks_for_the_estimated_memory_and_time_and_runs_on_the_processors_it_gets() {
    let place = Place::new(&format!("{AXIS}values = [0.3, 0.4]\n"));
    let planned = place.command(&["--out", "of two words", "--plan", "runs.sh"]).output().unwrap();
    assert_eq!(planned.status.code(), Some(0), "{}", said(&planned));

    let output = slurm(&place, &[], &["runs.sh", "--cpus-per-task=2"]);
    assert!(output.status.success(), "{}", said(&output));
    let submitted = fs::read_to_string(place.path("submitted")).unwrap();
    let words: Vec<&str> = submitted.lines().collect();
    assert_eq!(words[0], "--array=1-2");
    // 500 MB and twice the 4 MB of the small case, and a time of seconds
    let limit = |word: &str, name: &str| -> u64 {
        word.trim_end_matches('M').strip_prefix(name).unwrap().parse().unwrap()
    };
    assert!((505..520).contains(&limit(words[1], "--mem=")), "{submitted}");
    assert!((10..20).contains(&limit(words[2], "--time=")), "{submitted}");
    assert_eq!((words[3], words.last()), ("--cpus-per-task=2", Some(&"runs.sh")));

    let task = [("SLURM_ARRAY_TASK_ID", "2"), ("SLURM_CPUS_PER_TASK", "2")];
    let output = slurm(&place, &task, &["runs.sh"]);
    assert!(output.status.success(), "{}", said(&output));
    let runs = fs::read_dir(place.path("of two words/runs")).unwrap();
    let done: Vec<PathBuf> = runs.map(|entry| entry.unwrap().path()).collect();
    assert_eq!(done.len(), 1, "{done:?}");
    let summary: Value =
        serde_json::from_slice(&fs::read(done[0].join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["threads"], 2);

    let beyond = slurm(&place, &[("SLURM_ARRAY_TASK_ID", "3")], &["runs.sh"]);
    assert_eq!(beyond.status.code(), Some(2));
    fs::remove_file(place.path("submitted")).unwrap();
    fs::remove_dir_all(place.path("of two words/cases")).unwrap();
    assert_eq!(slurm(&place, &[], &["runs.sh"]).status.code(), Some(2), "no case, no estimate");
    assert!(!place.path("submitted").exists());
}
