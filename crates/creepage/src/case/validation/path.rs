//! The patch, by Hertz, is not lost in one element, and stays inside the fine zone while rolling from x = 0.

use super::warnings::units;
use super::{Findings, metres, mm};
use crate::case::hertz::{Hertz, hertz};
use crate::case::schema::{Case, PreloadMethod};
use crate::case::value::{digits, number};

/// Elements longer than this many half axes of the patch leave it without a node most of the time: the mean normal force
/// then misses the load by up to all of it.
const LARGEST_ELEMENT: f64 = 4.0;

/// Checks the fine zone against the patch and its path.
pub(super) fn check(case: &Case, found: &mut Findings<'_>) {
    let patch = hertz(case);
    check_resolution(case, &patch, found);
    check_ends(case, &patch, found);
    let (zone, least) = (&case.mesh.zone, 2.0 * patch.b);
    found.require(
        zone.width >= least * (1.0 - 1e-12),
        &["mesh.zone.width", "load.normal", "material.young"],
        format_args!(
            "mesh.zone.width = {} m must be at least the patch's width, {} m",
            number(zone.width),
            digits(least)
        ),
        &help(case, "widen the fine zone, reduce the load, or give the bar a smaller crown_radius"),
    );
}

/// A remedy, and the values in which a wrong unit shows: it is the likely cause of an absurd patch.
fn help(case: &Case, remedy: &str) -> String {
    units(case).into_iter().fold(remedy.to_owned(), |help, unit| format!("{help}; {unit}"))
}

/// The shorter half axis of the patch (m) that elements must resolve; a slice has none across.
pub(super) fn least_half_axis(case: &Case, patch: &Hertz) -> f64 {
    if case.mesh.plane_strain { patch.a } else { patch.a.min(patch.b) }
}

/// Elements are not larger than the patch.
fn check_resolution(case: &Case, patch: &Hertz, found: &mut Findings<'_>) {
    // half-spaces count points in the patch; a disk that falls presses harder than its load; a mesh that is read can not be
    // refined here, and a run on it says what it misses
    let generated = !case.is_half_space() && case.mesh.file.is_none();
    let rests = generated && case.preload.method != PreloadMethod::None;
    let (size, least) = (case.mesh.zone.size, least_half_axis(case, patch));
    found.require(
        !rests || size <= LARGEST_ELEMENT * least,
        &["load.normal", "mesh.zone.size", "material.young"],
        format_args!(
            "mesh.zone.size = {} mm is more than twice the shorter axis of the patch of load.normal = {} N, {} by {} mm by \
             Hertz: one node or none touches, and its force does not balance the load",
            mm(size),
            number(case.load.normal),
            mm(2.0 * patch.a),
            mm(2.0 * patch.b)
        ),
        &help(
            case,
            &format!(
                "raise load.normal, or set mesh.zone.size = {} or less, a quarter of the patch",
                digits(0.5 * least)
            ),
        ),
    );
}

/// The fine zone reaches from the rear of the first patch to the front of the last, or follows the patch.
fn check_ends(case: &Case, patch: &Hertz, found: &mut Findings<'_>) {
    let zone = &case.mesh.zone;
    let (rear, front) = (-patch.a, case.rolled() + patch.a);
    let follows = case.mesh.window.is_some();
    found.require(
        follows || zone.start <= rear,
        &["mesh.zone.start", "load.normal", "material.young"],
        format_args!(
            "mesh.zone.start = {} m must be at most {} m: the patch at the start reaches back so far",
            number(zone.start),
            digits(rear)
        ),
        &help(case, "start the fine zone further back, or reduce the load"),
    );
    let end = zone.start + zone.length;
    found.require(
        follows || end >= front,
        &[
            "time.roll",
            "time.duration",
            "mesh.zone.length",
            "mesh.zone.start",
            "load.normal",
            "material.young",
        ],
        format_args!(
            "the patch (half length {} mm) ends at x = {} m after rolling {} m, but the fine zone ends at {} m",
            mm(patch.a),
            digits(front),
            metres(case.rolled()),
            metres(end)
        ),
        &help(
            case,
            "roll less (time.roll), lengthen the fine zone (mesh.zone.length), or let it follow the contact (mesh.window)",
        ),
    );
    found.require(
        case.window_columns() != Some(0),
        &["mesh.window", "mesh.zone.size", "load.normal", "material.young"],
        format_args!(
            "mesh.window = {} m must be at least {} m: the patch (half length {} mm) with room to move on by one element",
            number(case.mesh.window.unwrap_or_default()),
            digits(case.shortest_window()),
            mm(patch.a)
        ),
        &help(case, "lengthen the window: three patches are sensible"),
    );
}
