//! Drawing of figures and their panels, on any backend.

use crate::chart::axes::{self, Plot};
use crate::chart::axis::Ticked;
use crate::chart::layout::{Area, Failure, GAP, LINE, Medium, Pen, TEXT, TICK, TITLE, rgb};
use crate::chart::legend::{self, Room};
use crate::chart::{Draw, Figure, Panel, Series, arrow, group};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

// Sizes in points of 1/96 inch.
/// Beside the caption.
const MARGIN: f64 = 20.0;
/// Around a panel: above, below, to the left and to the right.
const AROUND: [f64; 4] = [8.0, 6.0, 8.0, 20.0];
/// Length of a dash and of the gap after it.
const DASH: [f64; 2] = [5.0, 3.0];
/// Most intervals between the ticks of an axis.
const INTERVALS: usize = 7;

/// Draws with `unit` pixels per point.
pub(crate) fn figure<DB: DrawingBackend>(
    figure: &Figure,
    area: &Area<DB>,
    unit: f64,
    medium: Medium,
) -> Result<(), Failure<DB>> {
    area.fill(&WHITE)?;
    let pen = Pen { area, unit, medium };
    let area = caption(figure, &pen)?;
    let columns = figure.columns.max(1);
    let areas = area.split_evenly((figure.panels.len().div_ceil(columns), columns));
    // plots below each other begin at the same place
    let mut beside = vec![0; columns];
    for (i, panel) in figure.panels.iter().enumerate() {
        let needed = beside_plot(&pen, panel)?;
        beside[i % columns] = needed.max(beside[i % columns]);
    }
    for (i, (panel, area)) in figure.panels.iter().zip(&areas).enumerate() {
        draw_panel(panel, &pen.on(area), beside[i % columns])?;
    }
    Ok(())
}

/// Above a caption and below it.
const AROUND_CAPTION: [f64; 2] = [6.0, 4.0];

/// Height of a figure's caption (points of 1/96 inch); why it cannot be measured.
pub(crate) fn caption_height(figure: &Figure) -> Result<f64, String> {
    const UNIT: u32 = 4;
    let (mut unseen, size) = (String::new(), figure.size.map(|points| points * UNIT));
    let area = SVGBackend::with_string(&mut unseen, size.into()).into_drawing_area();
    let pen = Pen { area: &area, unit: f64::from(UNIT), medium: Medium::Svg };
    let lines = caption_lines(figure, &pen).map_err(|error| error.to_string())?.len();
    let around = AROUND_CAPTION.iter().sum::<f64>();
    Ok(if lines == 0 { 0.0 } else { lines as f64 * LINE + around })
}

fn caption_lines<DB: DrawingBackend>(
    figure: &Figure,
    pen: &Pen<'_, DB>,
) -> Result<Vec<String>, Failure<DB>> {
    pen.lines(&figure.caption, pen.area.dim_in_pixel().0 as i32 - pen.px(2.0 * MARGIN))
}

/// Draws the caption at the bottom of the area; returns what is left above it.
fn caption<DB: DrawingBackend>(
    figure: &Figure,
    pen: &Pen<'_, DB>,
) -> Result<Area<DB>, Failure<DB>> {
    if figure.caption.is_empty() {
        return Ok(pen.area.clone());
    }
    let lines = caption_lines(figure, pen)?;
    let [above, below] = AROUND_CAPTION.map(|points| pen.px(points));
    let top = pen.area.dim_in_pixel().1 as i32 - pen.px(LINE) * lines.len() as i32 - below;
    for (i, line) in lines.iter().enumerate() {
        let middle = top + pen.px((i as f64 + 0.5) * LINE);
        pen.write(line, TEXT, (pen.px(MARGIN), middle), HPos::Left)?;
    }
    Ok(pen.area.split_vertically(top - above).0)
}

/// Width of what stands to the left of a plot: the title of its axis and the labels of its ticks (pixels).
fn beside_plot<DB: DrawingBackend>(pen: &Pen<'_, DB>, panel: &Panel) -> Result<i32, Failure<DB>> {
    let [_, y] = ticked(panel);
    let mut axes = vec![y];
    if panel.to_scale {
        // its range may be widened, and its labels become longer
        axes.push(axes[0].widened(2.0));
    }
    let mut widest = 0;
    for axis in &axes {
        for tick in axis.ticks() {
            widest = widest.max(pen.width(&axis.label(*tick), TEXT)?);
        }
    }
    let title = if panel.y.label.is_empty() { 0.0 } else { GAP + TEXT };
    Ok(widest + pen.px(2.0 * TICK + title))
}

