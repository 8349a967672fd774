//! From a foreign mesh with named sets to the two bodies.

use super::contact_surface::{Sheet, check};
use super::error::{Fault, ImportError, SetRole};
use super::foreign::{Foreign, Labels, Set};
use super::order::along_curve;
use super::parts::Parts;
use super::unit::Unit;
use crate::check::boundary;
use crate::error::{MAX_ELEMENTS, digits};
use crate::grid::nodes_of;
use crate::near::{duplicates, hanging};
use crate::quality::scaled_jacobian;
use crate::{Body, Face, Mesh, MeshError, Surface};
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Distance below which two nodes of a foreign mesh coincide, over the shortest edge of the body. Larger than for
/// generated meshes: files print coordinates with few digits.
const COINCIDENT: f64 = 1e-4;

/// Least scaled Jacobian of a corner that is not flat: smaller ones are round-off.
const FLAT: f64 = 1e-10;

/// The names of the sets in the file, by what they stand for. Letter case matters only where two names differ by
/// nothing else.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetNames {
    /// Elements of the disk.
    pub disk: String,
    /// Elements of the bar.
    pub bar: String,
    /// Nodes or faces of the disk's rigid hub.
    pub hub: String,
    /// Faces or nodes of the disk's running surface.
    pub tread: String,
    /// Faces or nodes of the bar's running surface.
    pub top: String,
    /// Nodes or faces by which the bar is clamped.
    pub clamp: String,
}

impl Default for SetNames {
    fn default() -> Self {
        let [disk, bar, hub, tread, top, clamp] =
            ["disk", "bar", "hub", "tread", "top", "clamp"].map(str::to_owned);
        Self { disk, bar, hub, tread, top, clamp }
    }
}

/// A foreign mesh as two bodies.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The bodies `"disk"` and `"bar"` with the sets and surfaces of the generated meshes: node sets
    /// `"hub"`, `"tread"`, and `"bottom"` (the clamped nodes), `"top"`; surfaces `"tread"` and
    /// `"top"`. Coordinates in metres.
    pub mesh: Mesh,
    /// What was left out or corrected, a sentence each.
    pub notes: Vec<String>,
    /// Names of the sets in the file.
    pub(super) names: SetNames,
    /// Unit in which its coordinates were read.
    pub(super) unit: Unit,
    /// Numbers and lines in the file of the mesh's nodes.
    pub(super) nodes: Labels,
    /// Numbers and lines in the file of the mesh's elements.
    pub(super) elements: Labels,
}

/// Names of the two bodies, also in messages.
const BODIES: [&str; 2] = ["disk", "bar"];

/// Checks a foreign mesh, corrects what can be corrected without a guess, and makes the two bodies of it.
/// `unit` is the unit of its coordinates.
///
/// Corrected, with a note: hexahedra whose corners are numbered inside out as a whole are renumbered; nodes
/// without elements are left out.
///
/// # Errors
/// The first [`Fault`] found, in the file's own numbers of nodes and elements.
pub fn bodies(foreign: &Foreign, names: &SetNames, unit: Unit) -> Result<Imported, ImportError> {
    check_arrays(foreign)?;
    let owner = owners(foreign, names)?;
    let (mut imported, new_index) = renumbered(foreign, names, unit, &owner)?;
    turn_inside_out(&mut imported)?;
    let mut outside = [Vec::new(), Vec::new()];
    for body in 0..2 {
        outside[body] = check_body(&imported, body)?;
    }
    let find = Finder { foreign, new_index: &new_index };
    for (body, role, name, ours) in
        [(0, SetRole::Hub, &names.hub, "hub"), (1, SetRole::Clamp, &names.clamp, "bottom")]
    {
        let nodes = find.nodes(&imported, body, role, name)?;
        imported.mesh.bodies[body].node_sets.insert(ours.into(), nodes);
    }
    for (body, sheet, role, name, ours) in [
        (0, Sheet::Band, SetRole::Tread, &names.tread, "tread"),
        (1, Sheet::Patch, SetRole::Top, &names.top, "top"),
    ] {
        let chosen = find.faces(&imported, body, role, name, &outside[body])?;
        check(&imported, (role, name), sheet, &outside[body], &chosen)?;
        let faces: Vec<Face> =
            outside[body].iter().zip(&chosen).filter(|c| *c.1).map(|c| *c.0).collect();
        let body = &mut imported.mesh.bodies[body];
        body.node_sets.insert(ours.into(), nodes_of(&faces));
        body.surfaces.insert(ours.into(), Surface { faces, smooth: None, irregularity: None });
    }
    disjoint(&imported, 0, ("hub", &names.hub), ("tread", &names.tread))?;
    disjoint(&imported, 1, ("bottom", &names.clamp), ("top", &names.top))?;
    crate::check(&imported.mesh).map_err(|fault| Fault::Mesh(fault).nowhere())?;
    Ok(imported)
}

