//! The commands by their names, and which module does each.

use std::path::PathBuf;

use clap::{Parser, Subcommand};
use creepage::{
    BenchOptions, CasesOptions, CheckOptions, CompareOptions, Error, ExportKOptions, FAILED,
    ImportContactOptions, ImportInpOptions, ImportKOptions, MeshOptions, PlotOptions,
    RenderOptions, ReportOptions, RunOptions, SliderOptions, SweepFound, SweepOptions,
    VerifyOptions, ViewOptions,
};
use serde::Serialize;

use crate::args::Args;
use crate::progress::{Remarks, SliderWatch, SweepWatch};
use crate::report::{self, bench, check, compare, files, mesh, slider};

/// Rolling contact of an elastic disk on an elastic bar, by explicit finite elements.
#[derive(Debug, Parser)]
#[command(
    name = "creepage",
    version,
    arg_required_else_help = true,
    after_help = "Exit codes: 0 done; 1 a check failed; 2 bad input; 3 stopped by the run's own \
                  guards; 130 interrupted.\n\nExamples:\n  creepage run quick\n  \
                  creepage mesh cases/quick.toml --out quick.vtu\n  creepage schema > \
                  case.schema.json\n  creepage check runs/quick\n  creepage report runs/quick"
)]
pub struct Line {
    /// The options that all commands share.
    #[command(flatten)]
    pub args: Args,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to view, and whether in the browser at once.
#[derive(Debug, clap::Args)]
pub struct ViewArgs {
    /// What to view.
    #[command(flatten)]
    options: ViewOptions,
    /// Write the page and start no browser
    #[arg(long)]
    no_open: bool,
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
    Run(RunOptions),
    /// List the reference cases, which are part of this program, or copy some to change them
    #[command(
        after_help = "Examples:\n  creepage cases\n  creepage run quick\n  creepage sweep kt\n  \
        creepage cases zhao-li/b-falling --out mine\n  creepage run mine/zhao-li/b-falling.toml\n\nCommands that take \
        a case or a sweep take these names too; a file of that name goes first."
    )]
    Cases(CasesOptions),
    /// Build the mesh of a case: counts, quality, stable step, memory and run-time estimate
    #[command(after_help = "Examples:\n  creepage mesh cases/quick.toml\n  creepage mesh \
        cases/zhao-li/a-coulomb.toml --set mesh.zone.size=0.5e-3 --out fine.vtkhdf")]
    Mesh(MeshOptions),
    /// Check where and by how much a run violates the contact conditions; exit code 1 beyond a limit
    #[command(after_help = "Examples:\n  creepage check runs/quick\n  creepage check runs/quick \
        --window 1.2e-3:1.5e-3 --limit violating_fraction=0.05\n  creepage check runs/b-falling \
        --map violations.vtkhdf --json > check.json\n  creepage check other-code.vtkhdf --case \
        case.toml --scale approach=1.04e-4\n\nThe measures, their scales and limits: \
        docs/checks.md.")]
    Check(CheckOptions),
    /// Compare runs: slip and shear over place and time, means, statistics, growth of a disturbance
    #[command(
        after_help = "Examples:\n  creepage compare runs/coarse runs/fine\n  creepage compare \
        runs/space-memory/runs/* --plot memory.png\n\nWhat the numbers are: docs/checks.md."
    )]
    Compare(CompareOptions),
    /// Draw the figures of a run (those of the papers, histories, slip over space and time, spectra)
    /// or of a sweep (measures over its axes, profiles, maps)
    #[command(
        after_help = "Examples:\n  creepage plot runs/quick\n  creepage plot runs/b-falling \
        --out figures --format svg\n\nWhat each figure shows: docs/checks.md."
    )]
    Plot(PlotOptions),
    /// Draw a run in three dimensions, deformation magnified: a picture, or a film
    #[command(
        after_help = "Examples:\n  creepage render runs/quick\n  creepage render runs/quick --field pressure \
        --time 1e-3\n  creepage render runs/quick --view contact --magnify 100 --out contact.png\n  creepage render \
        runs/quick --out quick.gif\n\nA PNG shows one record, a GIF or MP4 all. They are drawn by PyVista: \
        pip install 'creepage[render]'. The rigid motion of the disk is not magnified. What the views show: \
        docs/python.md."
    )]
    Render(RenderOptions),
    /// Show the bodies and the contact of a run in the browser: turn, zoom, play, read values
    #[command(
        after_help = "Examples:\n  creepage view runs/quick\n  creepage view runs/quick --out quick.html \
        --no-open\n\nThe page holds its data and works without a network. The scene is that of creepage report."
    )]
    View(ViewArgs),
    /// Write one self-contained HTML page about a run or a sweep: case, numbers, checks, figures
    #[command(after_help = "Examples:\n  creepage report runs/quick\n  creepage report \
        runs/b-falling --out b-falling.html")]
    Report(ReportOptions),
    /// Run a case many times over a grid of parameters: one table, and a report; exit code 1 if a
    /// run fails
    #[command(
        after_help = "Examples:\n  creepage sweep cases/sweeps/kt.toml --jobs 2\n  creepage \
        sweep cases/sweeps/kt.toml --resume\n  creepage sweep cases/sweeps/kt-large.toml --plan \
        runs.sh\n  creepage sweep cases/sweeps/kt-large.toml --collect\n  creepage report \
        runs/kt\n\nCtrl-C ends the runs under way in order; --resume goes on. The sweep file, \
        other engines, results: docs/sweeps.md."
    )]
    Sweep(SweepOptions),
    /// Bring a contact history of another code, as CSV, into the layout that the checks read
    #[command(
        after_help = "Example:\n  creepage import-contact --nodes nodes.csv --faces faces.csv \
        --values values.csv --out contact.vtkhdf\n  creepage check contact.vtkhdf --case case.toml\n\n\
        The columns, with a small example: docs/checks.md."
    )]
    ImportContact(ImportContactOptions),
    /// Make a case and a mesh file of an LS-DYNA keyword file of a disk on a bar
    #[command(
        after_help = "Example:\n  creepage import-k meshes/small.k --unit mm-ton-s --out small\n  \
        creepage run small/case.toml\n\nThe cards that are read, and the keys that they become: \
        docs/ls-dyna.md. All others are refused by file and line."
    )]
    ImportK(ImportKOptions),
    /// Make case files of half-spaces of an input file of CONTACT: a wheel on a rail (module 1), two bodies (module 3)
    #[command(
        after_help = "Example:\n  creepage import-inp mbench_a22_left.inp --case 7 --out left\n  creepage run \
        left/case-7.toml\n\nWhat half-spaces in steady rolling cannot say is refused by its name and line: \
        docs/wheel-rail.md."
    )]
    ImportInp(ImportInpOptions),
    /// Write a case as an LS-DYNA keyword file: the same mesh, contact and drive for another program
    #[command(
        after_help = "Example:\n  creepage export-k cases/zhao-li/b-as-published.toml --out b.k\n\nThe keys, and the \
        cards that they become: docs/ls-dyna.md. A case that keyword files cannot say is refused with a list of the \
        reasons."
    )]
    ExportK(ExportKOptions),
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
    Slider(Box<SliderOptions>),
    /// Run verification problems against their references; exit code 1 if one misses its limit
    #[command(
        after_help = "Examples:\n  creepage verify --list\n  creepage verify hertz-wheel\n  \
        creepage verify --quick --json > verify.json"
    )]
    Verify(VerifyOptions),
    /// Measure the element kernel and whole step on this machine, beside what its memory and arithmetic
    /// allow
    #[command(
        after_help = "Examples:\n  creepage bench --threads 2 --json\n  creepage bench --set \
        mesh.zone.size=0.5e-3 --set contact.enforcement='\"exact\"'\n  creepage bench --block 48 \
        --element full --threads 1"
    )]
    Bench(BenchOptions),
    /// Print the completions of commands and options for a shell
    #[command(after_help = "Examples:\n  creepage completions bash > \
        ~/.local/share/bash-completion/completions/creepage\n  creepage completions fish > \
        ~/.config/fish/completions/creepage.fish")]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page of the program, or of one of its commands
    #[command(
        after_help = "Examples:\n  creepage man | man -l -\n  creepage man run > creepage-run.1\n  \
        creepage man --out ~/.local/share/man/man1"
    )]
    Man {
        /// The command
        command: Option<String>,
        /// Write the pages of the program and of all its commands into this folder
        #[arg(long, conflicts_with = "command")]
        out: Option<PathBuf>,
    },
}

