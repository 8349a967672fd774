//! Drawing of panels, on any backend.

use crate::axis::Ticked;
use crate::{Draw, Figure, Key, Mark, Panel, font, viridis};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

type Area<DB> = DrawingArea<DB, Shift>;
type Failure<DB> = DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>;

// Sizes in points of 1/96 inch.
const TEXT: f64 = 11.0;
const TITLE: f64 = 12.5;
const LINE: f64 = 16.0;
const SAMPLE: f64 = 20.0;
const MARGIN: f64 = 20.0;
/// Length of the colour bar of a map, in the legend.
const COLOURS: f64 = 110.0;

/// How the joints of the segments of a line are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Joints {
    /// The line is one path; the viewer of the file draws them.
    Viewer,
    /// Each segment is drawn by itself: the bitmap backend would draw spikes at sharp turns.
    Open,
}

/// Draws with `unit` pixels per point.
pub(crate) fn figure<DB: DrawingBackend>(
    figure: &Figure,
    area: &Area<DB>,
    unit: f64,
    joints: Joints,
) -> Result<(), Failure<DB>> {
    area.fill(&WHITE)?;
    let area = caption(figure, area, unit)?;
    let columns = figure.columns.max(1);
    let areas = area.split_evenly((figure.panels.len().div_ceil(columns), columns));
    for (panel, area) in figure.panels.iter().zip(&areas) {
        draw_panel(panel, area, unit, joints)?;
    }
    Ok(())
}

/// Draws the caption at the bottom of `area`; returns what is left above it.
fn caption<DB: DrawingBackend>(
    figure: &Figure,
    area: &Area<DB>,
    unit: f64,
) -> Result<Area<DB>, Failure<DB>> {
    let px = |points: f64| (points * unit).round() as i32;
    if figure.caption.is_empty() {
        return Ok(area.clone());
    }
    let style = text(TEXT, unit).pos(Pos::new(HPos::Left, VPos::Top));
    let (width, height) = area.dim_in_pixel();
    let room = width as i32 - px(2.0 * MARGIN);
    let mut lines = vec![String::new()];
    for word in figure.caption.split_whitespace() {
        let last = lines.len() - 1;
        let longer = format!("{} {word}", lines[last]);
        if lines[last].is_empty() {
            lines[last] = word.into();
        } else if area.estimate_text_size(&longer, &style)?.0 as i32 <= room {
            lines[last] = longer;
        } else {
            lines.push(word.into());
        }
    }
    let top = height as i32 - px(LINE) * lines.len() as i32 - px(4.0);
    for (i, line) in lines.iter().enumerate() {
        let at = (px(MARGIN), top + px(LINE) * i as i32);
        area.draw(&Text::new(line.as_str(), at, style.clone()))?;
    }
    Ok(area.split_vertically(top - px(6.0)).0)
}

fn rgb([r, g, b]: [u8; 3]) -> RGBColor {
    RGBColor(r, g, b)
}

fn text(size: f64, unit: f64) -> TextStyle<'static> {
    (font::NAME, size * unit).into_font().color(&BLACK)
}

