//! LS-DYNA keyword files of a disk on a bar.

use std::fs;
use std::path::{Path, PathBuf};

use crate::case::Case;
use crate::ls_dyna::{Account, Source, Units, translate};
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::commands::outputs::shown;
use crate::commands::values::parsed;

const ELSEWHERE: &str = "choose another folder with --out DIR";

/// The file to read, and where the case goes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ImportKOptions {
    /// The keyword file
    #[cfg_attr(feature = "clap", arg(value_name = "FILE.k"))]
    pub file: PathBuf,
    /// Units of the file: length (m, cm, mm, in), mass (kg, ton, g), time (s, ms, us)
    #[serde(deserialize_with = "parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "mm-ton-s"))]
    pub unit: Units,
    /// Read included files that lie outside the folder of FILE.k as well
    #[serde(default)]
    #[cfg_attr(feature = "clap", arg(long))]
    pub include_outside: bool,
    /// Folder for case.toml and mesh.inp [default: the file's name without its ending]
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR"))]
    pub out: Option<PathBuf>,
}

/// A case made of a keyword file: the document of `creepage import-k --json`.
#[derive(Clone, Debug, Serialize)]
pub struct ImportedK {
    /// The case file.
    #[serde(serialize_with = "shown")]
    pub case: PathBuf,
    /// The mesh file.
    #[serde(serialize_with = "shown")]
    pub mesh: PathBuf,
    /// Number of elements.
    pub elements: usize,
    /// What the keyword file lost.
    pub notes: Vec<String>,
    /// What became of its cards.
    pub cards: Account,
}

/// Makes a case and a mesh file of a keyword file.
///
/// # Errors
/// A card that is not known, by its file and line; an included file that must not be read; files that are there already or cannot be written; a case that cannot be run.
pub fn import_k(options: &ImportKOptions) -> Result<ImportedK, Error> {
    let source = Source { file: &options.file, include_outside: options.include_outside };
    let made = translate(&source, options.unit, "mesh.inp")?;
    let folder = options.out.clone().unwrap_or_else(|| options.file.with_extension(""));
    let [case, mesh] = ["case.toml", "mesh.inp"].map(|name| folder.join(name));
    if let Some(there) = [&case, &mesh].into_iter().find(|path| path.exists()) {
        return Err(Error::option(format!("{} is there already", there.display()), ELSEWHERE));
    }
    write(&folder, &mesh, &made.mesh)?;
    write(&folder, &case, &made.case)?;
    // the case is judged as any other, so that what is wrong is told now
    let found = crate::run::mesh_report(&Case::load(&case, &[])?, None, None)?;
    let (elements, notes, cards) = (found.elements, made.notes, made.cards);
    Ok(ImportedK { case, mesh, elements, notes, cards })
}

fn write(folder: &Path, path: &Path, text: &str) -> Result<(), Error> {
    let written = fs::create_dir_all(folder).and_then(|()| fs::write(path, text));
    written.map_err(|cause| Error::option(format!("{}: {cause}", path.display()), ELSEWHERE))
}
