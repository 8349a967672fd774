//! The parameters of Table 1, and those of the methods that are not in the paper.

use crate::State;
use friction::{Exponential, FrictionLaw, Memory};
use std::sync::Arc;
use thiserror::Error;

/// Parameters of the slider; the default is Table 1.
#[derive(Clone, Debug)]
pub struct Parameters {
    /// Velocity of the belt v_ref (m/s); its sign is the direction.
    pub belt: f64,
    /// Normal force F_n (N).
    pub normal_force: f64,
    /// Mass m (kg).
    pub mass: f64,
    /// Spring k_spring (N/m).
    pub spring: f64,
    /// Damper c_damp (N s/m).
    pub damping: f64,
    /// Slip speed s_adhes below which the friction force is linear in the slip velocity, Eq (18) (m/s).
    pub adhesion: f64,
    /// Coefficient of friction mu(s); Eq (17) in the paper.
    pub law: Arc<dyn FrictionLaw>,
    /// Stiffness k_t of the friction spring of the penalty method (N/m).
    pub stiffness: f64,
    /// Memory of the coefficient of friction, of [`crate::Method::Memory`].
    pub memory: Memory,
    /// Time step (s).
    pub dt: f64,
    /// End of the simulated time (s).
    pub end: f64,
    /// Position at t = 0 (m).
    pub x0: f64,
    /// Velocity at t = 0 (m/s).
    pub v0: f64,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            belt: -1.0,
            normal_force: 20.0,
            mass: 0.01,
            spring: 10.0,
            damping: 0.04,
            adhesion: 1e-3,
            law: Arc::new(Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 }),
            stiffness: 1e6,
            memory: Memory::default(),
            dt: 1e-4,
            end: 5.0,
            x0: 0.0,
            v0: -1.0,
        }
    }
}

/// Most steps of a run, `end/dt`: about a minute of the explicit method.
pub const MOST_STEPS: f64 = 1e10;

/// A parameter outside its range.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{key} = {} {unit} is out of range: it must be {allowed}", short(*value))]
pub struct ParameterError {
    /// Name of the parameter, as in a parameter file.
    pub key: &'static str,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What is allowed.
    pub allowed: String,
}

impl ParameterError {
    /// That a parameter is out of its range, both ends included, if it is.
    ///
    /// # Errors
    /// The parameter.
    pub fn unless_within(
        [low, high]: [f64; 2],
        key: &'static str,
        value: f64,
        unit: &'static str,
    ) -> Result<(), Self> {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        let allowed = format!("from {} to {}", short(low), short(high));
        Err(Self { key, value, unit, allowed })
    }
}

/// A number with or without an exponent, whichever is shorter.
fn short(x: f64) -> String {
    let [plain, power] = [format!("{x}"), format!("{x:e}")];
    if power.len() < plain.len() { power } else { plain }
}

/// The ranges of the parameters, both ends included: key, unit, least and largest value.
const RANGES: [(&str, &str, f64, f64); 13] = [
    ("belt", "m/s", -1e4, 1e4),
    ("normal_force", "N", 0.0, 1e8),
    ("mass", "kg", 1e-12, 1e6),
    ("spring", "N/m", 0.0, 1e12),
    ("damping", "N s/m", 0.0, 1e9),
    ("adhesion", "m/s", 1e-12, 100.0),
    ("stiffness", "N/m", 1e-6, 1e15),
    ("memory_distance", "m", 1e-12, 1.0),
    ("memory_floor", "m/s", 0.0, 100.0),
    ("dt", "s", 1e-12, 10.0),
    ("t_end", "s", 1e-12, 1e6),
    ("x0", "m", -1e4, 1e4),
    ("v0", "m/s", -1e4, 1e4),
];

impl Parameters {
    /// A parameter by its key.
    fn get(&self, key: &str) -> Option<f64> {
        Some(match key {
            "belt" => self.belt,
            "normal_force" => self.normal_force,
            "mass" => self.mass,
            "spring" => self.spring,
            "damping" => self.damping,
            "adhesion" => self.adhesion,
            "stiffness" => self.stiffness,
            "memory_distance" => self.memory.distance,
            "memory_floor" => self.memory.floor,
            "dt" => self.dt,
            "t_end" => self.end,
            "x0" => self.x0,
            "v0" => self.v0,
            _ => return None,
        })
    }

