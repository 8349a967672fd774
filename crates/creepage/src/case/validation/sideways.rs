//! A disk of finite elements that drifts, or turns about the vertical.

use super::Findings;
use crate::case::hertz::{hertz, patch_shape};
use crate::case::schema::{Case, Symmetry};
use crate::case::value::digits;
use crate::case::value::number;
use contact::patch::PatchShape;

/// The keys that move the disk sideways, what they say, and their unit.
fn given(case: &Case) -> impl Iterator<Item = (&'static str, f64, &'static str)> {
    [
        ("drive.lateral_creepage", case.drive.lateral_creepage, ""),
        ("drive.spin", case.drive.spin, " rad/m"),
    ]
    .into_iter()
    .filter(|(_, value, _)| *value != 0.0)
}

/// Only a whole model in three dimensions moves sideways, whose fine zone stays where it is.
pub(super) fn check(case: &Case, found: &mut Findings<'_>) {
    let line = patch_shape(case) == PatchShape::Rectangle && !case.mesh.plane_strain;
    for (key, value, unit) in given(case) {
        for (other, applies, why, remedy) in [
            (
                "mesh.symmetry",
                case.mesh.symmetry == Symmetry::Half,
                "mesh.symmetry = \"half\": the motion has no plane of symmetry",
                "set mesh.symmetry = \"whole\"",
            ),
            (
                "mesh.plane_strain",
                case.mesh.plane_strain,
                "mesh.plane_strain = true: a slice stays in its plane",
                "model the whole width (mesh.plane_strain = false)",
            ),
            (
                "mesh.window",
                case.mesh.window.is_some(),
                "mesh.window: the mesh can follow only a disk that rolls straight",
                "give a mesh.zone.length for the whole roll in place of mesh.window",
            ),
            (
                "bar.crown_radius",
                line,
                "disk.crown_radius and bar.crown_radius both \"flat\": contact along a line reaches the edges, off which the \
                 disk drifts",
                "give one of them a crown_radius",
            ),
        ] {
            found.require(
                !applies,
                &[key, other],
                format_args!("{key} = {}{unit} does not go with {why}", number(value)),
                &format!("{remedy}, or leave {key} out"),
            );
        }
    }
}

/// The patch stays inside the width of the fine zone of both bodies.
pub(super) fn check_drift(case: &Case, found: &mut Findings<'_>) {
    let Some((key, ..)) = given(case).next() else { return };
    let (drift, b) = (case.drift(), hertz(case).b);
    let behind = case.patch_behind();
    let reach = drift * behind.max(1.0 - behind) + b;
    let half = 0.5 * case.mesh.zone.width;
    found.require(
        reach <= half * (1.0 + 1e-12),
        &[key, "drive.spin", "mesh.zone.width", "time.roll"],
        format_args!(
            "the disk drifts by up to {} mm (drive.lateral_creepage, drive.spin), so that the patch (half width {} mm) \
             reaches {} mm to the side, but half of mesh.zone.width is {} mm",
            digits(1e3 * drift),
            digits(1e3 * b),
            digits(1e3 * reach),
            digits(1e3 * half)
        ),
        "widen the fine zone (mesh.zone.width), roll less (time.roll), or reduce drive.lateral_creepage or drive.spin",
    );
}
