//! The gap function of one pass without friction, for solvers of equilibrium.

use crate::constraint::{Rows, Share, within};
use crate::exact::slave_side;
use crate::face::{Positions, project, shape};
use crate::mortar::{Mean, Mortar};
use crate::nodal_normals::NodalNormals;
use crate::search::{Listed, Search};
use crate::surface::ContactSurface;
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
    /// Of the master.
    normals: NodalNormals,
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
        let slave = slave_side(settings, &sides)?;
        Ok(Self {
            slave,
            normals: NodalNormals::new(&sides[1 - slave], settings.curvature),
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

    fn over_faces(&mut self, positions: &Positions<'_>, gaps: &mut Vec<Gap>) {
        let (own, master) = (&self.sides[self.slave], &self.sides[1 - self.slave]);
        self.normals.expire();
        for point in &self.points[self.slave] {
            let x = positions.at(own.node(point.slave));
            let walk = project(master, positions, self.curvature, x, point.face, 0.0, 0.0);
            let Some(projection) = walk.projection else { continue };
            let [xi, eta] = within(&projection);
            let weights = shape(xi, eta);
            let corners = master.faces[projection.face as usize].nodes;
            let corners = corners.map(|node| self.trace.in_mesh(node));
            gaps.push(Gap {
                node: self.trace.in_mesh(own.node(point.slave)),
                projection: corners.into_iter().zip(weights).collect(),
                // with the normals of faces a slave over an edge between two of them would find no equilibrium
                normal: self.normals.at(master, positions, projection.face, &weights),
                gap: projection.gap,
                area: own.area[point.slave as usize],
                nodes: own.nodes_of_whole(x),
            });
        }
    }

    fn over_means(&self, positions: &Positions<'_>, gaps: &mut Vec<Gap>) {
        let (own, master) = (&self.sides[self.slave], &self.sides[1 - self.slave]);
        let mut mortar = Mortar::new(self.curvature);
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
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::Normals;
    use crate::tests::plates::{STEEL, plate, together};

    #[test]
    fn the_gaps_between_two_plates_are_their_distance_from_the_slaves_of_either_side() {
        let height = 1e-5;
        let (upper, first) = plate([0.0, 0.0], [8e-3, 8e-3], [5, 5], height, 1e-3, false);
        let (lower, second) = plate([0.0, 0.0], [8e-3, 8e-3], [4, 4], 0.0, 1e-3, true);
        let (mesh, second) = together(upper, lower, second);
        let reference: Vec<Padded> = mesh.nodes.iter().copied().map(Padded::from).collect();
        let rest = vec![Padded::ZERO; reference.len()];
        for rows in [Rows::NodeToFace, Rows::Mortar] {
            for (slave, surface, away) in [(0, &first, -1.0), (1, &second, 1.0)] {
                let normals = Normals::Averaged;
                let settings = ExactSettings { slave: Some(slave), curvature: true, rows, normals };
                let surfaces = [(&first, STEEL), (&second, STEEL)];
                let mut function = GapFunction::new(&mesh, surfaces, &settings).unwrap();
                let mut gaps = Vec::new();
                function.at(&reference, &rest, &mut gaps);
                let mut slaves: Vec<u32> = surface.faces.iter().flat_map(|f| f.nodes).collect();
                slaves.sort_unstable();
                slaves.dedup();
                assert_eq!(gaps.iter().map(|gap| gap.node).collect::<Vec<_>>(), slaves);
                for gap in &gaps {
                    assert!((gap.gap - height).abs() < 1e-15, "{rows:?} {slave}: {gap:?}");
                    assert!((gap.normal[2] + away).abs() < 1e-12, "{rows:?} {slave}: {gap:?}");
                    // the projection lies under the node
                    let x = mesh.nodes[gap.node as usize];
                    for (axis, lift) in [(0, 0.0), (1, 0.0), (2, -away * height)] {
                        let at =
                            |(node, weight): &(u32, f64)| weight * mesh.nodes[*node as usize][axis];
                        let under: f64 = gap.projection.iter().map(at).sum();
                        assert!(
                            (under + lift - x[axis]).abs() < 1e-14,
                            "{rows:?} {slave}: {gap:?}"
                        );
                    }
                }
                let area: f64 = gaps.iter().map(|gap| gap.area).sum();
                assert!((area / 64e-6 - 1.0).abs() < 1e-12);
            }
        }
    }
}
