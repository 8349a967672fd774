//! The reference cases: the cases and sweeps of the folder `cases` that are part of the program.

use std::path::Path;

use toml::{Table, Value};

use crate::case::keys::nearest;

/// A reference case, or a sweep over one.
#[derive(Debug, PartialEq, Eq)]
pub struct ReferenceCase {
    /// Path of its file in the folder `cases`, without the ending.
    pub name: &'static str,
    /// What the file holds.
    pub text: &'static str,
}

macro_rules! references {
    ($($name:literal)*) => {
        &[$(ReferenceCase {
            name: $name,
            text: include_str!(concat!("../../../../cases/", $name, ".toml")),
        }),*]
    };
}

/// All, in the order in which they are listed. None names a file other than these: neither a mesh nor a friction table.
pub static REFERENCES: &[ReferenceCase] = references![
    "quick" "smoke"
    "zhao-li/a-coulomb" "zhao-li/b-falling" "zhao-li/b-as-published" "zhao-li/c-memory"
    "zhao-li/d-coulomb-low" "zhao-li/control-weak"
    "verdict/slice" "verdict/falling" "verdict/space"
    "half-space/line" "half-space/line-falling" "half-space/mindlin" "wheel-rail/s1002-60e1"
    "wheel-rail/corrugation" "wheel-rail/flat"
    "sweeps/base" "sweeps/base-large"
    "sweeps/penalty-limit" "sweeps/tutorial" "sweeps/kt" "sweeps/dt" "sweeps/mesh" "sweeps/law" "sweeps/exact-damping"
    "sweeps/creep-curve" "sweeps/creep-curve-half-space" "sweeps/creep-curve-quasi-static"
    "sweeps/kt-large" "sweeps/dt-large" "sweeps/mesh-large" "sweeps/law-large"
];

impl ReferenceCase {
    /// The one of this name (`zhao-li/b-falling`), of the last part of it (`b-falling`), or of its path in the documents
    /// (`cases/zhao-li/b-falling.toml`).
    pub fn named(path: &Path) -> Option<&'static Self> {
        let given = text_of(path)?;
        let is_meant = |of: &&Self| {
            of.name == given || of.stem() == given || format!("cases/{}", of.file()) == given
        };
        REFERENCES.iter().find(is_meant)
    }

    /// Path of its file in the folder `cases`.
    pub fn file(&self) -> String {
        format!("{}.toml", self.name)
    }

    /// The last part of its name.
    fn stem(&self) -> &'static str {
        self.name.rsplit('/').next().unwrap_or(self.name)
    }

    /// The one at `path`, relative to the file of this one.
    pub fn beside(&self, path: &str) -> Option<&'static Self> {
        let mut place: Vec<&str> = self.name.split('/').collect();
        place.pop();
        for part in path.split('/') {
            if part == ".." {
                place.pop();
            } else {
                place.push(part);
            }
        }
        let file = place.join("/");
        REFERENCES.iter().find(|of| of.file() == file)
    }

    /// A text at the top level of its file.
    fn at_top(&self, key: &str) -> Option<String> {
        let table: Table = self.text.parse().ok()?;
        table.get(key).and_then(Value::as_str).map(str::to_owned)
    }

    /// One line that says what it is for.
    pub fn title(&self) -> String {
        self.at_top("title").unwrap_or_default()
    }

    /// Whether it is a sweep.
    pub fn is_sweep(&self) -> bool {
        self.at_top("base").is_some()
    }

    /// The one that it extends, or that it sweeps over.
    pub fn below(&self) -> Option<&'static Self> {
        self.beside(&self.at_top("extends").or_else(|| self.at_top("base"))?)
    }
}

/// The question after a path at which there is no file, where a reference case has nearly this name.
pub fn did_you_mean(path: &Path) -> Option<String> {
    let given = text_of(path)?;
    let name = given.strip_suffix(".toml").unwrap_or(&given);
    let meant = ReferenceCase::named(Path::new(name)).map(|of| of.name);
    let meant = meant.or_else(|| nearest(name, REFERENCES.iter().map(|of| of.name)))?;
    Some(format!("did you mean the reference case `{meant}`? `creepage cases` lists all"))
}

/// A path with `/` between its parts, if it is text.
fn text_of(path: &Path) -> Option<String> {
    let parts: Option<Vec<&str>> = path.iter().map(|part| part.to_str()).collect();
    Some(parts?.join("/"))
}
