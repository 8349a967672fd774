//! Writing on a thread beside the time loop, which then does not wait for compression.

use crate::checkpoint::sync_file;
use crate::{Checkpoint, History, Kept, OutputError, Results, TransientGrid, Values};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

/// The HDF5 files of one run.
#[derive(Debug)]
pub struct RunFiles {
    /// Writer of `fields.vtkhdf`; none where a run does not record its bodies.
    pub fields: Option<TransientGrid>,
    /// Writer of `contact.vtkhdf`.
    pub contact: TransientGrid,
    /// Writer of `history.h5`.
    pub history: History,
}

/// A thread that owns the files of a run and appends what it is sent, in the order of sending, so that
/// the files hold the same bits as without it.
///
/// Data are copied into buffers, which the thread returns for reuse. Each file has buffers of its own,
/// since their sizes differ by orders of magnitude; where all [`Self::BUFFERS`] of a file are in use, the
/// sender waits for one. An error stops the thread and is returned by a later call.
#[derive(Debug)]
pub struct BackgroundWriter {
    sender: Sender<Message>,
    spare: [Receiver<Buffer>; 3],
    /// Buffers allocated for each file.
    allocated: [usize; 3],
    /// Number of checkpoints sent and not yet known to be written (one at most), and the signals of those written.
    checkpoints: (usize, Receiver<()>),
    thread: Option<JoinHandle<Result<RunFiles, OutputError>>>,
}

#[derive(Clone, Copy)]
enum Target {
    // in the order of `BackgroundWriter::BUFFERS`
    Fields,
    Contact,
    History,
}

/// Makes a checkpoint from the lengths and checksums of the result files.
type MakeCheckpoint = dyn FnOnce(Results) -> Result<Checkpoint, OutputError> + Send;

enum Message {
    Append {
        target: Target,
        time: f64,
        buffer: Buffer,
    },
    /// A checkpoint to be written to a folder, and a result file that another writer owns.
    Checkpoint {
        make: Box<MakeCheckpoint>,
        folder: PathBuf,
        beside: Option<(PathBuf, Kept)>,
    },
}

/// Flat copies of the values of one snapshot, or of history rows.
#[derive(Debug, Default)]
struct Buffer {
    shapes: Vec<Shape>,
    numbers: Vec<f64>,
    integers: Vec<u8>,
}

#[derive(Debug)]
struct Shape {
    components: usize,
    integer: bool,
    count: usize,
}

impl BackgroundWriter {
    /// Buffers for each file (fields, contact, history); each holds one snapshot or block of rows.
    pub const BUFFERS: [usize; 3] = [1, 8, 4];

    /// Starts the thread.
    ///
    /// # Errors
    /// The system has no thread left.
    pub fn start(files: RunFiles) -> Result<Self, OutputError> {
        let (sender, inbox) = channel();
        let pools = [(); 3].map(|()| channel());
        let outbox = pools.each_ref().map(|(sender, _)| sender.clone());
        let (done, written) = channel();
        let thread = std::thread::Builder::new()
            .spawn(move || write_all(files, &inbox, &outbox, &done))
            .map_err(|cause| OutputError::Thread { cause })?;
        let spare = pools.map(|(_, receiver)| receiver);
        let (allocated, checkpoints) = ([0; 3], (0, written));
        Ok(Self { sender, spare, allocated, checkpoints, thread: Some(thread) })
    }

