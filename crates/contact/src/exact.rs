//! Exact enforcement: the conditions of contact and friction hold at the end of every step.
//!
//! Forward-increment Lagrange multipliers (Carpenter, Taylor and Katona 1991) with friction: the
//! velocities without contact, `v_free = v^{n-1/2} + dt M^-1 f`, are corrected by the contact forces `r`,
//! `v^{n+1/2} = v_free + dt M^-1 G^T r`, such that for every slave node
//!
//! - the gap at the end of the step, `g + dt G_n v^{n+1/2} >= 0`, is complementary to `r_n >= 0`;
//! - `|r_t| <= mu r_n`, with equality and against the slip velocity where that is not zero.
//!
//! Nodes of one side, the slaves, meet the other at one face, or in the mean over all faces near them
//! ([`Rows`]). The system is solved by projected block Gauss–Seidel: a node's own block
//! `W_ii = (1/m_s + sum w_J^2/m_J) I` is isotropic for lumped masses, so that its normal problem, and then
//! its tangential one (`friction::slip_speed`) are closed; blocks of neighbouring nodes couple little. The order is
//! fixed, hence the bits are. Over nodes on a plane of symmetry, which answer in x and z alone, the true block is smaller
//! across the plane; the sweeps go on with the isotropic one, which bounds it, to the same solution where that is unique.

mod implicit;

pub use implicit::Corrected;

use crate::constraint::{Constraint, MasterNode, MasterPoint, Rows, face_shares, within};
use crate::enforcement::{
    ContactRenumbering, ContactRestart, ContactStep, ContactTables, FreeMotion,
};
use crate::face::{EDGE, Positions, shape};
use crate::mortar::{Mean, Mortar};
use crate::nodal::NodalContact;
use crate::nodal_normals::{NodalNormals, Normals};
use crate::penalty::{check_common, in_range};
use crate::point::{State, WATCHED, finer, follow_first, sleep};
use crate::renumber::{Renumbered, Renumbering};
use crate::search::{Listed, Search};
use crate::snapshot::{Points, check_legs, check_points};
use crate::sums::Accumulator;
use crate::surface::ContactSurface;
use crate::{BodyMaterial, ContactError, ContactState, ContactSums, Motion, StateError, Trace};
use friction::slip_speed;
use friction::{NodeConditions, NodeFriction, NodeHistory};
use mesh::geometry::frame;
use mesh::{Face, Mesh, Padded, Surface};
use nalgebra::{Matrix3x2, Vector3};

/// Sweeps end when no force changes by more than this part of the largest.
const TOLERANCE: f64 = 1e-12;
/// Sweeps at most. Their errors fall tenfold each where pitches are alike.
const SWEEPS: usize = 100;
/// After so many sweeps a node whose friction has several solutions stays on the branch that the last
/// sweep found, not on that of the step before: near the end of a branch neighbours could else drive
/// one another to and fro.
const SETTLED: usize = 20;
/// A mortar constraint far from closing may have moved so much further along the master before its integrals are
/// taken anew.
const FAR: f64 = 10.0;

/// Settings of [`ExactContact`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExactSettings {
    /// Side whose nodes are slaves; the finer one unless given.
    pub slave: Option<usize>,
    /// Corrects gap and normal with the exact surface where a side has one.
    pub curvature: bool,
    /// What the slaves meet.
    pub rows: Rows,
    /// The normal along which they meet a face.
    pub normals: Normals,
}

/// The side whose nodes are slaves.
pub(crate) fn slave_side(
    settings: &ExactSettings,
    sides: &[ContactSurface; 2],
) -> Result<usize, ContactError> {
    let mean = |side: &ContactSurface| side.area.iter().sum::<f64>() / side.area.len() as f64;
    let slave = settings.slave.unwrap_or_else(|| finer([mean(&sides[0]), mean(&sides[1])]));
    in_range("the side of the slaves", slave as f64, slave < 2, "0 or 1")?;
    Ok(slave)
}

