//! The internal force of a block of elements, as many at a time as a vector has lanes, and the one-point element.
//! The fully integrated element is in [`crate::full`].
//!
//! Per one-point element, in the Hadamard modes of the corner values (their sums over the corners with the signs
//! of xi, eta, zeta, eta zeta, zeta xi, xi eta, xi eta zeta):
//!
//! * mean gradient B_I = dV/dx_I (Flanagan and Belytschko 1981; see [`crate::mean_gradient`]),
//! * H = 1/V sum u_I B_I^T, E = (H + H^T + H^T H)/2,
//! * S = lambda tr(E) I + 2 G E, P = (I + H) S (St. Venant–Kirchhoff),
//! * f_I = P B_I + K_h sum_a q_a gamma_aI with the hourglass shapes
//!   gamma_aI = Gamma_aI - B_I . (X Gamma_a)/V, amplitudes q_a = sum u_I gamma_aI and
//!   K_h = kappa M B_iI B_iI/(24 V), M of [`crate::Material::hourglass_modulus`].
//!
//! The modes are plain sums, without the factor 1/8; the constants contain it. With A_k and G_a the plain sums of the
//! corners' positions, V = W/64 and B_I = 1/64 (sum of the signs of corner I times b_k and c_a), where for cyclic k, l, m
//!
//! * b_k = A_l x A_m + G_m x G_l/3, c_k = (A_m x G_l + G_m x A_l)/3, c_4 = 0, W = A_1 . b_1 + G_1 . c_1.

use crate::blocks::{BATCH, Batch};
use crate::lanes::Lanes;
use crate::tensor::{Matrix, Vector};
use mesh::Padded;

/// Material and element constants of a body, in the scaling of a kernel. Here `w` is the volume that the plain sums
/// of its modes give, over the true volume: 64 for the one-point element, 512 for the fully integrated one, whose
/// Gauss points are summed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constants {
    /// lambda/w (Pa)
    pub(crate) lambda: f64,
    /// G/w (Pa)
    pub(crate) shear: f64,
    /// kappa M/192 (Pa), M the hourglass modulus; of the one-point element only
    pub(crate) hourglass: f64,
    /// Kelvin–Voigt time eta (s): S_v = eta C : dE/dt
    pub(crate) kelvin_voigt: f64,
    /// Linear bulk viscosity: coefficient times rho c_p/w (Pa s/m)
    pub(crate) bulk_linear: f64,
    /// Quadratic bulk viscosity: coefficient squared times rho/w (kg/m^3)
    pub(crate) bulk_quadratic: f64,
}

/// Nodal arrays that a block reads, and `force` (N), which it changes; positions and displacements in m, velocities in
/// m/s.
#[derive(Clone, Copy)]
pub(crate) struct Arrays {
    pub(crate) reference: *const Padded,
    pub(crate) displacement: *const Padded,
    pub(crate) velocity: *const Padded,
    pub(crate) force: *mut Padded,
}

/// Of a block: strain energy (J), hourglass energy (J), viscous power (W).
pub(crate) type Sums = [f64; 3];

/// A formulation of the element.
pub(crate) trait Kernel {
    /// The modes of the internal force of some elements. Adds to `sums` their energies if `ENERGY`, and their viscous
    /// power if `VISCOUS`.
    fn force<L: Lanes, const ENERGY: bool, const VISCOUS: bool>(
        part: &Part<L, VISCOUS>,
        k: &Constants,
        sums: &mut Sums,
    ) -> Modes<L>;
}

/// Part of a batch: as many elements as a vector has lanes, with the arrays of their nodes.
///
/// Its methods are safe because [`block_force`] alone makes one, and its callers fulfil its contract.
pub(crate) struct Part<'a, L, const VISCOUS: bool> {
    batch: &'a Batch,
    /// The first element's lane in the batch.
    lane: usize,
    /// Number of elements; further lanes repeat the last of them.
    pub(crate) count: usize,
    arrays: Arrays,
    pub(crate) zero: L,
}

