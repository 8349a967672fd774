//! The friction laws mu(|s|) by which the conditions are judged.

use friction::{Coulomb, Exponential, FrictionLaw, Kind, Parameters};

/// A friction law whose coefficient depends on the slip speed alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// One coefficient.
    Coulomb(Coulomb),
    /// Eq. (8), or a law of its form.
    Exponential(Exponential),
}

impl Law {
    /// The law of these parameters, if it is one of the two.
    pub(crate) fn of(parameters: &Parameters) -> Option<Self> {
        let mu_static = parameters.number("static")?;
        match parameters.law {
            Kind::Coulomb => Some(Self::Coulomb(Coulomb { mu: mu_static })),
            _ => parameters.exponential().map(Self::Exponential),
        }
    }

    /// Coefficient of friction at a slip speed (m/s).
    pub fn mu(&self, speed: f64) -> f64 {
        match self {
            Law::Coulomb(law) => law.mu(speed),
            Law::Exponential(law) => law.mu(speed),
        }
    }

    /// Coefficient of friction at rest.
    pub fn mu_static(&self) -> f64 {
        match self {
            Law::Coulomb(law) => law.mu_static(),
            Law::Exponential(law) => law.mu_static(),
        }
    }

    /// Distance of the point (|s|, p_f/p_n) from the graph of the law, the curve
    /// {s = 0, 0 <= p_f/p_n <= mu_S} and {p_f/p_n = mu(|s|)} of the paper's Figure 7.
    ///
    /// `speed` is |s| (m/s), `mu` the law's coefficient there, `ratio` p_f/p_n. Speeds are divided by `scale`
    /// (m/s). On the falling branch the projection is found by Newton's
    /// iteration from the point's own speed and from rest; the point's own speed itself is a
    /// candidate, so that a point on the graph is at distance 0.
    pub fn distance(&self, speed: f64, mu: f64, ratio: f64, scale: f64) -> f64 {
        let size = |a: f64, b: f64| (a * a + b * b).sqrt();
        let at_rest = size(speed / scale, (ratio - self.mu_static()).max(0.0));
        let mut best = at_rest.min((ratio - mu).abs());
        let Law::Exponential(law) = self else {
            return best;
        };
        if best > 0.0 {
            let per_square = 1.0 / (scale * scale);
            let mut descend = |start: f64, from: f64| {
                let (mut projection, mut mu) = (start, from);
                for _ in 0..30 {
                    // mu' = -k (mu - mu_D), mu'' = k^2 (mu - mu_D)
                    let slope = -law.decay * (mu - law.mu_dynamic);
                    let residual = (projection - speed) * per_square + (mu - ratio) * slope;
                    let gauss = per_square + slope * slope;
                    let newton = gauss - (mu - ratio) * law.decay * slope;
                    // where the distance is not convex, the Gauss-Newton part of its curvature is used
                    let curvature = if newton > 0.5 * gauss { newton } else { gauss };
                    let next = (projection - residual / curvature).max(0.0);
                    // the remaining error is of second order, and so is its effect on the distance
                    let done = (next - projection).abs() <= 1e-3 * scale;
                    (projection, mu) = (next, law.mu(next));
                    if done {
                        break;
                    }
                }
                best = best.min(size((speed - projection) / scale, ratio - mu));
            };
            descend(speed, mu);
            // Below the falling branch, which is convex, there is one projection; above it there may be two.
            if ratio >= mu {
                descend(0.0, law.mu_static);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_from_the_graph_is_that_of_a_search_over_all_of_it() {
        let law = Law::Exponential(Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 });
        let scale = 0.0933;
        for (speed, ratio) in [
            (0.0, 0.2),
            (0.3, 0.1),
            (0.02, 0.48),
            (1.0, 0.33),
            (0.05, 0.7),
            (0.2, 0.32),
            (3.0, 0.5),
        ] {
            let branch = (0..=4_000_000).map(|i| f64::from(i) * 1e-6);
            let sliding = branch
                .map(|s| libm::hypot((speed - s) / scale, ratio - law.mu(s)))
                .fold(f64::INFINITY, f64::min);
            let sticking = libm::hypot(speed / scale, (ratio - 0.5f64).max(0.0));
            let expected = sliding.min(sticking);
            let found = law.distance(speed, law.mu(speed), ratio, scale);
            assert!((found - expected).abs() < 1e-9, "{speed} {ratio}: {found} {expected}");
        }
    }

    #[test]
    fn a_point_on_the_graph_is_at_no_distance() {
        let law = Law::Exponential(Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 });
        assert_eq!(law.distance(0.7, law.mu(0.7), law.mu(0.7), 0.1), 0.0);
        assert_eq!(law.distance(0.0, 0.5, 0.3, 0.1), 0.0);
        let law = Law::Coulomb(Coulomb { mu: 0.5 });
        assert_eq!(law.distance(0.7, 0.5, 0.45, 0.1), 0.5 - 0.45);
    }
}
