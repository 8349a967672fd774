//! Cases written as keyword files and read again.

use super::{RollingMotion, export, unsayable};
use crate::case::Case;
use crate::case::schema::{
    BodyModel, ContactLayers, Creepage, Ends, LoadMode, Stiffness, Symmetry,
};
use crate::ls_dyna::{DeckError, Source, Translation, Units, translate};
use crate::scenario::{BAR, DISK, InitialState, Model};
use mesh::import::{Foreign, read_abaqus};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The tests' small case with penalty contact.
fn small(sets: &[&str]) -> Case {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/small.toml");
    let sets = ["contact.enforcement=penalty", "mesh.zone.size=2e-3"].iter().chain(sets);
    Case::load(&file, &sets.map(|set| (*set).to_owned()).collect::<Vec<_>>()).unwrap()
}

/// A case at its start, as a deck and as what is read of it.
struct There {
    case: Case,
    model: Model,
    facts: InitialState,
    deck: String,
}

impl There {
    fn new(case: Case, units: &str) -> Self {
        assert_eq!(unsayable(&case), [""; 0]);
        let model = crate::scenario::model(&case).unwrap();
        let stop = AtomicBool::new(false);
        let start =
            crate::scenario::start(&case, &model, None, &stop, &mut |_| {}, &mut |_| Ok(()));
        let facts = start.unwrap().facts;
        let rolling = RollingMotion { case: &case, model: &model, facts: &facts };
        let deck = export(&rolling, Units::parse(units).unwrap()).deck;
        Self { case, model, facts, deck }
    }

    fn back(&self, units: &str) -> Translation {
        translated(&self.deck, units).unwrap()
    }
}

/// A deck in these units, read.
fn translated(deck: &str, units: &str) -> Result<Translation, DeckError> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("deck.k");
    std::fs::write(&file, deck).unwrap();
    let source = Source { file: &file, include_outside: false };
    translate(&source, Units::parse(units).unwrap(), "mesh.inp")
}

/// The case of a translation.
fn read(made: &Translation) -> Case {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    std::fs::write(&path, &made.case).unwrap();
    std::fs::write(folder.path().join("mesh.inp"), &made.mesh).unwrap();
    Case::load(&path, &[]).unwrap_or_else(|error| panic!("{error}\n{}", made.case))
}

#[track_caller]
fn near(what: &str, found: f64, expected: f64) {
    let off = (found - expected).abs();
    assert!(off <= 1e-5 * expected.abs(), "{what}: {found} instead of {expected}");
}

/// The mesh that was read is that of the model to the last digit of the deck, whose nodes have nine after the point.
fn same_mesh(model: &Model, read: &Foreign) {
    assert!(read.points.len() >= model.mesh.nodes.len());
    for (x, y) in read.points.iter().zip(&model.mesh.nodes) {
        for (x, y) in x.iter().zip(y) {
            assert!((x - y).abs() <= 0.6e-9 * y.abs().max(1e-6), "{x} {y}");
        }
    }
    assert_eq!(read.hexes[..model.mesh.hexes.len()], model.mesh.hexes);
    let faces = |side: usize| model.surfaces[side].faces.iter().map(|face| face.nodes);
    for (name, side) in [("tread", DISK), ("top", BAR)] {
        let expected: Vec<_> = faces(side).collect();
        assert_eq!(read.sets[name].faces[..expected.len()], expected, "{name}");
    }
    for (name, nodes) in [("hub", &model.hub), ("clamp", &model.clamped)] {
        assert_eq!(read.sets[name].nodes[..nodes.len()], nodes[..], "{name}");
    }
}

