//! Nodes of equal mass that move as one, as those across a slice in plane strain do: pairs of a first node and another, a group
//! by as many pairs with one first node, one after the other.
//!
//! The constraint forces that give them one acceleration add up to zero, so that each bears the mean of all their forces, and do no
//! work.

use mesh::Padded;

/// Gives the nodes of each group the mean of their forces.
pub(crate) fn share(pairs: &[[u32; 2]], force: &mut [Padded]) {
    for group in pairs.chunk_by(|a, b| a[0] == b[0]) {
        let first = group[0][0] as usize;
        for i in 0..3 {
            let sum =
                group.iter().fold(force[first][i], |sum, pair| sum + force[pair[1] as usize][i]);
            let mean = sum / (group.len() + 1) as f64;
            force[first][i] = mean;
            group.iter().for_each(|pair| force[pair[1] as usize][i] = mean);
        }
    }
}

/// Gives the second node of each pair what the first has.
pub(crate) fn follow(pairs: &[[u32; 2]], field: &mut [Padded]) {
    pairs.iter().for_each(|&[first, second]| field[second as usize] = field[first as usize]);
}

/// A node and those that move with it.
pub(crate) fn group(pairs: &[[u32; 2]], node: u32) -> impl Iterator<Item = u32> + '_ {
    let first = pairs.iter().find(|pair| pair[1] == node).map_or(node, |pair| pair[0]);
    let others = pairs.iter().filter(move |pair| pair[0] == first).map(|pair| pair[1]);
    std::iter::once(first).chain(others)
}
