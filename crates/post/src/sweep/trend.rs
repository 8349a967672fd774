//! Whether a measure converges along an axis.
//!
//! The trend fitted to the points is v(r) = v_inf + c r^-q with r = x, or r = 1/x for axes that are
//! refined towards zero, so that r grows with refinement. This is the form of Richardson's
//! extrapolation (Richardson 1911; Roache 1994), with q left free. For q -> 0 it becomes growth by
//! the logarithm, for q < 0 growth by a power: neither has a limit.

use crate::digits::digits;

/// A measure at one value of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Value of the axis, greater than zero.
    pub x: f64,
    /// The measure, in its unit.
    pub value: f64,
    /// Its uncertainty, in its unit: the width of its 95 % confidence interval, else its standard deviation over
    /// the window; zero where neither is known.
    pub scatter: f64,
}

/// The trend of a measure along an axis; values in the unit of the measure.
#[derive(Clone, Debug, PartialEq)]
pub enum Trend {
    /// The measure changes by no more than 2 % over the whole axis: it is on its plateau.
    Flat {
        /// Mean over all points.
        mean: f64,
        /// Largest less smallest value.
        range: f64,
    },
    /// It converges, and the last point is within 5 % of the limit.
    Reached {
        /// The limit v_inf.
        limit: f64,
        /// q.
        exponent: f64,
    },
    /// It converges, but the last point is farther from the limit.
    Approaches {
        /// The limit v_inf.
        limit: f64,
        /// q.
        exponent: f64,
        /// |v - v_inf| of the last point over |v_inf|.
        left: f64,
    },
    /// It falls to zero by a power.
    Vanishes {
        /// q: v ~ r^-q.
        exponent: f64,
    },
    /// It has no limit.
    Grows {
        /// d ln|v| / d ln r over the last points.
        slope: f64,
        /// Change of v from the second to last point to the last.
        step: f64,
    },
    /// Its scatter is as large as the change, or too large to tell a limit.
    Hidden {
        /// Mean over all points.
        mean: f64,
        /// Largest less smallest value.
        range: f64,
        /// Mean scatter of the points.
        scatter: f64,
    },
    /// The points allow no verdict for another reason.
    Unclear {
        /// The reason, as half a sentence.
        reason: String,
    },
}

/// The verdict on a trend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Further refinement would not change the measure.
    Settles,
    /// Further refinement would change it.
    DoesNot,
    /// The points allow no verdict.
    CannotBeTold,
}

/// The rule of the verdicts, for people.
pub const RULE: &str = "Settles: the values differ by at most 2 % of the largest, or q is at least \
    0.25 and the last value is within 5 % of v\u{221e}; and the scatter, the width of the 95 % confidence \
    interval of the mean (of an ensemble by its members, of a run by batches in time; without one the \
    standard deviation over the records of the window), is at most 5 %. Does not settle: q is at most 0.1, \
    the last value is farther from v\u{221e}, or \
    v\u{221e} is zero. Cannot be told (scatter): the values differ by no more than the scatter, or the \
    scatter is above 5 % where the values alone would say that it settles. Cannot be told: \
    fewer than three points, no trend that the fit follows, or q in between.";

/// A measure is flat where its range is at most this share of its largest absolute value.
const FLAT: f64 = 0.02;
/// A limit is reached within this share of it, and no scatter beyond this share lets anything settle.
const REACHED: f64 = 0.05;
/// A fit holds where its root mean square residual is below this share of the range of values.
const RESIDUAL: f64 = 0.08;
/// A step against the overall direction counts as a turn where it exceeds this share of the range.
const TURN: f64 = 0.05;
/// From this exponent on there is a limit: each decade of refinement leaves at most 56 % of the distance to it.
const SETTLES: f64 = 0.25;
/// Up to this exponent there is none: each decade adds at least 79 % of what the one before did.
const GOES_ON: f64 = 0.1;

/// Largest exponent of the fit.
const STEEPEST: f64 = 6.0;

