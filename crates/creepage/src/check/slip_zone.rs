//! Statistics of slip over the slip zone: the places along the centre line whose mean slip speed over time
//! is at least a tenth of the largest, on the side where the conditions are enforced.
//!
//! The fluctuation is the difference from the running mean over a tenth of a contact transit, 2a/(10 V), centred
//! on the instant, as in the measure of roughness: the slow change of a run that is not quite steady does not
//! count. Its square is divided by the share that other records have in that mean, (n - 1)/n of n records of
//! equal weight (Bessel's correction), so that it does not depend on the number of records in the span. That span is fixed
//! in space; the share for one fixed in elements, 3 h/V, stands beside it, since the first may be shorter than an element.

use crate::check::centreline::{CentreLine, PLACES, Rows, profile};
use crate::check::correlation::Correlation;
use crate::check::result::{SlipQuantity, SlipStatistic, SlipZoneMeasured};
use crate::check::statistics::mean_and_deviation;
use output::confidence::of_batches;

/// A place slips where its mean slip speed over time is at least this part of the largest such mean.
const SLIPS: f64 = 0.1;

/// Elements of the band that is fixed in elements.
const ELEMENTS: f64 = 3.0;

/// A fluctuating share above this is told. Exact contact with constant friction, damped, has 0.07 to 0.45 on 2 mm, the
/// most at the least slip; undamped up to 0.75; Eq (8) without memory 0.9 and more.
const LARGE_SHARE: f64 = 0.5;

/// Statistics of slip in the zone over a window.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SlipZone {
    /// Indices of its places.
    places: Vec<usize>,
    /// Mean over its places and time (m/s).
    pub mean: f64,
    /// Root mean square of the fluctuation over its places and time (m/s); `None` where the records lie too far
    /// apart.
    pub fluctuation: Option<f64>,
    /// The fluctuation over the root mean square of the slip there.
    pub fluctuating_share: Option<f64>,
    /// The same share with the running mean over the time in which [`ELEMENTS`] elements pass.
    share_of_elements: Option<f64>,
    /// The largest value (m/s).
    pub largest: f64,
    /// Of the fluctuation over the longest row of neighbouring places of the zone.
    correlation: Correlation,
    /// Half widths of the 95 % confidence intervals of mean, fluctuation and share, or the reason why there is none.
    halves: [Result<f64, &'static str>; 3],
    /// Standard deviations over the records of mean, fluctuation and share of single records.
    deviations: [Option<f64>; 3],
}

/// Sums over the zone and records.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    weight: f64,
    slip: f64,
    /// Weight of the records that have others within the span, and for these the squares of the fluctuation and of
    /// the slip.
    among: f64,
    fluctuating: f64,
    all: f64,
}

impl Sums {
    /// The sums over `records` (index, time in s) and `places` of `slip`, `about` its running means with the share of `others`.
    fn over(
        records: &[(usize, f64)],
        places: &[usize],
        slip: &Rows,
        about: &Rows,
        others: &[f64],
    ) -> Self {
        let mut sums = Self::default();
        for &(record, span) in records {
            for &place in places {
                let value = slip[record][place];
                sums.weight += span;
                sums.slip += span * value;
                if others[record] > 0.0 {
                    let away = value - about[record][place];
                    sums.among += span;
                    sums.fluctuating += span * away * away / others[record];
                    sums.all += span * value * value;
                }
            }
        }
        sums
    }

    /// Mean, fluctuation and its share; NaN where there is none.
    fn values(&self) -> [f64; 3] {
        let share = if self.all > 0.0 { (self.fluctuating / self.all).sqrt() } else { f64::NAN };
        [self.slip / self.weight, (self.fluctuating / self.among).sqrt(), share]
    }
}