impl<L: Lanes, const VISCOUS: bool> Part<'_, L, VISCOUS> {
    #[inline(always)]
    pub(crate) fn reference(&self) -> Modes<L> {
        // SAFETY: by the contract of `block_force`, as in the methods below.
        unsafe { modes(self.arrays.reference, self.batch, self.lane) }
    }

    #[inline(always)]
    pub(crate) fn displacement(&self) -> Modes<L> {
        unsafe { modes(self.arrays.displacement, self.batch, self.lane) }
    }

    /// Of viscous elements.
    #[inline(always)]
    pub(crate) fn velocity(&self) -> Option<Modes<L>> {
        if VISCOUS {
            Some(unsafe { modes(self.arrays.velocity, self.batch, self.lane) })
        } else {
            None
        }
    }

    /// Subtracts a force, given by its modes, from the nodes of the elements.
    #[inline(always)]
    fn subtract(&self, force: &Modes<L>) {
        let corners = force.corners();
        for corner in 0..8 {
            let nodes = &self.batch.nodes[corner][self.lane..];
            let Vector(force) = corners[corner];
            unsafe { L::scatter_sub(self.arrays.force, nodes.as_ptr(), force, self.count) };
        }
    }
}

/// Subtracts the internal force of a block from `arrays.force`. Returns its energies, zero unless `ENERGY`, and its
/// viscous power, zero unless `VISCOUS`.
///
/// # Safety
/// The instructions of `L` are available; every node index of `batches` is valid in all arrays
/// (in `velocity` only if `VISCOUS`); nobody else writes those arrays or reads the forces of the
/// block's nodes meanwhile; `elements` is at least 1 and fills all batches but the last.
#[inline(always)]
pub(crate) unsafe fn block_force<K: Kernel, L: Lanes, const ENERGY: bool, const VISCOUS: bool>(
    batches: &[Batch],
    elements: usize,
    constants: &Constants,
    arrays: Arrays,
) -> Sums {
    // SAFETY: the caller vouches for the instructions.
    let zero = unsafe { L::splat(0.0) };
    let mut sums = [0.0; 3];
    let mut left = elements;
    for batch in batches {
        let mut lane = 0;
        while lane < BATCH {
            let count = if left < L::N { left } else { L::N };
            if count > 0 {
                // lane + L::N <= 8 because N divides 8
                let part = Part::<L, VISCOUS> { batch, lane, count, arrays, zero };
                part.subtract(&K::force::<L, ENERGY, VISCOUS>(&part, constants, &mut sums));
            }
            left -= count;
            lane += L::N;
        }
    }
    sums
}

/// The one-point element with hourglass stiffness.
pub(crate) struct OnePoint;

impl Kernel for OnePoint {
    #[inline(always)]
    fn force<L: Lanes, const ENERGY: bool, const VISCOUS: bool>(
        part: &Part<L, VISCOUS>,
        k: &Constants,
        sums: &mut Sums,
    ) -> Modes<L> {
        let x = part.reference();
        let mean = mean_gradient(&x);
        let Gradient { b, c, w, per_w, squares } = mean;

        let u = part.displacement();
        let h = gradient(&u, &mean);
        let e = green(&h);
        let two_g = w.like(2.0 * k.shear);
        let pressure = e.trace() * k.lambda;
        let mut s = elastic(&e, two_g, pressure); // S/64

        if ENERGY {
            // V (lambda/2 tr(E)^2 + G E:E), with V = W/64
            let density = (pressure * e.trace()).fma(w.like(0.5), e.contract(&e) * k.shear);
            sums[0] += (density * w).sum(part.count);
        }
        if let Some(v) = part.velocity() {
            let rate = green_rate(&h, &gradient(&v, &mean));
            let eta = k.kelvin_voigt;
            let mut viscous = elastic(&rate, two_g * eta, rate.trace() * k.lambda * eta);
            let q = bulk_viscosity(rate.trace(), w, squares, k);
            for i in 0..3 {
                viscous[i][i] = viscous[i][i] + q;
            }
            sums[2] += (viscous.contract(&rate) * w).sum(part.count);
            s = s + viscous;
        }
        let mut p = piola(&h, &s); // P/64

        // K_h = kappa M squares/(192 W). The amplitudes are q_a = U_a - H G_a. The part of their force along B_I is
        // taken off P/64: K_h/W sum of the dyads of q_a and G_a.
        let stiffness = squares * k.hourglass * per_w;
        let g = &x.hourglass;
        let mut q = u.hourglass;
        for a in 0..4 {
            q[a] = h.fnma(g[a], q[a]);
        }
        if ENERGY {
            let mut square = q[0].dot(q[0]);
            for a in 1..4 {
                square = q[a].dot_add(q[a], square);
            }
            sums[1] += (square * stiffness * 0.5).sum(part.count);
        }
        for a in 0..4 {
            q[a] = q[a] * stiffness;
            p = (q[a] * per_w).dyad_sub(g[a], p);
        }
        let mut force = Modes { linear: b, hourglass: q };
        for m in 0..3 {
            force.linear[m] = p * b[m];
            force.hourglass[m] = p.fma(c[m], q[m]);
        }
        force
    }
}

