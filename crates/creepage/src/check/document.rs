//! The JSON document of a check.

use super::evaluation::{Evaluation, View};
use super::{CheckOptions, Report};
use crate::check::accumulator::{Statistic, Switches};
use crate::check::basis::{Basis, Bound, SCALES};
use crate::check::conditions::{DIRECTION_TOLERANCE, IN_ADHESION, IN_CONTACT, LAW_TOLERANCE};
use crate::check::law::Law;
use crate::check::limits::{Limit, MEASURES, Measure};
use crate::check::surface::body_name;
use crate::check::window::Window;
use output::layout::Pairing;
use serde_json::{Map, Value, json};

impl Evaluation<'_> {
    /// The document, with the objects `patch` and `mesh_mode` that are passed in, and whether every limit holds.
    pub fn document(
        &self,
        basis: &Basis,
        options: &CheckOptions<'_>,
        window: &Window,
        patch: Value,
        mesh_mode: Value,
    ) -> (Value, bool) {
        let (own, stated) = self.history.pairing;
        let times = &self.history.times;
        let reported = match options.report {
            Report::Stated if stated => Report::Only(own),
            Report::Stated => Report::Stricter,
            report => report,
        };
        let mut metrics = Map::new();
        let mut limits = Map::new();
        let mut pass = true;
        for measure in &MEASURES {
            let limit = options.limits.of(measure.name);
            let asked = options.limits.was_asked(measure.name);
            let found = if measure.name == "mesh_mode" {
                self.mesh_mode(measure, &mesh_mode, limit, asked)
            } else {
                self.metric(measure, limit, asked, reported, basis)
            };
            pass &= found["pass"] == json!(true);
            limits.insert(measure.name.into(), limit_value(limit));
            metrics.insert(measure.name.into(), found);
        }
        let mut notes = Vec::new();
        notes.extend(compliance_note(&metrics));
        let crossed: usize = self
            .channels
            .iter()
            .filter(|c| c.pairing != own)
            .map(|c| c.accumulator.records)
            .max()
            .unwrap_or(0);
        notes.extend(self.gaps(crossed));
        let warnings = mesh_mode["warnings"].as_array().into_iter().flatten();
        notes.extend(warnings.filter_map(Value::as_str).map(str::to_owned));
        notes.extend(self.law_followed(&metrics));
        let scales = SCALES.iter().filter_map(|(name, units, about)| {
            let scale = basis.scales.get(name)?;
            let entry = json!({ "value": scale.value, "units": units, "about": about,
                                "from": scale.from });
            Some(((*name).to_owned(), entry))
        });
        let document = json!({
            "name": basis.name,
            "window": window.ends(times),
            "recorded": [times[window.records.start], times[window.records.end - 1]],
            "steps": window.records.len(),
            "nodes": self.history.surface.points.len(),
            "node_times": self.node_times,
            "limits": limits,
            "limits_for": options.limits.set,
            "metrics": metrics,
            "pass": pass,
            "pairing": {
                "reported": match reported {
                    Report::Only(pairing) => pairing.name(),
                    _ => "stricter",
                },
                "in_file": own.name(),
                "stated_by_file": stated,
                "enforced_on": self.history.enforced_on.map(body_name),
                "records_with_the_other": crossed,
            },
            "law": law_value(basis, self.replay.is_ok()),
            "law_followed": self.followed(),
            "scales": scales.collect::<Map<_, _>>(),
            "tolerances": {
                "in_contact": IN_CONTACT, "in_adhesion": IN_ADHESION,
                "law_error": LAW_TOLERANCE, "direction": DIRECTION_TOLERANCE,
            },
            "patch": patch,
            "mesh_mode": mesh_mode,
            "notes": notes,
        });
        (document, pass)
    }

    /// The object `law_followed`: shares of contact area and time on which the law's coefficient is known.
    fn followed(&self) -> Value {
        let mut sums = [0.0; 3];
        // forces on the other body's nodes are those that its faces distribute
        let judged = |body: u8| self.history.enforced_on.is_none_or(|on| on == body);
        for (_, side) in self.sides.iter().filter(|(body, _)| judged(*body)) {
            for (sum, weight) in sums.iter_mut().zip(side.mu.weights()) {
                *sum += weight;
            }
        }
        let all: f64 = sums.iter().sum();
        let share = |i: usize| if all > 0.0 { json!(sums[i] / all) } else { Value::Null };
        json!({ "known": share(0), "blurred": share(1), "unknown": share(2),
                "note": self.replay.as_ref().err() })
    }

    /// A note on where the law's coefficient is not known to round-off, and why.
    fn law_followed(&self, metrics: &Map<String, Value>) -> Option<String> {
        if let Err(why) = &self.replay {
            let looked = self.history.has.mu && !why.is_empty();
            return looked.then(|| {
                format!("mu is not judged, since the law's mu cannot be recomputed from the records: {why}")
            });
        }
        let followed = self.followed();
        let percent = |name: &str| 100.0 * followed[name].as_f64().unwrap_or(0.0);
        if percent("blurred") == 0.0 {
            return None;
        }
        let blurred = &metrics["mu_error_blurred"]["sides"];
        let blur = |name: &str| {
            let of = ["disk", "bar"].iter().filter_map(|side| blurred[side][name].as_f64());
            100.0 * of.fold(0.0, f64::max)
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
            percent("blurred"),
            blur("blur_median"),
            blur("blur_p95"),
            percent("known")
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

    /// The entry of a measure.
    fn metric(
        &self,
        measure: &Measure,
        limit: Option<Limit>,
        asked: bool,
        reported: Report,
        basis: &Basis,
    ) -> Value {
        let mut all = Vec::new();
        for (body, side) in &self.sides {
            if let Some(found) = side.statistic(measure.name) {
                all.push((body_name(*body), None, found));
            }
        }
        if all.is_empty() {
            for channel in self.channels.iter().filter(|c| c.accumulator.records > 0) {
                let found = channel.accumulator.statistic(measure.name);
                all.push((channel.view.name(), Some(channel.pairing), found));
            }
        }
        if measure.name == "switching_rate" {
            return self.switching(measure, limit, asked, &all);
        }
        let counts = |pairing: Option<Pairing>| match (reported, pairing) {
            (Report::Only(only), Some(pairing)) => only == pairing,
            _ => true,
        };
        let badness = |value: f64| match measure.name {
            "roughness_ratio" => libm::log(value).abs(),
            _ => value,
        };
        // Forces that faces distribute to the nodes of the other body obey the law only in the mean; mortar
        // conditions say nothing of single points, nor of the sign of single distributed forces.
        let in_means = self.history.in_means;
        let judged = |view: &str, pairing: Option<Pairing>| {
            let receives = |body: u8| view == body_name(1 - body);
            let received = self.history.enforced_on.is_some_and(receives);
            let pointwise = in_means && view == View::Pair.name();
            !pointwise && !(received && (pairing.is_some() || in_means))
        };
        let candidates =
            all.iter().filter(|(view, pairing, _)| counts(*pairing) && judged(view, *pairing));
        let worst = candidates
            .filter_map(|entry| Some((entry, entry.2.value?)))
            .max_by(|a, b| badness(a.1).total_cmp(&badness(b.1)));
        let value = worst.map(|(_, value)| value);
        let mut entry = entry(measure, value, limit, asked);
        if let Some(((view, pairing, found), _)) = worst {
            entry["where"] = self.place(view, *pairing, found);
            entry["side"] = json!(view);
            entry["pairing"] = json!(pairing.map(Pairing::name));
            entry["deviation"] = json!(found.deviation);
            let more = |name: &str| found.more.iter().find(|(known, _)| *known == name);
            for (key, name) in [("mu_used", "mu_used_worst"), ("mu_law", "mu_law_worst")] {
                if let Some((_, Some(mu))) = more(name) {
                    entry["where"][key] = json!(mu);
                }
            }
        } else {
            entry["note"] = json!(self.why_none(measure.name, basis));
        }
        entry["sides"] = details(&all);
        entry
    }

    /// The entry of `switching_rate`: by the algorithm's state where the file has it, else by the slip velocity.
    fn switching(
        &self,
        measure: &Measure,
        limit: Option<Limit>,
        asked: bool,
        by_slip: &[(&'static str, Option<Pairing>, Statistic)],
    ) -> Value {
        let states: Vec<_> = self
            .sides
            .iter()
            .filter(|_| self.history.has.state)
            .filter_map(|(body, side)| Some((body_name(*body), Switches::rate(&side.states)?)))
            .collect();
        let slips = by_slip.iter().filter_map(|(view, _, found)| Some((*view, found.value?)));
        let slips: Vec<_> = slips.collect();
        let used = if states.is_empty() { &slips } else { &states };
        let worst = used.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let time = self.scales.shear_wave.map(|speed| self.scales.size / speed);
        let worst = worst.filter(|_| !self.history.follows);
        let value = worst.zip(time).map(|((_, rate), time)| rate * time);
        let mut entry = entry(measure, value, limit, asked);
        if let Some((view, rate)) = worst {
            entry["side"] = json!(view);
            entry["per_node_and_microsecond"] = json!(rate * 1e-6);
        }
        if time.is_none() {
            entry["note"] = json!("the scale shear_wave is not known");
        }
        let per_us = |rates: &[(&str, f64)]| -> Map<String, Value> {
            rates.iter().map(|(view, rate)| ((*view).to_owned(), json!(rate * 1e-6))).collect()
        };
        entry["sides"] = json!({ "by_state": per_us(&states), "by_slip": per_us(&slips) });
        entry
    }

    /// The entry of `mesh_mode`, from the object `mesh_mode` of the document.
    fn mesh_mode(
        &self,
        measure: &Measure,
        found: &Value,
        limit: Option<Limit>,
        asked: bool,
    ) -> Value {
        let mut entry = entry(measure, found["alternating_slip"].as_f64(), limit, asked);
        if entry["value"].is_null() {
            entry["note"] = json!("hardly anything slips");
        } else {
            entry["side"] = json!(self.history.enforced_on.map_or("both", body_name));
        }
        entry
    }

    fn place(&self, view: &str, pairing: Option<Pairing>, found: &Statistic) -> Value {
        let Some((node, time, value)) = found.place else {
            return Value::Null;
        };
        let position = node.map(|node| self.history.surface.points[node]);
        json!({ "side": view, "pairing": pairing.map(Pairing::name), "node": node,
                "position": position, "time": time, "value": value })
    }

    /// Why a measure has no value.
    fn why_none(&self, name: &str, basis: &Basis) -> &'static str {
        let no_law = basis.law.is_none() && self.replay.is_err();
        match name {
            "penetration" | "complementarity" if !self.history.has.gap => {
                "the file has no field gap"
            }
            "penetration" | "complementarity" => "the scale approach is not known",
            "law_error" | "law_error_let_slip" | "roughness_ratio" | "law_scatter" if no_law => {
                "the friction law is not known"
            }
            "law_error_let_slip" | "direction_let_slip" if !self.history.has.state => {
                "the file has no field state"
            }
            "law_error_own" | "mu_error" | "mu_error_blurred" if !self.history.has.mu => {
                "the file has no field mu"
            }
            "mu_error" | "mu_error_blurred" if self.replay.is_err() => {
                "the law's mu cannot be recomputed, see the note"
            }
            "mu_error" => "no node has every step recorded since its contact began",
            "mu_error_blurred" => "every step that the law's mu needs is recorded",
            "roughness_ratio" if matches!(basis.law, Some(Law::Coulomb(_))) => {
                "the law's coefficient is constant"
            }
            "roughness_ratio" if self.scales.roughness_span.is_none() => {
                "the scales half_length and speed are not known"
            }
            "roughness_ratio" => {
                "no node slips for a tenth of a transit, or records lie too far apart or too close for it"
            }
            "law_scatter" if basis.bound == Bound::Used => {
                "the law is not a function of slip speed alone, or its graph is not known"
            }
            "adhesion_slip" => "no node is in adhesion",
            "law_error_let_slip" | "direction_let_slip" => "the algorithm lets no node slip",
            _ => "no node slips",
        }
    }
}

/// Measures that the compliance of penalty springs takes beyond their limits.
const AFFECTED_BY_COMPLIANCE: [&str; 3] = ["law_error", "direction", "violating_fraction"];

/// A note for the case that law and direction fail over all slip, but hold at nodes whose state by the algorithm
/// is slip.
fn compliance_note(metrics: &Map<String, Value>) -> Option<String> {
    let holds = |name: &str| metrics[name]["pass"] == json!(true);
    let measured =
        |name: &str| metrics[name]["value"].is_number() && !metrics[name]["limit"].is_null();
    let own = ["law_error_let_slip", "direction_let_slip"];
    let failed: Vec<&str> =
        AFFECTED_BY_COMPLIANCE.into_iter().filter(|name| !holds(name)).collect();
    (!failed.is_empty() && own.iter().all(|name| measured(name) && holds(name))).then(|| {
        format!(
            "law and direction hold at nodes that the algorithm lets slip; penalty springs that deform at \
             nodes held in stick take {} beyond the limit (docs/checks.md, What penalty can pass)",
            failed.join(", ")
        )
    })
}

fn entry(measure: &Measure, value: Option<f64>, limit: Option<Limit>, asked: bool) -> Value {
    // A measure without a value fails only where the user set its limit.
    let pass = match (value, limit) {
        (Some(value), Some(limit)) => limit.holds(value),
        (None, Some(_)) => !asked,
        (_, None) => true,
    };
    json!({ "value": value, "limit": limit_value(limit), "pass": pass, "where": null,
            "units": measure.units, "statistic": measure.statistic, "about": measure.about })
}

/// The slip velocity that the document of a check pairs with a traction, in words.
pub fn slip_paired(document: &Value) -> &'static str {
    match document["pairing"]["reported"].as_str() {
        Some("before") => "that of the step before",
        Some("after") => "that of the step after",
        _ => "that of the step before or after, whichever is stricter",
    }
}

/// Whether a measure of a check's document keeps its limit; `None` without a limit, or without a value that could
/// keep it.
pub fn keeps_limit(metric: &Value) -> Option<bool> {
    let pass = metric["pass"] == json!(true);
    let without = metric["limit"].is_null() || (metric["value"].is_null() && pass);
    (!without).then_some(pass)
}

fn limit_value(limit: Option<Limit>) -> Value {
    match limit {
        None => Value::Null,
        Some(Limit::Most(most)) => json!(most),
        Some(Limit::Between(low, high)) => json!([low, high]),
    }
}

/// Every statistic of every view and pairing.
fn details(all: &[(&'static str, Option<Pairing>, Statistic)]) -> Value {
    let mut sides = json!({});
    for (view, pairing, found) in all {
        let mut one = json!({ "value": found.value });
        for (name, value) in &found.more {
            one[*name] = json!(value);
        }
        match pairing {
            Some(pairing) => sides[*view][pairing.name()] = one,
            None => sides[*view] = one,
        }
    }
    sides
}

fn law_value(basis: &Basis, followed: bool) -> Value {
    let bound = match basis.bound {
        Bound::Law => "mu(|s|)",
        Bound::Used if followed => "mu of the law, recomputed from the records",
        Bound::Used => "mu that the algorithm used",
    };
    match basis.law {
        Some(Law::Coulomb(law)) => json!({ "law": "coulomb", "static": law.mu, "bound": bound }),
        Some(Law::Exponential(law)) => json!({
            "law": "exponential", "static": law.mu_static, "dynamic": law.mu_dynamic,
            "decay": law.decay, "bound": bound }),
        None => json!({ "law": null, "bound": bound }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_measure_without_a_value_is_not_judged_unless_its_limit_was_asked_for() {
        let measure = &crate::check::MEASURES[0];
        let of = |value, limit, asked| keeps_limit(&entry(measure, value, limit, asked));
        let limit = Some(Limit::Most(5e-3));
        assert_eq!(of(None, limit, false), None);
        assert_eq!(of(None, limit, true), Some(false));
        assert_eq!(of(Some(1e-3), limit, false), Some(true));
        assert_eq!(of(Some(1e-2), limit, false), Some(false));
        assert_eq!(of(Some(1e-2), None, false), None);
    }
}