/// Checks indices, counts and coordinates.
fn check_arrays(foreign: &Foreign) -> Result<(), ImportError> {
    let Foreign { points, hexes, sets, nodes, elements, .. } = foreign;
    if hexes.is_empty() {
        return Err(Fault::NoHexes.nowhere());
    }
    if hexes.len() as f64 > MAX_ELEMENTS || points.len() as f64 > 2.0 * MAX_ELEMENTS {
        let what = format!("a mesh of {} nodes and {} elements", points.len(), hexes.len());
        let remedy = "mesh the bodies with fewer elements";
        return Err(Fault::Unsupported { what, remedy }.nowhere());
    }
    if let Some(i) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(nodes.fault(i, Fault::NotFinite { node: nodes.id(i), point: points[i].into() }));
    }
    for (e, hex) in hexes.iter().enumerate() {
        let element = elements.id(e);
        if let Some(&n) = hex.iter().find(|&&n| n as usize >= points.len()) {
            let from = format!("element {element}");
            return Err(elements.fault(e, Fault::Unknown { from, what: format!("node {n}") }));
        }
        if let Some(k) = (1..8).find(|&k| hex[..k].contains(&hex[k])) {
            let node = nodes.id(hex[k] as usize);
            return Err(elements.fault(e, Fault::Collapsed { element, node }));
        }
    }
    for (name, set) in sets {
        let corners = set.faces.iter().flatten();
        let node = set.nodes.iter().chain(corners).find(|&&n| n as usize >= points.len());
        let hex = set.hexes.iter().find(|&&e| e as usize >= hexes.len());
        let what = match (node, hex) {
            (Some(n), _) => format!("node {n}"),
            (None, Some(e)) => format!("element {e}"),
            (None, None) => continue,
        };
        return Err(Fault::Unknown { from: format!("set `{name}`"), what }.nowhere());
    }
    Ok(())
}

/// A set by its name; letter case matters only where two names differ by nothing else.
fn set<'a>(foreign: &'a Foreign, role: SetRole, name: &str) -> Result<&'a Set, ImportError> {
    let sets = &foreign.sets;
    let alike: Vec<(&String, &Set)> =
        sets.iter().filter(|(n, _)| n.eq_ignore_ascii_case(name)).collect();
    let found = match (sets.get_key_value(name), &alike[..]) {
        (Some(found), _) => found,
        (None, &[found]) => found,
        _ if sets.is_empty() => return Err(Fault::NoSets { role, name: name.into() }.nowhere()),
        _ => {
            let there: Vec<_> = sets.keys().take(30).map(|n| format!("`{n}`")).collect();
            let there = match there.len() {
                n if n < sets.len() => format!("{} and others", there.join(", ")),
                _ => there.join(", "),
            };
            return Err(Fault::MissingSet { role, name: name.into(), there }.nowhere());
        }
    };
    match foreign.incomplete.get(found.0) {
        Some(error) => Err(error.clone()),
        None => Ok(found.1),
    }
}

