//! The centre line of a run, mean over its window.

use crate::check::PostError;
use crate::check::Scales;
use crate::check::basis::{Basis, RunPaths};
use crate::check::frames::ContactHistory;
use crate::check::window::Window;
use crate::figures::{FigureMeans, Scene};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// Most records that a mean is taken over.
const MOST_RECORDS: usize = 40;

/// Along y = 0, for each bin: x relative to the patch's centre (m), p_n and p_f (Pa), |s| (m/s; NaN where no record
/// has contact).
pub(super) struct Profile(pub Vec<[f64; 4]>);

/// The mean over the records of the evaluation window, in bins of an element's length that move
/// with the patch.
pub(super) fn profile(run: &Path) -> Result<Profile, PostError> {
    let paths = RunPaths::of(run)?;
    let mut basis = Basis::read(&paths)?;
    let history = ContactHistory::open(&paths.contact)?;
    let window = Window::resolve(None, &basis, &history)?;
    let records = window.records.clone();
    let scales = Scales::resolve(&mut basis, &history, &records)?;
    let body = history.surface.bodies().last().copied().unwrap_or(0);
    let scene = Scene {
        history: &history,
        basis: &basis,
        scales,
        body,
        records: records.clone(),
        window: window.ends(&history.times),
        means: FigureMeans::default(),
        instants: Vec::new(),
        halves: Vec::new(),
        line_reach: 0.0,
    };
    let line = scene.centreline(body);
    // per bin: sums of p_n, p_f and |s|, number of nodes for the first two and for the last
    let mut bins: BTreeMap<i64, [f64; 5]> = BTreeMap::new();
    for index in spread(&history.times, records) {
        let frame = history.record(index)?;
        let centre = scene.centre(&frame);
        for &row in &line {
            let x = scene.position(&frame, row)[0] - centre;
            if x.abs() > scene.reach() {
                continue;
            }
            let bin = bins.entry((x / scales.size).round() as i64).or_default();
            bin[0] += frame.pressure[row];
            bin[1] += frame.shear[row].norm();
            bin[3] += 1.0;
            if scene.in_contact(&frame, row) {
                bin[2] += frame.slip_velocity[row].norm();
                bin[4] += 1.0;
            }
        }
    }
    let mean = |(bin, [p, shear, slip, all, touching]): (i64, [f64; 5])| {
        [bin as f64 * scales.size, p / all, shear / all, slip / touching]
    };
    Ok(Profile(bins.into_iter().map(mean).collect()))
}

/// The records nearest to times that are evenly spaced over the window, so that spans recorded at every step
/// do not outweigh others.
fn spread(times: &[f64], records: Range<usize>) -> Vec<usize> {
    let (from, to) = (times[records.start], times[records.end - 1]);
    let nearest = |i: usize| {
        let wanted = from + (to - from) * i as f64 / (MOST_RECORDS - 1) as f64;
        let away = |k: &usize| (times[*k] - wanted).abs();
        records.clone().min_by(|a, b| away(a).total_cmp(&away(b)))
    };
    let mut chosen: Vec<usize> = (0..MOST_RECORDS).filter_map(nearest).collect();
    chosen.dedup();
    chosen
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn a_span_recorded_densely_does_not_outweigh_the_rest() {
        let mut times: Vec<f64> = (0..90).map(f64::from).collect();
        times.extend((0..900).map(|i| 90.0 + 1e-3 * f64::from(i)));
        let dense = spread(&times, 0..times.len()).iter().filter(|k| times[**k] >= 89.5).count();
        assert!(dense <= 2, "{dense}");
        assert_eq!(spread(&times, 3..4), [3]);
    }
}
