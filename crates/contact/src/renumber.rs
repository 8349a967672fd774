//! Contact when the mesh moves along the material (a window that follows the patch): every node and face of a surface
//! takes over the material, and with it the state, of another one.

use crate::constraint::Constraint;
use crate::mortar::Mean;
use crate::point::{ContactPoint, Enforced};
use crate::search::{Listed, Search};
use crate::surface::{ContactSurface, NONE};
use std::collections::HashMap;

/// Nodes of the mesh that take over the material of others.
#[derive(Clone, Copy)]
pub struct Renumbering<'a> {
    /// The node that takes over the material of a node of the mesh; none where that material is at no node any more.
    pub successor: &'a dyn Fn(u32) -> Option<u32>,
    /// How far the origin of the coordinates lies ahead along x (m), of the place where it was at the start.
    pub origin: f64,
}

/// The successors of the nodes and faces of a surface, in its own numbers; [`NONE`] where there is none.
struct Successors {
    nodes: Vec<u32>,
    faces: Vec<u32>,
}

impl Successors {
    /// Of a surface whose nodes have the numbers `in_mesh` in the mesh, ascending.
    fn new(surface: &ContactSurface, in_mesh: &[u32], renumbering: Renumbering<'_>) -> Self {
        let local = |node: u32| in_mesh.binary_search(&node).map_or(NONE, |place| place as u32);
        let successor = |&node: &u32| (renumbering.successor)(node).map_or(NONE, local);
        let nodes: Vec<u32> = in_mesh.iter().map(successor).collect();
        let corners = (0..).zip(&surface.faces).map(|(face, f)| (f.local, face));
        let by_corners: HashMap<[u32; 4], u32> = corners.collect();
        let faces = surface.faces.iter().map(|face| {
            let corners = face.local.map(|node| nodes[node as usize]);
            by_corners.get(&corners).copied().unwrap_or(NONE)
        });
        let faces = faces.collect();
        Self { nodes, faces }
    }

    /// Carries points, with slaves of this surface and faces of the one with the successors `master`; those that have no
    /// successor are left out. Returns how many of these were closed.
    fn carry<E: Enforced>(&self, points: &mut Vec<ContactPoint<E>>, master: &Self) -> usize {
        let mut lost = 0;
        points.retain_mut(|point| {
            let slave = self.nodes[point.slave as usize];
            let face = master.faces[point.face as usize];
            let carried = slave != NONE && face != NONE;
            lost += usize::from(!carried && point.is_closed());
            (point.slave, point.face) = (slave, face);
            carried
        });
        points.sort_unstable_by_key(|point| point.slave);
        lost
    }
}

/// Both surfaces of a contact, the numbers of their nodes in the mesh, and its search.
pub(crate) struct Renumbered<'a> {
    pub sides: &'a mut [ContactSurface; 2],
    pub in_mesh: [&'a [u32]; 2],
    pub search: &'a mut Search,
}

impl Renumbered<'_> {
    fn successors(&mut self, renumbering: Renumbering<'_>) -> [Successors; 2] {
        self.search.forget();
        self.sides.iter_mut().for_each(|side| side.origin = renumbering.origin);
        [0, 1].map(|side| Successors::new(&self.sides[side], self.in_mesh[side], renumbering))
    }

    /// Carries the points of both passes.
    pub fn passes<E: Enforced>(
        mut self,
        passes: &mut [Vec<ContactPoint<E>>; 2],
        renumbering: Renumbering<'_>,
    ) -> usize {
        let successors = self.successors(renumbering);
        let carry = |side: usize| successors[side].carry(&mut passes[side], &successors[1 - side]);
        [0, 1].map(carry).iter().sum()
    }

    /// Carries the constraints of the slaves of one side. The means of mortar rows are forgotten: they are integrated anew.
    pub fn rows(
        mut self,
        slave: usize,
        constraints: &mut Vec<Constraint>,
        means: Option<&mut [Mean]>,
        renumbering: Renumbering<'_>,
    ) -> usize {
        let successors = self.successors(renumbering);
        means.into_iter().flatten().for_each(Mean::forget);
        successors[slave].carry(constraints, &successors[1 - slave])
    }
}
