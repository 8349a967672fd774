//! Whether a measure converges along an axis, by its last points and their intervals.

use super::fit::{EXPONENTS, Fit, Form, log_slope};
use crate::check::digits::digits;

/// A measure at one value of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Value of the axis, greater than zero.
    pub x: f64,
    /// The measure, in its unit.
    pub value: f64,
    /// Half the width of its 95 % confidence interval, in its unit, where it has one.
    pub half: Option<f64>,
    /// Its standard deviation over the records of the window, in its unit, where it is known.
    pub deviation: Option<f64>,
}

/// Which way an axis is refined, and what is known of the form of the trends along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refinement {
    /// Towards larger values.
    Upwards,
    /// Towards zero.
    TowardsZero,
    /// Towards stiffer springs, in series with the bodies.
    Springs,
}

/// The limit that the points give, in the unit of the measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asymptote {
    /// `v_inf`.
    pub value: f64,
    /// Half the width of its interval.
    pub half: f64,
    /// |v - `v_inf`| of the last point over |`v_inf`|.
    pub left: f64,
    /// q of v = `v_inf` + c r^-q; `None` where the form is that of springs in series, 1/v = 1/`v_inf` + c/r.
    pub exponent: Option<f64>,
    /// How many of the last points it is fitted to.
    pub points: usize,
}

/// The trend of a measure along an axis; values in the unit of the measure.
#[derive(Clone, Debug, PartialEq)]
pub enum Trend {
    /// The last points differ by no more than 2 %, 5 % where they turn, or than their intervals: it is on its plateau.
    Flat {
        /// Mean over these points.
        mean: f64,
        /// Largest less smallest of their values.
        range: f64,
        /// How many they are.
        points: usize,
    },
    /// It converges, and the last point is within 5 % of the limit.
    Reached(Asymptote),
    /// It converges, but the last point is farther from the limit.
    Approaches(Asymptote),
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
    /// The scatter is as large as the change.
    Hidden {
        /// Mean over the points.
        mean: f64,
        /// Largest less smallest value.
        range: f64,
        /// Mean scatter of the points.
        scatter: f64,
    },
    /// The points give a limit whose interval is too wide to tell whether it is reached.
    Wide(Asymptote),
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
pub const RULE: &str = "Settles: the last points, three or more, differ by at most 2 % of the largest, 5 % where they turn, or by no more \
    than their 95 % confidence intervals, which are at most 5 % wide; or the last point is within 5 % of v\u{221e}, which is \
    known to 5 %. Does not settle: the last point is farther from v\u{221e} than 5 % and than v\u{221e} is uncertain, \
    q is at most 0.1, or v\u{221e} is zero. Cannot be told (scatter): the values differ by no more than the scatter, the \
    width of the interval of the mean (of an ensemble by its members, of a run by batches in time; without one \
    the standard deviation over the records of the window). Cannot be told: fewer than three points, no trend \
    that the fit follows, a v\u{221e} that is less certain, or q from 0.1 to 0.25.";

/// A measure is flat where its range is at most this share of its largest absolute value, or where it turns `REACHED`.
const FLAT: f64 = 0.02;
/// A flat end of a longer axis must span at least this factor: a slow change is small over close points.
const SPANNED: f64 = 1.9;
/// A limit is reached within this share of it, and must be known to it.
const REACHED: f64 = 0.05;
/// A fit holds where what it misses is below this share of the deviation of the values from their mean.
const MISSED: f64 = 0.15;
/// A step against the overall direction counts as a turn where it exceeds this share of the range.
const TURN: f64 = 0.05;
/// Most decimal places of a limit.
const PLACES: f64 = 6.0;
/// From this exponent on there is a limit: each decade of refinement leaves at most 56 % of the distance to it.
const SETTLES: f64 = 0.25;
/// Up to this exponent there is none: each decade adds at least 79 % of what the one before did.
const GOES_ON: f64 = 0.1;

/// The trend of a measure along an axis; `samples` in any order.
///
/// All points are judged, and where they allow no verdict, the last ones without the coarsest, down to three; down to
/// four where the values turn, since one in six sequences of three random values looks as if it converged, but one
/// point at the coarse end may always be left out.
///
/// 1. *Flat*: the range is below `FLAT` of the largest, `REACHED` where the points turn, or below the mean width of the intervals, and that
///    width below `REACHED` of it. *Hidden*: otherwise, where the range is below that width.
/// 2. Points that turn back by more than `TURN` of their range, and by more than that width, follow no trend.
/// 3. Otherwise a form must hold: 1/v = 1/v_inf + c/r for springs (`Form::Series`), or else v = v_inf + c r^-q
///    (`Form::Power`), within `MISSED` of the deviation of the values or within their intervals.
/// 4. q <= `GOES_ON`: no limit. q < `SETTLES`: no verdict. The limit is zero where |v| falls and |v_inf| is below
///    `REACHED` of the range or has the other sign than the last value. Otherwise it is *reached* where the last point
///    is within `REACHED` of it and its interval, too; it is not where the last point is farther away, and
///    farther than the interval reaches.
pub fn trend(samples: &[Sample], refinement: Refinement) -> Trend {
    let towards_zero = refinement == Refinement::TowardsZero;
    let mut points: Vec<Sample> = samples
        .iter()
        .filter(|s| s.x > 0.0 && s.x.is_finite() && s.value.is_finite())
        .map(|s| Sample { x: if towards_zero { 1.0 / s.x } else { s.x }, ..*s })
        .collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    let n = points.len();
    if n < 3 {
        return Trend::Unclear { reason: format!("{n} points; three are the least") };
    }
    if points.windows(2).any(|pair| pair[0].x == pair[1].x) {
        return Trend::Unclear { reason: "the axis takes a value twice".into() };
    }
    let least = if turns(&points) { (n - 1).min(4) } else { 3 }.max(3);
    (3..=n)
        .rev()
        .find_map(|last| {
            let tail = &points[n - last..];
            let fitted = || (last >= least).then(|| fitted(tail, refinement)).flatten();
            still(tail, last < n).or_else(fitted)
        })
        .unwrap_or_else(|| untold(&points))
}

/// Largest less smallest value.
fn range(points: &[Sample]) -> f64 {
    let values = || points.iter().map(|p| p.value);
    values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
}

fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count();
    if count == 0 { 0.0 } else { values.sum::<f64>() / count as f64 }
}

