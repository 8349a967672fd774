//! What the command line and Python do, each command as a function with a struct of options.

mod bench;
mod case;
mod cases;
mod check;
mod compare;
mod error;
mod export_k;
mod import_contact;
mod import_inp;
mod import_k;
mod interface_of_k;
mod listener;
mod mesh;
mod outputs;
mod plot;
mod render;
mod report;
mod run;
mod slider;
mod stress_profile;
mod sweep;
mod sweep_folder;
mod values;
mod verify;
mod view;

pub use bench::{BenchOptions, bench};
pub use cases::{CasesFound, CasesOptions, ListedCase, cases};
pub use check::{BasisOptions, CheckOptions, SpanOptions, check};
pub use compare::{CompareOptions, compare};
pub use error::{
    BAD_INPUT, Error, FAILED, FailureResult, FurtherError, INTERRUPTED, STOPPED_BY_GUARD,
};
pub use export_k::{ExportKOptions, ExportedK, export_k};
pub use import_contact::{ImportedContact, import_contact};
pub use import_inp::{ImportInpOptions, ImportedInp, import_inp};
pub use import_k::{ImportKOptions, ImportedK, import_k};
pub use interface_of_k::{InterfaceOfKOptions, interface_of_k};
pub use listener::Listener;
pub use mesh::{MeshOptions, mesh};
pub use plot::{Drawn, DrawnFigure, PlotOptions, plot};
pub use render::RenderOptions;
pub use report::{ReportOptions, Reported, report};
pub use run::{Ran, assist, run};
pub use slider::{
    LawName, LawNumbers, MethodName, SettingError, Settings, SliderFound, SliderOptions,
    SliderResult, SliderRun, slider,
};
pub use stress_profile::{StressProfileOptions, stress_profile};
pub use sweep::{SweepFound, SweepOptions, Swept, sweep};
pub use sweep_folder::sweep_table;
pub use verify::VerifyOptions;
pub use view::{ViewOptions, Viewed, view};