/// The body of each hexahedron: its index in [`BODIES`].
fn owners(foreign: &Foreign, names: &SetNames) -> Result<Vec<u8>, ImportError> {
    const NEITHER: u8 = 2;
    let mut owner = vec![NEITHER; foreign.hexes.len()];
    let sets = [(SetRole::Disk, &names.disk), (SetRole::Bar, &names.bar)];
    let fault = |e: usize, of: &'static str| {
        let (disk, bar) = (names.disk.clone(), names.bar.clone());
        let element = foreign.elements.id(e);
        Err(foreign.elements.fault(e, Fault::NoBody { element, of, disk, bar }))
    };
    for (body, (role, name)) in sets.into_iter().enumerate() {
        let set = set(foreign, role, name)?;
        let mut members: Vec<u32> = set.hexes.clone();
        if members.is_empty() {
            // a body may be named by its nodes
            let mut inside = vec![false; foreign.points.len()];
            set.nodes.iter().for_each(|&n| inside[n as usize] = true);
            let all = |hex: &[u32; 8]| hex.iter().all(|&n| inside[n as usize]);
            members.extend((0..).zip(&foreign.hexes).filter(|(_, h)| all(h)).map(|(e, _)| e));
        }
        if members.is_empty() {
            return Err(Fault::EmptySet { role, name: name.clone(), what: "hexahedra" }.nowhere());
        }
        for e in members {
            if owner[e as usize] < body as u8 {
                return fault(e as usize, "both");
            }
            owner[e as usize] = body as u8;
        }
    }
    match owner.iter().position(|&o| o == NEITHER) {
        Some(e) => fault(e, "neither"),
        None => Ok(owner),
    }
}

/// The two bodies in metres with nodes and elements numbered along a space-filling curve, and the new index of
/// each of the file's nodes.
fn renumbered(
    foreign: &Foreign,
    names: &SetNames,
    unit: Unit,
    owner: &[u8],
) -> Result<(Imported, Vec<Option<u32>>), ImportError> {
    let mut body_of: Vec<Option<u8>> = vec![None; foreign.points.len()];
    for (hex, &body) in foreign.hexes.iter().zip(owner) {
        for &n in hex {
            if body_of[n as usize].replace(body).is_some_and(|before| before != body) {
                let node = foreign.nodes.id(n as usize);
                return Err(foreign.nodes.fault(n as usize, Fault::SharedNode { node }));
            }
        }
    }
    let mut mesh = Mesh::default();
    let mut imported = Imported {
        mesh: Mesh::default(),
        notes: foreign.notes.clone(),
        names: names.clone(),
        unit,
        nodes: Labels::default(),
        elements: Labels::default(),
    };
    let mut new_index = vec![None; foreign.points.len()];
    for body in [0u8, 1] {
        let (first_node, first_hex) = (mesh.nodes.len(), mesh.hexes.len());
        let ours: Vec<usize> = (0..body_of.len()).filter(|&n| body_of[n] == Some(body)).collect();
        let points: Vec<_> =
            ours.iter().map(|&n| foreign.points[n].map(|x| unit.metres(x))).collect();
        for k in along_curve(&points) {
            new_index[ours[k as usize]] = Some(mesh.nodes.len() as u32);
            mesh.nodes.push(points[k as usize]);
            imported.nodes.copy(&foreign.nodes, ours[k as usize]);
        }
        let ours: Vec<usize> = (0..owner.len()).filter(|&e| owner[e] == body).collect();
        let corners =
            |e: usize| foreign.hexes[e].map(|n| new_index[n as usize].unwrap_or_default());
        let middles: Vec<Vector3<f64>> = ours
            .iter()
            .map(|&e| {
                // sorted, so that the sum does not depend on the element's numbering
                let mut corners = corners(e);
                corners.sort_unstable();
                corners.iter().map(|&n| mesh.at(n)).sum()
            })
            .collect();
        let order = along_curve(&middles);
        let hexes: Vec<[u32; 8]> = order.iter().map(|&k| corners(ours[k as usize])).collect();
        mesh.hexes.extend(hexes);
        order.iter().for_each(|&k| imported.elements.copy(&foreign.elements, ours[k as usize]));
        mesh.bodies.push(Body {
            name: BODIES[body as usize].into(),
            nodes: first_node..mesh.nodes.len(),
            hexes: first_hex..mesh.hexes.len(),
            node_sets: BTreeMap::new(),
            surfaces: BTreeMap::new(),
        });
    }
    let loose = new_index.iter().filter(|p| p.is_none()).count();
    if let Some(first) = new_index.iter().position(Option::is_none) {
        imported.notes.push(format!(
            "{loose} nodes belong to no hexahedron and are left out (the first: node {})",
            foreign.nodes.id(first)
        ));
    }
    imported.mesh = mesh;
    Ok((imported, new_index))
}

