//! How the results of a sweep depend on its axes, as figures and as verdicts.
//!
//! All data are in `sweep.json`, except the profiles: these are read from the contact histories
//! of the runs that it names.

mod creep_force;
mod figures;
mod fit;
mod groups;
mod limits;
mod lines;
mod measures;
mod profiles;
mod trend;
mod verdict;

pub use creep_force::{ComparedSweep, creep_force_figure};
pub use figures::sweep_figures;
pub(crate) use trend::RULE;
pub use trend::{Asymptote, Refinement, Sample, Trend, Verdict, trend};
pub use verdict::{SweepVerdict, sweep_verdicts};

pub(crate) use groups::{Sweep, steps, value_text};
pub(crate) use limits::{LIMITS, answers};
pub(crate) use measures::{MEASURES, SweepMeasure};
