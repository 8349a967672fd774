//! A fixed partition of the elements for parallel assembly with the same bits on any number of
//! threads.
//!
//! Elements are gathered in batches of eight, of one shape each (module `congruence`) or of any. Batches
//! of a body, in mesh order, are cut into blocks of at most [`BLOCK_ELEMENTS`] elements, and the blocks are coloured so that blocks of one colour share no nodes. Colours run one after
//! the other, blocks of a colour in any order: each node receives its contributions in the order
//! of colours and, within a block, of batches, whatever the number of threads.

use crate::congruence::{Alike, Shape, Turn, batches};
use crate::formulation::Elements;
use mesh::{Mesh, Padded};

/// Largest number of elements in a block of one-point elements: small enough that its nodes stay in
/// the second-level cache and that many threads find work, large enough that starting a block costs
/// nothing.
pub(crate) const BLOCK_ELEMENTS: usize = 512;

/// The same for fully integrated elements, each of which takes about three times as long.
pub(crate) const BLOCK_FULL_ELEMENTS: usize = 128;

/// Elements per batch; the widest vector has as many lanes.
pub(crate) const BATCH: usize = 8;

/// Eight elements, node by node: `offsets[corner][lane]`, in bytes of an array of [`Padded`].
///
/// A batch with fewer elements repeats its last one in the unused lanes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Batch {
    pub(crate) offsets: [[u32; BATCH]; 8],
}

/// Bytes of a node; offsets are multiples of it.
const NODE: usize = size_of::<Padded>();

/// The most nodes whose offsets a batch can hold.
pub(crate) const MOST_NODES: usize = u32::MAX as usize / NODE;

impl Batch {
    /// Nodes of one lane.
    fn hex(&self, lane: usize) -> [u32; 8] {
        self.offsets.map(|corner| corner[lane] / NODE as u32)
    }

    /// Nodes of all lanes.
    fn nodes(&self) -> impl Iterator<Item = usize> {
        self.offsets.as_flattened().iter().map(|&offset| offset as usize / NODE)
    }
}

/// Which kernel a block takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// One-point elements of any shape.
    OnePoint,
    /// One-point elements, those of a batch of one shape.
    Congruent,
    /// The same, turned about y.
    Turned,
    /// Fully integrated elements.
    Full,
}

/// Batches of one kernel, one after the other.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    /// First batch and one past the last.
    pub(crate) batches: std::ops::Range<usize>,
    /// Number of elements, at most eight per batch; only the last batch may be partial.
    pub(crate) elements: usize,
    pub(crate) kind: Kind,
    /// Turn of the first batch among all turns; of turned elements only.
    pub(crate) turns: usize,
}

/// Runs of batches of one body that lie together: what one thread works on at a time.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// First run and one past the last.
    pub(crate) runs: std::ops::Range<usize>,
    /// Index of the body, hence of the material.
    pub(crate) body: usize,
}

/// All batches and the coloured blocks that own them.
#[derive(Clone, Debug)]
pub(crate) struct Blocks {
    pub(crate) batches: Vec<Batch>,
    pub(crate) runs: Vec<Run>,
    pub(crate) blocks: Vec<Block>,
    /// Indices into `blocks`, colour by colour.
    pub(crate) colours: Vec<Vec<u32>>,
    pub(crate) shapes: Vec<Shape>,
    /// Index of the shape of each batch; 0 where its elements share none.
    pub(crate) shape_of: Vec<u32>,
    /// Turns of the batches of turned elements.
    pub(crate) turns: Vec<Turn>,
    /// Batch times eight plus lane of each element.
    place: Vec<u32>,
    /// Whether each element is fully integrated; empty where none is.
    full: Vec<bool>,
}

/// What a batch is to be made of.
enum Members<'a> {
    /// One-point elements of any shape.
    Any(&'a [u32]),
    /// One-point elements of one shape.
    Alike(Alike),
    /// Fully integrated elements.
    Full(&'a [u32]),
}

impl Members<'_> {
    fn elements(&self) -> &[u32] {
        match self {
            Self::Any(list) | Self::Full(list) => list,
            Self::Alike(alike) => &alike.elements,
        }
    }

    fn first(&self) -> u32 {
        self.elements()[0]
    }

    fn kind(&self) -> Kind {
        match self {
            Self::Any(_) => Kind::OnePoint,
            Self::Alike(alike) if alike.turn.is_some() => Kind::Turned,
            Self::Alike(_) => Kind::Congruent,
            Self::Full(_) => Kind::Full,
        }
    }
}

impl Blocks {
    /// Cuts and colours the elements of `mesh`.
    pub(crate) fn new(mesh: &Mesh, elements: &Elements) -> Self {
        let mut all = Self {
            batches: Vec::with_capacity(mesh.hexes.len() / BATCH + 1),
            runs: Vec::new(),
            blocks: Vec::new(),
            colours: Vec::new(),
            shapes: Vec::new(),
            shape_of: Vec::with_capacity(mesh.hexes.len() / BATCH + 1),
            turns: Vec::new(),
            place: vec![0; mesh.hexes.len()],
            full: Vec::new(),
        };
        for (body, part) in mesh.bodies.iter().enumerate() {
            let (full, mut one_point): (Vec<u32>, Vec<u32>) =
                part.hexes.clone().map(|e| e as u32).partition(|&e| elements.is_full(e as usize));
            if !full.is_empty() {
                all.full.resize(mesh.hexes.len(), false);
                full.iter().for_each(|&e| all.full[e as usize] = true);
            }
            let alike = batches(mesh, &mut one_point, &mut all.shapes);
            let mut together: Vec<Members> = alike.into_iter().map(Members::Alike).collect();
            together.extend(one_point.chunks(BATCH).map(Members::Any));
            // what lies together is worked on together, whatever its kernel
            together.sort_by_key(Members::first);
            all.add(mesh, body, &together, BLOCK_ELEMENTS);
            let full: Vec<Members> = full.chunks(BATCH).map(Members::Full).collect();
            all.add(mesh, body, &full, BLOCK_FULL_ELEMENTS);
        }
        all.colours = colour(mesh.nodes.len(), &all);
        all
    }

