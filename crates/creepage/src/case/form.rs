//! What a key may hold.

use std::fmt;

use friction::Table;
use mesh::profile::STANDARD_PROFILES;
use toml::Value;

use crate::case::irregularity::{self, Coordinate};
use crate::case::value::{float, number, points, quoted, show, whole};

/// A range of numbers, both ends included. Its ends are finite, and above zero where zero has no meaning: a number that is
/// merely above zero may be too small to be reckoned with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Whether zero is allowed below the lower end, and stands for none.
    pub or_zero: bool,
}

impl Range {
    /// Whether `x` lies in the range; NaN lies in none.
    pub fn holds(&self, x: f64) -> bool {
        (self.low..=self.high).contains(&x) || (self.or_zero && x == 0.0)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "at least {} and at most {}", number(self.low), number(self.high))
    }
}

pub(crate) const fn within(low: f64, high: f64) -> Range {
    Range { low, high, or_zero: false }
}

pub(crate) const fn none_or_within(low: f64, high: f64) -> Range {
    Range { or_zero: true, ..within(low, high) }
}

/// The three forms of a penalty stiffness: name (empty for the plain number), range, unit.
pub const STIFFNESS: [(&str, Range, &str); 3] = [
    ("", within(1e-4, 100.0), "-"),
    ("stiffness", within(1.0, 1e18), "N/m^3"),
    ("stability", within(1e-4, 2.0), "-"),
];

/// No point of a profile is farther from its origin (m).
const LARGEST_PROFILE: f64 = 1.0;

/// What kind of value a key holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A number in a range.
    Number(Range),
    /// A whole number from the first to the second.
    Count(u64, u64),
    /// `true` or `false`.
    Flag,
    /// One of these words.
    Word(&'static [&'static str]),
    /// `true`, `false` or a list of these words.
    Words(&'static [&'static str]),
    /// Any text.
    Text,
    /// `"flat"` or a radius in the range.
    Crown(Range),
    /// A penalty stiffness in one of its three forms.
    Stiffness,
    /// A number in the range, or a list of pairs of a time and such a number.
    OverTime(Range),
    /// A list of pairs of numbers in the range.
    Points(Range),
    /// A curve: pairs of numbers in the first and in the second range, the first of them rising from 0. In a file it may
    /// be the path of another file.
    Curve(Range, Range),
    /// The name of a standard's profile, or a list of points [y, z] in m. In a file it may be the path of another file.
    Profile,
    /// Heights over a coordinate of a surface: a formula, points or a grid. In a file they may be the path of another file.
    Heights(Coordinate),
}

impl Form {
    /// What the form allows, as a noun phrase; `unit` is that of the key.
    pub fn allowed(&self, unit: &str) -> String {
        let unit = match unit {
            "" | "-" => String::new(),
            unit => format!(" {unit}"),
        };
        match self {
            Self::Number(range) => {
                let none = if range.or_zero { "0, or " } else { "" };
                format!("{none}a number {range}{unit}")
            }
            Self::Count(low, high) => format!("a whole number from {low} to {high}"),
            Self::Flag => "true or false".into(),
            Self::Word(words) => quoted(words),
            Self::Words(words) => format!("true or false, or a list of {}", quoted(words)),
            Self::Text => "text in quotes".into(),
            Self::Crown(range) => format!("\"flat\" or a number {range}{unit}"),
            Self::Stiffness => {
                let [factor, areal, stability] = STIFFNESS.map(|(_, range, _)| range);
                format!(
                    "a number {factor}, {{ stiffness = ... }} {areal} N/m^3, or {{ stability = ... }} {stability}"
                )
            }
            Self::Curve(speed, mu) => format!(
                "the path of a CSV file or a list of pairs [slip velocity {speed} m/s, coefficient {mu}]"
            ),
            Self::OverTime(range) => format!(
                "a number {range}{unit}, or a list of pairs [time, number], times in s rising from 0"
            ),
            Self::Points(range) => format!("a list of pairs of numbers {range}{unit}"),
            Self::Heights(over) => over.allowed(),
            Self::Profile => {
                "\"60E1\" (a rail), \"S1002\" (a wheel), the path of a file in mm, or a list of pairs [y, z] in m".into()
            }
        }
    }

    /// Why a value is not of this form, if it is not: the value, then what is wrong with it, or what is allowed.
    pub fn mistake(&self, unit: &str, value: &Value) -> Option<String> {
        let problem = match (self, points::<2>(value)) {
            (Self::OverTime(range), Some(points)) => not_over_time(&points, *range),
            (Self::Curve(speeds, mu), Some(points)) => not_a_curve(points, *speeds, *mu),
            (Self::Heights(over), _) if irregularity::is_written(value) => {
                irregularity::mistake(value, *over)
            }
            _ if self.holds(value) => None,
            _ => return Some(format!("{} must be {}", show(value), self.allowed(unit))),
        };
        problem.map(|problem| format!("{}: {problem}", show(value)))
    }

