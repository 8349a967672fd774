//! Runs the commands of a table and reads what they leave.
//!
//! Runs, sweeps and verifications of this very program with these very inputs are not repeated: beside what a
//! command left lies the sum of the program, of the command and of all that cases are made of.

use std::collections::BTreeMap;
use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Instant, SystemTime};

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::extract::{document, table};
use super::instruction_set::kernels;
use super::manifest::{Manifest, Step};

/// What runs, sweeps and verifications read.
const INPUTS: [&str; 2] = ["cases", "meshes"];

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

/// What a table's commands gave.
#[derive(Default)]
pub struct Gathered {
    /// By the name of the step.
    pub documents: BTreeMap<String, Value>,
    /// SHA-256 of the resolved case of each run, by its file.
    pub cases: BTreeMap<String, String>,
}

/// What a command left when it ran.
#[derive(Deserialize, Serialize)]
struct Kept {
    key: String,
    said: String,
    read: Option<String>,
}

impl<'a> Runner<'a> {
    /// A runner of `program`; what it keeps lies below `target`. Commands find `python` in its folder.
    /// What commands left before `since` is not taken.
    pub fn new(
        root: &'a Path,
        target: &Path,
        program: &Path,
        python: Option<&Path>,
        since: SystemTime,
    ) -> Result<Self, String> {
        let mut inputs = Sha256::new();
        for folder in INPUTS {
            add(&mut inputs, &root.join(folder)).map_err(|error| format!("{folder}: {error}"))?;
        }
        let kept = target.join("results");
        fs::create_dir_all(&kept).map_err(|error| format!("{}: {error}", kept.display()))?;
        let (sum, folder) = own_copy(program, &kept)?;
        let folders = [Some(folder.as_path()), python].into_iter().flatten().map(Path::to_owned);
        let before = env::var_os("PATH").unwrap_or_default();
        let search = env::join_paths(folders.chain(env::split_paths(&before)))
            .map_err(|error| error.to_string())?;
        Ok(Self { root, kept, search, program: sum, inputs: hexadecimal(inputs), since })
    }

    /// The program's version.
    pub fn version(&self) -> Result<String, String> {
        let said = self.execute("creepage --version", 0)?;
        Ok(said.trim().trim_start_matches("creepage ").to_owned())
    }

    /// Runs the steps of a manifest.
    pub fn gather(&self, manifest: &Manifest) -> Result<Gathered, String> {
        let mut gathered = Gathered::default();
        for step in &manifest.steps {
            let at = |problem: String| format!("step `{}`: {problem}", step.name);
            let document = self.step(step).map_err(at)?;
            gathered.documents.insert(step.name.clone(), document);
            for case in after(step, "--out").iter().flat_map(|folder| self.cases_of(folder)) {
                gathered.cases.insert(case.clone(), sum(&self.root.join(case))?);
            }
        }
        Ok(gathered)
    }

