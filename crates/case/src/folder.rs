//! The folder of a run: taken only when it is free, or given up by `--force`.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use miette::Diagnostic;
use thiserror::Error;

use crate::schema::Case;
use output::CHECKPOINTS;

/// The resolved case of a run.
pub const CASE_FILE: &str = "case.toml";

/// The files that a run writes; `--force` removes these and nothing else.
pub const RUN_FILES: [&str; 9] = [
    CASE_FILE,
    "fields.vtkhdf",
    "contact.vtkhdf",
    "history.h5",
    "probes.h5",
    "summary.json",
    "run.log",
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

/// Refuses a folder that holds anything, unless `force`; touches nothing.
pub fn check(folder: &Path, force: bool) -> Result<(), FolderError> {
    let path = || folder.to_path_buf();
    match fs::metadata(folder) {
        Ok(found) if !found.is_dir() => Err(FolderError::NotAFolder { path: path() }),
        Ok(_) => {
            let unwritable = |cause| FolderError::NotWritable { path: path(), cause };
            let occupied = fs::read_dir(folder).map_err(unwritable)?.next().is_some();
            if occupied && !force {
                let run = RUN_FILES.iter().any(|file| folder.join(file).exists());
                return Err(FolderError::Taken { path: path(), run });
            }
            Ok(())
        }
        Err(_) => Ok(()),
    }
}

/// Makes `folder` ready for a run: it exists, is writable and holds no run.
///
/// A folder that holds anything is refused without `force`; with it only [`RUN_FILES`] are
/// removed, so that notes and figures beside a run survive; [`CASE_FILE`] is the run's to replace.
pub fn prepare(folder: &Path, force: bool) -> Result<(), FolderError> {
    let unwritable =
        |cause: io::Error| FolderError::NotWritable { path: folder.to_path_buf(), cause };
    check(folder, force)?;
    fs::create_dir_all(folder).map_err(unwritable)?;
    prove_writable(folder).map_err(unwritable)?;
    // with what a kill left half-written; the case itself is replaced at once, so that at any kill
    // there is one that says what the folder is of
    let files = RUN_FILES.iter().flat_map(|file| [(*file).to_owned(), format!("{file}.partial")]);
    for file in files.filter(|file| file != CASE_FILE) {
        match fs::remove_file(folder.join(file)) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(unwritable(cause)),
            _ => {}
        }
    }
    Ok(())
}

/// Permission bits do not tell (read-only mounts, full disks): only writing does.
fn prove_writable(folder: &Path) -> io::Result<()> {
    let probe = folder.join(format!(".creepage-{}", std::process::id()));
    fs::write(&probe, b"creepage")?;
    fs::remove_file(&probe)
}
