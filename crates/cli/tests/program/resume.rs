//! Runs that are ended by signals or killed go on from their checkpoints.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use output::{CHECKPOINTS, Checkpoint, HistoryFile};
use runs::kill::{BUSY, EXACT_WITH_MEMORY, KillLoop, python};
use runs::{heeding_signals, results, timeless};

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");

fn creepage(out: &Path, more: &[&str]) -> Command {
    let mut command = heeding_signals(env!("CARGO_BIN_EXE_creepage"));
    command.args(["run", CASE, "--threads", "2", "--out"]).arg(out).args(more);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn done(out: &Path, more: &[&str]) -> Output {
    let output = creepage(out, more).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    output
}

/// Short steps: the small case then runs long enough for a signal to meet it on a busy machine too.
const LONG: [&str; 2] = ["--set", "time.factor=0.15"];

/// Ends a run by a signal once it rolls, or rolls on.
fn signalled(out: &Path, signal: &str, more: &[&str]) -> Output {
    let rows = || HistoryFile::open(out.join("history.h5")).map_or(0, |h| h.rows());
    let before = rows();
    let mut run = creepage(out, more).spawn().unwrap();
    let clock = Instant::now();
    while rows() <= before {
        assert!(run.try_wait().unwrap().is_none(), "the run ended before it was stopped");
        assert!(clock.elapsed() < Duration::from_secs(120), "no rows");
        std::thread::sleep(Duration::from_millis(2));
    }
    let pid = run.id().to_string();
    assert!(Command::new("kill").args([signal, &pid]).status().unwrap().success());
    run.wait_with_output().unwrap()
}

#[test]
fn sigterm_and_ctrl_c_write_a_checkpoint_and_the_resumed_run_has_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, out) = (folder.path().join("whole"), folder.path().join("run"));
    done(&whole, &LONG);
    for (signal, more) in [("-TERM", &[][..]), ("-INT", &["--resume"])] {
        let output = signalled(&out, signal, &[&LONG[..], more].concat());
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        assert!(said(&output).contains("--resume goes on"), "{}", said(&output));
        // without a word it is neither replaced nor is that the first advice
        let taken = creepage(&out, &LONG).output().unwrap();
        let advice =
            "help: go on with it with --resume, which keeps its results; or choose another folder";
        assert!(
            taken.status.code() == Some(2) && said(&taken).contains(advice),
            "{}",
            said(&taken)
        );
        let kept = Checkpoint::read(&out.join(CHECKPOINTS[0])).unwrap();
        assert_eq!(results(&out).number("/steps"), kept.step as f64);
    }
    let resume = [&LONG[..], &["--resume"]].concat();
    done(&out, &resume);
    let (whole, found) = (results(&whole), results(&out));
    assert_eq!(whole.differing(&found), Vec::<&str>::new());
    assert_eq!(timeless(&whole.summary), timeless(&found.summary));

    // a run that is complete
    let taken = creepage(&out, &LONG).output().unwrap();
    assert!(!said(&taken).contains("--resume"), "{}", said(&taken));
    let again = done(&out, &resume);
    assert!(said(&again).contains("is complete: nothing to resume"), "{}", said(&again));
}

#[test]
fn a_run_goes_on_from_its_own_case_file_and_is_not_replaced_from_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    done(&out, &["--set", "time.roll=0.001"]);
    let case = out.join("case.toml");
    let again = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
        command.arg("run").arg(&case).arg("--out").arg(&out).args(more);
        command.output().unwrap()
    };
    let files =
        || ["case.toml", "summary.json", "history.h5"].map(|f| fs::read(out.join(f)).unwrap());
    let before = files();
    let changed = ["--resume", "--force", "--set", "friction.static=0.2"];
    for more in [&["--force"][..], &changed] {
        let output = again(more);
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains("case.toml is what is read"), "{}", said(&output));
        assert!(files() == before, "{more:?} replaced the run");
    }
    for more in [&["--resume"][..], &["--resume", "--force"]] {
        let output = again(more);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    }
}

