//! Ensembles: runs of one point of a sweep that differ by a disturbance of the preload alone, and the means over
//! them with their confidence intervals.

use std::collections::BTreeMap;

use crate::check::measure::Measure;
use crate::check::patch_series::PatchMeasure;
use crate::sweep::result::{
    COMPLETED, Entry, MeanOfMeans, MeanValue, Parameters, PointCheck, PointHalves, PointSummary,
    PointWindow, SweepPoint, SweepRun,
};
use output::confidence::interval;
use output::summary::{MEANS, Window};

/// Key of the axis of an ensemble's members.
pub(crate) const AXIS: &str = "preload.seed";
/// Key and size of the disturbance by which they differ, unless the file sets it.
pub(crate) const DISTURBANCE: (&str, f64) = ("preload.disturbance", 1e-9);

/// The points of the runs of an ensemble, in the order of their first members.
pub(super) fn points(runs: &[SweepRun]) -> Vec<SweepPoint> {
    let mut points: Vec<(Parameters, Vec<&SweepRun>)> = Vec::new();
    for run in runs {
        let mut parameters = run.parameters.clone();
        parameters.remove(AXIS);
        match points.iter_mut().find(|(known, _)| *known == parameters) {
            Some((_, members)) => members.push(run),
            None => points.push((parameters, vec![run])),
        }
    }
    points.into_iter().map(|(parameters, members)| point(parameters, &members)).collect()
}

fn point(parameters: Parameters, members: &[&SweepRun]) -> SweepPoint {
    let completed: Vec<Entry<'_>> = members
        .iter()
        .filter(|run| run.status.as_deref() == Some(COMPLETED))
        .map(|run| Entry::Run(run))
        .collect();
    let means: BTreeMap<_, _> = MEANS
        .iter()
        .filter_map(|&mean| Some((mean, over(&completed, |run| Some(run.mean(mean)?.value))?)))
        .collect();
    let section = |wanted: &str| {
        let of = means.iter().filter(|(mean, _)| mean.key().0 == wanted);
        of.map(|(mean, [value, _])| (*mean, *value)).collect()
    };
    let end = |of: fn(&Window) -> Option<f64>| {
        over(&completed, |run| of(run.summary()?.window.as_ref()?))
    };
    let ends = [end(|window| window.from), end(|window| window.to)];
    let [[from, from_half], [to, to_half]] =
        ends.map(|end| [end.map(|[mean, _]| mean), end.map(|[_, half]| half)]);
    // one member alone has no interval
    let status = if completed.len() > 1 { COMPLETED } else { "failed" };
    SweepPoint {
        parameters,
        members: members.iter().filter_map(|run| run.name.clone()).collect(),
        completed: completed.len(),
        status: status.into(),
        run: completed.first().and_then(|run| run.folder()?.to_str().map(str::to_owned)),
        summary: PointSummary {
            dt: completed.first().and_then(|run| run.step()),
            contact: section("contact"),
            window: PointWindow {
                ci95: PointHalves {
                    from: from_half,
                    to: to_half,
                    means: means.iter().map(|(mean, [_, half])| (*mean, *half)).collect(),
                },
                from,
                to,
                means: section("window"),
            },
        },
        check: check(&completed),
    }
}

/// Means over the checks of runs.
fn check(runs: &[Entry<'_>]) -> PointCheck {
    let value = |[value, ci95]: [f64; 2]| MeanValue { value, ci95 };
    let metric = |measure: Measure| over(runs, |run| Some(run.metric(measure)?.value)).map(value);
    let patch = |measure: PatchMeasure| over(runs, |run| Some(run.patch(measure)?.value));
    let zone = runs.first().and_then(|run| run.check()?.slip_zone());
    let quantities = zone.into_iter().flat_map(|zone| zone.statistics.keys().copied());
    PointCheck {
        metrics: Measure::ALL.iter().filter_map(|&m| Some((m, metric(m)?))).collect(),
        patch: PatchMeasure::ALL
            .iter()
            .filter_map(|&m| {
                let [mean, ci95] = patch(m)?;
                Some((m, MeanOfMeans { mean, ci95 }))
            })
            .collect(),
        slip_zone: quantities
            .filter_map(|q| Some((q, over(runs, |run| Some(run.slip_zone(q)?.value)).map(value)?)))
            .collect(),
    }
}

/// Mean of a number over runs and half the width of its confidence interval, where all of them have it.
fn over(runs: &[Entry<'_>], of: impl Fn(&Entry<'_>) -> Option<f64>) -> Option<[f64; 2]> {
    interval(&runs.iter().map(of).collect::<Option<Vec<_>>>()?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use output::summary::Mean;
    use serde_json::json;

    fn run(seed: u64, step: f64, traction: f64) -> SweepRun {
        let run = json!({
            "name": format!("{seed}-{step}"), "run": format!("runs/{seed}"), "status": "completed",
            "parameters": { "time.factor": step, AXIS: seed },
            "summary": { "dt": 1e-7 * step,
                         "contact": { "traction_coefficient": traction, "creepage": null },
                         "window": { "torque": 2.0 * traction, "deviation": { "torque": 9.0 } } },
            "check": { "metrics": { "law_error": { "value": 0.1, "limit": 0.02 } }, "patch": {} },
        });
        serde_json::from_value(run).unwrap()
    }

    #[test]
    fn a_point_holds_the_mean_of_its_members_and_the_interval_of_that_mean() {
        let runs = [run(1, 0.5, 0.2), run(2, 0.5, 0.3), run(3, 0.5, 0.4), run(1, 0.25, 0.7)];
        let points = points(&runs);
        assert_eq!(points.len(), 2);
        let close = |found: f64, wanted: f64| {
            assert!((found - wanted).abs() < 1e-12, "{found:?} {wanted}");
        };
        let SweepPoint { summary, check, .. } = &points[0];
        close(summary.contact[&Mean::TractionCoefficient], 0.3);
        assert_eq!(summary.dt, Some(0.5e-7));
        let half = 4.303 * 0.1 / 3.0_f64.sqrt();
        close(summary.window.ci95.means[&Mean::TractionCoefficient], half);
        close(summary.window.ci95.means[&Mean::Torque], 2.0 * half);
        close(check.metrics[&Measure::LawError].ci95, 0.0);
        assert!(!summary.contact.contains_key(&Mean::Creepage), "no member has one");
        let parameters = json!(points[0].parameters);
        assert_eq!(parameters, json!({ "time.factor": 0.5 }));
        assert_eq!((points[1].status.as_str(), points[1].completed), ("failed", 1));
    }

    #[test]
    fn a_point_reads_back_as_it_was_written() {
        let points = points(&[run(1, 0.5, 0.2), run(2, 0.5, 0.3)]);
        let text = serde_json::to_string(&points).unwrap();
        assert_eq!(serde_json::from_str::<Vec<SweepPoint>>(&text).unwrap(), points);
    }
}
