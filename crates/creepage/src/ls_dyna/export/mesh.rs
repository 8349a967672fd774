//! Nodes, elements, parts and sets, and what holds the nodes.

use super::columns::Cards;
use super::{RollingMotion, number};
use crate::scenario::{BAR, DISK};
use std::collections::BTreeSet;

/// Parts and sections. A body has a second part where some of its elements are fully integrated.
pub(super) fn bodies(cards: &mut Cards, rolling: &RollingMotion<'_>) {
    for (section, form) in number::SECTIONS.into_iter().zip([1.0, 2.0]) {
        cards.card("SECTION_SOLID", &[("SECID", section as f64), ("ELFORM", form)]);
    }
    let parts = [number::PARTS, number::FULL];
    for (i, layers) in ["", ", fully integrated layers"].into_iter().enumerate() {
        if i == 1 && rolling.model.fully_integrated() == 0 {
            continue;
        }
        for (body, name) in [(DISK, "disk"), (BAR, "bar")] {
            cards.keyword("PART");
            cards.line(&format!("{name}{layers}"));
            let fields = [
                ("PID", parts[i][body]),
                ("SECID", number::SECTIONS[i]),
                ("MID", number::PARTS[body]),
            ];
            cards.fields(&fields.map(|(name, id)| (name, id as f64)));
        }
    }
}

/// Nodes, elements, sets, and the nodes and faces that are held.
pub(super) fn mesh(cards: &mut Cards, rolling: &RollingMotion<'_>) {
    let model = rolling.model;
    let held = |set: u64, dofs: [f64; 3]| {
        let [x, y, z] = dofs;
        [("NSID", set as f64), ("CID", 0.0), ("DOFX", x), ("DOFY", y), ("DOFZ", z)]
    };
    cards.card("BOUNDARY_SPC_SET", &held(number::CLAMPED, [1.0; 3]));
    cards.node_set(number::CLAMPED, &model.clamped);
    let sliding = sliding(rolling);
    if !sliding.is_empty() {
        cards.card("BOUNDARY_SPC_SET", &held(number::SLIDING, [0.0, 1.0, 0.0]));
        cards.node_set(number::SLIDING, &sliding);
    }
    if !model.quiet.is_empty() {
        let fields = [("SSID", number::ENDS as f64), ("AD", 0.0), ("AS", 0.0)];
        cards.card("BOUNDARY_NON_REFLECTING", &fields);
        let faces = model.quiet.iter().flat_map(|end| &end.faces);
        cards.segment_set(number::ENDS, faces.map(|face| face.nodes));
    }
    for side in [DISK, BAR] {
        let faces = model.surfaces[side].faces.iter().map(|face| face.nodes);
        cards.segment_set(number::SURFACES[side], faces);
    }
    let mut hub = model.hub.clone();
    hub.push(rolling.axle());
    cards.node_set(number::HUB_NODES, &hub);
    let recorded: BTreeSet<u32> =
        model.zones.iter().flatten().flat_map(|face| face.nodes).collect();
    cards.node_set(number::RECORDED, &recorded.into_iter().collect::<Vec<_>>());
    nodes(cards, rolling);
    let full = model.elements();
    cards.keyword("ELEMENT_SOLID");
    for (body, range) in model.mesh.bodies.iter().map(|body| body.hexes.clone()).enumerate() {
        for e in range {
            let part = if full.is_full(e) { number::FULL } else { number::PARTS };
            cards.solid(e as u32, part[body], &model.mesh.hexes[e]);
        }
    }
}

/// The nodes, and that on the axle.
fn nodes(cards: &mut Cards, rolling: &RollingMotion<'_>) {
    let unit = cards.units().length();
    cards.keyword("NODE");
    let places = (0..).zip(&rolling.model.mesh.nodes);
    places.for_each(|(n, at)| cards.node(n, (at / unit).into()));
    cards.node(rolling.axle(), [0.0, 0.0, rolling.case.axle_height() / unit]);
}

/// The nodes that do not move along y, but for those that are held anyway.
fn sliding(rolling: &RollingMotion<'_>) -> Vec<u32> {
    let model = rolling.model;
    let held: BTreeSet<u32> = model.clamped.iter().chain(&model.hub).copied().collect();
    model.sliding.iter().copied().filter(|n| !held.contains(n)).collect()
}
