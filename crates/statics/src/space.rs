//! The displacements that the supports and closed constraints admit, and the preconditioner on
//! them.
//!
//! Vectors are full (one entry per node) but lie in the admissible space: zero where a node is held, without y where it
//! slides, equal on a group of tied nodes, and at constrained slaves moving with their projection along the normal. With
//! `T` the map from the free coordinates to full vectors, conjugate gradients run on `T^T K T`, whose residual `T^T r` is
//! kept in a full vector as well.

use crate::coarse::Coarse;
use crate::link::Link;
use crate::supports::{Axis, Supports};
use mesh::{Mesh, Padded};
use nalgebra::{Matrix3, UnitVector3, Vector3};
use rayon::prelude::*;
use solid::linear::AMPLITUDE;

/// Nodes per parallel chunk; fixed, so that sums do not depend on the number of threads.
pub(crate) const CHUNK: usize = 4096;

/// A symmetric 3x3 matrix: xx yy zz xy yz xz.
type Symmetric = [f64; 6];

/// The admissible displacements of a problem.
pub(crate) struct Space {
    /// Diagonal blocks of the elastic stiffness (N/m); zero at nodes that are not free.
    diagonal: Vec<Symmetric>,
    /// Inverse blocks, those of contact included.
    inverse: Vec<Symmetric>,
    /// Nodes whose inverse holds more than the elastic block.
    touched: Vec<usize>,
    pub(crate) groups: Vec<Group>,
    /// Slaves that follow their projections along the normal.
    pub(crate) links: Vec<Link>,
    /// Nodes that do not move along y, and whether these are all nodes, as in plane strain: slaves and masters then lie in
    /// one plane, and following one another takes none out of it.
    sliding: Vec<u32>,
    all_slide: bool,
    coarse: Coarse,
    reference: Vec<Padded>,
    /// Partial sums, one per chunk.
    partial: Vec<f64>,
}

/// The tied nodes that move together along a loaded axis.
pub(crate) struct Group {
    pub(crate) nodes: Vec<u32>,
    pub(crate) axis: usize,
    pub(crate) load: f64,
    /// Stiffness of moving the group alone (N/m).
    stiffness: f64,
}

impl Group {
    /// Resultant of `force` on the group along its axis (N).
    pub(crate) fn resultant(&self, force: &[Padded]) -> f64 {
        exact_sum::sum(self.nodes.iter().map(|&n| force[n as usize][self.axis]))
    }

    /// Sets the displacement of all its nodes.
    pub(crate) fn set(&self, value: f64, of: &mut [Padded]) {
        self.nodes.iter().for_each(|&n| of[n as usize][self.axis] = value);
    }
}

impl Space {
    /// `blocks` are the diagonal blocks of the elastic stiffness; `product` adds K x to y for
    /// x up to [`AMPLITUDE`].
    pub(crate) fn new(
        mesh: &Mesh,
        reference: &[Padded],
        supports: &Supports,
        blocks: &[Matrix3<f64>],
        mut product: impl FnMut(&[Padded], &mut [Padded]),
    ) -> Self {
        let mut diagonal: Vec<Symmetric> =
            blocks.iter().map(|k| [k.m11, k.m22, k.m33, k.m12, k.m23, k.m13]).collect();
        let tied = supports.tied.iter().flat_map(|t| &t.nodes);
        supports.held.iter().chain(tied).for_each(|&n| diagonal[n as usize] = [0.0; 6]);
        let n = diagonal.len();
        let mut groups = Vec::new();
        for tied in &supports.tied {
            for (axis, motion) in tied.axes.iter().enumerate() {
                let Axis::Loaded(load) = *motion else { continue };
                let mut group = Group { nodes: tied.nodes.clone(), axis, load, stiffness: 0.0 };
                let (mut x, mut y) = (vec![Padded::ZERO; n], vec![Padded::ZERO; n]);
                group.set(AMPLITUDE, &mut x);
                product(&x, &mut y);
                group.stiffness = group.resultant(&y) / AMPLITUDE;
                groups.push(group);
            }
        }
        let inverse = diagonal.iter().map(inverted).collect();
        let is_free = |node: usize| diagonal[node][0] > 0.0;
        // In plane strain every node slides: motion along y is then coupled to nothing.
        let all_slide = supports.sliding.len() == n;
        let slides: &[u32] = if all_slide { &[] } else { &supports.sliding };
        let slide = |x: &mut [Padded]| slides.iter().for_each(|&n| x[n as usize][1] = 0.0);
        let mut slid = vec![Padded::ZERO; n];
        let coarse = Coarse::new(mesh, reference, is_free, &groups, |x, y| {
            slid.copy_from_slice(x);
            slide(&mut slid);
            product(&slid, y);
            slide(y);
        });
        Self {
            sliding: supports.sliding.clone(),
            all_slide,
            coarse,
            reference: reference.to_vec(),
            inverse,
            diagonal,
            touched: Vec::new(),
            groups,
            links: Vec::new(),
            partial: vec![0.0; n.div_ceil(CHUNK)],
        }
    }

