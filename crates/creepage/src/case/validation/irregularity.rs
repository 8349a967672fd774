//! Heights of the running surfaces: where the bodies roll they are finite and small, and as symmetric as the model.

use super::Findings;
use crate::case::hertz::hertz;
use crate::case::irregularity::{Coordinate, SurfaceHeights};
use crate::case::schema::{Case, Symmetry};
use crate::case::value::{digits, number};
use mesh::{HeightGrid, HeightTable, Heights};
use std::f64::consts::PI;

/// Places along at which heights are tried, and most places across on either side of the middle.
const TRIALS: u32 = 4000;
const TRIALS_ACROSS: f64 = 100.0;
/// What heights that must be the same may differ by (m).
const SAME: f64 = 1e-9;
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
    // half as far apart as the nodes of the fine zone
    let half = 0.5 * case.mesh.zone.width;
    let rows = (half / (0.5 * case.mesh.zone.size)).ceil().clamp(1.0, TRIALS_ACROSS) as i32;
    let spread = |j: i32| half * f64::from(j) / f64::from(rows);
    for (key, given, over, [first, last]) in keys {
        let Some(given) = given else { continue };
        // heights that do not parse were refused before
        let Ok(heights) = given.heights(over) else { continue };
        let at = |i: u32| first + (last - first) * f64::from(i) / f64::from(TRIALS);
        let across: Vec<f64> = match given.varies_across(over) {
            true => (-rows..=rows).map(spread).collect(),
            false => vec![0.0],
        };
        let places = || (0..=TRIALS).flat_map(|i| across.iter().map(move |&y| [at(i), y]));
        if matches!(given, SurfaceHeights::Formula(_)) {
            check_formula(&*heights, over, places(), key, found);
        }
        check_symmetry(case, &*heights, places(), key, found);
    }
    check_reach(case, found);
}

/// A slice has the same heights at all y, a half model at y and -y.
fn check_symmetry(
    case: &Case,
    heights: &dyn Heights,
    mut places: impl Iterator<Item = [f64; 2]>,
    key: &str,
    found: &mut Findings<'_>,
) {
    if !case.mesh.plane_strain && case.mesh.symmetry != Symmetry::Half {
        return;
    }
    let other = |y: f64| if case.mesh.plane_strain { 0.0 } else { -y };
    let differ = |at: f64, y: f64| (heights.at(at, y) - heights.at(at, other(y))).abs() > SAME;
    let wrong = places.find(|&[at, y]| differ(at, y));
    found.require(
        wrong.is_none(),
        &[key, if case.mesh.plane_strain { "mesh.plane_strain" } else { "mesh.symmetry" }],
        wrong.map_or(String::new(), |[at, y]| {
            let [here, there] = [y, other(y)].map(|y| (number(y), digits(heights.at(at, y))));
            format!(
                "{key} gives {} m at y = {} m and {} m at y = {} m, which this model takes for the same",
                here.1, here.0, there.1, there.0
            )
        }),
        "give heights that are the same there, or model both halves (mesh.symmetry = \"whole\", mesh.plane_strain = false)",
    );
}

/// Points of a bar lie wherever the patch goes.
fn check_reach(case: &Case, found: &mut Findings<'_>) {
    let patch = hertz(case);
    let ends = match &case.bar.surface {
        Some(SurfaceHeights::Points(points)) => HeightTable::along(points.clone())
            .map(|table| [table.ends(), [f64::NEG_INFINITY, f64::INFINITY]]),
        Some(SurfaceHeights::Grid(points)) => {
            HeightGrid::new(points).map(|grid| [grid.ends(0), grid.ends(1)])
        }
        _ => return,
    };
    let Ok([ends, [low, high]]) = ends else { return };
    let half = if case.mesh.plane_strain { 0.0 } else { patch.b + case.drift() };
    found.require(
        low <= -half && high >= half,
        &["bar.surface"],
        format_args!(
            "bar.surface gives heights from y = {} to {} m, but the patch needs them from {} to {} m",
            number(low),
            number(high),
            digits(-half),
            digits(half)
        ),
        "give heights over the width of the patch; y is in metres from the point of first contact",
    );
    let room = ROOM * patch.a;
    let (rear, front) = (-room, case.rolled() + room);
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
    heights: &dyn Heights,
    over: Coordinate,
    mut places: impl Iterator<Item = [f64; 2]>,
    key: &str,
    found: &mut Findings<'_>,
) {
    let small = |z: f64| z.abs() <= mesh::HIGHEST;
    let wrong = places.find(|&[at, y]| !small(heights.at(at, y)));
    found.require(
        wrong.is_none(),
        &[key],
        wrong.map_or(String::new(), |[at, y]| {
            let (name, most) = (over.name(), number(mesh::HIGHEST));
            format!(
                "{key}: the formula gives {} m at {name} = {}, y = {}: heights must be finite and at most {most} m in size",
                digits(heights.at(at, y)),
                digits(at),
                digits(y)
            )
        }),
        "give heights in metres: 1e-5 for 10 um",
    );
    let ends = [-PI, PI * (1.0 - 1e-12)].map(|angle| heights.at(angle, 0.0));
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
