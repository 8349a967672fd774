//! What a check found, from the measures accumulated over the records.

use super::evaluation::{Channel, Evaluation};
use super::{Criteria, Report};
use crate::check::accumulator::{Statistic, Switches};
use crate::check::basis::{Basis, Bound, SCALES};
use crate::check::conditions::{DIRECTION_TOLERANCE, IN_ADHESION, IN_CONTACT, LAW_TOLERANCE};
use crate::check::law::Law;
use crate::check::limits::{Limits, MethodKind};
use crate::check::measure::Measure;
use crate::check::patch_series::PatchMeasure;
use crate::check::result::{
    CheckResult, Detail, IN_SLIP_STATE, LawFollowed, LawUsed, MeshModeFound, Metric, OnView,
    PairingUsed, PatchMean, Place, Reported, ScaleUsed, Sides, SlipZoneFound, Statistics,
    Tolerances, Verdict, View,
};
use crate::check::surface::body_name;
use crate::check::window::Window;
use output::layout::Pairing;
use std::collections::BTreeMap;

/// What a check found beside the measures of the conditions.
pub(super) struct Beside {
    pub patch: BTreeMap<PatchMeasure, PatchMean>,
    pub mesh_mode: MeshModeFound,
    pub slip_zone: Option<SlipZoneFound>,
    /// What to try where much of the slip fluctuates.
    pub slip_note: Option<String>,
}

/// A statistic of a measure on a part of the interface.
type OnPart = (View, Option<Pairing>, Statistic);

