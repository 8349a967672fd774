//! The reference cases: their list, and copies of them.

use std::fs;
use std::path::PathBuf;

use output::files::input;
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::case::json_schema;
use crate::case::reference::{REFERENCES, ReferenceCase, did_you_mean};

/// The schema that the cases name.
const SCHEMA: &str = "case.schema.json";

/// Which reference cases to copy, and where to.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CasesOptions {
    /// Copy these, with those that they extend or sweep over [default: list all]
    #[cfg_attr(feature = "clap", arg(value_name = "NAME"))]
    pub names: Vec<PathBuf>,
    /// Folder of the copies [default: cases]
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR", requires = "names"))]
    pub out: Option<PathBuf>,
    /// Write over files that are there
    #[cfg_attr(feature = "clap", arg(long, requires = "names"))]
    pub force: bool,
}

/// A reference case: the name for a command, and what it is for.
#[derive(Clone, Debug, Serialize)]
pub struct ListedCase {
    /// Its name.
    pub name: &'static str,
    /// The command that runs it: `run` or `sweep`.
    pub command: &'static str,
    /// One line that says what it is for.
    pub title: String,
    /// Name of the one that it extends or sweeps over.
    pub below: Option<&'static str>,
}

impl From<&ReferenceCase> for ListedCase {
    fn from(of: &ReferenceCase) -> Self {
        let command = if of.is_sweep() { "sweep" } else { "run" };
        Self { name: of.name, command, title: of.title(), below: of.below().map(|of| of.name) }
    }
}

/// The reference cases, all or those copied: the document of `creepage cases --json`.
#[derive(Clone, Debug, Serialize)]
pub struct CasesFound {
    /// The cases.
    pub cases: Vec<ListedCase>,
    /// The files that were written.
    pub files: Vec<String>,
}

/// Lists the reference cases, or copies those that are named, with those below them and the schema of a case.
///
/// # Errors
/// A name that none has; a file that is there and has another text, without [`CasesOptions::force`]; a file that cannot
/// be written.
pub fn cases(options: &CasesOptions) -> Result<CasesFound, Error> {
    if options.names.is_empty() {
        let cases = REFERENCES.iter().map(ListedCase::from).collect();
        return Ok(CasesFound { cases, files: Vec::new() });
    }
    let wanted = wanted(options)?;
    let schema = serde_json::to_string_pretty(&json_schema());
    let schema = schema.map_err(|error| Error::plain(error.to_string()))? + "\n";
    let folder = options.out.clone().unwrap_or_else(|| "cases".into());
    let texts = wanted.iter().map(|of| (folder.join(of.file()), of.text));
    let texts: Vec<_> = texts.chain([(folder.join(SCHEMA), schema.as_str())]).collect();
    let differs = |(path, text): &&(PathBuf, &str)| {
        path.exists() && input::text(path, input::CASE).ok().as_deref() != Some(*text)
    };
    if !options.force
        && let Some((path, _)) = texts.iter().find(differs)
    {
        return Err(Error::option(
            format!("{}: there is another file of this name", path.display()),
            "choose another folder with --out DIR, or write over it with --force",
        ));
    }
    for (path, text) in &texts {
        fs::create_dir_all(path.with_file_name("")).and_then(|()| fs::write(path, text)).map_err(
            |error| Error::plain(format!("{}: cannot be written: {error}", path.display())),
        )?;
    }
    let files = texts.iter().map(|(path, _)| path.display().to_string()).collect();
    Ok(CasesFound { cases: wanted.into_iter().map(ListedCase::from).collect(), files })
}

/// The reference cases that the options name, each followed by those below it, none twice.
fn wanted(options: &CasesOptions) -> Result<Vec<&'static ReferenceCase>, Error> {
    let mut wanted = Vec::new();
    for name in &options.names {
        let named = ReferenceCase::named(name).ok_or_else(|| Error::Option {
            problem: format!("{}: there is no such reference case", name.display()),
            help: did_you_mean(name).or_else(|| Some("`creepage cases` lists them".into())),
        })?;
        for of in std::iter::successors(Some(named), |of| of.below()) {
            if !wanted.contains(&of) {
                wanted.push(of);
            }
        }
    }
    Ok(wanted)
}
