//! From files and options to a resolved case.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use sha2::{Digest, Sha256};

use crate::case::check;
use crate::case::creepage;
use crate::case::error::CaseError;
use crate::case::keys;
use crate::case::layers::{Layers, get, join};
use crate::case::left_out::{keep_meaningful, leave_out};
use crate::case::mesh_file;
use crate::case::name;
use crate::case::schema::{
    BodyModel, Case, Checkpoint, ContactLayers, DriveMode, Enforcement, Guards, Meshing,
};
use crate::case::table;
use crate::case::units::with_units;
use crate::case::validation;
use output::hexadecimal;
use toml::{Table, Value};

impl Case {
    /// Reads a case file with everything that it extends, lays `sets` (`KEY=VALUE`) over it,
    /// checks it and writes every default out.
    ///
    /// # Errors
    /// A file that cannot be read, or is not well-formed TOML; keys that are unknown, missing, out of range, or
    /// contradict one another; a mesh file or a friction table that cannot be read.
    pub fn load(path: &Path, sets: &[String]) -> Result<Self, CaseError> {
        resolve(Layers::read(path)?, path, sets)
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
            BodyModel::FiniteElements => toml::to_string(self),
            BodyModel::HalfSpace => toml::to_string(&self.table()),
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

/// The files that a case is made of: its own, those that it extends, its friction table and its mesh. `source` is
/// the path that the case was read from, or the name of a text that is no file. A friction table that an option
/// names is not among them.
pub fn inputs(case: &Case, source: &Path) -> Vec<PathBuf> {
    let mut files = vec![source.to_path_buf()];
    files.extend(Layers::read(source).map(|layers| layers.files()).unwrap_or_default());
    files.extend(case.mesh.file.as_ref().map(PathBuf::from));
    files
}

/// An error about a key that was found after loading, at the place where the key was written. `path`, `text` and
/// `sets` are those of the case; `text` is none where the case was read from the file `path`.
pub fn error_at_key(
    path: &Path,
    text: Option<&str>,
    sets: &[String],
    key: &str,
    message: &str,
    remedy: &str,
) -> CaseError {
    let read = || -> Result<Layers, CaseError> {
        let mut layers = match text {
            Some(text) => Layers::from_text(text, path)?,
            None => Layers::read(path)?,
        };
        sets.iter().try_for_each(|set| layers.add_set(set))?;
        Ok(layers)
    };
    match read() {
        Ok(layers) => CaseError::Key(Box::new(layers.error_at(key, message, remedy))),
        Err(error) => error,
    }
}

fn resolve(mut layers: Layers, path: &Path, sets: &[String]) -> Result<Case, CaseError> {
    for set in sets {
        layers.add_set(set)?;
    }
    let left_out = leave_out(&mut layers)?;
    table::inline(&mut layers)?;
    mesh_file::resolve(&mut layers)?;
    creepage::drop_ramp(&mut layers);
    check::keys(&layers)?;
    hold(&mut layers.table, "");
    let mut case = Case::deserialize(layers.table.clone()).map_err(|error| {
        let message = error.message().replace('\n', "; ");
        let remedy = "see `creepage schema` for the keys and their forms";
        CaseError::Key(Box::new(layers.error_nowhere("", &message, remedy)))
    })?;
    case.left_out = left_out;
    choose(&mut case, &layers);
    if case.name.is_empty() && get(&layers.table, "name").is_none() {
        case.name = name_from(path);
    }
    validation::check(&case, &layers)?;
    write_defaults(&mut case);
    Ok(case)
}

/// Replaces values by those that the case holds, below the section or list `pattern`.
fn hold(table: &mut Table, pattern: &str) {
    for (name, value) in table {
        let pattern = join(pattern, name);
        match (keys::find(&pattern), value) {
            (Some(key), value) => *value = key.held(value),
            (None, Value::Table(section)) => hold(section, &pattern),
            (None, Value::Array(sections)) => {
                let sections = sections.iter_mut().filter_map(Value::as_table_mut);
                sections.for_each(|section| hold(section, &format!("{pattern}[]")));
            }
            _ => {}
        }
    }
}

/// The choices that follow from which keys are given.
fn choose(case: &mut Case, layers: &Layers) {
    if get(&layers.table, "drive.mode").is_none() && case.drive.torque.is_some() {
        case.drive.mode = DriveMode::Torque;
    }
}

fn write_defaults(case: &mut Case) {
    if case.is_half_space() {
        case.half_space.inertia.get_or_insert(true);
    }
    if case.drive.rises() {
        case.drive.ramp = Some(case.drive.ramp());
    }
    case.friction.write_defaults(case.contact.enforcement == Enforcement::Exact);
    if case.contact.enforcement == Enforcement::Exact {
        case.contact.rows.get_or_insert_default();
    }
    if case.element.contact_layers == ContactLayers::Full {
        case.element.layers = Some(case.contact_layers());
        case.element.volumetric.get_or_insert_default();
    }
    if !case.is_half_space() {
        case.damping.kelvin_voigt = Some(case.kelvin_voigt());
    }
    if case.time.step.is_none() {
        case.time.factor = Some(case.factor());
    }
    if case.time.duration.is_none() {
        case.time.roll = Some(case.rolled());
    }
    if case.mesh.file.is_some() {
        case.mesh.unit.get_or_insert_default();
        let sets = &mut case.mesh.sets;
        for (set, name) in [
            (&mut sets.disk, "disk"),
            (&mut sets.bar, "bar"),
            (&mut sets.hub, "hub"),
            (&mut sets.tread, "tread"),
            (&mut sets.top, "top"),
            (&mut sets.clamp, "clamp"),
        ] {
            set.get_or_insert_with(|| name.to_owned());
        }
    } else {
        case.mesh.grading = Some(case.mesh.grading());
    }
    case.preload.tolerance = Some(case.preload_tolerance());
    case.preload.max_iterations = Some(case.preload_iterations());
    case.guards.parted = case.longest_parted();
    case.guards.friction = case.largest_friction();
    if case.evaluate.transits.is_none() {
        case.evaluate.last = Some(case.evaluate_last());
    }
    case.output.fields_interval = Some(case.fields_interval());
}

/// The file's stem, with whatever a folder's name should not have replaced.
fn name_from(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
    let name: String = stem.chars().map(|c| if name::may_hold(c) { c } else { '-' }).collect();
    if name.trim_matches(['.', ' ']).is_empty() { "case".into() } else { name }
}
