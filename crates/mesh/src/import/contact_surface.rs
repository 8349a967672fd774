//! Checks of an imported contact surface: its faces must form one connected sheet without holes.

use super::bodies::Imported;
use super::error::{Fault, ImportError, SetRole};
use super::parts::Parts;
use crate::Face;
use crate::error::digits;
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::TAU;

/// The form that a contact surface must have, by its borders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sheet {
    /// A band around the disk: two borders, each of which encircles the disk's axis once.
    Band,
    /// A patch with one border.
    Patch,
}

/// Checks that the faces `chosen` of `boundary` form one connected sheet without holes.
pub(super) fn check(
    imported: &Imported,
    (role, name): (SetRole, &str),
    sheet: Sheet,
    boundary: &[Face],
    chosen: &[bool],
) -> Result<(), ImportError> {
    let name = name.to_owned();
    let inside: Vec<&Face> = boundary.iter().zip(chosen).filter(|c| *c.1).map(|c| c.0).collect();
    // Faces of each edge.
    let mut edges: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
    for (i, face) in inside.iter().enumerate() {
        for [a, b] in edges_of(face) {
            edges.entry([a.min(b), a.max(b)]).or_default().push(i as u32);
        }
    }
    let element = |face: &Face| imported.elements.id(face.hex as usize);
    let at_face = |face: &Face, fault: Fault| imported.elements.fault(face.hex as usize, fault);
    let mut pieces = Parts::new(inside.len());
    let mut border: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    for (i, face) in inside.iter().enumerate() {
        for [a, b] in edges_of(face) {
            let edge = [a.min(b), a.max(b)];
            let faces = &edges[&edge];
            if faces.len() > 2 {
                let edge = edge.map(|n| imported.nodes.id(n as usize));
                return Err(at_face(face, Fault::Fold { role, name, edge }));
            }
            faces.iter().for_each(|&other| pieces.join(i as u32, other));
            if faces.len() == 1 {
                border.insert(edge, [a, b]);
            }
        }
    }
    if let Some(apart) = pieces.apart() {
        let face = inside[apart as usize];
        return Err(at_face(face, Fault::Pieces { role, name, element: element(face) }));
    }

    let loops = loops(&border);
    if sheet == Sheet::Band
        && let Some(axis) = another_axis(imported, &loops)
    {
        return Err(at_face(inside[0], Fault::Axis { role, name, axis }));
    }
    let (rims, holes): (Vec<_>, Vec<_>) = match sheet {
        Sheet::Band => loops.into_iter().partition(|l| winding(imported, l, Y) != 0),
        Sheet::Patch => {
            let longest = loops.iter().map(Vec::len).max();
            let first = loops.iter().position(|l| Some(l.len()) == longest);
            let (rim, holes): (Vec<_>, Vec<_>) =
                loops.into_iter().enumerate().partition(|(i, _)| Some(*i) == first);
            let bare = |l: Vec<(usize, Vec<[u32; 2]>)>| l.into_iter().map(|(_, l)| l).collect();
            (bare(rim), bare(holes))
        }
    };
    // The face outside the set at an edge of its border.
    let beyond = |[a, b]: [u32; 2]| {
        let outside = boundary.iter().zip(chosen).filter(|c| !*c.1).map(|c| c.0);
        let mut met = outside.filter(|f| f.nodes.contains(&a) && f.nodes.contains(&b));
        met.next().copied()
    };
    let open = sheet == Sheet::Band && rims.len() < 2;
    let smallest = holes.iter().min_by_key(|l| l.len());
    match smallest {
        // a band that does not close round the disk has one border, which does not encircle the axis
        Some(hole) if !open || holes.len() > 1 => {
            let face = beyond(hole[0]).unwrap_or(*inside[0]);
            let at = imported.mesh.nodes[hole[0][0] as usize].map(digits).into();
            let fault = Fault::Hole { role, name, edges: hole.len(), at, element: element(&face) };
            Err(at_face(&face, fault))
        }
        _ if open => {
            let edge = border.values().find_map(|&edge| beyond(edge));
            let face = edge.unwrap_or(*inside[0]);
            Err(at_face(&face, Fault::Open { role, name, element: element(&face) }))
        }
        _ => Ok(()),
    }
}

fn edges_of(face: &Face) -> [[u32; 2]; 4] {
    let [a, b, c, d] = face.nodes;
    [[a, b], [b, c], [c, d], [d, a]]
}

/// The edges of a border, each in the sense of its face, grouped by the closed loops that they form.
fn loops(border: &BTreeMap<[u32; 2], [u32; 2]>) -> Vec<Vec<[u32; 2]>> {
    let mut places: BTreeMap<u32, u32> = BTreeMap::new();
    for node in border.values().flatten() {
        let next = places.len() as u32;
        places.entry(*node).or_insert(next);
    }
    let mut joined = Parts::new(places.len());
    border.values().for_each(|[a, b]| joined.join(places[a], places[b]));
    let mut found: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
    for edge in border.values() {
        found.entry(joined.of(places[&edge[0]])).or_default().push(*edge);
    }
    found.into_values().collect()
}

/// Index of the y coordinate.
const Y: usize = 1;

/// The axis, other than y, that both borders of a band encircle; `None` if they encircle y.
fn another_axis(imported: &Imported, loops: &[Vec<[u32; 2]>]) -> Option<char> {
    let rims = |axis| loops.iter().filter(|l| winding(imported, l, axis) != 0).count();
    let others = [(0, 'x'), (2, 'z')].into_iter();
    let mut others = others.filter(|(axis, _)| rims(Y) == 0 && rims(*axis) == 2);
    others.next().map(|(_, name)| name)
}

/// How often a border encircles the line along an axis through the middle of the disk.
fn winding(imported: &Imported, border: &[[u32; 2]], axis: usize) -> i64 {
    let mesh = &imported.mesh;
    let plane = [(axis + 2) % 3, (axis + 1) % 3];
    let middle = plane.map(|axis| {
        let along = mesh.nodes[mesh.bodies[0].nodes.clone()].iter().map(|p| p[axis]);
        let (low, high) = along
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        0.5 * (low + high)
    });
    let arm = |n: u32| {
        let p = mesh.nodes[n as usize];
        [p[plane[0]] - middle[0], p[plane[1]] - middle[1]]
    };
    let turn: f64 = border
        .iter()
        .map(|&[a, b]| {
            let ([x, z], [u, w]) = (arm(a), arm(b));
            libm::atan2(x * w - z * u, x * u + z * w)
        })
        .sum();
    (turn / TAU).round() as i64
}
