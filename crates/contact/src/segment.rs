//! Plane geometry of mortar segments: the part that a slave face and a master face have in common in
//! the plane of the slave (Puso and Laursen 2004), and a rule of integration on it.

/// Corners that a clipped quadrilateral can have: each of four cuts adds one at most.
const CORNERS: usize = 8;
/// Newton's rounds of [`coordinates`]; one is enough on a parallelogram.
const ROUNDS: usize = 8;
/// Corrections below this end them.
const CONVERGED: f64 = 1e-14;

/// A point in the plane of a face (m).
pub(crate) type Point = [f64; 2];

/// The symmetric rule of six points for polynomials of degree four (Dunavant 1985): the products of the
/// bilinear functions of two parallelograms are such. One coordinate of each orbit, and its weight.
const ORBITS: [[f64; 2]; 2] = [
    [0.445_948_490_915_964_9, 0.223_381_589_678_011_47],
    [0.091_576_213_509_770_74, 0.109_951_743_655_321_87],
];

/// A convex polygon.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polygon {
    corners: [Point; CORNERS],
    len: usize,
}

impl Polygon {
    /// The corners counter-clockwise.
    pub fn quad(corners: [Point; 4]) -> Self {
        let mut polygon = Self { corners: [[0.0; 2]; CORNERS], len: 4 };
        polygon.corners[..4].copy_from_slice(&corners);
        polygon
    }

    /// What lies inside the quadrilateral `by`, counter-clockwise too (Sutherland and Hodgman 1974).
    pub fn clipped(mut self, by: &[Point; 4]) -> Self {
        for edge in 0..4 {
            let (from, to) = (by[edge], by[(edge + 1) % 4]);
            let inside = |p: Point| {
                (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0])
            };
            let mut cut = Self { corners: [[0.0; 2]; CORNERS], len: 0 };
            for i in 0..self.len {
                let (p, q) = (self.corners[i], self.corners[(i + 1) % self.len]);
                let (at_p, at_q) = (inside(p), inside(q));
                if at_p >= 0.0 {
                    cut.push(p);
                }
                if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
                    let s = at_p / (at_p - at_q);
                    cut.push([p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])]);
                }
            }
            self = cut;
        }
        self
    }

    /// Of faces that are not convex, more corners than this are lost.
    fn push(&mut self, p: Point) {
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
        0.5 * ((p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]))
    }

    /// Visits the points of integration with their weights (m^2).
    pub fn integrate(&self, mut visit: impl FnMut(Point, f64)) {
        for i in 2..self.len {
            let area = self.triangle(i);
            let corners = [0, i - 1, i].map(|c| self.corners[c]);
            for [a, weight] in ORBITS {
                for odd in 0..3 {
                    let mut p = [0.0; 2];
                    for (c, corner) in corners.iter().enumerate() {
                        let share = if c == odd { 1.0 - 2.0 * a } else { a };
                        p[0] += share * corner[0];
                        p[1] += share * corner[1];
                    }
                    visit(p, weight * area);
                }
            }
        }
    }
}

/// Coordinates of a point in the bilinear quadrilateral.
pub(crate) fn coordinates(quad: &[Point; 4], p: Point) -> [f64; 2] {
    let [mut xi, mut eta] = [0.0, 0.0];
    for _ in 0..ROUNDS {
        let (mut r, mut a, mut b) = (p, [0.0; 2], [0.0; 2]);
        let shape = crate::face::shape(xi, eta);
        let gradients = crate::face::shape_gradients(xi, eta);
        for c in 0..4 {
            for i in 0..2 {
                r[i] -= shape[c] * quad[c][i];
                a[i] += gradients[c][0] * quad[c][i];
                b[i] += gradients[c][1] * quad[c][i];
            }
        }
        let per_det = 1.0 / (a[0] * b[1] - a[1] * b[0]);
        let step = [(r[0] * b[1] - r[1] * b[0]) * per_det, (a[0] * r[1] - a[1] * r[0]) * per_det];
        xi += step[0];
        eta += step[1];
        if step[0].abs() < CONVERGED && step[1].abs() < CONVERGED {
            break;
        }
    }
    [xi, eta]
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: [Point; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    #[test]
    fn the_common_part_of_a_square_and_a_diamond_is_an_octagon() {
        let r = 0.6;
        let diamond = [[0.5 + r, 0.5], [0.5, 0.5 + r], [0.5 - r, 0.5], [0.5, 0.5 - r]];
        let common = Polygon::quad(diamond).clipped(&UNIT);
        assert_eq!(common.len, 8);
        // the diamond less four corners of height 0.1
        assert!((common.area() - (2.0 * r * r - 4.0 * 0.01)).abs() < 1e-15);
    }

    #[test]
    fn corners_on_the_edges_of_the_other_face_stay_each_once() {
        // no triangle without area is integrated where faces share a corner or an edge
        assert_eq!(Polygon::quad(UNIT).clipped(&UNIT).len, 4);
        let half = [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]];
        for common in [Polygon::quad(UNIT).clipped(&half), Polygon::quad(half).clipped(&UNIT)] {
            assert_eq!((common.len, common.area()), (4, 0.5));
        }
    }

    #[test]
    fn what_lies_apart_has_nothing_in_common() {
        let far = UNIT.map(|[x, y]| [x + 1.5, y]);
        assert_eq!(Polygon::quad(far).clipped(&UNIT).area(), 0.0);
    }

    #[test]
    fn the_rule_integrates_products_of_bilinear_functions() {
        let (mut sum, mut area) = (0.0, 0.0);
        Polygon::quad(UNIT).integrate(|[x, y], w| {
            sum += w * x * x * y * y;
            area += w;
        });
        assert!((area - 1.0).abs() < 1e-15 && (sum - 1.0 / 9.0).abs() < 1e-15, "{area} {sum}");
    }

    #[test]
    fn coordinates_find_the_point_of_a_skew_quadrilateral() {
        let quad = [[0.0, 0.0], [2.0, 0.1], [2.5, 1.4], [-0.2, 1.0]];
        let shape = crate::face::shape(0.3, -0.7);
        let p = [0, 1].map(|i| (0..4).map(|c| shape[c] * quad[c][i]).sum());
        let [xi, eta] = coordinates(&quad, p);
        assert!((xi - 0.3).abs() < 1e-14 && (eta + 0.7).abs() < 1e-14, "{xi} {eta}");
    }
}
