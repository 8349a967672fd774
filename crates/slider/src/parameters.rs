//! Table 1.

use contact::{Exponential, FrictionLaw};
use thiserror::Error;

/// Parameters of the slider; the default is Table 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Velocity of the belt v_ref (m/s).
    pub belt: f64,
    /// Normal force F_n (N).
    pub normal_force: f64,
    /// Mass m (kg).
    pub mass: f64,
    /// Spring k_spring (N/m).
    pub spring: f64,
    /// Damper c_damp (N s/m).
    pub damping: f64,
    /// Slip velocity s_adhes below which friction is linear, Eq (18) (m/s).
    pub adhesion: f64,
    /// mu(s), Eq (17).
    pub law: Exponential,
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
            law: Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 },
            dt: 1e-4,
            end: 5.0,
            x0: 0.0,
            v0: -1.0,
        }
    }
}

/// A parameter outside its range.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("{key} = {value} must be {allowed}")]
pub struct ParameterError {
    /// Name of the parameter.
    pub key: &'static str,
    /// Its value.
    pub value: f64,
    /// What is allowed.
    pub allowed: &'static str,
}

impl Parameters {
    /// The parameters, if every one is within its range.
    pub fn checked(self) -> Result<Self, ParameterError> {
        let positive = [
            ("dt", self.dt),
            ("mass", self.mass),
            ("adhesion", self.adhesion),
            ("t-end", self.end),
        ];
        let not_negative = [
            ("normal force", self.normal_force),
            ("spring", self.spring),
            ("damping", self.damping),
            ("mu static", self.law.mu_static),
            ("mu dynamic", self.law.mu_dynamic),
            ("decay", self.law.decay),
        ];
        for (key, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ParameterError { key, value, allowed: "a finite number above 0" });
            }
        }
        for (key, value) in not_negative {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ParameterError {
                    key,
                    value,
                    allowed: "a finite number of at least 0",
                });
            }
        }
        for (key, value) in [("belt", self.belt), ("x0", self.x0), ("v0", self.v0)] {
            if !value.is_finite() {
                return Err(ParameterError { key, value, allowed: "a finite number" });
            }
        }
        if self.end / self.dt > 1e10 {
            let allowed = "at least t-end/1e10: more steps would take hours";
            return Err(ParameterError { key: "dt", value: self.dt, allowed });
        }
        Ok(self)
    }

    /// F_fric(s) (N), Eqs (17)-(18): -mu(|s|) F_n s/max(s_adhes, |s|).
    pub fn friction(&self, slip: f64) -> f64 {
        let speed = slip.abs();
        -self.law.mu(speed) * self.normal_force * slip / self.adhesion.max(speed)
    }
}
