//! What messages name: keys that there are, and no key in the crates below.

use std::fs;
use std::path::{Path, PathBuf};

use contact::ContactError;
use dynamics::{Cause, RelaxationError, RelaxationReport};
use friction::LawError;
use mesh::import::{Fault, SetRole, Unit};
use mesh::{Allowed, MeshError, Parameter};
use solid::{MaterialError, SolidError};
use statics::StaticsError;

use crate::case::keys::{KEYS, Place, place};
use crate::scenario::Remedy;

/// One value of every variant: a variant that is left out does not compile.
macro_rules! every {
    ($kind:ident: $($variant:ident $fields:tt)*) => {{
        let _ = |value: &$kind| match value { $($kind::$variant { .. } => ()),* };
        [$($kind::$variant $fields),*]
    }};
}

fn roles() -> [SetRole; 6] {
    every!(SetRole: Disk {} Bar {} Hub {} Tread {} Top {} Clamp {})
}

fn parameters() -> [Parameter; 18] {
    every!(Parameter: DiskRadius {} HubRadius {} DiskWidth {} DiskCrown {} BarLength {} BarWidth {}
        BarHeight {} BarCrown {} BarStart {} ZoneSize {} ZoneLength {} ZoneWidth {} ZoneDepth {}
        ZoneStart {} Growth {} Coarsest {} Line {} Plane {})
}

fn mesh_errors() -> Vec<MeshError> {
    let allowed = every!(Allowed: Positive {} Finite {} Growth {} AtLeast (1.0, "") AtMost (1.0, "")
        Below (1.0, "") Between (1.0, 2.0, "") Falls { fall: 2.0, most: 1.0 } Ascending {});
    let out_of_range = parameters().into_iter().flat_map(|parameter| {
        allowed.map(|allowed| MeshError::OutOfRange { parameter, value: 0.0, allowed })
    });
    let (body, face) = (String::new, [0; 4]);
    let others = every!(MeshError:
        OutOfRange { parameter: Parameter::Plane, value: 0.0, allowed: Allowed::Ascending }
        TooManyElements { body: "disk", size: 1.0, estimate: 1.0 }
        BodyRange { body: body() } BadIndex { what: body(), body: body(), index: 0 }
        UnsortedSet { set: body(), body: body() } NotFinite { node: 0, point: [0.0; 3] }
        NegativeJacobian { element: 0, corner: 0, value: 0.0 }
        DuplicateNodes { first: 0, second: 0, point: [0.0; 3] }
        FaceShared { nodes: face, element: 0 } HangingNode { node: 0, face, element: 0 }
        NotAFace { surface: body(), body: body(), nodes: face, hex: 0 } LooseNode { node: 0 });
    out_of_range.chain(others).collect()
}

fn faults() -> Vec<Fault> {
    let (name, body, at) = (String::new, "disk", [0.0; 3]);
    let of_roles = roles().into_iter().flat_map(|role| {
        [
            Fault::MissingSet { role, name: name(), there: name() },
            Fault::EmptySet { role, name: name(), what: "" },
            Fault::OffSurface { node: 0, name: name(), distance: 1.0, role, limit: 1.0 },
            Fault::Uncovered { role, name: name(), covered: 1.0, faces: 1 },
        ]
    });
    let of_sizes =
        parameters().map(|parameter| Fault::Size { parameter, found: 1.0, expected: 1.0 });
    let role = SetRole::Top;
    let others = every!(Fault: Syntax { what: name() } Unsupported { what: name(), remedy: "" }
        Cell { element: 0, kind: name() } NoHexes {} Repeated { what: "", id: 0 }
        Unknown { from: name(), what: name() } NotFinite { node: 0, point: at }
        Collapsed { element: 0, node: 0 } Inverted { element: 0, corner: 1, value: 0.0 }
        Coincident { first: 0, second: 0, body, point: at } FaceShared { element: 0 }
        Hanging { node: 0, element: 0 } SharedNode { node: 0 }
        NoBody { element: 0, of: "", disk: name(), bar: name() }
        MissingSet { role, name: name(), there: name() } NoSets { role, name: name() }
        EmptySet { role, name: name(), what: "" }
        BothBodies { role, name: name(), node: 0, body, other: "bar" }
        NotOutside { role, name: name(), nodes: [0; 4], body }
        SetsMeet { first: name(), second: name(), node: 0 } Loose { body, element: 0 }
        Hole { role, name: name(), edges: 4, at, element: 0 } Open { role, name: name(), element: 0 }
        Axis { role, name: name(), axis: 'x' } Pieces { role, name: name(), element: 0 }
        Fold { role, name: name(), edge: [0; 2] }
        Size { parameter: Parameter::DiskRadius, found: 1.0, expected: 2.0 }
        Unit { found: 1.0, expected: 2.0, unit: Unit::Millimetre }
        Place { what: "", found: 1.0, expected: 2.0 }
        OffSurface { node: 0, name: name(), distance: 1.0, role, limit: 1.0 }
        Uncovered { role, name: name(), covered: 1.0, faces: 1 }
        ZoneSize { disk: 1.0, bar: 1.0, size: 2.0 } NoEnd { which: "", at: 0.0 }
        HalfOfBodies {} Mesh (MeshError::LooseNode { node: 0 }));
    of_roles.chain(of_sizes).chain(others).collect()
}

