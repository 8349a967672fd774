//! Profiles touch at their position; finite elements follow those of a wheel that stands upright.

use super::Findings;
use crate::case::schema::{Case, Symmetry};
use std::f64::consts::FRAC_PI_4;

/// Checks the position of the disk, which means something only with profiles.
pub(super) fn check(case: &Case, found: &mut Findings<'_>) {
    let (disk, bar) = (&case.disk, &case.bar);
    let placed = [disk.lateral, disk.yaw, disk.roll, bar.cant].iter().any(|x| *x != 0.0);
    found.require(
        case.has_profiles() || !placed,
        &["disk.lateral", "disk.yaw", "disk.roll", "bar.cant"],
        "disk.lateral, disk.yaw, disk.roll and bar.cant need a profile",
        "give disk.profile or bar.profile, or leave them out",
    );
    let problem = case.first_contact().err().map(|error| error.to_string());
    found.require(
        problem.is_none(),
        &["disk.lateral", "disk.profile", "bar.profile"],
        problem.unwrap_or_default(),
        "correct the profile, or disk.lateral, the place of the wheel's origin over that of the rail",
    );
    if case.has_profiles() && !case.is_half_space() {
        check_mesh(case, found);
    }
}

/// A generated mesh of whole bodies follows profiles, under a wheel that rolls straight.
fn check_mesh(case: &Case, found: &mut Findings<'_>) {
    let angle = case.first_contact().ok().flatten().map_or(0.0, |(_, point)| point.angle);
    found.require(
        angle.abs() <= FRAC_PI_4,
        &["disk.lateral", "disk.profile", "bar.profile"],
        format_args!(
            "wheel and rail touch at {:.0} degrees, on the flange: elements follow profiles up to 45 degrees",
            angle.abs().to_degrees()
        ),
        "move the wheel by disk.lateral until it touches with its tread, or set model = \"half-space\"",
    );
    let drive = &case.drive;
    for (key, given, why, remedy) in [
        (
            "mesh.symmetry",
            case.mesh.symmetry == Symmetry::Half,
            "mesh.symmetry = \"half\": y = 0 is no plane of symmetry",
            "set mesh.symmetry = \"whole\"",
        ),
        (
            "mesh.plane_strain",
            case.mesh.plane_strain,
            "mesh.plane_strain = true: a slice has no section",
            "leave mesh.plane_strain out",
        ),
        (
            "mesh.file",
            case.mesh.file.is_some(),
            "mesh.file: only a mesh that is generated follows them",
            "leave mesh.file out",
        ),
        (
            "drive.lateral_creepage",
            drive.lateral_creepage != 0.0,
            "drive.lateral_creepage in finite elements: the wheel would leave its place on the rail",
            "leave it out, or set model = \"half-space\"",
        ),
        (
            "drive.spin",
            drive.spin != 0.0,
            "drive.spin in finite elements: the wheel would leave its place on the rail",
            "leave it out, or set model = \"half-space\"",
        ),
    ] {
        found.require(
            !given,
            &[key, "disk.profile", "bar.profile"],
            format_args!("disk.profile and bar.profile do not go with {why}"),
            remedy,
        );
    }
}
