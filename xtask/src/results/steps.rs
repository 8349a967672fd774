//! Runs the commands of tables and reads what they leave.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::env;
use std::error::Error;
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::time::Instant;

use serde_json::Value;
use sha2::{Digest, Sha256};

use super::extract::{document, table};
use super::manifest::{Manifest, Step};
use crate::step::{bash, search, target};

/// The program and what its commands printed so far: one that several tables name runs once.
pub struct Runner<'a> {
    root: &'a Path,
    search: OsString,
    /// SHA-256 of the program's file.
    pub program: String,
    printed: RefCell<BTreeMap<String, String>>,
}

impl<'a> Runner<'a> {
    /// A runner of `program`. Commands find `python` in its folder.
    pub fn new(root: &'a Path, program: &Path, python: Option<&Path>) -> Result<Self, String> {
        // a copy of its own: a build meanwhile changes the program that others run, not the one that results name
        let folder = target(root).join("results");
        let tell = |error: std::io::Error| format!("{}: {error}", folder.display());
        fs::create_dir_all(&folder).map_err(tell)?;
        // `creepage verify` starts the other one
        for name in ["creepage", "creepage-verify"] {
            let name = format!("{name}{}", env::consts::EXE_SUFFIX);
            fs::copy(program.with_file_name(&name), folder.join(name)).map_err(tell)?;
        }
        let python = python.map(|python| python.with_file_name(""));
        let folders = [Some(folder.canonicalize().map_err(tell)?), python];
        let search = search(folders.into_iter().flatten())?;
        let program = sum(program).map_err(tell)?;
        Ok(Self { root, search, program, printed: RefCell::default() })
    }

    /// Runs the steps of a manifest; gives what they left, by their names.
    pub fn gather(&self, manifest: &Manifest) -> Result<BTreeMap<String, Value>, String> {
        let run = |step: &Step| match self.step(step) {
            Ok(document) => Ok((step.name.clone(), document)),
            Err(problem) => Err(format!("step `{}`: {problem}", step.name)),
        };
        manifest.steps.iter().map(run).collect()
    }

    /// Runs a step, unless it ran for another table, and reads what it left.
    fn step(&self, step: &Step) -> Result<Value, Box<dyn Error>> {
        let mut printed = self.printed.borrow_mut();
        if !printed.contains_key(&step.command) {
            eprintln!("  {}", step.command);
            let start = Instant::now();
            let text = bash(&step.command, self.root, &self.search, &[], step.exit)?;
            eprintln!("    {:.1} s", start.elapsed().as_secs_f64());
            printed.insert(step.command.clone(), text);
        }
        let Some(read) = &step.read else { return Ok(document(&printed[&step.command])) };
        let text = fs::read_to_string(self.root.join(read))?;
        Ok(if read.ends_with(".csv") { table(&text)? } else { serde_json::from_str(&text)? })
    }
}

/// The instruction set that the program takes on this machine (`Level::detect` of `creepage-solid`): results of one
/// differ from those of another in their last bits.
pub fn kernels() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if std::is_x86_feature_detected!("avx512f") {
            return "avx512";
        }
        if std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma") {
            return "avx2";
        }
    }
    if cfg!(target_arch = "aarch64") { "neon" } else { "portable" }
}

/// The folders that a command names after an option.
pub fn after<'a>(command: &'a str, option: &str) -> Option<&'a str> {
    command.split_whitespace().skip_while(|word| *word != option).nth(1)
}

/// SHA-256 of a file.
pub fn sum(file: &Path) -> std::io::Result<String> {
    Ok(sum_of(fs::read(file)?))
}

/// SHA-256 of a text.
pub fn sum_of(bytes: impl AsRef<[u8]>) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(all(test, unix))]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_command_of_several_tables_runs_once_and_one_that_fails_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let search = env::var_os("PATH").unwrap();
        let printed = RefCell::default();
        let runner = Runner { root: folder.path(), search, program: String::new(), printed };
        let step = |command: &str, read: Option<&str>| {
            let (name, command, read) = ("a".into(), command.into(), read.map(Into::into));
            runner.step(&Step { name, command, read, exit: 3, chaotic: false })
        };
        let command = "echo '{\"n\": 1}' | tee -a out.json; exit 3";
        assert_eq!(step(command, None).unwrap()["n"], 1);
        assert_eq!(step(command, Some("out.json")).unwrap()["n"], 1, "appended once");
        let error = step("true", None).unwrap_err().to_string();
        assert!(error.starts_with("exit code 0 instead of 3"), "{error}");
    }
}
