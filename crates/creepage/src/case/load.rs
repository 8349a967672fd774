//! From files and options to a resolved case, and to its text.

use std::path::{Path, PathBuf};

use output::hexadecimal;
use serde::Deserialize;
use sha2::{Digest, Sha256};
use toml::Table;

use crate::case::error::CaseError;
use crate::case::file::CaseFile;
use crate::case::layers::Layers;
use crate::case::left_out::{drop_crowns, drop_ramp, keep_meaningful, leave_out};
use crate::case::schema::{BodyModel, Case, Checkpoint, DriveMode, Guards, Meshing};
use crate::case::units::with_units;
use crate::case::value::get;
use crate::case::written::Written;
use crate::case::{check, irregularity, mesh_file, name, profile_file, table, validation};

/// A case: a file, and what is laid over it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CaseSource {
    /// The case file, or the name of a reference case: `creepage cases` lists them
    #[cfg_attr(feature = "clap", arg(value_name = "CASE"))]
    pub path: PathBuf,
    /// Set a key of the case, for example mesh.zone.size=2e-3; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "set", value_name = "KEY=VALUE"))]
    pub sets: Vec<String>,
    /// The text of the case, where it is not in a file; `path` then only names it.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub text: Option<String>,
}

impl<P: AsRef<Path>> From<P> for CaseSource {
    /// The case of a file, as it is.
    fn from(path: P) -> Self {
        Self { path: path.as_ref().to_owned(), ..Self::default() }
    }
}

impl CaseSource {
    /// What the path means.
    pub fn file(&self) -> CaseFile {
        match self.text {
            Some(_) => CaseFile::Disk(self.path.clone()),
            None => CaseFile::named(&self.path),
        }
    }
}

impl Case {
    /// Reads a case file with everything that it extends, lays `sets` (`KEY=VALUE`) over it,
    /// checks it and writes every default out.
    ///
    /// # Errors
    /// A file that cannot be read, or is not well-formed TOML; keys that are unknown, missing, out of range, or
    /// contradict one another; a mesh file or a table that cannot be read.
    pub fn load(path: &Path, sets: &[String]) -> Result<Self, CaseError> {
        Self::read(&CaseFile::Disk(path.to_owned()), sets)
    }

    /// The same for a file or a reference case.
    ///
    /// # Errors
    /// As those of [`Case::load`].
    pub fn read(file: &CaseFile, sets: &[String]) -> Result<Self, CaseError> {
        resolve(Layers::read(file)?, &file.path(), sets)
    }

    /// The same for a text. `path` gives the case its name, unless the text does; `extends` is relative to the
    /// folder of `path`.
    ///
    /// # Errors
    /// As those of [`Case::load`].
    pub fn from_text(text: &str, path: &Path, sets: &[String]) -> Result<Self, CaseError> {
        resolve(Layers::from_text(text, path)?, path, sets)
    }

    /// The resolved case as TOML; loading it again gives an equal case.
    pub fn to_toml(&self) -> String {
        // A case holds nothing that TOML cannot: the round-trip test shows it.
        let text = match self.model {
            BodyModel::FiniteElements if !self.has_profiles() => toml::to_string(self),
            _ => toml::to_string(&self.table()),
        };
        text.unwrap_or_default()
    }

    /// [`Case::to_toml`] with the unit of every number as a comment behind it.
    pub fn to_toml_with_units(&self) -> String {
        with_units(&self.to_toml())
    }

    /// The keys of the case that have meaning for its model.
    pub fn table(&self) -> Table {
        let mut table = Table::try_from(self).unwrap_or_default();
        if self.model == BodyModel::HalfSpace {
            keep_meaningful(&mut table, self.model);
        }
        drop_crowns(&mut table);
        table
    }

    /// SHA-256, in hexadecimal, of [`Case::results_toml`].
    pub fn hash(&self) -> String {
        hexadecimal(&Sha256::digest(self.results_toml()))
    }

    /// The resolved case as TOML with all that results depend on: `checkpoint` and `guards` are set to their
    /// defaults, and `mesh.file` is left out, since `mesh.sha256` identifies the mesh.
    pub fn results_toml(&self) -> String {
        let (checkpoint, guards) = (Checkpoint::default(), Guards::default());
        let mesh = Meshing { file: None, ..self.mesh.clone() };
        Self { checkpoint, guards, mesh, ..self.clone() }.to_toml()
    }

    /// What is allowed but deserves a warning, one sentence each.
    pub fn warnings(&self) -> Vec<String> {
        validation::warnings(self)
    }
}

fn resolve(mut layers: Layers, path: &Path, sets: &[String]) -> Result<Case, CaseError> {
    for set in sets {
        layers.add_set(set)?;
    }
    let left_out = leave_out(&mut layers)?;
    let files = layers.files();
    table::inline(&mut layers)?;
    profile_file::inline(&mut layers)?;
    irregularity::inline(&mut layers)?;
    mesh_file::resolve(&mut layers)?;
    drop_ramp(&mut layers);
    let Layers { mut table, places } = layers;
    check::keys(&mut table, &places)?;
    let given = |key: &str| get(&table, key).is_some();
    let (is_named, has_mode) = (given("name"), given("drive.mode"));
    let mut case = Case::deserialize(table).map_err(|error| {
        let message = error.message().replace('\n', "; ");
        places.error_nowhere("", &message, "see `creepage schema` for the keys and their forms")
    })?;
    if !has_mode && case.drive.torque.is_some() {
        case.drive.mode = DriveMode::Torque;
    }
    if case.name.is_empty() && !is_named {
        case.name = name_from(path);
    }
    case.written = Written { places: places.into(), files, left_out };
    validation::check(&case)?;
    case.write_defaults();
    Ok(case)
}

/// The file's stem, with whatever a folder's name should not have replaced.
fn name_from(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
    let name: String = stem.chars().map(|c| if name::may_hold(c) { c } else { '-' }).collect();
    if name.trim_matches(['.', ' ']).is_empty() { "case".into() } else { name }
}
