//! Measures of the contact patch from nodal values.

use nalgebra::{SMatrix, SVector, Vector2, Vector3};
use std::f64::consts::PI;

/// A node is in contact where its pressure exceeds this share of Hertz's peak pressure, or of the largest nodal
/// one: nodes around the patch carry a little force that faces under a loaded node hand on to them.
pub const IN_CONTACT: f64 = 0.02;

/// Nodes with less than this part of the largest pressure do not take part in the fit: where the
/// patch ends, nodal pressures are smeared over the mesh.
const FITTED: f64 = 0.2;
/// Fewer nodes than this determine nothing.
const LEAST: usize = 5;

/// What the patch is, by the curvatures of the two bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PatchShape {
    /// An ellipse: point contact.
    #[default]
    Ellipse,
    /// A rectangle: line contact of bodies that are both flat across, a slice among them.
    Rectangle,
}

/// Hertz's distribution fitted to nodal pressures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFit {
    /// Semi-axis in x (m).
    pub a: f64,
    /// Semi-axis in y, or half the rectangle's width (m).
    pub b: f64,
    /// Peak pressure of the fitted distribution (Pa).
    pub p0: f64,
    /// x of the centre (m).
    pub xc: f64,
    /// y of the centre (m).
    pub yc: f64,
    /// Area (m^2): pi a b of an ellipse, 4 a b of a rectangle.
    pub area: f64,
}

/// Areas and peak of the patch from nodal values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PatchAreas {
    /// Tributary area of the nodes under pressure (m^2).
    pub contact: f64,
    /// Part of the contact area that sticks.
    pub stick_fraction: f64,
    /// Part of the contact area that slips.
    pub slip_fraction: f64,
    /// Largest nodal pressure (Pa).
    pub peak_pressure: f64,
}

/// Fits `p^2 = p0^2 (1 - (x-xc)^2/a^2 - (y-yc)^2/b^2)` to the nodes with `p > 0.2 p_max` at
/// `points` (m) by linear least squares in `p^2`.
///
/// A rectangle gets `p^2 = p0^2 (1 - (x-xc)^2/a^2)` over all of its width: `p0` is the root mean square
/// across it, peaks at the edges of a narrower body included, and `b` half the width over which nodes
/// take part. Nodes in one or two rows along x are a rectangle whatever `shape` says.
///
/// `None` where the nodes do not determine that: fewer than five, or a distribution that does not fall
/// off on all sides (of a rectangle: before and behind).
pub fn fit(shape: PatchShape, points: &[Vector3<f64>], pressure: &[f64]) -> Option<PatchFit> {
    let peak = pressure.iter().copied().fold(0.0, f64::max);
    let used = || points.iter().zip(pressure).filter(move |&(_, &p)| p > FITTED * peak);
    let count = used().count();
    if peak <= 0.0 || !peak.is_finite() || count < LEAST {
        return None;
    }
    // Coordinates about the mean in units of the extent keep the normal equations well scaled.
    let places = || used().map(|(x, _)| x.xy());
    let mean = places().sum::<Vector2<f64>>() / count as f64;
    let least = Vector2::repeat(f64::MIN_POSITIVE);
    let extent = places().fold(least, |most, x| most.sup(&(x - mean).abs()));
    let samples = || {
        let scaled = places().map(|x| (x - mean).component_div(&extent));
        scaled.zip(used()).map(|(s, (_, p))| (s, (p / peak) * (p / peak)))
    };
    let [low, high] =
        used().fold([f64::MAX, f64::MIN], |[a, b], (x, _)| [a.min(x[1]), b.max(x[1])]);
    let off_the_ends = |y: f64| f64::min(y - low, high - y);
    let in_rows = used().all(|(x, _)| off_the_ends(x[1]) < 1e-6 * (high - low))
        || extent[1] < 1e-9 * extent[0];
    let rectangle = in_rows || shape == PatchShape::Rectangle;
    let ([c, cx, cxx], [cy, cyy]) = if rectangle {
        (least_squares(samples().map(|(s, q)| ([1.0, s.x, s.x * s.x], q)))?, [0.0, -1.0])
    } else {
        let [c, cx, cy, cxx, cyy] =
            least_squares(samples().map(|(s, q)| ([1.0, s.x, s.y, s.x * s.x, s.y * s.y], q)))?;
        ([c, cx, cxx], [cy, cyy])
    };
    if cxx >= 0.0 || cyy >= 0.0 {
        return None;
    }
    let top = c - cx * cx / (4.0 * cxx) - cy * cy / (4.0 * cyy);
    // NaN fails the test too.
    if top.is_nan() || top <= 0.0 {
        return None;
    }
    let a = (-top / cxx).sqrt() * extent[0];
    let b = if rectangle { 0.5 * (high - low) } else { (-top / cyy).sqrt() * extent[1] };
    Some(PatchFit {
        a,
        b,
        p0: top.sqrt() * peak,
        xc: mean[0] - cx / (2.0 * cxx) * extent[0],
        yc: if rectangle { 0.5 * (low + high) } else { mean[1] - cy / (2.0 * cyy) * extent[1] },
        area: if rectangle { 4.0 } else { PI } * a * b,
    })
}

