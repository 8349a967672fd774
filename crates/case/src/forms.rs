//! Values that a case file may write in more than one form.
//!
//! They are read by visitors rather than untagged enums, because an untagged enum forgets where
//! in the file its value stood.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer, MapAccess, Visitor};
use serde::ser::{Serialize, SerializeMap, Serializer};

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
        deserializer.deserialize_any(CrownVisitor)
    }
}

struct CrownVisitor;

impl Visitor<'_> for CrownVisitor {
    type Value = Crown;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a radius in metres or \"flat\"")
    }

    fn visit_f64<E: de::Error>(self, radius: f64) -> Result<Crown, E> {
        Ok(Crown::Radius(radius))
    }

    fn visit_i64<E: de::Error>(self, radius: i64) -> Result<Crown, E> {
        Ok(Crown::Radius(radius as f64))
    }

    fn visit_u64<E: de::Error>(self, radius: u64) -> Result<Crown, E> {
        Ok(Crown::Radius(radius as f64))
    }

    fn visit_str<E: de::Error>(self, word: &str) -> Result<Crown, E> {
        match word {
            "flat" => Ok(Crown::Flat),
            _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
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
    /// A multiple of K/d per pass: LS-DYNA's scale factor (dimensionless).
    Factor(f64),
    /// Areal stiffness, the sum of both passes (N/m^3).
    Areal(f64),
    /// A fraction of the stability limit (dimensionless).
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
        deserializer.deserialize_any(StiffnessVisitor)
    }
}

struct StiffnessVisitor;

impl<'de> Visitor<'de> for StiffnessVisitor {
    type Value = Stiffness;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number, { stiffness = N/m^3 } or { stability = fraction }")
    }

    fn visit_f64<E: de::Error>(self, factor: f64) -> Result<Stiffness, E> {
        Ok(Stiffness::Factor(factor))
    }

    fn visit_i64<E: de::Error>(self, factor: i64) -> Result<Stiffness, E> {
        Ok(Stiffness::Factor(factor as f64))
    }

    fn visit_u64<E: de::Error>(self, factor: u64) -> Result<Stiffness, E> {
        Ok(Stiffness::Factor(factor as f64))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Stiffness, A::Error> {
        let Some(key) = map.next_key::<String>()? else {
            return Err(de::Error::custom(
                "an empty table: expected `stiffness` or `stability` in it",
            ));
        };
        let stiffness = match key.as_str() {
            "stiffness" => Stiffness::Areal(map.next_value()?),
            "stability" => Stiffness::Stability(map.next_value()?),
            other => return Err(de::Error::unknown_field(other, &["stiffness", "stability"])),
        };
        match map.next_key::<String>()? {
            None => Ok(stiffness),
            Some(_) => Err(de::Error::custom("give `stiffness` or `stability`, not both")),
        }
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
