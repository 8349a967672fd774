//! Statistics over nodes and times of the contact conditions at single nodes.

use crate::check::conditions::Judged;
use crate::check::measure::Measure;
use crate::check::replay::Allowed;
use crate::check::result::Detail;
use crate::check::roughness::Roughness;
use crate::check::statistics::{Moments, Occurrence, Spread};

/// The tangential conditions on one view of the interface in one pairing.
pub(crate) struct Accumulator {
    /// Area times time (m2 s) of contact, of contact that violates the conditions, and of the part of that whose state
    /// by the algorithm is slip.
    contact: f64,
    violating: f64,
    violating_slip_state: f64,
    /// Time and share of the record with the largest share in violation.
    worst_record: Option<(f64, f64)>,
    /// Violating area and all area of contact in this record (m2).
    record: [f64; 2],
    violating_of_records: Moments,
    wrong_record: [f64; 2],
    wrong_of_records: Moments,
    power_record: [f64; 2],
    power_of_records: Moments,
    law_error: Spread,
    law_error_own: Spread,
    /// The law and the direction at nodes whose state by the algorithm is slip. The compliance of penalty springs at
    /// nodes that stick is left out: what remains are errors of the algorithm itself.
    slip_state: [Spread; 2],
    direction: Spread,
    /// Weight of slip that shear drives (angle above 90 degrees), and of all slip.
    wrong: [f64; 2],
    adhesion_slip: Spread,
    law_scatter: Spread,
    /// Work of the wrong sign and of both signs (J).
    power: [f64; 2],
    worst_power: Option<Occurrence>,
    roughness: Option<Roughness>,
    switches: Switches,
    pub records: usize,
}

/// A statistic of an accumulator: its value, its worst place, and further statistics by name.
pub(crate) struct Statistic {
    pub value: Option<f64>,
    /// Standard deviation over the records of the same statistic of single records.
    pub deviation: Option<f64>,
    /// Node, time (s) and value where it is worst.
    pub place: Option<(Option<usize>, f64, f64)>,
    pub more: Vec<(Detail, Option<f64>)>,
}

impl Accumulator {
    /// For `nodes` nodes; with the roughness measure, whose running mean is over `span` (s), where that is known.
    pub fn new(nodes: usize, span: Option<f64>) -> Self {
        Self {
            contact: 0.0,
            violating: 0.0,
            violating_slip_state: 0.0,
            worst_record: None,
            record: [0.0; 2],
            violating_of_records: Moments::default(),
            wrong_record: [0.0; 2],
            wrong_of_records: Moments::default(),
            power_record: [0.0; 2],
            power_of_records: Moments::default(),
            law_error: Spread::default(),
            law_error_own: Spread::default(),
            slip_state: Default::default(),
            direction: Spread::default(),
            wrong: [0.0; 2],
            adhesion_slip: Spread::default(),
            law_scatter: Spread::default(),
            power: [0.0; 2],
            worst_power: None,
            roughness: span.map(|span| Roughness::new(nodes, span)),
            switches: Switches::new(nodes),
            records: 0,
        }
    }

    /// Begins a record.
    pub fn begin_record(&mut self, time: f64) {
        if let Some(roughness) = &mut self.roughness {
            roughness.begin(time);
        }
    }

    /// Adds a node in contact with its area (m2) and the time that the record stands for (s).
    pub fn add(&mut self, row: usize, time: f64, area: f64, span: f64, judged: &Judged) {
        let weight = area * span;
        self.contact += weight;
        self.record[1] += area;
        if judged.violates {
            self.violating += weight;
            self.record[0] += area;
            if judged.slip_state {
                self.violating_slip_state += weight;
            }
        }
        if let Some(error) = judged.law_error {
            self.law_error.add(weight, error, row, time);
            if judged.slip_state {
                self.slip_state[0].add(weight, error, row, time);
            }
        }
        if let Some(error) = judged.law_error_own {
            self.law_error_own.add(weight, error, row, time);
        }
        if let Some(angle) = judged.direction {
            self.direction.add(weight, angle, row, time);
            if judged.slip_state {
                self.slip_state[1].add(weight, angle, row, time);
            }
            self.wrong_record[0] += if angle > 90.0 { weight } else { 0.0 };
            self.wrong_record[1] += weight;
        }
        if let Some(slip) = judged.adhesion_slip {
            self.adhesion_slip.add(weight, slip, row, time);
        }
        if let Some(distance) = judged.law_scatter {
            self.law_scatter.add(weight, distance, row, time);
        }
        // slip below the threshold is round-off or regularisation, without a direction
        if judged.slips {
            self.power_record[0] += weight * (-judged.power).max(0.0);
            self.power_record[1] += weight * judged.power.abs();
            if judged.power < self.worst_power.map_or(0.0, |worst| worst.value) {
                self.worst_power = Some(Occurrence { node: row, time, value: judged.power });
            }
        }
        if let Some(roughness) = &mut self.roughness {
            match judged.mu_law {
                Some(mu) if judged.slips => {
                    roughness.add(row, [judged.ratio, mu, judged.relative_speed], area)
                }
                _ => roughness.interrupt(row),
            }
        }
        self.switches.add(row, time, judged.slips);
    }

