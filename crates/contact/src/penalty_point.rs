//! One slave node and its projection on the master surface: normal spring and damper, friction spring.

use crate::Motion;
use crate::face::{Positions, shape};
use crate::nodal_normals::NodalNormals;
use crate::point::{ContactPoint, Enforced, State, relative_velocity, sleep};
use crate::search::Listed;
use crate::stiffness::{StabilityScale, Stiffness};
use crate::surface::{ContactSurface, MasterFace};
use friction::{NodeFriction, NodeHistory};
use mesh::Padded;
use mesh::geometry::{frame, tangential};
use nalgebra::{Matrix3x2, UnitVector3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

/// A contact point that a spring and a damper push out and a friction spring holds.
pub(crate) type PenaltyPoint = ContactPoint<Springs>;

/// What penalty contact keeps of a contact point.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Springs {
    /// Normal and tangential stiffness (N/m), in motion kept from closing to opening.
    pub stiffness: [f64; 2],
    /// Weights with which the corners of the face take the reaction.
    pub weights: [f64; 4],
    /// The damper's part of the normal force (N).
    damper_force: f64,
    /// Dissipated in the last step (J).
    #[serde(skip)]
    pub friction_work: f64,
    #[serde(skip)]
    pub damping_work: f64,
    /// What the friction of the step under way starts from.
    #[serde(skip)]
    trial: Trial,
}

/// The motion to which the friction spring of a point answers in the step under way.
#[derive(Clone, Copy, Debug, Default)]
struct Trial {
    /// In contact since the step before.
    held: bool,
    /// Tangential motion of the slave over the step (m) from where its old place on the face has gone, so that a rotation
    /// common to both bodies gives none.
    delta: Vector3<f64>,
    /// The old force, turned with the frame of the face at the old projection and laid into the new tangent plane with its
    /// length kept (N).
    start: Vector3<f64>,
    /// First direction of the face at the new projection.
    tangent: Vector3<f64>,
}

/// A point in contact since the step before, as the face has carried it along.
struct Held {
    /// Motion of the slave over the step relative to where it was on the face, at the distance it had (m).
    moved: Vector3<f64>,
    /// The normal of the last step and its frame.
    normal: UnitVector3<f64>,
    frame: Matrix3x2<f64>,
}

impl Enforced for Springs {
    fn follow(&mut self, other: &Self) {
        *self = Self { weights: self.weights, ..*other };
    }
}

impl PenaltyPoint {
    /// Energy in the normal spring (J).
    pub fn stored_normal(&self) -> f64 {
        if self.is_closed() {
            0.5 * self.enforcement.stiffness[0] * self.gap * self.gap
        } else {
            0.0
        }
    }

    /// Energy in the friction spring (J).
    pub fn stored_tangential(&self) -> f64 {
        let stiffness = self.enforcement.stiffness[1];
        if self.is_closed() && stiffness > 0.0 {
            0.5 * self.friction.norm_squared() / stiffness
        } else {
            0.0
        }
    }

    /// What the friction spring still holds is lost as the surfaces part.
    fn part(&mut self) {
        let lost = self.stored_tangential();
        self.open();
        self.enforcement.friction_work = lost;
    }

    /// A node that slides off the border takes along what both springs hold.
    fn slide_off(&mut self) {
        let lost = [self.stored_tangential(), self.stored_normal()];
        self.leave();
        [self.enforcement.friction_work, self.enforcement.damping_work] = lost;
    }
}

/// What the points of one pass share.
pub(crate) struct Pass<'a> {
    pub slave: &'a ContactSurface,
    pub master: &'a ContactSurface,
    pub normal: Stiffness,
    pub tangential: Stiffness,
    pub stability: Option<StabilityScale>,
    pub damping: f64,
    pub curvature: bool,
    pub margin: f64,
    pub law: &'a dyn NodeFriction,
}

