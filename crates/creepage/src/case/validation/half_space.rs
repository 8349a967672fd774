//! Two half-spaces: what drives them, and the points on their surfaces.

use super::Findings;
use crate::case::schema::Case;
use crate::case::value::number;

/// More points than this on a surface are taken for a typing mistake.
const MOST_POINTS: f64 = 1e8;

/// Checks the choices of a case with half-spaces.
pub(super) fn check(case: &Case, found: &mut Findings<'_>) {
    found.require(
        case.disk_material() == case.bar_material(),
        &[
            "disk.material.young",
            "disk.material.poisson",
            "disk.material.density",
            "bar.material.young",
            "bar.material.poisson",
            "bar.material.density",
            "model",
        ],
        "disk.material and bar.material differ: model = \"half-space\" needs one material, since else friction changes \
             the pressure",
        "give [material] alone, or set model = \"finite-elements\"",
    );
    let crowns = case.disk.crown_radius.curvature() + case.bar.crown_radius.curvature();
    let flat = crowns == 0.0 && !case.has_profiles();
    found.require(
        flat == case.mesh.plane_strain,
        &["mesh.plane_strain", "bar.crown_radius", "disk.crown_radius", "model"],
        match flat {
            true => {
                "two bodies that are flat across touch along a line, which on half-spaces needs \
                 mesh.plane_strain = true"
            }
            false => "mesh.plane_strain = true must go with crown_radius = \"flat\" of disk and bar, without profiles",
        },
        "for a line contact set mesh.plane_strain = true and both crown radii to \"flat\"; for an ellipse give a \
         crown_radius, and mesh.plane_strain = false",
    );
    found.require(
        case.drive.spin == 0.0 || !case.mesh.plane_strain,
        &["drive.spin", "mesh.plane_strain"],
        format_args!(
            "drive.spin = {} does not go with mesh.plane_strain = true: a line contact has no centre to turn about",
            number(case.drive.spin)
        ),
        "leave it out",
    );
}

/// Checks the fine zone, in which the points of half-spaces lie.
pub(super) fn check_zone(case: &Case, found: &mut Findings<'_>) {
    let zone = &case.mesh.zone;
    let (key, along) = match case.mesh.window {
        Some(window) => ("mesh.window", window),
        None => ("mesh.zone.length", zone.length),
    };
    let across = (!case.mesh.plane_strain).then_some(("mesh.zone.width", zone.width));
    for (key, value) in [(key, along)].into_iter().chain(across) {
        found.require(
            zone.size <= value,
            &["mesh.zone.size", key],
            format_args!(
                "mesh.zone.size = {} m must be at most {key} = {} m",
                number(zone.size),
                number(value)
            ),
            "the spacing of the points must not exceed the fine zone: make mesh.zone.size smaller, for example 1e-3",
        );
    }
    let rows = across.map_or(1.0, |(_, width)| width / zone.size);
    let points = along / zone.size * rows;
    found.require(
        points <= MOST_POINTS,
        &["mesh.zone.size"],
        format_args!(
            "mesh.zone.size = {} m makes about {points:.1e} points on a surface, more than {MOST_POINTS:.0e}",
            number(zone.size)
        ),
        "give the spacing in metres: 1e-3 for 1 mm",
    );
}
