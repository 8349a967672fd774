//! The record of contact and the history of a run, whatever finds them.

use super::basis::RecordBasis;
use super::images::Images;
use super::patch::Patch;
use super::row::{PatchMeasures, Resultants, Whereabouts, row};
use super::surfaces::Surfaces;
use crate::case::schema::{Case, Window};
use crate::run::error::RunError;
use crate::run::means::Means;
use contact::NodalContact;
use dynamics::StepReport;
use nalgebra::Vector3;
use output::layout::{ContactFields, HISTORY, Pairing, file};
use output::{
    BackgroundWriter, Checkpoint, FieldSpec, Kept, OutputError, Results, RunFiles, Snapshot,
    TransientGrid, Values,
};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rows of the history gathered before they are handed to the writer.
const HISTORY_BATCH: usize = 64;
/// Rows of a run whose steps take long are handed over at the first row after this time: whoever reads the files
/// meanwhile sees how far it is.
pub(crate) const LONGEST_HELD: Duration = Duration::from_secs(1);

/// What a run rolls with.
pub(crate) struct RollingStep {
    /// Time step (s).
    pub(crate) dt: f64,
    /// Rolling radius (m) by which creepage is counted.
    pub(crate) effective_radius: f64,
}

/// Writes contact surfaces and history, and gathers the means over the evaluation window. It knows nothing of the
/// bodies below the surfaces.
pub(crate) struct ContactRecord {
    writer: BackgroundWriter,
    /// Contact at the nodes of disk and bar, for the recorder to fill before a record or a row is written.
    pub(crate) tables: [NodalContact; 2],
    images: Images,
    patch: Patch,
    pairing: Pairing,
    contact_every: u64,
    /// First and last step of each output window, and its interval (steps).
    windows: Vec<(u64, u64, u64)>,
    history_every: u64,
    /// Rows of the history that are not yet handed to the writer.
    rows: Vec<f64>,
    /// When rows were last handed over.
    flushed: Instant,
    effective_radius: f64,
    speed: f64,
    /// Whether y >= 0 alone is modelled.
    half: bool,
    /// The evaluation window (s).
    evaluate: [f64; 2],
    pub(crate) means: Means,
}

/// What a step adds to the record.
pub(crate) struct StepRecord {
    resultants: Resultants,
    /// Whether it lies inside the evaluation window.
    pub(crate) inside: bool,
}

impl ContactRecord {
    /// Begins the files of `surfaces`, or goes on with them; `fields` is that of a run which records its bodies.
    pub(crate) fn files(
        case: &Case,
        surfaces: &Surfaces<'_>,
        basis: &RecordBasis,
        fields: Option<TransientGrid>,
    ) -> Result<RunFiles, RunError> {
        let images = Images::new(surfaces.half, &surfaces.points);
        let columns = HISTORY.each().map(FieldSpec::clone);
        Ok(RunFiles {
            fields,
            contact: surfaces.create(case, &images, basis)?,
            history: basis.history(file::HISTORY, &columns, |results| &results.history)?,
        })
    }

    /// Writes into `files`, which are those of `surfaces`.
    pub(crate) fn new(
        case: &Case,
        surfaces: Surfaces<'_>,
        step: &RollingStep,
        hertz_pressure: f64,
        files: RunFiles,
    ) -> Result<Self, RunError> {
        let images = Images::new(surfaces.half, &surfaces.points);
        let RollingStep { dt, effective_radius } = *step;
        let steps_in = |interval: f64| (interval / dt).round().max(1.0) as u64;
        let window = |w: &Window| {
            let step = |t: f64| (t / dt).round() as u64;
            (step(w.from), step(w.to), w.every)
        };
        Ok(Self {
            writer: BackgroundWriter::start(files)?,
            patch: Patch::new(case, &surfaces, &images, hertz_pressure),
            images,
            pairing: surfaces.pairing(),
            contact_every: steps_in(case.output.contact_interval),
            windows: case.output.window.iter().map(window).collect(),
            history_every: case.output.history_interval,
            rows: Vec::with_capacity(HISTORY_BATCH * HISTORY.each().len()),
            flushed: Instant::now(),
            effective_radius,
            speed: case.drive.speed,
            half: surfaces.half,
            evaluate: case.evaluation_window(),
            means: Means::default(),
            tables: surfaces.tables,
        })
    }

    /// Whether step `n` writes a row of the history, and so needs the energies.
    pub(crate) fn reads(&self, n: u64) -> bool {
        n.is_multiple_of(self.history_every)
    }

    /// Whether step `n` writes a record of contact.
    pub(crate) fn records(&self, n: u64) -> bool {
        n.is_multiple_of(self.contact_every)
            || self.windows.iter().any(|&(from, to, every)| {
                (from..=to).contains(&n) && (n - from).is_multiple_of(every)
            })
    }

    /// Whether records at t^n hold the velocities of the step before (t^{n-1/2}) or after (t^{n+1/2}).
    pub(crate) fn pairing(&self) -> Pairing {
        self.pairing
    }

