//! The gap kinematics of one pass, for solvers of equilibrium.

use crate::PenaltyContact;
use crate::constraint::{Rows, within};
use crate::face::{Positions, corner_normals, project, shape};
use crate::mortar::{Mean, Mortar};
use crate::penalty_point::PenaltyPoint;
use crate::point::ContactPoint;
use crate::vector::{add, axpy, norm, scale};
use mesh::Padded;

/// A slave node over its projection on the master surface.
///
/// To first order its gap changes by `n . (u_s - sum w_J u_J)`, with the nodes `J` of the master that its
/// projection is a mean of.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// The slave (mesh index).
    pub node: u32,
    /// The nodes of the master (mesh indices) and their weights `w_J`, which add up to one: the corners of
    /// the face under the slave, or the nodes that its mortar function meets.
    pub projection: Vec<(u32, f64)>,
    /// Unit normal of the master surface at the projection, out of the master body. From
    /// [`PenaltyContact::gaps`] it is continuous over the surface: the mean of the facets' normals at
    /// each corner, interpolated, or the mortar function's mean; from [`PenaltyContact::springs`] it is the facet's.
    pub normal: [f64; 3],
    /// Gap (m), negative where the slave has penetrated.
    pub gap: f64,
    /// Tributary area of the slave in the reference configuration (m^2).
    pub area: f64,
}

impl PenaltyContact {
    /// The gaps of the pass in which the nodes of side `slave` meet the faces of the other side,
    /// at the positions `X + u`, as `rows` measure them: all nodes nearer than the search margin, ascending
    /// by node, written to `gaps`. No forces, and the state of the springs stays as it is.
    ///
    /// # Panics
    /// If `slave` is not 0 or 1, or a slice has fewer entries than the mesh has nodes.
    pub fn gaps(
        &mut self,
        slave: usize,
        rows: Rows,
        reference: &[Padded],
        displacement: &[Padded],
        gaps: &mut Vec<Gap>,
    ) {
        let positions = Positions { reference, displacement };
        self.search.refresh(&self.sides, &positions, &mut self.points);
        gaps.clear();
        if rows == Rows::Mortar {
            self.mortar_gaps(slave, &positions, gaps);
            return;
        }
        let mut projections = Vec::new();
        let mut points = std::mem::take(&mut self.points[slave]);
        for point in &mut points {
            let (own, master) = (&self.sides[slave], &self.sides[1 - slave]);
            let x = positions.at(own.nodes[point.slave as usize]);
            let curvature = self.settings.curvature;
            let walk = project(master, &positions, curvature, x, point.face, point.xi, point.eta);
            if let Some(projection) = walk.projection {
                if !point.is_closed() {
                    (point.face, point.xi, point.eta) =
                        (projection.face, projection.xi, projection.eta);
                }
                projections.push(projection.face);
                let [xi, eta] = within(&projection);
                let corners = master.faces[projection.face as usize].nodes;
                gaps.push(Gap {
                    node: own.nodes[point.slave as usize],
                    projection: corners.into_iter().zip(shape(xi, eta)).collect(),
                    normal: projection.point.normal,
                    gap: projection.gap,
                    area: own.area[point.slave as usize],
                });
            }
        }
        self.points[slave] = points;
        self.smooth_normals(1 - slave, &positions, &projections, gaps);
    }

    fn mortar_gaps(&mut self, slave: usize, positions: &Positions<'_>, gaps: &mut Vec<Gap>) {
        let (own, master) = (&self.sides[slave], &self.sides[1 - slave]);
        let mut mortar = Mortar::new(own, self.settings.curvature);
        let mut mean = Mean::default();
        for point in &mut self.points[slave] {
            let (face, on_master) =
                mortar.integrate([own, master], positions, point.slave, point.face, &mut mean);
            if !on_master {
                continue;
            }
            if !point.is_closed() {
                point.face = face;
            }
            let node = own.nodes[point.slave as usize];
            let kinematics = mean.kinematics(master, positions, positions.at(node));
            let projection = mean.shares.iter().map(|s| (master.nodes[s.node as usize], s.weight));
            gaps.push(Gap {
                node,
                projection: projection.collect(),
                normal: kinematics.normal,
                gap: kinematics.gap,
                area: own.area[point.slave as usize],
            });
        }
    }

    /// Replaces the normals of `gaps`, whose projections lie on the faces `projections` of side `master`, by ones
    /// that are continuous over the surface. A load dents facets against one another, so that a
    /// slave over their common edge finds no equilibrium with either normal.
    fn smooth_normals(
        &self,
        master: usize,
        positions: &Positions<'_>,
        projections: &[u32],
        gaps: &mut [Gap],
    ) {
        let surface = &self.sides[master];
        let mut wanted = vec![false; surface.nodes.len()];
        for &face in projections {
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
        for (gap, &face) in gaps.iter_mut().zip(projections) {
            let mut normal = [0.0; 3];
            for ((_, weight), &n) in gap.projection.iter().zip(&surface.faces[face as usize].local)
            {
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
            let closed = self.points[slave].iter().filter(|p| p.is_closed());
            closed.map(move |point| (self.spring(slave, point), point.stiffness[0]))
        })
    }

    fn spring(&self, slave: usize, point: &PenaltyPoint) -> Gap {
        let (own, master) = (&self.sides[slave], &self.sides[1 - slave]);
        Gap {
            node: own.nodes[point.slave as usize],
            projection: master.faces[point.face as usize]
                .nodes
                .into_iter()
                .zip(point.weights)
                .collect(),
            normal: point.normal,
            gap: point.gap,
            area: own.area[point.slave as usize],
        }
    }

    /// Says that the next positions may lie anywhere: the search looks at them at the next call.
    ///
    /// A time loop need not, since it moves by small steps; a solver of equilibrium must.
    pub fn expect_jump(&mut self) {
        self.search.expect_jump();
    }
}