impl Evaluation<'_> {
    /// What was found over the `window`, with what was found `beside` the conditions.
    pub fn result(
        &self,
        basis: &Basis,
        options: &Criteria<'_>,
        window: &Window,
        beside: Beside,
    ) -> CheckResult {
        let (own, stated) = self.history.pairing;
        let times = &self.history.times;
        let reported = match options.report {
            Report::Only(pairing) => pairing.into(),
            Report::Stated if stated => own.into(),
            Report::Stated | Report::Stricter => Reported::Stricter,
        };
        let limits = &options.limits;
        let metric = |measure: Measure| match measure {
            Measure::MeshMode => self.mesh_mode(beside.mesh_mode.mode.alternating_slip, limits),
            Measure::SwitchingRate => self.switching(limits),
            _ => self.metric(measure, limits, reported, basis),
        };
        let mut metrics: BTreeMap<_, _> =
            Measure::ALL.iter().map(|measure| (*measure, metric(*measure))).collect();
        attribute_to_springs(limits.kind, &mut metrics);
        let other = self.channels.iter().filter(|channel| channel.pairing != own);
        let crossed = other.map(|channel| channel.accumulator.records).max().unwrap_or(0);
        let law_followed = self.followed();
        let notes = self
            .gaps(crossed)
            .into_iter()
            .chain(beside.mesh_mode.mode.warnings.iter().cloned())
            .chain(self.law_note(&metrics, &law_followed))
            .chain(beside.slip_note);
        let scales = SCALES.iter().filter_map(|(name, units, about)| {
            let scale = basis.scales.get(name)?;
            let used = ScaleUsed {
                value: scale.value,
                units: (*units).into(),
                about: (*about).into(),
                from: scale.from.clone(),
            };
            Some(((*name).to_owned(), used))
        });
        CheckResult {
            name: basis.name.clone(),
            window: window.ends(times),
            recorded: [times[window.records.start], times[window.records.end - 1]],
            steps: window.records.len(),
            nodes: self.history.surface.points.len(),
            node_times: self.node_times,
            pass: metrics.values().all(|metric| metric.pass),
            limits_for: limits.kind,
            limits: metrics.iter().map(|(measure, metric)| (*measure, metric.limit)).collect(),
            pairing: PairingUsed {
                reported,
                in_file: own,
                stated_by_file: stated,
                enforced_on: self.history.enforced_on.map(View::of),
                records_with_the_other: crossed,
            },
            law: law_used(basis, self.replay.is_ok()),
            law_followed,
            scales: scales.collect(),
            tolerances: Tolerances {
                in_contact: IN_CONTACT,
                in_adhesion: IN_ADHESION,
                law_error: LAW_TOLERANCE,
                direction: DIRECTION_TOLERANCE,
            },
            notes: notes.collect(),
            metrics,
            patch: beside.patch,
            mesh_mode: beside.mesh_mode,
            slip_zone: beside.slip_zone,
        }
    }

    /// Shares of contact area and time on which the law's coefficient is known.
    fn followed(&self) -> LawFollowed {
        let mut sums = [0.0; 3];
        // forces on the other body's nodes are those that its faces distribute
        let judged = |body: u8| self.history.enforced_on.is_none_or(|on| on == body);
        for (_, side) in self.sides.iter().filter(|(body, _)| judged(*body)) {
            for (sum, weight) in sums.iter_mut().zip(side.mu.weights()) {
                *sum += weight;
            }
        }
        let all: f64 = sums.iter().sum();
        let [known, uncertain, unknown] = sums.map(|sum| (all > 0.0).then(|| sum / all));
        let note = self.replay.as_ref().err().cloned();
        LawFollowed { known, uncertain, blurred: uncertain, unknown, note }
    }

    /// A note on where the law's coefficient is not known to round-off, and why.
    fn law_note(
        &self,
        metrics: &BTreeMap<Measure, Metric>,
        followed: &LawFollowed,
    ) -> Option<String> {
        if let Err(why) = &self.replay {
            let looked = self.history.has.mu && !why.is_empty();
            return looked.then(|| {
                format!("mu is not judged, since the law's mu cannot be recomputed from the records: {why}")
            });
        }
        let percent = |share: Option<f64>| 100.0 * share.unwrap_or(0.0);
        if percent(followed.uncertain) == 0.0 {
            return None;
        }
        let sides = match &metrics[&Measure::MuErrorUncertain].sides {
            Some(Sides::Views(views)) => views.values().collect(),
            _ => Vec::new(),
        };
        let uncertainty = |detail: Detail| {
            let of = |on: &&OnView| match on {
                OnView::Single(statistics) => statistics.more.get(&detail).copied().flatten(),
                OnView::Paired(_) => None,
            };
            100.0 * sides.iter().filter_map(of).fold(0.0, f64::max)
        };
        let start = self.history.times[0];
        let late = match self.scales.dt {
            Some(dt) if start > 0.5 * dt => format!(
                ", and the law's state at the first record, {:.5} ms after the start, is not known",
                1e3 * start
            ),
            _ => String::new(),
        };
        Some(format!(
            "on {:.0} % of contact area and time, not every step since contact began is recorded{late}: there \
             the law's mu is known only to {:.2} % (median; 95 % of it to {:.2} %), and on {:.0} % to \
             round-off (record every step from the start, or for long enough, in an [[output.window]])",
            percent(followed.uncertain),
            uncertainty(Detail::UncertaintyMedian),
            uncertainty(Detail::UncertaintyP95),
            percent(followed.known)
        ))
    }

    /// Notes on what could not be measured.
    fn gaps(&self, crossed: usize) -> Vec<String> {
        let mut notes = Vec::new();
        let has = self.history.has;
        for (there, lost) in [
            (has.gap, "gap: penetration and complementarity are not measured"),
            (has.mu, "mu: law_error_own and mu_error are not measured"),
            (has.state, "state: switches are counted from the slip velocity"),
            (
                has.motion,
                "motion: the slip of the pair is not measured (displacement and velocity)",
            ),
        ] {
            if !there {
                notes.push(format!("the file has no {lost}"));
            }
        }
        if self.history.follows {
            notes.push(
                "the fine zone follows the contact, so a node does not stay at its point of the material: switching_rate, \
                 roughness_ratio and laws with memory are not judged, and moves of the mesh add to the fluctuation of slip"
                    .into(),
            );
        }
        let other = match self.history.pairing.0 {
            Pairing::Before => "after",
            Pairing::After => "before",
        };
        if self.scales.dt.is_none() {
            notes.push(format!(
                "the time step is not known: the pairing `{other}` is not measured (--scale dt=S)"
            ));
        } else if crossed == 0 {
            notes.push(format!(
                "no two records lie one step apart: the pairing `{other}` is not measured, and a \
                 chatter of two steps can hide (record every step in an [[output.window]])"
            ));
        }
        if let Some(body) = self.history.enforced_on.filter(|_| self.history.in_means) {
            notes.push(format!(
                "mortar rows: the conditions are enforced in means over the faces around the nodes of the {0}, and \
                 slip_velocity there is such a mean; the pair, which compares single points, and the {1} are not judged",
                body_name(body),
                body_name(1 - body)
            ));
        }
        if self.without_projection > 0 {
            notes.push(format!(
                "the pair leaves out {} records of nodes in contact that project on no face of the \
                 other body",
                self.without_projection
            ));
        }
        notes
    }

    /// The statistics of a measure on all parts of the interface that have it.
    fn on_parts(&self, measure: Measure) -> Vec<OnPart> {
        let sides = self.sides.iter();
        let of_bodies: Vec<OnPart> = sides
            .filter_map(|(body, side)| Some((View::of(*body), None, side.statistic(measure)?)))
            .collect();
        if !of_bodies.is_empty() {
            return of_bodies;
        }
        let stateless = measure == Measure::ViolatingFractionSlipState && !self.history.has.state;
        let of = |channel: &Channel| {
            let found = channel.accumulator.statistic(measure);
            let value = found.value.filter(|_| !stateless);
            (channel.view, Some(channel.pairing), Statistic { value, ..found })
        };
        self.channels.iter().filter(|channel| channel.accumulator.records > 0).map(of).collect()
    }

    /// A measure, of the part of the interface and the pairing where it is worst.
    fn metric(
        &self,
        measure: Measure,
        limits: &Limits,
        reported: Reported,
        basis: &Basis,
    ) -> Metric {
        let all = self.on_parts(measure);
        let counts = |pairing: Option<Pairing>| {
            reported == Reported::Stricter
                || pairing.is_none_or(|pairing| reported == pairing.into())
        };
        let badness = |value: f64| match measure {
            Measure::RoughnessRatio => libm::log(value).abs(),
            _ => value,
        };
        // Forces that faces distribute to the nodes of the other body obey the law only in the mean; mortar
        // conditions say nothing of single points, nor of the sign of single distributed forces.
        let in_means = self.history.in_means;
        let judged = |view: View, pairing: Option<Pairing>| {
            let received = self.history.enforced_on.is_some_and(|on| view == View::of(1 - on));
            let pointwise = in_means && view == View::Pair;
            !pointwise && !(received && (pairing.is_some() || in_means))
        };
        let worst = all
            .iter()
            .filter(|(view, pairing, _)| counts(*pairing) && judged(*view, *pairing))
            .filter_map(|part| Some((part, part.2.value?)))
            .max_by(|a, b| badness(a.1).total_cmp(&badness(b.1)));
        let sides = Some(Sides::Views(details(&all)));
        let (limit, asked) = (limits.of(measure), limits.was_asked(measure));
        let metric = Metric { sides, ..Metric::new(measure, worst.map(|w| w.1), limit, asked) };
        match worst {
            Some(((view, pairing, found), _)) => Metric {
                place: self.place(*view, *pairing, found),
                side: Some(*view),
                pairing: *pairing,
                deviation: found.deviation,
                ..metric
            },
            None => Metric { note: Some(self.why_none(measure, basis).into()), ..metric },
        }
    }

    /// `switching_rate`: by the algorithm's state where the file has it, else by the slip velocity.
    fn switching(&self, limits: &Limits) -> Metric {
        let measure = Measure::SwitchingRate;
        let states: Vec<(View, f64)> = self
            .sides
            .iter()
            .filter(|_| self.history.has.state)
            .filter_map(|(body, side)| Some((View::of(*body), Switches::rate(&side.states)?)))
            .collect();
        let slips: Vec<(View, f64)> = self
            .on_parts(measure)
            .into_iter()
            .filter_map(|(view, _, found)| Some((view, found.value?)))
            .collect();
        let used = if states.is_empty() { &slips } else { &states };
        let worst = used.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1));
        let worst = worst.filter(|_| !self.history.follows);
        let time = self.scales.shear_wave.map(|speed| self.scales.size / speed);
        let value = worst.zip(time).map(|((_, rate), time)| rate * time);
        let per_us = |rates: Vec<(View, f64)>| {
            rates.into_iter().map(|(view, rate)| (view, rate * 1e-6)).collect()
        };
        let note = "the scale shear_wave is not known";
        Metric {
            side: worst.map(|(view, _)| view),
            per_node_and_microsecond: worst.map(|(_, rate)| rate * 1e-6),
            note: time.is_none().then(|| note.into()),
            sides: Some(Sides::Switches { by_state: per_us(states), by_slip: per_us(slips) }),
            ..Metric::new(measure, value, limits.of(measure), limits.was_asked(measure))
        }
    }

    /// `mesh_mode`, from the part of the slip that alternates.
    fn mesh_mode(&self, alternating: Option<f64>, limits: &Limits) -> Metric {
        let measure = Measure::MeshMode;
        let metric =
            Metric::new(measure, alternating, limits.of(measure), limits.was_asked(measure));
        match metric.value {
            None => Metric { note: Some("hardly anything slips".into()), ..metric },
            Some(_) => Metric {
                side: Some(self.history.enforced_on.map_or(View::Both, View::of)),
                ..metric
            },
        }
    }

    fn place(&self, view: View, pairing: Option<Pairing>, found: &Statistic) -> Option<Place> {
        let (node, time, value) = found.place?;
        let detail = |wanted: Detail| {
            found.more.iter().find(|(detail, _)| *detail == wanted).and_then(|(_, value)| *value)
        };
        Some(Place {
            side: view,
            pairing,
            node,
            position: node.map(|node| self.history.surface.points[node].into()),
            time,
            value: Some(value).filter(|value| value.is_finite()),
            mu_used: detail(Detail::MuUsedWorst),
            mu_law: detail(Detail::MuLawWorst),
        })
    }

    /// Why a measure has no value.
    fn why_none(&self, measure: Measure, basis: &Basis) -> &'static str {
        use Measure as M;
        let has = self.history.has;
        let no_law = basis.law.is_none() && self.replay.is_err();
        match measure {
            M::Penetration | M::Complementarity if !has.gap => "the file has no field gap",
            M::Penetration | M::Complementarity => "the scale approach is not known",
            M::LawError | M::LawErrorSlipState | M::RoughnessRatio | M::LawScatter if no_law => {
                "the friction law is not known"
            }
            M::LawErrorSlipState | M::DirectionSlipState | M::ViolatingFractionSlipState
                if !has.state =>
            {
                "the file has no field state"
            }
            M::LawErrorOwn | M::MuError | M::MuErrorUncertain if !has.mu => {
                "the file has no field mu"
            }
            M::MuError | M::MuErrorUncertain if self.replay.is_err() => {
                "the law's mu cannot be recomputed, see the note"
            }
            M::MuError => "no node has every step recorded since its contact began",
            M::MuErrorUncertain => "every step that the law's mu needs is recorded",
            M::RoughnessRatio if matches!(basis.law, Some(Law::Coulomb(_))) => {
                "the law's coefficient is constant"
            }
            M::RoughnessRatio if self.scales.roughness_span.is_none() => {
                "the scales half_length and speed are not known"
            }
            M::RoughnessRatio => {
                "no node slips for a tenth of a transit, or records lie too far apart or too close for it"
            }
            M::LawScatter if basis.bound == Bound::Used => {
                "the law is not a function of slip speed alone, or its graph is not known"
            }
            M::AdhesionSlip => "no node is in adhesion",
            M::LawErrorSlipState | M::DirectionSlipState => "the algorithm lets no node slip",
            _ => "no node slips",
        }
    }
}