#[test]
fn a_case_comes_back_from_its_keyword_file_with_the_same_mesh() {
    let falling: &[&str] =
        &["friction.law=exponential", "friction.dynamic=0.2", "friction.decay=6.0"];
    let slice: &[&str] = &[
        "mesh.plane_strain=true",
        "bar.crown_radius=flat",
        "disk.width=2e-3",
        "bar.width=2e-3",
        "mesh.zone.width=2e-3",
        "load.normal=1e3",
        "bar.ends=quiet",
        "load.mode=height",
    ];
    for (sets, units) in [
        (&["element.contact_layers=one-point"][..], "mm-ton-s"),
        (
            &[
                "mesh.symmetry=half",
                "damping.mass=4000",
                "damping.kelvin_voigt=1e-9",
                "element.layers=2",
            ],
            "mm-ton-s",
        ),
        (falling, "m-kg-s"),
        (slice, "mm-kg-ms"),
    ] {
        let there = There::new(small(sets), units);
        let made = there.back(units);
        same_mesh(&there.model, &read_abaqus(made.mesh.as_bytes()).unwrap());
        let (a, b) = (&there.case, &read(&made));
        assert_eq!(a.mesh.symmetry, b.mesh.symmetry, "{sets:?}");
        assert_eq!(a.mesh.plane_strain, b.mesh.plane_strain, "{sets:?}");
        assert_eq!(a.bar.ends == Ends::Quiet, b.bar.ends == Ends::Quiet, "{sets:?}");
        assert_eq!(a.element.contact_layers, b.element.contact_layers, "{sets:?}");
        if a.element.contact_layers == ContactLayers::Full {
            assert_eq!(a.contact_layers(), b.contact_layers(), "{sets:?}");
        }
        assert_eq!(a.friction.law, b.friction.law, "{sets:?}");
        assert_eq!(a.load.mode == LoadMode::Height, b.load.mode == LoadMode::Height, "{sets:?}");
        let creepage =
            |case: &Case| case.drive.creepage.as_ref().and_then(Creepage::number).unwrap();
        let penalty = |case: &Case| match case.contact.penalty.normal {
            Stiffness::Factor(factor) => factor,
            _ => f64::NAN,
        };
        for (what, x, y) in [
            ("load.normal", b.load.normal, a.load.normal),
            ("drive.speed", b.drive.speed, a.drive.speed),
            ("drive.creepage", creepage(b), creepage(a)),
            ("drive.ramp", b.drive.ramp(), a.drive.ramp()),
            ("time.duration", b.duration(), a.duration()),
            (
                "friction.static",
                b.friction.number("static").unwrap(),
                a.friction.number("static").unwrap(),
            ),
            ("contact.penalty.normal", penalty(b), penalty(a)),
            ("contact.penalty.damping", b.contact.penalty.damping, a.contact.penalty.damping),
            ("element.hourglass", b.element.hourglass, a.element.hourglass),
            ("damping.mass", b.damping.mass, a.damping.mass),
            ("damping.kelvin_voigt", b.kelvin_voigt(), a.kelvin_voigt()),
            ("damping.bulk_linear", b.damping.bulk_linear, a.damping.bulk_linear),
            ("damping.bulk_quadratic", b.damping.bulk_quadratic, a.damping.bulk_quadratic),
            ("time.factor", b.time.factor.unwrap(), there.facts.stability.factor),
            ("output.contact_interval", b.output.contact_interval, a.output.contact_interval),
            ("output.fields_interval", b.fields_interval(), a.fields_interval()),
            ("disk.radius", b.disk.radius, a.disk.radius),
            ("disk.hub_radius", b.disk.hub_radius, a.disk.hub_radius),
            ("bar.length", b.bar.length, a.bar.length),
            ("material", b.disk_material().young, a.disk_material().young),
            ("density", b.bar_material().density, a.bar_material().density),
        ] {
            near(&format!("{sets:?}: {what}"), x, y);
        }
        if falling == sets {
            let [x, y] = [a, b].map(|case| case.friction.exponential().unwrap());
            near("friction.dynamic", y.mu_dynamic, x.mu_dynamic);
            near("friction.decay", y.decay, x.decay);
        }
    }
}

