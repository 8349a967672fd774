//! Files of runs, damaged at random, and what the program makes of them.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use output::CHECKPOINTS;
use output::summary::Status;

use crate::chance::Chance;
use crate::{Results, load, options, results, timeless};

/// What to damage, and how often.
pub struct Trial {
    /// The program `creepage`.
    pub program: PathBuf,
    /// The case file.
    pub case: PathBuf,
    /// Mutations of the complete run, and as many of the interrupted one.
    pub mutations: usize,
    /// Where the random choices come from.
    pub seed: u64,
}

/// What was found.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Mutations that were refused with the file's name.
    pub refused: usize,
    /// Mutations without an effect on any number.
    pub without_effect: usize,
    /// Refused resumings that were repeated with `--force`.
    pub forced: usize,
    /// What is not as it must be.
    pub faults: Vec<String>,
}

impl fmt::Display for Outcome {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { refused, without_effect, forced, faults } = self;
        for fault in faults {
            writeln!(out, "FAULT: {fault}")?;
        }
        write!(
            out,
            "{refused} refused and named, {without_effect} without effect, {forced} begun anew, {} faults",
            faults.len()
        )
    }
}

/// A short run with much output and many checkpoints.
const SETS: [&str; 8] = [
    "time.roll=0.0015",
    "time.factor=0.3",
    "checkpoint.steps=40",
    "output.history_interval=1",
    "output.fields_interval=4e-6",
    "output.contact_interval=6e-7",
    "output.probes.bar=[[0.0, 0.0]]",
    "evaluate.last=0.001",
];

/// The step after which the interrupted run is stopped.
const STOP: u64 = 384;

/// Nothing that is tried takes longer on any machine.
const HANGS: Duration = Duration::from_secs(300);

/// A command that has ended, or was killed because it did not.
struct Ended {
    output: Output,
    hung: bool,
}

impl Ended {
    fn code(&self) -> Option<i32> {
        self.output.status.code()
    }

    fn said(&self) -> String {
        String::from_utf8_lossy(&self.output.stderr).into_owned()
    }

    /// Whether the words name a file, though lines may be broken within them.
    fn names(&self, file: &str) -> bool {
        let joined: String = self.said().split_whitespace().filter(|word| *word != "│").collect();
        joined.contains(file)
    }

    /// What no damage may cause.
    fn fault(&self) -> Option<String> {
        let said = self.said();
        if self.hung {
            Some("it hung".into())
        } else if said.contains("panicked") || self.code().is_none() {
            Some(format!("it broke off: {said}"))
        } else {
            None
        }
    }
}

impl Trial {
    /// Makes both runs in `folder`, damages copies of them and judges.
    ///
    /// # Errors
    /// A run that cannot be made.
    pub fn run(&self, folder: &Path, say: &mut dyn FnMut(&str)) -> Result<Outcome, String> {
        let runs = ["whole", "stopped", "killed"].map(|name| folder.join(name));
        let [whole, stopped, killed] = &runs;
        let made = self.command(&self.running(whole, &[]), folder)?;
        if made.code() != Some(0) {
            return Err(made.said());
        }
        self.stop(stopped)?;
        copy(stopped, killed)?;
        as_if_killed(killed)?;
        let mut outcome = Outcome::default();
        let mut chance = Chance(self.seed);
        let reference = self.checked(whole, folder)?;
        let expected = results(whole);
        for kind in ["complete", "interrupted"] {
            for number in 0..self.mutations {
                let run = match kind {
                    "complete" => whole,
                    _ if number % 2 == 0 => stopped,
                    _ => killed,
                };
                let out = folder.join("damaged");
                let _ = fs::remove_dir_all(&out);
                copy(run, &out)?;
                let (file, what) = mutate(&out, &mut chance)?;
                let fault = if kind == "complete" {
                    self.judge_check(&out, &file, &reference, &mut outcome)?
                } else {
                    self.judge_resume(&out, &file, &expected, &mut outcome)?
                };
                if let Some(fault) = fault {
                    let fault = format!("{kind} {number}, {file}, {what}: {fault}");
                    say(&format!("FAULT: {fault}"));
                    outcome.faults.push(fault);
                }
                if (number + 1) % 50 == 0 {
                    say(&format!("{kind}: {} mutations", number + 1));
                }
            }
        }
        Ok(outcome)
    }

