//! Dimensionless numbers of friction that falls with the slip speed, Eq. (8) of Vollebregt (2017), between
//! elastic bodies. They predict, before a run, whether it is well posed.

use crate::Exponential;

/// The properties of an interface between two elastic bodies that the numbers depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// Pressure `p_n` (Pa); for a whole contact, its largest.
    pub pressure: f64,
    /// Radiation impedance in shear `Z` (Pa s/m) of both bodies in series,
    /// `1/(1/Z_1 + 1/Z_2)` with `Z_i = rho_i c_s,i`; for equal bodies half of that of one.
    pub impedance: f64,
    /// Effective shear modulus `G*` (Pa); for equal bodies `G/(1 - nu)` in mode II.
    pub modulus: f64,
    /// Reduced mass per area `m*` (kg/m^2) of the two surface layers of elements,
    /// `rho d/4` for equal ones of depth `d`.
    pub surface_mass: f64,
    /// Time step (s).
    pub dt: f64,
}

/// The numbers of falling friction; dimensionless where no unit is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Falling {
    /// `R = p_n k (mu_S - mu_D)/Z`. Above 1 three states are possible under one load, and a
    /// disturbance of wave number `k_x` grows at the rate `|k_x| c_s/sqrt(R^2 - 1)`. The rate has no bound as the
    /// mesh is refined: without memory the problem is ill-posed, and meshes do not converge.
    pub r: f64,
    /// `N_2 = dt p_n k (mu_S - mu_D)/m*`: the negative damping of friction over a time step, relative to the mass of
    /// the surface layer.
    pub n2: f64,
    /// The least ratio of trial shear to pressure at which slip can go on, for `R > 1`:
    /// `mu_D + (mu_S - mu_D) (1 + ln R)/R`.
    pub f_min: Option<f64>,
    /// Slip speed at `f_min` (m/s), `ln R/k`, for `R > 1`: between rest and this speed no state is stable.
    pub s_m: Option<f64>,
    /// Slip speed (m/s) to which a point jumps that begins to slip, for `R > 1`: the largest root
    /// of `Z s + mu(s) p_n = mu_S p_n`.
    pub s_jump: Option<f64>,
}

/// The numbers of [`Falling`] for a law at an interface; `None` for a law that does not fall.
pub fn falling(law: &Exponential, at: &Interface) -> Option<Falling> {
    let drop = law.mu_static - law.mu_dynamic;
    let slope = at.pressure * law.decay * drop;
    if slope.is_nan() || slope <= 0.0 {
        return None;
    }
    let r = slope / at.impedance;
    let unstable = r > 1.0;
    Some(Falling {
        r,
        n2: at.dt * slope / at.surface_mass,
        f_min: unstable.then(|| law.mu_dynamic + drop * (1.0 + libm::log(r)) / r),
        s_m: unstable.then(|| libm::log(r) / law.decay),
        s_jump: unstable.then(|| jump(law, at)),
    })
}

/// The largest root of `s = q (1 - exp(-k s))`, `q = p_n (mu_S - mu_D)/Z`, by Newton's method from
/// `s = q`. The difference of both sides is convex, so that the iteration decreases towards the root and
/// does not pass it.
fn jump(law: &Exponential, at: &Interface) -> f64 {
    let q = at.pressure * (law.mu_static - law.mu_dynamic) / at.impedance;
    let mut s = q;
    for _ in 0..200 {
        let left = libm::exp(-law.decay * s);
        let step = (s - q * (1.0 - left)) / (1.0 - q * law.decay * left);
        s -= step;
        if step.abs() <= 1e-15 * q {
            break;
        }
    }
    s
}

/// Nucleation length `h_n = 1.158 G* d_c/((mu_S - mu_D) p_n)` (m) of the law with memory over the slip
/// `distance = d_c` (m): shorter zones of slip are stable. From Uenishi and Rice (2003), for slip weakening at the rate
/// `(mu_S - mu_D) p_n/d_c`; their constant 0.579 is for half the length.
pub fn nucleation_length(law: &Exponential, distance: f64, at: &Interface) -> f64 {
    1.158 * at.modulus * distance / ((law.mu_static - law.mu_dynamic) * at.pressure)
}

/// `N_1 = dt^2 k_t/m*` (dimensionless) of a penalty friction spring with the areal stiffness `k_t` (N/m^3, the sum of
/// both passes).
pub fn spring_number(areal_stiffness: f64, at: &Interface) -> f64 {
    at.dt * at.dt * areal_stiffness / at.surface_mass
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };

    /// Steel at 1 GPa: G 80.77 GPa, rho 7850 kg/m^3, c_s 3208 m/s; d 1 mm, 0.9 of the Courant step.
    fn steel() -> Interface {
        Interface {
            pressure: 1e9,
            impedance: 12.6e6,
            modulus: 80.77e9,
            surface_mass: 7850.0 * 1e-3 / 4.0,
            dt: 0.9 * 1e-3 / 6001.0,
        }
    }

    #[test]
    fn steel_at_1_gpa_has_r_86_n2_83_a_jump_to_14_3_m_per_s_and_half_a_millimetre_per_um_of_memory()
    {
        let n = falling(&LAW, &steel()).unwrap();
        let near = |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 1e-9, "{found}");
        let r: f64 = 1e9 * 6.0 * 0.18 / 12.6e6;
        near(n.r, r);
        near(n.n2, 0.9e-3 / 6001.0 * 1e9 * 6.0 * 0.18 / (7.85 / 4.0));
        near(n.f_min.unwrap(), 0.32 + 0.18 * (1.0 + libm::log(r)) / r);
        // so fast that friction has fallen by all it can: 14.286 m/s
        near(n.s_jump.unwrap(), 0.18e9 / 12.6e6);
        let metres = nucleation_length(&LAW, 1e-6, &steel());
        assert!((metres - 0.52e-3).abs() < 5e-6, "{metres}");
    }

    #[test]
    fn at_f_min_the_line_of_the_radiated_shear_touches_the_law() {
        let at = steel();
        let n = falling(&LAW, &at).unwrap();
        let (s, f) = (n.s_m.unwrap(), n.f_min.unwrap());
        let above = |s: f64| 0.32 + 0.18 * libm::exp(-6.0 * s) + at.impedance * s / at.pressure;
        assert!((above(s) - f).abs() < 1e-14, "{} {f}", above(s));
        assert!(above(0.99 * s) > f && above(1.01 * s) > f);
    }

    #[test]
    fn the_jump_ends_where_radiated_and_lost_shear_are_equal() {
        for r in [1.01, 1.5, 4.0, 85.7] {
            let at = Interface { pressure: r * 12.6e6 / (6.0 * 0.18), ..steel() };
            let falling = falling(&LAW, &at).unwrap();
            let s = falling.s_jump.unwrap();
            let lost = at.pressure * 0.18 * (1.0 - libm::exp(-6.0 * s));
            assert!((at.impedance * s - lost).abs() < 1e-9 * lost, "R = {r}: {s}");
            assert!(s > falling.s_m.unwrap(), "R = {r}: the root at rest is another one");
        }
    }

    #[test]
    fn weak_falling_has_no_jump_and_constant_friction_no_numbers() {
        let weak = falling(&Exponential { decay: 0.05, ..LAW }, &steel()).unwrap();
        assert!(weak.r < 1.0 && weak.f_min.is_none() && weak.s_jump.is_none(), "{weak:?}");
        assert_eq!(falling(&Exponential { mu_dynamic: 0.5, ..LAW }, &steel()), None);
        assert_eq!(falling(&Exponential { decay: 0.0, ..LAW }, &steel()), None);
    }
}
