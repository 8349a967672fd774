//! Files that commands write where they are told to.

use std::path::{Path, PathBuf};

use crate::run::folder::VTKHDF;
use output::files::made::{Made, OutputRefused, VTU, check};
use serde::Serializer;

use crate::Error;

/// A mesh in Gmsh's format.
const MSH: Made = Made {
    what: "mesh",
    endings: &["msh"],
    start: ::mesh::import::GMSH_MARK.as_bytes(),
    marks: &[],
    proof: None,
};

/// Serializes a path as it is shown, whatever its bytes are.
pub fn shown<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}

/// Refuses the file of an option where writing it would replace an input, or what this program did not
/// write.
pub fn claim(option: &str, path: &Path, made: &Made, inputs: &[PathBuf]) -> Result<(), Error> {
    check(path, made, inputs).map_err(|refused| refusal(option, &refused))
}

/// The same for a grid; a file of a run is the run's alone.
pub fn claim_grid(option: &str, path: &Path, inputs: &[PathBuf]) -> Result<(), Error> {
    let made = match path.extension().and_then(|ending| ending.to_str()) {
        Some("vtu") => &VTU,
        Some("msh") => &MSH,
        _ => &VTKHDF,
    };
    if crate::run::folder::is_of_a_run(path) {
        return Err(of_the_run(option, path));
    }
    claim(option, path, made, inputs)
}

/// The refusal to write over a file of a run.
pub fn of_the_run(option: &str, path: &Path) -> Error {
    let problem = format!("{option} {}: this is a file of the run itself", path.display());
    Error::option(problem, format!("choose another file with {option} FILE"))
}

fn refusal(option: &str, refused: &OutputRefused) -> Error {
    let text = output::files::printable(format!("{option} {refused}").trim_start());
    Error::option(text, refused.remedy())
}
