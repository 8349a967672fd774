//! Differences between runs: slip and shear over place and time, their means and standard deviations, and the
//! rate at which a small disturbance grows between twins (runs of one mesh with records at the same times).
//!
//! The pointwise difference shows whether refinement converges to one slip s(x, t); where it does not, means
//! and standard deviations may still converge.

mod difference;
mod figure;
mod growth;
mod result;

use crate::chart::Figure;
use crate::check::PostError;
use crate::check::basis::{Basis, RunPaths};
use crate::check::centreline::{CentreLine, PLACES};
use crate::check::conditions::IN_CONTACT;
use crate::check::frames::ContactHistory;
use crate::check::judged_faces;
use crate::check::result::View;
use crate::check::slip_zone::SlipZone;
use crate::check::statistics::time_weights;
use crate::check::window::{Span, Window};
use contact::mesh_mode::{LEAST_SLIP, MeshMode};
use difference::INSTANTS;

pub use result::{
    ComparedRun, ComparisonGrid, ComparisonResult, Difference, GrownOver, Growth, RunDifference,
};

/// A run to compare.
pub struct Compared {
    /// Paths of its files.
    pub paths: RunPaths,
    /// Its law and scales.
    pub basis: Basis,
}

/// The result of a comparison.
pub struct Comparison {
    /// What `creepage compare --json` prints.
    pub result: ComparisonResult,
    /// Slip speed along the centre line, mean in time and one standard deviation to either side.
    pub figure: Figure,
}

/// The centre line of a run over the window.
struct RunLine {
    line: CentreLine,
    /// The time in the window that each record stands for (s).
    weights: Vec<f64>,
    zone: Option<SlipZone>,
    /// The largest slip speed (m/s) in the zone, and the span of time (s) that it is the largest of.
    largest: Option<f64>,
    largest_over: [f64; 2],
    /// Alternating slip over all faces in contact, in every record of the window.
    mesh_mode: MeshMode,
}

/// Compares runs of one geometry and speed, each with the one before it, over `window`; where that is `None`,
/// over the first `[[output.window]]` of the first run, else its evaluation window, else the time that all runs
/// have records of. The largest slip speed of a run is that of its evaluation window, unless a window is asked for.
///
/// # Errors
/// Fewer than two runs; files that cannot be read; a run without a record in the window, or whose speed, half
/// axis or peak pressure is not known.
pub fn compare(runs: &mut [Compared], window: Option<Span>) -> Result<Comparison, PostError> {
    let [first, .., _] = &*runs else {
        return Err(PostError::Asked("two runs or more are needed".into()));
    };
    let histories: Vec<ContactHistory> = runs
        .iter()
        .map(|run| ContactHistory::open(&run.paths.contact))
        .collect::<Result<_, _>>()?;
    let asked = window.map(|window| window.resolve(&first.basis, &histories[0])).transpose()?;
    let window = asked.or_else(|| first.basis.recorded_window()).or(first.basis.window);
    let window = window.unwrap_or_else(|| {
        let ends = |h: &ContactHistory| [h.times[0], h.times[h.times.len() - 1]];
        histories
            .iter()
            .map(ends)
            .fold([f64::NEG_INFINITY, f64::INFINITY], |[a, b], [c, d]| [a.max(c), b.min(d)])
    });
    let mut lines = Vec::new();
    for (run, history) in runs.iter_mut().zip(&histories) {
        let mut line = read(history, &mut run.basis, window)?;
        if asked.is_none() {
            (line.largest, line.largest_over) = largest(history, &mut run.basis)?;
        }
        lines.push(line);
    }
    let labels = labels(runs);
    let described: Vec<ComparedRun> = runs
        .iter()
        .zip(&labels)
        .zip(&lines)
        .map(|((run, label), line)| describe(run, label, line))
        .collect();
    let mut differences = Vec::new();
    for k in 1..runs.len() {
        let [a, b] = [&lines[k - 1], &lines[k]];
        let bases = [&runs[k - 1].basis, &runs[k].basis];
        differences.push(RunDifference {
            from: labels[k - 1].clone(),
            to: labels[k].clone(),
            slip: difference::of([a, b], |line| &line.slip, window),
            shear: difference::of([a, b], |line| &line.shear, window),
            growth: growth::growth(bases, [&histories[k - 1], &histories[k]])?,
        });
    }
    let reach = lines.iter().map(|line| line.line.reach).fold(0.0, f64::max);
    let result = ComparisonResult {
        window,
        grid: ComparisonGrid { from: -reach, to: reach, places: PLACES, instants: INSTANTS },
        runs: described,
        differences,
        figure: None,
    };
    Ok(Comparison { result, figure: figure::figure(&labels, &lines, window) })
}

