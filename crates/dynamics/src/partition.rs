//! Which process owns which nodes.

use mesh::Padded;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Nodes of a chunk, which one process owns: those with consecutive numbers. What is summed up over the nodes is summed up within a
/// chunk in the order of its nodes, then exactly over the chunks, so that the bits depend neither on threads nor on processes.
pub const CHUNK: usize = 128;

/// The owner of each chunk of nodes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Partition {
    /// By chunk.
    pub(crate) owners: Vec<u32>,
}

impl Partition {
    /// The partition with these owners, chunk by chunk.
    pub fn new(owners: Vec<u32>) -> Self {
        Self { owners }
    }

    /// Recursive coordinate bisection (Berger and Bokhari 1987) of the chunks of nodes at `reference` (m) into parts of the shares
    /// `parts` of all `weight`: each cut halves the parts, across the longest edge of the box of the chunks' centres.
    pub fn bisected(reference: &[Padded], weight: &[f64], parts: &[f64]) -> Self {
        let chunks: Vec<Weighed> = reference
            .chunks(CHUNK)
            .zip(weight.chunks(CHUNK))
            .enumerate()
            .map(|(index, (nodes, weight))| Weighed {
                index,
                centre: nodes.iter().map(|x| x.vector()).sum::<Vector3<f64>>() / nodes.len() as f64,
                weight: weight.iter().sum(),
            })
            .collect();
        let mut owners = vec![0; chunks.len()];
        bisect(chunks, parts, 0, &mut owners);
        Self { owners }
    }

    /// The process that owns a node.
    pub fn owner(&self, node: u32) -> usize {
        self.owners[node as usize / CHUNK] as usize
    }
}

/// A chunk of nodes with the mean of their positions (m).
struct Weighed {
    index: usize,
    centre: Vector3<f64>,
    weight: f64,
}

/// Gives the chunks to the processes from `first` on.
fn bisect(mut chunks: Vec<Weighed>, parts: &[f64], first: u32, owners: &mut [u32]) {
    if parts.len() <= 1 {
        chunks.iter().for_each(|chunk| owners[chunk.index] = first);
        return;
    }
    let (left, right) = parts.split_at(parts.len() / 2);
    let low = chunks.iter().fold(Vector3::repeat(f64::INFINITY), |low, c| low.inf(&c.centre));
    let high =
        chunks.iter().fold(Vector3::repeat(f64::NEG_INFINITY), |high, c| high.sup(&c.centre));
    let axis = (high - low).imax();
    chunks.sort_by(|a, b| a.centre[axis].total_cmp(&b.centre[axis]).then(a.index.cmp(&b.index)));
    let all: f64 = chunks.iter().map(|chunk| chunk.weight).sum();
    let share = left.iter().sum::<f64>() / parts.iter().sum::<f64>();
    let mut below = 0.0;
    let cut = chunks.iter().take_while(|chunk| {
        below += chunk.weight;
        below <= share * all
    });
    let cut = cut.count();
    let rest = chunks.split_off(cut);
    bisect(chunks, left, first, owners);
    bisect(rest, right, first + left.len() as u32, owners);
}
