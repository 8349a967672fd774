//! A step of the checks: how it ends, and the commands that it runs.

use std::env;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// How a step ended where nothing is wrong.
pub enum Outcome {
    /// All is well.
    Passed,
    /// This machine lacks what the step needs.
    Skipped,
}

/// How a step ended, or what is wrong.
pub type Ended = Result<Outcome, String>;

/// A check of the project, given its root folder.
pub type Step = fn(&Path) -> Ended;

/// Runs one step.
pub fn alone(step: impl FnOnce(&Path) -> Ended) -> ExitCode {
    match step(&root()) {
        Ok(Outcome::Passed) => ExitCode::SUCCESS,
        Ok(Outcome::Skipped) => ExitCode::FAILURE,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}

/// Makes a file, and says where it is.
pub fn made(make: impl FnOnce(&Path) -> Result<PathBuf, String>) -> ExitCode {
    alone(|root| {
        println!("{}", make(root)?.display());
        Ok(Outcome::Passed)
    })
}

/// The root folder of the project.
pub fn root() -> PathBuf {
    // Asked at run time: clones that share a target folder share this program as well.
    let home = env::var_os("CARGO_MANIFEST_DIR").unwrap_or(env!("CARGO_MANIFEST_DIR").into());
    Path::new(&home).parent().unwrap_or(Path::new(".")).to_path_buf()
}

/// Passes without faults.
pub fn without(faults: &[String]) -> Ended {
    if faults.is_empty() { Ok(Outcome::Passed) } else { Err(faults.join("\nerror: ")) }
}

/// Something is missing on this machine; the continuous integration must have it.
pub fn missing(problem: String, what: &str) -> Ended {
    if env::var_os("CI").is_some() {
        return Err(problem);
    }
    skipped(&format!("{problem}; {what}"))
}

/// Says why a step is not made.
pub fn skipped(why: &str) -> Ended {
    eprintln!("warning: {why} was skipped");
    Ok(Outcome::Skipped)
}

/// How Python installs packages, quietly.
pub const PIP: [&str; 5] = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];

/// The interpreter of a virtual environment under the target folder with the requirements of
/// the checks, made on the first call.
pub fn python(root: &Path) -> Result<PathBuf, String> {
    let venv = target(root).join("python");
    let bin = venv.join(if cfg!(windows) { "Scripts" } else { "bin" });
    let python = bin.join(if cfg!(windows) { "python.exe" } else { "python" });
    let requirements = root.join("tests/python/requirements.txt");
    let wanted = fs::read(&requirements)
        .map_err(|error| format!("{} cannot be read: {error}", requirements.display()))?;
    let installed = venv.join("requirements.txt");
    if fs::read(&installed).is_ok_and(|installed| installed == wanted) {
        return Ok(python);
    }
    let system = if cfg!(windows) { "python" } else { "python3" };
    done(Command::new(system).args(["-m", "venv", "--clear"]).arg(&venv)).map_err(|problem| {
        format!("{problem} (on Debian and Ubuntu: apt-get install python3-venv)")
    })?;
    // most of what is installed is never run
    done(Command::new(&python).args(PIP).args(["--no-compile", "-r"]).arg(&requirements))?;
    fs::write(&installed, wanted).map_err(|error| error.to_string())?;
    Ok(python)
}

/// The target folder; cargo itself gives it the same place.
pub fn target(root: &Path) -> PathBuf {
    match env::var_os("CARGO_TARGET_DIR") {
        Some(folder) => root.join(folder),
        None => root.join("target"),
    }
}

/// Runs cargo to its end.
pub fn cargo(root: &Path, args: &[&str], vars: &[(&str, &str)]) -> Ended {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    done(Command::new(cargo).args(args).envs(vars.iter().copied()).current_dir(root))
}

