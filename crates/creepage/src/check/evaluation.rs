//! One pass over the records of a window: every measure on every view of the interface.

use super::scales::Scales;
use crate::check::PostError;
use crate::check::accumulator::{Accumulator, SideAccumulator};
use crate::check::basis::{Basis, Bound};
use crate::check::conditions::{IN_CONTACT, Judge, Node};
use crate::check::frames::{ContactHistory, Frame};
use crate::check::map::MapWriter;
use crate::check::patch_series::{self, PatchRow};
use crate::check::projection::Pair;
use crate::check::replay::{Allowed, Replay};
use crate::check::result::View;
use crate::check::surface::Surface;
use contact::mesh_mode::MeshMode;
use contact::patch::PatchShape;
use friction::NodeConditions;
use nalgebra::Vector3;
use output::layout::Pairing;

/// The tangential conditions on a view in one pairing.
pub(super) struct Channel {
    pub view: View,
    body: u8,
    pub pairing: Pairing,
    pub accumulator: Accumulator,
}

/// A record with quantities derived from it.
struct Record {
    frame: Frame,
    /// The time that it stands for (s).
    weight: f64,
    /// Whether each node is in contact.
    contact: Vec<bool>,
    /// The pair's slip velocity (m/s) of nodes in contact in this record or the one before.
    pair_slip: Vec<Option<Vector3<f64>>>,
    /// The coefficients that the law allows at each node; empty where the law cannot be followed.
    allowed: Vec<Option<Allowed>>,
}

/// The measures of a check, accumulated over the records.
pub(super) struct Evaluation<'a> {
    pub history: &'a ContactHistory,
    pub judge: Judge,
    pub scales: Scales,
    pub channels: Vec<Channel>,
    pub sides: Vec<(u8, SideAccumulator)>,
    pub patch: Vec<PatchRow>,
    /// Number of nodes in contact, summed over the records.
    pub node_times: usize,
    /// How many of these have no projection.
    pub without_projection: usize,
    /// Alternating slip over the faces in contact, where the conditions are enforced.
    pub mesh_mode: MeshMode,
    judged_faces: Vec<[u32; 4]>,
    /// The law followed along the records, or the reason why it cannot be.
    pub replay: Result<Replay, String>,
    shape: PatchShape,
    pair: Option<Pair>,
    previous: Option<Record>,
}

impl<'a> Evaluation<'a> {
    pub fn new(history: &'a ContactHistory, basis: &Basis, scales: Scales) -> Self {
        let surface = &history.surface;
        let nodes = surface.points.len();
        let bodies = surface.bodies();
        let pair = (bodies.len() == 2 && history.has.motion)
            .then(|| Pair::new(surface, finer_body(surface, &bodies)));
        // a mean over time at a node is one at a point of material only where the mesh stays
        let span = scales.roughness_span.filter(|_| !history.follows);
        let views = bodies.iter().map(|&body| (View::of(body), body));
        let views = views.chain(pair.as_ref().map(|pair| (View::Pair, pair.slave)));
        let channels = views
            .flat_map(|(view, body)| {
                [Pairing::Before, Pairing::After].map(|pairing| Channel {
                    view,
                    body,
                    pairing,
                    accumulator: Accumulator::new(nodes, span),
                })
            })
            .collect();
        Self {
            history,
            judge: Judge::new(basis, scales.slip_speed),
            replay: if history.has.mu {
                Replay::new(history, basis, scales.dt)
            } else {
                Err("the file has no field mu".into())
            },
            scales,
            channels,
            sides: bodies.iter().map(|&body| (body, SideAccumulator::new(nodes))).collect(),
            patch: Vec::new(),
            node_times: 0,
            without_projection: 0,
            mesh_mode: MeshMode::default(),
            judged_faces: judged_faces(history),
            shape: basis.shape,
            pair,
            previous: None,
        }
    }

    /// Follows the law through the records before number `first`, from the first that its state depends on.
    ///
    /// # Errors
    /// Records that cannot be read.
    pub fn lead_in(&mut self, first: usize) -> Result<(), PostError> {
        let Ok(replay) = &mut self.replay else { return Ok(()) };
        let history = self.history;
        history.stream(replay.start(first)..first, |frame| {
            replay.follow(&history.surface, &frame);
            Ok(())
        })
    }

