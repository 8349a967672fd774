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

/// A measure over an axis: a line, its points, and bars for their uncertainty within `bounds`.
pub(super) fn line(
    label: String,
    colour: [u8; 3],
    points: &[(f64, Measured)],
    bounds: [f64; 2],
) -> [Series; 3] {
    let places: Vec<[f64; 2]> = points.iter().map(|(x, point)| [*x, point.value]).collect();
    let ended = |(x, point): &(f64, Measured)| {
        let [low, high] = ends(point, bounds);
        // NaN ends the line
        if low < high { vec![[*x, low], [*x, high], [*x, f64::NAN]] } else { Vec::new() }
    };
    let bars = points.iter().flat_map(ended).collect();
    let unnamed = |points, draw| Series { label: String::new(), points, draw };
    [
        Series { label, points: places.clone(), draw: Draw::Line(colour) },
        unnamed(places, Draw::Dots(colour, 2.5)),
        unnamed(bars, Draw::Line(colour)),
    ]
}

/// The ends of the bar of a point, which stays within `bounds`: a share is no larger than one.
pub(super) fn ends(point: &Measured, [least, most]: [f64; 2]) -> [f64; 2] {
    let half = point.bar().unwrap_or(0.0);
    [
        (point.value - half).max(least.min(point.value)),
        (point.value + half).min(most.max(point.value)),
    ]
}

/// Whether values span more than a decade, so that a logarithmic axis shows them.
pub(super) fn spans_decades(values: impl Iterator<Item = f64>) -> bool {
    let ends = values
        .filter(|value| value.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
    ends[0] > 0.0 && ends[1] > 10.0 * ends[0]
}
