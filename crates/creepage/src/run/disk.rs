//! Room on the disk: what the files of a run take, and what there is.

use std::path::Path;

use crate::case::schema::Case;
use crate::scenario::Model;
use serde::Serialize;

/// Part of the numbers of fields and of contact that compression leaves, measured on the small case and on the
/// reference case and rounded up.
const FIELDS: f64 = 0.95;
const CONTACT: f64 = 0.6;
/// Numbers per row of the history, per step and probe, and per node of a checkpoint.
const HISTORY: f64 = 38.0;
const PROBE: f64 = 20.0;
const CHECKPOINT: f64 = 7.0;
/// Numbers per contact node and record, and the byte of its state.
const CONTACT_NODE: f64 = 8.0 * 18.0 + 1.0;

/// What the files of a run take in the end (bytes).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disk {
    fields: f64,
    contact: f64,
    history: f64,
    checkpoints: f64,
}

impl Disk {
    /// The estimate for a run of so many steps.
    pub(crate) fn of(case: &Case, model: &Model, steps: f64) -> Self {
        let (nodes, elements) = (model.mesh.nodes.len() as f64, model.mesh.hexes.len() as f64);
        let dt = case.duration() / steps;
        let every = |interval: f64| (interval / dt).round().max(1.0);
        let stress: usize = case.output.stress.written().map(|s| s.dataset().components).sum();
        let snapshots = (case.duration() / case.fields_interval()).ceil().min(steps) + 1.0;
        // corners of a face are shared by four, but for the borders
        // and those of half a model have mirror images
        let zone =
            model.multiplicity * model.zones.iter().map(|faces| faces.len() as f64).sum::<f64>();
        let in_windows = |w: &crate::case::schema::Window| {
            (w.to.min(case.duration()) - w.from).max(0.0) / dt / w.every as f64
        };
        let windows: f64 = case.output.window.iter().map(in_windows).sum();
        let records = steps / every(case.output.contact_interval) + windows;
        let rows = steps / case.output.history_interval as f64;
        let probes = (case.output.probes.bar.len() + case.output.probes.disk.len()) as f64;
        let mesh = 24.0 * nodes + 74.0 * elements;
        let kept = case.checkpoint.wall_minutes > 0.0
            || case.checkpoint.steps.is_some()
            || case.checkpoint.time.is_some();
        Self {
            fields: mesh + FIELDS * snapshots * 8.0 * (9.0 * nodes + stress as f64 * elements),
            contact: CONTACT * records * CONTACT_NODE * zone,
            history: 8.0 * (HISTORY * rows + PROBE * probes * steps),
            checkpoints: if kept { 2.0 * 8.0 * CHECKPOINT * nodes } else { 0.0 },
        }
    }

    pub(crate) fn total(&self) -> f64 {
        self.fields + self.contact + self.history + self.checkpoints
    }

    /// The warning where `folder` has less room than the run takes.
    pub(crate) fn shortage(&self, folder: &Path) -> Option<String> {
        let free = output::free_space(folder)? as f64;
        self.shortage_of(free)
    }

    fn shortage_of(&self, free: f64) -> Option<String> {
        (self.total() > free).then(|| {
            format!(
                "the run writes about {:.1} MB, more than the {:.1} MB that the disk has free: it will \
                 stop when that is full; make output.fields_interval or output.contact_interval \
                 longer, leave output.stress out, or choose another disk with --out DIR",
                self.total() / 1e6,
                free / 1e6
            )
        })
    }

    /// In megabytes, with what is free for `folder`.
    pub(crate) fn estimate(&self, folder: &Path) -> DiskEstimate {
        let mb = |bytes: f64| bytes / 1e6;
        DiskEstimate {
            total_mb: mb(self.total()),
            fields_mb: mb(self.fields),
            contact_mb: mb(self.contact),
            history_mb: mb(self.history),
            checkpoints_mb: mb(self.checkpoints),
            free_mb: output::free_space(folder).map(|free| mb(free as f64)),
        }
    }
}

/// Room on the disk that a run takes (MB).
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct DiskEstimate {
    /// All files.
    pub total_mb: f64,
    /// Fields of the bodies.
    pub fields_mb: f64,
    /// Contact surfaces.
    pub contact_mb: f64,
    /// Scalars over time, and probes.
    pub history_mb: f64,
    /// Checkpoints.
    pub checkpoints_mb: f64,
    /// What is free; none where the system does not tell.
    pub free_mb: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disk_with_less_room_than_the_run_takes_is_told() {
        let disk = Disk { fields: 60e6, contact: 2e6, history: 1e6, checkpoints: 1e6 };
        assert_eq!(disk.shortage_of(64e6), None);
        let said = disk.shortage_of(63e6).unwrap_or_default();
        for words in ["64.0 MB", "63.0 MB", "output.fields_interval"] {
            assert!(said.contains(words), "{said}");
        }
    }
}