/// Mean width of the intervals of the points; zero where none has one.
fn width(points: &[Sample]) -> f64 {
    2.0 * mean(points.iter().filter_map(|p| p.half))
}

/// Mean scatter of the points: the width of the interval, without one the standard deviation over the records.
fn scatter(points: &[Sample]) -> f64 {
    mean(points.iter().filter_map(|p| p.half.map(|half| 2.0 * half).or(p.deviation)))
}

/// Largest step of the points against their way from the first to the last.
fn turn(points: &[Sample]) -> f64 {
    let way = points[points.len() - 1].value - points[0].value;
    let against = |pair: &[Sample]| -(pair[1].value - pair[0].value) * way.signum();
    points.windows(2).map(against).fold(0.0, f64::max)
}

fn turns(points: &[Sample]) -> bool {
    turn(points) > (TURN * range(points)).max(width(points))
}

/// Points that do not move, or not by more than their intervals; `part` of a longer axis.
fn still(points: &[Sample], part: bool) -> Option<Trend> {
    let (range, width) = (range(points), width(points));
    let largest = points.iter().fold(0.0, |most: f64, p| most.max(p.value.abs()));
    let mean = mean(points.iter().map(|p| p.value));
    let spans = points[points.len() - 1].x >= SPANNED * points[0].x;
    // what goes one way may be slow, and go far; what turns is known to its range
    let share = if turns(points) { REACHED } else { FLAT };
    if range <= (share * largest).max(width) && width <= REACHED * largest {
        return (spans || !part).then_some(Trend::Flat { mean, range, points: points.len() });
    }
    (range <= width).then_some(Trend::Hidden { mean, range, scatter: width })
}

