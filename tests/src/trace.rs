//! What `strace` saw a process do to a folder.

use std::collections::HashMap;
use std::fmt;
use std::path::{Path, PathBuf};

/// The system calls that can change a folder, and those that a change's place follows from; as an option
/// of `strace`.
pub const TRACED: &str = "trace=open,openat,creat,close,lseek,write,writev,pwrite64,pwritev,pwritev2,ftruncate,\
                          truncate,fallocate,rename,renameat,renameat2,unlink,unlinkat,mkdir,mkdirat,\
                          link,linkat,symlink,copy_file_range,sendfile";

/// A change of the folder; names are relative to it.
#[derive(Clone, Debug)]
pub enum Call {
    /// The folder itself is made.
    MakeFolder,
    /// A file is opened and made, or emptied.
    Create {
        /// The file.
        name: PathBuf,
        /// Whether it is emptied.
        truncate: bool,
    },
    /// Bytes are written.
    Write {
        /// The file.
        name: PathBuf,
        /// Where; at its end without it.
        at: Option<usize>,
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// Bytes of one file are copied to another.
    Copy {
        /// The file that they come from.
        from: PathBuf,
        /// Where they are in it.
        start: usize,
        /// The file that they are written to.
        to: PathBuf,
        /// Where; at its end without it.
        at: Option<usize>,
        /// How many.
        length: usize,
    },
    /// A file is cut off or lengthened.
    Cut {
        /// The file.
        name: PathBuf,
        /// To this many bytes.
        length: usize,
    },
    /// A file gets another name.
    Rename {
        /// The old name.
        from: PathBuf,
        /// The new name.
        to: PathBuf,
    },
    /// A file is removed.
    Remove {
        /// The file.
        name: PathBuf,
    },
}

impl fmt::Display for Call {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MakeFolder => write!(f, "mkdir"),
            Self::Create { name, .. } => write!(f, "open of {}", name.display()),
            Self::Write { name, at, bytes } => {
                write!(f, "write of {} bytes at {at:?} in {}", bytes.len(), name.display())
            }
            Self::Copy { from, to, length, .. } => {
                write!(f, "copy of {length} bytes of {} to {}", from.display(), to.display())
            }
            Self::Cut { name, length } => write!(f, "ftruncate of {} to {length}", name.display()),
            Self::Rename { from, to } => {
                write!(f, "rename of {} to {}", from.display(), to.display())
            }
            Self::Remove { name } => write!(f, "unlink of {}", name.display()),
        }
    }
}

/// An open file: where `write` writes, none for the end.
type Place = Option<usize>;

/// What of a log of `strace -f -y -xx` changed `folder`, in order.
///
/// # Errors
/// A call that is not understood.
pub fn calls(log: &str, folder: &Path) -> Result<Vec<Call>, String> {
    let mut found = Vec::new();
    let mut places: HashMap<u64, Place> = HashMap::new();
    // calls of one thread between whose beginning and end another's are
    let mut begun: HashMap<&str, &str> = HashMap::new();
    for line in log.lines() {
        let Some((process, rest)) = line.split_once(' ') else { continue };
        let rest = rest.trim_start();
        if let Some(start) = rest.strip_suffix(" <unfinished ...>") {
            begun.insert(process, start);
            continue;
        }
        let joined;
        let whole = match rest.strip_prefix("<... ").and_then(|rest| rest.split_once(" resumed>")) {
            Some((_, end)) => {
                let start = begun.remove(process).unwrap_or_default();
                joined = format!("{start}{end}");
                joined.as_str()
            }
            None => rest,
        };
        let Some((name, _)) = whole.split_once('(') else { continue };
        // strace fills short lines with blanks before the result
        let Some((arguments, result)) = whole[name.len() + 1..].rsplit_once(" = ") else {
            continue;
        };
        let arguments = arguments.trim_end();
        let arguments = arguments.strip_suffix(')').unwrap_or(arguments);
        let arguments: Vec<&str> = arguments.split(", ").collect();
        let number = |text: &str| text.split(['<', ' ']).next().and_then(|n| n.parse::<u64>().ok());
        // a failed call changes nothing
        let Some(result) = number(result) else { continue };
        one(name, &arguments, result, folder, &mut places, &mut found)
            .map_err(|problem| format!("{problem}: {}", &whole[..whole.len().min(300)]))?;
    }
    Ok(found)
}

