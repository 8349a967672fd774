//! Decks as LS-PrePost writes them: comments with the names of fields, `_TITLE` and `_ID`, all default cards.
//!
//! The three decks of `fixtures` are one model: a disk of 96 elements on a bar of 32.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use creepage::case::Case;
use creepage::case::schema::{ContactLayers, Creepage, Stiffness};
use creepage::ls_dyna::{DeckError, Source, Translation, Units, translate};
use friction::Kind;
use mesh::import::{Foreign, read_abaqus};

const DECKS: [&str; 3] = ["parts.k", "split/main.k", "long.k"];

fn read(file: &str) -> Result<Translation, DeckError> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(file);
    let source = Source { file: &file, include_outside: false };
    translate(&source, Units::parse("mm-ton-s").unwrap(), "mesh.inp")
}

fn mesh(made: &Translation) -> Foreign {
    read_abaqus(made.mesh.as_bytes()).unwrap()
}

fn case(made: &Translation) -> Case {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    fs::write(&path, &made.case).unwrap();
    fs::write(folder.path().join("mesh.inp"), &made.mesh).unwrap();
    Case::load(&path, &[]).unwrap_or_else(|error| panic!("{error}\n{}", made.case))
}

/// The faces of a set, each as its nodes in ascending order.
fn faces(mesh: &Foreign, set: &str) -> BTreeSet<[u64; 4]> {
    let sorted = |face: &[u32; 4]| {
        let mut nodes = face.map(|n| mesh.nodes.ids[n as usize]);
        nodes.sort_unstable();
        nodes
    };
    mesh.sets[set].faces.iter().map(sorted).collect()
}

#[test]
fn nodes_solids_and_sets_are_those_of_the_deck() {
    for deck in DECKS {
        let mesh = mesh(&read(deck).unwrap());
        // 24 by 3 by 3 of the disk and 9 by 3 by 3 of the bar; that on the axle has no element
        assert_eq!(mesh.points.len(), 216 + 81, "{deck}");
        assert_eq!(mesh.hexes.len(), 96 + 32, "{deck}");
        let hexes = ["disk", "bar"].map(|name| mesh.sets[name].hexes.len());
        assert_eq!(hexes, [96, 32], "{deck}");
        let nodes = ["hub", "clamp"].map(|name| mesh.sets[name].nodes.len());
        assert_eq!(nodes, [72, 27], "{deck}");
        let lowest = mesh.points.iter().map(|p| p[2]).fold(f64::INFINITY, f64::min);
        assert!((lowest + 0.02).abs() < 1e-12, "{deck}: {lowest}");
    }
}

#[test]
fn contact_and_friction_are_those_of_the_deck() {
    for deck in DECKS {
        let made = read(deck).unwrap();
        let case = case(&made);
        let law = &case.friction;
        assert_eq!(law.law, Kind::Exponential, "{deck}");
        // 0.005 s/mm
        assert_eq!(
            (law.number("static"), law.number("dynamic"), law.number("decay")),
            (Some(0.4), Some(0.3), Some(5.0))
        );
        assert_eq!(case.contact.penalty.normal, Stiffness::Factor(0.1), "{deck}");
        assert_eq!(case.contact.penalty.damping, 0.2, "{deck}");
        let mesh = mesh(&made);
        assert_eq!(["tread", "top"].map(|set| mesh.sets[set].faces.len()), [48, 16], "{deck}");
    }
}

#[test]
fn the_outer_faces_of_parts_that_meet_are_the_segments_that_another_deck_lists() {
    let [parts, listed] = ["parts.k", "long.k"].map(|deck| mesh(&read(deck).unwrap()));
    for set in ["tread", "top"] {
        assert_eq!(faces(&parts, set), faces(&listed, set), "{set}");
    }
}

#[test]
fn load_drive_material_and_method_are_those_of_the_deck() {
    for deck in DECKS {
        let case = case(&read(deck).unwrap());
        assert_eq!(case.load.normal, 2000.0, "{deck}");
        assert_eq!(case.drive.speed, 16.0, "{deck}");
        assert!(
            (case.drive.creepage.as_ref().and_then(Creepage::number).unwrap() - 2e-3).abs() < 1e-9,
            "{deck}"
        );
        let steel = case.disk_material();
        assert_eq!((steel.young, steel.poisson, steel.density), (210e9, 0.3, 7800.0), "{deck}");
        assert_eq!(case.element.hourglass, 0.05, "{deck}");
        assert_eq!(case.element.contact_layers, ContactLayers::OnePoint, "{deck}");
        assert_eq!((case.time.factor, case.time.duration), (Some(0.67), Some(2.5e-4)), "{deck}");
        assert_eq!(case.fields_interval(), 2.5e-5, "{deck}");
    }
}

#[test]
fn what_a_case_does_without_is_passed_over_in_one_note() {
    for deck in DECKS {
        let notes = read(deck).unwrap().notes;
        let [note] = &notes[..] else { panic!("{deck}: {notes:?}") };
        for card in ["*CONTROL_ACCURACY", "*CONTROL_ENERGY", "*DATABASE_GLSTAT"] {
            assert_eq!(note.matches(card).count(), 1, "{deck}: {note}");
        }
        assert!(!note.contains("*CONTROL_TERMINATION"), "{note}");
    }
}