/// Contact of two surfaces without penetration, and friction without elastic slip.
///
/// A direction in which a contact node is fixed (not held altogether) must be one in which contact
/// does not push it, as the direction across a plane motion, or only balances given loads: a node's own block
/// counts its whole mass.
#[derive(Debug)]
pub struct ExactContact {
    trace: Trace,
    sides: [ContactSurface; 2],
    slave: usize,
    /// The constraints, ascending by slave, in the list of the slaves' side.
    constraints: [Vec<Constraint>; 2],
    law: Box<dyn NodeFriction>,
    search: Search,
    /// Whether the search was refreshed in the last step.
    searched: bool,
    curvature: bool,
    /// Averaged normals of the master, unless slaves meet faces along theirs.
    normals: Option<NodalNormals>,
    /// Integration of mortar constraints, and the mean that each slave follows.
    mortar: Option<(Mortar, Vec<Mean>)>,
    /// Constraints that may carry force in this step, and their master_nodes.
    active: Vec<u32>,
    master_nodes: Vec<MasterNode>,
    /// The nodes of the trace that bear these.
    loaded: Vec<u32>,
    /// What the law of friction is told about those that were closed before, in their order.
    slid: Vec<NodeHistory>,
    /// Mortar constraints whose integrals were taken in this step.
    integrated: usize,
    /// Velocity and `dt/m` of the nodes of each side, where `stamp` is that of this step; `dt/m` is zero in a direction
    /// in which a plane of symmetry holds a node.
    velocity: [Vec<Vector3<f64>>; 2],
    dt_by_mass: [Vec<Vector3<f64>>; 2],
    stamp: [Vec<u64>; 2],
    now: u64,
    /// What an implicit step works with.
    implicit: implicit::ImplicitStep,
}

impl ExactContact {
    /// Contact of two `surfaces` of `mesh`, side 0 and side 1.
    ///
    /// # Errors
    /// Surfaces that are empty, degenerate, outside the mesh or in touch by a common node, and
    /// numbers out of range.
    pub fn new(
        mesh: &Mesh,
        surfaces: [(&Surface, BodyMaterial); 2],
        settings: &ExactSettings,
        law: Box<dyn NodeFriction>,
    ) -> Result<Self, ContactError> {
        check_common(&surfaces, &*law)?;
        let (trace, sides) = ContactSurface::both(mesh, surfaces)?;
        let slave = slave_side(settings, &sides)?;
        let zeros = |side: usize| sides[side].len();
        let mortar = || {
            let means = vec![Mean::default(); sides[slave].len()];
            (Mortar::new(settings.curvature), means)
        };
        let averaged = settings.rows == Rows::NodeToFace && settings.normals == Normals::Averaged;
        let normals = || NodalNormals::new(&sides[1 - slave], settings.curvature);
        Ok(Self {
            normals: averaged.then(normals),
            mortar: (settings.rows == Rows::Mortar).then(mortar),
            search: Search::new(&sides),
            searched: false,
            slave,
            constraints: [Vec::new(), Vec::new()],
            law,
            curvature: settings.curvature,
            active: Vec::new(),
            master_nodes: Vec::new(),
            slid: Vec::new(),
            integrated: 0,
            velocity: [0, 1].map(|s| vec![Vector3::zeros(); zeros(s)]),
            dt_by_mass: [0, 1].map(|s| vec![Vector3::zeros(); zeros(s)]),
            stamp: [0, 1].map(|s| vec![0; zeros(s)]),
            now: 0,
            implicit: implicit::ImplicitStep::default(),
            loaded: Vec::new(),
            trace,
            sides,
        })
    }

    /// Side whose nodes are slaves.
    pub fn slave(&self) -> usize {
        self.slave
    }

