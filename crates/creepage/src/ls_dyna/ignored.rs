//! Cards that are not read: those that a case does without, and those that are refused, with what to do instead.

use crate::ls_dyna::cards::Card;
use crate::ls_dyna::error::{DeckError, unsupported};

/// Why a case does without a card.
pub(super) enum Why {
    /// It is a heading or a remark.
    Heading,
    /// It asks for output.
    Output,
    /// It says how LS-DYNA computes, or runs on a machine.
    Method,
    /// It is about what two bodies of hexahedra on a rigid hub lack: shells, tetrahedra, joints.
    Absent,
}

/// Cards that are ignored, by keyword or, where it ends with `_`, by the begin of it.
pub(super) const IGNORED: [(&str, Why); 17] = [
    ("TITLE", Why::Heading),
    ("COMMENT", Why::Heading),
    ("CONTROL_ACCURACY", Why::Method),
    ("CONTROL_CPU", Why::Method),
    ("CONTROL_DEBUG", Why::Output),
    ("CONTROL_ENERGY", Why::Output),
    ("CONTROL_LSDA", Why::Output),
    ("CONTROL_MPP_", Why::Method),
    ("CONTROL_OUTPUT", Why::Output),
    ("CONTROL_PARALLEL", Why::Method),
    ("CONTROL_REQUIRE_REVISION", Why::Method),
    ("CONTROL_RIGID", Why::Absent),
    ("CONTROL_SHELL", Why::Absent),
    ("CONTROL_SOLID", Why::Absent),
    ("CONTROL_STRUCTURED", Why::Output),
    ("CONTROL_STRUCTURED_TERM", Why::Output),
    ("DATABASE_", Why::Output),
];

/// Cards that change nothing as long as a field, by its place from 0 and its name, is blank or 0.
const SWITCHES: [(&str, usize, &str); 3] = [
    ("CONTROL_DYNAMIC_RELAXATION", 7, "IDRFLG"),
    ("CONTROL_IMPLICIT_GENERAL", 0, "IMFLAG"),
    ("CONTROL_SOLUTION", 0, "SOLN"),
];

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
pub(super) fn ignored(card: &Card) -> Result<bool, DeckError> {
    if let Some((_, switch, name)) = SWITCHES.iter().find(|(keyword, ..)| *keyword == card.name) {
        card.line(0)?.switched_off(*switch, name)?;
        return Ok(true);
    }
    if card.name == "TITLE" {
        card.ends_after(1)?;
    }
    Ok(IGNORED.iter().any(|(keyword, _)| {
        *keyword == card.name || keyword.ends_with('_') && card.name.starts_with(keyword)
    }))
}

/// Whether that need not be said.
pub(super) fn unremarkable(keyword: &str) -> bool {
    IGNORED.iter().any(|(name, why)| *name == keyword && matches!(why, Why::Heading))
}

/// The refusal of a card.
pub(super) fn refusal(card: &Card) -> DeckError {
    let hint = HINTS.iter().find(|(begin, _)| card.name.starts_with(begin));
    let remedy = hint.map_or(
        "leave the card out if the model does without it; the cards that are read: docs/ls-dyna.md",
        |(_, remedy)| remedy,
    );
    unsupported(&card.place, format!("*{}", card.name), remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_document_lists_all_cards_that_are_ignored_and_no_others() {
        let document = include_str!("../../../../docs/ls-dyna.md");
        let (_, list) = document.split_once("### Cards that are ignored").unwrap();
        let (list, _) = list.split_once("Fields of other cards").unwrap();
        let mut listed: Vec<_> =
            list.split('`').filter_map(|word| word.strip_prefix('*')).collect();
        listed.sort_unstable();
        let mut ignored: Vec<_> = IGNORED
            .iter()
            .map(
                |(name, _)| if name.ends_with('_') { format!("{name}...") } else { (*name).into() },
            )
            .collect();
        ignored.sort_unstable();
        assert_eq!(listed, ignored);
    }
}