fn draw_panel<DB: DrawingBackend>(
    panel: &Panel,
    area: &Area<DB>,
    unit: f64,
    joints: Joints,
) -> Result<(), Failure<DB>> {
    let px = |points: f64| (points * unit).round() as i32;
    let area = area.margin(px(8.0), px(4.0), px(8.0), px(20.0));
    let mut top = 0;
    let width = area.dim_in_pixel().0 as i32;
    if !panel.title.is_empty() {
        let style = text(TITLE, unit).pos(Pos::new(HPos::Center, VPos::Top));
        area.draw(&Text::new(panel.title.as_str(), (width / 2, 0), style))?;
        top += px(LINE + 2.0);
    }
    if let Some(fill) = &panel.fill {
        top = key(&fill.key, &area, top, unit)?;
    }
    top = legend(panel, &area, top, unit)?;
    let (_, plot) = area.split_vertically(top);

    let values =
        |axis: usize| panel.series.iter().flat_map(move |s| &s.points).map(move |p| p[axis]);
    let cells = || panel.fill.iter().flat_map(|fill| &fill.cells);
    let corners = |axis: usize| cells().flat_map(move |cell| [cell.low[axis], cell.high[axis]]);
    let x = panel.x.ticked(values(0).chain(panel.marks.iter().map(|m| m.x)).chain(corners(0)));
    let y = panel.y.ticked(values(1).chain(corners(1)));
    let mut chart = ChartBuilder::on(&plot)
        .margin_top(px(8.0))
        .x_label_area_size(px(38.0))
        .y_label_area_size(px(62.0))
        .build_cartesian_2d(x.clone(), y.clone())?;
    chart
        .configure_mesh()
        .x_desc(panel.x.label.as_str())
        .y_desc(panel.y.label.as_str())
        .label_style(text(TEXT, unit))
        .axis_desc_style(text(TEXT, unit))
        .bold_line_style(RGBColor(225, 225, 225).stroke_width(px(0.6) as u32))
        .light_line_style(TRANSPARENT)
        .axis_style(BLACK.stroke_width(px(0.8) as u32))
        .set_all_tick_mark_size(px(4.0))
        .draw()?;
    for cell in cells() {
        let place = |[a, b]: [f64; 2]| Some((x.place(a)?, y.place(b)?));
        if let (Some(low), Some(high)) = (place(cell.low), place(cell.high)) {
            chart.draw_series([Rectangle::new([low, high], rgb(cell.colour).filled())])?;
        }
    }
    for mark in &panel.marks {
        if let Some(at) = x.place(mark.x) {
            let ends = [y.low(), y.high()].map(|end| (at, end));
            let style = rgb(mark.colour).stroke_width(px(1.2) as u32);
            chart.draw_series(DashedLineSeries::new(ends, px(5.0), px(3.0), style))?;
        }
    }
    for series in &panel.series {
        for run in runs(&series.points, &x, &y) {
            match series.draw {
                Draw::Line(colour) => {
                    let style = rgb(colour).stroke_width(px(1.1) as u32);
                    match joints {
                        Joints::Viewer => {
                            chart.draw_series(LineSeries::new(run, style))?;
                        }
                        Joints::Open => {
                            let segment = |w: &[_]| PathElement::new(w.to_vec(), style);
                            chart.draw_series(run.windows(2).map(segment))?;
                        }
                    }
                }
                Draw::Dashed(colour) => {
                    let style = rgb(colour).stroke_width(px(1.1) as u32);
                    chart.draw_series(DashedLineSeries::new(run, px(5.0), px(3.0), style))?;
                }
                Draw::Dots(colour, radius) => {
                    let dot = |at| Circle::new(at, px(radius), rgb(colour).filled());
                    chart.draw_series(run.into_iter().map(dot))?;
                }
            }
        }
    }
    Ok(())
}

/// The points in drawing coordinates, cut at those that cannot be drawn.
fn runs(points: &[[f64; 2]], x: &Ticked, y: &Ticked) -> Vec<Vec<(f64, f64)>> {
    let mut runs = vec![Vec::new()];
    for &[a, b] in points {
        match (x.place(a), y.place(b), runs.last_mut()) {
            (Some(a), Some(b), Some(run)) => run.push((a, b)),
            _ => runs.push(Vec::new()),
        }
    }
    runs.retain(|run| !run.is_empty());
    runs
}