/// Marks the measures that springs in stick take beyond their limits: what is left of them where the algorithm's state
/// is slip keeps its limit, or is little. Violations count as theirs where law and direction do: with friction that falls,
/// few nodes are in slip, and those in stick oscillate.
fn attribute_to_springs(kind: MethodKind, metrics: &mut BTreeMap<Measure, Metric>) {
    for measure in Measure::ALL {
        let own = measure.in_slip_state().map(|own| &metrics[&own]);
        let (left, keeps) = (own.and_then(|own| own.value), own.is_some_and(|own| own.pass));
        let Some(metric) = metrics.get_mut(measure).filter(|metric| !metric.pass) else { continue };
        let little = |(left, all): (f64, f64)| keeps || left <= IN_SLIP_STATE * all;
        metric.by_springs =
            kind == MethodKind::Penalty && left.zip(metric.value).is_some_and(little);
    }
    let wrong = |measure| metrics[&measure].verdict() == Verdict::Fail;
    if wrong(Measure::LawError) || wrong(Measure::Direction) {
        metrics.entry(Measure::ViolatingFraction).and_modify(|metric| metric.by_springs = false);
    }
}

/// Every statistic of every part of the interface and pairing.
fn details(all: &[OnPart]) -> BTreeMap<View, OnView> {
    let mut sides = BTreeMap::new();
    for (view, pairing, found) in all {
        let more = found.more.iter().copied().collect();
        let statistics = Statistics { value: found.value, more };
        match pairing {
            None => drop(sides.insert(*view, OnView::Single(statistics))),
            Some(pairing) => {
                let on = sides.entry(*view).or_insert_with(|| OnView::Paired(BTreeMap::new()));
                if let OnView::Paired(paired) = on {
                    paired.insert(*pairing, statistics);
                }
            }
        }
    }
    sides
}