/// The trend of a measure along an axis, refined towards zero or upwards; `samples` in any order.
///
/// 1. Fewer than three points say nothing about a limit.
/// 2. *Flat*: the range of the values is below `FLAT` of the largest, and the mean scatter below
///    `REACHED` of it. *Hidden*: otherwise, where the range is below that scatter.
/// 3. A measure that turns back by more than `TURN` of its range, and by more than the mean
///    scatter, follows no such trend.
/// 4. Otherwise the fit must hold: its root mean square residual is below `RESIDUAL` of the range,
///    or below the mean scatter. Three points determine the fit and cannot contradict it;
///    [`Trend::sentence`] says so.
/// 5. q >= `SETTLES`: a limit. It is zero where |v| falls from the first point to the last and |v_inf| is
///    below `REACHED` of the range or has the other sign than the last value; it is *reached* where the
///    last point is within `REACHED` of it. Where the scatter of the last point exceeds `REACHED` of the
///    limit and is no less than its distance from it, the limit is *hidden*. q <= `GOES_ON`: no limit. In
///    between there is no verdict.
pub fn trend(samples: &[Sample], towards_zero: bool) -> Trend {
    let mut points: Vec<Sample> = samples
        .iter()
        .filter(|s| s.x > 0.0 && [s.x, s.value, s.scatter].iter().all(|n| n.is_finite()))
        .map(|s| Sample { x: if towards_zero { 1.0 / s.x } else { s.x }, ..*s })
        .collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    let unclear = |reason: String| Trend::Unclear { reason };
    let n = points.len();
    if n < 3 {
        return unclear(format!("{n} points; three are the least"));
    }
    if points.windows(2).any(|pair| pair[0].x == pair[1].x) {
        return unclear("the axis takes a value twice".into());
    }
    let values = || points.iter().map(|p| p.value);
    let range = values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min);
    let largest = values().fold(0.0, |most: f64, v| most.max(v.abs()));
    let noise = points.iter().map(|p| p.scatter).sum::<f64>() / n as f64;
    let mean = values().sum::<f64>() / n as f64;
    if range <= FLAT * largest && noise <= REACHED * largest {
        return Trend::Flat { mean, range };
    }
    if range <= noise {
        return Trend::Hidden { mean, range, scatter: noise };
    }
    let way = points[n - 1].value - points[0].value;
    let against = |pair: &[Sample]| -(pair[1].value - pair[0].value) * way.signum();
    let turn = points.windows(2).map(against).fold(0.0, f64::max);
    if turn > (TURN * range).max(noise) {
        let share = digits(100.0 * turn / range, 2);
        return unclear(format!("the measure turns back on its way, by {share} % of its range"));
    }
    let fit = Fit::to(&points);
    if fit.residual > (RESIDUAL * range).max(noise) {
        let share = digits(100.0 * fit.residual / range, 2);
        return unclear(format!(
            "the points scatter about the fitted trend by {share} % of the range"
        ));
    }
    let last = points[n - 1];
    if fit.exponent <= GOES_ON {
        let before = points[n - 2];
        // over the last three points, least squares; only where v has one sign
        let slope = log_slope(&points[n - 3..]);
        return Trend::Grows { slope, step: last.value - before.value };
    }
    if fit.exponent < SETTLES {
        return unclear(format!(
            "the fitted exponent q = {} lies between growth without end and a limit",
            digits(fit.exponent, 2)
        ));
    }
    let (limit, exponent) = (fit.limit, fit.exponent);
    let falls = values().next().is_some_and(|first| first.abs() > last.value.abs());
    if falls && (limit.abs() <= REACHED * range || limit * last.value < 0.0) {
        return Trend::Vanishes { exponent: -log_slope(&points[n - 3..]) };
    }
    let away = (last.value - limit).abs();
    let near = REACHED * limit.abs();
    if last.scatter > near && last.scatter >= away {
        Trend::Hidden { mean, range, scatter: last.scatter }
    } else if away <= near {
        Trend::Reached { limit, exponent }
    } else {
        Trend::Approaches { limit, exponent, left: away / limit.abs() }
    }
}

impl Trend {
    /// The verdict.
    pub fn verdict(&self) -> Verdict {
        match self {
            Self::Flat { .. } | Self::Reached { .. } => Verdict::Settles,
            Self::Approaches { .. } | Self::Vanishes { .. } | Self::Grows { .. } => {
                Verdict::DoesNot
            }
            Self::Hidden { .. } | Self::Unclear { .. } => Verdict::CannotBeTold,
        }
    }

    /// The verdict in words.
    pub fn word(&self) -> &'static str {
        match (self.verdict(), self) {
            (Verdict::Settles, _) => "settles",
            (Verdict::DoesNot, _) => "does not settle",
            (Verdict::CannotBeTold, Self::Hidden { .. }) => "cannot be told (scatter)",
            (Verdict::CannotBeTold, _) => "cannot be told",
        }
    }

    /// In a sentence, for `points` points of a measure in `unit`.
    pub fn sentence(&self, points: usize, unit: &str) -> String {
        let with = |value: f64| format!("{} {unit}", digits(value, 4)).trim_end().to_owned();
        let power = |q: f64| {
            // the largest exponent of the search: a step, and then no change
            if q < STEEPEST {
                format!("what is left falls with the power {}", digits(q, 2))
            } else {
                "after the first step nothing is left".into()
            }
        };
        let bare =
            if points == 3 { " (three points determine the fit: nothing checks it)" } else { "" };
        match self {
            Self::Flat { mean, range } => {
                format!("Stays at {} within {} over the whole axis.", with(*mean), with(*range))
            }
            Self::Reached { limit, exponent } => {
                format!("Settles at {} and is there; {}{bare}.", with(*limit), power(*exponent))
            }
            Self::Approaches { limit, exponent, left } => format!(
                "Heads for {}; the last point is {} % away, and {}{bare}.",
                with(*limit),
                digits(100.0 * left, 2),
                power(*exponent)
            ),
            Self::Vanishes { exponent } => format!(
                "Falls to zero with the power {} over the last points{bare}.",
                digits(*exponent, 2)
            ),
            Self::Grows { slope, step } => format!(
                "Goes on: the last step changed it by {}, log-log slope {} over the last three \
                 points{bare}.",
                with(*step),
                digits(*slope, 2)
            ),
            Self::Hidden { mean, range, scatter } => format!(
                "Cannot be told: about {}, values {} apart, and a scatter of {} that would hide a change.",
                with(*mean),
                with(*range),
                with(*scatter)
            ),
            Self::Unclear { reason } => format!("Cannot be told: {reason}."),
        }
    }
}

