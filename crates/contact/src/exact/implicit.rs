//! Exact contact in an implicit step: the conditions of [the module above](super), with the compliance of all nodes over the
//! step in place of lumped masses.
//!
//! Over an implicit step the mean velocity `w = (u^{n+1} - u^n)/dt` of the surfaces answers contact forces r by the
//! Delassus operator `W = G A^-1 G^T` of the matrix A of the step (Acary 2013): `G w = G w_free + W r`. The gap at the end of
//! the step, `g + dt G_n w >= 0`, is complementary to the normal force, and friction obeys its law at the slip velocity `G_t w`.
//!
//! The time loop computes w under the forces found so far; [`ExactContact::solve_implicit`] corrects the forces with W, by
//! projected block Gauss–Seidel. Once forces no longer change, the conditions hold for w, whatever the error of W:
//! it may be a good approximation.

use super::{ExactContact, SETTLED, TOLERANCE};
use crate::constraint::Constraint;
use crate::face::Positions;
use crate::point::{State, follow_first};
use crate::search::Listed;
use crate::sums::Accumulator;
use crate::{ContactSums, Motion};
use mesh::Padded;
use mesh::geometry::tangential;
use nalgebra::{Matrix3, Matrix3x2, Vector3};

/// Sweeps over the dense operator at most.
const SWEEPS: usize = 500;

/// Iterations of the power method.
const POWERS: usize = 12;

/// What the forces of a call became.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corrected {
    /// Largest change of the forces of a constraint over the largest force (dimensionless).
    pub change: f64,
    /// Change in the last sweep over the largest force, where the sweeps ended at their limit; else 0.
    pub unconverged: f64,
}

/// What an implicit step works with.
#[derive(Debug, Default)]
pub(crate) struct ImplicitStep {
    /// Constraints to solve for, by their place in the list of the slaves' side.
    solved: Vec<u32>,
    /// The Delassus operator of these, by rows (m/(N s)).
    delassus: Vec<Matrix3<f64>>,
    /// Relative velocity of each of them (m/s).
    rates: Vec<Vector3<f64>>,
    /// Normal force and friction (N) before a correction.
    before: Vec<(f64, Vector3<f64>)>,
    /// Most sweeps of a correction in the step.
    sweeps: usize,
    /// The constraints as they were when the step began.
    kept: Vec<Constraint>,
    /// The nodes of the master that bear these, and the place of each node of the master among them.
    masters: Vec<u32>,
    place: Vec<u32>,
    /// Velocity of each of `masters` under unit forces on one constraint.
    answer: Vec<Matrix3<f64>>,
}

impl ExactContact {
    /// Begins a step: what the law of friction is told of the last one, and which constraints there are to solve for. The
    /// second slave of each of `pairs` (nodes of the mesh that move as one) follows the first.
    ///
    /// To be called after `follow` of the same motion.
    pub fn begin_implicit(&mut self, motion: &Motion<'_>, pairs: &[[u32; 2]]) {
        let positions = Positions(motion.position);
        let mut step = std::mem::take(&mut self.implicit);
        let mut constraints = std::mem::take(&mut self.constraints[self.slave]);
        let mut active = std::mem::take(&mut self.active);
        step.kept.clone_from(&constraints);
        step.sweeps = 0;
        self.slid.clear();
        active.retain(|&i| {
            let constraint = &mut constraints[i as usize];
            if self.is_held(constraint, motion) {
                constraint.open();
                return false;
            }
            let at = self.at(constraint, &positions, motion);
            if constraint.is_closed() {
                self.slid.push(constraint.slid(at));
            } else {
                constraint.memory = self.law.begin(&at);
            }
            true
        });
        self.remember(&mut constraints, &active, motion.dt);
        let own = self.trace.side(self.slave);
        let leads = |slave: u32| {
            let node = own[slave as usize];
            pairs.iter().all(|pair| pair[1] != node)
        };
        step.solved.clear();
        step.solved
            .extend(active.iter().copied().filter(|&i| leads(constraints[i as usize].slave)));
        self.constraints[self.slave] = constraints;
        (self.active, self.implicit) = (active, step);
    }

