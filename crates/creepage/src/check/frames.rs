//! The contact history, one record after the other. Two threads read a few records at a time, ahead of their
//! use; all records are never held at once.

use crate::check::PostError;
use crate::check::surface::Surface;
use nalgebra::Vector3;
use output::layout::{BODY_NAMES, CONTACT, FOLLOWS, MORTAR, Pairing, attribute};
use output::{FieldSpec, GridFile, HistoryFile, OutputError};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::JoinHandle;

/// One record: the fields at all nodes of both surfaces, in the order of the file and in the global frame.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Its index in the file.
    pub index: usize,
    /// Time (s).
    pub time: f64,
    /// Contact pressure (Pa).
    pub pressure: Vec<f64>,
    /// Of penalty contact in two passes, the part of the pressure that the node's own pass carries (Pa).
    pub pass_pressure: Option<Vec<f64>>,
    /// Shear traction on the node's own surface (Pa).
    pub shear: Vec<Vector3<f64>>,
    /// Velocity of the node's own surface relative to the other (m/s).
    pub slip_velocity: Vec<Vector3<f64>>,
    /// Gap (m), negative when penetrating.
    pub gap: Option<Vec<f64>>,
    /// Coefficient of friction that the algorithm used.
    pub mu: Option<Vec<f64>>,
    /// 0 open, 1 stick, 2 slip.
    pub state: Option<Vec<u8>>,
    /// Displacement (m) and velocity (m/s).
    pub motion: Option<[Vec<Vector3<f64>>; 2]>,
}

impl Frame {
    /// Where a node of its `surface` is (m), displaced where the record has displacements.
    pub(crate) fn position(&self, surface: &Surface, row: usize) -> Vector3<f64> {
        let moved =
            self.motion.as_ref().map_or(Vector3::zeros(), |[displacement, _]| displacement[row]);
        surface.points[row] + moved
    }
}

/// Vectors from their components in a file, one vector after the other.
pub(crate) fn vectors(components: &[f64]) -> Vec<Vector3<f64>> {
    components.as_chunks().0.iter().copied().map(Vector3::from).collect()
}

/// A contact history: its mesh, times and attributes; the records stay in the file.
#[derive(Clone, Debug)]
pub struct ContactHistory {
    path: PathBuf,
    /// Its mesh.
    pub surface: Surface,
    /// Time of each record (s).
    pub times: Vec<f64>,
    /// How a record pairs slip with traction in time, and whether the file states it ([`Pairing::Before`] is
    /// assumed where it does not).
    pub pairing: (Pairing, bool),
    /// The body (0 disk, 1 bar) at whose nodes the method enforces the conditions, if the file names one.
    pub enforced_on: Option<u8>,
    /// Whether it enforces them in the mean over the faces around each node (mortar).
    pub in_means: bool,
    /// Whether the fine zone follows the contact: a node is then no point of material.
    pub follows: bool,
    /// The optional fields of its records.
    pub has: Recorded,
}

/// Which optional fields the records of a contact history have.
#[derive(Clone, Copy, Debug)]
pub struct Recorded {
    /// `gap`.
    pub gap: bool,
    /// `mu`, the coefficient of friction that the algorithm used.
    pub mu: bool,
    /// `state`: open, stick or slip.
    pub state: bool,
    /// Both `displacement` and `velocity`.
    pub motion: bool,
    /// `pass_pressure`, the part of the pressure that a node's own pass carries.
    pub pass_pressure: bool,
}

