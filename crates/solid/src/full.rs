//! The fully integrated hexahedron: 2x2x2 Gauss points, no hourglass modes.
//!
//! The derivative of a trilinear field by one of xi, eta, zeta is bilinear in the other two, so that it takes four
//! values at the eight Gauss points (coordinates +-p, p = 1/sqrt(3)). With the Hadamard modes A_k, G_a of the corner
//! values (see [`crate::kernel`]), k, l, m cyclic, and xi_k here the sign of the coordinate,
//!
//! * 8 dx/dxi_k = A_k + p xi_l G_m + p xi_m G_l + p^2 xi_l xi_m G_4.
//!
//! From them, at each point, with J_k = 8 dx/dxi_k and D_k = 8 du/dxi_k:
//!
//! * cofactors C_1 = J_2 x J_3 (cyclic), w = J_1 . C_1 (512 times the point's volume), H = sum D_k C_k^T/w,
//! * E = (H + H^T + H^T H)/2, S = lambda tr(E) I + 2 G E, P = (I + H) S,
//! * f_k = sum over the points of P C_k/512, the force conjugate to D_k; the constants contain the 1/512.
//!
//! **Mean dilatation** (selective integration of the volumetric part, Malkus and Hughes 1978;
//! Nagtegaal, Parks and Rice 1974): the energy is
//! lambda/2 V `<tr E>`^2 + G int E : E dV with `<.>` the mean over the element. It is objective, and the force, its
//! derivative, is conservative: lambda `<tr E>` takes the place of lambda tr(E).
//!
//! Kelvin–Voigt stresses are eta times the elastic law applied to dE/dt at each Gauss point, with the same mean:
//! they damp every mode of the element in proportion to its stiffness. Bulk viscosity is one pressure per element,
//! from the mean of tr dE/dt as in the one-point element, so that it does not damp bending.
//!
//! A pressure p that is uniform over the element is known only after all points: sum (I + H) C_k is summed beside
//! the rest, and p times it is added at the end.

use crate::blocks::Batch;
use crate::kernel::{
    Arrays, Constants, Kernel, Matrix, Modes, Sums, Vector, bulk_viscosity, contract, cross, dot,
    dot_add, elastic, green, green_rate, mean_gradient, modes, piola, scatter, trace,
};
use crate::lanes::Lanes;

/// The fully integrated element, with mean dilatation if `MEAN`.
pub(crate) struct FullyIntegrated<const MEAN: bool>;

/// Eight times the derivatives by xi_k: `d[k][s]` with s = (xi_l > 0) + 2 (xi_m > 0), k, l, m cyclic.
type Derivatives<L> = [[Vector<L>; 4]; 3];

/// Coordinate p = 1/sqrt(3) of the Gauss points, and its square.
const P: f64 = 0.577_350_269_189_625_8;
const P_SQUARED: f64 = 1.0 / 3.0;