    /// Follows a constraint to the positions of the step. Returns whether it may close.
    fn update_kinematics(
        &mut self,
        constraint: &mut Constraint,
        positions: &Positions<'_>,
        motion: &Motion<'_>,
    ) -> bool {
        constraint.enforcement.slipped = constraint.state == State::Slip;
        if constraint.sleeps() {
            return false;
        }
        let x = positions.at(self.sides[self.slave].node(constraint.slave));
        let old = match &self.mortar {
            None => self.kinematics_on_face(constraint, positions, x),
            Some(_) => self.kinematics_in_mean(constraint, positions, x),
        };
        let Some(old) = old else {
            constraint.leave();
            return false;
        };
        if constraint.is_closed() {
            // the force of the last step turns with the master and is laid into the new plane
            constraint.friction = constraint.transported(old, constraint.normal);
            return true;
        }
        let (opening, slip) = self.rates_of(constraint, motion);
        let speed = libm::hypot(opening, slip.norm());
        constraint.sleep = sleep(constraint.gap, speed, self.search.margin, motion.dt);
        let may_close = constraint.gap < WATCHED * self.search.margin + 2.0 * motion.dt * speed;
        if !may_close {
            constraint.withdraw(&mut self.master_nodes);
        }
        may_close
    }

    /// Sets up a constraint over the face under it. Returns where its frame of the last step is now, or nothing
    /// where the node lies beside the master.
    fn kinematics_on_face(
        &mut self,
        constraint: &mut Constraint,
        positions: &Positions<'_>,
        x: Vector3<f64>,
    ) -> Option<Matrix3x2<f64>> {
        let master = &self.sides[1 - self.slave];
        let followed = constraint.project(master, positions, self.curvature, x);
        let projection = followed.projection?;
        let mut old = followed.old;
        if constraint.is_closed()
            && let Some(normals) = &mut self.normals
        {
            let weights = shape(constraint.xi, constraint.eta);
            old.normal = normals.at(master, positions, constraint.face, &weights);
        }
        constraint.move_to(&projection);
        let [xi, eta] = within(&projection);
        let shares = face_shares(&master.faces[projection.face as usize], xi, eta);
        let master_point = MasterPoint::under(x, &shares, master, positions);
        let normal = match &mut self.normals {
            Some(normals) => normals.at(master, positions, projection.face, &shape(xi, eta)),
            None => projection.point.normal,
        };
        let on_plane = master.is_on_plane(x);
        constraint.set_up(&shares, &master_point, normal, x, on_plane, &mut self.master_nodes);
        Some(frame(old.tangent, old.normal))
    }

    /// The same over the mean of a mortar constraint, which is integrated where there is none yet or the slave has
    /// moved along the master. Far from closing an older mean serves: its gap is good enough to wait by.
    fn kinematics_in_mean(
        &mut self,
        constraint: &mut Constraint,
        positions: &Positions<'_>,
        x: Vector3<f64>,
    ) -> Option<Matrix3x2<f64>> {
        let (mortar, means) = self.mortar.as_mut()?;
        let sides = [&self.sides[self.slave], &self.sides[1 - self.slave]];
        let mean = &mut means[constraint.slave as usize];
        let mut old = None;
        let mut kinematics = None;
        if !mean.shares.is_empty() {
            let now = mean.kinematics(sides[1], positions, x);
            old = Some(now.master_point.frame(now.normal, sides[1].is_on_plane(x)));
            let near = constraint.is_closed() || now.gap < WATCHED * self.search.margin;
            kinematics = (now.stale <= if near { 1.0 } else { FAR }).then_some(now);
        }
        let kinematics = match kinematics {
            Some(kinematics) => kinematics,
            None => {
                self.integrated += 1;
                let (face, on_master) =
                    mortar.integrate(sides, positions, constraint.slave, constraint.face, mean);
                constraint.face = face;
                if !on_master {
                    return None;
                }
                mean.kinematics(sides[1], positions, x)
            }
        };
        constraint.gap = kinematics.gap;
        constraint.set_up(
            &mean.shares,
            &kinematics.master_point,
            kinematics.normal,
            x,
            sides[1].is_on_plane(x),
            &mut self.master_nodes,
        );
        Some(old.unwrap_or(constraint.enforcement.frame))
    }

