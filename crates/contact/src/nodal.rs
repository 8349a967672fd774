//! Contact quantities at the nodes of one surface.

use crate::penalty_point::PenaltyPoint;
use crate::point::{ContactPoint, Enforced, State};
use crate::search::Listed;
use crate::surface::{ContactSurface, NONE};
use crate::symmetry::in_plane;
use crate::{PenaltyContact, Trace};
use mesh::Face;
use nalgebra::Vector3;

/// Contact quantities at surface nodes, one entry per node of [`nodes`](Self::nodes).
///
/// Tractions act on *this* surface: `pressure` is the normal force of both passes over the nodal
/// area, `shear` the tangential force of both passes over it, each pass resolved in its own
/// contact frame. Hence, where all weights are non-negative, `|shear| <= mu pressure` holds to round-off, up to the
/// angle between the contact frames of the points that load the node; `mu` is the mean of the coefficients that the
/// algorithm used, weighted with the size of the normal forces.
#[derive(Clone, Debug, Default)]
pub struct NodalContact {
    /// Node indices in the mesh.
    pub nodes: Vec<u32>,
    /// Contact pressure (Pa), positive in compression.
    pub pressure: Vec<f64>,
    /// The part of it that the node's own point carries: the pressure that its law of friction is told.
    pub pass_pressure: Vec<f64>,
    /// Shear traction on this surface (Pa).
    pub shear: Vec<Vector3<f64>>,
    /// Velocity of this surface relative to the other in the tangent plane (m/s): with springs the mean over the step
    /// that led to `x^n`, with multipliers that of the step that leaves it. Of the node's own pass; where that is open,
    /// the mean of the points of the other pass that load the node, weighted with their normal force.
    pub slip_velocity: Vec<Vector3<f64>>,
    /// Tangential motion relative to the other surface since the node's own point closed (m).
    pub slip: Vec<Vector3<f64>>,
    /// Coefficient of friction that the algorithm used; the law's static value where open.
    pub mu: Vec<f64>,
    /// 0 open, 1 stick, 2 slip: of the node's own point, or where that is open but the node is
    /// loaded by the other pass, of the points that carry most of its normal force.
    pub state: Vec<u8>,
    /// Gap of the node's own pass (m), negative when penetrating; the search margin where no face
    /// is that near. The gap of an open node may be a few steps old.
    pub gap: Vec<f64>,
    /// Tributary area in the reference configuration (m^2).
    pub area: Vec<f64>,
    side: usize,
    /// Row of this table of each node of the surface; `NONE` if it has none.
    rows: Vec<u32>,
    /// Size of the normal forces of the slipping points of the other pass (N).
    slipping: Vec<f64>,
    /// Size of the normal forces of all points (N).
    carried: Vec<f64>,
}

impl NodalContact {
    /// The table of `nodes` with these tributary areas (m^2), all of them open and their gaps 0. It belongs to no
    /// [`Contact`](crate::Contact): who finds the contact fills it.
    pub fn of_nodes(nodes: Vec<u32>, area: Vec<f64>) -> Self {
        let n = nodes.len();
        Self {
            nodes,
            area,
            pressure: vec![0.0; n],
            pass_pressure: vec![0.0; n],
            shear: vec![Vector3::zeros(); n],
            slip_velocity: vec![Vector3::zeros(); n],
            slip: vec![Vector3::zeros(); n],
            mu: vec![0.0; n],
            state: vec![State::Open as u8; n],
            gap: vec![0.0; n],
            side: 0,
            rows: Vec::new(),
            slipping: vec![0.0; n],
            carried: vec![0.0; n],
        }
    }

    fn new(side: usize, nodes: &[u32], area: &[f64], wanted: impl Fn(usize) -> bool) -> Self {
        let (mut rows, mut kept, mut areas) = (vec![NONE; nodes.len()], Vec::new(), Vec::new());
        for i in (0..nodes.len()).filter(|&i| wanted(i)) {
            rows[i] = kept.len() as u32;
            kept.push(nodes[i]);
            areas.push(area[i]);
        }
        Self { side, rows, ..Self::of_nodes(kept, areas) }
    }

    fn clear(&mut self, margin: f64) {
        self.pressure.fill(0.0);
        self.pass_pressure.fill(0.0);
        self.shear.fill(Vector3::zeros());
        self.slip_velocity.fill(Vector3::zeros());
        self.slip.fill(Vector3::zeros());
        self.mu.fill(0.0);
        self.state.fill(State::Open as u8);
        self.gap.fill(margin);
        self.slipping.fill(0.0);
        self.carried.fill(0.0);
    }
}

impl NodalContact {
    /// A table for all nodes of a side.
    pub(crate) fn whole(trace: &Trace, sides: &[ContactSurface; 2], side: usize) -> Self {
        Self::new(side, trace.side(side), &sides[side].area, |_| true)
    }

    /// A table for the nodes of `faces`, a part of the surface of a side.
    pub(crate) fn part(
        trace: &Trace,
        sides: &[ContactSurface; 2],
        side: usize,
        faces: &[Face],
    ) -> Self {
        let nodes = trace.side(side);
        let mut wanted = vec![false; nodes.len()];
        for node in faces.iter().flat_map(|f| f.nodes) {
            if let Ok(i) = nodes.binary_search(&node) {
                wanted[i] = true;
            }
        }
        Self::new(side, nodes, &sides[side].area, |i| wanted[i])
    }

