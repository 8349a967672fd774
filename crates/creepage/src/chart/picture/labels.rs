//! What is written over a picture: heading, titles, colour bar, scale bars and axes.

use super::{HEADING, KEY, Layout, PANE, Picture, PictureError, TITLE};
use crate::chart::axis::Axis;
use crate::chart::{Key, font, viridis};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;
type Drawn = Result<(), PictureError>;

// Sizes in points of 1/96 inch.
const TEXT: f64 = 11.0;
const LARGE: f64 = 13.0;
/// Length of the colour bar.
const BAR: f64 = 300.0;
/// Length of an axis that is seen from its side.
const AXIS: f64 = 22.0;

/// Writes all labels onto the pixels.
pub(super) fn draw(picture: &Picture, layout: &Layout, rgb: &mut [u8]) -> Drawn {
    if !font::register() {
        return Err(PictureError("the font cannot be read".into()));
    }
    let [width, height] = layout.size;
    let area = BitMapBackend::with_buffer(rgb, (width, height)).into_drawing_area();
    let pen = Pen { area: &area, layout };
    let at = [layout.px(8.0), layout.px(0.5 * HEADING)];
    pen.cut(&picture.heading, LARGE, at, width as i32 - layout.px(16.0))?;
    for (i, pane) in picture.panes.iter().enumerate() {
        let [left, top] = layout.corner(i).map(|at| at as i32);
        let at = [left + layout.px(8.0), top - layout.px(0.5 * TITLE)];
        pen.cut(&pane.title, TEXT, at, layout.pane[0] as i32 - layout.px(16.0))?;
        let [right, bottom] = [left + layout.pane[0] as i32, top + layout.pane[1] as i32];
        let frame = Rectangle::new([(left, top), (right - 1, bottom - 1)], RGBColor(200, 200, 200));
        pen.area.draw(&frame).map_err(failed)?;
        pen.scale_bar(pane.camera.span(), [left, bottom])?;
        pen.axes(&pane.camera, [right, bottom])?;
    }
    pen.key(&picture.key, layout.px(HEADING + TITLE + PANE[1]))?;
    area.present().map_err(failed)
}

fn failed(error: impl std::fmt::Display) -> PictureError {
    PictureError(error.to_string())
}

struct Pen<'a, 'b> {
    area: &'a Area<'b>,
    layout: &'a Layout,
}

