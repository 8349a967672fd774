//! The check of a run: every measure on every view of the interface, in one pass over its records.

use crate::PostError;
use crate::basis::{Basis, Bound, RunPaths, SCALES};
use crate::conditions::{DIRECTION_TOLERANCE, IN_ADHESION, IN_CONTACT, Judge, LAW_TOLERANCE, Node};
use crate::foot::Pair;
use crate::frames::{ContactHistory, Frame, Pairing};
use crate::law::Law;
use crate::limits::{Limit, Limits, MEASURES, Measure};
use crate::map::MapWriter;
use crate::patch_series::{self, PatchRow};
use crate::statistics::mean_and_deviation;
use crate::surface::{Surface, body_name};
use crate::tally::{SideTally, Statistic, Switches, Tally};
use crate::vector::{Vec3, norm};
use output::HistoryFile;
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::path::Path;

/// Which pairing in time of slip and traction a check reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Report {
    /// The one that the file states as its method's own, else the stricter.
    #[default]
    Stated,
    /// The larger violation of the two.
    Stricter,
    /// One of them.
    Only(Pairing),
}

/// What to check.
#[derive(Clone, Debug)]
pub struct CheckOptions<'a> {
    /// From and to (s), both included; `None` is the run's evaluation window, or all of it.
    pub window: Option<[f64; 2]>,
    /// Limits.
    pub limits: Limits,
    /// Pairing to report.
    pub report: Report,
    /// Where to write per-node violations over time.
    pub map: Option<&'a Path>,
}

/// What a check found.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The contract's document.
    pub document: Value,
    /// Whether every limit holds.
    pub pass: bool,
    /// The patch over time.
    pub patch: Vec<PatchRow>,
}

/// A part of the interface on which the tangential conditions are judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum View {
    /// The nodes of a body with the slip velocity recorded for them.
    Side(u8),
    /// The slave nodes with their motion relative to the faces of the other side.
    Pair,
}

impl View {
    fn name(self) -> &'static str {
        match self {
            Self::Side(body) => body_name(body),
            Self::Pair => "pair",
        }
    }
}

struct Channel {
    view: View,
    body: u8,
    pairing: Pairing,
    tally: Tally,
}

/// Checks the contact conditions of a run against `basis`.
///
/// Each record weighs with the time that it stands for, so that spans recorded at every step do
/// not outweigh others.
///
/// # Errors
/// Files that cannot be read or lack what the measures are made of; a window without contact.
pub fn check(
    paths: &RunPaths,
    basis: &mut Basis,
    options: &CheckOptions<'_>,
) -> Result<Checked, PostError> {
    let history = ContactHistory::open(&paths.contact)?;
    let span = options.window.or(basis.window).unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let records = match history.window(span) {
        // a run that ended, or has come, only to before its evaluation window
        Err(_) if options.window.is_none() => 0..history.times.len(),
        found => found?,
    };
    let scales = Scales::settle(basis, &history, &records)?;
    let mut checker = Checker::new(&history, basis, scales);
    let mut map = options
        .map
        .map(|path| MapWriter::create(path, &history.surface, &paths.contact))
        .transpose()?;
    let weights = weights(&history.times[records.clone()]);
    let mut patch = Vec::with_capacity(records.len());
    let patch_body = history.surface.bodies().last().copied().unwrap_or(0);
    let first = records.start;
    history.stream(records.clone(), |frame| {
        if let Some(map) = &mut map {
            map.write(&history.surface, &frame, &checker.judge, &checker.scales)?;
        }
        patch.push(patch_series::measure(
            &history.surface,
            &frame,
            patch_body,
            checker.scales.peak_pressure,
        ));
        let weight = weights[frame.index - first];
        checker.take(frame, weight);
        Ok(())
    })?;
    if checker.node_times == 0 {
        return Err(PostError::Lacks {
            path: paths.contact.clone(),
            what: format!(
                "no node is in contact in the window: no pressure exceeds {IN_CONTACT} p0 = {:e} Pa",
                IN_CONTACT * checker.scales.peak_pressure
            ),
        });
    }
    let times = [history.times[records.start], history.times[records.end - 1]];
    let (mut document, pass) = checker.document(basis, options, times, records.len(), &patch);
    if let Some(creepage) = creepage(&paths.folder.join("history.h5"), times) {
        document["patch"]["creepage"] = creepage;
    }
    Ok(Checked { document, pass, patch })
}

