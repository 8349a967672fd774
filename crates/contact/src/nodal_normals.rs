//! Averaged normals: at a node of the master the mean of the normals of the faces around it, between nodes the mean of
//! these with the shape functions (Yang, Laursen and Meng 2005; Puso and Laursen 2004).
//!
//! Under load the facets of a dent meet at angles of the order of h/R, for faces of size h under a disk of radius R. A node
//! beside an edge that takes the normal of its face is pushed along the surface. Where meshes match, all nodes lie on the
//! same side of their edges, and the pushes add up to about h/(4R) of the load, without friction. The averaged normal is
//! continuous over the edges. The normal of the face alone is that of Benson and Hallquist (1990).

use crate::face::{Positions, corner_normal};
use crate::surface::ContactSurface;
use crate::symmetry::in_plane;
use mesh::geometry::direction;
use nalgebra::{UnitVector3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The normals of contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Normals {
    /// Averaged at nodes, interpolated between them.
    #[default]
    Averaged,
    /// Of the face alone.
    Face,
}

impl Normals {
    /// The words of a case file for them.
    pub const WORDS: &'static [&'static str] = &["averaged", "face"];
}

/// The normals at the nodes of one surface, each found when it is first asked for in a configuration.
#[derive(Clone, Debug)]
pub(crate) struct NodalNormals {
    curvature: bool,
    normal: Vec<UnitVector3<f64>>,
    /// The configuration in which each was found.
    found: Vec<u64>,
    now: u64,
}

impl NodalNormals {
    /// Of `surface`, with the normals of its exact surface where it has one and `curvature` is set.
    pub fn new(surface: &ContactSurface, curvature: bool) -> Self {
        let nodes = surface.len();
        Self { curvature, normal: vec![Vector3::z_axis(); nodes], found: vec![0; nodes], now: 1 }
    }

    /// Forgets the normals, since the nodes move.
    pub fn expire(&mut self) {
        self.now += 1;
    }

    /// The unit normal of `surface` at the mean of the corners of `face` with `weights`; on a plane of symmetry that of the
    /// surface with its mirror image.
    pub fn at(
        &mut self,
        surface: &ContactSurface,
        positions: &Positions<'_>,
        face: u32,
        weights: &[f64; 4],
    ) -> UnitVector3<f64> {
        let corners = surface.faces[face as usize].local;
        let mut sum = Vector3::zeros();
        for (weight, node) in weights.iter().zip(corners) {
            // on an edge the nodes beside it have no part
            if *weight != 0.0 {
                sum += *weight * *self.of(surface, positions, node);
            }
        }
        direction(sum)
    }

    fn of(
        &mut self,
        surface: &ContactSurface,
        positions: &Positions<'_>,
        node: u32,
    ) -> UnitVector3<f64> {
        let place = node as usize;
        if self.found[place] != self.now {
            self.found[place] = self.now;
            self.normal[place] = self.mean(surface, positions, node);
        }
        self.normal[place]
    }

    fn mean(
        &self,
        surface: &ContactSurface,
        positions: &Positions<'_>,
        node: u32,
    ) -> UnitVector3<f64> {
        let on_plane = surface.is_on_plane(positions.at(surface.node(node)));
        let around = surface.around(node).iter();
        let sum = around.fold(Vector3::zeros(), |sum, corner| {
            let normal = *corner_normal(surface, corner, positions, self.curvature);
            sum + if on_plane { in_plane(normal) } else { normal }
        });
        direction(sum)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::tests::plates::{STEEL, tread};
    use mesh::Padded;

    #[test]
    fn nodes_of_a_tread_have_the_normals_of_its_circle_at_its_ends_too() {
        let (radius, half_angle) = (0.46, 0.02);
        let (mesh, faces) = tread(radius, half_angle, 8e-3, [10, 4], 2e-3);
        let (trace, surface) = ContactSurface::alone(&mesh, &faces, STEEL).unwrap();
        let nodes: Vec<Padded> = trace.gather(&mesh.nodes).into_iter().map(Padded::from).collect();
        let mut worst = [0.0_f64; 2];
        for (worst, curvature) in worst.iter_mut().zip([true, false]) {
            let mut normals = NodalNormals::new(&surface, curvature);
            for face in 0..surface.faces.len() {
                for corner in 0..4 {
                    let [x, _, z] = nodes[surface.faces[face].nodes[corner] as usize].xyz();
                    let mut weights = [0.0; 4];
                    weights[corner] = 1.0;
                    let found = normals.at(&surface, &Positions(&nodes), face as u32, &weights);
                    let off = [found[0] - x / radius, found[1], found[2] - (z - radius) / radius];
                    *worst = off.iter().fold(*worst, |worst, c| worst.max(c.abs()));
                }
            }
        }
        let [circle, facets] = worst;
        assert!(circle < 1e-12, "{circle:e}");
        // at the ends of the tread facets lie off by half of the angle of one
        assert!((facets / (half_angle / 10.0) - 1.0).abs() < 0.1, "{facets:e}");
    }
}
