//! The two bodies of a keyword file: their mesh with its sets.

use crate::cards::{syntax, unsupported};
use crate::deck::{Deck, Target};
use crate::units::Units;
use mesh::import::{Fault, Foreign, ImportError, Labels, Set};
use std::collections::{BTreeSet, HashMap};

/// The mesh of the disk and the bar with its sets.
pub(crate) struct Model {
    /// Nodes in metres, elements and sets.
    pub(crate) foreign: Foreign,
    /// Numbers of the parts of disk and bar.
    pub(crate) parts: [u64; 2],
    /// Nodes of disk and bar, as indices into the mesh.
    pub(crate) nodes: [BTreeSet<u32>; 2],
}

/// The error of a file that lacks what a disk on a bar needs.
pub(crate) fn lacks(what: &str) -> ImportError {
    ImportError { line: None, fault: Fault::Syntax { what: format!("the file has no {what}") } }
}

impl Model {
    /// The model of a keyword file, in metres.
    ///
    /// # Errors
    /// Cards that refer to what is not there, and what a disk on a bar lacks.
    pub(crate) fn new(deck: &Deck, units: Units) -> Result<Self, ImportError> {
        let mut foreign = Foreign::default();
        let indices = take_nodes(deck, units, &mut foreign)?;
        take_solids(deck, &indices, &mut foreign)?;
        let hub = deck.hub.as_ref().ok_or_else(|| {
            lacks("*CONSTRAINED_NODAL_RIGID_BODY, whose node set is the rigid hub of the disk")
        })?;
        let hub = indices.of_target(deck, hub)?;
        let parts = parts(deck, &foreign, &hub)?;
        let mut nodes = [BTreeSet::new(), BTreeSet::new()];
        for (e, solid) in deck.solids.iter().enumerate() {
            let body = usize::from(solid.part == parts[1]);
            nodes[body].extend(foreign.hexes[e]);
            let set = foreign.sets.entry(["disk", "bar"][body].to_owned()).or_default();
            set.hexes.push(e as u32);
        }
        foreign.sets.entry("hub".into()).or_default().nodes = hub;
        for target in &deck.clamped {
            let held = indices.of_target(deck, target)?;
            foreign.sets.entry("clamp".into()).or_default().nodes.extend(held);
        }
        if deck.clamped.is_empty() {
            return Err(lacks("*BOUNDARY_SPC_SET that clamps the bar"));
        }
        take_surfaces(deck, &indices, &nodes[0], &mut foreign)?;
        Ok(Self { foreign, parts, nodes })
    }

    /// Least and largest x, y, z (m) of nodes.
    pub(crate) fn extent(&self, nodes: &mut dyn Iterator<Item = u32>) -> [[f64; 2]; 3] {
        let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for n in nodes {
            for (a, [low, high]) in extent.iter_mut().enumerate() {
                let x = self.foreign.points[n as usize][a];
                (*low, *high) = (low.min(x), high.max(x));
            }
        }
        extent
    }

    /// The faces of a set; empty where there is no such set.
    pub(crate) fn faces(&self, set: &str) -> &[[u32; 4]] {
        self.foreign.sets.get(set).map_or(&[], |set| &set.faces)
    }
}

/// Index of every node in the mesh, by its number in the file.
struct Indices(HashMap<u64, u32>);

impl Indices {
    /// Index of a node to which `from` refers in a line of the file.
    fn find(&self, from: &str, node: u64, line: usize) -> Result<u32, ImportError> {
        let fault = || Fault::Unknown { from: from.into(), what: format!("node {node}") };
        let index = self.0.get(&node).copied();
        index.ok_or_else(|| ImportError { line: Some(line), fault: fault() })
    }

