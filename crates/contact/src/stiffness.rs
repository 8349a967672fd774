//! The areal stiffness (N/m^3) of the contact springs and what it is derived from.

/// How a contact spring's areal stiffness is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PenaltyStiffness {
    /// LS-DYNA's segment stiffness `SF K A^2/V` spread over the segment: each pass has the areal
    /// stiffness `SF K A/V` of the master face's element (`K` bulk modulus, `A` face area, `V`
    /// element volume). For a brick of depth `d` that is `SF K/d`.
    Scale(f64),
    /// Areal stiffness (N/m^3) of both passes together, the `k_t` of Eq. (10) of Vollebregt
    /// (2017); each pass has half of it.
    Areal(f64),
    /// Fraction of the limit of stability `m* (4/dt^2 - omega_el^2)` for both passes together,
    /// with `m*` the reduced mass per area of the two surfaces in touch; each pass has half.
    StabilityFraction(f64),
}

impl PenaltyStiffness {
    /// The number that the variant carries.
    pub fn value(self) -> f64 {
        match self {
            Self::Scale(v) | Self::Areal(v) | Self::StabilityFraction(v) => v,
        }
    }

    /// Areal stiffness (N/m^3) of one pass.
    ///
    /// `scaled` is `K A/V` of the master face's element (N/m^3), `reduced_mass` is `m*` (kg/m^2).
    /// [`PenaltyStiffness::StabilityFraction`] without a scale gives zero; the constructors of contact
    /// refuse that combination.
    pub fn per_pass(
        self,
        scaled: f64,
        reduced_mass: f64,
        stability: Option<StabilityScale>,
    ) -> f64 {
        match self {
            Self::Scale(factor) => factor * scaled,
            Self::Areal(both) => 0.5 * both,
            Self::StabilityFraction(fraction) => {
                0.5 * fraction * reduced_mass * stability.map_or(0.0, StabilityScale::omega_squared)
            }
        }
    }
}

/// What [`PenaltyStiffness::StabilityFraction`] is a fraction of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityScale {
    /// Highest angular frequency of the bodies without contact (rad/s).
    pub omega_elastic: f64,
    /// Time step (s).
    pub dt: f64,
}

impl StabilityScale {
    /// `4/dt^2 - omega_el^2` (1/s^2): a spring between surface masses of at most `m*` times this
    /// leaves the time step stable (Rayleigh's bound `omega^2 <= omega_el^2 + k/m*`).
    pub fn omega_squared(self) -> f64 {
        4.0 / (self.dt * self.dt) - self.omega_elastic * self.omega_elastic
    }
}

/// Material of the elements behind a contact surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMaterial {
    /// Bulk modulus (Pa).
    pub bulk_modulus: f64,
    /// Density (kg/m^3).
    pub density: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_form_gives_its_own_areal_stiffness_per_pass() {
        let scale = StabilityScale { omega_elastic: 3.0, dt: 0.4 };
        assert_eq!(PenaltyStiffness::Scale(0.1).per_pass(1.75e14, 2.0, None), 0.1 * 1.75e14);
        assert_eq!(PenaltyStiffness::Areal(3.5e13).per_pass(1.0, 2.0, None), 1.75e13);
        let fraction = PenaltyStiffness::StabilityFraction(0.5).per_pass(1.0, 2.0, Some(scale));
        assert!((fraction - 0.5 * 0.5 * 2.0 * (25.0 - 9.0)).abs() < 1e-12);
    }
}
