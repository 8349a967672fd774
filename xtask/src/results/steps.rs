//! Runs the commands of a table and reads what they leave.
//!
//! Runs, sweeps and verifications of this very program with these very inputs are not repeated: beside what a
//! command left lies the sum of the program, of the command and of all that cases are made of.

use std::collections::BTreeMap;
use std::env;
use std::error::Error;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Instant, SystemTime};

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::extract::{document, table};
use super::manifest::{Manifest, Step};

/// Prints sums of what runs, sweeps and verifications read.
const INPUTS: &str = "find cases meshes -type f ! -path '*/[._]*' -exec cksum {} + | sort";

/// The program and what it works on.
pub struct Runner<'a> {
    root: &'a Path,
    kept: PathBuf,
    search: OsString,
    /// SHA-256 of the program's file.
    pub program: String,
    inputs: String,
    /// What commands left before this is made anew.
    since: SystemTime,
}

impl<'a> Runner<'a> {
    /// A runner of `program`. What it keeps lies in the folder `kept`, and what commands left before `since` is not
    /// taken. Commands find `python` in its folder.
    pub fn new(
        root: &'a Path,
        kept: PathBuf,
        program: &Path,
        python: Option<&Path>,
        since: SystemTime,
    ) -> std::io::Result<Self> {
        // a copy of its own: a build meanwhile changes the program that others run, not the one that results name
        let folder = kept.join("program");
        fs::create_dir_all(&folder)?;
        let copy = folder.join(format!("creepage{}", env::consts::EXE_SUFFIX));
        fs::copy(program, &copy)?;
        // which `creepage verify` starts
        let verify = format!("creepage-verify{}", env::consts::EXE_SUFFIX);
        if program.with_file_name(&verify).is_file() {
            fs::copy(program.with_file_name(&verify), folder.join(&verify))?;
        }
        let folders =
            [Some(folder.canonicalize()?), python.map(|python| python.with_file_name(""))];
        let before = env::var_os("PATH").unwrap_or_default();
        let search =
            env::join_paths(folders.into_iter().flatten().chain(env::split_paths(&before)))
                .map_err(std::io::Error::other)?;
        let (program, inputs) = (sum(&copy)?, String::new());
        let mut runner = Self { root, kept, search, program, inputs, since };
        runner.inputs = runner.execute(INPUTS, 0).map_err(std::io::Error::other)?;
        runner.inputs += &sum(&folder.join(verify)).unwrap_or_default();
        Ok(runner)
    }

    /// Runs the steps of a manifest; gives what they left, by their names.
    pub fn gather(&self, manifest: &Manifest) -> Result<BTreeMap<String, Value>, String> {
        let run = |step: &Step| match self.step(step) {
            Ok(document) => Ok((step.name.clone(), document)),
            Err(problem) => Err(format!("step `{}`: {problem}", step.name)),
        };
        manifest.steps.iter().map(run).collect()
    }

    /// Runs a step, or finds that it ran, and reads what it left.
    fn step(&self, step: &Step) -> Result<Value, Box<dyn Error>> {
        let key = sum_of([&self.program, &self.inputs, kernels(), &step.command].join("\n"));
        let file = self.kept.join(key + ".json");
        let read = step.read.as_ref().map(|read| self.root.join(read));
        let said = match self.kept(step, &file, read.as_deref()) {
            Some(said) => said,
            None => {
                eprintln!("  {}", step.command);
                let start = Instant::now();
                let said = self.execute(&step.command, step.exit)?;
                eprintln!("    {:.1} s", start.elapsed().as_secs_f64());
                let read = read.as_deref().map(sum).transpose()?;
                fs::write(&file, json!([said, read]).to_string())?;
                said
            }
        };
        match read {
            None => Ok(document(&said)),
            Some(read) if read.extension().is_some_and(|extension| extension == "csv") => {
                Ok(table(&fs::read_to_string(read)?)?)
            }
            Some(read) => Ok(serde_json::from_str(&fs::read_to_string(read)?)?),
        }
    }