/// Mean and deviation of the creepage that the history holds for the window.
fn creepage(path: &Path, [from, to]: [f64; 2]) -> Option<Value> {
    let history = HistoryFile::open(path).ok()?;
    let (times, values) = (history.read("time").ok()?, history.read("creepage").ok()?);
    let inside = times.iter().zip(&values).filter(|(t, _)| (from..=to).contains(*t));
    let [mean, deviation] = mean_and_deviation(inside.map(|(_, value)| *value))?;
    Some(json!({ "mean": mean, "deviation": deviation, "units": "1",
                 "about": "longitudinal creepage, from the history" }))
}

/// The scales that every check needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales {
    pub peak_pressure: f64,
    pub approach: Option<f64>,
    pub slip_speed: f64,
    /// A tenth of a contact transit (s).
    pub roughness_span: Option<f64>,
    pub size: f64,
    pub shear_wave: Option<f64>,
    pub dt: Option<f64>,
}

impl Scales {
    /// What the basis knows, completed from the records where that can be done.
    pub fn settle(
        basis: &mut Basis,
        history: &ContactHistory,
        records: &std::ops::Range<usize>,
    ) -> Result<Self, PostError> {
        let surface = &history.surface;
        if basis.scale("peak_pressure").is_none() || basis.scale("half_length").is_none() {
            let last = history.record(records.end - 1)?;
            let body = surface.bodies().last().copied().unwrap_or(0);
            let row = patch_series::measure(surface, &last, body, 0.0);
            let [a, b, _, fitted, raw, ..] = row.values;
            let top = if fitted.is_finite() { fitted } else { raw };
            basis.offer("peak_pressure", top, "pressure of the last record");
            basis.offer("half_length", a, "pressure of the last record");
            basis.offer("half_width", b, "pressure of the last record");
        }
        let area = surface.area.iter().sum::<f64>() / surface.area.len() as f64;
        basis.offer("size", area.sqrt(), "mean nodal area");
        basis.complete();
        let unknown = |name, remedy| PostError::Unknown { name, remedy };
        let peak_pressure = basis.scale("peak_pressure").ok_or_else(|| {
            unknown(
                "the pressure scale p0",
                "no node carries pressure at the end of the window; give --scale peak_pressure=PA",
            )
        })?;
        let slip_speed = basis.scale("slip_speed").ok_or_else(|| {
            unknown(
                "the slip scale s_c = |creepage| V",
                "give --scale slip_speed=M/S, or --case CASE.toml with drive.speed and \
                 drive.creepage",
            )
        })?;
        if basis.bound == Bound::Used && !history.has("mu") {
            return Err(unknown(
                "the bound of friction",
                "the file has no field mu; give --case CASE.toml with friction.law and its \
                 coefficients",
            ));
        }
        let transit = basis
            .scale("half_length")
            .zip(basis.scale("speed"))
            .map(|(a, speed)| 2.0 * a / speed.abs());
        Ok(Self {
            peak_pressure,
            approach: basis.scale("approach"),
            slip_speed,
            roughness_span: transit.map(|transit| transit / 10.0),
            size: basis.scale("size").unwrap_or(area.sqrt()),
            shear_wave: basis.scale("shear_wave"),
            dt: basis.scale("dt"),
        })
    }
}

/// The time that each record stands for: half the way to its neighbours.
fn weights(times: &[f64]) -> Vec<f64> {
    let gap = |i: usize| times.get(i + 1).map(|next| next - times[i]);
    (0..times.len())
        .map(|i| {
            let (before, after) = (i.checked_sub(1).and_then(gap), gap(i));
            match (before, after) {
                (Some(before), Some(after)) => 0.5 * (before + after),
                (Some(only), None) | (None, Some(only)) => only,
                (None, None) => 1.0,
            }
        })
        .collect()
}

