//! Two half-spaces in place of disk and bar: what rolls, what drives it, and the points that a run records.

use crate::case::friction_law;
use crate::case::hertz::hertz;
use crate::case::schema::{Case, Creepage, DriveMode, Material};
use crate::scenario::draw::{draw, seed};
use crate::scenario::error::ScenarioError;
use crate::scenario::numbers::{DimensionlessNumbers, three};
use crate::scenario::wheel_on_rail::{PositionReport, PressedWheel, WheelOnRailError, press_wheel};
use dynamics::{interpolated, smoothstep};
use friction::OwnLaw;
use halfspace::{
    Along, Ellipse, HalfSpaces, Inertia, Patch, PressureFactor, Rigid, Rolling, Setup,
};
use mesh::profile::RigidSlip;
use std::sync::Arc;

/// Two half-spaces at rest under the pressure of Hertz, and what a run needs of them.
pub struct HalfSpaceModel {
    /// The patch at t = 0.
    pub rolling: Rolling,
    /// Time steps to take.
    pub steps: u64,
    /// The points that a run records.
    pub points: SurfacePoints,
    /// What to expect of the friction law.
    pub numbers: DimensionlessNumbers,
    /// Width (m) that forces per width are multiplied with: one in three dimensions, where they are forces.
    pub width: f64,
    /// What the position of the wheel makes it slip, beside what is prescribed.
    pub motion: RigidSlip,
    /// The wheel with profiles, pressed on the rail.
    pub position: Option<PositionReport>,
    /// Remarks for the user, one sentence each.
    pub warnings: Vec<String>,
}

/// Points on both surfaces, on the grid of the material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurfacePoints {
    /// First column (x over the spacing) and number of columns.
    pub columns: (i64, usize),
    /// Lines on either side of y = 0; none in plane strain, which has two lines that hold the same.
    pub lines: Option<usize>,
    /// By how many columns the points move on where they follow the contact.
    pub move_on: Option<usize>,
}

/// The model of a case with half-spaces; `law` is the function of `friction.law = "python"`.
///
/// # Errors
/// A friction law that cannot be made, a grid too coarse or too large.
pub fn half_space(
    case: &Case,
    law: Option<&Arc<dyn OwnLaw>>,
) -> Result<HalfSpaceModel, ScenarioError> {
    let material = case.disk_material();
    let bodies = HalfSpaces::new(material.young, material.poisson, material.density);
    let hertz = hertz(case);
    let line = case.mesh.plane_strain;
    let steps = (case.duration() / case.step().under(case.wave_time())).ceil().max(1.0);
    let ellipse = Ellipse {
        half_length: hertz.a,
        half_width: (!line).then_some(hertz.b),
        peak_pressure: hertz.p0,
    };
    let (wheel, motion) = wheel(case, &bodies)?;
    let setup = Setup {
        bodies,
        spacing: case.mesh.zone.size,
        patch: match &wheel {
            Some(wheel) => Patch::Field(wheel.pressed.field.trimmed()),
            None => ellipse.into(),
        },
        offset: 0.0,
        speed: case.drive.speed,
        start: 0.0,
        step: case.duration() / steps,
        inertia: if case.has_inertia() { Inertia::Dynamic } else { Inertia::Static },
        law: friction_law::law(case, law)?.into(),
        pressure_factor: pressure_factor(case),
    };
    if let Along::Force(force) = drive(case, &motion, f64::INFINITY, 1.0).along {
        let bound = setup.law.mu_static() * case.load.normal;
        if force.abs() >= bound {
            return Err(ScenarioError::Torque { force: force.abs(), bound });
        }
    }
    let at = interface(&setup);
    let numbers = DimensionlessNumbers::of(case, at, setup.law.mu_static());
    let too_coarse = numbers.nucleation.and_then(|length| coarse(length, setup.spacing));
    Ok(HalfSpaceModel {
        warnings: numbers.expectation().into_iter().chain(too_coarse).collect(),
        numbers,
        rolling: Rolling::new(setup)?,
        steps: steps as u64,
        points: points(case),
        motion,
        position: wheel.map(|wheel| PositionReport::new(&wheel, &motion)),
        width: if line { case.mesh.zone.width } else { 1.0 },
    })
}

/// Where the wheel of a case touches the rail, and how it would press half-spaces; none without profiles.
///
/// # Errors
/// A position without contact, or with a contact that half-spaces cannot have: at two places of different slope, or at an end
/// of a profile; a patch beyond the fine zone.
pub fn position(case: &Case) -> Result<Option<PositionReport>, ScenarioError> {
    let (wheel, motion) = wheel(case, &as_stiff_as(case))?;
    Ok(wheel.map(|wheel| PositionReport::new(&wheel, &motion)))
}

/// Half-spaces of one material that yield to pressure as those of both bodies do (Johnson 1985, Eq 4.6).
fn as_stiff_as(case: &Case) -> HalfSpaces {
    let (disk, bar) = (case.disk_material(), case.bar_material());
    let share = |m: Material| (1.0 - m.poisson * m.poisson) / m.young;
    let young = match disk == bar {
        true => disk.young,
        false => 2.0 * (1.0 - disk.poisson * disk.poisson) / (share(disk) + share(bar)),
    };
    HalfSpaces::new(young, disk.poisson, disk.density)
}

