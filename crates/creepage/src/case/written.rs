//! How a case was written, for what is found about it later.

use std::path::PathBuf;
use std::sync::Arc;

use crate::case::error::CaseError;
use crate::case::key::Key;
use crate::case::places::Places;
use crate::case::schema::Case;
use crate::case::section::Section;

/// How a case was written. It is no part of what a case says: all of them are equal.
#[derive(Clone, Debug, Default)]
pub struct Written {
    /// Where its keys were written.
    pub(crate) places: Arc<Places>,
    /// The files that it was read from, and its friction table.
    pub(crate) files: Vec<PathBuf>,
    /// Keys that a layer below that of `model` gives and that have no meaning for it.
    pub(crate) left_out: Vec<&'static str>,
}

impl PartialEq for Written {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// It has no keys.
impl Section for Written {
    fn keys(_: &str) -> Vec<Key> {
        Vec::new()
    }
}

impl Case {
    /// An error about a key that is found after loading, at the place where the key was written.
    pub fn error_at(&self, key: &str, message: &str, remedy: &str) -> CaseError {
        self.written.places.error(key, message, remedy).into()
    }

    /// The files that the case is made of: its own, those that it extends, its friction table and its mesh. The first is
    /// the name of the text where the case is read from none.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let mesh = self.mesh.file.as_ref().map(PathBuf::from);
        self.written.files.iter().cloned().chain(mesh).collect()
    }
}
