//! Stress below the surface of an elastic half-space at rest under given tractions.
//!
//! x and y lie on the surface, z points into the body. A stress has the components xx yy zz xy yz xz (Pa), tension
//! positive; a traction or force has the components x y z, those of what presses on the body having z > 0.

use crate::Ellipse;
use std::f64::consts::PI;

/// A rectangle of the surface under a uniform traction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadedCell {
    /// Its corner with the smallest x and y (m).
    pub low: [f64; 2],
    /// Its corner with the largest x and y (m).
    pub high: [f64; 2],
    /// The traction on it (Pa).
    pub traction: [f64; 3],
}

/// Parts of a cell are at most this share of their distance long, so that three Gauss points along each side sum them
/// to about 1e-4.
const PART: f64 = 0.5;
/// Most parts along a side.
const MOST_PARTS: f64 = 64.0;
/// Gauss points in a part of length one, from its middle, with their weights.
const GAUSS: [(f64, f64); 3] = [
    (-0.387_298_334_620_741_7, 5.0 / 18.0),
    (0.0, 8.0 / 18.0),
    (0.387_298_334_620_741_7, 5.0 / 18.0),
];

impl LoadedCell {
    /// How far beside the cell a place is along an axis (m).
    fn beside(&self, at: [f64; 3], axis: usize) -> f64 {
        (self.low[axis] - at[axis]).max(at[axis] - self.high[axis])
    }

    /// Offsets of a place from Gauss points along an axis, with the length of each (m); `distance` (m) is that of the
    /// place from the cell.
    fn offsets(
        &self,
        at: f64,
        axis: usize,
        distance: f64,
    ) -> impl Iterator<Item = [f64; 2]> + Clone {
        let (low, side) = (self.low[axis], self.high[axis] - self.low[axis]);
        let parts = (side / (PART * distance)).ceil().clamp(1.0, MOST_PARTS);
        let part = side / parts;
        let points = (0..parts as u32).flat_map(|k| GAUSS.map(|(off, weight)| (k, off, weight)));
        points.map(move |(k, off, weight)| {
            [at - low - (f64::from(k) + 0.5 + off) * part, weight * part]
        })
    }
}

/// Stress (Pa) at `at` (m, z > 0) below loaded cells: the sum of the point forces on parts of them.
pub fn stress_below(cells: &[LoadedCell], at: [f64; 3], poisson: f64) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for cell in cells {
        let distance = at[2].max(cell.beside(at, 0)).max(cell.beside(at, 1));
        let across = cell.offsets(at[1], 1, distance);
        for [x, length] in cell.offsets(at[0], 0, distance) {
            for [y, width] in across.clone() {
                let force = cell.traction.map(|p| p * length * width);
                let stress = point_force(force, [x, y, at[2]], poisson);
                (0..6).for_each(|c| sum[c] += stress[c]);
            }
        }
    }
    sum
}

/// The same in plane strain, where the cells go on along y for ever and have no traction along it.
pub fn plane_stress_below(cells: &[LoadedCell], at: [f64; 3], poisson: f64) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for cell in cells {
        for [x, length] in cell.offsets(at[0], 0, at[2].max(cell.beside(at, 0))) {
            let force = [0, 2].map(|i: usize| cell.traction[i] * length);
            let [xx, zz, xz] = line_force(force, [x, at[2]]);
            let stress = [xx, poisson * (xx + zz), zz, 0.0, 0.0, xz];
            (0..6).for_each(|c| sum[c] += stress[c]);
        }
    }
    sum
}

/// Stress (Pa) at the offset x, y, z (m, z > 0) from a point force (N) on the surface: Boussinesq's and Cerruti's
/// solutions (Johnson 1985, Eqs 3.19 and 3.76).
fn point_force([qx, qy, p]: [f64; 3], [x, y, z]: [f64; 3], poisson: f64) -> [f64; 6] {
    let (normal, along) = (boussinesq([x, y, z], poisson), cerruti([x, y, z], poisson));
    // a force along y is one along x with the axes exchanged
    let [yy, xx, zz, xy, xz, yz] = cerruti([y, x, z], poisson);
    let across = [xx, yy, zz, xy, yz, xz];
    std::array::from_fn(|c| p * normal[c] + qx * along[c] + qy * across[c])
}

