//! Choices that go together.

use friction::{Kind, Mode};

use super::Findings;
use crate::case::schema::{Case, Enforcement, LoadMode, PreloadMethod};
use crate::case::value::number;

/// Checks that the choices of a case go together.
pub(super) fn check(case: &Case, found: &mut Findings<'_>) {
    found.require(
        case.drive.ramp.is_none() || case.drive.rises(),
        &["drive.ramp", "drive.creepage"],
        "drive.ramp is not used where drive.creepage is a table over time",
        "leave drive.ramp out: the table says how the creepage rises",
    );
    check_implicit(case, found);
    check_exact_friction(case, found);
    check_preload(case, found);
}

/// Implicit steps solve the conditions of exact contact, and have a length.
fn check_implicit(case: &Case, found: &mut Findings<'_>) {
    let explicit = case.theta().is_none();
    found.require(
        explicit || case.contact.enforcement == Enforcement::Exact,
        &["time.integrator", "contact.enforcement"],
        "time.integrator = \"implicit\" does not go with contact.enforcement = \"penalty\": it solves the conditions of exact \
         contact",
        "set contact.enforcement = \"exact\", or leave time.integrator out",
    );
    found.require(
        explicit || case.time.step.is_some(),
        &["time.integrator", "time.factor", "time.step"],
        "time.integrator = \"implicit\" needs time.step: it has no stability limit that a step could be a fraction of",
        "give time.step in seconds, such as 2.5e-6; while a node passes an element of the fine zone there should be \
         several steps",
    );
}

/// Friction of the slip velocity of the same instant has no memory, and rate and state needs contact that is solved for.
fn check_exact_friction(case: &Case, found: &mut Findings<'_>) {
    if case.friction.mode != Some(Mode::Exact) {
        return;
    }
    found.require(
        case.friction.law != Kind::RateState
            || case.contact.enforcement == Enforcement::Exact
            || case.is_half_space(),
        &["friction.mode", "friction.law", "contact.enforcement"],
        "friction.mode = \"exact\" of rate and state needs exact enforcement of contact: its friction vanishes at rest, so that \
         springs would not hold",
        "set contact.enforcement = \"exact\", or friction.mode = \"lagged\"",
    );
    found.require(
        case.friction.memory.is_none(),
        &["friction.mode", "friction.memory"],
        "friction.mode = \"exact\" and friction.memory are both given: friction with memory does not depend on the slip \
         velocity of the instant",
        "leave one of them out",
    );
}

/// The preload has a solution, and what follows from it is asked for only where there is one.
fn check_preload(case: &Case, found: &mut Findings<'_>) {
    let method = case.preload.method;
    let (relaxed, preloaded) = (method == PreloadMethod::Relaxation, method != PreloadMethod::None);
    found.require(
        case.element.hourglass > 0.0 || method != PreloadMethod::Static,
        &["element.hourglass"],
        "element.hourglass = 0 leaves the elements without stiffness against hourglassing: the static preload has no \
         solution",
        "raise element.hourglass to 0.05, its default; 0.01 to 0.1 is the sensible range",
    );
    found.require(
        !relaxed || case.contact.enforcement == Enforcement::Penalty,
        &["preload.method", "contact.enforcement"],
        "preload.method = \"relaxation\" needs contact springs, and exact enforcement has none",
        "set preload.method = \"static\"",
    );
    found.require(
        !relaxed || !case.mesh.plane_strain,
        &["preload.method", "mesh.plane_strain"],
        "preload.method = \"relaxation\" lets every node move across, and mesh.plane_strain = true holds them in the plane",
        "set preload.method = \"static\"",
    );
    found.require(
        !preloaded || case.disk.lift == 0.0,
        &["disk.lift"],
        format_args!(
            "disk.lift = {} m: the disk does not touch the bar, so it cannot be preloaded",
            number(case.disk.lift)
        ),
        "leave disk.lift out (0: the disk touches), or drop the disk with preload.method = \"none\"",
    );
    found.require(
        preloaded || case.load.mode == LoadMode::Load,
        &["load.mode"],
        "load.mode = \"height\" holds the height of the preload, but there is none",
        "set preload.method = \"static\", or load.mode = \"load\"",
    );
}
