//! The rate at which a small disturbance grows: two runs of one mesh whose records have the same times, such as
//! members of an ensemble, diverge until the difference is as large as the slip itself.

use crate::check::PostError;
use crate::check::basis::Basis;
use crate::check::frames::ContactHistory;
use crate::compare::result::{GrownOver, Growth};

/// Difference over the largest slip (root mean squares over the nodes) up to which it counts as small.
const SMALL: f64 = 1e-2;
/// There is no rate from fewer records than this, or from less growth than this factor.
const LEAST_RECORDS: usize = 5;
const LEAST_GROWTH: f64 = 10.0;

/// Rate of growth of the difference of slip (1/s) with the records that it was fitted to, or the reason why there
/// is none; `None` for runs that are no twins.
pub(super) fn growth(
    bases: [&Basis; 2],
    [a, b]: [&ContactHistory; 2],
) -> Result<Option<Growth>, PostError> {
    let [case, other] = bases.map(undisturbed);
    let alike = case == other
        && a.surface.points == b.surface.points
        && a.times.len() == b.times.len()
        && a.times.iter().zip(&b.times).all(|(s, t)| (s - t).abs() <= 1e-9 * t.abs());
    if !alike {
        return Ok(None);
    }
    if a.follows || b.follows {
        let reason = "the fine zone follows the contact: meshes that do not move at the same step are no twins";
        return Ok(Some(Growth::none(reason)));
    }
    let mut series = Vec::new();
    let mut largest = 0.0_f64;
    let mut index = 0;
    a.stream(0..a.times.len(), |frame| {
        let other = b.record(index)?;
        index += 1;
        let pairs = || frame.slip_velocity.iter().zip(&other.slip_velocity);
        let apart: f64 = pairs().map(|(s, t)| (s - t).norm_squared()).sum();
        let all: f64 = pairs().map(|(s, t)| 0.5 * (s.norm_squared() + t.norm_squared())).sum();
        largest = largest.max(all.sqrt());
        series.push([frame.time, apart.sqrt()]);
        Ok(())
    })?;
    // by the largest slip of all records: that of the same record is zero while everything sticks
    series.iter_mut().for_each(|[_, apart]| *apart /= largest.max(f64::MIN_POSITIVE));
    Ok(Some(rate(&series)))
}

/// The case of a run without its name and without what disturbs its preload.
fn undisturbed(basis: &Basis) -> Option<toml::Table> {
    let mut case = basis.case.clone()?;
    case.remove("name");
    case.remove("title");
    if let Some(preload) = case.get_mut("preload").and_then(toml::Value::as_table_mut) {
        preload.remove("seed");
        preload.remove("disturbance");
    }
    Some(case)
}

/// Least-squares slope of the logarithm of the difference over time, from the first record with a difference to
/// the last one in which it is small.
fn rate(series: &[[f64; 2]]) -> Growth {
    let first = series.iter().position(|[_, apart]| *apart > 0.0);
    let Some(first) = first else {
        return Growth::none("both runs have the same bits");
    };
    let grown = series[first..].iter().position(|[_, apart]| *apart > SMALL);
    let end = grown.map_or(series.len(), |grown| first + grown);
    let small: Vec<[f64; 2]> = series[first..end]
        .iter()
        .filter(|[_, apart]| *apart > 0.0)
        .map(|[t, d]| [*t, libm::log(*d)])
        .collect();
    let ends = small.first().zip(small.last()).map(|(a, b)| [*a, *b]);
    let Some([start, last]) = ends.filter(|_| small.len() >= LEAST_RECORDS) else {
        return Growth::none("the difference is small in fewer than five records");
    };
    let over = Some(GrownOver {
        from: start[0],
        to: last[0],
        records: small.len(),
        start: libm::exp(start[1]),
        end: libm::exp(last[1]),
    });
    if last[1] - start[1] < libm::log(LEAST_GROWTH) {
        return Growth { over, ..Growth::none("the difference does not grow tenfold") };
    }
    let count = small.len() as f64;
    let mean = [0, 1].map(|i| small.iter().map(|p| p[i]).sum::<f64>() / count);
    let (mut upper, mut lower) = (0.0, 0.0);
    for [t, log] in &small {
        upper += (t - mean[0]) * (log - mean[1]);
        lower += (t - mean[0]).powi(2);
    }
    Growth { rate: Some(upper / lower), reason: None, over }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn series(apart: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        (0..200).map(|i| 1e-6 * f64::from(i)).map(|t| [t, apart(t)]).collect()
    }

    #[test]
    fn the_rate_of_an_exponential_is_its_own_until_it_saturates() {
        let found = rate(&series(|t| (1e-9 * libm::exp(2e5 * t)).min(0.7)));
        assert!((found.rate.unwrap() / 2e5 - 1.0).abs() < 1e-6, "{found:?}");
        assert!(found.over.unwrap().end <= SMALL);
    }

    #[test]
    fn runs_of_the_same_bits_and_differences_that_do_not_grow_have_no_rate_but_a_reason() {
        for apart in [0.0, 1e-9] {
            let found = rate(&series(|_| apart));
            assert!(found.rate.is_none() && found.reason.is_some(), "{found:?}");
        }
    }
}
