//! Axes: range, scale and ticks.

use crate::chart::label::minus;
use std::ops::Range;

/// An axis with its label, which names the unit.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Label, for example `t (s)`.
    pub label: String,
    /// Ends in the unit of the axis, the lower first, both positive on a logarithmic axis; `None` takes them from
    /// the data.
    pub range: Option<[f64; 2]>,
    /// Linear or logarithmic.
    pub scale: Scale,
}

/// Scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Linear.
    Linear,
    /// Logarithmic; values of zero or less are not drawn.
    Log,
}

impl Axis {
    /// A linear axis over the data.
    pub fn linear(label: &str) -> Self {
        Self { label: label.into(), range: None, scale: Scale::Linear }
    }

    /// A logarithmic axis over the data.
    pub fn log(label: &str) -> Self {
        Self { label: label.into(), range: None, scale: Scale::Log }
    }

    /// The same axis from `low` to `high`, see [`range`](Self::range).
    pub fn over(self, low: f64, high: f64) -> Self {
        Self { range: Some([low, high]), ..self }
    }

    /// The axis with its ticks, between which there are about `most` intervals at most; `values` give the range
    /// where it has none.
    pub(crate) fn ticked(&self, values: impl Iterator<Item = f64>, most: usize) -> Ticked {
        let log = self.scale == Scale::Log;
        let [low, high] = self.range.unwrap_or_else(|| {
            let usable = values.filter(|v| v.is_finite() && (!log || *v > 0.0));
            let ends =
                usable.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
            padded(ends, log)
        });
        if log { Ticked::log(low, high, most) } else { Ticked::linear(low, high, most) }
    }
}

/// The ends of the data with a margin around them; a default range where there are no data.
fn padded([low, high]: [f64; 2], log: bool) -> [f64; 2] {
    match (low <= high, log) {
        (false, true) => [1.0, 10.0],
        (false, false) => [0.0, 1.0],
        (true, true) => [low / 1.2, high * 1.2],
        (true, false) => {
            let margin = if high > low { 0.04 * (high - low) } else { 0.5 * low.abs().max(1.0) };
            [low - margin, high + margin]
        }
    }
}

/// An axis with its ticks, in drawing coordinates: the values, or their logarithms to base 10.
#[derive(Clone, Debug)]
pub(crate) struct Ticked {
    range: Range<f64>,
    ticks: Vec<f64>,
    log: bool,
    decimals: usize,
    /// About the most intervals between ticks.
    most: usize,
}

/// Fewest ticks of an axis: two show no scale.
const FEWEST: usize = 3;

impl Ticked {
    fn linear(low: f64, high: f64, most: usize) -> Self {
        let (ticks, step) = round_numbers(low, high, most);
        let decimals = (-libm::log10(step) - 1e-9).ceil().max(0.0) as usize;
        Self { range: low..high, ticks, log: false, decimals, most }
    }

    /// Powers of ten; 1, 2 and 5 times those where they are too few; any round numbers where these are too.
    fn log(low: f64, high: f64, most: usize) -> Self {
        let [from, to] = [low, high].map(libm::log10);
        let every = ((to - from) / (most + 1) as f64).ceil().max(1.0) as usize;
        let decades = |slack: f64| (from - slack).ceil() as i32..=(to + slack).floor() as i32;
        let powers: Vec<f64> = decades(1e-9).step_by(every).map(f64::from).collect();
        let between = || {
            let inside = |place: &f64| (from - 1e-9..=to + 1e-9).contains(place);
            let of = |power| [1.0, 2.0, 5.0].map(|m| f64::from(power) + libm::log10(m));
            decades(1.0).flat_map(of).filter(inside).collect::<Vec<_>>()
        };
        let numbers = || round_numbers(low, high, most).0.into_iter().map(libm::log10).collect();
        let enough = |ticks: &Vec<f64>| ticks.len() >= FEWEST;
        let ticks = Some(powers).filter(enough).or_else(|| Some(between()).filter(enough));
        let ticks = ticks.unwrap_or_else(numbers);
        Self { range: from..to, ticks, log: true, decimals: 0, most }
    }

    /// A linear axis with a range that is `factor` times as wide around the same middle; a logarithmic one as it is.
    pub(crate) fn widened(&self, factor: f64) -> Self {
        if self.log || factor <= 1.0 {
            return self.clone();
        }
        let more = 0.5 * (factor - 1.0) * (self.high() - self.low());
        Self::linear(self.low() - more, self.high() + more, self.most)
    }

    /// Where the ticks are, in drawing coordinates.
    pub(crate) fn ticks(&self) -> &[f64] {
        &self.ticks
    }

    pub(crate) fn low(&self) -> f64 {
        self.range.start
    }

    pub(crate) fn high(&self) -> f64 {
        self.range.end
    }

    /// The scale and the ends in drawing coordinates, as the attributes of [`group`](crate::chart::group) have them.
    pub(crate) fn described(&self) -> String {
        let scale = if self.log { "log" } else { "linear" };
        format!("{scale} {} {}", self.low(), self.high())
    }

