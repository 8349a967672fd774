//! A wheel on a rail: how its profiles press two half-spaces, and what its motion makes them slip.
//!
//! The half-spaces lie along the plane of contact: at the point of the rail in the middle of the overlap of the undeformed
//! bodies, with the slope that the rail has there ([`WheelOnRail::centre_of_overlap`]). The gap is that of the exact surfaces
//! along the normal of this plane.

use halfspace::{Gap, HalfSpaces, Patch, PressError, Pressed, press};
use mesh::profile::{ContactPoint, Overlap, ProfileError, RigidSlip, WheelOnRail};
use output::summary::Position;
use serde::Serialize;
use thiserror::Error;

/// Rounds in which the middle of the overlap and the approach settle.
const ROUNDS: usize = 3;
/// The grid reaches as far as the undeformed bodies overlap at so many approaches.
const REACH: f64 = 1.3;
/// Times that a grid that is too small grows, and by what.
const LARGER: usize = 8;
const GROWTH: f64 = 1.5;
/// Places whose slopes differ by less than this (rad) lie in one plane of contact.
const ONE_PLANE: f64 = 0.35;
/// More points than this in a grid are taken for a typing mistake.
const MOST_POINTS: f64 = 1e7;

/// A wheel on a rail as a case places it: where they touch, how they press, and what they slip by it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PositionReport {
    /// y of the first point of contact on the profile of the wheel, and on that of the rail (m).
    pub first_y: [f64; 2],
    /// Slope of the rail there, positive where it rises away from the middle of the track (rad).
    pub first_angle: f64,
    /// Distance of that point from the axle (m).
    pub rolling_radius: f64,
    /// Radii of the gap there, along x and across (m).
    pub radii: [f64; 2],
    /// Slope of the plane of contact (rad), which lies in the middle of the overlap of the undeformed bodies, and y there on both
    /// profiles (m).
    pub plane_angle: f64,
    /// See `plane_angle`.
    pub plane_y: [f64; 2],
    /// Approach along the normal of this plane (m), largest pressure (Pa), and area (m^2).
    pub approach: f64,
    /// See `approach`.
    pub peak_pressure: f64,
    /// See `approach`.
    pub area: f64,
    /// What the wheel slips, where it turns by the angle of `disk.radius`: longitudinal creepage.
    pub longitudinal: f64,
    /// Lateral creepage.
    pub lateral: f64,
    /// Spin (rad/m).
    pub spin: f64,
}

impl PositionReport {
    pub(crate) fn new(wheel: &PressedWheel, motion: &RigidSlip) -> Self {
        let PressedWheel { first, middle, pressed } = wheel;
        let bearing = pressed.field.pressure.iter().filter(|p| **p > 0.0).count();
        Self {
            first_y: first.profile_y,
            first_angle: first.angle,
            rolling_radius: first.rolling_radius,
            radii: first.curvature.map(|curvature| 1.0 / curvature),
            plane_angle: middle.angle,
            plane_y: middle.profile_y,
            approach: pressed.approach,
            peak_pressure: Patch::Field(pressed.field.clone()).peak_pressure(),
            area: bearing as f64 * pressed.field.spacing.powi(2),
            longitudinal: motion.longitudinal,
            lateral: motion.lateral,
            spin: motion.spin,
        }
    }

    /// What a summary keeps of it.
    pub(crate) fn result(&self) -> Position {
        let [wheel_y, rail_y] = self.first_y;
        Position {
            wheel_y,
            rail_y,
            rolling_radius: self.rolling_radius,
            plane_angle: self.plane_angle,
            longitudinal: self.longitudinal,
            lateral: self.lateral,
            spin: self.spin,
        }
    }

