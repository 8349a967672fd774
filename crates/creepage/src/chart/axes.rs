//! The plot of a panel: where values are in it, and its axes.

use crate::chart::axis::Ticked;
use crate::chart::layout::{Failure, GAP, Pen, TEXT, TICK};
use crate::chart::{Panel, colour};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use std::ops::Range;

/// Colour of the lines at the ticks.
const GRID: [u8; 3] = [225; 3];

/// The axes of a plot and where it is on its panel (pixels).
pub(crate) struct Plot {
    pub x: Ticked,
    pub y: Ticked,
    pub across: Range<i32>,
    /// From its upper to its lower end.
    pub down: Range<i32>,
}

impl Plot {
    /// Where a point is (pixels); `None` if that is nowhere.
    pub fn pixel(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.x_pixel(x)?, self.y_at(self.y.place(y)?)])
    }

    /// Where a value of x is (pixels from the left).
    pub fn x_pixel(&self, x: f64) -> Option<f64> {
        Some(self.x_at(self.x.place(x)?))
    }

    fn x_at(&self, place: f64) -> f64 {
        let Range { start, end } = self.across;
        f64::from(start) + self.x.share(place) * f64::from(end - start)
    }

    fn y_at(&self, place: f64) -> f64 {
        let Range { start, end } = self.down;
        f64::from(end) - self.y.share(place) * f64::from(end - start)
    }
}

/// Draws the axes with ticks, their labels and titles, and a grid.
pub(crate) fn draw<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    panel: &Panel,
    plot: &Plot,
) -> Result<(), Failure<DB>> {
    let Plot { x, y, across, down } = plot;
    let (left, bottom) = (across.start, down.end);
    let columns: Vec<(i32, String)> =
        x.ticks().iter().map(|t| (plot.x_at(*t).round() as i32, x.label(*t))).collect();
    let rows: Vec<(i32, String)> =
        y.ticks().iter().map(|t| (plot.y_at(*t).round() as i32, y.label(*t))).collect();
    for (x, _) in &columns {
        pen.rule([(*x, down.start), (*x, bottom)], GRID, 0.5)?;
    }
    for (y, _) in &rows {
        pen.rule([(left, *y), (across.end, *y)], GRID, 0.5)?;
    }
    pen.rule([(left, down.start), (left, bottom)], colour::BLACK, 1.0)?;
    pen.rule([(left, bottom), (across.end, bottom)], colour::BLACK, 1.0)?;
    let (tick, text) = (pen.px(TICK), pen.px(2.0 * TICK));
    for (x, label) in columns {
        pen.rule([(x, bottom), (x, bottom + tick)], colour::BLACK, 1.0)?;
        let middle = bottom + text + pen.px(0.4 * TEXT);
        pen.write(&label, TEXT, (x, middle), HPos::Center)?;
    }
    for (y, label) in rows {
        pen.rule([(left - tick, y), (left, y)], colour::BLACK, 1.0)?;
        pen.write(&label, TEXT, (left - text, y), HPos::Right)?;
    }
    let below = bottom + text + pen.px(1.4 * TEXT + GAP);
    pen.write(&panel.x.label, TEXT, ((left + across.end) / 2, below), HPos::Center)?;
    let middle = (down.start + bottom) / 2;
    pen.write_upwards(&panel.y.label, TEXT, (pen.px(0.5 * TEXT), middle))
}