impl<const MEAN: bool> Kernel for FullyIntegrated<MEAN> {
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
            let zero = L::splat(0.0);
            let x = modes::<L>(arrays.reference, batch, lane);
            let fields = Fields {
                x: derivatives(&x),
                u: derivatives(&modes::<L>(arrays.displacement, batch, lane)),
                v: if VISCOUS {
                    derivatives(&modes::<L>(arrays.velocity, batch, lane))
                } else {
                    [[[zero; 3]; 4]; 3]
                },
            };
            let mut total = Total {
                force: [[[zero; 3]; 4]; 3],
                unit_pressure: [[[zero; 3]; 4]; 3],
                volume: zero,
                dilatation: zero,
                dilatation_rate: zero,
                energy: zero,
                power: zero,
            };
            if L::N == 8 {
                // Unrolled: with the 32 registers of AVX-512, constant indices need no address
                // computation and the totals stay in registers.
                add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(0));
                add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(1));
                add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(2));
                add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(3));
                add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(4));
                add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(5));
                add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(6));
                add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(7));
            } else {
                // With fewer registers the totals spill anyway, and unrolled code would not fit its cache.
                let mut point = 0;
                while point < 8 {
                    add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(point));
                    point += 1;
                }
            }

            let Total {
                mut force,
                unit_pressure,
                volume,
                dilatation,
                dilatation_rate,
                mut energy,
                mut power,
            } = total;
            if ENERGY {
                energy = energy.mul(L::splat(0.5));
            }
            if MEAN || VISCOUS {
                let per_volume = L::splat(1.0).div(volume);
                let mut pressure = zero;
                if MEAN {
                    pressure = L::splat(k.lambda).mul(dilatation).mul(per_volume);
                    if ENERGY {
                        energy = pressure.mul(dilatation).mul_add(L::splat(0.5), energy);
                    }
                }
                if VISCOUS {
                    let mean = mean_gradient(&x);
                    let rate = dilatation_rate.mul(per_volume);
                    let mut viscous = bulk_viscosity(rate, mean.w, mean.squares, k);
                    if MEAN {
                        viscous = L::splat(k.lambda * k.kelvin_voigt).mul_add(rate, viscous);
                    }
                    power = viscous.mul_add(dilatation_rate, power);
                    pressure = pressure.add(viscous);
                }
                let mut m = 0;
                while m < 3 {
                    let mut s = 0;
                    while s < 4 {
                        let mut i = 0;
                        while i < 3 {
                            force[m][s][i] =
                                pressure.mul_add(unit_pressure[m][s][i], force[m][s][i]);
                            i += 1;
                        }
                        s += 1;
                    }
                    m += 1;
                }
            }
            if ENERGY {
                sums[0] += energy.sum(count);
            }
            if VISCOUS {
                sums[2] += power.sum(count);
            }
            scatter(&transposed(&force), arrays.force, batch, lane, count);
        }
    }
}

/// The derivatives of reference position, displacement and velocity.
struct Fields<L> {
    x: Derivatives<L>,
    u: Derivatives<L>,
    v: Derivatives<L>,
}

/// Sums over the Gauss points.
struct Total<L> {
    /// Force conjugate to the derivatives of the displacement, without that of uniform pressures.
    force: Derivatives<L>,
    /// The same for the uniform stress S/512 = I: the sum of (I + H) C_k.
    unit_pressure: Derivatives<L>,
    /// 512 V
    volume: L,
    /// Integral of tr E, times 512
    dilatation: L,
    /// Integral of tr dE/dt, times 512
    dilatation_rate: L,
    /// Twice the energy, without that of the mean dilatation
    energy: L,
    /// Viscous power, without that of uniform pressures
    power: L,
}

