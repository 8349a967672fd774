//! The two bodies of a keyword file: their mesh with its sets.

use crate::ls_dyna::axes;
use crate::ls_dyna::contact_surface;
use crate::ls_dyna::deck::{Deck, Target};
use crate::ls_dyna::error::{DeckError, DeckLine, Fault, lacks, unknown, unsupported};
use crate::ls_dyna::units::Units;
use mesh::import::{Foreign, Labels};
use mesh::{Body, Mesh};
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// The mesh of the disk and the bar with its sets.
pub(crate) struct Model {
    /// Nodes in metres, elements and sets.
    pub(crate) foreign: Foreign,
    /// Numbers of the parts of disk and bar.
    pub(crate) parts: [Vec<u64>; 2],
    /// What holds nodes in y.
    pub(crate) symmetry: Symmetry,
    /// Layers of fully integrated elements below the surfaces of bodies that have others as well.
    pub(crate) layers: Option<u64>,
    /// Nodes of disk and bar, as indices into the mesh.
    pub(crate) nodes: [BTreeSet<u32>; 2],
}

/// What the nodes are that do not move along y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Symmetry {
    /// None.
    Whole,
    /// Those of a plane of symmetry at the edge of both bodies.
    Half,
    /// All: plane strain.
    Slice,
}

impl Model {
    /// The model of a keyword file, in metres.
    ///
    /// # Errors
    /// Cards that refer to what is not there, and what a disk on a bar lacks.
    pub(crate) fn new(deck: &Deck, units: Units) -> Result<Self, DeckError> {
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
            let body = usize::from(parts[1].contains(&solid.part));
            nodes[body].extend(foreign.hexes[e]);
            let set = foreign.sets.entry(["disk", "bar"][body].to_owned()).or_default();
            set.hexes.push(e as u32);
        }
        axes::check_frame(deck, &foreign.points, &nodes)?;
        // a node of the axle that bears mass is none of the mesh
        let meshed = |n: &u32| nodes.iter().any(|body| body.contains(n));
        foreign.sets.entry("hub".into()).or_default().nodes =
            hub.into_iter().filter(meshed).collect();
        for target in &deck.clamped {
            let held = indices.of_target(deck, target)?;
            foreign.sets.entry("clamp".into()).or_default().nodes.extend(held);
        }
        if deck.clamped.is_empty() {
            return Err(lacks("*BOUNDARY_SPC_SET that clamps the bar"));
        }
        let bodies = Bodies { deck, indices: &indices, parts: &parts, nodes: &nodes };
        contact_surface::take(&bodies, &mut foreign)?;
        quiet_ends(&bodies, &foreign)?;
        let layers = full_layers(deck, &foreign, &parts);
        let symmetry = symmetry(deck, &indices, &nodes, &foreign)?;
        drop_loose(&mut foreign, &mut nodes);
        if symmetry == Symmetry::Half {
            // a case reads whole bodies, and cuts them itself
            let image = foreign.mirror(SAME);
            for body in &mut nodes {
                body.extend(body.clone().into_iter().map(|n| image[n as usize]));
            }
        }
        Ok(Self { foreign, parts, nodes, symmetry, layers })
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

    /// Lumped mass (kg) of the nodes of a set, of elements of this `density` (kg/m^3), and its moment of inertia (kg m^2)
    /// about the axis along y at x = 0 and this `height` (m).
    pub(crate) fn lumped(&self, set: &str, density: f64, height: f64) -> [f64; 2] {
        let Foreign { points, hexes, sets, .. } = &self.foreign;
        let whole = Body {
            name: String::new(),
            nodes: 0..points.len(),
            hexes: 0..hexes.len(),
            node_sets: BTreeMap::new(),
            surfaces: BTreeMap::new(),
        };
        let mesh = Mesh {
            nodes: points.clone(),
            hexes: hexes.clone(),
            bodies: vec![whole],
            symmetric: false,
        };
        let mass = solid::lumped_mass(&mesh, &[density]);
        let nodes = sets.get(set).map_or(&[][..], |set| &set.nodes);
        nodes.iter().map(|n| *n as usize).fold([0.0; 2], |[sum, moment], n| {
            let [x, _, z] = points[n].into();
            let squared = x * x + (z - height) * (z - height);
            [sum + mass[n], moment + mass[n] * squared]
        })
    }

