//! The patch over time: half axes, areas, forces, power.

use crate::check::conditions::IN_CONTACT;
use crate::check::frames::Frame;
use crate::check::surface::Surface;
use contact::patch::{self, PatchShape};
use mesh::geometry::vector_area;
use nalgebra::Vector3;
use output::summary::Mean;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Declares the measures of the patch: name, unit, meaning.
macro_rules! patch_measures {
    ($($Measure:ident $name:literal ($units:literal, $about:literal))*) => {
        /// A measure of the patch.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, JsonSchema, Serialize, Deserialize)]
        pub enum PatchMeasure {
            $(#[doc = concat!($about, " (", $units, ")")] #[serde(rename = $name)] $Measure,)*
        }

        impl PatchMeasure {
            /// All of them; the last is the creepage, which a run's history holds and its records of contact do not.
            pub const ALL: &[Self] = &[$(Self::$Measure),*];

            /// Its name, its unit and its meaning.
            pub const fn definition(self) -> (&'static str, &'static str, &'static str) {
                match self {
                    $(Self::$Measure => ($name, $units, $about),)*
                }
            }
        }
    };
}

patch_measures! {
    HalfLength "half_length" ("m", "half axis along x of Hertz's distribution fitted to the pressure")
    HalfWidth "half_width" ("m", "half axis along y of that fit, or half the width of a line contact")
    Centre "centre" ("m", "x of its centre")
    PeakPressure "peak_pressure" ("Pa", "peak pressure of that fit")
    PeakPressureRaw "peak_pressure_raw" ("Pa", "largest nodal pressure")
    PeakShear "peak_shear" ("Pa", "largest nodal shear traction")
    Area "area" ("m2", "sum of the areas of the nodes in contact")
    AreaFitted "area_fitted" ("m2", "area of the fitted ellipse, or of a line contact's rectangle")
    NormalForce "normal_force" ("N", "z component of the force on the disk")
    TangentialForce "tangential_force" ("N", "x component of the force on the disk")
    LateralForce "lateral_force" ("N", "y component of the force on the disk")
    TractionCoefficient "traction_coefficient" ("1", "tangential over normal force")
    StickFraction "stick_fraction" ("1", "share of the area that the algorithm lets stick")
    SlipFraction "slip_fraction" ("1", "share of the area that the algorithm lets slip")
    Power "power" ("W", "work of friction per time")
    Creepage "creepage" ("1", "longitudinal creepage")
}

impl PatchMeasure {
    /// Those that records of contact have, in the order of [`PatchRow::values`].
    pub const OF_RECORDS: &[Self] = Self::ALL.split_at(Self::ALL.len() - 1).0;

    /// Its name in documents and files.
    pub const fn name(self) -> &'static str {
        self.definition().0
    }

    /// The mean of a run's summary that is this measure.
    pub fn in_summary(self) -> Option<Mean> {
        match self {
            Self::HalfLength => Some(Mean::PatchHalfLength),
            Self::HalfWidth => Some(Mean::PatchHalfWidth),
            Self::PeakPressure => Some(Mean::PeakPressure),
            Self::PeakShear => Some(Mean::PeakShear),
            Self::Area => Some(Mean::PatchArea),
            Self::AreaFitted => Some(Mean::PatchAreaFitted),
            Self::NormalForce => Some(Mean::NormalForce),
            Self::TangentialForce => Some(Mean::TangentialForce),
            Self::LateralForce => Some(Mean::LateralForce),
            Self::TractionCoefficient => Some(Mean::TractionCoefficient),
            Self::StickFraction => Some(Mean::StickFraction),
            Self::SlipFraction => Some(Mean::SlipFraction),
            Self::Creepage => Some(Mean::Creepage),
            // the mean power of a summary is over every step, from another sum
            Self::Centre | Self::PeakPressureRaw | Self::Power => None,
        }
    }
}

