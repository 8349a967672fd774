//! Sizes of the parts of a figure, and text on it.

use crate::chart::font;
use crate::chart::label::{self, NO_BREAK};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub(crate) type Area<DB> = DrawingArea<DB, Shift>;
pub(crate) type Failure<DB> = DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>;

// Sizes in points of 1/96 inch.
pub(crate) const TEXT: f64 = 11.0;
pub(crate) const TITLE: f64 = 12.5;
/// From a line of text to the next.
pub(crate) const LINE: f64 = 16.0;
/// Length of a tick; its label begins at twice that.
pub(crate) const TICK: f64 = 3.5;
/// Between the labels of the ticks and the title of the axis.
pub(crate) const GAP: f64 = 5.0;

/// What a figure is drawn on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Medium {
    /// SVG: its viewer joins the segments of lines; [`label::typeset`] makes subscripts afterwards.
    Svg,
    /// PDF: its viewer joins the segments of lines; subscripts are drawn one by one.
    Pdf,
    /// Pixels: segments of lines and subscripts are drawn one by one. A pixel of the picture is the mean of so many
    /// in each direction.
    Bitmap(u32),
}

/// Draws on an area, with `unit` pixels per point.
pub(crate) struct Pen<'a, DB: DrawingBackend> {
    pub area: &'a Area<DB>,
    pub unit: f64,
    pub medium: Medium,
}

/// How far the bitmap backend draws text above the place where the SVG backend does, over the size of the text.
const TOO_HIGH: f64 = 0.12;

impl<'a, DB: DrawingBackend> Pen<'a, DB> {
    /// The same on another area of the figure.
    pub fn on<'b>(&self, area: &'b Area<DB>) -> Pen<'b, DB> {
        Pen { area, unit: self.unit, medium: self.medium }
    }

    /// Points as whole pixels.
    pub fn px(&self, points: f64) -> i32 {
        (points * self.unit).round() as i32
    }

    /// Black text of a size in points.
    pub fn style(&self, size: f64) -> TextStyle<'static> {
        (font::NAME, size * self.unit).into_font().color(&BLACK)
    }

    /// Width of a piece of a label, whose own size is `share` of `size` (pixels).
    fn width_of_run(&self, run: &str, size: f64, share: f64) -> Result<i32, Failure<DB>> {
        let width = self.area.estimate_text_size(run, &self.style(share * size))?.0 as i32;
        let space = if share < 1.0 { label::SPACE * size } else { 0.0 };
        Ok(width + self.px(space))
    }

    /// Width of a text (pixels).
    pub fn width(&self, text: &str, size: f64) -> Result<i32, Failure<DB>> {
        let mut width = 0;
        for (run, share) in label::runs(text) {
            width += self.width_of_run(run, size, share)?;
        }
        Ok(width)
    }

    /// Writes a text of a size in points; `at` is the middle of its height, and `across` says whether the left end,
    /// the middle or the right end of it.
    pub fn write(
        &self,
        text: &str,
        size: f64,
        at: (i32, i32),
        across: HPos,
    ) -> Result<(), Failure<DB>> {
        self.line_of_text(text, size, at, (across, FontTransform::None))
    }

    /// Writes a text upwards, `at` being its middle.
    pub fn write_upwards(&self, text: &str, size: f64, at: (i32, i32)) -> Result<(), Failure<DB>> {
        self.line_of_text(text, size, at, (HPos::Center, FontTransform::Rotate270))
    }

    fn line_of_text(
        &self,
        text: &str,
        size: f64,
        at: (i32, i32),
        (across, turn): (HPos, FontTransform),
    ) -> Result<(), Failure<DB>> {
        let style = |size: f64, across: HPos| {
            self.style(size).pos(Pos::new(across, VPos::Center)).transform(turn.clone())
        };
        if self.medium == Medium::Svg {
            let text = text.replace(label::PRIVATE, "");
            return self.area.draw(&Text::new(text, at, style(size, across)));
        }
        let width = self.width(text, size)?;
        let mut along = match across {
            HPos::Left => 0,
            HPos::Center => -width / 2,
            HPos::Right => -width,
        };
        let too_high = if self.medium == Medium::Pdf { 0.0 } else { TOO_HIGH };
        for (run, share) in label::runs(text) {
            let lowered = if share < 1.0 { label::LOWERED } else { 0.0 };
            // the middle of smaller letters is nearer to their line
            let down = self.px(size * (too_high + lowered + MIDDLE * (1.0 - share)));
            let (x, y) = turn.transform(along, down);
            // letters that begin on whole pixels of the picture are sharper, and alike wherever they stand
            let place = self.whole((at.0 + x, at.1 + y));
            self.area.draw(&Text::new(run, place, style(share * size, HPos::Left)))?;
            along += self.width_of_run(run, size, share)?;
        }
        Ok(())
    }

    /// The nearest point between whole pixels of the picture (pixels of the area).
    fn whole(&self, (x, y): (i32, i32)) -> (i32, i32) {
        let Medium::Bitmap(fine) = self.medium else { return (x, y) };
        let fine = fine as i32;
        let nearest = |at: i32, base: i32| (at + base + fine / 2).div_euclid(fine) * fine - base;
        let base = self.area.get_base_pixel();
        (nearest(x, base.0), nearest(y, base.1))
    }

    /// Draws a line along an axis from one point to another (pixels), as thick as `points` (of 1/96 inch), sharply.
    pub fn rule(
        &self,
        [from, to]: [(i32, i32); 2],
        colour: [u8; 3],
        points: f64,
    ) -> Result<(), Failure<DB>> {
        let thick = self.px(points).max(1);
        let [from, to] = [from, to].map(|at| self.whole(at));
        let (low, high) = if from.0 == to.0 {
            let left = self.whole((from.0 - thick / 2, 0)).0;
            ((left, from.1.min(to.1)), (left + thick, from.1.max(to.1)))
        } else {
            let top = self.whole((0, from.1 - thick / 2)).1;
            ((from.0.min(to.0), top), (from.0.max(to.0), top + thick))
        };
        self.area.draw(&Rectangle::new([low, high], rgb(colour).filled()))
    }

    /// A text in lines of at most `room` pixels, as far as its words allow; [`NO_BREAK`] becomes a space.
    pub fn lines(&self, text: &str, room: i32) -> Result<Vec<String>, Failure<DB>> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_ascii_whitespace() {
            let word = word.replace(NO_BREAK, " ");
            let longer = lines.last().map(|line| format!("{line} {word}"));
            match (longer, lines.last_mut()) {
                (Some(longer), Some(last)) if self.width(&longer, TEXT)? <= room => *last = longer,
                _ => lines.push(word),
            }
        }
        Ok(lines)
    }

    /// Draws a line through points (pixels), as thick as `points` (of 1/96 inch).
    pub fn path(
        &self,
        at: impl Into<Vec<(i32, i32)>>,
        colour: [u8; 3],
        points: f64,
    ) -> Result<(), Failure<DB>> {
        let style = rgb(colour).stroke_width(self.px(points).max(1) as u32);
        self.area.draw(&PathElement::new(at.into(), style))
    }
}

/// How far the bitmap backend's line of letters is below the middle of a text, over its size.
const MIDDLE: f64 = 0.22;

pub(crate) fn rgb([r, g, b]: [u8; 3]) -> RGBColor {
    RGBColor(r, g, b)
}