    /// How many parts alike make up the bodies of which the deck has one.
    pub(crate) fn alike(&self) -> f64 {
        if self.symmetry == Symmetry::Half { 2.0 } else { 1.0 }
    }

    /// Numbers of the disk's nodes in the deck: without those of the mirror image, which lies at y < 0.
    pub(crate) fn disk_nodes(&self) -> BTreeSet<u64> {
        let Foreign { points, nodes, .. } = &self.foreign;
        let own = |n: &&u32| self.symmetry != Symmetry::Half || points[**n as usize][1] > -SAME;
        self.nodes[0].iter().filter(own).map(|n| nodes.ids[*n as usize]).collect()
    }

    /// The faces of a set; empty where there is no such set.
    pub(crate) fn faces(&self, set: &str) -> &[[u32; 4]] {
        self.foreign.sets.get(set).map_or(&[], |set| &set.faces)
    }
}

/// Disk and bar of a deck while their surfaces are sought.
pub(crate) struct Bodies<'a> {
    pub(crate) deck: &'a Deck,
    pub(crate) indices: &'a Indices,
    /// Numbers of the parts of both.
    pub(crate) parts: &'a [Vec<u64>; 2],
    /// Nodes of both, as indices into the mesh.
    pub(crate) nodes: &'a [BTreeSet<u32>; 2],
}

impl Bodies<'_> {
    /// The segments of a set, as indices into the mesh, to which `from` refers in a line of the deck.
    pub(crate) fn segments(
        &self,
        from: &str,
        set: u64,
        at: &DeckLine,
    ) -> Result<Vec<[u32; 4]>, DeckError> {
        let segments = self.deck.segment_sets.get(&set);
        let segments = segments.ok_or_else(|| unknown(at, from, format!("segment set {set}")))?;
        let name = format!("segment set {set}");
        let find = |node: u64| self.indices.find(&name, node, at);
        let face = |[a, b, c, d]: &[u64; 4]| Ok([find(*a)?, find(*b)?, find(*c)?, find(*d)?]);
        segments.iter().map(face).collect()
    }
}

/// Index of every node in the mesh, by its number in the file.
pub(crate) struct Indices(HashMap<u64, u32>);

impl Indices {
    /// Index of a node to which `from` refers in a line of the file.
    pub(crate) fn find(&self, from: &str, node: u64, at: &DeckLine) -> Result<u32, DeckError> {
        let index = self.0.get(&node).copied();
        index.ok_or_else(|| unknown(at, from, format!("node {node}")))
    }

    /// Indices of the nodes that a card refers to.
    fn of_target(&self, deck: &Deck, target: &Target) -> Result<Vec<u32>, DeckError> {
        let ids = match deck.node_sets.get(&target.id) {
            _ if !target.set => vec![target.id],
            Some(ids) => ids.clone(),
            None => {
                return Err(unknown(&target.place, "the card", format!("node set {}", target.id)));
            }
        };
        ids.iter().map(|&id| self.find("the card", id, &target.place)).collect()
    }
}

