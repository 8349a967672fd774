//! LS-DYNA keyword files of a disk on a bar.

use std::fs;
use std::path::{Path, PathBuf};

use crate::case::Case;
use crate::ls_dyna::{Account, Source, Units, translate};
use serde_json::{Value, json};

use crate::Error;
#[cfg(feature = "clap")]
use crate::commands::values::words::units;

const ELSEWHERE: &str = "choose another folder with --out DIR";

/// The file to read, and where the case goes.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ImportKOptions {
    /// The keyword file
    #[cfg_attr(feature = "clap", arg(value_name = "FILE.k"))]
    pub file: PathBuf,
    /// Units of the file: length (m, cm, mm, in), mass (kg, ton, g), time (s, ms, us)
    #[cfg_attr(feature = "clap", arg(long, value_name = "mm-ton-s", value_parser = units))]
    pub unit: Units,
    /// Read included files that lie outside the folder of FILE.k as well
    #[cfg_attr(feature = "clap", arg(long))]
    pub include_outside: bool,
    /// Folder for case.toml and mesh.inp [default: the file's name without its ending]
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR"))]
    pub out: Option<PathBuf>,
}

/// Makes a case and a mesh file of a keyword file, and returns the document of `creepage import-k --json`: case, mesh,
/// elements, notes, and cards: how many were used, ignored and refused.
///
/// # Errors
/// A card that is not known, by its file and line; an included file that must not be read; files that are there already or cannot be written; a case that cannot be run.
pub fn import_k(options: &ImportKOptions) -> Result<Value, Error> {
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
    let found = crate::run::mesh_report(&Case::load(&case, &[])?, None)?;
    let Account { used, ignored, refused } = made.cards;
    Ok(json!({
        "case": case.display().to_string(),
        "mesh": mesh.display().to_string(),
        "elements": found["elements"].as_u64().unwrap_or_default(),
        "notes": made.notes,
        "cards": { "used": used, "ignored": ignored, "refused": refused },
    }))
}

fn write(folder: &Path, path: &Path, text: &str) -> Result<(), Error> {
    let written = fs::create_dir_all(folder).and_then(|()| fs::write(path, text));
    written.map_err(|cause| Error::option(format!("{}: {cause}", path.display()), ELSEWHERE))
}
