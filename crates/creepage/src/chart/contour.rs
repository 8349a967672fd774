//! Lines of equal value on a rectangular grid.

use std::collections::BTreeMap;

/// An edge of a grid: its node of lower indices (i, j), and whether it runs along x.
type Edge = (usize, usize, bool);

/// The lines on which `values` equals `level`, by marching squares: values are linear along the edges of the grid.
///
/// The value at the node (`x[i]`, `y[j]`) is `values[i + x.len() * j]`; `x` and `y` ascend. Returns points (x, y)
/// in the units of the grid; a point of NaN ends each line, as [`Series`](crate::chart::Series) draws them. A cell with a
/// corner that is not finite has no line. At a saddle the lines separate the two higher corners.
///
/// Empty if `values` has fewer entries than the grid has nodes.
pub fn contour(x: &[f64], y: &[f64], values: &[f64], level: f64) -> Vec<[f64; 2]> {
    if values.len() < x.len() * y.len() {
        return Vec::new();
    }
    let value = |i: usize, j: usize| values[i + x.len() * j];
    let mut neighbours = BTreeMap::<Edge, Vec<Edge>>::new();
    for j in 0..y.len().saturating_sub(1) {
        for i in 0..x.len().saturating_sub(1) {
            for [a, b] in crossings(i, j, level, &value).into_iter().flatten() {
                neighbours.entry(a).or_default().push(b);
                neighbours.entry(b).or_default().push(a);
            }
        }
    }
    let place = |(i, j, along_x): Edge| {
        let (k, l) = if along_x { (i + 1, j) } else { (i, j + 1) };
        let share = (level - value(i, j)) / (value(k, l) - value(i, j));
        [x[i] + share * (x[k] - x[i]), y[j] + share * (y[l] - y[j])]
    };
    let mut points = Vec::new();
    // lines that end at the border first, then closed ones
    while let Some(start) = neighbours
        .iter()
        .find(|(_, next)| next.len() == 1)
        .or_else(|| neighbours.iter().next())
        .map(|(edge, _)| *edge)
    {
        let mut at = start;
        points.push(place(at));
        while let Some(next) = step(&mut neighbours, at) {
            at = next;
            points.push(place(at));
        }
        points.push([f64::NAN; 2]);
    }
    points
}

/// Removes a segment that begins at `at` from the graph and returns its other end.
fn step(neighbours: &mut BTreeMap<Edge, Vec<Edge>>, at: Edge) -> Option<Edge> {
    let next = neighbours.get_mut(&at)?.pop()?;
    if let Some(back) = neighbours.get_mut(&next) {
        back.retain(|edge| *edge != at);
    }
    for edge in [at, next] {
        if neighbours.get(&edge).is_some_and(Vec::is_empty) {
            neighbours.remove(&edge);
        }
    }
    Some(next)
}

/// The segments of the line in a cell, each from edge to edge.
fn crossings(
    i: usize,
    j: usize,
    level: f64,
    value: &impl Fn(usize, usize) -> f64,
) -> [Option<[Edge; 2]>; 2] {
    let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| value(i, j));
    if corners.iter().any(|v| !v.is_finite()) {
        return [None; 2];
    }
    let edges = [(i, j, true), (i + 1, j, false), (i, j + 1, true), (i, j, false)];
    let above = corners.map(|v| v >= level);
    let mut cut = (0..4).filter(|&k| above[k] != above[(k + 1) % 4]).map(|k| edges[k]);
    match [cut.next(), cut.next(), cut.next(), cut.next()] {
        [Some(a), Some(b), None, None] => [Some([a, b]), None],
        // a saddle: each segment cuts off one of the two corners above the level
        [Some(a), Some(b), Some(c), Some(d)] if above[0] => [Some([d, a]), Some([b, c])],
        [Some(a), Some(b), Some(c), Some(d)] => [Some([a, b]), Some([c, d])],
        _ => [None; 2],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(points: &[[f64; 2]]) -> Vec<&[[f64; 2]]> {
        points.split(|p| p[0].is_nan()).filter(|line| !line.is_empty()).collect()
    }

    fn grid(n: usize, value: impl Fn(f64, f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let x: Vec<f64> = (0..n).map(|i| i as f64 - 0.5 * (n - 1) as f64).collect();
        let values = x.iter().flat_map(|y| x.iter().map(|x| value(*x, *y))).collect();
        (x, values)
    }

    #[test]
    fn a_plane_has_one_straight_line_where_it_takes_the_level() {
        let (x, values) = grid(6, |x, y| 2.0 * x + 0.5 * y);
        let points = contour(&x, &x, &values, 0.3);
        assert_eq!(lines(&points).len(), 1);
        for p in lines(&points)[0] {
            assert!((2.0 * p[0] + 0.5 * p[1] - 0.3).abs() < 1e-12, "{p:?}");
        }
    }

    #[test]
    fn a_cone_has_one_closed_line_about_as_long_as_its_circle() {
        let (x, values) = grid(41, libm::hypot);
        let points = contour(&x, &x, &values, 12.3);
        let all = lines(&points);
        assert_eq!(all.len(), 1);
        assert_eq!(all[0].first(), all[0].last());
        let length: f64 =
            all[0].windows(2).map(|w| libm::hypot(w[1][0] - w[0][0], w[1][1] - w[0][1])).sum();
        assert!((length / (2.0 * std::f64::consts::PI * 12.3) - 1.0).abs() < 5e-3, "{length}");
    }

    #[test]
    fn a_saddle_parts_and_what_is_not_finite_has_no_line() {
        let corners = [1.0, -1.0, -1.0, 1.0];
        let points = contour(&[0.0, 1.0], &[0.0, 1.0], &corners, 0.0);
        assert_eq!(lines(&points).len(), 2);
        let corners = [1.0, f64::INFINITY, -1.0, 1.0];
        assert!(contour(&[0.0, 1.0], &[0.0, 1.0], &corners, 0.0).is_empty());
        assert!(contour(&[0.0, 1.0], &[0.0, 1.0], &[1.0], 0.0).is_empty());
    }
}