    /// Runs a step, or finds that it ran, and reads what it left.
    fn step(&self, step: &Step) -> Result<Value, String> {
        let key = text_sum(&[&self.program, &self.inputs, kernels(), &step.command]);
        let file = self.kept.join(format!("{}.json", text_sum(&[&step.command])));
        let read = step.read.as_ref().map(|read| self.root.join(read));
        let said = match self.kept(step, &file, &key, read.as_deref()) {
            Some(said) => said,
            None => {
                eprintln!("  {}", step.command);
                let start = Instant::now();
                let said = self.execute(&step.command, step.exit)?;
                eprintln!("    {:.1} s", start.elapsed().as_secs_f64());
                let read = read.as_deref().map(sum).transpose()?;
                let kept = Kept { key, said, read };
                let text = serde_json::to_string(&kept).map_err(|error| error.to_string())?;
                fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))?;
                kept.said
            }
        };
        let Some(read) = read else { return Ok(document(&said)) };
        let told = |error: String| format!("{}: {error}", read.display());
        let text = fs::read_to_string(&read).map_err(|error| told(error.to_string()))?;
        if read.extension().is_some_and(|extension| extension == "csv") {
            return table(&text).map_err(|error| told(error.to_string()));
        }
        serde_json::from_str(&text).map_err(|error| told(error.to_string()))
    }

    /// The resolved cases of a run or of a sweep in a folder.
    fn cases_of(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.root.join(folder).join("cases")).into_iter().flatten();
        let names = entries.flatten().map(|entry| entry.file_name());
        let of_sweep = names.map(|name| format!("{folder}/cases/{}", name.to_string_lossy()));
        let cases = of_sweep.chain([format!("{folder}/case.toml")]);
        cases.filter(|case| self.root.join(case).is_file()).collect()
    }

    /// What a step said, if it ran with the same program and inputs and its file is as it left it, with the
    /// pictures that it drew.
    fn kept(&self, step: &Step, file: &Path, key: &str, read: Option<&Path>) -> Option<String> {
        let long = ["run", "sweep", "verify"];
        if !long.iter().any(|word| step.command.starts_with(&format!("creepage {word} "))) {
            return None;
        }
        let left = file.metadata().and_then(|file| file.modified()).ok()?;
        let drawn = after(step, "--plot").iter().all(|folder| self.root.join(folder).exists());
        if left < self.since || !drawn {
            return None;
        }
        let kept: Kept = serde_json::from_str(&fs::read_to_string(file).ok()?).ok()?;
        let same = kept.key == key && kept.read == read.map(sum).transpose().ok()?;
        same.then_some(kept.said)
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

/// The sum of the program, and the folder of a copy of it: a build meanwhile changes the program that others
/// run, not the one that the results name.
fn own_copy(program: &Path, kept: &Path) -> Result<(String, PathBuf), String> {
    let told = |error: std::io::Error| format!("{}: {error}", program.display());
    let folder = kept.join("program");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(told)?;
    }
    fs::create_dir_all(&folder).map_err(told)?;
    let copy = folder.join(format!("creepage{}", env::consts::EXE_SUFFIX));
    fs::copy(program, &copy).map_err(told)?;
    let folder = folder.canonicalize().map_err(told)?;
    Ok((sum(&copy)?, folder))
}

/// The files and folders that a step's command names after an option.
fn after(step: &Step, option: &str) -> Vec<String> {
    let words = crate::shell::commands(&step.command).concat();
    let pairs = words.windows(2).filter(|pair| pair[0] == option);
    pairs.map(|pair| pair[1].clone()).collect()
}

/// Adds names and contents of the files of a folder, in order.
fn add(sum: &mut Sha256, folder: &Path) -> std::io::Result<()> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    paths.sort();
    for path in paths {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.starts_with(['.', '_']) {
            continue;
        }
        sum.update(format!("{name}\n"));
        if path.is_dir() {
            add(sum, &path)?;
        } else {
            sum.update(Sha256::digest(fs::read(&path)?));
        }
    }
    Ok(())
}

/// SHA-256 of a file.
pub fn sum(file: &Path) -> Result<String, String> {
    let bytes = fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    Ok(hexadecimal(Sha256::new_with_prefix(bytes)))
}

fn text_sum(parts: &[&str]) -> String {
    hexadecimal(Sha256::new_with_prefix(parts.join("\n")))
}

