//! The steady friction laws that a user can choose by name.

use crate::expression::{self, Expression};
use crate::{Coulomb, Exponential, FrictionLaw, NodeConditions, Table};
use thiserror::Error;

/// A friction law without state, as plain data.
#[derive(Clone, Debug)]
pub enum SteadyLaw {
    /// One coefficient.
    Coulomb(Coulomb),
    /// Eq. (8) of Vollebregt (2017).
    Exponential(Exponential),
    /// Points.
    Table(Table),
    /// A formula.
    Expression(Expression),
}

/// A law in which friction rises with slip speed where that was not allowed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "friction rises with slip speed, from mu = {before} at {slower} m/s to {after} at {faster} m/s"
)]
pub struct Strengthens {
    /// A slip speed (m/s).
    pub slower: f64,
    /// A larger one (m/s).
    pub faster: f64,
    /// Coefficient at the first.
    pub before: f64,
    /// Coefficient at the second.
    pub after: f64,
}

impl SteadyLaw {
    /// `-mu'(0)`, the slope with which friction falls at the onset of slip (s/m). A formula must depend on the slip
    /// speed alone.
    pub fn fall_at_rest(&self) -> f64 {
        match self {
            Self::Coulomb(_) => 0.0,
            Self::Exponential(law) => law.decay * (law.mu_static - law.mu_dynamic),
            Self::Table(law) => match law.points() {
                [a, b, ..] => (a[1] - b[1]) / (b[0] - a[0]),
                _ => 0.0,
            },
            // second-order one-sided difference
            Self::Expression(law) => {
                let h = 1e-6;
                (3.0 * law.mu_static() - 4.0 * law.mu(h) + law.mu(2.0 * h)) / (2.0 * h)
            }
        }
    }

    /// Two slip speeds between which friction rises, if it does. A formula is evaluated from 1e-9 to 1e3 m/s, at zero
    /// pressure, time and position.
    pub fn strengthens(&self) -> Option<Strengthens> {
        let rise = |pair: [[f64; 2]; 2]| {
            let [[slower, before], [faster, after]] = pair;
            // rounding in a formula does not count as a rise
            (after > before * (1.0 + 1e-12)).then_some(Strengthens {
                slower,
                faster,
                before,
                after,
            })
        };
        match self {
            Self::Coulomb(_) => None,
            Self::Exponential(law) => {
                let far = if law.decay > 0.0 { f64::INFINITY } else { 0.0 };
                rise([[0.0, law.mu_static], [far, law.mu(far)]])
            }
            Self::Table(law) => law.points().windows(2).find_map(|w| rise([w[0], w[1]])),
            Self::Expression(law) => {
                let tried: Vec<_> = expression::trial_speeds().map(|s| [s, law.mu(s)]).collect();
                tried.windows(2).find_map(|w| rise([w[0], w[1]]))
            }
        }
    }
}

impl FrictionLaw for SteadyLaw {
    #[inline]
    fn mu(&self, slip_speed: f64) -> f64 {
        match self {
            Self::Coulomb(law) => law.mu(slip_speed),
            Self::Exponential(law) => law.mu(slip_speed),
            Self::Table(law) => law.mu(slip_speed),
            Self::Expression(law) => law.mu(slip_speed),
        }
    }

    fn mu_static(&self) -> f64 {
        match self {
            Self::Coulomb(law) => law.mu_static(),
            Self::Exponential(law) => law.mu_static(),
            Self::Table(law) => law.mu_static(),
            Self::Expression(law) => law.mu_static(),
        }
    }

    fn slope(&self, slip_speed: f64) -> f64 {
        match self {
            Self::Coulomb(law) => law.slope(slip_speed),
            Self::Exponential(law) => law.slope(slip_speed),
            Self::Table(law) => law.slope(slip_speed),
            Self::Expression(law) => law.slope(slip_speed),
        }
    }

    fn mu_at(&self, slip_speed: f64, at: &NodeConditions) -> f64 {
        match self {
            Self::Expression(law) => law.mu_at(slip_speed, at),
            _ => self.mu(slip_speed),
        }
    }

    fn slope_at(&self, slip_speed: f64, at: &NodeConditions) -> f64 {
        match self {
            Self::Expression(law) => law.slope_at(slip_speed, at),
            _ => self.slope(slip_speed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };

    #[test]
    fn the_slope_at_rest_is_that_of_the_law() {
        assert_eq!(SteadyLaw::Coulomb(Coulomb { mu: 0.3 }).fall_at_rest(), 0.0);
        assert!((SteadyLaw::Exponential(PAPER).fall_at_rest() - 1.08).abs() < 1e-15);
        let table = Table::new(vec![[0.0, 0.5], [0.5, 0.4], [9.0, 0.3]]).unwrap();
        assert!((SteadyLaw::Table(table).fall_at_rest() - 0.2).abs() < 1e-15);
        let formula = Expression::new("0.32 + 0.18*exp(-6*s)").unwrap();
        assert!((SteadyLaw::Expression(formula).fall_at_rest() - 1.08).abs() < 1e-8);
    }

    #[test]
    fn laws_that_rise_with_slip_speed_are_found() {
        let rising = Exponential { mu_static: 0.3, mu_dynamic: 0.4, decay: 6.0 };
        assert!(SteadyLaw::Exponential(rising).strengthens().is_some());
        assert_eq!(SteadyLaw::Exponential(PAPER).strengthens(), None);
        let hump = Table::new(vec![[0.0, 0.5], [1.0, 0.4], [2.0, 0.45]]).unwrap();
        let found = SteadyLaw::Table(hump).strengthens().unwrap();
        assert_eq!((found.slower, found.faster), (1.0, 2.0));
        let formula = |text| SteadyLaw::Expression(Expression::new(text).unwrap());
        assert!(formula("0.3 + 0.1*tanh(s)").strengthens().is_some());
        assert_eq!(formula("0.3 + 0.1*exp(-s)").strengthens(), None);
    }
}
