//! `cargo xtask results`: tables and pictures of the documents are what commands gave.
//!
//! A table has a manifest, `docs/results/NAME.toml`: commands, and lines with placeholders for what they
//! leave. What was found is kept beside it, `NAME.json`, and printed from there between the markers of
//! a document.

mod age;
mod extract;
mod instruction_set;
mod manifest;
mod markers;
mod pages;
mod record;
mod steps;
mod template;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::SystemTime;

use self::instruction_set::kernels;
use self::manifest::Manifest;
use self::pages::Tables;
use self::record::{Found, Record};
use self::steps::{Gathered, Runner, sum};
use crate::step::{self, Outcome};

/// What to do with the tables of the documents.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Tables to make anew [default: all but the long ones]
    names: Vec<String>,
    /// List all tables, and what they depend on that changed since they were made
    #[arg(long, conflicts_with = "names")]
    list: bool,
    /// Check that the documents say what the results say, and run nothing
    #[arg(long, conflicts_with_all = ["names", "list"])]
    check: bool,
    /// Print the results into the documents, and run nothing
    #[arg(long, conflicts_with_all = ["names", "list", "check"])]
    print: bool,
    /// Run the commands, and compare with the results instead of keeping what is found
    #[arg(long, conflicts_with_all = ["list", "check", "print"])]
    compare: bool,
    /// Take this program, built from this checkout, instead of building it
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
}

/// The chore.
pub fn results(options: &Options) -> ExitCode {
    let root = step::root();
    let done = if options.list {
        list(&root)
    } else if options.check {
        none(pages::check(&root))
    } else if options.print {
        pages::write(&root)
    } else {
        run(&root, options)
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(faults) => {
            faults.iter().for_each(|fault| eprintln!("error: {fault}"));
            ExitCode::FAILURE
        }
    }
}

/// Makes all long tables that were made before again, and compares; gives what there is to say of it, too.
pub fn compare_long(root: &Path) -> (Outcome, String) {
    let tables = Tables::read(root, &mut Vec::new());
    let long = tables
        .manifests
        .iter()
        .filter(|(name, manifest)| manifest.long && tables.records.contains_key(*name));
    let names: Vec<String> = long.map(|(name, _)| name.clone()).collect();
    if names.is_empty() {
        eprintln!("warning: no long table was made yet");
        return (Outcome::Skipped, String::new());
    }
    let count = names.len();
    let options =
        Options { names, list: false, check: false, print: false, compare: true, program: None };
    let faults = run(root, &options).err().unwrap_or_default();
    faults.iter().for_each(|fault| eprintln!("error: {fault}"));
    if faults.is_empty() {
        return (Outcome::Passed, format!("{count} long tables came out again"));
    }
    (
        Outcome::Failed,
        format!("{count} long tables, faults: {}", faults.join("; ").replace('\n', " ")),
    )
}

/// The commands of all short tables.
pub fn short_commands(root: &Path) -> Vec<String> {
    let short = manifest::all(root, &mut Vec::new()).into_values().filter(|table| !table.long);
    short.flat_map(|table| table.steps).map(|step| step.command).collect()
}

/// The commands of all tables that were made, as their manifests stand.
pub fn made_commands(root: &Path) -> Vec<String> {
    let tables = Tables::read(root, &mut Vec::new());
    let made = tables.manifests.iter().filter(|(name, manifest)| {
        tables.records.get(*name).is_some_and(|record| record.steps == manifest.steps_sum())
    });
    made.flat_map(|(_, manifest)| &manifest.steps).map(|step| step.command.clone()).collect()
}

/// The step of `validate`: documents say what results say, short tables come out again, and ages are told.
pub fn step(root: &Path) -> Outcome {
    let options = Options {
        names: Vec::new(),
        list: false,
        check: false,
        print: false,
        compare: true,
        program: None,
    };
    let done =
        none(pages::check(root)).and_then(|()| run(root, &options)).and_then(|()| list(root));
    let Err(faults) = done else { return Outcome::Passed };
    faults.iter().for_each(|fault| eprintln!("error: {fault}"));
    Outcome::Failed
}

