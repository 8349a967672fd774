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

use crate::kernel::{
    Constants, Kernel, Modes, Part, Sums, bulk_viscosity, elastic, green, green_rate,
    mean_gradient, piola,
};
use crate::lanes::Lanes;
use crate::tensor::{Matrix, Vector};

/// The fully integrated element, with mean dilatation if `MEAN`.
pub(crate) struct FullyIntegrated<const MEAN: bool>;

/// Eight times the derivatives by xi_k: `d[k][s]` with s = (xi_l > 0) + 2 (xi_m > 0), k, l, m cyclic.
type Derivatives<L> = [[Vector<L>; 4]; 3];

/// Coordinate p = 1/sqrt(3) of the Gauss points, and its square.
const P: f64 = 0.577_350_269_189_625_8;
const P_SQUARED: f64 = 1.0 / 3.0;

impl<const MEAN: bool> Kernel for FullyIntegrated<MEAN> {
    #[inline(always)]
    fn force<L: Lanes, const ENERGY: bool, const VISCOUS: bool>(
        part: &Part<L, VISCOUS>,
        k: &Constants,
        sums: &mut Sums,
    ) -> Modes<L> {
        let zero = part.zero.like(0.0);
        let x = part.reference();
        let fields = Fields {
            x: derivatives(&x),
            u: derivatives(&part.displacement()),
            v: match part.velocity() {
                Some(v) => derivatives(&v),
                None => [[Vector([zero; 3]); 4]; 3],
            },
        };
        let mut total = Total {
            force: [[Vector([zero; 3]); 4]; 3],
            unit_pressure: [[Vector([zero; 3]); 4]; 3],
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
            for point in 0..8 {
                add_point::<L, MEAN, ENERGY, VISCOUS>(&fields, k, &mut total, signs(point));
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
            energy = energy * 0.5;
        }
        if MEAN || VISCOUS {
            let per_volume = zero.like(1.0) / volume;
            let mut pressure = zero;
            if MEAN {
                pressure = dilatation * k.lambda * per_volume;
                if ENERGY {
                    energy = (pressure * dilatation).fma(zero.like(0.5), energy);
                }
            }
            if VISCOUS {
                let mean = mean_gradient(&x);
                let rate = dilatation_rate * per_volume;
                let mut viscous = bulk_viscosity(rate, mean.w, mean.squares, k);
                if MEAN {
                    viscous = rate.fma(zero.like(k.lambda * k.kelvin_voigt), viscous);
                }
                power = viscous.fma(dilatation_rate, power);
                pressure = pressure + viscous;
            }
            for m in 0..3 {
                for s in 0..4 {
                    force[m][s] = unit_pressure[m][s].fma(pressure, force[m][s]);
                }
            }
        }
        if ENERGY {
            sums[0] += energy.sum(part.count);
        }
        if VISCOUS {
            sums[2] += power.sum(part.count);
        }
        transposed(&force)
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
fn add_point<L: Lanes, const MEAN: bool, const ENERGY: bool, const VISCOUS: bool>(
    fields: &Fields<L>,
    k: &Constants,
    total: &mut Total<L>,
    at: [usize; 3],
) {
    let Fields { x, u, v } = fields;
    let [j1, j2, j3] = [x[0][at[0]], x[1][at[1]], x[2][at[2]]];
    let c = [j2.cross(j3), j3.cross(j1), j1.cross(j2)];
    let w = j1.dot(c[0]);
    let (zero, two_g) = (w.like(0.0), w.like(2.0 * k.shear));
    let per_w = w.like(1.0) / w;
    let h = gradient([u[0][at[0]], u[1][at[1]], u[2][at[2]]], &c, per_w);
    let e = green(&h);
    let tr = e.trace();
    // S/512
    let mut s = elastic(&e, two_g, if MEAN { zero } else { tr * k.lambda });
    if MEAN || VISCOUS {
        total.volume = total.volume + w;
    }
    if MEAN {
        total.dilatation = tr.fma(w, total.dilatation);
    }
    if ENERGY {
        total.energy = s.contract(&e).fma(w, total.energy);
    }
    if VISCOUS {
        let rate = green_rate(&h, &gradient([v[0][at[0]], v[1][at[1]], v[2][at[2]]], &c, per_w));
        let tr = rate.trace();
        let eta = k.kelvin_voigt;
        let pressure = if MEAN { zero } else { tr * k.lambda * eta };
        let viscous = elastic(&rate, two_g * eta, pressure);
        total.dilatation_rate = tr.fma(w, total.dilatation_rate);
        total.power = viscous.contract(&rate).fma(w, total.power);
        s = s + viscous;
    }
    let p = piola(&h, &s);
    for m in 0..3 {
        let f = &mut total.force[m][at[m]];
        *f = p.fma(c[m], *f);
        if MEAN || VISCOUS {
            let f = &mut total.unit_pressure[m][at[m]];
            *f = h.fma(c[m], *f + c[m]);
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
fn derivatives<L: Lanes>(x: &Modes<L>) -> Derivatives<L> {
    let p = x.linear[0][0].like(P);
    let mut d = [[Vector([p; 3]); 4]; 3];
    for k in 0..3 {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        for i in 0..3 {
            let (a, g) = (x.linear[k][i], x.hourglass[m][i]);
            let (minus, plus) = (g.fnma(p, a), g.fma(p, a));
            let (g, twist) = (x.hourglass[l][i] * P, x.hourglass[3][i] * P_SQUARED);
            let (slope_minus, slope_plus) = (g - twist, g + twist);
            d[k][0][i] = minus - slope_minus;
            d[k][1][i] = plus - slope_plus;
            d[k][2][i] = minus + slope_minus;
            d[k][3][i] = plus + slope_plus;
        }
    }
    d
}

/// The transpose of [`derivatives`]: forces on modes from forces on derivatives.
#[inline(always)]
fn transposed<L: Lanes>(f: &Derivatives<L>) -> Modes<L> {
    let any = f[0][0][0];
    let (p, p_squared) = (any.like(P), any.like(P_SQUARED));
    let zero = Vector([any.like(0.0); 3]);
    let mut out = Modes { linear: [zero; 3], hourglass: [zero; 4] };
    for k in 0..3 {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        let g = &mut out.hourglass;
        for i in 0..3 {
            let [f0, f1, f2, f3] = [f[k][0][i], f[k][1][i], f[k][2][i], f[k][3][i]];
            let (minus, plus) = (f0 + f2, f1 + f3);
            let (slope_minus, slope_plus) = (f2 - f0, f3 - f1);
            out.linear[k][i] = minus + plus;
            g[m][i] = (plus - minus).fma(p, g[m][i]);
            g[l][i] = (slope_minus + slope_plus).fma(p, g[l][i]);
            g[3][i] = (slope_plus - slope_minus).fma(p_squared, g[3][i]);
        }
    }
    out
}

/// H = sum D_k C_k^T/w.
#[inline(always)]
fn gradient<L: Lanes>(d: [Vector<L>; 3], c: &[Vector<L>; 3], per_w: L) -> Matrix<L> {
    d[2].dyad_add(c[2], d[1].dyad_add(c[1], d[0].dyad(c[0]))) * per_w
}
