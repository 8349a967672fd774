//! One contact surface: its nodes, faces, neighbours, tributary areas and masses.

use crate::face::{Bilinear, Inclination, Positions};
use crate::{BodyMaterial, ContactError, Trace};
use mesh::{Mesh, SmoothSurface, Surface};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::ops::Range;

/// No face, or no neighbour across an edge.
pub(crate) const NONE: u32 = u32::MAX;

/// A master face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MasterFace {
    /// Corner nodes in the trace.
    pub nodes: [u32; 4],
    /// Corner nodes in the surface.
    pub local: [u32; 4],
    /// Across edge `e` (corners `e`, `e + 1`): the face, and which of its edges that is.
    pub neighbours: [(u32, u8); 4],
    /// The face in the reference configuration.
    pub reference: Bilinear,
    /// Root of the area (m).
    pub size: f64,
}

impl MasterFace {
    #[inline(always)]
    pub fn facet(&self, positions: &Positions<'_>) -> Bilinear {
        // Not by `map`: what it calls is not always inlined.
        let mut x = [Vector3::zeros(); 4];
        for (x, &node) in x.iter_mut().zip(&self.nodes) {
            *x = positions.at(node);
        }
        Bilinear::through(x)
    }
}

/// A face at a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub face: u32,
    /// Which of its corners the node is.
    pub number: u8,
    /// That of the exact surface there, if there is one.
    pub inclination: Option<Inclination>,
}

/// One side of the contact.
#[derive(Clone, Debug)]
pub(crate) struct ContactSurface {
    /// Its first node in the trace, where all of them stand in order.
    first: u32,
    pub faces: Vec<MasterFace>,
    /// Tributary area of each node in the reference configuration (m^2).
    pub area: Vec<f64>,
    /// Mass of the surface elements lumped at each node over its area (kg/m^2).
    pub mass_per_area: Vec<f64>,
    /// `K A/V` of the elements behind the faces (N/m^3), at each node their mean weighted by the
    /// face's share in its area.
    pub scaled_stiffness: Vec<f64>,
    pub smooth: Option<SmoothSurface>,
    /// How far the origin of the coordinates lies ahead along x (m), of the place where it was at the start (module
    /// `renumber`).
    pub origin: f64,
    /// Whether y = 0 is a plane of symmetry and this is the half y >= 0 (module `symmetry`).
    pub symmetric: bool,
    /// Which nodes lie on the plane; empty without one.
    plane: Vec<bool>,
    /// The faces around each node: `around[start[i]..start[i + 1]]`.
    start: Vec<u32>,
    around: Vec<Corner>,
}

impl ContactSurface {
    /// Side 0 and side 1, which must have no node in common.
    pub fn both(
        mesh: &Mesh,
        surfaces: [(&Surface, BodyMaterial); 2],
    ) -> Result<(Trace, [Self; 2]), ContactError> {
        let mut trace = Trace::new(surfaces.map(|(surface, _)| nodes_of(surface)));
        let [(first, first_material), (second, second_material)] = surfaces;
        let sides = [
            Self::new(mesh, first, first_material, &trace, 0)?,
            Self::new(mesh, second, second_material, &trace, 1)?,
        ];
        trace.lift(mesh, [first, second])?;
        match trace.side(0).iter().find(|n| trace.side(1).binary_search(n).is_ok()) {
            Some(&node) => Err(ContactError::SharedNode { node }),
            None => Ok((trace, sides)),
        }
    }