fn none(faults: Vec<String>) -> Result<(), Vec<String>> {
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Runs the commands of tables, and keeps or compares what they give.
fn run(root: &Path, options: &Options) -> Result<(), Vec<String>> {
    let mut faults = Vec::new();
    let tables = Tables::read(root, &mut faults);
    let chosen = chosen(&tables, options).map_err(|problem| vec![problem])?;
    if !faults.is_empty() {
        return Err(faults);
    }
    let runner = runner(root, options, &chosen).map_err(|problem| vec![problem])?;
    // of what the program was built from: long commands outlive commits
    let sources: BTreeMap<&str, Sources> =
        chosen.iter().map(|(name, manifest)| (*name, Sources::of(root, manifest))).collect();
    for (name, manifest) in chosen {
        eprintln!("{name}: {}", manifest.title);
        let done = runner.gather(manifest).and_then(|gathered| match tables.records.get(name) {
            Some(record) if options.compare => compare(manifest, record, &gathered),
            _ => keep(root, name, manifest, &runner, &gathered, &sources[name]),
        });
        if let Err(problem) = done {
            faults.push(format!("table `{name}`: {problem}"));
        }
    }
    if !options.compare
        && let Err(more) = pages::write(root)
    {
        faults.extend(more);
    }
    none(faults)
}

/// The tables to run: those named, else the short ones; to compare, those that were made.
fn chosen<'a>(
    tables: &'a Tables,
    options: &'a Options,
) -> Result<BTreeMap<&'a str, &'a Manifest>, String> {
    if options.names.is_empty() {
        let made = |name: &String| !options.compare || tables.records.contains_key(name);
        let short = tables.manifests.iter().filter(|(name, table)| !table.long && made(name));
        return Ok(short.map(|(name, manifest)| (name.as_str(), manifest)).collect());
    }
    let named = options.names.iter().map(|name| {
        let manifest = tables.manifests.get(name);
        let manifest = manifest.ok_or(format!("there is no {}/{name}.toml", manifest::FOLDER))?;
        if options.compare && !tables.records.contains_key(name) {
            return Err(format!("table `{name}` was not made yet"));
        }
        Ok((name.as_str(), manifest))
    });
    named.collect()
}

/// What runs commands: the program just built, or the one named.
fn runner<'a>(
    root: &'a Path,
    options: &Options,
    chosen: &BTreeMap<&str, &Manifest>,
) -> Result<Runner<'a>, String> {
    let program = match &options.program {
        Some(program) => program.clone(),
        None => step::built(root, "creepage").ok_or("the program cannot be built")?,
    };
    let mut steps = chosen.values().flat_map(|manifest| &manifest.steps);
    let python = match steps.any(|step| step.command.starts_with("python ")) {
        true => Some(step::python(root)?),
        false => None,
    };
    let python = python.as_deref().and_then(Path::parent);
    // a comparison with what was kept would compare results with themselves
    let since = if options.compare { SystemTime::now() } else { SystemTime::UNIX_EPOCH };
    Runner::new(root, &step::target(root), &program, python, since)
}

fn compare(manifest: &Manifest, record: &Record, gathered: &Gathered) -> Result<(), String> {
    let found = Found::take(manifest, &gathered.documents)?;
    let same = record.kernels == kernels();
    let differences = record.found.differences(&found, manifest, same);
    if differences.is_empty() { Ok(()) } else { Err(differences.join("\n  ")) }
}

/// What a table depends on, as it is now.
struct Sources {
    /// The last commit that changed it.
    commit: String,
    /// What of it is changed and not committed.
    uncommitted: Vec<String>,
}

impl Sources {
    fn of(root: &Path, manifest: &Manifest) -> Self {
        Self {
            commit: age::last_change(root, &manifest.depends).unwrap_or_default(),
            uncommitted: age::uncommitted(root, &manifest.depends),
        }
    }
}

/// Keeps what was found, with the pictures.
fn keep(
    root: &Path,
    name: &str,
    manifest: &Manifest,
    runner: &Runner,
    gathered: &Gathered,
    sources: &Sources,
) -> Result<(), String> {
    let found = Found::take(manifest, &gathered.documents)?;
    found.print(manifest)?;
    let mut pictures = BTreeMap::new();
    for picture in &manifest.pictures {
        let told = |error: std::io::Error| format!("{}: {error}", picture.from);
        fs::copy(root.join(&picture.from), root.join(&picture.to)).map_err(told)?;
        pictures.insert(picture.to.clone(), sum(&root.join(&picture.to))?);
    }
    let record = Record {
        date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        steps: manifest.steps_sum(),
        commit: sources.commit.clone(),
        uncommitted: sources.uncommitted.clone(),
        version: runner.version()?,
        program: runner.program.clone(),
        kernels: kernels().to_owned(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        cases: gathered.cases.clone(),
        found,
        pictures,
    };
    record.write(root, name)
}

/// Names all tables with their age.
fn list(root: &Path) -> Result<(), Vec<String>> {
    let mut faults = Vec::new();
    let tables = Tables::read(root, &mut faults);
    for (name, manifest) in &tables.manifests {
        let length = if manifest.long { "long" } else { "short" };
        let age = tables.records.get(name).map_or("not made yet".into(), |record| {
            let day = record.date.split('T').next().unwrap_or_default();
            let changes = age::changes_since(root, &record.commit, &record.date, &manifest.depends);
            match changes.as_deref() {
                Some([]) if !record.uncommitted.is_empty() => {
                    format!("{day}, made with changes that were not committed")
                }
                None => format!("{day}, of unknown age: there is no git repository"),
                Some([]) => format!("{day}, as new as what it depends on"),
                Some([newest, ..]) => {
                    let number = changes.as_ref().map_or(0, Vec::len);
                    format!("{day}, older than {number} changes, the last: {newest}")
                }
            }
        });
        println!("{length:<6} {name:<28} {age}");
    }
    none(faults)
}