    /// Takes the velocity without contact of a node of `side`.
    fn release(
        &mut self,
        side: usize,
        local: u32,
        free_motion: &FreeMotion<'_>,
        force: &[Padded],
        motion: &Motion<'_>,
    ) {
        let i = local as usize;
        if self.stamp[side][i] == self.now {
            return;
        }
        let node = self.sides[side].node(local);
        self.stamp[side][i] = self.now;
        self.velocity[side][i] = (free_motion.velocity)(node, force[node as usize].vector());
        let dt_by_mass = motion.dt * motion.inverse_mass[node as usize];
        let held = self.sides[side].is_on_plane(motion.position[node as usize].vector());
        self.dt_by_mass[side][i] =
            Vector3::new(dt_by_mass, if held { 0.0 } else { dt_by_mass }, dt_by_mass);
    }

    /// Rates at the velocities that the forces found so far give.
    fn rates(&self, constraint: &Constraint) -> (f64, Vector3<f64>) {
        let master = &self.velocity[1 - self.slave];
        let slave = self.velocity[self.slave][constraint.slave as usize];
        constraint.rates(slave, &self.master_nodes[constraint.master_nodes()], |node| {
            master[node as usize]
        })
    }

    /// Rates at the velocities of a motion.
    fn rates_of(&self, constraint: &Constraint, motion: &Motion<'_>) -> (f64, Vector3<f64>) {
        let (own, master) = (&self.sides[self.slave], &self.sides[1 - self.slave]);
        let at = |node: u32| motion.velocity[node as usize].vector();
        let slave = at(own.node(constraint.slave));
        constraint.rates(slave, &self.master_nodes[constraint.master_nodes()], |node| {
            at(master.node(node))
        })
    }

    /// Notes which nodes bear the constraints that may carry force.
    fn note_loaded(&mut self) {
        let [own, master] = [&self.sides[self.slave], &self.sides[1 - self.slave]];
        let constraints = &self.constraints[self.slave];
        self.loaded.clear();
        self.loaded.reserve(self.active.capacity() + self.master_nodes.capacity());
        self.loaded.extend(self.active.iter().map(|&i| own.node(constraints[i as usize].slave)));
        self.loaded
            .extend(self.master_nodes.iter().map(|master_node| master.node(master_node.node)));
    }

    /// Adds what the forces of a constraint change in the velocities.
    fn push(&mut self, constraint: &Constraint, normal: f64, friction: Vector3<f64>) {
        let (i, own) = (constraint.slave as usize, self.slave);
        let on_slave = friction + normal * *constraint.normal;
        self.velocity[own][i] += self.dt_by_mass[own][i].component_mul(&on_slave);
        let (velocity, dt_by_mass) = (&mut self.velocity[1 - own], &self.dt_by_mass[1 - own]);
        for master_node in &self.master_nodes[constraint.master_nodes()] {
            let node = master_node.node as usize;
            let reaction = constraint.reaction(master_node, normal, friction);
            velocity[node] += dt_by_mass[node].component_mul(&reaction);
        }
    }

    fn at(
        &self,
        constraint: &Constraint,
        positions: &Positions<'_>,
        motion: &Motion<'_>,
    ) -> NodeConditions {
        let own = &self.sides[self.slave];
        let position = positions.at(own.node(constraint.slave));
        constraint.place(own, position, motion.time)
    }