/// What tells the runs apart: the names of their cases, else of their folders, else the folders as they were given.
fn labels(runs: &[Compared]) -> Vec<String> {
    let names: [fn(&Compared) -> String; 3] = [
        |run| run.basis.name.clone(),
        |run| run.paths.name(),
        |run| run.paths.folder.display().to_string(),
    ];
    let alone = |name: fn(&Compared) -> String, run: &Compared| {
        runs.iter().filter(|other| name(other) == name(run)).count() == 1
    };
    let label = |run: &Compared| {
        let name = names.into_iter().find(|name| alone(*name, run)).unwrap_or(names[2]);
        name(run)
    };
    runs.iter().map(label).collect()
}

/// What is compared of a run.
fn describe(run: &Compared, label: &str, line: &RunLine) -> ComparedRun {
    let zone = line.zone.as_ref();
    ComparedRun {
        name: run.basis.name.clone(),
        label: label.into(),
        folder: run.paths.folder.display().to_string(),
        side: View::of(line.line.body),
        largest: line.largest,
        largest_over: line.largest_over,
        mean: zone.map(|zone| zone.mean),
        fluctuation: zone.and_then(|zone| zone.fluctuation),
        fluctuating_share: zone.and_then(|zone| zone.fluctuating_share),
        slip_zone: zone.map(|zone| zone.measured(&line.line)),
        alternating_slip: line.mesh_mode.share(LEAST_SLIP * line.line.speed.abs()),
    }
}

/// Reads a run over `window`.
fn read(
    history: &ContactHistory,
    basis: &mut Basis,
    window: [f64; 2],
) -> Result<RunLine, PostError> {
    let mut line = CentreLine::new(history, basis)?;
    let p0 = basis.scale("peak_pressure").ok_or(PostError::Unknown {
        name: "Hertz's peak pressure",
        remedy: "the run's summary or case.toml gives it",
    })?;
    let surface = &history.surface;
    let faces = judged_faces(history);
    let records = history.window(window)?;
    let all = time_weights(&history.times, window);
    // one record more at each end, where there is one, to interpolate at the ends of the window
    let around = records.start.saturating_sub(1)..(records.end + 1).min(history.times.len());
    let mut mesh_mode = MeshMode::default();
    history.stream(around.clone(), |frame| {
        if records.contains(&frame.index) {
            let in_contact = |node: usize| frame.pressure[node] > IN_CONTACT * p0;
            mesh_mode.add(all[frame.index], &faces, &frame.slip_velocity, in_contact);
        }
        line.take(surface, &frame);
        Ok(())
    })?;
    let weights: Vec<f64> =
        around.map(|record| if records.contains(&record) { all[record] } else { 0.0 }).collect();
    let zone = SlipZone::of(&line, &weights);
    let largest = zone.as_ref().map(|zone| zone.largest);
    Ok(RunLine { line, weights, zone, largest, largest_over: window, mesh_mode })
}

/// The largest slip speed (m/s) in the slip zone over the run's evaluation window, as `creepage check` gives it, and that
/// window (s): the span in which records lie close enough for differences is too short for what happens seldom.
fn largest(
    history: &ContactHistory,
    basis: &mut Basis,
) -> Result<(Option<f64>, [f64; 2]), PostError> {
    let window = Window::resolve(None, basis, history)?;
    let mut line = CentreLine::new(history, basis)?;
    history.stream(window.records.clone(), |frame| {
        line.take(&history.surface, &frame);
        Ok(())
    })?;
    let zone = SlipZone::of(&line, &window.weights(&history.times));
    Ok((zone.map(|zone| zone.largest), window.ends(&history.times)))
}