/// The mean gradient in modes: B_I = 1/64 (sum of the signs of corner I times b_k and c_a); see [`mean_gradient`].
pub(crate) struct Gradient<L> {
    b: [Vector<L>; 3],
    c: [Vector<L>; 3],
    /// 64 V
    pub(crate) w: L,
    /// 1/w
    per_w: L,
    /// 512 B_iI B_iI
    pub(crate) squares: L,
}

/// The mean gradient from the modes `x` of the corners, as [`crate::mean_gradient`] without its factors.
#[inline(always)]
pub(crate) fn mean_gradient<L: Lanes>(x: &Modes<L>) -> Gradient<L> {
    let (a, g) = (&x.linear, &x.hourglass);
    let third = 1.0 / 3.0;
    let (mut b, mut c) = (*a, *a);
    for k in 0..3 {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        b[k] = a[l].cross_add(a[m], (g[m] * third).cross(g[l]));
        c[k] = (a[m] * third).cross_add(g[l], (g[m] * third).cross(a[l]));
    }
    let w = a[0].dot(b[0]) + g[0].dot(c[0]);
    let mut squares = b[0].dot(b[0]);
    for v in [b[1], b[2], c[0], c[1], c[2]] {
        squares = v.dot_add(v, squares);
    }
    Gradient { b, c, w, per_w: w.like(1.0) / w, squares }
}

/// Bulk viscosity as a uniform second Piola–Kirchhoff stress, scaled as the constants `k`, from the mean of tr dE/dt
/// (von Neumann and Richtmyer; Landshoff): negative in compression, zero otherwise.
///
/// Its length is V sqrt(3/2)/|B|: the edge of a cube, sqrt(3) times the thickness of a flat element. With
/// |B|^2 = 8 squares/4096 it is W sqrt(3/2)/sqrt(8 squares), W = 64 V.
#[inline(always)]
pub(crate) fn bulk_viscosity<L: Lanes>(rate: L, w: L, squares: L, k: &Constants) -> L {
    let length = w * 0.1875f64.sqrt() / squares.sqrt();
    let closing = rate.min(w.like(0.0)) * length;
    closing * closing.fnma(w.like(k.bulk_quadratic), w.like(k.bulk_linear))
}

/// H = 1/W (sum U_k b_k^T + sum U_a c_a^T), U the modes of the displacement or velocity.
#[inline(always)]
pub(crate) fn gradient<L: Lanes>(u: &Modes<L>, mean: &Gradient<L>) -> Matrix<L> {
    let Gradient { b, c, per_w, .. } = mean;
    let mut h = u.linear[0].dyad(b[0]);
    h = u.linear[1].dyad_add(b[1], h);
    h = u.linear[2].dyad_add(b[2], h);
    for a in 0..3 {
        h = u.hourglass[a].dyad_add(c[a], h);
    }
    h * *per_w
}

/// E = (H + H^T + H^T H)/2.
#[inline(always)]
pub(crate) fn green<L: Lanes>(h: &Matrix<L>) -> Matrix<L> {
    let column = h.transposed();
    let mut e = *h;
    for i in 0..3 {
        for j in i..3 {
            e[i][j] = column[i].dot_add(column[j], h[i][j] + h[j][i]) * 0.5;
            e[j][i] = e[i][j];
        }
    }
    e
}

/// dE/dt = sym(F^T dH/dt) = (dH/dt + dH/dt^T + H^T dH/dt + dH/dt^T H)/2.
#[inline(always)]
pub(crate) fn green_rate<L: Lanes>(h: &Matrix<L>, rate: &Matrix<L>) -> Matrix<L> {
    let mut e = *h;
    for i in 0..3 {
        for j in i..3 {
            let mut v = rate[i][j] + rate[j][i];
            for k in 0..3 {
                v = h[k][i].fma(rate[k][j], v);
                v = h[k][j].fma(rate[k][i], v);
            }
            e[i][j] = v * 0.5;
            e[j][i] = e[i][j];
        }
    }
    e
}

