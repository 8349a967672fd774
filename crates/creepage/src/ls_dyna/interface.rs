//! What results of a keyword file refer to: the two surfaces of its contact, the nodes on them, and friction. Any model
//! will do whose contact is between segments or parts of solids: materials, loads and motions are not read.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use mesh::geometry::vector_area;
use mesh::import::Foreign;
use mesh::{outer_faces, quad_corner_areas};
use nalgebra::Vector3;
use serde::Serialize;

use crate::ls_dyna::cards::Card;
use crate::ls_dyna::contact_card::{self, Sliding};
use crate::ls_dyna::deck::{Deck, Side};
use crate::ls_dyna::error::{DeckError, DeckLine, lacks, second, syntax, unknown};
use crate::ls_dyna::fields::{Layout, absent, number, whole};
use crate::ls_dyna::model::{Indices, take_nodes, take_solids};
use crate::ls_dyna::parameters::Parameters;
use crate::ls_dyna::sources::{Source, Sources};
use crate::ls_dyna::units::Units;

/// The contact of a keyword file, in SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Interface {
    /// Numbers that the nodes of both surfaces have in the file. Where the file has half of a symmetric model, their mirror
    /// images follow them.
    pub nodes: Vec<u64>,
    /// How many of them are such images.
    pub images: usize,
    /// The nodes on the plane of symmetry, as indices.
    pub on_plane: Vec<u32>,
    /// Where they are (m).
    pub points: Vec<[f64; 3]>,
    /// Their tributary areas, undeformed (m2).
    pub areas: Vec<f64>,
    /// Faces of wheel and rail by their nodes, counter-clockwise seen from outside.
    pub faces: [Vec<[u32; 4]>; 2],
    /// FS, FD and DC (s/m); none where the card of the contact does not give them.
    pub friction: Option<[f64; 3]>,
    /// When initial velocities are given (s); 0 where the file does not say.
    pub begins: f64,
    /// The file's units of length (m), mass (kg) and time (s).
    pub units: [f64; 3],
}

/// Contacts that are read; `_ID` and `_TITLE` may follow.
const CONTACTS: [&str; 5] = [
    "CONTACT_AUTOMATIC_ONE_WAY_SURFACE_TO_SURFACE",
    "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE",
    "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE_MORTAR",
    "CONTACT_ONE_WAY_SURFACE_TO_SURFACE",
    "CONTACT_SURFACE_TO_SURFACE",
];

const HELD: Layout<2> = Layout::new(&[
    number("NSID or NID"),
    absent("CID"),
    absent("DOFX"),
    whole("DOFY"),
    absent("DOFZ"),
    absent("DOFRX"),
    absent("DOFRY"),
    absent("DOFRZ"),
]);

/// Reads the contact of a deck in consistent `units`. `sides` are the numbers that wheel and rail have on its card; where
/// neither is given the wheel is the upper one, along z.
///
/// # Errors
/// A file that cannot be read or must not be included; a deck with no such contact or with several; sides that are not
/// there.
pub fn interface(
    source: &Source,
    units: Units,
    sides: [Option<u64>; 2],
) -> Result<Interface, DeckError> {
    let sources = Sources::read(source)?;
    let cards = sources.cards()?;
    let parameters = Parameters::of(&cards)?;
    let mut reading = Reading::default();
    for card in cards {
        reading.card(&card.with(&parameters))?;
    }
    let Reading { deck, contacts, held } = reading;
    deck.names(units)?;
    let contact = chosen(&contacts, sides)?;
    let mut foreign = Foreign::default();
    let indices = take_nodes(&deck, units, &mut foreign)?;
    take_solids(&deck, &indices, &mut foreign)?;
    let skin = Skin { deck: &deck, foreign: &foreign, indices: &indices };
    let [first, other] = contact.sides;
    let mut faces = [skin.side(first, &contact.place)?, skin.side(other, &contact.place)?];
    let turned = match sides {
        [Some(wheel), _] => number_of(first) != wheel,
        [None, Some(rail)] => number_of(other) != rail,
        [None, None] => skin.height(&faces[0]) < skin.height(&faces[1]),
    };
    if turned {
        faces.swap(0, 1);
    }
    let kept: BTreeSet<u32> = faces.iter().flatten().flatten().copied().collect();
    let row: HashMap<u32, u32> = kept.iter().copied().zip(0..).collect();
    let velocity = units.velocity();
    let mut found = Interface {
        nodes: kept.iter().map(|&n| foreign.nodes.ids[n as usize]).collect(),
        images: 0,
        on_plane: Vec::new(),
        points: kept.iter().map(|&n| foreign.points[n as usize].into()).collect(),
        areas: vec![0.0; kept.len()],
        faces: faces.map(|side| side.into_iter().map(|face| face.map(|n| row[&n])).collect()),
        friction: contact.friction.map(|[fs, fd, dc]| [fs, fd, dc / velocity]),
        begins: deck.begins * units.time(),
        units: [units.length(), units.mass(), units.time()],
    };
    let of_set = |id| deck.node_sets.get(id).into_iter().flatten();
    let alone = held.iter().filter(|(set, _)| !set).map(|(_, id)| id);
    let sets = held.iter().filter(|(set, _)| *set).flat_map(|(_, id)| of_set(id));
    found.complete(&alone.chain(sets).copied().collect());
    Ok(found)
}

