//! Friction of rate and state.

use crate::declaration::Make;
use crate::slip_weakening::DISTANCE;
use crate::{Declaration, LeftOut, Mode, NodeConditions, NodeFriction, Number, Parameters};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::LN_2;

const REFERENCE: Number = Number {
    path: "friction.reference",
    unit: "-",
    range: [1e-3, 5.0],
    sentence: "f_0 of `\"rate_state\"` (dimensionless), the coefficient of steady sliding at `reference_speed`.",
    remedy: "give a coefficient of friction: 0.6",
};

const REFERENCE_SPEED: Number = Number {
    path: "friction.reference_speed",
    unit: "m/s",
    range: [1e-12, 100.0],
    sentence: "V_0 of `\"rate_state\"` (m/s).",
    remedy: "give V_0 in m/s: 1e-6",
};

const DIRECT: Number = Number {
    path: "friction.direct",
    unit: "-",
    range: [1e-4, 1.0],
    sentence: "Direct effect a of `\"rate_state\"` (dimensionless).",
    remedy: "give the direct effect a: 0.008",
};

const EVOLUTION: Number = Number {
    path: "friction.evolution",
    unit: "-",
    range: [0.0, 1.0],
    sentence: "Effect of the state b of `\"rate_state\"` (dimensionless); friction falls with slip velocity in the \
               long run where it is above `direct`.",
    remedy: "give the effect b: 0.012",
};

const AGE: Number = Number {
    path: "friction.age",
    unit: "s",
    range: [1e-14, 1e13],
    sentence: "State theta of `\"rate_state\"` with which contact begins (s).",
    remedy: "give the state theta in seconds: 10",
};

/// The defaults are those of the benchmarks TPV101 and 102 (Harris et al. 2009).
pub(crate) const DECLARATION: Declaration = Declaration {
    word: "rate_state",
    sentence: "Dieterich and Ruina's law.",
    coefficient: "Dieterich-Ruina",
    numbers: &[
        (DISTANCE, LeftOut::Refused),
        (REFERENCE, LeftOut::Default(0.6)),
        (REFERENCE_SPEED, LeftOut::Default(1e-6)),
        (DIRECT, LeftOut::Default(0.008)),
        (EVOLUTION, LeftOut::Default(0.012)),
        (AGE, LeftOut::Follows { said: "`distance` over `reference_speed`", of: age_of_steady_sliding }),
    ],
    needs: &[],
    takes: &["state", "mode"],
    write_defaults,
    make: Make::AtNode(|p, _| Box::new(RateState::of(p))),
};

fn age_of_steady_sliding(p: &Parameters) -> f64 {
    p.value(DISTANCE) / p.value(REFERENCE_SPEED)
}

fn write_defaults(p: &mut Parameters, exact: bool) {
    p.state.get_or_insert_default();
    p.mode.get_or_insert(if exact { Mode::Exact } else { Mode::Lagged });
}

/// How the state of rate-and-state friction evolves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StateLaw {
    /// `d theta/dt = 1 - V theta/L` (Dieterich 1979): contacts age at rest.
    #[default]
    Ageing,
    /// `d theta/dt = -(V theta/L) ln(V theta/L)` (Ruina 1983): the state changes in slip alone.
    Slip,
}

/// Dieterich–Ruina friction, `mu = f_0 + a ln(V/V_0) + b ln(V_0 theta/L)`, regularised at zero velocity
/// (Rice, Lapusta and Ranjith 2001, Eq. 15):
/// `mu = a asinh( V/(2 V_0) exp( (f_0 + b ln(V_0 theta/L))/a ) )`.
///
/// At a fixed state the coefficient rises with the slip speed `V` and vanishes with it. No node sticks: one that seems
/// to stick creeps at less than `V_0 exp(-f_0/a)`. In steady sliding `mu = f_0 + (a - b) ln(V/V_0)`, which falls with
/// the speed where `b > a`.
///
/// The first number of the state is `theta` (s), advanced by the exact solution for a slip speed that is constant over
/// the step. It starts at `initial` wherever a node comes into contact. The second number is the slip speed of the step
/// before (m/s), at which the coefficient is evaluated if `lagged`; it starts at zero, so that a lagged law has no
/// friction in the first step of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateState {
    /// Coefficient `f_0` of steady sliding at `reference_speed`.
    pub reference: f64,
    /// Reference speed `V_0` (m/s).
    pub reference_speed: f64,
    /// Direct effect `a` (dimensionless).
    pub direct: f64,
    /// Effect of the state `b` (dimensionless).
    pub evolution: f64,
    /// Distance of slip `L` over which the state evolves (m).
    pub distance: f64,
    /// Evolution law of the state.
    pub law: StateLaw,
    /// State of a node that comes into contact (s).
    pub initial: f64,
    /// Whether the coefficient takes the slip speed of the step before instead of that of the same instant.
    pub lagged: bool,
}

