//! Time histories of the whole run.

use super::caption::caption;
use super::scene::Scene;
use crate::PostError;
use crate::frames::open_history;
use figure::{Axis, Draw, Figure, Mark, Panel, Series, colour, thin};
use output::FieldSpec;
use output::layout::HISTORY;
use std::path::Path;

/// A line: column, label, factor to the axis's unit, colour.
type Line = (&'static FieldSpec, &'static str, f64, [u8; 3]);

/// Axis label and lines of each panel.
static PANELS: [(&str, &[Line]); 6] = [
    (
        "force (kN)",
        &[
            (&HISTORY.normal_force, "normal", 1e-3, colour::BLACK),
            (&HISTORY.tangential_force, "tangential", 1e-3, colour::BLUE),
            (&HISTORY.lateral_force, "lateral", 1e-3, colour::GREY),
        ],
    ),
    ("traction coefficient (-)", &[(&HISTORY.traction_coefficient, "T/N", 1.0, colour::BLUE)]),
    ("creepage (10\u{207b}\u{b3})", &[(&HISTORY.creepage, "creepage", 1e3, colour::RED)]),
    (
        "patch (mm)",
        &[
            (&HISTORY.patch_half_length, "half length", 1e3, colour::BLUE),
            (&HISTORY.patch_half_width, "half width", 1e3, colour::GREEN),
        ],
    ),
    (
        "share of the patch (-)",
        &[
            (&HISTORY.stick_fraction, "sticks", 1.0, colour::BLUE),
            (&HISTORY.slip_fraction, "slips", 1.0, colour::ORANGE),
        ],
    ),
    (
        "energy (J)",
        &[
            (&HISTORY.internal, "internal", 1.0, colour::BLACK),
            (&HISTORY.hourglass, "hourglass", 1.0, colour::GREY),
            (&HISTORY.contact_stored, "contact springs", 1.0, colour::BLUE),
            (&HISTORY.friction_dissipated, "heat of friction", 1.0, colour::RED),
            (&HISTORY.damping_dissipated, "damping", 1.0, colour::GREEN),
            (&HISTORY.imbalance, "imbalance", 1.0, colour::PURPLE),
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
    for (label, lines) in &PANELS {
        let mut series = Vec::new();
        for (column, label, factor, colour) in lines.iter() {
            let Some(values) = history.column(column)? else { continue };
            let points: Vec<_> =
                time.iter().zip(values).map(|(t, value)| [1e3 * t, factor * value]).collect();
            let draw = Draw::Line(*colour);
            series.push(Series { label: (*label).into(), points: thin(&points, COLUMNS), draw });
        }
        let marks =
            scene.window.map(|t| Mark { x: 1e3 * t, label: String::new(), colour: colour::GREY });
        panels.push(Panel {
            title: String::new(),
            x: Axis::linear("t (ms)"),
            y: Axis::linear(label),
            fill: None,
            series,
            marks: marks.into(),
        });
    }
    panels.retain(|panel| !panel.series.is_empty());
    let text = "Histories of the run; dashed lines: the window of the other figures.";
    let size = [1000, 260 * panels.len().div_ceil(2) as u32 + 50];
    Ok(Some(Figure { size, columns: 2, panels, caption: caption(scene, text) }))
}
