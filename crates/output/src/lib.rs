//! The on-disk form of a run: VTKHDF fields and contact surfaces, history, summary.
//!
//! | file | written by |
//! |---|---|
//! | `fields.vtkhdf`, `contact.vtkhdf` | [`TransientGrid`] |
//! | `history.h5` | [`History`] |
//! | `checkpoint.h5` | [`Checkpoint`] |
//! | `summary.json` | [`summary::Summary::write`] |
//!
//! Every HDF5 file is created with its mesh and metadata and closed; each snapshot then opens it,
//! appends and closes. Between snapshots the file is complete, so any reader can open it while the
//! run goes on, and a killed process loses at most the snapshot that it was writing: headers are
//! rewritten in place, each within a page of memory, and a file gets its name only once its closings
//! no longer move its links. The counts `NSteps` (grids) and `rows` (history) are written after the data
//! that they count: what they count is valid. A snapshot writes the new end of the file into the
//! superblock before anything refers to addresses behind the old one (module `hdf5::rust_hdf5`). With the
//! feature `libhdf5`, HDF5's own library writes, and decides itself in which order it writes within a closing.
//!
//! An opening can still fail where it reads a header while that is rewritten, or where it stalls
//! between its first reads: about one in a thousand fails ("incorrect metadata checksum",
//! "addr overflow", "truncated file") while snapshots are written without pause. A reader then opens
//! again, or opens with `h5py.File(path, swmr=True)`, which checks less and repeats its reads:
//! none of thousands of such openings failed. A reader that keeps a file open across a closing must
//! open again to see new snapshots. No file is locked: a viewer that holds one cannot stop a run.
//!
//! Contents depend on the data alone, apart from the `created` attribute: the same run gives the
//! same bits.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod background;
mod checkpoint;
mod checksums;
pub mod confidence;
mod disk_space;
mod error;
mod field;
pub mod files;
mod grid;
mod hdf5;
mod history;
mod integrity;
mod json;
pub mod layout;
mod provenance;
mod reader;
mod recognise;
pub mod summary;
mod vtu;

pub use background::{BackgroundWriter, RunFiles, Snapshot};
pub use checkpoint::{CHECKPOINTS, Checkpoint, Results, bytes_of, of_bytes};
pub use checksums::{Kept, hexadecimal, verify};
pub use disk_space::{free_space, room_left};
pub use error::{NotWritten, OutputError};
pub use field::FieldSpec;
pub use grid::{Cells, GridSpec, StaticField, TransientGrid, Values};
pub use history::History;
pub use integrity::{FileSum, LOG_END, as_long_as_written, as_written, read_summary};
pub use json::{Aliased, by_all_names, keyed, known, write_json_atomically};
pub use provenance::Provenance;
pub use reader::{FieldInfo, GridFile, HistoryFile};
pub use recognise::{VTKHDF, is_ours};
pub use vtu::write_vtu;
