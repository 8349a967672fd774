//! Maps of stick and slip over the patch, and of slip along y = 0 over time.

use super::caption::{caption, instants};
use super::scene::{Instant, Scene, time_label};
use crate::chart::{Axis, Cell, Figure, Fill, Key, Panel, Scale, colour};
use crate::check::PostError;
use crate::check::surface::body_name;

/// The data of all records of the window that figures show: the centre line over time, and the points
/// (|s| (m/s), p_f/p_n) of nodes in contact.
pub(super) struct Band {
    samples: Vec<Sample>,
    pub points: Vec<[f64; 2]>,
}

/// A node of the centre line in contact at one time.
struct Sample {
    /// From and to (s).
    time: [f64; 2],
    /// From and to, relative to the patch's centre (m).
    x: [f64; 2],
    /// |s| (m/s).
    speed: f64,
    state: Option<u8>,
    /// p_f/p_n.
    ratio: f64,
}

/// Factor by which cells are enlarged, since strain and rounding would leave gaps between them.
pub(super) const SEAM: f64 = 1.02;

/// A cell enlarged by [`SEAM`].
pub(super) fn seamless([low, high]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let by = [0, 1].map(|i| 0.5 * (SEAM - 1.0) * (high[i] - low[i]));
    [[0, 1].map(|i| low[i] - by[i]), [0, 1].map(|i| high[i] + by[i])]
}

/// Most records that the diagram over time shows.
const MOST_COLUMNS: usize = 400;

impl Band {
    pub fn gather(scene: &Scene<'_>) -> Result<Self, PostError> {
        let history = scene.history;
        let every = scene.records.len().div_ceil(MOST_COLUMNS);
        let line = scene.centreline(scene.body);
        let mut band = Self { samples: Vec::new(), points: Vec::new() };
        let mut seen = std::collections::HashSet::new();
        let times = &history.times;
        history.stream(scene.records.clone(), |frame| {
            let speed_and_ratio = |row: usize| {
                let speed = frame.slip_velocity[row].norm();
                (speed, frame.shear[row].norm() / frame.pressure[row])
            };
            for row in 0..frame.pressure.len() {
                if history.surface.body[row] == scene.body && scene.in_contact(&frame, row) {
                    let (speed, ratio) = speed_and_ratio(row);
                    // dots that would overlap are drawn once
                    let place = [(speed / 8e-3) as i64, (ratio / 2e-3) as i64];
                    if seen.insert(place) {
                        band.points.push([speed, ratio]);
                    }
                }
            }
            if !(frame.index - scene.records.start).is_multiple_of(every) {
                return Ok(());
            }
            let centre = scene.centre(&frame);
            let neighbour = |index: Option<usize>| {
                let inside = index.filter(|i| scene.records.contains(i));
                inside.map(|i| 0.5 * (times[i] + frame.time))
            };
            let before = neighbour(frame.index.checked_sub(every));
            let after = neighbour(Some(frame.index + every));
            let mirrored = |edge: Option<f64>| edge.map(|edge| 2.0 * frame.time - edge);
            let only = frame.time;
            let time = [
                before.or(mirrored(after)).unwrap_or(only - 1e-6),
                after.or(mirrored(before)).unwrap_or(only + 1e-6),
            ];
            for &row in &line {
                if scene.in_contact(&frame, row) {
                    let (speed, ratio) = speed_and_ratio(row);
                    band.samples.push(Sample {
                        time,
                        x: scene.halves[row][0]
                            .map(|half| scene.position(&frame, row)[0] - centre + SEAM * half),
                        speed,
                        state: frame.state.as_ref().map(|state| state[row]),
                        ratio,
                    });
                }
            }
            Ok(())
        })?;
        Ok(band)
    }
}

/// Stick dark, slip light: distinct for the colour-blind and in grey.
pub(super) fn states() -> Key {
    Key::Classes(vec![("stick".into(), colour::BLUE), ("slip".into(), colour::ORANGE)])
}

pub(super) fn state_colour(state: Option<u8>) -> [u8; 3] {
    match state {
        Some(1) => colour::BLUE,
        Some(2) => colour::ORANGE,
        _ => colour::GREY,
    }
}

/// A logarithmic key of slip speeds over the three decades up to the one of the largest.
pub(super) fn speeds(values: impl Iterator<Item = f64>) -> Key {
    let largest = values.filter(|v| v.is_finite()).fold(0.0f64, f64::max);
    let top = if largest > 0.0 { libm::log10(largest).ceil() } else { 0.0 };
    let range = [libm::pow(10f64, top - 3.0), libm::pow(10f64, top)];
    Key::Values { label: "|s| (m/s)".into(), range, scale: Scale::Log }
}