    /// One update of Gauss–Seidel; returns the change of the force and its size (N).
    fn gauss_seidel_update(
        &mut self,
        constraint: &mut Constraint,
        positions: &Positions<'_>,
        motion: &Motion<'_>,
    ) -> [f64; 2] {
        let (opening, slip) = self.rates(constraint);
        let (pressed, frictional) = (constraint.normal_force, constraint.friction);
        let free_gap =
            constraint.gap + motion.dt * (opening - constraint.enforcement.delassus * pressed);
        let needed = -free_gap / (motion.dt * constraint.enforcement.delassus);
        // not `max`: what is no number must reach the guards
        constraint.normal_force = if needed <= 0.0 { 0.0 } else { needed };
        let free = slip - constraint.enforcement.delassus * frictional;
        (constraint.friction, constraint.state) =
            self.return_mapping(constraint, free, positions, motion);
        let change = constraint.friction - frictional;
        self.push(constraint, constraint.normal_force - pressed, change);
        [
            (constraint.normal_force - pressed).abs() + change.norm(),
            constraint.normal_force.max(constraint.friction.norm()),
        ]
    }

    /// Friction on the slave for the pressure of the constraint, from the slip velocity without it. Sets the
    /// coefficient.
    fn return_mapping(
        &self,
        constraint: &mut Constraint,
        free: Vector3<f64>,
        positions: &Positions<'_>,
        motion: &Motion<'_>,
    ) -> (Vector3<f64>, State) {
        if constraint.normal_force == 0.0 {
            return (Vector3::zeros(), State::Open);
        }
        let at = self.at(constraint, positions, motion);
        let speed = free.norm();
        let c = constraint.enforcement.delassus * constraint.normal_force;
        let sticking = (free * (-1.0 / constraint.enforcement.delassus), State::Stick);
        if self.law.is_implicit() {
            let curve = |s: f64| {
                (self.law.mu(constraint.memory, s, &at), self.law.slope(constraint.memory, s, &at))
            };
            let Some((_, mu)) = slip_speed::solve(speed, c, constraint.enforcement.slipped, &curve)
            else {
                constraint.mu = self.law.mu(constraint.memory, 0.0, &at);
                return sticking;
            };
            constraint.mu = mu;
        } else {
            constraint.mu = self.law.mu(constraint.memory, 0.0, &at);
            if speed <= c * constraint.mu {
                return sticking;
            }
        }
        (free * (-constraint.mu * constraint.normal_force / speed), State::Slip)
    }

    /// Takes the velocities without contact of the nodes of a constraint, its own block of the Delassus
    /// operator, and what the law is told of the last step. Returns whether there is anything to enforce.
    fn free(
        &mut self,
        constraint: &mut Constraint,
        free_motion: &FreeMotion<'_>,
        force: &[Padded],
        positions: &Positions<'_>,
        motion: &Motion<'_>,
    ) -> bool {
        let own = self.slave;
        self.release(own, constraint.slave, free_motion, force, motion);
        constraint.enforcement.delassus = self.dt_by_mass[own][constraint.slave as usize][0];
        for k in constraint.master_nodes() {
            let MasterNode { node, weight, .. } = self.master_nodes[k];
            self.release(1 - own, node, free_motion, force, motion);
            constraint.enforcement.delassus +=
                weight * weight * self.dt_by_mass[1 - own][node as usize][0];
        }
        // both ends held: nothing to enforce
        if constraint.enforcement.delassus == 0.0 {
            constraint.open();
            return false;
        }
        let at = self.at(constraint, positions, motion);
        if constraint.is_closed() {
            self.slid.push(constraint.slid(at));
        } else {
            constraint.memory = self.law.begin(&at);
        }
        true
    }

    /// Advances the law's state of the constraints that were closed.
    fn remember(&mut self, constraints: &mut [Constraint], active: &[u32], dt: f64) {
        self.law.advance_all(&mut self.slid, dt);
        let mut advanced = self.slid.iter();
        for &i in active {
            let constraint = &mut constraints[i as usize];
            // those of `slid`, in the same order
            if constraint.is_closed()
                && let Some(slid) = advanced.next()
            {
                constraint.memory = slid.state;
            }
        }
    }

