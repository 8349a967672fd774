//! Heights of the running surfaces: where the bodies roll they are finite and small.

use super::Findings;
use crate::case::hertz::hertz;
use crate::case::irregularity::{Coordinate, SurfaceHeights};
use crate::case::schema::Case;
use crate::case::value::{digits, number};
use std::f64::consts::PI;

/// Places at which a formula is tried.
const TRIALS: u32 = 4000;
/// Room beside the patch that points must cover, in its half lengths.
const ROOM: f64 = 2.0;

/// Checks the heights of both bodies.
pub(super) fn check(case: &Case, found: &mut Findings<'_>) {
    let travel = if case.mesh.window.is_some() { case.rolled() } else { 0.0 };
    let bar = [case.bar.start, case.bar.start + case.bar.length + travel];
    let keys = [
        ("bar.surface", &case.bar.surface, Coordinate::X, bar),
        ("disk.out_of_round", &case.disk.out_of_round, Coordinate::Angle, [-PI, PI]),
    ];
    for (key, given, over, [first, last]) in keys {
        if let Some(given @ SurfaceHeights::Formula(_)) = given {
            let at = |i: u32| first + (last - first) * f64::from(i) / f64::from(TRIALS);
            check_formula(given, over, (0..=TRIALS).map(at), key, found);
        }
    }
    let Some(SurfaceHeights::Points(points)) = &case.bar.surface else { return };
    let room = ROOM * hertz(case).a;
    let (rear, front) = (-room, case.rolled() + room);
    let ends = [points.first(), points.last()].map(|point| point.map_or(f64::NAN, |[x, _]| *x));
    found.require(
        ends[0] <= rear && ends[1] >= front,
        &["bar.surface", "time.roll", "time.duration"],
        format_args!(
            "bar.surface gives heights from x = {} to {} m, but the patch needs them from {} to {} m",
            number(ends[0]),
            number(ends[1]),
            digits(rear),
            digits(front)
        ),
        "give heights over the whole roll with a patch before and behind, or roll less (time.roll); x is in metres from \
         the point of first contact",
    );
}

/// A formula has small heights everywhere; around the disk it closes.
fn check_formula(
    given: &SurfaceHeights,
    over: Coordinate,
    places: impl Iterator<Item = f64>,
    key: &str,
    found: &mut Findings<'_>,
) {
    // one that does not parse was refused before
    let Ok(heights) = given.heights(over) else { return };
    let small = |z: f64| z.abs() <= mesh::HIGHEST;
    let wrong = places.map(|at| (at, heights.at(at))).find(|(_, z)| !small(*z));
    found.require(
        wrong.is_none(),
        &[key],
        wrong.map_or(String::new(), |(at, z)| {
            let (name, most) = (over.name(), number(mesh::HIGHEST));
            format!(
                "{key}: the formula gives {} m at {name} = {}: heights must be finite and at most {most} m in size",
                digits(z),
                digits(at)
            )
        }),
        "give heights in metres: 1e-5 for 10 um",
    );
    let ends = [-PI, PI * (1.0 - 1e-12)].map(|angle| heights.at(angle));
    found.require(
        over == Coordinate::X || wrong.is_some() || (ends[1] - ends[0]).abs() <= mesh::CLOSED,
        &[key],
        format_args!(
            "{key}: the formula gives {} m at angle = -pi and {} m at pi, which is the same place of the disk",
            digits(ends[0]),
            digits(ends[1])
        ),
        "write a formula that closes after a turn: cos(3*angle), or max(0, ...) for a flat",
    );
}
