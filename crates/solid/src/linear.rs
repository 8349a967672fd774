//! Linear systems with the stiffness K of undeformed bodies: products by small motions, and conjugate gradients.
//!
//! The force of the elements under a small motion p stands for -K p. It is formed from displacements and not from deformed
//! positions, so that it is as accurate for small motions as for large ones.

use exact_sum::ExactSum;
use mesh::Padded;
use rayon::prelude::*;

/// Largest displacement (m) of a small motion. Strains are then about 1e-10 in millimetre elements: the elements' force
/// is linear to 1e-10.
pub const AMPLITUDE: f64 = 1e-13;

/// The power of two, which rounds nothing, that makes of a motion of `largest` (m) one below [`AMPLITUDE`] and above its
/// half.
pub fn small(largest: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    f64::from_bits((AMPLITUDE / largest).to_bits() & EXPONENT)
}

/// Nodes per parallel chunk, on any number of threads.
const CHUNK: usize = 4096;

/// Curvature p.Ap over r.M^-1 r that counts as none: a lower bound of the smallest eigenvalue of M^-1 A, far below what
/// supported bodies have.
const FLAT: f64 = 1e-13;

/// `a . b`, whose bits do not depend on the number of threads.
pub fn inner(a: &[Padded], b: &[Padded]) -> f64 {
    let dot = |a: &Padded, b: &Padded| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let chunks = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK));
    let of_chunk = |mut sum: ExactSum, (a, b): (&[Padded], &[Padded])| {
        sum.add(a.iter().zip(b).map(|(a, b)| dot(a, b)).sum());
        sum
    };
    let merged = |mut sum: ExactSum, other| {
        sum.merge(other);
        sum
    };
    chunks.fold(|| ExactSum::ZERO, of_chunk).reduce(|| ExactSum::ZERO, merged).value()
}

/// A motion, or a force.
pub trait Vector: Clone {
    /// Sets all components to zero.
    fn set_zero(&mut self);
    /// `self *= s`.
    fn scale(&mut self, s: f64);
    /// `self += s other`.
    fn add(&mut self, s: f64, other: &Self);
    /// `self = other + s self`.
    fn follow(&mut self, other: &Self, s: f64);
    /// `self . other`.
    fn inner(&self, other: &Self) -> f64;
    /// The largest magnitude of the components.
    fn largest(&self) -> f64;
}

impl Vector for Vec<Padded> {
    fn set_zero(&mut self) {
        self.par_chunks_mut(CHUNK).for_each(|v| v.fill(Padded::ZERO));
    }

    fn scale(&mut self, s: f64) {
        self.par_chunks_mut(CHUNK)
            .for_each(|v| v.iter_mut().for_each(|v| *v = Padded(v.0.map(|c| s * c))));
    }

    fn add(&mut self, s: f64, other: &Self) {
        self.par_chunks_mut(CHUNK).zip(other.par_chunks(CHUNK)).for_each(|(a, b)| {
            for (a, b) in a.iter_mut().zip(b) {
                for i in 0..3 {
                    a[i] += s * b[i];
                }
            }
        });
    }

    fn follow(&mut self, other: &Self, s: f64) {
        self.par_chunks_mut(CHUNK).zip(other.par_chunks(CHUNK)).for_each(|(a, b)| {
            for (a, b) in a.iter_mut().zip(b) {
                for i in 0..3 {
                    a[i] = b[i] + s * a[i];
                }
            }
        });
    }

    fn inner(&self, other: &Self) -> f64 {
        inner(self, other)
    }

    fn largest(&self) -> f64 {
        self.iter().flat_map(|v| v.xyz()).fold(0.0, |m: f64, c| m.max(c.abs()))
    }
}

/// A symmetric positive definite matrix A, and M that is like it but easily inverted.
pub trait LinearSystem<V> {
    /// `q = -A p`, the force that answers the motion `p`; `p` may be used on the way, and is restored.
    fn answer(&mut self, p: &mut V, q: &mut V);

    /// `z = M^-1 r`; returns `r . z`.
    fn precondition(&mut self, r: &V, z: &mut V) -> f64;
}

/// What conjugate gradients reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The tolerance.
    Converged,
    /// A direction without stiffness.
    Flat,
    /// Nothing: the right side is no number.
    NotANumber,
    /// The limit of products.
    Slow,
}

/// Preconditioned conjugate gradients (Hestenes and Stiefel 1952), with their work vectors.
#[derive(Clone, Debug)]
pub struct ConjugateGradients<V> {
    z: V,
    p: V,
    q: V,
}

