//! Steady rolling by explicit dynamics, with penalty and with exact contact, beside CONTACT.
//!
//! The reference case A (Coulomb friction 0.5, 100 kN, wheel on crown) rolls 60 mm at the creepages
//! at which CONTACT finds T/N = 0.15, 0.28 and 0.40; means over the last 20 mm. The bias of the
//! penalty is removed by extrapolation: penetration and elastic slip of the springs are
//! proportional to 1/SF, so that `v = v_b + (v_b - v_a)/(SF_b/SF_a - 1)`.
//!
//! A run has a creepage and gives a force; the creepage at CONTACT's own T/N follows with the slope
//! of CONTACT's creep-force curve there.

use crate::convergence::Sample;
use crate::problem::{Outcome, Size};
use crate::row::Row;
use case::{Case, RunOptions};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// What is computed is the reference case itself.
const CASE: &str = include_str!("../../../cases/zhao-li/a-coulomb.toml");

const SOURCE: &str = "CONTACT (Vollebregt), h -> 0: creepage, stick border on y = 0, peak shear";

/// CONTACT at h -> 0 for mu 0.5.
struct Reference {
    /// T/N.
    traction: f64,
    /// Creepage.
    creepage: f64,
    /// d(T/N)/d(creepage) at it, from the creep-force curve.
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

/// Scale factors of the penalty from which is extrapolated.
const FACTORS: [f64; 2] = [0.3, 1.0];

/// What a run is judged by.
#[derive(Clone, Copy)]
struct Rolled {
    creepage: f64,
    border: f64,
    peak: f64,
    balance: f64,
}

/// Penalty, extrapolated to rigid springs.
pub(crate) fn run(size: Size) -> Outcome {
    series(size, &[2e-3, 1e-3, 0.5e-3], |reference, h| {
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
    series(size, &[2e-3, 1e-3], |reference, h| rolled(reference, h, &exact))
}

/// All references on meshes of elements of `full` (m), in quick size one on the coarsest.
fn series(
    size: Size,
    full: &[f64],
    roll: impl Fn(&Reference, f64) -> Result<Rolled, crate::problem::Cause>,
) -> Outcome {
    let (meshes, references): (&[f64], &[Reference]) = match size {
        Size::Quick => (&full[..1], &REFERENCES[..1]),
        Size::Full => (full, &REFERENCES),
    };
    let mut rows = Vec::new();
    for reference in references {
        let mut found = Vec::new();
        for &h in meshes {
            found.push((h, roll(reference, h)?));
        }
        rows.extend(judged(reference, &found));
    }
    Ok(rows)
}

fn judged(reference: &Reference, found: &[(f64, Rolled)]) -> Vec<Row> {
    let Some(&(finest, last)) = found.last() else { return Vec::new() };
    let asked = "asked of this problem";
    let row = |what: &str, expected: f64, scale: f64, limit: f64, of: fn(&Rolled) -> f64| {
        let quantity = format!("T/N {}: {what}", reference.traction);
        let values = [expected, of(&last)];
        let meshes = found.iter().map(|(size, r)| Sample { size: *size, value: of(r) }).collect();
        Row { meshes, ..Row::new(quantity, values, scale, (limit, asked), SOURCE) }
    };
    let creepage = reference.creepage;
    let mut rows = vec![
        row("creepage", creepage, creepage, 0.1, |r| r.creepage),
        row("border of stick (m), error in elements", reference.border, finest, 1.0, |r| r.border),
        row("energy balance error", 0.0, 1.0, 1e-3, |r| r.balance),
    ];
    // asked of 0.5 mm: the ridge of the shear is narrower than coarser elements
    if finest <= 0.5e-3 {
        rows.push(row("peak shear (Pa)", reference.peak, reference.peak, 0.05, |r| r.peak));
    }
    rows
}

/// Extrapolated to SF -> infinity; the balance error is the larger one.
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

/// A run whose summary lacks a number.
#[derive(Debug, thiserror::Error)]
#[error("the run ended with the status '{status}' and without {key}")]
struct Missing {
    status: String,
    key: &'static str,
}

/// The case with elements of `h` (m) at the reference's creepage, with more keys set.
fn rolled(reference: &Reference, h: f64, more: &[String]) -> Result<Rolled, crate::problem::Cause> {
    let creepage = reference.creepage;
    let mut sets = vec![
        format!("mesh.zone.size={h}"),
        format!("drive.creepage={creepage}"),
        "output.probes.bar=[]".into(),
        "output.probes.disk=[]".into(),
    ];
    sets.extend_from_slice(more);
    let case = Case::from_text(CASE, Path::new("a-coulomb.toml"), &sets)?;
    let folder = tempfile::tempdir()?;
    let options = RunOptions {
        preload_cache: None,
        out: folder.path().join("run"),
        threads: std::thread::available_parallelism().map_or(1, |n| n.get()),
        force: false,
        resume: false,
        source: "a-coulomb.toml".into(),
        law: None,
    };
    let summary = case::run(&case, &options, &AtomicBool::new(false), &mut |_| {})?;
    let number = |section: &str, key: &'static str| {
        let status = summary["status"].as_str().unwrap_or_default().to_owned();
        summary[section][key].as_f64().ok_or(Missing { status, key })
    };
    let traction = number("contact", "traction_coefficient")?;
    Ok(Rolled {
        creepage: number("contact", "creepage")?
            + (reference.traction - traction) / reference.slope,
        border: number("window", "stick_border")?,
        peak: number("window", "peak_shear")?,
        balance: number("energy", "balance_error")?,
    })
}
