//! Nested dissection of a mesh graph by planes (George 1973): the elimination order that keeps the
//! Cholesky factor of a three-dimensional body small.

use nalgebra::Vector3;

/// Parts of at most this many vertices are not divided further.
const LEAF: usize = 24;

/// A part is divided no further from its middle than this fraction of its vertices.
const BALANCE: f64 = 0.2;

/// An undirected graph: the neighbours of each vertex, ascending, itself left out.
pub(crate) struct Graph {
    start: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Graph {
    /// The graph in which the vertices of each clique (an element's nodes) are neighbours.
    pub fn of_cliques(vertices: usize, cliques: impl Iterator<Item = [u32; 8]> + Clone) -> Self {
        const NO_VERTEX: u32 = u32::MAX;
        let mut start = vec![0; vertices + 1];
        let pairs = |c: [u32; 8]| {
            (0..64)
                .map(move |k| (c[k / 8], c[k % 8]))
                .filter(|&(a, b)| a != b && a != NO_VERTEX && b != NO_VERTEX)
        };
        for clique in cliques.clone() {
            pairs(clique).for_each(|(a, _)| start[a as usize + 1] += 1);
        }
        for v in 0..vertices {
            start[v + 1] += start[v];
        }
        let mut next = start.clone();
        let mut all = vec![0; start[vertices]];
        for clique in cliques {
            for (a, b) in pairs(clique) {
                all[next[a as usize]] = b;
                next[a as usize] += 1;
            }
        }
        let mut graph = Self { start: vec![0], neighbours: Vec::new() };
        for v in 0..vertices {
            let row = &mut all[start[v]..start[v + 1]];
            row.sort_unstable();
            for (i, &n) in row.iter().enumerate() {
                if i == 0 || row[i - 1] != n {
                    graph.neighbours.push(n);
                }
            }
            graph.start.push(graph.neighbours.len());
        }
        graph
    }

    pub fn neighbours(&self, vertex: u32) -> &[u32] {
        &self.neighbours[self.start[vertex as usize]..self.start[vertex as usize + 1]]
    }
}

/// Elimination order of the vertices in `part`, which lie at the points `at`.
///
/// Each part is divided by the coordinate plane near its middle that needs the fewest separating
/// vertices; both halves come before their separator. Vertices of equal coordinate are ordered by index, so that the
/// order depends on the input alone.
pub(crate) fn nested_dissection(graph: &Graph, at: &[Vector3<f64>], part: Vec<u32>) -> Vec<u32> {
    let mut order = Vec::with_capacity(part.len());
    let mut halves = Halves { of: vec![0; at.len()], stamp: 0 };
    dissect(graph, at, part, &mut halves, &mut order);
    order
}

/// The half of the current cut in which each vertex lies: `stamp` the lower, `stamp + 1` the upper; any other number
/// is left from an earlier cut and means neither. A new stamp saves clearing the list.
struct Halves {
    of: Vec<u32>,
    stamp: u32,
}

/// Appends the elimination order of `part` to `order`.
fn dissect(
    graph: &Graph,
    at: &[Vector3<f64>],
    part: Vec<u32>,
    halves: &mut Halves,
    order: &mut Vec<u32>,
) {
    if part.len() <= LEAF {
        order.extend(part);
        return;
    }
    let mut best: Option<[Vec<u32>; 3]> = None;
    for axis in 0..3 {
        let cut = cut(graph, at, &part, axis, halves);
        if best.as_ref().is_none_or(|b| cut[2].len() < b[2].len()) {
            best = Some(cut);
        }
    }
    let Some([first, second, separator]) = best else { return };
    if first.is_empty() && second.is_empty() {
        order.extend(separator);
        return;
    }
    drop(part);
    dissect(graph, at, first, halves, order);
    dissect(graph, at, second, halves, order);
    order.extend(separator);
}

/// The two halves and the separator of a cut across `axis`. The half from which the separator is taken comes first.
fn cut(
    graph: &Graph,
    at: &[Vector3<f64>],
    part: &[u32],
    axis: usize,
    halves: &mut Halves,
) -> [Vec<u32>; 3] {
    let mut sorted = part.to_vec();
    let key = |v: u32| at[v as usize][axis];
    sorted.sort_unstable_by(|&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
    let middle = between_planes(&sorted, key);
    halves.stamp += 2;
    let (low, high) = (halves.stamp, halves.stamp + 1);
    for (i, &v) in sorted.iter().enumerate() {
        halves.of[v as usize] = if i < middle { low } else { high };
    }
    let touches =
        |v: u32, other: u32| graph.neighbours(v).iter().any(|&n| halves.of[n as usize] == other);
    let border = |side: &[u32], other| side.iter().filter(|&&v| touches(v, other)).count();
    let (lower, upper) = sorted.split_at(middle);
    let (kept, divided, other) = if border(lower, high) <= border(upper, low) {
        (upper, lower, high)
    } else {
        (lower, upper, low)
    };
    let (separator, rest) = divided.iter().partition(|&&v| touches(v, other));
    [rest, kept.to_vec(), separator]
}

/// Index at which a sorted part is divided: the change of coordinate nearest to its middle, so that the
/// vertices of one plane of a grid stay together, or the middle if there is none within [`BALANCE`].
fn between_planes(sorted: &[u32], key: impl Fn(u32) -> f64) -> usize {
    let n = sorted.len();
    let extent = key(sorted[n - 1]) - key(sorted[0]);
    let changes = |i: usize| key(sorted[i]) - key(sorted[i - 1]) > 1e-9 * extent;
    let middle = n / 2;
    let reach = (BALANCE * n as f64) as usize;
    (0..=reach)
        .flat_map(|d| [middle - d, middle + d])
        .find(|&i| i > 0 && i < n && changes(i))
        .unwrap_or(middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_vertex_comes_once_and_no_half_touches_the_other() {
        let mesh = mesh::block([9, 7, 5], [9.0, 7.0, 5.0]);
        let graph = Graph::of_cliques(mesh.nodes.len(), mesh.hexes.iter().copied());
        let part: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
        let mut halves = Halves { of: vec![0; part.len()], stamp: 0 };
        let [lower, upper, separator] = cut(&graph, &mesh.nodes, &part, 0, &mut halves);
        assert_eq!(separator.len(), 8 * 6, "one plane of the grid");
        for &v in &lower {
            assert!(graph.neighbours(v).iter().all(|n| !upper.contains(n)));
        }
        let mut order = nested_dissection(&graph, &mesh.nodes, part.clone());
        order.sort_unstable();
        assert_eq!(order, part);
    }
}
