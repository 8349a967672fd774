//! The tangential problem of one node with a coefficient that depends on the slip speed of the same instant.
//!
//! `s_free` is the slip velocity (m/s) that the node would have without its own friction. Slip is parallel
//! to it, and its speed `s` (m/s) solves `s + c mu(s) = |s_free|`, or is zero where `c mu(0) >= |s_free|`. Here
//! `c = dt W p_n A` (m/s) with the time step `dt`, the node's entry `W` of the Delassus operator (1/kg), the pressure
//! `p_n` and the node's area `A`. With a constant coefficient this is Coulomb's law.
//!
//! # Selection
//! Where `c mu` falls faster than `s` rises there are three solutions: adhesion, and two in slip, the
//! slower of which is unstable. A node stays on its branch until that ends (perfect delay, Ionescu and
//! Paumier 1994): a node that stuck sticks as long as it can; one that slipped slips as long as there
//! is a solution in slip, and takes the fastest. Where `c mu(0) < |s_free|` there is no adhesion, and always slip: of a
//! coefficient that rises to a peak and falls beyond it one solution or three, of which the node takes the fastest.

/// Newton steps and bisections at most.
const MOST_ITERATIONS: usize = 100;

/// A coefficient of friction as a function of the slip speed.
pub trait Curve {
    /// Coefficient and its derivative (s/m) at the slip speed `speed >= 0` (m/s).
    fn at(&self, speed: f64) -> (f64, f64);
}

impl<F: Fn(f64) -> (f64, f64)> Curve for F {
    fn at(&self, speed: f64) -> (f64, f64) {
        self(speed)
    }
}

/// Slip speed (m/s) and coefficient of friction of a node; `None` where it sticks.
///
/// `free` is `|s_free|` (m/s) and `c` as in the module's equation (m/s), both at least zero. `slipped` says whether
/// the node slipped in the step before; it selects the branch where there are several solutions.
///
/// `mu` may rise to one peak and fall beyond it. With more turns the speed is still a solution, but perhaps not the
/// fastest.
pub fn solve(free: f64, c: f64, slipped: bool, mu: &impl Curve) -> Option<(f64, f64)> {
    let sticks = c * mu.at(0.0).0 >= free;
    if sticks && !slipped {
        return None;
    }
    fastest(free, c, mu).filter(|(speed, _)| *speed > 0.0)
}

/// Whether adhesion and slip are both solutions; arguments as for [`solve`].
pub fn is_non_unique(free: f64, c: f64, mu: &impl Curve) -> bool {
    c * mu.at(0.0).0 >= free && fastest(free, c, mu).is_some_and(|(speed, _)| speed > 0.0)
}

