//! Friction that weakens with accumulated slip.

use crate::coulomb::STATIC;
use crate::declaration::{Make, no_defaults};
use crate::exponential::DYNAMIC;
use crate::{Declaration, LeftOut, NodeConditions, NodeFriction, Number};

/// `distance`, of the laws whose friction changes with the path of slip.
pub const DISTANCE: Number = Number {
    path: "friction.distance",
    unit: "m",
    range: [1e-12, 10.0],
    sentence: "Slip over which friction changes (m): d_0 of `\"slip_weakening\"`, L of `\"rate_state\"` and \
               `\"prakash_clifton\"`.",
    remedy: "give the slip over which friction changes, in metres: `distance = 10e-6`",
};

pub(crate) const DECLARATION: Declaration = Declaration {
    word: "slip_weakening",
    sentence: "A coefficient that falls linearly with slip.",
    coefficient: "linear from `static` to `dynamic` over `distance`",
    numbers: &[
        (STATIC, LeftOut::Refused),
        (DISTANCE, LeftOut::Refused),
        (DYNAMIC, LeftOut::Default(0.32)),
    ],
    needs: &[],
    takes: &[],
    write_defaults: no_defaults,
    make: Make::AtNode(|p, _| {
        Box::new(SlipWeakening {
            mu_static: p.value(STATIC),
            mu_dynamic: p.value(DYNAMIC),
            distance: p.value(DISTANCE),
        })
    }),
};

/// `mu = mu_S - (mu_S - mu_D) min(|slip|/d_0, 1)`: linear slip weakening (Ida 1972; Andrews 1976), the
/// law of the dynamic rupture benchmarks (Harris et al. 2009, TPV3).
///
/// The first number of the state is the slip path since the node came into contact, `integral |s| dt` (m). It starts
/// again at zero when a node that left contact comes into contact again; rest does not heal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipWeakening {
    /// Coefficient before slip, `mu_S`.
    pub mu_static: f64,
    /// Coefficient after a slip of `distance`, `mu_D`.
    pub mu_dynamic: f64,
    /// Distance of slip `d_0` over which the coefficient falls (m).
    pub distance: f64,
}

impl NodeFriction for SlipWeakening {
    fn advance(
        &self,
        [slip, _]: [f64; 2],
        slip_speed: f64,
        _at: &NodeConditions,
        dt: f64,
    ) -> [f64; 2] {
        [slip + slip_speed * dt, 0.0]
    }

    fn mu(&self, [slip, _]: [f64; 2], _slip_speed: f64, _at: &NodeConditions) -> f64 {
        self.mu_static - (self.mu_static - self.mu_dynamic) * (slip / self.distance).min(1.0)
    }

    fn mu_static(&self) -> f64 {
        self.mu_static
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TPV3: SlipWeakening =
        SlipWeakening { mu_static: 0.677, mu_dynamic: 0.525, distance: 0.4 };

    #[test]
    fn friction_falls_linearly_over_the_distance_and_no_further() {
        let at = NodeConditions::default();
        let mut state = TPV3.begin(&at);
        for i in 0..60 {
            let slip = f64::from(i) * 0.01;
            let expected = if slip < 0.4 { 0.677 - 0.38 * slip } else { 0.525 };
            assert!((TPV3.mu(state, 3.0, &at) - expected).abs() < 1e-14, "{slip}");
            state = TPV3.advance(state, 2.0, &at, 5e-3);
        }
    }

    #[test]
    fn the_work_of_weakening_is_half_the_drop_over_the_distance() {
        // fracture energy G_c/p = (mu_S - mu_D) d_0/2
        let at = NodeConditions::default();
        let (mut state, mut work) = (TPV3.begin(&at), 0.0);
        for _ in 0..4000 {
            let before = TPV3.mu(state, 1.0, &at);
            state = TPV3.advance(state, 1.0, &at, 1e-4);
            work += (0.5 * (before + TPV3.mu(state, 1.0, &at)) - 0.525) * 1e-4;
        }
        assert!((work - 0.5 * 0.152 * 0.4).abs() < 1e-12, "{work}");
    }

    #[test]
    fn rest_does_not_heal_and_new_contact_does() {
        let at = NodeConditions::default();
        let slid = TPV3.advance(TPV3.begin(&at), 1.0, &at, 0.3);
        assert_eq!(TPV3.advance(slid, 0.0, &at, 1e3), slid);
        assert_eq!(TPV3.mu(TPV3.begin(&at), 0.0, &at), 0.677);
    }
}
