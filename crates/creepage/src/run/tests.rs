#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::case::Case;
use friction::OwnLaw;

use crate::run::RunOptions;
use crate::run::folder::{self, FolderError};

const SHORT: &str = "load.normal = 100e3\ndrive.speed = 38.89\ndrive.creepage = 2.4e-3\n\
                     friction.static = 0.5\n";

#[test]
fn a_run_folder_is_taken_only_when_free_or_forced() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("runs/new");
    folder::prepare(&out, false, None).unwrap();
    folder::prepare(&out, false, None).unwrap();
    fs::write(out.join("case.toml"), "x").unwrap();
    fs::write(out.join("history.h5"), "x").unwrap();
    fs::write(out.join("history.h5.partial"), "x").unwrap();
    fs::write(out.join("notes.txt"), "mine").unwrap();
    assert!(matches!(
        folder::prepare(&out, false, None),
        Err(FolderError::Taken { run: true, .. })
    ));
    folder::prepare(&out, true, None).unwrap();
    assert!(!out.join("history.h5").exists() && !out.join("history.h5.partial").exists());
    assert!(
        out.join("case.toml").exists(),
        "a kill now would leave nothing that says of what it is"
    );
    assert!(out.join("notes.txt").exists());
    fs::remove_file(out.join("case.toml")).unwrap();
    assert!(matches!(
        folder::prepare(&out, false, None),
        Err(FolderError::Taken { run: false, .. })
    ));
    let file = dir.path().join("file");
    fs::write(&file, "x").unwrap();
    assert!(matches!(folder::prepare(&file, true, None), Err(FolderError::NotAFolder { .. })));
    assert!(matches!(
        folder::prepare(&file.join("below"), true, None),
        Err(FolderError::NotWritable { .. })
    ));
}

#[test]
fn what_a_kill_leaves_before_the_case_is_written_is_free_for_the_next_run() {
    let left =
        ["run.lock", "run.log", "case.toml.partial", ".creepage-7-0", "fields.vtkhdf.partial"];
    for count in 1..=left.len() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path();
        left[..count].iter().for_each(|name| fs::write(out.join(name), "x").unwrap());
        let case = Case::from_text(SHORT, Path::new("short.toml"), &[]).unwrap();
        let origin = crate::run::resume::resume_from::<crate::run::checkpoint::State>(&case, out);
        assert!(matches!(origin, Ok(crate::run::resume::ResumeFrom::Beginning(_))), "{count}");
        folder::prepare(out, false, None).unwrap();
        let there = fs::read_dir(out).unwrap().map(|entry| entry.unwrap().file_name());
        assert_eq!(there.collect::<Vec<_>>(), ["run.lock"]);
    }
    // with anything else the folder is somebody's
    for name in ["notes.txt", "fields.vtkhdf", "case.toml"] {
        let dir = tempfile::tempdir().unwrap();
        ["run.lock", name].iter().for_each(|name| fs::write(dir.path().join(name), "x").unwrap());
        let refused = folder::prepare(dir.path(), false, None);
        assert!(matches!(refused, Err(FolderError::Taken { .. })), "{name}");
    }
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("run.log"), "what was piped there").unwrap();
    assert!(matches!(folder::prepare(dir.path(), false, None), Err(FolderError::Taken { .. })));
}

#[test]
fn a_run_that_is_replaced_loses_its_word_of_completion_before_its_results() {
    let place = |name: &str| folder::RUN_FILES.iter().position(|file| *file == name).unwrap();
    for result in ["fields.vtkhdf", "contact.vtkhdf", "history.h5", "probes.h5"] {
        for word in ["summary.json", "checkpoint.h5", "checkpoint-1.h5"] {
            assert!(place(word) < place(result), "{word} goes after {result}");
        }
    }
}

#[derive(Debug)]
struct Constant;

impl OwnLaw for Constant {
    fn mu(&self, _: &[f64], mu: &mut [f64]) {
        mu.fill(0.3);
    }

    fn failure(&self) -> Option<String> {
        None
    }
}

#[test]
fn the_function_of_a_law_that_the_case_does_not_use_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("run");
    let case = Case::from_text(SHORT, Path::new("case.toml"), &[]).unwrap();
    let options = RunOptions {
        out: Some(out.clone()),
        law: Some(Arc::new(Constant)),
        ..RunOptions::default()
    };
    let error = crate::run::run(&case, &options, &AtomicBool::new(false), &mut |_| {}).unwrap_err();
    assert!(error.to_string().contains("friction.law = \"coulomb\" does not use"), "{error}");
    assert_eq!(error.exit_code(), 2);
    assert!(!out.exists());
}

#[test]
fn the_mesh_report_estimates_the_time_of_explicit_steps_alone() {
    let case = |more: &str| {
        let text = format!("mesh.zone.size = 4e-3\ncontact.enforcement = \"exact\"\n{SHORT}{more}");
        Case::from_text(&text, Path::new("short.toml"), &[]).unwrap()
    };
    let explicit = crate::run::mesh_report(&case(""), None, None).unwrap();
    assert!(explicit.estimate.run_time_s.unwrap() > 0.0);
    let implicit = "time.integrator = \"implicit\"\ntime.step = 1e-5\n";
    let implicit = crate::run::mesh_report(&case(implicit), None, None).unwrap();
    assert!(implicit.estimate.run_time_s.is_none());
    assert!(implicit.estimate.steps > 0.0);
}