impl Pen<'_, '_> {
    fn style(&self, size: f64, across: HPos) -> TextStyle<'static> {
        let font = (font::NAME, size * self.layout.unit).into_font();
        font.color(&BLACK).pos(Pos::new(across, VPos::Center))
    }

    fn width(&self, text: &str, size: f64) -> Result<i32, PictureError> {
        let size = self.area.estimate_text_size(text, &self.style(size, HPos::Left));
        Ok(size.map_err(failed)?.0 as i32)
    }

    fn text(&self, text: &str, size: f64, [x, y]: [i32; 2], across: HPos) -> Drawn {
        let text = Text::new(text.to_owned(), (x, y), self.style(size, across));
        self.area.draw(&text).map_err(failed)
    }

    /// Text that starts at `at`, cut to `room` pixels.
    fn cut(&self, text: &str, size: f64, at: [i32; 2], room: i32) -> Drawn {
        let mut shown = text.to_owned();
        while self.width(&shown, size)? > room {
            let kept = shown.chars().count().saturating_sub(2);
            if kept == 0 {
                return Ok(());
            }
            shown = shown.chars().take(kept).collect::<String>() + "…";
        }
        self.text(&shown, size, at, HPos::Left)
    }

    fn line(&self, from: [i32; 2], to: [i32; 2], colour: RGBColor) -> Drawn {
        let width = self.layout.px(1.2).max(1) as u32;
        let ends = [from, to].map(|[x, y]| (x, y));
        self.area.draw(&PathElement::new(ends, colour.stroke_width(width))).map_err(failed)
    }

    /// A white field on which labels can be read whatever is behind it.
    fn field(&self, from: [i32; 2], to: [i32; 2]) -> Drawn {
        let ends = [(from[0], from[1]), (to[0], to[1])];
        self.area.draw(&Rectangle::new(ends, WHITE.mix(0.85).filled())).map_err(failed)
    }

    /// A bar of a round length in the lower left corner of a pane.
    fn scale_bar(&self, span: f64, [left, bottom]: [i32; 2]) -> Drawn {
        let px = |points| self.layout.px(points);
        let length = round_down(0.25 * span);
        let shorter = f64::from(self.layout.pane[0].min(self.layout.pane[1]));
        let pixels = (length / span * shorter).round() as i32;
        let label = length_label(length);
        let wide = pixels.max(self.width(&label, TEXT)?);
        self.field(
            [left + px(8.0), bottom - px(34.0)],
            [left + px(24.0) + wide, bottom - px(8.0)],
        )?;
        let y = bottom - px(13.0);
        let [from, to] = [left + px(16.0), left + px(16.0) + pixels];
        self.line([from, y], [to, y], BLACK)?;
        for x in [from, to] {
            self.line([x, y - px(3.0)], [x, y + px(3.0)], BLACK)?;
        }
        self.text(&label, TEXT, [from, y - px(12.0)], HPos::Left)
    }

    /// The axes x, y, z in the lower right corner of a pane.
    fn axes(&self, camera: &super::Camera, [right, bottom]: [i32; 2]) -> Drawn {
        let px = |points| self.layout.px(points);
        let seen = |i: usize| {
            let mut axis = [0.0; 3];
            axis[i] = 1.0;
            let [across, up, _] = camera.turned(axis);
            // the label of an axis that points at the viewer would lie on the others
            (libm::hypot(across, up) > 0.3).then_some(([across, up], ["x", "y", "z"][i]))
        };
        let axes: Vec<_> = (0..3).filter_map(seen).collect();
        // how far the axes with their labels reach to the left, right, top and bottom
        let reach = |side: [f64; 2]| {
            let along = axes.iter().map(|([across, up], _)| side[0] * across + side[1] * up);
            px(AXIS * along.fold(0.0, f64::max) + 16.0)
        };
        let [left, top] = [reach([-1.0, 0.0]), reach([0.0, 1.0])];
        let [beyond_x, beyond_y] = [reach([1.0, 0.0]), reach([0.0, -1.0])];
        let origin = [right - px(8.0) - beyond_x, bottom - px(8.0) - beyond_y];
        self.field(
            [origin[0] - left, origin[1] - top],
            [origin[0] + beyond_x, origin[1] + beyond_y],
        )?;
        for ([across, up], name) in axes {
            let end = |points: f64| [origin[0] + px(points * across), origin[1] - px(points * up)];
            self.line(origin, end(AXIS), BLACK)?;
            let label = AXIS + 8.0 / libm::hypot(across, up);
            self.text(name, TEXT, end(label), HPos::Center)?;
        }
        Ok(())
    }

    /// The colour bar with its ticks, and beside it the quantity.
    fn key(&self, key: &Key, top: i32) -> Drawn {
        let Key::Values { label, range: [low, high], .. } = key else {
            return Ok(());
        };
        let px = |points| self.layout.px(points);
        let gap = px(14.0);
        let wide = self.width(label, TEXT)? + gap + px(BAR);
        let start = ((self.layout.size[0] as i32 - wide) / 2).max(px(8.0));
        let [upper, lower] = [top + px(10.0), top + px(24.0)];
        self.text(label, TEXT, [start, (upper + lower) / 2], HPos::Left)?;
        let left = start + wide - px(BAR);
        let steps = px(BAR);
        for i in 0..steps {
            let [r, g, b] = viridis(f64::from(i) / f64::from(steps - 1));
            self.line([left + i, upper], [left + i, lower], RGBColor(r, g, b))?;
        }
        let axis = Axis::linear("").over(*low, *high).ticked(std::iter::empty(), 7);
        for tick in axis.ticks() {
            let share = (tick - low) / (high - low);
            let x = left + (share * f64::from(steps)).round() as i32;
            self.line([x, lower], [x, lower + px(4.0)], BLACK)?;
            self.text(&axis.label(*tick), TEXT, [x, lower + px(12.0)], HPos::Center)?;
        }
        debug_assert!(lower + px(18.0) < top + px(KEY));
        Ok(())
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `value`.
pub fn round_down(value: f64) -> f64 {
    let power = libm::pow(10.0, libm::log10(value).floor());
    let factor = [5.0, 2.0, 1.0].into_iter().find(|f| f * power <= value * (1.0 + 1e-9));
    factor.unwrap_or(1.0) * power
}

/// A length with a unit that needs few digits.
fn length_label(length: f64) -> String {
    let (unit, size) = match length {
        l if l >= 1.0 => ("m", 1.0),
        l if l >= 1e-3 => ("mm", 1e-3),
        _ => ("µm", 1e-6),
    };
    // three digits hide what division leaves
    format!("{} {unit}", (length / size * 1e3).round() / 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bars_are_round_and_their_labels_short() {
        for (span, bar, label) in [
            (0.019, 0.01, "10 mm"),
            (0.0205, 0.02, "20 mm"),
            (0.5, 0.5, "500 mm"),
            (3e-4, 2e-4, "200 µm"),
            (7.0, 5.0, "5 m"),
        ] {
            assert!((round_down(span) / bar - 1.0).abs() < 1e-9, "{span}");
            assert_eq!(length_label(round_down(span)), label);
        }
    }
}
