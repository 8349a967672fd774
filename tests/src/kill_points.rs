//! Every state of a run's folder that a kill can leave between two system calls, and what becomes of each.
//!
//! `strace` writes down what a run does to its folder. Replayed call by call, that gives the folder as a
//! kill after each call leaves it; from every such state the run must go on, or begin anew, to the
//! same bits. That the replay misses nothing shows at its end: the folder it leaves is the run's, byte for byte.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::chance::Chance;
use crate::kill::open_all;
use crate::trace::{Call, calls};
use crate::{Results, results, timeless};

/// What to kill, and where.
pub struct KillPoints {
    /// The program `creepage`.
    pub program: PathBuf,
    /// The case file.
    pub case: PathBuf,
    /// Keys laid over it (`KEY=VALUE`).
    pub sets: Vec<String>,
    /// How many states of each kind of run are tried beside the first and the last, drawn at random; all
    /// without it.
    pub sample: Option<usize>,
    /// Where the random draw comes from.
    pub seed: u64,
    /// The kind of run, `begun`, `replaced` or `resumed`; all without it.
    pub kind: Option<String>,
}

/// What was found.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// System calls that change the folder, each a point of a kill.
    pub points: usize,
    /// Those after which the folder was tried.
    pub tried: usize,
    /// Those of them from which the run began anew.
    pub anew: usize,
}

/// A run of some steps and all kinds of files, that takes tenths of a second.
pub const SHORT: [&str; 13] = [
    "mesh.zone.size=1.6e-3",
    "mesh.growth=3.0",
    "time.roll=0.00015",
    "time.factor=0.9",
    "evaluate.last=0.0001",
    "drive.ramp=0",
    "preload.method=none",
    "checkpoint.steps=6",
    "output.history_interval=1",
    "output.fields_interval=1e-6",
    "output.contact_interval=6e-7",
    "output.probes.bar=[[0.0, 0.0]]",
    "output.probes.disk=[[0.001, 0.0]]",
];

/// Calls at the beginning and at the end of a run that every sample tries.
const FIRST: usize = 14;
const LAST: usize = 6;

/// Files with their contents; none where there is no folder.
type Image = Option<BTreeMap<PathBuf, Vec<u8>>>;

/// Whether there is a `strace` that may trace.
pub fn can_trace() -> bool {
    let mut strace = Command::new("strace");
    strace.args(["-f", "-o", "/dev/null", "true"]).stdout(Stdio::null()).stderr(Stdio::null());
    strace.status().is_ok_and(|status| status.success())
}

impl KillPoints {
    /// Kills a run that begins, one that replaces another, and one that is resumed.
    ///
    /// # Errors
    /// What is not as it must be: a state that is refused, a file that cannot be read, a bit that differs.
    pub fn run(&self, folder: &Path, say: &mut dyn FnMut(&str)) -> Result<Outcome, String> {
        let folder = &folder.canonicalize().map_err(text)?;
        let out = folder.join("run");
        let mut total = Outcome::default();
        let begins = self.traced(&out, &[])?;
        let whole = results(&out);
        let complete = image(&out)?;
        // in the middle of rolling, with two checkpoints
        let two = |image: &Image| {
            image.as_ref().is_some_and(|files| files.contains_key(Path::new("checkpoint-1.h5")))
        };
        let mut state = None;
        let mut middle = None;
        for (n, call) in begins.iter().enumerate() {
            apply(&mut state, call)?;
            if two(&state) && n > begins.len() * 3 / 4 {
                middle = Some(state.clone());
                break;
            }
        }
        let middle = middle.ok_or("the run has no second checkpoint")?;
        let kinds = [
            ("begun", None, vec![]),
            ("replaced", complete, vec!["--force"]),
            ("resumed", middle, vec!["--resume"]),
        ];
        for (k, (kind, before, more)) in kinds.into_iter().enumerate() {
            if self.kind.as_ref().is_some_and(|only| only != kind) {
                continue;
            }
            put(&before, &out)?;
            let calls = self.traced(&out, &more)?;
            let found = results(&out);
            let differing = whole.differing(&found);
            if !differing.is_empty() {
                return Err(format!("{kind}, not killed: {differing:?} differ"));
            }
            let mut state = before.clone();
            calls.iter().try_for_each(|call| apply(&mut state, call))?;
            if let Some(name) = first_difference(&state, &image(&out)?) {
                return Err(format!("{kind}: the replay does not give the run's {name}"));
            }
            let chosen = self.chosen(&calls, k as u64);
            let mut state = before;
            let mut outcome = Outcome { points: calls.len(), ..Outcome::default() };
            for (n, call) in calls.iter().enumerate() {
                apply(&mut state, call)?;
                if chosen[n] {
                    let tried = self.try_state(&state, &out, &whole, &mut outcome);
                    tried.map_err(|e| format!("{kind}, killed after {}, {call}: {e}", n + 1))?;
                    if outcome.tried.is_multiple_of(100) {
                        say(&format!("{kind}: {} of {} points", outcome.tried, outcome.points));
                    }
                }
            }
            say(&format!("{kind}: {outcome:?}"));
            total.points += outcome.points;
            total.tried += outcome.tried;
            total.anew += outcome.anew;
        }
        Ok(total)
    }

