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
//! The modes are plain sums, without the factor 1/8; the constants contain it. With A_k and G_a the plain sums,
//! V = W/64 and B_I = 1/64 (sum of the signs of corner I times b_k and c_a).

use crate::blocks::{BATCH, Batch};
use crate::lanes::Lanes;
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

pub(crate) type Vector<L> = [L; 3];
pub(crate) type Matrix<L> = [[L; 3]; 3];

/// Signed sums of corner values: xi, eta, zeta, then eta zeta, zeta xi, xi eta, xi eta zeta.
pub(crate) struct Modes<L> {
    pub(crate) linear: [Vector<L>; 3],
    pub(crate) hourglass: [Vector<L>; 4],
}

/// A formulation of the element.
pub(crate) trait Kernel {
    /// Subtracts the internal force of one vector of elements, and adds their energies and power to `sums`.
    ///
    /// # Safety
    /// As [`block_force`], for `count` elements of `batch` from `lane` on.
    unsafe fn elements_force<L: Lanes, const ENERGY: bool, const VISCOUS: bool>(
        batch: &Batch,
        lane: usize,
        count: usize,
        k: &Constants,
        arrays: Arrays,
        sums: &mut Sums,
    );
}

/// The one-point element with hourglass stiffness.
pub(crate) struct OnePoint;

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
    let mut sums = [0.0; 3];
    let mut left = elements;
    let mut i = 0;
    while i < batches.len() {
        let batch = &batches[i];
        let mut lane = 0;
        while lane < BATCH {
            let count = if left < L::N { left } else { L::N };
            if count > 0 {
                // SAFETY: as the caller's; lane + L::N <= 8 because N divides 8.
                unsafe {
                    K::elements_force::<L, ENERGY, VISCOUS>(
                        batch, lane, count, constants, arrays, &mut sums,
                    );
                }
            }
            left -= count;
            lane += L::N;
        }
        i += 1;
    }
    sums
}

