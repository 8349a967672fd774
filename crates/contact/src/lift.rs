//! Irregularities of the surfaces, which the mesh does not have: contact sees the nodes of an irregular surface moved by their
//! heights.
//!
//! A node `n` is at `x_n + (h/l) (x_n - x_in)` with `x = X + u`, the height `h` of its material, and the node `in` across the
//! element from the face, whose edge to `n` reaches `l` along the height in the reference configuration: the height turns with
//! the body. Facets tilt with it, and so gaps, normals and the search follow. Velocities and forces stay those of the nodes: what
//! `h` adds to the radius of a wheel is missing in the slip velocity, a part `h/R` of the rolling speed.

use crate::ContactError;
use mesh::{Face, HEX_EDGES, Heights, Irregularity, Mesh, Padded, Surface};
use std::sync::Arc;

/// A node of the trace on an irregular surface.
#[derive(Clone, Copy, Debug)]
struct Lift {
    /// The node in the trace.
    node: u32,
    /// The node across the element, in the mesh.
    inward: u32,
    side: u8,
    /// The coordinate of the material that the node has at the start (m or rad).
    coordinate: f64,
    /// y of its material (m).
    y: f64,
    /// How far the edge reaches along the height in the reference configuration (m).
    reach: f64,
    /// Height over reach.
    ratio: f64,
}

/// The irregularities of both surfaces at the nodes of a trace; empty without any.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lifts {
    lifts: Vec<Lift>,
    heights: [Option<Arc<dyn Heights>>; 2],
}

impl Lifts {
    /// Of surfaces of the mesh, whose nodes have the numbers `local` in the trace.
    pub fn new(
        mesh: &Mesh,
        surfaces: [&Surface; 2],
        local: impl Fn(usize, u32) -> u32,
    ) -> Result<Self, ContactError> {
        let mut all = Self::default();
        for (side, surface) in surfaces.into_iter().enumerate() {
            let Some(Irregularity { along, heights }) = &surface.irregularity else { continue };
            let first = all.lifts.len();
            for (index, face) in surface.faces.iter().enumerate() {
                for node in face.nodes {
                    let inward = across(mesh, face, node)
                        .ok_or(ContactError::OutsideMesh { side, face: index })?;
                    let (at, edge) = (mesh.at(node), mesh.at(node) - mesh.at(inward));
                    all.lifts.push(Lift {
                        node: local(side, node),
                        inward,
                        side: side as u8,
                        coordinate: along.coordinate(at),
                        y: at.y,
                        // an edge that leans by more than 60 degrees is none across a layer
                        reach: along.outward(at).dot(&edge).max(0.5 * edge.norm()),
                        ratio: 0.0,
                    });
                }
            }
            // stable: of the faces around a node the first decides
            all.lifts[first..].sort_by_key(|lift| lift.node);
            all.heights[side] = Some(Arc::clone(heights));
        }
        all.lifts.dedup_by_key(|lift| lift.node);
        all.of_material([0.0; 2]);
        Ok(all)
    }

    /// Takes the heights of the material that is at the nodes now: each mesh has moved along it by `moved` (m or rad).
    pub fn of_material(&mut self, moved: [f64; 2]) {
        for lift in &mut self.lifts {
            let side = usize::from(lift.side);
            let height = self.heights[side].as_ref();
            let along = lift.coordinate + moved[side];
            let height = height.map_or(0.0, |heights| heights.at(along, lift.y));
            lift.ratio = height / lift.reach;
        }
    }

    /// The nodes across, in the mesh.
    pub fn inward(&self) -> impl Iterator<Item = u32> {
        self.lifts.iter().map(|lift| lift.inward)
    }

    /// Moves `positions` of the trace (m); `inward` are those of the [nodes across](Self::inward).
    #[inline]
    pub fn apply(&self, inward: impl Iterator<Item = Padded>, positions: &mut [Padded]) {
        for (lift, inward) in self.lifts.iter().zip(inward) {
            let x = &mut positions[lift.node as usize];
            *x = Padded::from(x.vector() + lift.ratio * (x.vector() - inward.vector()));
        }
    }
}