    /// Nodes of both tables: those of the disk, then those of the bar.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = u32> {
        self.tables.iter().flat_map(|table| &table.nodes).copied()
    }

    /// Writes a record at `time` (s) from the tables, and displacement (m) and velocity (m/s) of their
    /// [`nodes`](Self::nodes).
    pub(crate) fn write(
        &mut self,
        time: f64,
        displacement: &[Vector3<f64>],
        velocity: &[Vector3<f64>],
    ) -> Result<(), RunError> {
        let Self { tables: [disk, bar], pairing, images, .. } = &*self;
        let sides = |values: &[Vector3<f64>]| {
            let (disk, bar) = values.split_at(disk.nodes.len());
            images.vectors([disk, bar])
        };
        let pressure = images.scalars([&disk.pressure, &bar.pressure]);
        let shear = images.vectors([&disk.shear, &bar.shear]);
        let slip_velocity = images.vectors([&disk.slip_velocity, &bar.slip_velocity]);
        let slip = images.vectors([&disk.slip, &bar.slip]);
        let mu = images.scalars([&disk.mu, &bar.mu]);
        let state = images.scalars([&disk.state[..], &bar.state]);
        let gap = images.scalars([&disk.gap, &bar.gap]);
        let pass_pressure = images.scalars([&disk.pass_pressure, &bar.pass_pressure]);
        let (velocity, displacement) = (sides(velocity), sides(displacement));
        let values = ContactFields {
            pressure: Some(Values::Scalar(&pressure)),
            shear: Some(Values::Vector(&shear)),
            slip_velocity: Some(Values::Vector(&slip_velocity)),
            slip: Some(Values::Vector(&slip)),
            mu: Some(Values::Scalar(&mu)),
            state: Some(Values::Integer(&state)),
            gap: Some(Values::Scalar(&gap)),
            velocity: Some(Values::Vector(&velocity)),
            displacement: Some(Values::Vector(&displacement)),
            pass_pressure: Some(Values::Scalar(&pass_pressure))
                .filter(|_| *pairing == Pairing::Before),
        };
        let values: Vec<_> = values.each().into_iter().copied().flatten().collect();
        Ok(self.writer.append_contact(time, &values)?)
    }

    /// Adds a step to the means.
    pub(crate) fn add_step(&mut self, report: &StepReport) -> StepRecord {
        let resultants = Resultants::of(report, self.effective_radius, self.speed, self.half);
        let [from, to] = self.evaluate;
        let inside = (from..=to).contains(&report.time);
        let passed = inside.then(|| (report.time - from) / (to - from));
        self.means.add_step(report, &resultants, passed);
        StepRecord { resultants, inside }
    }

    /// The patch on the bar by the present tables, with the hub at `hub_x` (m).
    pub(crate) fn patch(&mut self, hub_x: f64) -> PatchMeasures {
        self.patch.measure(&self.tables, &self.images, hub_x)
    }

    /// Adds the row of a step to the history.
    pub(crate) fn add_row(
        &mut self,
        report: &StepReport,
        step: &StepRecord,
        patch: &PatchMeasures,
        at: &Whereabouts,
    ) -> Result<(), RunError> {
        let energies = report.energies.unwrap_or_default();
        self.means.add_row(report.time, patch, &energies, step.inside);
        self.rows.extend(row(report, &step.resultants, patch, at).each());
        if self.rows.len() >= HISTORY_BATCH * HISTORY.each().len()
            || self.flushed.elapsed() >= LONGEST_HELD
        {
            self.flush()?;
        }
        Ok(())
    }

    /// Hands the rows of the history that are left to the writer.
    pub(crate) fn flush(&mut self) -> Result<(), RunError> {
        if !self.rows.is_empty() {
            self.writer.append_history(&self.rows)?;
            self.rows.clear();
        }
        self.flushed = Instant::now();
        Ok(())
    }

    /// Sends a snapshot of the bodies at `time` (s), which `fill` writes, for `fields.vtkhdf`.
    pub(crate) fn write_fields(
        &mut self,
        time: f64,
        fill: impl FnOnce(&mut Snapshot<'_>),
    ) -> Result<(), RunError> {
        Ok(self.writer.append_fields_with(time, fill)?)
    }

    /// Has the writer write the checkpoint that `make` returns, after everything sent before; `beside` is a result file
    /// that another writer owns.
    pub(crate) fn keep(
        &mut self,
        make: impl FnOnce(Results) -> Result<Checkpoint, OutputError> + Send + 'static,
        folder: &Path,
        beside: Option<(PathBuf, Kept)>,
    ) -> Result<(), RunError> {
        Ok(self.writer.keep(make, folder, beside)?)
    }

    /// Hands over what is left, closes the files and returns the means.
    pub(crate) fn finish(mut self) -> Result<Means, RunError> {
        self.flush()?;
        self.writer.finish()?;
        Ok(self.means)
    }
}