/// What is kept of a record until the next.
struct Previous {
    time: f64,
    frame: Frame,
    contact: Vec<bool>,
    pair_slip: Vec<Option<Vec3>>,
}

struct Checker<'a> {
    history: &'a ContactHistory,
    judge: Judge,
    scales: Scales,
    channels: Vec<Channel>,
    sides: Vec<(u8, SideTally)>,
    pair: Option<Pair>,
    previous: Option<Previous>,
    node_times: usize,
    without_foot: usize,
}

impl<'a> Checker<'a> {
    fn new(history: &'a ContactHistory, basis: &Basis, scales: Scales) -> Self {
        let surface = &history.surface;
        let nodes = surface.points.len();
        let bodies = surface.bodies();
        let pair = (bodies.len() == 2 && history.has("motion"))
            .then(|| Pair::new(surface, finer_body(surface, &bodies)));
        let views = bodies.iter().map(|&body| (View::Side(body), body));
        let views = views.chain(pair.as_ref().map(|pair| (View::Pair, pair.slave)));
        let channels = views
            .flat_map(|(view, body)| {
                [Pairing::Before, Pairing::After].map(|pairing| Channel {
                    view,
                    body,
                    pairing,
                    tally: Tally::new(nodes, scales.roughness_span),
                })
            })
            .collect();
        Self {
            history,
            judge: Judge::new(basis, scales.slip_speed),
            scales,
            channels,
            sides: bodies.iter().map(|&body| (body, SideTally::new(nodes))).collect(),
            pair,
            previous: None,
            node_times: 0,
            without_foot: 0,
        }
    }

    fn take(&mut self, frame: Frame, weight: f64) {
        let surface = &self.history.surface;
        let limit = IN_CONTACT * self.scales.peak_pressure;
        let contact: Vec<bool> = frame.pressure.iter().map(|&p| p > limit).collect();
        self.node_times += contact.iter().filter(|c| **c).count();
        for (body, side) in &mut self.sides {
            take_side(side, *body, surface, &frame, &contact, weight, &self.judge, &self.scales);
        }
        // The pair's slip where either this record or the last has contact: both pairings need it.
        let mut pair_slip = vec![None; contact.len()];
        if let (Some(pair), Some(motion)) = (&mut self.pair, &frame.motion) {
            let before = self.previous.as_ref().map(|p| &p.contact);
            let wanted = |&row: &usize| {
                surface.body[row] == pair.slave
                    && (contact[row] || before.is_some_and(|before| before[row]))
            };
            let rows: Vec<usize> = (0..contact.len()).filter(wanted).collect();
            for (&row, slip) in rows.iter().zip(pair.slip(surface, motion, &rows)) {
                self.without_foot += usize::from(slip.is_none() && contact[row]);
                pair_slip[row] = slip;
            }
        }
        let own = self.history.pairing.0;
        let adjacent = self.previous.as_ref().filter(|previous| {
            let step = frame.time - previous.time;
            self.scales.dt.is_some_and(|dt| (step / dt - 1.0).abs() < 0.01)
        });
        let (judge, record) = (&self.judge, (&frame, &contact, &pair_slip));
        // Views and pairings are independent of each other: the same bits on any number of threads.
        self.channels.par_iter_mut().for_each(|channel| {
            let (frame, contact, pair_slip) = record;
            // (record of the traction, its contact, record of the slip, its pair's slip)
            let (traction, contact, slip, pair_slip, weight) = if channel.pairing == own {
                (frame, contact, frame, pair_slip, weight)
            } else {
                let Some(previous) = adjacent else {
                    return;
                };
                let step = frame.time - previous.time;
                match own {
                    Pairing::Before => (&previous.frame, &previous.contact, frame, pair_slip, step),
                    Pairing::After => (frame, contact, &previous.frame, &previous.pair_slip, step),
                }
            };
            take_view(channel, surface, traction, contact, slip, pair_slip, weight, judge);
        });
        self.previous = Some(Previous { time: frame.time, frame, contact, pair_slip });
    }