    /// Fills the table from the points in which nodes of its side are slaves (`own`) and the closed ones in
    /// which they bear slaves (`others`), with the node and its weight, which may be negative: means over
    /// slaves then count the size of their force. `followed` says whether nodes of its side are
    /// slaves at all: the gap of those that are not is the mean of the gaps of the points that load them.
    pub(crate) fn fill<'a, E: Enforced + 'a>(
        &mut self,
        sides: &[ContactSurface; 2],
        own: &[ContactPoint<E>],
        others: impl Iterator<Item = (&'a ContactPoint<E>, u32, f64)>,
        margin: f64,
        mu_static: f64,
        followed: bool,
    ) {
        let table = self;
        table.clear(margin);
        let side = table.side;
        if sides.get(side).is_none_or(|s| s.len() != table.rows.len()) {
            return;
        }
        if !followed {
            table.gap.fill(0.0);
        }
        // The other pass: what the faces of this side take as masters. Forces and slip of its
        // slaves are those of the other side, hence the signs.
        for (point, node, weight) in others {
            // most nodes are in no row of a small table
            let Some(row) = table.row(node) else {
                continue;
            };
            let values = point.values();
            let normal = weight * values.normal_force;
            let size = normal.abs();
            table.pressure[row] += normal;
            table.carried[row] += size;
            table.mu[row] += values.mu * size;
            table.shear[row] -= weight * values.friction;
            table.slip_velocity[row] -= size * values.slip_velocity;
            if values.state == State::Slip {
                table.slipping[row] += size;
            }
            if !followed {
                table.gap[row] += size * values.gap;
            }
        }
        for row in 0..table.nodes.len() {
            let total = table.carried[row];
            if total > 0.0 {
                table.slip_velocity[row] *= 1.0 / total;
                let slips = 2.0 * table.slipping[row] > total;
                table.state[row] = if slips { State::Slip } else { State::Stick } as u8;
            } else {
                table.slip_velocity[row] = Vector3::zeros();
            }
            if !followed {
                table.gap[row] = if total > 0.0 { table.gap[row] / total } else { margin };
            }
        }
        table.keep_in_plane(&sides[side]);
        for point in own {
            let Some(row) = table.row(point.slave) else {
                continue;
            };
            let values = point.values();
            table.gap[row] = values.gap.min(margin);
            if point.is_closed() {
                table.pressure[row] += values.normal_force;
                table.pass_pressure[row] = values.normal_force / table.area[row];
                table.carried[row] += values.normal_force;
                table.mu[row] += values.mu * values.normal_force;
                table.shear[row] += values.friction;
                table.slip_velocity[row] = values.slip_velocity;
                table.slip[row] = values.slip;
                table.state[row] = values.state as u8;
            }
        }
        for row in 0..table.nodes.len() {
            let (normal, size) = (table.pressure[row], table.carried[row]);
            table.mu[row] = if size > 0.0 { table.mu[row] / size } else { mu_static };
            table.pressure[row] = normal / table.area[row];
            table.shear[row] *= 1.0 / table.area[row];
        }
    }

    /// Leaves vectors that masters on a plane of symmetry gather in it: what loads them from one side loads them from the
    /// other.
    fn keep_in_plane(&mut self, surface: &ContactSurface) {
        let Self { rows, shear, slip_velocity, .. } = self;
        for (local, &row) in rows.iter().enumerate() {
            if row != NONE && surface.holds_on_plane(local) {
                for field in [&mut *shear, &mut *slip_velocity] {
                    field[row as usize] = in_plane(field[row as usize]);
                }
            }
        }
    }
}

impl PenaltyContact {
    /// An output table for all nodes of side `side`.
    pub fn nodal_table(&self, side: usize) -> NodalContact {
        NodalContact::whole(&self.trace, &self.sides, side)
    }

    /// Fills a `table` of this contact with the values of the last call.
    pub fn nodal(&self, table: &mut NodalContact) {
        let Some([own, others]) = passes(&self.points, table.side) else { return };
        let masters = &self.sides[table.side].faces;
        let others = others.iter().filter(|p| p.is_closed()).flat_map(|p| {
            let corners = masters.get(p.face as usize).map(|f| f.local).into_iter().flatten();
            corners.zip(p.enforcement.weights).map(move |(node, weight)| (p, node, weight))
        });
        let (margin, mu) = (self.search.margin, self.law.mu_static());
        table.fill(&self.sides, own, others, margin, mu, true);
    }
}

/// The points with slaves on `side` and those with masters there.
fn passes(points: &[Vec<PenaltyPoint>; 2], side: usize) -> Option<[&[PenaltyPoint]; 2]> {
    Some([points.get(side)?, points.get(1 - side)?])
}

impl NodalContact {
    pub(crate) fn side(&self) -> usize {
        self.side
    }

    fn row(&self, local: u32) -> Option<usize> {
        let row = self.rows[local as usize];
        (row != NONE).then_some(row as usize)
    }
}