/// The wheel of a case with profiles, pressed on the rail, and what its position makes it slip.
fn wheel(
    case: &Case,
    bodies: &HalfSpaces,
) -> Result<(Option<PressedWheel>, RigidSlip), ScenarioError> {
    let Some((pair, first)) = case.first_contact().map_err(WheelOnRailError::from)? else {
        return Ok((None, RigidSlip::default()));
    };
    let upright = if case.is_half_space() { 1.0 } else { libm::cos(first.angle) };
    let wheel = press_wheel(bodies, &pair, case.load.normal / upright, case.mesh.zone.size)?;
    let field = wheel.pressed.field.trimmed();
    let lines = [field.first[1], field.first[1] + field.points[1] as i64 - 1];
    let reach = lines.map(|line| line.unsigned_abs() as f64 * field.spacing);
    // the fine zone of elements lies about the first point of contact
    let aside = match case.is_half_space() {
        true => 0.0,
        false => (wheel.middle.profile_y[1] - wheel.first.profile_y[1]).abs(),
    };
    let (reach, width) = (reach[0].max(reach[1]) + aside, case.mesh.zone.width);
    if reach > 0.5 * width + field.spacing {
        return Err(ScenarioError::Zone { reach_mm: 1e3 * reach, width_mm: 1e3 * width });
    }
    let motion = pair.rigid_slip(&wheel.middle, 1.0 / case.disk.radius);
    Ok((Some(wheel), motion))
}

/// The factor of the pressure at a point of the material by which the members of an ensemble differ.
fn pressure_factor(case: &Case) -> Option<PressureFactor> {
    let (size, seed) = (case.preload.disturbance?, seed(case));
    let place =
        |[column, line]: [i64; 2]| (column as u64).wrapping_mul(1 << 32).wrapping_add(line as u64);
    Some(Arc::new(move |at| 1.0 + size * draw(seed, place(at))))
}

/// What drives the upper body at the time `time` (s); torque over the radius is the force of half-spaces, which have no
/// inertia as a whole. What the position of a wheel makes it slip is added to what is prescribed.
pub fn drive(case: &Case, motion: &RigidSlip, time: f64, width: f64) -> Rigid {
    let ramp = smoothstep(time, case.drive.ramp());
    let along = match case.drive.mode {
        DriveMode::Creepage => Along::Creepage(
            ramp * motion.longitudinal
                + match &case.drive.creepage {
                    Some(Creepage::Table(points)) => interpolated(points, time),
                    Some(Creepage::Number(creepage)) => ramp * creepage,
                    None => 0.0,
                },
        ),
        DriveMode::Torque => {
            let torque = case.drive.torque.unwrap_or(0.0);
            Along::Force(ramp * torque / case.disk.radius / width)
        }
    };
    Rigid {
        along,
        lateral: ramp * (case.drive.lateral_creepage + motion.lateral),
        spin: ramp * (case.drive.spin + motion.spin),
    }
}

/// The points of the fine zone.
fn points(case: &Case) -> SurfacePoints {
    let h = case.mesh.zone.size;
    let [rear, front] = case.mesh.zone_along();
    // squares that the patch touches bear pressure: points beyond the zone by less than a spacing belong to it
    let first = (rear / h + 1e-6).floor() as i64;
    let last = (front / h - 1e-6).ceil() as i64;
    let across = (0.5 * case.mesh.zone.width / h - 1e-6).ceil() as usize;
    SurfacePoints {
        columns: (first, (last - first + 1) as usize),
        lines: (!case.mesh.plane_strain).then_some(across),
        move_on: case.window_columns().map(|columns| columns as usize),
    }
}

/// The interface of the half-spaces. Without inertia they have no impedance; they have no surface layer.
fn interface(setup: &Setup) -> friction::Interface {
    let bodies = &setup.bodies;
    friction::Interface {
        pressure: setup.patch.peak_pressure(),
        impedance: match setup.inertia {
            Inertia::Dynamic => 0.5 * bodies.shear_modulus / bodies.shear_speed,
            Inertia::Static => f64::NAN,
        },
        // G/(1 - nu) = 2 G (1 - (c_s/c_p)^2)
        modulus: 2.0
            * bodies.shear_modulus
            * (1.0 - (bodies.shear_speed / bodies.pressure_speed).powi(2)),
        surface_mass: f64::NAN,
        dt: setup.step,
    }
}

/// What a spacing `h` (m) is too coarse for, beside the nucleation length (m).
fn coarse(length: f64, h: f64) -> Option<String> {
    let text = || {
        format!(
            "the friction law's nucleation length is {} mm, {} spacings: below {POINTS_PER_NUCLEATION} what slips \
             fast depends on the grid; take mesh.zone.size = {:.1e} or less, or a longer friction.memory.distance",
            three(1e3 * length),
            three(length / h),
            length / POINTS_PER_NUCLEATION
        )
    };
    (length < POINTS_PER_NUCLEATION * h).then(text)
}

/// A nucleation length should have so many spacings.
const POINTS_PER_NUCLEATION: f64 = 4.0;
