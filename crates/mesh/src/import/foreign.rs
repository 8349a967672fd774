//! A mesh as a file holds it.

use super::error::{Fault, ImportError, Place};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// A mesh as a file or a program gives it, not checked yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Foreign {
    /// Coordinates (x, y, z) of the nodes, in the unit of the file.
    pub points: Vec<Vector3<f64>>,
    /// Corners of each hexahedron, as indices in `points`, in `VTK_HEXAHEDRON` order, which is also that of
    /// Gmsh, Abaqus C3D8 and LS-DYNA.
    pub hexes: Vec<[u32; 8]>,
    /// The sets by their names.
    pub sets: BTreeMap<String, Set>,
    /// Sets that name nodes or elements which the file does not have, with the first of these.
    pub incomplete: BTreeMap<String, ImportError>,
    /// Numbers and lines of the nodes in the file; empty where they have none.
    pub nodes: Labels,
    /// Numbers and lines of the hexahedra in the file; empty where they have none.
    pub elements: Labels,
    /// What the user should know about how the file was read, a sentence each.
    pub notes: Vec<String>,
}

/// A named set; its members may be of three kinds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Set {
    /// Nodes, as indices in [`Foreign::points`].
    pub nodes: Vec<u32>,
    /// Elements, as indices in [`Foreign::hexes`].
    pub hexes: Vec<u32>,
    /// Faces by their corners, as indices in [`Foreign::points`], in order around the face in either sense.
    pub faces: Vec<[u32; 4]>,
}

/// The numbers of nodes or elements in a file, and the lines of a text where they stand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labels {
    /// Their numbers; may be empty.
    pub ids: Vec<u64>,
    /// Their lines, counted from 1; may be empty.
    pub lines: Vec<usize>,
}

impl Labels {
    /// Appends an entry; in a binary file its number alone tells where it is.
    pub(crate) fn push(&mut self, id: u64, place: impl Into<Place>) {
        self.ids.push(id);
        if let Place::Line(line) = place.into() {
            self.lines.push(line);
        }
    }

    /// Appends entry `index` of `other`: its number, and its line if it has one.
    pub(crate) fn copy(&mut self, other: &Self, index: usize) {
        self.ids.push(other.id(index));
        self.lines.extend(other.lines.get(index));
    }

    /// The number in the file of entry `index`; `index` itself where there are no numbers.
    pub fn id(&self, index: usize) -> u64 {
        self.ids.get(index).copied().unwrap_or(index as u64)
    }

    /// The fault, at the line of entry `index` where it has one.
    pub(crate) fn fault(&self, index: usize, fault: Fault) -> ImportError {
        ImportError { place: self.lines.get(index).copied().map(Place::Line), fault }
    }
}

impl Foreign {
    /// A mesh from arrays: coordinates of nodes (in any one unit), hexahedra by the indices of their corners in
    /// `VTK_HEXAHEDRON` order, and named sets. Messages name nodes and elements by their indices, counted
    /// from 0. [`bodies`](super::bodies()) checks the mesh.
    pub fn from_arrays(
        points: Vec<Vector3<f64>>,
        hexes: Vec<[u32; 8]>,
        sets: BTreeMap<String, Set>,
    ) -> Self {
        Self { points, hexes, sets, ..Self::default() }
    }

    /// The set of a name, created empty if there is none.
    pub(crate) fn set(&mut self, name: &str) -> &mut Set {
        self.sets.entry(name.to_owned()).or_default()
    }
}