    /// Cuts batches of a body into blocks of `size` elements.
    fn add(&mut self, mesh: &Mesh, body: usize, list: &[Members<'_>], size: usize) {
        for block in list.chunks(size / BATCH) {
            let first = self.runs.len();
            for members in block {
                let (at, kind) = (self.batches.len(), members.kind());
                let elements = members.elements();
                match self.runs[first..].last_mut() {
                    Some(run) if run.kind == kind && run.elements.is_multiple_of(BATCH) => {
                        run.batches.end += 1;
                        run.elements += elements.len();
                    }
                    _ => self.runs.push(Run {
                        batches: at..at + 1,
                        elements: elements.len(),
                        kind,
                        turns: self.turns.len(),
                    }),
                }
                let mut shape = 0;
                if let Members::Alike(alike) = members {
                    shape = alike.shape;
                    self.turns.extend(alike.turn);
                }
                self.add_batch(mesh, elements, shape);
            }
            self.blocks.push(Block { runs: first..self.runs.len(), body });
        }
    }

    /// The batch of at most eight elements.
    fn add_batch(&mut self, mesh: &Mesh, elements: &[u32], shape: u32) {
        let mut batch = Batch { offsets: [[0; BATCH]; 8] };
        for lane in 0..BATCH {
            let hex = mesh.hexes[elements[lane.min(elements.len() - 1)] as usize];
            for corner in 0..8 {
                batch.offsets[corner][lane] = hex[corner] * NODE as u32;
            }
        }
        for (lane, &element) in elements.iter().enumerate() {
            self.place[element as usize] = (self.batches.len() * BATCH + lane) as u32;
        }
        self.batches.push(batch);
        self.shape_of.push(shape);
    }

    /// Nodes of an element by its index in the mesh.
    pub(crate) fn hex(&self, element: usize) -> [u32; 8] {
        let place = self.place[element] as usize;
        self.batches[place / BATCH].hex(place % BATCH)
    }

    /// Whether an element is fully integrated.
    pub(crate) fn is_full(&self, element: usize) -> bool {
        self.full.get(element).copied().unwrap_or(false)
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.batches)
            + size_of_val(&*self.runs)
            + size_of_val(&*self.shapes)
            + size_of_val(&*self.shape_of)
            + size_of_val(&*self.turns)
            + size_of_val(&*self.place)
            + size_of_val(&*self.full)
    }

    /// Elements that share their gradients with others.
    pub(crate) fn congruent(&self) -> usize {
        let shared = |run: &&Run| matches!(run.kind, Kind::Congruent | Kind::Turned);
        self.runs.iter().filter(shared).map(|run| run.elements).sum()
    }

    /// The batches of a block.
    fn batches_of(&self, block: &Block) -> &[Batch] {
        let runs = &self.runs[block.runs.clone()];
        let ends = runs.first().zip(runs.last());
        ends.map_or(&[], |(first, last)| &self.batches[first.batches.start..last.batches.end])
    }
}

/// Greedy colouring of blocks that share nodes, in order.
fn colour(nodes: usize, all: &Blocks) -> Vec<Vec<u32>> {
    // One bit per colour already present at each node; 64 is far beyond what a 3-D mesh needs,
    // and a block that finds none free opens a colour of its own.
    let mut used = vec![0u64; nodes];
    let mut colours: Vec<Vec<u32>> = Vec::new();
    let mut lonely = Vec::new();
    for (index, block) in all.blocks.iter().enumerate() {
        let own = all.batches_of(block);
        let nodes = || own.iter().flat_map(Batch::nodes);
        let taken = nodes().fold(0u64, |bits, n| bits | used[n]);
        let free = (!taken).trailing_zeros() as usize;
        if free >= 64 {
            lonely.push(vec![index as u32]);
            continue;
        }
        nodes().for_each(|n| used[n] |= 1 << free);
        if free == colours.len() {
            colours.push(Vec::new());
        }
        colours[free].push(index as u32);
    }
    colours.append(&mut lonely);
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
                owned += blocks.runs[block.runs.clone()].iter().map(|r| r.elements).sum::<usize>();
                let own: HashSet<usize> =
                    blocks.batches_of(block).iter().flat_map(Batch::nodes).collect();
                assert!(seen.is_disjoint(&own));
                seen.extend(own);
            }
        }
        assert_eq!(owned, mesh.hexes.len());
        for (e, hex) in mesh.hexes.iter().enumerate() {
            assert_eq!(blocks.hex(e), *hex);
            assert_eq!(blocks.is_full(e), elements.is_full(e));
        }
    }
}