fn causes() -> Vec<Cause> {
    let weak = Cause::Hourglass { share: 1.0, limit: 0.5, coefficient: 0.0 };
    let unsolved = dynamics::Unsolved { step: 1e-7, iterations: 80, residual: 1.0, change: 1.0 };
    let others = every!(Cause: UnstableStep { ratio: 2.0 } StiffContact { ratio: 2.0 } EnergyGrowth {}
        NotFinite {} Unsolved { 0: unsolved } Friction { mu: 9.0, limit: 5.0, slip_speed: 0.0, pressure: 0.0 }
        Inverted { volume_ratio: -1.0 } Hourglass { share: 1.0, limit: 0.5, coefficient: 0.05 }
        Penetration { depth: 1.0, limit: 0.5, force: 1.0 } ContactLost { since: 0.0, limit: 1.0 }
        MeshMoves { energy: 1.0 } EndOfTrack { hub: 1.0, end: 0.5 });
    others.into_iter().chain([weak]).collect()
}

fn statics_errors() -> impl Iterator<Item = StaticsError> {
    let (body, position) = (String::new, nalgebra::Vector3::zeros());
    let at = statics::Iteration::default();
    every!(StaticsError: NoSuchNode { node: 0 } TwiceSupported { node: 0 } EmptyGroup {}
        NotANumber { value: 0.0 } Floating { body: body(), node: 0 }
        Open { body: body(), axis: 'z', force: 1.0 } Flat { node: 0, body: body(), position }
        Inverted { element: 0, body: body(), centre: position, jacobian: -1.0 }
        Linear { iterations: 1, at }
        Slow { at, tolerance: 1e-9, node: 0, body: body(), position } HeldSlave { node: 0 }
        Interrupted {})
    .into_iter()
}

/// Every remedy that there is for what the crates below find wrong.
fn remedies() -> Vec<String> {
    let all = |errors: &mut dyn Iterator<Item = String>| errors.collect::<Vec<_>>();
    let body = String::new();
    let source = MaterialError { property: "", value: 0.0, range: "" };
    let solid = every!(SolidError: Material { body: body.clone(), source }
        Inverted { body: body.clone(), element: 0, volume: 0.0 }
        Folded { body, element: 0, jacobian: 0.0 } Level ("") Count { bodies: 2, materials: 1 });
    let contact = every!(ContactError: EmptySurface { side: 0 } OutsideMesh { side: 0, face: 0 }
        Degenerate { side: 0, face: 0 } Edge { side: 0, a: 0, b: 1 } SharedNode { node: 0 }
        Value { name: "", value: 0.0, range: "" } NoStabilityScale {});
    let law = every!(LawError: Expression (friction::Expression::new("(").unwrap_err())
        Table (friction::TableError::Empty));
    let report = RelaxationReport::default();
    let relaxation = every!(RelaxationError: Slow { report, tolerance: 1e-8 }
        BlowUp { iteration: 1 } Interrupted {});
    [
        all(&mut mesh_errors().iter().map(Remedy::remedy)),
        all(&mut faults().iter().map(Remedy::remedy)),
        all(&mut causes().iter().map(Remedy::remedy)),
        all(&mut statics_errors().map(|error| error.remedy())),
        all(&mut relaxation.iter().map(Remedy::remedy)),
        all(&mut solid.iter().map(Remedy::remedy)),
        all(&mut contact.iter().map(Remedy::remedy)),
        all(&mut law.iter().map(Remedy::remedy)),
    ]
    .concat()
}

/// Whether a text is the path of a key or of a section.
fn is_there(path: &str) -> bool {
    !matches!(place(path), Place::Nowhere)
}