impl SlipZone {
    /// The slip zone of `line`; `weights` are the times (s) that its records stand for. `None` where nothing slips.
    pub fn of(line: &CentreLine, weights: &[f64]) -> Option<Self> {
        let slip = &line.slip;
        let means = profile(slip, weights);
        let most = means.iter().map(|[mean, _]| *mean).fold(0.0, f64::max);
        let slips = |place: &usize| means[*place][0] >= SLIPS * most;
        let places: Vec<usize> = (0..means.len()).filter(slips).collect();
        if most <= 0.0 {
            return None;
        }
        let span = 0.1 * line.transit();
        let (about, others) = running_means(&line.times, weights, slip, span);
        let over = |records: &[(usize, f64)]| Sums::over(records, &places, slip, &about, &others);
        let whole: Vec<(usize, f64)> = weights.iter().copied().enumerate().collect();
        let sums = over(&whole);
        let [mean, fluctuation, share] = sums.values();
        let span = ELEMENTS * line.size / line.speed;
        let (about_elements, others_elements) = running_means(&line.times, weights, slip, span);
        let [.., share_of_elements] =
            Sums::over(&whole, &places, slip, &about_elements, &others_elements).values();
        let some = |value: f64| Some(value).filter(|value| value.is_finite());
        let counts = slip.iter().zip(weights).filter(|(_, weight)| **weight > 0.0);
        let values = counts.flat_map(|(row, _)| places.iter().map(|&place| row[place]));
        let largest = values.fold(0.0, f64::max);
        // first order: an interval of r^2 is one of r over 2 r; a ratio of means is linearised about its value
        let of_root = |half: f64, root: f64| if half > 0.0 { 0.5 * half / root } else { 0.0 };
        let square = of_batches(weights, |batch| {
            let batch = over(batch);
            batch.fluctuating / batch.among
        });
        let ratio = of_batches(weights, |batch| {
            let batch = over(batch);
            let too_much = batch.fluctuating - sums.fluctuating / sums.all * batch.all;
            too_much / batch.among / (sums.all / sums.among)
        });
        let halves = [
            of_batches(weights, |batch| {
                let batch = over(batch);
                batch.slip / batch.weight
            }),
            square.map(|half| of_root(half, fluctuation)),
            ratio.map(|half| of_root(half, share)),
        ];
        let of_records: Vec<[f64; 3]> = whole.iter().map(|one| over(&[*one]).values()).collect();
        let deviations = [0, 1, 2].map(|i| {
            let values = of_records.iter().map(|values| values[i]);
            mean_and_deviation(weights, values).map(|[_, deviation]| deviation)
        });
        let correlation = correlation(line, &about, &others, &places);
        Some(Self {
            places,
            mean,
            fluctuation: some(fluctuation),
            fluctuating_share: some(share),
            share_of_elements: some(share_of_elements),
            largest,
            correlation,
            halves,
            deviations,
        })
    }

    /// What to try where much of the slip fluctuates.
    pub fn note(&self) -> Option<String> {
        let share = self.fluctuating_share.filter(|share| *share > LARGE_SHARE)?;
        Some(format!(
            "slip fluctuates: what is faster than a tenth of a transit is {:.0} % of its root mean square in the slip zone, \
             and forces may depend on it; compare with constant friction, damp the mesh (damping.kelvin_voigt), give \
             friction a memory (friction.memory), or refine mesh.zone.size",
            100.0 * share
        ))
    }

    /// Its statistics as results; `line` gave the slip.
    pub fn measured(&self, line: &CentreLine) -> SlipZoneMeasured {
        use SlipQuantity as Q;
        let averaged = [
            (Q::Mean, Some(self.mean)),
            (Q::Fluctuation, self.fluctuation),
            (Q::FluctuatingShare, self.fluctuating_share),
        ];
        let averaged = averaged.into_iter().enumerate().map(|(i, (quantity, value))| {
            let note = match (value, self.halves[i]) {
                (None, _) => {
                    Some("the records lie farther apart than a twentieth of a transit".into())
                }
                (Some(_), Err(why)) => Some(format!("no interval: {why}")),
                (Some(_), Ok(_)) => None,
            };
            let statistic = SlipStatistic {
                ci95: self.halves[i].ok().filter(|_| value.is_some()),
                deviation: self.deviations[i],
                note,
                ..SlipStatistic::of(quantity, value)
            };
            (quantity, statistic)
        });
        let others = [
            (Q::Largest, SlipStatistic::of(Q::Largest, Some(self.largest))),
            (
                Q::FluctuatingShareOfElements,
                SlipStatistic::of(Q::FluctuatingShareOfElements, self.share_of_elements),
            ),
        ];
        let Correlation { length, time, wavenumber, frequency } = self.correlation;
        let correlated = [
            (Q::CorrelationLength, length),
            (Q::CorrelationTime, time),
            (Q::MeanWavenumber, wavenumber),
            (Q::MeanFrequency, frequency),
        ];
        let correlated = correlated.into_iter().map(|(quantity, value)| {
            let why = "places or records do not resolve it, are too few, or end before it does";
            let note = value.is_none().then(|| why.to_owned());
            (quantity, SlipStatistic { note, ..SlipStatistic::of(quantity, value) })
        });
        let end = |place: Option<&usize>| place.map(|&place| line.place(place));
        SlipZoneMeasured {
            statistics: averaged.chain(others).chain(correlated).collect(),
            from: end(self.places.first()),
            to: end(self.places.last()),
        }
    }
}

/// The longest row of neighbouring places, of ascending `places`.
fn longest_row(places: &[usize]) -> &[usize] {
    places.chunk_by(|a, b| b - a == 1).max_by_key(|row| row.len()).unwrap_or_default()
}

