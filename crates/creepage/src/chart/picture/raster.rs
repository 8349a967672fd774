//! Quads as pixels: nearer ones hide farther ones by a z-buffer.

use super::{Pane, Surface};
use crate::chart::Key;

/// Pixels are drawn finer by this factor along each side and then averaged, so that edges are smooth.
const FINER: usize = 2;
/// Where the light comes from: right, up, away from the viewer; of length 1. It comes from beside the viewer, so
/// that faces that are seen well have the colours of the colour bar.
const LIGHT: [f64; 3] = [-0.25, 0.3, -0.92];
/// Brightness of a face turned away from the light, and how much faster than the cosine it rises to 1.
const SHADE: f64 = 0.62;
const RISE: f64 = 1.35;
/// How much of a mesh line's grey covers the colour of the face.
const LINE: f64 = 0.5;
const LINE_COLOUR: f64 = 150.0;

/// A corner of a quad on the canvas: right, down (fine pixels), away (m); its value.
#[derive(Clone, Copy, Debug, Default)]
struct Corner {
    x: f64,
    y: f64,
    depth: f64,
    value: f64,
}

/// A triangle of a quad, and which of its sides (from corner i to the next) are sides of the quad.
struct Triangle {
    corners: [Corner; 3],
    sides: [bool; 3],
    light: f64,
    line: f64,
}

struct Canvas<'a> {
    size: [usize; 2],
    colours: Vec<[u8; 3]>,
    depths: Vec<f64>,
    key: &'a Key,
    lit: bool,
    /// Half the width of a mesh line (fine pixels).
    half_line: f64,
}

/// The red, green and blue bytes of a pane of `size` pixels, `unit` of which are a point of 1/96 inch.
pub(super) fn draw(pane: &Pane, key: &Key, size: [u32; 2], unit: f64) -> Vec<u8> {
    let fine = size.map(|n| n as usize * FINER);
    let count = fine[0] * fine[1];
    let mut canvas = Canvas {
        size: fine,
        colours: vec![[255; 3]; count],
        depths: vec![f64::INFINITY; count],
        key,
        lit: pane.lit,
        half_line: 0.3 * unit * FINER as f64,
    };
    let scale = fine[0].min(fine[1]) as f64 / pane.camera.span();
    let middle = fine.map(|n| 0.5 * n as f64);
    let Surface { points, quads, values } = &pane.surface;
    for quad in quads {
        let corner = |node: u32| {
            let [x, y, depth] = pane.camera.project(*points.get(node as usize)?);
            let value = *values.get(node as usize)?;
            let [x, y] = [middle[0] + scale * x, middle[1] - scale * y];
            let finite = x.is_finite() && y.is_finite() && depth.is_finite();
            finite.then_some(Corner { x, y, depth, value })
        };
        if let [Some(a), Some(b), Some(c), Some(d)] = quad.map(corner) {
            canvas.quad([a, b, c, d], scale, unit);
        }
    }
    canvas.averaged()
}

