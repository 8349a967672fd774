//! `run.log`.

use std::fs::File;
use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::run::progress_lines::ProgressLines;
use crate::scenario::progress::Progress;
use output::NotWritten;

/// How the last line of the log begins where a run was refused after its mesh was made.
pub const REFUSED: &str = "end: refused before rolling: ";

/// `run.log`: a line for every event of a run.
pub(crate) struct Log {
    path: PathBuf,
    file: File,
}

impl Log {
    pub(crate) fn new(path: PathBuf) -> Result<Self, NotWritten> {
        match File::create(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(cause) => Err(NotWritten { path, cause }),
        }
    }

    /// The log of a run that goes on.
    pub(crate) fn append(path: PathBuf) -> Result<Self, NotWritten> {
        match File::options().append(true).create(true).open(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(cause) => Err(NotWritten { path, cause }),
        }
    }

    /// Where a run under way writes how far it is, once in each `interval`.
    pub(crate) fn progress(&self, interval: Duration) -> Result<ProgressLog, NotWritten> {
        let lines = ProgressLines::new(interval, Instant::now());
        match self.file.try_clone() {
            Ok(file) => Ok(ProgressLog { file, lines }),
            Err(cause) => Err(NotWritten { path: self.path.clone(), cause }),
        }
    }

    /// Writes a line, and passes it on to the subscriber of `tracing`.
    pub(crate) fn say(&mut self, line: &str) -> Result<(), NotWritten> {
        tracing::info!("{line}");
        self.write(line)
    }

    /// Writes a warning, which the user sees also where other lines are not shown.
    pub(crate) fn warn(&mut self, line: &str) -> Result<(), NotWritten> {
        tracing::warn!("{line}");
        self.write(&format!("warning: {line}"))
    }

    fn write(&mut self, line: &str) -> Result<(), NotWritten> {
        writeln!(self.file, "{line}").map_err(|cause| NotWritten { path: self.path.clone(), cause })
    }
}

/// `run.log` while a run is under way.
pub(crate) struct ProgressLog {
    file: File,
    lines: ProgressLines,
}

impl ProgressLog {
    /// An observer that passes on to `observe` what it hears.
    pub(crate) fn beside(
        mut self,
        observe: &mut (dyn FnMut(&Progress) + Send),
    ) -> impl FnMut(&Progress) + Send {
        move |progress| {
            self.hear(progress);
            observe(progress);
        }
    }

    /// Writes how far the run is, where that is due. A full disk ends no run for such a line.
    fn hear(&mut self, progress: &Progress) {
        if let Some(line) = self.lines.due(progress, Instant::now()) {
            let _ = self.file.write_all(format!("{line}\n").as_bytes());
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::scenario::progress::Stage;

    const FAR: Progress = Progress {
        stage: Stage::Roll,
        step: 64,
        steps: 128,
        time: 1e-5,
        end_time: 2e-5,
        normal_force: 1e4,
        tangential_force: 1e3,
        element_steps_per_s: 1e6,
        cost: None,
    };

    #[test]
    fn how_far_a_run_is_stands_in_its_log_between_its_messages_also_when_it_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.log");
        for mut log in [Log::new(path.clone()).unwrap(), Log::append(path.clone()).unwrap()] {
            let mut progress = log.progress(Duration::ZERO).unwrap();
            log.say("begins").unwrap();
            progress.hear(&FAR);
            log.say("ends").unwrap();
        }
        let text = std::fs::read_to_string(path).unwrap();
        let begins: Vec<_> = text.lines().map(|line| line.split(' ').next().unwrap()).collect();
        assert_eq!(begins, ["begins", "step", "ends", "begins", "step", "ends"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_ends_no_run_for_a_line_that_says_how_far_it_is() {
        let mut log = Log::append("/dev/full".into()).unwrap();
        log.progress(Duration::ZERO).unwrap().hear(&FAR);
        assert!(log.say("a message of the run").is_err());
    }
}