/// Takes one call with its arguments and its result.
fn one(
    name: &str,
    arguments: &[&str],
    result: u64,
    folder: &Path,
    places: &mut HashMap<u64, Place>,
    found: &mut Vec<Call>,
) -> Result<(), String> {
    let argument = |k: usize| arguments.get(k).copied().ok_or("an argument is missing".to_string());
    let whole = |text: &str| text.parse::<usize>().map_err(|_| format!("{text} is no number"));
    let inside = |path: PathBuf| path.strip_prefix(folder).map(Path::to_path_buf).ok();
    // a descriptor with the path behind it
    let opened = |k: usize| -> Result<(u64, Option<PathBuf>), String> {
        let (number, path) = argument(k)?.split_once('<').ok_or("no path of a descriptor")?;
        let path = path.strip_suffix('>').unwrap_or(path);
        Ok((number.parse().map_err(|_| "no descriptor")?, inside(path_of(path))))
    };
    let quoted = |k: usize| argument(k).map(|text| inside(path_of(text.trim_matches('"'))));
    match name {
        "open" | "openat" | "creat" => {
            let first = usize::from(name == "openat");
            let flags = if name == "creat" { "O_CREAT|O_TRUNC" } else { argument(first + 1)? };
            places.insert(result, if flags.contains("O_APPEND") { None } else { Some(0) });
            let truncate = flags.contains("O_TRUNC");
            if let Some(name) = quoted(first)?
                && (truncate || flags.contains("O_CREAT"))
            {
                found.push(Call::Create { name, truncate });
            }
        }
        "lseek" => {
            let (file, _) = opened(0)?;
            places.entry(file).and_modify(|place| {
                *place = place.map(|_| result as usize);
            });
        }
        "write" => {
            let (file, path) = opened(0)?;
            let Some(name) = path else { return Ok(()) };
            let place = places.entry(file).or_insert(Some(0));
            let mut bytes = bytes(argument(1)?);
            bytes.truncate(result as usize);
            found.push(Call::Write { name, at: *place, bytes });
            *place = place.map(|at| at + result as usize);
        }
        "pwrite64" => {
            if let (_, Some(name)) = opened(0)? {
                let mut bytes = bytes(argument(1)?);
                bytes.truncate(result as usize);
                found.push(Call::Write { name, at: Some(whole(argument(3)?)?), bytes });
            }
        }
        "copy_file_range" => {
            let ((source, from), (target, to)) = (opened(0)?, opened(2)?);
            let (Some(from), Some(to)) = (from, to) else {
                return Err("a copy over the border of the folder".into());
            };
            if argument(1)? != "NULL" || argument(3)? != "NULL" {
                return Err("a copy between places of its own".into());
            }
            let length = result as usize;
            let mut advance = |file: u64| {
                let place = places.entry(file).or_insert(Some(0));
                let at = *place;
                *place = at.map(|at| at + length);
                at
            };
            let start = advance(source).unwrap_or(0);
            found.push(Call::Copy { from, start, to, at: advance(target), length });
        }
        "ftruncate" => {
            if let (_, Some(name)) = opened(0)? {
                found.push(Call::Cut { name, length: whole(argument(1)?)? });
            }
        }
        "rename" => {
            if let (Some(from), Some(to)) = (quoted(0)?, quoted(1)?) {
                found.push(Call::Rename { from, to });
            }
        }
        "unlink" => {
            if let Some(name) = quoted(0)? {
                found.push(Call::Remove { name });
            }
        }
        "mkdir" => {
            if let Some(name) = quoted(0)? {
                if name.as_os_str().is_empty() {
                    found.push(Call::MakeFolder);
                } else {
                    return Err("a folder in the folder".into());
                }
            }
        }
        "close" => {}
        _ => {
            let concerns = (0..arguments.len()).any(|k| {
                opened(k).is_ok_and(|(_, path)| path.is_some())
                    || quoted(k).is_ok_and(|path| path.is_some())
            });
            if concerns {
                return Err("a call that the replay does not know".into());
            }
        }
    }
    Ok(())
}

/// The bytes of a text of `strace -xx`.
fn bytes(text: &str) -> Vec<u8> {
    let digits = |pair: &str| u8::from_str_radix(pair.get(..2)?, 16).ok();
    text.trim_matches('"').split("\\x").skip(1).filter_map(digits).collect()
}

/// A path, coded or not.
fn path_of(text: &str) -> PathBuf {
    let decoded = if text.contains("\\x") { bytes(text) } else { text.as_bytes().to_vec() };
    PathBuf::from(String::from_utf8_lossy(&decoded).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_tells_what_changed_the_folder_alone() {
        let log = r#"7 mkdir("\x2f\x61", 0777) = 0
7 openat(AT_FDCWD</>, "\x2f\x61\x2f\x62", O_WRONLY|O_CREAT|O_TRUNC|O_CLOEXEC, 0666) = 3</a/b>
7 write(3<\x2f\x61\x2f\x62>, "\x68\x69", 2) = 2
8 write(1<\x2f\x64>, "\x68\x69", 2 <unfinished ...>
7 write(3<\x2f\x61\x2f\x62>, "\x21", 1 <unfinished ...>
8 <... write resumed>) = 2
7 <... write resumed>)            = 1
7 pwrite64(3<\x2f\x61\x2f\x62>, "\x48", 1, 0) = 1
7 openat(AT_FDCWD</>, "\x2f\x61\x2f\x62", O_RDONLY|O_CLOEXEC) = 4</a/b>
7 openat(AT_FDCWD</>, "\x2f\x61\x2f\x65", O_WRONLY|O_CREAT|O_TRUNC|O_CLOEXEC, 0666) = 5</a/e>
7 copy_file_range(4<\x2f\x61\x2f\x62>, NULL, 5<\x2f\x61\x2f\x65>, NULL, 1073741824, 0) = 3
7 unlink("\x2f\x61\x2f\x63") = -1 ENOENT (No such file or directory)
7 rename("\x2f\x61\x2f\x62", "\x2f\x61\x2f\x63") = 0
7 +++ exited with 0 +++
"#;
        let found = calls(log, Path::new("/a")).unwrap();
        let said: Vec<_> = found.iter().map(ToString::to_string).collect();
        assert_eq!(
            said,
            [
                "mkdir",
                "open of b",
                "write of 2 bytes at Some(0) in b",
                "write of 1 bytes at Some(2) in b",
                "write of 1 bytes at Some(0) in b",
                "open of e",
                "copy of 3 bytes of b to e",
                "rename of b to c"
            ]
        );
        assert!(
            calls("7 link(\"\\x2f\\x61\\x2f\\x62\", \"\\x2f\\x65\") = 0", Path::new("/a")).is_err()
        );
    }
}
