//! The creep-force curve: the tangential force that a creepage needs.

use super::groups::Sweep;
use super::lines::{GROUPS, line};
use super::measures::{MEASURES, SweepMeasure, UNBOUNDED};
use crate::chart::{Axis, Figure, Panel};
use crate::sweep::result::{Measured, SweepResult};
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
    /// What it came to.
    pub result: &'a SweepResult,
}

/// T/N over `drive.creepage`, from sweeps of the same axes by several methods: a panel for each value of the other
/// axes, a line for each sweep, with bars for the uncertainty. `None` where no sweep has at least two
/// creepages.
pub fn creep_force_figure(sweeps: &[ComparedSweep<'_>]) -> Option<(String, Figure)> {
    let known = sweeps.iter().map(|sweep| Sweep::of(sweep.folder, sweep.result));
    let known: Vec<_> = known.collect();
    let names = sweeps.iter().map(|sweep| sweep.name.clone());
    let figure = creep_force(&names.zip(&known).collect::<Vec<_>>())?;
    Some((CREEP_FORCE.into(), figure))
}

/// A curve: the values of the other axes, the name of the sweep, and T/N over creepage (10⁻³).
struct Curve {
    others: String,
    sweep: String,
    points: Vec<(f64, Measured)>,
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
    let (panels, size, lines) = if sweeps.len() == 1 {
        let all: Vec<&Curve> = curves.iter().collect();
        let panel = panel(String::new(), &all, &curves, |curve| &curve.others, true);
        (vec![panel], [720, 460], "a line for each value of the other axes")
    } else {
        let titles = distinct(&curves, |curve| &curve.others);
        let of = |title: &str| curves.iter().filter(|c| c.others == title).collect::<Vec<_>>();
        let panels: Vec<Panel> = titles
            .iter()
            .enumerate()
            .map(|(k, title)| {
                panel((*title).into(), &of(title), &curves, |curve| &curve.sweep, k == 0)
            })
            .collect();
        let size = [360 * panels.len().min(3) as u32, 300 * panels.len().div_ceil(3) as u32 + 50];
        (panels, size, "a line for each sweep")
    };
    let caption = format!(
        "Tangential over normal force over the creepage, {lines}; bars: the 95 % confidence interval \
         of the mean, where there is none the standard deviation over the records of the \
         evaluation window.{}",
        free_rolling(&curves)
    );
    Some(Figure { size, columns: panels.len().min(3), panels, caption })
}

/// At which creepage the bodies roll freely, for each curve that passes through T = 0, as a sentence of the caption.
fn free_rolling(curves: &[Curve]) -> String {
    let found = curves.iter().filter_map(|curve| {
        let names = [curve.sweep.as_str(), curve.others.as_str()];
        let name = names.into_iter().filter(|name| !name.is_empty()).collect::<Vec<_>>().join(", ");
        let name = if name.is_empty() { name } else { format!(" ({name})") };
        curve.without_force().map(|creepage| format!("{creepage:.3}e-3{name}"))
    });
    match found.collect::<Vec<_>>() {
        found if found.is_empty() => String::new(),
        found => format!(" T = 0, by interpolation, at creepage {}.", found.join("; ")),
    }
}

impl Curve {
    /// The creepage (10⁻³) at which T/N changes its sign, between two of its points that are neighbours.
    fn without_force(&self) -> Option<f64> {
        self.points.windows(2).find_map(|pair| {
            let [(x, a), (y, b)] = [pair[0], pair[1]].map(|(x, point)| (x, point.value));
            (a < 0.0 && b >= 0.0).then(|| x - a * (y - x) / (b - a))
        })
    }
}

/// The names of curves, each once, in the order of the curves.
fn distinct(curves: &[Curve], name: fn(&Curve) -> &String) -> Vec<&str> {
    let mut all: Vec<&str> = Vec::new();
    for name in curves.iter().map(name) {
        if !all.contains(&name.as_str()) {
            all.push(name);
        }
    }
    all
}

/// A panel of some of `all` curves on axes that hold all of them, coloured by `name`.
fn panel(
    title: String,
    shown: &[&Curve],
    all: &[Curve],
    name: fn(&Curve) -> &String,
    legend: bool,
) -> Panel {
    let points = || all.iter().flat_map(|curve| &curve.points);
    let [left, right] = ends(points().map(|(x, _)| *x), 0.03);
    let [bottom, top] = ends(points().map(|(_, point)| point.value), 0.08);
    let names = distinct(all, name);
    let series = shown.iter().flat_map(|curve| {
        let place = names.iter().position(|known| known == name(curve)).unwrap_or(0);
        let label = if legend { name(curve).clone() } else { String::new() };
        line(label, GROUPS[place % GROUPS.len()], &curve.points, UNBOUNDED)
    });
    Panel {
        title,
        series: series.collect(),
        ..Panel::new(
            Axis::linear("creepage (10\u{207b}\u{b3})").over(left, right),
            Axis::linear("T/N").over(bottom, top),
        )
    }
}

/// The ends of an axis that holds zero and `values`, with this part of the largest to spare beyond the values.
fn ends(values: impl Iterator<Item = f64>, spare: f64) -> [f64; 2] {
    let [low, high] = values.fold([0.0f64; 2], |[low, high], x| [low.min(x), high.max(x)]);
    [low * (1.0 + spare), high * (1.0 + spare)]
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
