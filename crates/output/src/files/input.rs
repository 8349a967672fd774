//! Opening a file that is to be read: regular and bounded, as bytes or as text.

use std::borrow::Cow;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// A kind of input file, and its largest size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Name in messages, with its article.
    pub what: &'static str,
    /// Largest size (bytes).
    pub most: u64,
}

const KIB: u64 = 1 << 10;
const MIB: u64 = 1 << 20;
const GIB: u64 = 1 << 30;

/// A case file, a sweep file, or parameters of the slider. A larger file is no such file.
pub const CASE: Kind = Kind { what: "a case file", most: 4 * MIB };
/// A friction table. The resolved case repeats its points in up to eight times as many bytes, and must still
/// be readable as a [`CASE`].
pub const TABLE: Kind = Kind { what: "a friction table", most: 512 * KIB };
/// Heights of a running surface, as long for the same reason.
pub const HEIGHTS: Kind = Kind { what: "a table of heights", most: 512 * KIB };
/// A profile of a wheel or a rail.
pub const PROFILE: Kind = Kind { what: "a profile", most: 512 * KIB };
/// A mesh file. It is read whole; at about 100 bytes per node and element, the largest meshes
/// that one machine can run need a tenth of this size.
pub const MESH: Kind = Kind { what: "a mesh file", most: 4 * GIB };
/// An LS-DYNA keyword file, which holds a mesh.
pub const KEYWORDS: Kind = Kind { what: "a keyword file", most: MESH.most };
/// A table of another code's contact history, read row by row.
pub const CONTACT_TABLE: Kind = Kind { what: "a table of a contact history", most: 64 * GIB };
/// A JSON document that this program wrote; that of a sweep has some kilobytes per run.
pub const DOCUMENT: Kind = Kind { what: "a document of results", most: 256 * MIB };
/// A log that this program wrote, or a text of the operating system.
pub const LOG: Kind = Kind { what: "a log", most: 256 * MIB };
/// A preload kept for other runs: 24 bytes per node.
pub const PRELOAD: Kind = Kind { what: "a kept preload", most: 16 * GIB };
/// A result file, read in parts and so of any size.
pub const RESULTS: Kind = Kind { what: "a result file", most: u64::MAX };

/// Why a file was not read.
#[derive(Debug, Error)]
#[error("{}: {}", path.display(), self.problem())]
pub struct InputError {
    /// The file.
    pub path: PathBuf,
    /// The kind of file expected.
    pub kind: Kind,
    /// What is wrong.
    pub fault: Fault,
}

/// What is wrong with an input.
#[derive(Debug)]
pub enum Fault {
    /// There is no file at the path.
    Missing,
    /// It is no regular file; what it is instead, with its article: `"a folder"`, `"a pipe"` and so on.
    NotAFile(&'static str),
    /// It is larger than [`Kind::most`].
    TooLarge,
    /// The operating system refuses to open or read it.
    Unreadable(io::Error),
    /// It is text in UTF-16.
    Utf16,
    /// It is not UTF-8 text; where the first invalid byte is.
    NotText {
        /// Line, counted from 1.
        line: usize,
        /// Offset in the file (bytes), counted from 0.
        byte: usize,
    },
}

impl InputError {
    /// What is wrong, as a phrase for a message, without the name of the file.
    pub fn problem(&self) -> String {
        let what = self.kind.what;
        match &self.fault {
            Fault::Missing => "there is no such file".into(),
            Fault::NotAFile(found) => format!("is {found}, not {what}"),
            Fault::TooLarge => {
                format!("is larger than {}, the most that {what} may have", size(self.kind.most))
            }
            Fault::Unreadable(cause) => format!("cannot be read: {cause}"),
            Fault::Utf16 => "is text in UTF-16, not in UTF-8".into(),
            Fault::NotText { line, byte } => {
                format!("is not UTF-8 text (line {line}, byte {byte})")
            }
        }
    }

    /// What the user can do about it, as a phrase for a message.
    pub fn remedy(&self) -> String {
        let what = self.kind.what;
        match &self.fault {
            Fault::Missing => format!("check the path of {what}"),
            Fault::NotAFile("a folder") => format!("name {what} in it"),
            Fault::NotAFile(_) => {
                format!("save it as a file, and name that: {what} is read from a file alone")
            }
            Fault::TooLarge => format!("name {what}"),
            Fault::Unreadable(_) => "check that you may read it".into(),
            Fault::Utf16 | Fault::NotText { .. } => format!("{what} is text, saved as UTF-8"),
        }
    }