impl Pass<'_> {
    /// Normal and tangential stiffness (N/m) of a slave whose projection is the mean of the corners of a
    /// master face with `weights`.
    ///
    /// What the face's element gives is interpolated between its means at the corners: with a
    /// value for each face, a projection by an edge would decide by round-off which of two it gets.
    pub fn stiffness(&self, slave: usize, face: &MasterFace, weights: &[f64; 4]) -> [f64; 2] {
        let mean = |values: &[f64]| -> f64 {
            weights.iter().zip(face.local).map(|(weight, n)| weight * values[n as usize]).sum()
        };
        let (own, other) = (self.slave.mass_per_area[slave], mean(&self.master.mass_per_area));
        let reduced = own * other / (own + other);
        let scaled = mean(&self.master.scaled_stiffness);
        [self.normal, self.tangential]
            .map(|form| form.per_pass(scaled, reduced, self.stability) * self.slave.area[slave])
    }

    /// Follows the point to `positions`; `motion` is absent where only normal springs act. Its normal is that of the face
    /// unless there are averaged `normals`.
    pub fn update(
        &self,
        point: &mut PenaltyPoint,
        positions: &Positions<'_>,
        motion: Option<&Motion<'_>>,
        mut normals: Option<&mut NodalNormals>,
    ) {
        point.enforcement.friction_work = 0.0;
        point.enforcement.damping_work = 0.0;
        if motion.is_some() && point.sleeps() {
            return;
        }
        let node = self.slave.node(point.slave);
        let x = positions.at(node);
        let followed = point.project(self.master, positions, self.curvature, x);
        let Some(projection) = followed.projection else {
            point.slide_off();
            return;
        };
        let before = *point;
        point.move_to(&projection);
        let face = &self.master.faces[projection.face as usize];
        point.enforcement.weights =
            shape(projection.xi.clamp(-1.0, 1.0), projection.eta.clamp(-1.0, 1.0));
        let penetrates = projection.gap < 0.0;
        if !penetrates {
            self.separate(point, before.is_closed(), node, face, motion);
            return;
        }
        // equilibrium knows no history: the time loop starts from its displacements alone
        if !before.is_closed() || motion.is_none() {
            point.enforcement.stiffness =
                self.stiffness(point.slave as usize, face, &point.enforcement.weights);
        }
        let (old, of_face) = (followed.old, projection.point.normal);
        let mut averaged = |face, weights: &[f64; 4], of_face| match &mut normals {
            Some(normals) => normals.at(self.master, positions, face, weights),
            None => of_face,
        };
        point.normal = averaged(projection.face, &point.enforcement.weights, of_face);
        let held = before.is_closed().then(|| {
            let normal = averaged(before.face, &before.enforcement.weights, old.normal);
            let kept = old.x + (before.gap + old.offset) * *old.normal;
            Held { moved: x - kept, normal, frame: frame(old.tangent, normal) }
        });
        self.press(point, &before, node, face, motion);
        if let Some(Held { moved, normal, .. }) = &held {
            // the springs store by the gap, which does not change along the face: the work that an inclined normal does
            // there is none of theirs
            let along = before.normal_force * (**normal - *old.normal)
                + point.normal_force * (*point.normal - *of_face);
            point.enforcement.damping_work -= 0.5 * along.dot(moved);
        }
        point.state = State::Stick;
        match (motion, held) {
            (Some(_), Some(Held { moved, frame, .. })) => {
                point.enforcement.trial = Trial {
                    held: true,
                    delta: tangential(moved, point.normal),
                    start: before.transported(frame, point.normal),
                    tangent: projection.point.tangent,
                };
            }
            (Some(motion), None) => self.begin(point, x, node, face, motion),
            (None, _) => self.rest(point, x),
        }
    }

    /// Without penetration a closed point opens, and an open one sleeps as long as it cannot close.
    fn separate(
        &self,
        point: &mut PenaltyPoint,
        was_closed: bool,
        node: u32,
        face: &MasterFace,
        motion: Option<&Motion<'_>>,
    ) {
        if was_closed {
            point.part();
        } else if let Some(motion) = motion {
            let velocity =
                relative_velocity(motion.velocity, node, face.nodes, &point.enforcement.weights);
            point.sleep = sleep(point.gap, velocity.norm(), self.margin, motion.dt);
        }
    }

    /// Friction in equilibrium: the spring is unloaded, and the time loop goes on from here.
    fn rest(&self, point: &mut PenaltyPoint, x: Vector3<f64>) {
        point.friction = Vector3::zeros();
        point.framed = Vector2::zeros();
        point.mu = self.law.mu_static();
        point.memory = self.law.begin(&point.place(self.slave, x, 0.0));
        point.slip_velocity = Vector3::zeros();
        point.slip = Vector3::zeros();
    }

    /// Spring and damper. The damper's work in the step is the trapezoidal
    /// `-(d^n + d^{n+1})/2 (g^{n+1} - g^n)`, with `d` what the force exceeds the spring's by.
    fn press(
        &self,
        point: &mut PenaltyPoint,
        before: &PenaltyPoint,
        node: u32,
        face: &MasterFace,
        motion: Option<&Motion<'_>>,
    ) {
        let spring = -point.enforcement.stiffness[0] * point.gap;
        point.normal_force = spring;
        point.enforcement.damper_force = 0.0;
        let Some(motion) = motion else { return };
        if self.damping == 0.0 {
            return;
        }
        let velocity =
            relative_velocity(motion.velocity, node, face.nodes, &point.enforcement.weights);
        let rate = point.normal.dot(&velocity);
        let mut compliance = motion.inverse_mass[node as usize];
        for (weight, corner) in point.enforcement.weights.iter().zip(face.nodes) {
            compliance += weight * weight * motion.inverse_mass[corner as usize];
        }
        // Both ends held: nothing to damp.
        if compliance > 0.0 {
            let critical = 2.0 * (point.enforcement.stiffness[0] / compliance).sqrt();
            point.normal_force = (spring - self.damping * critical * rate).max(0.0);
            point.enforcement.damper_force = point.normal_force - spring;
        }
        let closing = if before.is_closed() { point.gap - before.gap } else { rate * motion.dt };
        point.enforcement.damping_work =
            -0.5 * (before.enforcement.damper_force + point.enforcement.damper_force) * closing;
    }

    /// Begins friction where a point closes: the spring starts unloaded, and the slip speed is that of the nodes'
    /// velocities.
    fn begin(
        &self,
        point: &mut PenaltyPoint,
        x: Vector3<f64>,
        node: u32,
        face: &MasterFace,
        motion: &Motion<'_>,
    ) {
        let velocity =
            relative_velocity(motion.velocity, node, face.nodes, &point.enforcement.weights);
        point.slip_velocity = tangential(velocity, point.normal);
        point.memory = self.law.begin(&point.place(self.slave, x, motion.time));
        point.enforcement.trial = Trial::default();
    }

    /// What the law of friction is told about a closed point: the slip speed of the step before.
    pub fn slid(&self, point: &PenaltyPoint, positions: &Positions<'_>, time: f64) -> NodeHistory {
        let x = positions.at(self.slave.node(point.slave));
        point.slid(point.place(self.slave, x, time))
    }

    /// The friction spring of a closed point, Eqs (10) and (11) of Vollebregt (2017): trial force
    /// `f* = f - k_t Delta`, capped at `mu f_n` in its own direction, with `mu` at the slip speed of the
    /// step before, to which the law's state has been advanced, or of a law of the same instant at that of this step.
    ///
    /// # Energy
    /// The cap lets the spring slip by `Delta_p = Delta + (f^{n+1} - f^n)/k_t`. The trapezoidal
    /// work of the force on both bodies is then
    /// `1/2 (f^n + f^{n+1}).Delta = 1/2 (f^n + f^{n+1}).Delta_p - (|f^{n+1}|^2 - |f^n|^2)/(2 k_t)`:
    /// minus the energy stored and minus the dissipation `-1/2 (f^n + f^{n+1}).Delta_p`, exactly.
    /// The dissipation is negative only where the motion of one step turns a full friction force
    /// round beyond the opposite cap while the cap shrinks, a chatter that no stable run has.
    pub fn return_mapping(&self, point: &mut PenaltyPoint, slid: &NodeHistory, dt: f64) {
        let Trial { held, delta, start, tangent } = point.enforcement.trial;
        let of_instant = held && self.law.is_implicit();
        let slip_speed = if of_instant { delta.norm() / dt } else { slid.slip_speed };
        point.mu = self.law.mu(slid.state, slip_speed, &slid.at);
        if !held {
            // the state stays that of the beginning: this slip is counted in the next step
            return;
        }
        point.memory = slid.state;
        let stiffness = point.enforcement.stiffness[1];
        let mut friction = start - stiffness * delta;
        let (trial, cap) = (friction.norm(), point.mu * point.normal_force);
        // a coefficient that is no number must reach the guards
        if cap.is_nan() || trial > cap {
            friction *= cap / trial;
            point.state = State::Slip;
            if stiffness > 0.0 {
                let slip = delta + (1.0 / stiffness) * (friction - start);
                point.enforcement.friction_work = -0.5 * (start.dot(&slip) + friction.dot(&slip));
            }
        }
        point.friction = friction;
        point.keep_in(frame(tangent, point.normal));
        point.slip_velocity = delta * (1.0 / dt);
        point.slip += delta;
    }
}

/// Adds the force of a closed point on the slave to that node, and the reaction to the `corners` of the face.
#[inline]
pub(crate) fn scatter(
    point: &PenaltyPoint,
    slave: u32,
    corners: [u32; 4],
    on_slave: Vector3<f64>,
    force: &mut [Padded],
) {
    force[slave as usize] += on_slave;
    for (weight, corner) in point.enforcement.weights.iter().zip(corners) {
        force[corner as usize] -= *weight * on_slave;
    }
}
