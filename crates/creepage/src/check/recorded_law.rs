//! The friction law of a run, read from its case and summary, by which its coefficients are recomputed.

use friction::{Expression, FrictionLaw as _, Kind, NodeFriction, Parameters, Table};
use std::sync::Arc;

/// The law of a contact node with its state.
#[derive(Clone, Debug)]
pub struct RecordedLaw {
    /// The law.
    pub law: Arc<dyn NodeFriction>,
    /// Relative accuracy of its coefficient: zero for a law that the case states.
    pub known_to: f64,
}

/// The friction law of the case of a run; only its tables `friction` and `contact` are read. `sampled` are the
/// points of a law that was supplied as a function of Python.
///
/// # Errors
/// The reason why there is none, as half a sentence.
pub(crate) fn recorded_law(
    case: &toml::Table,
    sampled: Option<&[[f64; 2]]>,
) -> Result<RecordedLaw, String> {
    let table = case.get("friction").ok_or("the case has no [friction]")?;
    let mut parameters: Parameters = table
        .clone()
        .try_into()
        .map_err(|error: toml::de::Error| format!("[friction] of the case: {}", error.message()))?;
    if let Some(key) = parameters.missing() {
        return Err(format!("friction.{key} is missing in the case"));
    }
    let mut known_to = 0.0;
    if parameters.law == Kind::Python {
        let points = sampled.map(<[_]>::to_vec);
        let points =
            points.ok_or("the run has left no points of its law \"python\" (summary.json)")?;
        known_to = interpolation_error(&points);
        parameters = Parameters { law: Kind::Table, table: Some(points), ..parameters };
    }
    let contact = case.get("contact").and_then(|contact| contact.get("enforcement"));
    parameters.write_defaults(contact.and_then(toml::Value::as_str) == Some("exact"));
    let law = parameters.node_friction(Expression::untried, None).map_err(|e| e.to_string())?;
    Ok(RecordedLaw { law: law.into(), known_to })
}

/// Largest relative error of linear interpolation between every second point at the points in between: for a
/// smooth law four times the error of interpolation between all points.
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
    use friction::{Exponential, Implicit, NodeConditions, OwnLaw, sampled};

    const PAPER: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };

    /// Eq. (8) brought along.
    #[derive(Debug)]
    struct Brought;

    impl OwnLaw for Brought {
        fn mu(&self, slip_speeds: &[f64], mu: &mut [f64]) {
            mu.iter_mut().zip(slip_speeds).for_each(|(mu, s)| *mu = PAPER.mu(*s));
        }

        fn failure(&self) -> Option<String> {
            None
        }
    }

    #[test]
    fn a_law_that_was_brought_along_is_known_from_its_points_to_what_is_said() {
        let points = sampled(&Brought).unwrap();
        let case =
            "[friction]\nlaw = \"python\"\nsource = \"-\"\nmode = \"exact\"".parse().unwrap();
        let RecordedLaw { law, known_to } = recorded_law(&case, Some(&points)).unwrap();
        assert!(known_to < 1e-4, "{known_to:e}");
        let (at, same) = (NodeConditions::default(), Implicit(PAPER));
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
        assert!(read(text).unwrap().law.is_implicit());
        assert!(!read(&text.replace("exact", "penalty")).unwrap().law.is_implicit());
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
