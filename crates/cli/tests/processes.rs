//! The program under `mpirun`: with the feature `mpi` processes share a run, without it they are refused.
//!
//! `cargo test --release --workspace --features creepage/mpi --test processes` needs Open MPI or MPICH on the machine.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::{Command, Output};

const CREEPAGE: &str = env!("CARGO_BIN_EXE_creepage");

/// What the program does as one of two processes, as far as its environment tells.
fn as_one_of_two(rank: &str, words: &[&str]) -> Output {
    let rank = [("OMPI_COMM_WORLD_RANK", rank), ("OMPI_COMM_WORLD_SIZE", "2")];
    Command::new(CREEPAGE).args(words).envs(rank).output().unwrap()
}

#[test]
fn a_command_of_one_process_is_refused_once_under_mpirun() {
    let said = |rank| {
        let done = as_one_of_two(rank, &["schema"]);
        (done.status.code(), String::from_utf8(done.stderr).unwrap(), done.stdout)
    };
    let (code, message, printed) = said("0");
    assert_eq!((code, printed), (Some(2), vec![]));
    assert!(message.contains("2 processes were started for a command of one"), "{message}");
    assert_eq!(said("1"), (Some(2), String::new(), vec![]));
}

#[cfg(not(feature = "mpi"))]
#[test]
fn a_program_without_mpi_says_how_to_build_one_that_has_it() {
    let done = as_one_of_two("0", &["run", "smoke"]);
    assert_eq!(done.status.code(), Some(2));
    assert!(String::from_utf8(done.stderr).unwrap().contains("--features mpi"));
    assert!(!Path::new("runs/smoke").exists());
}

/// Runs `tests/small.toml` in `out` under `mpirun` as so many processes.
#[cfg(feature = "mpi")]
fn mpirun(processes: usize, sets: &[&str], out: &Path) -> Command {
    let mut command = Command::new("mpirun");
    command
        // of Open MPI, which MPICH does not read: as root, and more processes than cores
        .envs([("OMPI_ALLOW_RUN_AS_ROOT", "1"), ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")])
        .envs([("OMPI_MCA_rmaps_base_oversubscribe", "1"), ("OMPI_MCA_mpi_yield_when_idle", "1")])
        .args(["-n", &processes.to_string(), CREEPAGE, "--quiet", "run"])
        .arg(runs::project("tests/small.toml"))
        .args(["--threads", "1", "--out"])
        .arg(out);
    sets.iter().for_each(|set| {
        command.args(["--set", set]);
    });
    command
}

#[cfg(feature = "mpi")]
mod shared {
    use super::*;
    use std::time::{Duration, Instant};

    #[track_caller]
    fn has_the_bits_of_one(processes: usize, sets: &[&str]) {
        let alone = runs::run(&runs::load(&runs::project("tests/small.toml"), sets), 1);
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        let done = mpirun(processes, sets, &out).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let shared = runs::results(&out);
        assert_eq!(alone.differing(&shared), Vec::<&str>::new());
        assert_eq!(runs::timeless(&alone.summary), runs::timeless(&shared.summary));
    }

    #[test]
    fn two_processes_leave_the_files_of_one() {
        has_the_bits_of_one(2, &["damping.mass=4000", "time.roll=0.001"]);
    }

    #[test]
    fn three_processes_with_exact_contact_and_memory_leave_the_files_of_one() {
        let mut sets = runs::kill::EXACT_WITH_MEMORY.to_vec();
        sets.push("time.roll=0.0004");
        has_the_bits_of_one(3, &sets);
    }

    #[test]
    fn four_processes_leave_the_files_of_one_of_half_a_model() {
        has_the_bits_of_one(4, &["mesh.symmetry=half", "time.roll=0.0006"]);
    }

    /// The number that the system gave process 1 of the run in `out`.
    fn process_1(out: &Path) -> String {
        let is_it = |process: &Path| {
            let read = |name| std::fs::read(process.join(name)).unwrap_or_default();
            let holds = |text: Vec<u8>, word: &str| String::from_utf8_lossy(&text).contains(word);
            let [open_mpi, others] = ["OMPI_COMM_WORLD_RANK=1\0", "PMI_RANK=1\0"];
            holds(read("cmdline"), &out.display().to_string())
                && (holds(read("environ"), open_mpi) || holds(read("environ"), others))
        };
        let mut processes = std::fs::read_dir("/proc").unwrap().map(|entry| entry.unwrap().path());
        let found = processes.find(|process| is_it(process)).unwrap();
        found.file_name().unwrap().to_str().unwrap().to_owned()
    }

    #[test]
    fn a_process_that_is_killed_ends_all_within_seconds_and_the_run_goes_on_with_another_number() {
        let sets = ["time.roll=0.004", "checkpoint.steps=50"];
        let alone = runs::run(&runs::load(&runs::project("tests/small.toml"), &sets), 1);
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        let mut running =
            mpirun(2, &sets, &out).stderr(std::process::Stdio::null()).spawn().unwrap();
        let begun = Instant::now();
        while !out.join("checkpoint.h5").exists() {
            assert!(running.try_wait().unwrap().is_none(), "the run ended before a checkpoint");
            assert!(begun.elapsed() < Duration::from_secs(60));
            std::thread::sleep(Duration::from_millis(20));
        }
        let kill = format!("kill -KILL {}", process_1(&out));
        assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
        let killed = Instant::now();
        assert!(!running.wait().unwrap().success());
        assert!(killed.elapsed() < Duration::from_secs(10), "{:?}", killed.elapsed());
        let resumed = mpirun(3, &sets, &out).arg("--resume").output().unwrap();
        assert!(resumed.status.success(), "{}", String::from_utf8_lossy(&resumed.stderr));
        assert_eq!(alone.differing(&runs::results(&out)), Vec::<&str>::new());
    }
}