/// Distance (m) below which places are the same: less than a file prints.
const SAME: f64 = 1e-9;

impl Interface {
    /// Adds mirror images, if the nodes that are `held` along y are those of a plane that ends the surfaces, and areas.
    fn complete(&mut self, held: &BTreeSet<u64>) {
        let on_plane: Vec<u32> =
            (0..).zip(&self.nodes).filter(|(_, id)| held.contains(id)).map(|(n, _)| n).collect();
        if let Some(&first) = on_plane.first() {
            let plane = self.points[first as usize][1];
            let beyond: Vec<f64> = self.points.iter().map(|x| x[1] - plane).collect();
            let one_side = |sign: f64| beyond.iter().all(|y| sign * y > -SAME);
            let flat = on_plane.iter().all(|&n| beyond[n as usize].abs() < SAME);
            if flat && on_plane.len() < beyond.len() && (one_side(1.0) || one_side(-1.0)) {
                self.mirror(plane, on_plane);
            }
        }
        self.areas = vec![0.0; self.points.len()];
        for face in self.faces.iter().flatten() {
            let corners = face.map(|n| Vector3::from(self.points[n as usize]));
            let shares = quad_corner_areas(&corners);
            face.iter().zip(shares).for_each(|(&n, share)| self.areas[n as usize] += share);
        }
    }

    /// Adds the mirror images in the plane y = `plane` of all nodes but those on it.
    fn mirror(&mut self, plane: f64, on_plane: Vec<u32>) {
        let count = self.nodes.len() as u32;
        let off: Vec<u32> = (0..count).filter(|n| on_plane.binary_search(n).is_err()).collect();
        let image: HashMap<u32, u32> = off.iter().copied().zip(count..).collect();
        for &n in &off {
            self.nodes.push(self.nodes[n as usize]);
            let [x, y, z] = self.points[n as usize];
            self.points.push([x, 2.0 * plane - y, z]);
        }
        for side in &mut self.faces {
            let mirrored = |&[a, b, c, d]: &[u32; 4]| {
                [d, c, b, a].map(|n| image.get(&n).copied().unwrap_or(n))
            };
            let images: Vec<_> = side.iter().map(mirrored).collect();
            side.extend(images);
        }
        (self.images, self.on_plane) = (off.len(), on_plane);
    }
}

/// The cards that count.
#[derive(Default)]
struct Reading {
    deck: Deck,
    contacts: Vec<Sliding>,
    /// Nodes held along y: whether it is a set, and its number.
    held: Vec<(bool, u64)>,
}

impl Reading {
    fn card(&mut self, card: &Card) -> Result<(), DeckError> {
        match card.name.as_str() {
            "NODE" | "ELEMENT_SOLID" => drop(self.deck.body_card(card)?),
            "CONTROL_UNITS" => drop(self.deck.control_card(card)?),
            "INITIAL_VELOCITY_GENERATION_START_TIME" => drop(self.deck.motion_card(card)?),
            "BOUNDARY_SPC_SET" | "BOUNDARY_SPC_NODE" => {
                for line in card.lines() {
                    let [id, y] = line.take(&HELD)?;
                    if y == 1.0 {
                        self.held.push((card.name.ends_with("SET"), id as u64));
                    }
                }
            }
            name if name.starts_with("SET_") => drop(self.deck.set_card(card)?),
            name if CONTACTS.contains(&name) => self.contacts.push(contact_card::sliding(card)?),
            _ => {}
        }
        Ok(())
    }
}

/// The contact that has these sides.
fn chosen(contacts: &[Sliding], sides: [Option<u64>; 2]) -> Result<&Sliding, DeckError> {
    let has = |contact: &Sliding, id| contact.sides.iter().any(|side| number_of(*side) == id);
    let fits = |contact: &&Sliding| sides.iter().flatten().all(|id| has(contact, *id));
    let mut fitting = contacts.iter().filter(fits);
    let Some(contact) = fitting.next() else {
        return Err(match (contacts.first(), sides.iter().flatten().next()) {
            (Some(contact), Some(side)) => {
                unknown(&contact.place, "what was asked for", format!("a contact with side {side}"))
            }
            _ => lacks("*CONTACT_SURFACE_TO_SURFACE, _AUTOMATIC_, _ONE_WAY_ or _MORTAR"),
        });
    };
    let remedy = "name the surfaces, with --wheel and --rail: their numbers on the card";
    match fitting.next() {
        Some(next) => Err(second(&next.place, "contact", &contact.place, remedy)),
        None => Ok(contact),
    }
}