    /// Whether there is no such file.
    pub fn is_missing(&self) -> bool {
        matches!(self.fault, Fault::Missing)
    }
}

fn size(bytes: u64) -> String {
    match bytes {
        GIB.. => format!("{} GiB", bytes / GIB),
        MIB.. => format!("{} MiB", bytes / MIB),
        _ => format!("{} KiB", bytes / KIB),
    }
}

/// What `found` is, with its article, unless it is a regular file.
pub(crate) fn not_a_file(found: &Metadata) -> Option<&'static str> {
    let kind = found.file_type();
    if kind.is_file() {
        return None;
    }
    if kind.is_dir() {
        return Some("a folder");
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return Some("a pipe");
        }
        if kind.is_char_device() || kind.is_block_device() {
            return Some("a device");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
    }
    Some("no regular file")
}

/// Refuses whatever is not a regular file of at most [`Kind::most`] bytes, without opening it: opening a pipe
/// would wait for its writer.
///
/// # Errors
/// [`Fault::Missing`], [`Fault::NotAFile`], [`Fault::TooLarge`], or [`Fault::Unreadable`] where the system does
/// not say what is there.
pub fn regular(path: &Path, kind: Kind) -> Result<(), InputError> {
    let refuse = |fault| InputError { path: path.to_path_buf(), kind, fault };
    let found = fs::metadata(path).map_err(|cause| refuse(fault_of(cause)))?;
    check_metadata(&found, kind).map_err(refuse)
}

/// Opens a regular file of at most [`Kind::most`] bytes for reading.
///
/// # Errors
/// As [`regular`]; also [`Fault::Unreadable`] for a file that may not be read.
pub fn open(path: &Path, kind: Kind) -> Result<File, InputError> {
    let refuse = |fault| InputError { path: path.to_path_buf(), kind, fault };
    regular(path, kind)?;
    let mut options = OpenOptions::new();
    options.read(true);
    // The path may lead to another file since `regular` looked, and some files that the system calls regular
    // block when they are opened.
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits() as i32);
    }
    let file = options.open(path).map_err(|cause| refuse(fault_of(cause)))?;
    let found = file.metadata().map_err(|cause| refuse(fault_of(cause)))?;
    check_metadata(&found, kind).map_err(refuse)?;
    Ok(file)
}

/// All bytes of a file.
///
/// # Errors
/// As [`open`]; also [`Fault::TooLarge`] for a file that grows beyond [`Kind::most`] while it is read.
pub fn bytes(path: &Path, kind: Kind) -> Result<Vec<u8>, InputError> {
    let refuse = |fault| InputError { path: path.to_path_buf(), kind, fault };
    let mut bytes = Vec::new();
    let file = open(path, kind)?;
    let read = file.take(kind.most.saturating_add(1)).read_to_end(&mut bytes);
    let read = read.map_err(|cause| refuse(Fault::Unreadable(cause)))?;
    if read as u64 > kind.most { Err(refuse(Fault::TooLarge)) } else { Ok(bytes) }
}

/// A whole file as UTF-8 text. Letters of Latin-1 may stand where they change nothing: after a `#`, and in a [`TABLE`],
/// whose values are numbers.
///
/// # Errors
/// As [`bytes`]; also [`Fault::Utf16`] and [`Fault::NotText`].
pub fn text(path: &Path, kind: Kind) -> Result<String, InputError> {
    let bytes = bytes(path, kind)?;
    let refuse = |fault| InputError { path: path.to_path_buf(), kind, fault };
    // a mark, or the zero of a letter of ASCII
    if matches!(bytes[..], [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, _, ..] | [_, 0, ..]) {
        return Err(refuse(Fault::Utf16));
    }
    String::from_utf8(bytes).or_else(|error| {
        let mut text = String::with_capacity(error.as_bytes().len());
        let mut start = 0;
        for (number, line) in (1..).zip(error.as_bytes().split_inclusive(|&b| b == b'\n')) {
            let comment = match kind {
                TABLE => Some(0),
                CASE => line.iter().position(|&b| b == b'#'),
                _ => None,
            };
            let (code, comment) = line.split_at(comment.unwrap_or(line.len()));
            text += str::from_utf8(code).map_err(|error| {
                let byte = start + error.valid_up_to();
                refuse(Fault::NotText { line: number, byte })
            })?;
            text += &decoded(comment);
            start += line.len();
        }
        Ok(text)
    })
}

/// Text in UTF-8, or else in Latin-1, where each byte is the character of its number.
pub fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    match str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => bytes.iter().copied().map(char::from).collect(),
    }
}

/// Longest line that [`by_line`] lets through (bytes).
const LONGEST_LINE: usize = 1 << 20;

/// A reader for use line by line: a line without end, which would fill the memory, is an error.
///
/// Reading fails with [`io::ErrorKind::InvalidData`] once more than 1 MiB came without a line end.
pub fn by_line(file: impl Read) -> impl Read {
    ByLine { file, since_line_end: 0 }
}

struct ByLine<R> {
    file: R,
    /// Bytes since the last line end.
    since_line_end: usize,
}

