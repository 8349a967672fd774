//! The folder of a run: taken only when it is free, or given up by `--force`.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use files::output::among;
use miette::Diagnostic;
use thiserror::Error;

use crate::derived;
use crate::postmortem::POSTMORTEM;
use crate::schema::Case;
use output::CHECKPOINTS;
pub use output::VTKHDF;

/// The resolved case of a run.
pub const CASE_FILE: &str = "case.toml";

/// Held locked while a run is written; stays behind, empty.
const LOCK: &str = "run.lock";

/// The files that a run writes; `--force` removes these, what was made from them, and nothing else.
pub const RUN_FILES: [&str; 10] = [
    CASE_FILE,
    "fields.vtkhdf",
    "contact.vtkhdf",
    "history.h5",
    "probes.h5",
    "summary.json",
    "run.log",
    POSTMORTEM,
    CHECKPOINTS[0],
    CHECKPOINTS[1],
];

/// Why a run folder cannot be used.
#[derive(Debug, Error, Diagnostic)]
pub enum FolderError {
    /// There is a run, or something else, in the folder.
    #[error("{} already holds {}", path.display(), if *run { "a run" } else { "other files" })]
    #[diagnostic(help("choose another folder with --out DIR, or replace the run with --force"))]
    Taken {
        /// The folder.
        path: PathBuf,
        /// Whether files of a run are among its content.
        run: bool,
    },
    /// What is to be replaced is no run of this program.
    #[error(
        "{} holds {file}, but no run of this program: that file is not replaced", path.display()
    )]
    #[diagnostic(help("choose another folder with --out DIR, or move the file away"))]
    Foreign {
        /// The folder.
        path: PathBuf,
        /// The file.
        file: &'static str,
    },
    /// What is to be replaced is read by the same command.
    #[error("{} is what is read: it is not replaced", path.display())]
    #[diagnostic(help(
        "choose another folder with --out DIR, or go on with the run with --resume"
    ))]
    Input {
        /// The file.
        path: PathBuf,
    },
    /// Another process writes the run in the folder.
    #[error("another process is at work in {}", path.display())]
    #[diagnostic(help("wait for it, or stop it, or choose another folder with --out DIR"))]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// The path is a file.
    #[error("{} is a file, not a folder", path.display())]
    #[diagnostic(help("choose a folder with --out DIR"))]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// The folder cannot be made or written to.
    #[error("{} is not writable: {cause}", path.display())]
    #[diagnostic(help("choose a folder that you may write to with --out DIR"))]
    NotWritable {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        cause: io::Error,
    },
}

/// The folder of a case where none is asked for: `runs/<name>`.
pub fn default_folder(case: &Case) -> PathBuf {
    Path::new("runs").join(&case.name)
}

/// Whether a run has been begun in `folder`.
pub fn has_run(folder: &Path) -> bool {
    RUN_FILES.iter().any(|file| folder.join(file).exists())
}

/// Whether the files of a run in `folder` are of a run of this program, and not a case that somebody
/// wrote there: a run leaves its lock behind, and its name in its results.
pub fn is_run(folder: &Path) -> bool {
    let ours = |file: &&str| output::is_ours(&folder.join(file));
    has_run(folder) && (folder.join(LOCK).exists() || RUN_FILES.iter().any(ours))
}

/// Whether a file is one of a run's own, which nothing but the run may replace.
pub fn is_of_a_run(path: &Path) -> bool {
    let named = path.file_name().is_some_and(|name| RUN_FILES.iter().any(|file| name == *file));
    named && path.parent().is_some_and(|folder| folder.join(LOCK).exists())
}

/// Refuses to replace the run in `folder` where one of its files is among `inputs`.
pub fn spare(folder: &Path, inputs: &[PathBuf]) -> Result<(), FolderError> {
    let files = RUN_FILES.map(|file| folder.join(file));
    match among(inputs, &files) {
        Some(path) => Err(FolderError::Input { path: path.to_path_buf() }),
        None => Ok(()),
    }
}