    /// Indices of the nodes that a card refers to.
    fn of_target(&self, deck: &Deck, target: &Target) -> Result<Vec<u32>, ImportError> {
        let ids = match deck.node_sets.get(&target.id) {
            _ if !target.set => vec![target.id],
            Some(ids) => ids.clone(),
            None => {
                let (from, what) = ("the card".into(), format!("node set {}", target.id));
                let fault = Fault::Unknown { from, what };
                return Err(ImportError { line: Some(target.line), fault });
            }
        };
        ids.iter().map(|&id| self.find("the card", id, target.line)).collect()
    }
}

fn take_nodes(deck: &Deck, units: Units, foreign: &mut Foreign) -> Result<Indices, ImportError> {
    let mut indices = HashMap::new();
    for node in &deck.nodes {
        if indices.insert(node.id, foreign.points.len() as u32).is_some() {
            let fault = Fault::Repeated { what: "node", id: node.id };
            return Err(ImportError { line: Some(node.line), fault });
        }
        foreign.points.push(node.point.map(|x| x * units.length()));
        label(&mut foreign.nodes, node.id, node.line);
    }
    Ok(Indices(indices))
}

fn take_solids(deck: &Deck, indices: &Indices, foreign: &mut Foreign) -> Result<(), ImportError> {
    for solid in &deck.solids {
        let mut hex = [0; 8];
        for (corner, &node) in hex.iter_mut().zip(&solid.nodes) {
            *corner = indices.find(&format!("element {}", solid.id), node, solid.line)?;
        }
        foreign.hexes.push(hex);
        label(&mut foreign.elements, solid.id, solid.line);
    }
    Ok(())
}

/// The parts of disk and bar: the disk's is the one that has nodes of the hub.
fn parts(deck: &Deck, foreign: &Foreign, hub: &[u32]) -> Result<[u64; 2], ImportError> {
    let held: BTreeSet<u32> = hub.iter().copied().collect();
    let on_hub = |e: &usize| foreign.hexes[*e].iter().any(|n| held.contains(n));
    let disk = (0..foreign.hexes.len()).find(on_hub).map(|e| deck.solids[e].part);
    let disk = disk.ok_or_else(|| lacks("solid elements on the nodes of the rigid hub"))?;
    let parts: BTreeSet<u64> = deck.solids.iter().map(|s| s.part).collect();
    let others: Vec<u64> = parts.into_iter().filter(|p| *p != disk).collect();
    let [bar] = others[..] else {
        let what = format!("a model of {} parts of solids", others.len() + 1);
        let remedy = "keep one part for the disk and one for the bar";
        return Err(unsupported(deck.solids[0].line, what, remedy));
    };
    Ok([disk, bar])
}

/// The two surfaces of the contact, as the sets `tread` of the disk and `top` of the bar.
fn take_surfaces(
    deck: &Deck,
    indices: &Indices,
    disk: &BTreeSet<u32>,
    foreign: &mut Foreign,
) -> Result<(), ImportError> {
    let contact = deck.contact.ok_or_else(|| lacks("*CONTACT_SURFACE_TO_SURFACE"))?;
    for side in contact.sides {
        let segments = deck.segment_sets.get(&side).ok_or_else(|| {
            let (from, what) = ("the contact".into(), format!("segment set {side}"));
            ImportError { line: Some(contact.line), fault: Fault::Unknown { from, what } }
        })?;
        if segments.is_empty() {
            return Err(syntax(contact.line, format!("segment set {side} has no segments")));
        }
        let mut faces = Vec::new();
        for segment in segments {
            let mut face = [0; 4];
            for (corner, &node) in face.iter_mut().zip(segment) {
                *corner = indices.find(&format!("segment set {side}"), node, contact.line)?;
            }
            faces.push(face);
        }
        let name = if disk.contains(&faces[0][0]) { "tread" } else { "top" };
        if foreign.sets.insert(name.into(), Set { faces, ..Set::default() }).is_some() {
            return Err(syntax(contact.line, "the two surfaces of the contact lie on one body"));
        }
    }
    Ok(())
}

fn label(labels: &mut Labels, id: u64, line: usize) {
    labels.ids.push(id);
    labels.lines.push(line);
}