    /// The lines of a log or a page.
    pub fn lines(&self) -> [String; 3] {
        let mm = |x: f64| 1e3 * x;
        let [wheel, rail] = self.first_y.map(mm);
        let [along, across] = self.radii.map(mm);
        let [plane_wheel, plane_rail] = self.plane_y.map(mm);
        [
            format!(
                "first contact: y = {wheel:.3} mm of the wheel, {rail:.3} mm of the rail; angle {:.2} mrad; rolling radius \
                 {:.3} mm; radii of the gap {along:.1} mm along, {across:.1} mm across",
                mm(self.first_angle),
                mm(self.rolling_radius)
            ),
            format!(
                "plane of contact: y = {plane_wheel:.3} mm of the wheel, {plane_rail:.3} mm of the rail; angle {:.2} mrad; approach \
                 {:.2} um; largest pressure {:.1} MPa on {:.1} mm^2",
                mm(self.plane_angle),
                1e6 * self.approach,
                1e-6 * self.peak_pressure,
                1e6 * self.area
            ),
            format!(
                "slip by its position: creepage {:.4e}, lateral {:.4e}, spin {:.4e} rad/m",
                self.longitudinal, self.lateral, self.spin
            ),
        ]
    }
}

/// Why a wheel cannot be pressed on a rail.
#[derive(Debug, Error, PartialEq)]
pub enum WheelOnRailError {
    /// Profiles or position.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The pressure is not found.
    #[error(transparent)]
    Press(#[from] PressError),
    /// The patch reaches the end of a profile.
    #[error(
        "the patch reaches an end of a profile: at y = {wheel_mm:.2} mm of the wheel, {rail_mm:.2} mm of the rail"
    )]
    Beyond {
        /// y of the middle of the patch on the wheel (mm).
        wheel_mm: f64,
        /// y of it on the rail (mm).
        rail_mm: f64,
    },
    /// Contact at two places of different slope, such as tread and flange.
    #[error(
        "wheel and rail touch at two places of different slope, on the wheel about y = {first_mm:.2} and {second_mm:.2} mm: \
         half-spaces need one plane of contact"
    )]
    TwoPlaces {
        /// y of the first place (mm).
        first_mm: f64,
        /// y of the other one (mm).
        second_mm: f64,
    },
    /// A grid without end.
    #[error("the patch needs {points:.1e} points")]
    Points {
        /// Their number.
        points: f64,
    },
}

/// A wheel pressed on a rail.
#[derive(Clone, Debug, PartialEq)]
pub struct PressedWheel {
    /// Where they first touch.
    pub first: ContactPoint,
    /// The middle of the overlap, where the half-spaces lie.
    pub middle: ContactPoint,
    /// The pressure about that point, x forward and y up the slope of the plane of contact, and the approach.
    pub pressed: Pressed,
}

/// Presses a wheel on a rail with the force `load` (N) along the normal of the plane of contact, on points of the spacing
/// `spacing` (m).
///
/// # Errors
/// A position without contact, or with two; a patch that reaches the end of a profile.
pub fn press_wheel(
    bodies: &HalfSpaces,
    pair: &WheelOnRail,
    load: f64,
    spacing: f64,
) -> Result<PressedWheel, WheelOnRailError> {
    let first = pair.first_contact()?;
    let mut approach = hertz_approach(bodies, &first, load);
    let mut found = None;
    for _ in 0..ROUNDS {
        let beyond = || {
            let [wheel_mm, rail_mm] = first.profile_y.map(|y| 1e3 * y);
            WheelOnRailError::Beyond { wheel_mm, rail_mm }
        };
        let middle = pair.centre_of_overlap(&first, approach).ok_or_else(beyond)?;
        let pressed = on_grid(bodies, pair, &first, &middle, load, [approach, spacing])?;
        approach = pressed.approach;
        found = Some(PressedWheel { first, middle, pressed });
    }
    let found = found.ok_or(PressError::Open)?;
    one_plane(pair, &found)?;
    Ok(found)
}

/// The approach (m) of a sphere of the mean curvature of the gap (Johnson 1985, Eq 4.23), from which the rounds start.
fn hertz_approach(bodies: &HalfSpaces, point: &ContactPoint, load: f64) -> f64 {
    let curvature = mean_curvature(point);
    // G/(1 - nu) = 2 G (1 - (c_s/c_p)^2) is E* of two equal bodies
    let ratio = (bodies.shear_speed / bodies.pressure_speed).powi(2);
    let modulus = 2.0 * bodies.shear_modulus * (1.0 - ratio);
    libm::cbrt(9.0 * load * load * curvature / (16.0 * modulus * modulus))
}