/// 2G E + p I.
#[inline(always)]
pub(crate) fn elastic<L: Lanes>(e: &Matrix<L>, two_g: L, p: L) -> Matrix<L> {
    let mut s = *e;
    for i in 0..3 {
        s[i][i] = e[i][i].fma(two_g, p);
        for j in i + 1..3 {
            s[i][j] = e[i][j] * two_g;
            s[j][i] = s[i][j];
        }
    }
    s
}

/// P = (I + H) S.
#[inline(always)]
pub(crate) fn piola<L: Lanes>(h: &Matrix<L>, s: &Matrix<L>) -> Matrix<L> {
    let mut p = *s;
    for i in 0..3 {
        for k in 0..3 {
            p[i] = s[k].fma(h[i][k], p[i]);
        }
    }
    p
}

/// Signed sums of corner values: xi, eta, zeta, then eta zeta, zeta xi, xi eta, xi eta zeta.
pub(crate) struct Modes<L> {
    pub(crate) linear: [Vector<L>; 3],
    pub(crate) hourglass: [Vector<L>; 4],
}

/// The modes of a nodal array's values at the corners.
///
/// # Safety
/// The instructions of `L` are available, and the nodes of `L::N` elements of `batch` from `lane` on exist in the
/// array at `base`.
#[inline(always)]
pub(crate) unsafe fn modes<L: Lanes>(base: *const Padded, batch: &Batch, lane: usize) -> Modes<L> {
    // SAFETY: as the caller's.
    unsafe {
        let mut n = [Vector([L::splat(0.0); 3]); 8];
        for corner in 0..8 {
            n[corner] = Vector(L::gather(base, batch.nodes[corner].as_ptr().add(lane)));
        }
        Modes::of(n)
    }
}

impl<L: Lanes> Modes<L> {
    /// The modes of the values `n` at the corners.
    #[inline(always)]
    fn of(n: [Vector<L>; 8]) -> Self {
        let mut out = Self { linear: [n[0]; 3], hourglass: [n[0]; 4] };
        // one axis after the other: with the 16 registers of AVX2, whole vectors would spill
        for i in 0..3 {
            let [n0, n1, n2, n3] = [n[0][i], n[1][i], n[2][i], n[3][i]];
            let [n4, n5, n6, n7] = [n[4][i], n[5][i], n[6][i], n[7][i]];
            // p: sum over zeta, m: difference over zeta
            let (p0, p1, p2, p3) = (n0 + n4, n1 + n5, n2 + n6, n3 + n7);
            let (m0, m1, m2, m3) = (n4 - n0, n5 - n1, n6 - n2, n7 - n3);
            let (p20, p13) = (p2 - p0, p1 - p3);
            let (m20, m13) = (m2 - m0, m1 - m3);
            let (m02, m31) = (m0 + m2, m1 + m3);
            out.linear[0][i] = p20 + p13;
            out.linear[1][i] = p20 - p13;
            out.linear[2][i] = m02 + m31;
            out.hourglass[0][i] = m20 - m13;
            out.hourglass[1][i] = m20 + m13;
            out.hourglass[2][i] = p0 + p2 - (p1 + p3);
            out.hourglass[3][i] = m02 - m31;
        }
        out
    }

    /// The transpose of [`of`](Self::of): forces on the corners from forces on the modes.
    #[inline(always)]
    fn corners(&self) -> [Vector<L>; 8] {
        let zero = self.linear[0][0].like(0.0);
        let mut n = [Vector([zero; 3]); 8];
        for i in 0..3 {
            let [a1, a2, a3] = [self.linear[0][i], self.linear[1][i], self.linear[2][i]];
            let [g1, g2] = [self.hourglass[0][i], self.hourglass[1][i]];
            let [g3, g4] = [self.hourglass[2][i], self.hourglass[3][i]];
            let (s, t) = (a1 + a2, a1 - a2);
            let (c0, c1, c2, c3) = (g3 - s, t - g3, g3 + s, zero - (t + g3));
            let (s, t) = (g2 + g1, g2 - g1);
            let (plus, minus) = (a3 + g4, a3 - g4);
            let (d0, d1, d2, d3) = (plus - s, minus + t, plus + s, minus - t);
            n[0][i] = c0 - d0;
            n[1][i] = c1 - d1;
            n[2][i] = c2 - d2;
            n[3][i] = c3 - d3;
            n[4][i] = c0 + d0;
            n[5][i] = c1 + d1;
            n[6][i] = c2 + d2;
            n[7][i] = c3 + d3;
        }
        n
    }
}
