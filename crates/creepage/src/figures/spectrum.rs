//! Spectrum of the slip velocity at probe nodes, recorded at every step.

use super::caption::caption;
use super::scene::Scene;
use crate::chart::{Axis, Draw, Figure, Mark, Panel, Series, colour, minus, thin};
use crate::check::PostError;
use crate::check::basis::value_at;
use crate::check::conditions::IN_CONTACT;
use crate::check::frames::open_history;
use crate::check::welch::density;
use output::layout::{BODY_NAMES, HISTORY, PROBE, of_probe};
use std::path::Path;

/// Most probes that are drawn where none were asked for.
const MOST: usize = 6;
/// Fewest steps in contact of which a spectrum is drawn.
const FEWEST_STEPS: usize = 64;

/// The spectra of the probes in the file at `path`, those with the numbers `asked` or the first ones; `None` where there is
/// no file, or no probe was in contact for long enough.
///
/// # Errors
/// A file that cannot be read; a number that no probe has.
pub(super) fn spectrum(
    scene: &Scene<'_>,
    path: &Path,
    asked: &[usize],
) -> Result<Option<Figure>, PostError> {
    let Some(probes) = open_history(path)? else { return Ok(None) };
    let Some(time) = probes.column(&HISTORY.time)?.filter(|time| time.len() > FEWEST_STEPS) else {
        return Ok(None);
    };
    let dt = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let mut spectra = Vec::new();
    for probe in 0.. {
        let column = |column| probes.column(&of_probe(probe, column));
        let (Some(pressure), Some(slip)) =
            (column(&PROBE.pressure)?, column(&PROBE.slip_velocity_x)?)
        else {
            check_asked(asked, probe)?;
            break;
        };
        if asked.is_empty() || asked.contains(&probe) {
            spectra.extend(in_contact(scene, &pressure, &slip).map(|s| (probe, density(s, dt))));
        }
        if asked.is_empty() && spectra.len() == MOST {
            break;
        }
    }
    if spectra.is_empty() {
        return Ok(None);
    }
    let ends = ends(spectra.iter().flat_map(|(_, points)| points));
    let panels: Vec<Panel> =
        spectra.iter().map(|(probe, points)| panel(scene, *probe, points, ends)).collect();
    let text = "Spectrum of the slip velocity along x at the probe nodes while they are in \
                contact, from every step (Welch, 1024 steps). V/h: nodes that meet; c_{s}/h: shear waves \
                over an element.";
    let columns = panels.len().min(2);
    let rows = panels.len().div_ceil(columns) as u32;
    Ok(Some(Figure {
        size: [if columns == 1 { 760 } else { 1000 }, 300 * rows + 66],
        columns,
        panels,
        caption: caption(scene, text),
    }))
}

/// Refuses the number of a probe that is none of the `count`.
fn check_asked(asked: &[usize], count: usize) -> Result<(), PostError> {
    match asked.iter().find(|probe| **probe >= count) {
        Some(probe) => Err(PostError::Asked(format!(
            "--probes {probe}: the run has {count} probes, with numbers from 0"
        ))),
        None => Ok(()),
    }
}

/// The slip velocities of a probe from its first to its last step in contact; `None` where these are too few.
fn in_contact<'a>(scene: &Scene<'_>, pressure: &[f64], slip: &'a [f64]) -> Option<&'a [f64]> {
    let touches = |p: &f64| *p > IN_CONTACT * scene.scales.peak_pressure;
    let (from, to) = (pressure.iter().position(touches)?, pressure.iter().rposition(touches)?);
    (to - from >= FEWEST_STEPS).then(|| &slip[from..=to])
}

/// The least and the greatest of the frequencies (kHz) and of the densities above zero.
fn ends<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> [[f64; 2]; 2] {
    let all = points.filter(|[f, power]| *f > 0.0 && *power > 0.0);
    all.fold([[f64::INFINITY, 0.0]; 2], |ends, [f, power]| {
        let values = [1e-3 * f, *power];
        [0, 1].map(|i| [ends[i][0].min(values[i]), ends[i][1].max(values[i])])
    })
}

fn panel(scene: &Scene<'_>, probe: usize, points: &[[f64; 2]], [x, y]: [[f64; 2]; 2]) -> Panel {
    let points: Vec<_> = points.iter().map(|[f, power]| [1e-3 * f, *power]).collect();
    let mut marks = Vec::new();
    if let Some(speed) = scene.basis.scale("speed") {
        let x = 1e-3 * speed / scene.scales.size;
        marks.push(Mark { x, label: "V/h".into(), colour: colour::GREY });
    }
    if let Some(speed) = scene.scales.shear_wave {
        let x = 1e-3 * speed / scene.scales.size;
        marks.push(Mark { x, label: "c_{s}/h".into(), colour: colour::BLACK });
    }
    Panel {
        title: title(scene, probe),
        series: vec![Series {
            label: String::new(),
            points: thin(&points, 600),
            draw: Draw::Line(colour::BLUE),
        }],
        marks,
        ..Panel::new(
            Axis::log("frequency (kHz)").over(x[0] / 1.2, x[1] * 1.2),
            Axis::log("density of s_{x} (m\u{b2}/s\u{b2}/Hz)").over(y[0] / 1.2, y[1] * 1.2),
        )
    }
}

/// The number of a probe and, by the case, where it is.
fn title(scene: &Scene<'_>, probe: usize) -> String {
    let mut before = 0;
    for body in BODY_NAMES {
        let case = scene.basis.case.as_ref();
        let points = case.and_then(|case| value_at(case, &format!("output.probes.{body}")));
        let points = points.and_then(|points| points.as_array()).map_or(&[][..], |p| p);
        if let Some(point) = probe.checked_sub(before).and_then(|own| points.get(own)) {
            let along = if body == "disk" { "s" } else { "x" };
            let place = |axis: usize| {
                let metres = point.get(axis).and_then(|value| value.as_float())?;
                Some(minus(&format!("{:.1}", 1e3 * metres)))
            };
            if let (Some(x), Some(y)) = (place(0), place(1)) {
                return format!("probe {probe}: {body}, {along} = {x} mm, y = {y} mm");
            }
        }
        before += points.len();
    }
    format!("probe {probe}")
}
