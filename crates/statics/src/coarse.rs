//! The coarse level of the preconditioner: clusters of nodes that move as rigid bodies.
//!
//! A two-level additive preconditioner `D^-1 + W A^-1 W^T` with `A = W^T K W` (Nicolaides 1987;
//! rigid bodies for elasticity: Bulgakov 1993, Vanek, Mandel and Brezina 1996). Clusters grow by distance along the
//! edges of the mesh, so that stretched elements are coarsened across their short edges, where
//! their nodes are coupled most.

use crate::cholesky::Factor;
use crate::link::Link;
use crate::space::{CHUNK, Group};
use mesh::{HEX_EDGES, Mesh, Padded};
use nalgebra::Vector3;
use rayon::prelude::*;
use solid::linear::AMPLITUDE;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

/// Least nodes of a full cluster: a larger number makes the coarse level cheaper and the iterations more.
const CLUSTER: usize = 250;

/// Most full clusters: the work of the factor grows with the square of their number.
const MOST: usize = 5000;

/// Clusters smaller than this part of a full one join a neighbour.
const SMALLEST: usize = 3;

/// Part of the slaves that may open or close until the coarse level follows: a preconditioner need only be like the tangent.
const CHANGED: f64 = 0.1;

const NONE: u32 = u32::MAX;
const MODES: usize = 6;
type Block = [[f64; MODES]; MODES];

/// The coarse level.
pub(crate) struct Coarse {
    /// Cluster of each node; none for nodes that are not free.
    cluster: Vec<u32>,
    /// The nodes of all clusters, one after the other, and where each cluster's begin.
    nodes: Vec<u32>,
    begin: Vec<usize>,
    frames: Vec<Frame>,
    /// `W^T K W` in blocks (a, b), `a >= b`; groups of tied nodes come after the clusters and use
    /// the first unknown of their block.
    elastic: BTreeMap<(u32, u32), Block>,
    /// None before the first and where there is none: the coarse level then adds nothing.
    factor: Option<Factor>,
    /// The slaves whose springs are in the factor.
    slaves: BTreeSet<usize>,
    /// Coarse residual, then solution.
    vector: Vec<f64>,
}

/// Origin and size of a cluster: its rotations move nodes by at most about one.
#[derive(Clone, Copy, Debug)]
struct Frame {
    centre: Vector3<f64>,
    per_size: f64,
}

impl Frame {
    /// Arm of a point, in sizes of the cluster.
    #[inline(always)]
    fn arm(&self, x: &Padded) -> Vector3<f64> {
        self.per_size * (x.vector() - self.centre)
    }

    /// Motion `t + w x arm` of a point under `[t, w]`.
    #[inline(always)]
    fn motion(&self, x: &Padded, q: &[f64]) -> Vector3<f64> {
        let [a, b, c] = self.arm(x).into();
        Vector3::new(
            q[0] + q[4] * c - q[5] * b,
            q[1] + q[5] * a - q[3] * c,
            q[2] + q[3] * b - q[4] * a,
        )
    }

    /// Adds the resultant `[f, arm x f]` of a force.
    #[inline(always)]
    fn collect(&self, x: &Padded, f: &Padded, to: &mut [f64]) {
        let moment = self.arm(x).cross(&f.vector());
        for i in 0..3 {
            to[i] += f[i];
            to[3 + i] += moment[i];
        }
    }
}

