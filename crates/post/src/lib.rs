//! What a run means: where and by how much the contact conditions, Eqs. (6) to (8) of Vollebregt's
//! *Comments* (2017), are violated, the measures of the patch, and the figures and the page that show them.
//!
//! Runs are read through `output` alone, so that results of other codes can be judged once they
//! have the layout of `contact.vtkhdf`. The friction laws are those of `friction`; of `contact` only the fit
//! of the patch and the measure of mesh modes are used. The closest-point projection is written anew here
//! (module `projection`), so that a check does not repeat an error of the solver.
//!
//! [`check`](check()) goes through a contact history record by record and returns the document of
//! `creepage check`. Fields are never held for all records; what is kept of each record are its patch
//! measures and its centre line.
//!
//! Units are SI. x is the direction of rolling, y is lateral, z is up. `p_n` is the pressure, `p_tau` the shear
//! traction, `p_f` its size, `s` the slip velocity, `mu` the coefficient of friction.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod accumulator;
mod basis;
mod centreline;
mod check;
mod compare;
mod conditions;
mod correlation;
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
mod render;
mod replay;
mod roughness;
mod slip_zone;
mod statistics;
mod surface;
mod sweep;
mod vector;
mod welch;
mod window;

pub use basis::{Basis, Bound, RunPaths, SCALES, Scale};
pub use check::{CheckOptions, Checked, Report, check, fluctuating_slip, keeps_limit, slip_paired};
pub use compare::{Compared, Comparison, compare};
pub use conditions::{DIRECTION_TOLERANCE, IN_ADHESION, IN_CONTACT, LAW_TOLERANCE};
pub use digits::all_digits;
pub use error::PostError;
pub use figures::{Named, figures};
pub use frames::{ContactHistory, Frame, Recorded};
pub use import::{ImportError, ImportFiles, Imported, import_contact};
pub use integrity::{Depth, prove, prove_case};
pub use law::Law;
pub use limits::{Limit, Limits, MEASURES, Measure};
pub use output::layout::Pairing;
pub use page::{ListedRun, run_page, runs_page, sweep_page};
pub use patch_series::{PATCH_MEASURES, PATCH_TABLE, PatchLine, PatchRow};
pub use render::{Drawable, Quantity, RenderError, Rendering, View, Wanted};
pub use surface::{NO_BODY, Surface, body_name};
pub use sweep::{
    Asymptote, ComparedSweep, Refinement, Sample, SweepVerdict, Trend, Verdict, creep_force_figure,
    sweep_figures, sweep_verdicts, trend,
};
pub use window::Span;
