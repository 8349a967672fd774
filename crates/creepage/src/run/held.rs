//! One process at a time in the folder of a run.
//!
//! Three things keep a second one out: a lock on the folder itself, which nobody can delete; a lock on
//! `run.lock`, for systems that cannot lock folders; and, for those that cannot lock at all, the identity of the
//! process that holds the folder, written in `run.lock`. The holder checks from time to time that the file and the
//! identity are still its own ([`FolderLock::prove`]): where nothing kept a second process out, the first one stops.

use std::fs::{self, File, Metadata, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::SystemTime;

use output::files::input;

use crate::run::folder::FolderError;

/// Locked while a run is written, with the identity of its holder in it; stays behind, empty.
pub(crate) const LOCK: &str = "run.lock";

/// The lock of a folder: no other process writes a run there until it is dropped.
#[derive(Debug)]
pub struct FolderLock {
    folder: PathBuf,
    lock: File,
    /// The identity in the file; none where a full disk had no room for it.
    identity: Option<String>,
    _folder: Option<File>,
}

/// Locks `folder`, which must exist, against other processes. The system frees the lock however this process ends.
///
/// # Errors
/// [`FolderError::Busy`] where another process holds it, [`FolderError::NotWritable`] where the lock cannot be made.
pub fn hold(folder: &Path) -> Result<FolderLock, FolderError> {
    let busy = || FolderError::Busy { path: folder.to_path_buf() };
    let unwritable = |cause| FolderError::NotWritable { path: folder.to_path_buf(), cause };
    #[expect(clippy::disallowed_methods, reason = "a folder, of which nothing is read")]
    let own = File::open(folder);
    let own = match own.map(|own| own.try_lock().map(|()| own)) {
        Ok(Ok(own)) => Some(own),
        Ok(Err(TryLockError::WouldBlock)) => return Err(busy()),
        // a system that does not lock folders
        Ok(Err(TryLockError::Error(_))) | Err(_) => None,
    };
    let mut options = File::options();
    options.create(true).read(true).write(true).truncate(false);
    let mut lock = options.open(folder.join(LOCK)).map_err(unwritable)?;
    match lock.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => return Err(busy()),
        Err(TryLockError::Error(_)) => {
            let mut theirs = String::new();
            if lock.read_to_string(&mut theirs).is_ok() && Holder::parse(&theirs).lives() {
                return Err(busy());
            }
        }
    }
    let identity = Holder::own().to_string();
    let written = write(&mut lock, &identity).is_ok();
    Ok(FolderLock {
        folder: folder.into(),
        lock,
        identity: written.then_some(identity),
        _folder: own,
    })
}

impl FolderLock {
    /// Checks that the folder is still this process's: its `run.lock` is the file that was locked, with the identity
    /// that was written. A file that is there and cannot be read passes.
    ///
    /// # Errors
    /// [`FolderError::Lost`] where the file is gone or another one.
    pub fn check_owner(&self) -> Result<(), FolderError> {
        let path = self.folder.join(LOCK);
        let same = match (fs::metadata(&path), self.lock.metadata()) {
            (Ok(there), Ok(own)) => same(&there, &own),
            (Err(cause), _) => cause.kind() != io::ErrorKind::NotFound,
            _ => true,
        };
        let said = |identity: &String| {
            input::text(&path, input::DOCUMENT).map_or(true, |there| there == *identity)
        };
        if same && self.identity.as_ref().is_none_or(said) {
            return Ok(());
        }
        Err(FolderError::Lost { path: self.folder.clone() })
    }
}

/// The identity is removed with its holder, unless that is killed.
impl Drop for FolderLock {
    fn drop(&mut self) {
        if self.check_owner().is_ok() {
            let _ = self.lock.set_len(0);
        }
    }
}

fn write(file: &mut File, identity: &str) -> io::Result<()> {
    file.set_len(0)?;
    file.rewind()?;
    file.write_all(identity.as_bytes())
}

