//! What the other program is to write, at the intervals of the case.

use super::columns::Cards;
use super::{RollingMotion, number};

/// Fields, interface forces, motion of the nodes of both fine zones, resultants and energies.
pub(super) fn requests(cards: &mut Cards, rolling: &RollingMotion<'_>) {
    let (case, unit) = (rolling.case, cards.units().time());
    let interval = case.output.contact_interval / unit;
    let step = case.duration() / rolling.facts.steps as f64;
    let often = case.output.history_interval as f64 * step / unit;
    cards.card("DATABASE_BINARY_D3PLOT", &[("DT", case.fields_interval() / unit)]);
    cards.card("DATABASE_BINARY_INTFOR", &[("DT", interval)]);
    for name in ["DATABASE_NODOUT", "DATABASE_NCFORC"] {
        // into binout, also where text is the default
        cards.card(name, &[("DT", interval), ("BINARY", 2.0)]);
    }
    for name in ["DATABASE_GLSTAT", "DATABASE_RCFORC", "DATABASE_RBDOUT"] {
        cards.card(name, &[("DT", often)]);
    }
    cards.card("DATABASE_HISTORY_NODE_SET", &[("ID1", number::RECORDED as f64)]);
}
