//! A slave node and its foot as three rows of constraints: the normal one and two tangential ones.
//!
//! The rows give the rate at which the gap opens, `n . w`, and the slip velocity, and their transpose
//! the forces. The slip velocity is measured against the point of the master that the node touches,
//! carried along with the face at the distance `d = n . (x_s - x_m)` of the exact surface beyond the
//! facet:
//!
//! `s = P (v_s - sum phi_I v_I - d n')`, `n' = -sum b_I (n . v_I)`, `P = I - n n`,
//!
//! with `b_I` the surface gradients of the shape functions. A rotation common to both bodies then
//! gives no slip; and since the transposed rows are the forces, the forces on slave and face have no
//! resultant moment.

use crate::face::{Foot, Positions, shape, shape_gradients};
use crate::snapshot::Fields;
use crate::surface::MasterFace;
use crate::touch::{Listed, State, Touch};
use crate::vector::{Vec3, axpy, cross, dot, scale, sub, tangential};

/// A slave node near the master surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub slave: u32,
    pub state: State,
    pub sleep: u32,
    /// Where the foot is.
    pub face: u32,
    pub xi: f64,
    pub eta: f64,
    pub gap: f64,
    pub normal: Vec3,
    pub weights: [f64; 4],
    /// `d b_I`.
    pub levers: [Vec3; 4],
    /// `dt W_ii`: the velocity (m/s) that a force of 1 N on slave and face makes in the step.
    pub mobility: f64,
    pub normal_force: f64,
    /// On the slave (N).
    pub friction: Vec3,
    /// Tangential frame that turns with the face, and `friction` in it.
    pub frame: [Vec3; 2],
    pub framed: [f64; 2],
    pub mu: f64,
    /// State of the friction law.
    pub memory: [f64; 2],
    pub slip_velocity: Vec3,
    pub slip: Vec3,
    /// Whether it slipped in the step before.
    pub slipped: bool,
}

impl Listed for Row {
    fn near(slave: u32, face: u32) -> Self {
        Self {
            slave,
            state: State::Open,
            sleep: 0,
            face,
            xi: 0.0,
            eta: 0.0,
            gap: f64::INFINITY,
            normal: [0.0; 3],
            weights: [0.0; 4],
            levers: [[0.0; 3]; 4],
            mobility: 0.0,
            normal_force: 0.0,
            friction: [0.0; 3],
            frame: [[0.0; 3]; 2],
            framed: [0.0; 2],
            mu: 0.0,
            memory: [0.0; 2],
            slip_velocity: [0.0; 3],
            slip: [0.0; 3],
            slipped: false,
        }
    }

    fn slave(&self) -> u32 {
        self.slave
    }

    fn face(&self) -> u32 {
        self.face
    }

    fn is_closed(&self) -> bool {
        self.state != State::Open
    }

    fn fields(&mut self, visit: &mut impl Fields) {
        visit.whole("slave", &mut self.slave);
        visit.state(&mut self.state);
        visit.whole("sleep", &mut self.sleep);
        visit.whole("face", &mut self.face);
        visit.number("xi", "1", &mut self.xi);
        visit.number("eta", "1", &mut self.eta);
        visit.number("gap", "m", &mut self.gap);
        visit.real("weights", "1", &mut self.weights);
        visit.real("normal", "1", &mut self.normal);
        visit.number("normal_force", "N", &mut self.normal_force);
        visit.real("friction", "N", &mut self.friction);
        visit.real("framed_friction", "N", &mut self.framed);
        visit.number("mu", "1", &mut self.mu);
        visit.real("memory", "as of the law", &mut self.memory);
        visit.real("slip_velocity", "m/s", &mut self.slip_velocity);
        visit.real("slip", "m", &mut self.slip);
        visit.flag("slipped", &mut self.slipped);
    }
}

impl Row {
    pub fn touch(&self) -> Touch {
        Touch {
            slave: self.slave,
            face: self.face,
            weights: self.weights,
            state: self.state,
            gap: self.gap,
            normal_force: self.normal_force,
            friction: self.friction,
            mu: self.mu,
            slip_velocity: self.slip_velocity,
            slip: self.slip,
        }
    }

    /// Forgets contact, but not where the foot is.
    pub fn open(&mut self) {
        *self =
            Self { gap: self.gap, xi: self.xi, eta: self.eta, ..Self::near(self.slave, self.face) };
    }

    /// Sets up the rows of a node at `x` over its foot.
    pub fn place(&mut self, foot: &Foot, face: &MasterFace, positions: &Positions<'_>, x: Vec3) {
        let (xi, eta) = (foot.xi.clamp(-1.0, 1.0), foot.eta.clamp(-1.0, 1.0));
        let n = foot.point.normal;
        self.normal = n;
        self.weights = shape(xi, eta);
        let gradients = shape_gradients(xi, eta);
        let (mut foot, mut a1, mut a2) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for ((&node, weight), [d1, d2]) in face.nodes.iter().zip(self.weights).zip(gradients) {
            let corner = positions.at(node);
            foot = axpy(foot, weight, corner);
            a1 = axpy(a1, d1, corner);
            a2 = axpy(a2, d2, corner);
        }
        let distance = dot(n, sub(x, foot));
        // tangents in the plane of the rows, and their duals
        let (a1, a2) = (tangential(a1, n), tangential(a2, n));
        let area = dot(n, cross(a1, a2));
        let (g1, g2) = (scale(1.0 / area, cross(a2, n)), scale(1.0 / area, cross(n, a1)));
        for (lever, [d1, d2]) in self.levers.iter_mut().zip(gradients) {
            *lever = axpy(scale(distance * d1, g1), distance * d2, g2);
        }
    }

    /// Rate of the gap (m/s) and slip velocity (m/s) from the velocities of slave and corners.
    #[inline]
    pub fn rates(&self, slave: Vec3, corners: [Vec3; 4]) -> (f64, Vec3) {
        let mut w = slave;
        let mut turn = [0.0; 3];
        for i in 0..4 {
            w = axpy(w, -self.weights[i], corners[i]);
            turn = axpy(turn, dot(self.normal, corners[i]), self.levers[i]);
        }
        let opening = dot(self.normal, w);
        (opening, axpy(axpy(w, -opening, self.normal), 1.0, turn))
    }

    /// Force on corner `i` where `normal` and `friction` act on the slave (N).
    #[inline]
    pub fn reaction(&self, i: usize, normal: f64, friction: Vec3) -> Vec3 {
        let along = dot(self.levers[i], friction) - self.weights[i] * normal;
        axpy(scale(-self.weights[i], friction), along, self.normal)
    }
}
