//! Mutation tests: deliberate errors in the physics, and the rows of the ladder that detect them at [`Size::Quick`].
//!
//! Problems take a deliberate error as an argument; the program itself contains none. The table in
//! docs/verification.md names each error with its row; the numbers of that table are printed by
//! `cargo test --release -p verification --lib planted -- --nocapture --test-threads=1`.
#![allow(clippy::unwrap_used)]

use crate::problem::Outcome;
use crate::row::Row;
use crate::{
    Size, contact_turn, finite_body, free_block, grading_reflection, hertz_stress, interface_patch,
    mindlin, patch, rolling_limits, shear_column, sliding, unlike,
};
use contact::{ContactRestart, PenaltyContact};
use friction::{Implicit, Lagged};
use mesh::Mesh;
use nalgebra::Vector3;
use solid::Element;

/// The document with the table of faults.
const TABLE: &str = include_str!("../../docs/verification.md");

/// Asserts that the row passes without the fault and fails with it, and that the table has it.
fn catches(fault: &str, problem: &str, quantity: &str, sound: Outcome, planted: Outcome) {
    let row = |found: Outcome| -> Row {
        let found = found.unwrap().into_iter().find(|row| row.quantity.contains(quantity));
        found.unwrap_or_else(|| panic!("{problem} has no row '{quantity}'"))
    };
    let (sound, planted) = (row(sound), row(planted));
    let line = format!("| {fault} | `{problem}`: {} |", sound.quantity);
    println!("{line} {:.1e} | {:.1e} | {:.1e} |", sound.error, planted.error, sound.limit);
    stands_in_the_table(&line);
    fails(&sound, &planted);
}

fn stands_in_the_table(line: &str) {
    assert!(TABLE.lines().any(|found| found == line), "docs/verification.md lacks: {line}");
}

#[track_caller]
fn fails(sound: &Row, planted: &Row) {
    assert!(sound.pass, "without the fault: {sound:?}");
    assert!(!planted.pass, "with the fault: {planted:?}");
    // a fault may also change its row's own limit: its error must exceed that of the sound problem
    assert!(planted.error > sound.limit || planted.error.is_nan(), "{planted:?}");
}

/// Asserts the same of each of several rows, and that the table has the fault with `which` rows of the problem.
fn catches_all(fault: &str, problem: &str, which: &str, sound: &[Row], planted: &[Row]) {
    assert_eq!(sound.len(), planted.len());
    for (sound, planted) in sound.iter().zip(planted) {
        let [was, is, limit] = [sound.error, planted.error, sound.limit];
        println!(
            "| {fault} | `{problem}`: {} | {was:.1e} | {is:.1e} | {limit:.1e} |",
            sound.quantity
        );
    }
    stands_in_the_table(&format!("| {fault} | `{problem}`: {which} |"));
    sound.iter().zip(planted).for_each(|(sound, planted)| fails(sound, planted));
}

#[test]
fn friction_one_per_cent_off_is_caught_by_the_sliding_block() {
    catches(
        "mu 1 % off",
        "block-slide-exact",
        "distance to the stop",
        sliding::stop_exact(Size::Quick),
        sliding::stop_exact_with(Size::Quick, 1.01 * sliding::MU),
    );
}

#[test]
fn a_load_twenty_per_cent_up_is_caught_by_the_stress_below() {
    catches(
        "load 20 % up",
        "hertz-stress",
        "bar: greatest shear",
        hertz_stress::run(Size::Quick),
        hertz_stress::run_with(Size::Quick, &["load.normal=120e3"]),
    );
}

#[test]
fn the_area_of_a_face_five_per_cent_off_is_caught_by_the_interface_patch() {
    // the corner belongs to one face alone
    let widen = |mesh: &mut Mesh| {
        let surface = &mesh.bodies[0].surfaces["z-"];
        let least = |n: &&u32| mesh.nodes[**n as usize].iter().sum::<f64>();
        let nodes = surface.faces.iter().flat_map(|face| &face.nodes);
        let corner = *nodes.min_by(|a, b| least(a).total_cmp(&least(b))).unwrap() as usize;
        let edge = 10e-3 / 6.0;
        mesh.nodes[corner][0] -= 0.1 * edge;
    };
    catches(
        "area of one face 5 % off",
        "interface-patch",
        "6 on 6 elements, node to face: pressure over the applied one, less 1, largest",
        interface_patch::run(Size::Quick),
        interface_patch::run_with(Size::Quick, widen),
    );
}

#[test]
fn elements_without_hourglass_control_are_caught_by_the_energy_of_their_modes() {
    catches(
        "hourglass control off",
        "patch",
        "energy of an hourglass mode",
        patch::patch(Size::Quick),
        patch::patch_with(Element { hourglass: 0.0 }),
    );
}

#[test]
fn friction_of_the_step_before_is_caught_by_the_law_of_the_same_step() {
    catches(
        "lag in place of the same instant",
        "shear-column",
        "shear of slip off mu(s) p of the same step",
        shear_column::run(Size::Quick),
        shear_column::run_with(Size::Quick, || Box::new(Lagged(shear_column::LAW)), None),
    );
    // the same friction made in another way passes
    let same = shear_column::run_with(Size::Quick, || Box::new(Implicit(shear_column::LAW)), None);
    assert!(same.unwrap().iter().all(|row| row.pass));
}

#[test]
fn gaps_of_the_polygon_are_caught_by_the_rolling_disk() {
    let nothing = |_: &mut PenaltyContact, _: Vector3<f64>| Ok(());
    catches(
        "gap without curvature",
        "contact-turn",
        "gaps under a rolling disk",
        contact_turn::run_with(true, nothing),
        contact_turn::run_with(false, nothing),
    );
}