    /// Takes the state back in which the step began.
    pub fn reject_implicit(&mut self) {
        self.constraints[self.slave].clone_from(&self.implicit.kept);
    }

    /// The nodes of the trace, some more than once, whose compliance the step asks for.
    pub fn borne_by(&self) -> impl Iterator<Item = u32> + '_ {
        let [own, master] = [&self.sides[self.slave], &self.sides[1 - self.slave]];
        let constraints = &self.constraints[self.slave];
        self.implicit.solved.iter().flat_map(move |&i| {
            let constraint = &constraints[i as usize];
            let master_nodes = self.master_nodes[constraint.master_nodes()]
                .iter()
                .map(|master_node| master.node(master_node.node));
            std::iter::once(own.node(constraint.slave)).chain(master_nodes)
        })
    }

    /// Sets the Delassus operator up from `compliance`: the velocity (m/s) of the first node of the trace under unit forces (N) on
    /// the second, of the same side.
    pub fn set_compliance(&mut self, compliance: &dyn Fn(u32, u32) -> Matrix3<f64>) {
        let mut step = std::mem::take(&mut self.implicit);
        let [own, master] = [&self.sides[self.slave], &self.sides[1 - self.slave]];
        let constraints = &self.constraints[self.slave];
        let ImplicitStep { solved, delassus, masters, place, answer, .. } = &mut step;
        place.clear();
        place.resize(master.len(), u32::MAX);
        masters.clear();
        for master_node in
            solved.iter().flat_map(|&i| &self.master_nodes[constraints[i as usize].master_nodes()])
        {
            let at = &mut place[master_node.node as usize];
            if *at == u32::MAX {
                *at = masters.len() as u32;
                masters.push(master_node.node);
            }
        }
        let n = solved.len();
        delassus.clear();
        delassus.resize(n * n, Matrix3::zeros());
        for (k, &on) in solved.iter().enumerate() {
            let on = &constraints[on as usize];
            answer.clear();
            answer.extend(masters.iter().map(|&node| {
                let on_node = self.master_nodes[on.master_nodes()].iter().map(|master_node| {
                    let c = compliance(master.node(node), master.node(master_node.node));
                    c * on.on_leg(master_node).transpose()
                });
                on_node.sum::<Matrix3<f64>>()
            }));
            for (i, &of) in solved.iter().enumerate() {
                let of = &constraints[of as usize];
                let mut block = compliance(own.node(of.slave), own.node(on.slave));
                for master_node in &self.master_nodes[of.master_nodes()] {
                    let velocity = &answer[place[master_node.node as usize] as usize];
                    block += of.on_leg(master_node) * velocity;
                }
                delassus[i * n + k] = of.within_plane(on, block);
            }
        }
        self.implicit = step;
    }

    /// Corrects the forces for the velocities of `motion`, those that the forces give so far.
    pub fn solve_implicit(&mut self, motion: &Motion<'_>) -> Corrected {
        let positions = Positions(motion.position);
        let mut step = std::mem::take(&mut self.implicit);
        let mut constraints = std::mem::take(&mut self.constraints[self.slave]);
        step.rates.clear();
        step.before.clear();
        for &i in &step.solved {
            let constraint = &constraints[i as usize];
            let (opening, slip) = self.rates_of(constraint, motion);
            step.rates.push(slip + opening * *constraint.normal);
            step.before.push((constraint.normal_force, constraint.friction));
        }
        let (mut corrected, mut sweeps) = (Corrected::default(), 0);
        for sweep in 1..=SWEEPS {
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for k in 0..step.solved.len() {
                let constraint = &mut constraints[step.solved[k] as usize];
                let [changed, force] =
                    self.sweep_over(&mut step, k, constraint, &positions, motion);
                if sweep > SETTLED {
                    constraint.enforcement.slipped = constraint.state == State::Slip;
                }
                change = change.max(changed);
                size = size.max(force);
            }
            sweeps = sweep;
            corrected.unconverged = change / size.max(change);
            // NaN ends the sweeps too
            let goes_on = change > TOLERANCE * size;
            if !goes_on {
                corrected.unconverged = if change.is_nan() { change } else { 0.0 };
                break;
            }
        }
        step.sweeps = step.sweeps.max(sweeps);
        let (mut change, mut size) = (0.0_f64, 0.0_f64);
        for (&i, (normal, friction)) in step.solved.iter().zip(&step.before) {
            let constraint = &constraints[i as usize];
            let by = (constraint.friction - friction).norm();
            change = change.max((constraint.normal_force - normal).abs() + by);
            size = size.max(constraint.normal_force).max(*normal);
        }
        corrected.change = if size > 0.0 { change / size } else { change };
        self.constraints[self.slave] = constraints;
        self.implicit = step;
        corrected
    }

    /// Solves for the forces of constraint k alone, first normal, then friction; returns their change and size (N).
    fn sweep_over(
        &self,
        step: &mut ImplicitStep,
        k: usize,
        constraint: &mut Constraint,
        positions: &Positions<'_>,
        motion: &Motion<'_>,
    ) -> [f64; 2] {
        let n = step.solved.len();
        let own = step.delassus[k * n + k];
        let normal = constraint.normal;
        let (pressed, frictional) = (constraint.normal_force, constraint.friction);
        let answer = normal.dot(&(own * *normal));
        let free_gap = constraint.gap + motion.dt * (normal.dot(&step.rates[k]) - answer * pressed);
        let needed = -free_gap / (motion.dt * answer);
        // not `max`: what is no number must reach the guards
        constraint.normal_force = if needed <= 0.0 { 0.0 } else { needed };
        step.push(k, (constraint.normal_force - pressed) * *normal);
        let slip = tangential(step.rates[k], normal);
        constraint.enforcement.delassus = largest(&own, &constraint.enforcement.frame);
        let free = slip - constraint.enforcement.delassus * frictional;
        (constraint.friction, constraint.state) =
            self.return_mapping(constraint, free, positions, motion);
        let change = constraint.friction - frictional;
        step.push(k, change);
        [
            (constraint.normal_force - pressed).abs() + change.norm(),
            constraint.normal_force.max(constraint.friction.norm()),
        ]
    }

    /// Adds the contact forces found so far (N) to `force`, over the nodes of the trace.
    pub fn add_forces(&self, force: &mut [Padded]) {
        let constraints = &self.constraints[self.slave];
        for &i in &self.implicit.solved {
            self.add_force(&constraints[i as usize], force);
        }
    }

    /// Ends a step with the velocities of `motion`: the state of contact, and its sums. Friction and what else contact
    /// dissipates are those of the whole step. Adds the forces (N), those on the second nodes of `pairs` too, to `force`.
    pub fn end_implicit(
        &mut self,
        motion: &Motion<'_>,
        pairs: &[[u32; 2]],
        force: &mut [Padded],
    ) -> ContactSums {
        let positions = Positions(motion.position);
        let mut sums = Accumulator::new(self.searched);
        let mut constraints = std::mem::take(&mut self.constraints[self.slave]);
        follow_first(&mut constraints, self.trace.side(self.slave), pairs);
        let active = std::mem::take(&mut self.active);
        for &i in &active {
            let constraint = &mut constraints[i as usize];
            if !constraint.is_closed() {
                constraint.open();
                continue;
            }
            let (opening, slip) = self.rates_of(constraint, motion);
            let slips = constraint.state == State::Slip;
            let rubbed = constraint.friction.dot(&slip);
            let heat = if slips { -motion.dt * rubbed } else { 0.0 };
            sums.friction_ahead.add(heat);
            let work = motion.dt * (constraint.normal_force * opening + rubbed);
            sums.damping_ahead.add(-(work + heat));
            self.finish(constraint, slip, &positions, motion, force, &mut sums);
            // the conditions hold at the end of the step, as the table of the nodes then says
            constraint.gap += motion.dt * opening;
        }
        (sums.other.sweeps, sums.other.integrated) = (self.implicit.sweeps, self.integrated);
        sums.other.steepness = self.steepness(&constraints, &positions, motion);
        self.active = active;
        self.constraints[self.slave] = constraints;
        sums.finish()
    }

    /// `R` of [`ContactSums::steepness`]: the largest of `-mu'(0) r_n W_ii` over the constraints, and the largest eigenvalue of
    /// `-mu'(0) r_n W` along their friction, by the power method.
    fn steepness(
        &self,
        constraints: &[Constraint],
        positions: &Positions<'_>,
        motion: &Motion<'_>,
    ) -> [f64; 2] {
        let step = &self.implicit;
        let n = step.solved.len();
        let mut along = vec![Vector3::zeros(); n];
        let mut alone = 0.0_f64;
        for (k, &i) in step.solved.iter().enumerate() {
            let constraint = &constraints[i as usize];
            let size = constraint.friction.norm();
            if size == 0.0 {
                continue;
            }
            let at = self.at(constraint, positions, motion);
            let fall = -self.law.slope(constraint.memory, 0.0, &at) * constraint.normal_force;
            if fall > 0.0 {
                let own = step.delassus[k * n + k];
                alone = alone.max(fall * largest(&own, &constraint.enforcement.frame));
                // the square root of the fall on either side keeps the operator symmetric
                along[k] = constraint.friction * (fall.sqrt() / size);
            }
        }
        let mut x: Vec<f64> = along.iter().map(|direction| direction.norm()).collect();
        let mut together = 0.0;
        for _ in 0..POWERS {
            let size = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            if size == 0.0 {
                return [alone, 0.0];
            }
            let y: Vec<f64> = (0..n)
                .map(|i| {
                    let answer: Vector3<f64> =
                        (0..n).map(|k| step.delassus[i * n + k] * (x[k] / size * along[k])).sum();
                    along[i].dot(&answer)
                })
                .collect();
            together = y.iter().map(|y| y * y).sum::<f64>().sqrt();
            x = y;
        }
        [alone, together]
    }

    /// Whether neither the slave nor a node of the master under it can move.
    fn is_held(&self, constraint: &Constraint, motion: &Motion<'_>) -> bool {
        let [own, master] = [&self.sides[self.slave], &self.sides[1 - self.slave]];
        let held = |node: u32| motion.inverse_mass[node as usize] == 0.0;
        held(own.node(constraint.slave))
            && self.master_nodes[constraint.master_nodes()]
                .iter()
                .all(|master_node| held(master.node(master_node.node)))
    }
}