#[test]
fn torque_lateral_creepage_and_the_mass_of_the_hub_come_back() {
    let case = small(&["load.hub_mass=35", "drive.lateral_creepage=1e-3"]);
    let there = There::new(case, "mm-ton-s");
    let made = there.back("mm-ton-s");
    same_mesh(&there.model, &read_abaqus(made.mesh.as_bytes()).unwrap());
    let found = read(&made);
    near("mass", found.load.hub_mass, 35.0);
    // TM is the fourth of its line, in tons
    let mut lines: Vec<String> = there.deck.lines().map(str::to_owned).collect();
    let mass = 1 + lines.iter().position(|line| line.contains(" TM")).unwrap();
    lines[mass].replace_range(30..40, "    1.0e-6");
    let error = translated(&lines.join("\n"), "mm-ton-s").unwrap_err();
    assert!(error.to_string().contains("below the"), "{error}");
    near("lateral", found.drive.lateral_creepage, 1e-3);

    let text = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/small.toml"),
    );
    let lines: Vec<String> = text
        .unwrap()
        .lines()
        .map(
            |line| if line.starts_with("creepage") { "torque = 120.0".into() } else { line.into() },
        )
        .collect();
    let sets = ["contact.enforcement=penalty", "mesh.zone.size=2e-3", "mesh.symmetry=half"];
    let sets = sets.map(str::to_owned);
    let case = Case::from_text(&lines.join("\n"), Path::new("small.toml"), &sets).unwrap();
    let there = There::new(case, "mm-ton-s");
    let found = read(&there.back("mm-ton-s"));
    near("torque", found.drive.torque.unwrap(), 120.0);
    // a torque turns the hub by its moment of inertia about the axle, the fourth of its line
    let mut lines: Vec<String> = there.deck.lines().map(str::to_owned).collect();
    let moments = 1 + lines.iter().position(|line| line.contains("IYY")).unwrap();
    lines[moments].replace_range(30..40, "       1.0");
    let error = translated(&lines.join("\n"), "mm-ton-s").unwrap_err();
    assert!(error.to_string().contains("a hub with IYY = "), "{error}");
    assert_eq!(found.mesh.symmetry, Symmetry::Half);
}

#[test]
fn a_creepage_over_time_is_the_curve_of_the_turn() {
    let back = |table: &str| {
        let case = small(&[&format!("drive.creepage={table}")]);
        There::new(case, "mm-ton-s").back("mm-ton-s")
    };
    let found = read(&back("[[0,0],[3e-5,2e-3],[4e-5,2e-3]]"));
    near("creepage", found.drive.creepage.as_ref().and_then(Creepage::number).unwrap(), 2e-3);
    let ramp = found.drive.ramp();
    assert!((ramp / 3e-5 - 1.0).abs() < 1e-3, "{ramp}");
    // a case that is made of a keyword file has one ramp
    let case = small(&["drive.creepage=[[0,0],[3e-5,2e-3],[5e-5,-2e-3]]"]);
    let error = translated(&There::new(case, "mm-ton-s").deck, "mm-ton-s").unwrap_err();
    assert!(error.to_string().contains("while the disk rolls"), "{error}");
}

#[test]
fn what_keyword_files_cannot_say_is_listed_by_key() {
    for (set, key) in [
        ("contact.enforcement=exact", "contact.enforcement"),
        ("friction.memory.distance=1e-6", "friction.memory"),
        ("friction.mode=exact", "friction.mode"),
        ("contact.penalty.normal={ stability = 0.5 }", "contact.penalty.normal"),
        ("drive.spin=0.1", "drive.spin"),
        ("preload.disturbance=1e-12", "preload.disturbance"),
    ] {
        let mut sets = vec![set];
        if set.starts_with("friction") {
            sets.extend(["friction.law=exponential", "friction.dynamic=0.2"]);
        }
        let said = unsayable(&small(&sets));
        assert!(said.len() == 1 && said[0].starts_with(key), "{set}: {said:?}");
    }
    let mut case = small(&[]);
    case.model = BodyModel::HalfSpace;
    assert!(unsayable(&case)[0].starts_with("model"));
}

