//! Rolling whose tangential force is known beforehand: none without friction, and `mu N` in gross sliding.
//!
//! The reference case A rolls on 2 mm by penalty and by exact contact. Where a node meets a face along the normal of that
//! face, the load pushes the disk along by about h/(4R) of itself (`contact::Normals`); of that a tenth is asked.
//!
//! In steady rolling the friction at the contact takes up what drives it, the power T xi V.
//!
//! In gross sliding the shear `q = mu p` tilts the common surface of both bodies by (1 - 2 nu) q/(2G) (Johnson 1985,
//! section 2.4), so that T/N falls short of mu by that mean angle times 1 + mu^2.

use crate::half_space::WHEEL;
use crate::problem::{Cause, Outcome, Size};
use crate::rolling_dynamic::{mean, run_at};
use crate::row::Row;
use output::summary::Mean;

/// Size of the elements (m).
const SIZE: f64 = 2e-3;
/// The friction of case A.
const MU: f64 = 0.5;
/// The material of case A.
const YOUNG: f64 = 210e9;
const POISSON: f64 = 0.3;
/// The speed of case A (m/s).
const SPEED: f64 = 38.89;

/// The name of a contact and its keys.
pub(crate) type Contact = (&'static str, &'static [&'static str]);

pub(crate) const PENALTY: Contact =
    ("penalty", &["contact.penalty.normal=1", "contact.penalty.tangential=1"]);
pub(crate) const NODE_TO_FACE: Contact = ("node to face", &["contact.enforcement=exact"]);
pub(crate) const MORTAR: Contact =
    ("mortar", &["contact.enforcement=exact", "contact.rows=mortar"]);

pub(crate) fn run(size: Size) -> Outcome {
    let mut rows = Vec::new();
    for contact in [PENALTY, NODE_TO_FACE, MORTAR] {
        rows.push(without_friction(contact, &[])?);
    }
    for contact in [PENALTY, NODE_TO_FACE, MORTAR] {
        rows.push(in_gross_sliding(contact, &[])?);
    }
    rows.push(power(NODE_TO_FACE, &[])?);
    if size == Size::Full {
        rows.push(power(MORTAR, &[])?);
        rows.push(in_a_window(&[])?);
    }
    Ok(rows)
}

fn traction((_, keys): Contact, more: &[&str]) -> Result<f64, Cause> {
    let keys: Vec<String> = keys.iter().chain(more).map(|key| (*key).to_owned()).collect();
    Ok(mean(&run_at(SIZE, keys)?, Mean::TractionCoefficient)?)
}

/// Rolling without friction, where no key of the run is `planted`.
pub(crate) fn without_friction(contact: Contact, planted: &[&str]) -> Result<Row, Cause> {
    let keys = ["friction.static=0", "time.roll=0.02", "drive.ramp=0.2e-3"];
    let found = traction(contact, &[&keys, planted].concat())?;
    let limit = 0.1 * SIZE / (4.0 * WHEEL.radii[0]);
    let from = "a tenth of h/(4R), the push along normals of faces";
    let what = format!("{}: T/N without friction", contact.0);
    Ok(Row::new(what, [0.0, found], 1.0, (limit, from), "equilibrium"))
}

/// Gross sliding, where no key of the run is `planted`.
pub(crate) fn in_gross_sliding(contact: Contact, planted: &[&str]) -> Result<Row, Cause> {
    let found = traction(contact, &[&["drive.creepage=20e-3"], planted].concat())?;
    let [a, b] = WHEEL.half_axes;
    let mean_pressure = WHEEL.load / (std::f64::consts::PI * a * b);
    let shear_modulus = YOUNG / (2.0 * (1.0 + POISSON));
    let tilt = (1.0 - 2.0 * POISSON) * MU * mean_pressure / (2.0 * shear_modulus);
    let limit = tilt * (1.0 + MU * MU) / MU;
    let from = "tilt of the surface under shear, (1 - 2 nu) mu p_m/(2G), times (1 + mu^2)/mu";
    let what = format!("{}: T/N at 20 per mille", contact.0);
    Ok(Row::new(what, [MU, found], MU, (limit, from), "T = mu N"))
}

/// Keys of steady rolling at T/N = 0.28: the wind-up of the bodies takes 100 mm.
const STEADY: [&str; 2] = ["mesh.window=0.04", "time.roll=0.12"];

/// The power of friction, where no key of the run is `planted`.
pub(crate) fn power((name, keys): Contact, planted: &[&str]) -> Result<Row, Cause> {
    let keys = [keys, &STEADY, planted].concat();
    let summary = run_at(SIZE, keys.iter().map(|&key| key.to_owned()).collect())?;
    let number = |of| mean(&summary, of);
    let driven = number(Mean::TangentialForce)? * number(Mean::Creepage)? * SPEED;
    let friction = number(Mean::FrictionPower)?;
    let limit = (0.01, "asked: 0.6 % are missing on 2 mm, 0.1 % on 1 mm and 0.5 mm");
    Ok(Row::new(
        format!("{name}: power of friction (W)"),
        [driven, friction],
        driven,
        limit,
        "T xi V",
    ))
}

/// A zone of fine elements that follows the contact takes the place of one for the whole way, also for friction with
/// memory, which the nodes carry; `planted` keys are those of the run with the moving zone alone.
pub(crate) fn in_a_window(planted: &[&str]) -> Result<Row, Cause> {
    let memory = [
        "friction.law=exponential",
        "friction.dynamic=0.32",
        "friction.decay=6",
        "friction.memory.distance=10e-6",
    ];
    let rolled = |window: &[&str]| traction(NODE_TO_FACE, &[&memory, window].concat());
    let [whole, moving] = [rolled(&[])?, rolled(&[&["mesh.window=0.04"], planted].concat())?];
    let limit = (0.01, "asked: the elements outside the zone are coarser");
    Ok(Row::new(
        "node to face, memory of 10 um: T/N in a zone that moves",
        [whole, moving],
        whole,
        limit,
        "one zone",
    ))
}