fn law_used(basis: &Basis, followed: bool) -> LawUsed {
    let bound = match basis.bound {
        Bound::Law => "mu(|s|)",
        Bound::Used if followed => "mu of the law, recomputed from the records",
        Bound::Used => "mu that the algorithm used",
    };
    let none =
        LawUsed { law: None, mu_static: None, mu_dynamic: None, decay: None, bound: bound.into() };
    let law = basis.parameters().map(|parameters| parameters.declaration().word.to_owned());
    match basis.law {
        Some(Law::Coulomb(of)) => LawUsed { law, mu_static: Some(of.mu), ..none },
        Some(Law::Exponential(of)) => LawUsed {
            law,
            mu_static: Some(of.mu_static),
            mu_dynamic: Some(of.mu_dynamic),
            decay: Some(of.decay),
            ..none
        },
        None => none,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The verdicts on the law, for its error and what is left of it where the algorithm's state is slip, and on
    /// violations, of which nothing is left there.
    fn law(kind: MethodKind, [all, left]: [f64; 2]) -> [Verdict; 2] {
        let limits = Limits::for_enforcement(None);
        let metric = |measure: &Measure| {
            let value = match measure {
                Measure::LawError => all,
                Measure::LawErrorSlipState => left,
                Measure::ViolatingFraction => 0.5,
                _ => 0.0,
            };
            (*measure, Metric::new(*measure, Some(value), limits.of(*measure), false))
        };
        let mut metrics = Measure::ALL.iter().map(metric).collect();
        attribute_to_springs(kind, &mut metrics);
        [Measure::LawError, Measure::ViolatingFraction].map(|measure| metrics[&measure].verdict())
    }

    #[test]
    fn springs_account_for_a_measure_of_which_little_is_left_in_slip_and_for_nothing_else() {
        use Verdict::{Fail, Pass, Springs};
        let penalty = MethodKind::Penalty;
        assert_eq!(law(penalty, [0.5, 0.05]), [Springs; 2]);
        assert_eq!(law(penalty, [0.5, 0.051]), [Fail; 2], "violations neither");
        assert_eq!(law(penalty, [0.03, 0.02]), [Springs; 2], "what is left keeps the limit");
        assert_eq!(law(penalty, [0.02, 0.0]), [Pass, Springs]);
        assert_eq!(law(MethodKind::Exact, [0.5, 0.0]), [Fail; 2], "exact contact has no springs");
    }
}
