//! What stands between a panel's title and its plot: the meaning of its colours, lines and marks.

use crate::chart::layout::{Failure, LINE, Pen, TEXT, TICK, rgb};
use crate::chart::{Axis, Draw, Key, Mark, Panel, arrow, colour, viridis};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

// Sizes in points of 1/96 inch.
/// Length of a sample of a line or of a colour, and from it to its name.
const SAMPLE: f64 = 20.0;
const TO_NAME: f64 = 6.0;
/// Between an entry and the next.
const APART: f64 = 14.0;
/// Least and greatest length of a colour bar, its height, and that of its labels.
const BAR: [f64; 2] = [120.0, 220.0];
const BAR_HEIGHT: f64 = 10.0;
const BAR_LABELS: f64 = 15.0;
/// Most intervals between the ticks of a colour bar.
const INTERVALS: usize = 4;

/// Room for a legend: from `left` to `right`, from `top` downwards (pixels).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Room {
    pub left: i32,
    pub right: i32,
    pub top: i32,
}

/// Draws what the colours of a map mean; returns where that ends (pixels from the top).
pub(crate) fn key<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    key: &Key,
    room: Room,
) -> Result<i32, Failure<DB>> {
    match key {
        Key::Values { label, range, scale } => {
            let axis = Axis { label: label.clone(), range: Some(*range), scale: *scale };
            colour_bar(pen, &axis, room)
        }
        Key::Classes(classes) => {
            let mut flow = Flow::new(pen, room);
            for (label, colour) in classes {
                let middle = flow.entry(label)?;
                let [low, high] = [-5.0, 5.0].map(|points| middle.1 + pen.px(points));
                let sample = [(middle.0, low), (middle.0 + pen.px(SAMPLE), high)];
                pen.area.draw(&Rectangle::new(sample, rgb(*colour).filled()))?;
            }
            // as high as a colour bar, so that maps beside each other are of one size
            Ok(flow.end().max(room.top + pen.px(2.0 + BAR_HEIGHT + BAR_LABELS)))
        }
    }
}

/// The name of a quantity and a bar of its colours with ticks, beside each other where there is room.
fn colour_bar<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    axis: &Axis,
    room: Room,
) -> Result<i32, Failure<DB>> {
    let Room { mut left, right, mut top } = room;
    let name = pen.width(&axis.label, TEXT)?;
    // half a label of a tick may stand out at the right
    let right = right - pen.px(APART);
    if !axis.label.is_empty() {
        let middle = top + pen.px(0.5 * BAR_HEIGHT + 2.0);
        pen.write(&axis.label, TEXT, (left, middle), HPos::Left)?;
        if right - left - name - pen.px(APART) >= pen.px(BAR[0]) {
            left += name + pen.px(APART);
        } else {
            top += pen.px(LINE);
        }
    }
    let length = (right - left).min(pen.px(BAR[1])).max(2);
    let (upper, lower) = (top + pen.px(2.0), top + pen.px(2.0 + BAR_HEIGHT));
    // strips that overlap leave no seam
    let strips = length.min(256);
    let place = |i: i32| left + length * i / strips;
    for i in 0..strips {
        let colour = rgb(viridis(f64::from(i) / f64::from(strips - 1)));
        let strip = [(place(i), upper), (left + length, lower)];
        pen.area.draw(&Rectangle::new(strip, colour.filled()))?;
    }
    let ticked = axis.ticked(std::iter::empty(), INTERVALS);
    for tick in ticked.ticks() {
        let share = (tick - ticked.low()) / (ticked.high() - ticked.low());
        let x = left + (share * f64::from(length)).round() as i32;
        pen.rule([(x, lower), (x, lower + pen.px(TICK))], colour::BLACK, 1.0)?;
        let middle = lower + pen.px(TICK + 0.5 * TEXT);
        pen.write(&ticked.label(*tick), TEXT, (x, middle), HPos::Center)?;
    }
    Ok(lower + pen.px(BAR_LABELS))
}