/// Of a unit force along z. With the potential V = 1/rho of the force and chi = ln(rho + z), whose derivative by z it is:
///
/// ```text
/// 2 pi sigma_xx = 2 nu V_z - z V_xx - (1 - 2 nu) chi_xx      2 pi sigma_xy = -z V_xy - (1 - 2 nu) chi_xy
/// 2 pi sigma_zz = V_z - z V_zz                               2 pi sigma_xz = -z V_xz
/// ```
fn boussinesq([x, y, z]: [f64; 3], poisson: f64) -> [f64; 6] {
    let rho = (x * x + y * y + z * z).sqrt();
    let (cube, fifth, s) = (rho.powi(3), rho.powi(5), rho + z);
    let free = 1.0 - 2.0 * poisson;
    let bent = (rho + s) / (cube * s * s);
    let normal = |x: f64| {
        -2.0 * poisson * z / cube
            - z * (3.0 * x * x / fifth - 1.0 / cube)
            - free * (1.0 / (rho * s) - x * x * bent)
    };
    let (zz, xy) = (-3.0 * z.powi(3) / fifth, x * y * (free * bent - 3.0 * z / fifth));
    let side = -3.0 * z * z / fifth;
    [normal(x), normal(y), zz, xy, y * side, x * side].map(|sigma| sigma / (2.0 * PI))
}

/// Of a unit force along x.
fn cerruti([x, y, z]: [f64; 3], poisson: f64) -> [f64; 6] {
    let rho = (x * x + y * y + z * z).sqrt();
    let (cube, s) = (rho.powi(3), rho + z);
    let free = 1.0 - 2.0 * poisson;
    let five = -3.0 / rho.powi(5);
    let one = 1.0 / (rho * s * s);
    let bent = 1.0 / (cube * s * s) + 2.0 / (rho * rho * s.powi(3));
    [
        x * (five * x * x + free * (1.0 / cube - 3.0 * one + x * x * bent)),
        x * (five * y * y + free * (1.0 / cube - one + y * y * bent)),
        five * x * z * z,
        y * (five * x * x + free * (x * x * bent - one)),
        five * x * y * z,
        five * x * x * z,
    ]
    .map(|sigma| sigma / (2.0 * PI))
}

/// Components xx, zz and xz (Pa) at the offset x, z (m) from a force along a line on the surface (N/m), which is
/// radial: sigma_r = -2 F.r/(pi r^2) (Flamant; Johnson 1985, Eqs 2.15 and 2.22).
fn line_force([q, p]: [f64; 2], [x, z]: [f64; 2]) -> [f64; 3] {
    let square = x * x + z * z;
    let radial = -2.0 * (q * x + p * z) / (PI * square * square);
    [x * x, z * z, x * z].map(|rr| radial * rr)
}

impl Ellipse {
    /// Stress (Pa) at the depth `z` (m) below the centre, where x, y and z are the principal directions.
    ///
    /// In plane strain by McEwen (Johnson 1985, Sec. 4.2). Below an ellipse the formulas of Boussinesq with the
    /// potential of Hertz's pressure,
    /// V = (pi a b p0/2) int_{z^2}^inf (1 - x^2/(a^2 + s) - y^2/(b^2 + s) - z^2/s) ds/sqrt((a^2 + s)(b^2 + s) s)
    /// (Johnson 1985, Secs. 3.2 and 3.5; Sackfield and Hills 1983). With
    /// I_x = int_z^inf dw/((a^2 + w^2)^(3/2) (b^2 + w^2)^(1/2)) and J_x, the same with w before dw, which is
    /// 1/((a^2 + z^2)(1 + T)) for T^2 = (b^2 + z^2)/(a^2 + z^2):
    ///
    /// ```text
    /// V_xx = -2 pi a b p0 I_x      chi_xx = 2 pi a b p0 (J_x - z I_x)      V_z = -(chi_xx + chi_yy)
    /// sigma_zz = -a b p0 (J_x + J_y)
    /// ```
    pub fn stress_below_centre(&self, z: f64, poisson: f64) -> [f64; 6] {
        let (a, p0) = (self.half_length, self.peak_pressure);
        let Some(b) = self.half_width else {
            let root = (a * a + z * z).sqrt();
            let [xx, zz] =
                [(a * a + 2.0 * z * z) / root - 2.0 * z, a * a / root].map(|f| -p0 / a * f);
            return [xx, poisson * (xx + zz), zz, 0.0, 0.0, 0.0];
        };
        let (a2, b2) = (a * a + z * z, b * b + z * z);
        let t = (b2 / a2).sqrt();
        let j = [1.0 / (a2 * (1.0 + t)), t / (b2 * (1.0 + t))];
        let i = [second_kind([z * z, b2, a2]) / 3.0, second_kind([z * z, a2, b2]) / 3.0];
        let sinking = j[0] + j[1] - z * (i[0] + i[1]);
        let along = |k: usize| {
            let chi = j[k] - z * i[k];
            z * i[k] - 2.0 * poisson * sinking - (1.0 - 2.0 * poisson) * chi
        };
        [along(0), along(1), -(j[0] + j[1]), 0.0, 0.0, 0.0].map(|sigma| a * b * p0 * sigma)
    }
}