impl Coarse {
    /// Clusters the free nodes of `mesh`; `product` adds K x to y for x up to [`AMPLITUDE`].
    pub(crate) fn new(
        mesh: &Mesh,
        reference: &[Padded],
        is_free: impl Fn(usize) -> bool,
        groups: &[Group],
        product: impl FnMut(&[Padded], &mut [Padded]),
    ) -> Self {
        let neighbours = edges(mesh);
        let (cluster, count) = clusters(reference, &neighbours, is_free);
        let mut begin = vec![0; count + 1];
        cluster.iter().filter(|&&c| c != NONE).for_each(|&c| begin[c as usize + 1] += 1);
        (0..count).for_each(|c| begin[c + 1] += begin[c]);
        let mut nodes: Vec<u32> =
            (0..cluster.len() as u32).filter(|&n| cluster[n as usize] != NONE).collect();
        nodes.sort_by_key(|&n| (cluster[n as usize], n));
        let frames = (0..count).map(|c| frame(reference, &nodes[begin[c]..begin[c + 1]])).collect();
        let blocks = count + groups.len();
        let mut coarse = Self {
            cluster,
            nodes,
            begin,
            frames,
            elastic: BTreeMap::new(),
            factor: None,
            slaves: BTreeSet::new(),
            vector: vec![0.0; MODES * blocks],
        };
        coarse.probe(mesh, reference, groups, product);
        coarse
    }

    /// `W^T K W` from products with sets of clusters so far apart that no cluster feels two.
    fn probe(
        &mut self,
        mesh: &Mesh,
        reference: &[Padded],
        groups: &[Group],
        mut product: impl FnMut(&[Padded], &mut [Padded]),
    ) {
        let near = self.adjacency(mesh, groups);
        let colours = colours(&near);
        let (mut x, mut y) =
            (vec![Padded::ZERO; reference.len()], vec![Padded::ZERO; reference.len()]);
        for colour in &colours {
            for mode in 0..MODES {
                self.vector.fill(0.0);
                colour.iter().for_each(|&c| self.vector[MODES * c as usize + mode] = AMPLITUDE);
                y.par_iter_mut().for_each(|y| *y = Padded::ZERO);
                self.prolong(reference, groups, &mut x);
                product(&x, &mut y);
                self.restrict(reference, groups, &y);
                for &a in colour {
                    for &b in near[a as usize].range(a..) {
                        let block = self.elastic.entry((b, a)).or_insert([[0.0; MODES]; MODES]);
                        for i in 0..MODES {
                            block[i][mode] = self.vector[MODES * b as usize + i] / AMPLITUDE;
                        }
                    }
                }
            }
        }
    }

    /// Blocks that share an element with each block, itself included.
    fn adjacency(&self, mesh: &Mesh, groups: &[Group]) -> Vec<BTreeSet<u32>> {
        let clusters = self.frames.len();
        let mut groups_at = BTreeMap::<u32, Vec<u32>>::new();
        for (g, group) in groups.iter().enumerate() {
            let block = (clusters + g) as u32;
            group.nodes.iter().for_each(|&n| groups_at.entry(n).or_default().push(block));
        }
        let mut near: Vec<BTreeSet<u32>> =
            (0..(clusters + groups.len()) as u32).map(|c| BTreeSet::from([c])).collect();
        let mut here = Vec::new();
        for hex in &mesh.hexes {
            here.clear();
            for n in hex {
                let c = self.cluster[*n as usize];
                if c != NONE {
                    here.push(c);
                } else if let Some(blocks) = groups_at.get(n) {
                    here.extend(blocks);
                }
            }
            here.sort_unstable();
            here.dedup();
            if here.len() > 1 {
                for &a in &here {
                    near[a as usize].extend(&here);
                }
            }
        }
        near
    }