fn number_of(side: Side) -> u64 {
    match side {
        Side::Segments(id) | Side::Part(id) | Side::PartSet(id) => id,
    }
}

/// The outer faces of a deck's solids.
struct Skin<'a> {
    deck: &'a Deck,
    foreign: &'a Foreign,
    indices: &'a Indices,
}

impl Skin<'_> {
    /// The faces of a side of the contact, seen from outside; segments of a set may stand either way.
    fn side(&self, side: Side, at: &DeckLine) -> Result<Vec<[u32; 4]>, DeckError> {
        let missing = |what: &str, id| unknown(at, "the contact", format!("{what} {id}"));
        let faces: Vec<[u32; 4]> = match side {
            Side::Segments(id) => {
                let segments = self.deck.segment_sets.get(&id);
                let outer: BTreeMap<[u32; 4], [u32; 4]> =
                    self.outer(|_| true).into_iter().map(|face| (sorted(face), face)).collect();
                let name = format!("segment set {id}");
                let find = |node: u64| self.indices.find(&name, node, at);
                let face = |[a, b, c, d]: &[u64; 4]| {
                    let face = [find(*a)?, find(*b)?, find(*c)?, find(*d)?];
                    Ok(outer.get(&sorted(face)).copied().unwrap_or(face))
                };
                let segments = segments.ok_or_else(|| missing("segment set", id))?;
                segments.iter().map(face).collect::<Result<_, DeckError>>()?
            }
            Side::Part(id) => self.outer(|part| part == id),
            Side::PartSet(id) => {
                let parts = self.deck.part_sets.get(&id).ok_or_else(|| missing("part set", id))?;
                self.outer(|part| parts.contains(&part))
            }
        };
        if faces.is_empty() {
            return Err(syntax(
                at,
                format!("side {} of the contact has no faces", number_of(side)),
            ));
        }
        Ok(faces)
    }

    /// The outer faces of the solids of some parts. A deck may number elements inside out.
    fn outer(&self, of: impl Fn(u64) -> bool) -> Vec<[u32; 4]> {
        let Foreign { points, hexes, .. } = self.foreign;
        let mean = |nodes: &[u32]| {
            nodes.iter().map(|&n| points[n as usize]).sum::<Vector3<f64>>() / nodes.len() as f64
        };
        let outward = |(element, [a, b, c, d]): (usize, [u32; 4])| {
            let normal = vector_area([a, b, c, d].map(|n| points[n as usize]));
            let out = mean(&[a, b, c, d]) - mean(&hexes[element]);
            if normal.dot(&out) < 0.0 { [d, c, b, a] } else { [a, b, c, d] }
        };
        let solids = &self.deck.solids;
        outer_faces(hexes, |e| of(solids[e].part)).into_iter().map(outward).collect()
    }

    /// Mean height of faces (m).
    fn height(&self, faces: &[[u32; 4]]) -> f64 {
        let nodes = faces.as_flattened();
        nodes.iter().map(|&n| self.foreign.points[n as usize].z).sum::<f64>() / nodes.len() as f64
    }
}