    /// What becomes of a state.
    fn try_state(
        &self,
        state: &Image,
        out: &Path,
        whole: &Results,
        outcome: &mut Outcome,
    ) -> Result<(), String> {
        let empty = state.as_ref().is_none_or(BTreeMap::is_empty);
        let begun = state.as_ref().is_some_and(|files| files.contains_key(Path::new("case.toml")));
        // where nothing says of which case it is, both ways must lead on
        let ways: &[&[&str]] = match (empty, begun) {
            (true, _) => &[&[]],
            (false, false) => &[&[], &["--resume"]],
            (false, true) => &[&["--resume"]],
        };
        for more in ways {
            put(state, out)?;
            open_all(out)?;
            let ended = self.command(out, more).output().map_err(text)?;
            if !ended.status.success() {
                let said = String::from_utf8_lossy(&ended.stderr).into_owned();
                return Err(format!("{more:?} ended with {}: {said}", ended.status));
            }
            let found = results(out);
            let differing = whole.differing(&found);
            if !differing.is_empty() {
                return Err(format!("{more:?}: {} differ", differing.join(", ")));
            }
            if timeless(&whole.summary) != timeless(&found.summary) {
                return Err(format!("{more:?}: the summary differs"));
            }
            if let Some(left) = image(out)?.unwrap_or_default().keys().find(|name| is_rest(name)) {
                return Err(format!("{more:?}: {} is left behind", left.display()));
            }
        }
        outcome.tried += 1;
        let log = fs::read_to_string(out.join("run.log")).unwrap_or_default();
        outcome.anew += usize::from(!log.contains("resumed from"));
        Ok(())
    }

    /// Which of the calls are tried: in a sample the first and the last, where what a folder is changes, and
    /// of the others one half that are not writes.
    fn chosen(&self, calls: &[Call], kind: u64) -> Vec<bool> {
        let Some(sample) = self.sample else { return vec![true; calls.len()] };
        let mut chance = Chance(self.seed + kind);
        let ends = |n: usize| n < FIRST || n + LAST >= calls.len();
        let mut chosen: Vec<bool> = (0..calls.len()).map(ends).collect();
        for writes in [false, true] {
            let is = |n: &usize| matches!(calls[*n], Call::Write { .. }) == writes;
            let mut left: Vec<usize> = (0..calls.len()).filter(is).collect();
            for _ in 0..sample.div_ceil(2).min(left.len()) {
                chosen[left.swap_remove(chance.below(left.len() as u64) as usize)] = true;
            }
        }
        chosen
    }