/// The trend of points that follow a form; `None` where they do not.
fn fitted(points: &[Sample], refinement: Refinement) -> Option<Trend> {
    if turns(points) {
        return None;
    }
    let forms = match refinement {
        Refinement::Springs => &[Form::Series, Form::Power][..],
        Refinement::Upwards | Refinement::TowardsZero => &[Form::Power],
    };
    // the steepest fit to three points is that to a step: the two after it say nothing
    let checked = |fit: &Fit| points.len() > 3 || fit.exponent < EXPONENTS[1];
    let holds =
        |fit: &Fit| fit.residual <= (MISSED * fit.spread).max(0.5 * width(points)) && checked(fit);
    let of = |form: &Form| Some((*form, form.fit(points).filter(holds)?));
    let (form, fit) = forms.iter().find_map(of)?;
    Some(match form {
        Form::Series => asymptote(points, form, &fit),
        Form::Power => by_power(points, &fit),
    })
}

/// The trend of points that follow a power.
fn by_power(points: &[Sample], fit: &Fit) -> Trend {
    let tail = &points[points.len() - 3..];
    let (before, last) = (tail[1], tail[2]);
    if fit.exponent <= GOES_ON {
        let step = last.value - before.value;
        // three points determine the fit: nothing but their records says how they scatter
        let scatter = if points.len() > 3 { width(points) } else { scatter(points) };
        if step.abs() <= scatter {
            let mean = mean(points.iter().map(|p| p.value));
            return Trend::Hidden { mean, range: range(points), scatter };
        }
        // over the last three points, least squares; only where v has one sign
        return Trend::Grows { slope: log_slope(tail), step };
    }
    if fit.exponent < SETTLES {
        let q = digits(fit.exponent, 2);
        let reason =
            format!("the fitted exponent q = {q} lies between growth without end and a limit");
        return Trend::Unclear { reason };
    }
    let falls = points[0].value.abs() > last.value.abs();
    let zero = fit.limit.abs() <= REACHED * range(points) || fit.limit * last.value < 0.0;
    if falls && zero {
        return Trend::Vanishes { exponent: -log_slope(tail) };
    }
    asymptote(points, Form::Power, fit)
}

/// Whether the limit of a fit is reached.
fn asymptote(points: &[Sample], form: Form, fit: &Fit) -> Trend {
    let half = form.half(points, fit);
    let away = (points[points.len() - 1].value - fit.limit).abs();
    let near = REACHED * fit.limit.abs();
    let limit = Asymptote {
        value: fit.limit,
        half,
        left: away / fit.limit.abs(),
        exponent: (form == Form::Power).then_some(fit.exponent),
        points: points.len(),
    };
    if away > near && away > half {
        Trend::Approaches(limit)
    } else if away <= near && half <= near {
        Trend::Reached(limit)
    } else {
        Trend::Wide(limit)
    }
}

/// Why points that follow no form allow no verdict.
fn untold(points: &[Sample]) -> Trend {
    let (range, turn) = (range(points), turn(points));
    let scatter = scatter(points);
    if scatter >= turn.max(TURN * range) {
        return Trend::Hidden { mean: mean(points.iter().map(|p| p.value)), range, scatter };
    }
    let reason = if turns(points) {
        let share = digits(100.0 * turn / range, 2);
        format!("the measure turns back on its way, by {share} % of its range")
    } else {
        "no form fits the last points".into()
    };
    Trend::Unclear { reason }
}

