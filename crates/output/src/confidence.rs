//! 95 % confidence intervals of a mean: over independent values, and over a time series.

/// Numbers of batches that are tried, the larger first; between 10 and 30 little changes (Schmeiser 1982).
const BATCHES: [usize; 2] = [20, 10];
/// The 0.95 quantile of the standard normal distribution.
const ONE_IN_TWENTY: f64 = 1.644_854;

/// Mean of independent values and half the width of its 95 % confidence interval (Student 1908), both in the
/// unit of the values; `None` for fewer than two values or where one is not finite.
pub fn interval(values: &[f64]) -> Option<[f64; 2]> {
    let count = values.len() as f64;
    if values.len() < 2 || values.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
    let of_mean = (squares / (count - 1.0) / count).sqrt();
    Some([mean, student(values.len() - 1) * of_mean])
}

/// Divides the records of a time series into `count` successive batches of equal weight. `weights` are the times
/// (s) that the records stand for. Each batch lists its records with the part (s) of their weight that lies in
/// the batch.
///
/// # Panics
/// Where `count` is 0 and a weight is positive.
pub fn batches(weights: &[f64], count: usize) -> Vec<Vec<(usize, f64)>> {
    let whole: f64 = weights.iter().sum();
    let length = whole / count as f64;
    let mut found = vec![Vec::new(); count];
    let mut before = 0.0;
    for (record, &weight) in weights.iter().enumerate() {
        let (mut from, to) = (before, before + weight);
        before = to;
        while from < to {
            let batch = ((from / length) as usize).min(count - 1);
            let end = if batch + 1 == count { to } else { to.min(length * (batch + 1) as f64) };
            // where the end rounds to the beginning, the rest of the record stays in this batch
            let end = if end > from { end } else { to };
            found[batch].push((record, end - from));
            from = end;
        }
    }
    found
}

/// Half the width of the 95 % confidence interval of a mean over time, by the method of batch means (Conway
/// 1963). `of` gives the mean of a batch from its records, as [`batches`] lists them; `weights` are the times
/// (s) that the records stand for. 20 batches are tried, then 10.
///
/// # Errors
/// The reason why there is no interval: a record weighs more than half a batch, a batch has no value, or
/// neighbouring batches correlate by the ratio of von Neumann (1941), which happens by chance one time in
/// twenty.
pub fn of_batches(
    weights: &[f64],
    of: impl Fn(&[(usize, f64)]) -> f64,
) -> Result<f64, &'static str> {
    let mut why = "there are fewer than two records in a tenth of the window";
    let whole: f64 = weights.iter().sum();
    let largest = weights.iter().copied().fold(0.0, f64::max);
    for count in BATCHES {
        // to round-off: records at equal intervals fill a batch two by two
        if largest * count as f64 > 0.5 * whole * (1.0 + 1e-9) {
            continue;
        }
        let means: Vec<f64> = batches(weights, count).iter().map(|batch| of(batch)).collect();
        let Some([mean, half]) = interval(&means) else {
            why = "not every part of the window has a value";
            continue;
        };
        // of independent normal numbers the ratio has this variance (Young 1941)
        let n = count as f64;
        let by_chance = ((n - 2.0) / (n * n - 1.0)).sqrt();
        if correlation(&means, mean) <= ONE_IN_TWENTY * by_chance {
            return Ok(half);
        }
        why = "it drifts, or varies as slowly as the window is long";
    }
    Err(why)
}

/// As [`of_batches`], for the weighted mean of `values`, one for each record.
///
/// # Errors
/// As there.
///
/// # Panics
/// Where there are fewer values than weights.
pub fn of_series(weights: &[f64], values: &[f64]) -> Result<f64, &'static str> {
    of_batches(weights, |batch| {
        let whole: f64 = batch.iter().map(|(_, weight)| weight).sum();
        batch.iter().map(|&(record, weight)| weight * values[record]).sum::<f64>() / whole
    })
}

/// Correlation of successive values by their squared differences, 1 - sum (x_{i+1} - x_i)^2 / (2 sum (x_i - m)^2),
/// m their mean; 0 where all values are equal.
fn correlation(values: &[f64], mean: f64) -> f64 {
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let steps: f64 = values.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
    // the squares of equal numbers are round-off
    if squares <= (1e-12 * mean).powi(2) { 0.0 } else { 1.0 - 0.5 * steps / squares }
}

