//! Which file may be written: a new one, or one that this program wrote.

use std::fs::{self, Metadata};
use std::io::Read;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::files::input::{self, not_a_file};

/// A kind of file that a command writes, and how such a file is recognised.
#[derive(Clone, Copy, Debug)]
pub struct Made {
    /// Name in messages, without an article.
    pub what: &'static str,
    /// Extensions that its name may have, without the dot and in lower case; empty where any will do.
    pub endings: &'static [&'static str],
    /// The bytes with which it begins; empty where they say nothing.
    pub start: &'static [u8],
    /// One of these stands in its first 64 KiB; empty for a format without such a mark.
    pub marks: &'static [&'static str],
    /// A further test, for a format whose mark has no fixed place, such as an attribute in an HDF5 file.
    pub proof: Option<fn(&Path) -> bool>,
}

/// The mark of this program in the head of an HTML page.
pub const PAGE_MARK: &str =
    concat!("<meta name=\"generator\" content=\"Creepage ", env!("CARGO_PKG_VERSION"), "\">");
/// The mark of this program in an XML file: a comment near its beginning.
pub const XML_MARK: &str = concat!("<!-- Creepage ", env!("CARGO_PKG_VERSION"), " -->");
/// The mark of this program in a PNG file: the content of a chunk `tEXt`.
pub const PNG_MARK: &[u8] = concat!("Software\0Creepage ", env!("CARGO_PKG_VERSION")).as_bytes();

/// The mark of this program in a PDF file: its producer, near its beginning.
pub const PDF_MARK: &str = concat!("Creepage ", env!("CARGO_PKG_VERSION"));

/// The CSS rule of the font in pages and figures: the one mark of those that versions without
/// [`PAGE_MARK`] and [`XML_MARK`] wrote.
const FONT: &str = "@font-face{font-family:\"DejaVu Sans\";src:url(data:font/ttf;base64,";

/// An HTML page.
pub const PAGE: Made = Made {
    what: "page",
    endings: &["html", "htm"],
    start: b"<!DOCTYPE html>",
    marks: &["<meta name=\"generator\" content=\"Creepage", FONT],
    proof: None,
};
/// A figure as SVG.
pub const SVG: Made = Made {
    what: "figure",
    endings: &["svg"],
    start: b"<svg",
    marks: &["<!-- Creepage", FONT],
    proof: None,
};
/// A figure as PNG.
pub const PNG: Made = Made {
    what: "figure",
    endings: &["png"],
    start: b"\x89PNG\r\n\x1a\n",
    marks: &["Software\0Creepage"],
    proof: None,
};
/// A figure as PDF.
pub const PDF: Made = Made {
    what: "figure",
    endings: &["pdf"],
    start: b"%PDF-",
    marks: &["Producer (Creepage"],
    proof: None,
};
/// A mesh as a VTK XML unstructured grid.
pub const VTU: Made = Made {
    what: "mesh",
    endings: &["vtu"],
    start: b"<?xml",
    marks: &["<!-- Creepage"],
    proof: None,
};
/// The table of the slider's steps (CSV), which begins with [`SLIDER_HEADING`].
pub const SLIDER: Made = Made {
    what: "table of the slider",
    endings: &[],
    start: SLIDER_HEADING,
    marks: &[],
    proof: None,
};
/// The first line of the slider's table: each column's name and unit.
pub const SLIDER_HEADING: &[u8] = b"t_s,x_m,v_m_s,s_m_s,mu,friction_N,spring_N\n";
/// An LS-DYNA keyword file.
pub const KEYWORDS: Made = Made {
    what: "keyword file",
    endings: &["k", "key", "dyn"],
    start: b"$ ",
    marks: &["a deck by creepage export-k"],
    proof: None,
};
/// The runs of a sweep as shell commands, one per line.
pub const PLAN: Made =
    Made { what: "plan of a sweep", endings: &[], start: PLAN_START, marks: &[], proof: None };
/// How each line of a plan begins.
pub const PLAN_START: &[u8] = b"${CREEPAGE:-creepage} run ";