/// The axes of a panel with their ticks.
fn ticked(panel: &Panel) -> [Ticked; 2] {
    let values =
        |axis: usize| panel.series.iter().flat_map(move |s| &s.points).map(move |p| p[axis]);
    let cells = || panel.fill.iter().flat_map(|fill| &fill.cells);
    let corners = |axis: usize| cells().flat_map(move |cell| [cell.low[axis], cell.high[axis]]);
    let marks = panel.marks.iter().map(|mark| mark.x);
    [
        panel.x.ticked(values(0).chain(marks).chain(corners(0)), INTERVALS),
        panel.y.ticked(values(1).chain(corners(1)), INTERVALS),
    ]
}

fn draw_panel<DB: DrawingBackend>(
    panel: &Panel,
    pen: &Pen<'_, DB>,
    beside: i32,
) -> Result<(), Failure<DB>> {
    let [above, below, left, right] = AROUND.map(|points| pen.px(points));
    let area = pen.area.margin(above, below, left, right);
    let pen = pen.on(&area);
    let (right, bottom) = area.dim_in_pixel();
    let (right, bottom) = (right as i32, bottom as i32);
    let mut top = 0;
    if !panel.title.is_empty() {
        let at = ((beside + right) / 2, pen.px(0.5 * LINE));
        pen.write(&panel.title, TITLE, at, HPos::Center)?;
        top += pen.px(LINE + 2.0);
    }
    if let Some(fill) = &panel.fill {
        top = legend::key(&pen, &fill.key, Room { left: beside, right, top })?;
    }
    top = legend::names(&pen, panel, Room { left: beside, right, top })?;
    let across = beside..right;
    let down = top + above..bottom - pen.px(2.0 * TICK + TEXT + GAP + TEXT);
    let [x, y] = ticked(panel);
    let [x, y] = if panel.to_scale { to_scale([x, y], [across.len(), down.len()]) } else { [x, y] };
    let plot = Plot { x, y, across, down };
    axes::draw(&pen, panel, &plot)?;
    group::open_plot(&pen, panel, &plot)?;
    content(&pen, panel, &plot)?;
    group::close(&pen)
}

/// The axes with the range of one widened, so that a unit is as long on both in a plot of `size` pixels.
fn to_scale([x, y]: [Ticked; 2], size: [usize; 2]) -> [Ticked; 2] {
    let [across, up] = [(&x, size[0]), (&y, size[1])]
        .map(|(axis, pixels)| (axis.high() - axis.low()) / pixels.max(1) as f64);
    [x.widened((up / across).max(1.0)), y.widened((across / up).max(1.0))]
}

/// Draws cells, marks and series.
fn content<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    panel: &Panel,
    plot: &Plot,
) -> Result<(), Failure<DB>> {
    if let Some(fill) = &panel.fill {
        group::open_map(pen, &fill.key)?;
        for cell in &fill.cells {
            if let (Some(low), Some(high)) = (plot.pixel(cell.low), plot.pixel(cell.high)) {
                let [low, high] = [low, high].map(whole);
                pen.area.draw(&Rectangle::new([low, high], rgb(cell.colour).filled()))?;
            }
        }
        group::close(pen)?;
    }
    for face in &panel.faces {
        let corners: Option<Vec<_>> = face.corners.iter().map(|at| plot.pixel(*at)).collect();
        if let Some(corners) = corners {
            let corners: Vec<_> = corners.into_iter().map(whole).collect();
            pen.area.draw(&Polygon::new(corners, rgb(face.colour).filled()))?;
        }
    }
    for mark in &panel.marks {
        let ends = [plot.down.end, plot.down.start].map(f64::from);
        if let Some(x) = plot.x_pixel(mark.x) {
            dashed(pen, &ends.map(|y| [x, y]), mark.colour, 1.2)?;
        }
    }
    for shown in &panel.series {
        group::open_series(pen, shown, DASH[1] * pen.unit)?;
        series(pen, shown, plot)?;
        group::close(pen)?;
    }
    Ok(())
}