    /// A value in drawing coordinates; `None` if it is not finite there.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        let place = if self.log { libm::log10(value) } else { value };
        place.is_finite().then_some(place)
    }

    /// Where a place is between the ends of the axis: 0 at the lower, 1 at the upper; a value far outside is at -10
    /// or 10, so that it cannot overflow the drawing.
    pub(crate) fn share(&self, place: f64) -> f64 {
        ((place - self.low()) / (self.high() - self.low())).clamp(-10.0, 10.0)
    }

    pub(crate) fn label(&self, place: f64) -> String {
        if self.log {
            return logarithmic(place, self.ticks.iter().all(|tick| is_whole(*tick)));
        }
        // the tick at zero may carry a sign and a rest from rounding
        let place = if place.abs() < 1e-9 * (self.high() - self.low()) { 0.0 } else { place };
        if place == 0.0 && self.decimals > 4 {
            return "0".into();
        }
        if self.decimals > 4 || place.abs() >= 1e5 {
            let sign = if place < 0.0 { "\u{2212}" } else { "" };
            return format!("{sign}{}", logarithmic(libm::log10(place.abs()), false));
        }
        minus(&format!("{place:.*}", self.decimals))
    }
}

/// At least [`FEWEST`] multiples of 1, 2 or 5 times a power of ten from `low` to `high`, with about `most` intervals
/// between them at most, and the interval.
fn round_numbers(low: f64, high: f64, most: usize) -> (Vec<f64>, f64) {
    let rough = (high - low) / most as f64;
    let power = libm::pow(10f64, libm::log10(rough).floor());
    let steps = [10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1].map(|m| m * power);
    // the least step of those that are large enough, then those that give more ticks
    let first = steps.iter().rposition(|step| *step >= rough * (1.0 - 1e-9)).unwrap_or(0);
    let ticks = |step: f64| {
        let (first, last) =
            ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
        (first..=last).map(|i| i as f64 * step).collect::<Vec<_>>()
    };
    let found = steps[first..].iter().map(|step| (ticks(*step), *step));
    found.clone().find(|(ticks, _)| ticks.len() >= FEWEST).unwrap_or((ticks(rough), rough))
}

fn is_whole(value: f64) -> bool {
    (value - value.round()).abs() < 1e-9
}

/// A number by its logarithm: as a power of ten where all ticks are `powers`, else in digits as far as these are few.
fn logarithmic(place: f64, powers: bool) -> String {
    let power = (place + 1e-9).floor();
    let significand = (libm::pow(10.0, place - power) * 1e3).round() / 1e3;
    let raised = format!("10{}", superscript(power as i32));
    match () {
        () if powers => raised,
        () if (-3.0..4.0).contains(&power) => {
            // as many digits as the significand has
            let digits = format!("{significand}").len().saturating_sub(2) as i32;
            let decimals = (digits - power as i32).max(0) as usize;
            format!("{:.decimals$}", significand * libm::pow(10.0, power))
        }
        () if significand == 1.0 => raised,
        () => format!("{significand}\u{b7}{raised}"),
    }
}

fn superscript(n: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    };
    n.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Ticked) -> Vec<String> {
        axis.ticks.iter().map(|t| axis.label(*t)).collect()
    }

    #[test]
    fn ticks_are_round_numbers_with_the_digits_that_they_need() {
        let linear = |low, high| labels(&Ticked::linear(low, high, 7));
        assert_eq!(linear(-1.0, 0.0), ["−1.0", "−0.8", "−0.6", "−0.4", "−0.2", "0.0"]);
        assert_eq!(linear(0.78, 0.8), ["0.780", "0.785", "0.790", "0.795", "0.800"]);
        assert_eq!(labels(&Ticked::linear(0.0, 0.5, 4)), ["0.0", "0.2", "0.4"]);
        assert_eq!(linear(0.0, 0.31), ["0.00", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30"]);
        assert_eq!(linear(0.0, 0.5), ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(linear(0.0, 5.0), ["0", "1", "2", "3", "4", "5"]);
    }

    #[test]
    fn a_logarithmic_axis_shows_powers_of_ten_and_over_a_few_decades_numbers_between() {
        let log = |low, high| labels(&Ticked::log(low, high, 7));
        assert_eq!(log(1e-7, 1e-3), ["10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"]);
        assert_eq!(log(0.9, 1.1e10).first().map(String::as_str), Some("10⁰"));
        assert_eq!(log(0.45, 4.4), ["0.5", "1", "2"]);
        assert_eq!(log(2e-5, 1e-4), ["2·10⁻⁵", "5·10⁻⁵", "10⁻⁴"]);
        assert_eq!(log(0.0021, 0.0039), ["0.0025", "0.003", "0.0035"]);
    }

    #[test]
    fn every_axis_has_at_least_three_ticks() {
        for low in [-3.0, 0.0, 0.7, 12.3] {
            for span in [1e-3, 0.11, 0.24, 0.5, 0.99, 3.0, 77.0, 1e4] {
                for most in [4, 7] {
                    let linear = Ticked::linear(low, low + span, most);
                    assert!((3..=most + 2).contains(&linear.ticks.len()), "{linear:?}");
                    let log = Ticked::log(0.1 + low.abs(), 0.1 + low.abs() + span, most);
                    assert!((3..=most + 2).contains(&log.ticks.len()), "{log:?}");
                }
            }
        }
    }

    #[test]
    fn data_without_extent_still_have_an_axis() {
        for axis in [Axis::linear(""), Axis::log("")] {
            for values in [vec![], vec![f64::NAN], vec![3.0]] {
                let ticked = axis.ticked(values.into_iter(), 7);
                assert!(ticked.range.start < ticked.range.end, "{ticked:?}");
            }
        }
    }
}
