//! How far runs differ: slip and shear over place and time, their means, their statistics, and how fast a
//! small disturbance grows between twins.
//!
//! A pointwise difference says whether refinement leads to one slip s(x, t); where it does not, means and
//! standard deviations may still settle.

mod figure;
mod growth;
mod line;

use crate::PostError;
use crate::basis::{Basis, RunPaths};
use crate::frames::ContactHistory;
use ::figure::Figure;
use contact::mesh_mode::LEAST_SLIP;
use line::{INSTANTS, Line, PLACES};
use serde_json::{Value, json};

/// A run to compare.
pub struct Compared {
    /// Its files.
    pub paths: RunPaths,
    /// Its case and scales.
    pub basis: Basis,
}

/// What a comparison found.
pub struct Comparison {
    /// The document of `creepage compare`.
    pub document: Value,
    /// Slip speed along the centre line, mean in time and one standard deviation to either side.
    pub figure: Figure,
}

/// Compares runs of one geometry and speed, each with the one before it, over `window` (from and to, s) or the
/// span that the first run records most densely.
///
/// # Errors
/// Fewer than two runs, files that cannot be read, a window without records in every run, a case without
/// a speed.
pub fn compare(runs: &mut [Compared], window: Option<[f64; 2]>) -> Result<Comparison, PostError> {
    let [first, .., _] = &*runs else {
        return Err(PostError::Asked("two runs or more are needed".into()));
    };
    let window = window.or_else(|| first.basis.recorded_window()).or(first.basis.window);
    let histories: Vec<ContactHistory> = runs
        .iter()
        .map(|run| ContactHistory::open(&run.paths.contact))
        .collect::<Result<_, _>>()?;
    let window = window.unwrap_or_else(|| {
        let ends = |h: &ContactHistory| [h.times[0], h.times[h.times.len() - 1]];
        histories
            .iter()
            .map(ends)
            .fold([f64::NEG_INFINITY, f64::INFINITY], |[a, b], [c, d]| [a.max(c), b.min(d)])
    });
    let mut lines = Vec::new();
    for (run, history) in runs.iter_mut().zip(&histories) {
        lines.push(Line::read(history, &mut run.basis, window)?);
    }
    let described = runs.iter().zip(&lines).map(|(run, line)| {
        let least = LEAST_SLIP * line.speed;
        json!({ "name": run.basis.name, "folder": run.paths.folder, "side": line.side,
                "largest": line.slip.largest(), "mean": line.slip.mean(),
                "deviation": line.slip.mean_deviation(),
                "fluctuating_share": line.slip.fluctuating_share(),
                "alternating_slip": line.mesh_mode.share(least) })
    });
    let described: Vec<Value> = described.collect();
    let mut differences = Vec::new();
    for k in 1..runs.len() {
        let [a, b] = [&lines[k - 1], &lines[k]];
        differences.push(json!({
            "from": runs[k - 1].basis.name, "to": runs[k].basis.name,
            "slip": a.slip.difference(&b.slip), "shear": a.shear.difference(&b.shear),
            "growth": growth::growth(&histories[k - 1], &histories[k])?,
        }));
    }
    let reach = lines.iter().map(|line| line.reach).fold(0.0, f64::max);
    let document = json!({
        "window": window,
        "grid": { "from": -reach, "to": reach, "places": PLACES, "instants": INSTANTS },
        "runs": described,
        "differences": differences,
    });
    let names: Vec<&str> = runs.iter().map(|run| run.basis.name.as_str()).collect();
    Ok(Comparison { document, figure: figure::figure(&names, &lines, window) })
}
