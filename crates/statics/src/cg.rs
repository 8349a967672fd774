//! Preconditioned conjugate gradients on the admissible displacements, without a matrix.

use crate::link::Link;
use crate::space::{CHUNK, Space};
use mesh::Padded;
use rayon::prelude::*;
use solid::Solid;

/// Largest displacement (m) that the first search direction starts from. The force of the
/// elements stands for K p; it is linear to the strain of p, which stays far below 1e-6, and, formed
/// from displacements alone, as accurate as for large ones.
const AMPLITUDE: f64 = 1e-13;

/// Curvature p.Kp over r.D^-1 r that counts as none: a lower bound of the smallest eigenvalue of
/// D^-1 K, far below what supported bodies have.
const FLAT: f64 = 1e-13;

/// Work vectors of the iteration.
pub(crate) struct Cg {
    z: Vec<Padded>,
    p: Vec<Padded>,
    q: Vec<Padded>,
}

/// What the iteration reached.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Outcome {
    /// The tolerance, after so many iterations.
    Converged(usize),
    /// A direction without stiffness, largest at this node.
    Flat(usize),
    /// The limit of iterations.
    Slow(usize),
}

impl Cg {
    pub(crate) fn new(nodes: usize) -> Self {
        let zero = || vec![Padded::ZERO; nodes];
        Self { z: zero(), p: zero(), q: zero() }
    }

    /// Solves (K + K_springs) x = r on `space`; `r` is the reduced residual and is used up.
    ///
    /// K is the stiffness of the undeformed state. Ends where sqrt(r . D^-1 r) has fallen by
    /// `tolerance`.
    pub(crate) fn solve(
        &mut self,
        solid: &mut Solid,
        space: &mut Space,
        springs: &[(Link, f64)],
        r: &mut [Padded],
        x: &mut [Padded],
        tolerance: f64,
        max_iterations: usize,
    ) -> Outcome {
        let Self { z, p, q } = self;
        x.fill(Padded::ZERO);
        space.slide(r);
        let mut rz = space.precondition(r, z);
        let largest = largest(z);
        if rz == 0.0 || largest == 0.0 {
            return Outcome::Converged(0);
        }
        // The whole system is scaled so that products see small displacements only.
        let small = AMPLITUDE / largest;
        for v in [&mut *r, &mut *z] {
            v.par_chunks_mut(CHUNK).for_each(|v| v.iter_mut().for_each(|v| scale(v, small)));
        }
        rz *= small * small;
        p.copy_from_slice(z);
        let enough = rz * tolerance * tolerance;
        let mut outcome = Outcome::Slow(max_iterations);
        for iteration in 1..=max_iterations {
            q.par_chunks_mut(CHUNK).for_each(|q| q.fill(Padded::ZERO));
            solid.subtract_elastic_force(p, q, false);
            for (link, k) in springs {
                link.push(-k * link.opening(p), q);
            }
            space.reduce(q);
            // q = -T^T K p
            let curvature = -space.inner(p, q);
            let stiff = curvature > FLAT * rz;
            if !stiff {
                outcome = Outcome::Flat(farthest(p));
                break;
            }
            let alpha = rz / curvature;
            x.par_chunks_mut(CHUNK)
                .zip(r.par_chunks_mut(CHUNK))
                .zip(p.par_chunks(CHUNK).zip(q.par_chunks(CHUNK)))
                .for_each(|((x, r), (p, q))| {
                    for ((x, r), (p, q)) in x.iter_mut().zip(r).zip(p.iter().zip(q)) {
                        for i in 0..3 {
                            x[i] += alpha * p[i];
                            r[i] += alpha * q[i];
                        }
                    }
                });
            let before = rz;
            rz = space.precondition(r, z);
            if rz <= enough {
                outcome = Outcome::Converged(iteration);
                break;
            }
            let beta = rz / before;
            p.par_chunks_mut(CHUNK).zip(z.par_chunks(CHUNK)).for_each(|(p, z)| {
                for (p, z) in p.iter_mut().zip(z) {
                    for i in 0..3 {
                        p[i] = z[i] + beta * p[i];
                    }
                }
            });
        }
        let large = 1.0 / small;
        x.par_chunks_mut(CHUNK).for_each(|x| x.iter_mut().for_each(|x| scale(x, large)));
        outcome
    }
}

fn scale(v: &mut Padded, factor: f64) {
    *v = Padded(v.0.map(|c| c * factor));
}

fn largest(v: &[Padded]) -> f64 {
    v.iter().flat_map(|v| v.xyz()).fold(0.0, |m: f64, c| m.max(c.abs()))
}

fn farthest(v: &[Padded]) -> usize {
    let length = |v: &Padded| v.xyz().iter().map(|c| c * c).sum::<f64>();
    (0..v.len()).max_by(|&i, &j| length(&v[i]).total_cmp(&length(&v[j]))).unwrap_or(0)
}
