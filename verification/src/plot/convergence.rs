//! `--plot`: error over mesh size, one panel for each problem.

use creepage::chart::{Axis, Draw, Figure, Panel, Series, colour};
use verification::Row;

/// Width and height of a panel (points).
const PANEL: [u32; 2] = [350, 340];
/// Panels in a row.
const COLUMNS: usize = 3;
/// Colours of the series of a panel. More series would leave the plot no room below their names.
const COLOURS: [[u8; 3]; 4] = [colour::BLACK, colour::BLUE, colour::VERMILION, colour::GREEN];

/// Errors of the rows with three meshes or more, problem by problem; `None` where there are none.
///
/// The error is relative to the reference, and absolute where the reference is zero. A dashed line
/// shows first order.
pub fn figure(rows: &[Row]) -> Option<Figure> {
    let studies: Vec<&Row> = rows.iter().filter(|row| row.meshes.len() > 2).collect();
    let problems = studies.chunk_by(|one, next| one.name == next.name);
    let mut panels: Vec<Panel> = problems
        .flat_map(|problem| {
            let count = problem.len().div_ceil(COLOURS.len());
            problem.chunks(problem.len().div_ceil(count)).map(panel)
        })
        .collect();
    panels.iter_mut().for_each(first_order);
    let lines = panels.len().div_ceil(COLUMNS) as u32;
    let size = [PANEL[0] * COLUMNS as u32, PANEL[1] * lines + 40];
    let caption =
        "Error over mesh size h, relative to the reference, and absolute where that is zero.";
    let figure = Figure { size, columns: COLUMNS, panels, caption: caption.into() };
    (!figure.panels.is_empty()).then_some(figure)
}

/// Errors of rows of one problem, at most as many as there are colours.
fn panel(rows: &[&Row]) -> Panel {
    let series = rows.iter().zip(COLOURS).map(|(row, colour)| {
        let scale = if row.reference == 0.0 { 1.0 } else { row.reference.abs() };
        let point =
            |s: &verification::Sample| [1e3 * s.size, (s.value - row.reference).abs() / scale];
        let label = row.quantity.split(", extrapolated").next().unwrap_or_default();
        Series {
            label: subscripts(label),
            points: row.meshes.iter().map(point).collect(),
            draw: Draw::Line(colour),
        }
    });
    Panel {
        title: rows.first().map(|row| row.name.into()).unwrap_or_default(),
        series: series.collect(),
        ..Panel::new(Axis::log("h (mm)"), Axis::log("error"))
    }
}

/// The name of a quantity with the subscripts of its symbols, as figures write them: of a symbol of one or two
/// letters, the letters behind `_`.
fn subscripts(name: &str) -> String {
    let of_word = |word: &str| match word.split_once('_') {
        Some((symbol, subscript)) if (1..=2).contains(&symbol.chars().count()) => {
            let end = subscript.find(|c: char| !c.is_alphanumeric()).unwrap_or(subscript.len());
            let (subscript, rest) = subscript.split_at(end);
            format!("{symbol}_{{{subscript}}}{rest}")
        }
        _ => word.to_owned(),
    };
    name.split(' ').map(of_word).collect::<Vec<_>>().join(" ")
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
    fn symbols_have_subscripts_and_other_words_do_not() {
        assert_eq!(subscripts("k_t 3.5e13: p_f, over mu"), "k_{t} 3.5e13: p_{f}, over mu");
        assert_eq!(subscripts("shear_column over mu"), "shear_column over mu");
    }

    #[test]
    fn a_panel_shows_the_error_on_each_mesh_and_rows_without_meshes_give_none() {
        let study =
            verification::Convergence::new([4e-3, 2e-3, 1e-3].map(|h| (h, 5.0 + 5.0 * h)), 1.0);
        let row = Row::extrapolated("q", 5.0, &study, (0.0, ""), "");
        let drawn = figure(&[row]).unwrap();
        for (point, h) in drawn.panels[0].series[0].points.iter().zip([4.0, 2.0, 1.0]) {
            assert!(
                (point[0] / h - 1.0).abs() < 1e-12 && (point[1] / (1e-3 * h) - 1.0).abs() < 1e-9
            );
        }
        assert!(figure(&[Row::new("q", [1.0, 1.0], 1.0, (0.1, ""), "")]).is_none());
    }

    #[test]
    fn many_rows_of_a_problem_are_divided_evenly() {
        let study = verification::Convergence::new([4e-3, 2e-3, 1e-3].map(|h| (h, 5.0 + h)), 1.0);
        let rows = [(); 6].map(|()| Row::extrapolated("q", 5.0, &study, (0.0, ""), ""));
        let drawn = figure(&rows).unwrap();
        // with the line of first order
        assert_eq!(drawn.panels.iter().map(|panel| panel.series.len()).collect::<Vec<_>>(), [4, 4]);
    }
}
