//! Friction given by points.

use crate::declaration::{Make, no_defaults};
use crate::law::Strengthens;
use crate::{Declaration, FrictionLaw};
use std::sync::Arc;
use thiserror::Error;

pub(crate) const DECLARATION: Declaration = Declaration {
    word: "table",
    sentence: "A coefficient by points.",
    coefficient: "",
    numbers: &[],
    needs: &["table"],
    takes: &["mode", "memory"],
    write_defaults: no_defaults,
    make: Make::Steady(|p, _| Ok(Arc::new(Table::new(p.table.clone().unwrap_or_default())?))),
};

/// `mu(|s|)` by linear interpolation between points; beyond the last point it stays constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    points: Vec<[f64; 2]>,
}

/// Least difference of the slip speeds of neighbouring points (m/s): the slope between closer ones is round-off.
const LEAST_RISE: f64 = 1e-12;

/// Why points define no friction law.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum TableError {
    /// No points.
    #[error("the friction table is empty; give at least one point (slip speed in m/s, mu)")]
    Empty,
    /// A number is negative or not finite.
    #[error(
        "point {number} of the friction table, slip speed {speed} m/s and mu {mu}: both must be finite and at least 0"
    )]
    Range {
        /// Number of the point, from 1.
        number: usize,
        /// Its slip speed (m/s).
        speed: f64,
        /// Its coefficient.
        mu: f64,
    },
    /// The first point is not at rest.
    #[error(
        "the friction table starts at the slip speed {speed} m/s; its first point must be at 0, the coefficient at rest"
    )]
    Start {
        /// Slip speed of the first point (m/s).
        speed: f64,
    },
    /// Slip speeds do not rise.
    #[error(
        "point {number} of the friction table has the slip speed {speed} m/s, which must be above that of the point before, {before} m/s, by {:e} m/s or more",
        LEAST_RISE
    )]
    Order {
        /// Number of the point, from 1.
        number: usize,
        /// Its slip speed (m/s).
        speed: f64,
        /// Slip speed of the point before (m/s).
        before: f64,
    },
}

impl Table {
    /// A law through `points` (slip speed in m/s, coefficient), the first at rest, slip speeds
    /// strictly rising.
    ///
    /// # Errors
    /// [`TableError`]: no points, a number that is negative or not finite, speeds that do not rise, or a first speed
    /// above zero.
    pub fn new(points: Vec<[f64; 2]>) -> Result<Self, TableError> {
        let Some(&[first, _]) = points.first() else { return Err(TableError::Empty) };
        for (i, &[speed, mu]) in points.iter().enumerate() {
            let number = i + 1;
            if !(speed >= 0.0 && mu >= 0.0 && speed.is_finite() && mu.is_finite()) {
                return Err(TableError::Range { number, speed, mu });
            }
            if i > 0 && speed < points[i - 1][0] + LEAST_RISE {
                return Err(TableError::Order { number, speed, before: points[i - 1][0] });
            }
        }
        if first > 0.0 {
            return Err(TableError::Start { speed: first });
        }
        Ok(Self { points })
    }

    /// The points (slip speed in m/s, coefficient).
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }
}

impl FrictionLaw for Table {
    fn mu(&self, slip_speed: f64) -> f64 {
        let after = self.points.partition_point(|p| p[0] <= slip_speed);
        match (self.points.get(after.wrapping_sub(1)), self.points.get(after)) {
            (Some(&[s0, mu0]), Some(&[s1, mu1])) => {
                mu0 + (mu1 - mu0) * (slip_speed - s0) / (s1 - s0)
            }
            (Some(&[_, mu]), None) | (None, Some(&[_, mu])) => mu,
            (None, None) => 0.0,
        }
    }

    fn mu_static(&self) -> f64 {
        self.points.first().map_or(0.0, |p| p[1])
    }

    fn fall_at_rest(&self) -> f64 {
        match self.points() {
            [a, b, ..] => (a[1] - b[1]) / (b[0] - a[0]),
            _ => 0.0,
        }
    }

    fn strengthens(&self) -> Option<Strengthens> {
        self.points.windows(2).find_map(|pair| Strengthens::between([pair[0], pair[1]]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_interpolates_linearly_and_stays_constant_beyond_its_end() {
        let law = Table::new(vec![[0.0, 0.5], [1.0, 0.4], [3.0, 0.3]]).unwrap();
        for (s, mu) in [(0.0, 0.5), (0.5, 0.45), (1.0, 0.4), (2.0, 0.35), (3.0, 0.3), (9.0, 0.3)] {
            assert!((law.mu(s) - mu).abs() < 1e-15, "{s}");
        }
        assert_eq!(law.mu_static(), 0.5);
    }

    #[test]
    fn bad_tables_are_refused_with_the_number_of_the_point() {
        assert_eq!(Table::new(Vec::new()), Err(TableError::Empty));
        assert_eq!(Table::new(vec![[0.1, 0.5]]), Err(TableError::Start { speed: 0.1 }));
        let order = TableError::Order { number: 3, speed: 1.0, before: 1.0 };
        assert_eq!(Table::new(vec![[0.0, 0.5], [1.0, 0.4], [1.0, 0.3]]), Err(order));
        let order = TableError::Order { number: 2, speed: 1e-300, before: 0.0 };
        assert_eq!(Table::new(vec![[0.0, 0.5], [1e-300, 0.3]]), Err(order));
        let nan = Table::new(vec![[0.0, 0.5], [1.0, f64::NAN]]);
        assert!(matches!(nan, Err(TableError::Range { number: 2, .. })));
    }
}
