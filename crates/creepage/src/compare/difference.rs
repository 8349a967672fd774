//! The difference of two runs along the centre line.

use super::RunLine;
use crate::check::centreline::{CentreLine, PLACES, Rows, interpolate, profile};
use crate::compare::result::Difference;

/// Number of equally spaced instants of the window at which both are compared.
pub(super) const INSTANTS: usize = 97;

/// Root mean square of the difference over that of the second run: pointwise over place and time, of the means in
/// time, and of the standard deviations in time.
pub(super) fn of(
    runs: [&RunLine; 2],
    quantity: fn(&CentreLine) -> &Rows,
    [from, to]: [f64; 2],
) -> Difference {
    let instants: Vec<f64> =
        (0..INSTANTS).map(|i| from + (to - from) * i as f64 / (INSTANTS - 1) as f64).collect();
    let [a, b] = runs.map(|run| at(&run.line.times, quantity(&run.line), &instants));
    let [c, d] = runs.map(|run| profile(quantity(&run.line), &run.weights));
    let part = |profile: &[[f64; 2]], i: usize| profile.iter().map(|p| p[i]).collect::<Vec<_>>();
    Difference {
        place_and_time: apart(&a.concat(), &b.concat()),
        means: apart(&part(&c, 0), &part(&d, 0)),
        deviations: apart(&part(&c, 1), &part(&d, 1)),
    }
}

/// A quantity at `instants` (s), linear between records.
fn at(times: &[f64], rows: &Rows, instants: &[f64]) -> Rows {
    let value = |instant: f64, place: usize| interpolate(times, instant, |k| rows[k][place]);
    instants.iter().map(|&t| (0..PLACES).map(|place| value(t, place)).collect()).collect()
}

/// Root mean square of the difference over that of `b`; `None` where `b` is zero.
fn apart(a: &[f64], b: &[f64]) -> Option<f64> {
    let squares = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>();
    let all = squares(&mut b.iter().copied());
    let differs = squares(&mut a.iter().zip(b).map(|(a, b)| a - b));
    (all > 0.0).then(|| (differs / all).sqrt())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn waves_out_of_phase_differ_in_place_and_time_and_not_in_their_statistics() {
        let times: Vec<f64> = (0..INSTANTS).map(|i| i as f64 / (INSTANTS - 1) as f64).collect();
        let wave = |phase: f64| -> Rows {
            let value = |t: f64, i: usize| {
                let x = i as f64 / (PLACES - 1) as f64;
                1.0 + 0.5 * libm::sin(2.0 * std::f64::consts::PI * (4.0 * t + x) + phase)
            };
            times.iter().map(|&t| (0..PLACES).map(|i| value(t, i)).collect()).collect()
        };
        let [a, b] = [wave(0.0), wave(std::f64::consts::PI)];
        // the difference is a wave of amplitude 1 over one of mean square 1 + 1/8
        let both = [&a, &b].map(|rows| at(&times, rows, &times).concat());
        let found = apart(&both[0], &both[1]).unwrap();
        assert!((found - (0.5_f64 / 1.125).sqrt()).abs() < 0.01, "{found}");
        let [c, d] = [a, b].map(|rows| profile(&rows, &[1.0; INSTANTS]));
        for i in 0..2 {
            let [c, d] = [&c, &d].map(|p| p.iter().map(|p| p[i]).collect::<Vec<_>>());
            assert!(apart(&c, &d).unwrap() < 0.02);
        }
    }
}
