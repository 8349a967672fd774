//! Which nodes have all their internal force when a block is done.
//!
//! A node whose elements have all been worked on can move at once, while the caches still hold it: its
//! displacement is needed no more in this step. Nodes that other forces act on are held back until those are
//! known.

use crate::blocks::{Blocks, NONE};
use mesh::Padded;
use std::ops::Range;

/// Nodes held back are worked on in pieces of at most so many; fixed, so that sums over pieces do not depend
/// on the threads.
const PIECE: usize = 4096;

/// Nodal arrays of a step; one entry per node.
#[derive(Debug)]
pub struct NodalFields<'a> {
    /// Displacements (m).
    pub displacement: &'a mut [Padded],
    /// Velocities at the last half step (m/s).
    pub velocity: &'a mut [Padded],
    /// Forces (N).
    pub force: &'a mut [Padded],
}

/// Nodes one after the other that have all their internal force, from node `first` on.
#[derive(Debug)]
pub struct SettledNodes<'a> {
    /// The first of them.
    pub first: usize,
    /// Their reference positions (m).
    pub reference: &'a [Padded],
    /// Their displacements (m).
    pub displacement: &'a mut [Padded],
    /// Their velocities at the last half step (m/s).
    pub velocity: &'a mut [Padded],
    /// Their forces (N).
    pub force: &'a mut [Padded],
}

/// Runs of nodes: those that each block settles, and pieces of those held back. Every node is in at most one
/// run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Settled {
    runs: Vec<Range<u32>>,
    /// Runs of each block: `runs[of_block[b]..of_block[b + 1]]`.
    of_block: Vec<usize>,
    /// Pieces of the nodes held back or without elements: `runs[piece]`, after those of all blocks.
    pieces: Vec<Range<usize>>,
}

impl Settled {
    /// With the marked nodes held back.
    pub(crate) fn new(blocks: &Blocks, held_back: &[bool]) -> Self {
        let last = blocks.last_at_nodes(held_back.len());
        let mut of: Vec<Vec<Range<u32>>> = vec![Vec::new(); blocks.blocks.len() + 1];
        for (node, (&block, &held)) in last.iter().zip(held_back).enumerate() {
            let list = if held || block == NONE { blocks.blocks.len() } else { block as usize };
            let node = node as u32;
            match of[list].last_mut() {
                Some(run) if run.end == node => run.end += 1,
                _ => of[list].push(node..node + 1),
            }
        }
        let rest = of.pop().unwrap_or_default();
        let mut settled = Self { of_block: vec![0], ..Self::default() };
        for runs in of {
            settled.runs.extend(runs);
            settled.of_block.push(settled.runs.len());
        }
        let (mut begin, mut filled) = (settled.runs.len(), 0);
        for run in rest {
            for start in run.clone().step_by(PIECE) {
                let part = start..run.end.min(start + PIECE as u32);
                if filled + part.len() > PIECE {
                    settled.pieces.push(begin..settled.runs.len());
                    (begin, filled) = (settled.runs.len(), 0);
                }
                filled += part.len();
                settled.runs.push(part);
            }
        }
        if filled > 0 {
            settled.pieces.push(begin..settled.runs.len());
        }
        settled
    }

    pub(crate) fn of_block(&self, block: usize) -> &[Range<u32>] {
        &self.runs[self.of_block[block]..self.of_block[block + 1]]
    }

    pub(crate) fn of_piece(&self, piece: usize) -> &[Range<u32>] {
        &self.runs[self.pieces[piece].clone()]
    }

    pub(crate) fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        self.runs.len() * size_of::<Range<u32>>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Element;
    use crate::formulation::Elements;

    #[test]
    fn every_node_is_in_one_run_and_moves_only_when_no_element_needs_it_any_more() {
        let mesh = mesh::block([40, 13, 11], [1.0, 1.0, 1.0]);
        let blocks = Blocks::new(&mesh, &Elements::from(Element { hourglass: 0.05 }));
        assert!(blocks.colours.len() > 1);
        let held_back: Vec<bool> = (0..mesh.nodes.len()).map(|n| n % 5 == 0).collect();
        let settled = Settled::new(&blocks, &held_back);
        let mut moved = vec![false; mesh.nodes.len()];
        let mut take = |runs: &[Range<u32>], held: bool| {
            for n in runs.iter().cloned().flatten() {
                assert_eq!(held_back[n as usize], held);
                assert!(!std::mem::replace(&mut moved[n as usize], true));
            }
        };
        for colour in &blocks.colours {
            for &b in colour {
                take(settled.of_block(b as usize), false);
            }
        }
        (0..settled.pieces()).for_each(|piece| take(settled.of_piece(piece), true));
        assert!(moved.iter().all(|&m| m));

        // blocks that come after the one that moves a node do not touch it, nor do others of its colour
        let mut gone = vec![false; mesh.nodes.len()];
        for colour in &blocks.colours {
            let now: Vec<u32> = colour
                .iter()
                .flat_map(|&b| settled.of_block(b as usize).iter().cloned().flatten())
                .collect();
            for &b in colour {
                let block = &blocks.blocks[b as usize];
                for n in blocks.batches[block.batches.clone()]
                    .iter()
                    .flat_map(|x| x.nodes.as_flattened())
                {
                    assert!(!gone[*n as usize]);
                    let elsewhere = now.contains(n)
                        && !settled.of_block(b as usize).iter().any(|run| run.contains(n));
                    assert!(!elsewhere);
                }
            }
            now.iter().for_each(|&n| gone[n as usize] = true);
        }
    }
}
