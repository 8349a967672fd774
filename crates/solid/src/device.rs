//! The elements as a device takes them: their operations as text, their nodes, and in what order each node receives their
//! forces.

use crate::blocks::{BATCH, Blocks};
use crate::lanes::{Four, Lanes};

/// Elements that the processor's kernels of [`Level::pinned`](crate::Level::pinned) take at a time; their forces reach a node by
/// corners, then by elements.
const PART: usize = Four::N;

/// Elements of one body and one formulation.
#[derive(Clone, Debug)]
pub struct DeviceKind {
    /// The first of them.
    pub first: usize,
    /// How many they are.
    pub count: usize,
    /// Statements in C that compute the forces on their corners: from `n[8]`, their nodes, and `reference`, `displacement` and
    /// `velocity`, of four numbers for each node, to `f[24]`.
    pub text: String,
}

/// All elements.
#[derive(Clone, Debug, Default)]
pub struct DeviceElements {
    /// The kinds, one after the other.
    pub kinds: Vec<DeviceKind>,
    /// Nodes, for each corner those of all elements.
    pub nodes: Vec<u32>,
    /// Where in `places` those of each node begin, and where the last ones end.
    pub begin: Vec<u32>,
    /// Where the forces that a node receives stand in an array of three times the corners, each of all elements, in the order in
    /// which it receives them.
    pub places: Vec<u32>,
}

impl DeviceElements {
    /// Of `blocks` over so many nodes; `text` gives that of a body and formulation.
    ///
    /// # Panics
    /// With more than 178 million elements.
    pub(crate) fn new(blocks: &Blocks, nodes: usize, text: impl Fn(usize, bool) -> String) -> Self {
        let mut elements = Self::default();
        let count: usize = blocks.blocks.iter().map(|block| block.elements).sum();
        let fits = |numbers: usize| u32::try_from(numbers).is_ok();
        assert!(fits(24 * count) && fits(4 * nodes), "a device counts by 32 bits");
        elements.nodes = vec![0; 8 * count];
        let mut first_of = Vec::with_capacity(blocks.blocks.len());
        let (mut next, mut last) = (0, None);
        for block in &blocks.blocks {
            if last != Some((block.body, block.full)) {
                let text = text(block.body, block.full);
                elements.kinds.push(DeviceKind { first: next, count: 0, text });
                last = Some((block.body, block.full));
            }
            first_of.push(next);
            for (b, batch) in blocks.batches[block.batches.clone()].iter().enumerate() {
                for lane in 0..BATCH.min(block.elements - BATCH * b) {
                    for corner in 0..8 {
                        elements.nodes[corner * count + next] = batch.nodes[corner][lane];
                    }
                    next += 1;
                }
            }
            if let Some(kind) = elements.kinds.last_mut() {
                kind.count += block.elements;
            }
        }
        let mut of_node = vec![Vec::new(); nodes];
        for &b in blocks.colours.iter().flatten() {
            let (block, first) = (&blocks.blocks[b as usize], first_of[b as usize]);
            for part in (0..block.elements).step_by(PART) {
                for corner in 0..8 {
                    for element in first + part..first + block.elements.min(part + PART) {
                        let node = elements.nodes[corner * count + element];
                        of_node[node as usize].push((3 * corner * count + element) as u32);
                    }
                }
            }
        }
        elements.begin.push(0);
        for places in of_node {
            elements.places.extend(places);
            elements.begin.push(elements.places.len() as u32);
        }
        elements
    }
}