    /// Whether a node moves freely along all axes.
    pub(crate) fn is_free(&self, node: usize) -> bool {
        self.diagonal[node][0] > 0.0
    }

    /// Takes normal springs (N/m) into the preconditioner in place of those before.
    pub(crate) fn set_springs(&mut self, springs: &[(Link, f64)]) {
        let mut blocks = Blocks::new(self);
        for (link, k) in springs {
            blocks.add(link.slave, *k, link.normal);
            for &(node, weight) in &link.projection {
                blocks.add(node, k * weight * weight, link.normal);
            }
        }
        blocks.finish();
        let springs = springs.iter().map(|(link, k)| (link, *k));
        self.coarse.factorise(&self.reference, springs);
    }

    /// Ties the slaves of `links` to their projections along the normal, in place of those before. A
    /// slave's normal stiffness goes to its projection.
    pub(crate) fn set_links(&mut self, links: Vec<Link>) {
        let stiffness: Vec<f64> =
            links.iter().map(|l| along(&self.diagonal[l.slave], l.normal)).collect();
        let mut blocks = Blocks::new(self);
        for (link, k) in links.iter().zip(&stiffness) {
            for &(node, weight) in &link.projection {
                blocks.add(node, k * weight * weight, link.normal);
            }
        }
        blocks.finish();
        self.coarse.factorise(&self.reference, links.iter().zip(stiffness));
        self.links = links;
    }

    /// Leaves out what acts or moves along y at nodes that do not move that way.
    pub(crate) fn slide(&self, of: &mut [Padded]) {
        self.sliding.iter().for_each(|&n| of[n as usize][1] = 0.0);
    }

    /// `T^T r`: a linked slave hands its normal force on to its projection.
    pub(crate) fn reduce(&self, r: &mut [Padded]) {
        // before, so that round-off of normals hands on nothing of the supports' reaction
        self.slide(r);
        for link in &self.links {
            let f = link.slave_normal(r);
            link.push(-f, r);
        }
        if !self.all_slide {
            self.slide(r);
        }
    }

    /// `T z`: linked slaves move with their projections along the normal.
    fn follow(&self, z: &mut [Padded]) {
        for link in &self.links {
            let w = link.opening(z);
            link.add(link.slave, -w, z);
        }
    }

    /// `z = T (D^-1 + W A^-1 W^T) r` with the reduced residual `r`; returns `r . z` (N m).
    pub(crate) fn precondition(&mut self, r: &[Padded], z: &mut [Padded]) -> f64 {
        let Self { coarse, reference, groups, inverse, partial, .. } = self;
        coarse.solve(reference, groups, r);
        let coarse = &*coarse;
        let chunks = z.par_chunks_mut(CHUNK).zip(r.par_chunks(CHUNK));
        chunks.zip(inverse.par_chunks(CHUNK).zip(partial.par_iter_mut())).enumerate().for_each(
            |(chunk, ((z, r), (inverse, sum)))| {
                *sum = 0.0;
                for (i, ((z, r), k)) in z.iter_mut().zip(r).zip(inverse).enumerate() {
                    let node = CHUNK * chunk + i;
                    let whole = coarse.motion(node, &reference[node]);
                    *z = (times(k, r.vector()) + whole).into();
                    *sum += product(r, z);
                }
            },
        );
        // A linked slave's residual has no normal part: `T` changes nothing in `r . z`.
        let mut rz = exact_sum::sum(partial.iter().copied());
        for (g, group) in groups.iter().enumerate() {
            let pull = group.resultant(r);
            let value = pull / group.stiffness + coarse.group_motion(g);
            group.set(value, z);
            rz += pull * value;
        }
        // `r` has no part there: `r . z` stays.
        if !self.all_slide {
            self.slide(z);
        }
        self.follow(z);
        self.slide(z);
        rz
    }

