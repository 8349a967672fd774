//! Slip and shear along the centre line, over places that move with the disk and instants.

use crate::PostError;
use crate::basis::Basis;
use crate::conditions::IN_CONTACT;
use crate::frames::{ContactHistory, Frame};
use crate::surface::body_name;
use crate::vector::norm;
use contact::mesh_mode::MeshMode;
use serde_json::{Value, json};

/// Places from -a to a, with a Hertz's half axis.
pub(super) const PLACES: usize = 141;
/// Instants from one end of the window to the other.
pub(super) const INSTANTS: usize = 97;

/// A quantity at every instant and place.
pub(super) struct Field {
    /// The places of an instant after those of the one before.
    values: Vec<f64>,
}

/// The centre line of a run.
pub(super) struct Line {
    /// Slip speed (m/s).
    pub slip: Field,
    /// Size of the shear traction (Pa).
    pub shear: Field,
    /// Of the slip over all faces in contact, in every record of the window.
    pub mesh_mode: MeshMode,
    /// Rolling speed (m/s).
    pub speed: f64,
    /// The body whose nodes are taken.
    pub side: &'static str,
    /// Half of what is looked at (m).
    pub reach: f64,
}

impl Line {
    /// Reads a run over `window`, on the body at whose nodes the conditions are enforced, else the disk.
    pub fn read(
        history: &ContactHistory,
        basis: &mut Basis,
        [from, to]: [f64; 2],
    ) -> Result<Self, PostError> {
        basis.complete();
        let needed = |name, remedy| PostError::Unknown { name, remedy };
        let speed = basis
            .scale("speed")
            .ok_or(needed("the rolling speed", "it is drive.speed of the run's case.toml"))?;
        let (reach, p0) = basis
            .scale("half_length")
            .zip(basis.scale("peak_pressure"))
            .ok_or(needed("Hertz's half axis", "the run's summary or case.toml gives it"))?;
        let surface = &history.surface;
        let body = history.enforced_on.unwrap_or(0);
        let area = surface.area.iter().sum::<f64>() / surface.area.len().max(1) as f64;
        let nodes = surface.centreline(body, basis.scale("size").unwrap_or(area.sqrt()));
        let faces: Vec<[u32; 4]> = surface
            .faces
            .iter()
            .zip(&surface.face_body)
            .filter(|(_, of)| **of == body)
            .map(|(face, _)| *face)
            .collect();
        let records = history.window([from, to])?;
        // one more at each end, where there is one: instants lie between records
        let around = records.start.saturating_sub(1)..(records.end + 1).min(history.times.len());
        let mut mesh_mode = MeshMode::default();
        let (mut times, mut slip, mut shear) = (Vec::new(), Vec::new(), Vec::new());
        history.stream(around, |frame| {
            if records.contains(&frame.index) {
                let in_contact = |node: usize| frame.pressure[node] > IN_CONTACT * p0;
                mesh_mode.add(1.0, &faces, &frame.slip_velocity, in_contact);
            }
            let places = places_of(history, &frame, &nodes, speed);
            times.push(frame.time);
            slip.push(sampled(&places, reach, |node| norm(frame.slip_velocity[node])));
            shear.push(sampled(&places, reach, |node| norm(frame.shear[node])));
            Ok(())
        })?;
        let instants: Vec<f64> =
            (0..INSTANTS).map(|i| from + (to - from) * i as f64 / (INSTANTS - 1) as f64).collect();
        let (slip, shear) =
            (Field::at(&times, &slip, &instants), Field::at(&times, &shear, &instants));
        Ok(Self { slip, shear, mesh_mode, speed: speed.abs(), side: body_name(body), reach })
    }
}

/// Where nodes are along x from the disk's axis (m), ascending, with the nodes.
fn places_of(
    history: &ContactHistory,
    frame: &Frame,
    nodes: &[usize],
    speed: f64,
) -> Vec<(f64, usize)> {
    let moved = |node: usize| frame.motion.as_ref().map_or(0.0, |[u, _]| u[node][0]);
    let place =
        |&node: &usize| (history.surface.points[node][0] + moved(node) - speed * frame.time, node);
    let mut places: Vec<(f64, usize)> = nodes.iter().map(place).collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places
}

/// A quantity of nodes at the places of the grid, linear between nodes.
fn sampled(places: &[(f64, usize)], reach: f64, of: impl Fn(usize) -> f64) -> Vec<f64> {
    let grid = (0..PLACES).map(|i| reach * (2.0 * i as f64 / (PLACES - 1) as f64 - 1.0));
    let at: Vec<f64> = places.iter().map(|(x, _)| *x).collect();
    grid.map(|x| between(&at, x, |i| of(places[i].1))).collect()
}

/// Linear interpolation in ascending `at`, constant beyond its ends.
fn between(at: &[f64], x: f64, value: impl Fn(usize) -> f64) -> f64 {
    let next = at.partition_point(|at| *at <= x);
    if next == 0 {
        return value(0);
    }
    if next == at.len() {
        return value(next - 1);
    }
    let part = (x - at[next - 1]) / (at[next] - at[next - 1]);
    value(next - 1) + part * (value(next) - value(next - 1))
}

