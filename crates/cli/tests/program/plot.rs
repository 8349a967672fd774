//! `creepage plot`: every figure is written, with its labels and the case's numbers.

use crate::planted::{COULOMB, FALLING, Leave, perfect, write_with};
use serde_json::Value;
use std::fs;
use std::process::Command;

#[test]
fn every_figure_carries_labels_units_and_the_numbers_of_the_case() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write_with(&run, FALLING, "penalty", 30, 1e-6, Leave::default(), |x, step| {
        perfect(FALLING, x, step)
    });
    let output = Command::new(env!("CARGO_BIN_EXE_creepage"))
        .args(["plot", run.to_str().unwrap(), "--json"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let names: Vec<&str> = document["figures"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f["name"].as_str().unwrap())
        .collect();
    assert_eq!(
        names,
        [
            "figure-1-velocities",
            "figure-2-stick-slip",
            "figure-3-tractions",
            "figure-4-bound",
            "figure-7-law",
            "space-time",
            "contact-maps"
        ]
    );
    for name in names {
        let svg = fs::read_to_string(run.join(format!("figures/{name}.svg"))).unwrap();
        for part in ["planted:", "V = 40.00 m/s", "@font-face", "creepage 2.500"] {
            assert!(svg.contains(part), "{name}: {part}");
        }
        assert!(svg.contains("(mm)") || svg.contains("(m/s)"), "{name} has no unit");
        assert!(!svg.contains("NaN"), "{name}");
        assert!(texts(&svg).iter().all(|text| !text.contains('_')), "{name} shows a raw subscript");
        let png = fs::read(run.join(format!("figures/{name}.png"))).unwrap();
        assert_eq!(&png[1..4], b"PNG");
    }
}

/// The texts of an SVG file, without the elements in them.
fn texts(svg: &str) -> Vec<String> {
    let inside = svg.split("<text").skip(1).filter_map(|part| part.split("</text>").next());
    let bare = |text: &str| {
        text.split('<')
            .filter_map(|part| part.split_once('>'))
            .map(|p| p.1.trim_end_matches('\n'))
            .collect()
    };
    inside.map(|text| bare(&format!("<{text}"))).collect()
}

#[test]
fn every_line_of_an_instant_names_it_and_a_caption_names_colours_that_are_there() {
    let folder = tempfile::tempdir().unwrap();
    write_with(folder.path(), FALLING, "penalty", 30, 1e-6, Leave::default(), |x, step| {
        perfect(FALLING, x, step)
    });
    let output = Command::new(env!("CARGO_BIN_EXE_creepage"))
        .args(["plot", folder.path().to_str().unwrap(), "--format", "svg"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let svg =
        |name: &str| fs::read_to_string(folder.path().join(format!("figures/{name}.svg"))).unwrap();
    for (name, lines) in [("figure-3-tractions", 4), ("figure-4-bound", 6 + 7)] {
        let texts = texts(&svg(name));
        let of_time = texts.iter().filter(|text| text.contains("t = 0.")).count();
        assert_eq!(of_time, lines, "{name}: {texts:?}");
    }
    let law = svg("figure-7-law");
    assert!(texts(&law).join(" ").contains("vermilion line") && law.contains("#D55E00"));
}

#[test]
fn instants_width_and_captions_of_figures_can_be_chosen() {
    let folder = tempfile::tempdir().unwrap();
    write_with(folder.path(), FALLING, "penalty", 30, 1e-6, Leave::default(), |x, step| {
        perfect(FALLING, x, step)
    });
    let plot = |options: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_creepage"))
            .args(["plot", folder.path().to_str().unwrap(), "--format", "svg"])
            .args(options)
            .output()
            .unwrap()
    };
    let options = ["--at", "4e-6,9e-6", "--width", "90", "--font-size", "8", "--no-caption"];
    let output = plot(&options);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let svg = fs::read_to_string(folder.path().join("figures/figure-3-tractions.svg")).unwrap();
    assert!(svg.starts_with("<svg width=\"90.00mm\""), "{}", &svg[..90]);
    let texts = texts(&svg);
    let of_time: Vec<_> = texts.iter().filter(|text| text.contains("t = 0.")).collect();
    assert_eq!(of_time.len(), 3, "{texts:?}");
    assert!(of_time.iter().all(|text| text.contains("0.0040") || text.contains("0.0090")));
    assert!(!svg.contains("planted:"));
    for (refused, why) in [
        (["--at", "1"], "the records are from 0 to"),
        (["--width", "3"], "from 30 to 1000"),
        (["--font-size", "90"], "from 4 to 24"),
        (["--reference", "contact"], "half-space is the one reference"),
        (["--reference", "half-space"], "--reference half-space: "),
    ] {
        let output = plot(&refused);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains(why), "{output:?}");
    }
}

#[test]
fn one_format_can_be_chosen_and_bare_data_have_the_figures_that_they_allow() {
    let folder = tempfile::tempdir().unwrap();
    let bare = Leave { gap: true, motion: true, mu: false };
    write_with(folder.path(), COULOMB, "other", 1, 1e-6, bare, |x, _| perfect(COULOMB, x, 0));
    let out = folder.path().join("pictures");
    let output = Command::new(env!("CARGO_BIN_EXE_creepage"))
        .args(["plot", folder.path().to_str().unwrap(), "--format", "svg", "--out"])
        .arg(&out)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let files: Vec<_> = fs::read_dir(&out).unwrap().map(|f| f.unwrap().path()).collect();
    assert_eq!(files.len(), 7);
    assert!(files.iter().all(|file| file.extension().unwrap() == "svg"));
    let refused = Command::new(env!("CARGO_BIN_EXE_creepage"))
        .args(["plot", folder.path().to_str().unwrap(), "--format", "gif"])
        .output()
        .unwrap();
    assert_eq!(refused.status.code(), Some(2));
}

#[test]
fn captions_speak_of_the_bodies_and_instants_that_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    write_with(folder.path(), COULOMB, "other", 2, 1e-6, Leave::default(), |x, step| {
        perfect(COULOMB, x, step)
    });
    let output = Command::new(env!("CARGO_BIN_EXE_creepage"))
        .args(["plot", folder.path().to_str().unwrap(), "--format", "svg"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let drawn = |name: &str| {
        let svg = fs::read_to_string(folder.path().join(format!("figures/{name}.svg"))).unwrap();
        texts(&svg).join(" ").split_whitespace().collect::<Vec<_>>().join(" ")
    };
    for (name, words) in [
        ("figure-1-velocities", "both bodies"),
        ("figure-1-velocities", "slip velocity of the bar relative to the disk"),
        ("figure-1-velocities", "Slip velocity of the bar"),
        ("figure-1-velocities", "at two instants"),
        ("figure-2-stick-slip", "on the bar at two instants"),
        ("space-time", "Nodes of the bar"),
    ] {
        assert!(drawn(name).contains(words), "{name}: {words}: {}", drawn(name));
    }
}
