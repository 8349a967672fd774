//! Friction with memory: the coefficient follows its steady law over a distance of slip.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Memory of friction: `d(mu)/dt = -(max(|s|, s_0)/d_c) (mu - mu_steady(|s|))`, the regularisation
/// of falling friction that CONTACT uses; with it the problem of two elastic bodies is well posed.
/// Out of contact the coefficient returns to that at rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Memory {
    /// Distance of slip `d_c` over which the coefficient adapts (m). Default 1e-6, as in CONTACT.
    pub distance: f64,
    /// Slip speed `s_0` below which it adapts in time instead (m/s). Default 10e-3, as in CONTACT.
    pub floor: f64,
}

impl Default for Memory {
    fn default() -> Self {
        Self { distance: 1e-6, floor: 1e-2 }
    }
}

impl Memory {
    /// The coefficient after `dt` (s) of slip at `slip_speed >= 0` (m/s), from `mu` before towards
    /// `steady`, the coefficient of the steady law: the exact solution for a constant slip speed.
    pub fn advance(&self, mu: f64, steady: f64, slip_speed: f64, dt: f64) -> f64 {
        steady + (mu - steady) * libm::exp(-slip_speed.max(self.floor) * dt / self.distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_adapts_by_1_over_e_per_memory_distance_in_any_number_of_steps() {
        let memory = Memory { distance: 3e-6, floor: 1e-2 };
        let expected = 0.3 + 0.2 * libm::exp(-1.0f64);
        for steps in [1, 7, 300] {
            let dt = 3e-6 / 0.5 / f64::from(steps);
            let mu = (0..steps).fold(0.5, |mu, _| memory.advance(mu, 0.3, 0.5, dt));
            assert!((mu - expected).abs() < 1e-14, "{steps}: {mu} {expected}");
        }
    }

    #[test]
    fn at_rest_friction_recovers_at_the_floor_speed() {
        let memory = Memory::default();
        assert_eq!(memory.advance(0.3, 0.5, 0.0, 1e-5), memory.advance(0.3, 0.5, 1e-2, 1e-5));
    }
}