/// Runs the command and returns the exit code.
pub fn dispatch(line: &Line) -> Result<u8, Error> {
    let args = &line.args;
    if args.check_args {
        return check_args(line);
    }
    match &line.command {
        Command::Run(options) => crate::run::command(args, options),
        Command::Cases(options) => done(args, &creepage::cases(options)?, files::cases),
        Command::Mesh(options) => {
            done(args, &creepage::mesh(options, &mut Remarks(args))?, mesh::text)
        }
        Command::Check(options) => {
            let found = creepage::check(options)?;
            args.show(&found.result, || check::text(&found.result));
            Ok(if found.result.pass { 0 } else { FAILED })
        }
        Command::Compare(options) => done(args, &creepage::compare(options)?, compare::text),
        Command::Plot(options) => done(args, &creepage::plot(options)?, files::figures),
        Command::Render(options) => crate::render::command(args, options),
        Command::View(options) => view(args, options),
        Command::Report(options) => done(args, &creepage::report(options)?, files::report),
        Command::Sweep(options) => sweep(args, options),
        Command::ImportContact(options) => {
            done(args, &creepage::import_contact(options)?, files::contact_history)
        }
        Command::ExportK(options) => {
            done(args, &creepage::export_k(options, &mut Remarks(args))?, files::deck)
        }
        Command::ImportK(options) => done(args, &creepage::import_k(options)?, files::case),
        Command::ImportInp(options) => {
            done(args, &creepage::import_inp(options)?, files::inp_cases)
        }
        Command::Schema => {
            report::print_json(&creepage::schema());
            Ok(0)
        }
        Command::Slider(options) => {
            let found = creepage::slider(options, &mut SliderWatch::new(args))?;
            args.show(&found, || slider::text(&found));
            Ok(found.exit_code())
        }
        Command::Verify(options) => crate::verify::command(args, options),
        Command::Bench(options) => done(args, &creepage::bench(options)?, bench::text),
        Command::Completions { shell } => {
            crate::manual::completions(*shell);
            Ok(0)
        }
        Command::Man { out: Some(folder), .. } => crate::manual::pages(folder).map(|()| 0),
        Command::Man { command, out: None } => crate::manual::page(command.as_deref()).map(|()| 0),
    }
}

