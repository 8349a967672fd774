//! Free space on the disk.

use std::path::Path;

/// Bytes that may still be written where `path` is or would be; `None` where the system does not say.
pub fn free_space(path: &Path) -> Option<u64> {
    let there = path.ancestors().find(|place| place.exists()).filter(|p| *p != Path::new(""));
    room(there.unwrap_or(Path::new(".")))
}

#[cfg(unix)]
fn room(place: &Path) -> Option<u64> {
    let found = rustix::fs::statvfs(place).ok()?;
    Some(found.f_bavail.saturating_mul(found.f_frsize))
}

#[cfg(not(unix))]
fn room(_: &Path) -> Option<u64> {
    None
}

/// The most that a file of this process may hold (bytes), where there is a limit (`ulimit -f`).
#[cfg(unix)]
fn largest_file() -> Option<u64> {
    rustix::process::getrlimit(rustix::process::Resource::Fsize).current
}

#[cfg(not(unix))]
fn largest_file() -> Option<u64> {
    None
}

/// The free space where `path` cannot be written, as text in brackets to follow an error message; empty where
/// its folder is gone or the system does not say.
pub fn room_left(path: &Path) -> String {
    let mb = |bytes: u64| bytes as f64 / 1e6;
    match free_space(path) {
        Some(bytes) if path.parent().is_some_and(Path::exists) => {
            let limit = largest_file().map_or(String::new(), |most| {
                format!(", and a file may hold {:.1} MB at most, by ulimit -f", mb(most))
            });
            format!(" ({:.1} MB are free there{limit})", mb(bytes))
        }
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    #[cfg(unix)]
    fn a_folder_that_is_not_there_yet_has_the_room_of_the_one_that_is() {
        let folder = tempfile::tempdir().unwrap();
        assert!(free_space(&folder.path().join("a/b")).unwrap() > 0);
        assert!(free_space(Path::new("not there")).unwrap() > 0);
    }
}
