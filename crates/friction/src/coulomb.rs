//! Coulomb's law.

use crate::FrictionLaw;

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
