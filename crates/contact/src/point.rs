//! The contact point: a slave node and its projection on the master, as every enforcement knows it.

use crate::face::{Followed, Positions, Projection, project};
use crate::search::Listed;
use crate::surface::ContactSurface;
use friction::{NodeConditions, NodeHistory};
use mesh::Padded;
use mesh::geometry::tangential;
use nalgebra::{Matrix3x2, UnitVector3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

/// An open node is looked at again after at most this many steps.
const LONGEST_SLEEP: u32 = 8;

/// Part of the search margin within which every open node is looked at in every step.
pub(crate) const WATCHED: f64 = 1.0 / 32.0;

/// State of a slave node, as the output codes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub(crate) enum State {
    Open = 0,
    Stick = 1,
    Slip = 2,
}

/// What one method of enforcement keeps of a contact point besides what all of them do.
pub(crate) trait Enforced: Copy + Default {
    /// Takes over all of `other` but what belongs to where the node's own projection is.
    fn follow(&mut self, other: &Self);
}

/// A slave node near the master surface, with what its method of enforcement `E` keeps.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct ContactPoint<E> {
    /// The slave, in its surface.
    pub slave: u32,
    pub state: State,
    /// Steps in which it need not be looked at.
    pub sleep: u32,
    /// Where the projection is, or was sought last.
    pub face: u32,
    /// Coordinates of the projection in the face, from -1 to 1 within it.
    pub xi: f64,
    pub eta: f64,
    /// Negative where the slave has penetrated (m).
    pub gap: f64,
    /// Normal of the master, out of its body; any before one is found.
    pub normal: UnitVector3<f64>,
    /// On the slave along the normal (N).
    pub normal_force: f64,
    /// On the slave in the tangent plane (N).
    pub friction: Vector3<f64>,
    /// `friction` in the tangential frame that turns with the master.
    pub framed: Vector2<f64>,
    /// Coefficient of friction (dimensionless).
    pub mu: f64,
    /// State of the friction law.
    pub memory: [f64; 2],
    /// Of the slave relative to the master, tangential (m/s).
    pub slip_velocity: Vector3<f64>,
    /// Its integral since contact began (m).
    pub slip: Vector3<f64>,
    /// What the method of enforcement keeps besides.
    pub enforcement: E,
}

impl<E: Enforced> Listed for ContactPoint<E> {
    fn near(slave: u32, face: u32) -> Self {
        Self {
            slave,
            state: State::Open,
            sleep: 0,
            face,
            xi: 0.0,
            eta: 0.0,
            gap: f64::INFINITY,
            normal: Vector3::z_axis(),
            normal_force: 0.0,
            friction: Vector3::zeros(),
            framed: Vector2::zeros(),
            mu: 0.0,
            memory: [0.0; 2],
            slip_velocity: Vector3::zeros(),
            slip: Vector3::zeros(),
            enforcement: E::default(),
        }
    }

    fn slave(&self) -> u32 {
        self.slave
    }

    fn is_closed(&self) -> bool {
        self.state != State::Open
    }
}

impl<E: Enforced> ContactPoint<E> {
    /// Forgets contact, but not where the projection is.
    pub fn open(&mut self) {
        *self =
            Self { gap: self.gap, xi: self.xi, eta: self.eta, ..Self::near(self.slave, self.face) };
    }

    /// Forgets contact of a node that projects off the master: the next search for its projection
    /// starts from the middle of the face.
    pub fn leave(&mut self) {
        *self = Self::near(self.slave, self.face);
    }

    /// Whether the node need not be looked at in this step; counts the step.
    pub fn sleeps(&mut self) -> bool {
        let sleeps = self.sleep > 0;
        self.sleep -= u32::from(sleeps);
        sleeps
    }

    /// The projection of the node at `x` on `master`, followed from where it was.
    #[inline]
    pub fn project(
        &self,
        master: &ContactSurface,
        positions: &Positions<'_>,
        curvature: bool,
        x: Vector3<f64>,
    ) -> Followed {
        project(master, positions, curvature, x, self.face, self.xi, self.eta)
    }

    /// Takes a projection over.
    pub fn move_to(&mut self, projection: &Projection) {
        (self.face, self.xi, self.eta, self.gap) =
            (projection.face, projection.xi, projection.eta, projection.gap);
    }

    /// The force of friction of the last step: turned with the tangential frame of the master, which
    /// is `frame` now, and laid into the plane with unit normal `n`, its length kept.
    pub fn transported(&self, frame: Matrix3x2<f64>, n: UnitVector3<f64>) -> Vector3<f64> {
        let turned = frame * self.framed;
        let flat = tangential(turned, n);
        let (length, left) = (turned.norm(), flat.norm());
        if left > 0.0 { flat * (length / left) } else { Vector3::zeros() }
    }

    /// Keeps the force of friction in the tangential frame of the master.
    pub fn keep_in(&mut self, frame: Matrix3x2<f64>) {
        self.framed = frame.tr_mul(&self.friction);
    }

    /// Where and when the law of friction is asked, for a node of `surface` at `position`.
    pub fn place(
        &self,
        surface: &ContactSurface,
        position: Vector3<f64>,
        time: f64,
    ) -> NodeConditions {
        let pressure = self.normal_force / surface.area[self.slave as usize];
        let position = [position.x + surface.origin, position.y, position.z];
        NodeConditions { position, time, pressure }
    }