/// Renumbers the hexahedra whose corners are numbered inside out as a whole: their coordinates are mirrored, or
/// their bottom and top are exchanged.
fn turn_inside_out(imported: &mut Imported) -> Result<(), ImportError> {
    let Imported { mesh, elements, notes, .. } = imported;
    let (mut turned, mut first) = (0, None);
    for (e, hex) in mesh.hexes.iter_mut().enumerate() {
        let shape = |hex: &[u32; 8]| scaled_jacobian(&hex.map(|n| mesh.nodes[n as usize]));
        let (corner, value) = shape(hex);
        if value > FLAT {
            continue;
        }
        let [a, b, c, d, e5, f, g, h] = *hex;
        let other = [e5, f, g, h, a, b, c, d];
        if shape(&other).1 > FLAT {
            *hex = other;
            turned += 1;
            first.get_or_insert(e);
            continue;
        }
        let fault = Fault::Inverted { element: elements.id(e), corner: corner + 1, value };
        return Err(elements.fault(e, fault));
    }
    if let Some(e) = first {
        notes.push(format!(
            "{turned} hexahedra are numbered inside out and have been turned (among them element {})",
            elements.id(e)
        ));
    }
    Ok(())
}

/// Checks that a body is connected and that its elements match; returns its boundary faces.
fn check_body(imported: &Imported, index: usize) -> Result<Vec<Face>, ImportError> {
    let Imported { mesh, nodes, elements, .. } = imported;
    let (body, name) = (&mesh.bodies[index], BODIES[index]);
    if let Some((a, b)) = duplicates(mesh, body, COINCIDENT) {
        // in the order of the file's numbers
        let (a, b) = if nodes.id(a) <= nodes.id(b) { (a, b) } else { (b, a) };
        let (first, second) = (nodes.id(a), nodes.id(b));
        let fault = Fault::Coincident {
            first,
            second,
            body: name,
            point: mesh.nodes[b].map(digits).into(),
        };
        return Err(nodes.fault(b, fault));
    }
    let outside = boundary(mesh, body).map_err(|error| match error {
        MeshError::FaceShared { element, .. } => {
            elements.fault(element, Fault::FaceShared { element: elements.id(element) })
        }
        error => Fault::Mesh(error).nowhere(),
    })?;
    let mut parts = Parts::new(body.nodes.len());
    for hex in &mesh.hexes[body.hexes.clone()] {
        let [first, ..] = hex.map(|n| n - body.nodes.start as u32);
        hex.iter().for_each(|n| parts.join(first, n - body.nodes.start as u32));
    }
    if let Some(apart) = parts.apart() {
        let node = body.nodes.start as u32 + apart;
        let owner = body.hexes.clone().find(|&e| mesh.hexes[e].contains(&node));
        let e = owner.unwrap_or(body.hexes.start);
        return Err(elements.fault(e, Fault::Loose { body: name, element: elements.id(e) }));
    }
    if let Some((node, face)) = hanging(mesh, &outside) {
        let element = elements.id(face.hex as usize);
        let fault = Fault::Hanging { node: nodes.id(node as usize), element };
        return Err(nodes.fault(node as usize, fault));
    }
    Ok(outside)
}

/// Finds the members of sets in the new numbering of nodes.
struct Finder<'a> {
    foreign: &'a Foreign,
    /// New index of each of the file's nodes; `None` for those left out.
    new_index: &'a [Option<u32>],
}

