//! The figures of a sweep.

use super::creep_force::{CREEP_FORCE, creep_force};
use super::groups::{Group, Sweep, short};
use super::limits::{LIMITS, limits};
use super::lines::{GROUPS, axis_over, ends, label, line, spans_decades};
use super::measures::{MEASURES, SweepMeasure};
use super::profiles::{Profile, profile};
use super::verdict::towards_zero;
use crate::chart::{Axis, Cell, Draw, Figure, Fill, Key, Panel, Scale, Series, viridis};
use crate::sweep::result::{Measured, SweepResult};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// All figures of a sweep with the names of their files: `measures-AXIS`, each measure over an axis;
/// `profiles-AXIS`, the centre lines along it; for two axes `map`, measures over both; and `creep-force`
/// ([`creep_force_figure`](super::creep_force_figure)); `limits`, the measures of the three questions. Runs that did not complete are left out, and so
/// are contact histories that cannot be read.
///
/// `folder` is the folder of the sweep.
pub fn sweep_figures(folder: &Path, sweep: &SweepResult) -> Vec<(String, Figure)> {
    let sweep = Sweep::of(folder, sweep);
    let mut all = Vec::new();
    let mut known = BTreeMap::new();
    for axis in sweep.numeric_axes() {
        let groups = sweep.groups(axis);
        if let Some(figure) = measures(axis, &groups, &sweep) {
            all.push((format!("measures-{}", stem(axis)), figure));
        }
        if let Some(figure) = groups.first().and_then(|g| profiles(&sweep, axis, g, &mut known)) {
            all.push((format!("profiles-{}", stem(axis)), figure));
        }
    }
    if let [first, second] = sweep.numeric_axes()[..]
        && let Some(figure) = maps(&sweep, [first, second])
    {
        all.push(("map".into(), figure));
    }
    if let Some(figure) = limits(&sweep) {
        all.push((LIMITS.into(), figure));
    }
    if let Some(figure) = creep_force(&[(String::new(), &sweep)]) {
        all.push((CREEP_FORCE.into(), figure));
    }
    all
}

/// The key of an axis as part of a file name.
fn stem(axis: &str) -> String {
    axis.replace(|c: char| !c.is_ascii_alphanumeric(), "-")
}

/// Every measure over an axis, a line for each group, with bars for its uncertainty.
fn measures(axis: &str, groups: &[Group<'_>], sweep: &Sweep<'_>) -> Option<Figure> {
    let x = axis_over(&label(axis, sweep.form(axis)), &sweep.values(axis));
    let mut panels = Vec::new();
    for measure in &MEASURES {
        panels.extend(panel(measure, &x, groups, panels.is_empty()));
    }
    if panels.is_empty() {
        return None;
    }
    let left_out = sweep.runs.iter().filter(|run| !run.completed()).count();
    let left_out = match left_out {
        0 => String::new(),
        n => format!(" {n} of {} runs did not complete and are left out.", sweep.runs.len()),
    };
    let refined = if towards_zero(axis) { "left" } else { "right" };
    let caption = format!(
        "Measures over {axis}; bars: the 95 % confidence interval of the mean, where there is none the \
         standard deviation over the records of the evaluation window. Verdicts follow the axis \
         to the {refined}.{left_out}"
    );
    let size = [1080, 270 * panels.len().div_ceil(3) as u32 + 50];
    Some(Figure { size, columns: 3, panels, caption })
}

/// A measure over the axis `x`, a line for each group, which the legend names if it is `named`; `None` where no run
/// has it.
pub(super) fn panel(
    measure: &SweepMeasure,
    x: &Axis,
    groups: &[Group<'_>],
    named: bool,
) -> Option<Panel> {
    let points: Vec<Vec<(f64, Measured)>> = groups.iter().map(|g| g.points(measure)).collect();
    let all = || points.iter().flatten();
    if all().count() == 0 {
        return None;
    }
    let log = spans_decades(all().map(|(_, point)| point.value));
    let heading = measure.heading();
    let [least, most] = measure.bounds();
    // on a logarithmic axis a bar that reaches below zero ends a decade below the least value
    let least =
        if log { 0.1 * all().map(|(_, p)| p.value).fold(f64::INFINITY, f64::min) } else { least };
    let bounds = [least, most];
    let ends = all().map(|(_, point)| ends(point, bounds));
    let y = if log { Axis::log(&heading) } else { wide_enough(&heading, ends) };
    let mut series = Vec::new();
    for (k, (group, points)) in groups.iter().zip(&points).enumerate() {
        let label = if named { group.label.clone() } else { String::new() };
        series.extend(line(label, GROUPS[k % GROUPS.len()], points, bounds));
    }
    Some(Panel { series, ..Panel::new(x.clone(), y) })
}

/// A linear axis of at least 6 % of its middle, so that small changes do not fill it.
fn wide_enough(heading: &str, bars: impl Iterator<Item = [f64; 2]>) -> Axis {
    let ends = bars.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], bar| {
        [low.min(bar[0]), high.max(bar[1])]
    });
    let middle = 0.5 * (ends[0] + ends[1]);
    let half = (0.52 * (ends[1] - ends[0])).max(0.03 * middle.abs());
    let axis = Axis::linear(heading);
    if half > 0.0 { axis.over(middle - half, middle + half) } else { axis }
}