    /// Adds the next records, each with the time that it stands for (s), and writes the `map` of each.
    ///
    /// Views, pairings and sides are independent of each other and each goes through the records in order: the
    /// bits do not depend on the number of threads or the size of batches.
    ///
    /// # Errors
    /// A map that cannot be written.
    pub fn take(
        &mut self,
        frames: impl IntoIterator<Item = (Frame, f64)>,
        map: Option<&mut MapWriter>,
    ) -> Result<(), PostError> {
        let limit = IN_CONTACT * self.scales.peak_pressure;
        let (surface, replay) = (&self.history.surface, &mut self.replay);
        let record = |(frame, weight): (Frame, f64)| {
            let contact: Vec<bool> = frame.pressure.iter().map(|&p| p > limit).collect();
            let allowed =
                replay.as_mut().map(|replay| replay.follow(surface, &frame)).unwrap_or_default();
            Record { pair_slip: vec![None; contact.len()], frame, weight, contact, allowed }
        };
        let mut records: Vec<Record> = self.previous.take().into_iter().collect();
        let first = records.len();
        records.extend(frames.into_iter().map(record));
        self.node_times += records[first..].iter().flat_map(|r| &r.contact).filter(|c| **c).count();

        let (history, judge, scales) = (self.history, &self.judge, &self.scales);
        let replay = self.replay.as_ref().ok();
        let surface = &history.surface;
        if let Some(map) = map {
            for Record { frame, allowed, .. } in &records[first..] {
                let mu = |row: usize| {
                    let slip = frame.slip_velocity[row];
                    let replay = replay.filter(|_| judge.bound == Bound::Used)?;
                    recomputed_mu(replay, surface, frame, allowed, slip, row)
                };
                map.write(surface, frame, mu, judge, scales)?;
            }
        }
        let (pairs, views): (Vec<&mut Channel>, Vec<&mut Channel>) =
            self.channels.iter_mut().partition(|channel| channel.view == View::Pair);
        let (sides, patch) = (&mut self.sides, &mut self.patch);
        let (mesh_mode, faces) = (&mut self.mesh_mode, &self.judged_faces[..]);
        // The pair's slip is computed beside the other views; the views that need it follow.
        let mut slips = Vec::new();
        let (motion, lost) = (&mut self.pair, &mut self.without_projection);
        rayon::scope(|scope| {
            let records = &records;
            scope.spawn(|_| {
                if let Some(pair) = motion {
                    slips = pair_slips(pair, surface, records, first, lost);
                }
            });
            for channel in views {
                scope.spawn(move |_| channel.take(history, records, first, judge, replay, scales));
            }
            for (body, side) in sides {
                scope.spawn(move |_| {
                    for record in &records[first..] {
                        take_side(side, *body, surface, record, judge, scales);
                    }
                });
            }
            scope.spawn(|_| {
                for Record { frame, weight, contact, .. } in &records[first..] {
                    mesh_mode.add(*weight, faces, &frame.slip_velocity, |node| contact[node]);
                }
            });
            scope.spawn(|_| {
                let body = surface.bodies().last().copied().unwrap_or(0);
                let p0 = scales.peak_pressure;
                let shape = self.shape;
                let rows = records[first..].iter();
                patch.extend(
                    rows.map(|r| patch_series::measure(surface, &r.frame, body, p0, shape)),
                );
            });
        });
        for (record, slip) in records[first..].iter_mut().zip(slips) {
            record.pair_slip = slip;
        }
        rayon::scope(|scope| {
            let records = &records;
            for channel in pairs {
                scope.spawn(move |_| channel.take(history, records, first, judge, replay, scales));
            }
        });
        self.previous = records.pop();
        Ok(())
    }
}

impl Channel {
    /// Judges `records[first..]`; a record before them is judged already.
    fn take(
        &mut self,
        history: &ContactHistory,
        records: &[Record],
        first: usize,
        judge: &Judge,
        replay: Option<&Replay>,
        scales: &Scales,
    ) {
        let own = history.pairing.0;
        for k in first..records.len() {
            let record = &records[k];
            if self.pairing == own {
                self.judge(&history.surface, record, record, record.weight, judge, replay);
                continue;
            }
            // the other pairing takes slip or traction from the record one step before
            let Some(before) = k.checked_sub(1).map(|k| &records[k]) else {
                continue;
            };
            let step = record.frame.time - before.frame.time;
            let follows_it = scales.dt.is_some_and(|dt| (step / dt - 1.0).abs() < 0.01);
            // a node is no point of material across a move
            let moved =
                history.follows && mesh_moved(&history.surface.area, &before.frame, &record.frame);
            if !follows_it || moved {
                continue;
            }
            let (traction, slip) = match own {
                Pairing::Before => (before, record),
                Pairing::After => (record, before),
            };
            self.judge(&history.surface, traction, slip, step, judge, replay);
        }
    }

    /// Judges the traction of one record with the slip of another or the same.
    fn judge(
        &mut self,
        surface: &Surface,
        Record { frame: traction, contact, allowed, .. }: &Record,
        slip: &Record,
        weight: f64,
        judge: &Judge,
        replay: Option<&Replay>,
    ) {
        let accumulator = &mut self.accumulator;
        accumulator.begin_record(traction.time);
        for row in (0..contact.len()).filter(|&row| surface.body[row] == self.body) {
            let slip = match self.view {
                View::Pair => slip.pair_slip[row],
                _ => Some(slip.frame.slip_velocity[row]),
            };
            let Some(slip) = slip.filter(|_| contact[row]) else {
                accumulator.open(row);
                continue;
            };
            let node = Node {
                pressure: traction.pressure[row],
                shear: traction.shear[row],
                slip,
                mu_used: traction.mu.as_ref().map(|mu| mu[row]),
                mu_recomputed: replay.filter(|_| judge.bound == Bound::Used).and_then(|replay| {
                    recomputed_mu(replay, surface, traction, allowed, slip, row)
                }),
                state: traction.state.as_ref().map(|state| state[row]),
            };
            accumulator.add(row, traction.time, surface.area[row], weight, &judge.judge(&node));
        }
        accumulator.end_record(traction.time, weight);
    }
}

