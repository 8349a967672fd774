//! `cargo xtask results`: tables and pictures of the documents are what commands gave.
//!
//! A table has a manifest, `docs/results/NAME.toml`: commands, and lines with placeholders for what they
//! leave. What was found is kept beside it, `NAME.json`, and printed from there between the markers of
//! a document.

mod extract;
mod manifest;
mod pages;
mod record;
mod steps;
mod template;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::SystemTime;

use self::manifest::{FOLDER, Manifest};
use self::pages::Tables;
use self::record::{Found, Record};
use self::steps::{Runner, after, kernels, sum};
use crate::step::{Ended, built, part, python, without};

/// What to do with the tables of the documents.
#[derive(Debug, Default, clap::Args)]
pub struct Options {
    /// Tables to make anew [default: all but the long ones]
    names: Vec<String>,
    /// List all tables, and what they depend on that changed since they were made
    #[arg(long, exclusive = true)]
    list: bool,
    /// Check that the documents say what the results say, and run nothing
    #[arg(long, exclusive = true)]
    check: bool,
    /// Print the results into the documents, and run nothing
    #[arg(long, exclusive = true)]
    print: bool,
    /// Run the commands, and compare with the results instead of keeping what is found
    #[arg(long)]
    compare: bool,
    /// Without names the long tables instead of the short ones
    #[arg(long, conflicts_with = "names")]
    long: bool,
}

/// The chore.
pub fn results(root: &Path, options: &Options) -> Ended {
    without(&if options.list {
        list(root)
    } else if options.check {
        pages::check(root)
    } else if options.print {
        pages::write(root)
    } else {
        run(root, options)
    })
}

/// The step of `validate`: documents say what results say, short tables come out again, and ages are told.
pub fn step(root: &Path) -> Ended {
    let names = part(root).map(|part| sampled(root, part % 3)).unwrap_or_default();
    let compare = Options { compare: true, names, ..Options::default() };
    without(&[pages::check(root), run(root, &compare), list(root)].concat())
}

/// Tables whose runs the commands of the book read.
const READ_LATER: [&str; 3] = ["start-quick", "tutorial-check-a", "tutorial-check-b"];

/// The short tables that the continuous integration makes: those of [`READ_LATER`], and all of a third of the pages,
/// by which their names begin.
fn sampled(root: &Path, third: usize) -> Vec<String> {
    let Tables { mut manifests, records } = Tables::read(root, &mut Vec::new());
    manifests.retain(|name, table| !table.long && records.contains_key(name));
    let page = |name: &str| name.split('-').next().unwrap_or_default().to_owned();
    let pages: BTreeSet<_> = manifests.keys().map(|name| page(name)).collect();
    // the sweep of the tutorial not where `other_machines` takes long
    let chosen: Vec<_> = pages.into_iter().skip((third + 1) % 3).step_by(3).collect();
    let is_made = |name: &String| READ_LATER.contains(&&**name) || chosen.contains(&page(name));
    manifests.into_keys().filter(is_made).collect()
}

/// The folders of the runs and sweeps that short tables make.
pub fn short_folders(root: &Path) -> Vec<String> {
    let manifests = Tables::read(root, &mut Vec::new()).manifests;
    let steps = manifests.values().filter(|table| !table.long).flat_map(|table| &table.steps);
    steps.filter_map(|step| Some(after(&step.command, "--out")?.to_owned())).collect()
}

