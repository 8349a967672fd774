//! The contact conditions (6) to (8) at one node at one instant.

use crate::check::basis::{Basis, Bound};
use crate::check::law::Law;
pub use contact::patch::IN_CONTACT;
use nalgebra::Vector3;

/// A node is in adhesion where its shear is below this share of the bound mu p_n.
pub const IN_ADHESION: f64 = 0.98;
/// The law is violated where |p_f/(mu p_n) - 1| exceeds this.
pub const LAW_TOLERANCE: f64 = 0.02;
/// The direction of friction is violated where the angle between shear and -s exceeds this (degrees).
pub const DIRECTION_TOLERANCE: f64 = 5.0;

/// A node in contact: its traction and the slip velocity that it is paired with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    /// p_n (Pa).
    pub pressure: f64,
    /// p_tau on the node's own surface (Pa).
    pub shear: Vector3<f64>,
    /// s, of the node relative to the other surface (m/s).
    pub slip: Vector3<f64>,
    /// The coefficient that the algorithm used.
    pub mu_used: Option<f64>,
    /// The law's coefficient recomputed from the records.
    pub mu_recomputed: Option<f64>,
    /// Its state by the algorithm: 0 open, 1 stick, 2 slip.
    pub state: Option<u8>,
}

/// The contact conditions evaluated at one node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    /// |s| (m/s).
    pub speed: f64,
    /// |s|/s_c.
    pub relative_speed: f64,
    /// p_f/p_n.
    pub ratio: f64,
    /// Whether |s| is above the threshold.
    pub slips: bool,
    /// Whether its state by the algorithm is slip.
    pub slip_state: bool,
    /// mu(|s|) of the law; of a law with state the recomputed coefficient.
    pub mu_law: Option<f64>,
    /// p_f/(mu p_n) - 1 with that coefficient, where it slips.
    pub law_error: Option<f64>,
    /// p_f/(mu p_n) - 1 with the coefficient that the algorithm used, where it slips.
    pub law_error_own: Option<f64>,
    /// Angle of the shear from -s (degrees), where it slips and carries shear.
    pub direction: Option<f64>,
    /// |s|/s_c, where the shear is below [`IN_ADHESION`] of the bound.
    pub adhesion_slip: Option<f64>,
    /// Distance from the law's graph ([`Law::distance`]), of a law without state.
    pub law_scatter: Option<f64>,
    /// -p_tau . s (W/m2): dissipated power, negative where friction supplies energy.
    pub power: f64,
    /// Whether it violates the law, the direction or adhesion.
    pub violates: bool,
}

/// Law, bound and scales by which the conditions are judged.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judge {
    pub law: Option<Law>,
    pub bound: Bound,
    /// s_c (m/s).
    pub slip_speed: f64,
    /// Slip speed above which a node slips (m/s).
    pub threshold: f64,
}

impl Judge {
    pub fn new(basis: &Basis, slip_speed: f64) -> Self {
        let threshold = basis.scale("slip_threshold").unwrap_or(1e-3 * slip_speed);
        Self { law: basis.law, bound: basis.bound, slip_speed, threshold }
    }

    pub fn judge(&self, node: &Node) -> Judged {
        let (speed, shear) = (node.slip.norm(), node.shear.norm());
        let ratio = shear / node.pressure;
        let slips = speed > self.threshold;
        // of a law with state the coefficient depends on more than the slip speed
        let mu_law = match self.bound {
            Bound::Law => self.law.map(|law| law.mu(speed)),
            Bound::Used => node.mu_recomputed.or(node.mu_used.filter(|_| self.law.is_some())),
        };
        let bound = match self.bound {
            Bound::Law => mu_law,
            Bound::Used => mu_law.or(node.mu_used),
        };
        // of zero friction there is no relative error
        let error = |mu: f64| if mu > 0.0 { ratio / mu - 1.0 } else { ratio };
        let law_error = mu_law.filter(|_| slips).map(error);
        let law_error_own = node.mu_used.filter(|_| slips).map(error);
        let direction = (slips && shear > 0.0).then(|| angle(node.shear, -node.slip));
        let adheres = bound.is_some_and(|mu| ratio < IN_ADHESION * mu);
        let off_bound = bound.is_some_and(|mu| slips && error(mu).abs() > LAW_TOLERANCE);
        let off_direction = direction.is_some_and(|angle| angle > DIRECTION_TOLERANCE);
        Judged {
            speed,
            relative_speed: speed / self.slip_speed,
            ratio,
            slips,
            slip_state: node.state == Some(2),
            mu_law,
            law_error,
            law_error_own,
            direction,
            adhesion_slip: adheres.then_some(speed / self.slip_speed),
            law_scatter: self
                .law
                .filter(|_| self.bound == Bound::Law)
                .zip(mu_law)
                .map(|(law, mu)| law.distance(speed, mu, ratio, self.slip_speed)),
            power: -node.shear.dot(&node.slip),
            violates: off_bound || off_direction || (adheres && slips),
        }
    }
}

/// The angle between `a` and `b` in degrees, accurate near 0 and 180 where the arc cosine is not.
fn angle(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    libm::atan2(a.cross(&b).norm(), a.dot(&b)).to_degrees()
}
