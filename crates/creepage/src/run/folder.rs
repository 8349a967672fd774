//! The folder of a run: used only when it is free, or when `--force` lets its run be replaced.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use miette::Diagnostic;
use output::files::made::among;
use thiserror::Error;

use crate::case::schema::Case;
use crate::run::derived;
use crate::run::held::{FolderLock, LOCK, hold};
use output::CHECKPOINTS;
pub use output::VTKHDF;
use output::layout::file;
use output::{GridFile, HistoryFile};

/// Prefix of the files that are written to prove a folder writable; a kill leaves one behind.
const PROBE: &str = ".creepage-";

/// Suffix of files that are not yet complete.
const PARTIAL: &str = ".partial";

/// The files that a run writes; `--force` removes these, what was made from them, and nothing else. It
/// does so in this order: a kill meanwhile must leave neither a summary of a run that has ended nor a
/// checkpoint beside results that are gone.
pub const RUN_FILES: [&str; 10] = [
    file::CASE,
    file::LOG,
    file::SUMMARY,
    CHECKPOINTS[0],
    CHECKPOINTS[1],
    file::FIELDS,
    file::CONTACT,
    file::HISTORY,
    file::PROBES,
    file::POSTMORTEM,
];

/// Why a run folder cannot be used.
#[derive(Debug, Error, Diagnostic)]
pub enum FolderError {
    /// There is a run, or something else, in the folder.
    #[error("{} already holds {}", path.display(), if *run { "a run" } else { "other files" })]
    #[diagnostic(help(
        "{}choose another folder with --out DIR, or replace the run with --force",
        if *goes_on { "go on with it with --resume, which keeps its results; or " } else { "" }
    ))]
    Taken {
        /// The folder.
        path: PathBuf,
        /// Whether files of a run are among its content.
        run: bool,
        /// Whether it holds a checkpoint, from which the run can go on.
        goes_on: bool,
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
    /// Another process writes the run or the sweep in the folder.
    #[error("another process is at work in {}", path.display())]
    #[diagnostic(help("wait for it, or stop it, or choose another folder with --out DIR"))]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// The folder is no longer this process's.
    #[error(
        "{}: run.lock is gone, or another's: this process no longer has the folder to itself and has \
         stopped", path.display()
    )]
    #[diagnostic(help(
        "where no other process has written there, --resume goes on; else begin the run anew with --force"
    ))]
    Lost {
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

/// What a folder holds, as far as runs are concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    /// No folder, or nothing in it.
    Nothing,
    /// What a run leaves that was killed before it could say of which case it is.
    Beginning,
    /// A run.
    Run,
    /// Something else.
    Other,
}

/// Whether `folder` holds a run of this program, and not files of the same names that somebody wrote there: a run
/// leaves its lock behind, and the program's name in its results.
pub fn is_run(folder: &Path) -> bool {
    let ours = |file: &&str| output::is_ours(&folder.join(file));
    content(folder) == Content::Run && (folder.join(LOCK).exists() || RUN_FILES.iter().any(ours))
}

/// Whether `path` is a file of a run, which no other command may replace.
pub fn is_of_a_run(path: &Path) -> bool {
    let named = path.file_name().is_some_and(|name| RUN_FILES.iter().any(|file| name == *file));
    named && path.parent().is_some_and(|folder| folder.join(LOCK).exists())
}

/// Refuses to replace the run in `folder` where one of its files is among `inputs`.
///
/// # Errors
/// [`FolderError::Input`].
pub fn refuse_inputs(folder: &Path, inputs: &[PathBuf]) -> Result<(), FolderError> {
    let files = RUN_FILES.map(|file| folder.join(file));
    match among(inputs, &files) {
        Some(path) => Err(FolderError::Input { path: path.to_path_buf() }),
        None => Ok(()),
    }
}

/// What `folder` holds; what cannot be listed counts as nothing.
pub(crate) fn content(folder: &Path) -> Content {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let names: Vec<_> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    let is = |name: &str| names.iter().any(|other| other == name);
    let held = is(LOCK);
    // a run takes its lock before it begins its log: a log without a lock is somebody else's file
    let left = |name: &String| {
        name == LOCK || (name == file::LOG && held) || name.starts_with(PROBE) || is_partial(name)
    };
    if names.is_empty() {
        Content::Nothing
    } else if RUN_FILES.iter().any(|file| is(file) && !(*file == file::LOG && held)) {
        Content::Run
    } else if names.iter().all(left) {
        Content::Beginning
    } else {
        Content::Other
    }
}

