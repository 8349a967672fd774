//! Coulomb's law.

use crate::declaration::{Make, no_defaults};
use crate::{Declaration, FrictionLaw, LeftOut, Number};

/// `static`, of most laws.
pub const STATIC: Number = Number {
    path: "friction.static",
    unit: "-",
    range: [0.0, 5.0],
    sentence: "Coefficient of friction at zero slip velocity (dimensionless).",
    remedy: "give the coefficient of friction: `static = 0.5`",
};

pub(crate) const DECLARATION: Declaration = Declaration {
    word: "coulomb",
    sentence: "A constant coefficient.",
    coefficient: "one coefficient, `static`",
    numbers: &[(STATIC, LeftOut::Refused)],
    needs: &[],
    takes: &[],
    write_defaults: no_defaults,
    make: Make::Constant(|p| Coulomb { mu: p.value(STATIC) }),
};

/// Coulomb's law: one coefficient at every slip speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// Coefficient of friction.
    pub mu: f64,
}

impl FrictionLaw for Coulomb {
    fn mu(&self, _slip_speed: f64) -> f64 {
        self.mu
    }

    fn mu_static(&self) -> f64 {
        self.mu
    }

    fn slope(&self, _slip_speed: f64) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coulomb_law_ignores_the_slip_speed() {
        let law = Coulomb { mu: 0.3 };
        assert_eq!(FrictionLaw::mu(&law, 0.0), FrictionLaw::mu(&law, 40.0));
        assert_eq!(FrictionLaw::mu_static(&law), 0.3);
    }
}