    /// What a step said, if it ran with the same program and inputs and its file is as it left it, with the
    /// pictures that it drew.
    fn kept(&self, step: &Step, file: &Path, read: Option<&Path>) -> Option<String> {
        let command = step.command.strip_prefix("creepage ")?;
        let takes_long = ["run ", "sweep ", "verify "].iter().any(|word| command.starts_with(word));
        let left = file.metadata().and_then(|file| file.modified()).ok()?;
        let drawn = after(command, "--plot").is_none_or(|folder| self.root.join(folder).exists());
        if !takes_long || left < self.since || !drawn {
            return None;
        }
        let kept = fs::read_to_string(file).ok()?;
        let (said, left): (String, Option<String>) = serde_json::from_str(&kept).ok()?;
        (left == read.map(sum).transpose().ok()?).then_some(said)
    }

    /// What a command says, if it ends with this code.
    fn execute(&self, command: &str, exit: i32) -> Result<String, String> {
        let output = Command::new("bash")
            .args(["-c", &format!("set -euo pipefail\n{command}")])
            .env("PATH", &self.search)
            .env("MPLBACKEND", "agg")
            .current_dir(self.root)
            .stdin(Stdio::null())
            .output()
            .map_err(|error| format!("bash: {error}"))?;
        let code = output.status.code().unwrap_or(-1);
        if code == exit {
            return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
        }
        let said = String::from_utf8_lossy(&output.stderr);
        Err(format!("exit code {code} instead of {exit}\n{command}\n{said}"))
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

    use std::os::unix::fs::PermissionsExt;
    use std::time::Duration;

    use super::*;

    /// A project whose program counts its calls.
    struct Project(tempfile::TempDir);

    impl Project {
        fn new() -> Self {
            let project = Self(tempfile::tempdir().unwrap());
            fs::create_dir(project.0.path().join("cases")).unwrap();
            fs::create_dir(project.0.path().join("meshes")).unwrap();
            project.program("echo '{\"n\": 1}' | tee out.json");
            project
        }

        fn program(&self, text: &str) {
            let file = self.0.path().join("creepage");
            fs::write(&file, format!("#!/bin/sh\necho x >> calls\n{text}\n")).unwrap();
            fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
        }

        fn runner(&self, since: SystemTime) -> Runner<'_> {
            let root = self.0.path();
            Runner::new(root, root.join("kept"), &root.join("creepage"), None, since).unwrap()
        }

        /// Runs a command, and says how often the program was called so far.
        fn calls(&self, command: &str, read: Option<&str>, since: SystemTime) -> usize {
            let (name, command) = ("a".into(), command.into());
            let step = Step { name, command, read: read.map(Into::into), exit: 0, chaotic: false };
            assert_eq!(self.runner(since).step(&step).unwrap()["n"], 1);
            fs::read_to_string(self.0.path().join("calls")).unwrap().lines().count()
        }
    }

    #[test]
    fn a_run_is_repeated_where_program_inputs_or_its_file_changed_and_not_otherwise() {
        let project = Project::new();
        let root = project.0.path();
        let calls = |since| project.calls("creepage run a.toml", Some("out.json"), since);
        let long_ago = SystemTime::UNIX_EPOCH;
        assert_eq!((calls(long_ago), calls(long_ago)), (1, 1));
        fs::write(root.join("cases/a.toml"), "changed").unwrap();
        assert_eq!(calls(long_ago), 2, "an input changed");
        fs::write(root.join("out.json"), "{\"n\": 2}").unwrap();
        assert_eq!(calls(long_ago), 3, "its file changed");
        project.program("echo '{\"n\": 1}' > out.json");
        assert_eq!((calls(long_ago), calls(long_ago)), (4, 4), "the program changed");
        assert_eq!(calls(SystemTime::now() + Duration::from_secs(60)), 5, "too old");
    }

    #[test]
    fn what_reads_runs_and_a_verification_whose_pictures_are_gone_are_repeated() {
        let project = Project::new();
        let calls = |command: &str| project.calls(command, None, SystemTime::UNIX_EPOCH);
        let check = "creepage check runs/a --json";
        assert_eq!((calls(check), calls(check)), (1, 2));
        let verify = "creepage verify a --json --plot runs/p";
        assert_eq!((calls(verify), calls(verify)), (3, 4));
        fs::create_dir_all(project.0.path().join("runs/p")).unwrap();
        assert_eq!(calls(verify), 4);
        let error = project.runner(SystemTime::now()).execute(check, 1).unwrap_err();
        assert!(error.starts_with("exit code 0 instead of 1"), "{error}");
    }
}