#[test]
fn cards_of_the_motion_that_a_case_cannot_say_are_refused_by_their_line() {
    let deck = There::new(small(&["mesh.symmetry=half"]), "mm-ton-s").deck;
    let lines: Vec<&str> = deck.lines().collect();
    let after = |card: &str, n: usize| n + lines.iter().position(|line| *line == card).unwrap();
    let depth = lines.iter().position(|line| line.starts_with("         5         3         2"));
    let held = lines.iter().rposition(|line| *line == "*BOUNDARY_SPC_SET").unwrap() + 2;
    let curve = lines.iter().position(|line| *line == "         7").unwrap() + 7;
    let load = after("*LOAD_NODE_POINT", 2);
    for (at, new, words) in [
        // an acceleration
        (depth.unwrap(), "         5         3         1         3", "VAD = 1"),
        // damping of all motion that goes on
        (curve, "           1.0                1000.0", "while the disk rolls"),
        // the nodes whose motion is recorded, which are no plane, do not move along y
        (held, "         4         0         0         1         0", "neither all nodes"),
        (load, "         9         1         4     -5000", "DOF = 1"),
    ] {
        let mut changed = lines.clone();
        assert_ne!(changed[at], new);
        changed[at] = new;
        let error = translated(&changed.join("\n"), "mm-ton-s").unwrap_err();
        assert!(error.to_string().contains(words), "{words}: {error}");
        assert!(error.place.is_some(), "{words}");
    }
}

/// A deck with a line of data in place of another; lines are told by how they begin, the nth of them is meant.
fn changed(deck: &str, (old, nth): (&str, usize), new: &str) -> String {
    let mut lines: Vec<&str> = deck.lines().collect();
    let found = lines.iter().enumerate().filter(|(_, line)| line.starts_with(old));
    let at = found.map(|(at, _)| at).nth(nth).unwrap_or_else(|| panic!("{old}"));
    assert_ne!(lines[at], new);
    lines[at] = new;
    lines.join("\n")
}

#[test]
fn motions_that_would_be_read_as_others_are_refused() {
    let sets = ["mesh.symmetry=half", "drive.lateral_creepage=0", "bar.ends=quiet"];
    let deck = There::new(small(&sets), "mm-ton-s").deck;
    let travel = "         5         1         0         1";
    let turn = "         5         6         0         2";
    // the quiet segments are set 13; 12 is the top
    let quiet = "        13         0         0";
    for (old, new, words) in [
        (travel, "         1         1         0         1", "PID 1, which is not the hub's, 5"),
        (turn, "         5         1         0         2", "a second prescribed motion of DOF = 1"),
        (travel, "         5         1         0         8", "speed (DOF = 1) that ends at 0"),
        (turn, "         5         7         0         2", "turns about DOF = 7"),
        (quiet, "        12         0         0", "off the bar's ends"),
    ] {
        // DOF 7 is prescribed already: it is at rest
        let at_rest = "         5         7         0         8";
        let deck = match words {
            "turns about DOF = 7" => changed(&deck, (at_rest, 0), turn),
            _ => deck.clone(),
        };
        let error = translated(&changed(&deck, (old, 0), new), "mm-ton-s").unwrap_err();
        assert!(error.to_string().contains(words), "{words}: {error}");
        assert!(error.place.is_some(), "{words}");
    }
}

#[test]
fn a_deck_names_its_units_and_what_it_says_nearly() {
    let there =
        There::new(small(&["contact.curvature=true", "contact.normals=\"averaged\""]), "mm-ton-s");
    let head: Vec<&str> = there.deck.lines().take_while(|line| line.starts_with('$')).collect();
    assert!(head.contains(&"$ units: mm-ton-s"), "{head:?}");
    for key in ["curvature", "normals"] {
        let line = format!("$ nearly: contact.{key}");
        assert!(head.iter().any(|found| found.starts_with(&line)), "{head:?}");
    }
    assert!(there.deck.lines().all(|line| line.len() <= 88 || line.starts_with('$')));
    assert!(there.deck.is_ascii());
}
