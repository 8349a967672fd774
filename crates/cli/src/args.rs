//! Commands and options.

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

use crate::check::CheckArgs;
use crate::compare::CompareArgs;
use crate::embedded::{Embedded, Told};
use crate::import_contact::ImportArgs;
use crate::import_k::ImportKArgs;
use crate::plot::PlotArgs;
use crate::report;
use crate::report_page::ReportArgs;
use crate::slider::SliderArgs;
use crate::stop::Stop;
use crate::sweep::SweepArgs;
use crate::verify::VerifyArgs;
use case::{BlockElement, Level};
use clap::{ArgAction, Parser, Subcommand};
use serde_json::Value;

/// Rolling contact of an elastic disk on an elastic bar, by explicit finite elements.
#[derive(Debug, Parser)]
#[command(
    name = "creepage",
    version,
    arg_required_else_help = true,
    after_help = "Exit codes: 0 done; 1 a check failed; 2 bad input; 3 stopped by the run's own \
                  guards; 130 interrupted.\n\nExamples:\n  creepage run cases/quick.toml\n  \
                  creepage mesh cases/quick.toml --out quick.vtu\n  creepage schema > \
                  case.schema.json\n  creepage check runs/quick\n  creepage report runs/quick"
)]
pub struct Args {
    /// Print exactly one JSON document on standard output, everything else on standard error
    #[arg(long, global = true)]
    pub json: bool,
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say more (-vv still more)
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub verbose: u8,
    /// Read the command line, and the case or sweep that it runs, and stop there: how the commands of
    /// the documents are checked
    #[arg(long, global = true, hide = true)]
    pub check_args: bool,
    /// The program that holds this command.
    #[arg(skip)]
    pub embedded: Option<Embedded>,
    /// The program, and its first arguments, that does the runs of a sweep; empty for this one.
    #[arg(skip)]
    pub program: Vec<OsString>,
    /// Ctrl-C and SIGTERM.
    #[arg(skip)]
    pub stop: Stop,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

impl Args {
    /// Hands over the document of `--json`.
    pub fn print_json(&self, document: &Value) {
        match &self.embedded {
            Some(embedded) => (embedded.tell)(Told::Document(document.clone())),
            None => report::print_json(document),
        }
    }

    /// Says a remark beside the results.
    pub fn say(&self, line: &str) {
        match &self.embedded {
            Some(embedded) => (embedded.tell)(Told::Said(line.to_owned())),
            // A closed standard error is no reason to panic.
            None if !self.quiet => drop(writeln!(std::io::stderr(), "{line}")),
            None => {}
        }
    }