impl Kernel for OnePoint {
    #[inline(always)]
    unsafe fn elements_force<L: Lanes, const ENERGY: bool, const VISCOUS: bool>(
        batch: &Batch,
        lane: usize,
        count: usize,
        k: &Constants,
        arrays: Arrays,
        sums: &mut Sums,
    ) {
        // SAFETY: as the caller's throughout.
        unsafe {
            let x = modes::<L>(arrays.reference, batch, lane);
            let g = &x.hourglass;
            let of_volume = mean_gradient(&x);
            let Gradient { b, c, w, per_w, squares } = of_volume;

            let u = modes::<L>(arrays.displacement, batch, lane);
            let h = gradient(&u, &of_volume);
            let e = green(&h);
            let two_g = L::splat(2.0 * k.shear);
            let pressure = L::splat(k.lambda).mul(trace(&e));
            // S/64
            let mut s = elastic(&e, two_g, pressure);

            if ENERGY {
                // V (lambda/2 tr(E)^2 + G E:E), with V = W/64
                let density = pressure
                    .mul(trace(&e))
                    .mul_add(L::splat(0.5), L::splat(k.shear).mul(contract(&e, &e)));
                sums[0] += density.mul(w).sum(count);
            }
            if VISCOUS {
                let v = modes::<L>(arrays.velocity, batch, lane);
                let rate = green_rate(&h, &gradient(&v, &of_volume));
                let eta = L::splat(k.kelvin_voigt);
                let mut viscous =
                    elastic(&rate, two_g.mul(eta), L::splat(k.lambda).mul(trace(&rate)).mul(eta));
                let q = bulk_viscosity(trace(&rate), w, squares, k);
                let mut i = 0;
                while i < 3 {
                    viscous[i][i] = viscous[i][i].add(q);
                    i += 1;
                }
                sums[2] += contract(&viscous, &rate).mul(w).sum(count);
                let mut i = 0;
                while i < 3 {
                    s[i] = [
                        s[i][0].add(viscous[i][0]),
                        s[i][1].add(viscous[i][1]),
                        s[i][2].add(viscous[i][2]),
                    ];
                    i += 1;
                }
            }

            let mut p = piola(&h, &s); // P/64

            // Hourglass: K_h = kappa (lambda + 2 G) squares/(192 W). The part of the force along B_I is
            // taken off P/64: K_h/W sum of the dyads of q_a and G_a.
            let stiffness = L::splat(k.hourglass).mul(squares).mul(per_w);
            let mut q = u.hourglass;
            let mut amplitude = 0;
            while amplitude < 4 {
                let mut i = 0;
                while i < 3 {
                    let mut v = q[amplitude][i];
                    v = h[i][0].neg_mul_add(g[amplitude][0], v);
                    v = h[i][1].neg_mul_add(g[amplitude][1], v);
                    v = h[i][2].neg_mul_add(g[amplitude][2], v);
                    q[amplitude][i] = v;
                    i += 1;
                }
                amplitude += 1;
            }
            if ENERGY {
                let mut square = dot(q[0], q[0]);
                square = dot_add(q[1], q[1], square);
                square = dot_add(q[2], q[2], square);
                square = dot_add(q[3], q[3], square);
                sums[1] += square.mul(stiffness).mul(L::splat(0.5)).sum(count);
            }
            let mut amplitude = 0;
            while amplitude < 4 {
                q[amplitude] = scale(q[amplitude], stiffness);
                let mut i = 0;
                while i < 3 {
                    let over_w = q[amplitude][i].mul(per_w);
                    let mut j = 0;
                    while j < 3 {
                        p[i][j] = over_w.neg_mul_add(g[amplitude][j], p[i][j]);
                        j += 1;
                    }
                    i += 1;
                }
                amplitude += 1;
            }
            let mut force = Modes { linear: b, hourglass: q };
            let mut m = 0;
            while m < 3 {
                let mut i = 0;
                while i < 3 {
                    force.linear[m][i] = dot(p[i], b[m]);
                    force.hourglass[m][i] = dot_add(p[i], c[m], q[m][i]);
                    i += 1;
                }
                m += 1;
            }
            scatter(&force, arrays.force, batch, lane, count);
        }
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
pub(crate) unsafe fn mean_gradient<L: Lanes>(x: &Modes<L>) -> Gradient<L> {
    unsafe {
        let (a, g) = (&x.linear, &x.hourglass);
        let third = L::splat(1.0 / 3.0);
        let mut b = [[L::splat(0.0); 3]; 3];
        let mut c = b;
        let mut m = 0;
        while m < 3 {
            let (n, o) = ((m + 1) % 3, (m + 2) % 3);
            b[m] = cross_add(a[n], a[o], scale(g[o], third), g[n]);
            c[m] = cross_add(scale(a[o], third), g[n], scale(g[o], third), a[n]);
            m += 1;
        }
        let w = dot(a[0], b[0]).add(dot(g[0], c[0]));
        let mut squares = dot(b[0], b[0]);
        squares = dot_add(b[1], b[1], squares);
        squares = dot_add(b[2], b[2], squares);
        squares = dot_add(c[0], c[0], squares);
        squares = dot_add(c[1], c[1], squares);
        squares = dot_add(c[2], c[2], squares);
        Gradient { b, c, w, per_w: L::splat(1.0).div(w), squares }
    }
}

/// Bulk viscosity as a uniform second Piola–Kirchhoff stress, scaled as the constants `k`, from the mean of tr dE/dt
/// (von Neumann and Richtmyer; Landshoff): negative in compression, zero otherwise.
///
/// Its length is V sqrt(3/2)/|B|: the edge of a cube, sqrt(3) times the thickness of a flat element. With
/// |B|^2 = 8 squares/4096 it is W sqrt(3/2)/sqrt(8 squares), W = 64 V.
#[inline(always)]
pub(crate) unsafe fn bulk_viscosity<L: Lanes>(rate: L, w: L, squares: L, k: &Constants) -> L {
    unsafe {
        let length = w.mul(L::splat(0.1875f64.sqrt())).div(squares.sqrt());
        let closing = rate.min(L::splat(0.0)).mul(length);
        closing.mul(closing.neg_mul_add(L::splat(k.bulk_quadratic), L::splat(k.bulk_linear)))
    }
}

/// P = (I + H) S.
#[inline(always)]
pub(crate) unsafe fn piola<L: Lanes>(h: &Matrix<L>, s: &Matrix<L>) -> Matrix<L> {
    unsafe {
        let mut p = *s;
        let mut i = 0;
        while i < 3 {
            let mut j = 0;
            while j < 3 {
                p[i][j] = h[i][0].mul_add(s[0][j], p[i][j]);
                p[i][j] = h[i][1].mul_add(s[1][j], p[i][j]);
                p[i][j] = h[i][2].mul_add(s[2][j], p[i][j]);
                j += 1;
            }
            i += 1;
        }
        p
    }
}

/// Gathers the corner values of a nodal array and forms their signed sums.
#[inline(always)]
pub(crate) unsafe fn modes<L: Lanes>(base: *const Padded, batch: &Batch, lane: usize) -> Modes<L> {
    unsafe {
        let zero = [L::splat(0.0); 3];
        let mut n = [zero; 8];
        let mut corner = 0;
        while corner < 8 {
            n[corner] = L::gather(base, batch.nodes[corner].as_ptr().add(lane));
            corner += 1;
        }
        let mut out = Modes { linear: [zero; 3], hourglass: [zero; 4] };
        let mut i = 0;
        while i < 3 {
            // p: sum over zeta, m: difference over zeta
            let p0 = n[0][i].add(n[4][i]);
            let p1 = n[1][i].add(n[5][i]);
            let p2 = n[2][i].add(n[6][i]);
            let p3 = n[3][i].add(n[7][i]);
            let m0 = n[4][i].sub(n[0][i]);
            let m1 = n[5][i].sub(n[1][i]);
            let m2 = n[6][i].sub(n[2][i]);
            let m3 = n[7][i].sub(n[3][i]);
            let (p20, p13) = (p2.sub(p0), p1.sub(p3));
            let (m20, m13) = (m2.sub(m0), m1.sub(m3));
            let (m02, m31) = (m0.add(m2), m1.add(m3));
            out.linear[0][i] = p20.add(p13);
            out.linear[1][i] = p20.sub(p13);
            out.linear[2][i] = m02.add(m31);
            out.hourglass[0][i] = m20.sub(m13);
            out.hourglass[1][i] = m20.add(m13);
            out.hourglass[2][i] = p0.add(p2).sub(p1.add(p3));
            out.hourglass[3][i] = m02.sub(m31);
            i += 1;
        }
        out
    }
}

/// The transpose of [`modes`]: corner forces from their modes, subtracted from the nodes.
#[inline(always)]
pub(crate) unsafe fn scatter<L: Lanes>(
    force: &Modes<L>,
    base: *mut Padded,
    batch: &Batch,
    lane: usize,
    count: usize,
) {
    unsafe {
        let mut n = [[L::splat(0.0); 3]; 8];
        let mut i = 0;
        while i < 3 {
            let (a1, a2, a3) = (force.linear[0][i], force.linear[1][i], force.linear[2][i]);
            let (g1, g2) = (force.hourglass[0][i], force.hourglass[1][i]);
            let (g3, g4) = (force.hourglass[2][i], force.hourglass[3][i]);
            let (s, t) = (a1.add(a2), a1.sub(a2));
            let (c0, c2) = (g3.sub(s), g3.add(s));
            let (c1, c3) = (t.sub(g3), L::splat(0.0).sub(t.add(g3)));
            let (s, t) = (g2.add(g1), g2.sub(g1));
            let (plus, minus) = (a3.add(g4), a3.sub(g4));
            let (d0, d2) = (plus.sub(s), plus.add(s));
            let (d1, d3) = (minus.add(t), minus.sub(t));
            n[0][i] = c0.sub(d0);
            n[1][i] = c1.sub(d1);
            n[2][i] = c2.sub(d2);
            n[3][i] = c3.sub(d3);
            n[4][i] = c0.add(d0);
            n[5][i] = c1.add(d1);
            n[6][i] = c2.add(d2);
            n[7][i] = c3.add(d3);
            i += 1;
        }
        let mut corner = 0;
        while corner < 8 {
            L::scatter_sub(base, batch.nodes[corner].as_ptr().add(lane), n[corner], count);
            corner += 1;
        }
    }
}

/// H = 1/W (sum U_k b_k^T + sum U_a c_a^T), U the modes of the displacement or velocity.
#[inline(always)]
pub(crate) unsafe fn gradient<L: Lanes>(u: &Modes<L>, of_volume: &Gradient<L>) -> Matrix<L> {
    unsafe {
        let Gradient { b, c, per_w, .. } = of_volume;
        let per_w = *per_w;
        let mut h = [[per_w; 3]; 3];
        let mut i = 0;
        while i < 3 {
            let mut j = 0;
            while j < 3 {
                let mut v = u.linear[0][i].mul(b[0][j]);
                v = u.linear[1][i].mul_add(b[1][j], v);
                v = u.linear[2][i].mul_add(b[2][j], v);
                v = u.hourglass[0][i].mul_add(c[0][j], v);
                v = u.hourglass[1][i].mul_add(c[1][j], v);
                v = u.hourglass[2][i].mul_add(c[2][j], v);
                h[i][j] = v.mul(per_w);
                j += 1;
            }
            i += 1;
        }
        h
    }
}

/// E = (H + H^T + H^T H)/2.
#[inline(always)]
pub(crate) unsafe fn green<L: Lanes>(h: &Matrix<L>) -> Matrix<L> {
    unsafe {
        let half = L::splat(0.5);
        let mut e = *h;
        let mut i = 0;
        while i < 3 {
            let mut j = i;
            while j < 3 {
                let mut v = h[i][j].add(h[j][i]);
                v = h[0][i].mul_add(h[0][j], v);
                v = h[1][i].mul_add(h[1][j], v);
                v = h[2][i].mul_add(h[2][j], v);
                e[i][j] = v.mul(half);
                e[j][i] = e[i][j];
                j += 1;
            }
            i += 1;
        }
        e
    }
}

/// dE/dt = sym(F^T dH/dt).
#[inline(always)]
pub(crate) unsafe fn green_rate<L: Lanes>(h: &Matrix<L>, rate: &Matrix<L>) -> Matrix<L> {
    unsafe {
        let half = L::splat(0.5);
        let mut e = *h;
        let mut i = 0;
        while i < 3 {
            let mut j = i;
            while j < 3 {
                let mut v = rate[i][j].add(rate[j][i]);
                let mut k = 0;
                while k < 3 {
                    v = h[k][i].mul_add(rate[k][j], v);
                    v = h[k][j].mul_add(rate[k][i], v);
                    k += 1;
                }
                e[i][j] = v.mul(half);
                e[j][i] = e[i][j];
                j += 1;
            }
            i += 1;
        }
        e
    }
}

/// 2G E + p I.
#[inline(always)]
pub(crate) unsafe fn elastic<L: Lanes>(e: &Matrix<L>, two_g: L, p: L) -> Matrix<L> {
    unsafe {
        let (xy, xz, yz) = (two_g.mul(e[0][1]), two_g.mul(e[0][2]), two_g.mul(e[1][2]));
        [
            [two_g.mul_add(e[0][0], p), xy, xz],
            [xy, two_g.mul_add(e[1][1], p), yz],
            [xz, yz, two_g.mul_add(e[2][2], p)],
        ]
    }
}

#[inline(always)]
pub(crate) unsafe fn trace<L: Lanes>(m: &Matrix<L>) -> L {
    unsafe { m[0][0].add(m[1][1]).add(m[2][2]) }
}

/// a : b of symmetric matrices.
#[inline(always)]
pub(crate) unsafe fn contract<L: Lanes>(a: &Matrix<L>, b: &Matrix<L>) -> L {
    unsafe {
        let mut shear = a[0][1].mul(b[0][1]);
        shear = a[0][2].mul_add(b[0][2], shear);
        shear = a[1][2].mul_add(b[1][2], shear);
        let mut sum = a[0][0].mul_add(b[0][0], shear.add(shear));
        sum = a[1][1].mul_add(b[1][1], sum);
        a[2][2].mul_add(b[2][2], sum)
    }
}

#[inline(always)]
pub(crate) unsafe fn dot<L: Lanes>(a: Vector<L>, b: Vector<L>) -> L {
    unsafe { a[2].mul_add(b[2], a[1].mul_add(b[1], a[0].mul(b[0]))) }
}

/// a . b + c.
#[inline(always)]
pub(crate) unsafe fn dot_add<L: Lanes>(a: Vector<L>, b: Vector<L>, c: L) -> L {
    unsafe { a[2].mul_add(b[2], a[1].mul_add(b[1], a[0].mul_add(b[0], c))) }
}

#[inline(always)]
unsafe fn scale<L: Lanes>(a: Vector<L>, s: L) -> Vector<L> {
    unsafe { [a[0].mul(s), a[1].mul(s), a[2].mul(s)] }
}

/// a x b + c x d.
#[inline(always)]
pub(crate) unsafe fn cross_add<L: Lanes>(
    a: Vector<L>,
    b: Vector<L>,
    c: Vector<L>,
    d: Vector<L>,
) -> Vector<L> {
    unsafe {
        let mut out = a;
        let mut i = 0;
        while i < 3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let v = c[k].neg_mul_add(d[j], c[j].mul(d[k]));
            out[i] = a[j].mul_add(b[k], a[k].neg_mul_add(b[j], v));
            i += 1;
        }
        out
    }
}

/// a x b.
#[inline(always)]
pub(crate) unsafe fn cross<L: Lanes>(a: Vector<L>, b: Vector<L>) -> Vector<L> {
    unsafe {
        let mut out = a;
        let mut i = 0;
        while i < 3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            out[i] = a[k].neg_mul_add(b[j], a[j].mul(b[k]));
            i += 1;
        }
        out
    }
}