#[cfg(unix)]
fn same(a: &Metadata, b: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn same(_: &Metadata, _: &Metadata) -> bool {
    true
}

/// Who holds a folder: a process by the boot of its machine, its number and its start, and which of the locks that
/// it has taken.
#[derive(Debug, PartialEq)]
struct Holder {
    boot: String,
    process: String,
    started: String,
    hold: String,
}

impl Holder {
    fn own() -> Self {
        static HOLDS: AtomicUsize = AtomicUsize::new(0);
        let count = HOLDS.fetch_add(1, Ordering::Relaxed);
        let process = std::process::id().to_string();
        let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        Self {
            boot: boot(),
            started: started(&process).unwrap_or("-".into()),
            process,
            hold: format!("{}-{count}", since.as_nanos()),
        }
    }

    fn parse(text: &str) -> Self {
        let mut words = text.split_whitespace().map(str::to_owned);
        let mut next = || words.next().unwrap_or_default();
        Self { boot: next(), process: next(), started: next(), hold: next() }
    }

    /// Whether the process runs on this machine. One of another machine, of which nothing is known, counts as gone.
    fn lives(&self) -> bool {
        self.boot == boot() && started(&self.process).is_some_and(|since| since == self.started)
    }
}

impl std::fmt::Display for Holder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "{} {} {} {}", self.boot, self.process, self.started, self.hold)
    }
}

/// The identity of the machine's present boot; `-` where the system has none.
fn boot() -> String {
    let id = input::text(Path::new("/proc/sys/kernel/random/boot_id"), input::LOG);
    let id = id.unwrap_or_default();
    if id.trim().is_empty() { "-".into() } else { id.trim().into() }
}

/// When a process started, in ticks since the boot (`man 5 proc`, field 22 of its `stat`).
fn started(process: &str) -> Option<String> {
    let stat = input::text(&Path::new("/proc").join(process).join("stat"), input::LOG).ok()?;
    let (_, fields) = stat.rsplit_once(") ")?;
    fields.split(' ').nth(19).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_deleted_lock_lets_no_second_in_and_the_first_knows() {
        let folder = tempfile::tempdir().unwrap();
        let first = hold(folder.path()).unwrap();
        first.check_owner().unwrap();
        fs::remove_file(folder.path().join(LOCK)).unwrap();
        if cfg!(target_os = "linux") {
            let second = hold(folder.path());
            assert!(matches!(second, Err(FolderError::Busy { .. })), "{second:?}");
        }
        assert!(matches!(first.check_owner(), Err(FolderError::Lost { .. })));
        fs::write(folder.path().join(LOCK), first.identity.as_ref().unwrap()).unwrap();
        if cfg!(unix) {
            assert!(matches!(first.check_owner(), Err(FolderError::Lost { .. })), "another file");
        }
    }

    #[test]
    fn another_identity_in_the_lock_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let first = hold(folder.path()).unwrap();
        fs::write(folder.path().join(LOCK), Holder::own().to_string()).unwrap();
        assert!(matches!(first.check_owner(), Err(FolderError::Lost { .. })));
    }

    #[test]
    fn a_lock_that_was_let_go_is_empty_and_free() {
        let folder = tempfile::tempdir().unwrap();
        drop(hold(folder.path()).unwrap());
        assert_eq!(fs::read_to_string(folder.path().join(LOCK)).unwrap(), "");
        hold(folder.path()).unwrap().check_owner().unwrap();
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn an_identity_tells_a_living_process_from_one_that_is_gone() {
        let own = Holder::own();
        assert_eq!(Holder::parse(&own.to_string()), own);
        assert!(own.lives());
        assert!(!Holder { started: "1".into(), ..Holder::own() }.lives(), "another's number");
        assert!(!Holder { boot: "elsewhere".into(), ..Holder::own() }.lives());
        assert!(!Holder { process: "4194305".into(), ..Holder::own() }.lives(), "no such process");
        assert!(!Holder::parse("").lives());
    }
}
