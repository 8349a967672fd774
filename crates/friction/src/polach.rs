//! Polach's law: friction that falls with the slip speed to a share of that at rest.

use crate::coulomb::STATIC;
use crate::declaration::{Make, no_defaults};
use crate::exponential::DECAY;
use crate::{Declaration, Exponential, FrictionLaw, LeftOut, Number};
use std::sync::Arc;

const RATIO: Number = Number {
    path: "friction.ratio",
    unit: "-",
    range: [1e-3, 1.0],
    sentence: "Coefficient at infinite slip velocity over `static`, A of `\"polach\"` (dimensionless).",
    remedy: "give the ratio of the coefficients at infinite and at zero slip velocity: 0.4",
};

pub(crate) const DECLARATION: Declaration = Declaration {
    word: "polach",
    sentence: "A coefficient that falls exponentially to a share of that at rest, in Polach's parameters.",
    coefficient: "mu(s) = static ((1 - ratio) exp(-decay |s|) + ratio)",
    numbers: &[
        (STATIC, LeftOut::Refused),
        (RATIO, LeftOut::Refused),
        (DECAY, LeftOut::Refused),
    ],
    needs: &[],
    takes: &["mode", "memory"],
    write_defaults: no_defaults,
    make: Make::Steady(|p, _| {
        Ok(Arc::new(Polach {
            mu_static: p.value(STATIC),
            ratio: p.value(RATIO),
            decay: p.value(DECAY),
        }))
    }),
};

/// `mu(s) = mu_0 ((1 - A) exp(-B |s|) + A)` (Polach 2005, Wear 258: 992): Eq. (8) of Vollebregt (2017) with
/// `mu_dynamic = A mu_0`, in other parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polach {
    /// Coefficient at rest `mu_0`, the largest.
    pub mu_static: f64,
    /// Ratio `A` of the coefficient at infinite slip speed to `mu_0`.
    pub ratio: f64,
    /// Rate of decay `B` (s/m).
    pub decay: f64,
}

impl FrictionLaw for Polach {
    fn mu(&self, slip_speed: f64) -> f64 {
        let left = libm::exp(-self.decay * slip_speed);
        self.mu_static * ((1.0 - self.ratio) * left + self.ratio)
    }

    fn mu_static(&self) -> f64 {
        self.mu_static
    }

    fn slope(&self, slip_speed: f64) -> f64 {
        let left = libm::exp(-self.decay * slip_speed);
        -self.mu_static * (1.0 - self.ratio) * self.decay * left
    }

    fn as_exponential(&self) -> Option<Exponential> {
        let Self { mu_static, ratio, decay } = *self;
        Some(Exponential { mu_static, mu_dynamic: ratio * mu_static, decay })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficient_and_slope_are_those_of_the_closed_form() {
        // 0.55 (0.6 exp(-0.6 s) + 0.4); exp(-0.6) and exp(-6) by an independent calculation (25-digit decimals)
        let law = Polach { mu_static: 0.55, ratio: 0.4, decay: 0.6 };
        for (s, left) in [(0.0, 1.0), (1.0, 0.548_811_636_094_026_4), (10.0, 2.478_752_176_666_358_4e-3)]
        {
            let mu = 0.22 + 0.33 * left;
            assert!((law.mu(s) - mu).abs() < 1e-15, "{s}: {} {mu}", law.mu(s));
            assert!((law.slope(s) + 0.198 * left).abs() < 1e-15, "{s}: {}", law.slope(s));
        }
        assert!((law.mu(1e3) - 0.22).abs() < 1e-15);
    }

    #[test]
    fn it_is_equation_8_in_other_parameters() {
        let law = Polach { mu_static: 0.3, ratio: 0.4, decay: 0.2 };
        let same = law.as_exponential().unwrap();
        for s in [0.0, 1e-3, 0.7, 30.0] {
            assert!((law.mu(s) - same.mu(s)).abs() < 1e-15, "{s}");
        }
    }
}