/// A folder in which no other process writes a run as long as this lives.
#[derive(Debug)]
pub struct Held {
    _lock: Option<File>,
}

/// Keeps other processes out of `folder`, which is there. The system lets go of it however this process
/// ends. Where it has no locks, as on some network disks, nobody is kept out.
pub fn hold(folder: &Path) -> Result<Held, FolderError> {
    let path = || folder.to_path_buf();
    let file = File::options().create(true).append(true).open(folder.join(LOCK));
    let file = file.map_err(|cause| FolderError::NotWritable { path: path(), cause })?;
    match file.try_lock() {
        Ok(()) => Ok(Held { _lock: Some(file) }),
        Err(TryLockError::WouldBlock) => Err(FolderError::Busy { path: path() }),
        Err(TryLockError::Error(_)) => Ok(Held { _lock: None }),
    }
}

/// Refuses a folder that cannot be written to, or in which a run cannot be begun because it holds
/// anything, unless `force`; leaves nothing behind.
pub fn check(folder: &Path, force: bool) -> Result<(), FolderError> {
    let path = || folder.to_path_buf();
    match fs::metadata(folder) {
        Ok(found) if !found.is_dir() => Err(FolderError::NotAFolder { path: path() }),
        Ok(_) => {
            let unwritable = |cause| FolderError::NotWritable { path: path(), cause };
            let others = |name: &std::ffi::OsStr| name != LOCK;
            let mut found = fs::read_dir(folder).map_err(unwritable)?;
            if found.any(|entry| entry.is_ok_and(|e| others(&e.file_name()))) && !force {
                return Err(FolderError::Taken { path: path(), run: has_run(folder) });
            }
            prove_writable(folder).map_err(unwritable)
        }
        Err(_) => {
            let there = folder.ancestors().skip(1).find(|place| place.is_dir());
            let there = there.unwrap_or(Path::new("."));
            prove_writable(there).map_err(|cause| FolderError::NotWritable { path: path(), cause })
        }
    }
}

/// Makes `folder` ready for a run: it exists, is writable and holds no run.
///
/// A folder that holds anything is refused without `force`; with it only [`RUN_FILES`] and the checks, pages
/// and figures that this program made from them are removed, so that anything else beside a run survives;
/// [`CASE_FILE`] is the run's to replace.
pub fn prepare(folder: &Path, force: bool) -> Result<Held, FolderError> {
    let unwritable =
        |cause: io::Error| FolderError::NotWritable { path: folder.to_path_buf(), cause };
    check(folder, force)?;
    if let Some(file) = RUN_FILES.iter().find(|file| folder.join(file).exists())
        && !is_run(folder)
    {
        return Err(FolderError::Foreign { path: folder.to_path_buf(), file });
    }
    fs::create_dir_all(folder).map_err(unwritable)?;
    let held = hold(folder)?;
    // looked at again: another process may just have been here
    check(folder, force)?;
    // with what a kill left half-written; the case itself is replaced at once, so that at any kill
    // there is one that says what the folder is of
    let files = RUN_FILES.iter().flat_map(|file| [(*file).to_owned(), format!("{file}.partial")]);
    for file in files.filter(|file| file != CASE_FILE) {
        match fs::remove_file(folder.join(file)) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(unwritable(cause)),
            _ => {}
        }
    }
    derived::remove(folder).map_err(unwritable)?;
    Ok(held)
}

/// Permission bits do not tell (read-only mounts, full disks): only writing does.
fn prove_writable(folder: &Path) -> io::Result<()> {
    static PROBES: AtomicUsize = AtomicUsize::new(0);
    let number = PROBES.fetch_add(1, Ordering::Relaxed);
    let probe = folder.join(format!(".creepage-{}-{number}", std::process::id()));
    let written = fs::write(&probe, b"creepage");
    // also what a full disk has let in
    let removed = fs::remove_file(&probe);
    written.and(removed)
}