    /// What the law of friction is told: the slip speed of the step before.
    pub fn slid(&self, at: NodeConditions) -> NodeHistory {
        NodeHistory { state: self.memory, slip_speed: self.slip_velocity.norm(), at }
    }

    /// What tables of nodes show of it.
    pub fn values(&self) -> PointValues {
        PointValues {
            state: self.state,
            gap: self.gap,
            normal_force: self.normal_force,
            friction: self.friction,
            mu: self.mu,
            slip_velocity: self.slip_velocity,
            slip: self.slip,
        }
    }

    /// Takes over all of `other` but the node itself and where its projection is.
    pub fn follow(&mut self, other: &Self) {
        let Self { slave, face, xi, eta, mut enforcement, .. } = *self;
        enforcement.follow(&other.enforcement);
        *self = Self { slave, face, xi, eta, enforcement, ..*other };
    }
}

/// A slave node and its projection, as the tables of nodes show them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointValues {
    pub state: State,
    pub gap: f64,
    /// Normal force (N) and tangential force on the slave (N).
    pub normal_force: f64,
    pub friction: Vector3<f64>,
    pub mu: f64,
    pub slip_velocity: Vector3<f64>,
    pub slip: Vector3<f64>,
}

/// Gives the second slave of each pair of mesh nodes the state of the first; the pairs ascend by the first,
/// `rows` by their slaves, which are the nodes `own` of the mesh.
pub(crate) fn follow_first<E: Enforced>(
    rows: &mut [ContactPoint<E>],
    own: &[u32],
    pairs: &[[u32; 2]],
) {
    if pairs.is_empty() {
        return;
    }
    for i in 0..rows.len() {
        let first = rows[i];
        let node = own[first.slave as usize];
        let from = pairs.partition_point(|pair| pair[0] < node);
        for pair in pairs[from..].iter().take_while(|pair| pair[0] == node) {
            let local = own.binary_search(&pair[1]).ok();
            let row = |local| rows.binary_search_by_key(&(local as u32), |r| r.slave).ok();
            if let Some(second) = local.and_then(row) {
                rows[second].follow(&first);
            }
        }
    }
}

/// Steps for which an open node with this gap (m) and relative speed (m/s) cannot close unless that
/// speed more than doubles. Nodes within a part of the search margin are never left unwatched.
pub(crate) fn sleep(gap: f64, speed: f64, margin: f64, dt: f64) -> u32 {
    if gap < WATCHED * margin {
        return 0;
    }
    let steps = gap / (2.0 * dt * speed);
    // A saturating cast: NaN gives zero.
    (steps as u32).min(LONGEST_SLEEP)
}

/// Velocity (m/s) of a slave relative to the point with `weights` on `face` of the master.
#[inline]
pub(crate) fn relative_velocity(
    velocity: &[Padded],
    node: u32,
    corners: [u32; 4],
    weights: &[f64; 4],
) -> Vector3<f64> {
    let mut relative = velocity[node as usize].vector();
    for (weight, corner) in weights.iter().zip(corners) {
        relative -= *weight * velocity[corner as usize].vector();
    }
    relative
}

/// The side whose faces or nodes are finer by their mean areas (m^2), the first of equals: its nodes serve
/// better as slaves.
pub fn finer(mean_areas: [f64; 2]) -> usize {
    usize::from(mean_areas[1] < 0.99 * mean_areas[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraint::Constraint;

    #[test]
    fn a_node_that_moves_as_another_has_its_contact_and_keeps_its_own_projection() {
        let mut first = Constraint::near(3, 17);
        (first.xi, first.eta) = (0.25, -0.5);
        (first.state, first.gap, first.normal_force) = (State::Slip, -1e-6, 120.0);
        (first.framed, first.mu, first.memory) = (Vector2::new(30.0, -10.0), 0.3, [1e-3, 2e-3]);
        let mut second = Constraint::near(8, 41);
        (second.xi, second.eta) = (-0.75, 0.125);
        // the slaves 3 and 8 are the nodes 20 and 90 of the mesh
        let own: Vec<u32> = (0..9).map(|slave| if slave < 8 { 17 + slave } else { 90 }).collect();
        let mut rows = [first, second];
        follow_first(&mut rows, &own, &[[19, 8], [20, 90], [21, 90]]);
        let [_, follower] = rows;
        assert_eq!((follower.slave, follower.face), (8, 41));
        assert_eq!([follower.xi, follower.eta], [-0.75, 0.125]);
        assert_eq!(follower.state, State::Slip);
        assert_eq!([follower.gap, follower.normal_force, follower.mu], [-1e-6, 120.0, 0.3]);
        assert_eq!((follower.framed, follower.memory), (first.framed, first.memory));
    }

    #[test]
    fn the_finer_side_has_the_smaller_faces_and_is_the_first_of_equals() {
        assert_eq!([finer([1.0, 2.0]), finer([2.0, 1.0]), finer([1.0, 1.0])], [0, 1, 0]);
        // equal to round-off
        assert_eq!(finer([1.0, 1.0 - 1e-12]), 0);
    }
}