/// Refuses segments that do not reflect waves unless they are the bar's ends, which alone a case can say of.
fn quiet_ends(bodies: &Bodies, foreign: &Foreign) -> Result<(), DeckError> {
    let Some(first) = bodies.deck.quiet.first() else { return Ok(()) };
    let x = |n: &u32| foreign.points[*n as usize][0];
    let along = bodies.nodes[1].iter().map(x);
    let ends =
        [along.clone().fold(f64::INFINITY, f64::min), along.fold(f64::NEG_INFINITY, f64::max)];
    let mut found = [false; 2];
    for set in &bodies.deck.quiet {
        for face in bodies.segments("the card", set.id, &set.place)? {
            let at_end = |end: &f64| face.iter().all(|n| (x(n) - end).abs() < SAME);
            let end = ends.iter().position(at_end);
            let Some(end) = end.filter(|_| face.iter().all(|n| bodies.nodes[1].contains(n))) else {
                let what = "*BOUNDARY_NON_REFLECTING of segments off the bar's ends";
                let remedy = "name the faces at the least and the largest x of the bar alone";
                return Err(unsupported(&set.place, what, remedy));
            };
            found[end] = true;
        }
    }
    if found == [true; 2] {
        return Ok(());
    }
    let what = "*BOUNDARY_NON_REFLECTING of one end of the bar alone";
    Err(unsupported(&first.place, what, "name the faces of both ends, or of none"))
}

pub(super) fn take_nodes(
    deck: &Deck,
    units: Units,
    foreign: &mut Foreign,
) -> Result<Indices, DeckError> {
    let mut indices = HashMap::new();
    for node in &deck.nodes {
        if indices.insert(node.id, foreign.points.len() as u32).is_some() {
            return Err(Fault::RepeatedNode { id: node.id }.at(&node.place));
        }
        foreign.points.push(Vector3::from(node.point) * units.length());
        label(&mut foreign.nodes, node.id, node.place.line);
    }
    Ok(Indices(indices))
}

pub(super) fn take_solids(
    deck: &Deck,
    indices: &Indices,
    foreign: &mut Foreign,
) -> Result<(), DeckError> {
    for solid in &deck.solids {
        let mut hex = [0; 8];
        for (corner, &node) in hex.iter_mut().zip(&solid.nodes) {
            *corner = indices.find(&format!("element {}", solid.id), node, &solid.place)?;
        }
        foreign.hexes.push(hex);
        label(&mut foreign.elements, solid.id, solid.place.line);
    }
    Ok(())
}

/// The parts of disk and bar: parts that share nodes make a body, and the disk is the one that has nodes of the hub.
fn parts(deck: &Deck, foreign: &Foreign, hub: &[u32]) -> Result<[Vec<u64>; 2], DeckError> {
    let mut of_part: BTreeMap<u64, BTreeSet<u32>> = BTreeMap::new();
    for (e, solid) in deck.solids.iter().enumerate() {
        of_part.entry(solid.part).or_default().extend(foreign.hexes[e]);
    }
    let mut bodies: Vec<(Vec<u64>, BTreeSet<u32>)> = Vec::new();
    for (part, nodes) in of_part {
        let (joined, apart): (Vec<_>, Vec<_>) =
            bodies.into_iter().partition(|(_, there)| !there.is_disjoint(&nodes));
        bodies = apart;
        let mut body = (vec![part], nodes);
        for (parts, nodes) in joined {
            body.0.extend(parts);
            body.1.extend(nodes);
        }
        bodies.push(body);
    }
    let held: BTreeSet<u32> = hub.iter().copied().collect();
    let (disk, others): (Vec<_>, Vec<_>) =
        bodies.into_iter().partition(|(_, nodes)| !nodes.is_disjoint(&held));
    if disk.is_empty() {
        return Err(lacks("solid elements on the nodes of the rigid hub"));
    }
    let count = disk.len() + others.len();
    let (Ok([disk]), Ok([bar])) = (<[_; 1]>::try_from(disk), <[_; 1]>::try_from(others)) else {
        let what = format!("a model of {count} bodies of solids");
        let remedy = "keep the disk and the bar alone; parts that share nodes make one body";
        return Err(unsupported(&deck.solids[0].place, what, remedy));
    };
    Ok([disk.0, bar.0])
}

