//! The half-space reference of Figure 3.

use super::scene::Scene;
use crate::check::basis::number_at;
use crate::check::law::Law;

/// Shear along y = 0 by CONTACT (E. A. H. Vollebregt, Apache-2.0) for steady rolling of the
/// reference wheel; the head of the file states its parameters.
const TABLE: &str = include_str!("../../../../verification/data/steady-rolling-y0.csv");
/// T/N of its columns of shear.
pub(super) const TRACTIONS: [(f64, usize); 3] = [(0.15, 2), (0.28, 4), (0.40, 6)];
/// Its coefficient of friction, Poisson's ratio, half axes (m) and peak pressure (Pa).
pub(super) const MU: f64 = 0.5;
const POISSON: f64 = 0.3;
pub(super) const HALF_AXES: [f64; 2] = [7.1617e-3, 5.3872e-3];
pub(super) const PEAK_PRESSURE: f64 = 1.23756e9;

/// Largest difference of T/(mu N) from that of the table.
const NEAR: f64 = 0.05;

/// Shear along y = 0 of half-spaces as it is drawn: label, points x (m), p_f (Pa), and what the caption says.
pub(super) struct HalfSpaceShear {
    pub label: String,
    pub points: Vec<[f64; 2]>,
    pub text: String,
}

/// A column of the table: points x (m), p_f (Pa).
pub(super) fn profile(column: usize) -> Vec<[f64; 2]> {
    let rows =
        TABLE.lines().filter(|line| line.starts_with(|c: char| c == '-' || c.is_ascii_digit()));
    let points = rows.filter_map(|line| {
        let number = |column: usize| line.split(',').nth(column)?.parse::<f64>().ok();
        Some([1e-3 * number(0)?, 1e6 * number(column)?])
    });
    points.collect()
}

/// The reference for a case, where there is one.
///
/// In steady rolling of equal half-spaces with Coulomb friction along x, the shear over mu p0 as a function of
/// x/a depends on Poisson's ratio, a/b and T/(mu N) alone. A case therefore has a reference where its friction is
/// Coulomb's, its Poisson's ratio is 0.3, its a/b within 1 % of the table's, and its T/(mu N) within 0.05 of one of
/// 0.30, 0.56 and 0.80.
pub(super) fn shear(scene: &Scene<'_>) -> Option<HalfSpaceShear> {
    let basis = scene.basis;
    let Some(Law::Coulomb(law)) = basis.law else {
        return None;
    };
    let poisson = basis.case.as_ref().and_then(|case| number_at(case, "material.poisson"));
    let (a, b) = (scene.hertz("half_length")?, scene.hertz("half_width")?);
    let (shape, table_shape) = (a / b, HALF_AXES[0] / HALF_AXES[1]);
    if (poisson? - POISSON).abs() > 1e-6 || (shape / table_shape - 1.0).abs() > 0.01 {
        return None;
    }
    let wanted = scene.means.traction_coefficient?.abs() / law.mu;
    let away = |of: f64| (of / MU - wanted).abs();
    let (of, column) = TRACTIONS.into_iter().min_by(|a, b| away(a.0).total_cmp(&away(b.0)))?;
    if away(of) > NEAR {
        return None;
    }
    let (along, up) =
        (a / HALF_AXES[0], law.mu / MU * scene.hertz("peak_pressure")? / PEAK_PRESSURE);
    let traction = of * law.mu / MU;
    Some(HalfSpaceShear {
        label: format!("p_{{f}}, half-space (CONTACT) at T/N = {traction:.3}"),
        points: profile(column).into_iter().map(|[x, p]| [along * x, up * p]).collect(),
        text: " Orange: half-spaces, pressure by Hertz, shear of steady rolling by CONTACT at the \
               nearest T/N computed."
            .into(),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::TABLE;

    #[test]
    fn the_columns_are_those_of_the_tractions() {
        let head = TABLE.lines().find(|line| line.starts_with("x_mm")).unwrap();
        let names: Vec<&str> = head.split(',').collect();
        for ((traction, column), name) in super::TRACTIONS.into_iter().zip(["015", "028", "040"]) {
            assert_eq!(names[column], format!("tau_{name}_MPa"), "{traction}");
        }
    }
}