    fn new(
        mesh: &Mesh,
        surface: &Surface,
        material: BodyMaterial,
        trace: &Trace,
        side: usize,
    ) -> Result<Self, ContactError> {
        if surface.faces.is_empty() {
            return Err(ContactError::EmptySurface { side });
        }
        let nodes = trace.side(side);
        let first = trace.range(side).start as u32;
        let mut result = Self {
            first,
            area: vec![0.0; nodes.len()],
            mass_per_area: vec![0.0; nodes.len()],
            scaled_stiffness: vec![0.0; nodes.len()],
            faces: Vec::with_capacity(surface.faces.len()),
            smooth: surface.smooth.clone(),
            origin: 0.0,
            symmetric: mesh.symmetric,
            plane: Vec::new(),
            start: Vec::new(),
            around: Vec::new(),
        };
        if mesh.symmetric {
            result.plane = nodes.iter().map(|&n| mesh.nodes[n as usize][1] == 0.0).collect();
        }
        for (index, face) in surface.faces.iter().enumerate() {
            let outside = ContactError::OutsideMesh { side, face: index };
            let hex = mesh.hexes.get(face.hex as usize).ok_or(outside.clone())?;
            if face.nodes.iter().chain(hex).any(|&n| n as usize >= mesh.nodes.len()) {
                return Err(outside);
            }
            let corners = face.nodes.map(|n| mesh.at(n));
            let volume = mesh::hex_volume(&hex.map(|n| mesh.at(n)));
            let shares = mesh::quad_corner_areas(&corners);
            let area: f64 = shares.iter().sum();
            let sound = area > 0.0 && volume > 0.0 && (area + volume).is_finite();
            if !sound {
                return Err(ContactError::Degenerate { side, face: index });
            }
            let scaled = material.bulk_modulus * area / volume;
            let mut local = [0; 4];
            for corner in 0..4 {
                let slot = nodes.partition_point(|&n| n < face.nodes[corner]);
                local[corner] = slot as u32;
                result.area[slot] += shares[corner];
                result.mass_per_area[slot] += material.density * volume / 8.0;
                result.scaled_stiffness[slot] += shares[corner] * scaled;
            }
            result.faces.push(MasterFace {
                nodes: local.map(|n| first + n),
                local,
                neighbours: [(NONE, 0); 4],
                reference: Bilinear::through(corners.map(Vector3::from)),
                size: area.sqrt(),
            });
        }
        let Self { mass_per_area, scaled_stiffness, area, .. } = &mut result;
        for sums in [mass_per_area, scaled_stiffness] {
            sums.iter_mut().zip(&*area).for_each(|(sum, area)| *sum /= area);
        }
        result.join_neighbours(side, nodes)?;
        result.gather_around();
        Ok(result)
    }

    /// How many nodes it has.
    pub fn len(&self) -> usize {
        self.area.len()
    }

    /// Whether a node at `x` (m) lies on the plane of symmetry of the surface.
    #[inline(always)]
    pub fn is_on_plane(&self, x: Vector3<f64>) -> bool {
        self.symmetric && x[1] == 0.0
    }

    /// How many nodes of the whole surface a node at `x` (m) stands for: itself, and its mirror image where it has one.
    pub fn nodes_of_whole(&self, x: Vector3<f64>) -> usize {
        if self.symmetric && x[1] != 0.0 { 2 } else { 1 }
    }

    /// Whether a node of the surface has a mirror image.
    pub fn has_image(&self, local: usize) -> bool {
        self.symmetric && !self.holds_on_plane(local)
    }

    /// Whether a node of the surface lies on the plane of symmetry.
    pub fn holds_on_plane(&self, local: usize) -> bool {
        self.plane.get(local).is_some_and(|on_plane| *on_plane)
    }

    /// The number in the trace of a node of the surface.
    #[inline(always)]
    pub fn node(&self, local: u32) -> u32 {
        self.first + local
    }

    /// The numbers of its nodes in the trace.
    pub fn nodes(&self) -> Range<u32> {
        self.first..self.first + self.len() as u32
    }

    /// The faces around a node, ascending.
    #[inline]
    pub fn around(&self, local: u32) -> &[Corner] {
        let [first, last] = [0, 1].map(|next| self.start[local as usize + next] as usize);
        &self.around[first..last]
    }

    fn gather_around(&mut self) {
        let corners = self.faces.iter().zip(0..).flat_map(|(face, f)| {
            face.local.into_iter().zip(0..).map(move |(node, corner)| (node, (f, corner)))
        });
        let mut corners: Vec<(u32, (u32, u8))> = corners.collect();
        corners.sort_unstable();
        let nodes = 0..=self.len() as u32;
        let first = |node| corners.partition_point(|(at, _)| *at < node) as u32;
        self.start = nodes.map(first).collect();
        let corner = |(_, (face, number))| Corner {
            face,
            number,
            inclination: Inclination::at_corner(self, face, number),
        };
        self.around = corners.into_iter().map(corner).collect();
    }

