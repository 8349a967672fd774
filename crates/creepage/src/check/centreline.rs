//! Slip and shear along the centre line y = 0, at places that move with the disk, over the records in time.

use crate::check::PostError;
use crate::check::basis::Basis;
use crate::check::frames::{ContactHistory, Frame};
use crate::check::surface::Surface;

/// Number of equally spaced places from x = -a to a, relative to the disk's axis; a is Hertz's half axis.
pub(crate) const PLACES: usize = 141;

/// A quantity at the [`PLACES`] of the centre line, a row for each record.
pub(crate) type Rows = Vec<Vec<f64>>;

/// Slip and shear of the records along the centre line of the body at whose nodes the conditions are enforced;
/// where the file names none, of the disk.
pub(crate) struct CentreLine {
    /// Time of each record (s).
    pub times: Vec<f64>,
    /// Slip speed (m/s).
    pub slip: Rows,
    /// Size of the shear traction (Pa).
    pub shear: Rows,
    /// Rolling speed (m/s).
    pub speed: f64,
    /// The body whose nodes are taken.
    pub body: u8,
    /// Hertz's half axis a, half the length of the line (m).
    pub reach: f64,
    /// Edge h of a surface element (m).
    pub size: f64,
    nodes: Vec<usize>,
}

impl CentreLine {
    /// The centre line of a run, without records yet.
    ///
    /// # Errors
    /// A rolling speed or a half axis that is not known.
    pub fn new(history: &ContactHistory, basis: &mut Basis) -> Result<Self, PostError> {
        basis.complete();
        let needed = |name, remedy| PostError::Unknown { name, remedy };
        let speed = basis
            .scale("speed")
            .ok_or(needed("the rolling speed", "it is drive.speed of the run's case.toml"))?;
        let reach = basis
            .scale("half_length")
            .ok_or(needed("Hertz's half axis", "the run's summary or case.toml gives it"))?;
        let surface = &history.surface;
        let bodies = surface.bodies();
        let there = history.enforced_on.filter(|body| bodies.contains(body));
        let body = there.or(bodies.first().copied()).unwrap_or(0);
        let area = surface.area.iter().sum::<f64>() / surface.area.len().max(1) as f64;
        let size = basis.scale("size").unwrap_or(area.sqrt());
        let nodes = surface.centreline(body, size);
        if nodes.is_empty() {
            let what = "it has no node near the centre line".into();
            return Err(PostError::Lacks { path: history.path().into(), what });
        }
        let (times, slip, shear) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { times, slip, shear, speed, body, reach, size, nodes })
    }

    /// Adds a record. The disk's axis is taken to be at x = V t.
    pub fn take(&mut self, surface: &Surface, frame: &Frame) {
        let moved = |node: usize| frame.motion.as_ref().map_or(0.0, |[u, _]| u[node][0]);
        let axis = self.speed * frame.time;
        let place = |&node: &usize| (surface.points[node][0] + moved(node) - axis, node);
        let mut nodes: Vec<(f64, usize)> = self.nodes.iter().map(place).collect();
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let at: Vec<f64> = nodes.iter().map(|(x, _)| *x).collect();
        let row = |of: &dyn Fn(usize) -> f64| {
            let value = |place: usize| interpolate(&at, self.place(place), |i| of(nodes[i].1));
            (0..PLACES).map(value).collect()
        };
        let slip = row(&|node| frame.slip_velocity[node].norm());
        let shear = row(&|node| frame.shear[node].norm());
        self.times.push(frame.time);
        self.slip.push(slip);
        self.shear.push(shear);
    }

    /// Time in which a point passes through the patch, 2a/V (s).
    pub fn transit(&self) -> f64 {
        2.0 * self.reach / self.speed.abs()
    }

    /// A line with these records of slip, without shear.
    #[cfg(test)]
    pub fn planted(times: Vec<f64>, slip: Rows, reach: f64, speed: f64) -> Self {
        let (shear, nodes, size) = (Vec::new(), Vec::new(), 0.25 * reach);
        Self { times, slip, shear, speed, body: 0, reach, size, nodes }
    }

    /// x of the place `index`, relative to the disk's axis (m).
    pub fn place(&self, index: usize) -> f64 {
        self.reach * (2.0 * index as f64 / (PLACES - 1) as f64 - 1.0)
    }
}

/// Mean and standard deviation in time of a quantity at every place; `weights` are the times (s) that the
/// records stand for.
pub(crate) fn profile(rows: &Rows, weights: &[f64]) -> Vec<[f64; 2]> {
    let whole: f64 = weights.iter().sum();
    let mean_of = |of: &dyn Fn(f64) -> f64, place: usize| {
        rows.iter().zip(weights).map(|(row, weight)| weight * of(row[place])).sum::<f64>() / whole
    };
    let of = |place: usize| {
        let mean = mean_of(&|value| value, place);
        [mean, mean_of(&|value| (value - mean).powi(2), place).sqrt()]
    };
    (0..PLACES).map(of).collect()
}

/// `value` of the index, interpolated linearly to `x` in the ascending `at`; constant beyond its ends.
pub(crate) fn interpolate(at: &[f64], x: f64, value: impl Fn(usize) -> f64) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_between_nodes_are_linear_and_beyond_them_constant() {
        let at = [0.0, 1.0, 3.0];
        let value = |i: usize| [5.0, 7.0, 3.0][i];
        for (x, wanted) in [(-1.0, 5.0), (0.5, 6.0), (2.0, 5.0), (9.0, 3.0)] {
            assert_eq!(interpolate(&at, x, value), wanted);
        }
    }

    #[test]
    fn a_place_has_the_mean_and_deviation_over_the_time_that_its_records_stand_for() {
        // 4 at place 0 for a quarter of the time, else 8; the others are constant
        let row = |first: f64| (0..PLACES).map(|i| if i == 0 { first } else { 3.0 }).collect();
        let found = profile(&vec![row(4.0), row(8.0), row(8.0)], &[0.5, 1.0, 0.5]);
        assert_eq!(found[0], [7.0, f64::sqrt(3.0)]);
        assert!(found[1..].iter().all(|of| *of == [3.0, 0.0]));
    }
}