impl Field {
    fn at(times: &[f64], rows: &[Vec<f64>], instants: &[f64]) -> Self {
        let value = |instant: f64, place: usize| between(times, instant, |k| rows[k][place]);
        let values =
            instants.iter().flat_map(|&t| (0..PLACES).map(move |place| value(t, place))).collect();
        Self { values }
    }

    /// The largest value.
    pub fn largest(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }

    /// Mean over place and time.
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }

    /// Mean and standard deviation in time at every place.
    pub fn profile(&self) -> Vec<[f64; 2]> {
        let of = |place: usize| {
            let values = || self.values[place..].iter().step_by(PLACES);
            let mean = values().sum::<f64>() / INSTANTS as f64;
            let squares = values().map(|value| (value - mean).powi(2)).sum::<f64>();
            [mean, (squares / INSTANTS as f64).sqrt()]
        };
        (0..PLACES).map(of).collect()
    }

    /// Mean over place of the standard deviation in time.
    pub fn mean_deviation(&self) -> f64 {
        self.profile().iter().map(|[_, deviation]| deviation).sum::<f64>() / PLACES as f64
    }

    /// Root mean square of what fluctuates in time over that of all.
    pub fn fluctuating_share(&self) -> Option<f64> {
        let fluctuating = rms(self.profile().into_iter().map(|[_, deviation]| deviation));
        over(fluctuating, rms(self.values.iter().copied()))
    }

    /// Root mean squares of what differs over those of the other: over place and time, of the means in time,
    /// and of the standard deviations in time.
    pub fn difference(&self, other: &Self) -> Value {
        let of = |a: &[f64], b: &[f64]| {
            over(rms(a.iter().zip(b).map(|(a, b)| a - b)), rms(b.iter().copied()))
        };
        let [a, b] = [self, other].map(Self::profile);
        let part =
            |profile: &[[f64; 2]], i: usize| profile.iter().map(|p| p[i]).collect::<Vec<_>>();
        json!({
            "place_and_time": of(&self.values, &other.values),
            "means": of(&part(&a, 0), &part(&b, 0)),
            "deviations": of(&part(&a, 1), &part(&b, 1)),
        })
    }
}

fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    (values.map(|value| value * value).sum::<f64>() / count).sqrt()
}

fn over(part: f64, all: f64) -> Option<f64> {
    (all > 0.0).then(|| part / all)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A field by its value at place 0 to 1 and time 0 to 1.
    fn field(of: impl Fn(f64, f64) -> f64) -> Field {
        let instants: Vec<f64> = (0..INSTANTS).map(|i| i as f64 / (INSTANTS - 1) as f64).collect();
        let place = |i: usize| i as f64 / (PLACES - 1) as f64;
        let rows: Vec<Vec<f64>> =
            instants.iter().map(|&t| (0..PLACES).map(|i| of(place(i), t)).collect()).collect();
        Field::at(&instants, &rows, &instants)
    }

    #[test]
    fn of_a_steady_field_nothing_fluctuates_and_of_a_vibration_without_mean_everything() {
        let steady = field(|x, _| 2.0 + x);
        assert!(steady.fluctuating_share().unwrap() < 1e-12);
        assert!((steady.mean() - 2.5).abs() < 1e-12);
        let sign = |t: f64| {
            if ((t * (INSTANTS - 1) as f64).round() as u64).is_multiple_of(2) { 1.0 } else { -1.0 }
        };
        let vibration = field(|x, t| (1.0 + x) * sign(t));
        assert!((vibration.fluctuating_share().unwrap() - 1.0).abs() < 1e-3);
    }

    #[test]
    fn fields_that_vibrate_alike_but_out_of_phase_differ_in_place_and_time_and_not_in_their_statistics()
     {
        let wave = |phase: f64| {
            move |x: f64, t: f64| {
                1.0 + 0.5 * (2.0 * std::f64::consts::PI * (4.0 * t + x) + phase).sin()
            }
        };
        let difference = field(wave(0.0)).difference(&field(wave(std::f64::consts::PI)));
        let at = |key: &str| difference[key].as_f64().unwrap();
        // the difference is a wave of amplitude 1 over one of mean square 1 + 1/8
        assert!((at("place_and_time") - (0.5_f64 / 1.125).sqrt()).abs() < 0.01, "{difference}");
        assert!(at("means") < 0.02 && at("deviations") < 0.02, "{difference}");
    }

    #[test]
    fn values_between_nodes_are_linear_and_beyond_them_constant() {
        let at = [0.0, 1.0, 3.0];
        let value = |i: usize| [5.0, 7.0, 3.0][i];
        for (x, wanted) in [(-1.0, 5.0), (0.5, 6.0), (2.0, 5.0), (9.0, 3.0)] {
            assert_eq!(between(&at, x, value), wanted);
        }
    }
}
