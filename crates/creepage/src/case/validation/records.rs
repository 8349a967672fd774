//! What is evaluated and recorded lies in the run and in the fine zone, and a disk holds it.

use super::{Findings, metres, steps};
use crate::case::schema::{Case, Window};
use crate::case::value::number;

/// An interval between records that is shorter than this part of the estimated time step is taken for a typing
/// mistake: there can be one record at every step at most.
const SHORTEST: f64 = 1e-3;

/// More snapshots of fields or contact, more rows of the history and more numbers of probes than these are taken
/// for a typing mistake: they fill any disk.
const MOST_RECORDS: f64 = 1e7;
const MOST_ROWS: f64 = 1e8;
const MOST_NUMBERS: f64 = 1e11;

/// Every probe is this many datasets of `probes.h5`, and the time to create them grows with the square of their
/// number; every window is looked at in every step.
const PER_PROBE: f64 = 11.0;
const MOST_PROBES: usize = 1000;
const MOST_WINDOWS: usize = 1000;

/// Checks the evaluation window, the windows of output and the probes.
pub(super) fn check(case: &Case, found: &mut Findings<'_>) {
    check_evaluation(case, found);
    check_windows(&case.output.window, found);
    check_probes(case, found);
}

/// The key that gives the evaluation window.
fn evaluation_key(case: &Case) -> &'static str {
    if case.evaluate.transits.is_some() { "evaluate.transits" } else { "evaluate.last" }
}

/// Means are over a stretch that is rolled.
fn check_evaluation(case: &Case, found: &mut Findings<'_>) {
    let (rolled, last, key) = (case.rolled(), case.evaluate_last(), evaluation_key(case));
    let transits =
        case.evaluate.transits.map(|transits| format!("{} transits, ", number(transits)));
    found.require(
        last <= rolled * (1.0 + 1e-12),
        &[key, "time.roll", "time.duration"],
        format_args!(
            "{key} = {}{} m must be at most the rolled distance, {} m",
            transits.unwrap_or_default(),
            metres(last),
            metres(rolled)
        ),
        "evaluate a shorter stretch, or roll further",
    );
}

/// There are not too many windows, and each ends after it begins.
fn check_windows(windows: &[Window], found: &mut Findings<'_>) {
    found.require(
        windows.len() <= MOST_WINDOWS,
        &["output.window"],
        format_args!(
            "output.window has {} entries, more than {MOST_WINDOWS}: each is looked at in every step",
            windows.len()
        ),
        "join windows that follow each other, or shorten output.contact_interval",
    );
    for (i, window) in windows.iter().enumerate() {
        let key = format!("output.window[{i}].to");
        let (from, to) = (number(window.from), number(window.to));
        found.require(
            window.to > window.from,
            &[&key],
            format_args!("{key} = {to} s must be greater than its from = {from} s"),
            "a window ends after it begins",
        );
    }
}

/// The keys of the probes, their points, and the coordinate along the body.
fn probes(case: &Case) -> [(&'static str, &[[f64; 2]], &'static str); 2] {
    let probes = &case.output.probes;
    [("output.probes.bar", &probes.bar, "x"), ("output.probes.disk", &probes.disk, "s")]
}

/// A probe is recorded at the nearest node of the fine zone, so it must be there.
fn check_probes(case: &Case, found: &mut Findings<'_>) {
    let zone = &case.mesh.zone;
    let [rear, front] = case.mesh.zone_along();
    let front = if case.mesh.window.is_some() { front + case.rolled() } else { front };
    let half = 0.5 * zone.width;
    for (key, points, along) in probes(case) {
        found.require(
            points.len() <= MOST_PROBES,
            &[key],
            format_args!(
                "{key} has {} points, more than {MOST_PROBES}: each is eleven datasets, and the time to create them grows \
                 with the square of their number",
                points.len()
            ),
            "record all nodes of the fine zone at every step of a while instead: [[output.window]]",
        );
        let outside = points.iter().find(|[x, y]| {
            *x < rear - zone.size || *x > front + zone.size || y.abs() > half + zone.size
        });
        let [x, y] = outside.copied().unwrap_or_default().map(number);
        found.require(
            outside.is_none(),
            &[key],
            format_args!(
                "{key} = [{x}, {y}] m must lie in the fine zone: {along} from {} to {} m, y from {} to {} m",
                metres(rear),
                metres(front),
                metres(-half),
                metres(half)
            ),
            "contact is recorded in the fine zone: move the point, or enlarge mesh.zone",
        );
    }
}

