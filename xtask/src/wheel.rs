//! `cargo xtask wheel`: the wheel of the Python package; its tests, and the notebooks.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use crate::step::{Outcome, execute, missing, python, root, target};

/// Options of maturin that link for every Linux with glibc 2.17 or newer.
const PORTABLE: [&str; 3] = ["--zig", "--compatibility", "manylinux2014"];

/// Builds the wheel, for other machines too if `portable`, and says where it is.
pub fn wheel(portable: bool) -> ExitCode {
    let root = root();
    let options = if portable { &PORTABLE[..] } else { &[] };
    let built = python(&root).and_then(|python| {
        if portable {
            install_zig(&python)?;
        }
        build(&root, &python, options)
    });
    match built {
        Ok(wheel) => {
            println!("{}", wheel.display());
            ExitCode::SUCCESS
        }
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}

/// Installs the linker of portable wheels beside maturin.
fn install_zig(python: &Path) -> Result<(), String> {
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "ziglang==0.17.1"];
    match execute(Command::new(python).args(pip)) {
        Outcome::Passed => Ok(()),
        _ => Err("pip could not install ziglang".into()),
    }
}

/// Builds the wheel, installs it in the virtual environment of the checks, and runs the tests of the
/// package and the notebooks there.
pub fn tests(root: &Path) -> Outcome {
    let python = match python(root) {
        Ok(python) => python,
        Err(problem) => return missing(&problem, "the Python package"),
    };
    let wheel = match build(root, &python, &[]) {
        Ok(wheel) => wheel,
        Err(problem) => {
            eprintln!("error: {problem}");
            return Outcome::Failed;
        }
    };
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    let install = ["--force-reinstall", "--no-deps"];
    if execute(Command::new(&python).args(pip).args(install).arg(wheel)) != Outcome::Passed {
        return Outcome::Failed;
    }
    let pytest = ["-m", "pytest", "-q", "-p", "no:cacheprovider"];
    let tests = execute(Command::new(&python).args(pytest).current_dir(root.join("crates/python")));
    if tests != Outcome::Passed {
        return tests;
    }
    let mut command = Command::new(&python);
    command.args(pytest).arg("--nbmake").arg(root.join("notebooks")).current_dir(root);
    execute(&mut command)
}

/// Builds the wheel into the target folder, the only one in its folder.
fn build(root: &Path, python: &Path, options: &[&str]) -> Result<PathBuf, String> {
    let folder = target(root).join("wheel");
    if let Err(error) = std::fs::remove_dir_all(&folder)
        && error.kind() != std::io::ErrorKind::NotFound
    {
        return Err(format!("{}: {error}", folder.display()));
    }
    let maturin = ["-m", "maturin", "build", "--release", "--quiet", "--manifest-path"];
    let mut command = Command::new(python);
    command.args(maturin).arg(root.join("crates/python/Cargo.toml"));
    command.arg("--interpreter").arg(python).arg("--out").arg(&folder).args(options);
    // maturin looks for zig by the first `python3` on the path
    let own = python.parent().map(Path::to_owned);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = own.into_iter().chain(std::env::split_paths(&path));
    command.env("PATH", std::env::join_paths(folders).map_err(|error| error.to_string())?);
    if execute(&mut command) != Outcome::Passed {
        return Err("maturin could not build the wheel".into());
    }
    let files = std::fs::read_dir(&folder).map_err(|error| error.to_string())?;
    let mut wheels = files.filter_map(|file| Some(file.ok()?.path()));
    let is_wheel = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "whl");
    wheels.find(is_wheel).ok_or_else(|| format!("there is no wheel in {}", folder.display()))
}