/// The largest root of `F(s) = s + c mu(s) - free`, by Newton's method from above, where `F > 0`.
///
/// For laws that level off at high speed `F` is convex there, so that Newton's steps do not pass the root. Where one
/// does, or where `F` turns up again without one although `F(0) < 0`, the root is bracketed, and bisection takes over
/// where Newton's step leaves the bracket.
fn fastest(free: f64, c: f64, mu: &impl Curve) -> Option<(f64, f64)> {
    // F(free) = c mu >= 0
    let (mut above, mut below) = (free, f64::NAN);
    let mut s = free;
    for _ in 0..MOST_ITERATIONS {
        let (value, slope) = mu.at(s);
        let f = s + c * value - free;
        if f.abs() <= f64::EPSILON * (free + c * value) {
            return Some((s, value));
        }
        if f > 0.0 {
            above = s
        } else {
            below = s
        }
        let derivative = 1.0 + c * slope;
        let newton = s - f / derivative;
        if below.is_nan() {
            // no root on this branch: F turns up again, or reaches rest, without a change of sign
            if derivative <= 0.0 || newton < 0.0 {
                if c * mu.at(0.0).0 >= free || s == 0.0 {
                    return None;
                }
                below = 0.0;
                s = 0.5 * above;
                continue;
            }
            if newton == s {
                return Some((s, value));
            }
            s = newton;
        } else {
            let inside = newton > below && newton < above;
            let next = match below {
                _ if inside => newton,
                // a law that rises with the logarithm of the speed: the root may have any size
                0.0 => above / 1024.0,
                _ => 0.5 * (below + above),
            };
            if next == s || above - below <= f64::EPSILON * above {
                return Some((s, value));
            }
            s = next;
        }
    }
    Some((s, mu.at(s).0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NodeConditions, NodeFriction, RateState, StateLaw};
    use proptest::prelude::*;

    #[test]
    fn rate_and_state_creeps_at_the_speed_at_which_its_friction_carries_the_shear() {
        let law = RateState {
            reference: 0.6,
            reference_speed: 1e-6,
            direct: 0.008,
            evolution: 0.012,
            distance: 1e-5,
            law: StateLaw::Ageing,
            initial: 10.0,
            lagged: false,
        };
        let (state, at) = ([10.0, 0.0], NodeConditions::default());
        let curve = |s: f64| (law.mu(state, s, &at), law.slope(state, s, &at));
        // far below the reference coefficient mu = a asinh(..) inverts to V in closed form
        for share in [1e-3, 0.1, 0.3, 0.6, 0.65] {
            let (speed, mu) = solve(share * C, C, false, &curve).unwrap();
            let creep = 2e-6 * libm::exp(-0.6f64 / 0.008) * libm::sinh(mu / 0.008);
            assert!((mu + speed / C - share).abs() < 1e-13, "{share}: {mu}");
            assert!((speed / creep - 1.0).abs() < 1e-9, "{share}: {speed} {creep}");
        }
        // at high load it slides: Z s + mu(s) p = tau
        let (speed, mu) = solve(0.9 * C, C, true, &curve).unwrap();
        assert!(speed > 1.0 && (speed + C * mu - 0.9 * C).abs() < 1e-11 * C);
        assert_eq!(solve(0.0, C, false, &curve), None);
    }

    /// Eq. (8) with the impedance of steel: c = p/Z at 1 GPa, R = 86.
    fn paper(s: f64) -> (f64, f64) {
        let above = 0.18 * libm::exp(-6.0 * s);
        (0.32 + above, -6.0 * above)
    }
    const C: f64 = 1e9 / 12.6e6;

    #[test]
    fn a_constant_coefficient_gives_coulomb() {
        let law = |_: f64| (0.3, 0.0);
        assert_eq!(solve(0.29, 1.0, true, &law), None);
        let (s, mu) = solve(0.5, 1.0, false, &law).unwrap();
        assert!((s - 0.2).abs() < 1e-15 && mu == 0.3);
    }

    #[test]
    fn a_node_that_stuck_sticks_up_to_the_static_bound_and_jumps_to_the_root_of_the_balance() {
        assert_eq!(solve(0.4999 * C, C, false, &paper), None);
        let (s, mu) = solve(0.500_001 * C, C, false, &paper).unwrap();
        // at 14.286 m/s all of the fall is spent: s = (tau - mu_D p)/Z
        assert!((s / (0.180_001 * C) - 1.0).abs() < 1e-12, "{s}");
        assert!((s + C * mu - 0.500_001 * C).abs() < 1e-12 * C);
    }

    #[test]
    fn a_node_that_slipped_slips_down_to_the_minimum_of_the_curve() {
        // f_min/p_n = mu_D + dmu (1 + ln R)/R with R = c k dmu
        let r = C * 6.0 * 0.18;
        let least = 0.32 + 0.18 * (1.0 + libm::log(r)) / r;
        assert!(solve((least + 1e-5) * C, C, true, &paper).is_some());
        assert_eq!(solve((least - 1e-5) * C, C, true, &paper), None);
        assert!(is_non_unique(0.4 * C, C, &paper));
        assert!(!is_non_unique(0.51 * C, C, &paper));
        assert!(!is_non_unique(0.3 * C, C, &paper));
    }

    #[test]
    fn a_well_posed_law_has_one_solution_for_any_history() {
        // R = 0.5
        let c = 0.5 / (6.0 * 0.18);
        for i in 1..200 {
            let free = f64::from(i) * 5e-3;
            assert_eq!(solve(free, c, true, &paper), solve(free, c, false, &paper), "{free}");
            assert!(!is_non_unique(free, c, &paper));
        }
    }

    #[test]
    fn a_law_that_rises_before_it_falls_slips_below_its_peak_where_it_cannot_stick() {
        // up from 0.3 to 0.5 at 1 m/s, and down again within a few m/s
        let hump =
            |s: f64| (0.3 + 0.2 * s * libm::exp(1.0 - s), 0.2 * (1.0 - s) * libm::exp(1.0 - s));
        for slipped in [false, true] {
            let (speed, mu) = solve(0.35 * C, C, slipped, &hump).unwrap();
            assert!(speed > 0.0 && speed < 1.0 && (speed + C * mu - 0.35 * C).abs() < 1e-12 * C);
            assert_eq!(solve(0.29 * C, C, slipped, &hump), None);
        }
    }

    proptest! {
        /// `mu = base + rise x e^(1 - x) - fall (1 - e^(-s/far))`, `x = s/peak`.
        #[test]
        fn a_law_with_one_peak_gets_the_fastest_slip_that_solves_its_equation(
            (base, rise, part) in (0.05..0.6, 0.0..0.6, 0.0..1.0f64),
            (peak, stretch) in (-6.0..1.0f64, 1.0..30.0f64),
            (c, load) in (-3.0..3.0f64, 0.2..3.0f64),
            slipped: bool,
        ) {
            let (peak, c) = (libm::exp10(peak), libm::exp10(c));
            let far = stretch * peak;
            // not so steep that the fall outdoes the rise at rest
            let fall = part * f64::min(base, rise * core::f64::consts::E * stretch);
            let law = |s: f64| {
                let x = s / peak;
                let (near, slow) = (rise * libm::exp(1.0 - x), fall * libm::exp(-s / far));
                (base + near * x - (fall - slow), near * (1.0 - x) / peak - slow / far)
            };
            let free = load * c * base;
            let residual = |s: f64| s + c * law(s).0 - free;
            let sticks = c * law(0.0).0 >= free;
            // the fastest root, between two of many speeds
            let speeds = || (0..20_000).map(|i| free * libm::pow(0.998, f64::from(i)));
            let scanned = speeds().find(|&s| residual(s) < 0.0);
            match solve(free, c, slipped, &law) {
                None => prop_assert!(sticks && (!slipped || scanned.is_none())),
                Some((speed, mu)) => {
                    prop_assert!(!sticks || slipped);
                    prop_assert!(speed > 0.0 && mu == law(speed).0);
                    let steep = f64::EPSILON * speed * (1.0 + c * law(speed).1.abs());
                    prop_assert!(
                        residual(speed).abs() <= 1e-14 * (free + c * mu) + 4.0 * steep,
                        "{:e} at {speed:e}", residual(speed)
                    );
                    prop_assert!(scanned.is_none_or(|s| speed >= s));
                }
            }
        }
    }
}