    /// Factorises `W^T K W` with springs (N/m) along links, unless nearly all slaves are those of the factor that there is.
    pub(crate) fn factorise<'l>(
        &mut self,
        reference: &[Padded],
        springs: impl Iterator<Item = (&'l Link, f64)> + Clone,
    ) {
        let slaves: BTreeSet<usize> = springs.clone().map(|(link, _)| link.slave).collect();
        let changes = slaves.symmetric_difference(&self.slaves).count();
        if self.factor.is_some() && changes as f64 <= CHANGED * slaves.len() as f64 {
            return;
        }
        self.slaves = slaves;
        let mut matrix = self.elastic.clone();
        for (link, k) in springs {
            let mut row = BTreeMap::<u32, [f64; MODES]>::new();
            let projection = link.projection.iter().map(|&(n, w)| (n, -w));
            for (node, weight) in [(link.slave, 1.0)].into_iter().chain(projection) {
                let c = self.cluster[node];
                if c != NONE {
                    let pull = (weight * *link.normal).into();
                    let entry = row.entry(c).or_insert([0.0; MODES]);
                    self.frames[c as usize].collect(&reference[node], &pull, entry);
                }
            }
            for (&b, left) in &row {
                for (&a, right) in row.range(..=b) {
                    let block = matrix.entry((b, a)).or_insert([[0.0; MODES]; MODES]);
                    for i in 0..MODES {
                        for j in 0..MODES {
                            block[i][j] += k * left[i] * right[j];
                        }
                    }
                }
            }
        }
        self.factor = factor(self.vector.len(), &matrix);
    }

    /// `A^-1 W^T r`, whose motions [`motion`](Self::motion) and
    /// [`group_motion`](Self::group_motion) give.
    pub(crate) fn solve(&mut self, reference: &[Padded], groups: &[Group], r: &[Padded]) {
        self.restrict(reference, groups, r);
        match &mut self.factor {
            Some(factor) => factor.solve(&mut self.vector),
            None => self.vector.fill(0.0),
        }
    }

    /// Motion of a node at `x` with its cluster; none if it belongs to none.
    #[inline(always)]
    pub(crate) fn motion(&self, node: usize, x: &Padded) -> Vector3<f64> {
        match self.cluster[node] {
            NONE => Vector3::zeros(),
            c => self.frames[c as usize].motion(x, &self.vector[MODES * c as usize..][..MODES]),
        }
    }

    /// Motion of a group of tied nodes along its axis.
    pub(crate) fn group_motion(&self, group: usize) -> f64 {
        self.vector[MODES * (self.frames.len() + group)]
    }

    /// Resultants of `r` on clusters and groups, to `vector`.
    fn restrict(&mut self, reference: &[Padded], groups: &[Group], r: &[Padded]) {
        let Self { vector, nodes, begin, frames, .. } = self;
        let (clusters, tied) = vector.split_at_mut(MODES * frames.len());
        clusters.par_chunks_mut(MODES).zip(frames.par_iter()).enumerate().for_each(
            |(c, (sum, frame))| {
                sum.fill(0.0);
                for &n in &nodes[begin[c]..begin[c + 1]] {
                    frame.collect(&reference[n as usize], &r[n as usize], sum);
                }
            },
        );
        for (sum, group) in tied.chunks_mut(MODES).zip(groups) {
            sum.fill(0.0);
            sum[0] = group.resultant(r);
        }
    }

    /// The motions `vector` of clusters and groups.
    fn prolong(&self, reference: &[Padded], groups: &[Group], z: &mut [Padded]) {
        z.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, z)| {
            for (i, z) in z.iter_mut().enumerate() {
                let node = CHUNK * chunk + i;
                *z = self.motion(node, &reference[node]).into();
            }
        });
        for (g, group) in groups.iter().enumerate() {
            group.set(self.group_motion(g), z);
        }
    }
}

/// Ends of the element edges at each node.
fn edges(mesh: &Mesh) -> Vec<Vec<u32>> {
    let mut ends = vec![Vec::new(); mesh.nodes.len()];
    for hex in &mesh.hexes {
        for [a, b] in HEX_EDGES {
            ends[hex[a] as usize].push(hex[b]);
            ends[hex[b] as usize].push(hex[a]);
        }
    }
    for ends in &mut ends {
        ends.sort_unstable();
        ends.dedup();
    }
    ends
}

/// Nodes of a full cluster of so many nodes.
fn full_cluster(nodes: usize) -> usize {
    CLUSTER.max(nodes.div_ceil(MOST))
}