    /// Adds a node that is not in contact, or has no slip velocity.
    pub fn open(&mut self, row: usize) {
        if let Some(roughness) = &mut self.roughness {
            roughness.interrupt(row);
        }
        self.switches.open(row);
    }

    /// Ends a record that stands for `span` (s).
    pub fn end_record(&mut self, time: f64, span: f64) {
        self.records += 1;
        let [violating, contact] = std::mem::take(&mut self.record);
        let share = violating / contact;
        if contact > 0.0 {
            self.violating_of_records.add(span, share);
            if self.worst_record.is_none_or(|(_, worst)| share > worst) {
                self.worst_record = Some((time, share));
            }
        }
        for (record, all, shares) in [
            (&mut self.wrong_record, &mut self.wrong, &mut self.wrong_of_records),
            (&mut self.power_record, &mut self.power, &mut self.power_of_records),
        ] {
            let [part, whole] = std::mem::take(record);
            all[0] += part;
            all[1] += whole;
            if whole > 0.0 {
                shares.add(span, part / whole);
            }
        }
        let [law, direction] = &mut self.slip_state;
        for spread in [
            &mut self.law_error,
            &mut self.law_error_own,
            law,
            &mut self.direction,
            direction,
            &mut self.adhesion_slip,
            &mut self.law_scatter,
        ] {
            spread.end_record(span);
        }
    }

    /// The statistic of a tangential measure; without a value for any other.
    pub fn statistic(&self, measure: Measure) -> Statistic {
        let share = |[part, whole]: [f64; 2]| (whole > 0.0).then(|| part / whole);
        let by = |spread: &Spread, value: Option<f64>, deviation: Option<f64>| Statistic {
            value,
            deviation,
            place: spread.worst.map(|w| (Some(w.node), w.time, w.value)),
            more: vec![
                (Detail::Mean, spread.mean()),
                (Detail::Rms, spread.rms()),
                (Detail::P95, spread.quantile(0.95)),
                (Detail::Max, spread.largest()),
            ],
        };
        let spread = |of: &Spread| by(of, of.rms(), of.deviation_of_rms());
        let plain = |value, place| Statistic { value, deviation: None, place, more: Vec::new() };
        let also = |mut statistic: Statistic, slip_state: &Spread| {
            statistic.more.push((Detail::RmsSlipState, slip_state.rms()));
            statistic
        };
        match measure {
            Measure::LawError => also(spread(&self.law_error), &self.slip_state[0]),
            Measure::LawErrorOwn => spread(&self.law_error_own),
            Measure::Direction => also(spread(&self.direction), &self.slip_state[1]),
            Measure::LawErrorSlipState => spread(&self.slip_state[0]),
            Measure::DirectionSlipState => spread(&self.slip_state[1]),
            Measure::WrongDirection => {
                let worst = self.direction.worst.filter(|worst| worst.value > 90.0);
                let place = worst.map(|w| (Some(w.node), w.time, w.value));
                let deviation = self.wrong_of_records.deviation();
                Statistic { deviation, ..plain(share(self.wrong), place) }
            }
            Measure::AdhesionSlip => {
                let slip = &self.adhesion_slip;
                by(slip, slip.largest(), slip.deviation_of_largest())
            }
            Measure::LawScatter => spread(&self.law_scatter),
            Measure::Dissipation => {
                let place = self.worst_power.map(|w| (Some(w.node), w.time, w.value));
                let more = vec![(Detail::Energy, Some(self.power[1] - 2.0 * self.power[0]))];
                let deviation = self.power_of_records.deviation();
                Statistic { deviation, more, ..plain(share(self.power), place) }
            }
            Measure::ViolatingFraction => {
                let place = self.worst_record.filter(|(_, share)| *share > 0.0);
                let place = place.map(|(time, share)| (None, time, share));
                let deviation = self.violating_of_records.deviation();
                Statistic { deviation, ..plain(share([self.violating, self.contact]), place) }
            }
            Measure::ViolatingFractionSlipState => {
                plain(share([self.violating_slip_state, self.contact]), None)
            }
            Measure::RoughnessRatio => {
                let deviations = self.roughness.as_ref().and_then(Roughness::deviations);
                let ratio =
                    deviations.filter(|[_, law, _]| *law > 1e-9).map(|[shear, law, _]| shear / law);
                let more = vec![
                    (Detail::DeviationTraction, deviations.map(|d| d[0])),
                    (Detail::DeviationLaw, deviations.map(|d| d[1])),
                    (Detail::DeviationSlip, deviations.map(|d| d[2])),
                ];
                Statistic { more, ..plain(ratio, None) }
            }
            Measure::SwitchingRate => plain(self.switches.rate(), None),
            Measure::Penetration
            | Measure::Tension
            | Measure::Complementarity
            | Measure::Cone
            | Measure::MuError
            | Measure::MuErrorUncertain
            | Measure::MeshMode => plain(None, None),
        }
    }
}