/// The words in square brackets of a text.
fn in_brackets(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split('[').skip(1).filter_map(|rest| Some(rest.split_once(']')?.0));
    let plain = |word: &str| word.chars().all(|c| c.is_ascii_alphanumeric() || "_.".contains(c));
    words.filter(move |word| plain(word))
}

/// Whether every dotted path in a text is that of a key or a section, and every word in square brackets that of a section.
fn names_only_keys(text: &str) -> bool {
    let words = dotted(text).chain(in_brackets(text));
    words.filter(|word| word.starts_with(|c: char| c.is_ascii_lowercase())).all(is_there)
}

#[test]
fn every_remedy_names_only_keys_that_there_are() {
    let remedies = remedies();
    assert!(remedies.len() > 200);
    for remedy in &remedies {
        assert!(names_only_keys(remedy), "{remedy}");
    }
    assert!(remedies.iter().any(|remedy| remedy.contains("mesh.growth")));
}

#[test]
fn a_key_that_there_is_not_is_seen_in_a_text() {
    for text in
        ["lower mesh.growth.", "[contact.penalty] or [disk]: 0.67, a.b1?", "", "output.window"]
    {
        assert_eq!(names_only_keys(text), !text.contains("a.b1"), "{text}");
    }
    for text in ["mesh.zone.growth", "set mesh.grow", "(mesh.growths)", "[disc]", "mesh.growth.x"] {
        assert!(!names_only_keys(text), "{text}");
    }
}

/// Rust sources of a folder without its tests: path and text.
fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let tests = path.file_stem().is_some_and(|name| name == "tests");
        if path.is_dir() && !tests {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") && !tests {
            let text = fs::read_to_string(&path).unwrap();
            let product = text.split("#[cfg(test)]").next().unwrap_or_default().to_owned();
            found.push((path, product));
        }
    }
    found
}

/// The texts between quotes, also over several lines.
fn literals(text: &str) -> Vec<String> {
    let code: String = text
        .lines()
        .map(|line| if line.trim_start().starts_with("//") { "" } else { line })
        .flat_map(|line| [line, "\n"])
        .collect();
    let (mut found, mut literal) = (Vec::new(), None);
    let mut chars = code.replace("'\"'", "").chars().collect::<Vec<_>>().into_iter();
    while let Some(c) = chars.next() {
        match (&mut literal, c) {
            (Some(_), '"') => found.extend(literal.take()),
            (None, '"') => literal = Some(String::new()),
            (Some(literal), '\\') => literal.extend(chars.next().filter(|c| !c.is_alphanumeric())),
            (Some(literal), c) => literal.push(c),
            (None, _) => {}
        }
    }
    found
}

/// The dotted words of a text.
fn dotted(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || "_.".contains(c)));
    words.map(|word| word.trim_matches('.')).filter(|word| word.contains('.'))
}

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[test]
fn the_crates_below_name_no_key() {
    let is_key = |word: &str| {
        KEYS.iter()
            .filter_map(|key| key.path.strip_prefix(word))
            .any(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    for below in ["mesh", "solid", "contact", "statics", "dynamics"] {
        for (path, text) in sources(&crates().join(below).join("src")) {
            let comments = text.lines().filter(|line| line.trim_start().starts_with("//"));
            let marked = comments.flat_map(|line| line.split('`').skip(1).step_by(2));
            let literals = literals(&text);
            for said in literals.iter().map(String::as_str).chain(marked) {
                let key = dotted(said).find(|word| is_key(word));
                assert_eq!(key, None, "{}: {said}", path.display());
            }
        }
    }
}

#[test]
fn messages_of_cases_and_sweeps_name_only_keys_that_there_are() {
    let top: Vec<_> = KEYS.iter().filter_map(|key| key.path.split_once('.')).map(|k| k.0).collect();
    let files = ["toml", "h5", "vtkhdf", "inp", "vtu", "log", "png", "gif"];
    let of_a_key = |word: &&str| {
        let is_file = files.iter().any(|ending| word.ends_with(ending));
        !is_file && word.split_once('.').is_some_and(|(head, _)| top.contains(&head))
    };
    let mut seen = 0;
    for above in ["creepage", "cli"] {
        for (path, text) in sources(&crates().join(above).join("src")) {
            for literal in literals(&text) {
                for word in dotted(&literal).filter(of_a_key) {
                    seen += 1;
                    assert!(names_only_keys(word), "{}: {literal}", path.display());
                }
            }
        }
    }
    assert!(seen > 150, "{seen}");
}
