//! Invariants of a stress with the components xx yy zz xy yz xz (Pa), tension positive.

use nalgebra::Matrix3;

/// Von Mises stress (Pa), sqrt(3 J_2): the size of the pull that yields as early (von Mises 1913).
pub fn von_mises([xx, yy, zz, xy, yz, xz]: &[f64; 6]) -> f64 {
    let square = |x: f64| x * x;
    let normal = square(xx - yy) + square(yy - zz) + square(zz - xx);
    (0.5 * normal + 3.0 * (square(*xy) + square(*yz) + square(*xz))).sqrt()
}

/// Largest shear stress (Pa): half the difference of the largest and the smallest principal stress.
pub fn max_shear(stress: &[f64; 6]) -> f64 {
    let [largest, _, smallest] = principal(stress);
    0.5 * (largest - smallest)
}

/// Hydrostatic stress (Pa), a third of the trace.
pub fn hydrostatic([xx, yy, zz, ..]: &[f64; 6]) -> f64 {
    (xx + yy + zz) / 3.0
}

/// Principal stresses (Pa), the largest first.
pub fn principal([xx, yy, zz, xy, yz, xz]: &[f64; 6]) -> [f64; 3] {
    let tensor = Matrix3::new(*xx, *xy, *xz, *xy, *yy, *yz, *xz, *yz, *zz);
    let mut values: [f64; 3] = tensor.symmetric_eigenvalues().into();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn von_mises_of_pull_of_shear_and_of_pressure() {
        assert_eq!(von_mises(&[-3.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 3.0);
        assert!((von_mises(&[0.0, 0.0, 0.0, 0.0, 2.0, 0.0]) - 12f64.sqrt()).abs() < 1e-15);
        assert_eq!(von_mises(&[7.0, 7.0, 7.0, 0.0, 0.0, 0.0]), 0.0);
    }

    #[test]
    fn principal_stresses_are_those_of_mohrs_circle_the_largest_first() {
        // in the plane xz: centre 1, radius 5; across it -7
        let stress = [4.0, -7.0, -2.0, 0.0, 0.0, 4.0];
        for (found, known) in principal(&stress).into_iter().zip([6.0, -4.0, -7.0]) {
            assert!((found - known).abs() < 1e-13, "{found} {known}");
        }
        assert!((max_shear(&stress) - 6.5).abs() < 1e-13);
        assert!((hydrostatic(&stress) + 5.0 / 3.0).abs() < 1e-15);
    }
}
