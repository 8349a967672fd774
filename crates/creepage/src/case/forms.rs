//! Values that a case file may write in more than one form.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, SerializeMap, Serializer};
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

/// Stiffness of a penalty spring, in one of three forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stiffness {
    /// A multiple of K/d in each pass (dimensionless), with the bulk modulus K (Pa) and the thickness d = V/A (m) of
    /// the element below the face: LS-DYNA's scale factor.
    Factor(f64),
    /// Stiffness per area, the sum of both passes (N/m^3).
    Areal(f64),
    /// A fraction of the stiffness at which the time step would be unstable (dimensionless).
    Stability(f64),
}

impl Serialize for Stiffness {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (key, value) = match self {
            Self::Factor(factor) => return serializer.serialize_f64(*factor),
            Self::Areal(stiffness) => ("stiffness", stiffness),
            Self::Stability(fraction) => ("stability", fraction),
        };
        let mut map = serializer.serialize_map(Some(1))?;
        map.serialize_entry(key, value)?;
        map.end()
    }
}

impl<'de> Deserialize<'de> for Stiffness {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        let only = value.as_table().filter(|table| table.len() == 1);
        let form = |name| only.and_then(|table| table.get(name)).and_then(float);
        let areal = || form("stiffness").map(Self::Areal);
        let stability = || form("stability").map(Self::Stability);
        let stiffness = float(&value).map(Self::Factor).or_else(areal).or_else(stability);
        stiffness.ok_or_else(|| {
            D::Error::custom("expected a number, { stiffness = N/m^3 } or { stability = fraction }")
        })
    }
}

impl JsonSchema for Stiffness {
    fn schema_name() -> Cow<'static, str> {
        "Stiffness".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let one_key = |key: &str| {
            json_schema!({
                "type": "object",
                "properties": { key: { "type": "number" } },
                "required": [key],
                "additionalProperties": false
            })
        };
        json_schema!({
            "oneOf": [{ "type": "number" }, one_key("stiffness"), one_key("stability")]
        })
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
