//! `creepage report`: one page that needs nothing else.
#![allow(clippy::unwrap_used)]

#[allow(dead_code)]
#[path = "../../post/tests/planted/mod.rs"]
mod planted;

use planted::{FALLING, perfect, write};
use serde_json::json;
use std::fs;
use std::process::Command;

fn creepage(args: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(args).output().unwrap()
}

/// The page names no address but the name of the SVG language, which nobody fetches.
fn is_self_contained(page: &str) {
    let bare = page.replace("http://www.w3.org/2000/svg", "");
    for reference in ["http://", "https://", "src=\"", "<script", "@import", "url(/", "<iframe"] {
        assert!(!bare.contains(reference), "{reference}");
    }
    for tag in ["table", "figure", "svg", "tr", "td", "p", "body", "html"] {
        let (opened, closed) = (format!("<{tag}"), format!("</{tag}>"));
        let starts = |end: char| page.matches(&format!("{opened}{end}")).count();
        assert_eq!(starts('>') + starts(' '), page.matches(&closed).count(), "{tag}");
    }
}

#[test]
fn the_page_of_a_run_holds_case_numbers_verdicts_and_figures() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write(&run, FALLING, "penalty", 20, |x, step| perfect(FALLING, x, step));
    let output = creepage(&["report", run.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let page = fs::read_to_string(run.join("report.html")).unwrap();
    is_self_contained(&page);
    for part in [
        "planted",
        "violating_fraction",
        "Dimensionless numbers",
        "How to reproduce",
        "No node is pulled.",
        "figure-4-bound",
        "creepage run case.toml",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(page.matches("<svg").count(), 6);
    assert!(!page.contains("NaN"));
}

#[test]
fn the_page_of_a_sweep_holds_its_table_and_figures() {
    let folder = tempfile::tempdir().unwrap();
    let run = |size: f64, pass: bool| {
        json!({ "parameters": { "mesh.zone.size": size }, "status": "completed", "run": "a",
                "summary": { "contact": { "traction_coefficient": 0.1 * size } },
                "check": { "pass": pass,
                           "metrics": { "violating_fraction": { "value": 0.25 } } } })
    };
    let broken = json!({ "parameters": { "mesh.zone.size": 3.0 }, "status": "failed<b>" });
    let sweep = json!({ "parameters": ["mesh.zone.size"], "runs": [run(1.0, true), run(2.0, false), broken] });
    fs::write(folder.path().join("sweep.json"), sweep.to_string()).unwrap();
    let out = folder.path().join("page.html");
    let args = ["report", folder.path().to_str().unwrap(), "--out", out.to_str().unwrap()];
    assert_eq!(creepage(&args).status.code(), Some(0));
    let page = fs::read_to_string(&out).unwrap();
    is_self_contained(&page);
    for part in ["mesh.zone.size", "0.2500", "failed&lt;b&gt;", ">pass<", ">fail<"] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(page.matches("<svg").count(), 1);
    fs::write(folder.path().join("sweep.json"), "{}").unwrap();
    assert_eq!(creepage(&args).status.code(), Some(2));
}

#[test]
fn a_page_that_cannot_be_made_or_written_ends_with_code_2() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(creepage(&["report", folder.path().to_str().unwrap()]).status.code(), Some(2));
    write(folder.path(), FALLING, "penalty", 2, |x, step| perfect(FALLING, x, step));
    let out = folder.path().join("none/page.html");
    let args = ["report", folder.path().to_str().unwrap(), "--out", out.to_str().unwrap()];
    let output = creepage(&args);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write the page"));
}