/// The centre lines of a group of runs, coloured by the axis.
fn profiles(
    sweep: &Sweep<'_>,
    axis: &str,
    group: &Group<'_>,
    known: &mut BTreeMap<PathBuf, Option<Profile>>,
) -> Option<Figure> {
    let count = group.members.len();
    let mut lines = Vec::new();
    for (k, (x, run)) in group.members.iter().enumerate() {
        let Some(folder) = run.folder().map(|run| sweep.folder.join(run)) else {
            continue;
        };
        known.entry(folder.clone()).or_insert_with(|| profile(&folder).ok());
        // the lightest yellow does not show on paper
        let colour = viridis(0.9 * k as f64 / (count - 1).max(1) as f64);
        lines.push((short(*x), colour, folder));
    }
    lines.retain(|(.., folder)| known[folder].is_some());
    if lines.is_empty() {
        return None;
    }
    let quantities: [(&str, usize, f64); 3] =
        [("mean p_{n} (MPa)", 1, 1e-6), ("mean p_{f} (MPa)", 2, 1e-6), ("mean |s| (m/s)", 3, 1.0)];
    let panels = quantities.map(|(heading, column, factor)| Panel {
        series: lines
            .iter()
            .filter_map(|(label, colour, folder)| {
                let Profile(points) = known[folder].as_ref()?;
                Some(Series {
                    label: label.clone(),
                    points: points.iter().map(|p| [1e3 * p[0], factor * p[column]]).collect(),
                    draw: Draw::Line(*colour),
                })
            })
            .collect(),
        ..Panel::new(Axis::linear("x from the patch's centre (mm)"), Axis::linear(heading))
    });
    let others =
        if group.label.is_empty() { String::new() } else { format!(" with {}", group.label) };
    let caption = format!(
        "Pressure, shear and slip speed along y = 0, mean over the evaluation window in bins of an \
         element's length that move with the patch, for the values of {axis}{others}."
    );
    Some(Figure { size: [1080, 400], columns: 3, panels: panels.into(), caption })
}

/// Measures that change by less than this share are named below the maps instead of drawn.
const SHOWN: f64 = 0.01;

/// Each measure over two axes as a colour map.
fn maps(sweep: &Sweep<'_>, axes: [&str; 2]) -> Option<Figure> {
    let values = axes.map(|axis| sweep.values(axis));
    let edges = [0, 1].map(|i| edges(&values[i]));
    let (mut panels, mut constant) = (Vec::new(), Vec::new());
    for measure in MEASURES.iter().filter(|measure| measure.in_table) {
        let found: Vec<([usize; 2], f64)> = sweep
            .completed()
            .filter_map(|run| {
                let at = |i: usize| {
                    let value = sweep.number(run, axes[i])?;
                    values[i].iter().position(|known| *known == value)
                };
                Some(([at(0)?, at(1)?], measure.of(run)?.value))
            })
            .collect();
        let least = found.iter().map(|f| f.1).fold(f64::INFINITY, f64::min);
        let most = found.iter().map(|f| f.1).fold(f64::NEG_INFINITY, f64::max);
        // axes that vary together fill a diagonal, which is no map
        if found.len() <= values[0].len().max(values[1].len()) {
            continue;
        }
        if most - least <= SHOWN * most.abs().max(least.abs()) {
            constant.push(measure.name);
            continue;
        }
        let log = spans_decades(found.iter().map(|f| f.1));
        let key = Key::Values {
            label: String::new(), // the title has it: beside the colours long names find no room
            range: [rounded(least), rounded(most)],
            scale: if log { Scale::Log } else { Scale::Linear },
        };
        let cells = found.iter().map(|([i, j], value)| Cell {
            low: [edges[0][*i], edges[1][*j]],
            high: [edges[0][i + 1], edges[1][j + 1]],
            colour: key.colour(*value),
        });
        let cells = cells.collect();
        panels.push(Panel {
            title: measure.heading(),
            fill: Some(Fill { cells, key }),
            ..Panel::new(
                axis_over(&label(axes[0], sweep.form(axes[0])), &values[0]),
                axis_over(&label(axes[1], sweep.form(axes[1])), &values[1]),
            )
        });
    }
    if panels.is_empty() {
        return None;
    }
    let constant = if constant.is_empty() {
        String::new()
    } else {
        format!(" Not drawn, since they change by less than 1 %: {}.", constant.join(", "))
    };
    let caption = format!(
        "Measures over {} and {}; blank: no run completed there.{constant}",
        axes[0], axes[1]
    );
    let size = [1080, 290 * panels.len().div_ceil(3) as u32 + 50];
    Some(Figure { size, columns: 3, panels, caption })
}

/// To three significant digits, as the legend of a map shows it.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Ends of the cells around values: half-way between neighbours, on the scale of the axis (linear or
/// logarithmic).
fn edges(values: &[f64]) -> Vec<f64> {
    let log = spans_decades(values.iter().copied());
    let [to, from]: [fn(f64) -> f64; 2] = if log { [libm::log, libm::exp] } else { [|v| v, |v| v] };
    let places: Vec<f64> = values.iter().map(|value| to(*value)).collect();
    let n = places.len();
    let half = |i: usize| 0.5 * (places[i + 1] - places[i]);
    let mut edges = vec![places[0] - half(0)];
    edges.extend((0..n - 1).map(|i| places[i] + half(i)));
    edges.push(places[n - 1] + half(n - 2));
    edges.into_iter().map(from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_meet_half_way_between_the_values_of_an_axis() {
        assert_eq!(edges(&[1.0, 2.0, 4.0]), [0.5, 1.5, 3.0, 5.0]);
        let log = edges(&[1.0, 100.0]);
        for (found, expected) in log.iter().zip([0.1, 10.0, 1000.0]) {
            assert!((found / expected - 1.0f64).abs() < 1e-12, "{log:?}");
        }
    }
}
