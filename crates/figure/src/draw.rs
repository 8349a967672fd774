//! Drawing of panels, on any backend.

use crate::axis::Ticked;
use crate::{Draw, Figure, Mark, Panel, font};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

type Area<DB> = DrawingArea<DB, Shift>;
type Failure<DB> = DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>;

/// Sizes in points.
const TEXT: f64 = 11.0;
const TITLE: f64 = 12.5;
const LINE: f64 = 16.0;
const SAMPLE: f64 = 20.0;

/// How joints of lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Joints {
    /// By the viewer of the file.
    Viewer,
    /// Not at all, each segment by itself: the bitmap backend draws spikes at sharp turns.
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
    let columns = figure.columns.max(1);
    let areas = area.split_evenly((figure.panels.len().div_ceil(columns), columns));
    for (panel, area) in figure.panels.iter().zip(&areas) {
        draw_panel(panel, area, unit, joints)?;
    }
    Ok(())
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
    let area = area.margin(px(4.0), px(4.0), px(4.0), px(20.0));
    let mut top = 0;
    let width = area.dim_in_pixel().0 as i32;
    if !panel.title.is_empty() {
        let style = text(TITLE, unit).pos(Pos::new(HPos::Center, VPos::Top));
        area.draw(&Text::new(panel.title.as_str(), (width / 2, 0), style))?;
        top += px(LINE + 2.0);
    }
    top = legend(panel, &area, top, unit)?;
    let (_, plot) = area.split_vertically(top);

    let values =
        |axis: usize| panel.series.iter().flat_map(move |s| &s.points).map(move |p| p[axis]);
    let x = panel.x.ticked(values(0).chain(panel.marks.iter().map(|m| m.x)));
    let y = panel.y.ticked(values(1));
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

/// The points in drawing coordinates, in runs without a gap.
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

/// Draws the legend from `top` on, in as many lines as it needs; returns where it ends.
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
