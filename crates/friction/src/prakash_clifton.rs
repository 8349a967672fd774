//! Friction whose shear strength follows changes of pressure gradually.

use crate::coulomb::STATIC;
use crate::declaration::{Make, no_defaults};
use crate::slip_weakening::DISTANCE;
use crate::{Declaration, LeftOut, NodeConditions, NodeFriction, Number};

const RELAXATION_SPEED: Number = Number {
    path: "friction.relaxation_speed",
    unit: "m/s",
    range: [1e-9, 1e3],
    sentence: "V* of `\"prakash_clifton\"` (m/s): the strength follows the pressure at rest in the time `distance` \
               over this.",
    remedy: "give V* of the law in m/s: 1.0",
};

/// The default of V* is that of the benchmarks TPV6 and 7 (Harris et al. 2009).
pub(crate) const DECLARATION: Declaration = Declaration {
    word: "prakash_clifton",
    sentence: "A shear strength that follows the pressure.",
    coefficient: "shear strength that follows `static` times the pressure over `distance`",
    numbers: &[
        (STATIC, LeftOut::Refused),
        (DISTANCE, LeftOut::Refused),
        (RELAXATION_SPEED, LeftOut::Default(1.0)),
    ],
    needs: &[],
    takes: &[],
    write_defaults: no_defaults,
    make: Make::AtNode(|p, _| {
        Box::new(PrakashClifton {
            mu: p.value(STATIC),
            distance: p.value(DISTANCE),
            speed: p.value(RELAXATION_SPEED),
        })
    }),
};

/// `d tau_s/dt = -((|s| + V*)/L) (tau_s - mu p)`: the shear strength `tau_s` relaxes towards Coulomb's
/// over the distance `L` of slip, and at rest in the time `L/V*`. Prakash and Clifton's (1993) response to
/// changes of pressure in the form of Cochard and Rice (2000, Eq. 5), which makes slip between unlike
/// bodies well posed (Ranjith and Rice 2001).
///
/// The state is `tau_s` (Pa), advanced by the exact solution for a slip speed and a pressure that are
/// constant over the step. The coefficient is `tau_s/p`, so that the bound on the shear is `tau_s`, however the
/// pressure changes within the step.
///
/// - *Beginning of contact*: the strength is `mu p` at the pressure of that instant. Exact enforcement
///   does not know that pressure yet: the strength starts from zero and follows.
/// - *End of contact*: the pressure falls to zero and the strength lags behind, so that `tau_s/p` grows
///   without bound. It is limited to [`MOST`](Self::MOST) times `mu`, which it reaches when the pressure is a
///   thousandth of `tau_s/mu`: shear then vanishes with the pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrakashClifton {
    /// Coefficient of friction `mu` under constant pressure.
    pub mu: f64,
    /// Distance of slip `L` over which the strength adapts (m).
    pub distance: f64,
    /// Slip speed `V*` (m/s) at which the strength relaxes when the node is at rest.
    pub speed: f64,
}

impl PrakashClifton {
    /// The coefficient is at most this multiple of `mu`.
    pub const MOST: f64 = 1e3;
}

impl NodeFriction for PrakashClifton {
    fn begin(&self, at: &NodeConditions) -> [f64; 2] {
        [self.mu * at.pressure.max(0.0), 0.0]
    }

    fn advance(
        &self,
        [strength, _]: [f64; 2],
        slip_speed: f64,
        at: &NodeConditions,
        dt: f64,
    ) -> [f64; 2] {
        let target = self.mu * at.pressure.max(0.0);
        let decay = libm::exp(-(slip_speed + self.speed) * dt / self.distance);
        [target + (strength - target) * decay, 0.0]
    }

    fn mu(&self, [strength, _]: [f64; 2], _slip_speed: f64, at: &NodeConditions) -> f64 {
        // a comparison without a division, which also holds at zero pressure
        let most = Self::MOST * self.mu;
        if strength < most * at.pressure { strength / at.pressure } else { most }
    }

    fn mu_static(&self) -> f64 {
        self.mu
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: PrakashClifton = PrakashClifton { mu: 0.5, distance: 1e-5, speed: 1.0 };

    fn pressed(pressure: f64) -> NodeConditions {
        NodeConditions { pressure, ..NodeConditions::default() }
    }

    #[test]
    fn under_constant_pressure_it_is_coulombs_law() {
        let at = pressed(8e8);
        let mut state = LAW.begin(&at);
        for i in 0..100 {
            assert!((LAW.mu(state, 0.0, &at) - 0.5).abs() < 1e-15);
            state = LAW.advance(state, f64::from(i) * 0.1, &at, 1e-7);
        }
    }

    #[test]
    fn after_a_jump_of_pressure_the_shear_strength_relaxes_exponentially_in_slip() {
        let at = pressed(3e8);
        for steps in [1, 9, 500] {
            let mut state = LAW.begin(&pressed(1e9));
            // the pressure has jumped, the strength has not
            assert!((LAW.mu(state, 0.0, &at) * 3e8 - 5e8).abs() < 1e-6);
            let dt = 1e-5 / f64::from(steps);
            for _ in 0..steps {
                state = LAW.advance(state, 0.7, &at, dt);
            }
            // slip and V* t over L: 1.7
            let expected = 1.5e8 + 3.5e8 * libm::exp(-1.7f64);
            let strength = LAW.mu(state, 0.0, &at) * 3e8;
            assert!((strength / expected - 1.0).abs() < 1e-12, "{steps}");
        }
    }

    #[test]
    fn the_bound_does_not_follow_the_pressure_within_a_step() {
        let state = LAW.begin(&pressed(1e9));
        for p in [2e6, 1e8, 2e9] {
            let at = pressed(p);
            assert!((LAW.mu(state, 0.0, &at) * p / 5e8 - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn the_coefficient_stays_bounded_as_the_pressure_vanishes() {
        let state = LAW.begin(&pressed(1e9));
        for p in [0.0, 1e-300, 1.0] {
            assert_eq!(LAW.mu(state, 0.0, &pressed(p)), 500.0);
        }
        assert_eq!(LAW.begin(&pressed(0.0)), [0.0; 2]);
    }
}
