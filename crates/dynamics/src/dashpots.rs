//! Mass-proportional damping relative to the rigid motion.
//!
//! Each node of the upper body is tied to the hub by a dashpot alpha m, each node of the lower body to the
//! ground. The force on a node is -alpha m (v - v_rigid); its reaction acts on the hub, so that
//! the dashpots dissipate alpha m |v - v_rigid|^2 and never push the whole. v_rigid is the hub's
//! motion at the node's *undeformed* place: the preload pattern, which stays in space while the
//! upper body turns through it, then meets no mean drag.

use crate::hub::{Hub, HubState};
use mesh::Padded;
use nalgebra::Vector3;
use std::ops::Range;

/// The dashpots of a step.
#[derive(Clone, Debug)]
pub(crate) struct Dashpots {
    /// Damping rate (1/s).
    pub(crate) alpha: f64,
    /// Nodes of the upper body.
    pub(crate) upper: Range<usize>,
    /// The hub's motion, if there is a hub.
    pub(crate) motion: Option<RigidMotion>,
}

/// A hub's rigid motion; by default rest.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RigidMotion {
    centre: Vector3<f64>,
    turn: (f64, f64),
    v: [f64; 3],
    omega: f64,
    /// Sine and cosine of the angle that the axle has turned about +z, and how fast it turns (rad/s).
    heading: (f64, f64),
    turning: f64,
}

impl RigidMotion {
    pub(crate) fn new(hub: &Hub) -> Self {
        Self::of(hub, hub.state)
    }

    /// In another state of the hub.
    pub(crate) fn of(hub: &Hub, s: HubState) -> Self {
        Self {
            centre: hub.centre,
            turn: libm::sincos(s.angle),
            v: [s.vx, s.vy, s.vz],
            omega: s.omega,
            heading: libm::sincos(s.heading),
            turning: s.turning,
        }
    }

    pub(crate) fn is_at_rest(&self) -> bool {
        self.v == [0.0; 3] && self.omega == 0.0 && self.turning == 0.0
    }

    /// Whether it leaves the plane of rolling.
    pub(crate) fn is_sideways(&self) -> bool {
        self.v[1] != 0.0 || self.heading.0 != 0.0 || self.turning != 0.0
    }

    /// Velocity (m/s) at the undeformed place of a point, padded, and its arm from the centre (m). Of a motion that is not
    /// [sideways](Self::is_sideways), the arm in y is zero.
    #[inline(always)]
    pub(crate) fn at(&self, reference: Padded) -> ([f64; 4], [f64; 3]) {
        if self.is_sideways() { self.at_sideways(reference) } else { self.at_straight(reference) }
    }

    /// The same of a motion that is not sideways.
    #[inline(always)]
    pub(crate) fn at_straight(&self, reference: Padded) -> ([f64; 4], [f64; 3]) {
        let [x, z] = self.rolled(reference);
        ([self.v[0] + self.omega * z, 0.0, self.v[2] - self.omega * x, 0.0], [x, 0.0, z])
    }

    /// The same of any motion.
    #[inline(always)]
    pub(crate) fn at_sideways(&self, reference: Padded) -> ([f64; 4], [f64; 3]) {
        let (sin, cos) = self.heading;
        let ([ahead, z], y) = (self.rolled(reference), reference.0[1] - self.centre[1]);
        let arm = [cos * ahead - sin * y, sin * ahead + cos * y, z];
        let rolling = self.omega * z;
        let velocity = [
            self.v[0] + cos * rolling - self.turning * arm[1],
            self.v[1] + sin * rolling + self.turning * arm[0],
            self.v[2] - self.omega * ahead,
            0.0,
        ];
        (velocity, arm)
    }

    /// Arm of a point in x and z (m), turned about the axle.
    #[inline(always)]
    fn rolled(&self, reference: Padded) -> [f64; 2] {
        let (x, z) = (reference.0[0] - self.centre[0], reference.0[2] - self.centre[2]);
        let (sin, cos) = self.turn;
        [cos * x + sin * z, cos * z - sin * x]
    }
}
