//! Pairs of nodes of equal mass that move as one, as those across a slice in plane strain do.
//!
//! The constraint forces that give both one acceleration are equal and opposite, so that each bears the
//! mean of both forces, and do no work.

use mesh::Padded;

/// Gives both nodes of each pair the mean of their forces.
pub(crate) fn share(pairs: &[[u32; 2]], force: &mut [Padded]) {
    for pair in pairs {
        let [a, b] = pair.map(|n| n as usize);
        for i in 0..3 {
            let mean = 0.5 * (force[a][i] + force[b][i]);
            (force[a][i], force[b][i]) = (mean, mean);
        }
    }
}

/// Gives the second node of each pair what the first has.
pub(crate) fn follow(pairs: &[[u32; 2]], field: &mut [Padded]) {
    pairs.iter().for_each(|&[first, second]| field[second as usize] = field[first as usize]);
}