/// Figure 2: stick-slip maps at up to three instants, and below them the slip speed.
pub(super) fn stick_slip(scene: &Scene<'_>) -> Figure {
    let surface = &scene.history.surface;
    let rows_of = |instant: &Instant| -> Vec<usize> {
        (0..surface.points.len())
            .filter(|&row| surface.body[row] == scene.body && scene.in_contact(&instant.frame, row))
            .collect()
    };
    let all = scene.instants.iter().flat_map(|instant| {
        rows_of(instant).into_iter().map(|row| instant.frame.slip_velocity[row].norm())
    });
    let speed_key = speeds(all);
    let state_key = states();
    let cells = scene.instants.iter().flat_map(|instant| {
        rows_of(instant).into_iter().map(|row| scene.cell(instant, row)).collect::<Vec<_>>()
    });
    let [width, height] = scene.map_ends(cells);
    let mut panels = Vec::new();
    for by_state in [true, false] {
        if by_state && !scene.history.has.state {
            continue;
        }
        for instant in &scene.instants {
            let frame = &instant.frame;
            let cells = rows_of(instant).into_iter().map(|row| {
                let [low, high] = seamless(scene.cell(instant, row));
                let colour = if by_state {
                    state_colour(frame.state.as_ref().map(|state| state[row]))
                } else {
                    speed_key.colour(frame.slip_velocity[row].norm())
                };
                Cell { low, high, colour }
            });
            let key = if by_state { state_key.clone() } else { speed_key.clone() };
            panels.push(Panel {
                to_scale: true,
                title: if by_state { time_label(instant) } else { String::new() },
                fill: Some(Fill { cells: cells.collect(), key }),
                ..Panel::new(
                    Axis::linear("x from the patch's centre (mm)").over(-width, width),
                    Axis::linear("y (mm)").over(-height, height),
                )
            });
        }
    }
    let columns = scene.instants.len();
    let rows = panels.len().div_ceil(columns.max(1)) as u32;
    let what = if scene.history.has.state {
        "What the algorithm lets stick and slip, and the slip speed of the same nodes,"
    } else {
        "Slip speed"
    };
    let text = format!(
        "{what} on the {} at {}; rolling is to the right (the papers' Figure 2).",
        body_name(scene.body),
        instants(scene)
    );
    Figure {
        size: [360 * columns as u32, 300 * rows + 50],
        columns,
        panels,
        caption: caption(scene, &text),
    }
}

/// Slip along y = 0 over time: speed, state, and shear over pressure.
pub(super) fn space_time(scene: &Scene<'_>, band: &Band) -> Figure {
    let reached = band.samples.iter().flat_map(|sample| sample.x.map(f64::abs));
    let reach = 1e3 * reached.fold(scene.reach(), |reach, x| reach.max(1.05 * x));
    let speed_key = speeds(band.samples.iter().map(|sample| sample.speed));
    let ratio_key = Key::Values {
        label: "p_{f}/p_{n} (-)".into(),
        range: [0.0, scene.mu_static()],
        scale: Scale::Linear,
    };
    let panel = |key: &Key, of: &dyn Fn(&Sample) -> [u8; 3]| {
        let cells = band.samples.iter().map(|sample| Cell {
            low: [1e3 * sample.time[0], 1e3 * sample.x[0]],
            high: [1e3 * sample.time[1], 1e3 * sample.x[1]],
            colour: of(sample),
        });
        Panel {
            fill: Some(Fill { cells: cells.collect(), key: key.clone() }),
            ..Panel::new(
                Axis::linear("t (ms)"),
                Axis::linear("x from the patch's centre (mm)").over(-reach, reach),
            )
        }
    };
    let mut panels = vec![panel(&speed_key, &|sample| speed_key.colour(sample.speed))];
    if scene.history.has.state {
        panels.push(panel(&states(), &|sample| state_colour(sample.state)));
    }
    panels.push(panel(&ratio_key, &|sample| ratio_key.colour(sample.ratio)));
    let states =
        if scene.history.has.state { ", what the algorithm lets stick and slip," } else { "" };
    let text = format!(
        "Nodes of the {} on y = 0 over time: slip speed{states} and shear over pressure. Rolling is upwards: material \
         enters at the top.",
        body_name(scene.body)
    );
    Figure {
        size: [820, 290 * panels.len() as u32 + 50],
        columns: 1,
        panels,
        caption: caption(scene, &text),
    }
}