#[test]
fn half_the_mass_of_a_surface_node_is_caught_by_the_free_block() {
    catches(
        "half the mass of a surface node",
        "free-block",
        "n = 4",
        free_block::run(Size::Quick),
        free_block::run_with(Size::Quick, |mass| mass[mass.len() - 1] *= 0.5),
    );
}

#[test]
fn friction_that_does_not_turn_with_the_face_is_caught_by_a_turn() {
    /// Turns what the springs hold back by the part of the turn along the normal: it stays as it is in space.
    fn back(contact: &mut PenaltyContact, turn: Vector3<f64>) -> Result<(), crate::Cause> {
        let mut state = toml::Value::try_from(contact.snapshot()).unwrap();
        let reals = |value: &toml::Value| -> Vec<f64> { value.clone().try_into().unwrap() };
        let passes = state["points"]["Penalty"].as_array_mut().unwrap();
        for point in passes.iter_mut().flat_map(|pass| pass.as_array_mut().unwrap()) {
            let (n, f) = (reals(&point["normal"]), reals(&point["framed"]));
            let angle: f64 = (0..3).map(|k| n[k] * turn[k]).sum();
            let (s, c) = libm::sincos(angle);
            point["framed"] = vec![c * f[0] + s * f[1], c * f[1] - s * f[0]].into();
        }
        let state = state.try_into().unwrap();
        Ok(contact.restore(&state)?)
    }
    catches(
        "friction not turned with the face",
        "contact-turn",
        "force of friction after a turn",
        contact_turn::run_with(true, |_, _| Ok(())),
        contact_turn::run_with(true, back),
    );
}

#[test]
fn creepage_by_the_nominal_radius_is_caught_by_the_disk_on_the_bar() {
    let found = finite_body::rolled(finite_body::QUICK).unwrap();
    catches(
        "creepage by the nominal radius",
        "finite-body",
        "creepage of free rolling",
        Ok(finite_body::disk_on_bar(&found, |rolled| rolled.free)),
        Ok(finite_body::disk_on_bar(&found, |_| 0.0)),
    );
}

#[test]
fn mass_missing_where_elements_grow_is_caught_by_the_wave_that_comes_back() {
    let lighter = |mesh: &Mesh, mass: &mut [f64]| {
        let below = mesh.nodes.iter().zip(mass).filter(|(x, _)| x[2] < -4.5e-3);
        below.for_each(|(_, mass)| *mass *= 0.95);
    };
    catches(
        "mass 5 % off below the fine zone",
        "grading-reflection",
        "P wave, 2:1, growth 1.35",
        grading_reflection::run(Size::Quick),
        grading_reflection::run_with(Size::Quick, lighter),
    );
}

#[test]
fn friction_off_is_caught_by_a_shift_to_and_fro() {
    let run = |friction: &str| mindlin::run_with(Size::Quick, &[friction]);
    let sound = run("friction.static=4e-4").unwrap();
    let first = "Q/(mu N) at the first turn";
    let off = run("friction.static=4.1e-4");
    catches("mu 2.5 % off in a shift", "mindlin", first, Ok(sound.clone()), off);
    let off = run("friction.static=4.8e-4").unwrap();
    catches_all("mu 20 % off in a shift", "mindlin", "every row", &sound, &off);
}

#[test]
fn normals_of_single_faces_are_caught_by_rolling_without_friction() {
    let run =
        |contact, planted: &[&str]| rolling_limits::without_friction(contact, planted).unwrap();
    let contacts = [rolling_limits::PENALTY, rolling_limits::NODE_TO_FACE];
    let sound = contacts.map(|contact| run(contact, &[]));
    let faces = contacts.map(|contact| run(contact, &["contact.normals=face"]));
    let which = "T/N without friction, penalty and node to face";
    catches_all("normals of single faces", "rolling-limits", which, &sound, &faces);
    // mortar rows have no normals of faces
    let mortar = |planted: &[&str]| Ok(vec![run(rolling_limits::MORTAR, planted)]);
    let rough = mortar(&["friction.static=1e-3"]);
    catches("mu of 0.001 in place of none", "rolling-limits", "mortar", mortar(&[]), rough);
}

#[test]
fn friction_off_is_caught_by_gross_sliding() {
    let run = |planted: &[&str]| {
        Ok(vec![rolling_limits::in_gross_sliding(rolling_limits::MORTAR, planted)?])
    };
    let off = run(&["friction.static=0.505"]);
    catches("mu 1 % off in gross sliding", "rolling-limits", "at 20 per mille", run(&[]), off);
}

#[test]
fn damping_that_takes_power_is_caught_by_the_power_of_friction() {
    let run =
        |planted: &[&str]| Ok(vec![rolling_limits::power(rolling_limits::NODE_TO_FACE, planted)?]);
    let damped = run(&["damping.kelvin_voigt=1e-6"]);
    catches(
        "damping by 1 us of stiffness",
        "rolling-limits",
        "power of friction",
        run(&[]),
        damped,
    );
}

#[test]
fn memory_lost_in_a_zone_that_moves_is_caught_by_the_zone_that_stays() {
    let run = |planted: &[&str]| Ok(vec![rolling_limits::in_a_window(planted)?]);
    let lost = run(&["friction.memory.distance=100e-6"]);
    catches(
        "memory ten times as long in a zone that moves",
        "rolling-limits",
        "in a zone that moves",
        run(&[]),
        lost,
    );
}

#[test]
fn a_material_off_is_caught_by_free_rolling_of_unlike_ones() {
    let run = |planted: &[&str]| unlike::run_with(Size::Quick, planted);
    let off = run(&["disk.material.poisson=0.33"]);
    let free = "(omega R - V)/V of free rolling";
    catches("nu 0.33 in place of 0.31 in one body", "unlike-materials", free, run(&[]), off);
}