impl ImplicitStep {
    /// Adds what a change of the force of constraint k (N) changes in the relative velocities.
    fn push(&mut self, k: usize, force: Vector3<f64>) {
        if force == Vector3::zeros() {
            return;
        }
        let n = self.solved.len();
        for (i, rate) in self.rates.iter_mut().enumerate() {
            *rate += self.delassus[i * n + k] * force;
        }
    }
}

/// The larger eigenvalue of the symmetric part of a matrix in the plane of two orthonormal columns.
fn largest(m: &Matrix3<f64>, frame: &Matrix3x2<f64>) -> f64 {
    let in_frame = frame.tr_mul(&(m * frame));
    let (a, d) = (in_frame.m11, in_frame.m22);
    let b = 0.5 * (in_frame.m12 + in_frame.m21);
    0.5 * (a + d) + libm::hypot(0.5 * (a - d), b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_answer_in_the_plane_of_contact_is_the_larger_eigenvalue_there() {
        // 2 +- 1 in the plane, at 45 degrees to its axes, whatever there is across it
        let plane = Matrix3x2::identity();
        let across = Matrix3::new(2.0, 1.0, 5.0, 1.0, 2.0, 5.0, 5.0, 5.0, 9.0);
        assert_eq!(largest(&across, &plane), 3.0);
        let along = Matrix3::from_diagonal(&Vector3::new(2.0, 4.0, 9.0));
        assert_eq!(largest(&along, &plane), 4.0);
    }
}