#[test]
fn what_cannot_be_resumed_ends_with_code_2_and_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    signalled(&out, "-TERM", &LONG);
    let refused = |more: &[&str], words: &[&str]| {
        let output = creepage(&out, &[&["--resume"], &LONG[..], more].concat()).output().unwrap();
        let said = said(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        words.iter().for_each(|word| assert!(said.contains(word), "{word} is not in {said}"));
    };
    refused(&["--set", "friction.static=0.2"], &["another case", "friction.static", "--force"]);
    // Torn indexes, as a kill or a power cut can leave them.
    for name in ["fields.vtkhdf", "contact.vtkhdf", "history.h5"] {
        let whole = fs::read(out.join(name)).unwrap();
        let mut torn = whole.clone();
        let index = torn.windows(4).rposition(|mark| mark == b"EAIB").unwrap();
        torn[index + 20] ^= 0xff;
        fs::write(out.join(name), torn).unwrap();
        refused(&[], &["no checkpoint", "checkpoint.h5: cannot read", name, "checksum", "--force"]);
        fs::write(out.join(name), whole).unwrap();
    }
    for name in CHECKPOINTS {
        if out.join(name).exists() {
            fs::write(out.join(name), b"HDF").unwrap();
        }
    }
    refused(&[], &["no checkpoint", "checkpoint.h5: it is damaged", "begin the run anew"]);
    done(&out, &["--resume", "--force", "--set", "time.roll=0.001"]);
}

/// A result file that was cut short, emptied or changed is refused by its name, whichever it is; `--force`
/// then begins the run anew.
#[test]
fn a_damaged_result_file_ends_resuming_with_code_2_and_its_name_and_force_begins_anew() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let sets = [&LONG[..], &["--set", "output.probes.bar=[[0.0, 0.0]]"]].concat();
    signalled(&out, "-TERM", &sets);
    let cut = |bytes: &mut Vec<u8>, share: f64| {
        bytes.truncate((share * bytes.len() as f64) as usize);
    };
    for name in ["fields.vtkhdf", "contact.vtkhdf", "history.h5", "probes.h5"] {
        let whole = fs::read(out.join(name)).unwrap();
        for share in [0.0, 0.5, 0.56, 0.8, 0.95, 0.99] {
            let mut damaged = whole.clone();
            cut(&mut damaged, share);
            fs::write(out.join(name), damaged).unwrap();
            for _ in 0..2 {
                let output = creepage(&out, &[&["--resume"], &sets[..]].concat()).output().unwrap();
                let said = said(&output);
                assert_eq!(output.status.code(), Some(2), "{name} {share}: {said}");
                assert!(said.contains(name), "{share}: {said}");
            }
        }
        fs::write(out.join(name), whole).unwrap();
    }
    let copy = folder.path().join("copy");
    fs::create_dir(&copy).unwrap();
    for entry in fs::read_dir(&out).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), copy.join(entry.file_name())).unwrap();
    }
    fs::write(copy.join("history.h5"), []).unwrap();
    done(&copy, &[&["--resume", "--force"], &sets[..]].concat());
    let history = out.join("history.h5");
    let mut damaged = fs::read(&history).unwrap();
    let step = damaged.windows(8).rposition(|number| number == 10_f64.to_le_bytes()).unwrap();
    damaged[step] ^= 1;
    fs::write(&history, damaged).unwrap();
    let output = creepage(&out, &[&["--resume"], &sets[..]].concat()).output().unwrap();
    // a row that the checkpoint of the beginning does not need
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    for words in ["history.h5 is damaged: `step`", "the one before is"] {
        assert!(said(&output).contains(words), "{words}: {}", said(&output));
    }
}

/// The short form of `cargo xtask soak kill-loop`.
#[track_caller]
fn survives_kills(method: &[&str], seed: u64) {
    let sets = [&BUSY[..], method, &["time.roll=0.003"]].concat();
    let kill_loop = KillLoop {
        program: env!("CARGO_BIN_EXE_creepage").into(),
        case: CASE.into(),
        sets: sets.into_iter().map(str::to_owned).collect(),
        kills: 3,
        seed,
        python: python(),
    };
    let folder = tempfile::tempdir().unwrap();
    let outcome = kill_loop.run(folder.path(), &mut |_| {}).unwrap();
    assert!(outcome.kills >= 3 && outcome.runs >= 1, "{outcome:?}");
}

#[test]
fn a_penalty_run_killed_again_and_again_leaves_the_same_bits() {
    survives_kills(&[], 1);
}

#[test]
fn an_exact_run_with_memory_killed_again_and_again_leaves_the_same_bits() {
    survives_kills(&EXACT_WITH_MEMORY, 2);
}