    fn document(
        &self,
        basis: &Basis,
        options: &CheckOptions<'_>,
        window: [f64; 2],
        steps: usize,
        patch: &[PatchRow],
    ) -> (Value, bool) {
        let (own, stated) = self.history.pairing;
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
            let found = self.metric(measure, limit, asked, reported, basis);
            pass &= found["pass"] == json!(true);
            limits.insert(measure.name.into(), limit_value(limit));
            metrics.insert(measure.name.into(), found);
        }
        let crossed: usize = self
            .channels
            .iter()
            .filter(|c| c.pairing != own)
            .map(|c| c.tally.records)
            .max()
            .unwrap_or(0);
        let scales = SCALES.iter().filter_map(|(name, units, about)| {
            let scale = basis.scales.get(name)?;
            let entry = json!({ "value": scale.value, "units": units, "about": about,
                                "from": scale.from });
            Some(((*name).to_owned(), entry))
        });
        let document = json!({
            "name": basis.name,
            "window": window,
            "steps": steps,
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
            "law": law_value(basis),
            "scales": scales.collect::<Map<_, _>>(),
            "tolerances": {
                "in_contact": IN_CONTACT, "in_adhesion": IN_ADHESION,
                "law_error": LAW_TOLERANCE, "direction": DIRECTION_TOLERANCE,
            },
            "patch": patch_series::means(patch),
            "notes": self.notes(crossed),
        });
        (document, pass)
    }

    fn notes(&self, crossed: usize) -> Vec<String> {
        let mut notes = Vec::new();
        for (field, lost) in [
            ("gap", "penetration and complementarity are not measured"),
            ("mu", "law_error_own is not measured"),
            ("state", "switches are counted from the slip velocity"),
            ("motion", "the slip of the pair is not measured (displacement and velocity)"),
        ] {
            if !self.history.has(field) {
                notes.push(format!("the file has no {field}: {lost}"));
            }
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
        if self.without_foot > 0 {
            notes.push(format!(
                "{} node-times in contact project on no face of the other side and are left out \
                 of the pair",
                self.without_foot
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
            for channel in self.channels.iter().filter(|c| c.tally.records > 0) {
                let found = channel.tally.statistic(measure.name);
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
            "roughness_ratio" => value.ln().abs(),
            _ => value,
        };
        // What the faces hand on to the nodes of the other body obeys the law only on the mean.
        let judged = |view: &str, pairing: Option<Pairing>| {
            let receives = |body: u8| view == body_name(1 - body);
            pairing.is_none() || !self.history.enforced_on.is_some_and(receives)
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
        } else {
            entry["note"] = json!(self.why_none(measure.name, basis));
        }
        entry["sides"] = details(&all);
        entry
    }

    /// Switches by the algorithm's state where the file has it, else by the slip velocity.
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
            .filter(|_| self.history.has("state"))
            .filter_map(|(body, side)| Some((body_name(*body), Switches::rate(&side.states)?)))
            .collect();
        let slips = by_slip.iter().filter_map(|(view, _, found)| Some((*view, found.value?)));
        let slips: Vec<_> = slips.collect();
        let used = if states.is_empty() { &slips } else { &states };
        let worst = used.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let time = self.scales.shear_wave.map(|speed| self.scales.size / speed);
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
        let no_law = basis.law.is_none();
        match name {
            "penetration" | "complementarity" if !self.history.has("gap") => {
                "the file has no field gap"
            }
            "penetration" | "complementarity" => "the scale approach is not known",
            "law_error" | "roughness_ratio" | "law_scatter" if no_law => {
                "the friction law is not known"
            }
            "law_error_own" if !self.history.has("mu") => "the file has no field mu",
            "roughness_ratio" if matches!(basis.law, Some(Law::Coulomb(_))) => {
                "the law's coefficient is constant"
            }
            "roughness_ratio" if self.scales.roughness_span.is_none() => {
                "the scales half_length and speed are not known"
            }
            "roughness_ratio" => {
                "no node slips for a tenth of a transit, or records lie too far apart"
            }
            "adhesion_slip" => "no node is in adhesion",
            _ => "no node slips",
        }
    }
}

fn entry(measure: &Measure, value: Option<f64>, limit: Option<Limit>, asked: bool) -> Value {
    // What nobody asked for and what has no value violates nothing.
    let pass = match (value, limit) {
        (Some(value), Some(limit)) => limit.holds(value),
        (None, Some(_)) => !asked,
        (_, None) => true,
    };
    json!({ "value": value, "limit": limit_value(limit), "pass": pass, "where": null,
            "units": measure.units, "statistic": measure.statistic, "about": measure.about })
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

pub(crate) fn law_value(basis: &Basis) -> Value {
    let bound = match basis.bound {
        Bound::Law => "mu(|s|)",
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

/// The body with the smaller nodal area, the first of equals: its nodes follow the other's faces.
fn finer_body(surface: &Surface, bodies: &[u8]) -> u8 {
    let mean = |body: u8| {
        let areas = surface.body.iter().zip(&surface.area).filter(|(b, _)| **b == body);
        let (count, sum) = areas.fold((0.0, 0.0), |(n, s), (_, a)| (n + 1.0, s + a));
        sum / f64::max(count, 1.0)
    };
    match bodies {
        [a, b] if mean(*b) < 0.99 * mean(*a) => *b,
        [a, ..] => *a,
        [] => 0,
    }
}

fn take_side(
    side: &mut SideTally,
    body: u8,
    surface: &Surface,
    frame: &Frame,
    contact: &[bool],
    weight: f64,
    judge: &Judge,
    scales: &Scales,
) {
    let time = frame.time;
    for row in (0..contact.len()).filter(|&row| surface.body[row] == body) {
        let area = weight * surface.area[row];
        let pressure = frame.pressure[row];
        side.add_pressure(row, time, area, (-pressure).max(0.0) / scales.peak_pressure);
        if let (Some(gap), Some(approach)) = (&frame.gap, scales.approach) {
            let pressure = pressure.max(0.0) / scales.peak_pressure;
            side.add_gap(row, time, area, gap[row] / approach, pressure);
        }
        if !contact[row] {
            side.states.open(row);
            continue;
        }
        // without a law the largest coefficient used is all that is known of the cone
        let used = frame.mu.as_ref().map(|mu| mu[row]);
        if let Some(mu) = judge.law.map(|law| law.mu_static()).or(used) {
            side.add_cone(row, time, area, norm(frame.shear[row]) / (mu * pressure) - 1.0);
        }
        match frame.state.as_ref().map(|state| state[row]) {
            Some(state @ (1 | 2)) => side.states.add(row, time, state == 2),
            _ => side.states.open(row),
        }
    }
}

fn take_view(
    channel: &mut Channel,
    surface: &Surface,
    traction: &Frame,
    contact: &[bool],
    slip: &Frame,
    pair_slip: &[Option<Vec3>],
    weight: f64,
    judge: &Judge,
) {
    let tally = &mut channel.tally;
    tally.begin_record(traction.time);
    for row in (0..contact.len()).filter(|&row| surface.body[row] == channel.body) {
        let slip = match channel.view {
            View::Side(_) => Some(slip.slip_velocity[row]),
            View::Pair => pair_slip[row],
        };
        let Some(slip) = slip.filter(|_| contact[row]) else {
            tally.open(row);
            continue;
        };
        let node = Node {
            pressure: traction.pressure[row],
            shear: traction.shear[row],
            slip,
            mu_used: traction.mu.as_ref().map(|mu| mu[row]),
            state: traction.state.as_ref().map(|state| state[row]),
        };
        tally.add(row, traction.time, surface.area[row], weight, &judge.judge(&node));
    }
    tally.end_record(traction.time);
}
