//! Lines of measures over the axis of a sweep.

use crate::case::keys;
use crate::chart::{Axis, Draw, Series, colour};
use crate::sweep::result::Measured;

/// Colours of groups of runs.
pub(super) const GROUPS: [[u8; 3]; 6] =
    [colour::BLUE, colour::VERMILION, colour::GREEN, colour::PURPLE, colour::ORANGE, colour::BLACK];

/// The label of an axis: its key with the unit of its numbers in a form.
pub(super) fn label(axis: &str, form: &str) -> String {
    let unit = match axis {
        _ if form == "stiffness" => "N/m\u{b3}",
        "mesh.zone.size" | "time.roll" => "m",
        "time.step" | "drive.ramp" | "time.duration" | "damping.kelvin_voigt" => "s",
        "drive.speed" => "m/s",
        "drive.torque" => "Nm",
        "load.normal" => "N",
        "damping.mass" => "1/s",
        "material.young" => "Pa",
        _ if axis.starts_with("friction.") => {
            keys::find(axis).map(|key| key.unit).filter(|unit| !unit.is_empty()).unwrap_or("-")
        }
        _ => "-",
    };
    format!("{axis} ({unit})")
}

/// The axis of a figure for values of an axis of the sweep.
pub(super) fn axis_over(text: &str, values: &[f64]) -> Axis {
    let log = spans_decades(values.iter().copied());
    if log { Axis::log(text) } else { Axis::linear(text) }
}

/// A measure over an axis: a line, its points, and bars for their uncertainty.
pub(super) fn line(
    label: String,
    colour: [u8; 3],
    points: &[(f64, Measured)],
    log: bool,
) -> [Series; 3] {
    let places: Vec<[f64; 2]> = points.iter().map(|(x, point)| [*x, point.value]).collect();
    let bars = points.iter().flat_map(|(x, point)| bar(*x, point, log)).collect();
    let unnamed = |points, draw| Series { label: String::new(), points, draw };
    [
        Series { label, points: places.clone(), draw: Draw::Line(colour) },
        unnamed(places, Draw::Dots(colour, 2.5)),
        unnamed(bars, Draw::Line(colour)),
    ]
}

/// The bar of a point as a line, then NaN, which ends the line.
fn bar(x: f64, point: &Measured, log: bool) -> Vec<[f64; 2]> {
    let Some(scatter) = point.bar().filter(|scatter| *scatter > 0.0) else {
        return Vec::new();
    };
    // on a logarithmic axis a bar that reaches below zero ends a decade down
    let low = point.value - scatter;
    let low = if log { low.max(0.1 * point.value) } else { low };
    vec![[x, low], [x, point.value + scatter], [x, f64::NAN]]
}

/// Whether values span more than a decade, so that a logarithmic axis shows them.
pub(super) fn spans_decades(values: impl Iterator<Item = f64>) -> bool {
    let ends = values
        .filter(|value| value.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
    ends[0] > 0.0 && ends[1] > 10.0 * ends[0]
}