    /// Tells the program that holds this command, if one does.
    pub fn tell(&self, told: impl FnOnce() -> Told) {
        if let Some(embedded) = &self.embedded {
            (embedded.tell)(told());
        }
    }
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a case
    #[command(after_help = "Examples:\n  creepage run cases/quick.toml\n  creepage run \
        cases/quick.toml --set friction.static=0.3 --out runs/slippery\n  creepage run \
        cases/zhao-li/b-falling.toml --set mesh.zone.size=2e-3 --threads 2\n  creepage run \
        cases/quick.toml --resume\n\nCtrl-C and SIGTERM end the run in order: a checkpoint is written and \
        what was computed so far is readable. --resume goes on from the last checkpoint (one every five \
        minutes, and on Ctrl-C) and leaves the same bits as a run that was not interrupted; on any \
        number of threads, also after kill -9. In a batch script, --resume --force begins the run or goes on with it.")]
    Run(RunArgs),
    /// Build the mesh of a case: counts, quality, stable step, memory and run-time estimate
    #[command(after_help = "Examples:\n  creepage mesh cases/quick.toml\n  creepage mesh \
        cases/zhao-li/a-coulomb.toml --set mesh.zone.size=0.5e-3 --out fine.vtkhdf")]
    Mesh(MeshArgs),
    /// Check where and by how much a run violates the contact conditions; exit code 1 beyond a limit
    #[command(after_help = "Examples:\n  creepage check runs/quick\n  creepage check runs/quick \
        --window 1.2e-3:1.5e-3 --limit violating_fraction=0.05\n  creepage check runs/b-falling \
        --map violations.vtkhdf --json > check.json\n  creepage check other-code.vtkhdf --case \
        case.toml --scale approach=1.04e-4\n\nThe measures, their scales and limits: \
        docs/checks.md.")]
    Check(CheckArgs),
    /// Compare runs: slip and shear over place and time, means, statistics, growth of a disturbance
    #[command(
        after_help = "Examples:\n  creepage compare runs/coarse runs/fine\n  creepage compare \
        runs/space-memory/runs/* --plot memory.png\n\nWhat the numbers are: docs/checks.md."
    )]
    Compare(CompareArgs),
    /// Draw the figures of a run (those of the papers, histories, slip over space and time, spectra)
    /// or of a sweep (measures over its axes, profiles, maps)
    #[command(
        after_help = "Examples:\n  creepage plot runs/quick\n  creepage plot runs/b-falling \
        --out figures --format svg\n\nWhat each figure shows: docs/checks.md."
    )]
    Plot(PlotArgs),
    /// Write one self-contained HTML page about a run or a sweep: case, numbers, checks, figures
    #[command(after_help = "Examples:\n  creepage report runs/quick\n  creepage report \
        runs/b-falling --out b-falling.html")]
    Report(ReportArgs),
    /// Run a case many times over a grid of parameters: one table, and a report; exit code 1 if a
    /// run fails
    #[command(
        after_help = "Examples:\n  creepage sweep cases/sweeps/kt.toml --jobs 2\n  creepage \
        sweep cases/sweeps/kt.toml --resume\n  creepage sweep cases/sweeps/kt-large.toml --plan \
        runs.sh\n  creepage sweep cases/sweeps/kt-large.toml --collect\n  creepage report \
        runs/kt\n\nCtrl-C ends the runs under way in order; --resume goes on. The sweep file, \
        other engines, results: docs/sweeps.md."
    )]
    Sweep(SweepArgs),
    /// Bring a contact history of another code, as CSV, into the layout that the checks read
    #[command(
        after_help = "Example:\n  creepage import-contact --nodes nodes.csv --faces faces.csv \
        --values values.csv --out contact.vtkhdf\n  creepage check contact.vtkhdf --case case.toml\n\n\
        The columns, with a small example: docs/checks.md."
    )]
    ImportContact(ImportArgs),
    /// Make a case and a mesh file of an LS-DYNA keyword file of a disk on a bar
    #[command(
        after_help = "Example:\n  creepage import-k meshes/small.k --unit mm-ton-s --out small\n  \
        creepage run small/case.toml\n\nThe cards that are read, and the keys that they become: \
        docs/ls-dyna.md. All others are refused by their line."
    )]
    ImportK(ImportKArgs),
    /// Print the JSON Schema of a case file: every key with unit, default and range
    #[command(after_help = "Example:\n  creepage schema > case.schema.json")]
    Schema,
    /// The 1-D slider of the paper: a block on a belt with falling friction
    #[command(
        after_help = "Examples:\n  creepage slider --tables\n  creepage slider --thresholds \
        --mass 0.1\n  creepage slider --method explicit --dt 3e-5 --csv slider.csv\n  creepage \
        slider --plot figures\n  creepage slider --method penalty --stiffness 1e5 --dt 1e-5\n  \
        creepage slider --method exact --expression \"0.3 + 0.2*exp(-2*s)\"\n  creepage slider \
        --config slider.toml --mass 0.02"
    )]
    Slider(Box<SliderArgs>),
    /// Run verification problems against their references; exit code 1 if one misses its limit
    #[command(
        after_help = "Examples:\n  creepage verify --list\n  creepage verify hertz-wheel\n  \
        creepage verify --quick --json > verify.json"
    )]
    Verify(VerifyArgs),
    /// Measure the element kernel and whole step on this machine, beside what its memory and arithmetic
    /// allow
    #[command(
        after_help = "Examples:\n  creepage bench --threads 2 --json\n  creepage bench --set \
        mesh.zone.size=0.5e-3 --set contact.enforcement='\"exact\"'\n  creepage bench --block 48 \
        --element full --threads 1"
    )]
    Bench(BenchArgs),
}