    /// Euclidean norm (N) of the reduced residual on the free coordinates.
    pub(crate) fn residual_norm(&mut self, reduced: &[Padded]) -> f64 {
        self.partial
            .par_iter_mut()
            .zip(reduced.par_chunks(CHUNK).zip(self.diagonal.par_chunks(CHUNK)))
            .for_each(|(sum, (r, diagonal))| {
                let free = r.iter().zip(diagonal).filter(|(_, d)| d[0] > 0.0);
                *sum = free.map(|(r, _)| product(r, r)).sum();
            });
        let groups = self.groups.iter().map(|g| g.resultant(reduced).powi(2));
        exact_sum::sum(self.partial.iter().copied().chain(groups)).sqrt()
    }

    /// The free node with the largest residual, and that residual (N); a group counts as its first
    /// node.
    pub(crate) fn worst(&self, reduced: &[Padded]) -> (usize, f64) {
        let free = reduced.iter().enumerate().filter(|&(n, _)| self.is_free(n));
        let nodes = free.map(|(n, r)| (n, product(r, r).sqrt()));
        let groups = self.groups.iter().map(|g| (g.nodes[0] as usize, g.resultant(reduced).abs()));
        nodes.chain(groups).fold((0, 0.0), |worst, this| {
            if this.1 > worst.1 || this.1.is_nan() { this } else { worst }
        })
    }
}

/// Collects additions to diagonal blocks and inverts those that changed.
struct Blocks<'a> {
    space: &'a mut Space,
    sums: std::collections::BTreeMap<usize, Symmetric>,
}

impl<'a> Blocks<'a> {
    fn new(space: &'a mut Space) -> Self {
        for node in std::mem::take(&mut space.touched) {
            space.inverse[node] = inverted(&space.diagonal[node]);
        }
        Self { space, sums: Default::default() }
    }

    /// Adds `k n n^T` at a node that is free.
    fn add(&mut self, node: usize, k: f64, n: UnitVector3<f64>) {
        if self.space.is_free(node) {
            let block = self.sums.entry(node).or_insert(self.space.diagonal[node]);
            let outer =
                [n[0] * n[0], n[1] * n[1], n[2] * n[2], n[0] * n[1], n[1] * n[2], n[0] * n[2]];
            for (b, o) in block.iter_mut().zip(outer) {
                *b += k * o;
            }
        }
    }

    fn finish(self) {
        for (node, block) in self.sums {
            self.space.inverse[node] = inverted(&block);
            self.space.touched.push(node);
        }
    }
}

/// Inverse of a positive definite matrix; zero for the zero matrix.
fn inverted(k: &Symmetric) -> Symmetric {
    let [xx, yy, zz, xy, yz, xz] = *k;
    let cofactors = [
        yy * zz - yz * yz,
        xx * zz - xz * xz,
        xx * yy - xy * xy,
        xz * yz - xy * zz,
        xy * xz - xx * yz,
        xy * yz - yy * xz,
    ];
    let determinant = xx * cofactors[0] + xy * cofactors[3] + xz * cofactors[5];
    if determinant > 0.0 { cofactors.map(|c| c / determinant) } else { [0.0; 6] }
}

/// `n . K n`.
fn along(k: &Symmetric, n: UnitVector3<f64>) -> f64 {
    times(k, *n).dot(&n)
}

#[inline(always)]
fn times(k: &Symmetric, r: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(
        k[0] * r[0] + k[3] * r[1] + k[5] * r[2],
        k[3] * r[0] + k[1] * r[1] + k[4] * r[2],
        k[5] * r[0] + k[4] * r[1] + k[2] * r[2],
    )
}

#[inline(always)]
fn product(a: &Padded, b: &Padded) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