/// Coefficients of the rows' columns that fit the right sides best; `None` where they are not
/// determined.
fn least_squares<const N: usize>(rows: impl Iterator<Item = ([f64; N], f64)>) -> Option<[f64; N]> {
    let (mut matrix, mut right) = (SMatrix::zeros(), SVector::zeros());
    for (row, q) in rows {
        let row = SVector::from(row);
        matrix += row * row.transpose();
        right += q * row;
    }
    solve(matrix, right).map(Into::into)
}

/// Area-weighted measures from nodal pressure (Pa), area (m^2) and state (1 stick, 2 slip).
pub fn areas(pressure: &[f64], area: &[f64], state: &[u8]) -> PatchAreas {
    let (mut contact, mut stick, mut slip) = (0.0, 0.0, 0.0);
    let peak = pressure.iter().copied().fold(0.0, f64::max);
    for ((&p, &a), &state) in pressure.iter().zip(area).zip(state) {
        if p > IN_CONTACT * peak {
            contact += a;
            stick += if state == 1 { a } else { 0.0 };
            slip += if state == 2 { a } else { 0.0 };
        }
    }
    let part = |a: f64| if contact > 0.0 { a / contact } else { 0.0 };
    PatchAreas {
        contact,
        stick_fraction: part(stick),
        slip_fraction: part(slip),
        peak_pressure: peak,
    }
}