/// The geometric mean of the curvatures of the gap (1/m); a patch is no longer than ten times its width or so.
fn mean_curvature(point: &ContactPoint) -> f64 {
    let [along, across] = point.curvature;
    (along * across.max(0.1 * along)).sqrt()
}

/// The pressure on a grid that holds the patch: as large as the overlap at `approach` (m), and larger until the patch fits.
fn on_grid(
    bodies: &HalfSpaces,
    pair: &WheelOnRail,
    first: &ContactPoint,
    middle: &ContactPoint,
    load: f64,
    [approach, spacing]: [f64; 2],
) -> Result<Pressed, WheelOnRailError> {
    let mut depth = REACH * approach;
    for _ in 0..LARGER {
        let gap = gap(pair, first, middle, [depth, spacing])?;
        let pressed = press(bodies, &gap, load)?;
        if !pressed.cut {
            return Ok(pressed);
        }
        depth *= GROWTH;
    }
    let [wheel_mm, rail_mm] = middle.profile_y.map(|y| 1e3 * y);
    Err(WheelOnRailError::Beyond { wheel_mm, rail_mm })
}

/// The gap about the middle of the patch, where the undeformed bodies overlap at the approach `depth` (m).
fn gap(
    pair: &WheelOnRail,
    first: &ContactPoint,
    middle: &ContactPoint,
    [depth, spacing]: [f64; 2],
) -> Result<Gap, WheelOnRailError> {
    let parts = pair.overlaps(first, depth);
    let ends = parts.iter().filter(|part| in_plane(part, middle)).map(|part| part.ends);
    let y = middle.profile_y[0];
    let [low, high] = ends.fold([y; 2], |all, ends| [all[0].min(ends[0]), all[1].max(ends[1])]);
    // along the slope
    let place = |s: f64| (s - middle.profile_y[0]) / libm::cos(middle.angle) / spacing;
    let half = (2.0 * depth / middle.curvature[0]).sqrt() / spacing;
    let columns = [-half.ceil() as i64 - 1, half.ceil() as i64 + 1];
    let lines = [place(low).floor() as i64 - 1, place(high).ceil() as i64 + 1];
    let points = [columns, lines].map(|[first, last]| (last - first + 1) as f64);
    if points[0] * points[1] > MOST_POINTS {
        return Err(WheelOnRailError::Points { points: points[0] * points[1] });
    }
    let at = |i: i64, j: i64| [i, j].map(|k| k as f64 * spacing);
    let gap = (lines[0]..=lines[1])
        .flat_map(|j| (columns[0]..=columns[1]).map(move |i| at(i, j)))
        .map(|at| pair.gap(middle, at).unwrap_or(f64::INFINITY));
    Ok(Gap {
        spacing,
        first: [columns[0], lines[0]],
        points: points.map(|n| n as usize),
        gap: gap.collect(),
    })
}

/// Whether a place of overlap lies in the plane of contact, which two patches may share.
fn in_plane(part: &Overlap, middle: &ContactPoint) -> bool {
    (part.angle - middle.angle).abs() < ONE_PLANE
}

/// Whether no part of the profiles overlaps beyond the plane of contact.
fn one_plane(pair: &WheelOnRail, found: &PressedWheel) -> Result<(), WheelOnRailError> {
    let PressedWheel { first, middle, pressed } = found;
    let parts = pair.overlaps(first, pressed.approach);
    match parts.iter().find(|part| !in_plane(part, middle)) {
        None => Ok(()),
        Some(part) => Err(WheelOnRailError::TwoPlaces {
            first_mm: 1e3 * middle.profile_y[0],
            second_mm: 1e3 * 0.5 * (part.ends[0] + part.ends[1]),
        }),
    }
}