    /// Runs under `strace`; returns what that did to `out`.
    fn traced(&self, out: &Path, more: &[&str]) -> Result<Vec<Call>, String> {
        let log = out.with_extension("strace");
        let run = self.command(out, more);
        let mut strace = Command::new("strace");
        strace.args(["-f", "-y", "-xx", "-s", "16777216", "-e", crate::trace::TRACED, "-o"]);
        strace.arg(&log).arg(run.get_program()).args(run.get_args());
        let ended = strace.output().map_err(text)?;
        if !ended.status.success() {
            return Err(String::from_utf8_lossy(&ended.stderr).into_owned());
        }
        calls(&fs::read_to_string(&log).map_err(text)?, out)
    }

    fn command(&self, out: &Path, more: &[&str]) -> Command {
        let mut command = Command::new(&self.program);
        command.arg("run").arg(&self.case).arg("--out").arg(out).args([
            "--quiet",
            "--threads",
            "1",
        ]);
        self.sets.iter().for_each(|set| {
            command.args(["--set", set]);
        });
        command.args(more);
        command
    }
}

/// Whether a file should be gone once a run is complete.
fn is_rest(name: &Path) -> bool {
    let name = name.to_string_lossy();
    name.ends_with(".partial") || name.starts_with("checkpoint") || name.starts_with(".creepage")
}

fn image(folder: &Path) -> Result<Image, String> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).map_err(text)? {
        let path = entry.map_err(text)?.path();
        let name = path.strip_prefix(folder).map_err(text)?.to_path_buf();
        files.insert(name, fs::read(&path).map_err(text)?);
    }
    Ok(Some(files))
}

fn put(image: &Image, folder: &Path) -> Result<(), String> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(text)?;
    }
    let Some(files) = image else { return Ok(()) };
    fs::create_dir(folder).map_err(text)?;
    files.iter().try_for_each(|(name, bytes)| fs::write(folder.join(name), bytes).map_err(text))
}

fn apply(image: &mut Image, call: &Call) -> Result<(), String> {
    if let Call::MakeFolder = call {
        image.get_or_insert_default();
        return Ok(());
    }
    let files = image.as_mut().ok_or_else(|| format!("{call} in a folder that is not there"))?;
    let missing = || format!("{call}: there is no such file");
    match call {
        Call::MakeFolder => {}
        Call::Create { name, truncate } => {
            let file = files.entry(name.clone()).or_default();
            if *truncate {
                file.clear();
            }
        }
        Call::Write { name, at, bytes } => {
            let file = files.get_mut(name).ok_or_else(missing)?;
            let at = at.unwrap_or(file.len());
            file.resize(file.len().max(at + bytes.len()), 0);
            file[at..at + bytes.len()].copy_from_slice(bytes);
        }
        Call::Copy { from, start, to, at, length } => {
            let source = files.get(from).ok_or_else(missing)?;
            let bytes = source.get(*start..start + length).ok_or("a copy beyond the end")?.to_vec();
            let file = files.get_mut(to).ok_or_else(missing)?;
            let at = at.unwrap_or(file.len());
            file.resize(file.len().max(at + length), 0);
            file[at..at + length].copy_from_slice(&bytes);
        }
        Call::Cut { name, length } => {
            files.get_mut(name).ok_or_else(missing)?.resize(*length, 0);
        }
        Call::Rename { from, to } => {
            let file = files.remove(from).ok_or_else(missing)?;
            files.insert(to.clone(), file);
        }
        Call::Remove { name } => {
            files.remove(name).ok_or_else(missing)?;
        }
    }
    Ok(())
}

fn first_difference(a: &Image, b: &Image) -> Option<String> {
    let (Some(a), Some(b)) = (a, b) else { return Some("folder".into()) };
    let mut names = a.keys().chain(b.keys());
    names.find(|name| a.get(*name) != b.get(*name)).map(|name| name.display().to_string())
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}
