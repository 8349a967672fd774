//! Plane geometry of mortar segments: the part that a slave face and a master face have in common in
//! the plane of the slave (Puso and Laursen 2004), and a rule of integration on it.

use crate::face::{shape, shape_gradients};
use mesh::geometry::adjugate;
use nalgebra::{Matrix2, Vector2};

/// Corners that a clipped quadrilateral can have: each of four cuts adds one at most.
const CORNERS: usize = 8;
/// Newton's rounds of [`coordinates`]; one is enough on a parallelogram.
const ROUNDS: usize = 8;
/// Corrections below this end them.
const CONVERGED: f64 = 1e-14;

/// The symmetric rule of six points for polynomials of degree four (Dunavant 1985): the products of the
/// bilinear functions of two parallelograms are such. One coordinate of each orbit, and its weight.
const ORBITS: [[f64; 2]; 2] = [
    [0.445_948_490_915_964_9, 0.223_381_589_678_011_47],
    [0.091_576_213_509_770_74, 0.109_951_743_655_321_87],
];

/// A convex polygon in the plane of a face (m).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polygon {
    corners: [Vector2<f64>; CORNERS],
    len: usize,
}

impl Polygon {
    /// The corners counter-clockwise.
    pub fn quad(corners: [Vector2<f64>; 4]) -> Self {
        let mut polygon = Self { corners: [Vector2::zeros(); CORNERS], len: 4 };
        polygon.corners[..4].copy_from_slice(&corners);
        polygon
    }

    /// What lies inside the quadrilateral `by`, counter-clockwise too (Sutherland and Hodgman 1974).
    pub fn clipped(mut self, by: &[Vector2<f64>; 4]) -> Self {
        for edge in 0..4 {
            let (from, to) = (by[edge], by[(edge + 1) % 4]);
            let inside = |p: Vector2<f64>| (to - from).perp(&(p - from));
            let mut cut = Self { corners: [Vector2::zeros(); CORNERS], len: 0 };
            for i in 0..self.len {
                let (p, q) = (self.corners[i], self.corners[(i + 1) % self.len]);
                let (at_p, at_q) = (inside(p), inside(q));
                if at_p >= 0.0 {
                    cut.push(p);
                }
                if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
                    let s = at_p / (at_p - at_q);
                    cut.push(p + s * (q - p));
                }
            }
            self = cut;
        }
        self
    }

    /// Of faces that are not convex, more corners than this are lost.
    fn push(&mut self, p: Vector2<f64>) {
        if self.len < CORNERS {
            self.corners[self.len] = p;
            self.len += 1;
        }
    }

    pub fn area(&self) -> f64 {
        (2..self.len).map(|i| self.triangle(i)).sum()
    }

    /// Area of the triangle of the first corner, `i - 1` and `i`.
    fn triangle(&self, i: usize) -> f64 {
        let [o, p, q] = [0, i - 1, i].map(|c| self.corners[c]);
        0.5 * (p - o).perp(&(q - o))
    }

    /// Visits the points of integration with their weights (m^2).
    pub fn integrate(&self, mut visit: impl FnMut(Vector2<f64>, f64)) {
        for i in 2..self.len {
            let area = self.triangle(i);
            let corners = [0, i - 1, i].map(|c| self.corners[c]);
            for [a, weight] in ORBITS {
                for odd in 0..3 {
                    let mut p = Vector2::zeros();
                    for (c, corner) in corners.iter().enumerate() {
                        p += if c == odd { 1.0 - 2.0 * a } else { a } * *corner;
                    }
                    visit(p, weight * area);
                }
            }
        }
    }
}

/// Coordinates `xi` of a point `p = sum N_c(xi) x_c` in the bilinear quadrilateral, by Newton's method.
pub(crate) fn coordinates(quad: &[Vector2<f64>; 4], p: Vector2<f64>) -> Vector2<f64> {
    let mut xi = Vector2::zeros();
    for _ in 0..ROUNDS {
        let (mut residual, mut jacobian) = (p, Matrix2::zeros());
        let weights = shape(xi.x, xi.y).into_iter().zip(shape_gradients(xi.x, xi.y));
        for ((weight, gradient), x) in weights.zip(quad) {
            residual -= weight * x;
            jacobian += x * Vector2::from(gradient).transpose();
        }
        let step = adjugate(&jacobian) * residual * (1.0 / jacobian.determinant());
        xi += step;
        if step.iter().all(|s| s.abs() < CONVERGED) {
            break;
        }
    }
    xi
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: [Vector2<f64>; 4] = [
        Vector2::new(0.0, 0.0),
        Vector2::new(1.0, 0.0),
        Vector2::new(1.0, 1.0),
        Vector2::new(0.0, 1.0),
    ];

    #[test]
    fn the_common_part_of_a_square_and_a_diamond_is_an_octagon() {
        let r = 0.6;
        let diamond =
            [[r, 0.0], [0.0, r], [-r, 0.0], [0.0, -r]].map(|[x, y]| Vector2::new(0.5 + x, 0.5 + y));
        let common = Polygon::quad(diamond).clipped(&UNIT);
        assert_eq!(common.len, 8);
        // the diamond less four corners of height 0.1
        assert!((common.area() - (2.0 * r * r - 4.0 * 0.01)).abs() < 1e-15);
    }

    #[test]
    fn corners_on_the_edges_of_the_other_face_stay_each_once() {
        // no triangle without area is integrated where faces share a corner or an edge
        assert_eq!(Polygon::quad(UNIT).clipped(&UNIT).len, 4);
        let half = UNIT.map(|p| Vector2::new(0.5 * p.x, p.y));
        for common in [Polygon::quad(UNIT).clipped(&half), Polygon::quad(half).clipped(&UNIT)] {
            assert_eq!((common.len, common.area()), (4, 0.5));
        }
    }

    #[test]
    fn what_lies_apart_has_nothing_in_common() {
        let far = UNIT.map(|p| p + 1.5 * Vector2::x());
        assert_eq!(Polygon::quad(far).clipped(&UNIT).area(), 0.0);
    }

    #[test]
    fn the_rule_integrates_products_of_bilinear_functions() {
        let (mut sum, mut area) = (0.0, 0.0);
        Polygon::quad(UNIT).integrate(|p, w| {
            sum += w * p.x * p.x * p.y * p.y;
            area += w;
        });
        assert!((area - 1.0).abs() < 1e-15 && (sum - 1.0 / 9.0).abs() < 1e-15, "{area} {sum}");
    }

    #[test]
    fn coordinates_find_the_point_of_a_skew_quadrilateral() {
        let quad = [[0.0, 0.0], [2.0, 0.1], [2.5, 1.4], [-0.2, 1.0]].map(Vector2::from);
        let p = shape(0.3, -0.7).into_iter().zip(quad).map(|(n, x)| n * x).sum();
        let xi = coordinates(&quad, p);
        assert!((xi - Vector2::new(0.3, -0.7)).amax() < 1e-14, "{xi}");
    }
}
