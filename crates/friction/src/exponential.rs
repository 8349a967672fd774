//! Friction that falls exponentially.

use crate::coulomb::STATIC;
use crate::declaration::{Make, no_defaults};
use crate::{Declaration, FrictionLaw, LeftOut, Number};
use std::sync::Arc;

/// `dynamic`, of the laws that fall to a coefficient.
pub const DYNAMIC: Number = Number {
    path: "friction.dynamic",
    unit: "-",
    range: [0.0, 5.0],
    sentence: "Coefficient at high slip velocity, or after slip (dimensionless), at most `static`.",
    remedy: "give a coefficient of friction: 0.32",
};

/// `decay`, of the laws that fall exponentially.
pub const DECAY: Number = Number {
    path: "friction.decay",
    unit: "s/m",
    range: [0.0, 1e4],
    sentence: "Decay of the coefficient with slip velocity (s/m).",
    remedy: "give the decay in s/m: 6.0",
};

pub(crate) const DECLARATION: Declaration = Declaration {
    word: "exponential",
    sentence: "A coefficient that falls exponentially with slip velocity.",
    coefficient: "Eq 8 of the paper: mu(s) = dynamic + (static - dynamic) exp(-decay |s|)",
    numbers: &[
        (STATIC, LeftOut::Refused),
        (DYNAMIC, LeftOut::Default(0.32)),
        (DECAY, LeftOut::Default(6.0)),
    ],
    needs: &[],
    takes: &["mode", "memory"],
    write_defaults: no_defaults,
    make: Make::Steady(|p, _| {
        Ok(Arc::new(Exponential {
            mu_static: p.value(STATIC),
            mu_dynamic: p.value(DYNAMIC),
            decay: p.value(DECAY),
        }))
    }),
};

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

    fn as_exponential(&self) -> Option<Exponential> {
        Some(*self)
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