/// Whether the run in `folder` has written nothing but its case, its log and files without a record.
pub(crate) fn has_no_results(folder: &Path) -> bool {
    let is_bare = |name: &str| {
        let path = folder.join(name);
        match name {
            file::CASE | file::LOG => true,
            file::FIELDS | file::CONTACT => {
                GridFile::open(path).is_ok_and(|grid| grid.steps() == 0)
            }
            file::HISTORY => HistoryFile::open(path).is_ok_and(|history| history.rows() == 0),
            _ => false,
        }
    };
    RUN_FILES.iter().all(|name| !folder.join(name).exists() || is_bare(name))
}

/// Whether a name is that of a run's file that is not yet complete.
fn is_partial(name: &str) -> bool {
    name.strip_suffix(PARTIAL).is_some_and(|name| RUN_FILES.contains(&name))
}

/// Checks that a run can begin in `folder`: it can be written to, or made, and holds nothing; with `force` it may hold
/// something. Leaves nothing behind.
///
/// # Errors
/// A folder that fails the check.
pub fn check(folder: &Path, force: bool) -> Result<(), FolderError> {
    let path = || folder.to_path_buf();
    match fs::metadata(folder) {
        Ok(found) if !found.is_dir() => Err(FolderError::NotAFolder { path: path() }),
        Ok(_) => {
            let unwritable = |cause| FolderError::NotWritable { path: path(), cause };
            fs::read_dir(folder).map_err(unwritable)?;
            let content = content(folder);
            if matches!(content, Content::Run | Content::Other) && !force {
                let run = content == Content::Run;
                let goes_on = run && CHECKPOINTS.iter().any(|name| folder.join(name).exists());
                return Err(FolderError::Taken { path: path(), run, goes_on });
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

/// Makes `folder` ready for a run: it exists, is writable, holds no run and is locked; `held` is the lock where the
/// caller has it already.
///
/// A folder that holds anything is refused without `force`. With it, [`RUN_FILES`] and the checks, pages and figures
/// that this program made from them are removed, and everything else stays; [`file::CASE`] stays too, for the run to
/// replace. What is left of a run that was killed as it began is removed also without `force`.
///
/// # Errors
/// A folder that holds something, that another process works in, or that cannot be written to.
pub fn prepare(
    folder: &Path,
    force: bool,
    held: Option<FolderLock>,
) -> Result<FolderLock, FolderError> {
    let unwritable =
        |cause: io::Error| FolderError::NotWritable { path: folder.to_path_buf(), cause };
    check(folder, force)?;
    if let Some(file) = RUN_FILES.iter().find(|file| folder.join(file).exists())
        && content(folder) == Content::Run
        && !is_run(folder)
    {
        return Err(FolderError::Foreign { path: folder.to_path_buf(), file });
    }
    fs::create_dir_all(folder).map_err(unwritable)?;
    let held = held.map_or_else(|| take(folder), Ok)?;
    // checked again under the lock: another process may just have been here
    check(folder, force)?;
    // the run replaces the case in one step, so that after any kill the folder says of which case it is
    RUN_FILES
        .iter()
        .filter(|file| **file != file::CASE)
        .try_for_each(|file| remove(folder, file))?;
    derived::remove(folder).map_err(unwritable)?;
    Ok(held)
}

/// Locks `folder`, which must exist, and removes incomplete files that a kill left.
pub(crate) fn take(folder: &Path) -> Result<FolderLock, FolderError> {
    let held = hold(folder)?;
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut left = names.filter(|name| name.starts_with(PROBE) || is_partial(name));
    left.try_for_each(|name| remove(folder, &name))?;
    Ok(held)
}

/// Removes a file of `folder` if it is there.
fn remove(folder: &Path, name: &str) -> Result<(), FolderError> {
    match fs::remove_file(folder.join(name)) {
        Err(cause) if cause.kind() != io::ErrorKind::NotFound => {
            Err(FolderError::NotWritable { path: folder.to_path_buf(), cause })
        }
        _ => Ok(()),
    }
}

/// Permission bits do not tell (read-only mounts, full disks): only writing does.
fn prove_writable(folder: &Path) -> io::Result<()> {
    static PROBES: AtomicUsize = AtomicUsize::new(0);
    let number = PROBES.fetch_add(1, Ordering::Relaxed);
    let probe = folder.join(format!("{PROBE}{}-{number}", std::process::id()));
    let written = fs::write(&probe, b"creepage");
    // removed also where a full disk took only a part of it
    let removed = fs::remove_file(&probe);
    written.and(removed)
}