    fn running(&self, out: &Path, more: &[&str]) -> Vec<String> {
        let mut words = vec!["run".to_owned(), self.case.display().to_string()];
        words.extend(["--threads", "1", "--quiet", "--out"].map(str::to_owned));
        words.push(out.display().to_string());
        words.extend(SETS.iter().flat_map(|set| ["--set".to_owned(), (*set).to_owned()]));
        words.extend(more.iter().map(|word| (*word).to_owned()));
        words
    }

    /// Runs the program, and kills it should it hang.
    fn command(&self, words: &[String], folder: &Path) -> Result<Ended, String> {
        let files = ["stdout", "stderr"].map(|name| folder.join(name));
        let [stdout, stderr] = files.each_ref().map(fs::File::create);
        let mut child = Command::new(&self.program)
            .args(words)
            .stdin(Stdio::null())
            .stdout(stdout.map_err(text)?)
            .stderr(stderr.map_err(text)?)
            .spawn()
            .map_err(text)?;
        let clock = Instant::now();
        let mut hung = false;
        let status = loop {
            if let Some(status) = child.try_wait().map_err(text)? {
                break status;
            }
            if clock.elapsed() > HANGS {
                hung = true;
                child.kill().map_err(text)?;
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        let [stdout, stderr] = files.map(fs::read);
        let output =
            Output { status, stdout: stdout.map_err(text)?, stderr: stderr.map_err(text)? };
        Ok(Ended { output, hung })
    }

    /// Leaves a run that was interrupted, at the same step every time.
    fn stop(&self, out: &Path) -> Result<(), String> {
        let stop = AtomicBool::new(false);
        let observe = &mut |progress: &creepage::scenario::Progress| {
            stop.store(progress.step >= STOP, Ordering::Relaxed);
        };
        let summary =
            creepage::run::run(&load(&self.case, &SETS), &options(out, 1), &stop, observe);
        match summary.map_err(text)?.status {
            Some(Status::Interrupted) => Ok(()),
            status => Err(format!("the run to be interrupted ended as {status:?}")),
        }
    }

    fn checked(&self, out: &Path, folder: &Path) -> Result<Ended, String> {
        let out = out.display().to_string();
        let words = ["check", &out, "--json"].map(str::to_owned);
        self.command(&words, folder)
    }

    /// The same numbers, or a refusal that names the file.
    fn judge_check(
        &self,
        out: &Path,
        file: &str,
        reference: &Ended,
        outcome: &mut Outcome,
    ) -> Result<Option<String>, String> {
        let ended = self.checked(out, out.parent().unwrap_or(out))?;
        if let Some(fault) = ended.fault() {
            return Ok(Some(fault));
        }
        if ended.code() == Some(2) && ended.names(file) {
            outcome.refused += 1;
        } else if ended.code() == reference.code() && ended.output.stdout == reference.output.stdout
        {
            outcome.without_effect += 1;
        } else {
            return Ok(Some(format!("check ended with {:?}: {}", ended.code(), ended.said())));
        }
        Ok(None)
    }

    /// The same bits in the end, or a refusal that names the file and can be overcome.
    fn judge_resume(
        &self,
        out: &Path,
        file: &str,
        expected: &Results,
        outcome: &mut Outcome,
    ) -> Result<Option<String>, String> {
        let folder = out.parent().unwrap_or(out);
        let resume = self.command(&self.running(out, &["--resume"]), folder)?;
        if let Some(fault) = resume.fault() {
            return Ok(Some(fault));
        }
        let mut how = "--resume";
        if resume.code() == Some(2) && resume.names(file) {
            outcome.refused += 1;
            how = "--resume --force";
            let forced = self.command(&self.running(out, &["--resume", "--force"]), folder)?;
            if forced.code() != Some(0) {
                let (code, said) = (forced.code(), forced.said());
                return Ok(Some(format!("{how} ended with {code:?}: {said}")));
            }
            outcome.forced += 1;
        } else if resume.code() == Some(0) {
            outcome.without_effect += 1;
        } else {
            return Ok(Some(format!("{how} ended with {:?}: {}", resume.code(), resume.said())));
        }
        let found = results(out);
        let differing = expected.differing(&found);
        if !differing.is_empty() || timeless(&expected.summary) != timeless(&found.summary) {
            return Ok(Some(format!("{how} left other results: {}", differing.join(", "))));
        }
        Ok(None)
    }
}

/// Makes of an interrupted run one that was killed after it had written more than its last checkpoint knows.
fn as_if_killed(out: &Path) -> Result<(), String> {
    fs::remove_file(out.join("summary.json")).map_err(text)?;
    let [newest, before] = CHECKPOINTS.map(|name| out.join(name));
    fs::rename(before, newest).map_err(text)?;
    let log = fs::read_to_string(out.join("run.log")).map_err(text)?;
    let lines: Vec<&str> = log.lines().collect();
    let kept = &lines[..lines.len().saturating_sub(1)];
    fs::write(out.join("run.log"), kept.join("\n") + "\n").map_err(text)
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    fs::create_dir_all(to).map_err(text)?;
    for entry in fs::read_dir(from).map_err(text)? {
        let entry = entry.map_err(text)?;
        fs::copy(entry.path(), to.join(entry.file_name())).map_err(text)?;
    }
    Ok(())
}

/// Damages one file; returns its name and what was done.
fn mutate(out: &Path, chance: &mut Chance) -> Result<(String, String), String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(out).map_err(text)? {
        let entry = entry.map_err(text)?;
        if entry.metadata().map_err(text)?.len() > 0 {
            names.push(entry.file_name().to_string_lossy().into_owned());
        }
    }
    names.sort();
    let name = chance.one_of(&names).clone();
    let path = out.join(&name);
    let mut bytes = fs::read(&path).map_err(text)?;
    let length = bytes.len();
    let at = chance.below(length as u64) as usize;
    let block = (*chance.one_of(&[16, 512, 4096])).min(length);
    let place = |chance: &mut Chance| chance.below((length - block + 1) as u64) as usize;
    let (first, second) = (place(chance), place(chance));
    let what = match chance.below(8) {
        0 => {
            bytes.truncate(at);
            format!("cut to {at} of {length} bytes")
        }
        1 => {
            bytes.clear();
            "emptied".into()
        }
        2 => {
            bytes[at] ^= 1 << chance.below(8);
            format!("a bit of byte {at} flipped")
        }
        3 => {
            bytes[at] = chance.draw() as u8;
            format!("byte {at} changed")
        }
        4 => {
            bytes[first..first + block].fill(0);
            format!("{block} bytes from {first} zeroed")
        }
        5 => {
            let moved = bytes[first..first + block].to_vec();
            bytes.copy_within(second..second + block, first);
            bytes[second..second + block].copy_from_slice(&moved);
            format!("{block} bytes at {first} and {second} swapped")
        }
        6 => {
            bytes.copy_within(first..first + block, second);
            format!("{block} bytes of {first} doubled at {second}")
        }
        _ => {
            fs::remove_file(&path).map_err(text)?;
            return Ok((name, "deleted".into()));
        }
    };
    fs::write(&path, bytes).map_err(text)?;
    Ok((name, what))
}

fn text(error: impl fmt::Display) -> String {
    error.to_string()
}
