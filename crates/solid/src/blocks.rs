//! A fixed partition of the elements for parallel assembly with the same bits on any number of
//! threads.
//!
//! Elements are cut, in mesh order, into blocks of one body and one formulation. Blocks are coloured so that those
//! of one colour share no nodes. Colours run one after the other, blocks of a colour in any order: each node
//! receives its contributions in the order of colours and, within a block, of elements, whatever the number of
//! threads.

use crate::formulation::Elements;
use mesh::Mesh;
use std::ops::Range;

/// Number of blocks into which a body's one-point elements are cut, within the bounds of [`BLOCK_ELEMENTS`]: enough
/// for the threads of a large machine in two or three colours. More blocks would be smaller and have more nodes
/// in common, and each node is loaded once per block.
const BLOCKS: usize = 64;

/// Least and largest number of elements in a block of one-point elements. A smaller block costs more to start than
/// to compute; a larger one gains nothing more.
const BLOCK_ELEMENTS: [usize; 2] = [512, 16384];

/// A fully integrated element takes about as long as this many one-point elements.
pub const FULL_COST: usize = 4;

/// Elements per block for the `elements` of one body and formulation; a multiple of [`BATCH`].
fn block_size(elements: usize, full: bool) -> usize {
    let [least, most] = BLOCK_ELEMENTS;
    let size = elements.div_ceil(BLOCKS).next_multiple_of(FULL_COST * BATCH).clamp(least, most);
    if full { size / FULL_COST } else { size }
}

/// Elements per batch: the number of lanes of the widest vector.
pub(crate) const BATCH: usize = 8;

/// The nodes of eight elements: `nodes[corner][lane]`, one lane per element.
///
/// A batch with fewer elements repeats its last one in the unused lanes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Batch {
    pub(crate) nodes: [[u32; BATCH]; 8],
}

/// Batches whose energies are added up one after the other; the sums of the groups are added up exactly.
const GROUP: usize = 8;

/// Consecutive batches of one body and one formulation.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Indices in [`Blocks::batches`].
    pub(crate) batches: Range<usize>,
    /// Number of elements, at most eight per batch; only the last batch may be partial.
    pub(crate) elements: usize,
    /// Index of the body, hence of the material.
    pub(crate) body: usize,
    /// Whether its elements are fully integrated.
    pub(crate) full: bool,
}

/// Batches of a block that are computed together.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Indices in [`Blocks::batches`].
    pub(crate) batches: Range<usize>,
    /// Number of elements, at most eight per batch; only the last batch may be partial.
    pub(crate) elements: usize,
    /// Whether it is a whole group, the energies of which are counted.
    pub(crate) counts: bool,
}

/// The part of the elements that is computed, block by block; colours and the order within a block stay, so that
/// a node whose elements are all computed receives its contributions in the order of the whole.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pieces {
    pub(crate) all: Vec<Piece>,
    /// Indices in `all` of the pieces of each block.
    pub(crate) of_block: Vec<Range<usize>>,
}

impl Pieces {
    /// Of `blocks`, the groups whose first element `counts`, and of the others the batches that are `needed`.
    pub(crate) fn new(
        blocks: &Blocks,
        counts: impl Fn(&Batch) -> bool,
        needed: impl Fn(&Batch) -> bool,
    ) -> Self {
        let mut pieces = Self::default();
        for block in &blocks.blocks {
            let before = pieces.all.len();
            let (first, end) = (block.batches.start, block.batches.end);
            let piece = |batches: Range<usize>, counts| {
                let elements = block.elements.min(BATCH * (batches.end - first));
                Piece { elements: elements - BATCH * (batches.start - first), batches, counts }
            };
            for group in (first..end).step_by(GROUP) {
                let group = group..end.min(group + GROUP);
                if counts(&blocks.batches[group.start]) {
                    pieces.all.push(piece(group, true));
                    continue;
                }
                for batch in group.filter(|&b| needed(&blocks.batches[b])) {
                    match pieces.all[before..].last_mut() {
                        Some(last) if !last.counts && last.batches.end == batch => {
                            *last = piece(last.batches.start..batch + 1, false);
                        }
                        _ => pieces.all.push(piece(batch..batch + 1, false)),
                    }
                }
            }
            pieces.of_block.push(before..pieces.all.len());
        }
        pieces
    }
}

/// All batches and the coloured blocks that own them.
#[derive(Clone, Debug)]
pub(crate) struct Blocks {
    pub(crate) batches: Vec<Batch>,
    pub(crate) blocks: Vec<Block>,
    /// Indices into `blocks`, colour by colour.
    pub(crate) colours: Vec<Vec<u32>>,
    /// Where the elements of each body are.
    bodies: Vec<Places>,
}