/// Draws what the colours of a map mean, from the height `top` (pixels) downwards; returns where that ends.
fn key<DB: DrawingBackend>(
    key: &Key,
    area: &Area<DB>,
    top: i32,
    unit: f64,
) -> Result<i32, Failure<DB>> {
    let px = |points: f64| (points * unit).round() as i32;
    let style = text(TEXT, unit).pos(Pos::new(HPos::Left, VPos::Center));
    let width =
        |label: &str| Ok::<_, Failure<DB>>(area.estimate_text_size(label, &style)?.0 as i32);
    let middle = top + px(0.5 * LINE);
    let (low, high) = (top + px(3.0), top + px(LINE - 3.0));
    let mut left = px(62.0);
    match key {
        Key::Values { label, range, .. } => {
            let [from, to] = range.map(short);
            area.draw(&Text::new(from.as_str(), (left, middle), style.clone()))?;
            left += width(&from)? + px(5.0);
            let steps = px(COLOURS);
            for i in 0..steps {
                let colour = rgb(viridis(f64::from(i) / f64::from(steps - 1)));
                let strip = [(left + i, low), (left + i + 1, high)];
                area.draw(&Rectangle::new(strip, colour.filled()))?;
            }
            left += steps + px(5.0);
            area.draw(&Text::new(to.as_str(), (left, middle), style.clone()))?;
            left += width(&to)? + px(14.0);
            area.draw(&Text::new(label.as_str(), (left, middle), style))?;
        }
        Key::Classes(classes) => {
            for (label, colour) in classes {
                let sample = [(left, low), (left + px(SAMPLE), high)];
                area.draw(&Rectangle::new(sample, rgb(*colour).filled()))?;
                left += px(SAMPLE + 6.0);
                area.draw(&Text::new(label.as_str(), (left, middle), style.clone()))?;
                left += width(label)? + px(14.0);
            }
        }
    }
    Ok(top + px(LINE))
}

/// An end of a range for the legend; with an exponent where it would be long.
fn short(value: f64) -> String {
    let plain = value == 0.0 || (1e-3..1e5).contains(&value.abs());
    let text = if plain { format!("{value}") } else { format!("{value:e}") };
    text.replace('-', "\u{2212}")
}

/// Draws the legend from the height `top` (pixels) downwards, in as many lines as it needs; returns where it
/// ends.
fn legend<DB: DrawingBackend>(
    panel: &Panel,
    area: &Area<DB>,
    mut top: i32,
    unit: f64,
) -> Result<i32, Failure<DB>> {
    let px = |points: f64| (points * unit).round() as i32;
    let named = panel.series.iter().filter(|s| !s.label.is_empty());
    let entries: Vec<(&str, Draw)> = named
        .map(|s| (s.label.as_str(), s.draw))
        .chain(
            panel
                .marks
                .iter()
                .filter(|mark| !mark.label.is_empty())
                .map(|Mark { label, colour, .. }| (label.as_str(), Draw::Dashed(*colour))),
        )
        .collect();
    if entries.is_empty() {
        return Ok(top);
    }
    let style = text(TEXT, unit).pos(Pos::new(HPos::Left, VPos::Center));
    let (start, end) = (px(62.0), area.dim_in_pixel().0 as i32);
    let mut left = start;
    for (label, draw) in entries {
        let width = area.estimate_text_size(label, &style)?.0 as i32;
        let needed = px(SAMPLE + 6.0) + width;
        if left > start && left + needed > end {
            left = start;
            top += px(LINE);
        }
        let middle = top + px(0.5 * LINE);
        let ends = [(left, middle), (left + px(SAMPLE), middle)];
        match draw {
            Draw::Line(colour) => {
                area.draw(&PathElement::new(ends, rgb(colour).stroke_width(px(1.4) as u32)))?;
            }
            Draw::Dashed(colour) => {
                for from in [0.0, 7.5, 15.0] {
                    let dash = [from, from + 5.0].map(|at| (left + px(at), middle));
                    area.draw(&PathElement::new(dash, rgb(colour).stroke_width(px(1.4) as u32)))?;
                }
            }
            Draw::Dots(colour, _) => {
                let centre = (left + px(0.5 * SAMPLE), middle);
                area.draw(&Circle::new(centre, px(2.5), rgb(colour).filled()))?;
            }
        }
        area.draw(&Text::new(label, (left + px(SAMPLE + 6.0), middle), style.clone()))?;
        left += needed + px(14.0);
    }
    Ok(top + px(LINE))
}