/// How many layers of fully integrated elements lie below the surfaces, where bodies have one-point elements as well.
fn full_layers(deck: &Deck, foreign: &Foreign, parts: &[Vec<u64>; 2]) -> Option<u64> {
    let full = |part: u64| {
        deck.parts.get(&part).and_then(|part| deck.sections.get(&part.section)) == Some(&2)
    };
    if !parts.iter().all(|parts| parts.iter().any(|p| full(*p)) && !parts.iter().all(|p| full(*p)))
    {
        return None;
    }
    let mut left: Vec<usize> =
        (0..deck.solids.len()).filter(|e| full(deck.solids[*e].part)).collect();
    let surfaces = ["tread", "top"].into_iter().filter_map(|name| foreign.sets.get(name));
    let mut reached: HashSet<u32> =
        surfaces.flat_map(|set| &set.faces).flatten().copied().collect();
    let mut layers = 0;
    while !left.is_empty() {
        let (layer, below): (Vec<_>, Vec<_>) =
            left.into_iter().partition(|e| foreign.hexes[*e].iter().any(|n| reached.contains(n)));
        if layer.is_empty() {
            return None;
        }
        reached.extend(layer.iter().flat_map(|e| foreign.hexes[*e]));
        (left, layers) = (below, layers + 1);
    }
    Some(layers)
}

/// What the nodes are that the file holds in y.
fn symmetry(
    deck: &Deck,
    indices: &Indices,
    nodes: &[BTreeSet<u32>; 2],
    foreign: &Foreign,
) -> Result<Symmetry, DeckError> {
    let Some(first) = deck.sliding.first() else { return Ok(Symmetry::Whole) };
    let mut sliding = BTreeSet::new();
    for target in &deck.sliding {
        sliding.extend(indices.of_target(deck, target)?);
    }
    let held: BTreeSet<u32> =
        ["hub", "clamp"].iter().flat_map(|name| &foreign.sets[*name].nodes).copied().collect();
    let free = || nodes.iter().flatten().filter(|n| !held.contains(n));
    if free().all(|n| sliding.contains(n)) {
        return Ok(Symmetry::Slice);
    }
    let y = |n: u32| foreign.points[n as usize][1];
    let edge = free().map(|n| y(*n)).fold(f64::INFINITY, f64::min);
    let on_edge = |n: &u32| (y(*n) - edge).abs() < SAME;
    let plane: BTreeSet<u32> = free().filter(|n| on_edge(n)).copied().collect();
    let sliding: BTreeSet<u32> = sliding.difference(&held).copied().collect();
    if sliding == plane && edge.abs() < SAME {
        return Ok(Symmetry::Half);
    }
    let what = "*BOUNDARY_SPC with DOFY = 1 of nodes that are neither all nodes nor those of a plane y = 0 that ends both bodies";
    Err(unsupported(&first.place, what, "hold all of them (plane strain) or the plane of symmetry"))
}

/// Distance (m) below which places are the same: less than a file prints.
const SAME: f64 = 1e-9;

/// Takes out the nodes that no element has.
fn drop_loose(foreign: &mut Foreign, nodes: &mut [BTreeSet<u32>; 2]) {
    let count = foreign.points.len();
    let kept: Vec<usize> =
        (0..count).filter(|n| nodes.iter().any(|body| body.contains(&(*n as u32)))).collect();
    if kept.len() == count {
        return;
    }
    let mut place = vec![0; count];
    kept.iter().zip(0..).for_each(|(&n, new)| place[n] = new);
    let moved = |n: &mut u32| *n = place[*n as usize];
    foreign.points = kept.iter().map(|&n| foreign.points[n]).collect();
    foreign.nodes.ids = kept.iter().map(|&n| foreign.nodes.ids[n]).collect();
    foreign.nodes.lines = kept.iter().map(|&n| foreign.nodes.lines[n]).collect();
    foreign.hexes.iter_mut().flatten().for_each(moved);
    for set in foreign.sets.values_mut() {
        set.nodes.iter_mut().for_each(moved);
        set.faces.iter_mut().flatten().for_each(moved);
    }
    for body in nodes {
        *body = body.iter().map(|n| place[*n as usize]).collect();
    }
}

fn label(labels: &mut Labels, id: u64, line: usize) {
    labels.ids.push(id);
    labels.lines.push(line);
}