impl Asymptote {
    /// "v ± half" to two digits of the half, with the unit.
    fn text(&self, unit: &str) -> String {
        if !self.half.is_finite() {
            return format!("{} {unit}", digits(self.value, 4)).trim_end().to_owned() + ", or none";
        }
        let decimals = 1.0 - libm::floor(libm::log10(self.half));
        let text = if (0.0..=PLACES).contains(&decimals) {
            let fixed =
                |value: f64| format!("{value:.*}", decimals as usize).replace('-', "\u{2212}");
            format!("{} \u{b1} {} {unit}", fixed(self.value), fixed(self.half))
        } else {
            format!("{} \u{b1} {} {unit}", digits(self.value, 4), digits(self.half, 2))
        };
        text.trim_end().into()
    }

    /// How what is left falls.
    fn way(&self) -> String {
        match self.exponent {
            None => "what is left of 1/v falls as 1/k_t: bodies and springs in series".into(),
            Some(q) if q < EXPONENTS[1] => {
                format!("what is left falls with the power {}", digits(q, 2))
            }
            Some(_) => "after the first step nothing is left".into(),
        }
    }

    /// The distance of the last point, and what the fit is made of, out of `points` points.
    fn last(&self, points: usize) -> String {
        let left = digits(100.0 * self.left, 2);
        let bare = if self.points == 3 && self.exponent.is_some() {
            " (three points determine the fit: nothing checks it)"
        } else {
            ""
        };
        let of = if self.points < points {
            format!(", from the last {} points", self.points)
        } else {
            String::new()
        };
        format!("the last point is {left} % away, and {}{of}{bare}", self.way())
    }
}

