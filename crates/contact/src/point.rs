//! What every enforcement knows of a slave node and its projection: the state, what the search lists, and
//! what the tables of nodes show.

use crate::surface::ContactSurface;
use crate::vector::{Vec3, axpy};
use mesh::Padded;
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

/// A slave node that the search lists because it is near the other surface.
pub(crate) trait ContactPoint: Copy {
    /// An open node whose projection is to be sought from `face`.
    fn near(slave: u32, face: u32) -> Self;
    /// The node, in its surface.
    fn slave(&self) -> u32;
    /// Where its projection is.
    fn face(&self) -> u32;
    /// Closed nodes stay listed.
    fn is_closed(&self) -> bool;
    /// What tables of nodes show of it.
    fn values(&self) -> PointValues;
    /// Takes over all of `other` but the node itself and where its projection is.
    fn follow(&mut self, other: &Self);
}

/// A slave node and its projection, as the tables of nodes show them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointValues {
    pub state: State,
    pub gap: f64,
    /// Normal force (N) and tangential force on the slave (N).
    pub normal_force: f64,
    pub friction: Vec3,
    pub mu: f64,
    pub slip_velocity: Vec3,
    pub slip: Vec3,
}

/// Gives the second slave of each pair of mesh nodes the state of the first; the pairs ascend by the first,
/// `rows` by their slaves on `own`.
pub(crate) fn follow_first<P: ContactPoint>(
    rows: &mut [P],
    own: &ContactSurface,
    pairs: &[[u32; 2]],
) {
    if pairs.is_empty() {
        return;
    }
    for i in 0..rows.len() {
        let first = rows[i];
        let node = own.nodes[first.slave() as usize];
        let second = pairs
            .binary_search_by_key(&node, |pair| pair[0])
            .ok()
            .and_then(|k| own.nodes.binary_search(&pairs[k][1]).ok())
            .and_then(|local| rows.binary_search_by_key(&(local as u32), |r| r.slave()).ok());
        if let Some(second) = second {
            rows[second].follow(&first);
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
) -> Vec3 {
    let mut relative = velocity[node as usize].xyz();
    for (weight, corner) in weights.iter().zip(corners) {
        relative = axpy(relative, -weight, velocity[corner as usize].xyz());
    }
    relative
}

/// The side whose surface is finer by its mean nodal area, the first of equals.
pub(crate) fn finer(sides: &[ContactSurface; 2]) -> usize {
    let mean = |s: &ContactSurface| s.area.iter().sum::<f64>() / s.area.len() as f64;
    usize::from(mean(&sides[1]) < 0.99 * mean(&sides[0]))
}
