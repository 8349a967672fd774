//! The small model of `meshes/`, and cards that are refused.

use crate::case::Case;
use crate::case::schema::{ContactLayers, Creepage, Crown, Normals, Stiffness};
use crate::ls_dyna::{DeckError, Source, Translation, Units, translate};
use friction::Kind;
use mesh::import::{SetNames, Unit, bodies, read_abaqus};
use std::fs;
use std::path::Path;

const DECK: &str = include_str!("../../../../meshes/small.k");

pub(super) fn import(text: &str) -> Result<Translation, DeckError> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("small.k");
    fs::write(&file, text).unwrap();
    let source = Source { file: &file, include_outside: false };
    translate(&source, Units::parse("mm-ton-s").unwrap(), "mesh.inp")
}

/// The line of the deck where the cause of an error stands.
fn line_of(error: &DeckError) -> Option<usize> {
    error.place.as_ref().map(|place| place.line)
}

pub(super) fn case(made: &Translation) -> Case {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    fs::write(&path, &made.case).unwrap();
    fs::write(folder.path().join("mesh.inp"), &made.mesh).unwrap();
    Case::load(&path, &[]).unwrap_or_else(|error| panic!("{error}\n{}", made.case))
}

#[test]
fn the_cards_of_the_small_model_become_the_keys_of_the_table() {
    let made = import(DECK).unwrap();
    let case = case(&made);
    assert_eq!((case.disk.radius, case.disk.hub_radius, case.disk.width), (0.1, 0.05, 0.02));
    assert_eq!((case.bar.length, case.bar.height, case.bar.start), (0.1, 0.02, -0.05));
    assert!(matches!(case.bar.crown_radius, Crown::Radius(c) if (c - 0.30).abs() < 1e-3));
    assert_eq!(case.disk.crown_radius, Crown::Flat);
    let steel = case.disk_material();
    assert_eq!((steel.young, steel.poisson, steel.density), (210e9, 0.3, 7800.0));
    assert!((case.load.normal - 2000.0).abs() < 0.1, "{}", case.load.normal);
    assert_eq!(case.drive.speed, 16.0);
    // 160.32 rad/s at 0.1 m and 16 m/s
    assert!(
        (case.drive.creepage.as_ref().and_then(Creepage::number).unwrap() - 2e-3).abs() < 1e-12
    );
    assert_eq!(case.friction.law, Kind::Exponential);
    // 0.006 s/mm
    assert_eq!(
        (
            case.friction.number("static"),
            case.friction.number("dynamic"),
            case.friction.number("decay")
        ),
        (Some(0.5), Some(0.32), Some(6.0))
    );
    assert_eq!(case.contact.penalty.normal, Stiffness::Factor(1.0));
    assert_eq!(case.contact.penalty.tangential, Stiffness::Factor(1.0));
    assert_eq!(case.contact.penalty.damping, 0.1);
    assert!(!case.contact.curvature);
    assert_eq!(case.contact.normals, Normals::Face);
    assert_eq!(case.element.hourglass, 0.05);
    assert_eq!(case.element.contact_layers, ContactLayers::OnePoint);
    assert_eq!((case.damping.bulk_linear, case.damping.bulk_quadratic), (0.06, 1.5));
    assert_eq!((case.time.factor, case.time.duration), (Some(0.67), Some(2.5e-4)));
    assert!((case.mesh.zone.size - 2e-3).abs() < 1e-4, "{:?}", case.mesh.zone);
    assert!(made.notes.iter().any(|note| note.contains("*CONTROL_ENERGY")), "{:?}", made.notes);
}

#[test]
fn the_mesh_of_a_keyword_file_is_that_of_the_same_msh() {
    let made = import(DECK).unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/small.msh");
    let first = mesh::import::read_gmsh(&fs::read(path).unwrap()).unwrap();
    let second = read_abaqus(made.mesh.as_bytes()).unwrap();
    let of = |foreign| bodies(foreign, &SetNames::default(), Unit::Metre).unwrap().mesh;
    let (first, second) = (of(&first), of(&second));
    assert_eq!(first.hexes.len(), second.hexes.len());
    for (name, body) in [("tread", 0), ("hub", 0), ("top", 1), ("bottom", 1)] {
        let count = |mesh: &mesh::Mesh| mesh.bodies[body].node_sets[name].len();
        assert_eq!(count(&first), count(&second), "{name}");
    }
    let volume = |mesh: &mesh::Mesh| mesh::quality(mesh).volume;
    assert!((volume(&first) / volume(&second) - 1.0).abs() < 1e-9);
}