/// A line of a table of the patch.
#[derive(Clone, Copy, Debug)]
pub struct PatchLine {
    /// Its label.
    pub label: &'static str,
    /// Its measure.
    pub measure: PatchMeasure,
    /// Factor from its SI unit to `unit`.
    pub factor: f64,
    /// The unit shown; empty for pure numbers.
    pub unit: &'static str,
}

const fn line(
    label: &'static str,
    measure: PatchMeasure,
    factor: f64,
    unit: &'static str,
) -> PatchLine {
    PatchLine { label, measure, factor, unit }
}

/// The lines of a table of the patch, on a page or in a terminal.
pub const PATCH_TABLE: [PatchLine; 14] = [
    line("half length (fit)", PatchMeasure::HalfLength, 1e3, "mm"),
    line("half width (fit)", PatchMeasure::HalfWidth, 1e3, "mm"),
    line("area (nodes)", PatchMeasure::Area, 1e6, "mm\u{b2}"),
    line("area (fit)", PatchMeasure::AreaFitted, 1e6, "mm\u{b2}"),
    line("peak pressure (fit)", PatchMeasure::PeakPressure, 1e-6, "MPa"),
    line("peak pressure (nodes)", PatchMeasure::PeakPressureRaw, 1e-6, "MPa"),
    line("peak shear", PatchMeasure::PeakShear, 1e-6, "MPa"),
    line("normal force", PatchMeasure::NormalForce, 1e-3, "kN"),
    line("tangential force", PatchMeasure::TangentialForce, 1e-3, "kN"),
    line("traction coefficient", PatchMeasure::TractionCoefficient, 1.0, ""),
    line("creepage", PatchMeasure::Creepage, 1e3, "10\u{207b}\u{b3}"),
    line("stick fraction", PatchMeasure::StickFraction, 1.0, ""),
    line("slip fraction", PatchMeasure::SlipFraction, 1.0, ""),
    line("power of friction", PatchMeasure::Power, 1e-3, "kW"),
];

/// The patch at one time: values in the order of [`PatchMeasure::OF_RECORDS`].
#[derive(Clone, Copy, Debug)]
pub struct PatchRow {
    /// Time (s).
    pub time: f64,
    /// The values; NaN where there is none.
    pub values: [f64; PatchMeasure::OF_RECORDS.len()],
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
    let position = |row: usize| frame.position(surface, row);
    let points: Vec<Vector3<f64>> = rows.iter().map(|&row| position(row)).collect();
    let pressure: Vec<f64> = rows.iter().map(|&row| frame.pressure[row]).collect();
    let fit = patch::fit(shape, &points, &pressure);
    let normals = normals(surface, frame, body, position);
    let mut force = Vector3::zeros();
    let (mut area, mut stick, mut slip, mut power) = (0.0, 0.0, 0.0, 0.0);
    let (mut peak, mut peak_shear) = (0.0f64, 0.0f64);
    for &row in &rows {
        let (p, a, shear) = (frame.pressure[row], surface.area[row], frame.shear[row]);
        let n = normals[row];
        let size = n.norm();
        if size > 0.0 {
            force -= p * a / size * n;
        }
        force += a * shear;
        power -= a * shear.dot(&frame.slip_velocity[row]);
        peak = peak.max(p);
        peak_shear = peak_shear.max(shear.norm());
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
    let [fx, fy, fz] = (force * towards_disk).into();
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
    position: impl Fn(usize) -> Vector3<f64>,
) -> Vec<Vector3<f64>> {
    let mut normals = vec![Vector3::zeros(); surface.points.len()];
    for (face, &label) in surface.faces.iter().zip(&surface.face_body) {
        let corners = face.map(|node| node as usize);
        if label != body || corners.iter().all(|&node| frame.pressure[node] == 0.0) {
            continue;
        }
        let area = vector_area(corners.map(&position));
        corners.iter().for_each(|&node| normals[node] += area);
    }
    normals
}
