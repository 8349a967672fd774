//! `--plot`: rupture times over the fault on each mesh, and along its axes.

use creepage::chart::{Axis, Cell, Draw, Figure, Fill, Key, Panel, Scale, Series, colour, contour};
use verification::{Field, Row};

/// Width and height of a panel (points).
const PANEL: [u32; 2] = [640, 400];
/// Time between contours (s).
const EVERY: f64 = 0.5;
const COARSE: [[u8; 3]; 4] = [colour::ORANGE, colour::BLUE, colour::GREEN, colour::PURPLE];

/// The fields that rows bring along, the last of them the reference's; `None` where no row has any.
pub fn figure(rows: &[Row]) -> Option<Figure> {
    let fields = rows.iter().map(|row| row.fields.as_slice()).find(|fields| fields.len() > 1)?;
    let [meshes @ .., reference] = fields else { return None };
    let finest = meshes.last()?;
    let panels = vec![
        whole(finest),
        quarter(meshes, reference),
        along(meshes, reference, 0, "x, along strike (km)"),
        along(meshes, reference, 1, "y, along dip (km)"),
    ];
    let caption = format!(
        "Time at which each place of the fault first slips faster than 1 mm/s; contours every {EVERY} s."
    );
    Some(Figure { size: [2 * PANEL[0], 2 * PANEL[1]], columns: 2, panels, caption })
}

/// The whole fault, mirrored from the quarter.
fn whole(field: &Field) -> Panel {
    let latest = latest(field);
    let key = Key::Values {
        label: format!("rupture time (s), {}", field.name),
        range: [0.0, (latest / EVERY).ceil() * EVERY],
        scale: Scale::Linear,
    };
    let km = |line: &[f64], i: usize| 1e-3 * line[i];
    let mut cells = Vec::new();
    for j in 1..field.y.len() {
        for i in 1..field.x.len() {
            let value = field
                .at([0.5 * (field.x[i - 1] + field.x[i]), 0.5 * (field.y[j - 1] + field.y[j])]);
            let ([x, a], [y, b]) =
                ([km(&field.x, i - 1), km(&field.x, i)], [km(&field.y, j - 1), km(&field.y, j)]);
            let colour = key.colour(value);
            for (low, high) in
                [([x, y], [a, b]), ([-a, y], [-x, b]), ([x, -b], [a, -y]), ([-a, -b], [-x, -y])]
            {
                cells.push(Cell { low, high, colour });
            }
        }
    }
    let quarter = contours(field);
    let series = [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[a, b]| Series {
        label: String::new(),
        points: quarter.iter().map(|[x, y]| [a * x, b * y]).collect(),
        draw: Draw::Line(colour::BLACK),
    });
    Panel {
        title: "Rupture time".into(),
        to_scale: true,
        fill: Some(Fill { cells, key }),
        series: series.into(),
        ..Panel::new(
            Axis::linear("x, along strike (km)").over(-15.0, 15.0),
            Axis::linear("y, along dip (km)").over(-7.5, 7.5),
        )
    }
}

/// Contours of all meshes and of the reference.
fn quarter(meshes: &[Field], reference: &Field) -> Panel {
    let line =
        |field: &Field, draw| Series { label: field.name.clone(), points: contours(field), draw };
    let mut series: Vec<Series> =
        meshes.iter().enumerate().map(|(i, f)| line(f, draw(i, meshes.len()))).collect();
    series.push(line(reference, Draw::Dashed(colour::VERMILION)));
    Panel {
        title: "Contours, one quarter".into(),
        to_scale: true,
        series,
        ..Panel::new(
            Axis::linear("x, along strike (km)").over(0.0, 15.0),
            Axis::linear("y, along dip (km)").over(0.0, 7.5),
        )
    }
}

/// Rupture times on an axis of the fault.
fn along(meshes: &[Field], reference: &Field, axis: usize, label: &str) -> Panel {
    let times = |field: &Field| {
        let line = if axis == 0 { &field.x } else { &field.y };
        line.iter()
            .map(|&x| [1e-3 * x, field.at(if axis == 0 { [x, 0.0] } else { [0.0, x] })])
            .collect()
    };
    let mut series: Vec<Series> = meshes
        .iter()
        .enumerate()
        .map(|(i, field)| Series {
            label: field.name.clone(),
            points: times(field),
            draw: draw(i, meshes.len()),
        })
        .collect();
    series.push(Series {
        label: reference.name.clone(),
        points: times(reference),
        draw: Draw::Dots(colour::VERMILION, 2.5),
    });
    Panel { series, ..Panel::new(Axis::linear(label), Axis::linear("rupture time (s)")) }
}

/// The finest mesh in black.
fn draw(i: usize, meshes: usize) -> Draw {
    Draw::Line(if i + 1 == meshes { colour::BLACK } else { COARSE[i % COARSE.len()] })
}

fn latest(field: &Field) -> f64 {
    field.values.iter().filter(|t| t.is_finite()).fold(0.0, |most, t| t.max(most))
}

/// All contours of a field (km).
fn contours(field: &Field) -> Vec<[f64; 2]> {
    let [x, y] = [&field.x, &field.y].map(|line| line.iter().map(|x| 1e-3 * x).collect::<Vec<_>>());
    let levels = (latest(field) / EVERY) as usize;
    let lines = (1..=levels).map(|k| contour(&x, &y, &field.values, EVERY * k as f64));
    lines.flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(fields: Vec<Field>) -> Row {
        Row { fields, ..Row::new("q", [1.0, 1.0], 1.0, (0.1, ""), "") }
    }

    fn field(speed: f64) -> Field {
        let (x, y): (Vec<f64>, Vec<f64>) =
            ((0..16).map(|i| 1e3 * f64::from(i)).collect(), vec![0.0, 1e3, 2e3]);
        let values = y.iter().flat_map(|_| x.iter().map(|x| x / speed)).collect();
        Field { name: format!("{speed}"), size: 1e3, x, y, values }
    }

    #[test]
    fn contours_of_a_straight_front_lie_where_it_is_at_their_times() {
        let drawn = figure(&[row(vec![field(3e3), field(2e3)])]).unwrap();
        let points = &drawn.panels[1].series[0].points;
        for p in points.iter().filter(|p| p[0].is_finite()) {
            assert!((p[0] / 1.5 - (p[0] / 1.5).round()).abs() < 1e-9, "{p:?}");
        }
        assert_eq!(points.iter().filter(|p| p[0].is_nan()).count(), 10);
    }

    #[test]
    fn rows_without_fields_have_no_figure() {
        assert!(figure(&[row(Vec::new())]).is_none());
    }
}