    /// Sweeps over the constraints until no force changes; returns how many, and where they end at their limit the
    /// largest change of a constraint's forces in the last, over the largest force.
    fn gauss_seidel(
        &mut self,
        constraints: &mut [Constraint],
        active: &[u32],
        positions: &Positions<'_>,
        motion: &Motion<'_>,
    ) -> (usize, f64) {
        let mut part = 0.0;
        for sweep in 1..=SWEEPS {
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for &i in active {
                let constraint = &mut constraints[i as usize];
                let [changed, force] = self.gauss_seidel_update(constraint, positions, motion);
                if sweep > SETTLED {
                    constraint.enforcement.slipped = constraint.state == State::Slip;
                }
                change = change.max(changed);
                size = size.max(force);
            }
            // NaN ends the sweeps too
            let goes_on = change > TOLERANCE * size;
            if !goes_on {
                return (sweep, 0.0);
            }
            // a force that falls to zero changes by more than is left
            part = change / size.max(change);
        }
        (SWEEPS, part)
    }

    /// Adds the forces of a closed constraint to `force`, and what they do to `sums`.
    fn load(
        &self,
        constraint: &mut Constraint,
        positions: &Positions<'_>,
        motion: &Motion<'_>,
        force: &mut [Padded],
        sums: &mut Accumulator,
    ) {
        let (opening, slip) = self.rates(constraint);
        let before = self.rates_of(constraint, motion);
        // the trapezoidal work of the force, in halves around t^n
        let work = |(opening, slip): (f64, Vector3<f64>)| {
            0.5 * motion.dt * (constraint.normal_force * opening + constraint.friction.dot(&slip))
        };
        // round-off of a node that sticks is no friction
        let slips = constraint.state == State::Slip;
        let heat = if slips { -motion.dt * constraint.friction.dot(&slip) } else { 0.0 };
        sums.friction_ahead.add(heat);
        sums.damping_work.add(-work(before));
        sums.damping_ahead.add(-(work((opening, slip)) + heat));

        self.finish(constraint, slip, positions, motion, force, sums);
    }

    /// Leaves a closed constraint as the step with this slip velocity (m/s) leaves it; adds its forces to `force`, and what is
    /// counted to `sums`.
    fn finish(
        &self,
        constraint: &mut Constraint,
        slip: Vector3<f64>,
        positions: &Positions<'_>,
        motion: &Motion<'_>,
        force: &mut [Padded],
        sums: &mut Accumulator,
    ) {
        let own = self.slave;
        let [on_slave, on_masters] = self.add_force(constraint, force);
        sums.push(own, on_slave);
        sums.push(1 - own, on_masters);
        constraint.keep_in(constraint.enforcement.frame);
        constraint.slip_velocity = slip;
        constraint.slip += motion.dt * slip;
        sums.normal_force.add(constraint.normal_force);
        sums.meet(constraint.mu);
        let other = &mut sums.other;
        let node = self.sides[own].node(constraint.slave);
        let nodes = self.sides[own].nodes_of_whole(positions.at(node));
        other.closed += nodes;
        other.slipping += nodes * usize::from(constraint.state == State::Slip);
        other.max_penetration = other.max_penetration.max(-constraint.gap);
        other.non_unique +=
            nodes * usize::from(self.is_non_unique(constraint, slip, positions, motion));
    }

    /// Adds the forces of a constraint to `force`; returns those on the slave and on the master.
    fn add_force(&self, constraint: &Constraint, force: &mut [Padded]) -> [Vector3<f64>; 2] {
        let own = self.slave;
        let on_slave = constraint.friction + constraint.normal_force * *constraint.normal;
        force[self.sides[own].node(constraint.slave) as usize] += on_slave;
        let mut on_masters = Vector3::zeros();
        for master_node in &self.master_nodes[constraint.master_nodes()] {
            let on_leg =
                constraint.reaction(master_node, constraint.normal_force, constraint.friction);
            force[self.sides[1 - own].node(master_node.node) as usize] += on_leg;
            on_masters += on_leg;
        }
        [on_slave, on_masters]
    }

