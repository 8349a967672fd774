//! The patch over time: half axes, areas, forces, power.

use crate::check::conditions::IN_CONTACT;
use crate::check::frames::Frame;
use crate::check::surface::Surface;
use crate::check::vector::{Vec3, axpy, cross, dot, norm, sub};
use contact::patch::{self, PatchShape};

/// Measures of the patch, in the order of [`PatchRow::values`]: name, unit, meaning.
pub const PATCH_MEASURES: [(&str, &str, &str); 15] = [
    ("half_length", "m", "half axis along x of Hertz's distribution fitted to the pressure"),
    ("half_width", "m", "half axis along y of that fit, or half the width of a line contact"),
    ("centre", "m", "x of its centre"),
    ("peak_pressure", "Pa", "peak pressure of that fit"),
    ("peak_pressure_raw", "Pa", "largest nodal pressure"),
    ("peak_shear", "Pa", "largest nodal shear traction"),
    ("area", "m2", "sum of the areas of the nodes in contact"),
    ("area_fitted", "m2", "area of the fitted ellipse, or of a line contact's rectangle"),
    ("normal_force", "N", "z component of the force on the disk"),
    ("tangential_force", "N", "x component of the force on the disk"),
    ("lateral_force", "N", "y component of the force on the disk"),
    ("traction_coefficient", "1", "tangential over normal force"),
    ("stick_fraction", "1", "share of the area that the algorithm lets stick"),
    ("slip_fraction", "1", "share of the area that the algorithm lets slip"),
    ("power", "W", "work of friction per time"),
];

/// A line of a table of the patch.
#[derive(Clone, Copy, Debug)]
pub struct PatchLine {
    /// Its label.
    pub label: &'static str,
    /// Its key in `patch` of a check's document: a name of [`PATCH_MEASURES`], or `creepage`.
    pub key: &'static str,
    /// Factor from its SI unit to `unit`.
    pub factor: f64,
    /// The unit shown; empty for pure numbers.
    pub unit: &'static str,
}

const fn line(
    label: &'static str,
    key: &'static str,
    factor: f64,
    unit: &'static str,
) -> PatchLine {
    PatchLine { label, key, factor, unit }
}

/// The lines of a table of the patch, on a page or in a terminal.
pub const PATCH_TABLE: [PatchLine; 14] = [
    line("half length (fit)", "half_length", 1e3, "mm"),
    line("half width (fit)", "half_width", 1e3, "mm"),
    line("area (nodes)", "area", 1e6, "mm\u{b2}"),
    line("area (fit)", "area_fitted", 1e6, "mm\u{b2}"),
    line("peak pressure (fit)", "peak_pressure", 1e-6, "MPa"),
    line("peak pressure (nodes)", "peak_pressure_raw", 1e-6, "MPa"),
    line("peak shear", "peak_shear", 1e-6, "MPa"),
    line("normal force", "normal_force", 1e-3, "kN"),
    line("tangential force", "tangential_force", 1e-3, "kN"),
    line("traction coefficient", "traction_coefficient", 1.0, ""),
    line("creepage", "creepage", 1e3, "10\u{207b}\u{b3}"),
    line("stick fraction", "stick_fraction", 1.0, ""),
    line("slip fraction", "slip_fraction", 1.0, ""),
    line("power of friction", "power", 1e-3, "kW"),
];

/// The patch at one time: values in the order of [`PATCH_MEASURES`].
#[derive(Clone, Copy, Debug)]
pub struct PatchRow {
    /// Time (s).
    pub time: f64,
    /// The values; NaN where there is none.
    pub values: [f64; PATCH_MEASURES.len()],
}

/// Measures the patch of a record on `body`; `p0` is Hertz's peak pressure (Pa), of which contact needs a share.
///
/// The half axes come from a least-squares fit of Hertz's distribution to the pressure, which
/// resolves fractions of an element; positions are the deformed ones where the record has displacements. Forces
/// are sums of pressure along the normals of the deformed surface and of shear, over all nodes; they are those
/// on the disk, with the sign reversed where `body` is the bar.
pub(crate) fn measure(
    surface: &Surface,
    frame: &Frame,
    body: u8,
    p0: f64,
    shape: PatchShape,
) -> PatchRow {
    let of_body = |&row: &usize| surface.body[row] == body;
    let rows: Vec<usize> = (0..surface.points.len()).filter(of_body).collect();
    let position = |row: usize| match &frame.motion {
        Some([displacement, _]) => axpy(surface.points[row], 1.0, displacement[row]),
        None => surface.points[row],
    };
    let points: Vec<Vec3> = rows.iter().map(|&row| position(row)).collect();
    let pressure: Vec<f64> = rows.iter().map(|&row| frame.pressure[row]).collect();
    let fit = patch::fit(shape, &points, &pressure);
    let normals = normals(surface, frame, body, position);
    let mut force = [0.0; 3];
    let (mut area, mut stick, mut slip, mut power) = (0.0, 0.0, 0.0, 0.0);
    let (mut peak, mut peak_shear) = (0.0f64, 0.0f64);
    for &row in &rows {
        let (p, a, shear) = (frame.pressure[row], surface.area[row], frame.shear[row]);
        let n = normals[row];
        let size = norm(n);
        if size > 0.0 {
            force = axpy(force, -p * a / size, n);
        }
        force = axpy(force, a, shear);
        power -= a * dot(shear, frame.slip_velocity[row]);
        peak = peak.max(p);
        peak_shear = peak_shear.max(norm(shear));
        if p > IN_CONTACT * p0 {
            area += a;
            match frame.state.as_ref().map(|state| state[row]) {
                Some(1) => stick += a,
                Some(2) => slip += a,
                _ => {}
            }
        }
    }
    let towards_disk = if body == 0 { 1.0 } else { -1.0 };
    let [fx, fy, fz] = force.map(|f| f * towards_disk);
    let share = |part: f64| if frame.state.is_some() { part / area } else { f64::NAN };
    let [a, b, xc, top, of_fit] = fit.map_or([f64::NAN; 5], |f| [f.a, f.b, f.xc, f.p0, f.area]);
    let (stick, slip) = (share(stick), share(slip));
    let values =
        [a, b, xc, top, peak, peak_shear, area, of_fit, fz, fx, fy, fx / fz, stick, slip, power];
    PatchRow { time: frame.time, values }
}

/// For each node the sum of the area vectors of the faces around it that have pressure at a corner.
fn normals(
    surface: &Surface,
    frame: &Frame,
    body: u8,
    position: impl Fn(usize) -> Vec3,
) -> Vec<Vec3> {
    let mut normals = vec![[0.0; 3]; surface.points.len()];
    for (face, &label) in surface.faces.iter().zip(&surface.face_body) {
        let corners = face.map(|node| node as usize);
        if label != body || corners.iter().all(|&node| frame.pressure[node] == 0.0) {
            continue;
        }
        let [a, b, c, d] = corners.map(&position);
        let area = cross(sub(c, a), sub(d, b));
        corners.iter().for_each(|&node| normals[node] = axpy(normals[node], 0.5, area));
    }
    normals
}
