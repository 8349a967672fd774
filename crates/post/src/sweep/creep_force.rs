//! The creep-force curve: the tangential force that a creepage needs.

use super::document::Sweep;
use super::lines::{GROUPS, line};
use super::measures::{MEASURES, Point, SweepMeasure};
use crate::PostError;
use figure::{Axis, Figure, Panel};
use serde_json::Value;
use std::path::Path;

/// Name of the figure.
pub(super) const CREEP_FORCE: &str = "creep-force";

/// The axis of the curve.
const CREEPAGE: &str = "drive.creepage";

/// A sweep beside others in a figure.
pub struct ComparedSweep<'a> {
    /// Its name in the legend.
    pub name: String,
    /// Its folder.
    pub folder: &'a Path,
    /// The content of its `sweep.json`.
    pub document: &'a Value,
}

/// T/N over `drive.creepage`, from sweeps of the same axes by several methods: a panel for each value of the other
/// axes, a line for each sweep, with bars for the uncertainty. `None` where no sweep has at least two
/// creepages.
///
/// # Errors
/// A document that is no sweep.
pub fn creep_force_figure(
    sweeps: &[ComparedSweep<'_>],
) -> Result<Option<(String, Figure)>, PostError> {
    let mut known = Vec::new();
    for ComparedSweep { name, folder, document } in sweeps {
        known.push((name.clone(), Sweep::of(folder, document)?));
    }
    let known: Vec<_> = known.iter().map(|(name, sweep)| (name.clone(), sweep)).collect();
    Ok(creep_force(&known).map(|figure| (CREEP_FORCE.into(), figure)))
}

/// A curve: the values of the other axes, the name of the sweep, and T/N over creepage (10⁻³).
struct Curve {
    others: String,
    sweep: String,
    points: Vec<(f64, Point)>,
}

/// The figure of sweeps with their names. A single sweep has all its curves in one panel.
pub(super) fn creep_force(sweeps: &[(String, &Sweep<'_>)]) -> Option<Figure> {
    let measure = MEASURES.iter().find(|measure| measure.name == "T/N")?;
    let curves: Vec<Curve> = sweeps
        .iter()
        .filter(|(_, sweep)| sweep.numeric_axes().contains(&CREEPAGE))
        .flat_map(|(name, sweep)| curves(name, sweep, measure))
        .collect();
    if curves.is_empty() {
        return None;
    }
    let alone = sweeps.len() == 1;
    let distinct = |name: fn(&Curve) -> &String| {
        let mut all: Vec<&String> = Vec::new();
        for name in curves.iter().map(name) {
            if !all.contains(&name) {
                all.push(name);
            }
        }
        all
    };
    let titles = if alone { vec![] } else { distinct(|curve| &curve.others) };
    let names =
        if alone { distinct(|curve| &curve.others) } else { distinct(|curve| &curve.sweep) };
    let colour = |name: &String| {
        let k = names.iter().position(|known| *known == name).unwrap_or(0);
        GROUPS[k % GROUPS.len()]
    };
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let most = points().map(|(x, _)| *x).fold(0.0, f64::max);
    let x = Axis::linear("creepage (10\u{207b}\u{b3})").over(0.0, 1.03 * most);
    let top = points().map(|(_, point)| point.value);
    let y = Axis::linear("T/N").over(0.0, 1.08 * top.fold(0.0, f64::max));
    let panel = |title: String, shown: Vec<&Curve>, legend: bool| Panel {
        title,
        x: x.clone(),
        y: y.clone(),
        fill: None,
        series: shown
            .iter()
            .flat_map(|curve| {
                let name = if alone { &curve.others } else { &curve.sweep };
                let shown = if legend { name.clone() } else { String::new() };
                line(shown, colour(name), &curve.points, false)
            })
            .collect(),
        marks: Vec::new(),
    };
    let panels: Vec<Panel> = if alone {
        vec![panel(String::new(), curves.iter().collect(), true)]
    } else {
        let of = |title: &String| curves.iter().filter(|curve| curve.others == *title).collect();
        let panels = titles.iter().enumerate();
        panels.map(|(k, title)| panel((*title).clone(), of(title), k == 0)).collect()
    };
    let lines =
        if alone { "a line for each value of the other axes" } else { "a line for each sweep" };
    let caption = format!(
        "Tangential over normal force over the creepage, {lines}; bars: the 95 % confidence interval \
         of the mean, where there is none the standard deviation over the records of the \
         evaluation window."
    );
    let columns = panels.len().min(3);
    let rows = panels.len().div_ceil(3) as u32;
    let size = if alone { [720, 460] } else { [360 * columns as u32, 300 * rows + 50] };
    Some(Figure { size, columns, panels, caption })
}

/// The curves of a sweep.
fn curves(name: &str, sweep: &Sweep<'_>, measure: &SweepMeasure) -> Vec<Curve> {
    let groups = sweep.groups(CREEPAGE).into_iter();
    groups
        .map(|group| Curve {
            others: group.label,
            sweep: name.to_owned(),
            points: group
                .members
                .iter()
                .filter_map(|(x, run)| Some((1e3 * x, measure.of(*run)?)))
                .collect(),
        })
        .filter(|curve| curve.points.len() > 1)
        .collect()
}