/// Carlson's elliptic integral of the second kind,
/// R_D(x, y, z) = 3/2 int_0^inf dt/((t + x)^(1/2) (t + y)^(1/2) (t + z)^(3/2)), by doubling its arguments until they are
/// alike (Carlson 1979; DLMF 19.26.20 and 19.20.18).
fn second_kind([mut x, mut y, mut z]: [f64; 3]) -> f64 {
    let (mut sum, mut share) = (0.0, 1.0);
    loop {
        let mean = (x + y + 3.0 * z) / 5.0;
        let off = [x, y, z].map(|v| (1.0 - v / mean).abs());
        // what is left out is of second order in what they differ by
        if off.iter().all(|off| *off < 1e-8) {
            return 3.0 * sum + share / (mean * mean.sqrt());
        }
        let [rx, ry, rz] = [x, y, z].map(f64::sqrt);
        let lambda = rx * ry + ry * rz + rz * rx;
        sum += share / (rz * (z + lambda));
        share /= 4.0;
        [x, y, z] = [x, y, z].map(|v| 0.25 * (v + lambda));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NU: f64 = 0.3;

    fn near(found: f64, known: f64, share: f64) {
        assert!((found - known).abs() <= share * known.abs(), "{found} {known}");
    }

    /// Depth over the half axis and largest shear over p0 below the centre.
    fn greatest_shear(pressure: Ellipse) -> [f64; 2] {
        let shear = |z: f64| {
            let [xx, yy, zz, ..] = pressure.stress_below_centre(z, NU);
            let [low, high] = [xx.min(yy).min(zz), xx.max(yy).max(zz)];
            0.5 * (high - low)
        };
        let depths = (1..3000).map(|i| 1e-3 * f64::from(i));
        depths.map(|z| [z, shear(z)]).max_by(|a, b| a[1].total_cmp(&b[1])).unwrap_or_default()
    }

    fn unit(half_width: Option<f64>) -> Ellipse {
        Ellipse { half_length: 1.0, half_width, peak_pressure: 1.0 }
    }

    #[test]
    fn the_greatest_shear_is_where_and_as_large_as_the_books_say() {
        // Johnson 1985, Secs. 3.4 and 4.2
        for (half_width, depth, shear) in [(Some(1.0), 0.48, 0.310), (None, 0.786, 0.300)] {
            let found = greatest_shear(unit(half_width));
            assert!((found[0] - depth).abs() < 0.005, "{half_width:?}: {found:?}");
            assert!((found[1] - shear).abs() < 0.0005, "{half_width:?}: {found:?}");
        }
    }

    #[test]
    fn below_a_circle_the_axis_has_the_stresses_of_the_closed_form() {
        // Johnson 1985, Eq 3.45
        for z in [0.0, 0.1, 0.48, 2.0] {
            let inside = if z > 0.0 { 1.0 - z * libm::atan(1.0 / z) } else { 1.0 };
            let radial = -(1.0 + NU) * inside + 0.5 / (1.0 + z * z);
            let [xx, yy, zz, ..] = unit(Some(1.0)).stress_below_centre(z, NU);
            for (found, known) in [(xx, radial), (yy, radial), (zz, -1.0 / (1.0 + z * z))] {
                near(found, known, 1e-12);
            }
        }
    }

    #[test]
    fn a_long_ellipse_has_the_stresses_of_a_line_contact() {
        for z in [0.1, 0.78, 2.0] {
            let long = unit(Some(1e4)).stress_below_centre(z, NU);
            let line = unit(None).stress_below_centre(z, NU);
            assert!((0..3).all(|c| (long[c] - line[c]).abs() < 1e-4), "{long:?} {line:?}");
        }
    }

    /// Cells of the side `h` under Hertz's pressure.
    fn cells(pressure: &Ellipse, h: f64) -> Vec<LoadedCell> {
        let ends = [pressure.half_length, pressure.half_width.unwrap_or(0.5 * h)];
        let [nx, ny] = ends.map(|end| (end / h).ceil() as i32);
        let rows = if pressure.half_width.is_some() { -ny..ny } else { 0..1 };
        let at = |i: i32, j: i32| [i, j].map(|k| h * f64::from(k));
        let cell = |i: i32, j: i32| {
            let (low, high) = (at(i, j), at(i + 1, j + 1));
            let middle = [0, 1].map(|k: usize| 0.5 * (low[k] + high[k]));
            LoadedCell { low, high, traction: [0.0, 0.0, pressure.mean_pressure(middle, h)] }
        };
        rows.flat_map(|j| (-nx..nx).map(move |i| (i, j))).map(|(i, j)| cell(i, j)).collect()
    }

    #[test]
    fn the_sum_over_cells_under_the_pressure_of_hertz_meets_the_closed_form() {
        let ellipse = unit(Some(0.7));
        let (many, line) = (cells(&ellipse, 0.025), cells(&unit(None), 0.025));
        for z in [0.05, 0.3, 0.5, 1.5] {
            let closed = ellipse.stress_below_centre(z, NU);
            let summed = stress_below(&many, [0.0, 0.0, z], NU);
            let plane = plane_stress_below(&line, [0.0, 0.0, z], NU);
            let closed_plane = unit(None).stress_below_centre(z, NU);
            for c in 0..6 {
                assert!((summed[c] - closed[c]).abs() < 1e-3, "{z}: {summed:?} {closed:?}");
                assert!((plane[c] - closed_plane[c]).abs() < 1e-3, "{z}: {plane:?}");
            }
        }
    }

    /// Second derivatives by differences over `h`.
    fn second(f: impl Fn([f64; 3]) -> f64, at: [f64; 3], h: f64, [i, j]: [usize; 2]) -> f64 {
        let moved = |di: f64, dj: f64| {
            let mut to = at;
            to[i] += di * h;
            to[j] += dj * h;
            f(to)
        };
        let corners = moved(1.0, 1.0) - moved(1.0, -1.0) - moved(-1.0, 1.0) + moved(-1.0, -1.0);
        corners / (4.0 * h * h)
    }

    /// Index of a component in a stress.
    const AT: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];

    #[test]
    fn a_point_force_leaves_the_surface_free_and_satisfies_equilibrium_and_compatibility() {
        let (at, h) = ([0.4, -0.3, 0.6], 1e-3);
        for force in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let stress = |at: [f64; 3]| point_force(force, at, NU);
            let free = stress([0.4, -0.3, 1e-12]);
            assert!([2, 4, 5].iter().all(|c| free[*c].abs() < 1e-9), "{free:?}");
            let slope = |c: usize, axis: usize| {
                let [mut low, mut high] = [at; 2];
                low[axis] -= h;
                high[axis] += h;
                (stress(high)[c] - stress(low)[c]) / (2.0 * h)
            };
            let trace = |at: [f64; 3]| stress(at)[..3].iter().sum::<f64>();
            for i in 0..3 {
                let divergence: f64 = (0..3).map(|j| slope(AT[i][j], j)).sum();
                assert!(divergence.abs() < 1e-4, "{force:?} {i}: {divergence}");
                for j in i..3 {
                    // Beltrami and Michell
                    let component = |at: [f64; 3]| stress(at)[AT[i][j]];
                    let laplacian: f64 = (0..3).map(|k| second(component, at, h, [k, k])).sum();
                    let rest = laplacian + second(trace, at, h, [i, j]) / (1.0 + NU);
                    assert!(rest.abs() < 1e-3, "{force:?} {i}{j}: {rest}");
                }
            }
        }
    }

    #[test]
    fn a_plane_below_a_point_force_carries_it() {
        let h = 0.05;
        let places = (-400..400).map(|i| h * (f64::from(i) + 0.5));
        let mut carried = [0.0; 3];
        for (x, y) in places.clone().flat_map(|x| places.clone().map(move |y| (x, y))) {
            let stress = point_force([0.3, -0.2, 1.0], [x, y, 0.5], NU);
            [5, 4, 2].into_iter().enumerate().for_each(|(i, c)| carried[i] -= h * h * stress[c]);
        }
        for (found, force) in carried.into_iter().zip([0.3, -0.2, 1.0]) {
            near(found, force, 0.05);
        }
    }
}