fn sorted(mut face: [u32; 4]) -> [u32; 4] {
    face.sort_unstable();
    face
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ls_dyna::Fault;
    use std::fmt::Write as _;

    /// A cube of 1 mm on another with 0.1 mm between; the upper one is numbered inside out. `cards` say the rest.
    fn read(cards: &str, sides: [Option<u64>; 2]) -> Result<Interface, DeckError> {
        let mut deck = String::from("*KEYWORD\n*NODE\n");
        for (first, low) in [(1, 0.0), (11, 1.1)] {
            for (n, [x, y]) in [[0, 0], [1, 0], [1, 1], [0, 1]].into_iter().enumerate() {
                for (above, z) in [(0, low), (4, low + 1.0)] {
                    writeln!(deck, "{}, {x}, {y}, {z}", first + n + above).unwrap();
                }
            }
        }
        deck +=
            "*ELEMENT_SOLID\n1, 1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 2, 15, 16, 17, 18, 11, 12, 13, 14\n";
        // what a disk on a bar could not have
        deck += "*MAT_PLASTIC_KINEMATIC\n1, 7.8e-9, 210e3, 0.3, 400\n*CONTACT_TIED_NODES_TO_SURFACE\n1, 2\n";
        deck += cards;
        deck += "*END\n";
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("deck.k");
        std::fs::write(&file, deck).unwrap();
        let source = Source { file: &file, include_outside: false };
        interface(&source, Units::parse("mm-ton-ms").unwrap(), sides)
    }

    /// Mean height of a side (m), and how many of its faces look outward from the middle of their cube.
    fn seen(found: &Interface, side: usize) -> (f64, usize) {
        let at = |n: u32| Vector3::from(found.points[n as usize]);
        let faces = &found.faces[side];
        let mean =
            |nodes: &[u32]| nodes.iter().map(|&n| at(n)).sum::<Vector3<f64>>() / nodes.len() as f64;
        let middle = mean(faces.as_flattened());
        let outward =
            |face: &&[u32; 4]| vector_area(face.map(at)).dot(&(mean(&face[..]) - middle)) > 0.0;
        (middle.z, faces.iter().filter(outward).count())
    }

    #[test]
    fn sides_by_parts_and_part_sets_are_their_outer_faces_seen_from_outside_and_the_wheel_is_above()
    {
        let cards = "*CONTACT_ONE_WAY_SURFACE_TO_SURFACE_ID\n9, wheel on rail\n1, 5, 3, 2, 0, 0, 1, 1\n0.5, 0.3, 6\n\n2\n\
                     *SET_PART_LIST\n5\n2\n";
        let found = read(cards, [None, None]).unwrap();
        assert_eq!([seen(&found, 0).1, seen(&found, 1).1], [6, 6]);
        assert!(seen(&found, 0).0 > seen(&found, 1).0);
        let mut nodes = found.nodes.clone();
        nodes.sort_unstable();
        assert_eq!(nodes, [1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15, 16, 17, 18]);
        // three faces of 1 mm2 meet at a corner
        assert!(found.areas.iter().all(|area| (area - 0.75e-6).abs() < 1e-15));
        // ms/mm are s/m
        assert_eq!(found.friction, Some([0.5, 0.3, 6.0]));
        assert_eq!(found.units, [1e-3, 1e3, 1e-3]);
        for sides in [[Some(1), None], [None, Some(5)], [Some(1), Some(5)]] {
            let turned = read(cards, sides).unwrap();
            assert!(seen(&turned, 0).0 < seen(&turned, 1).0);
        }
    }

    #[test]
    fn a_half_is_completed_and_a_slice_is_not() {
        let contact = "*CONTACT_SURFACE_TO_SURFACE\n31, 32\n-1\n\n*SET_SEGMENT\n31\n11, 12, 13, 14\n*SET_SEGMENT\n32\n5, 6, 7, 8\n";
        let held = |nodes: &str| {
            let cards =
                format!("{contact}*BOUNDARY_SPC_SET\n4, 0, 0, 1\n*SET_NODE_LIST\n4\n{nodes}\n");
            read(&cards, [None, None]).unwrap()
        };
        let half = held("1, 2, 5, 6, 11, 12, 15, 16");
        assert_eq!((half.images, half.on_plane.len(), half.nodes.len()), (4, 4, 12));
        assert_eq!(half.nodes[8..], [7, 8, 13, 14]);
        assert_eq!(half.faces.each_ref().map(Vec::len), [2, 2]);
        assert_eq!(half.friction, None);
        let up = |face: &[u32; 4]| vector_area(face.map(|n| half.points[n as usize].into())).z;
        assert!(half.faces[0].iter().all(|face| up(face) < 0.0), "the wheel's looks down");
        assert!(half.faces[1].iter().all(|face| up(face) > 0.0), "the rail's looks up");
        let total: f64 = half.areas.iter().sum();
        assert!((total - 4e-6).abs() < 1e-15, "{total:e}");
        let slice = held("5, 6, 7, 8, 11, 12, 13, 14");
        assert_eq!((slice.images, slice.nodes.len()), (0, 8));
    }

    #[test]
    fn of_several_contacts_the_sides_name_one() {
        let cards = "*CONTACT_SURFACE_TO_SURFACE\n1, 2, 3, 3\n0.5\n\n*CONTACT_AUTOMATIC_SURFACE_TO_SURFACE\n2, 7, 3, 3\n0.1\n\n";
        let refused = read(cards, [None, None]).unwrap_err();
        assert!(matches!(refused.fault, Fault::Second { .. }), "{refused}");
        assert_eq!(read(cards, [None, Some(1)]).unwrap().friction, Some([0.5, 0.0, 0.0]));
        for (sides, said) in
            [([Some(7), None], "side 7 of the contact has no faces"), ([Some(4), None], "side 4")]
        {
            let refused = read(cards, sides).unwrap_err().to_string();
            assert!(refused.contains(said), "{refused}");
        }
        assert!(
            read("", [None, None]).unwrap_err().to_string().contains("*CONTACT_SURFACE_TO_SURFACE")
        );
    }
}