/// Bytes at the beginning of a file that are searched for its mark.
const HEAD: u64 = 64 << 10;

/// Why a file was not written.
#[derive(Debug, Error)]
#[error("{}: {}", path.display(), self.problem())]
pub struct OutputRefused {
    /// The file.
    pub path: PathBuf,
    /// What was to be written: [`Made::what`].
    pub what: &'static str,
    /// Why not.
    pub fault: Fault,
}

/// The reason not to write a file.
#[derive(Debug)]
pub enum Fault {
    /// The name has none of these extensions.
    Ending(&'static [&'static str]),
    /// The folder that should hold the file does not exist.
    NoFolder(PathBuf),
    /// The path leads to no regular file; what it leads to, with its article.
    NotAFile(&'static str),
    /// The file is one that the command reads.
    Input,
    /// The file exists, and this program did not write it.
    Foreign,
    /// The file exists, but cannot be read to tell whether this program wrote it.
    Unreadable(std::io::Error),
}

impl OutputRefused {
    /// The reason, as a phrase for a message, without the name of the file.
    pub fn problem(&self) -> String {
        let what = self.what;
        match &self.fault {
            Fault::Ending(endings) => {
                format!("the name of a {what} must end in .{}", endings.join(" or ."))
            }
            Fault::NoFolder(folder) => {
                format!("cannot write the {what}: there is no folder {}", folder.display())
            }
            Fault::NotAFile(found) => format!("is {found}, not a file"),
            Fault::Input => "is what is read: it is not written over".into(),
            Fault::Foreign => {
                format!("is there already, and is not a {what} that this program wrote")
            }
            Fault::Unreadable(cause) => format!("cannot be looked at: {cause}"),
        }
    }

    /// What the user can do about it, as a phrase for a message.
    pub fn remedy(&self) -> &'static str {
        match self.fault {
            Fault::Foreign => "choose another name, or move that file away",
            Fault::NoFolder(_) => "make it, or choose a file in a folder that is there",
            _ => "choose another file",
        }
    }
}

/// Refuses a path where writing would replace one of `inputs`, or a file that this program did not write. An
/// empty file may be replaced.
///
/// # Errors
/// Any [`Fault`].
pub fn check<P: AsRef<Path>>(path: &Path, made: &Made, inputs: &[P]) -> Result<(), OutputRefused> {
    let refuse = |fault| Err(OutputRefused { path: path.to_path_buf(), what: made.what, fault });
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    if !made.endings.is_empty() && !made.endings.contains(&ending.to_ascii_lowercase().as_str()) {
        return refuse(Fault::Ending(made.endings));
    }
    let found = match fs::metadata(path) {
        Ok(found) => found,
        Err(cause) if cause.kind() == std::io::ErrorKind::NotFound => {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            return match folder {
                Some(folder) if !folder.is_dir() => refuse(Fault::NoFolder(folder.into())),
                _ => Ok(()),
            };
        }
        Err(cause) => return refuse(Fault::Unreadable(cause)),
    };
    if let Some(what) = not_a_file(&found) {
        return refuse(Fault::NotAFile(what));
    }
    if inputs.iter().any(|input| same(path, &found, input.as_ref())) {
        return refuse(Fault::Input);
    }
    match wrote(path, made) {
        Ok(true) => Ok(()),
        Ok(false) => refuse(Fault::Foreign),
        Err(cause) => refuse(Fault::Unreadable(cause)),
    }
}

/// Whether a file is empty, or bears the marks of `made`.
///
/// # Errors
/// A path that leads to no regular file, or a file that cannot be read.
pub fn wrote(path: &Path, made: &Made) -> std::io::Result<bool> {
    let file = input::open(path, input::RESULTS).map_err(|error| match error.fault {
        input::Fault::Unreadable(cause) => cause,
        _ => std::io::Error::other(error.problem()),
    })?;
    let mut head = Vec::new();
    file.take(HEAD).read_to_end(&mut head)?;
    let holds = |mark: &&str| head.windows(mark.len()).any(|window| window == mark.as_bytes());
    let marked = made.marks.is_empty() || made.marks.iter().any(holds);
    let begins = head.starts_with(made.start) && marked;
    Ok(head.is_empty() || begins && made.proof.is_none_or(|proof| proof(path)))
}

