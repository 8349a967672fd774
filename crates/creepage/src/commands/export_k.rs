//! Cases as LS-DYNA keyword files.

use std::path::PathBuf;

use crate::ls_dyna::{RollingMotion, Units, export, unsayable};
use output::files::made::KEYWORDS;
use serde::{Deserialize, Serialize};

use crate::commands::outputs::{claim, shown};
use crate::commands::values::parsed;
use crate::{CaseSource, Error, Listener};

/// Whose keyword file, in which units, and where to write it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ExportKOptions {
    /// The case.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub case: CaseSource,
    /// The file to write [default: the case's name with .k]
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.k"))]
    pub out: Option<PathBuf>,
    /// Units of the file: length (m, cm, mm, in), mass (kg, ton, g), time (s, ms, us)
    #[serde(deserialize_with = "parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "mm-ton-s", default_value = "mm-ton-s"))]
    pub unit: Units,
}

/// A keyword file that was written: the document of `creepage export-k --json`.
#[derive(Clone, Debug, Serialize)]
pub struct ExportedK {
    /// The file.
    #[serde(serialize_with = "shown")]
    pub file: PathBuf,
    /// Its units.
    pub unit: String,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of elements.
    pub elements: usize,
    /// Time in which the deck presses the bodies together (s).
    pub preload_time: f64,
    /// What it says in another way than the case.
    pub notes: Vec<String>,
}

/// Writes a case as a keyword file.
///
/// The static preload is found first: the deck presses the hub down to its depth.
///
/// # Errors
/// What of the case keyword files cannot say; a case that cannot be run; a file that cannot be written, or is not to be written over.
pub fn export_k(options: &ExportKOptions, listener: &mut dyn Listener) -> Result<ExportedK, Error> {
    let case = options.case.load(listener)?;
    let cannot = unsayable(&case);
    if !cannot.is_empty() {
        let list: String = cannot.iter().map(|why| format!("\n  {why}")).collect();
        let file = options.case.path.display();
        return Err(Error::option(
            format!("{file}: keyword files cannot say{list}"),
            "change these keys with --set, or run the case here",
        ));
    }
    let out = options.out.clone().unwrap_or_else(|| format!("{}.k", case.name).into());
    claim("--out", &out, &KEYWORDS, &case.inputs())?;
    let placed = |error: crate::scenario::ScenarioError| case.placed(error.into());
    let model = crate::scenario::model(&case).map_err(placed)?;
    let stop = listener.stop();
    let start = crate::scenario::start(&case, &model, None, &stop, &mut |_| {}, &mut |_| Ok(()));
    let facts = start.map_err(placed)?.facts;
    let rolling = RollingMotion { case: &case, model: &model, facts: &facts };
    let made = export(&rolling, options.unit);
    std::fs::write(&out, made.deck).map_err(|cause| {
        Error::option(
            format!("--out {}: {cause}", out.display()),
            "choose another file with --out FILE",
        )
    })?;
    Ok(ExportedK {
        file: out,
        unit: options.unit.name(),
        nodes: model.mesh.nodes.len(),
        elements: model.mesh.hexes.len(),
        preload_time: rolling.preload_time(),
        notes: made.notes,
    })
}
