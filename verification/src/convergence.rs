//! Mesh convergence: observed order, Richardson's extrapolation, and the uncertainty that follows from them.

use serde::Serialize;

/// A quantity on one mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sample {
    /// Mesh size (m).
    pub size: f64,
    /// The quantity, in its own unit.
    pub value: f64,
}

/// A quantity on meshes of falling size. In formulas index 1 is the finest mesh, and r = h_2/h_1.
///
/// The uncertainty is the grid convergence index of Roache (1994), "Perspective: a method for
/// uniform reporting of grid refinement studies", J. Fluids Eng. 116: a safety factor times the
/// error that Richardson's extrapolation estimates on the finest mesh,
/// `F |f_2 - f_1|/(r^p - 1)`, with F = 1.25 where three meshes show the order p or the theory of
/// the method gives it, and F = 3 where it is assumed.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    samples: Vec<Sample>,
    order: Order,
}

/// Where the order of convergence comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Order {
    /// From the meshes, or this assumed order where they show none.
    Observed(f64),
    /// Known, for values too scattered to show it.
    Scattered(f64),
    /// From theory.
    Theory(f64),
}

/// Observed orders that count as such: below, refinement hardly helps; above, two meshes agree by chance.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 0.5..=4.0;

impl Convergence {
    /// Samples (mesh size in m, value) in any sequence; `assumed` is the order of convergence to use where three
    /// meshes do not show one.
    pub fn new(samples: impl IntoIterator<Item = (f64, f64)>, assumed: f64) -> Self {
        let mut samples: Vec<_> =
            samples.into_iter().map(|(size, value)| Sample { size, value }).collect();
        samples.sort_by(|a, b| b.size.total_cmp(&a.size));
        Self { samples, order: Order::Observed(assumed) }
    }

    /// The same for a quantity whose order is known but whose values scatter, so
    /// that an order observed on three meshes would be chance: `order` is used with the safety factor 3.
    pub fn with_known_order(samples: impl IntoIterator<Item = (f64, f64)>, order: f64) -> Self {
        Self { order: Order::Scattered(order), ..Self::new(samples, order) }
    }

    /// The same for a quantity whose order the theory of the method gives. That order is used to
    /// extrapolate even where the meshes show another. Where the three finest values oscillate, the uncertainty is at
    /// least half their range (Stern, Wilson, Coleman and Paterson 2001, J. Fluids Eng. 123: 793–802).
    pub fn by_theory(samples: impl IntoIterator<Item = (f64, f64)>, order: f64) -> Self {
        Self { order: Order::Theory(order), ..Self::new(samples, order) }
    }

    /// The values, coarse to fine.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The value on the finest mesh; NaN without meshes.
    pub fn finest(&self) -> f64 {
        self.samples.last().map_or(f64::NAN, |s| s.value)
    }

    /// Observed order from the three finest meshes: the p with
    /// `(f_3 - f_2)/(f_2 - f_1) = (h_3^p - h_2^p)/(h_2^p - h_1^p)`. `None` with fewer meshes, for
    /// [`Convergence::with_known_order`], or where p is not between 0.5 and 4.
    pub fn order(&self) -> Option<f64> {
        let [.., c, b, a] = self.samples[..] else { return None };
        if matches!(self.order, Order::Scattered(_)) {
            return None;
        }
        let ratio = (c.value - b.value) / (b.value - a.value);
        let excess = |p: f64| {
            (libm::pow(c.size, p) - libm::pow(b.size, p))
                / (libm::pow(b.size, p) - libm::pow(a.size, p))
                - ratio
        };
        let (mut low, mut high) = (*PLAUSIBLE.start(), *PLAUSIBLE.end());
        // `excess` rises with p
        if !(excess(low) <= 0.0 && excess(high) >= 0.0) {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if excess(middle) <= 0.0 { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }

    /// The order with which the error is estimated, and the safety factor.
    fn used(&self) -> (f64, f64) {
        match self.order {
            Order::Observed(assumed) => self.order().map_or((assumed, 3.0), |p| (p, 1.25)),
            Order::Scattered(p) => (p, 3.0),
            Order::Theory(p) => (p, 1.25),
        }
    }

    /// Half the range of the three finest values, if they oscillate; zero otherwise.
    fn oscillation(&self) -> f64 {
        let [.., c, b, a] = self.samples[..] else { return 0.0 };
        let [c, b, a] = [c, b, a].map(|s| s.value);
        let turns = (c - b) * (b - a) < 0.0;
        if turns { 0.5 * (a.max(b).max(c) - a.min(b).min(c)) } else { 0.0 }
    }

    /// Richardson's estimate of the correction to the finest value.
    fn correction(&self) -> f64 {
        let [.., b, a] = self.samples[..] else { return f64::NAN };
        (a.value - b.value) / (libm::pow(b.size / a.size, self.used().0) - 1.0)
    }

    /// Uncertainty of the finest value, in its unit; infinite for one mesh.
    pub fn uncertainty(&self) -> f64 {
        if self.samples.len() < 2 {
            return f64::INFINITY;
        }
        let index = self.used().1 * self.correction().abs();
        match self.order {
            Order::Theory(_) => index.max(self.oscillation()),
            _ => index,
        }
    }

    /// The value extrapolated to a mesh size of zero with the order given by theory, else the
    /// observed, else the assumed one; NaN with fewer than two meshes.
    pub fn extrapolated(&self) -> f64 {
        self.finest() + self.correction()
    }

    /// How the uncertainty was determined, in words.
    pub fn explain(&self) -> String {
        let seen = match (self.order, self.order()) {
            (Order::Theory(p), Some(seen)) => format!("order {p} by theory, {seen:.2} observed"),
            (Order::Theory(p), None) if self.oscillation() > 0.0 => {
                format!("order {p} by theory, the last three oscillate")
            }
            (Order::Theory(p), None) => format!("order {p} by theory"),
            (_, Some(p)) => format!("order {p:.2}"),
            (_, None) => format!("order {} assumed", self.used().0),
        };
        format!("mesh convergence (GCI, {} meshes, {seen})", self.samples.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_and_limit_of_an_exact_power_law_are_found() {
        let study = Convergence::new([1e-3, 4e-3, 2e-3].map(|h| (h, 7.0 - 3e4 * h * h)), 1.0);
        assert!((study.order().unwrap() - 2.0).abs() < 1e-9);
        assert!((study.extrapolated() - 7.0).abs() < 1e-9);
        assert!((study.uncertainty() - 1.25 * 3e-2).abs() < 1e-9);
        assert_eq!(study.finest(), 7.0 - 3e-2);
    }

    #[test]
    fn meshes_that_show_no_order_widen_the_factor_and_one_mesh_shows_nothing() {
        let noise = Convergence::new([(4.0, 1.0), (2.0, 1.1), (1.0, 1.0)], 1.0);
        assert_eq!(noise.order(), None);
        assert!((noise.uncertainty() - 0.3).abs() < 1e-12);
        let scatter = Convergence::with_known_order([(4.0, 1.7), (2.0, 1.1), (1.0, 1.0)], 1.0);
        assert_eq!(scatter.order(), None);
        assert!((scatter.uncertainty() - 0.3).abs() < 1e-12);
        let theory = Convergence::by_theory([(4.0, 1.0), (2.0, 1.1), (1.0, 1.08)], 1.0);
        assert!((theory.extrapolated() - 1.06).abs() < 1e-12);
        assert!((theory.uncertainty() - 0.05).abs() < 1e-12, "half the range");
        let one = Convergence::new([(1.0, 5.0)], 1.0);
        assert_eq!(one.uncertainty(), f64::INFINITY);
    }
}