impl Canvas<'_> {
    fn quad(&mut self, [a, b, c, d]: [Corner; 4], scale: f64, unit: f64) {
        let [p, q] = [[a, c], [b, d]].map(|[from, to]| {
            [(to.x - from.x) / scale, (from.y - to.y) / scale, to.depth - from.depth]
        });
        let normal =
            [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        // the side that is seen faces the viewer
        let facing = if normal[2] > 0.0 { -1.0 } else { 1.0 };
        let cosine: f64 = normal.iter().zip(LIGHT).map(|(n, l)| facing * n * l).sum();
        let light = if !self.lit {
            1.0
        } else if length > 0.0 {
            SHADE + (1.0 - SHADE) * (RISE * cosine / length).clamp(0.0, 1.0)
        } else {
            SHADE
        };
        // lines fade where they would lie so close that they hid the faces
        let twice = ((c.x - a.x) * (d.y - b.y) - (c.y - a.y) * (d.x - b.x)).abs();
        let longest = [[a, b], [b, c], [c, d], [d, a]]
            .map(|[p, q]| libm::hypot(q.x - p.x, q.y - p.y))
            .into_iter()
            .fold(1e-9, f64::max);
        let height = 0.5 * twice / longest / (unit * FINER as f64);
        let line = LINE * ((height - 1.5) / 6.0).clamp(0.0, 1.0);
        self.triangle(&Triangle { corners: [a, b, c], sides: [true, true, false], light, line });
        self.triangle(&Triangle { corners: [c, d, a], sides: [true, true, false], light, line });
    }

    fn triangle(&mut self, triangle: &Triangle) {
        let [a, b, c] = triangle.corners;
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area.abs() < 1e-12 {
            return;
        }
        let clipped = |low: f64, high: f64, size: usize| {
            let low = low.floor().max(0.0) as usize;
            low..(high.ceil().max(0.0) as usize).min(size)
        };
        let ends = |of: fn(&Corner) -> f64| {
            let at = triangle.corners.map(|corner| of(&corner));
            at.into_iter().fold([f64::MAX, f64::MIN], |[l, h], x| [l.min(x), h.max(x)])
        };
        let [top, bottom] = ends(|corner| corner.y);
        for row in clipped(top, bottom, self.size[1]) {
            // the share of each corner, that of the triangle opposite to it, rises evenly along the row
            let along = [(b, c), (c, a), (a, b)].map(|(p, q)| {
                let y = row as f64 + 0.5;
                let start = (p.x * (q.y - y) - (p.y - y) * q.x) / area;
                (start, (p.y - q.y) / area)
            });
            let mut inside = [0.0, self.size[0] as f64];
            for (start, rise) in along {
                let zero = -start / rise;
                if rise > 0.0 {
                    inside[0] = zero.max(inside[0]);
                } else if rise < 0.0 {
                    inside[1] = zero.min(inside[1]);
                } else if start < 0.0 {
                    inside[1] = 0.0;
                }
            }
            // one more at each end, since the ends are rounded; the shares decide
            for column in clipped(inside[0] - 1.0, inside[1] + 1.0, self.size[0]) {
                let x = column as f64 + 0.5;
                let shares = along.map(|(start, rise)| start + rise * x);
                if shares.iter().all(|share| *share >= 0.0) {
                    self.pixel(row * self.size[0] + column, triangle, shares, area);
                }
            }
        }
    }

    /// Colours a pixel inside a triangle, unless something nearer is there.
    fn pixel(&mut self, at: usize, triangle: &Triangle, shares: [f64; 3], area: f64) {
        let of = |number: fn(&Corner) -> f64| -> f64 {
            triangle.corners.iter().zip(shares).map(|(corner, share)| share * number(corner)).sum()
        };
        let depth = of(|corner| corner.depth);
        if depth >= self.depths[at] {
            return;
        }
        self.depths[at] = depth;
        let mut on_line = false;
        if triangle.line > 0.0 {
            for i in (0..3).filter(|i| triangle.sides[*i]) {
                let [p, q] = [triangle.corners[i], triangle.corners[(i + 1) % 3]];
                let distance =
                    (shares[(i + 2) % 3] * area).abs() / libm::hypot(q.x - p.x, q.y - p.y);
                on_line |= distance < self.half_line;
            }
        }
        let line = if on_line { triangle.line } else { 0.0 };
        let face = self.key.colour(of(|corner| corner.value));
        self.colours[at] = face.map(|c| {
            let lit = f64::from(c) * triangle.light;
            (lit + line * (LINE_COLOUR - lit)).round() as u8
        });
    }

    /// The bytes of the pixels, each the mean of its fine ones.
    fn averaged(&self) -> Vec<u8> {
        let [width, height] = self.size.map(|n| n / FINER);
        let mut bytes = Vec::with_capacity(3 * width * height);
        for row in 0..height {
            for column in 0..width {
                let fine = (0..FINER * FINER).map(|k| {
                    let [i, j] = [FINER * row + k / FINER, FINER * column + k % FINER];
                    self.colours[i * self.size[0] + j]
                });
                let sum =
                    fine.fold([0u32; 3], |sum, c| [0, 1, 2].map(|i| sum[i] + u32::from(c[i])));
                bytes.extend(sum.map(|s| (s / (FINER * FINER) as u32) as u8));
            }
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::{Scale, picture::Camera};

    fn key() -> Key {
        Key::Values { label: String::new(), range: [0.0, 1.0], scale: Scale::Linear }
    }

    /// Two squares of different size, one behind the other, seen along +y.
    fn two(near_first: bool) -> Vec<u8> {
        let square = |half: f64, y: f64| {
            [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[x, z]| [x, y, z])
        };
        let (near, far) = (square(0.2, -1.0), square(0.4, 1.0));
        let points = [near, far].concat();
        let mut quads = vec![[0, 1, 2, 3], [4, 5, 6, 7]];
        if !near_first {
            quads.reverse();
        }
        let values = [[1.0; 4], [0.0; 4]].concat();
        let camera = Camera::new([0.0; 3], [0.0, 1.0, 0.0], 1.0);
        let pane = Pane {
            title: String::new(),
            camera,
            surface: Surface { points, quads, values },
            lit: true,
        };
        draw(&pane, &key(), [100, 100], 1.0)
    }

    #[test]
    fn the_nearer_face_hides_the_farther_in_whichever_order_they_come() {
        let bytes = two(true);
        assert_eq!(bytes, two(false));
        let pixel = |x: usize, y: usize| &bytes[3 * (100 * y + x)..][..3];
        // yellow in the middle, violet around it, white outside
        assert!(pixel(50, 50)[1] > 150 && pixel(50, 50)[2] < 60, "{:?}", pixel(50, 50));
        assert!(pixel(85, 50)[1] < 40, "{:?}", pixel(85, 50));
        assert_eq!(pixel(95, 50), [255; 3]);
    }

    #[test]
    fn without_light_a_face_has_the_colour_of_its_value_however_it_is_turned() {
        let camera = Camera::new([0.0; 3], [0.0, 1.0, 0.0], 1.0);
        let middle = |slope: f64, lit: bool| {
            let points = [[-0.4, -0.4], [0.4, -0.4], [0.4, 0.4], [-0.4, 0.4]];
            let points = points.map(|[x, z]| [x, slope * x, z]).to_vec();
            let surface = Surface { points, quads: vec![[0, 1, 2, 3]], values: vec![0.5; 4] };
            let pane = Pane { title: String::new(), camera, surface, lit };
            let bytes = draw(&pane, &key(), [100, 100], 1.0);
            let start = 3 * (100 * 50 + 55);
            [bytes[start], bytes[start + 1], bytes[start + 2]]
        };
        let of_value = key().colour(0.5);
        assert_eq!([-2.0, 2.0].map(|slope| middle(slope, false)), [of_value; 2]);
        assert_ne!(middle(-2.0, true), middle(2.0, true));
    }

    #[test]
    fn what_is_not_a_number_or_lies_outside_leaves_the_canvas_white() {
        let points = vec![[f64::NAN; 3], [9.0; 3], [8.0, 9.0, 1.0], [1e300, 0.0, 1e300]];
        let surface = Surface {
            points,
            quads: vec![[0, 1, 2, 3], [1, 2, 3, 3], [1, 2, 2, 1], [1, 2, 3, 9]],
            values: vec![f64::NAN; 4],
        };
        let camera = Camera::new([0.0; 3], [0.0, 1.0, 0.0], 1e-3);
        let pane = Pane { title: String::new(), camera, surface, lit: true };
        assert!(draw(&pane, &key(), [40, 30], 1.0).iter().all(|byte| *byte == 255));
    }
}