impl RateState {
    /// That of the parameters.
    pub(crate) fn of(p: &Parameters) -> Self {
        Self {
            reference: p.value(REFERENCE),
            reference_speed: p.value(REFERENCE_SPEED),
            direct: p.value(DIRECT),
            evolution: p.value(EVOLUTION),
            distance: p.value(DISTANCE),
            law: p.state.unwrap_or_default(),
            initial: p.value(AGE),
            lagged: p.mode.unwrap_or_default() == Mode::Lagged,
        }
    }

    /// The same law with another distance L (m), whose contact begins with the same strength.
    pub fn with_distance(self, distance: f64) -> Self {
        Self { distance, initial: self.initial * distance / self.distance, ..self }
    }

    /// How much less friction a small further slip leaves, too fast for the state to recover, over `slip/L`: with
    /// `d(f)/d(slip) = -g/L` of the strength `f = b ln(V_0 theta/L)` it is `g + V dg/dV - a`.
    pub fn weakening(&self, theta: f64, speed: f64) -> f64 {
        let lag = match self.law {
            StateLaw::Ageing => 0.0,
            StateLaw::Slip => self.evolution * libm::log(speed * theta / self.distance),
        };
        lag + self.evolution - self.direct
    }

    /// Coefficient of steady sliding at `speed > 0` (m/s), where `theta = L/V`.
    pub fn steady(&self, speed: f64) -> f64 {
        let state = [self.distance / speed, speed];
        self.mu(state, speed, &NodeConditions::default())
    }

    /// `ln( V/(2 V_0) exp(..) )`, the logarithm of the argument of `asinh`; the argument itself may overflow.
    fn log_argument(&self, theta: f64, speed: f64) -> f64 {
        let state = self.evolution * libm::log(self.reference_speed * theta / self.distance);
        libm::log(speed / (2.0 * self.reference_speed)) + (self.reference + state) / self.direct
    }
}

/// For larger x, `asinh(e^x) = x + ln 2` in double precision.
const LARGE: f64 = 20.0;

impl NodeFriction for RateState {
    fn begin(&self, _at: &NodeConditions) -> [f64; 2] {
        [self.initial, 0.0]
    }

    fn advance(
        &self,
        [theta, _]: [f64; 2],
        slip_speed: f64,
        _at: &NodeConditions,
        dt: f64,
    ) -> [f64; 2] {
        let x = slip_speed * dt / self.distance;
        // 1 - e^-x and (1 - e^-x)/x
        let decayed = -libm::expm1(-x);
        let mean = if x > 0.0 { decayed / x } else { 1.0 };
        let theta = match self.law {
            StateLaw::Ageing => theta * libm::exp(-x) + dt * mean,
            // ln(V theta/L) decays as e^-x
            StateLaw::Slip if slip_speed > 0.0 => {
                theta * libm::exp(-decayed * libm::log(slip_speed * theta / self.distance))
            }
            StateLaw::Slip => theta,
        };
        [theta, slip_speed]
    }

    fn mu(&self, [theta, before]: [f64; 2], slip_speed: f64, _at: &NodeConditions) -> f64 {
        let x = self.log_argument(theta, if self.lagged { before } else { slip_speed });
        self.direct * if x > LARGE { x + LN_2 } else { libm::asinh(libm::exp(x)) }
    }

    fn slope(&self, [theta, _]: [f64; 2], slip_speed: f64, _at: &NodeConditions) -> f64 {
        if self.lagged {
            return 0.0;
        }
        if slip_speed == 0.0 {
            // the derivative of asinh is 1 at rest
            return self.direct * libm::exp(self.log_argument(theta, 1.0));
        }
        let x = self.log_argument(theta, slip_speed);
        // tanh(asinh(e^x)), since d asinh(y)/d ln y = tanh(asinh(y))
        let tanh = if x > LARGE { 1.0 } else { 1.0 / (1.0 + libm::exp(-2.0 * x)).sqrt() };
        self.direct * tanh / slip_speed
    }

    fn is_implicit(&self) -> bool {
        !self.lagged
    }