/// The node of the face's element across from it, at the face's corner `node`.
fn across(mesh: &Mesh, face: &Face, node: u32) -> Option<u32> {
    let hex = mesh.hexes.get(face.hex as usize)?;
    let corner = hex.iter().position(|&n| n == node)?;
    let ends = HEX_EDGES.iter().filter_map(|&[a, b]| match corner {
        _ if a == corner => Some(hex[b]),
        _ if b == corner => Some(hex[a]),
        _ => None,
    });
    ends.filter(|n| !face.nodes.contains(n)).find(|&n| (n as usize) < mesh.nodes.len())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::gap_function::GapFunction;
    use crate::surface::ContactSurface;
    use crate::tests::plates::{STEEL, plate, together, tread};
    use crate::{ExactSettings, Gap, Normals, Rows, TraceFields};
    use mesh::{Along, HeightTable, Heights, Irregularity, Mesh, Padded, Surface};
    use nalgebra::{Rotation3, Vector3};
    use std::sync::Arc;

    #[derive(Debug)]
    struct Wave(f64);

    impl Heights for Wave {
        fn at(&self, s: f64, y: f64) -> f64 {
            self.0 * libm::cos(700.0 * s) * (1.0 + 100.0 * y)
        }
    }

    fn irregular(surface: Surface, along: Along, heights: Arc<dyn Heights>) -> Surface {
        Surface { irregularity: Some(Irregularity { along, heights }), ..surface }
    }

    fn padded(mesh: &Mesh) -> Vec<Padded> {
        mesh.nodes.iter().copied().map(Padded::from).collect()
    }

    #[test]
    fn a_node_is_lifted_by_the_height_of_its_material_along_the_direction_that_turns_with_the_body()
    {
        let radius = 0.5;
        let (mesh, surface) = tread(radius, 0.05, 8e-3, [20, 4], 1e-3);
        let axis = radius * Vector3::z();
        let surface = irregular(surface, Along::Around(axis), Arc::new(Wave(1e-5)));
        let (lower, other) = plate([-1e-2, 0.0], [1e-2, 8e-3], [4, 4], -1e-3, 1e-3, true);
        let (mesh, other) = together(mesh, lower, other);
        let (trace, _) = ContactSurface::both(&mesh, [(&surface, STEEL), (&other, STEEL)]).unwrap();
        let reference = padded(&mesh);
        for (turn, moved) in [(0.0, 0.0), (0.3, 0.0), (0.3, 0.02)] {
            // a positive angle about y turns the bottom back
            let about = Rotation3::from_axis_angle(&Vector3::y_axis(), turn);
            let turned = |x: &Padded| about * (x.vector() - axis) + axis;
            let displacement: Vec<Padded> =
                reference.iter().map(|x| Padded::from(turned(x) - x.vector())).collect();
            let mut fields = TraceFields::new(&trace, &reference, &vec![1.0; reference.len()]);
            fields.of_material([moved, 0.0]);
            fields.gather_positions(&displacement);
            for (at, &n) in fields.motion(0.0, 1.0).position.iter().zip(trace.nodes()) {
                let x = reference[n as usize].vector();
                let angle = libm::atan2(x.x, radius - x.z);
                let on_disk = trace.side(0).contains(&n);
                let height = if on_disk { Wave(1e-5).at(angle + moved, x.y) } else { 0.0 };
                let outward = Along::Around(axis).outward(x);
                let wanted = axis + about * (x - axis + height * outward);
                if on_disk {
                    assert!((at.vector() - wanted).norm() < 1e-14, "{turn} {moved} {x}");
                } else {
                    assert_eq!(at.vector(), x + displacement[n as usize].vector());
                }
            }
            if moved == 0.0 {
                let all = trace.positions(&reference, &displacement);
                assert_eq!(all, fields.motion(0.0, 1.0).position);
            }
        }
    }

    /// The gaps of a flat plate 10 um above one whose irregularity these heights are.
    fn gaps(rows: Rows, slave: usize, heights: Option<Arc<dyn Heights>>) -> (Mesh, Vec<Gap>) {
        let (upper, first) = plate([2e-3, 2e-3], [6e-3, 6e-3], [16, 4], 1e-5, 1e-3, false);
        let (lower, second) = plate([0.0, 0.0], [8e-3, 8e-3], [32, 8], 0.0, 1e-3, true);
        let (mesh, mut second) = together(upper, lower, second);
        if let Some(heights) = heights {
            second = irregular(second, Along::X, heights);
        }
        let normals = Normals::Averaged;
        let settings = ExactSettings { slave: Some(slave), curvature: true, rows, normals };
        let mut function =
            GapFunction::new(&mesh, [(&first, STEEL), (&second, STEEL)], &settings).unwrap();
        let (reference, mut gaps) = (padded(&mesh), Vec::new());
        function.at(&reference, &vec![Padded::ZERO; reference.len()], &mut gaps);
        (mesh, gaps)
    }

    #[test]
    fn the_gaps_over_an_irregular_plate_are_those_that_its_heights_give() {
        let wave: Arc<dyn Heights> = Arc::new(Wave(5e-6));
        for (rows, slave) in [(Rows::NodeToFace, 0), (Rows::NodeToFace, 1), (Rows::Mortar, 0)] {
            let (mesh, found) = gaps(rows, slave, Some(Arc::clone(&wave)));
            assert!(found.len() > 50, "{rows:?} {slave}");
            for gap in found {
                let at = mesh.at(gap.node);
                // slopes of 3.5e-3 make gaps along the normal shorter by 6e-6 of them; a mortar gap is a mean over the node's faces
                let limit = if rows == Rows::Mortar { 5e-7 } else { 2e-8 };
                let expected = 1e-5 - wave.at(at.x, at.y);
                assert!((gap.gap - expected).abs() < limit, "{rows:?} {slave} {at}: {}", gap.gap);
            }
        }
    }

    #[test]
    fn heights_of_zero_give_the_bits_without_them() {
        let level = HeightTable::along(vec![[-1.0, 0.0], [1.0, 0.0]]).unwrap();
        for rows in [Rows::NodeToFace, Rows::Mortar] {
            let bits = |heights: Option<Arc<dyn Heights>>| -> Vec<u64> {
                gaps(rows, 0, heights).1.iter().map(|gap| gap.gap.to_bits()).collect()
            };
            assert_eq!(bits(None), bits(Some(Arc::new(level.clone()))));
        }
    }
}
