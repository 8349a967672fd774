//! A mesh as it stands in a file.

use super::error::{Fault, ImportError};
use std::collections::BTreeMap;

/// A mesh as a file or a program gives it: nothing is checked yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Foreign {
    /// Coordinates, in the unit of the file.
    pub points: Vec<[f64; 3]>,
    /// Places in `points` of each hexahedron's corners in `VTK_HEXAHEDRON` order, which is also that
    /// of Gmsh, Abaqus C3D8 and LS-DYNA.
    pub hexes: Vec<[u32; 8]>,
    /// Named sets.
    pub sets: BTreeMap<String, Set>,
    /// Numbers and lines of nodes in the file; empty where they have none, and their places count.
    pub nodes: Labels,
    /// Numbers and lines of hexahedra in the file.
    pub elements: Labels,
    /// What the user should know of the reading.
    pub notes: Vec<String>,
}

/// A named set, by any of three kinds of members.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Set {
    /// Places in [`Foreign::points`].
    pub nodes: Vec<u32>,
    /// Places in [`Foreign::hexes`].
    pub hexes: Vec<u32>,
    /// Faces by their corners, in order around the face in either sense.
    pub faces: Vec<[u32; 4]>,
}

/// Numbers and lines in a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labels {
    /// Numbers.
    pub ids: Vec<u64>,
    /// Lines, counted from 1.
    pub lines: Vec<usize>,
}

impl Labels {
    pub(crate) fn push(&mut self, id: u64, line: usize) {
        self.ids.push(id);
        self.lines.push(line);
    }

    /// Takes over entry `place` of `other`, as far as it has one.
    pub(crate) fn copy(&mut self, other: &Self, place: usize) {
        self.ids.push(other.id(place));
        self.lines.extend(other.lines.get(place));
    }

    /// The number in the file of entry `place`.
    pub fn id(&self, place: usize) -> u64 {
        self.ids.get(place).copied().unwrap_or(place as u64)
    }

    /// The fault, at the line of entry `place` where it has one.
    pub(crate) fn fault(&self, place: usize, fault: Fault) -> ImportError {
        ImportError { line: self.lines.get(place).copied(), fault }
    }
}

impl Foreign {
    /// A mesh from arrays: points (in any one unit), hexahedra by the places of their corners in
    /// `VTK_HEXAHEDRON` order, named sets. Messages then name nodes and elements by their places,
    /// counted from 0. [`bodies`](super::bodies()) checks it.
    pub fn from_arrays(
        points: Vec<[f64; 3]>,
        hexes: Vec<[u32; 8]>,
        sets: BTreeMap<String, Set>,
    ) -> Self {
        Self { points, hexes, sets, ..Self::default() }
    }

    /// The set of a name, made where there is none.
    pub(crate) fn set(&mut self, name: &str) -> &mut Set {
        self.sets.entry(name.to_owned()).or_default()
    }
}
