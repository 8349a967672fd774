//! Over which length and time the fluctuation of slip correlates, and the mean wavenumber and frequency of its power spectrum.
//!
//! All is in the frame of the patch: x relative to its centre, and time at places that move with it.

use crate::check::welch::density;

/// A correlation ends where the autocorrelation falls below this part of the variance.
const ENDS: f64 = 1.0 / std::f64::consts::E;
/// Intervals of records count as equal within this part of their mean: the step of the time integration does not divide the
/// interval that was asked for.
const EQUAL: f64 = 0.1;
/// The fewest values of which there is a spectrum.
const FEWEST: usize = 16;

/// Statistics of a fluctuation in space and time; `None` where records or places do not resolve one, or are too few.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Correlation {
    /// Distance along x at which the autocorrelation falls to 1/e (m).
    pub length: Option<f64>,
    /// Time in which it does (s).
    pub time: Option<f64>,
    /// Mean of the wavenumber, 2 pi over the wavelength, weighted by the power (1/m).
    pub wavenumber: Option<f64>,
    /// Mean of the frequency, weighted by the power (Hz).
    pub frequency: Option<f64>,
}

impl Correlation {
    /// Of the `rows` of a fluctuation, one for each of the `times` (s), at places that follow each other at the distance `dx`
    /// (m).
    pub fn of(rows: &[Vec<f64>], times: &[f64], dx: f64) -> Self {
        let mut found = Self {
            length: along_rows(rows).map(|lag| lag * dx),
            wavenumber: centroid(rows.iter().map(|row| density(row, dx)), least(rows)),
            ..Self::default()
        };
        if let Some(dt) = interval(times) {
            let columns = transposed(rows);
            found.time = along_rows(&columns).map(|lag| lag * dt);
            found.frequency =
                centroid(columns.iter().map(|column| density(column, dt)), least(&columns));
        }
        found.wavenumber = found.wavenumber.map(|k| std::f64::consts::TAU * k);
        found
    }
}

/// Length of the rows.
fn least(rows: &[Vec<f64>]) -> usize {
    rows.iter().map(Vec::len).min().unwrap_or(0)
}

fn transposed(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..least(rows)).map(|i| rows.iter().map(|row| row[i]).collect()).collect()
}

/// The interval of times (s); `None` where their intervals differ.
fn interval(times: &[f64]) -> Option<f64> {
    let [first, last] = [times.first()?, times.last()?];
    let mean = (last - first) / (times.len() - 1) as f64;
    let equal = times.windows(2).all(|pair| (pair[1] - pair[0] - mean).abs() <= EQUAL * mean);
    (mean > 0.0 && equal).then_some(mean)
}

/// Mean product of values `lag` apart in the same row, over all rows.
fn product(rows: &[Vec<f64>], lag: usize) -> f64 {
    let pairs = rows.iter().flat_map(|row| row.iter().zip(&row[lag..]));
    let (sum, count) = pairs.fold((0.0, 0.0), |(sum, count), (a, b)| (sum + a * b, count + 1.0));
    sum / count
}

/// The lag, in values, at which the autocorrelation along the rows falls to 1/e, by linear interpolation; `None` where it does
/// within one value, or not within half of a row.
fn along_rows(rows: &[Vec<f64>]) -> Option<f64> {
    let variance = product(rows, 0);
    let mut before = 1.0;
    for lag in 1..=least(rows) / 2 {
        let now = product(rows, lag) / variance;
        if now.is_nan() {
            return None;
        }
        if now < ENDS {
            let end = lag as f64 - (ENDS - now) / (before - now);
            return (lag > 1).then_some(end);
        }
        before = now;
    }
    None
}

/// Mean frequency of the sum of spectra, weighted by their density.
fn centroid(spectra: impl Iterator<Item = Vec<[f64; 2]>>, values: usize) -> Option<f64> {
    if values < FEWEST {
        return None;
    }
    let mut sums = [0.0; 2];
    for [frequency, power] in spectra.flatten() {
        sums[0] += power * frequency;
        sums[1] += power;
    }
    (sums[1] > 0.0).then(|| sums[0] / sums[1])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::f64::consts::TAU;

    const DX: f64 = 1e-4;
    const DT: f64 = 1e-6;

    fn field(of: impl Fn(f64, f64) -> f64) -> (Vec<Vec<f64>>, Vec<f64>) {
        let row = |k: usize| (0..128).map(|i| of(DX * i as f64, DT * k as f64)).collect();
        ((0..512).map(row).collect(), (0..512).map(|k| DT * k as f64).collect())
    }

    #[test]
    fn a_travelling_sine_has_its_wavenumber_and_frequency_and_correlates_until_its_cosine_is_one_in_e()
     {
        let (wavelength, period) = (3.2e-3, 32e-6);
        let (rows, times) = field(|x, t| libm::sin(TAU * (x / wavelength - t / period)));
        let found = Correlation::of(&rows, &times, DX);
        let part = libm::acos(ENDS) / TAU;
        let near = |found: Option<f64>, wanted: f64, by: f64| {
            assert!((found.unwrap() / wanted - 1.0).abs() < by, "{found:?} {wanted}");
        };
        near(found.length, part * wavelength, 5e-3);
        near(found.time, part * period, 5e-3);
        near(found.wavenumber, TAU / wavelength, 2e-2);
        near(found.frequency, 1.0 / period, 2e-2);
    }

    /// Numbers between -1 and 1 that look random (Steele, Lea and Flood 2014).
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    #[test]
    fn white_noise_correlates_over_less_than_a_place_and_its_spectrum_is_flat() {
        let mut seed = 1;
        let (mut rows, times) = field(|_, _| 0.0);
        rows.iter_mut().flatten().for_each(|value| *value = noise(&mut seed));
        let found = Correlation::of(&rows, &times, DX);
        assert_eq!((found.length, found.time), (None, None));
        // half of the highest wavenumber pi/dx and frequency 1/(2 dt)
        assert!((found.wavenumber.unwrap() * DX / (0.25 * TAU) - 1.0).abs() < 2e-2);
        assert!((found.frequency.unwrap() * 4.0 * DT - 1.0).abs() < 2e-2);
    }

    #[test]
    fn noise_that_forgets_exponentially_correlates_over_the_length_in_which_it_does() {
        // first-order autoregression (Gauss-Markov), of ten values
        let (keeps, mut seed) = (libm::exp(-0.1), 2);
        let (mut rows, times) = field(|_, _| 0.0);
        for row in &mut rows {
            let mut value = noise(&mut seed) / (1.0 - keeps * keeps).sqrt();
            for to in row.iter_mut() {
                value = keeps * value + noise(&mut seed);
                *to = value;
            }
        }
        let found = Correlation::of(&rows, &times, DX).length.unwrap();
        assert!((found / (10.0 * DX) - 1.0).abs() < 0.1, "{found}");
    }

    #[test]
    fn records_at_unequal_intervals_have_no_time() {
        let (rows, mut times) = field(|x, t| libm::sin(1e3 * x + 1e5 * t));
        times.iter_mut().skip(200).for_each(|time| *time += DT);
        let found = Correlation::of(&rows, &times, DX);
        assert!(found.time.is_none() && found.frequency.is_none() && found.length.is_some());
    }

    #[test]
    fn few_records_have_the_interval_between_them_and_one_has_none() {
        assert_eq!(interval(&[5.0, 5.25]), Some(0.25));
        assert_eq!(interval(&[5.0, 5.25, 5.5]), Some(0.25));
        assert_eq!(
            (interval(&[5.0, 5.25, 6.0]), interval(&[5.0]), interval(&[])),
            (None, None, None)
        );
    }
}