/// The keys of what is recorded after intervals of time (s); no interval where there is none.
fn intervals(case: &Case) -> [(&'static str, f64); 3] {
    [
        ("output.fields_interval", case.fields_interval()),
        ("output.contact_interval", case.output.contact_interval),
        ("checkpoint.time", case.checkpoint.time.unwrap_or(f64::INFINITY)),
    ]
}

/// Records must be a step apart at least, and a disk must hold them.
pub(super) fn check_records(case: &Case, found: &mut Findings<'_>) {
    check_against_step(case, found);
    let (steps, duration, output) = (steps(case), case.duration(), &case.output);
    let mut at_most = |most: f64, count: f64, key: &str, what: &str, remedy: &str| {
        found.require(
            count <= most,
            &[key],
            format_args!(
                "{key} makes about {count:.0e} {what} in {steps:.0e} steps, more than {most:.0e}: no disk holds them"
            ),
            remedy,
        );
    };
    const LONGER: &str = "make the interval longer, or roll less (time.roll, time.duration)";
    const SHORTER: &str = "shorten the windows, or give `every` more steps";
    const FEWER: &str = "give fewer points, or roll less (time.roll)";
    let [fields, contact, _] = intervals(case);
    for ((key, interval), what) in
        [(fields, "snapshots of both bodies"), (contact, "snapshots of contact")]
    {
        at_most(MOST_RECORDS, (duration / interval).min(steps), key, what, LONGER);
    }
    let in_window = |window: &Window| {
        let steps = steps * ((window.to.min(duration) - window.from) / duration).max(0.0);
        steps / window.every as f64
    };
    let windows = output.window.iter().map(in_window).sum();
    at_most(MOST_RECORDS, windows, "output.window", "snapshots of contact", SHORTER);
    let rows = steps / output.history_interval as f64;
    at_most(MOST_ROWS, rows, "output.history_interval", "rows of the history", LONGER);
    for (key, points, _) in probes(case) {
        let numbers = PER_PROBE * steps * points.len() as f64;
        at_most(MOST_NUMBERS, numbers, key, "numbers", FEWER);
    }
}

/// The run, its evaluation window and the intervals between records are not far below the time step.
fn check_against_step(case: &Case, found: &mut Findings<'_>) {
    let duration = case.duration();
    let step = duration / steps(case);
    let key = if case.time.duration.is_some() { "time.duration" } else { "time.roll" };
    found.require(
        duration >= SHORTEST * step,
        &[key],
        format_args!(
            "{key} makes a run of {} s, far below the time step, which is about {step:.0e} s",
            number(duration)
        ),
        "roll further: 0.06 m, or 1.5e-3 s",
    );
    let shortest = SHORTEST * step.min(duration);
    let [from, to] = case.evaluation_window();
    let key = evaluation_key(case);
    found.require(
        to - from >= shortest,
        &[key],
        format_args!(
            "{key} makes an evaluation window of {} s, far below the time step, which is about {step:.0e} s: no step ends \
             in it, and no mean has a value",
            number(to - from)
        ),
        "take the means over a longer stretch: evaluate.last = 0.02",
    );
    for (key, interval) in intervals(case) {
        found.require(
            interval >= shortest,
            &[key],
            format_args!(
                "{key} = {} s is far below the time step, which is about {step:.0e} s: there can be one at every step at \
                 most",
                number(interval)
            ),
            "give the time between two of them in seconds: 5.7e-6 for 5.7 microseconds",
        );
    }
}

/// Warnings about intervals and an evaluation window that are shorter than the time step `dt` (s), one sentence each. The
/// default interval of a very short run gives none.
pub fn below_the_step(case: &Case, dt: f64) -> Vec<String> {
    let default = case.duration() / Case::SNAPSHOTS;
    let short = intervals(case)
        .into_iter()
        .filter(|&(_, interval)| interval < dt && interval < 0.999 * default)
        .map(|(key, interval)| {
            format!(
                "{key} = {} s is shorter than the time step, {dt:.2e} s: there is one at every step",
                number(interval)
            )
        });
    let [from, to] = case.evaluation_window();
    let window = (to - from < dt).then(|| {
        format!(
            "the evaluation window of {:.2e} s is shorter than the time step, {dt:.2e} s: it may hold no step, and the \
             means then have no value",
            to - from
        )
    });
    short.chain(window).collect()
}