    /// Sends a snapshot at `time` (s) for `fields.vtkhdf`; see [`TransientGrid::append`].
    ///
    /// # Errors
    /// The first error of the thread, whatever it wrote; then [`OutputError::Stopped`]. [`OutputError::NoFields`]
    /// where the run has no such file.
    pub fn append_fields(&mut self, time: f64, values: &[Values<'_>]) -> Result<(), OutputError> {
        self.send(Target::Fields, time, |buffer| buffer.fill(values))
    }

    /// Sends a snapshot at `time` (s) for `fields.vtkhdf` that `fill` writes directly into the buffer, field
    /// after field in the order of the file. This saves a copy.
    ///
    /// # Errors
    /// As for [`Self::append_fields`].
    pub fn append_fields_with(
        &mut self,
        time: f64,
        fill: impl FnOnce(&mut Snapshot<'_>),
    ) -> Result<(), OutputError> {
        self.send(Target::Fields, time, |buffer| fill(&mut Snapshot(buffer)))
    }

    /// Sends a snapshot at `time` (s) for `contact.vtkhdf`; see [`TransientGrid::append`].
    ///
    /// # Errors
    /// As for [`Self::append_fields`].
    pub fn append_contact(&mut self, time: f64, values: &[Values<'_>]) -> Result<(), OutputError> {
        self.send(Target::Contact, time, |buffer| buffer.fill(values))
    }

    /// Sends rows for `history.h5`; see [`History::append`].
    ///
    /// # Errors
    /// As for [`Self::append_fields`].
    pub fn append_history(&mut self, rows: &[f64]) -> Result<(), OutputError> {
        self.send(Target::History, 0.0, |buffer| buffer.numbers.extend_from_slice(rows))
    }

    /// Has a checkpoint written to `folder`. The thread calls `make` with the lengths and checksums of the result
    /// files, once everything sent before is in them and they are synced to the disk. `beside` is a result file
    /// that the caller writes itself (`probes.h5`), with its length and checksums; it is synced with them. Returns
    /// at once unless an earlier checkpoint is not yet written.
    ///
    /// # Errors
    /// As for [`Self::append_fields`].
    pub fn keep(
        &mut self,
        make: impl FnOnce(Results) -> Result<Checkpoint, OutputError> + Send + 'static,
        folder: &Path,
        beside: Option<(PathBuf, Kept)>,
    ) -> Result<(), OutputError> {
        if self.checkpoints.0 > 0 {
            self.wait_for_checkpoint()?;
        }
        let message =
            Message::Checkpoint { make: Box::new(make), folder: folder.to_owned(), beside };
        if self.sender.send(message).is_err() {
            return join(self.thread.take()).and(Err(OutputError::Stopped));
        }
        self.checkpoints.0 += 1;
        Ok(())
    }

    fn wait_for_checkpoint(&mut self) -> Result<(), OutputError> {
        match self.checkpoints.1.recv() {
            Ok(()) => {
                self.checkpoints.0 -= 1;
                Ok(())
            }
            Err(_) => join(self.thread.take()).and(Err(OutputError::Stopped)),
        }
    }

    /// Waits until everything is written and returns the writers of the files.
    ///
    /// # Errors
    /// As for [`Self::append_fields`].
    pub fn finish(self) -> Result<RunFiles, OutputError> {
        let Self { sender, thread, .. } = self;
        drop(sender);
        join(thread)
    }

    fn send(
        &mut self,
        target: Target,
        time: f64,
        fill: impl FnOnce(&mut Buffer),
    ) -> Result<(), OutputError> {
        let file = target as usize;
        let mut buffer = if self.allocated[file] < Self::BUFFERS[file] {
            self.spare[file].try_recv().unwrap_or_else(|_| {
                self.allocated[file] += 1;
                Buffer::default()
            })
        } else {
            match self.spare[file].recv() {
                Ok(buffer) => buffer,
                Err(_) => return join(self.thread.take()).and(Err(OutputError::Stopped)),
            }
        };
        buffer.clear();
        fill(&mut buffer);
        match self.sender.send(Message::Append { target, time, buffer }) {
            Ok(()) => Ok(()),
            Err(_) => join(self.thread.take()).and(Err(OutputError::Stopped)),
        }
    }
}

/// A snapshot of a grid that is being written into a buffer, field after field.
#[derive(Debug)]
pub struct Snapshot<'a>(&'a mut Buffer);

impl Snapshot<'_> {
    /// Writes the next field: three numbers at every point or on every cell, in the units of the field.
    pub fn vectors(&mut self, values: impl ExactSizeIterator<Item = [f64; 3]>) {
        let count = values.len();
        self.0.numbers.reserve_exact(3 * count);
        self.0.numbers.extend(values.flatten());
        self.0.shapes.push(Shape { components: 3, integer: false, count });
    }

    /// Writes the next field: a number at every point or on every cell, in the units of the field.
    pub fn scalars(&mut self, values: impl ExactSizeIterator<Item = f64>) {
        let count = values.len();
        self.0.numbers.extend(values);
        self.0.shapes.push(Shape { components: 1, integer: false, count });
    }

    /// Writes the next field: `fill` writes `count` symmetric tensors, xx yy zz xy yz xz, over zeros, in the units
    /// of the field.
    pub fn tensors(&mut self, count: usize, fill: impl FnOnce(&mut [[f64; 6]])) {
        let numbers = &mut self.0.numbers;
        let start = numbers.len();
        numbers.reserve_exact(6 * count);
        numbers.resize(start + 6 * count, 0.0);
        fill(numbers[start..].as_chunks_mut().0);
        self.0.shapes.push(Shape { components: 6, integer: false, count });
    }
}

impl Buffer {
    fn clear(&mut self) {
        self.shapes.clear();
        self.numbers.clear();
        self.integers.clear();
    }