/// Runs the commands of tables, and keeps or compares what they give.
fn run(root: &Path, options: &Options) -> Vec<String> {
    let mut faults = Vec::new();
    let tables = Tables::read(root, &mut faults);
    let is_known = |name: &String| {
        let made = || !options.compare || tables.records.contains_key(name);
        tables.manifests.contains_key(name) && made()
    };
    let is_chosen = |name: &String, table: &Manifest| match options.names.is_empty() {
        true => table.long == options.long && is_known(name),
        false => options.names.contains(name),
    };
    let unknown = options.names.iter().filter(|name| !is_known(name));
    faults.extend(unknown.map(|n| format!("there is no table `{n}`, or it was not made yet")));
    if !faults.is_empty() {
        return faults;
    }
    let chosen = tables.manifests.iter().filter(|(name, table)| is_chosen(name, table)).collect();
    let runner = match runner(root, &chosen) {
        Ok(runner) => runner,
        Err(problem) => return vec![problem],
    };
    // with the commit of what the program was built from: long commands outlive commits
    let begun: Vec<Record> =
        chosen.values().map(|manifest| begun(root, manifest, &runner.program)).collect();
    for ((name, manifest), record) in chosen.into_iter().zip(begun) {
        eprintln!("{name}: {}", manifest.title);
        let found = runner.gather(manifest).and_then(|documents| Found::take(manifest, &documents));
        let done = found.and_then(|found| match tables.records.get(name) {
            Some(old) if options.compare => {
                let differences =
                    old.found.differences(&found, manifest, old.kernels == record.kernels);
                if differences.is_empty() { Ok(()) } else { Err(differences.join("\n  ")) }
            }
            _ => keep(root, name, manifest, Record { found, ..record }),
        });
        faults.extend(done.err().map(|problem| format!("table `{name}`: {problem}")));
    }
    if !options.compare {
        faults.extend(pages::write(root));
    }
    faults
}

/// What runs the commands of these tables.
fn runner<'a>(root: &'a Path, chosen: &BTreeMap<&String, &Manifest>) -> Result<Runner<'a>, String> {
    let program = built(root, "creepage")?;
    let mut steps = chosen.values().flat_map(|manifest| &manifest.steps);
    let needs_python = steps.any(|step| step.command.starts_with("python "));
    let python = needs_python.then(|| python(root)).transpose()?;
    Runner::new(root, &program, python.as_deref())
}

/// A record of a table whose commands begin now, without what they will give.
fn begun(root: &Path, manifest: &Manifest, program: &str) -> Record {
    let commit = git(root, &["log", "-1", "--format=%H"], &manifest.depends).unwrap_or_default();
    let changed = git(root, &["status", "--porcelain"], &manifest.depends).unwrap_or_default();
    Record {
        date: String::new(),
        steps: manifest.steps_sum(),
        commit: commit.trim().to_owned(),
        uncommitted: changed.lines().filter_map(|line| Some(line.get(3..)?.to_owned())).collect(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        program: program.to_owned(),
        kernels: kernels().to_owned(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        found: Found::default(),
        pictures: BTreeMap::new(),
    }
}

/// Keeps what was found, with the pictures.
fn keep(root: &Path, name: &str, manifest: &Manifest, mut record: Record) -> Result<(), String> {
    record.found.print(manifest)?;
    for picture in &manifest.pictures {
        let to = root.join(&picture.to);
        let sum = fs::copy(root.join(&picture.from), &to).and_then(|_| sum(&to));
        let sum = sum.map_err(|error| format!("{}: {error}", picture.from))?;
        record.pictures.insert(picture.to.clone(), sum);
    }
    record.date = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    let text = serde_json::to_string_pretty(&record).map_err(|error| error.to_string())?;
    let file = root.join(FOLDER).join(format!("{name}.json"));
    fs::write(&file, text + "\n").map_err(|error| format!("{}: {error}", file.display()))
}

/// Names all tables with their age.
fn list(root: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    let tables = Tables::read(root, &mut faults);
    for (name, manifest) in &tables.manifests {
        let length = if manifest.long { "long" } else { "short" };
        let age = tables.records.get(name).map(|record| age(root, manifest, record));
        println!("{length:<6} {name:<28} {}", age.unwrap_or_else(|| "not made yet".into()));
    }
    faults
}

/// The day when a table was made, and how often what it depends on was changed since its commands began.
fn age(root: &Path, manifest: &Manifest, record: &Record) -> String {
    let day = record.date.split('T').next().unwrap_or_default();
    // the commit may have gone with its branch: then the date decides
    let since = [format!("{}..HEAD", record.commit), format!("--since={}", record.date)];
    let log = |since| git(root, &["log", "--format=%h", since], &manifest.depends);
    let changes = since.iter().find_map(|since| log(since)).unwrap_or_default();
    format!("{day}, changes since: {}", changes.lines().count())
}

/// What git says of these paths, if it ends well.
fn git(root: &Path, words: &[&str], paths: &[String]) -> Option<String> {
    let mut command = Command::new("git");
    let output = command.args(words).arg("--").args(paths).current_dir(root).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}
