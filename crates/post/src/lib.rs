//! What a run means: where and by how much the contact conditions, Eqs. (6) to (8) of Vollebregt
//! (2017), are violated, what the patch is like, and the figures and the page that show it.
//!
//! Runs are read through `output` alone, so that results of other codes can be judged once they
//! have the layout of `contact.vtkhdf`. Of `contact` only definitions are used, the friction laws
//! and the fit of the patch; the kinematics of the pair is written anew here (module `projection`), so
//! that a check does not repeat an error of the solver.
//!
//! [`check`](check()) goes through a contact history record by record and gives the document of
//! `creepage check`; memory does not grow with the number of records beyond a few numbers each.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod accumulator;
mod basis;
mod centreline;
mod check;
mod compare;
mod conditions;
mod digits;
mod error;
mod figures;
mod frames;
mod import;
mod integrity;
mod law;
mod limits;
mod map;
mod means;
mod page;
mod patch_series;
mod projection;
mod recorded_law;
mod replay;
mod roughness;
mod slip_zone;
mod statistics;
mod surface;
mod sweep;
mod vector;
mod window;

pub use basis::{Basis, Bound, RunPaths, SCALES, Scale};
pub use check::{CheckOptions, Checked, Report, check};
pub use compare::{Compared, Comparison, compare};
pub use conditions::{DIRECTION_TOLERANCE, IN_ADHESION, IN_CONTACT, LAW_TOLERANCE};
pub use error::PostError;
pub use figures::{Named, figures};
pub use frames::{ContactHistory, Frame, Recorded};
pub use import::{ImportError, ImportFiles, Imported, import_contact};
pub use integrity::{Depth, prove, prove_case};
pub use law::Law;
pub use limits::{Limit, Limits, MEASURES, Measure};
pub use output::layout::Pairing;
pub use page::{run_page, sweep_page};
pub use patch_series::{PATCH_MEASURES, PATCH_TABLE, PatchLine, PatchRow};
pub use surface::{NO_BODY, Surface, body_name};
pub use sweep::{Sample, SweepVerdict, Trend, Verdict, sweep_figures, sweep_verdicts, trend};
pub use window::Span;
