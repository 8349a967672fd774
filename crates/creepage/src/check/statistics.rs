//! Weighted moments, extremes and quantiles in one pass.

/// A value with its node and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence {
    /// Index of the node in the file.
    pub node: usize,
    /// Time (s).
    pub time: f64,
    /// The value there.
    pub value: f64,
}

/// Weighted mean, mean square, largest absolute value with its place, and quantiles of all values; the standard
/// deviations over the records of their root mean squares and of their largest values.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spread {
    weight: f64,
    sum: f64,
    squares: f64,
    pub worst: Option<Occurrence>,
    /// Weight of the values in each bin.
    bins: Vec<f64>,
    /// The smallest |x|; the largest is that of `worst`.
    smallest: f64,
    record: OfRecord,
    rms_of_records: Moments,
    largest_of_records: Moments,
}

#[derive(Clone, Copy, Debug, Default)]
struct OfRecord {
    weight: f64,
    squares: f64,
    largest: f64,
}

/// Weighted mean and standard deviation of a number that every record has (West 1979).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Moments {
    weight: f64,
    mean: f64,
    squares: f64,
}

impl Moments {
    pub fn add(&mut self, weight: f64, value: f64) {
        self.weight += weight;
        let away = value - self.mean;
        self.mean += away * weight / self.weight;
        self.squares += weight * away * (value - self.mean);
    }

    pub fn deviation(&self) -> Option<f64> {
        (self.weight > 0.0).then(|| (self.squares / self.weight).max(0.0).sqrt())
    }
}

/// Bits of the fraction of |x| that, with its exponent, number its bin: a quantile is known to 1.6 %.
const FRACTION_BITS: u32 = 6;
/// Biased exponents with bins of their own; one bin holds all values below, one all values above.
const EXPONENTS: std::ops::Range<u64> = 1023 - 60..1023 + 24;
const BINS: usize = ((EXPONENTS.end - EXPONENTS.start) << FRACTION_BITS) as usize + 2;

fn bin_of(size: f64) -> usize {
    let at = size.to_bits() >> (52 - FRACTION_BITS);
    let first = EXPONENTS.start << FRACTION_BITS;
    ((at + 1).saturating_sub(first) as usize).min(BINS - 1)
}

/// Smallest and largest value of a bin; values below the first exponent count as zero.
fn ends(bin: usize) -> [f64; 2] {
    let first = EXPONENTS.start << FRACTION_BITS;
    let end = |bin: usize| match bin {
        BINS.. => f64::INFINITY,
        bin => f64::from_bits((first + bin as u64 - 1) << (52 - FRACTION_BITS)),
    };
    if bin == 0 { [0.0; 2] } else { [end(bin), end(bin + 1)] }
}

impl Spread {
    /// Adds a value of a node at a time (s).
    pub fn add(&mut self, weight: f64, value: f64, node: usize, time: f64) {
        self.weight += weight;
        self.sum += weight * value;
        self.squares += weight * value * value;
        let size = value.abs();
        self.record.weight += weight;
        self.record.squares += weight * value * value;
        self.record.largest = self.record.largest.max(size);
        if self.worst.is_none_or(|worst| size > worst.value.abs()) {
            self.worst = Some(Occurrence { node, time, value });
        }
        if self.bins.is_empty() {
            self.bins = vec![0.0; BINS];
            self.smallest = size;
        }
        self.smallest = self.smallest.min(size);
        self.bins[bin_of(size)] += weight;
    }

    /// Ends a record that stands for `span` (s).
    pub fn end_record(&mut self, span: f64) {
        let record = std::mem::take(&mut self.record);
        if record.weight > 0.0 {
            self.rms_of_records.add(span, (record.squares / record.weight).sqrt());
            self.largest_of_records.add(span, record.largest);
        }
    }

    /// Standard deviation over the records of their root mean squares.
    pub fn deviation_of_rms(&self) -> Option<f64> {
        self.rms_of_records.deviation()
    }

    /// Standard deviation over the records of their largest |x|.
    pub fn deviation_of_largest(&self) -> Option<f64> {
        self.largest_of_records.deviation()
    }

    pub fn mean(&self) -> Option<f64> {
        (self.weight > 0.0).then(|| self.sum / self.weight)
    }

    pub fn rms(&self) -> Option<f64> {
        (self.weight > 0.0).then(|| (self.squares / self.weight).sqrt())
    }

    /// The largest |x|.
    pub fn largest(&self) -> Option<f64> {
        self.worst.map(|worst| worst.value.abs())
    }

    /// The value that |x| does not exceed on the share `share` of the weight, to 1.6 % (exact where all values are
    /// equal).
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let mut below = 0.0;
        let largest = self.largest()?;
        for (bin, &weight) in self.bins.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
            let wanted = share * self.weight - below;
            if wanted <= weight {
                let part = (wanted / weight).clamp(0.0, 1.0);
                let [low, high] = ends(bin).map(|end| end.clamp(self.smallest, largest));
                return Some(low + part * (high - low));
            }
            below += weight;
        }
        self.largest()
    }
}

