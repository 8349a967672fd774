//! One evaluation window and one number for each mean over it, in every command and document.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use output::HistoryFile;
use serde_json::Value;

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");

/// Records of contact lie 4 us apart, a short span of them one step: no record lies at an end of the
/// evaluation window, and their plain mean is not that over time.
const SWEEP: &str = "base = \"base.toml\"\n[[axis]]\nkey = \"friction.static\"\nvalues = [0.2, 0.3]\n\
    [set]\noutput.contact_interval = 4e-6\noutput.history_interval = 7\n\
    output.window = [{ from = 2.0e-5, to = 2.04e-5 }]\n";

/// The mean of a measure in the summary, by its place there, and in `patch` of a check.
const MEANS: [(&str, &str); 13] = [
    ("contact/normal_force", "normal_force"),
    ("contact/tangential_force", "tangential_force"),
    ("contact/lateral_force", "lateral_force"),
    ("contact/traction_coefficient", "traction_coefficient"),
    ("contact/creepage", "creepage"),
    ("contact/patch_half_length", "half_length"),
    ("contact/patch_half_width", "half_width"),
    ("contact/patch_area", "area"),
    ("contact/patch_area_fitted", "area_fitted"),
    ("contact/peak_pressure", "peak_pressure"),
    ("contact/stick_fraction", "stick_fraction"),
    ("contact/slip_fraction", "slip_fraction"),
    ("window/peak_shear", "peak_shear"),
];

fn creepage(folder: &Path, args: &[&str]) -> Vec<u8> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
    let output = command.current_dir(folder).args(args).stdin(Stdio::null()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{args:?}: {said}");
    output.stdout
}

fn document(folder: &Path, args: &[&str]) -> Value {
    serde_json::from_slice(&creepage(folder, args)).unwrap()
}

fn number(of: &Value, pointer: &str) -> f64 {
    of.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer} in {of}"))
}

/// The number that a page shows to four digits in the cell behind `before`.
#[track_caller]
fn shows(page: &str, before: &str, column: usize, value: f64) {
    let row = &page[page.find(before).unwrap_or_else(|| panic!("no {before}"))..];
    let cell = row.split("<td").nth(column).unwrap();
    let text = cell[cell.find('>').unwrap() + 1..cell.find('<').unwrap()].replace('\u{2212}', "-");
    let shown: f64 = text.trim().parse().unwrap();
    let unit = 10f64.powi(libm::log10(value.abs()).floor() as i32 - 3);
    assert!((shown - value).abs() <= 0.501 * unit, "{before}: {shown} is not {value}");
}

#[test]
fn run_check_report_and_sweep_give_one_number_for_each_mean_over_one_window() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let case = fs::read_to_string(CASE).unwrap().replace("roll = 0.008", "roll = 0.001");
    fs::write(folder.join("base.toml"), case).unwrap();
    fs::write(folder.join("sweep.toml"), SWEEP).unwrap();
    let swept = document(folder, &["sweep", "sweep.toml", "--out", "s", "--json"]);
    let table = fs::read_to_string(folder.join("s/sweep.csv")).unwrap();
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| lines[0].iter().position(|heading| *heading == name).unwrap();
    creepage(folder, &["report", "s"]);
    let sweep_page = fs::read_to_string(folder.join("s/report.html")).unwrap();
    let headings = &sweep_page[sweep_page.find("<h2>Runs</h2>").unwrap()..];
    let headings: Vec<&str> = headings.split("<th").skip(1).collect();
    let under = |name: &str| headings.iter().position(|h| h.contains(name)).unwrap() + 1;

    for (i, entry) in swept["runs"].as_array().unwrap().iter().enumerate() {
        let path = format!("s/{}", entry["run"].as_str().unwrap());
        let summary: Value =
            serde_json::from_slice(&fs::read(folder.join(&path).join("summary.json")).unwrap())
                .unwrap();
        assert_eq!(entry["summary"], summary);
        let ends = ["from", "to"].map(|end| number(&summary, &format!("/window/{end}")));
        let same = format!("{:?}:{:?}", ends[0], ends[1]);
        for found in [
            entry["check"].clone(),
            document(folder, &["check", &path, "--json"]),
            document(folder, &["check", &path, "--json", "--window", &same]),
        ] {
            assert_eq!(found["window"], serde_json::json!(ends));
            for (at, measure) in MEANS {
                let mean = &found["patch"][measure];
                assert_eq!(Some(&mean["mean"]), summary.pointer(&format!("/{at}")), "{measure}");
                let name = at.split('/').nth(1).unwrap();
                assert_eq!(mean["deviation"], summary["window"]["deviation"][name], "{measure}");
                let cell: f64 = lines[i + 1][column(name)].parse().unwrap();
                assert_eq!(Some(cell), mean["mean"].as_f64(), "{measure}");
            }
        }
        creepage(folder, &["report", &path]);
        let page = fs::read_to_string(folder.join(&path).join("report.html")).unwrap();
        let value = |at: &str| number(&summary, at);
        let traction = value("/contact/traction_coefficient");
        shows(&page, "<td>traction coefficient</td>", 2, traction);
        shows(&page, "<td>normal force</td>", 2, 1e-3 * value("/contact/normal_force"));
        shows(&page, "<td>area (nodes)</td>", 2, 1e6 * value("/contact/patch_area"));
        shows(&page, "<td>area (fit)</td>", 2, 1e6 * value("/contact/patch_area_fitted"));
        shows(&page, "<td>peak pressure (fit)</td>", 2, 1e-6 * value("/contact/peak_pressure"));
        let mu = if i == 0 { "<tr><td class=\"n\">0.2<" } else { "<tr><td class=\"n\">0.3<" };
        shows(&sweep_page, mu, under("T/N"), traction);
        shows(&sweep_page, mu, under("peak shear"), 1e-6 * value("/window/peak_shear"));
        shows(&sweep_page, mu, under("half length"), 1e3 * value("/contact/patch_half_length"));
    }
}

