//! Spectrum of the slip velocity at probe nodes, recorded at every step.

use super::caption::caption;
use super::scene::Scene;
use crate::chart::{Axis, Draw, Figure, Mark, Panel, Series, colour, thin};
use crate::check::PostError;
use crate::check::conditions::IN_CONTACT;
use crate::check::frames::open_history;
use crate::check::welch::density;
use output::layout::{HISTORY, PROBE, of_probe};
use std::path::Path;

const COLOURS: [[u8; 3]; 6] =
    [colour::BLUE, colour::VERMILION, colour::GREEN, colour::PURPLE, colour::ORANGE, colour::BLACK];

/// The spectra of the probes in the file at `path`; `None` where there is no file, or no probe was in contact for
/// more than 64 steps.
pub(super) fn spectrum(scene: &Scene<'_>, path: &Path) -> Result<Option<Figure>, PostError> {
    let Some(probes) = open_history(path)? else { return Ok(None) };
    let Some(time) = probes.column(&HISTORY.time)?.filter(|time| time.len() > 64) else {
        return Ok(None);
    };
    let dt = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let mut series = Vec::new();
    for k in 0.. {
        let column = |column| probes.column(&of_probe(k, column));
        let (Some(pressure), Some(slip)) =
            (column(&PROBE.pressure)?, column(&PROBE.slip_velocity_x)?)
        else {
            break;
        };
        let touches = |p: &f64| *p > IN_CONTACT * scene.scales.peak_pressure;
        let (Some(from), Some(to)) =
            (pressure.iter().position(touches), pressure.iter().rposition(touches))
        else {
            continue;
        };
        if to - from < 64 {
            continue;
        }
        let points = density(&slip[from..=to], dt);
        let points: Vec<_> = points.into_iter().map(|[f, power]| [1e-3 * f, power]).collect();
        series.push(Series {
            label: format!("probe {k}"),
            points: thin(&points, 600),
            draw: Draw::Line(COLOURS[k % COLOURS.len()]),
        });
    }
    if series.is_empty() {
        return Ok(None);
    }
    let mut marks = Vec::new();
    if let Some(speed) = scene.basis.scale("speed") {
        let x = 1e-3 * speed / scene.scales.size;
        marks.push(Mark { x, label: "V/h".into(), colour: colour::GREY });
    }
    if let Some(speed) = scene.scales.shear_wave {
        let x = 1e-3 * speed / scene.scales.size;
        marks.push(Mark { x, label: "c_{s}/h".into(), colour: colour::BLACK });
    }
    let panel = Panel {
        series,
        marks,
        ..Panel::new(
            Axis::log("frequency (kHz)"),
            Axis::log("power density of s_{x} (m\u{b2}/s\u{b2}/Hz)"),
        )
    };
    let text = "Spectrum of the slip velocity along x at the probe nodes while they are in \
                contact, from every step (Welch, 1024 steps). V/h: nodes that meet; c_{s}/h: shear waves \
                over an element.";
    Ok(Some(Figure {
        size: [760, 500],
        columns: 1,
        panels: vec![panel],
        caption: caption(scene, text),
    }))
}
