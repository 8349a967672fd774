//! The mesh of a contact history and the body of each node.

use crate::check::PostError;
use mesh::geometry::vector_area;
use nalgebra::Vector3;
use output::layout::{BODY_NAMES, CONSTANT};
use output::{FieldSpec, GridFile};
use std::path::Path;

/// The contact surfaces of both bodies.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Reference coordinates (m).
    pub points: Vec<Vector3<f64>>,
    /// Faces, counter-clockwise seen from outside.
    pub faces: Vec<[u32; 4]>,
    /// Body of each face: 0 disk, 1 bar; 0 where the file has one body only.
    pub face_body: Vec<u8>,
    /// Body of each node; `NO_BODY` for nodes without a face.
    pub body: Vec<u8>,
    /// Tributary area of each node (m2).
    pub area: Vec<f64>,
}

/// Label in [`Surface::body`] of a node that no face uses.
pub const NO_BODY: u8 = u8::MAX;

/// The name of a body by its label: `disk`, `bar`, else `other`.
pub fn body_name(body: u8) -> &'static str {
    BODY_NAMES.get(usize::from(body)).copied().unwrap_or("other")
}

impl Surface {
    pub(crate) fn read(file: &GridFile, path: &Path) -> Result<Self, PostError> {
        let lacks = |what: &str| PostError::Lacks { path: path.into(), what: what.into() };
        let points: Vec<Vector3<f64>> = file.points()?.into_iter().map(Vector3::from).collect();
        let connectivity = file.connectivity()?;
        if file.cells().checked_mul(4) != Some(connectivity.len()) {
            return Err(lacks("its cells are not quads; a contact history has four-node faces"));
        }
        let faces = connectivity.as_chunks::<4>().0.to_vec();
        if connectivity.iter().any(|&node| node as usize >= points.len()) {
            return Err(lacks("a face names a node that the file does not hold"));
        }
        if points.iter().flatten().any(|x| !x.is_finite()) {
            return Err(lacks("a node has coordinates that are not numbers"));
        }
        let constant = |field: &FieldSpec| {
            let has =
                file.fields().iter().any(|f| f.name == field.name && f.on_cells == field.on_cells);
            has.then(|| file.read(&field.name, field.on_cells, 0)).transpose()
        };
        let face_body: Vec<u8> = match constant(&CONSTANT.body)? {
            Some(labels) => labels.into_iter().map(|b| b as u8).collect(),
            None => vec![0; faces.len()],
        };
        let mut body = vec![NO_BODY; points.len()];
        for (face, &label) in faces.iter().zip(&face_body) {
            face.iter().for_each(|&node| body[node as usize] = label);
        }
        let area = constant(&CONSTANT.area)?.unwrap_or_else(|| tributary_areas(&points, &faces));
        if area.iter().any(|a| !a.is_finite() || *a < 0.0) {
            return Err(lacks("the field area holds values that are no areas"));
        }
        Ok(Self { points, faces, face_body, body, area })
    }

    /// Indices of a body's nodes nearest y = 0, sorted by their reference x; `size` is the edge of an element (m).
    pub(crate) fn centreline(&self, body: u8, size: f64) -> Vec<usize> {
        let of_body = |&row: &usize| self.body[row] == body;
        let off = |row: usize| self.points[row][1].abs();
        let rows = (0..self.points.len()).filter(of_body);
        let least = rows.clone().map(off).fold(f64::INFINITY, f64::min);
        let mut rows: Vec<usize> = rows.filter(|&row| off(row) <= least + 0.1 * size).collect();
        let x = |row: usize| self.points[row][0];
        rows.sort_by(|a, b| x(*a).total_cmp(&x(*b)));
        // where no node is on y = 0 there may be a line on each side: one node is kept of each two alike in x
        rows.dedup_by(|a, b| (x(*a) - x(*b)).abs() < 0.1 * size);
        rows
    }

    /// Of each node the halves of the faces around it: in x and in y the ends of these, from the node (m). At the edge of
    /// the surface they end at the node.
    pub(crate) fn halves(&self) -> Vec<[[f64; 2]; 2]> {
        let mut halves = vec![[[0.0f64; 2]; 2]; self.points.len()];
        for face in &self.faces {
            for [node, other] in face.iter().flat_map(|a| face.map(|b| [*a as usize, b as usize])) {
                for axis in 0..2 {
                    let half = 0.5 * (self.points[other][axis] - self.points[node][axis]);
                    let [low, high] = &mut halves[node][axis];
                    (*low, *high) = (low.min(half), high.max(half));
                }
            }
        }
        halves
    }

    /// Labels of the bodies that have faces, sorted, each once.
    pub fn bodies(&self) -> Vec<u8> {
        let mut labels: Vec<u8> = self.face_body.clone();
        labels.sort_unstable();
        labels.dedup();
        labels
    }
}

/// Area of each node (m2): a quarter of every face around it.
fn tributary_areas(points: &[Vector3<f64>], faces: &[[u32; 4]]) -> Vec<f64> {
    let mut area = vec![0.0; points.len()];
    for face in faces {
        let part = 0.25 * vector_area(face.map(|node| points[node as usize])).norm();
        face.iter().for_each(|&node| area[node as usize] += part);
    }
    area
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tributary_areas_of_two_faces_are_a_quarter_of_each_at_its_corners() {
        // a square of 2 m on the plane z = 1 m, and one that stands on its edge, 2 m x 3 m
        let points = [
            [0.0, 0.0, 1.0],
            [2.0, 0.0, 1.0],
            [2.0, 2.0, 1.0],
            [0.0, 2.0, 1.0],
            [2.0, 2.0, 4.0],
            [2.0, 0.0, 4.0],
        ]
        .map(Vector3::from);
        let faces = [[0, 1, 2, 3], [1, 5, 4, 2]];
        let expected = [1.0, 2.5, 2.5, 1.0, 1.5, 1.5];
        for (found, expected) in tributary_areas(&points, &faces).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
    }

    #[test]
    fn the_cells_of_a_surface_cover_it_up_to_its_edge_and_no_further() {
        // two rows of three nodes, 1 mm and then 3 mm apart
        let xs = [0.0, 1e-3, 4e-3];
        let points: Vec<Vector3<f64>> =
            [0.0, 2e-3].iter().flat_map(|y| xs.map(|x| Vector3::new(x, *y, 0.0))).collect();
        let surface = Surface {
            points: points.clone(),
            faces: vec![[0, 1, 4, 3], [1, 2, 5, 4]],
            face_body: vec![0; 2],
            body: vec![0; 6],
            area: vec![0.0; 6],
        };
        let halves = surface.halves();
        assert_eq!(halves[0], [[0.0, 0.5e-3], [0.0, 1e-3]]);
        assert_eq!(halves[4], [[-0.5e-3, 1.5e-3], [-1e-3, 0.0]]);
        let area: f64 =
            halves.iter().map(|h| h.map(|[low, high]| high - low).iter().product::<f64>()).sum();
        assert!((area / 8e-6 - 1.0).abs() < 1e-12);
    }
}