    /// Every inner edge is run through once in each direction; `nodes` are the numbers in the mesh.
    fn join_neighbours(&mut self, side: usize, nodes: &[u32]) -> Result<(), ContactError> {
        let mut edges = BTreeMap::new();
        for (index, face) in self.faces.iter().enumerate() {
            for e in 0..4 {
                let (a, b) = (face.local[e], face.local[(e + 1) % 4]);
                if edges.insert((a, b), (index as u32, e as u8)).is_some() {
                    let [a, b] = [a, b].map(|n| nodes[n as usize]);
                    return Err(ContactError::Edge { side, a, b });
                }
            }
        }
        for face in &mut self.faces {
            for e in 0..4 {
                let (a, b) = (face.local[e], face.local[(e + 1) % 4]);
                face.neighbours[e] = edges.get(&(b, a)).copied().unwrap_or((NONE, 0));
            }
        }
        Ok(())
    }
}

/// Numbers in the mesh of the nodes of a surface, ascending.
fn nodes_of(surface: &Surface) -> Vec<u32> {
    let mut nodes: Vec<u32> = surface.faces.iter().flat_map(|f| f.nodes).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

#[cfg(test)]
impl ContactSurface {
    /// A surface with no other, side 0.
    pub fn alone(
        mesh: &Mesh,
        surface: &Surface,
        material: BodyMaterial,
    ) -> Result<(Trace, Self), ContactError> {
        let trace = Trace::new([nodes_of(surface), Vec::new()]);
        let surface = Self::new(mesh, surface, material, &trace, 0)?;
        Ok((trace, surface))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::tests::plates::{STEEL, plate};

    #[test]
    fn tributary_areas_of_a_plane_plate_add_up_to_its_area() {
        let (mesh, top) = plate([0.0, 0.0], [3.0, 2.0], [6, 5], 0.0, 0.5, true);
        let (_, surface) = ContactSurface::alone(&mesh, &top, STEEL).unwrap();
        assert!((surface.area.iter().sum::<f64>() - 6.0).abs() < 1e-13);
    }

    #[test]
    fn brick_gives_bulk_modulus_over_depth_and_half_its_mass() {
        let (mesh, top) = plate([0.0, 0.0], [3.0, 2.0], [6, 5], 0.0, 0.5, true);
        let (_, surface) = ContactSurface::alone(&mesh, &top, STEEL).unwrap();
        for scaled in &surface.scaled_stiffness {
            assert!((scaled * 0.5 / STEEL.bulk_modulus - 1.0).abs() < 1e-13);
        }
        for mass in &surface.mass_per_area {
            assert!((mass / (STEEL.density * 0.25) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn neighbours_share_the_edge_in_opposite_direction() {
        let (mesh, top) = plate([0.0, 0.0], [3.0, 2.0], [6, 5], 0.0, 0.5, true);
        let (_, surface) = ContactSurface::alone(&mesh, &top, STEEL).unwrap();
        let mut inner = 0;
        for face in &surface.faces {
            for e in 0..4 {
                let (other, edge) = face.neighbours[e];
                if other != NONE {
                    let other = &surface.faces[other as usize];
                    assert_eq!(face.nodes[e], other.nodes[(edge as usize + 1) % 4]);
                    assert_eq!(face.nodes[(e + 1) % 4], other.nodes[edge as usize]);
                    inner += 1;
                }
            }
        }
        assert_eq!(inner, 2 * (5 * 5 + 6 * 4));
    }

    #[test]
    fn wrong_surfaces_are_refused() {
        let (mesh, top) = plate([0.0, 0.0], [1.0, 1.0], [2, 2], 0.0, 0.5, true);
        let refused = |s: &Surface| ContactSurface::alone(&mesh, s, STEEL).unwrap_err();
        assert_eq!(refused(&Surface::default()), ContactError::EmptySurface { side: 0 });
        let mut outside = top.clone();
        outside.faces[1].nodes[2] = 999;
        assert_eq!(refused(&outside), ContactError::OutsideMesh { side: 0, face: 1 });
        let mut flat = top.clone();
        flat.faces[2].nodes = [flat.faces[2].nodes[0]; 4];
        assert_eq!(refused(&flat), ContactError::Degenerate { side: 0, face: 2 });
        let mut twice = top.clone();
        twice.faces.push(twice.faces[0]);
        assert!(matches!(refused(&twice), ContactError::Edge { side: 0, .. }));
    }
}
