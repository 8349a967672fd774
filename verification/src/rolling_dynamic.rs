//! Steady rolling by explicit dynamics, with penalty and with exact contact, compared with CONTACT.
//!
//! The reference case A (Coulomb friction 0.5, 100 kN, wheel on crown) rolls 60 mm at the creepages
//! at which CONTACT finds T/N = 0.15, 0.28 and 0.40. Results are means over the last 20 mm. The bias of the
//! penalty is removed by extrapolation: penetration and elastic slip of the springs are
//! proportional to 1/SF, so that `v = v_b + (v_b - v_a)/(SF_b/SF_a - 1)`.
//!
//! A run prescribes the creepage and yields the force; the creepage at CONTACT's T/N follows with the slope
//! of CONTACT's creep-force curve there. It is counted from free rolling: without tangential force the disk on the bar
//! turns faster than V/R, unlike half-spaces (finite_body.rs).
//!
//! Convergence is of first order, as for static contact on such a mesh, since the patch ends between two nodes.
//! Creepage and peak shear are compared after extrapolation to h = 0. The limit is the grid convergence index plus the
//! effect of the shape of the bodies, a over the smaller radius.

use crate::convergence::Convergence;
use crate::half_space::WHEEL;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use creepage::case::Case;
use creepage::run::RunOptions;
use creepage::{StressProfile, StressProfileOptions};
use output::summary::{Mean, Status, Summary};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The reference case A.
const CASE: &str = include_str!("../../cases/zhao-li/a-coulomb.toml");

const SOURCE: &str = "CONTACT (Vollebregt), h -> 0: creepage, stick border on y = 0, peak shear";

/// CONTACT at h -> 0 for mu 0.5.
struct Reference {
    /// T/N.
    traction: f64,
    /// Creepage.
    creepage: f64,
    /// Slope d(T/N)/d(creepage) of the creep-force curve at this creepage.
    slope: f64,
    /// Border of stick on y = 0 (m).
    border: f64,
    /// Peak shear (Pa).
    peak: f64,
}

const REFERENCES: [Reference; 3] = [
    Reference {
        traction: 0.28,
        creepage: 2.4348e-3,
        slope: 86.3,
        border: -3.225e-3,
        peak: 552.8e6,
    },
    Reference {
        traction: 0.15,
        creepage: 1.1554e-3,
        slope: 113.9,
        border: -5.275e-3,
        peak: 416.2e6,
    },
    Reference {
        traction: 0.40,
        creepage: 4.1370e-3,
        slope: 55.5,
        border: -0.425e-3,
        peak: 617.6e6,
    },
];

/// Scale factors SF of the penalty for the extrapolation.
const FACTORS: [f64; 2] = [0.3, 1.0];

/// The results of a run.
#[derive(Clone, Copy)]
struct Rolled {
    /// Creepage at the T/N of the reference.
    creepage: f64,
    /// Border of stick on y = 0 (m).
    border: f64,
    /// Peak shear (Pa).
    peak: f64,
    /// Relative error of the energy balance.
    balance: f64,
}

/// Largest relative error of the creepage that passes.
const REQUIRED: f64 = 0.05;
/// Creepage of free rolling of the disk on the bar (finite_body.rs, 1 mm).
const FREE: f64 = 2.2e-5;

/// Penalty, extrapolated to rigid springs, at the first reference.
pub(crate) fn run(size: Size) -> Outcome {
    series(size, &REFERENCES[..1], 2e-5, |reference, h| {
        let [soft, stiff] = FACTORS.map(|factor| {
            let springs = ["normal", "tangential"];
            rolled(reference, h, &springs.map(|s| format!("contact.penalty.{s}={factor}")))
        });
        Ok(without_penalty(soft?, stiff?))
    })
}

/// Exact enforcement: one run, nothing to extrapolate.
pub(crate) fn run_exact(size: Size) -> Outcome {
    let exact = ["contact.enforcement=\"exact\"".to_owned()];
    let references = match size {
        Size::Quick => &REFERENCES[..1],
        Size::Full => &REFERENCES,
    };
    series(size, references, 2e-6, |reference, h| rolled(reference, h, &exact))
}

/// The rows of `references` on meshes of 2 mm and, at [`Size::Full`], 1 mm. A coarser mesh has two and a half elements
/// in the half length of the patch and shows no order of convergence. The energy balance may miss `balance`.
fn series(
    size: Size,
    references: &[Reference],
    balance: f64,
    roll: impl Fn(&Reference, f64) -> Result<Rolled, Cause>,
) -> Outcome {
    let meshes: &[f64] = match size {
        Size::Quick => &[2e-3],
        Size::Full => &[2e-3, 1e-3],
    };
    let mut rows = Vec::new();
    for reference in references {
        let mut found = Vec::new();
        for &h in meshes {
            found.push((h, roll(reference, h)?));
        }
        rows.extend(judged(reference, &found, balance));
    }
    Ok(rows)
}

