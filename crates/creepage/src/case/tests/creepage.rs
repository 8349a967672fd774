//! `drive.creepage` as a number and as a table over time.

use std::fs;
use std::path::Path;

use super::{SHORT, read, refused, set};
use crate::case::Case;
use crate::case::schema::Creepage;

const TABLE: &str = "drive.creepage=[[0,0],[1e-3,2.4e-3]]";

#[test]
fn a_table_over_time_is_read_written_and_read_again() {
    let case = set(&[TABLE]).unwrap();
    let points = [[0.0, 0.0], [1e-3, 2.4e-3]];
    assert_eq!(case.drive.creepage, Some(Creepage::Table(points.into())));
    let text = case.to_toml();
    assert!(text.contains("creepage = [[0.0, 0.0], [0.001, 0.0024]]"), "{text}");
    assert!(!text.contains("ramp"), "{text}");
    let again = read(&text).unwrap();
    assert_eq!(again, case);
    assert_eq!(again.hash(), case.hash());
    assert_ne!(set(&["drive.creepage=[[0,0],[1e-3,2.5e-3]]"]).unwrap().hash(), case.hash());
    let number = set(&[]).unwrap();
    assert_eq!(number.drive.creepage, Some(Creepage::Number(2.4e-3)));
    assert_eq!(number.drive.ramp, Some(0.74e-3));
}

#[test]
fn what_is_no_table_over_time_is_refused_with_its_point() {
    for (value, words) in [
        ("[[0,1e-3]]", ["drive.creepage = [[0, 0.001]]", "two points or more"]),
        ("[]", ["drive.creepage = []", "two points or more"]),
        ("[[0,0],[2e-3,1e-3],[1e-3,0]]", ["point 3 is at 0.001 s", "at 0.002 s"]),
        ("[[0,0],[1e-3,1e-3],[1e-3,0]]", ["point 3 is at 0.001 s", "after the point before"]),
        ("[[1e-3,0],[2e-3,1e-3]]", ["its first point is at 0.001 s", "start of rolling"]),
        ("[[0,nan],[2e-3,1e-3]]", ["point 1", "value NaN"]),
        ("[[0,0],[2e-3,2.4]]", ["point 2", "did you mean 0.024 (2.4 per cent)"]),
        ("[[0,0],[20,1e-3]]", ["point 2, time 20 s", "at least 0 and at most 10 s"]),
        ("[[0,0,1],[2e-3,1e-3]]", ["must be a number", "a list of pairs [time, number]"]),
        ("[1e-3,2e-3]", ["must be a number", "a list of pairs"]),
    ] {
        refused(set(&[&format!("drive.creepage={value}")]), &words);
    }
}

#[test]
fn a_ramp_beside_a_table_is_refused_but_for_what_rises_over_it() {
    refused(set(&[TABLE, "drive.ramp=1e-4"]), &["drive.ramp is not used", "table over time"]);
    let across = [TABLE, "drive.lateral_creepage=1e-3", "drive.ramp=1e-4"];
    assert_eq!(set(&across).unwrap().drive.ramp, Some(1e-4));
    // a layer above may give the table
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("base.toml"), format!("{SHORT}drive.ramp = 1e-4\n")).unwrap();
    let above = dir.path().join("above.toml");
    fs::write(&above, "extends = \"base.toml\"\n").unwrap();
    let load = |path: &Path, sets: &[&str]| {
        Case::load(path, &sets.iter().map(|set| (*set).to_owned()).collect::<Vec<_>>())
    };
    assert_eq!(load(&above, &[TABLE]).unwrap().drive.ramp, None);
    let across = load(&above, &[TABLE, "drive.spin=0.1"]).unwrap();
    assert_eq!(across.drive.ramp, Some(1e-4));
    let both = format!("{SHORT}drive.ramp = 1e-4\n").replace("2.4e-3", "[[0,0],[1e-3,2.4e-3]]");
    refused(read(&both), &["drive.ramp is not used", "leave drive.ramp out"]);
    // and torque in its place
    let torque = set(&[TABLE, "drive.torque=100"]).unwrap();
    assert_eq!((torque.drive.creepage, torque.drive.ramp), (None, Some(0.74e-3)));
}

#[test]
fn a_creepage_that_changes_in_the_evaluation_window_is_told() {
    let told = |set_: &str| set(&[set_]).unwrap().warnings().join("\n");
    let words = "drive.creepage still changes after 1.029 ms";
    assert!(told("drive.creepage=[[0,0],[1.2e-3,2e-3]]").contains(words));
    assert!(!told("drive.creepage=[[0,0],[1e-3,2e-3],[1.2e-3,2e-3]]").contains("changes"));
    let steep = told("drive.creepage=[[0,0],[1e-3,-0.24]]");
    assert!(steep.contains("did you mean -0.0024 (-0.24 per cent)"), "{steep}");
}
