//! Which process owns which nodes.

use mesh::Padded;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Nodes of a chunk, which one process owns: those with consecutive numbers. What is summed up over the nodes is summed up within a
/// chunk in the order of its nodes, then exactly over the chunks, so that the bits depend neither on threads nor on processes.
pub const CHUNK: usize = 256;

/// How far the weight on a side of a cut may be from its share (dimensionless, of all that is cut).
const TOLERANCE: f64 = 0.02;

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
    /// `parts` of all `weight`: each cut halves the parts, where it runs through the fewest chunks of those that give each side its
    /// weight within two per cent of it all.
    pub fn bisected(reference: &[Padded], weight: &[f64], parts: &[f64]) -> Self {
        let chunks: Vec<Weighed> = reference
            .chunks(CHUNK)
            .zip(weight.chunks(CHUNK))
            .enumerate()
            .map(|(index, (nodes, weight))| {
                let none = [f64::INFINITY, f64::NEG_INFINITY].map(Vector3::repeat);
                let [low, high] = nodes
                    .iter()
                    .map(|x| x.vector())
                    .fold(none, |[low, high], x| [low.inf(&x), high.sup(&x)]);
                Weighed { index, low, high, weight: weight.iter().sum() }
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

/// A chunk of nodes with its box (m).
struct Weighed {
    index: usize,
    low: Vector3<f64>,
    high: Vector3<f64>,
    weight: f64,
}

impl Weighed {
    fn centre(&self, axis: usize) -> f64 {
        0.5 * (self.low[axis] + self.high[axis])
    }
}

/// Gives the chunks to the processes from `first` on.
fn bisect(mut chunks: Vec<Weighed>, parts: &[f64], first: u32, owners: &mut [u32]) {
    if parts.len() <= 1 || chunks.is_empty() {
        chunks.iter().for_each(|chunk| owners[chunk.index] = first);
        return;
    }
    let (left, right) = parts.split_at(parts.len() / 2);
    let share = left.iter().sum::<f64>() / parts.iter().sum::<f64>();
    let cuts = [0, 1, 2].map(|axis| {
        sort(&mut chunks, axis);
        cut(&chunks, axis, share)
    });
    let axis = (1..3).fold(0, |best, axis| if cuts[axis].1 < cuts[best].1 { axis } else { best });
    sort(&mut chunks, axis);
    let rest = chunks.split_off(cuts[axis].0);
    bisect(chunks, left, first, owners);
    bisect(rest, right, first + left.len() as u32, owners);
}

fn sort(chunks: &mut [Weighed], axis: usize) {
    chunks.sort_by(|a, b| a.centre(axis).total_cmp(&b.centre(axis)).then(a.index.cmp(&b.index)));
}

/// Where to cut chunks that are sorted along an axis so that the first part has about this `share` of the weight: as many
/// chunks go there, and the cut runs through so many.
fn cut(chunks: &[Weighed], axis: usize, share: f64) -> (usize, usize) {
    let [mut lows, mut highs]: [Vec<f64>; 2] = [|c: &Weighed| c.low, |c: &Weighed| c.high]
        .map(|of| chunks.iter().map(|c| of(c)[axis]).collect());
    [&mut lows, &mut highs].into_iter().for_each(|ends| ends.sort_by(f64::total_cmp));
    let below = |ends: &[f64], plane: f64| ends.partition_point(|&end| end < plane);
    let all: f64 = chunks.iter().map(|chunk| chunk.weight).sum();
    let mut before = 0.0;
    let places = chunks.iter().enumerate().map(|(place, chunk)| {
        let plane = match place.checked_sub(1) {
            Some(last) => 0.5 * (chunks[last].centre(axis) + chunk.centre(axis)),
            None => f64::NEG_INFINITY,
        };
        let off = (before - share * all).abs() / all;
        before += chunk.weight;
        let through = below(&lows, plane).saturating_sub(below(&highs, plane));
        (place, through, off)
    });
    let places: Vec<_> = places.collect();
    let nearest = places.iter().fold(f64::INFINITY, |nearest, place| nearest.min(place.2));
    let fair = places.iter().filter(|place| place.2 <= nearest.max(TOLERANCE));
    let best = fair.min_by(|a, b| a.1.cmp(&b.1).then(a.2.total_cmp(&b.2)));
    best.map_or((0, 0), |&(place, through, _)| (place, through))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten rods along x of sixteen chunks, each as long as its rod, one rod beside the other along y.
    fn rods() -> Vec<Padded> {
        let node = |i: usize| {
            let (rod, place) = (i / (16 * CHUNK), 7919 * i % (16 * CHUNK));
            Padded::new([place as f64, rod as f64, 0.0])
        };
        (0..10 * 16 * CHUNK).map(node).collect()
    }

    #[test]
    fn each_process_has_its_part_of_the_weight_within_the_tolerance() {
        let reference = rods();
        let weight: Vec<f64> = (0..reference.len()).map(|i| 1.0 + (i % 7) as f64).collect();
        let all: f64 = weight.iter().sum();
        for parts in [&[1.0, 1.0][..], &[1.0, 3.0], &[2.0, 1.0, 1.0], &[1.0; 5]] {
            let partition = Partition::bisected(&reference, &weight, parts);
            let mut of_each = vec![0.0; parts.len()];
            (0..reference.len()).for_each(|n| of_each[partition.owner(n as u32)] += weight[n]);
            let wanted = |part: f64| all * part / parts.iter().sum::<f64>();
            // each part is left by at most three cuts
            for (found, part) in of_each.iter().zip(parts) {
                assert!((found - wanted(*part)).abs() <= 3.0 * TOLERANCE * all, "{of_each:?}");
            }
        }
    }

    #[test]
    fn a_cut_goes_between_chunks_where_it_can() {
        let reference = rods();
        let halves = Partition::bisected(&reference, &vec![1.0; reference.len()], &[1.0, 1.0]);
        // five rods each, though the rods are longer than all are wide
        for (rod, nodes) in halves.owners.chunks(16).enumerate() {
            assert!(nodes.iter().all(|&owner| owner == u32::from(rod >= 5)), "{:?}", halves.owners);
        }
    }
}