    /// Whether friction at a constraint that slips at `slip` (m/s) has more than one solution.
    fn is_non_unique(
        &self,
        constraint: &Constraint,
        slip: Vector3<f64>,
        positions: &Positions<'_>,
        motion: &Motion<'_>,
    ) -> bool {
        if !self.law.is_implicit() {
            return false;
        }
        let at = self.at(constraint, positions, motion);
        let free = (slip - constraint.enforcement.delassus * constraint.friction).norm();
        let curve = |s: f64| {
            (self.law.mu(constraint.memory, s, &at), self.law.slope(constraint.memory, s, &at))
        };
        slip_speed::is_non_unique(
            free,
            constraint.enforcement.delassus * constraint.normal_force,
            &curve,
        )
    }
}

#[cfg(test)]
impl ExactContact {
    /// Room of the lists that a step fills.
    pub(crate) fn room(&self) -> [usize; 4] {
        let (mortar, means) = match &self.mortar {
            Some((mortar, means)) => {
                (mortar.room(), means.iter().map(|m| m.shares.capacity()).sum())
            }
            None => (0, 0),
        };
        [self.master_nodes.capacity(), self.active.capacity(), mortar, means]
    }
}

impl ContactStep for ExactContact {
    fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Finds the constraints that may close, and sets them up.
    fn follow(&mut self, motion: &Motion<'_>) {
        let positions = Positions(motion.position);
        let own = self.slave;
        self.searched = self.search.is_due(&self.sides, &positions, &self.constraints);
        if self.searched {
            self.search.refresh(&self.sides, &positions, &mut self.constraints);
            self.constraints[1 - own].clear();
            let most = self.constraints[own].len();
            self.active.reserve(most.saturating_sub(self.active.len()));
            self.master_nodes.reserve((4 * most).saturating_sub(self.master_nodes.len()));
            self.slid.reserve(most.saturating_sub(self.slid.len()));
        }
        let mut constraints = std::mem::take(&mut self.constraints[own]);
        self.active.clear();
        self.master_nodes.clear();
        self.integrated = 0;
        self.normals.iter_mut().for_each(NodalNormals::expire);
        for (i, constraint) in constraints.iter_mut().enumerate() {
            if self.update_kinematics(constraint, &positions, motion) {
                self.active.push(i as u32);
            }
        }
        self.constraints[own] = constraints;
        self.note_loaded();
    }

    fn loaded(&self) -> &[u32] {
        &self.loaded
    }

    fn apply(
        &mut self,
        motion: &Motion<'_>,
        free_motion: &FreeMotion<'_>,
        force: &mut [Padded],
    ) -> ContactSums {
        let positions = Positions(motion.position);
        let mut sums = Accumulator::new(self.searched);
        let mut constraints = std::mem::take(&mut self.constraints[self.slave]);
        let mut active = std::mem::take(&mut self.active);
        self.slid.clear();
        self.now += 1;
        active.retain(|&i| {
            let constraint = &mut constraints[i as usize];
            self.free(constraint, free_motion, force, &positions, motion)
        });
        self.remember(&mut constraints, &active, motion.dt);
        // Only now: all velocities are free ones.
        for &i in &active {
            let constraint = &constraints[i as usize];
            if constraint.is_closed() {
                self.push(constraint, constraint.normal_force, constraint.friction);
            }
        }
        sums.other.integrated = self.integrated;
        (sums.other.sweeps, sums.other.unconverged) =
            self.gauss_seidel(&mut constraints, &active, &positions, motion);
        for &i in &active {
            let constraint = &mut constraints[i as usize];
            if constraint.is_closed() {
                self.load(constraint, &positions, motion, force, &mut sums);
            } else {
                constraint.open();
            }
        }
        self.constraints[self.slave] = constraints;
        self.active = active;
        sums.finish()
    }

