//! The data that figures of a run are drawn from.

use crate::chart::colour;
use crate::check::basis::Basis;
use crate::check::frames::{ContactHistory, Frame};
use crate::check::patch_series;
use crate::check::{PostError, Scales};
use nalgebra::Vector3;
use std::ops::Range;

/// Interval of the snapshots in the papers (s).
const SNAPSHOTS: f64 = 5.7e-6;

/// Colours of the instants, of which no more can be drawn.
pub(crate) const INSTANTS: [[u8; 3]; 4] =
    [colour::BLUE, colour::VERMILION, colour::GREEN, colour::PURPLE];

/// A record that is drawn, with the centre of its patch.
pub(crate) struct Instant {
    pub frame: Frame,
    /// x of the patch's centre (m).
    pub centre: f64,
}

/// Means over the window that figures state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FigureMeans {
    pub normal_force: Option<f64>,
    pub creepage: Option<f64>,
    pub traction_coefficient: Option<f64>,
}

/// The data that figures of a run are drawn from.
pub(crate) struct Scene<'a> {
    pub history: &'a ContactHistory,
    pub basis: &'a Basis,
    pub scales: Scales,
    /// The body whose nodes are drawn: the bar where there are two.
    pub body: u8,
    /// Indices of the records of the window.
    pub records: Range<usize>,
    /// The window, from and to (s).
    pub window: [f64; 2],
    /// Means over the window, as far as the run has them.
    pub means: FigureMeans,
    pub instants: Vec<Instant>,
    /// Of each node the halves of the faces around it: in x and in y the ends of these, from the node (m).
    pub halves: Vec<[[f64; 2]; 2]>,
    /// Half the range of x of lines along y = 0 (m).
    pub line_reach: f64,
}

impl Scene<'_> {
    /// Indices of the records nearest to the times `at` (s); without any, of the last record of the window and of up to two
    /// before it.
    ///
    /// # Errors
    /// More times than there are colours, and times without a record.
    pub fn instant_indices(&self, at: &[f64]) -> Result<Vec<usize>, PostError> {
        if at.is_empty() {
            return Ok(self.last_indices());
        }
        let most = INSTANTS.len();
        if at.len() > most {
            return Err(PostError::Asked(format!("--at: at most {most} instants are drawn")));
        }
        let mut indices: Vec<usize> =
            at.iter().map(|time| self.index_at(*time)).collect::<Result<_, _>>()?;
        indices.sort_unstable();
        indices.dedup();
        Ok(indices)
    }

    /// The index of the record nearest to a time (s).
    fn index_at(&self, time: f64) -> Result<usize, PostError> {
        let times = &self.history.times;
        let (first, last) = (times[0], times[times.len() - 1]);
        let away = |i: &usize| (times[*i] - time).abs();
        let nearest = (0..times.len()).min_by(|a, b| away(a).total_cmp(&away(b)));
        nearest.filter(|_| (first..=last).contains(&time)).ok_or_else(|| {
            PostError::Asked(format!("--at {time}: the records are from {first} to {last} s"))
        })
    }

    fn last_indices(&self) -> Vec<usize> {
        let times = &self.history.times;
        let last = self.records.end - 1;
        let mut chosen = vec![last];
        for back in 1..3 {
            let wanted = times[last] - SNAPSHOTS * f64::from(back);
            let before = self.records.start..chosen[0];
            let away = |i: &usize| (times[*i] - wanted).abs();
            if let Some(index) = before.min_by(|a, b| away(a).total_cmp(&away(b))) {
                chosen.insert(0, index);
            }
        }
        chosen
    }

    /// x of the patch's centre (m); 0 where no fit exists.
    pub fn centre(&self, frame: &Frame) -> f64 {
        let p0 = self.scales.peak_pressure;
        let row =
            patch_series::measure(&self.history.surface, frame, self.body, p0, self.basis.shape);
        if row.values[2].is_finite() { row.values[2] } else { 0.0 }
    }

    /// Position of a node (m), deformed where the record has displacements.
    pub fn position(&self, frame: &Frame, row: usize) -> Vector3<f64> {
        frame.position(&self.history.surface, row)
    }

    /// Indices of a body's nodes nearest y = 0, sorted by their reference x.
    pub fn centreline(&self, body: u8) -> Vec<usize> {
        self.history.surface.centreline(body, self.scales.size)
    }

    /// The part of the surface that a node stands for at an instant, x from the patch's centre: its lower and its upper
    /// corner (mm).
    pub fn cell(&self, instant: &Instant, row: usize) -> [[f64; 2]; 2] {
        let at = self.position(&instant.frame, row);
        let from = [instant.centre, 0.0];
        [0, 1].map(|end| [0, 1].map(|i| 1e3 * (at[i] - from[i] + self.halves[row][i][end])))
    }

    /// [`line_reach`](Self::line_reach): that of maps and, on coarse meshes, the nodes beside those in contact, at which the
    /// pressure ends.
    pub fn reach_of_lines(&self) -> f64 {
        let mut reach = self.reach();
        let rows: Vec<usize> =
            self.history.surface.bodies().iter().flat_map(|body| self.centreline(*body)).collect();
        for Instant { frame, centre } in &self.instants {
            for &row in rows.iter().filter(|row| self.in_contact(frame, **row)) {
                let x = self.position(frame, row)[0] - centre;
                let [low, high] = self.halves[row][0].map(|half| 1.05 * (x + 2.0 * half).abs());
                reach = reach.max(low).max(high);
            }
        }
        reach
    }

    /// Half the range of x that is drawn (m).
    pub fn reach(&self) -> f64 {
        1.35 * self.basis.scale("half_length").unwrap_or(10.0 * self.scales.size)
    }

    /// Half of what a map of the patch shows in x and in y (mm): the half-space's patch with a margin, and on coarse meshes
    /// the cells of all nodes in contact (mm).
    pub fn map_ends(&self, cells: impl Iterator<Item = [[f64; 2]; 2]>) -> [f64; 2] {
        let half_width = self.basis.scale("half_width").unwrap_or(10.0 * self.scales.size);
        let patch = [1e3 * self.reach(), 1.35e3 * half_width];
        cells.flatten().fold(patch, |ends, corner| {
            [0, 1].map(|axis| f64::max(ends[axis], 1.05 * corner[axis].abs()))
        })
    }

    /// A measure of the patch by Hertz (SI), where it is known apart from the records.
    pub fn hertz(&self, name: &str) -> Option<f64> {
        self.basis.hertz(name)
    }

    pub fn in_contact(&self, frame: &Frame, row: usize) -> bool {
        frame.pressure[row] > crate::check::conditions::IN_CONTACT * self.scales.peak_pressure
    }

    /// Coefficient of friction at rest; 0.5 where the law is not known.
    pub fn mu_static(&self) -> f64 {
        self.basis.law.map_or(0.5, |law| law.mu_static())
    }
}

/// A time in the legend.
pub(crate) fn time_label(instant: &Instant) -> String {
    format!("t = {:.4} ms", 1e3 * instant.frame.time)
}
