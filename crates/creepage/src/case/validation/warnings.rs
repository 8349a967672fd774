//! What is allowed but deserves a warning.

use super::path::least_half_axis;
use super::{mm, steps};
use crate::case::hertz::{dundurs_beta, hertz};
use crate::case::schema::{Case, Stiffness};
use crate::case::units::mistaken;
use crate::case::value::{digits, number};

/// More steps than these deserve a warning.
const MANY_STEPS: f64 = 1e7;

/// Young's modulus below this (Pa) and density outside these bounds (kg/m^3) are likely given in other units.
const SOFTEST: f64 = 5e5;
const LIGHTEST: f64 = 20.0;
const HEAVIEST: f64 = 2.5e4;

/// What is allowed but deserves a warning, one sentence each.
pub fn warnings(case: &Case) -> Vec<String> {
    let mut found: Vec<String> = left_out(case).into_iter().collect();
    found.extend(units(case));
    found.extend(mistaken(&case.table()));
    found.extend(of_step_and_mesh(case));
    found.extend(of_creepage(case));
    found.extend(of_springs_and_windows(case));
    found
}

/// Keys of the layers below that have no meaning for the model.
fn left_out(case: &Case) -> Option<String> {
    let (model, keys) = (case.model.word(), &case.written.left_out);
    let keys = (!keys.is_empty()).then(|| keys.join(", "))?;
    Some(format!("without meaning for model = \"{model}\" and left out: {keys}"))
}

/// Materials whose numbers look as if given in another unit.
pub(super) fn units(case: &Case) -> Vec<String> {
    let mut found = Vec::new();
    for (body, own, material) in [
        ("disk", &case.disk.material, case.disk_material()),
        ("bar", &case.bar.material, case.bar_material()),
    ] {
        let path = |key: &str, is_own: bool| {
            if is_own { format!("{body}.material.{key}") } else { format!("material.{key}") }
        };
        let modulus =
            format!("{} = {} Pa", path("young", own.young.is_some()), number(material.young));
        let density = format!(
            "{} = {} kg/m^3",
            path("density", own.density.is_some()),
            number(material.density)
        );
        if material.young < SOFTEST {
            found
                .push(format!("{modulus} is softer than rubber: is it in MPa? steel has 210e9 Pa"));
        }
        if material.density < LIGHTEST {
            found.push(format!(
                "{density} is lighter than foam: is it in g/cm^3? steel has 7850 kg/m^3"
            ));
        } else if material.density > HEAVIEST {
            found.push(format!("{density} is heavier than any metal: steel has 7850 kg/m^3"));
        }
    }
    found.sort();
    found.dedup();
    found
}

/// Elements without stiffness, unstable or very many steps, and a mesh that is coarse for the patch.
fn of_step_and_mesh(case: &Case) -> impl Iterator<Item = String> {
    let (factor, steps, patch, size) =
        (case.factor(), steps(case), hertz(case), case.mesh.zone.size);
    [
        (case.element.hourglass == 0.0).then(|| {
            "element.hourglass = 0: nothing holds the elements against hourglassing".into()
        }),
        (factor > 1.0 && !case.is_half_space()).then(|| {
            format!("time.factor = {factor} is above 1: THE RUN IS UNSTABLE and will blow up")
        }),
        (steps > MANY_STEPS).then(|| {
            let hours = steps * 1e-3 / 3600.0;
            format!(
                "the run needs about {steps:.1e} time steps, at a millisecond each {hours:.0} hours"
            )
        }),
        (size > 0.5 * least_half_axis(case, &patch)).then(|| {
            let (size, a, b) = (mm(size), mm(patch.a), mm(patch.b));
            format!("mesh.zone.size = {size} mm is coarse for a patch of half axes {a} and {b} mm")
        }),
    ]
    .into_iter()
    .flatten()
}

/// A creepage that does not mean what it seems to, or changes while means are taken.
fn of_creepage(case: &Case) -> impl Iterator<Item = String> {
    let (beta, [from, _]) = (dundurs_beta(case), case.evaluation_window());
    let milliseconds = |time: f64| digits(1e3 * time);
    let begins = milliseconds(from);
    let changes = |creepage: &crate::case::schema::Creepage| creepage.changes_after(from);
    [
        (beta.abs() > 1e-6).then(|| {
            format!(
                "the materials of disk and bar differ (Dundurs' beta {beta:.3}): creepage 0 is not free rolling, and \
                 creep-force curves are shifted by the creepage that a run with drive.torque = 0 finds"
            )
        }),
        (case.drive.rises() && case.drive.ramp() > from).then(|| {
            let ends = milliseconds(case.drive.ramp());
            format!("the evaluation window begins at {begins} ms, before the drive's ramp ends at {ends} ms")
        }),
        case.drive.creepage.as_ref().is_some_and(changes).then(|| {
            format!(
                "drive.creepage still changes after {begins} ms, where the evaluation window begins: means are over the \
                 change"
            )
        }),
    ]
    .into_iter()
    .flatten()
}

/// Springs beyond the stability limit, and windows after the end of the run.
fn of_springs_and_windows(case: &Case) -> impl Iterator<Item = String> {
    let penalty = &case.contact.penalty;
    let springs = [("normal", penalty.normal), ("tangential", penalty.tangential)];
    let unstable = springs.into_iter().filter_map(|(key, spring)| match spring {
        Stiffness::Stability(fraction) if fraction > 1.0 => {
            Some(format!("contact.penalty.{key} is {fraction} of the stability limit: unstable"))
        }
        _ => None,
    });
    let end = case.duration();
    let late = case.output.window.iter().filter(move |window| window.from >= end);
    let late = late.map(move |window| {
        let (from, end) = (number(window.from), digits(end));
        format!("an output window begins at {from} s, after the end of the run at {end} s")
    });
    unstable.chain(late)
}