fn series<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    series: &Series,
    plot: &Plot,
) -> Result<(), Failure<DB>> {
    let points = series.points.iter().map(|point| plot.pixel(*point));
    match series.draw {
        Draw::Line(colour) => {
            for run in runs(points) {
                line(pen, &run, colour)?;
            }
        }
        Draw::Dashed(colour) => {
            for run in runs(points) {
                dashed(pen, &run, colour, 1.1)?;
            }
        }
        Draw::Dots(colour, radius) => {
            for at in points.flatten() {
                let dot = Circle::new(whole(at), pen.px(radius), rgb(colour).filled());
                pen.area.draw(&dot)?;
            }
        }
        Draw::Arrows(colour) => {
            let points: Vec<_> = points.collect();
            for ends in points.as_chunks::<2>().0 {
                let [Some(tail), Some(tip)] = *ends else { continue };
                for piece in arrow::pieces(tail, tip, pen.unit) {
                    pen.path(piece, colour, 1.0)?;
                }
            }
        }
    }
    Ok(())
}

fn whole([x, y]: [f64; 2]) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

/// Points (pixels) cut into lines at those that cannot be drawn.
fn runs(points: impl Iterator<Item = Option<[f64; 2]>>) -> Vec<Vec<[f64; 2]>> {
    let mut runs = vec![Vec::new()];
    for point in points {
        match (point, runs.last_mut()) {
            (Some(point), Some(run)) => run.push(point),
            _ => runs.push(Vec::new()),
        }
    }
    runs.retain(|run| run.len() > 1);
    runs
}

/// A continuous line through points (pixels).
fn line<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    points: &[[f64; 2]],
    colour: [u8; 3],
) -> Result<(), Failure<DB>> {
    const THICK: f64 = 1.1;
    let mut at: Vec<(i32, i32)> = points.iter().map(|point| whole(*point)).collect();
    at.dedup();
    if !matches!(pen.medium, Medium::Bitmap(_)) {
        return pen.path(at, colour, THICK);
    }
    // the bitmap backend draws spikes at sharp turns of a path
    for ends in at.windows(2) {
        pen.path(ends, colour, THICK)?;
    }
    for joint in at {
        let radius = (0.5 * THICK * pen.unit) as i32;
        pen.area.draw(&Circle::new(joint, radius, rgb(colour).filled()))?;
    }
    Ok(())
}

/// A dashed line through points (pixels).
fn dashed<DB: DrawingBackend>(
    pen: &Pen<'_, DB>,
    points: &[[f64; 2]],
    colour: [u8; 3],
    thick: f64,
) -> Result<(), Failure<DB>> {
    for dash in dashes(points, DASH.map(|length| length * pen.unit)) {
        pen.path(dash.into_iter().map(whole).collect::<Vec<_>>(), colour, thick)?;
    }
    Ok(())
}

/// The dashes of a line: pieces of the length `on`, with gaps of the length `off` between them.
fn dashes(points: &[[f64; 2]], [on, off]: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let mut dashes = Vec::new();
    let mut dash = points.first().map_or(Vec::new(), |first| vec![*first]);
    // what remains of the dash or of the gap
    let (mut drawn, mut left) = (true, on);
    for ends in points.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let mut gone = 0.0;
        while length - gone > left {
            gone += left;
            let at = [0, 1].map(|i| from[i] + gone / length * (to[i] - from[i]));
            dash.push(at);
            if drawn {
                dashes.push(std::mem::take(&mut dash));
            }
            dash = vec![at];
            drawn = !drawn;
            left = if drawn { on } else { off };
        }
        left -= length - gone;
        dash.push(to);
    }
    if drawn && dash.len() > 1 {
        dashes.push(dash);
    }
    dashes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_go_on_around_corners() {
        let corner = [[0.0, 0.0], [6.0, 0.0], [6.0, 10.0]];
        let found = dashes(&corner, [4.0, 4.0]);
        assert_eq!(found[0], [[0.0, 0.0], [4.0, 0.0]]);
        assert_eq!(found[1], [[6.0, 2.0], [6.0, 6.0]]);
        assert_eq!(found.len(), 2);
        assert_eq!(dashes(&corner, [8.0, 4.0])[0], [[0.0, 0.0], [6.0, 0.0], [6.0, 2.0]]);
    }
}