    fn fill(&mut self, values: &[Values<'_>]) {
        for value in values {
            let integer = match *value {
                Values::Scalar(values) => self.take(values),
                Values::Vector(values) => self.take(values.as_flattened()),
                Values::Tensor(values) => self.take(values.as_flattened()),
                Values::Integer(values) => {
                    self.integers.extend_from_slice(values);
                    true
                }
            };
            let (components, count) = (value.components(), value.count());
            self.shapes.push(Shape { components, integer, count });
        }
    }

    fn take(&mut self, numbers: &[f64]) -> bool {
        self.numbers.extend_from_slice(numbers);
        false
    }

    fn values(&self) -> Vec<Values<'_>> {
        let (mut numbers, mut integers) = (&self.numbers[..], &self.integers[..]);
        let mut values = Vec::with_capacity(self.shapes.len());
        for shape in &self.shapes {
            if shape.integer {
                let (mine, rest) = integers.split_at(shape.count);
                integers = rest;
                values.push(Values::Integer(mine));
                continue;
            }
            let (mine, rest) = numbers.split_at(shape.count * shape.components);
            numbers = rest;
            values.push(match shape.components {
                3 => Values::Vector(mine.as_chunks().0),
                6 => Values::Tensor(mine.as_chunks().0),
                _ => Values::Scalar(mine),
            });
        }
        values
    }
}

fn write_all(
    mut files: RunFiles,
    inbox: &Receiver<Message>,
    outbox: &[Sender<Buffer>; 3],
    done: &Sender<()>,
) -> Result<RunFiles, OutputError> {
    for message in inbox {
        match message {
            Message::Append { target, time, buffer } => {
                match target {
                    Target::Fields => match &mut files.fields {
                        Some(fields) => fields.append(time, &buffer.values())?,
                        None => return Err(OutputError::NoFields),
                    },
                    Target::Contact => files.contact.append(time, &buffer.values())?,
                    Target::History => files.history.append(&buffer.numbers)?,
                }
                // A sender that has finished no longer receives buffers.
                let _ = outbox[target as usize].send(buffer);
            }
            Message::Checkpoint { make, folder, beside } => {
                write_checkpoint(&files, make, &folder, beside)?;
                let _ = done.send(());
            }
        }
    }
    Ok(files)
}

/// Syncs the results first: a checkpoint must not refer to data that a power cut can still remove.
fn write_checkpoint(
    files: &RunFiles,
    make: Box<MakeCheckpoint>,
    folder: &Path,
    beside: Option<(PathBuf, Kept)>,
) -> Result<(), OutputError> {
    let (beside, probes) = beside.unzip();
    let fields = files.fields.as_ref();
    let own = [files.contact.path(), files.history.path()];
    let others = fields.map(TransientGrid::path).into_iter().chain(beside.as_deref());
    own.into_iter().chain(others).try_for_each(sync_file)?;
    let results = Results {
        fields: fields.map(TransientGrid::kept).unwrap_or_default(),
        contact: files.contact.kept(),
        history: files.history.kept(),
        probes: probes.unwrap_or_default(),
    };
    make(results)?.write(folder)
}

fn join(
    thread: Option<JoinHandle<Result<RunFiles, OutputError>>>,
) -> Result<RunFiles, OutputError> {
    let thread = thread.ok_or(OutputError::Stopped)?;
    thread.join().unwrap_or(Err(OutputError::Stopped))
}
