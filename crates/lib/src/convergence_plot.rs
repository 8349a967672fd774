//! `creepage verify --plot`: error over mesh size, one panel for each problem.

use figure::{Axis, Draw, Figure, Panel, Series, colour};
use verify::Row;

/// Width and height of a panel (points).
const PANEL: [u32; 2] = [460, 400];
const COLOURS: [[u8; 3]; 7] = [
    colour::BLACK,
    colour::BLUE,
    colour::RED,
    colour::GREEN,
    colour::PURPLE,
    colour::ORANGE,
    colour::GREY,
];

/// Series of a panel; more would leave the legend no room for the plot.
const MOST_SERIES: usize = 8;

/// Errors of the rows with three meshes or more, problem by problem; `None` where there are none.
///
/// The error is relative to the reference, and absolute where the reference is zero. A dashed line
/// shows first order.
pub fn figure(rows: &[Row]) -> Option<Figure> {
    let mut panels: Vec<Panel> = Vec::new();
    for row in rows.iter().filter(|row| row.meshes.len() > 2) {
        let full = |panel: &Panel| panel.title != row.name || panel.series.len() >= MOST_SERIES;
        if panels.last().is_none_or(full) {
            panels.push(Panel {
                fill: None,
                title: row.name.into(),
                x: Axis::log("h (mm)"),
                y: Axis::log("error"),
                series: Vec::new(),
                marks: Vec::new(),
            });
        }
        let Some(panel) = panels.last_mut() else { continue };
        let scale = if row.reference == 0.0 { 1.0 } else { row.reference.abs() };
        let point = |s: &verify::Sample| [1e3 * s.size, (s.value - row.reference).abs() / scale];
        let label = row.quantity.split(", extrapolated").next().unwrap_or_default();
        panel.series.push(Series {
            label: label.into(),
            points: row.meshes.iter().map(point).collect(),
            draw: Draw::Line(COLOURS[panel.series.len() % COLOURS.len()]),
        });
    }
    panels.iter_mut().for_each(first_order);
    let columns = 2;
    let lines = panels.len().div_ceil(columns) as u32;
    let size = [PANEL[0] * columns as u32, PANEL[1] * lines];
    (!panels.is_empty()).then_some(Figure { size, columns, panels, caption: String::new() })
}

/// Adds the line of first order through the largest error on the coarsest mesh.
fn first_order(panel: &mut Panel) {
    let points = panel.series.iter().flat_map(|series| &series.points);
    let [low, high, most] = points.fold([f64::INFINITY, 0.0, 0.0f64], |[low, high, most], p| {
        [low.min(p[0]), p[0].max(high), most.max(p[1])]
    });
    panel.series.push(Series {
        label: "first order".into(),
        points: vec![[low, most * low / high], [high, most]],
        draw: Draw::Dashed(colour::GREY),
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_shows_the_error_on_each_mesh_and_rows_without_meshes_give_none() {
        let study = verify::Convergence::new([4e-3, 2e-3, 1e-3].map(|h| (h, 5.0 + 5.0 * h)), 1.0);
        let row = Row::extrapolated("q", 5.0, &study, (0.0, ""), "");
        let drawn = figure(&[row]).unwrap();
        for (point, h) in drawn.panels[0].series[0].points.iter().zip([4.0, 2.0, 1.0]) {
            assert!(
                (point[0] / h - 1.0).abs() < 1e-12 && (point[1] / (1e-3 * h) - 1.0).abs() < 1e-9
            );
        }
        assert!(figure(&[Row::new("q", [1.0, 1.0], 1.0, (0.1, ""), "")]).is_none());
    }
}