    /// Whether a value is of this form, but for lists whose points are to be looked at one by one.
    fn holds(&self, value: &Value) -> bool {
        let lies_in = |range: &Range| float(value).is_some_and(|x| range.holds(x));
        match (self, value) {
            (Self::Crown(_), Value::String(word)) => word == "flat",
            (Self::Number(range) | Self::Crown(range) | Self::OverTime(range), _) => lies_in(range),
            (Self::Count(low, high), _) => {
                whole(value).is_some_and(|n| (*low..=*high).contains(&n))
            }
            (Self::Flag | Self::Words(_), Value::Boolean(_)) | (Self::Text, Value::String(_)) => {
                true
            }
            (Self::Word(words), Value::String(word)) => words.contains(&word.as_str()),
            (Self::Words(words), Value::Array(list)) => {
                list.iter().all(|word| word.as_str().is_some_and(|word| words.contains(&word)))
            }
            (Self::Stiffness, Value::Table(table)) => {
                let named = |(name, range, _): &(&str, Range, _)| {
                    table.get(*name).and_then(float).is_some_and(|x| range.holds(x))
                };
                table.len() == 1 && STIFFNESS.iter().any(named)
            }
            (Self::Stiffness, _) => lies_in(&STIFFNESS[0].1),
            (Self::Profile, Value::String(name)) => STANDARD_PROFILES.contains(&name.as_str()),
            (Self::Profile, _) => points::<2>(value)
                .is_some_and(|points| points.iter().flatten().all(|x| x.abs() <= LARGEST_PROFILE)),
            (Self::Points(range), _) => points::<2>(value)
                .is_some_and(|points| points.iter().flatten().all(|x| range.holds(*x))),
            _ => false,
        }
    }
}

/// Why points are no curve whose coordinates lie in the two ranges, if they are none.
fn not_a_curve(points: Vec<[f64; 2]>, speeds: Range, coefficients: Range) -> Option<String> {
    let beyond = |&[speed, mu]: &[f64; 2]| !(speeds.holds(speed) && coefficients.holds(mu));
    let Some(at) = points.iter().position(beyond) else {
        return Table::new(points).err().map(|error| error.to_string());
    };
    let ([speed, mu], point) = (points[at].map(number), at + 1);
    Some(format!(
        "point {point}, slip velocity {speed} m/s and coefficient {mu}: the first must be {speeds} m/s, the second \
         {coefficients}"
    ))
}

/// Times of a table over time (s).
const TIMES: Range = within(0.0, 10.0);

/// Why pairs of time and value are no table over time, if they are none; values lie in `range`.
fn not_over_time(points: &[[f64; 2]], range: Range) -> Option<String> {
    if points.len() < 2 {
        let problem =
            "a table over time needs two points or more; give what stays the same as a number";
        return Some(problem.into());
    }
    let mut before: Option<f64> = None;
    for (i, &[time, value]) in points.iter().enumerate() {
        let (point, [t, x]) = (i + 1, [time, value].map(number));
        if !(TIMES.holds(time) && range.holds(value)) {
            return Some(format!(
                "point {point}, time {t} s and value {x}: the first must be {TIMES} s, the second {range}"
            ));
        }
        match before {
            None if time != 0.0 => {
                return Some(format!(
                    "its first point is at {t} s, which must be 0, the start of rolling"
                ));
            }
            Some(before) if time <= before => {
                let before = number(before);
                return Some(format!(
                    "point {point} is at {t} s, which must be after the point before, at {before} s"
                ));
            }
            _ => before = Some(time),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_are_no_table_over_time_are_told_with_their_number() {
        let range = within(-0.5, 0.5);
        for (points, words) in [
            (&[[0.0, 0.1]][..], "two points or more"),
            (&[], "two points or more"),
            (&[[0.1, 0.0], [0.2, 0.1]], "first point is at 0.1 s, which must be 0"),
            (&[[0.0, 0.0], [0.2, 0.1], [0.2, 0.0]], "point 3 is at 0.2 s"),
            (&[[0.0, 0.0], [0.2, 0.1], [0.1, 0.0]], "after the point before, at 0.2 s"),
            (&[[0.0, 0.0], [0.2, 0.6]], "point 2, time 0.2 s and value 0.6"),
            (&[[0.0, f64::NAN], [0.2, 0.1]], "point 1, time 0 s and value NaN"),
            (&[[0.0, 0.0], [f64::NAN, 0.1]], "point 2, time NaN s"),
            (&[[0.0, 0.0], [f64::INFINITY, 0.1]], "point 2, time inf s"),
            (&[[-1.0, 0.0], [0.2, 0.1]], "point 1, time -1 s"),
        ] {
            let problem = not_over_time(points, range).unwrap_or_default();
            assert!(problem.contains(words), "{points:?}: {problem}");
        }
        assert_eq!(not_over_time(&[[0.0, 0.1], [1e-6, -0.5], [10.0, 0.0]], range), None);
    }
}
