//! Time histories of the whole run.

use super::caption::caption;
use super::scene::Scene;
use crate::chart::{Axis, Draw, Figure, Mark, Panel, Scale, Series, colour, thin};
use crate::check::PostError;
use crate::check::frames::open_history;
use output::FieldSpec;
use output::layout::HISTORY;
use std::path::Path;

/// A line: column, label, factor to the axis's unit, colour.
type Line = (&'static FieldSpec, &'static str, f64, [u8; 3]);

/// Energies are drawn over so many decades below the largest.
const DECADES: i32 = 6;

/// Axis label, scale and lines of each panel. On a logarithmic axis stand the magnitudes.
static PANELS: [(&str, Scale, &[Line]); 6] = [
    (
        "force (kN)",
        Scale::Linear,
        &[
            (&HISTORY.normal_force, "normal", 1e-3, colour::BLACK),
            (&HISTORY.tangential_force, "tangential", 1e-3, colour::BLUE),
            (&HISTORY.lateral_force, "lateral", 1e-3, colour::GREY),
        ],
    ),
    (
        "traction coefficient (-)",
        Scale::Linear,
        &[(&HISTORY.traction_coefficient, "T/N", 1.0, colour::BLUE)],
    ),
    (
        "creepage (10\u{207b}\u{b3})",
        Scale::Linear,
        &[(&HISTORY.creepage, "creepage", 1e3, colour::VERMILION)],
    ),
    (
        "patch (mm)",
        Scale::Linear,
        &[
            (&HISTORY.patch_half_length, "half length", 1e3, colour::BLUE),
            (&HISTORY.patch_half_width, "half width", 1e3, colour::GREEN),
        ],
    ),
    (
        "share of the patch (-)",
        Scale::Linear,
        &[
            (&HISTORY.stick_fraction, "sticks", 1.0, colour::BLUE),
            (&HISTORY.slip_fraction, "slips", 1.0, colour::ORANGE),
        ],
    ),
    (
        "energy (J)",
        Scale::Log,
        &[
            (&HISTORY.internal, "internal", 1.0, colour::BLACK),
            (&HISTORY.hourglass, "hourglass", 1.0, colour::GREY),
            (&HISTORY.contact_stored, "contact springs", 1.0, colour::BLUE),
            (&HISTORY.friction_dissipated, "heat of friction", 1.0, colour::VERMILION),
            (&HISTORY.damping_dissipated, "damping", 1.0, colour::GREEN),
            (&HISTORY.imbalance, "|imbalance|", 1.0, colour::PURPLE),
        ],
    ),
];

/// Number of pixel columns to which lines are thinned.
const COLUMNS: usize = 1200;

/// The histories of the file at `path`; `None` where there is none, or fewer than two rows.
pub(super) fn histories(scene: &Scene<'_>, path: &Path) -> Result<Option<Figure>, PostError> {
    let Some(history) = open_history(path)? else { return Ok(None) };
    let Some(time) = history.column(&HISTORY.time)?.filter(|time| time.len() > 1) else {
        return Ok(None);
    };
    let mut panels = Vec::new();
    for (label, scale, lines) in &PANELS {
        let mut series = Vec::new();
        for (column, name, factor, colour) in lines.iter() {
            let Some(values) = history.column(column)? else { continue };
            let points: Vec<_> =
                time.iter().zip(values).map(|(t, value)| [1e3 * t, factor * value]).collect();
            let draw = Draw::Line(*colour);
            series.push(Series { label: (*name).into(), points: thin(&points, COLUMNS), draw });
        }
        let marks =
            scene.window.map(|t| Mark { x: 1e3 * t, label: String::new(), colour: colour::GREY });
        let y = match scale {
            Scale::Linear => Axis::linear(label),
            Scale::Log => magnitudes(label, &mut series),
        };
        let x = Axis::linear("t (ms)");
        panels.push(Panel { series, marks: marks.into(), ..Panel::new(x, y) });
    }
    panels.retain(|panel| !panel.series.is_empty());
    let text = "Histories of the run; dashed lines: the window of the other figures. Energies are on a logarithmic axis.";
    let size = [1000, 260 * panels.len().div_ceil(2) as u32 + 50];
    Ok(Some(Figure { size, columns: 2, panels, caption: caption(scene, text) }))
}

/// A logarithmic axis over the largest magnitude of the series and [`DECADES`] below it; replaces the values by their
/// magnitudes, and those below the axis by gaps.
fn magnitudes(label: &str, series: &mut [Series]) -> Axis {
    let mut largest = 0.0f64;
    for [_, value] in series.iter_mut().flat_map(|series| &mut series.points) {
        *value = value.abs();
        largest = largest.max(*value);
    }
    if largest == 0.0 {
        return Axis::log(label);
    }
    let top = libm::log10(largest).ceil();
    let [low, high] = [top - f64::from(DECADES), top].map(|power| libm::pow(10.0, power));
    for [_, value] in series.iter_mut().flat_map(|series| &mut series.points) {
        if *value < low {
            *value = f64::NAN;
        }
    }
    Axis::log(label).over(low, high)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn energies_of_different_size_are_on_one_logarithmic_axis_and_round_off_is_left_out() {
        let points = vec![[0.0, 0.0], [1.0, -2e-3], [2.0, 40.0], [3.0, 1e-12]];
        let mut series = [Series { label: String::new(), points, draw: Draw::Line([0; 3]) }];
        let axis = magnitudes("energy (J)", &mut series);
        let [low, high] = axis.range.unwrap();
        assert!((low / 1e-4 - 1.0).abs() < 1e-12 && (high / 100.0 - 1.0).abs() < 1e-12);
        let values: Vec<f64> = series[0].points.iter().map(|p| p[1]).collect();
        assert_eq!(values[1..3], [2e-3, 40.0]);
        assert!(values[0].is_nan() && values[3].is_nan());
    }
}