/// Shows the results of a command that has no verdict.
fn done<T: Serialize>(args: &Args, results: &T, page: fn(&T) -> String) -> Result<u8, Error> {
    args.show(results, || page(results));
    Ok(0)
}

fn view(args: &Args, ViewArgs { options, no_open }: &ViewArgs) -> Result<u8, Error> {
    let viewed = creepage::view(options)?;
    args.show(&viewed, || files::view(&viewed));
    if !no_open && !args.json && open::that_detached(&viewed.page).is_err() {
        args.say("no browser could be started: open the page by hand");
    }
    Ok(0)
}

fn sweep(args: &Args, options: &SweepOptions) -> Result<u8, Error> {
    let done = creepage::sweep(options, &mut SweepWatch::new(args))?;
    args.show(&done.result, || match (&done.result, &done.page, &options.plan) {
        (SweepFound::Result(result), Some(page), _) => {
            report::sweep::text(result, &done.folder, page)
        }
        (.., plan) => plan.iter().map(|plan| format!("{}\n", plan.display())).collect(),
    });
    Ok(done.exit_code())
}

/// Reads what a command would compute from, and computes nothing.
fn check_args(line: &Line) -> Result<u8, Error> {
    let mut remarks = Remarks(&line.args);
    match &line.command {
        Command::Run(RunOptions { case, .. }) | Command::Mesh(MeshOptions { case, .. }) => {
            case.load(&mut remarks).map(|_| 0)
        }
        Command::Sweep(options) => options.load().map(|_| 0),
        _ => Ok(0),
    }
}