/// The part (s) of the span from `from` to `to` that each of the records at `times` stands for: up to half-way
/// to its neighbours. The first and the last reach as far outwards as inwards.
///
/// In a span without length the nearest record has the weight 1 and all others 0; so has a single record.
pub(crate) fn time_weights(times: &[f64], [from, to]: [f64; 2]) -> Vec<f64> {
    let alone = |index: usize| (0..times.len()).map(|i| f64::from(u8::from(i == index))).collect();
    let gap = |i: usize| times.get(i + 1).map(|next| next - times[i]);
    if times.len() < 2 {
        return alone(0);
    }
    if from >= to {
        let away = |i: &usize| (times[*i] - from).abs();
        return alone((0..times.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0));
    }
    let weight = |(i, time): (usize, &f64)| {
        let (before, after) = (i.checked_sub(1).and_then(gap), gap(i));
        let [before, after] =
            [before.or(after), after.or(before)].map(|gap| 0.5 * gap.unwrap_or(0.0));
        (after.min(to - time) + before.min(time - from)).max(0.0)
    };
    times.iter().enumerate().map(weight).collect()
}

/// Weighted mean and standard deviation of the values of records; `weights` are their [times](time_weights).
/// Values that are not finite are left out; `None` where none is left.
pub(crate) fn mean_and_deviation(
    weights: &[f64],
    values: impl Iterator<Item = f64>,
) -> Option<[f64; 2]> {
    let (mut sum, mut mean, mut squares) = (0.0, 0.0, 0.0);
    let counts = |(weight, value): &(&f64, f64)| **weight > 0.0 && value.is_finite();
    for (weight, value) in weights.iter().zip(values).filter(counts) {
        sum += weight;
        let away = value - mean;
        mean += weight / sum * away;
        squares += weight * away * (value - mean);
    }
    (sum > 0.0).then(|| [mean, (squares / sum).sqrt()])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_sorted_values_to_two_percent() {
        let mut spread = Spread::default();
        for i in 1..=1000 {
            spread.add(1.0, f64::from(i) * if i % 2 == 0 { 1e-3 } else { -1e-3 }, i as usize, 0.0);
        }
        assert!((spread.quantile(0.95).unwrap() / 0.95 - 1.0).abs() < 0.016);
        assert_eq!(spread.largest(), Some(1.0));
        assert_eq!(spread.worst.unwrap().node, 1000);
    }

    #[test]
    fn equal_values_have_exact_statistics() {
        let mut spread = Spread::default();
        (0..7).for_each(|i| spread.add(0.3, 0.1, i, 0.0));
        for found in [spread.mean(), spread.rms(), spread.quantile(0.95), spread.largest()] {
            assert!((found.unwrap() - 0.1).abs() < 1e-15);
        }
    }

    #[test]
    fn the_deviation_over_records_is_that_of_their_own_statistics() {
        let mut spread = Spread::default();
        // records (1, 1), (3, 3) and none, each for the same time
        for (time, value) in [(0.0, 1.0), (1.0, 3.0)] {
            (0..2).for_each(|node| spread.add(0.7, value, node, time));
            spread.end_record(0.5);
        }
        spread.end_record(0.5);
        assert!((spread.deviation_of_rms().unwrap() - 1.0).abs() < 1e-15);
        assert!((spread.deviation_of_largest().unwrap() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_span_recorded_densely_weighs_no_more_than_its_time() {
        // 1 over the first second, 3 over the last three
        let dense = (0..100).map(|i| f64::from(i) * 0.01 + 0.005);
        let times: Vec<f64> = dense.chain([1.5, 2.5, 3.5]).collect();
        let value = |t: &f64| if *t < 1.0 { 1.0 } else { 3.0 };
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        let weights = time_weights(&times, all);
        let [mean, deviation] = mean_and_deviation(&weights, times.iter().map(value)).unwrap();
        // the border between the two lies half-way from 0.995 s to 1.5 s; ends count as their neighbours
        let share = 1.2475 / 4.0;
        let exact = 3.0 - 2.0 * share;
        assert!((mean - exact).abs() < 1e-12, "{mean} {exact}");
        assert!((deviation - 2.0 * (share * (1.0 - share)).sqrt()).abs() < 1e-12, "{deviation}");
        let weights = time_weights(&[0.0, 1.0, 2.0], all);
        let [even, _] = mean_and_deviation(&weights, [1.0, f64::NAN, 4.0].into_iter()).unwrap();
        assert!((even - 2.5).abs() < 1e-15);
        assert_eq!(mean_and_deviation(&[], [].into_iter()), None);
    }

    #[test]
    fn the_weights_of_unevenly_spaced_records_sum_to_the_window_that_they_are_clipped_to() {
        let times = [0.0, 1.0, 1.5, 1.75, 2.0, 4.0];
        for (window, weights) in [
            ([0.75, 1.8], [0.0, 0.5, 0.375, 0.175, 0.0, 0.0]),
            ([1.9, 3.5], [0.0, 0.0, 0.0, 0.0, 1.1, 0.5]),
            ([-9.0, 9.0], [1.0, 0.75, 0.375, 0.25, 1.125, 2.0]),
            ([1.6, 1.6], [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
            ([6.0, 7.0], [0.0; 6]),
        ] {
            let found = time_weights(&times, window);
            let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-14;
            assert!(found.iter().zip(&weights).all(near), "{window:?}: {found:?}");
        }
        assert_eq!(time_weights(&[3.0], [0.0, 1.0]), [1.0]);
        assert!(time_weights(&[], [0.0, 1.0]).is_empty());
    }

    #[test]
    fn zeros_and_huge_values_have_a_place() {
        let mut spread = Spread::default();
        spread.add(1.0, 0.0, 0, 0.0);
        spread.add(1.0, 1e300, 1, 0.0);
        assert_eq!(spread.quantile(0.4), Some(0.0));
        assert_eq!(spread.quantile(1.0), Some(1e300));
        assert_eq!(Spread::default().quantile(0.5), None);
    }
}