impl ContactHistory {
    /// Opens a file of the layout of `contact.vtkhdf`.
    ///
    /// Needed are `pressure` (Pa), `shear` (Pa, 3) and `slip_velocity` (m/s, 3) at the points.
    /// `gap`, `mu`, `state`, `pass_pressure`, and together `displacement` and `velocity`, are used where they
    /// exist; so are `area` (else from the mesh) and the cell data `body` (else one body).
    ///
    /// # Errors
    /// A file that cannot be read, is of another layout, or holds no record.
    pub fn open(path: &Path) -> Result<Self, PostError> {
        let file = open(path)?;
        let lacks = |what: String| PostError::Lacks { path: path.into(), what };
        let found = |wanted: &FieldSpec| {
            let FieldSpec { name, units, components, .. } = wanted;
            let field = file.fields().iter().find(|f| f.name == *name && !f.on_cells);
            match field {
                Some(field) if field.units != *units => Err(lacks(format!(
                    "{name} is in {:?}, but {units} is needed: convert it",
                    field.units
                ))),
                Some(field) if field.components != *components => Err(lacks(format!(
                    "{name} has {} components, but {components} are needed",
                    field.components
                ))),
                field => Ok(field.is_some()),
            }
        };
        for needed in [&CONTACT.pressure, &CONTACT.shear, &CONTACT.slip_velocity] {
            if !found(needed)? {
                return Err(lacks(format!(
                    "it has no point data {:?}: this is no contact history (docs/files.md)",
                    needed.name
                )));
            }
        }
        let has = Recorded {
            gap: found(&CONTACT.gap)?,
            mu: found(&CONTACT.mu)?,
            state: found(&CONTACT.state)?,
            motion: found(&CONTACT.displacement)? & found(&CONTACT.velocity)?,
            pass_pressure: found(&CONTACT.pass_pressure)?,
        };
        let times = file.times()?;
        if times.is_empty() {
            return Err(lacks("it holds no record yet".into()));
        }
        if !times.windows(2).all(|pair| pair[0] < pair[1]) || !times.iter().all(|t| t.is_finite()) {
            return Err(lacks("its times do not rise".into()));
        }
        let text = |attribute| file.provenance(attribute).ok();
        let said = |pairing: &Pairing| {
            text(attribute::SLIP_PAIRING).is_some_and(|text| text == pairing.name())
        };
        let stated = [Pairing::Before, Pairing::After].into_iter().find(said);
        let pairing = (stated.unwrap_or(Pairing::Before), stated.is_some());
        let enforced_on = text(attribute::ENFORCED_ON)
            .and_then(|text| BODY_NAMES.iter().position(|name| **name == text))
            .map(|body| body as u8);
        let in_means = text(attribute::CONTACT_ROWS).is_some_and(|rows| rows == MORTAR);
        let surface = Surface::read(&file, path)?;
        let follows = text(attribute::WINDOW).is_some_and(|window| window == FOLLOWS);
        Ok(Self { path: path.into(), surface, times, pairing, enforced_on, in_means, follows, has })
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Indices of the records from `from` to `to` (s), both included to round-off.
    ///
    /// # Errors
    /// [`PostError::Lacks`] for a window without a record.
    pub fn window(&self, [from, to]: [f64; 2]) -> Result<Range<usize>, PostError> {
        let slack = 1e-9 * self.times.last().copied().unwrap_or(0.0).abs();
        let start = self.times.partition_point(|t| *t < from - slack);
        let end = self.times.partition_point(|t| *t <= to + slack);
        if start < end {
            return Ok(start..end);
        }
        Err(PostError::Lacks {
            path: self.path.clone(),
            what: format!(
                "there is no record from {from} to {to} s; the file has {} from {:.6} to {:.6} s",
                self.times.len(),
                self.times[0],
                self.times[self.times.len() - 1]
            ),
        })
    }

    /// The record `index` (from 0).
    ///
    /// # Errors
    /// A record that cannot be read or holds values that are not finite.
    pub fn record(&self, index: usize) -> Result<Frame, PostError> {
        let file = open(&self.path)?;
        let reading = Reading { file: &file, history: self };
        let tractions = reading.tractions(index..index + 1)?;
        let motions = reading.motions(index..index + 1)?;
        let frame = tractions.into_iter().zip(motions).next();
        frame
            .map(|(frame, motion)| Frame { motion, ..frame })
            .ok_or_else(|| PostError::Damaged { path: self.path.clone() })
    }

    /// Calls `take` with each of `records`, in order.
    ///
    /// # Errors
    /// A record that cannot be read or holds values that are not finite; an error of `take`.
    pub fn stream(
        &self,
        records: Range<usize>,
        mut take: impl FnMut(Frame) -> Result<(), PostError>,
    ) -> Result<(), PostError> {
        self.stream_batches(records, |batch| batch.into_iter().try_for_each(&mut take))
    }

    /// As [`Self::stream`], a few records at a time: at most 16, and at most 4 MiB of them.
    ///
    /// # Errors
    /// As there.
    pub fn stream_batches(
        &self,
        records: Range<usize>,
        mut take: impl FnMut(Vec<Frame>) -> Result<(), PostError>,
    ) -> Result<(), PostError> {
        let record = NUMBERS_PER_NODE * size_of::<f64>() * self.surface.points.len();
        let size = (BATCH_BYTES / record.max(1)).clamp(1, MOST_IN_BATCH);
        let batches: Vec<Range<usize>> = records
            .clone()
            .step_by(size)
            .map(|start| start..(start + size).min(records.end))
            .collect();
        let tractions = Ahead::start(self, batches.clone(), |reading, k| reading.tractions(k))?;
        let motions = Ahead::start(self, batches.clone(), |reading, k| reading.motions(k))?;
        for _ in batches {
            let frames = tractions.next(&self.path)?.into_iter();
            let motions = motions.next(&self.path)?;
            take(frames.zip(motions).map(|(frame, motion)| Frame { motion, ..frame }).collect())?;
        }
        tractions.finish();
        motions.finish();
        Ok(())
    }
}

/// Most numbers that a record has for a node.
const NUMBERS_PER_NODE: usize = 17;
/// Size of a batch of records (bytes), of which a few are in memory at a time.
const BATCH_BYTES: usize = 4 << 20;
/// Most records in a batch; more make it no faster.
const MOST_IN_BATCH: usize = 16;
/// Batches that each thread reads ahead.
const AHEAD: usize = 2;

/// A thread that reads batches of records ahead of their use.
struct Ahead<T> {
    inbox: Receiver<Result<Vec<T>, PostError>>,
    thread: JoinHandle<()>,
}

impl<T: Send + 'static> Ahead<T> {
    fn start(
        history: &ContactHistory,
        batches: Vec<Range<usize>>,
        read: fn(&Reading<'_>, Range<usize>) -> Result<Vec<T>, PostError>,
    ) -> Result<Self, PostError> {
        let (sender, inbox) = sync_channel(AHEAD);
        let history = history.clone();
        let thread = std::thread::Builder::new().spawn(move || {
            let file = match open(&history.path) {
                Ok(file) => file,
                Err(error) => {
                    let _ = sender.send(Err(error));
                    return;
                }
            };
            let reading = Reading { file: &file, history: &history };
            for batch in batches {
                let read = read(&reading, batch);
                let stop = read.is_err();
                // the receiver is gone: no more records are wanted
                if sender.send(read).is_err() || stop {
                    return;
                }
            }
        });
        let thread = thread.map_err(|cause| OutputError::Thread { cause })?;
        Ok(Self { inbox, thread })
    }

    fn next(&self, path: &Path) -> Result<Vec<T>, PostError> {
        self.inbox.recv().map_err(|_| PostError::Damaged { path: path.into() })?
    }

    fn finish(self) {
        drop(self.inbox);
        let _ = self.thread.join();
    }
}

/// How often a file is opened that a run may be extending: one opening in a thousand reads a header while it
/// is rewritten.
const ATTEMPTS: usize = 5;

/// Opens a grid, up to [`ATTEMPTS`] times.
pub(crate) fn open(path: &Path) -> Result<GridFile, PostError> {
    open_by(path, |path| GridFile::open(path))
}

/// Opens a history in the same way; `None` where there is no such file.
pub(crate) fn open_history(path: &Path) -> Result<Option<HistoryFile>, PostError> {
    if !path.exists() {
        return Ok(None);
    }
    open_by(path, |path| HistoryFile::open(path)).map(Some)
}

fn open_by<T>(path: &Path, open: fn(&Path) -> Result<T, OutputError>) -> Result<T, PostError> {
    let mut failed = None;
    for _ in 0..ATTEMPTS {
        match open(path) {
            Ok(file) => return Ok(file),
            Err(error) => failed = Some(error),
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    Err(failed.map_or_else(|| PostError::Damaged { path: path.into() }, PostError::from))
}

struct Reading<'a> {
    file: &'a GridFile,
    history: &'a ContactHistory,
}

/// Displacement and velocity of the nodes, where the file has them.
type Motion = Option<[Vec<Vector3<f64>>; 2]>;

impl Reading<'_> {
    /// Records without their motion.
    fn tractions(&self, records: Range<usize>) -> Result<Vec<Frame>, PostError> {
        let has = self.history.has;
        let all = |field| self.numbers(field, records.clone());
        let some = |there: bool, field| there.then(|| all(field)).transpose();
        let (pressure, shear) = (all(&CONTACT.pressure)?, all(&CONTACT.shear)?);
        let slip_velocity = all(&CONTACT.slip_velocity)?;
        let gap = some(has.gap, &CONTACT.gap)?;
        let mu = some(has.mu, &CONTACT.mu)?;
        let state = some(has.state, &CONTACT.state)?;
        let pass = some(has.pass_pressure, &CONTACT.pass_pressure)?;
        let label = |states: &[f64]| states.iter().map(|state| *state as u8).collect();
        let frame = |(k, index): (usize, usize)| Frame {
            index,
            time: self.history.times[index],
            pressure: self.nodes(&pressure, k, 1).to_vec(),
            pass_pressure: pass.as_ref().map(|pass| self.nodes(pass, k, 1).to_vec()),
            shear: self.vectors(&shear, k),
            slip_velocity: self.vectors(&slip_velocity, k),
            gap: gap.as_ref().map(|gap| self.nodes(gap, k, 1).to_vec()),
            mu: mu.as_ref().map(|mu| self.nodes(mu, k, 1).to_vec()),
            state: state.as_ref().map(|state| label(self.nodes(state, k, 1))),
            motion: None,
        };
        Ok(records.clone().enumerate().map(frame).collect())
    }

    fn motions(&self, records: Range<usize>) -> Result<Vec<Motion>, PostError> {
        if !self.history.has.motion {
            return Ok(vec![None; records.len()]);
        }
        let displacement = self.numbers(&CONTACT.displacement, records.clone())?;
        let velocity = self.numbers(&CONTACT.velocity, records.clone())?;
        let of = |k| Some([self.vectors(&displacement, k), self.vectors(&velocity, k)]);
        Ok((0..records.len()).map(of).collect())
    }

    /// The part of `values` that belongs to record `k` of those read.
    fn nodes<'a>(&self, values: &'a [f64], k: usize, components: usize) -> &'a [f64] {
        let count = components * self.history.surface.points.len();
        &values[k * count..(k + 1) * count]
    }

    fn vectors(&self, values: &[f64], k: usize) -> Vec<Vector3<f64>> {
        vectors(self.nodes(values, k, 3))
    }

    /// A field over `records`, one record after the other.
    fn numbers(
        &self,
        field: &'static FieldSpec,
        records: Range<usize>,
    ) -> Result<Vec<f64>, PostError> {
        let components = field.components;
        let values = self.file.read_steps(&field.name, false, records.clone())?;
        let path = || self.history.path.clone();
        let per_record = components * self.history.surface.points.len();
        if values.len() != per_record * records.len() {
            return Err(PostError::Damaged { path: path() });
        }
        // without an early end the loop over all values takes a fraction of the time
        if values.iter().fold(true, |all, value| all & value.is_finite()) {
            return Ok(values);
        }
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(values),
            Some(at) => Err(PostError::NotANumber {
                path: path(),
                field: &field.name,
                node: at % per_record / components,
                time: self.history.times[records.start + at / per_record],
            }),
        }
    }
}
