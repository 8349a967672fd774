//! `creepage report`: one page that needs nothing else.

use crate::planted::{FALLING, perfect, write};
use serde_json::json;
use std::fs;
use std::process::Command;

fn creepage(args: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(args).output().unwrap()
}

/// The page names no address but the name of the SVG language, which nobody fetches.
fn is_self_contained(page: &str) {
    // names of languages, and data
    let no_address = [
        "http://www.w3.org/2000/svg",
        "http://www.w3.org/1999/xhtml",
        "src=\"data:image/png",
        "<script type=\"application/json\"",
    ];
    let bare = no_address.iter().fold(page.to_owned(), |page, words| page.replace(words, ""));
    for reference in ["http://", "https://", "src=\"", "<script ", "@import", "url(/", "<iframe"] {
        assert!(!bare.contains(reference), "{reference}");
    }
    assert_eq!(nesting_error(page), None);
}

/// The first place where tags do not nest, read as a browser reads well-formed pages: elements
/// without content need no end, and what stands in a style sheet or a script is no markup.
fn nesting_error(page: &str) -> Option<String> {
    const EMPTY: [&str; 4] = ["meta", "link", "br", "hr"];
    let mut open: Vec<String> = Vec::new();
    let mut rest = page;
    while let Some(at) = rest.find('<') {
        let end = match rest[at..].find('>') {
            Some(length) => at + length,
            None => return Some(format!("a tag without end: {}", &rest[at..])),
        };
        let tag = &rest[at + 1..end];
        rest = &rest[end + 1..];
        let name: String =
            tag.trim_start_matches('/').chars().take_while(|c| c.is_alphanumeric()).collect();
        if tag.starts_with('!') || tag.ends_with('/') || EMPTY.contains(&name.as_str()) {
            continue;
        }
        if tag.starts_with('/') {
            let last = open.pop();
            if last.as_deref() != Some(&name) {
                return Some(format!("</{name}> closes {last:?}"));
            }
        } else {
            // attributes are quoted in pairs
            if !tag.matches('"').count().is_multiple_of(2) {
                return Some(format!("<{tag}> has an odd quote"));
            }
            if name == "style" || name == "script" {
                rest = &rest[rest.find(&format!("</{name}>"))?..];
            }
            open.push(name);
        }
    }
    open.pop().map(|name| format!("<{name}> is not closed"))
}

#[test]
fn tags_that_do_not_nest_are_found() {
    assert_eq!(nesting_error("<p><b class=\"x\">a</b><br></p><!-- < -->"), None);
    for bad in ["<p><b></p></b>", "<p>", "</p>", "<p", "<p class=\"></p>"] {
        assert!(nesting_error(bad).is_some(), "{bad}");
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
        "No node is under tension.",
        "figure-4-bound",
        "contact-maps",
        "name=\"viewport\"",
        "What happened",
        "download=\"check.json\"",
        "data-line=\"p_{n}, t = ",
        "data-map=\"classes\" data-names=\"stick;slip\"",
        "function heightAt(",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let scripts = page.split("<script").skip(1).map(|rest| rest.split("</script>").next().unwrap());
    let markup = scripts.fold(page.clone(), |page, script| page.replace(script, ""));
    assert_eq!(markup.matches("<svg").count(), 8);
    assert_eq!(markup.matches("class=\"still\"").count(), 1);
    assert!(!markup.contains("NaN"));
}

#[test]
fn the_commands_with_which_a_page_says_to_reproduce_its_run_work_as_printed() {
    let place = tempfile::tempdir().unwrap();
    let in_place = |command: &mut Command| {
        let output = command.current_dir(place.path()).output().unwrap();
        assert!(matches!(output.status.code(), Some(0 | 1)), "{command:?}: {output:?}");
    };
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_creepage"));
    // the case reads a table that is named from its own folder
    let small = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml"));
    fs::create_dir(place.path().join("cases")).unwrap();
    fs::write(place.path().join("cases/small.toml"), small.unwrap()).unwrap();
    fs::write(place.path().join("cases/mu.csv"), "0,0.5\n1,0.4\n").unwrap();
    fs::write(
        place.path().join("cases/x.toml"),
        "extends = \"small.toml\"\ntitle = 'a \"b\"'\n[friction]\nlaw = \"table\"\ntable = \"mu.csv\"\n",
    )
    .unwrap();
    let short = ["--set", "time.roll=0.0005", "--set", "drive.ramp=1e-6"];
    in_place(
        Command::new(program).args(["run", "cases/x.toml", "--out", "runs/a run"]).args(short),
    );
    in_place(Command::new(program).args(["report", "runs/a run"]));
    let page = fs::read_to_string(place.path().join("runs/a run/report.html")).unwrap();
    let commands = page.split("How to reproduce").nth(2).unwrap();
    let commands = commands.split_once("<pre>").unwrap().1.split_once("</pre>").unwrap().0;
    assert_eq!(commands.lines().count(), 4, "{commands}");
    let programs = std::env::join_paths([program.parent().unwrap(), "/usr/bin".as_ref()]).unwrap();
    for line in commands.lines() {
        in_place(Command::new("sh").args(["-c", line]).env("PATH", &programs));
    }
    assert!(place.path().join("runs/a run-again/report.html").exists());
    let of = |folder: &str| {
        let text = fs::read(place.path().join(folder).join("summary.json")).unwrap();
        serde_json::from_slice::<serde_json::Value>(&text).unwrap()["contact"].clone()
    };
    assert_eq!(of("runs/a run"), of("runs/a run-again"));
}

#[test]
fn a_warning_about_the_files_beside_a_history_names_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write(&run, FALLING, "penalty", 20, |x, step| perfect(FALLING, x, step));
    let _ = fs::remove_file(run.join("summary.json"));
    for words in [["check", "contact.vtkhdf"], ["report", "contact.vtkhdf"], ["check", "."]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
        let output = command.args(words).current_dir(&run).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(said.contains("nothing proves that the files in . are whole"), "{words:?}: {said}");
    }
}