/// Adds the contribution of a Gauss point; `at[k]` is the index of its derivative by xi_k among the four.
#[inline(always)]
unsafe fn add_point<L: Lanes, const MEAN: bool, const ENERGY: bool, const VISCOUS: bool>(
    fields: &Fields<L>,
    k: &Constants,
    total: &mut Total<L>,
    at: [usize; 3],
) {
    unsafe {
        let zero = L::splat(0.0);
        let two_g = L::splat(2.0 * k.shear);
        let lambda = L::splat(k.lambda);
        let Fields { x, u, v } = fields;
        let [j1, j2, j3] = [x[0][at[0]], x[1][at[1]], x[2][at[2]]];
        let c = [cross(j2, j3), cross(j3, j1), cross(j1, j2)];
        let w = dot(j1, c[0]);
        let per_w = L::splat(1.0).div(w);
        let h = gradient([u[0][at[0]], u[1][at[1]], u[2][at[2]]], &c, per_w);
        let e = green(&h);
        let tr = trace(&e);
        // S/512
        let mut s = elastic(&e, two_g, if MEAN { zero } else { lambda.mul(tr) });
        if MEAN || VISCOUS {
            total.volume = total.volume.add(w);
        }
        if MEAN {
            total.dilatation = tr.mul_add(w, total.dilatation);
        }
        if ENERGY {
            total.energy = contract(&s, &e).mul_add(w, total.energy);
        }
        if VISCOUS {
            let rate =
                green_rate(&h, &gradient([v[0][at[0]], v[1][at[1]], v[2][at[2]]], &c, per_w));
            let tr = trace(&rate);
            let eta = L::splat(k.kelvin_voigt);
            let pressure = if MEAN { zero } else { lambda.mul(tr).mul(eta) };
            let viscous = elastic(&rate, two_g.mul(eta), pressure);
            total.dilatation_rate = tr.mul_add(w, total.dilatation_rate);
            total.power = contract(&viscous, &rate).mul_add(w, total.power);
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
        let p = piola(&h, &s);
        let mut m = 0;
        while m < 3 {
            let mut i = 0;
            while i < 3 {
                let f = &mut total.force[m][at[m]][i];
                *f = dot_add(p[i], c[m], *f);
                if MEAN || VISCOUS {
                    let f = &mut total.unit_pressure[m][at[m]][i];
                    *f = dot_add(h[i], c[m], f.add(c[m][i]));
                }
                i += 1;
            }
            m += 1;
        }
    }
}

/// The indices of a Gauss point's derivatives by each xi_k among the four; bit k of `point` is set if xi_k > 0.
#[inline(always)]
const fn signs(point: usize) -> [usize; 3] {
    let bit = [point & 1, point >> 1 & 1, point >> 2 & 1];
    [bit[1] + 2 * bit[2], bit[2] + 2 * bit[0], bit[0] + 2 * bit[1]]
}

/// The derivatives at the Gauss points from the modes.
#[inline(always)]
unsafe fn derivatives<L: Lanes>(x: &Modes<L>) -> Derivatives<L> {
    unsafe {
        let (p, p_squared) = (L::splat(P), L::splat(P_SQUARED));
        let mut d = [[[p; 3]; 4]; 3];
        let mut k = 0;
        while k < 3 {
            let (l, m) = ((k + 1) % 3, (k + 2) % 3);
            let mut i = 0;
            while i < 3 {
                let (a, g) = (x.linear[k][i], x.hourglass[m][i]);
                let (minus, plus) = (p.neg_mul_add(g, a), p.mul_add(g, a));
                let g = x.hourglass[l][i].mul(p);
                let twist = x.hourglass[3][i].mul(p_squared);
                let (slope_minus, slope_plus) = (g.sub(twist), g.add(twist));
                d[k][0][i] = minus.sub(slope_minus);
                d[k][1][i] = plus.sub(slope_plus);
                d[k][2][i] = minus.add(slope_minus);
                d[k][3][i] = plus.add(slope_plus);
                i += 1;
            }
            k += 1;
        }
        d
    }
}

/// The transpose of [`derivatives`]: forces on modes from forces on derivatives.
#[inline(always)]
unsafe fn transposed<L: Lanes>(f: &Derivatives<L>) -> Modes<L> {
    unsafe {
        let (p, p_squared) = (L::splat(P), L::splat(P_SQUARED));
        let zero = [L::splat(0.0); 3];
        let mut out = Modes { linear: [zero; 3], hourglass: [zero; 4] };
        let mut k = 0;
        while k < 3 {
            let (l, m) = ((k + 1) % 3, (k + 2) % 3);
            let mut i = 0;
            while i < 3 {
                let [f0, f1, f2, f3] = [f[k][0][i], f[k][1][i], f[k][2][i], f[k][3][i]];
                let (minus, plus) = (f0.add(f2), f1.add(f3));
                let (slope_minus, slope_plus) = (f2.sub(f0), f3.sub(f1));
                out.linear[k][i] = minus.add(plus);
                out.hourglass[m][i] = plus.sub(minus).mul_add(p, out.hourglass[m][i]);
                let slope = slope_minus.add(slope_plus);
                out.hourglass[l][i] = slope.mul_add(p, out.hourglass[l][i]);
                let twist = slope_plus.sub(slope_minus);
                out.hourglass[3][i] = twist.mul_add(p_squared, out.hourglass[3][i]);
                i += 1;
            }
            k += 1;
        }
        out
    }
}

/// H = sum D_k C_k^T/w.
#[inline(always)]
unsafe fn gradient<L: Lanes>(d: [Vector<L>; 3], c: &[Vector<L>; 3], per_w: L) -> Matrix<L> {
    unsafe {
        let mut h = *c;
        let mut i = 0;
        while i < 3 {
            let mut j = 0;
            while j < 3 {
                let mut v = d[0][i].mul(c[0][j]);
                v = d[1][i].mul_add(c[1][j], v);
                v = d[2][i].mul_add(c[2][j], v);
                h[i][j] = v.mul(per_w);
                j += 1;
            }
            i += 1;
        }
        h
    }
}