/// Where the elements of a body are: first its one-point elements fill batches in mesh order, then its fully
/// integrated ones.
#[derive(Clone, Debug)]
struct Places {
    /// Index of the body's first element in the mesh.
    first: usize,
    /// Fully integrated elements of the body, ascending.
    full: Vec<u32>,
    /// First batch of the one-point and of the fully integrated elements.
    batches: [usize; 2],
}

impl Blocks {
    /// Cuts and colours the elements of `mesh`.
    pub(crate) fn new(mesh: &Mesh, elements: &Elements) -> Self {
        let mut batches = Vec::with_capacity(mesh.hexes.len() / BATCH + 1);
        let mut blocks = Vec::new();
        let mut bodies = Vec::new();
        for (body, part) in mesh.bodies.iter().enumerate() {
            let (full, one_point): (Vec<u32>, Vec<u32>) =
                part.hexes.clone().map(|e| e as u32).partition(|&e| elements.is_full(e as usize));
            let mut places = Places { first: part.hexes.start, full, batches: [0; 2] };
            for (list, full) in [(&one_point, false), (&places.full, true)] {
                let size = block_size(list.len(), full);
                places.batches[usize::from(full)] = batches.len();
                for elements in list.chunks(size) {
                    let first = batches.len();
                    batches.extend(elements.chunks(BATCH).map(|chunk| batch(mesh, chunk)));
                    let batches = first..batches.len();
                    blocks.push(Block { batches, elements: elements.len(), body, full });
                }
            }
            bodies.push(places);
        }
        let colours = colour(mesh.nodes.len(), &batches, &blocks);
        Self { batches, blocks, colours, bodies }
    }

    /// Batch and lane of an element, and whether it is fully integrated. All blocks of one body and formulation but
    /// the last hold a multiple of eight elements, so that only their last batch may be partial.
    pub(crate) fn place(&self, body: usize, element: usize) -> (&Batch, usize, bool) {
        let places = &self.bodies[body];
        let (full, slot) = match places.full.binary_search(&(element as u32)) {
            Ok(slot) => (true, slot),
            Err(before) => (false, element - places.first - before),
        };
        (&self.batches[places.batches[usize::from(full)] + slot / BATCH], slot % BATCH, full)
    }

    /// Nodes of an element.
    pub(crate) fn hex(&self, body: usize, element: usize) -> [u32; 8] {
        let (batch, lane, _) = self.place(body, element);
        batch.nodes.map(|corner| corner[lane])
    }

    /// Whether an element is fully integrated.
    pub(crate) fn is_full(&self, body: usize, element: usize) -> bool {
        self.place(body, element).2
    }
}

/// The batch of at most eight elements.
fn batch(mesh: &Mesh, elements: &[u32]) -> Batch {
    let mut batch = Batch { nodes: [[0; BATCH]; 8] };
    for lane in 0..BATCH {
        let hex = mesh.hexes[elements[lane.min(elements.len() - 1)] as usize];
        for corner in 0..8 {
            batch.nodes[corner][lane] = hex[corner];
        }
    }
    batch
}

/// Greedy colouring of blocks that share nodes, in order.
fn colour(nodes: usize, batches: &[Batch], blocks: &[Block]) -> Vec<Vec<u32>> {
    // One bit per colour already present at each node. 64 colours are far more than a 3-D mesh needs; a block that
    // finds none of them free gets a colour of its own.
    let mut used = vec![0u64; nodes];
    let mut colours: Vec<Vec<u32>> = Vec::new();
    let mut alone = Vec::new();
    for (index, block) in blocks.iter().enumerate() {
        let own = &batches[block.batches.clone()];
        let nodes = || own.iter().flat_map(|b| b.nodes.as_flattened()).map(|&n| n as usize);
        let taken = nodes().fold(0u64, |bits, n| bits | used[n]);
        let free = (!taken).trailing_zeros() as usize;
        if free >= 64 {
            alone.push(vec![index as u32]);
            continue;
        }
        nodes().for_each(|n| used[n] |= 1 << free);
        if free == colours.len() {
            colours.push(Vec::new());
        }
        colours[free].push(index as u32);
    }
    colours.append(&mut alone);
    colours
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{Element, Volumetric};
    use std::collections::HashSet;

    #[test]
    fn blocks_of_one_colour_share_no_nodes_and_every_element_is_owned_once() {
        let mesh = mesh::block([17, 13, 11], [1.0, 1.0, 1.0]);
        let some: Vec<bool> = (0..mesh.hexes.len()).map(|e| e % 7 == 3 || e > 2100).collect();
        let one_point = Element { hourglass: 0.05 };
        for elements in [
            Elements::from(one_point),
            Elements::from(Volumetric::Mean),
            Elements::mixed(one_point, &some, Volumetric::Mean),
        ] {
            check(&mesh, &elements);
        }
    }

    fn check(mesh: &Mesh, elements: &Elements) {
        let blocks = Blocks::new(mesh, elements);
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
            assert_eq!(blocks.is_full(0, e), elements.is_full(e));
        }
    }
}
