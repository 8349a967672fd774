//! The gap function of one pass without friction, for solvers of equilibrium.

use crate::constraint::{Rows, Share, within};
use crate::exact::slave_side;
use crate::face::{Positions, corner_normals, project, shape};
use crate::mortar::{Mean, Mortar};
use crate::search::{Listed, Search};
use crate::surface::ContactSurface;
use crate::symmetry::in_plane;
use crate::vector::{add, axpy, norm, scale};
use crate::{BodyMaterial, ContactError, ExactSettings, Gap, Trace};
use mesh::{Mesh, Padded, Surface};

/// A slave near the master, and a face of the master near it.
#[derive(Clone, Copy, Debug)]
struct Near {
    slave: u32,
    face: u32,
}

impl Listed for Near {
    fn near(slave: u32, face: u32) -> Self {
        Self { slave, face }
    }

    fn slave(&self) -> u32 {
        self.slave
    }

    fn is_closed(&self) -> bool {
        false
    }
}

/// The gaps of the nodes of one surface, the slaves, over another, as functions of the positions.
#[derive(Debug)]
pub struct GapFunction {
    trace: Trace,
    sides: [ContactSurface; 2],
    slave: usize,
    rows: Rows,
    curvature: bool,
    search: Search,
    /// The nodes of each side near the other.
    points: [Vec<Near>; 2],
}

impl GapFunction {
    /// The gaps between two `surfaces` of `mesh`, side 0 and side 1.
    ///
    /// # Errors
    /// Surfaces that are empty, degenerate, outside the mesh or in touch by a common node, and a side
    /// that is not 0 or 1.
    pub fn new(
        mesh: &Mesh,
        surfaces: [(&Surface, BodyMaterial); 2],
        settings: &ExactSettings,
    ) -> Result<Self, ContactError> {
        let (trace, sides) = ContactSurface::both(mesh, surfaces)?;
        Ok(Self {
            slave: slave_side(settings, &sides)?,
            rows: settings.rows,
            curvature: settings.curvature,
            search: Search::new(&sides),
            points: [Vec::new(), Vec::new()],
            trace,
            sides,
        })
    }

    /// The gaps at the positions `X + u` of all slaves nearer than the search margin, ascending by
    /// node, written to `gaps`.
    ///
    /// # Panics
    /// If a slice has fewer entries than the mesh has nodes.
    pub fn at(&mut self, reference: &[Padded], displacement: &[Padded], gaps: &mut Vec<Gap>) {
        let position = self.trace.positions(reference, displacement);
        let positions = Positions(&position);
        self.search.refresh(&self.sides, &positions, &mut self.points);
        gaps.clear();
        match self.rows {
            Rows::NodeToFace => self.over_faces(&positions, gaps),
            Rows::Mortar => self.over_means(&positions, gaps),
        }
    }

    fn over_faces(&self, positions: &Positions<'_>, gaps: &mut Vec<Gap>) {
        let (own, master) = (&self.sides[self.slave], &self.sides[1 - self.slave]);
        let mut faces = Vec::new();
        for point in &self.points[self.slave] {
            let x = positions.at(own.node(point.slave));
            let walk = project(master, positions, self.curvature, x, point.face, 0.0, 0.0);
            let Some(projection) = walk.projection else { continue };
            faces.push(projection.face);
            let [xi, eta] = within(&projection);
            let corners = master.faces[projection.face as usize].nodes;
            let corners = corners.map(|node| self.trace.in_mesh(node));
            gaps.push(Gap {
                node: self.trace.in_mesh(own.node(point.slave)),
                projection: corners.into_iter().zip(shape(xi, eta)).collect(),
                normal: projection.point.normal,
                gap: projection.gap,
                area: own.area[point.slave as usize],
                nodes: own.nodes_of_whole(x),
            });
        }
        self.smooth_normals(positions, &faces, gaps);
    }

    fn over_means(&self, positions: &Positions<'_>, gaps: &mut Vec<Gap>) {
        let (own, master) = (&self.sides[self.slave], &self.sides[1 - self.slave]);
        let mut mortar = Mortar::new(own, self.curvature);
        let mut mean = Mean::default();
        for point in &self.points[self.slave] {
            let (_, on_master) =
                mortar.integrate([own, master], positions, point.slave, point.face, &mut mean);
            if !on_master {
                continue;
            }
            let node = own.node(point.slave);
            let x = positions.at(node);
            let kinematics = mean.kinematics(master, positions, x);
            let in_mesh =
                |share: &Share| (self.trace.in_mesh(master.node(share.node)), share.weight);
            gaps.push(Gap {
                node: self.trace.in_mesh(node),
                projection: mean.shares.iter().map(in_mesh).collect(),
                normal: kinematics.normal,
                gap: kinematics.gap,
                area: own.area[point.slave as usize],
                nodes: own.nodes_of_whole(x),
            });
        }
    }

    /// Replaces the normals of `gaps`, whose projections lie on the faces `projections` of the master, by ones that are
    /// continuous over the surface, on a plane of symmetry with its mirror image. A load dents facets against one
    /// another, so that a slave over their common edge finds no equilibrium with either normal.
    fn smooth_normals(&self, positions: &Positions<'_>, projections: &[u32], gaps: &mut [Gap]) {
        let surface = &self.sides[1 - self.slave];
        let mut wanted = vec![false; surface.len()];
        for &face in projections {
            surface.faces[face as usize].local.iter().for_each(|&n| wanted[n as usize] = true);
        }
        let mut sums = vec![[0.0; 3]; surface.len()];
        for (index, face) in surface.faces.iter().enumerate() {
            if face.local.iter().any(|&n| wanted[n as usize]) {
                let normals = corner_normals(surface, index as u32, positions, self.curvature);
                for (normal, &n) in normals.iter().zip(&face.local) {
                    let x = positions.at(surface.node(n));
                    let normal = if surface.is_on_plane(x) { in_plane(*normal) } else { *normal };
                    sums[n as usize] = add(sums[n as usize], normal);
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
}
