//! Sizes of the bodies and of the fine zone that fit one another.

use super::{Findings, metres};
use crate::case::schema::{Case, Crown, Grading, PreloadMethod, Symmetry};
use crate::case::value::number;

/// More elements than this in the fine zones are taken for a typing mistake.
const MOST_ELEMENTS: f64 = 2e8;

/// The least radius of a hub over that of its disk.
const SMALLEST_HUB: f64 = 1e-3;

const NOT_INSIDE: &str = "the fine zone must lie inside both bodies: make it smaller";

/// Checks the sizes of the bodies and of the fine zone.
pub(super) fn check(case: &Case, found: &mut Findings<'_>) {
    check_zone_size(case, found);
    check_disk(case, found);
    check_crowns(case, found);
    check_slice(case, found);
    check_symmetry(case, found);
    check_grading(case, found);
    check_window(case, found);
    check_zone_place(case, found);
    check_element_count(case, found);
}

/// The fine zone is no larger than the bodies, and its elements no larger than it.
fn check_zone_size(case: &Case, found: &mut Findings<'_>) {
    let (disk, bar, zone) = (&case.disk, &case.bar, &case.mesh.zone);
    const COARSE: &str = "the element size must not exceed the fine zone: make mesh.zone.size \
                          smaller, for example 1e-3";
    const GROWS: &str = "elements grow from zone.size to coarsest: make coarsest larger";
    let (width, depth, size) = ("mesh.zone.width", "mesh.zone.depth", "mesh.zone.size");
    let length = if case.mesh.window.is_some() { "mesh.window" } else { "mesh.zone.length" };
    let along = case.mesh.window.unwrap_or(zone.length);
    let coarsest = case.mesh.coarsest;
    // `zone.depth` and `coarsest` are without meaning beside a mesh that is read
    let generated = case.mesh.file.is_none();
    for (key, value, limit_key, limit, remedy, applies) in [
        (width, zone.width, "bar.width", bar.width, NOT_INSIDE, true),
        (width, zone.width, "disk.width", disk.width, NOT_INSIDE, true),
        (length, along, "bar.length", bar.length, NOT_INSIDE, true),
        (depth, zone.depth, "bar.height", bar.height, NOT_INSIDE, generated),
        (size, zone.size, length, along, COARSE, true),
        (size, zone.size, width, zone.width, COARSE, true),
        (size, zone.size, depth, zone.depth, COARSE, generated),
        (size, zone.size, "mesh.coarsest", coarsest, GROWS, generated),
    ] {
        let (asked, limit_text) = (number(value), number(limit));
        found.require(
            !applies || value <= limit,
            &[key, limit_key],
            format_args!("{key} = {asked} m must be at most {limit_key} = {limit_text} m"),
            remedy,
        );
    }
}

/// The hub is smaller than the disk, and the rim around it as deep as the fine zone.
fn check_disk(case: &Case, found: &mut Findings<'_>) {
    let (disk, zone) = (&case.disk, &case.mesh.zone);
    found.require(
        disk.hub_radius < disk.radius,
        &["disk.hub_radius", "disk.radius"],
        format_args!(
            "disk.hub_radius = {} m must be less than disk.radius = {} m",
            number(disk.hub_radius),
            number(disk.radius)
        ),
        "the hub is the rigid core of the disk: make it smaller",
    );
    let least = SMALLEST_HUB * disk.radius;
    found.require(
        case.mesh.file.is_some() || disk.hub_radius >= least,
        &["disk.hub_radius", "disk.radius"],
        format_args!(
            "disk.hub_radius = {} m must be at least {SMALLEST_HUB} of disk.radius, {} m: the elements around a \
             smaller one are needles",
            number(disk.hub_radius),
            metres(least)
        ),
        "make the hub larger: a tenth of the disk is as good as none",
    );
    let rim = disk.radius - disk.hub_radius;
    found.require(
        case.mesh.file.is_some() || rim <= 0.0 || zone.depth <= rim,
        &["mesh.zone.depth", "disk.hub_radius", "disk.radius"],
        format_args!(
            "mesh.zone.depth = {} m must be at most disk.radius - disk.hub_radius = {} m",
            number(zone.depth),
            metres(rim)
        ),
        NOT_INSIDE,
    );
}

fn check_crowns(case: &Case, found: &mut Findings<'_>) {
    let (disk, bar) = (&case.disk, &case.bar);
    for (key, crown, width) in [
        ("disk.crown_radius", disk.crown_radius, disk.width),
        ("bar.crown_radius", bar.crown_radius, bar.width),
    ] {
        if let Crown::Radius(radius) = crown {
            found.require(
                radius >= width,
                &[key],
                format_args!("{key} = {} m must be at least the width, {width} m", number(radius)),
                "a crown radius below the width of the body makes no running surface",
            );
        }
    }
}

