//! `creepage import-contact` on the example of the documentation, and on tables that are wrong.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn example() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/examples/external-contact")
}

fn import(folder: &Path, out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
    command.arg("import-contact");
    for table in ["nodes", "faces", "values"] {
        command.arg(format!("--{table}")).arg(folder.join(format!("{table}.csv")));
    }
    command.arg("--out").arg(out).output().unwrap()
}

#[test]
fn the_example_of_the_documentation_is_imported_and_its_planted_fault_found() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("contact.vtkhdf");
    let output = import(&example(), &out);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("35 nodes, 24 faces, 4 records"));
    let output = Command::new(env!("CARGO_BIN_EXE_creepage"))
        .args(["check", out.to_str().unwrap(), "--json", "--case"])
        .arg(example().join("case.toml"))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let law_error = &found["metrics"]["law_error"];
    // 13 nodes slip, and this one bears 1/9.5 of their area
    assert!((law_error["value"].as_f64().unwrap() - 0.1 / 9.5f64.sqrt()).abs() < 1e-5);
    assert_eq!(law_error["pass"], false);
    let worst = &law_error["where"];
    assert!((worst["value"].as_f64().unwrap() + 0.1).abs() < 1e-5, "{worst}");
    assert_eq!(worst["position"][0], -2e-3);
    assert_eq!(found["metrics"]["direction"]["value"], 0.0);
}

#[test]
fn figures_of_one_body_say_whose_slip_velocity_they_draw() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("contact.vtkhdf");
    assert_eq!(import(&example(), &out).status.code(), Some(0));
    let output = Command::new(env!("CARGO_BIN_EXE_creepage"))
        .args(["plot", out.to_str().unwrap(), "--format", "svg", "--out"])
        .arg(folder.path())
        .arg("--case")
        .arg(example().join("case.toml"))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let figure = fs::read_to_string(folder.path().join("figure-1-velocities.svg")).unwrap();
    assert!(figure.contains("Slip velocity of the bar"));
    assert!(!figure.contains("both bodies"));
}

#[test]
fn the_page_of_imported_records_says_what_they_cannot_show_and_has_the_figures_of_the_papers() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("contact.vtkhdf");
    assert_eq!(import(&example(), &out).status.code(), Some(0));
    let report = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
        command.arg("report").arg(&out).arg("--case").arg(example().join("case.toml"));
        let output = command.args(more).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(folder.path().join("report.html")).unwrap()
    };
    let page = report(&[]);
    assert!(page.contains("The records are of another program."));
    let (_, table) = page.split_once("id=\"not-judged\"").unwrap();
    let (table, _) = table.split_once("</table>").unwrap();
    for row in [
        "<td>penetration, complementarity</td><td>the file has no field gap</td>",
        "<td>mu_error, mu_error_uncertain, law_error_own</td><td>the file has no field mu</td>",
        "<td>creepage</td>",
        "<td>records lie 1.00 \u{3bc}s apart",
        "<td>when rolling is steady</td>",
    ] {
        assert!(table.contains(row), "{row} is not in {table}");
    }
    assert!(!table.contains("law_error,"), "what was measured is not among it: {table}");
    for figure in ["1-velocities", "2-stick-slip", "3-tractions", "4-bound"] {
        assert!(page.contains(&format!("id=\"figure-{figure}\"")), "{figure}");
    }
    assert!(
        report(&["--window", "1e-6:2e-6"]).contains("from 0.0010000 to 0.0020000 ms, in 2 records")
    );
}

#[test]
fn wrong_tables_are_refused_with_file_line_and_reason() {
    for (table, from, to, words) in [
        ("nodes", "x,y,z", "x,y", "no column \"z\""),
        ("faces", "0,5,6,1,1", "0,5,6,99,1", "line 2: there is no node 99"),
        ("faces", "0,5,6,1,1", "0,5,6,1,7", "line 2: there is no body 7"),
        ("values", "pressure", "force", "no column \"pressure\""),
        ("values", "\n3e-06,", "\n0,", "the time falls"),
        ("values", "\n1e-06,", "\nsoon,", "\"soon\" is no number"),
        ("values", "\n1e-06,", "\n1e-06,1,", "CSV error"),
        ("values", "\n0,2,", "\n0,1,", "node 1 stands twice at 0e0 s"),
        ("values", "0.2,0,0,2\n", "0.2,0,0,1.7\n", "there is no state 1.7; they are 0 to 2"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        for name in ["nodes", "faces", "values"] {
            let text = fs::read_to_string(example().join(format!("{name}.csv"))).unwrap();
            let text = if name == table { text.replacen(from, to, 1) } else { text };
            fs::write(folder.path().join(format!("{name}.csv")), text).unwrap();
        }
        let output = import(folder.path(), &folder.path().join("out.vtkhdf"));
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(words) && said.contains(table), "{words:?} is not in:\n{said}");
    }
}

#[test]
fn the_heading_of_a_table_may_be_in_latin_1() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["nodes", "faces", "values"] {
        let text = fs::read_to_string(example().join(format!("{name}.csv"))).unwrap();
        let (heading, rows) = text.trim_end().split_once('\n').unwrap();
        let rows = rows.replace('\n', ",0\n");
        let bytes = [heading.as_bytes(), b",\xb5\n", rows.as_bytes(), b",0\n"].concat();
        fs::write(folder.path().join(format!("{name}.csv")), bytes).unwrap();
    }
    let output = import(folder.path(), &folder.path().join("out.vtkhdf"));
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}