/// Options of `run`.
#[derive(Debug, clap::Args)]
pub struct RunArgs {
    /// The case file
    #[arg(value_name = "CASE.toml")]
    pub case: PathBuf,
    /// Folder of the run [default: runs/NAME, by the name of the case]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Set a key of the case, for example mesh.zone.size=2e-3; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Take the kernels whose bits every processor can give, at some cost in speed; the same as
    /// --set deterministic=true
    #[arg(long)]
    pub deterministic: bool,
    /// Go on with the run in the folder from its last checkpoint, to the same bits; with --force,
    /// begin anew where there is none of this case
    #[arg(long)]
    pub resume: bool,
    /// Replace the run that is already in the folder
    #[arg(long)]
    pub force: bool,
    /// Keep the preload in this folder, and take it from there if a run with the same has been
    #[arg(long, value_name = "DIR")]
    pub preload_cache: Option<PathBuf>,
    /// Live as long as standard input is open, and print progress: how a sweep holds its runs
    #[arg(long, hide = true)]
    pub leash: bool,
}

impl RunArgs {
    /// What is laid over the case file.
    pub fn sets(&self) -> Vec<String> {
        let pinned = self.deterministic.then(|| "deterministic=true".to_owned());
        self.sets.iter().cloned().chain(pinned).collect()
    }
}

/// Options of `mesh`.
#[derive(Debug, clap::Args)]
pub struct MeshArgs {
    /// The case file
    #[arg(value_name = "CASE.toml")]
    pub case: PathBuf,
    /// Write the mesh here
    #[arg(long, value_name = "FILE.vtu|FILE.vtkhdf", value_parser = mesh_file)]
    pub out: Option<PathBuf>,
    /// Set a key of the case, for example mesh.zone.size=2e-3; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Options of `bench`.
#[derive(Debug, clap::Args)]
pub struct BenchArgs {
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Instruction set of the element kernels [default: the best of this machine]
    #[arg(long, value_name = "avx512|avx2|fused|portable", value_parser = kernels)]
    pub kernels: Option<Level>,
    /// Set a key of the reference case, for example mesh.zone.size=2e-3; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
    /// Instead of the reference case, a free block of N x N x N elements
    #[arg(long, value_name = "N", value_parser = edge, conflicts_with = "sets")]
    pub block: Option<usize>,
    /// Elements of the block
    #[arg(long, value_name = "one-point|full", value_parser = element, requires = "block",
        default_value = "one-point")]
    pub element: BlockElement,
}

fn edge(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=400) => Ok(n),
        _ => Err("a whole number from 1 to 400 is needed".into()),
    }
}

fn element(text: &str) -> Result<BlockElement, String> {
    [BlockElement::OnePoint, BlockElement::Full]
        .into_iter()
        .find(|element| element.name() == text)
        .ok_or_else(|| "one of one-point, full is needed".into())
}

fn kernels(text: &str) -> Result<Level, String> {
    match Level::named(text) {
        Some(level) if level.available() => Ok(level),
        Some(_) => Err("this machine does not have these instructions".into()),
        None => Err("one of avx512, avx2, fused, portable is needed".into()),
    }
}

pub fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=1024) => Ok(n),
        _ => Err("a whole number from 1 to 1024 is needed".into()),
    }
}

fn mesh_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("vtu" | "vtkhdf") => Ok(path),
        _ => Err("the file's name must end in .vtu or .vtkhdf".into()),
    }
}