#[test]
fn columns_and_commas_one_line_and_two_are_the_same() {
    let second_format = DECK.replace(
        "*MAT_ELASTIC\n$      MID        RO         E        PR\n         1    7.8e-9   2.1e+05       0.3",
        "*MAT_ELASTIC\n1,7.8-9,2.1d5,0.3",
    );
    assert_ne!(second_format, DECK);
    assert_eq!(import(&second_format).unwrap(), import(DECK).unwrap());
    let mut lines: Vec<String> = DECK.lines().map(str::to_owned).collect();
    let start = lines.iter().position(|l| l == "*ELEMENT_SOLID").unwrap() + 1;
    let (head, nodes) = lines[start].split_at(16);
    let two = format!("{head}\n{nodes}");
    lines[start] = two;
    assert_eq!(import(&lines.join("\n")).unwrap().mesh, import(DECK).unwrap().mesh);
}

#[test]
fn equal_coefficients_of_friction_or_no_decay_are_coulombs_law() {
    for line in [
        "       0.5       0.5    0.0060       0.0      10.0",
        "       0.5      0.32       0.0       0.0      10.0",
    ] {
        let old = "       0.5      0.32    0.0060       0.0      10.0";
        let case = case(&import(&DECK.replace(old, line)).unwrap());
        assert_eq!((case.friction.law, case.friction.number("static")), (Kind::Coulomb, Some(0.5)));
    }
}

#[test]
fn a_model_that_begins_elsewhere_is_moved_to_x_0_and_said_so() {
    let shifted: String = DECK
        .lines()
        .map(|line| {
            // a line of *NODE
            if line.len() == 56 {
                let x: f64 = line[8..24].trim().parse().unwrap();
                format!("{}{:16.6}{}\n", &line[..8], x + 250.0, &line[24..])
            } else if line.starts_with("       0.0       0.0     100.0") {
                // the axis about which the disk turns
                format!("     250.0{}\n", &line[10..])
            } else {
                format!("{line}\n")
            }
        })
        .collect();
    let moved = import(&shifted).unwrap();
    assert!(moved.notes.iter().any(|note| note.contains("in x")), "{:?}", moved.notes);
    assert_eq!(case(&moved).bar, case(&import(DECK).unwrap()).bar);
}

#[test]
fn what_is_not_read_is_refused_by_its_line() {
    let at = |words: &str| 1 + DECK.lines().position(|l| l.starts_with(words)).unwrap();
    for (old, new, line, words) in [
        ("*TITLE", "*MAT_PLASTIC_KINEMATIC", at("*TITLE"), "*MAT_PLASTIC_KINEMATIC is not read"),
        ("    2.5e-4", "     &tend", at("    2.5e-4"), "parameter &tend is not defined"),
        (
            "         1         4      0.05",
            "         1         6      0.05",
            at("         1         4      0.05"),
            "IHQ = 6",
        ),
        (
            "       101       102         0",
            "       101       102         4",
            at("       101"),
            "SSTYP (SURFATYP) = 4",
        ),
        (
            "       0.5      0.32    0.0060       0.0",
            "       0.5      0.32    0.0060       9.0",
            at("       0.5"),
            "VC = 9",
        ),
        (
            "         2         0         1         1         1",
            "         2         0         1         0         1",
            at("         2         0"),
            "DOFX",
        ),
        (
            "       1.0       1.0\n*CON",
            "       1.0       2.0\n*CON",
            at("       1.0       1.0"),
            "SFM = 2",
        ),
        ("   2.1e+05       0.3", "   2.1e+05       abc", at("         1    7.8e-9"), "`abc`"),
    ] {
        let text = DECK.replacen(old, new, 1);
        assert_ne!(text, DECK, "{old}");
        let error = import(&text).unwrap_err();
        assert!(error.to_string().contains(words), "{words}: {error}");
        assert_eq!(line_of(&error), Some(line), "{words}");
    }
}

#[test]
fn a_second_initial_velocity_is_refused() {
    let line = |text: &str, words: &str, nth: usize| {
        let mut found = text.lines().enumerate().filter(|(_, l)| l.starts_with(words));
        1 + found.nth(nth).unwrap().0
    };
    let other = "*INITIAL_VELOCITY\n         1\n     900.0\n*NODE";
    let pair = "         1         2     99.00     900.0\n       0.0       0.0     100.0       0.0       1.0\n*NODE";
    let first = line(DECK, "*INITIAL_VELOCITY", 0);
    for (put, words) in [(other, "*INITIAL_VELOCITY"), (pair, "         1         2     99.00")] {
        let text = DECK.replacen("*NODE", put, 1);
        let error = import(&text).unwrap_err();
        let said = "a second initial velocity after that of";
        let first = format!("small.k:{first} is not read");
        assert!(error.to_string().contains(said), "{error}");
        assert!(error.to_string().contains(&first), "{error}");
        let nth = usize::from(words.starts_with('*'));
        assert_eq!(line_of(&error), Some(line(&text, words, nth)), "{words}");
    }
}