fn hexadecimal(sum: Sha256) -> String {
    sum.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(all(test, unix))]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::os::unix::fs::PermissionsExt;

    use super::*;

    /// A project in a folder of its own whose program counts its calls.
    struct Project(PathBuf);

    impl Project {
        fn new(name: &str) -> Self {
            let root =
                env::temp_dir().join(format!("creepage-steps-{name}-{}", std::process::id()));
            for folder in INPUTS {
                fs::create_dir_all(root.join(folder)).unwrap();
            }
            let project = Self(root);
            project.program("echo x >> calls; echo '{\"n\": 1}' | tee out.json; exit 1");
            project
        }

        fn program(&self, text: &str) {
            let file = self.0.join("creepage");
            fs::write(&file, format!("#!/bin/sh\n{text}\n")).unwrap();
            fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
        }

        fn step(&self, command: &str, read: Option<&str>, exit: i32) -> Result<Value, String> {
            let step = Step {
                name: "a".into(),
                command: command.into(),
                read: read.map(Into::into),
                exit,
                chaotic: false,
            };
            let target = self.0.join("target");
            Runner::new(&self.0, &target, &self.0.join("creepage"), None, SystemTime::UNIX_EPOCH)?
                .step(&step)
        }

        fn calls(&self) -> usize {
            fs::read_to_string(self.0.join("calls")).unwrap_or_default().lines().count()
        }
    }

    impl Drop for Project {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_run_is_repeated_where_program_inputs_or_its_file_changed_and_not_otherwise() {
        let project = Project::new("repeat");
        let run = || project.step("creepage run a.toml", Some("out.json"), 1).unwrap();
        assert_eq!(run()["n"], 1);
        run();
        assert_eq!(project.calls(), 1);
        fs::write(project.0.join("cases/a.toml"), "changed").unwrap();
        run();
        assert_eq!(project.calls(), 2, "an input changed");
        fs::write(project.0.join("out.json"), "{\"n\": 2}").unwrap();
        assert_eq!((run()["n"].as_i64(), project.calls()), (Some(1), 3), "its file changed");
        project.program("echo y >> calls; echo '{\"n\": 1}' | tee out.json; exit 1");
        run();
        assert_eq!(project.calls(), 4, "the program changed");
    }

    #[test]
    fn a_verification_whose_pictures_are_gone_is_repeated() {
        let project = Project::new("plot");
        project.program("echo x >> calls; mkdir -p runs/p; echo '{\"n\": 1}'");
        let verify = || project.step("creepage verify a --json --plot runs/p", None, 0).unwrap();
        verify();
        verify();
        assert_eq!(project.calls(), 1);
        fs::remove_dir_all(project.0.join("runs/p")).unwrap();
        verify();
        assert_eq!(project.calls(), 2);
    }

    #[test]
    fn a_program_that_is_built_anew_meanwhile_does_not_take_part() {
        let project = Project::new("meanwhile");
        let (program, target) = (project.0.join("creepage"), project.0.join("target"));
        let runner =
            Runner::new(&project.0, &target, &program, None, SystemTime::UNIX_EPOCH).unwrap();
        let before = sum(&program).unwrap();
        project.program("echo other");
        let said = runner.execute("creepage run a.toml", 1).unwrap();
        assert_eq!((said.as_str(), &runner.program), ("{\"n\": 1}\n", &before));
    }

    #[test]
    fn what_was_kept_before_a_comparison_began_is_made_anew() {
        let project = Project::new("compare");
        let step = || project.step("creepage run a.toml", None, 1);
        step().unwrap();
        let later = SystemTime::now() + std::time::Duration::from_secs(60);
        let (target, program) = (project.0.join("target"), project.0.join("creepage"));
        let manifest = Manifest::read(
            "title = \"A\"\ndepends = [\"a\"]\ntolerance = { relative = 0.0, absolute = 0.0 }\n\
             [[step]]\nname = \"a\"\ncommand = \"creepage run a.toml\"\nexit = 1\n",
        );
        let runner = Runner::new(&project.0, &target, &program, None, later).unwrap();
        runner.gather(&manifest.unwrap()).unwrap();
        assert_eq!(project.calls(), 2);
    }

    #[test]
    fn what_reads_runs_is_always_done_again() {
        let project = Project::new("check");
        for _ in 0..2 {
            assert_eq!(project.step("creepage check runs/a --json", None, 1).unwrap()["n"], 1);
        }
        assert_eq!(project.calls(), 2);
    }

    #[test]
    fn the_cases_of_runs_and_of_sweeps_are_summed() {
        let project = Project::new("cases");
        project.program(
            "mkdir -p runs/s/cases; echo a > runs/s/cases/000.toml; echo b > runs/s/case.toml",
        );
        let manifest = Manifest::read(
            "title = \"A\"\ndepends = [\"a\"]\ntolerance = { relative = 0.0, absolute = 0.0 }\n\
             [[step]]\nname = \"a\"\ncommand = \"creepage sweep a.toml --out runs/s\"\n",
        );
        let target = project.0.join("target");
        let runner = Runner::new(
            &project.0,
            &target,
            &project.0.join("creepage"),
            None,
            SystemTime::UNIX_EPOCH,
        )
        .unwrap();
        let cases = runner.gather(&manifest.unwrap()).unwrap().cases;
        let files: Vec<_> = cases.keys().map(String::as_str).collect();
        assert_eq!(files, ["runs/s/case.toml", "runs/s/cases/000.toml"]);
        assert_eq!(cases["runs/s/case.toml"], text_sum(&["b\n"]));
    }

    #[test]
    fn another_exit_code_is_a_fault() {
        let project = Project::new("exit");
        let error = project.step("creepage check runs/a", None, 0).unwrap_err();
        assert!(error.starts_with("exit code 1 instead of 0"), "{error}");
    }
}