impl Finder<'_> {
    /// The new index of a node of the body, `None` if it was left out; an error if it belongs to the other body.
    fn on(
        &self,
        imported: &Imported,
        body: usize,
        (role, name): (SetRole, &str),
        node: u32,
    ) -> Result<Option<u32>, ImportError> {
        let Some(index) = self.new_index[node as usize] else { return Ok(None) };
        if imported.mesh.bodies[body].nodes.contains(&(index as usize)) {
            return Ok(Some(index));
        }
        let nodes = &self.foreign.nodes;
        let fault = Fault::BothBodies {
            role,
            name: name.into(),
            node: nodes.id(node as usize),
            body: BODIES[body],
            other: BODIES[1 - body],
        };
        Err(nodes.fault(node as usize, fault))
    }

    /// All nodes of a set, sorted: its nodes, and the corners of its faces and elements.
    fn nodes(
        &self,
        imported: &Imported,
        body: usize,
        role: SetRole,
        name: &str,
    ) -> Result<Vec<u32>, ImportError> {
        let set = set(self.foreign, role, name)?;
        let corners = set.hexes.iter().flat_map(|&e| &self.foreign.hexes[e as usize]);
        let mut found = BTreeSet::new();
        for &node in set.nodes.iter().chain(set.faces.iter().flatten()).chain(corners) {
            found.extend(self.on(imported, body, (role, name), node)?);
        }
        if found.len() < 3 {
            let name = name.to_owned();
            return Err(Fault::EmptySet { role, name, what: "three nodes or more" }.nowhere());
        }
        Ok(found.into_iter().collect())
    }

    /// Which boundary faces belong to a set: those that it lists, or, if it lists none, those whose corners are
    /// all among its nodes.
    fn faces(
        &self,
        imported: &Imported,
        body: usize,
        role: SetRole,
        name: &str,
        outside: &[Face],
    ) -> Result<Vec<bool>, ImportError> {
        let set = set(self.foreign, role, name)?;
        let sorted = |mut nodes: [u32; 4]| {
            nodes.sort_unstable();
            nodes
        };
        let mut chosen = vec![false; outside.len()];
        if set.faces.is_empty() {
            let mut inside = vec![false; imported.mesh.nodes.len()];
            for &node in &set.nodes {
                if let Some(n) = self.on(imported, body, (role, name), node)? {
                    inside[n as usize] = true;
                }
            }
            for (chosen, face) in chosen.iter_mut().zip(outside) {
                *chosen = face.nodes.iter().all(|&n| inside[n as usize]);
            }
        } else {
            let places: HashMap<[u32; 4], usize> =
                outside.iter().enumerate().map(|(i, f)| (sorted(f.nodes), i)).collect();
            for face in &set.faces {
                let mut nodes = [None; 4];
                for (place, &node) in nodes.iter_mut().zip(face) {
                    *place = self.on(imported, body, (role, name), node)?;
                }
                let place = match nodes {
                    [Some(a), Some(b), Some(c), Some(d)] => places.get(&sorted([a, b, c, d])),
                    _ => None,
                };
                let Some(&place) = place else {
                    let nodes = face.map(|n| self.foreign.nodes.id(n as usize));
                    let (name, body) = (name.to_owned(), BODIES[body]);
                    let fault = Fault::NotOutside { role, name, nodes, body };
                    return Err(self.foreign.nodes.fault(face[0] as usize, fault));
                };
                chosen[place] = true;
            }
        }
        if !chosen.contains(&true) {
            let what = "faces of the outside, nor all nodes of one";
            return Err(Fault::EmptySet { role, name: name.into(), what }.nowhere());
        }
        Ok(chosen)
    }
}

/// Refuses two sets of a body that have a node in common; each by its names in the mesh and in the file.
fn disjoint(
    imported: &Imported,
    body: usize,
    first: (&str, &str),
    second: (&str, &str),
) -> Result<(), ImportError> {
    let sets = &imported.mesh.bodies[body].node_sets;
    let common = sets[first.0].iter().find(|n| sets[second.0].binary_search(n).is_ok());
    match common {
        None => Ok(()),
        Some(&n) => {
            let node = imported.nodes.id(n as usize);
            let (first, second) = (first.1.to_owned(), second.1.to_owned());
            Err(imported.nodes.fault(n as usize, Fault::SetsMeet { first, second, node }))
        }
    }
}
