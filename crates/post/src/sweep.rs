//! What a sweep says: how results follow its axes, as figures and as verdicts.
//!
//! Everything starts from the document `sweep.json`; the profiles read the contact histories of
//! the runs that it names.

mod document;
mod figures;
mod measures;
mod profiles;
mod trend;
mod verdict;

pub use figures::sweep_figures;
pub(crate) use trend::RULE;
pub use trend::{Sample, Trend, Verdict, trend};
pub use verdict::{SweepVerdict, sweep_verdicts};

pub(crate) use document::{Sweep, value_text};
pub(crate) use measures::{MEASURES, SweepMeasure};
