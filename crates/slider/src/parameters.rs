//! The parameters of Table 1, and those of the methods that are not in the paper.

use crate::State;
use friction::{Exponential, FrictionLaw, Memory, SteadyLaw};
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
    pub law: SteadyLaw,
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
            law: SteadyLaw::Exponential(Exponential {
                mu_static: 0.5,
                mu_dynamic: 0.32,
                decay: 6.0,
            }),
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
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("{key} = {value} {unit} is out of range: it must be {allowed}")]
pub struct ParameterError {
    /// Name of the parameter, as in a parameter file.
    pub key: &'static str,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What is allowed.
    pub allowed: &'static str,
}

const POSITIVE: &str = "a finite number above 0";
const NOT_NEGATIVE: &str = "a finite number of at least 0";

impl Parameters {
    /// The parameters, if every one is within its range.
    ///
    /// # Errors
    /// The first parameter that is out of range, or `dt` if the run would take more than [`MOST_STEPS`].
    pub fn checked(self) -> Result<Self, ParameterError> {
        let positive = [
            ("dt", self.dt, "s"),
            ("mass", self.mass, "kg"),
            ("adhesion", self.adhesion, "m/s"),
            ("t_end", self.end, "s"),
            ("stiffness", self.stiffness, "N/m"),
            ("memory_distance", self.memory.distance, "m"),
        ];
        let mut not_negative = vec![
            ("normal_force", self.normal_force, "N"),
            ("spring", self.spring, "N/m"),
            ("damping", self.damping, "N s/m"),
            ("memory_floor", self.memory.floor, "m/s"),
        ];
        match &self.law {
            SteadyLaw::Coulomb(law) => not_negative.push(("mu_static", law.mu, "")),
            SteadyLaw::Exponential(law) => not_negative.extend([
                ("mu_static", law.mu_static, ""),
                ("mu_dynamic", law.mu_dynamic, ""),
                ("decay", law.decay, "s/m"),
            ]),
            // checked when they were constructed
            SteadyLaw::Table(_) | SteadyLaw::Expression(_) => {}
        }
        for (key, value, unit) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ParameterError { key, value, unit, allowed: POSITIVE });
            }
        }
        for (key, value, unit) in not_negative {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ParameterError { key, value, unit, allowed: NOT_NEGATIVE });
            }
        }
        for (key, value, unit) in
            [("belt", self.belt, "m/s"), ("x0", self.x0, "m"), ("v0", self.v0, "m/s")]
        {
            if !value.is_finite() {
                return Err(ParameterError { key, value, unit, allowed: "a finite number" });
            }
        }
        if self.end / self.dt > MOST_STEPS {
            let allowed = "at least t_end/1e10: more steps would take too long";
            return Err(ParameterError { key: "dt", value: self.dt, unit: "s", allowed });
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