#[test]
fn an_angular_velocity_of_0_or_backwards_is_refused() {
    for omega in ["       0.0", "   -160.32"] {
        let error = import(&DECK.replacen("    160.32", omega, 1)).unwrap_err();
        assert!(error.to_string().contains("OMEGA"), "{error}");
        assert!(line_of(&error).is_some());
    }
}

#[test]
fn an_initial_velocity_of_others_than_the_disk_is_refused() {
    let velocity = "         1         2    160.32";
    for (other, words) in [
        ("         2         2    160.32", "of others than the whole disk"),
        ("         0         0    160.32", "of others than the whole disk"),
        ("         1         3    160.32", "of others than the whole disk"),
        ("         7         1    160.32", "part set 7"),
    ] {
        let error = import(&DECK.replacen(velocity, other, 1)).unwrap_err();
        assert!(error.to_string().contains(words), "{other}: {error}");
    }
}

#[test]
fn long_standard_and_i10_cards_stand_side_by_side() {
    let standard = "*MAT_ELASTIC\n$      MID        RO         E        PR\n         1    7.8e-9   2.1e+05       0.3";
    let long = "*MAT_ELASTIC_TITLE +\nsteel\n                   1              7.8e-9             2.1e+05                 0.3";
    let text = DECK.replace(standard, long);
    assert_ne!(text, DECK);
    assert_eq!(import(&text).unwrap(), import(DECK).unwrap());
    // columns of 8 become 10
    let mut i10 = String::new();
    let mut card = "";
    for line in DECK.lines() {
        card = line.strip_prefix('*').unwrap_or(card);
        match card {
            "NODE" | "ELEMENT_SOLID" if line.starts_with('*') => i10 += &format!("{line} %\n"),
            "NODE" => i10 += &format!("{:>10}{}\n", &line[..8], &line[8..]),
            "ELEMENT_SOLID" => {
                let fields = (0..line.len()).step_by(8).map(|at| &line[at..line.len().min(at + 8)]);
                i10 += &fields.map(|field| format!("{field:>10}")).collect::<String>();
                i10.push('\n');
            }
            _ => i10 += &format!("{line}\n"),
        }
    }
    assert_eq!(import(&i10).unwrap(), import(DECK).unwrap());
    // in a file in the long format, `-` marks cards in the standard one
    let minus: String = DECK
        .lines()
        .map(|line| match line {
            "*KEYWORD" => "*KEYWORD MEMORY=20M LONG = Y\n".to_owned(),
            _ if line.starts_with('*') && line != "*END" => format!("{line}-\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    assert_eq!(import(&minus).unwrap(), import(DECK).unwrap());
}

#[test]
fn headings_in_another_encoding_are_no_data() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("small.k");
    // u with two dots in Latin-1
    let mut bytes = DECK.replacen("disk\n", "R#der\n", 1).into_bytes();
    *bytes.iter_mut().find(|byte| **byte == b'#').unwrap() = 0xfc;
    fs::write(&file, bytes).unwrap();
    let source = Source { file: &file, include_outside: false };
    let made = translate(&source, Units::parse("mm-ton-s").unwrap(), "mesh.inp").unwrap();
    assert_eq!(made, import(DECK).unwrap());
    let error = import(&DECK.replacen("    2.5e-4", "  2\u{b7}5e-4", 1)).unwrap_err();
    assert!(error.to_string().contains("a number is expected"), "{error}");
}

#[test]
fn control_cards_that_switch_nothing_on_are_passed_over() {
    let with = |card: &str| import(&DECK.replacen("*TITLE", &format!("{card}\n*TITLE"), 1));
    for (card, field) in [
        ("*CONTROL_SOLUTION\n         #", "SOLN"),
        ("*CONTROL_IMPLICIT_GENERAL\n         #       0.0", "IMFLAG"),
        ("*CONTROL_DYNAMIC_RELAXATION\n250,0.001,0.995,0.0,0.0,0,0.04,#", "IDRFLG"),
    ] {
        let made = with(&card.replace('#', "0")).unwrap();
        let name = card.lines().next().unwrap();
        assert!(made.notes.iter().any(|note| note.contains(name)), "{:?}", made.notes);
        let error = with(&card.replace('#', "1")).unwrap_err();
        assert!(error.to_string().contains(&format!("{name} with {field} = 1")), "{error}");
    }
}

#[test]
fn a_card_that_is_not_read_is_refused_with_a_hint_that_fits_it() {
    for (card, hint) in [
        ("*MAT_PLASTIC_KINEMATIC", "*MAT_ELASTIC"),
        ("*ELEMENT_SHELL", "*ELEMENT_SOLID"),
        ("*CONTACT_TIED_NODES_TO_SURFACE", "*CONTACT_AUTOMATIC_SURFACE_TO_SURFACE"),
        ("*CONTROL_IMPLICIT_EIGENVALUE", "time.integrator"),
        ("*INCLUDE_TRANSFORM", "*INCLUDE"),
        ("*SET_NODE_GENERAL", "*SET_NODE_LIST"),
        ("*SET_SHELL_LIST", "segments, parts and nodes"),
        ("*DEFINE_FRICTION", "FS, FD and DC"),
        ("*DEFINE_BOX", "members of sets"),
        ("*LOAD_GRAVITY_PART", "weight"),
        ("*CONTROL_REFINE_SOLID", "their mesh stays"),
        ("*PART_INERTIA", "*CONSTRAINED_NODAL_RIGID_BODY_INERTIA"),
        ("*AIRBAG", "leave the card out"),
    ] {
        let error = import(&DECK.replacen("*TITLE", card, 1)).unwrap_err();
        assert!(error.to_string().contains(card), "{error}");
        assert!(error.fault.remedy().contains(hint), "{card}: {}", error.fault.remedy());
    }
}

#[test]
fn elements_of_the_ten_nodes_format_are_read_where_they_have_eight() {
    let start = DECK.find("*ELEMENT_SOLID\n").unwrap();
    let end = start + DECK[start..].find("\n*").unwrap();
    let two_lines = |tenth: &str| {
        let mut cards = String::from("*ELEMENT_SOLID (ten nodes format)\n");
        for line in DECK[start..end].lines().skip(1) {
            let (head, nodes) = line.split_at(16);
            cards += &format!("{head}\n{nodes}{tenth}\n");
        }
        DECK.replacen(&DECK[start..=end], &cards, 1)
    };
    let plain = import(DECK).unwrap();
    assert_eq!(import(&two_lines("       0       0")).unwrap().mesh, plain.mesh);
    let error = import(&two_lines("       9      10")).unwrap_err();
    assert!(error.to_string().contains("of ten nodes is not read"), "{error}");
}

#[test]
fn what_a_disk_on_a_bar_lacks_is_named() {
    for (keyword, lines) in [
        ("*CONSTRAINED_NODAL_RIGID_BODY", 3),
        ("*BOUNDARY_SPC_SET", 3),
        ("*CONTACT_SURFACE_TO_SURFACE", 7),
        ("*LOAD_NODE_SET", 3),
        ("*CONTROL_TERMINATION", 3),
        ("*INITIAL_VELOCITY_GENERATION", 5),
    ] {
        let mut kept: Vec<&str> = DECK.lines().collect();
        let at = kept.iter().position(|l| *l == keyword).unwrap();
        kept.drain(at..at + lines);
        let error = import(&kept.join("\n")).unwrap_err();
        let word = keyword.trim_end_matches("_GENERATION");
        assert!(error.to_string().contains(word), "{keyword}: {error}");
    }
}

#[test]
fn a_keyword_file_cut_off_anywhere_never_panics() {
    for part in 0..80 {
        let _ = import(&DECK[..DECK.len() * part / 80]);
    }
}

#[test]
fn a_surface_without_segments_is_refused_by_its_set() {
    let start = DECK.find("*SET_SEGMENT").unwrap();
    let end = start + DECK[start..].find("\n*").unwrap();
    let head: String = DECK[start..end].lines().take(2).map(|line| format!("{line}\n")).collect();
    let text = DECK.replacen(&DECK[start..=end], &head, 1);
    let error = import(&text).unwrap_err();
    assert!(error.to_string().contains("segment set 101 has no segments"), "{error}");
}

#[test]
fn no_file_name_breaks_the_case() {
    let units = Units::parse("mm-ton-s").unwrap();
    let name = "a\"b\\\nc\u{202e}.k";
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    fs::write(&file, DECK).unwrap();
    let made =
        translate(&Source { file: &file, include_outside: false }, units, "mesh.inp").unwrap();
    assert_eq!(case(&made).title, Some(format!("from {name}")));
}
