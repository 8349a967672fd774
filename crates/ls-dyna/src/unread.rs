//! Cards that are not read: those that a case does without, and those that are refused, with what to do instead.

use crate::cards::{Card, TENS};
use crate::error::{DeckError, unsupported};

/// Begins of keywords that control the method or ask for output, and those among them that change what is computed.
const PASSED_OVER: [&str; 2] = ["CONTROL_", "DATABASE_"];
const CHANGING: [&str; 7] = [
    "CONTROL_ADAP",
    "CONTROL_COUPLING",
    "CONTROL_IMPLICIT",
    "CONTROL_REFINE",
    "CONTROL_REMESHING",
    "CONTROL_STAGED",
    "CONTROL_THERMAL",
];

/// Cards that change nothing as long as a field, by index and name, is blank or 0.
const SWITCHES: [(&str, usize, &str); 3] = [
    ("CONTROL_DYNAMIC_RELAXATION", 7, "IDRFLG"),
    ("CONTROL_IMPLICIT_GENERAL", 0, "IMFLAG"),
    ("CONTROL_SOLUTION", 0, "SOLN"),
];

/// Keywords without a word about the model.
const UNREMARKABLE: [&str; 3] = ["TITLE", "COMMENT", "PARAMETER"];

/// What to do instead of a card, by the begin of its keyword; the first that fits.
const HINTS: [(&str, &str); 36] = [
    ("CONTROL_IMPLICIT", "leave it out, and set time.integrator = \"implicit\" in the case"),
    ("CONTROL_", "leave it out: bodies are elastic, and their mesh stays"),
    ("INCLUDE_PATH", "write the folder in front of the names of *INCLUDE"),
    ("INCLUDE", "write the file out as it is meant, and name it in *INCLUDE"),
    ("PARAMETER", "write the numbers themselves, in *PARAMETER"),
    ("ELEMENT_INERTIA", "give the hub its mass as TM of *CONSTRAINED_NODAL_RIGID_BODY_INERTIA"),
    ("ELEMENT_MASS", "give the hub its mass as TM of *CONSTRAINED_NODAL_RIGID_BODY_INERTIA"),
    ("ELEMENT_", "mesh both bodies with *ELEMENT_SOLID of eight nodes"),
    ("SECTION_", "use *SECTION_SOLID: both bodies are solids"),
    ("MAT_RIGID", "make the hub a *CONSTRAINED_NODAL_RIGID_BODY, and both bodies *MAT_ELASTIC"),
    ("MAT_020", "make the hub a *CONSTRAINED_NODAL_RIGID_BODY, and both bodies *MAT_ELASTIC"),
    ("MAT_", "use *MAT_ELASTIC: both bodies are elastic"),
    ("EOS_", "leave it out, and use *MAT_ELASTIC"),
    ("PART_", "use *PART, and *CONSTRAINED_NODAL_RIGID_BODY_INERTIA for the mass of the hub"),
    ("CONTACT_", "use *CONTACT_AUTOMATIC_SURFACE_TO_SURFACE between disk and bar"),
    ("SET_SOLID", "leave it out: contact, clamp and hub are sets of segments, parts and nodes"),
    ("SET_SHELL", "leave it out: contact, clamp and hub are sets of segments, parts and nodes"),
    ("SET_", "list the members: *SET_NODE_LIST, *SET_SEGMENT or *SET_PART_LIST"),
    ("CONSTRAINED_", "hold the hub by one *CONSTRAINED_NODAL_RIGID_BODY"),
    ("BOUNDARY_PRESCRIBED_MOTION", "move the hub: *BOUNDARY_PRESCRIBED_MOTION_RIGID of its PID"),
    ("BOUNDARY_", "clamp by *BOUNDARY_SPC_SET; quiet ends are *BOUNDARY_NON_REFLECTING"),
    ("LOAD_BODY", "leave it out: weight is no load of a case"),
    ("LOAD_GRAVITY", "leave it out: weight is no load of a case"),
    ("LOAD_", "load the hub: *LOAD_RIGID_BODY, *LOAD_NODE_SET or *LOAD_NODE_POINT"),
    ("INITIAL_VELOCITY", "use *INITIAL_VELOCITY_GENERATION of the disk"),
    ("INITIAL_", "leave it out: a case begins without stresses, and finds its preload"),
    ("DAMPING_", "use *DAMPING_RELATIVE to the hub, or *DAMPING_PART_STIFFNESS"),
    ("DEFINE_CURVE", "use *DEFINE_CURVE with its points"),
    ("DEFINE_BOX", "leave it out, and list the members of sets"),
    ("DEFINE_COORDINATE", "leave it out, and give everything in the global system"),
    ("DEFINE_FRICTION", "give FS, FD and DC on the card of the contact"),
    ("DEFINE_TRANSFORMATION", "leave it out, and write the coordinates as they are meant"),
    ("DEFINE_VECTOR", "leave it out, and give everything in the global system"),
    ("DEFINE_", "use curves with their points: *DEFINE_CURVE"),
    ("RIGIDWALL", "mesh the bar: contact is between two bodies of solids"),
    ("NODE_", "use *NODE, in the global system"),
];

/// Whether a case does without the card.
///
/// # Errors
/// A card that switches another method on.
pub(super) fn passed_over(card: &Card) -> Result<bool, DeckError> {
    let name = card.name.as_str();
    if let Some((_, field, word)) = SWITCHES.iter().find(|(switch, ..)| *switch == name) {
        card.line(0)?.fields(&TENS).unused(name, &[(*field, word)])?;
        return Ok(true);
    }
    let begins = |begin: &&str| name.starts_with(begin);
    Ok(unremarkable(name) || PASSED_OVER.iter().any(begins) && !CHANGING.iter().any(begins))
}

/// Whether that need not be said.
pub(super) fn unremarkable(name: &str) -> bool {
    name.starts_with("KEYWORD") || UNREMARKABLE.contains(&name)
}

/// The refusal of a card.
pub(super) fn refused(card: &Card) -> DeckError {
    let hint = HINTS.iter().find(|(begin, _)| card.name.starts_with(begin));
    let remedy = hint.map_or(
        "leave the card out if the model does without it; the cards that are read: docs/ls-dyna.md",
        |(_, remedy)| remedy,
    );
    unsupported(&card.place, format!("*{}", card.name), remedy)
}
