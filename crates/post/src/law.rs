//! The friction law that a run is measured against.

use contact::{Coulomb, Exponential, FrictionLaw};

/// The laws of a case file, with their slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// One coefficient.
    Coulomb(Coulomb),
    /// Eq. (8).
    Exponential(Exponential),
}

impl Law {
    /// Coefficient at a slip speed (m/s).
    pub fn mu(&self, speed: f64) -> f64 {
        match self {
            Law::Coulomb(law) => law.mu(speed),
            Law::Exponential(law) => law.mu(speed),
        }
    }

    /// Coefficient at rest.
    pub fn mu_static(&self) -> f64 {
        match self {
            Law::Coulomb(law) => law.mu_static(),
            Law::Exponential(law) => law.mu_static(),
        }
    }

    /// Its derivative with respect to the slip speed (s/m).
    fn slope(&self, speed: f64) -> f64 {
        match self {
            Law::Coulomb(_) => 0.0,
            Law::Exponential(law) => {
                -law.decay * (law.mu_static - law.mu_dynamic) * (-law.decay * speed).exp()
            }
        }
    }

    /// Distance of the point (|s|, p_f/p_n) from the graph of the law, the curve
    /// {s = 0, 0 <= p_f/p_n <= mu_S} and {p_f/p_n = mu(|s|)} of the paper's Figure 7.
    ///
    /// Speeds are counted in units of `scale` (m/s), coefficients of friction as they are. On the
    /// falling branch the foot is found by Gauss-Newton from the point's own speed and from rest;
    /// the point's own speed itself is a candidate, so that a point on the graph is at distance 0.
    pub fn distance(&self, speed: f64, ratio: f64, scale: f64) -> f64 {
        let at = |foot: f64| ((speed - foot) / scale).hypot(ratio - self.mu(foot));
        let stick = (speed / scale).hypot((ratio - self.mu_static()).max(0.0));
        let mut best = stick.min(at(speed));
        if let (Law::Exponential(_), true) = (self, best > 0.0) {
            for start in [speed, 0.0] {
                let mut foot = start;
                for _ in 0..30 {
                    let slope = self.slope(foot);
                    let residual =
                        (foot - speed) / (scale * scale) + (self.mu(foot) - ratio) * slope;
                    let step = residual / (1.0 / (scale * scale) + slope * slope);
                    let next = (foot - step).max(0.0);
                    let done = (next - foot).abs() <= 1e-9 * scale;
                    foot = next;
                    if done {
                        break;
                    }
                }
                best = best.min(at(foot));
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
                .map(|s| ((speed - s) / scale).hypot(ratio - law.mu(s)))
                .fold(f64::INFINITY, f64::min);
            let sticking = (speed / scale).hypot((ratio - 0.5f64).max(0.0));
            let expected = sliding.min(sticking);
            let found = law.distance(speed, ratio, scale);
            assert!((found - expected).abs() < 1e-9, "{speed} {ratio}: {found} {expected}");
        }
    }

    #[test]
    fn a_point_on_the_graph_is_at_no_distance() {
        let law = Law::Exponential(Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 });
        assert_eq!(law.distance(0.7, law.mu(0.7), 0.1), 0.0);
        assert_eq!(law.distance(0.0, 0.3, 0.1), 0.0);
        let law = Law::Coulomb(Coulomb { mu: 0.5 });
        assert_eq!(law.distance(0.7, 0.45, 0.1), 0.5 - 0.45);
    }
}