impl<V: Vector> ConjugateGradients<V> {
    /// For vectors of the size of `like`.
    pub fn new(like: &V) -> Self {
        let [z, p, q] = [0; 3].map(|_| like.clone());
        Self { z, p, q }
    }

    /// Solves `A x = r`; `r` is used up. Ends where `sqrt(r . M^-1 r)` has fallen by `tolerance`, or after `most` products;
    /// returns how many there were.
    pub fn solve(
        &mut self,
        system: &mut impl LinearSystem<V>,
        r: &mut V,
        x: &mut V,
        tolerance: f64,
        most: usize,
    ) -> (Outcome, usize) {
        let Self { z, p, q } = self;
        x.set_zero();
        let mut rz = system.precondition(r, z);
        let largest = z.largest();
        if !rz.is_finite() {
            return (Outcome::NotANumber, 0);
        }
        if rz == 0.0 || largest == 0.0 {
            return (Outcome::Converged, 0);
        }
        // The whole system is scaled, so that products see small motions alone.
        let small = small(largest);
        r.scale(small);
        z.scale(small);
        rz *= small * small;
        p.clone_from(z);
        let enough = rz * tolerance * tolerance;
        let mut ended = (Outcome::Slow, most);
        for product in 1..=most {
            system.answer(p, q);
            let curvature = -p.inner(q);
            let stiff = curvature > FLAT * rz;
            if !stiff {
                ended = (Outcome::Flat, product);
                break;
            }
            let alpha = rz / curvature;
            x.add(alpha, p);
            r.add(alpha, q);
            let before = rz;
            rz = system.precondition(r, z);
            if rz <= enough {
                ended = (Outcome::Converged, product);
                break;
            }
            p.follow(z, rz / before);
        }
        x.scale(1.0 / small);
        ended
    }

    /// The last direction.
    pub fn direction(&self) -> &V {
        &self.p
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Springs of stiffness 1 from each of a row of points to the next, and of `ground` from all points to the ground, along
    /// each axis, with the diagonal as M.
    struct Chain {
        ground: f64,
    }

    impl LinearSystem<Vec<Padded>> for Chain {
        fn answer(&mut self, p: &mut Vec<Padded>, q: &mut Vec<Padded>) {
            assert!(p.largest() < 1e-9, "{}", p.largest());
            q.set_zero();
            for n in 0..p.len() {
                for i in 0..3 {
                    q[n][i] -= self.ground * p[n][i];
                    if n > 0 {
                        let pull = p[n][i] - p[n - 1][i];
                        q[n][i] -= pull;
                        q[n - 1][i] += pull;
                    }
                }
            }
        }

        fn precondition(&mut self, r: &Vec<Padded>, z: &mut Vec<Padded>) -> f64 {
            z.clone_from(r);
            z.scale(1.0 / (2.0 + self.ground));
            r.inner(z)
        }
    }

    #[test]
    fn the_solution_answers_the_force_and_what_nothing_holds_is_flat() {
        let motion: Vec<Padded> = (0..50)
            .map(|n| Padded::new([f64::from(n % 7), f64::from(n % 3) - 1.0, f64::from(n * n)]))
            .collect();
        let mut chain = Chain { ground: 0.1 };
        let mut gradients = ConjugateGradients::new(&motion);
        let (mut force, mut x) = (motion.clone(), motion.clone());
        let mut tiny = motion.clone();
        tiny.scale(small(motion.largest()));
        chain.answer(&mut tiny, &mut force);
        force.scale(-1.0 / small(motion.largest()));
        let mut r = force.clone();
        let (outcome, products) = gradients.solve(&mut chain, &mut r, &mut x, 1e-13, 200);
        assert!(outcome == Outcome::Converged && products < 100, "{outcome:?} {products}");
        x.add(-1.0, &motion);
        assert!(x.largest() < 1e-10 * motion.largest(), "{}", x.largest());
        let mut r = force.clone();
        let (outcome, _) = gradients.solve(&mut chain, &mut r, &mut x, 1e-13, 3);
        assert_eq!(outcome, Outcome::Slow);

        let mut r = vec![Padded::new([1.0, 0.0, 0.0]); 50];
        let (outcome, _) = gradients.solve(&mut Chain { ground: 0.0 }, &mut r, &mut x, 1e-13, 200);
        assert_eq!(outcome, Outcome::Flat);
        assert!(gradients.direction().largest() > 0.0);

        for some in [1, 50] {
            let mut r = force.clone();
            r[..some].fill(Padded::new([f64::NAN; 3]));
            let (outcome, _) = gradients.solve(&mut chain, &mut r, &mut x, 1e-13, 200);
            assert_eq!(outcome, Outcome::NotANumber);
        }
    }
}
