//! The contact of disk and bar.

use super::columns::Cards;
use super::{RollingMotion, number};
use crate::case::schema::Stiffness;
use crate::scenario::{BAR, DISK};
use friction::STATIC;

/// Contact of tread and top, with its friction.
pub(super) fn contact(cards: &mut Cards, rolling: &RollingMotion<'_>) {
    let case = rolling.case;
    // the product counts, and some programs read the second factor alone
    cards.card("CONTROL_CONTACT", &[("SLSFAC", 1.0)]);
    cards.keyword("CONTACT_AUTOMATIC_SURFACE_TO_SURFACE");
    let [tread, top] = number::SURFACES.map(|id| id as f64);
    // segment sets on both sides, and a record of the forces on both
    cards.fields(&[
        ("SSID", tread),
        ("MSID", top),
        ("SSTYP", 0.0),
        ("MSTYP", 0.0),
        ("SBOXID", 0.0),
        ("MBOXID", 0.0),
        ("SPR", 1.0),
        ("MPR", 1.0),
    ]);
    let mu = case.friction.value(STATIC);
    let (dynamic, decay) = match case.friction.exponential() {
        Some(law) => (law.mu_dynamic, law.decay),
        None => (mu, 0.0),
    };
    cards.fields(&[
        ("FS", mu),
        ("FD", dynamic),
        ("DC", decay * cards.units().velocity()),
        ("VC", 0.0),
        ("VDC", 100.0 * case.contact.penalty.damping),
    ]);
    let factor = scale_factor(rolling);
    cards.fields(&[("SFS", factor), ("SFM", factor)]);
}

/// The scale factor of the normal springs; of springs that are given in N/m^3 that which gives them between cubes of the
/// fine zone.
fn scale_factor(rolling: &RollingMotion<'_>) -> f64 {
    let size = rolling.case.mesh.zone.size;
    let unit =
        || [DISK, BAR].iter().map(|&b| rolling.model.materials[b].bulk() / size).sum::<f64>();
    match rolling.case.contact.penalty.normal {
        Stiffness::Factor(factor) => factor,
        Stiffness::Areal(both) => both / unit(),
        // refused before
        Stiffness::Stability(_) => f64::NAN,
    }
}
