//! Rolling whose forces and power are known beforehand: no tangential force without friction, `mu N` in gross sliding, and
//! a power of friction equal to `T xi V`.
//!
//! The reference case A rolls on 2 mm, by penalty and by both rows of exact contact. Where nodes meet faces along the
//! normals of the faces, the load pushes the disk along by about h/(4R) of itself (contact::Normals), and this force takes
//! a part of the power. Without friction a tenth of that is asked.

use crate::problem::{Cause, Outcome, Size};
use crate::rolling_dynamic::summary;
use crate::row::Row;

/// Size of the elements (m).
const SIZE: f64 = 2e-3;
/// Radius of the disk (m).
const RADIUS: f64 = 0.46;
const MU: f64 = 0.5;

/// The name of a way of enforcing contact, and its keys.
type Contact = (&'static str, &'static [&'static str]);

const CONTACTS: [Contact; 3] = [
    ("penalty", &["contact.penalty.normal=1", "contact.penalty.tangential=1"]),
    ("node to face", &["contact.enforcement=exact"]),
    ("mortar", &["contact.enforcement=exact", "contact.rows=mortar"]),
];

pub(crate) fn run(_: Size) -> Outcome {
    let mut rows = Vec::new();
    for contact in CONTACTS {
        rows.extend(judged(contact)?);
    }
    Ok(rows)
}

fn judged((name, keys): Contact) -> Result<[Row; 3], Cause> {
    let rolled = |more: &[&str]| summary(SIZE, &[keys, more].concat());
    let at = |what: &str| format!("{name}: {what}");
    let frictionless = rolled(&["friction.static=0", "time.roll=0.02"])?;
    let sliding = rolled(&["drive.creepage=20e-3"])?;
    let partly = rolled(&[])?;
    let traction = "contact.traction_coefficient";
    let power = partly.number("window.friction_power")?;
    let [force, creepage] = [partly.number("contact.tangential_force")?, partly.number("contact.creepage")?];
    Ok([
        Row::new(
            at("T/N without friction"),
            [0.0, frictionless.number(traction)?],
            1.0,
            (0.1 * SIZE / (4.0 * RADIUS), "a tenth of h/(4R), what normals of faces give"),
            "equilibrium",
        ),
        Row::asked(at("T/N in gross sliding"), [MU, sliding.number(traction)?], 1e-3, "T = mu N"),
        Row::asked(at("power of friction (W)"), [force * creepage * SPEED, power], 0.01, "T xi V"),
    ])
}
