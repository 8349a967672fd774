//! `cargo xtask wheel`: the wheel of the Python package; its tests, and the notebooks.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::step::{Ended, PIP, done, files, missing, python, sample_variable, search, target};

/// Builds the wheel, for other machines too if `portable`.
pub fn wheel(root: &Path, portable: bool) -> Result<PathBuf, String> {
    let python = python(root)?;
    if !portable {
        return build(root, &python, &[]);
    }
    // the linker of wheels for every Linux with glibc 2.17 or newer, beside maturin
    done(Command::new(&python).args(PIP).arg("ziglang==0.17.1"))?;
    build(root, &python, &["--zig", "--compatibility", "manylinux2014"])
}

/// Builds the wheel, tries it in a clean environment, installs it in that of the checks, and runs the tests of the package
/// and the notebooks there.
pub fn tests(root: &Path) -> Ended {
    let python = match python(root) {
        Ok(python) => python,
        Err(problem) => return missing(problem, "the Python package"),
    };
    let install = ["--force-reinstall", "--no-deps"];
    let wheel = build(root, &python, &[])?;
    // lasso-python asks for pandas below 3, which what is used of it does not need
    done(Command::new(&python).args(PIP).args(install).arg(&wheel).arg("lasso-python==2.0.4"))?;
    done(Command::new(&python).arg(root.join("tests/python/check_wheel.py")).arg(&wheel))?;
    // in the continuous integration a sixth of the longer tests, and one of the notebooks in turn
    let part = sample_variable(root);
    let pytest = ["-m", "pytest", "-q", "-p", "no:cacheprovider"];
    let mut package = Command::new(&python);
    package.args(pytest).envs(part.clone()).current_dir(root.join("crates/python"));
    // `creepage.verify` starts another program
    done(package.env("PATH", search([target(root).join("release")])?))?;
    let folder = root.join("notebooks");
    let notebooks = files(&folder).filter(|file| file.extension() == Some("ipynb".as_ref()));
    let script = root.join("tests/python/notebooks.py");
    done(Command::new(&python).arg(script).args(notebooks).envs(part))
}

/// Builds the wheel into the target folder, the only one in its folder.
fn build(root: &Path, python: &Path, options: &[&str]) -> Result<PathBuf, String> {
    let folder = target(root).join("wheel");
    // what is left of another version would be taken for the wheel
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    let maturin =
        "-m maturin build --release --quiet --compression-level 9 --manifest-path".split(' ');
    let mut command = Command::new(python);
    command.args(maturin).arg(root.join("crates/python/Cargo.toml"));
    command.arg("--interpreter").arg(python).arg("--out").arg(&folder).args(options);
    // maturin looks for zig by the first `python3` on the path
    command.env("PATH", search([python.with_file_name("")])?);
    done(&mut command)?;
    let wheel = fs::read_dir(&folder).map_err(|error| error.to_string())?.flatten().next();
    wheel.map(|wheel| wheel.path()).ok_or_else(|| format!("{} is empty", folder.display()))
}
