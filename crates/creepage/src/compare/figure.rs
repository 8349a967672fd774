//! The slip speed of all runs along the centre line.

use super::RunLine;
use crate::chart::{Axis, Draw, Figure, Panel, Series, colour};
use crate::check::centreline::profile;

const COLOURS: [[u8; 3]; 6] =
    [colour::BLACK, colour::BLUE, colour::VERMILION, colour::GREEN, colour::PURPLE, colour::ORANGE];

/// Mean in time as a line, one standard deviation to either side dashed.
pub(super) fn figure(labels: &[String], lines: &[RunLine], [from, to]: [f64; 2]) -> Figure {
    let mut series = Vec::new();
    for (k, (label, line)) in labels.iter().zip(lines).enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        let profile = profile(&line.line.slip, &line.weights);
        let curve = |sign: f64| -> Vec<[f64; 2]> {
            let at = |(i, [mean, deviation]): (usize, &[f64; 2])| {
                [1e3 * line.line.place(i), f64::max(mean + sign * deviation, 0.0)]
            };
            profile.iter().enumerate().map(at).collect()
        };
        let label = label.clone();
        series.push(Series { label, points: curve(0.0), draw: Draw::Line(colour) });
        for sign in [-1.0, 1.0] {
            let draw = Draw::Dashed(colour);
            series.push(Series { label: String::new(), points: curve(sign), draw });
        }
    }
    let panel = Panel {
        series,
        ..Panel::new(Axis::linear("x from the disk's axis (mm)"), Axis::linear("slip speed (m/s)"))
    };
    let caption = format!(
        "Slip speed along the centre line, mean from {:.4} to {:.4} ms; dashed: one standard deviation in \
         time to either side.",
        1e3 * from,
        1e3 * to
    );
    Figure { size: [720, 420], columns: 1, panels: vec![panel], caption }
}
