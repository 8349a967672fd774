//! Axes: range, scale and ticks.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
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

    /// The axis with its ticks; `values` give the range where it has none.
    pub(crate) fn ticked(&self, values: impl Iterator<Item = f64>) -> Ticked {
        let log = self.scale == Scale::Log;
        let [low, high] = self.range.unwrap_or_else(|| {
            let usable = values.filter(|v| v.is_finite() && (!log || *v > 0.0));
            let ends =
                usable.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
            padded(ends, log)
        });
        if log { Ticked::log(low, high) } else { Ticked::linear(low, high) }
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
}

impl Ticked {
    fn linear(low: f64, high: f64) -> Self {
        // 1, 2 or 5 times a power of ten, three to eight ticks
        let rough = (high - low) / 7.0;
        let power = libm::pow(10f64, libm::log10(rough).floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= rough);
        let step = step.unwrap_or(rough);
        let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
        let ticks = (first..=last).map(|i| i as f64 * step).collect();
        let decimals = (-libm::log10(step) + 1e-9).ceil().max(0.0) as usize;
        Self { range: low..high, ticks, log: false, decimals }
    }

    fn log(low: f64, high: f64) -> Self {
        let (low, high) = (libm::log10(low), libm::log10(high));
        let every = ((high - low) / 8.0).ceil().max(1.0) as usize;
        let decades = (low - 1e-9).ceil() as i32..=(high + 1e-9).floor() as i32;
        let ticks = decades.step_by(every).map(f64::from).collect();
        Self { range: low..high, ticks, log: true, decimals: 0 }
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

    /// A value in drawing coordinates; `None` if it is not finite there.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        let place = if self.log { libm::log10(value) } else { value };
        place.is_finite().then_some(place)
    }

    pub(crate) fn label(&self, place: f64) -> String {
        if self.log {
            return format!("10{}", superscript(place.round() as i32));
        }
        if self.decimals > 4 || place.abs() >= 1e5 {
            return format!("{place:.1e}");
        }
        // the tick at zero may carry a sign from rounding
        let place = if place.abs() < 1e-12 { 0.0 } else { place };
        format!("{place:.*}", self.decimals).replace('-', "\u{2212}")
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

impl Ranged for Ticked {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        let share = (value - self.range.start) / (self.range.end - self.range.start);
        // a value far outside may not overflow the drawing
        let share = share.clamp(-10.0, 10.0);
        start + (share * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

impl ValueFormatter<f64> for Ticked {
    fn format_ext(&self, value: &f64) -> String {
        self.label(*value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Ticked) -> Vec<String> {
        axis.ticks.iter().map(|t| axis.label(*t)).collect()
    }

    #[test]
    fn ticks_are_round_numbers_with_the_digits_that_they_need() {
        assert_eq!(
            labels(&Ticked::linear(-1.0, 0.0)),
            ["−1.0", "−0.8", "−0.6", "−0.4", "−0.2", "0.0"]
        );
        assert_eq!(
            labels(&Ticked::linear(0.78, 0.8)),
            ["0.780", "0.785", "0.790", "0.795", "0.800"]
        );
        assert_eq!(labels(&Ticked::log(1e-7, 1e-3)), ["10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"]);
        assert_eq!(labels(&Ticked::log(0.9, 1.1e10)).first().map(String::as_str), Some("10⁰"));
    }

    #[test]
    fn data_without_extent_still_have_an_axis() {
        for axis in [Axis::linear(""), Axis::log("")] {
            for values in [vec![], vec![f64::NAN], vec![3.0]] {
                let ticked = axis.ticked(values.into_iter());
                assert!(ticked.range.start < ticked.range.end, "{ticked:?}");
            }
        }
    }
}
