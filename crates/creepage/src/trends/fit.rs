//! Fits of the forms by which a measure tends to its limit, and the limit's interval.
//!
//! Points count in proportion to their refinement r, so that the last ones decide (Eça and Hoekstra, J. Comput. Phys.
//! 262, 2014, whose weights are 1/h).

use super::trend::Sample;

/// A form by which a measure tends to its limit as the refinement r grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// v = `v_inf` + c r^-q with a free q: Richardson's extrapolation (Richardson 1911; Roache 1994).
    ///
    /// For q -> 0 it becomes growth by the logarithm, for q < 0 growth by a power: neither has a limit.
    Power,
    /// 1/v = 1/`v_inf` + c/r: bodies and springs of the stiffness r in series, whose flexibilities add.
    ///
    /// By the simplified theory (Kalker, Vehicle Syst. Dyn. 11, 1982) a patch that sticks carries
    /// T = 8 a^2 b xi/(3 L) at the creepage xi, and friction springs raise its flexibility L to L + `1/k_t`: N/T is
    /// linear in `1/k_t`. Where much of the patch slips, T is bounded by mu N and the form does not hold.
    Series,
}

/// A form fitted to points by weighted least squares.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    /// `v_inf`; for [`Form::Power`] infinite or not a number where q is not positive.
    pub limit: f64,
    /// q; for [`Form::Series`] that which 1/v = 1/`v_inf` + c r^-q would have.
    pub exponent: f64,
    /// Weighted root mean square of what the points miss the fit by.
    pub residual: f64,
    /// Weighted standard deviation of the values.
    pub spread: f64,
}

/// Smallest and largest exponent of the search. What falls with the largest is a step, after which nothing changes.
pub(super) const EXPONENTS: [f64; 2] = [-3.0, 6.0];
/// Steps of the search per unit of the exponent.
const STEPS: f64 = 100.0;
/// Exponents of 1/v with which springs in series are seen; a noisy 1 lies between them.
const SERIES: [f64; 2] = [2.0 / 3.0, 1.5];
/// A limit is uncertain by this share of what is extrapolated (a factor of safety of 1.25; Roache 1994).
const EXTRAPOLATED: f64 = 0.25;

impl Form {
    /// Number of parameters of the form.
    pub fn parameters(self) -> usize {
        match self {
            Self::Power => 3,
            Self::Series => 2,
        }
    }

    /// The fit to points by rising r; `None` where the form has none.
    pub fn fit(self, points: &[Sample]) -> Option<Fit> {
        match self {
            Self::Power => power(points),
            Self::Series => series(points),
        }
    }

    /// Half the width of the interval of the limit that `fit` found.
    ///
    /// The uncertainty of each point moves the limit: half the width of its 95 % interval, and at least twice the
    /// standard deviation of the points about the fit. Where the points determine the fit and nothing is left to
    /// scatter, a point without an interval has its standard deviation over the records. Beside that stands what the
    /// form itself leaves open: how far the limit moves without the coarsest point, and [`EXTRAPOLATED`].
    pub fn half(self, points: &[Sample], fit: &Fit) -> f64 {
        let free = points.len() - self.parameters();
        let about = 2.0 * fit.residual * (points.len() as f64 / free.max(1) as f64).sqrt();
        let limit = |points: &[Sample]| self.fit(points).map_or(f64::INFINITY, |fit| fit.limit);
        let mut moved = points.to_vec();
        let mut squares = 0.0;
        for (i, point) in points.iter().enumerate() {
            let half = match free {
                0 => point.half.or(point.deviation).unwrap_or(0.0),
                _ => point.half.unwrap_or(0.0).max(about),
            };
            moved[i].value += half;
            squares += (limit(&moved) - fit.limit).powi(2);
            moved[i].value = point.value;
        }
        let without = if free > 0 { (limit(&points[1..]) - fit.limit).abs() } else { 0.0 };
        let beyond = EXTRAPOLATED * (points[points.len() - 1].value - fit.limit).abs();
        (squares + without.max(beyond).powi(2)).sqrt()
    }
}

fn power(points: &[Sample]) -> Option<Fit> {
    let of = |p: &Sample| (p.x, p.value, p.x);
    let (limit, exponent, squares) = free_power(points.iter().map(of))?;
    Some(Fit { limit, exponent, residual: squares.sqrt(), spread: spread(points) })
}