fn judged(reference: &Reference, found: &[(f64, Rolled)], balance: f64) -> Vec<Row> {
    let Some(&(finest, last)) = found.last() else { return Vec::new() };
    let study = |of: fn(&Rolled) -> f64| {
        Convergence::by_theory(found.iter().map(|(h, rolled)| (*h, of(rolled))), 1.0)
    };
    let at = |what: &str| format!("T/N {}: {what}", reference.traction);
    let [a, _] = WHEEL.half_axes;
    let bodies = (a / WHEEL.radii[1], "bodies that are no half-spaces, a over the smaller radius");
    let border = study(|r| r.border);
    let row = Row::new(
        at("border of stick (m), error in elements"),
        [reference.border, border.finest()],
        finest,
        (0.5, "half an element: it lies between two nodes"),
        SOURCE,
    );
    let creepage = study(|r| r.creepage - FREE);
    let what = at("creepage, less that of free rolling");
    let mut rows = vec![
        Row { meshes: border.samples().to_vec(), ..row },
        Row::new(
            at("energy balance error"),
            [0.0, last.balance],
            1.0,
            (balance, "asked of this problem"),
            "energy",
        ),
    ];
    if found.len() == 1 {
        // one mesh shows no uncertainty
        rows.push(Row::asked(what, [reference.creepage, creepage.finest()], REQUIRED, SOURCE));
        return rows;
    }
    let row = Row::extrapolated(&what, reference.creepage, &creepage, bodies, SOURCE);
    rows.push(row.at_most(REQUIRED));
    let peak = at("peak shear (Pa)");
    rows.push(Row::extrapolated(&peak, reference.peak, &study(|r| r.peak), bodies, SOURCE));
    rows
}

/// Results extrapolated to SF -> infinity; the balance error is the larger of the two.
fn without_penalty(soft: Rolled, stiff: Rolled) -> Rolled {
    let beyond = 1.0 / (FACTORS[1] / FACTORS[0] - 1.0);
    let at = |of: fn(&Rolled) -> f64| of(&stiff) + beyond * (of(&stiff) - of(&soft));
    Rolled {
        creepage: at(|r| r.creepage),
        border: at(|r| r.border),
        peak: at(|r| r.peak),
        balance: soft.balance.max(stiff.balance),
    }
}

/// A run whose summary lacks a mean.
#[derive(Debug, thiserror::Error)]
#[error("the run ended with the status '{status}' and without {key}")]
pub(crate) struct Missing {
    status: &'static str,
    key: &'static str,
}

/// A mean of a run.
pub(crate) fn mean(summary: &Summary, mean: Mean) -> Result<f64, Missing> {
    let status = summary.status.map_or("", Status::word);
    summary.mean(mean).ok_or(Missing { status, key: mean.key().1 })
}

/// Runs the case with elements of `h` (m) at the creepage of the reference, with `more` keys set.
fn rolled(reference: &Reference, h: f64, more: &[String]) -> Result<Rolled, Cause> {
    let creepage = format!("drive.creepage={}", reference.creepage);
    let summary = run_at(h, [more, &[creepage]].concat())?;
    let traction = mean(&summary, Mean::TractionCoefficient)?;
    Ok(Rolled {
        creepage: mean(&summary, Mean::Creepage)?
            + (reference.traction - traction) / reference.slope,
        border: mean(&summary, Mean::StickBorder)?,
        peak: mean(&summary, Mean::PeakShear)?,
        balance: summary.energy.balance_error,
    })
}

/// Runs the case with elements of `h` (m) and `more` keys set.
pub(crate) fn run_at(h: f64, more: Vec<String>) -> Result<Summary, Cause> {
    let mut sets = vec![
        format!("mesh.zone.size={h}"),
        "output.probes.bar=[]".into(),
        "output.probes.disk=[]".into(),
    ];
    sets.extend(more);
    run_case(CASE, "a-coulomb.toml", &sets)
}

/// The same of the case with this text and file name.
pub(crate) fn run_case(text: &str, name: &str, sets: &[String]) -> Result<Summary, Cause> {
    run_and_read(text, name, sets, |_, summary| Ok(summary))
}

/// The same, and what `read` finds in the folder of the run.
fn run_and_read<T>(
    text: &str,
    name: &str,
    sets: &[String],
    read: impl FnOnce(&Path, Summary) -> Result<T, Cause>,
) -> Result<T, Cause> {
    let case = Case::from_text(text, Path::new(name), sets)?;
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("run");
    let options = RunOptions { case: name.into(), out: Some(out.clone()), ..RunOptions::default() };
    let summary = creepage::run::run(&case, &options, &AtomicBool::new(false), &mut |_| {})?;
    read(&out, summary)
}

/// The stress below the patch of the case with `sets`: of the disk and of the bar.
pub(crate) fn stress_below(sets: &[String]) -> Result<[StressProfile; 2], Cause> {
    run_and_read(CASE, "a-coulomb.toml", sets, |folder, _| {
        let options = StressProfileOptions { run: folder.to_owned() };
        Ok(creepage::stress_profile(&options)?)
    })
}