/// v = limit + c r^-q, least squares.
struct Fit {
    limit: f64,
    exponent: f64,
    /// Root mean square.
    residual: f64,
}

impl Fit {
    /// The best of the exponents q from -3 to [`STEEPEST`] in steps of 0.01; limit and c follow from each by
    /// linear least squares.
    fn to(points: &[Sample]) -> Self {
        let mut best = Self { limit: f64::NAN, exponent: 0.0, residual: f64::INFINITY };
        let first = points[0].x;
        for i in -300..=(100.0 * STEEPEST) as i32 {
            let q = 0.01 * f64::from(i);
            // (r^-q - 1)/q is regular at q = 0, where it is -ln r
            let shape = |p: &Sample| {
                let log = libm::log(p.x / first);
                if i == 0 { -log } else { (libm::exp(-q * log) - 1.0) / q }
            };
            let Some((at_zero, slope, residual)) = line(points.iter().map(|p| (shape(p), p.value)))
            else {
                continue;
            };
            if residual < best.residual {
                // r -> infinity: the shape goes to -1/q
                best = Self { limit: at_zero - slope / q, exponent: q, residual };
            }
        }
        best
    }
}

/// Straight line through (shape, value) by least squares: value at 0, slope, rms residual.
fn line(points: impl Iterator<Item = (f64, f64)> + Clone) -> Option<(f64, f64, f64)> {
    let n = points.clone().count() as f64;
    let mean = |of: fn((f64, f64)) -> f64| points.clone().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let (xx, xy) = points
        .clone()
        .fold((0.0, 0.0), |(xx, xy), (a, b)| (xx + (a - x) * (a - x), xy + (a - x) * (b - y)));
    let slope = xy / xx;
    let squares: f64 = points.map(|(a, b)| (b - y - slope * (a - x)).powi(2)).sum();
    slope.is_finite().then_some((y - slope * x, slope, (squares / n).sqrt()))
}