#[test]
fn a_window_that_is_asked_for_has_the_means_of_the_history_over_exactly_its_time() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let set = ["--set", "time.roll=0.001", "--set", "output.contact_interval=1e-6"];
    creepage(folder, &[&["run", CASE, "--out", "r"], &set[..]].concat());
    let (from, to) = (1.2345e-5, 2.1e-5);
    let found = document(folder, &["check", "r", "--json", "--window", "1.2345e-5:2.1e-5"]);
    assert_eq!(found["window"], serde_json::json!([from, to]));
    let history = HistoryFile::open(folder.join("r/history.h5")).unwrap();
    let times = history.read("time").unwrap();
    let border = |i: usize| 0.5 * (times[i - 1] + times[i]);
    for (column, measure) in
        [("traction_coefficient", "traction_coefficient"), ("patch_area", "area")]
    {
        let values = history.read(column).unwrap();
        let (mut sum, mut time) = (0.0, 0.0);
        for i in 1..times.len() - 1 {
            let part = (border(i + 1).min(to) - border(i).max(from)).max(0.0);
            (sum, time) = (sum + part * values[i], time + part);
        }
        assert!((time / (to - from) - 1.0).abs() < 1e-12, "the rows do not cover the window");
        let mean = number(&found, &format!("/patch/{measure}/mean"));
        assert!((mean / (sum / time) - 1.0).abs() < 1e-12, "{measure}: {mean} {}", sum / time);
        assert_eq!(found["patch"][measure]["from"], "history");
    }
    // a run in progress has no summary: its window is that of its case, its numbers its history's
    // as while it was in progress
    ["summary.json", "run.log"]
        .iter()
        .for_each(|f| fs::remove_file(folder.join("r").join(f)).unwrap());
    let ends = [2.0 / 3.0, 1.0].map(|part| part * 0.001 / 38.89);
    let found = document(folder, &["check", "r", "--json"]);
    for (i, end) in ends.into_iter().enumerate() {
        assert!((number(&found, &format!("/window/{i}")) / end - 1.0).abs() < 1e-12);
    }
    assert_eq!(found["patch"]["traction_coefficient"]["from"], "history");
}

#[test]
fn means_that_do_not_exist_are_dashes_with_the_reason_everywhere() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    // the patch lies on fewer nodes than a fit needs
    let set = ["--set", "time.roll=0.001", "--set", "load.normal=100"];
    let said =
        String::from_utf8(creepage(folder, &[&["run", CASE, "--out", "r"], &set[..]].concat()));
    let line = |page: &str, label: &str| {
        let found = page.lines().find(|line| line.trim_start().starts_with(label));
        found.unwrap_or_else(|| panic!("no {label} in\n{page}")).to_owned()
    };
    let said = said.unwrap();
    for label in ["patch half length", "patch area (fit)", "peak pressure", "stick border"] {
        let line = line(&said, label);
        assert!(line.contains("  -  (") && line.contains("none of"), "{line}");
    }
    let table = String::from_utf8(creepage(folder, &["check", "r"])).unwrap();
    for label in ["half length (fit)", "area (fit)", "peak pressure (fit)"] {
        let line = line(&table, label);
        assert!(line.contains("  -  (") && line.contains("none of"), "{line}");
    }
    let found = document(folder, &["check", "r", "--json"]);
    assert_eq!(found["patch"]["half_length"]["mean"], Value::Null);
    assert!(found["patch"]["half_length"]["note"].as_str().unwrap().contains("none of"));
    creepage(folder, &["report", "r"]);
    let page = fs::read_to_string(folder.join("r/report.html")).unwrap();
    let row = &page[page.find("<td>half length (fit)</td>").unwrap()..];
    assert!(row[..row.find("</tr>").unwrap()].contains("none of"));
    // what the page carries as data is no text: the check's document, where null has its meaning, a picture, scripts
    let page: String = page
        .split("<script")
        .map(|part| part.split_once("</script>").map_or(part, |(_, shown)| shown))
        .collect();
    let shown: Vec<&str> =
        page.split("\"data:").map(|part| part.split_once('"').map_or(part, |p| p.1)).collect();
    let text = format!("{}{}", page.split("\"data:").next().unwrap(), shown[1..].concat());
    assert!(text.contains("How to reproduce") && !text.contains("NaN") && !text.contains("null"));
}
