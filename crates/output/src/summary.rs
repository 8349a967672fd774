//! The summary of a run: what `creepage run --json` prints and `summary.json` holds.

use crate::layout::file;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It reached the end time of its case.
    Completed,
    /// A signal interrupted it; the results so far are readable.
    Interrupted,
    /// Its guards stopped it.
    Failed,
}

/// The summary of a run at its end; numbers in SI units unless a field says otherwise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the case.
    pub name: String,
    /// How the run ended.
    pub status: Status,
    /// Time steps taken.
    pub steps: u64,
    /// Time step (s).
    pub dt: f64,
    /// Simulated time reached (s).
    pub t_end: f64,
    /// Elements of both bodies.
    pub elements: u64,
    /// Nodes of both bodies.
    pub nodes: u64,
    /// Threads used.
    pub threads: u64,
    /// Wall-clock time of the run (s).
    pub wall_s: f64,
    /// Elements times steps over the wall-clock time of the time loop (1/s).
    pub element_steps_per_s: f64,
    /// Largest resident memory of the process (MB).
    pub peak_rss_mb: f64,
    /// Energies at the end of the run.
    pub energy: Energy,
    /// Means over the evaluation window.
    pub contact: Contact,
    /// Files of the run, relative to its folder.
    pub files: Files,
    /// Wall-clock time per stage of the run (s).
    #[serde(default)]
    pub stages: BTreeMap<String, f64>,
    /// Further sections, each under its own key.
    #[serde(flatten)]
    pub extra: BTreeMap<String, serde_json::Value>,
}

/// The energy balance of both bodies at the end of the run (J), and its error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Kinetic energy (J).
    pub kinetic: f64,
    /// Strain energy of the elements (J).
    pub internal: f64,
    /// Energy of the hourglass stiffness (J).
    pub hourglass: f64,
    /// Energy in the contact springs (J).
    pub contact_stored: f64,
    /// Work of friction turned into heat so far (J).
    pub friction_dissipated: f64,
    /// Work of all dampers turned into heat so far (J).
    pub damping_dissipated: f64,
    /// Work of prescribed motion and load so far (J).
    pub external_work: f64,
    /// |sum of energies - external work - initial sum| over the largest energy exchanged (dimensionless).
    pub balance_error: f64,
}

/// Means over the evaluation window; forces are those of the bar on the disk in the global frame (x rolls, y is
/// lateral, z is up). `None` (null) where there is no value, such as where Hertz's distribution fits no pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Normal force (N).
    pub normal_force: Option<f64>,
    /// Force along x, the rolling direction (N); positive when driving.
    pub tangential_force: Option<f64>,
    /// Force along y, across the rolling direction (N).
    pub lateral_force: Option<f64>,
    /// Tangential over normal force (dimensionless).
    pub traction_coefficient: Option<f64>,
    /// (omega R_eff - V)/V (dimensionless).
    pub creepage: Option<f64>,
    /// Half axis along x of the fitted distribution (m).
    pub patch_half_length: Option<f64>,
    /// Half axis along y of the fitted distribution, or half the width of a line contact (m).
    pub patch_half_width: Option<f64>,
    /// Area of the bar's nodes in contact (m2).
    pub patch_area: Option<f64>,
    /// Area of the fitted ellipse, or of a line contact's rectangle (m2).
    pub patch_area_fitted: Option<f64>,
    /// Peak pressure of Hertz's distribution fitted to the nodal pressures (Pa).
    pub peak_pressure: Option<f64>,
    /// Share of the patch's area that sticks (dimensionless).
    pub stick_fraction: Option<f64>,
    /// Share of the patch's area that slips (dimensionless).
    pub slip_fraction: Option<f64>,
}

/// Files of a run, relative to its folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Files {
    /// Fields of both bodies; empty where the run has no such file.
    pub fields: String,
    /// Both contact surfaces.
    pub contact: String,
    /// Scalars over time.
    pub history: String,
    /// The state in which the guards stopped the run, if they did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub postmortem: Option<String>,
}

impl Default for Files {
    fn default() -> Self {
        Self {
            fields: file::FIELDS.into(),
            contact: file::CONTACT.into(),
            history: file::HISTORY.into(),
            postmortem: None,
        }
    }
}

impl Files {
    /// Those of a run that does not record its bodies.
    pub fn without_fields() -> Self {
        Self { fields: String::new(), ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use serde_json::{Value, json};

    fn summary() -> Summary {
        Summary {
            name: "quick".into(),
            status: Status::Interrupted,
            steps: 10,
            dt: 1e-7,
            t_end: 1e-6,
            elements: 2,
            nodes: 12,
            threads: 1,
            wall_s: 0.1,
            element_steps_per_s: 200.0,
            peak_rss_mb: 3.0,
            energy: Energy::default(),
            contact: Contact::default(),
            files: Files::default(),
            stages: [("contact".to_owned(), 0.5)].into(),
            extra: [("half_space".to_owned(), json!({ "p0": 1.0 }))].into(),
        }
    }

    fn keys(value: &Value) -> Vec<&str> {
        let mut keys: Vec<_> = value.as_object().unwrap().keys().map(String::as_str).collect();
        keys.sort_unstable();
        keys
    }

    #[test]
    fn the_keys_are_those_that_scripts_rely_on() {
        let value = serde_json::to_value(summary()).unwrap();
        let mut expected = vec![
            "name",
            "status",
            "steps",
            "dt",
            "t_end",
            "elements",
            "nodes",
            "threads",
            "wall_s",
            "element_steps_per_s",
            "peak_rss_mb",
            "energy",
            "contact",
            "files",
            "stages",
            "half_space",
        ];
        expected.sort_unstable();
        assert_eq!(keys(&value), expected);
        assert_eq!(value["status"], "interrupted");
        let mut energy = vec![
            "kinetic",
            "internal",
            "hourglass",
            "contact_stored",
            "friction_dissipated",
            "damping_dissipated",
            "external_work",
            "balance_error",
        ];
        energy.sort_unstable();
        assert_eq!(keys(&value["energy"]), energy);
        let mut contact = vec![
            "normal_force",
            "tangential_force",
            "lateral_force",
            "traction_coefficient",
            "creepage",
            "patch_half_length",
            "patch_half_width",
            "patch_area",
            "patch_area_fitted",
            "peak_pressure",
            "stick_fraction",
            "slip_fraction",
        ];
        contact.sort_unstable();
        assert_eq!(keys(&value["contact"]), contact);
        assert_eq!(keys(&value["files"]), ["contact", "fields", "history"]);
    }

    #[test]
    fn a_summary_reads_back() {
        let text = serde_json::to_string(&summary()).unwrap();
        assert_eq!(serde_json::from_str::<Summary>(&text).unwrap(), summary());
    }
}