/// Draws the names of series and marks; returns where that ends (pixels from the top).
pub(crate) fn names<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    panel: &Panel,
    room: Room,
) -> Result<i32, Failure<DB>> {
    let series = panel.series.iter().map(|series| (series.label.as_str(), series.draw));
    let mark = |mark: &'_ Mark| Draw::Dashed(mark.colour);
    let marks = panel.marks.iter().map(|m| (m.label.as_str(), mark(m)));
    let mut flow = Flow::new(pen, room);
    for (label, draw) in series.chain(marks).filter(|(label, _)| !label.is_empty()) {
        let at = flow.entry(label)?;
        sample(pen, draw, at)?;
    }
    Ok(flow.end())
}

/// A piece of a line, a dot or an arrow, which begins at `left` on the height `middle`.
fn sample<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    draw: Draw,
    (left, middle): (i32, i32),
) -> Result<(), Failure<DB>> {
    let path = |from: f64, to: f64, colour: [u8; 3]| {
        pen.path([from, to].map(|at| (left + pen.px(at), middle)), colour, 1.4)
    };
    match draw {
        Draw::Line(colour) => path(0.0, SAMPLE, colour),
        Draw::Dashed(colour) => {
            [0.0, 7.5, 15.0].into_iter().try_for_each(|at| path(at, at + 5.0, colour))
        }
        Draw::Dots(colour, _) => {
            let centre = (left + pen.px(0.5 * SAMPLE), middle);
            pen.area.draw(&Circle::new(centre, pen.px(2.5), rgb(colour).filled()))
        }
        Draw::Arrows(colour) => {
            let tip = f64::from(pen.px(SAMPLE));
            for piece in arrow::pieces([0.0, 0.0], [tip, 0.0], pen.unit) {
                let at = piece.into_iter().map(|(x, y)| (left + x, middle + y));
                pen.path(at.collect::<Vec<_>>(), colour, 1.0)?;
            }
            Ok(())
        }
    }
}

/// Entries one after the other, in as many lines as they need.
struct Flow<'a, 'b, DB: DrawingBackend> {
    pen: &'a Pen<'b, DB>,
    room: Room,
    /// Where the next entry begins (pixels), and the middle of its line.
    next: (i32, i32),
    any: bool,
}

impl<'a, 'b, DB: DrawingBackend> Flow<'a, 'b, DB> {
    fn new(pen: &'a Pen<'b, DB>, room: Room) -> Self {
        Self { pen, room, next: (room.left, room.top + pen.px(0.5 * LINE)), any: false }
    }

    /// Writes the name of an entry, in several lines where it is too long for one; returns the left end of its
    /// sample and the middle of that.
    fn entry(&mut self, label: &str) -> Result<(i32, i32), Failure<DB>> {
        let Self { pen, room, .. } = *self;
        let sample = pen.px(SAMPLE + TO_NAME);
        let needed = sample + pen.width(label, TEXT)?;
        if self.next.0 > room.left && self.next.0 + needed > room.right {
            self.next = (room.left, self.next.1 + pen.px(LINE));
        }
        self.any = true;
        let at = self.next;
        let lines = pen.lines(label, room.right - at.0 - sample)?;
        for (i, line) in lines.iter().enumerate() {
            self.next.1 = at.1 + i as i32 * pen.px(LINE);
            pen.write(line, TEXT, (at.0 + sample, self.next.1), HPos::Left)?;
        }
        // after a name in several lines the next entry begins a line
        self.next.0 = if lines.len() > 1 { room.right } else { at.0 + needed + pen.px(APART) };
        Ok(at)
    }

    /// Where the entries end (pixels from the top).
    fn end(&self) -> i32 {
        if self.any { self.next.1 + self.pen.px(0.5 * LINE) } else { self.room.top }
    }
}