    /// The parameters, if every one is within its range; the law was checked where it was made.
    ///
    /// # Errors
    /// The first parameter that is out of range; `dt` if it is longer than the run, or if that would take more than
    /// [`MOST_STEPS`].
    pub fn checked(self) -> Result<Self, ParameterError> {
        for (key, unit, low, high) in RANGES {
            if let Some(value) = self.get(key) {
                ParameterError::unless_within([low, high], key, value, unit)?;
            }
        }
        let steps = self.end / self.dt;
        if !(1.0..=MOST_STEPS).contains(&steps) {
            let allowed = match steps < 1.0 {
                true => "at most t_end: a longer step passes the end",
                false => "at least t_end/1e10: more steps would take too long",
            };
            let (value, allowed) = (self.dt, allowed.into());
            return Err(ParameterError { key: "dt", value, unit: "s", allowed });
        }
        Ok(self)
    }

    /// The block at t = 0: no force in the friction spring, the coefficient of friction at rest.
    pub fn start(&self) -> State {
        State {
            x: self.x0,
            v: self.v0,
            slip: self.v0 - self.belt,
            friction: 0.0,
            mu: self.mu_static(),
        }
    }

    /// Coefficient of friction at a slip velocity (m/s).
    #[inline]
    pub fn mu(&self, slip: f64) -> f64 {
        self.law.mu(slip.abs())
    }

    /// Coefficient of friction at rest, mu_S.
    #[inline]
    pub fn mu_static(&self) -> f64 {
        self.law.mu_static()
    }

    /// Friction force F_fric on the block (N) of a coefficient `mu` at a slip velocity (m/s), Eq (18):
    /// -mu F_n s/max(s_adhes, |s|).
    #[inline]
    pub fn regularised(&self, mu: f64, slip: f64) -> f64 {
        -mu * self.normal_force * slip / self.adhesion.max(slip.abs())
    }

    /// Friction force F_fric(s) on the block (N) at a slip velocity (m/s), Eqs (17) and (18).
    #[inline]
    pub fn friction(&self, slip: f64) -> f64 {
        self.regularised(self.mu(slip), slip)
    }

    /// Extension of the spring at which it pulls with static friction, mu_S F_n/k_spring (m); infinite without a
    /// spring.
    pub fn reach(&self) -> f64 {
        self.mu_static() * self.normal_force / self.spring
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// The parameters with one other value.
    fn with(key: &str, value: f64) -> Parameters {
        let mut p = Parameters::default();
        match key {
            "belt" => p.belt = value,
            "normal_force" => p.normal_force = value,
            "mass" => p.mass = value,
            "spring" => p.spring = value,
            "damping" => p.damping = value,
            "adhesion" => p.adhesion = value,
            "stiffness" => p.stiffness = value,
            "memory_distance" => p.memory.distance = value,
            "memory_floor" => p.memory.floor = value,
            "dt" => p.dt = value,
            "t_end" => p.end = value,
            "x0" => p.x0 = value,
            "v0" => p.v0 = value,
            other => panic!("{other}"),
        }
        p
    }

    #[test]
    fn every_parameter_has_a_finite_range_and_no_value_beyond_it_is_taken() {
        for (key, unit, low, high) in RANGES {
            let absurd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300];
            for value in absurd {
                let error = with(key, value).checked().unwrap_err();
                assert!(error.key == key && error.unit == unit, "{key} = {value}: {error}");
                let range = format!("from {} to {}", short(low), short(high));
                assert!(error.to_string().contains(&range), "{error}");
            }
            // what must be above zero must be large enough to be reckoned with
            assert_eq!(with(key, 5e-324).checked().is_ok(), low <= 0.0, "{key}");
            assert_eq!(with(key, low).get(key), Some(low));
        }
    }

    #[test]
    fn a_step_is_no_longer_than_the_run() {
        let error = with("t_end", 1e-6).checked().unwrap_err();
        assert_eq!(error.key, "dt");
        assert!(error.to_string().contains("at most t_end"), "{error}");
    }
}
