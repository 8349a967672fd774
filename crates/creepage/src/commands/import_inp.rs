//! Input files of CONTACT.

use std::fs;
use std::path::{Path, PathBuf};

use crate::case::Case;
use crate::contact_inp::inp_cases;
use output::files::input;
use serde::{Deserialize, Serialize};

use crate::Error;

/// The file to read, and where the cases go.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ImportInpOptions {
    /// The input file
    #[cfg_attr(feature = "clap", arg(value_name = "FILE.inp"))]
    pub file: PathBuf,
    /// The case of this number alone, counted from 1
    #[serde(default)]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub case: Option<usize>,
    /// Folder for the case files [default: the file's name without its ending]
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR"))]
    pub out: Option<PathBuf>,
}

/// Case files made of an input file: the document of `creepage import-inp --json`.
#[derive(Clone, Debug, Serialize)]
pub struct ImportedInp {
    /// The case files, by the numbers of their cases.
    pub cases: Vec<String>,
}

/// Makes case files of half-spaces of an input file.
///
/// # Errors
/// What half-spaces cannot say, by its name and line; a profile that cannot be read; files that are there already or cannot be
/// written; a case that cannot be run.
pub fn import_inp(options: &ImportInpOptions) -> Result<ImportedInp, Error> {
    let file = options.file.display();
    let text = input::text(&options.file, input::CASE)
        .map_err(|error| Error::option(format!("{file}: {}", error.problem()), error.remedy()))?;
    let parent = options.file.parent().unwrap_or(Path::new(""));
    let all = inp_cases(&text, parent, options.case).map_err(|error| {
        let remedy = "half-spaces say steady rolling of one material by a force and creepages: change the file, or run it with CONTACT";
        Error::option(format!("{file}: {error}"), remedy)
    })?;
    if all.is_empty() {
        let problem = format!("{file} holds no such case");
        return Err(Error::option(problem, "leave --case out, or give a number that it has"));
    }
    let folder = options.out.clone().unwrap_or_else(|| options.file.with_extension(""));
    let mut cases = Vec::new();
    for case in all {
        let path = folder.join(format!("case-{}.toml", case.number));
        write(&folder, &path, &case.text)?;
        // the case is judged as any other, so that what is wrong is told now
        Case::load(&path, &[])?;
        cases.push(path.display().to_string());
    }
    Ok(ImportedInp { cases })
}

fn write(folder: &Path, path: &Path, text: &str) -> Result<(), Error> {
    const ELSEWHERE: &str = "choose another folder with --out DIR";
    if path.exists() {
        return Err(Error::option(format!("{} is there already", path.display()), ELSEWHERE));
    }
    let written = fs::create_dir_all(folder).and_then(|()| fs::write(path, text));
    written.map_err(|cause| Error::option(format!("{}: {cause}", path.display()), ELSEWHERE))
}
