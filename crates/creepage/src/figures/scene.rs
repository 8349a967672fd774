//! The data that figures of a run are drawn from.

use crate::chart::colour;
use crate::check::Scales;
use crate::check::basis::Basis;
use crate::check::frames::{ContactHistory, Frame};
use crate::check::patch_series;
use nalgebra::Vector3;
use std::ops::Range;

/// Interval of the snapshots in the papers (s).
const SNAPSHOTS: f64 = 5.7e-6;

/// Colours of the three instants.
pub(crate) const INSTANTS: [[u8; 3]; 3] = [colour::BLUE, colour::VERMILION, colour::GREEN];

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
}

impl Scene<'_> {
    /// Indices of the last record of the window and of up to two before it.
    pub fn instant_indices(&self) -> Vec<usize> {
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

    /// Half the range of x that is drawn (m).
    pub fn reach(&self) -> f64 {
        1.35 * self.basis.scale("half_length").unwrap_or(10.0 * self.scales.size)
    }

    /// Half of what a map of the patch shows in x and in y (mm): the half-space's patch with a margin, and on coarse meshes
    /// the squares of all nodes in contact, which reach so far from its centre (mm).
    pub fn map_ends(&self, reached: [f64; 2]) -> [f64; 2] {
        let half_width = self.basis.scale("half_width").unwrap_or(10.0 * self.scales.size);
        let patch = [1e3 * self.reach(), 1.35e3 * half_width];
        [0, 1].map(|axis| patch[axis].max(1.05 * reached[axis]))
    }

    /// A measure of the patch by Hertz (SI), where it is known apart from the records.
    pub fn hertz(&self, name: &str) -> Option<f64> {
        let scale = self.basis.scales.get(name).filter(|s| !s.from.contains("last record"));
        scale.map(|scale| scale.value)
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