/// Cluster of each free node, and how many there are: from the first node left, the nearest along
/// edges until the cluster is full.
fn clusters(
    reference: &[Padded],
    neighbours: &[Vec<u32>],
    is_free: impl Fn(usize) -> bool,
) -> (Vec<u32>, usize) {
    let n = reference.len();
    let full = full_cluster(n);
    let mut cluster = vec![NONE; n];
    let mut members: Vec<Vec<u32>> = Vec::new();
    let mut heap = BinaryHeap::new();
    for seed in 0..n {
        if cluster[seed] != NONE || !is_free(seed) {
            continue;
        }
        let label = members.len() as u32;
        let mut own = Vec::new();
        heap.clear();
        heap.push((Reverse(0u64), Reverse(seed as u32)));
        while let Some((_, Reverse(node))) = heap.pop() {
            let at = node as usize;
            if cluster[at] != NONE {
                continue;
            }
            cluster[at] = label;
            own.push(node);
            if own.len() == full {
                break;
            }
            for &next in &neighbours[at] {
                if cluster[next as usize] == NONE && is_free(next as usize) {
                    let d: f64 = (0..3)
                        .map(|i| (reference[next as usize][i] - reference[seed][i]).powi(2))
                        .sum();
                    // Bits of positive numbers order as the numbers do.
                    heap.push((Reverse(d.to_bits()), Reverse(next)));
                }
            }
        }
        let host = (own.len() < full / SMALLEST).then(|| {
            let around = own.iter().flat_map(|&n| &neighbours[n as usize]);
            around.map(|&n| cluster[n as usize]).find(|&c| c != NONE && c != label)
        });
        if let Some(Some(host)) = host {
            own.iter().for_each(|&n| cluster[n as usize] = host);
            members[host as usize].extend(own);
        } else {
            members.push(own);
        }
    }
    (cluster, members.len())
}

fn frame(reference: &[Padded], nodes: &[u32]) -> Frame {
    let points = || nodes.iter().map(|&n| reference[n as usize].vector());
    let centre: Vector3<f64> = points().map(|x| x / nodes.len() as f64).sum();
    let size = points().map(|x| (x - centre).norm()).fold(0.0, f64::max);
    Frame { centre, per_size: if size > 0.0 { 1.0 / size } else { 0.0 } }
}

/// Sets of blocks of which no two are near a common block, greedily.
fn colours(near: &[BTreeSet<u32>]) -> Vec<Vec<u32>> {
    let mut colour = vec![NONE; near.len()];
    let mut sets: Vec<Vec<u32>> = Vec::new();
    for c in 0..near.len() {
        let taken: BTreeSet<u32> = near[c]
            .iter()
            .flat_map(|&b| &near[b as usize])
            .map(|&b| colour[b as usize])
            .filter(|&k| k != NONE)
            .collect();
        let free = (0..).find(|k| !taken.contains(k)).unwrap_or(0);
        colour[c] = free;
        if free as usize == sets.len() {
            sets.push(Vec::new());
        }
        sets[free as usize].push(c as u32);
    }
    sets
}

/// Factor of a matrix of so many unknowns, given by the blocks (b, a), `b >= a`, of its lower triangle.
fn factor(unknowns: usize, matrix: &BTreeMap<(u32, u32), Block>) -> Option<Factor> {
    let (mut columns, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for column in 0..unknowns as u32 {
        let (b, j) = (column / MODES as u32, column as usize % MODES);
        for ((_, a), block) in matrix.range((b, 0)..=(b, b)) {
            for i in 0..MODES {
                let row = a * MODES as u32 + i as u32;
                if row == column || row < column && block[j][i] != 0.0 {
                    rows.push(row);
                    values.push(block[j][i]);
                }
            }
        }
        columns.push(rows.len() as u32);
    }
    Factor::new(&columns, &rows, values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clusters_grow_with_meshes_above_1_25_million_nodes() {
        assert_eq!([1_000, 1_250_000, 5_000_000].map(full_cluster), [250, 250, 1000]);
    }
}
