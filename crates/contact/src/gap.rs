//! The gap kinematics of one pass, for solvers of equilibrium.

use crate::PenaltyContact;
use crate::face::{Positions, corner_normals, project, shape};
use crate::pair::Pair;
use crate::touch::Listed;
use crate::vector::{add, axpy, norm, scale};
use mesh::Padded;

/// A slave node over its foot on the master surface.
///
/// To first order its gap changes by `n . (u_s - sum phi_I u_I)`, with the corners `I` of the
/// master face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The slave (mesh index).
    pub node: u32,
    /// Corner nodes of the master face (mesh indices).
    pub corners: [u32; 4],
    /// Shape functions `phi_I` of the corners at the foot.
    pub weights: [f64; 4],
    /// Unit normal of the master surface at the foot, out of the master body. From
    /// [`PenaltyContact::gaps`] it is continuous over the surface: the mean of the facets' normals at
    /// each corner, interpolated; from [`PenaltyContact::springs`] it is the facet's.
    pub normal: [f64; 3],
    /// Gap (m), negative where the slave has penetrated.
    pub gap: f64,
    /// Tributary area of the slave in the reference configuration (m^2).
    pub area: f64,
}

impl PenaltyContact {
    /// The gaps of the pass in which the nodes of side `slave` meet the faces of the other side,
    /// at the positions `X + u`: all nodes nearer than the search margin, ascending by node,
    /// written to `gaps`. No forces, and the state of the springs stays as it is.
    ///
    /// # Panics
    /// If `slave` is not 0 or 1, or a slice has fewer entries than the mesh has nodes.
    pub fn gaps(
        &mut self,
        slave: usize,
        reference: &[Padded],
        displacement: &[Padded],
        gaps: &mut Vec<Gap>,
    ) {
        let positions = Positions { reference, displacement };
        self.search.refresh(&self.sides, &positions, &mut self.pairs);
        gaps.clear();
        let mut feet = Vec::new();
        let mut pairs = std::mem::take(&mut self.pairs[slave]);
        for pair in &mut pairs {
            let (own, master) = (&self.sides[slave], &self.sides[1 - slave]);
            let x = positions.at(own.nodes[pair.slave as usize]);
            let curvature = self.settings.curvature;
            let walk = project(master, &positions, curvature, x, pair.face, pair.xi, pair.eta);
            if let Some(foot) = walk.foot {
                if !pair.is_closed() {
                    (pair.face, pair.xi, pair.eta) = (foot.face, foot.xi, foot.eta);
                }
                feet.push(foot.face);
                gaps.push(Gap {
                    node: own.nodes[pair.slave as usize],
                    corners: master.faces[foot.face as usize].nodes,
                    weights: shape(foot.xi.clamp(-1.0, 1.0), foot.eta.clamp(-1.0, 1.0)),
                    normal: foot.point.normal,
                    gap: foot.gap,
                    area: own.area[pair.slave as usize],
                });
            }
        }
        self.pairs[slave] = pairs;
        self.smooth_normals(1 - slave, &positions, &feet, gaps);
    }

    /// Replaces the normals of `gaps`, whose feet lie on the faces `feet` of side `master`, by ones
    /// that are continuous over the surface. A load dents facets against one another, so that a
    /// slave over their common edge finds no equilibrium with either normal.
    fn smooth_normals(
        &self,
        master: usize,
        positions: &Positions<'_>,
        feet: &[u32],
        gaps: &mut [Gap],
    ) {
        let surface = &self.sides[master];
        let mut wanted = vec![false; surface.nodes.len()];
        for &face in feet {
            surface.faces[face as usize].local.iter().for_each(|&n| wanted[n as usize] = true);
        }
        let mut sums = vec![[0.0; 3]; surface.nodes.len()];
        for (index, face) in surface.faces.iter().enumerate() {
            if face.local.iter().any(|&n| wanted[n as usize]) {
                let normals =
                    corner_normals(surface, index as u32, positions, self.settings.curvature);
                for (normal, &n) in normals.iter().zip(&face.local) {
                    sums[n as usize] = add(sums[n as usize], *normal);
                }
            }
        }
        for (gap, &face) in gaps.iter_mut().zip(feet) {
            let mut normal = [0.0; 3];
            for (weight, &n) in gap.weights.iter().zip(&surface.faces[face as usize].local) {
                let sum = sums[n as usize];
                normal = axpy(normal, weight / norm(sum), sum);
            }
            gap.normal = scale(1.0 / norm(normal), normal);
        }
    }

    /// The normal springs of both passes that were closed at the last call, each with its
    /// stiffness (N/m), in a fixed order.
    pub fn springs(&self) -> impl Iterator<Item = (Gap, f64)> + '_ {
        (0..2).flat_map(move |slave: usize| {
            let closed = self.pairs[slave].iter().filter(|p| p.is_closed());
            closed.map(move |pair| (self.spring(slave, pair), pair.stiffness[0]))
        })
    }

    fn spring(&self, slave: usize, pair: &Pair) -> Gap {
        let (own, master) = (&self.sides[slave], &self.sides[1 - slave]);
        Gap {
            node: own.nodes[pair.slave as usize],
            corners: master.faces[pair.face as usize].nodes,
            weights: pair.weights,
            normal: pair.normal,
            gap: pair.gap,
            area: own.area[pair.slave as usize],
        }
    }

    /// Says that the next positions may lie anywhere: the search looks at them at the next call.
    ///
    /// A time loop need not, since it moves by small steps; a solver of equilibrium must.
    pub fn expect_jump(&mut self) {
        self.search.expect_jump();
    }
}