/// Counts changes of nodes between stick and slip from record to record.
pub(crate) struct Switches {
    last: Vec<Option<(f64, bool)>>,
    switches: f64,
    node_time: f64,
}

impl Switches {
    pub fn new(nodes: usize) -> Self {
        Self { last: vec![None; nodes], switches: 0.0, node_time: 0.0 }
    }

    pub fn add(&mut self, row: usize, time: f64, slips: bool) {
        if let Some((before, slipped)) = self.last[row].replace((time, slips)) {
            self.node_time += time - before;
            self.switches += if slips == slipped { 0.0 } else { 1.0 };
        }
    }

    pub fn open(&mut self, row: usize) {
        self.last[row] = None;
    }

    /// Switches per node and time (1/s).
    pub fn rate(&self) -> Option<f64> {
        (self.node_time > 0.0).then(|| self.switches / self.node_time)
    }
}

/// The normal conditions, the friction cone, the coefficient used and the states by the algorithm, on one body.
pub(crate) struct SideAccumulator {
    penetration: Spread,
    tension: Spread,
    complementarity: Spread,
    cone: Spread,
    pub mu: MuErrors,
    pub states: Switches,
}

/// Errors of the coefficient that the algorithm used against the law's.
#[derive(Default)]
pub(crate) struct MuErrors {
    /// Where the law's coefficient is known to round-off.
    known: MuError,
    /// Where it is known to lie in an interval only.
    uncertain: MuError,
    /// 1 - low/high of that interval.
    uncertainty: Spread,
    /// Weight of contact where the law's coefficient is not known.
    pub unknown: f64,
}

/// Relative error of the coefficient used.
#[derive(Default)]
struct MuError {
    error: Spread,
    /// Sums of the weights, of the coefficient used and of the law's.
    sums: [f64; 3],
    /// The coefficient used and the law's where the error is largest.
    worst: Option<[f64; 2]>,
}

impl MuError {
    fn add(&mut self, row: usize, time: f64, weight: f64, used: f64, law: f64) {
        let error = if law > 0.0 { used / law - 1.0 } else { used - law };
        let before = self.error.largest();
        self.error.add(weight, error, row, time);
        if before.is_none_or(|before| error.abs() > before) {
            self.worst = Some([used, law]);
        }
        for (sum, part) in self.sums.iter_mut().zip([1.0, used, law]) {
            *sum += weight * part;
        }
    }