/// Whether the mesh moved along the material between two records one step apart: a node then jumps by columns of elements.
fn mesh_moved(areas: &[f64], before: &Frame, after: &Frame) -> bool {
    let (Some([u, _]), Some([v, _])) = (&before.motion, &after.motion) else { return false };
    let smallest = areas.iter().fold(f64::INFINITY, |smallest: f64, area| smallest.min(*area));
    u.iter().zip(v).any(|(u, v)| (v[0] - u[0]).abs() > smallest.sqrt())
}

/// The law's coefficient: of a law that remembers no more than one step, at the slip velocity of the same instant;
/// else that of its recomputed state. Where the state is not known to round-off, the coefficient used by the
/// algorithm.
fn recomputed_mu(
    replay: &Replay,
    surface: &Surface,
    frame: &Frame,
    allowed: &[Option<Allowed>],
    slip: Vector3<f64>,
    row: usize,
) -> Option<f64> {
    let position = frame.position(surface, row).into();
    let at = NodeConditions { position, time: frame.time, pressure: frame.pressure[row] };
    replay.at_once(slip.norm(), &at).or_else(|| {
        let (used, allowed) = (frame.mu.as_ref()?[row], allowed[row]?);
        Some(if allowed.known { allowed.nearest(used) } else { used })
    })
}

/// The pair's slip velocity in `records[first..]` at nodes in contact in the record or the one before it, since
/// both pairings need it. `lost` counts nodes in contact without a projection.
fn pair_slips(
    pair: &mut Pair,
    surface: &Surface,
    records: &[Record],
    first: usize,
    lost: &mut usize,
) -> Vec<Vec<Option<Vector3<f64>>>> {
    let of_record = |k: usize| {
        let contact = &records[k].contact;
        let mut slips = vec![None; contact.len()];
        let Some(motion) = &records[k].frame.motion else {
            return slips;
        };
        let before = k.checked_sub(1).map(|k| &records[k].contact);
        let wanted = |&row: &usize| {
            surface.body[row] == pair.slave
                && (contact[row] || before.is_some_and(|before| before[row]))
        };
        let rows: Vec<usize> = (0..contact.len()).filter(wanted).collect();
        for (&row, slip) in rows.iter().zip(pair.slip(surface, motion, &rows)) {
            *lost += usize::from(slip.is_none() && contact[row]);
            slips[row] = slip;
        }
        slips
    };
    (first..records.len()).map(of_record).collect()
}

/// The faces of the body at whose nodes the conditions are enforced; of both where that is stated of none.
pub(crate) fn judged_faces(history: &ContactHistory) -> Vec<[u32; 4]> {
    let surface = &history.surface;
    let judged = |body: u8| history.enforced_on.is_none_or(|on| on == body);
    let faces = surface.faces.iter().zip(&surface.face_body);
    faces.filter(|(_, body)| judged(**body)).map(|(face, _)| *face).collect()
}

/// The body with the smaller mean nodal area, the first of equals: the slave of the pair.
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

/// Adds a record to the measures of one body.
fn take_side(
    side: &mut SideAccumulator,
    body: u8,
    surface: &Surface,
    Record { frame, contact, weight, allowed, .. }: &Record,
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
            side.add_cone(row, time, area, excess(frame.shear[row].norm(), mu * pressure));
        }
        if let (Some(used), Some(law)) = (used, allowed.get(row)) {
            side.mu.add(row, time, area, used, *law);
        }
        match frame.state.as_ref().map(|state| state[row]) {
            Some(state @ (1 | 2)) => side.states.add(row, time, state == 2),
            _ => side.states.open(row),
        }
    }
    side.end_record(*weight);
}

/// Relative excess of the shear over the cone, shear/cone - 1; 0 where there is no shear, infinite where shear
/// meets a cone of zero.
fn excess(shear: f64, cone: f64) -> f64 {
    if shear == 0.0 { 0.0 } else { shear / cone - 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_by_a_column_of_elements_is_a_move_of_the_mesh_and_a_step_of_rolling_is_none() {
        let at = |x: f64| Frame {
            motion: Some([vec![x * Vector3::x(); 4], vec![Vector3::zeros(); 4]]),
            ..Frame::default()
        };
        // nodes bear from a quarter of an element of 1 mm to all of it
        let areas = [0.25e-6, 0.5e-6, 0.5e-6, 1e-6];
        assert!(!mesh_moved(&areas, &at(0.0), &at(8e-6)));
        assert!(mesh_moved(&areas, &at(0.0), &at(1e-3)));
        assert!(!mesh_moved(&areas, &at(0.0), &Frame::default()));
    }
}
