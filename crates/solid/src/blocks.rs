//! A fixed partition of the elements for parallel assembly with the same bits on any number of
//! threads.
//!
//! Elements are cut, in mesh order, into blocks of at most [`BLOCK_ELEMENTS`] of one body, and
//! the blocks are coloured so that blocks of one colour share no nodes. Colours run one after
//! the other, blocks of a colour in any order: each node receives its contributions in the order
//! of colours and, within a block, of elements, whatever the number of threads.

use mesh::Mesh;

/// Largest number of elements in a block: small enough that its nodes stay in the second-level
/// cache and that many threads find work, large enough that starting a block costs nothing.
pub(crate) const BLOCK_ELEMENTS: usize = 512;

/// Elements per batch; the widest vector has as many lanes.
pub(crate) const BATCH: usize = 8;

/// Eight elements, node by node: `nodes[corner][lane]`.
///
/// A batch with fewer elements repeats its last one in the unused lanes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Batch {
    pub(crate) nodes: [[u32; BATCH]; 8],
}

/// A run of batches of one body.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// First batch and one past the last.
    pub(crate) batches: std::ops::Range<usize>,
    /// Number of elements, at most eight per batch; only the last batch may be partial.
    pub(crate) elements: usize,
    /// Index of the body, hence of the material.
    pub(crate) body: usize,
}

/// All batches and the coloured blocks that own them.
#[derive(Clone, Debug)]
pub(crate) struct Blocks {
    pub(crate) batches: Vec<Batch>,
    pub(crate) blocks: Vec<Block>,
    /// Indices into `blocks`, colour by colour.
    pub(crate) colours: Vec<Vec<u32>>,
    /// First element and first batch of each body.
    starts: Vec<(usize, usize)>,
}

impl Blocks {
    /// Cuts and colours the elements of `mesh`.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let mut batches = Vec::with_capacity(mesh.hexes.len() / BATCH + 1);
        let mut blocks = Vec::new();
        let mut ranges = Vec::new();
        let mut starts = Vec::new();
        for (body, part) in mesh.bodies.iter().enumerate() {
            let mut start = part.hexes.start;
            starts.push((start, batches.len()));
            while start < part.hexes.end {
                let end = (start + BLOCK_ELEMENTS).min(part.hexes.end);
                let first = batches.len();
                for chunk in mesh.hexes[start..end].chunks(BATCH) {
                    let mut batch = Batch { nodes: [[0; BATCH]; 8] };
                    for lane in 0..BATCH {
                        let hex = chunk[lane.min(chunk.len() - 1)];
                        for corner in 0..8 {
                            batch.nodes[corner][lane] = hex[corner];
                        }
                    }
                    batches.push(batch);
                }
                blocks.push(Block { batches: first..batches.len(), elements: end - start, body });
                ranges.push(start..end);
                start = end;
            }
        }
        let colours = colour(mesh, &ranges);
        Self { batches, blocks, colours, starts }
    }

    /// Nodes of an element. Blocks hold a multiple of eight elements but for the last of a body,
    /// so a body's batches are full but for the last.
    pub(crate) fn hex(&self, body: usize, element: usize) -> [u32; 8] {
        let (first, batch) = self.starts[body];
        let local = element - first;
        let nodes = &self.batches[batch + local / BATCH].nodes;
        nodes.map(|corner| corner[local % BATCH])
    }
}

/// Greedy colouring of element ranges that share nodes, in order.
fn colour(mesh: &Mesh, ranges: &[std::ops::Range<usize>]) -> Vec<Vec<u32>> {
    // One bit per colour already present at each node; 64 is far beyond what a 3-D mesh needs,
    // and a block that finds none free opens a colour of its own.
    let mut used = vec![0u64; mesh.nodes.len()];
    let mut colours: Vec<Vec<u32>> = Vec::new();
    let mut lonely = Vec::new();
    for (block, range) in ranges.iter().enumerate() {
        let nodes = || mesh.hexes[range.clone()].iter().flatten().map(|&n| n as usize);
        let taken = nodes().fold(0u64, |bits, n| bits | used[n]);
        let free = (!taken).trailing_zeros() as usize;
        if free >= 64 {
            lonely.push(vec![block as u32]);
            continue;
        }
        nodes().for_each(|n| used[n] |= 1 << free);
        if free == colours.len() {
            colours.push(Vec::new());
        }
        colours[free].push(block as u32);
    }
    colours.append(&mut lonely);
    colours
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn blocks_of_one_colour_share_no_nodes_and_every_element_is_owned_once() {
        let mesh = mesh::block([17, 13, 11], [1.0, 1.0, 1.0]);
        let blocks = Blocks::new(&mesh);
        let mut owned = 0;
        for colour in &blocks.colours {
            let mut seen = HashSet::new();
            for &b in colour {
                let block = &blocks.blocks[b as usize];
                owned += block.elements;
                let own: HashSet<u32> = blocks.batches[block.batches.clone()]
                    .iter()
                    .flat_map(|batch| batch.nodes.iter().flatten().copied())
                    .collect();
                assert!(seen.is_disjoint(&own));
                seen.extend(own);
            }
        }
        assert_eq!(owned, mesh.hexes.len());
        for (e, hex) in mesh.hexes.iter().enumerate() {
            assert_eq!(blocks.hex(0, e), *hex);
        }
    }
}
