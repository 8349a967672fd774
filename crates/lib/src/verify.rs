//! The verification ladder.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use ::verify::{PROBLEMS, Problem, Row, Size};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::error::{FAILED, INTERRUPTED};
use crate::values::exclude;
use crate::{Error, Listener, convergence_plot, rupture_plot};

/// Which problems to run, and how.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct VerifyOptions {
    /// Problems to run [default: all]
    #[cfg_attr(feature = "clap", arg(value_name = "NAME"))]
    pub names: Vec<String>,
    /// Name all problems and run none
    #[cfg_attr(feature = "clap", arg(long, conflicts_with_all = ["names", "quick", "plot"]))]
    pub list: bool,
    /// Coarse meshes, for continuous integration
    #[cfg_attr(feature = "clap", arg(long))]
    pub quick: bool,
    /// Draw error over mesh size (convergence.svg, .png) and rupture times (rupture.svg, .png) in this folder
    #[cfg_attr(feature = "clap", arg(long, value_name = "FOLDER"))]
    pub plot: Option<PathBuf>,
}

/// What verification problems gave.
#[derive(Clone, Debug)]
pub struct Verified {
    /// The quantities, each beside its reference.
    pub rows: Vec<Row>,
    /// The document of `creepage verify --json`.
    pub document: Value,
    /// Whether it was interrupted between two problems.
    pub interrupted: bool,
}

impl Verified {
    /// Whether every quantity is within its limit.
    pub fn pass(&self) -> bool {
        self.rows.iter().all(|row| row.pass)
    }

    /// Exit code of the command line: 0, 1 where a quantity misses its limit, 130 when interrupted.
    pub fn exit_code(&self) -> u8 {
        match (self.interrupted, self.pass()) {
            (true, _) => INTERRUPTED,
            (false, true) => 0,
            (false, false) => FAILED,
        }
    }
}

/// Runs verification problems, each beside its reference; with [`VerifyOptions::list`] it only names them.
///
/// The listener hears each problem when it is done; its flag ends the command before the next.
///
/// # Errors
/// A problem that there is not, or that cannot be computed; figures that cannot be written.
pub fn verify(options: &VerifyOptions, listener: &mut dyn Listener) -> Result<Verified, Error> {
    let others = [
        ("a name", !options.names.is_empty()),
        ("--quick", options.quick),
        ("--plot", options.plot.is_some()),
    ];
    exclude(("--list", options.list), &others)?;
    let mut found = Verified { rows: Vec::new(), document: Value::Null, interrupted: false };
    if options.list {
        let named = |problem: &Problem| json!({ "name": problem.name, "about": problem.about });
        found.document = json!({ "problems": PROBLEMS.iter().map(named).collect::<Vec<_>>() });
        return Ok(found);
    }
    let problems = chosen(&options.names)?;
    let size = if options.quick { Size::Quick } else { Size::Full };
    let stop = listener.stop();
    for problem in problems {
        if stop.load(Ordering::Relaxed) {
            found.interrupted = true;
            return Ok(found);
        }
        listener.remark(&format!("{}: {}", problem.name, problem.about));
        let clock = Instant::now();
        let rows = problem.run(size)?;
        listener.verified(problem, &rows, clock.elapsed().as_secs_f64());
        found.rows.extend(rows);
    }
    if let Some(folder) = &options.plot {
        draw(&found.rows, folder)?;
    }
    let rows: Vec<Value> = found.rows.iter().map(document).collect();
    found.document = json!({ "results": rows, "pass": found.pass() });
    Ok(found)
}

fn draw(rows: &[Row], folder: &Path) -> Result<(), Error> {
    let figures =
        [("convergence", convergence_plot::figure(rows)), ("rupture", rupture_plot::figure(rows))];
    for (name, figure) in figures {
        if let Some(figure) = figure {
            figure.write(folder, name).map_err(|error| {
                Error::option(format!("--plot: {error}"), "give a folder that you may write to")
            })?;
        }
    }
    Ok(())
}

/// A row with the signed error on each mesh beside the values, over the reference where that is not zero.
fn document(row: &Row) -> Value {
    let mut document = json!(row);
    let scale = if row.reference == 0.0 { 1.0 } else { row.reference };
    let errors: Vec<f64> =
        row.meshes.iter().map(|sample| (sample.value - row.reference) / scale).collect();
    document["mesh_errors"] = json!(errors);
    document
}

fn chosen(names: &[String]) -> Result<Vec<&'static Problem>, Error> {
    if names.is_empty() {
        return Ok(PROBLEMS.iter().collect());
    }
    let unknown = |name: &String| {
        let problem = format!("there is no verification problem '{name}'");
        Error::option(problem, "`creepage verify --list` names all problems")
    };
    names.iter().map(|name| ::verify::find(name).ok_or_else(|| unknown(name))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn naming_all_problems_excludes_how_they_run() {
        let options = VerifyOptions { list: true, quick: true, ..VerifyOptions::default() };
        let error = verify(&options, &mut ()).unwrap_err();
        assert_eq!(error.to_string(), "--list cannot be used with --quick");
        assert_eq!(error.exit_code(), 2);
    }
}
