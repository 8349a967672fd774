//! Creepage as a number, or as a table over time.

use std::borrow::Cow;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};
use toml::Value;

use crate::case::forms::float;
use crate::case::key::{Range, number, within};
use crate::case::layers::{Layers, get};

const KEY: &str = "drive.creepage";
const RAMP: &str = "drive.ramp";

/// Times of a table (s).
const TIMES: Range = within(0.0, 10.0);

/// The creepage that drives a disk.
#[derive(Clone, Debug, PartialEq)]
pub enum Creepage {
    /// The same all the time, once it has risen over `drive.ramp`.
    Number(f64),
    /// Points (s of rolling, creepage), the first at 0 and each later than the one before: linear between them, constant
    /// after the last.
    Table(Arc<[[f64; 2]]>),
}

impl Creepage {
    /// Its largest size.
    pub fn largest(&self) -> f64 {
        match self {
            Self::Number(creepage) => creepage.abs(),
            Self::Table(points) => points.iter().fold(0.0, |most, [_, x]| most.max(x.abs())),
        }
    }

    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(creepage) => Some(*creepage),
            Self::Table(_) => None,
        }
    }

    /// Whether it is a table with a change after the time `time` (s).
    pub(crate) fn changes_after(&self, time: f64) -> bool {
        match self {
            Self::Number(_) => false,
            Self::Table(points) => {
                points.windows(2).any(|pair| pair[1][0] > time && pair[1][1] != pair[0][1])
            }
        }
    }
}

impl Serialize for Creepage {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(creepage) => serializer.serialize_f64(*creepage),
            Self::Table(points) => serializer.collect_seq(points.iter()),
        }
    }
}

impl<'de> Deserialize<'de> for Creepage {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        let table = || crate::case::table::points(value.as_array()?);
        let creepage = float(&value).map(Self::Number);
        creepage
            .or_else(|| Some(Self::Table(table()?.into())))
            .ok_or_else(|| D::Error::custom("expected a number or pairs [time, creepage]"))
    }
}

impl JsonSchema for Creepage {
    fn schema_name() -> Cow<'static, str> {
        "Creepage".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let pair = json_schema!({
            "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2
        });
        json_schema!({
            "oneOf": [{ "type": "number" }, { "type": "array", "items": pair, "minItems": 2 }]
        })
    }
}

/// Why pairs of time and value are no table over time, if they are none; values lie in `range`.
pub(crate) fn mistake(points: &[[f64; 2]], range: Range) -> Option<String> {
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

/// Removes a ramp that the layers below a table give, unless lateral creepage or spin rise over it: the table says all.
pub(crate) fn drop_ramp(layers: &mut Layers) {
    let table = get(&layers.table, KEY).is_some_and(Value::is_array);
    let number = |path| get(&layers.table, path).and_then(float).unwrap_or(0.0);
    let rises = ["drive.lateral_creepage", "drive.spin"].into_iter().any(|key| number(key) != 0.0);
    let heights = [RAMP, KEY].map(|key| layers.origins.get(key).map(|at| layers.height(at)));
    if table && !rises && heights[0] < heights[1] {
        layers.drop_key(RAMP);
    }
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
            let problem = mistake(points, range).unwrap_or_default();
            assert!(problem.contains(words), "{points:?}: {problem}");
        }
        assert_eq!(mistake(&[[0.0, 0.1], [1e-6, -0.5], [10.0, 0.0]], range), None);
    }
}
