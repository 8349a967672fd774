//! Shape of the elements.

use crate::Mesh;
use crate::geometry::vector_area;
use crate::hex::{HEX_EDGES, hex_volume};
use crate::{HEX_FACES, hex};
use nalgebra::Vector3;

/// Measures of the element shapes of a mesh.
///
/// The *scaled Jacobian* of a hexahedron (Knupp 2000; the Verdict library, Sandia SAND2007-1751) is
/// the least, over its eight corners, of the triple product of the three unit vectors along the
/// edges that leave the corner: 1 for a brick, 0 for a flat corner, negative for an inverted one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Least scaled Jacobian (dimensionless).
    pub min_scaled_jacobian: f64,
    /// Mean of the scaled Jacobian over the elements.
    pub mean_scaled_jacobian: f64,
    /// Largest ratio of an element's longest edge to its shortest.
    pub max_aspect: f64,
    /// Element with the least scaled Jacobian.
    pub worst_element: usize,
    /// Shortest edge (m).
    pub min_edge: f64,
    /// Longest edge (m).
    pub max_edge: f64,
    /// Least thickness of an element: its volume over its largest face (m). The time step that a
    /// dilatational wave allows is about this length over its speed.
    pub min_thickness: f64,
    /// Element with the least thickness.
    pub thinnest_element: usize,
    /// Total volume (m^3).
    pub volume: f64,
}

/// Measures the elements of a mesh. Of an empty mesh the least values are infinite and the mean is NaN.
///
/// # Panics
/// If an element names a node that the mesh does not have.
pub fn quality(mesh: &Mesh) -> Quality {
    let mut q = Quality {
        min_scaled_jacobian: f64::INFINITY,
        mean_scaled_jacobian: 0.0,
        max_aspect: 0.0,
        worst_element: 0,
        min_edge: f64::INFINITY,
        max_edge: 0.0,
        min_thickness: f64::INFINITY,
        thinnest_element: 0,
        volume: 0.0,
    };
    for (element, corners) in mesh.hexes.iter().enumerate() {
        let p = corners.map(|n| mesh.at(n));
        let (_, jacobian) = scaled_jacobian(&p);
        q.mean_scaled_jacobian += jacobian;
        if jacobian < q.min_scaled_jacobian {
            q.min_scaled_jacobian = jacobian;
            q.worst_element = element;
        }
        let (mut shortest, mut longest) = (f64::INFINITY, 0f64);
        for [a, b] in HEX_EDGES {
            let edge = (p[b] - p[a]).norm();
            shortest = shortest.min(edge);
            longest = longest.max(edge);
        }
        q.max_aspect = q.max_aspect.max(longest / shortest);
        q.min_edge = q.min_edge.min(shortest);
        q.max_edge = q.max_edge.max(longest);
        let mut largest = 0f64;
        for face in HEX_FACES {
            largest = largest.max(vector_area(face.map(|c| p[c])).norm());
        }
        let volume = hex_volume(&p);
        q.volume += volume;
        if volume / largest < q.min_thickness {
            q.min_thickness = volume / largest;
            q.thinnest_element = element;
        }
    }
    q.mean_scaled_jacobian /= mesh.hexes.len() as f64;
    q
}

/// Corner with the least scaled Jacobian, and its value; NaN where an edge has no length.
pub(crate) fn scaled_jacobian(p: &[Vector3<f64>; 8]) -> (usize, f64) {
    let mut worst = (0, f64::INFINITY);
    for (corner, neighbours) in hex::NEIGHBOURS.iter().enumerate() {
        let [a, b, c] = neighbours.map(|n| p[n] - p[corner]);
        let value = a.dot(&b.cross(&c)) / (a.norm() * b.norm() * c.norm());
        if value.is_nan() {
            return (corner, value);
        }
        if value < worst.1 {
            worst = (corner, value);
        }
    }
    worst
}
