//! The friction law of a run from what the run left, to make its coefficients again.

use super::own::OwnLaw;
use super::{Friction, FrictionLaw, Uses, node_friction, path};
use contact::{Expression, FrictionLaw as _, NodeFriction, Table};
use serde_json::Value;

/// Key of the summary: points of a law that was handed over with the run, pairs of slip speed (m/s) and
/// coefficient.
pub const SAMPLED_LAW: &str = "friction_law";

/// Slip speeds at which such a law is sampled: at rest, and so many per decade from 1e-6 to 1e2 m/s.
const PER_DECADE: u32 = 100;

/// Points of a law that was handed over with the run; none of one that failed.
pub(crate) fn sampled(law: &dyn OwnLaw) -> Option<Vec<[f64; 2]>> {
    if law.failure().is_some() {
        return None;
    }
    let decades = f64::from(PER_DECADE);
    let speeds = (0..=8 * PER_DECADE).map(|i| libm::pow(10f64, -6.0 + f64::from(i) / decades));
    let speeds: Vec<f64> = std::iter::once(0.0).chain(speeds).collect();
    let mut mu = vec![0.0; speeds.len()];
    law.mu(&speeds, &mut mu);
    let points = speeds.into_iter().zip(mu).map(|(speed, mu)| [speed, mu]);
    law.failure().is_none().then(|| points.collect())
}

/// The friction law of a case as it lies beside results, whatever its other keys, and the part of the
/// coefficient to which it is known. `sampled` are the points of a law that was handed over with the run.
///
/// # Errors
/// Why there is none, as half a sentence.
pub fn recorded_law(
    case: &toml::Table,
    sampled: Option<&Value>,
) -> Result<(Box<dyn NodeFriction>, f64), String> {
    let table = case.get("friction").ok_or("the case has no [friction]")?;
    let mut friction: Friction = table
        .clone()
        .try_into()
        .map_err(|error: toml::de::Error| format!("[friction] of the case: {}", error.message()))?;
    let needed = Uses::of(friction.law).needs;
    if let Some(key) = needed.iter().find(|key| !friction.given().any(|given| given == **key)) {
        return Err(format!("{} is missing in the case", path(key)));
    }
    let mut known_to = 0.0;
    if friction.law == FrictionLaw::Python {
        let points = sampled.and_then(|points| serde_json::from_value(points.clone()).ok());
        let points: Vec<[f64; 2]> =
            points.ok_or("the run has left no points of its law \"python\" (summary.json)")?;
        known_to = interpolation_error(&points);
        friction = Friction { law: FrictionLaw::Table, table: Some(points), ..friction };
    }
    let contact = case.get("contact").and_then(|contact| contact.get("enforcement"));
    friction.write_defaults(contact.and_then(toml::Value::as_str) == Some("exact"));
    let law = node_friction(&friction, Expression::untried, None).map_err(|e| e.to_string())?;
    Ok((law, known_to))
}

/// What linear interpolation between every second point is off at those between, relative: of a smooth law
/// four times what it is off between all.
fn interpolation_error(points: &[[f64; 2]]) -> f64 {
    let Ok(coarse) = Table::new(points.iter().step_by(2).copied().collect()) else { return 1.0 };
    let last = points.len() - 1 - (points.len() - 1) % 2;
    let off = |[speed, mu]: &[f64; 2]| (coarse.mu(*speed) - mu).abs() / mu.max(f64::MIN_POSITIVE);
    points[..last].iter().map(off).fold(0.0, f64::max).min(1.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::friction::own::tests::Brought;
    use contact::{Exponential, Implicit, Place};

    const PAPER: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };

    #[test]
    fn a_law_that_was_brought_along_is_known_from_its_points_to_what_is_said() {
        let points = serde_json::json!(sampled(&Brought).unwrap());
        let case =
            "[friction]\nlaw = \"python\"\nsource = \"-\"\nmode = \"exact\"".parse().unwrap();
        let (law, known_to) = recorded_law(&case, Some(&points)).unwrap();
        assert!(known_to < 1e-4, "{known_to:e}");
        let (at, same) = (Place::default(), Implicit(PAPER));
        for s in [0.0, 3e-7, 0.0123, 0.17, 2.9] {
            let off = law.mu([0.0; 2], s, &at) / same.mu([0.0; 2], s, &at) - 1.0;
            assert!(off.abs() <= known_to, "{s}: {off:e}");
        }
        assert!(recorded_law(&case, None).is_err());
    }

    #[test]
    fn a_law_is_read_from_its_own_table_alone_and_what_is_missing_is_named() {
        let read = |text: &str| recorded_law(&text.parse().unwrap(), None);
        let text = "other = 1\n[friction]\nlaw = \"rate_state\"\ndistance = 2e-6\n[contact]\n\
                    enforcement = \"exact\"";
        assert!(read(text).unwrap().0.is_implicit());
        assert!(!read(&text.replace("exact", "penalty")).unwrap().0.is_implicit());
        for (text, word) in [
            ("name = \"x\"", "no [friction]"),
            ("[friction]\nlaw = \"prakash_clifton\"\nstatic = 0.3", "friction.distance"),
            ("[friction]\nlaw = \"other\"", "other"),
        ] {
            let said = read(text).unwrap_err();
            assert!(said.contains(word), "{said}");
        }
    }
}