/// Plane strain is a slice of two cylinders of one width.
fn check_slice(case: &Case, found: &mut Findings<'_>) {
    if !case.mesh.plane_strain {
        return;
    }
    let (disk, bar, zone) = (&case.disk, &case.bar, &case.mesh.zone);
    found.require(
        disk.crown_radius == Crown::Flat && bar.crown_radius == Crown::Flat,
        &["mesh.plane_strain", "disk.crown_radius", "bar.crown_radius"],
        "mesh.plane_strain = true must go with crown_radius = \"flat\" of disk and bar",
        "plane strain is the contact of two cylinders: set bar.crown_radius = \"flat\"",
    );
    let alike = |width: f64| (width - zone.width).abs() <= 1e-9 * zone.width;
    found.require(
        alike(disk.width) && alike(bar.width),
        &["mesh.plane_strain", "mesh.zone.width", "disk.width", "bar.width"],
        format_args!(
            "mesh.plane_strain = true must go with one width of all, but mesh.zone.width = {} m, disk.width \
             = {} m, bar.width = {} m",
            number(zone.width),
            number(disk.width),
            number(bar.width)
        ),
        "make a slice: give all three the same width",
    );
}

/// Half a model is neither a slice nor preloaded by relaxation, whose nodes are held or free.
fn check_symmetry(case: &Case, found: &mut Findings<'_>) {
    let whole = case.mesh.symmetry == Symmetry::Whole;
    found.require(
        whole || !case.mesh.plane_strain,
        &["mesh.symmetry", "mesh.plane_strain"],
        "mesh.symmetry = \"half\" has no meaning with mesh.plane_strain = true",
        "a slice is one element wide: leave mesh.symmetry out",
    );
    found.require(
        whole || case.preload.method != PreloadMethod::Relaxation,
        &["mesh.symmetry", "preload.method"],
        "mesh.symmetry = \"half\" does not go with preload.method = \"relaxation\"",
        "preload.method = \"static\" finds the same state, and sooner",
    );
}

/// A zone that follows the contact needs a generated mesh in three dimensions.
fn check_window(case: &Case, found: &mut Findings<'_>) {
    let stays = case.mesh.window.is_none();
    found.require(
        stays || case.mesh.file.is_none(),
        &["mesh.window", "mesh.file"],
        "mesh.window does not go with mesh.file: the pattern of a mesh that is read is not known",
        "leave out mesh.window, or let the mesh be generated",
    );
    found.require(
        stays || !case.mesh.plane_strain,
        &["mesh.window", "mesh.plane_strain"],
        "mesh.window does not go with mesh.plane_strain = true",
        "a slice has few elements: give it a mesh.zone.length for the whole roll",
    );
}

/// The fine zone lies on the bar.
fn check_zone_place(case: &Case, found: &mut Findings<'_>) {
    let bar = &case.bar;
    let [zone_start, zone_end] = case.mesh.zone_along();
    let bar_end = bar.start + bar.length;
    let rounding = 1e-12;
    found.require(
        zone_start >= bar.start - rounding && zone_end <= bar_end + rounding,
        &["mesh.zone.start", "mesh.zone.length", "mesh.window", "bar.start", "bar.length"],
        format_args!(
            "the fine zone from x = {} to {} m must lie inside the bar, x = {} to {} m",
            metres(zone_start),
            metres(zone_end),
            metres(bar.start),
            metres(bar_end)
        ),
        "move or shorten the fine zone (mesh.zone.start, mesh.zone.length), or lengthen the bar",
    );
    let quarter = 0.5 * case.disk.radius * std::f64::consts::PI;
    let length = zone_end - zone_start;
    found.require(
        length <= quarter,
        &["mesh.zone.length", "mesh.window", "disk.radius"],
        format_args!(
            "the fine zone is {} m long and must be at most a quarter of the disk's circumference, {} m",
            metres(length),
            metres(quarter)
        ),
        "shorten the fine zone or enlarge the disk",
    );
}

/// Grading in three directions is of generated meshes, and of those that are more than a slice.
fn check_grading(case: &Case, found: &mut Findings<'_>) {
    if case.mesh.grading() == Grading::Tensor {
        return;
    }
    for (key, applies, why) in [
        ("mesh.file", case.mesh.file.is_none(), "a mesh that is read is as its file says"),
        ("mesh.plane_strain", !case.mesh.plane_strain, "a slice is one element wide"),
    ] {
        found.require(
            applies,
            &["mesh.grading", key],
            format_args!("mesh.grading = \"two_to_one\" cannot go with {key}: {why}"),
            "leave out mesh.grading",
        );
    }
}

/// The fine zones do not have more elements than any machine holds.
fn check_element_count(case: &Case, found: &mut Findings<'_>) {
    let zone = &case.mesh.zone;
    let [rear, front] = case.mesh.zone_along();
    let elements = 2.0 * (front - rear) * zone.width * zone.depth / zone.size.powi(3);
    found.require(
        case.mesh.file.is_some() || elements <= MOST_ELEMENTS,
        &["mesh.zone.size"],
        format_args!(
            "mesh.zone.size = {} m makes about {elements:.1e} elements in the fine zones, more \
                 than {MOST_ELEMENTS:.0e}",
            number(zone.size)
        ),
        "give the element size in metres: 1e-3 for 1 mm",
    );
}