impl Trend {
    /// The verdict.
    pub fn verdict(&self) -> Verdict {
        match self {
            Self::Flat { .. } | Self::Reached(_) => Verdict::Settles,
            Self::Approaches(_) | Self::Vanishes { .. } | Self::Grows { .. } => Verdict::DoesNot,
            Self::Hidden { .. } | Self::Wide(_) | Self::Unclear { .. } => Verdict::CannotBeTold,
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

    /// What a measure in `unit` does, as half a sentence; `last` is its value at the last point.
    pub fn phrase(&self, last: f64, unit: &str) -> String {
        let with = |value: f64| format!("{} {unit}", digits(value, 4)).trim_end().to_owned();
        match self {
            Self::Flat { mean, .. } => format!("settles at {}", with(*mean)),
            Self::Reached(limit) => format!("settles at {}", limit.text(unit)),
            Self::Approaches(limit) => {
                format!("has not settled at {} and heads for {}", with(last), limit.text(unit))
            }
            Self::Vanishes { .. } => format!("falls to zero, at last {}", with(last)),
            Self::Grows { .. } => format!("does not settle, at last {}", with(last)),
            Self::Hidden { mean, .. } => format!("scatters about {}", with(*mean)),
            Self::Wide(_) | Self::Unclear { .. } => {
                format!("shows no limit that can be told, at last {}", with(last))
            }
        }
    }

    /// The limit and half the width of its interval, where the points give one.
    pub fn limit(&self) -> Option<[f64; 2]> {
        match self {
            Self::Flat { mean, range, .. } => Some([*mean, 0.5 * range]),
            Self::Reached(limit) | Self::Approaches(limit) | Self::Wide(limit) => {
                Some([limit.value, limit.half])
            }
            Self::Vanishes { .. }
            | Self::Grows { .. }
            | Self::Hidden { .. }
            | Self::Unclear { .. } => None,
        }
    }

    /// In a sentence, for `points` points of a measure in `unit`.
    pub fn sentence(&self, points: usize, unit: &str) -> String {
        let with = |value: f64| format!("{} {unit}", digits(value, 4)).trim_end().to_owned();
        let bare =
            if points == 3 { " (three points determine the fit: nothing checks it)" } else { "" };
        match self {
            Self::Flat { mean, range, points: last } => {
                let over = if *last < points {
                    format!("the last {last} points")
                } else {
                    "the whole axis".into()
                };
                format!("Stays at {} within {} over {over}.", with(*mean), with(*range))
            }
            Self::Reached(limit) => {
                format!("Settles at {}; {}.", limit.text(unit), limit.last(points))
            }
            Self::Approaches(limit) => {
                format!("Heads for {}; {}.", limit.text(unit), limit.last(points))
            }
            Self::Wide(limit) => format!(
                "Cannot be told: the points give a limit of {}; {}.",
                limit.text(unit),
                limit.last(points)
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

#[cfg(test)]
mod tests {
    use super::*;

    const DECADES: [f64; 5] = [0.1, 1.0, 10.0, 100.0, 1000.0];

    fn sampled(of: impl Fn(f64) -> f64, xs: &[f64]) -> Vec<Sample> {
        let sample = |&x: &f64| Sample { x, value: of(x), half: None, deviation: None };
        xs.iter().map(sample).collect()
    }

    fn measured(xs: &[f64], values: &[f64], half: Option<f64>) -> Vec<Sample> {
        let points = xs.iter().zip(values);
        points.map(|(&x, &value)| Sample { x, value, half, deviation: None }).collect()
    }

    fn upwards(samples: &[Sample]) -> Trend {
        trend(samples, Refinement::Upwards)
    }

    #[track_caller]
    fn reached(found: Trend) -> Asymptote {
        match found {
            Trend::Reached(limit) => limit,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_planted_plateau_is_found_with_its_limit_and_power() {
        let limit = reached(upwards(&sampled(|x| 1.24e3 - 30.0 * libm::pow(x, -0.8), &DECADES)));
        assert!((limit.value / 1.24e3 - 1.0).abs() < 1e-6, "{limit:?}");
        assert!((limit.exponent.unwrap_or(0.0) - 0.8).abs() < 1e-6, "{limit:?}");
        // a quarter of what is extrapolated from the last point
        let away = 30.0 * libm::pow(1000.0, -0.8);
        assert!((limit.half / (0.25 * away) - 1.0).abs() < 1e-3, "{limit:?}");
        assert!((limit.left / (away / 1.24e3) - 1.0).abs() < 1e-3, "{limit:?}");
    }

    #[test]
    fn a_mesh_refined_towards_zero_reaches_its_plateau_from_coarse_to_fine() {
        let points = sampled(|h| 2.0 + 0.1 * h * h, &[2.0, 1.0, 0.5, 0.25]);
        let limit = reached(trend(&points, Refinement::TowardsZero));
        assert!((limit.value - 2.0).abs() < 1e-6);
        // the same values along an axis refined upwards go away from their limit
        let found = upwards(&points);
        assert!(matches!(found, Trend::Grows { .. }), "{found:?}");
    }

    #[test]
    fn a_plateau_that_is_far_is_headed_for_but_not_reached() {
        let found = upwards(&sampled(|x| 1.0 - 0.5 * libm::pow(x, -0.3), &DECADES[..4]));
        let Trend::Approaches(limit) = found else {
            panic!("{found:?}");
        };
        assert!((limit.value - 1.0).abs() < 1e-3, "{limit:?}");
        assert!((limit.left - 0.5 * libm::pow(100f64, -0.3)).abs() < 1e-3, "{limit:?}");
    }

    #[test]
    fn growth_by_the_logarithm_and_by_a_power_have_no_plateau() {
        for refinement in [Refinement::Upwards, Refinement::Springs] {
            let log = trend(&sampled(|x| 3.0 + 0.4 * libm::log(x), &DECADES), refinement);
            assert!(matches!(log, Trend::Grows { .. }), "{log:?}");
            let found = trend(&sampled(|x| 0.02 * libm::pow(x, 0.5), &DECADES), refinement);
            assert!(
                matches!(found, Trend::Grows { slope, .. } if (slope - 0.5).abs() < 1e-9),
                "{found:?}"
            );
            assert_eq!(found.word(), "does not settle");
        }
    }

    #[test]
    fn a_power_that_falls_goes_to_zero_with_its_exponent() {
        let found = upwards(&sampled(|x| 0.3 / x.sqrt(), &DECADES));
        assert!(
            matches!(found, Trend::Vanishes { exponent } if (exponent - 0.5).abs() < 1e-9),
            "{found:?}"
        );
    }

    #[test]
    fn springs_in_series_have_their_limit_exactly_and_what_is_left_to_it() {
        let points = sampled(|k| 1.0 / (3.06 + 0.14 / k), &[1e-3, 1e-2, 0.1, 1.0, 10.0]);
        let limit = reached(trend(&points, Refinement::Springs));
        assert!((limit.value * 3.06 - 1.0).abs() < 1e-12, "{limit:?}");
        assert!((limit.left - (1.0 - 3.06 / 3.074)).abs() < 1e-9, "{limit:?}");
        assert_eq!(limit.exponent, None);
        // a force of the other sign is the same
        let other: Vec<Sample> = points.iter().map(|p| Sample { value: -p.value, ..*p }).collect();
        assert_eq!(reached(trend(&other, Refinement::Springs)).value, -limit.value);
        // the spring's unit does not matter: SF 0.1 is 3.5e13 N/m^3 at 1 mm
        let scaled: Vec<Sample> = points.iter().map(|p| Sample { x: 3.5e14 * p.x, ..*p }).collect();
        let scaled = reached(trend(&scaled, Refinement::Springs));
        assert!((scaled.value / limit.value - 1.0).abs() < 1e-12);
    }

    /// T/N measured over four decades of `k_t`.
    const SATURATION: [[f64; 5]; 2] =
        [[1e-3, 1e-2, 0.1, 1.0, 10.0], [0.0068, 0.060, 0.234, 0.317, 0.325]];

    #[test]
    fn a_measured_force_that_saturates_over_decades_of_the_spring_settles_at_the_limit_of_its_series()
     {
        let mut points = measured(&SATURATION[0], &SATURATION[1], None);
        let limit = reached(trend(&points, Refinement::Springs));
        // N/T on the straight line through the last two points
        let [softer, stiffer] = [1.0 / 0.317, 1.0 / 0.325];
        let series = 1.0 / (stiffer - (softer - stiffer) / 9.0);
        assert!((limit.value / series - 1.0).abs() < 3e-3, "{limit:?} {series}");
        assert!((limit.value - series).abs() < limit.half && limit.half < 0.01, "{limit:?}");
        assert!(limit.left < 0.01, "{limit:?}");
        let said = Trend::Reached(limit).sentence(5, "");
        assert!(said.contains(" \u{b1} ") && said.contains("in series"), "{said}");
        // in any order
        points.swap(0, 3);
        points.swap(1, 4);
        assert_eq!(reached(trend(&points, Refinement::Springs)), limit);
        // what no spring carries: the last three points have a limit as well
        let by_power = reached(upwards(&points));
        assert!((by_power.value / series - 1.0).abs() < 3e-3, "{by_power:?}");
        assert_eq!(by_power.points, 3);
    }

    #[test]
    fn a_limit_is_told_to_two_digits_of_its_uncertainty() {
        let text = |value, half| {
            Asymptote { value, half, left: 0.0, exponent: None, points: 4 }.text("MPa")
        };
        assert_eq!(text(0.198_037, 9.7e-4), "0.19804 \u{b1} 0.00097 MPa");
        assert_eq!(text(-292.84, 12.3), "\u{2212}293 \u{b1} 12 MPa");
        assert_eq!(text(292.84, f64::INFINITY), "292.8 MPa, or none");
    }

    #[test]
    fn the_deviation_over_records_hides_no_series() {
        // T/N of the tutorial: every run has the same transient in its window, of 0.015
        let mut points = measured(&[0.1, 0.3, 1.0, 3.0], &[0.1484, 0.1776, 0.1910, 0.1960], None);
        points.iter_mut().for_each(|p| p.deviation = Some(0.015));
        let limit = reached(trend(&points, Refinement::Springs));
        assert!((limit.value - 0.1981).abs() < 2e-4, "{limit:?}");
        assert!((limit.left - 0.0107).abs() < 1e-3, "{limit:?}");
    }

    #[test]
    fn a_force_that_goes_on_with_stiffer_springs_does_not_settle() {
        // each decade adds more than the one before
        let found =
            trend(&measured(&DECADES[..4], &[0.05, 0.09, 0.16, 0.29], None), Refinement::Springs);
        assert_eq!(found.word(), "does not settle", "{found:?}");
        // in series, but the stiffest spring is still as soft as the bodies
        let soft = sampled(|k| 1.0 / (3.0 + 0.3 / k), &[1e-4, 1e-3, 1e-2, 0.1]);
        let Trend::Approaches(limit) = trend(&soft, Refinement::Springs) else {
            panic!("{:?}", trend(&soft, Refinement::Springs));
        };
        assert!((limit.left - 0.5).abs() < 1e-9, "{limit:?}");
    }

    #[test]
    fn intervals_as_wide_as_the_steps_leave_the_limit_of_a_series_untold() {
        let points = measured(&SATURATION[0], &SATURATION[1], Some(0.1));
        let found = trend(&points, Refinement::Springs);
        assert_eq!(found.verdict(), Verdict::CannotBeTold, "{found:?}");
        let close = measured(&DECADES, &[0.31, 0.33, 0.30, 0.32, 0.31], Some(0.04));
        let found = trend(&close, Refinement::Springs);
        assert_eq!(found.word(), "cannot be told (scatter)", "{found:?}");
        // narrow intervals carry over to the limit
        let points = measured(&SATURATION[0], &SATURATION[1], Some(0.002));
        let limit = reached(trend(&points, Refinement::Springs));
        assert!(limit.half > 0.002 && limit.half < 0.005, "{limit:?}");
    }

    #[test]
    fn a_plateau_at_the_end_of_the_axis_counts_whatever_came_before() {
        // a step, and then noise of a per cent
        let values = [0.06, 0.3255, 0.322, 0.3275, 0.3258];
        for refinement in [Refinement::Upwards, Refinement::Springs] {
            let found = trend(&measured(&DECADES, &values, None), refinement);
            assert!(
                matches!(found, Trend::Flat { points: 4, mean, .. } if (mean - 0.3252).abs() < 1e-4),
                "{found:?}"
            );
            assert!(found.sentence(5, "").contains("over the last 4 points"));
        }
        // one point at the coarse end that is out of line
        let xs = [16.0, 8.0, 4.0, 2.0, 1.0];
        let found =
            trend(&measured(&xs, &[0.2, 1.2, 1.05, 1.012, 1.003], None), Refinement::TowardsZero);
        let limit = reached(found);
        assert!((limit.value - 1.0).abs() < 2e-3 && limit.points == 4, "{limit:?}");
        let found =
            trend(&measured(&xs[..4], &[0.2, 1.2, 1.05, 1.012], None), Refinement::TowardsZero);
        assert_eq!(found.word(), "settles", "{found:?}");
    }

    #[test]
    fn slow_growth_over_close_points_is_no_plateau() {
        let xs: Vec<f64> = (0..20).map(|i| libm::pow(1.02, f64::from(i))).collect();
        // a zigzag of half a per cent, so that no form holds
        let zigzag = |x: f64| {
            if (libm::log(x) / libm::log(1.02)).round() % 2.0 == 0.0 { 0.995 } else { 1.005 }
        };
        let found = upwards(&sampled(|x| x * zigzag(x), &xs));
        assert_ne!(found.verdict(), Verdict::Settles, "{found:?}");
    }

    #[test]
    fn what_stays_settles_and_what_turns_cannot_be_told() {
        let found = upwards(&sampled(|x| 5.0 + 0.01 * libm::sin(libm::log(x)), &DECADES));
        assert!(matches!(found, Trend::Flat { points: 5, .. }), "{found:?}");
        let found = upwards(&measured(&DECADES, &[1.0, 3.0, 0.5, 2.5, 1.0], None));
        assert_eq!(found.word(), "cannot be told");
        // the violating fraction of kt.toml, with no more trend than 4 %
        let found = upwards(&measured(&DECADES, &[0.998, 0.981, 0.960, 0.965], None));
        assert!(matches!(found, Trend::Flat { points: 4, .. }), "{found:?}");
        // a step: two points that agree are no plateau
        for step in [&[2.1, 3.21, 3.18][..], &[1.0, 2.1, 3.21, 3.18]] {
            let found = upwards(&measured(&DECADES, step, None));
            assert_eq!(found.verdict(), Verdict::CannotBeTold, "{found:?}");
        }
        // random values whose last three happen to come closer to one another
        let found = upwards(&measured(&DECADES, &[1.2, 0.7, 1.1, 1.0, 0.97], None));
        assert_eq!(found.word(), "cannot be told", "{found:?}");
        let turns = sampled(|x| 1.0 + 0.3 / x - 0.1 * (x - 100.0).max(0.0) / 900.0, &DECADES);
        reached(upwards(&turns[..4]));
        let mut back = turns;
        back[4].value += 0.4;
        let found = upwards(&back);
        assert!(found.sentence(5, "").contains("turns back"), "{found:?}");
    }

    #[test]
    fn a_scatter_that_would_hide_a_change_is_no_plateau() {
        // wrong directions of a sweep of the mesh: they differ by 34.16 degrees
        let values = [70.78, 36.62, 53.7];
        let mut records = measured(&DECADES, &values, None);
        records.iter_mut().for_each(|p| p.deviation = Some(40.0));
        for points in [measured(&DECADES, &values, Some(20.0)), records] {
            let found = upwards(&points);
            assert_eq!(found.word(), "cannot be told (scatter)");
            let said = found.sentence(3, "degrees");
            assert!(
                said.contains("34.16 degrees apart") && said.contains("scatter of 40.00"),
                "{said}"
            );
        }
        // values that agree, with intervals that do not
        let agreeing = [50.0, 50.1, 50.2];
        let found = upwards(&measured(&DECADES, &agreeing, Some(10.0)));
        assert_eq!(found.word(), "cannot be told (scatter)");
        assert_eq!(upwards(&measured(&DECADES, &agreeing, Some(0.5))).word(), "settles");
        // a limit that the fit gives, but 15 % of uncertainty about it
        let way: Vec<f64> =
            DECADES.iter().map(|x| 10.0 - 8.0 * libm::pow(*x, -0.8) * 0.1584).collect();
        assert_eq!(upwards(&measured(&DECADES, &way, Some(0.05))).word(), "settles");
        let found = upwards(&measured(&DECADES, &way, Some(1.5)));
        assert_eq!(found.verdict(), Verdict::CannotBeTold, "{found:?}");
    }

    #[test]
    fn a_change_beyond_the_scatter_has_its_verdict() {
        let log: Vec<f64> = DECADES.iter().map(|x| 3.0 + 0.4 * libm::log(*x)).collect();
        assert_eq!(upwards(&measured(&DECADES, &log, Some(0.1))).word(), "does not settle");
        let found = upwards(&measured(&DECADES, &log, Some(0.1)));
        assert_eq!(found.verdict(), Verdict::DoesNot);
    }

    #[test]
    fn two_points_say_nothing_and_repeated_ones_neither() {
        for refinement in [Refinement::Upwards, Refinement::TowardsZero, Refinement::Springs] {
            let found = trend(&sampled(|x| x, &[1.0, 2.0]), refinement);
            assert_eq!(found.sentence(2, ""), "Cannot be told: 2 points; three are the least.");
            let found = trend(&sampled(|x| x, &[2.0, 1.0, 3.0, 1.0]), refinement);
            assert_eq!(found.sentence(4, ""), "Cannot be told: the axis takes a value twice.");
            assert_eq!(trend(&[], refinement).word(), "cannot be told");
        }
    }
}
