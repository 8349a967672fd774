//! Friction that falls exponentially.

use crate::FrictionLaw;

/// Friction that falls exponentially with the slip speed, Eq. (8) of Vollebregt (2017):
/// `mu(s) = mu_dynamic + (mu_static - mu_dynamic) exp(-decay |s|)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    /// Coefficient at rest.
    pub mu_static: f64,
    /// Coefficient at infinite slip speed.
    pub mu_dynamic: f64,
    /// Rate of decay `k` (s/m).
    pub decay: f64,
}

impl FrictionLaw for Exponential {
    fn mu(&self, slip_speed: f64) -> f64 {
        self.mu_dynamic + (self.mu_static - self.mu_dynamic) * libm::exp(-self.decay * slip_speed)
    }

    fn mu_static(&self) -> f64 {
        self.mu_static
    }

    fn slope(&self, slip_speed: f64) -> f64 {
        -self.decay * (self.mu_static - self.mu_dynamic) * libm::exp(-self.decay * slip_speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_law_is_static_at_rest_and_dynamic_at_high_speed() {
        let law = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
        assert_eq!(law.mu(0.0), 0.5);
        assert_eq!(law.mu_static(), 0.5);
        assert_eq!(law.mu(1e3), 0.32);
    }

    #[test]
    fn exponential_law_has_the_values_of_equation_8() {
        // 0.32 + 0.18 exp(-6 s) by an independent calculation (25-digit decimals).
        let law = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
        for (s, mu) in [
            (0.01, 0.489_517_616_045_164_8),
            (0.1, 0.418_786_094_496_924_8),
            (1.0, 0.320_446_175_391_799_9),
        ] {
            assert!((law.mu(s) - mu).abs() < 1e-15, "{s}: {} {mu}", law.mu(s));
        }
    }
}
