//! Values that a case file may write in more than one form.

use std::borrow::Cow;
use std::sync::Arc;

use mesh::profile::{
    Profile, ProfileBody, ProfileError, STANDARD_PROFILES, rail_60e1, smoothed, wheel_s1002,
};
use output::FieldSpec;
use output::layout::BODIES;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use toml::Value;

use crate::case::section::words;
use crate::case::value::{float, listed, points};

/// Transverse shape of a running surface: `"flat"`, or the radius of its crown.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Value", into = "Value")]
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

impl From<Crown> for Value {
    fn from(crown: Crown) -> Self {
        crown.radius().map_or_else(|| "flat".into(), Self::from)
    }
}

impl TryFrom<Value> for Crown {
    type Error = &'static str;

    fn try_from(value: Value) -> Result<Self, &'static str> {
        match (float(&value), value.as_str()) {
            (Some(radius), _) => Ok(Self::Radius(radius)),
            (None, Some("flat")) => Ok(Self::Flat),
            _ => Err("expected a radius in metres or \"flat\""),
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

/// A transverse profile in the place of a crown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ProfileShape {
    /// That of a standard, by its name.
    Standard(String),
    /// A smooth curve through points (y, z) (m), y away from the middle of the track and z down.
    Points(Vec<[f64; 2]>),
}

impl ProfileShape {
    /// The profile of a body.
    ///
    /// # Errors
    /// Points that make no profile, or the name of the other body's.
    pub fn profile(&self, body: ProfileBody) -> Result<Profile, ProfileError> {
        let standard = |of: ProfileBody, profile: fn() -> Profile| match of == body {
            true => Ok(profile()),
            false => Err(ProfileError::Body { found: of, wanted: body }),
        };
        match self {
            Self::Standard(name) if name == STANDARD_PROFILES[0] => {
                standard(ProfileBody::Rail, rail_60e1)
            }
            Self::Standard(_) => standard(ProfileBody::Wheel, wheel_s1002),
            Self::Points(points) => smoothed(points),
        }
    }
}

/// The creepage that drives a disk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Value", into = "Value")]
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

impl From<Creepage> for Value {
    fn from(creepage: Creepage) -> Self {
        match creepage {
            Creepage::Number(creepage) => creepage.into(),
            Creepage::Table(points) => listed(&points),
        }
    }
}

impl TryFrom<Value> for Creepage {
    type Error = &'static str;

    fn try_from(value: Value) -> Result<Self, &'static str> {
        match (float(&value), points(&value)) {
            (Some(creepage), _) => Ok(Self::Number(creepage)),
            (None, Some(points)) => Ok(Self::Table(points.into())),
            _ => Err("expected a number or pairs [time, creepage]"),
        }
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

words! {
    /// A stress of the elements, tension positive.
    StressField {
        /// The tensor, xx yy zz xy yz xz.
        #[default]
        Tensor = "tensor",
        /// Von Mises stress.
        VonMises = "von_mises",
        /// Largest shear stress.
        MaxShear = "max_shear",
        /// Hydrostatic stress.
        Hydrostatic = "hydrostatic",
        /// Principal stresses, the largest first.
        Principal = "principal",
    }
}

impl StressField {
    /// All, in the order of the file.
    pub const ALL: [Self; 5] =
        [Self::Tensor, Self::VonMises, Self::MaxShear, Self::Hydrostatic, Self::Principal];

    /// Its dataset.
    pub fn dataset(self) -> &'static FieldSpec {
        match self {
            Self::Tensor => &BODIES.stress,
            Self::VonMises => &BODIES.von_mises,
            Self::MaxShear => &BODIES.max_shear,
            Self::Hydrostatic => &BODIES.hydrostatic,
            Self::Principal => &BODIES.principal,
        }
    }
}

/// Which stresses a run writes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum StressOutput {
    /// The tensor and von Mises stress, or none.
    Usual(bool),
    /// These.
    These(Vec<StressField>),
}

impl StressOutput {
    /// Those that are written, in the order of the file.
    pub fn written(&self) -> impl Iterator<Item = StressField> {
        let wanted = |field: &StressField| match self {
            Self::Usual(all) => {
                *all && [StressField::Tensor, StressField::VonMises].contains(field)
            }
            Self::These(these) => these.contains(field),
        };
        StressField::ALL.into_iter().filter(wanted)
    }
}