    fn statistic(&self, value: Option<f64>) -> Statistic {
        let mean = |i: usize| (self.sums[0] > 0.0).then(|| self.sums[i] / self.sums[0]);
        let worst = |i: usize| self.worst.map(|pair| pair[i]);
        Statistic {
            value,
            deviation: self.error.deviation_of_largest(),
            place: self.error.worst.map(|w| (Some(w.node), w.time, w.value)),
            more: vec![
                (Detail::Mean, self.error.mean()),
                (Detail::Median, self.error.quantile(0.5)),
                (Detail::P95, self.error.quantile(0.95)),
                (Detail::Max, self.error.largest()),
                (Detail::MuUsed, mean(1)),
                (Detail::MuLaw, mean(2)),
                (Detail::MuUsedWorst, worst(0)),
                (Detail::MuLawWorst, worst(1)),
            ],
        }
    }
}

impl MuErrors {
    /// Adds a node in contact: the coefficient `used`, and what the law allows where that is known.
    pub fn add(&mut self, row: usize, time: f64, weight: f64, used: f64, law: Option<Allowed>) {
        let Some(law) = law else {
            self.unknown += weight;
            return;
        };
        let off = if law.known { &mut self.known } else { &mut self.uncertain };
        off.add(row, time, weight, used, law.nearest(used));
        if !law.known && law.high > 0.0 {
            self.uncertainty.add(weight, 1.0 - law.low / law.high, row, time);
        }
    }

    /// Weights of contact where the law is known, uncertain, and not known.
    pub fn weights(&self) -> [f64; 3] {
        [self.known.sums[0], self.uncertain.sums[0], self.unknown]
    }
}

impl SideAccumulator {
    pub fn new(nodes: usize) -> Self {
        Self {
            penetration: Spread::default(),
            tension: Spread::default(),
            complementarity: Spread::default(),
            cone: Spread::default(),
            mu: MuErrors::default(),
            states: Switches::new(nodes),
        }
    }

    /// Adds max(-p_n, 0)/p0 of any node, in contact or not.
    pub fn add_pressure(&mut self, row: usize, time: f64, weight: f64, tension: f64) {
        self.tension.add(weight, tension, row, time);
    }

    /// Adds gap and pressure of any node, over their scales.
    pub fn add_gap(&mut self, row: usize, time: f64, weight: f64, gap: f64, pressure: f64) {
        self.penetration.add(weight, (-gap).max(0.0), row, time);
        self.complementarity.add(weight, gap.abs() * pressure, row, time);
    }

    /// Adds p_f/(mu_S p_n) - 1 of a node in contact.
    pub fn add_cone(&mut self, row: usize, time: f64, weight: f64, excess: f64) {
        self.cone.add(weight, excess.max(0.0), row, time);
    }

    /// Ends a record that stands for `span` (s).
    pub fn end_record(&mut self, span: f64) {
        for spread in [
            &mut self.penetration,
            &mut self.tension,
            &mut self.complementarity,
            &mut self.cone,
            &mut self.mu.known.error,
            &mut self.mu.uncertain.error,
        ] {
            spread.end_record(span);
        }
    }

    /// The statistic of a measure; `None` where it is no measure of one body.
    pub fn statistic(&self, measure: Measure) -> Option<Statistic> {
        let spread = match measure {
            Measure::Penetration => &self.penetration,
            Measure::Tension => &self.tension,
            Measure::Complementarity => &self.complementarity,
            Measure::Cone => &self.cone,
            Measure::MuError => {
                let known = &self.mu.known;
                return Some(known.statistic(known.error.largest()));
            }
            Measure::MuErrorUncertain => {
                let off = &self.mu.uncertain;
                let mut found = off.statistic(off.error.quantile(0.5));
                let uncertainty = &self.mu.uncertainty;
                found.more.push((Detail::UncertaintyMedian, uncertainty.quantile(0.5)));
                found.more.push((Detail::UncertaintyRms, uncertainty.rms()));
                found.more.push((Detail::UncertaintyP95, uncertainty.quantile(0.95)));
                return Some(found);
            }
            _ => return None,
        };
        let worst = spread.worst.filter(|worst| worst.value != 0.0);
        Some(Statistic {
            value: spread.largest(),
            deviation: spread.deviation_of_largest(),
            place: worst.map(|w| (Some(w.node), w.time, w.value)),
            more: vec![(Detail::Mean, spread.mean()), (Detail::P95, spread.quantile(0.95))],
        })
    }
}
