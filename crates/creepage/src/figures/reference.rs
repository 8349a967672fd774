//! Steady rolling of half-spaces beside a run, computed when asked and kept in the run's folder.

use super::half_space::HalfSpaceShear;
use super::scene::Scene;
use crate::case::Case;
use crate::case::hertz::{hertz, patch_shape};
use crate::chart::minus;
use crate::check::PostError;
use crate::check::basis::RunPaths;
use contact::patch::PatchShape;
use friction::Kind;
use halfspace::{Along, ClosedForms, Ellipse, HalfSpaces, Rigid, SteadyError};
use output::files::input;
use output::layout::file;
use output::write_json_atomically;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// What a run is drawn beside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reference {
    /// Half-spaces in steady rolling with the run's Hertzian contact and friction, at its mean creepage.
    HalfSpace,
}

impl FromStr for Reference {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        (text == "half-space").then_some(Self::HalfSpace).ok_or("half-space is the one reference")
    }
}

/// What steady rolling depends on (SI), and the program that computed it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Inputs {
    creepage_version: String,
    young: f64,
    poisson: f64,
    density: f64,
    half_length: f64,
    half_width: f64,
    peak_pressure: f64,
    mu: f64,
    creepage: f64,
    lateral_creepage: f64,
    spin: f64,
}

/// The file of the reference.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Steady {
    of: Inputs,
    /// Spacing of its points (m).
    spacing: f64,
    /// T/N of half-spaces, and in closed form, where creepage is longitudinal alone.
    traction_coefficient: f64,
    linear: Option<f64>,
    fastsim: Option<f64>,
    cubic: Option<f64>,
    /// The points on y = 0: x from the patch's centre (m), shear (Pa).
    centreline: Vec<[f64; 2]>,
}

/// The reference of a run: that of its folder where it is of the same inputs, else computed.
///
/// It is taken at the run's mean creepage, not at its force: every creepage has one steady state, and a force near or above mu N
/// has none.
///
/// # Errors
/// [`PostError::Asked`] for a run whose bodies, friction or creepage have no such reference.
pub(super) fn steady(scene: &Scene<'_>, paths: &RunPaths) -> Result<HalfSpaceShear, PostError> {
    let asked = |why: String| {
        PostError::Asked(format!("--reference half-space: {}: {why}", scene.basis.name))
    };
    let case = Case::load(&paths.case, &[]).map_err(|error| asked(error.to_string()))?;
    let creepage = scene.means.creepage.ok_or_else(|| asked("it has no mean creepage".into()))?;
    let of = inputs(&case, creepage).map_err(|why| asked(why.into()))?;
    let place = paths.folder.join(file::REFERENCE);
    let kept = input::bytes(&place, input::DOCUMENT).ok();
    let kept = kept.and_then(|bytes| serde_json::from_slice::<Steady>(&bytes).ok());
    let steady = match kept.filter(|kept| kept.of == of) {
        Some(kept) => kept,
        None => {
            let found = computed(of).map_err(|error| asked(error.to_string()))?;
            if let Err(error) = write_json_atomically(&place, &found) {
                tracing::warn!("the reference is not kept: {error}");
            }
            found
        }
    };
    Ok(steady.drawn(scene.means.traction_coefficient))
}

/// The inputs of a case's reference at a creepage, or why it has none.
fn inputs(case: &Case, creepage: f64) -> Result<Inputs, &'static str> {
    let material = case.disk_material();
    let refused = [
        (case.mesh.plane_strain, "mesh.plane_strain = true: it is for elliptic contact"),
        (
            patch_shape(case) == PatchShape::Rectangle,
            "both bodies are flat across: it is for elliptic contact",
        ),
        (
            material != case.bar_material(),
            "disk.material and bar.material differ: half-spaces need one material, since else friction changes the \
             pressure",
        ),
        (
            case.friction.law != Kind::Coulomb,
            "friction.law is not \"coulomb\": where friction depends on slip, rolling need not become steady",
        ),
    ];
    if let Some((_, why)) = refused.into_iter().find(|(is_so, _)| *is_so) {
        return Err(why);
    }
    let hertz = hertz(case);
    Ok(Inputs {
        creepage_version: env!("CARGO_PKG_VERSION").into(),
        young: material.young,
        poisson: material.poisson,
        density: material.density,
        half_length: hertz.a,
        half_width: hertz.b,
        peak_pressure: hertz.p0,
        mu: case.friction.number("static").ok_or("friction.static is not known")?,
        creepage,
        lateral_creepage: case.drive.lateral_creepage,
        spin: case.drive.spin,
    })
}