fn series(points: &[Sample]) -> Option<Fit> {
    let last = points[points.len() - 1].value;
    if points.iter().any(|p| p.value * last <= 0.0) {
        return None;
    }
    // 1/v errs by 1/v^2 times the error of v
    let of = |shape: fn(f64) -> f64| {
        move |p: &Sample| (shape(p.x), 1.0 / p.value, p.x * p.value.powi(4))
    };
    let (at_infinity, slope, _) = line(points.iter().map(of(|r| 1.0 / r)))?;
    if at_infinity * last <= 0.0 || slope * last <= 0.0 {
        return None;
    }
    // two points have the form whatever they are
    let exponent = match points.len() {
        2 => 1.0,
        _ => free_power(points.iter().map(of(|r| r)))?.1,
    };
    if !(SERIES[0]..=SERIES[1]).contains(&exponent) {
        return None;
    }
    let missed = |p: &Sample| p.x * (p.value - 1.0 / (at_infinity + slope / p.x)).powi(2);
    let weights: f64 = points.iter().map(|p| p.x).sum();
    let residual = (points.iter().map(missed).sum::<f64>() / weights).sqrt();
    Some(Fit { limit: 1.0 / at_infinity, exponent, residual, spread: spread(points) })
}

/// The best power through (r, value, weight): value for r without bound, exponent, weighted mean square residual.
fn free_power(points: impl Iterator<Item = (f64, f64, f64)> + Clone) -> Option<(f64, f64, f64)> {
    let first = points.clone().next()?.0;
    let mut best: Option<(f64, f64, f64)> = None;
    let [from, to] = EXPONENTS.map(|q| (STEPS * q) as i32);
    for i in from..=to {
        let q = f64::from(i) / STEPS;
        // (r^-q - 1)/q is regular at q = 0, where it is -ln r
        let shape = |r: f64| {
            let log = libm::log(r / first);
            if i == 0 { -log } else { (libm::exp(-q * log) - 1.0) / q }
        };
        let shaped = points.clone().map(|(r, value, weight)| (shape(r), value, weight));
        let Some((at_zero, slope, squares)) = line(shaped) else {
            continue;
        };
        if best.is_none_or(|(.., least)| squares < least) {
            // r -> infinity: the shape goes to -1/q
            best = Some((at_zero - slope / q, q, squares));
        }
    }
    best
}

/// Straight line through (shape, value, weight) by least squares: value at 0, slope, weighted mean square residual.
fn line(points: impl Iterator<Item = (f64, f64, f64)> + Clone) -> Option<(f64, f64, f64)> {
    let sum = |of: fn((f64, f64, f64)) -> f64| points.clone().map(of).sum::<f64>();
    let weights = sum(|p| p.2);
    let (x, y) = (sum(|p| p.2 * p.0) / weights, sum(|p| p.2 * p.1) / weights);
    let (xx, xy) = points.clone().fold((0.0, 0.0), |(xx, xy), (a, b, w)| {
        (xx + w * (a - x) * (a - x), xy + w * (a - x) * (b - y))
    });
    let slope = xy / xx;
    let squares: f64 = points.map(|(a, b, w)| w * (b - y - slope * (a - x)).powi(2)).sum();
    slope.is_finite().then_some((y - slope * x, slope, squares / weights))
}

/// Weighted standard deviation of the values.
fn spread(points: &[Sample]) -> f64 {
    let weights: f64 = points.iter().map(|p| p.x).sum();
    let mean = points.iter().map(|p| p.x * p.value).sum::<f64>() / weights;
    (points.iter().map(|p| p.x * (p.value - mean).powi(2)).sum::<f64>() / weights).sqrt()
}

/// d ln|v| / d ln r by least squares; NaN where v changes sign or is zero.
pub(super) fn log_slope(points: &[Sample]) -> f64 {
    let one_sign = points.iter().all(|p| p.value * points[0].value > 0.0);
    let logs = points.iter().map(|p| (libm::log(p.x), libm::log(p.value.abs()), 1.0));
    line(logs).filter(|_| one_sign).map_or(f64::NAN, |(_, slope, _)| slope)
}
