//! A small disturbance of the preload's displacement, by which the members of an ensemble differ.

use crate::case::schema::Case;
use crate::scenario::draw::{draw, seed};
use crate::scenario::model::Model;
use mesh::Padded;

/// Multiplies each component of the displacement (m) of every node that is neither clamped nor on the hub by
/// 1 + r `preload.disturbance`, r random in [-1, 1). r depends on the seed, the node and the direction alone, so that
/// the number of threads does not matter.
pub fn disturb(case: &Case, model: &Model, displacement: &mut [Padded]) {
    let Some(size) = case.preload.disturbance else { return };
    let seed = seed(case);
    let mut free = vec![true; displacement.len()];
    model.clamped.iter().chain(&model.hub).for_each(|&n| free[n as usize] = false);
    for (node, u) in displacement.iter_mut().enumerate().filter(|(node, _)| free[*node]) {
        for axis in 0..3 {
            u[axis] *= 1.0 + size * draw(seed, 3 * node as u64 + axis as u64);
        }
    }
}
