//! Values that a case file may write in more than one form.

use std::borrow::Cow;

pub use contact::Stiffness;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};
use toml::Value;

/// Transverse shape of a running surface: `"flat"`, or the radius of its crown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crown {
    /// Straight across.
    Flat,
    /// A circular arc of this radius (m).
    Radius(f64),
}

impl Crown {
    /// Transverse curvature (1/m); zero when flat.
    pub fn curvature(self) -> f64 {
        match self {
            Self::Flat => 0.0,
            Self::Radius(radius) => 1.0 / radius,
        }
    }

    /// Radius of the crown (m), if there is one.
    pub fn radius(self) -> Option<f64> {
        match self {
            Self::Flat => None,
            Self::Radius(radius) => Some(radius),
        }
    }
}

impl Serialize for Crown {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Flat => serializer.serialize_str("flat"),
            Self::Radius(radius) => serializer.serialize_f64(*radius),
        }
    }
}

impl<'de> Deserialize<'de> for Crown {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Value::deserialize(deserializer)? {
            Value::String(word) if word == "flat" => Ok(Self::Flat),
            value => float(&value)
                .map(Self::Radius)
                .ok_or_else(|| D::Error::custom("expected a radius in metres or \"flat\"")),
        }
    }
}

impl JsonSchema for Crown {
    fn schema_name() -> Cow<'static, str> {
        "Crown".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "oneOf": [{ "type": "number" }, { "const": "flat" }] })
    }
}

/// The number that a value holds, written as a float or as an integer; none for any other value.
pub fn float(value: &Value) -> Option<f64> {
    match value {
        Value::Float(x) => Some(*x),
        Value::Integer(n) => Some(*n as f64),
        _ => None,
    }
}

/// The number that a value holds, if it is whole and at least 0, written as an integer or as a float such as `1e2`; none
/// for any other value.
pub fn whole(value: &Value) -> Option<u64> {
    /// Every whole number up to this is a float.
    const LARGEST: f64 = 9_007_199_254_740_992.0;
    match value {
        Value::Integer(n) => u64::try_from(*n).ok(),
        Value::Float(x) if x.fract() == 0.0 && (0.0..=LARGEST).contains(x) => Some(*x as u64),
        _ => None,
    }
}
