//! Friction at a point of the patch.

use friction::{NodeConditions, NodeFriction, slip_speed};

/// A point of the patch, and what its law of friction needs.
pub(crate) struct TrialPoint<'a> {
    pub(crate) law: &'a dyn NodeFriction,
    pub(crate) state: [f64; 2],
    pub(crate) at: NodeConditions,
    /// Whether it slipped in the step before.
    pub(crate) slipped: bool,
    /// A coefficient that stands for the law's.
    pub(crate) coefficient: Option<f64>,
}

impl TrialPoint<'_> {
    /// The law's coefficient at a slip velocity (m/s).
    pub(crate) fn law_coefficient(&self, [x, y]: [f64; 2]) -> f64 {
        self.law.mu(self.state, libm::hypot(x, y), &self.at)
    }
}

/// Traction on the upper body (Pa), slip velocity (m/s) and coefficient of friction of a point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Friction {
    pub(crate) shear: [f64; 2],
    pub(crate) slip_velocity: [f64; 2],
    pub(crate) mu: f64,
    pub(crate) slips: bool,
}

/// Whether adhesion and slip both are solutions at a point; arguments as of [`return_mapping`].
pub(crate) fn is_non_unique(point: &TrialPoint<'_>, free: [f64; 2], compliance: f64) -> bool {
    let (speed, bound) = (libm::hypot(free[0], free[1]), compliance * point.at.pressure);
    let curve = |s: f64| {
        (point.law.mu(point.state, s, &point.at), point.law.slope(point.state, s, &point.at))
    };
    point.law.is_implicit() && slip_speed::is_non_unique(speed, bound, &curve)
}

/// Friction at a point whose slip velocity is `free + compliance * shear` (m/s, m/s per Pa): the traction that holds it, or
/// where that is beyond the bound the traction of the bound against the slip.
pub(crate) fn return_mapping(point: &TrialPoint<'_>, free: [f64; 2], compliance: f64) -> Friction {
    let pressure = point.at.pressure;
    let speed = libm::hypot(free[0], free[1]);
    let bound = compliance * pressure;
    let slip = if point.coefficient.is_none() && point.law.is_implicit() {
        let curve = |s: f64| {
            (point.law.mu(point.state, s, &point.at), point.law.slope(point.state, s, &point.at))
        };
        slip_speed::solve(speed, bound, point.slipped, &curve)
    } else {
        let mu = point.coefficient.unwrap_or_else(|| point.law.mu(point.state, 0.0, &point.at));
        (bound * mu < speed).then_some((speed - bound * mu, mu))
    };
    match slip {
        Some((s, mu)) => {
            let direction = free.map(|v| v / speed);
            Friction {
                shear: direction.map(|d| -mu * pressure * d),
                slip_velocity: direction.map(|d| s * d),
                mu,
                slips: true,
            }
        }
        None => Friction {
            shear: free.map(|v| -v / compliance),
            slip_velocity: [0.0; 2],
            mu: point.law.mu(point.state, 0.0, &point.at),
            slips: false,
        },
    }
}
