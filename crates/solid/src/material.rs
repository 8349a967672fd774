//! Isotropic linear elasticity.

use thiserror::Error;

/// A homogeneous, isotropic, linear-elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Poisson's ratio nu (dimensionless), above -1 and below 0.5.
    pub poisson: f64,
    /// Density rho in the reference configuration (kg/m^3).
    pub density: f64,
}

/// A material constant outside its physical range.
#[derive(Debug, Error, PartialEq)]
#[error("{property} = {value} is outside {range}")]
pub struct MaterialError {
    /// Name of the constant.
    pub property: &'static str,
    /// Its value, in the unit that `property` names.
    pub value: f64,
    /// The values allowed, as an open interval.
    pub range: &'static str,
}

impl Material {
    /// The material itself, if its constants are physical.
    ///
    /// # Errors
    /// Young's modulus or a density that is not positive and finite, or Poisson's ratio outside (-1, 0.5).
    pub fn checked(self) -> Result<Self, MaterialError> {
        let positive = |property, value: f64| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(MaterialError { property, value, range: "(0, inf)" })
            }
        };
        positive("Young's modulus (Pa)", self.young)?;
        positive("the density (kg/m^3)", self.density)?;
        if !(self.poisson > -1.0 && self.poisson < 0.5) {
            let (property, range) = ("Poisson's ratio", "(-1, 0.5)");
            return Err(MaterialError { property, value: self.poisson, range });
        }
        Ok(self)
    }

    /// First Lamé constant lambda = E nu/((1 + nu)(1 - 2 nu)) (Pa).
    pub fn lame(&self) -> f64 {
        self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
    }

    /// Shear modulus G = E/(2(1 + nu)) (Pa).
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Bulk modulus K = E/(3(1 - 2 nu)) (Pa).
    pub fn bulk(&self) -> f64 {
        self.young / (3.0 * (1.0 - 2.0 * self.poisson))
    }

    /// P-wave modulus lambda + 2G (Pa).
    pub fn p_modulus(&self) -> f64 {
        self.lame() + 2.0 * self.shear()
    }

    /// The modulus that scales the hourglass stiffness of one-point elements (Pa): lambda + 2G (Flanagan and Belytschko
    /// 1981), which is 3.5 G at nu = 0.3, and 3.5 G above. Hourglass modes keep the mean volume, so their stiffness
    /// must not grow without bound as a material becomes incompressible (Belytschko and Bindeman 1993).
    pub fn hourglass_modulus(&self) -> f64 {
        if self.poisson <= 0.3 { self.p_modulus() } else { 3.5 * self.shear() }
    }

    /// Dilatational wave speed c_p = sqrt((lambda + 2G)/rho) (m/s).
    pub fn c_p(&self) -> f64 {
        (self.p_modulus() / self.density).sqrt()
    }

    /// Shear wave speed c_s = sqrt(G/rho) (m/s).
    pub fn c_s(&self) -> f64 {
        (self.shear() / self.density).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steel_has_the_wave_speeds_of_the_reference_model() {
        let steel = Material { young: 210e9, poisson: 0.3, density: 7850.0 };
        assert!((steel.c_p() - 6001.0).abs() < 0.5, "{}", steel.c_p());
        assert!((steel.c_s() - 3208.0).abs() < 0.5, "{}", steel.c_s());
        assert!((steel.bulk() - 175e9).abs() < 1.0);
    }

    #[test]
    fn hourglass_stiffness_follows_the_p_modulus_to_steel_and_the_shear_modulus_beyond() {
        let of = |poisson| Material { young: 210e9, poisson, density: 7850.0 };
        for poisson in [-0.5, 0.0, 0.25, 0.3] {
            assert_eq!(of(poisson).hourglass_modulus(), of(poisson).p_modulus());
        }
        // continuous where the rule changes
        let [below, above] = [0.3, 0.3 + 1e-12].map(|poisson| of(poisson).hourglass_modulus());
        assert!((above / below - 1.0).abs() < 1e-11, "{below} {above}");
        // and bounded where lambda + 2G is not
        let rubber = of(0.4999);
        assert!((rubber.hourglass_modulus() / rubber.shear() - 3.5).abs() < 1e-12);
        assert!(rubber.p_modulus() > 1000.0 * rubber.shear());
    }

    #[test]
    fn an_incompressible_material_is_refused() {
        let m = Material { young: 1.0, poisson: 0.5, density: 1.0 };
        assert!(m.checked().is_err());
        assert!(Material { poisson: 0.3, young: f64::NAN, ..m }.checked().is_err());
    }
}