    fn follow_first(&mut self, pairs: &[[u32; 2]]) {
        let own = self.trace.side(self.slave);
        follow_first(&mut self.constraints[self.slave], own, pairs);
    }
}

impl ContactRenumbering for ExactContact {
    fn renumber(&mut self, renumbering: Renumbering<'_>) -> usize {
        let Self { sides, trace, search, constraints, slave, mortar, .. } = self;
        let in_mesh = [trace.side(0), trace.side(1)];
        let means = mortar.as_mut().map(|(_, means)| means.as_mut_slice());
        let renumbered = Renumbered { sides, in_mesh, search };
        renumbered.rows(*slave, &mut constraints[*slave], means, renumbering)
    }
}

impl ContactTables for ExactContact {
    fn nodal_table(&self, side: usize) -> NodalContact {
        NodalContact::whole(&self.trace, &self.sides, side)
    }

    fn nodal_table_of(&self, side: usize, faces: &[Face]) -> NodalContact {
        NodalContact::part(&self.trace, &self.sides, side, faces)
    }

    fn nodal(&self, table: &mut NodalContact) {
        let is_slave = table.side() == self.slave;
        let constraints = &self.constraints[self.slave][..];
        let (own, others) = if is_slave { (constraints, &[][..]) } else { (&[][..], constraints) };
        let others =
            others.iter().filter(|constraint| constraint.is_closed()).flat_map(|constraint| {
                // Beyond an edge that a slave lies over, weights are zero to round-off. The forces keep them for their
                // balance; shown, they would pull a node.
                let bears = |master_node: &&MasterNode| {
                    master_node.weight >= 0.0 || master_node.weight <= -EDGE
                };
                let master_nodes =
                    self.master_nodes[constraint.master_nodes()].iter().filter(bears);
                master_nodes
                    .map(move |master_node| (constraint, master_node.node, master_node.weight))
            });
        let (margin, mu) = (self.search.margin, self.law.mu_static());
        table.fill(&self.sides, own, others, margin, mu, is_slave);
    }

    fn enforced_on(&self) -> Option<usize> {
        Some(self.slave)
    }
}

impl ContactRestart for ExactContact {
    fn snapshot(&self) -> ContactState {
        let means = self.mortar.as_ref().map(|(_, means)| means.clone()).unwrap_or_default();
        let (constraints, master_nodes) =
            (self.constraints[self.slave].clone(), self.master_nodes.clone());
        let points = Points::Exact(constraints, master_nodes, means);
        ContactState { points, search: self.search.clone(), origin: self.sides[0].origin }
    }

    fn restore(&mut self, state: &ContactState) -> Result<(), StateError> {
        let own = self.slave;
        let Points::Exact(constraints, master_nodes, kept) = &state.points else {
            return Err(StateError::Method);
        };
        if kept.is_empty() != self.mortar.is_none() {
            return Err(StateError::Rows);
        }
        let sides = [&self.sides[own], &self.sides[1 - own]];
        check_points(constraints, sides[0], sides[1])?;
        check_legs(constraints, master_nodes, sides[1])?;
        if let Some((mortar, means)) = &mut self.mortar {
            mortar.check_means(kept, sides)?;
            means.clone_from(kept);
        }
        self.active.reserve(constraints.len());
        self.slid.reserve(constraints.len());
        self.master_nodes.clone_from(master_nodes);
        self.master_nodes.reserve((4 * constraints.len()).saturating_sub(master_nodes.len()));
        self.constraints[own].clone_from(constraints);
        self.sides.iter_mut().for_each(|side| side.origin = state.origin);
        self.search.restore(&state.search, &self.sides)
    }
}