#[test]
fn a_page_about_the_records_of_another_program_has_no_commands_to_make_them() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), FALLING, "penalty", 20, |x, step| perfect(FALLING, x, step));
    for of_ours in ["summary.json", "history.h5"] {
        let _ = fs::remove_file(folder.path().join(of_ours));
    }
    assert_eq!(creepage(&["report", folder.path().to_str().unwrap()]).status.code(), Some(0));
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(page.contains("of another program, which alone can make them again"));
    assert!(!page.contains("creepage run "));
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
    let plot = creepage(&["plot", folder.path().to_str().unwrap(), "--json"]);
    assert_eq!(plot.status.code(), Some(0), "{}", String::from_utf8_lossy(&plot.stderr));
    for file in ["measures-mesh-zone-size.svg", "measures-mesh-zone-size.png"] {
        assert!(folder.path().join("figures").join(file).is_file(), "{file}");
    }
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

#[test]
fn a_run_that_failed_is_told_from_a_method_that_violates_the_conditions() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write(&run, FALLING, "penalty", 20, |x, step| perfect(FALLING, x, step));
    let page = |status: &str| {
        let summary = json!({ "status": status, "diagnosis": "the energy grew" });
        fs::write(run.join("summary.json"), summary.to_string()).unwrap();
        assert_eq!(creepage(&["report", run.to_str().unwrap()]).status.code(), Some(0));
        fs::read_to_string(run.join("report.html")).unwrap()
    };
    let failed = "class=\"fail\">The run failed: its own guards stopped it.";
    assert!(page("failed").contains(failed) && page("failed").contains("the energy grew"));
    let completed = page("completed");
    assert!(
        completed.contains("class=\"pass\">The run reached its end.")
            && !completed.contains(failed)
    );
}

#[test]
fn a_folder_of_runs_gets_a_page_that_lists_them() {
    let folder = tempfile::tempdir().unwrap();
    for (name, status) in [("b<i>", "failed"), ("a", "completed")] {
        let run = folder.path().join(name);
        fs::create_dir(&run).unwrap();
        let summary = json!({ "status": status, "contact": { "traction_coefficient": 0.25 } });
        fs::write(run.join("summary.json"), summary.to_string()).unwrap();
    }
    fs::write(folder.path().join("a/report.html"), "").unwrap();
    let output = creepage(&["report", folder.path().to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    is_self_contained(&page);
    for part in ["<a href=\"a/report.html\">a</a>", "0.2500", ">b&lt;i&gt;<", "failed"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(page.find(">a<").unwrap() < page.find(">b&lt;i&gt;<").unwrap(), "by name");
}