    /// The coefficient `f_0`: this law has no static coefficient, since `mu` vanishes at rest.
    fn mu_static(&self) -> f64 {
        self.reference
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parameters of the benchmark TPV101 (Harris et al. 2009).
    const LAW: RateState = RateState {
        reference: 0.6,
        reference_speed: 1e-6,
        direct: 0.008,
        evolution: 0.012,
        distance: 0.02,
        law: StateLaw::Ageing,
        initial: 2e4,
        lagged: false,
    };
    const SLIP: RateState = RateState { law: StateLaw::Slip, ..LAW };

    #[test]
    fn the_coefficient_is_the_regularised_formula() {
        let at = NodeConditions::default();
        for (theta, v) in [(2e4, 1e-9), (1.0, 1e-3), (1e-3, 0.1), (1e-8, 1e-12), (1e-30, 1e-6)] {
            let psi = 0.6 + 0.012 * libm::log(1e-6 * theta / 0.02_f64);
            let direct = 0.008 * libm::asinh(v / 2e-6 * libm::exp(psi / 0.008_f64));
            let mu = LAW.mu([theta, 0.0], v, &at);
            assert!((mu - direct).abs() <= 1e-13 * direct, "{theta} {v}: {mu} {direct}");
        }
        assert_eq!(LAW.mu([2e4, 0.0], 0.0, &at), 0.0);
    }

    #[test]
    fn large_parameters_do_not_overflow() {
        let sharp = RateState { direct: 1e-5, ..LAW };
        let mu = sharp.mu([2e4, 0.0], 1e-6, &NodeConditions::default());
        assert!((mu - 0.6).abs() < 1e-12, "{mu}");
    }

    #[test]
    fn steady_sliding_weakens_with_the_logarithm_of_the_speed() {
        for v in [1e-6, 1e-3, 1.0] {
            let expected = 0.6 - 0.004 * libm::log(v / 1e-6_f64);
            assert!((LAW.steady(v) - expected).abs() < 1e-14, "{v}");
        }
    }

    #[test]
    fn a_jump_in_speed_has_the_direct_effect_at_once_and_the_steady_one_in_the_end() {
        for law in [LAW, SLIP] {
            let at = NodeConditions::default();
            let mut state = [law.distance / 1e-3, 0.0];
            let jump = law.mu(state, 1e-2, &at) - law.mu(state, 1e-3, &at);
            assert!((jump - 0.008 * libm::log(10f64)).abs() < 1e-14);
            for _ in 0..2000 {
                state = law.advance(state, 1e-2, &at, 0.04);
            }
            let settled = law.mu(state, 1e-2, &at) - law.steady(1e-3);
            assert!((settled + 0.004 * libm::log(10f64)).abs() < 1e-13, "{settled}");
        }
    }

    #[test]
    fn the_state_follows_the_closed_form_in_any_number_of_steps() {
        // theta_ss + (theta - theta_ss) e^-x, and theta_ss (theta/theta_ss)^(e^-x)
        let (v, time) = (0.5_f64, 0.03);
        let (steady, decay) = (0.02 / v, libm::exp(-v * time / 0.02_f64));
        for (law, expected) in [
            (LAW, steady + (0.3 - steady) * decay),
            (SLIP, steady * libm::pow(0.3 / steady, decay)),
        ] {
            for steps in [1, 7, 1000] {
                let dt = time / f64::from(steps);
                let at = NodeConditions::default();
                let end = (0..steps).fold([0.3, 0.0], |state, _| law.advance(state, v, &at, dt));
                assert!((end[0] - expected).abs() < 1e-13 * expected * f64::from(steps), "{steps}");
            }
        }
    }

    #[test]
    fn at_rest_the_ageing_law_ages_and_the_slip_law_does_not() {
        let at = NodeConditions::default();
        assert_eq!(LAW.advance([2.0, 0.0], 0.0, &at, 0.5)[0], 2.5);
        assert_eq!(SLIP.advance([2.0, 0.0], 0.0, &at, 0.5)[0], 2.0);
    }

    #[test]
    fn lagged_it_is_the_coefficient_at_the_speed_before() {
        let at = NodeConditions::default();
        let lagged = RateState { lagged: true, ..LAW };
        let state = lagged.advance([2.0, 0.0], 0.3, &at, 1e-7);
        assert_eq!(lagged.mu(state, 5.0, &at), LAW.mu(state, 0.3, &at));
        assert!(!lagged.is_implicit() && lagged.slope(state, 5.0, &at) == 0.0);
    }

    #[test]
    fn the_slope_is_the_derivative() {
        let at = NodeConditions::default();
        for (theta, v) in [(2e4, 1e-9), (1.0, 1e-3), (1e-30, 1e-6), (1e-32, 1e-6)] {
            let state = [theta, 0.0];
            let h = 1e-5 * v;
            let by_difference = (LAW.mu(state, v + h, &at) - LAW.mu(state, v - h, &at)) / (2.0 * h);
            let slope = LAW.slope(state, v, &at);
            assert!((slope / by_difference - 1.0).abs() < 1e-6, "{theta} {slope} {by_difference}");
        }
        let state = [1e-40, 0.0];
        let at_rest = LAW.mu(state, 1e-12, &at) / 1e-12;
        assert!((LAW.slope(state, 0.0, &at) / at_rest - 1.0).abs() < 1e-6);
    }
}