/// Gaussian elimination with row pivoting; `None` for a singular matrix.
fn solve<const N: usize>(
    mut m: SMatrix<f64, N, N>,
    mut right: SVector<f64, N>,
) -> Option<SVector<f64, N>> {
    for k in 0..N {
        let pivot = (k..N).max_by(|&i, &j| m[(i, k)].abs().total_cmp(&m[(j, k)].abs()))?;
        m.swap_rows(k, pivot);
        right.swap_rows(k, pivot);
        if m[(k, k)].abs() < 1e-10 * m[(0, 0)].abs() {
            return None;
        }
        for i in k + 1..N {
            let factor = m[(i, k)] / m[(k, k)];
            for j in k..N {
                m[(i, j)] -= factor * m[(k, j)];
            }
            right[i] -= factor * right[k];
        }
    }
    let mut x = SVector::zeros();
    for k in (0..N).rev() {
        let known: f64 = (k + 1..N).map(|j| m[(k, j)] * x[j]).sum();
        x[k] = (right[k] - known) / m[(k, k)];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn hertz(h: f64) -> (Vec<Vector3<f64>>, Vec<f64>) {
        let (a, b, p0, xc, yc) = (7.162e-3, 5.387e-3, 1.2376e9, 1.3e-3, -0.4e-3);
        let mut points = Vec::new();
        let mut pressure = Vec::new();
        for i in -12..=12 {
            for j in -12..=12 {
                let (x, y) = (f64::from(i) * h, f64::from(j) * h);
                let q = 1.0 - ((x - xc) / a).powi(2) - ((y - yc) / b).powi(2);
                points.push(Vector3::new(x, y, 0.3));
                pressure.push(p0 * q.max(0.0).sqrt());
            }
        }
        (points, pressure)
    }

    #[test]
    fn fit_recovers_a_hertz_ellipse_exactly() {
        let (points, pressure) = hertz(1e-3);
        let found = fit(PatchShape::Ellipse, &points, &pressure).unwrap();
        assert!((found.a / 7.162e-3 - 1.0).abs() < 1e-11, "{found:?}");
        assert!((found.b / 5.387e-3 - 1.0).abs() < 1e-11);
        assert!((found.p0 / 1.2376e9 - 1.0).abs() < 1e-11);
        assert!((found.xc - 1.3e-3).abs() < 1e-13);
        assert!((found.yc + 0.4e-3).abs() < 1e-13);
        assert!((found.area / (PI * 7.162e-3 * 5.387e-3) - 1.0).abs() < 1e-11);
    }

    #[test]
    fn the_area_of_the_fit_is_the_ellipse_s_where_that_of_the_nodes_is_larger() {
        let (points, pressure) = hertz(1e-3);
        let area = vec![1e-6; points.len()];
        let ellipse = PI * 7.162e-3 * 5.387e-3;
        // faces hand a sixth of a node's force on to each neighbour, along and across
        let weight = |d: f64| match d.abs() {
            d if d < 0.5e-3 => 2.0 / 3.0,
            d if d < 1.5e-3 => 1.0 / 6.0,
            _ => 0.0,
        };
        let spread = |x: &Vector3<f64>| {
            let from =
                |(y, p): (&Vector3<f64>, &f64)| p * weight(x[0] - y[0]) * weight(x[1] - y[1]);
            points.iter().zip(&pressure).map(from).sum::<f64>()
        };
        let spread: Vec<f64> = points.iter().map(spread).collect();
        let nodes = areas(&spread, &area, &vec![1; points.len()]).contact;
        let found = fit(PatchShape::Ellipse, &points, &spread).unwrap();
        assert!(nodes > 1.2 * ellipse, "{nodes} {ellipse}");
        assert!((found.area / ellipse - 1.0).abs() < 0.05, "{found:?}");
    }

    #[test]
    fn a_slice_of_a_line_contact_gets_half_length_and_peak_of_hertz_exactly() {
        let (a, p0, xc) = (7.125e-3, 0.8936e9, 0.3e-3);
        let mut points = Vec::new();
        let mut pressure = Vec::new();
        for i in -10..=10 {
            for y in [-0.25e-3, 0.25e-3] {
                let x = f64::from(i) * 1e-3;
                points.push(Vector3::new(x, y, 0.0));
                pressure.push(p0 * (1.0 - ((x - xc) / a).powi(2)).max(0.0).sqrt());
            }
        }
        for lost in [0, 1, 3] {
            // two rows, of which one may have lost nodes
            let (mut points, mut pressure) = (points.clone(), pressure.clone());
            for at in 10..10 + lost {
                points.remove(at);
                pressure.remove(at);
            }
            let found = fit(PatchShape::Ellipse, &points, &pressure).unwrap();
            assert!((found.a / a - 1.0).abs() < 1e-11, "{found:?}");
            assert!((found.p0 / p0 - 1.0).abs() < 1e-11);
            assert!((found.xc - xc).abs() < 1e-13);
            assert!((found.b - 0.25e-3).abs() < 1e-16 && found.yc.abs() < 1e-16, "{found:?}");
            assert!((found.area / (2.0 * a * 0.5e-3) - 1.0).abs() < 1e-11, "{found:?}");
        }
    }

    #[test]
    fn a_line_contact_gets_its_width_and_the_semi_ellipse_along_it_whatever_happens_at_its_edges() {
        let (a, half_width, xc) = (7.125e-3, 20.8e-3, -0.2e-3);
        let mut points = Vec::new();
        let mut pressure = Vec::new();
        for i in -10..=10 {
            for j in -30_i32..=30 {
                let (x, y) = (f64::from(i) * 1e-3, f64::from(j) * 1.04e-3);
                points.push(Vector3::new(x, y, 0.0));
                // where the narrower body ends its edge presses half as much again
                let edge = if j.abs() == 20 { 1.5 } else { 1.0 };
                let inside = if j.abs() <= 20 { edge * 350e6 } else { 0.0 };
                pressure.push(inside * (1.0 - ((x - xc) / a).powi(2)).max(0.0).sqrt());
            }
        }
        let found = fit(PatchShape::Rectangle, &points, &pressure).unwrap();
        assert!((found.a / a - 1.0).abs() < 5e-3, "{found:?}");
        assert!((found.b - half_width).abs() < 1e-15 && found.yc.abs() < 1e-15, "{found:?}");
        assert!(found.p0 > 350e6 && found.p0 < 375e6, "{found:?}");
        assert!((found.xc - xc).abs() < 2e-5);
        // an ellipse is what it is not
        let ellipse = fit(PatchShape::Ellipse, &points, &pressure);
        assert!(ellipse.is_none_or(|e| (e.b / half_width - 1.0).abs() > 0.1), "{ellipse:?}");
    }

    #[test]
    fn fit_refuses_what_is_no_ellipse() {
        assert_eq!(fit(PatchShape::Ellipse, &[], &[]), None);
        let row: Vec<Vector3<f64>> = (0..9).map(|i| f64::from(i) * Vector3::x()).collect();
        assert_eq!(fit(PatchShape::Ellipse, &row, &[1.0; 9]), None);
        let (points, _) = hertz(1e-3);
        let bowl: Vec<f64> = points.iter().map(|x| 1.0 + x[0] * x[0] + x[1] * x[1]).collect();
        assert_eq!(fit(PatchShape::Ellipse, &points, &bowl), None);
        for shape in [PatchShape::Ellipse, PatchShape::Rectangle] {
            assert_eq!(fit(shape, &points, &vec![f64::NAN; points.len()]), None);
            assert_eq!(fit(shape, &points, &bowl), None);
        }
    }

    #[test]
    fn areas_weigh_nodes_by_their_area() {
        let found =
            areas(&[0.0, 2.0, 5.0, 1.0, 0.09], &[9.0, 1.0, 2.0, 1.0, 4.0], &[0, 1, 2, 1, 2]);
        assert_eq!(found.contact, 4.0);
        assert_eq!(found.stick_fraction, 0.5);
        assert_eq!(found.slip_fraction, 0.5);
        assert_eq!(found.peak_pressure, 5.0);
        assert_eq!(areas(&[], &[], &[]), PatchAreas::default());
    }
}
