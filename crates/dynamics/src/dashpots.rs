//! Mass-proportional damping relative to the rigid motion.
//!
//! Each node of the disk is tied to the hub by a dashpot alpha m, each node of the bar to the
//! ground. The force on a node is -alpha m (v - v_rigid); its reaction acts on the hub, so that
//! the dashpots dissipate alpha m |v - v_rigid|^2 and never push the whole. v_rigid is the hub's
//! motion at the node's *undeformed* place: the preload pattern, which stays in space while the
//! disk turns through it, then meets no mean drag.

use crate::hub::Hub;
use mesh::Padded;
use std::ops::Range;

/// The dashpots of a step.
#[derive(Clone, Debug)]
pub(crate) struct Dashpots {
    /// Damping rate (1/s).
    pub(crate) alpha: f64,
    /// Nodes of the disk.
    pub(crate) disk: Range<usize>,
    /// The hub's motion, if there is a hub.
    pub(crate) motion: Option<RigidMotion>,
}

/// A hub's rigid motion; by default rest.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RigidMotion {
    centre: [f64; 3],
    turn: (f64, f64),
    v: [f64; 2],
    omega: f64,
}

impl RigidMotion {
    pub(crate) fn new(hub: &Hub) -> Self {
        let s = hub.state;
        Self { centre: hub.centre, turn: libm::sincos(s.angle), v: [s.vx, s.vz], omega: s.omega }
    }

    pub(crate) fn is_at_rest(&self) -> bool {
        self.v == [0.0; 2] && self.omega == 0.0
    }

    /// Velocity (m/s) at the undeformed place of a point, padded, and its arm (x, z) from the
    /// centre (m).
    #[inline(always)]
    pub(crate) fn at(&self, reference: Padded) -> ([f64; 4], [f64; 2]) {
        let (x, z) = (reference.0[0] - self.centre[0], reference.0[2] - self.centre[2]);
        let (sin, cos) = self.turn;
        let arm = [cos * x + sin * z, cos * z - sin * x];
        ([self.v[0] + self.omega * arm[1], 0.0, self.v[1] - self.omega * arm[0], 0.0], arm)
    }
}