/// d ln|v| / d ln r by least squares; NaN where v changes sign or is zero.
fn log_slope(points: &[Sample]) -> f64 {
    let one_sign = points.iter().all(|p| p.value * points[0].value > 0.0);
    let logs = points.iter().map(|p| (libm::log(p.x), libm::log(p.value.abs())));
    line(logs).filter(|_| one_sign).map_or(f64::NAN, |(_, slope, _)| slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(of: impl Fn(f64) -> f64, xs: &[f64]) -> Vec<Sample> {
        xs.iter().map(|&x| Sample { x, value: of(x), scatter: 0.0 }).collect()
    }

    const DECADES: [f64; 5] = [0.1, 1.0, 10.0, 100.0, 1000.0];

    #[test]
    fn a_planted_plateau_is_found_with_its_limit_and_power() {
        match trend(&sampled(|x| 1.24e3 - 30.0 * libm::pow(x, -0.8), &DECADES), false) {
            Trend::Reached { limit, exponent } => {
                assert!((limit / 1.24e3 - 1.0).abs() < 1e-6, "{limit}");
                assert!((exponent - 0.8).abs() < 1e-6, "{exponent}");
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_mesh_refined_towards_zero_reaches_its_plateau_from_coarse_to_fine() {
        let found = trend(&sampled(|h| 2.0 + 0.1 * h * h, &[2.0, 1.0, 0.5, 0.25]), true);
        assert!(matches!(found, Trend::Reached { limit, .. } if (limit - 2.0).abs() < 1e-6));
        // the same values along an axis refined upwards go away from their limit
        let found = trend(&sampled(|h| 2.0 + 0.1 * h * h, &[2.0, 1.0, 0.5, 0.25]), false);
        assert!(matches!(found, Trend::Grows { .. }), "{found:?}");
    }

    #[test]
    fn a_plateau_that_is_far_is_headed_for_but_not_reached() {
        let found = trend(&sampled(|x| 1.0 - 0.5 * libm::pow(x, -0.3), &DECADES[..4]), false);
        let Trend::Approaches { limit, left, .. } = found else {
            panic!("{found:?}");
        };
        assert!((limit - 1.0).abs() < 1e-3, "{limit}");
        assert!((left - 0.5 * libm::pow(100f64, -0.3)).abs() < 1e-3, "{left}");
    }

    #[test]
    fn growth_by_the_logarithm_and_by_a_power_have_no_plateau() {
        let log = trend(&sampled(|x| 3.0 + 0.4 * libm::log(x), &DECADES), false);
        assert!(matches!(log, Trend::Grows { .. }), "{log:?}");
        let found = trend(&sampled(|x| 0.02 * libm::pow(x, 0.5), &DECADES), false);
        assert!(
            matches!(found, Trend::Grows { slope, .. } if (slope - 0.5).abs() < 1e-9),
            "{found:?}"
        );
        assert_eq!(found.word(), "does not settle");
    }

    #[test]
    fn a_power_that_falls_goes_to_zero_with_its_exponent() {
        let found = trend(&sampled(|x| 0.3 / x.sqrt(), &DECADES), false);
        assert!(
            matches!(found, Trend::Vanishes { exponent } if (exponent - 0.5).abs() < 1e-9),
            "{found:?}"
        );
    }

    #[test]
    fn what_stays_settles_and_what_scatters_cannot_be_told() {
        let found = trend(&sampled(|x| 5.0 + 0.01 * libm::sin(libm::log(x)), &DECADES), false);
        assert!(matches!(found, Trend::Flat { .. }), "{found:?}");
        let zigzag = [1.0, 3.0, 0.5, 2.5, 1.0];
        let points: Vec<Sample> = DECADES
            .iter()
            .zip(zigzag)
            .map(|(&x, value)| Sample { x, value, scatter: 0.0 })
            .collect();
        assert_eq!(trend(&points, false).word(), "cannot be told");
        let turns = sampled(|x| 1.0 + 0.3 / x - 0.1 * (x - 100.0).max(0.0) / 900.0, &DECADES);
        assert!(matches!(trend(&turns[..4], false), Trend::Reached { .. }));
        let mut back = turns;
        back[4].value += 0.4;
        let found = trend(&back, false);
        assert!(found.sentence(5, "").contains("turns back"), "{found:?}");
    }

    fn scattering(values: &[f64], scatter: f64) -> Vec<Sample> {
        let points = DECADES.iter().zip(values);
        points.map(|(&x, &value)| Sample { x, value, scatter }).collect()
    }

    #[test]
    fn a_scatter_that_would_hide_a_change_is_no_plateau() {
        // wrong directions of a sweep of the mesh: they differ by 34.16 degrees
        let found = trend(&scattering(&[70.78, 36.62, 53.7], 40.0), false);
        assert_eq!(found.word(), "cannot be told (scatter)");
        let said = found.sentence(3, "degrees");
        assert!(
            said.contains("34.16 degrees apart") && said.contains("scatter of 40.00"),
            "{said}"
        );
        // values that agree, out of records that do not
        let found = trend(&scattering(&[50.0, 50.1, 50.2], 20.0), false);
        assert_eq!(found.word(), "cannot be told (scatter)");
        assert_eq!(trend(&scattering(&[50.0, 50.1, 50.2], 1.0), false).word(), "settles");
        // a limit that the fit gives, but 30 % of scatter about it
        let way: Vec<f64> =
            DECADES.iter().map(|x| 10.0 - 8.0 * libm::pow(*x, -0.8) * 0.1584).collect();
        assert_eq!(trend(&scattering(&way, 0.1), false).word(), "settles");
        assert_eq!(trend(&scattering(&way, 3.0), false).word(), "cannot be told (scatter)");
    }

    #[test]
    fn a_change_beyond_the_scatter_has_its_verdict() {
        let log: Vec<f64> = DECADES.iter().map(|x| 3.0 + 0.4 * libm::log(*x)).collect();
        assert_eq!(trend(&scattering(&log, 0.2), false).word(), "does not settle");
        assert_eq!(trend(&scattering(&log, 0.2), false).verdict(), Verdict::DoesNot);
    }

    #[test]
    fn two_points_say_nothing_and_repeated_ones_neither() {
        let found = trend(&sampled(|x| x, &[1.0, 2.0]), false);
        assert_eq!(found.sentence(2, ""), "Cannot be told: 2 points; three are the least.");
        assert_eq!(trend(&sampled(|x| x, &[1.0, 1.0, 2.0]), false).word(), "cannot be told");
        assert_eq!(trend(&[], false).word(), "cannot be told");
    }
}