/// The 0.975 quantile of Student's distribution with `freedom` degrees of freedom, to 1e-3: tabulated below
/// ten, above by the expansion of Cornish and Fisher (Abramowitz and Stegun 26.7.5).
fn student(freedom: usize) -> f64 {
    const FEW: [f64; 9] = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262];
    if let Some(quantile) = freedom.checked_sub(1).and_then(|few| FEW.get(few)) {
        return *quantile;
    }
    let (z, n) = (1.959_964_f64, freedom as f64);
    let first = (z.powi(3) + z) / 4.0;
    let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
    let third = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0;
    z + first / n + second / n.powi(2) + third / n.powi(3)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (freedom, quantile) in [(1, 12.706), (7, 2.365), (10, 2.228), (30, 2.042), (120, 1.980)]
        {
            assert!((student(freedom) - quantile).abs() < 1e-3, "{freedom}: {}", student(freedom));
        }
    }

    /// Numbers from -1 to 1 without order: the finish of `SplitMix64` (Steele, Lea and Flood 2014).
    fn noise(seed: u64) -> impl Iterator<Item = f64> {
        (0_u64..).map(move |i| {
            let k = (i + 1 + (seed << 32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let k = (k ^ (k >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let k = (k ^ (k >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((k ^ (k >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
    }

    /// A series that forgets what it was within `memory` records, of mean zero.
    fn series(seed: u64, count: usize, memory: f64) -> Vec<f64> {
        let keep = libm::exp(-1.0 / memory);
        let mut value = 0.0;
        let mut next = |force: f64| {
            value = keep * value + force;
            value
        };
        noise(seed).map(&mut next).skip(200).take(count).collect()
    }

    #[test]
    fn nineteen_of_twenty_intervals_hold_the_mean_of_a_series_that_forgets_within_a_batch() {
        let weights = vec![1e-6; 2000];
        let held = |seed: &u64| {
            let values = series(*seed, 2000, 5.0);
            let mean = values.iter().sum::<f64>() / 2000.0;
            of_series(&weights, &values).is_ok_and(|half| mean.abs() <= half)
        };
        let found = (0..400).filter(held).count();
        // one in twenty misses, a few more are refused by chance with 20 batches and again with 10
        assert!((360..=392).contains(&found), "{found} of 400");
        let refused = |seed: &u64| of_series(&weights, &series(*seed, 2000, 0.1)).is_err();
        // one in twenty with 20, of these again some with 10
        assert!((1..=12).contains(&(0..400).filter(refused).count()));
        let with_20 = |seed: &u64| {
            let means: Vec<f64> = noise(*seed).take(20).collect();
            let mean = means.iter().sum::<f64>() / 20.0;
            correlation(&means, mean) > ONE_IN_TWENTY * (18.0_f64 / 399.0).sqrt()
        };
        let found = (0..2000).filter(with_20).count();
        assert!((75..=125).contains(&found), "{found} of 2000 correlate by chance");
        // the error of independent records would be far too small
        let naive = |seed: &u64| {
            let [mean, half] = interval(&series(*seed, 2000, 5.0)).unwrap();
            mean.abs() <= half
        };
        assert!((0..400).filter(naive).count() < 260);
    }

    #[test]
    fn a_drift_and_a_wave_as_long_as_the_window_have_no_interval() {
        let weights = vec![1.0; 500];
        let of = |value: fn(f64) -> f64| -> Vec<f64> {
            noise(3)
                .take(500)
                .zip(0..)
                .map(|(n, i)| value(f64::from(i) / 500.0) + 0.1 * n)
                .collect()
        };
        for values in [of(|t| 5.0 + t), of(|t| libm::sin(6.3 * t))] {
            assert!(of_series(&weights, &values).is_err_and(|why| why.contains("drifts")));
        }
        assert!(of_series(&weights[..19], &[1.0; 19]).is_err());
        assert_eq!(of_series(&weights, &[2.5; 500]), Ok(0.0));
    }

    #[test]
    fn batches_split_records_where_they_end() {
        let found = batches(&[1.0, 2.0, 0.0, 1.0], 2);
        assert_eq!(found, [vec![(0, 1.0), (1, 1.0)], vec![(1, 1.0), (3, 1.0)]]);
        let whole: f64 = batches(&[0.1; 77], 10).concat().iter().map(|(_, weight)| weight).sum();
        assert!((whole - 7.7).abs() < 1e-12);
    }
}
