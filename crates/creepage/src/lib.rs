//! Creepage as a library: an elastic disk rolls on an elastic bar, by explicit finite elements.
//!
//! What the command line does and what Python does are functions here, each with a struct of options: [`run()`] a
//! case, look at its [`mesh()`], [`check()`], [`plot()`], [`view()`] and [`report()`] what it gave, [`compare()`] runs, [`sweep()`]
//! over a grid of parameters, compute with the 1-D [`slider()`]. Each function gives a
//! struct that the command prints with `--json`. Nothing is written to the terminal; who wants to know how far
//! a command is, or to end it, is a [`Listener`]. Numbers are in SI units.
//!
//! A run of a few steps of a small case, and its check:
//!
//! ```
//! use creepage::{CaseSource, CheckOptions, Measure, RunOptions};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scratch = tempfile::tempdir()?;
//! let small = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");
//! let sets = ["mesh.zone.size=1.6e-3", "time.roll=0.1e-3", "output.contact_interval=5e-6"];
//! let ran = creepage::run(
//!     &RunOptions {
//!         case: CaseSource { sets: sets.map(str::to_owned).into(), ..small.into() },
//!         out: Some(scratch.path().join("small")),
//!         ..RunOptions::default()
//!     },
//!     &mut (),
//! )?;
//! assert!(ran.summary.contact.creepage.is_some());
//!
//! let checked = creepage::check(&CheckOptions {
//!     run: ran.folder,
//!     limits: vec![("law_error".into(), 0.02)],
//!     ..CheckOptions::default()
//! })?;
//! println!("every limit holds: {}", checked.result.pass);
//! println!("{:?}", checked.result.metrics[&Measure::Penetration]);
//! # Ok(())
//! # }
//! ```
//!
//! The same case with two coefficients of friction:
//!
//! ```
//! use creepage::{SweepFound, SweepOptions};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scratch = tempfile::tempdir()?;
//! let base = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");
//! let sweep = scratch.path().join("friction.toml");
//! let axis = "[[axis]]\nkey = 'friction.static'\nvalues = [0.3, 0.4]";
//! let set = "[set]\nmesh.zone.size = 1.6e-3\ntime.roll = 0.1e-3\noutput.contact_interval = 5e-6";
//! std::fs::write(&sweep, format!("base = '{base}'\n{set}\n{axis}"))?;
//! let out = Some(scratch.path().join("friction"));
//! let swept = creepage::sweep(&SweepOptions { sweep, out, ..SweepOptions::default() }, &mut ())?;
//! let SweepFound::Result(result) = swept.result else { unreachable!("no plan was asked for") };
//! for run in &result.runs {
//!     let contact = run.summary.as_ref().map(|summary| summary.contact);
//!     println!("{:?}: {:?}", run.parameters, contact.and_then(|of| of.traction_coefficient));
//! }
//! assert!(result.runs.iter().all(|run| run.completed()));
//! # Ok(())
//! # }
//! ```
//!
//! The explicit slider with a listener that ends it:
//!
//! ```
//! use std::sync::Arc;
//! use std::sync::atomic::{AtomicBool, Ordering};
//!
//! use creepage::{Listener, MethodName, Settings, SliderFound, SliderOptions};
//!
//! #[derive(Default)]
//! struct Half(Arc<AtomicBool>);
//!
//! impl Listener for Half {
//!     fn stop(&mut self) -> Arc<AtomicBool> {
//!         Arc::clone(&self.0)
//!     }
//!
//!     fn slider(&mut self, step: u64, steps: u64) {
//!         self.0.store(2 * step >= steps, Ordering::Relaxed);
//!     }
//! }
//!
//! # fn main() -> Result<(), creepage::Error> {
//! let settings = Settings {
//!     method: Some(MethodName::Explicit),
//!     dt: Some(1e-5),
//!     ..Settings::default()
//! };
//! let options = SliderOptions { settings, ..SliderOptions::default() };
//! let slid = creepage::slider(&options, &mut Half::default())?;
//! assert!(matches!(slid, SliderFound::Run(run) if run.outcome.stopped));
//! # Ok(())
//! # }
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod case;
pub mod chart;
pub mod check;
mod commands;
pub mod compare;
pub mod contact_inp;
pub mod figures;
pub mod ls_dyna;
pub mod python;
pub mod report;
pub mod rule;
pub mod run;
pub mod scenario;
pub mod scene;
pub mod subsurface;
pub mod sweep;
#[cfg(test)]
mod tests;
pub mod trends;

pub use ::slider::tables::{TableRow, Tables};
pub use ::slider::{Method, Outcome, Parameters, Threshold, Thresholds, penalty_stable_step};
pub use case::CaseSource;
pub use case::json_schema as schema;
pub use chart::Format;
pub use check::{
    CheckResult, Checked, ImportContactOptions, Measure, Pairing, Report as PairingReport,
};
pub use commands::*;
pub use dynamics::{Message, Ranks};
pub use friction::OwnLaw;
pub use ls_dyna::Units;
pub use output::summary::Summary;
pub use run::{BlockElement, Leader, Level, RunOptions};
pub use scenario::{Cost, Progress, Stage};
pub use subsurface::StressProfile;
pub use sweep::{Cell, Column, SweepResult, Table, Watched};