/// Whether `path`, whose metadata is `found`, and `other` lead to one file.
fn same(path: &Path, found: &Metadata, other: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let _ = path;
        fs::metadata(other).is_ok_and(|o| (o.dev(), o.ino()) == (found.dev(), found.ino()))
    }
    #[cfg(not(unix))]
    {
        let _ = found;
        matches!((path.canonicalize(), other.canonicalize()), (Ok(a), Ok(b)) if a == b)
    }
}

/// The first of `inputs` that is the same file as one of `paths`, also by another name or a link.
pub fn among<'a, P: AsRef<Path>>(inputs: &'a [P], paths: &[PathBuf]) -> Option<&'a Path> {
    let is_input = |input: &&P| {
        let at = |path: &PathBuf| {
            fs::metadata(path).is_ok_and(|found| same(path, &found, input.as_ref()))
        };
        paths.iter().any(at)
    };
    inputs.iter().find(is_input).map(AsRef::as_ref)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: [&Path; 0] = [];

    fn said(path: &Path, made: &Made, inputs: &[&Path]) -> String {
        check(path, made, inputs).unwrap_err().to_string()
    }

    #[test]
    fn only_what_this_program_wrote_is_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let page = folder.path().join("page.html");
        check(&page, &PAGE, &NONE).unwrap();
        fs::write(&page, "").unwrap();
        check(&page, &PAGE, &NONE).unwrap();
        for ours in ["<meta name=\"generator\" content=\"Creepage 0.1.0\">", FONT] {
            fs::write(&page, format!("<!DOCTYPE html>\n<head>{ours}</head>")).unwrap();
            check(&page, &PAGE, &NONE).unwrap();
        }
        for theirs in ["notes", "<!DOCTYPE html>\n<p>of Creepage</p>"] {
            fs::write(&page, theirs).unwrap();
            assert!(said(&page, &PAGE, &[]).contains("not a page that this program wrote"));
        }
        let table = folder.path().join("steps.txt");
        fs::write(&table, [SLIDER_HEADING, b"0,0,0,0,0,0,0\n"].concat()).unwrap();
        check(&table, &SLIDER, &NONE).unwrap();
        fs::write(&table, "t_s,x_m\n").unwrap();
        assert!(said(&table, &SLIDER, &[]).contains("is there already"));
    }

    #[test]
    fn a_name_of_another_kind_a_folder_and_a_missing_folder_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        assert!(said(&at("case.toml"), &PAGE, &[]).contains("must end in .html or .htm"));
        assert!(said(folder.path(), &PLAN, &[]).contains("is a folder, not a file"));
        assert!(said(&at("no/plan.sh"), &PLAN, &[]).contains("there is no folder"));
        #[cfg(unix)]
        assert!(said(Path::new("/dev/null"), &PLAN, &[]).contains("is a device, not a file"));
    }

    #[cfg(unix)]
    #[test]
    fn an_input_is_not_written_over_by_whatever_name() {
        let folder = tempfile::tempdir().unwrap();
        let mesh = folder.path().join("mesh.vtu");
        fs::write(&mesh, "<?xml version=\"1.0\"?>\n<!-- Creepage 0.1.0 -->\n").unwrap();
        check(&mesh, &VTU, &NONE).unwrap();
        assert!(said(&mesh, &VTU, &[&mesh]).contains("is what is read"));
        for (name, link) in [("soft.vtu", true), ("hard.vtu", false)] {
            let other = folder.path().join(name);
            if link {
                std::os::unix::fs::symlink(&mesh, &other).unwrap();
            } else {
                fs::hard_link(&mesh, &other).unwrap();
            }
            assert!(said(&other, &VTU, &[&mesh]).contains("is what is read"), "{name}");
        }
    }
}
