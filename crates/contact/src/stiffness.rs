//! The areal stiffness (N/m^3) of the contact springs and what it is derived from.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

/// Stiffness of a penalty spring, in one of three forms. In a case file they are a number, `{ stiffness = N/m^3 }` and
/// `{ stability = fraction }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stiffness {
    /// A multiple of `K A/V` in each pass (dimensionless), with the bulk modulus `K` (Pa), the area `A` of the master face
    /// and the volume `V` of the element below it; for a brick of depth `d` that is `K/d`. LS-DYNA's scale factor: its
    /// segment stiffness `SF K A^2/V` spread over the segment.
    Factor(f64),
    /// Stiffness per area (N/m^3) of both passes together, the `k_t` of Eq. (10) of Vollebregt (2017); each pass has
    /// half of it.
    Areal(f64),
    /// A fraction of the limit of stability `m* (4/dt^2 - omega_el^2)` (dimensionless) for both passes together, with
    /// `m*` the reduced mass per area of the two surfaces in touch; each pass has half.
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
        #[derive(Deserialize)]
        #[serde(untagged, deny_unknown_fields)]
        #[serde(expecting = "expected a number, { stiffness = N/m^3 } or { stability = fraction }")]
        enum Form {
            Factor(f64),
            Areal { stiffness: f64 },
            Stability { stability: f64 },
        }
        Ok(match Form::deserialize(deserializer)? {
            Form::Factor(factor) => Self::Factor(factor),
            Form::Areal { stiffness } => Self::Areal(stiffness),
            Form::Stability { stability } => Self::Stability(stability),
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

impl Stiffness {
    /// The number that the variant carries.
    pub fn value(self) -> f64 {
        match self {
            Self::Factor(v) | Self::Areal(v) | Self::Stability(v) => v,
        }
    }

    /// Areal stiffness (N/m^3) of one pass.
    ///
    /// `scaled` is `K A/V` of the master face's element (N/m^3), `reduced_mass` is `m*` (kg/m^2).
    /// [`Stiffness::Stability`] without a scale gives zero; the constructors of contact
    /// refuse that combination.
    pub fn per_pass(
        self,
        scaled: f64,
        reduced_mass: f64,
        stability: Option<StabilityScale>,
    ) -> f64 {
        match self {
            Self::Factor(factor) => factor * scaled,
            Self::Areal(both) => 0.5 * both,
            Self::Stability(fraction) => {
                0.5 * fraction * reduced_mass * stability.map_or(0.0, StabilityScale::omega_squared)
            }
        }
    }
}

/// What [`Stiffness::Stability`] is a fraction of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityScale {
    /// Highest angular frequency of the bodies without contact (rad/s).
    pub omega_elastic: f64,
    /// Time step (s).
    pub dt: f64,
}

impl StabilityScale {
    /// `4/dt^2 - omega_el^2` (1/s^2): a spring between surface masses of at most `m*` times this
    /// leaves the time step stable (Rayleigh's bound `omega^2 <= omega_el^2 + k/m*`).
    pub fn omega_squared(self) -> f64 {
        4.0 / (self.dt * self.dt) - self.omega_elastic * self.omega_elastic
    }
}

/// Material of the elements behind a contact surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMaterial {
    /// Bulk modulus (Pa).
    pub bulk_modulus: f64,
    /// Density (kg/m^3).
    pub density: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_form_gives_its_own_areal_stiffness_per_pass() {
        let scale = StabilityScale { omega_elastic: 3.0, dt: 0.4 };
        assert_eq!(Stiffness::Factor(0.1).per_pass(1.75e14, 2.0, None), 0.1 * 1.75e14);
        assert_eq!(Stiffness::Areal(3.5e13).per_pass(1.0, 2.0, None), 1.75e13);
        let fraction = Stiffness::Stability(0.5).per_pass(1.0, 2.0, Some(scale));
        assert!((fraction - 0.5 * 0.5 * 2.0 * (25.0 - 9.0)).abs() < 1e-12);
    }
}