/// A program of the workspace, built with everything that the README's test command builds: another selection of
/// packages has other features of its dependencies, and would compile most of them again.
pub fn built(root: &Path, name: &str) -> Result<PathBuf, String> {
    cargo(root, &["test", "--release", "--workspace", "--no-run", "--quiet"], &[])?;
    Ok(target(root).join("release").join(format!("{name}{}", env::consts::EXE_SUFFIX)))
}

/// Of how many parts of the long tests and of the verification problems the continuous integration takes one.
pub const PARTS: usize = 6;

/// Which part that is, by the last commit; `None` elsewhere, where all are made.
pub fn part(root: &Path) -> Option<usize> {
    env::var_os("CI")?;
    let commit = output(Command::new("git").args(["rev-parse", "HEAD"]).current_dir(root));
    Some(commit.unwrap_or_default().bytes().map(usize::from).sum::<usize>() % PARTS)
}

/// The part for programs of tests, which read it from this variable: `K/N`.
pub fn sample_variable(root: &Path) -> Option<(&'static str, String)> {
    part(root).map(|part| ("CREEPAGE_SAMPLE", format!("{part}/{PARTS}")))
}

/// Runs a command to its end.
pub fn done(command: &mut Command) -> Ended {
    match command.status() {
        Ok(status) if status.success() => Ok(Outcome::Passed),
        Ok(status) => Err(format!("{command:?}: {status}")),
        Err(error) => Err(format!("{command:?}: {error}")),
    }
}

/// What a command prints, if it ends well.
pub fn output(command: &mut Command) -> Result<String, String> {
    match command.stderr(Stdio::inherit()).output() {
        Ok(output) if output.status.success() => {
            Ok(String::from_utf8_lossy(&output.stdout).into_owned())
        }
        Ok(output) => Err(format!("{command:?}: {}", output.status)),
        Err(error) => Err(format!("{command:?}: {error}")),
    }
}

/// The path on which programs are looked for, `folders` first.
pub fn search(folders: impl IntoIterator<Item = PathBuf>) -> Result<OsString, String> {
    let before = env::var_os("PATH").unwrap_or_default();
    let all = folders.into_iter().chain(env::split_paths(&before));
    env::join_paths(all).map_err(|error| error.to_string())
}

/// Runs a script of bash in a folder, with the programs of `search`; gives what it prints if it ends with the code
/// `wanted`.
pub fn bash(
    script: &str,
    folder: &Path,
    search: &OsStr,
    vars: &[(&str, &OsStr)],
    wanted: i32,
) -> Result<String, String> {
    let mut bash = Command::new("bash");
    // the first command that fails ends it; pictures need no screen
    bash.args(["-euo", "pipefail", "-c", script]).env("PATH", search).env("MPLBACKEND", "agg");
    bash.envs(vars.iter().copied()).current_dir(folder).stdin(Stdio::null());
    let output = bash.output().map_err(|error| format!("bash: {error}"))?;
    let [printed, told] =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    match output.status.code().unwrap_or(-1) {
        code if code == wanted => Ok(printed),
        code => Err(format!("exit code {code} instead of {wanted}\n{printed}{told}")),
    }
}

/// The files below a folder in order, apart from hidden ones, what is built, and the runs that lie in it.
pub fn files(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let is_ours = |entry: &walkdir::DirEntry| {
        let name = entry.file_name().to_string_lossy();
        let is_run = entry.depth() == 1 && name == "runs";
        entry.depth() == 0 || !(name.starts_with('.') || name == "target" || is_run)
    };
    let entries = walkdir::WalkDir::new(folder).sort_by_file_name().into_iter();
    let ours = entries.filter_entry(is_ours).filter_map(Result::ok);
    ours.filter(|entry| entry.file_type().is_file()).map(walkdir::DirEntry::into_path)
}

/// Copies these files of a folder.
pub fn copy(from: &Path, to: &Path) -> io::Result<()> {
    for file in files(from) {
        let to = to.join(file.strip_prefix(from).unwrap_or(&file));
        fs::create_dir_all(to.with_file_name(""))?;
        fs::copy(file, to)?;
    }
    Ok(())
}