fn computed(of: Inputs) -> Result<Steady, SteadyError> {
    let bodies = HalfSpaces::new(of.young, of.poisson, of.density);
    let patch = Ellipse {
        half_length: of.half_length,
        half_width: Some(of.half_width),
        peak_pressure: of.peak_pressure,
    };
    let rigid =
        Rigid { along: Along::Creepage(of.creepage), lateral: of.lateral_creepage, spin: of.spin };
    let found = halfspace::steady(bodies, patch, of.mu, rigid)?;
    let forms = closed_forms(&of, bodies.shear_modulus);
    let share = |form: fn(ClosedForms) -> f64| forms.map(|forms| of.mu * form(forms));
    Ok(Steady {
        spacing: found.spacing,
        traction_coefficient: found.traction[0],
        linear: share(|forms| forms.linear),
        fastsim: share(|forms| forms.fastsim),
        cubic: share(|forms| forms.cubic),
        centreline: found.centreline,
        of,
    })
}

/// The closed forms, over mu N: with N = 2 pi a b p0/3 that of the linear theory is G a b C11 xi/(mu N) = 3 G C11 xi/(2 pi mu p0).
fn closed_forms(of: &Inputs, shear_modulus: f64) -> Option<ClosedForms> {
    if of.lateral_creepage != 0.0 || of.spin != 0.0 {
        return None;
    }
    let c11 = halfspace::c11(of.half_length / of.half_width, of.poisson)?;
    let bound = 2.0 * std::f64::consts::PI * of.mu * of.peak_pressure;
    Some(ClosedForms::of(3.0 * shear_modulus * c11 * of.creepage / bound))
}

impl Steady {
    /// The line of Figure 3, and what its caption says; `run` is the run's T/N.
    fn drawn(self, run: Option<f64>) -> HalfSpaceShear {
        let digits = |value: f64| minus(&format!("{value:.4}"));
        let half_space = digits(self.traction_coefficient);
        let all = [
            ("of the run", run),
            ("of half-spaces", Some(self.traction_coefficient)),
            ("by Kalker's linear theory", self.linear),
            ("by FASTSIM", self.fastsim),
            ("by Vermeulen and Johnson's cubic", self.cubic),
        ];
        let numbers: Vec<_> = all
            .into_iter()
            .filter_map(|(whose, value)| Some(format!("{whose} {}", digits(value?))))
            .collect();
        HalfSpaceShear {
            label: format!("p_{{f}}, half-space, steady, T/N = {half_space}"),
            points: self.centreline,
            text: format!(
                " Orange: half-spaces, pressure by Hertz, shear of steady rolling at the run's mean creepage. T/N {}.",
                numbers.join(", ")
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::figures::half_space::{HALF_AXES, MU, PEAK_PRESSURE, TRACTIONS, profile};

    /// The reference wheel at a creepage at which CONTACT finds a T/N of its table.
    fn wheel(creepage: f64) -> Inputs {
        Inputs {
            creepage_version: String::new(),
            young: 210e9,
            poisson: 0.3,
            density: 7800.0,
            half_length: HALF_AXES[0],
            half_width: HALF_AXES[1],
            peak_pressure: PEAK_PRESSURE,
            mu: MU,
            creepage,
            lateral_creepage: 0.0,
            spin: 0.0,
        }
    }

    #[test]
    fn steady_rolling_of_half_spaces_is_that_of_contact() {
        // creepages by CONTACT, extrapolated to h = 0
        for ((traction, column), creepage) in
            TRACTIONS.into_iter().zip([1.1554e-3, 2.4348e-3, 4.1370e-3]).skip(1)
        {
            let found = computed(wheel(creepage)).unwrap();
            let excess = found.traction_coefficient / traction - 1.0;
            // 0.9 and 0.4 %: of first order in the spacing
            assert!((0.0..0.01).contains(&excess), "{traction}: {excess}");
            let profile = profile(column);
            let at = |x: f64| {
                let after = profile.iter().position(|point| point[0] >= x)?;
                let [[x0, y0], [x1, y1]] = [*profile.get(after.checked_sub(1)?)?, profile[after]];
                Some(y0 + (y1 - y0) * (x - x0) / (x1 - x0))
            };
            let squares: Vec<f64> = found
                .centreline
                .iter()
                .filter_map(|[x, shear]| Some((shear - at(*x)?).powi(2)))
                .collect();
            let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            // 0.8 and 1.1 %: half a spacing at the border of stick
            assert!(squares.len() > 30 && rms < 0.015 * MU * PEAK_PRESSURE, "{traction}: {rms}");
            let linear = found.linear.unwrap();
            assert!(linear > found.traction_coefficient && found.fastsim.unwrap() < linear);
        }
    }

    #[test]
    fn other_contact_materials_and_friction_have_no_reference_and_are_told_why() {
        let quick = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/quick.toml");
        let of = |sets: &[&str]| {
            let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
            inputs(&Case::load(quick.as_ref(), &sets).unwrap(), 1e-3)
        };
        assert_eq!(of(&[]).unwrap().mu, 0.5);
        let flat = ["disk.crown_radius=flat", "bar.crown_radius=flat", "mesh.zone.width=0.06"];
        for (sets, why) in [
            (&["friction.law=exponential", "friction.dynamic=0.3"][..], "friction.law"),
            (&["disk.material.young=100e9"], "disk.material and bar.material differ"),
            (&flat, "flat across"),
        ] {
            assert!(of(sets).unwrap_err().contains(why), "{sets:?}");
        }
    }
}
