//! Runs that are killed at random moments and resumed, against one that is not.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use creepage::run::folder::RUN_FILES;
use output::{CHECKPOINTS, Checkpoint, GridFile, HistoryFile};

use crate::chance::Chance;
use crate::{project, results, timeless};

/// What to kill, and how often.
pub struct KillLoop {
    /// The program `creepage`.
    pub program: PathBuf,
    /// The case file.
    pub case: PathBuf,
    /// Keys laid over it (`KEY=VALUE`).
    pub sets: Vec<String>,
    /// Kills in all.
    pub kills: usize,
    /// Where the random moments come from.
    pub seed: u64,
    /// A Python with h5py, which then opens the files too.
    pub python: Option<PathBuf>,
}

/// What was found.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// Kills while the process ran.
    pub kills: usize,
    /// Runs that came to their end and were compared.
    pub runs: usize,
    /// Kills before the first checkpoint.
    pub early: usize,
    /// Files opened and read after kills.
    pub opened: usize,
    /// Wall time of the undisturbed run (s).
    pub reference_s: f64,
}

/// The keys of a friction with memory, enforced exactly; the loop is run for penalty and for this.
pub const EXACT_WITH_MEMORY: [&str; 6] = [
    "contact.enforcement=exact",
    "friction.law=exponential",
    "friction.static=0.5",
    "friction.dynamic=0.32",
    "friction.decay=6.0",
    "friction.memory.distance=2e-6",
];

/// Much output and many checkpoints, so that kills meet both.
pub const BUSY: [&str; 7] = [
    "checkpoint.steps=25",
    "output.history_interval=1",
    "output.fields_interval=2e-6",
    "output.contact_interval=3e-7",
    "output.probes.bar=[[0.0, 0.0], [0.001, 0.001]]",
    "output.probes.disk=[[0.001, 0.0]]",
    "output.window=[{ from = 10e-6, to = 14e-6 }]",
];

/// A Python that has h5py, if there is one: `$CREEPAGE_PYTHON`, or else `python3`.
pub fn python() -> Option<PathBuf> {
    let asked = std::env::var_os("CREEPAGE_PYTHON").filter(|path| !path.is_empty());
    let asked = asked.map(PathBuf::from);
    let python = asked.unwrap_or_else(|| "python3".into());
    let has = Command::new(&python).args(["-c", "import h5py"]).stderr(Stdio::null()).status();
    has.is_ok_and(|status| status.success()).then_some(python)
}

impl KillLoop {
    /// Kills and resumes in `folder`.
    ///
    /// # Errors
    /// What is not as it must be: a file that cannot be read after a kill, a run that cannot be
    /// resumed, a bit that differs at the end.
    pub fn run(&self, folder: &Path, say: &mut dyn FnMut(&str)) -> Result<Outcome, String> {
        let mut chance = Chance(self.seed);
        let reference = folder.join("reference");
        let clock = Instant::now();
        let ended = self.command(&reference, 2).output().map_err(text)?;
        if !ended.status.success() {
            return Err(String::from_utf8_lossy(&ended.stderr).into_owned());
        }
        let wall = clock.elapsed();
        let whole = results(&reference);
        let mut outcome = Outcome { reference_s: wall.as_secs_f64(), ..Outcome::default() };
        while outcome.kills < self.kills {
            let out = folder.join(format!("killed-{}", outcome.runs));
            self.one(&out, wall, &mut chance, &mut outcome)?;
            let found = results(&out);
            let differing = whole.differing(&found);
            if !differing.is_empty() {
                return Err(format!("{} differs in {}", out.display(), differing.join(", ")));
            }
            if timeless(&whole.summary) != timeless(&found.summary) {
                return Err(format!("the summary of {} differs", out.display()));
            }
            self.with_h5py(&[&out, &reference])?;
            outcome.runs += 1;
            say(&format!("{} kills, {} runs, all the same bits", outcome.kills, outcome.runs));
            fs::remove_dir_all(&out).map_err(text)?;
        }
        Ok(outcome)
    }

    /// One run to its end, through as many kills as it takes.
    fn one(
        &self,
        out: &Path,
        wall: Duration,
        chance: &mut Chance,
        outcome: &mut Outcome,
    ) -> Result<(), String> {
        loop {
            let mut command = self.command(out, 1 + chance.below(3));
            let begun = RUN_FILES.iter().any(|file| out.join(file).exists());
            command.arg(if begun { "--resume" } else { "--force" });
            let mut run = command.stderr(Stdio::piped()).spawn().map_err(text)?;
            // Once there are enough kills the run may end in peace.
            if outcome.kills < self.kills {
                std::thread::sleep(wall.mul_f64(0.9 * chance.fraction()));
            } else {
                let _ = run.wait();
            }
            match run.try_wait().map_err(text)? {
                Some(status) if status.success() => return Ok(()),
                Some(status) => {
                    let said = run.wait_with_output().map_err(text)?;
                    let said = String::from_utf8_lossy(&said.stderr).into_owned();
                    return Err(format!("{} ended with {status}: {said}", out.display()));
                }
                None => {}
            }
            run.kill().map_err(text)?;
            run.wait().map_err(text)?;
            outcome.kills += 1;
            outcome.early += usize::from(!CHECKPOINTS.iter().any(|name| out.join(name).exists()));
            outcome.opened += open_all(out).map_err(|e| format!("kill {}: {e}", outcome.kills))?;
            self.with_h5py(&[out]).map_err(|e| format!("kill {}: {e}", outcome.kills))?;
        }
    }

    fn command(&self, out: &Path, threads: u64) -> Command {
        let mut command = Command::new(&self.program);
        command.arg("run").arg(&self.case).arg("--out").arg(out).arg("--quiet");
        command.args(["--threads", &threads.to_string()]);
        self.sets.iter().for_each(|set| {
            command.args(["--set", set]);
        });
        command
    }

    /// Reads a run with libhdf5, and compares it with another.
    fn with_h5py(&self, runs: &[&Path]) -> Result<(), String> {
        let Some(python) = &self.python else { return Ok(()) };
        let script = project("tests/python/check_same.py");
        let done = Command::new(python).arg(script).args(runs).output().map_err(text)?;
        if done.status.success() {
            return Ok(());
        }
        Err([done.stdout, done.stderr].map(|s| String::from_utf8_lossy(&s).into_owned()).concat())
    }
}

/// Opens every file of a run that is there and reads all of it; returns how many there were.
pub fn open_all(out: &Path) -> Result<usize, String> {
    let mut opened = 0;
    for name in RUN_FILES {
        let path = out.join(name);
        if !path.exists() {
            continue;
        }
        if CHECKPOINTS.contains(&name) {
            Checkpoint::read(&path).map_err(text)?;
        } else if name.ends_with(".vtkhdf") {
            let file = GridFile::open(&path).map_err(text)?;
            for field in file.fields() {
                let steps = if field.constant { 0..1 } else { 0..file.steps() };
                file.read_steps(&field.name, field.on_cells, steps).map_err(text)?;
            }
        } else if name.ends_with(".h5") {
            let file = HistoryFile::open(&path).map_err(text)?;
            for column in file.columns().map_err(text)? {
                file.read(&column).map_err(text)?;
            }
        } else {
            continue;
        }
        opened += 1;
    }
    Ok(opened)
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}