/// Correlation of what differs from the running means `about`, over the records that have `others` in their span.
fn correlation(line: &CentreLine, about: &Rows, others: &[f64], places: &[usize]) -> Correlation {
    let row = longest_row(places);
    let records = || (0..line.times.len()).filter(|&record| others[record] > 0.0);
    let away = |record: usize| {
        row.iter().map(|&place| line.slip[record][place] - about[record][place]).collect()
    };
    let rows: Rows = records().map(away).collect();
    let times: Vec<f64> = records().map(|record| line.times[record]).collect();
    Correlation::of(&rows, &times, line.place(1) - line.place(0))
}

/// For each record the mean of every place over the records within half of `span` (s) before and after it, and the
/// share of other records in the weight of that mean: zero for a record without others, or without weight.
fn running_means(times: &[f64], weights: &[f64], rows: &Rows, span: f64) -> (Rows, Vec<f64>) {
    // cumulative sums: a mean is a difference of two of them
    let (mut weight, mut sums) = (vec![0.0], vec![vec![0.0; PLACES]]);
    for (row, w) in rows.iter().zip(weights) {
        let before = &sums[sums.len() - 1];
        let next = before.iter().zip(row).map(|(sum, value)| sum + w * value).collect();
        sums.push(next);
        weight.push(weight[weight.len() - 1] + w);
    }
    let slack = 1e-9 * span;
    let mean = |(record, time): (usize, &f64)| -> (Vec<f64>, f64) {
        let from = times.partition_point(|t| *t < time - 0.5 * span - slack);
        let to = times.partition_point(|t| *t <= time + 0.5 * span + slack);
        let whole = weight[to] - weight[from];
        let others = 1.0 - weights[record] / whole;
        if !(whole > 0.0 && others > 1e-9) {
            return (rows[record].clone(), 0.0);
        }
        let of = |place: usize| (sums[to][place] - sums[from][place]) / whole;
        ((0..PLACES).map(of).collect(), others)
    };
    times.iter().enumerate().map(mean).unzip()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A centre line with `count` records of slip by its value at place 0 to 1 and record; a tenth of a transit
    /// takes 20 of them.
    fn line(count: usize, of: impl Fn(f64, usize) -> f64) -> CentreLine {
        let place = |i: usize| i as f64 / (PLACES - 1) as f64;
        let times = (0..count).map(|k| 1e-6 * k as f64).collect();
        let row = |k: usize| (0..PLACES).map(|i| of(place(i), k)).collect();
        CentreLine::planted(times, (0..count).map(row).collect(), 4e-3, 40.0)
    }

    #[test]
    fn places_that_stick_on_the_mean_do_not_count() {
        // stick in the first half but for one instant, slip of 2 m/s in the second
        let slip = line(100, |x, k| if x > 0.5 { 2.0 } else { f64::from(u8::from(k == 7)) });
        let zone = SlipZone::of(&slip, &[1e-6; 100]).unwrap();
        assert_eq!(zone.places.len(), PLACES / 2);
        assert!(
            (zone.mean - 2.0).abs() < 1e-14
                && zone.fluctuation.unwrap() < 1e-7
                && zone.largest == 2.0
        );
        assert_eq!(SlipZone::of(&line(50, |_, _| 0.0), &[1e-6; 50]), None);
    }

    #[test]
    fn what_alternates_from_record_to_record_fluctuates_and_what_changes_slowly_does_not() {
        let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let slip = line(1000, |x, k| 1.0 + x + 1e-3 * k as f64 + 0.3 * sign(k));
        let zone = SlipZone::of(&slip, &[1e-6; 1000]).unwrap();
        assert!((zone.mean - 1.9995).abs() < 1e-3, "{}", zone.mean);
        // 21 records about each: the mean over an odd number of them keeps one of the alternating
        let wanted = 0.3 * (20.0_f64 / 21.0).sqrt();
        assert!((zone.fluctuation.unwrap() - wanted).abs() < 2e-3, "{:?}", zone.fluctuation);
        let [mean, fluctuation, _] = zone.halves;
        assert!(mean.is_err(), "a drift has no mean");
        assert!(fluctuation.unwrap() < 2e-3);
        assert_eq!(zone.note(), None);
        let zone = SlipZone::of(&line(1000, |_, k| 1.0 + 0.8 * sign(k)), &[1e-6; 1000]).unwrap();
        assert!(zone.note().unwrap().contains("is 61 % of its root mean square"));
    }

    #[test]
    fn a_ripple_as_long_as_an_element_counts_among_elements_and_not_in_a_shorter_span() {
        // an element of 1 mm passes in 25 us, a tenth of a transit takes 20
        let ripple = |k: usize| 0.3 * libm::sin(std::f64::consts::TAU * k as f64 / 100.0);
        let slip = line(1000, |_, k| 1.0 + ripple(k));
        let zone = SlipZone::of(&slip, &[1e-6; 1000]).unwrap();
        // a sine less its mean over three of four quarters of its period: 1 - sin(3 pi/4)/(3 pi/4)
        let rms = (1.0_f64 + 0.5 * 0.09).sqrt();
        let kept = 1.0 - libm::sin(0.75 * std::f64::consts::PI) / (0.75 * std::f64::consts::PI);
        let wanted = 0.3 * 0.5_f64.sqrt() * kept / rms;
        assert!((zone.share_of_elements.unwrap() / wanted - 1.0).abs() < 0.03);
        assert!(zone.fluctuating_share.unwrap() < 0.15 * wanted);
    }

    #[test]
    fn bursts_with_rest_between_have_an_interval_that_holds_their_share() {
        // one burst of 5 records in 40, not at the same places of the batches
        let burst = |k: usize| !(k * 7919 / 40).is_multiple_of(3) && (k % 37) < 5;
        let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let slip = line(2000, |_, k| if burst(k) { 1.0 + 0.5 * sign(k) } else { 0.0 });
        let zone = SlipZone::of(&slip, &[1e-6; 2000]).unwrap();
        let [_, deviation, share] = zone.halves;
        let fluctuation = zone.fluctuation.unwrap();
        assert!(deviation.unwrap() < 0.3 * fluctuation, "{deviation:?} {fluctuation}");
        assert!(share.unwrap() < 0.1 && zone.fluctuating_share.unwrap() < 1.0, "{share:?}");
    }

    #[test]
    fn records_too_far_apart_to_show_a_fluctuation_show_none_instead_of_zero() {
        // a transit of 200 us, records every 11
        let mut sparse = line(60, |x, k| 1.0 + x + f64::from(u8::from(k % 2 == 0)));
        sparse.times.iter_mut().for_each(|time| *time *= 11.0);
        let zone = SlipZone::of(&sparse, &[11e-6; 60]).unwrap();
        assert_eq!((zone.fluctuation, zone.fluctuating_share), (None, None));
        assert!((zone.mean - 2.0).abs() < 1e-12);
        let fluctuation = &zone.measured(&sparse).statistics[&SlipQuantity::Fluctuation];
        assert!(fluctuation.note.as_ref().unwrap().contains("farther apart"));
        assert_eq!(fluctuation.ci95, None);
    }

    #[test]
    fn in_another_unit_slip_has_the_same_share_and_interval_of_the_share() {
        let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let burst = |k: usize| if (k % 37) < 5 { 1.0 + 0.5 * sign(k) } else { 0.1 };
        let zone =
            |unit: f64| SlipZone::of(&line(2000, |x, k| unit * (x + burst(k))), &[1e-6; 2000]);
        let [metres, millimetres] = [1.0, 1e3].map(|unit| zone(unit).unwrap());
        let near = |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 1e-9, "{found}");
        near(millimetres.fluctuating_share.unwrap(), metres.fluctuating_share.unwrap());
        near(millimetres.fluctuation.unwrap(), 1e3 * metres.fluctuation.unwrap());
        for (i, factor) in [1e3, 1e3, 1.0].into_iter().enumerate() {
            let half = metres.halves[i].unwrap();
            assert!(half > 0.0);
            near(millimetres.halves[i].unwrap(), factor * half);
        }
    }

    #[test]
    fn a_wave_of_slip_correlates_over_its_length_in_metres_and_its_period_in_seconds() {
        // the line is 8 mm long; 1.6 mm and 10 us, about a mean over two periods
        let (wavelength, period) = (1.6e-3, 10e-6);
        let wave = |x: f64, k: usize| x * 8e-3 / wavelength - 1e-6 * k as f64 / period;
        let slip = line(1000, |x, k| 2.0 + 0.3 * libm::sin(std::f64::consts::TAU * wave(x, k)));
        let found = SlipZone::of(&slip, &[1e-6; 1000]).unwrap().correlation;
        let part = libm::acos(libm::exp(-1.0)) / std::f64::consts::TAU;
        let near = |found: Option<f64>, exact: f64| {
            assert!((found.unwrap() / exact - 1.0).abs() < 0.05, "{found:?} {exact:e}");
        };
        near(found.length, part * wavelength);
        near(found.time, part * period);
        near(found.wavenumber, std::f64::consts::TAU / wavelength);
        near(found.frequency, 1.0 / period);
    }
}