impl<R: Read> Read for ByLine<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(bytes)?;
        let found = &bytes[..read];
        self.since_line_end = match found.iter().rposition(|&byte| byte == b'\n') {
            Some(end) => read - end - 1,
            None => self.since_line_end + read,
        };
        if self.since_line_end > LONGEST_LINE {
            let problem = format!("a line is longer than {}", size(LONGEST_LINE as u64));
            return Err(io::Error::new(io::ErrorKind::InvalidData, problem));
        }
        Ok(read)
    }
}

fn check_metadata(found: &Metadata, kind: Kind) -> Result<(), Fault> {
    match not_a_file(found) {
        Some(what) => Err(Fault::NotAFile(what)),
        None if found.len() > kind.most => Err(Fault::TooLarge),
        None => Ok(()),
    }
}

fn fault_of(cause: io::Error) -> Fault {
    match cause.kind() {
        // `case.toml/x`, where `case.toml` is a file, names no file either
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Fault::Missing,
        _ => Fault::Unreadable(cause),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(path: &Path, kind: Kind, words: &[&str]) {
        let said = bytes(path, kind).unwrap_err().to_string();
        for word in words.iter().chain([&path.to_str().unwrap()]) {
            assert!(said.contains(word), "{word:?} is not in {said}");
        }
    }

    #[test]
    fn what_is_no_file_is_refused_by_what_it_is() {
        let folder = tempfile::tempdir().unwrap();
        refused(folder.path(), CASE, &["is a folder, not a case file"]);
        refused(&folder.path().join("no.toml"), CASE, &["no such file"]);
        #[cfg(unix)]
        refused(Path::new("/dev/zero"), MESH, &["is a device, not a mesh file"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_refused_and_not_waited_for() {
        use rustix::fs::{CWD, FileType, Mode, mknodat};
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("case.toml");
        mknodat(CWD, &pipe, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).unwrap();
        refused(&pipe, CASE, &["is a pipe"]);
        let link = folder.path().join("link.toml");
        std::os::unix::fs::symlink(&pipe, &link).unwrap();
        refused(&link, CASE, &["is a pipe"]);
    }

    #[test]
    fn a_file_beyond_the_size_of_its_kind_is_refused_with_the_size() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let kind = Kind { what: "a note", most: 2 * KIB };
        file.as_file().set_len(2 * KIB).unwrap();
        assert_eq!(bytes(file.path(), kind).unwrap().len(), 2048);
        file.as_file().set_len(2 * KIB + 1).unwrap();
        refused(file.path(), kind, &["larger than 2 KiB", "a note"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_that_tells_no_size_is_read_no_further_than_its_kind_goes() {
        // of length 0 by its metadata
        let kind = Kind { what: "a note", most: 16 };
        refused(Path::new("/proc/self/status"), kind, &["larger than"]);
    }

    #[test]
    fn a_line_without_end_is_an_error_before_it_takes_all_memory() {
        let mut kept = Vec::new();
        let short = b"0,1\n".repeat(1 << 19);
        assert_eq!(by_line(&short[..]).read_to_end(&mut kept).unwrap(), short.len());
        let error = by_line(io::repeat(0)).read_to_end(&mut kept).unwrap_err();
        assert!(error.to_string().contains("a line is longer than 1 MiB"), "{error}");
    }

    #[test]
    fn text_that_is_none_is_refused_at_its_line() {
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::write(file.path(), b"a = 1\nb = \xff\n").unwrap();
        let error = text(file.path(), CASE).unwrap_err();
        assert!(error.to_string().contains("line 2, byte 10"), "{error}");
    }

    #[test]
    fn letters_of_latin_1_are_read_in_comments_and_in_the_heading_of_a_table() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let read = |bytes: &[u8], kind| {
            fs::write(file.path(), bytes).unwrap();
            text(file.path(), kind)
        };
        assert_eq!(read(b"# Gr\xf6\xdfe\na = 1 # \xb5\n", CASE).unwrap(), "# Größe\na = 1 # µ\n");
        // what stands before a comment stays UTF-8
        assert_eq!(read(b"\"\xc3\xa9\" = 1 # \xb5", CASE).unwrap(), "\"é\" = 1 # µ");
        assert_eq!(read(b"s (m/s),\xb5\n0,0.5\n", TABLE).unwrap(), "s (m/s),µ\n0,0.5\n");
        assert!(read(b"{\"#\xb5\": 1}", DOCUMENT).is_err());
    }

    #[test]
    fn utf_16_is_called_so() {
        let file = tempfile::NamedTempFile::new().unwrap();
        for bytes in [&b"\xff\xfea\0"[..], b"\xfe\xff\0a", b"a\0=\0", b"\0a\0="] {
            fs::write(file.path(), bytes).unwrap();
            let error = text(file.path(), CASE).unwrap_err();
            assert!(error.to_string().contains("UTF-16"), "{error}");
        }
    }
}
