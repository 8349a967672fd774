//! A sphere pressed on a flat and shifted to and fro: Mindlin and Deresiewicz (1953).
//!
//! Under a load N the relative shift of two equal bodies along the surface is d_0 (1 - (1 - x)^(2/3)) when the force first
//! rises to Q = x mu N, with d_0 = 3 mu N (2 - nu)/(8 G a) (Mindlin 1949; [`cattaneo`](crate::cattaneo)). Where it turns back
//! from Q* = x* mu N, every change of traction is that of a first loading under twice the coefficient of friction: a ring of
//! slip backward grows from the edge to the radius a (1 - (x* - x)/2)^(1/3), and the shift is
//!
//! d_0 (2 (1 - (x* - x)/2)^(2/3) - (1 - x*)^(2/3) - 1)
//!
//! down to -Q*; from there back the same with other signs. The loop between both dissipates its area, the integral of Q
//! over the shift (Johnson 1985, "Contact mechanics", section 7.4):
//!
//! W = 24/5 mu N d_0 (1 - (1 - x*)^(5/3) - 5/6 x* (1 + (1 - x*)^(2/3)))
//!
//! These tractions lie along the shift. The lateral displacements that they cause, and that this solution leaves out,
//! are proportional to nu: with nu = 0 it is exact.
//!
//! The problem is a run of the program, [`CASE`], on grids of several spacings. The shift is the integral of speed times
//! creepage. Convergence is of first order: the squares of the grid that the edge of the patch cuts belong to it.

use crate::convergence::Convergence;
use crate::half_space::{column, sizes};
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use creepage::case::Case;
use creepage::case::hertz::hertz;
use creepage::run::RunOptions;
use output::HistoryFile;
use output::layout::{HISTORY, file};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const CASE: &str = include_str!("../../cases/half-space/mindlin.toml");
const NAME: &str = "mindlin.toml";
const SOURCE: &str = "Mindlin and Deresiewicz (1953)";

/// Spacings over the radius of the patch.
const SPACINGS: [f64; 4] = [1.0 / 6.0, 1.0 / 9.0, 1.0 / 13.5, 1.0 / 30.0];
/// Half a period of the drive (s): the first shift takes one, the way back and the way forth two each.
const HALF: f64 = 0.05;
/// The shift at which the drive turns (m).
const SHIFT: f64 = 10e-9;

/// The closed form of the case.
struct Mindlin {
    a: f64,
    /// mu N (N).
    bound: f64,
    /// Shift at which all slips (m).
    whole: f64,
    /// x*.
    turn: f64,
}

impl Mindlin {
    fn of(case: &Case) -> Self {
        let (a, steel) = (hertz(case).a, case.disk_material());
        let shear = steel.young / (2.0 * (1.0 + steel.poisson));
        let bound = case.friction.number("static").unwrap_or(0.0) * case.load.normal;
        let whole = 3.0 * bound * (2.0 - steel.poisson) / (8.0 * shear * a);
        let turn = 1.0 - libm::pow(1.0 - SHIFT / whole, 1.5);
        Self { a, bound, whole, turn }
    }

    /// (1 - x*)^(2/3).
    fn left(&self) -> f64 {
        1.0 - SHIFT / self.whole
    }

    /// 1 - (x* - x)/2 where the shift is zero on the way back.
    fn back(&self) -> f64 {
        libm::pow(0.5 * (1.0 + self.left()), 1.5)
    }

    /// Dissipated by a cycle (J).
    fn dissipated(&self) -> f64 {
        let (x, left) = (self.turn, self.left());
        let share = 1.0 - libm::pow(left, 2.5) - 5.0 / 6.0 * x * (1.0 + left);
        24.0 / 5.0 * self.bound * self.whole * share
    }

    /// Closed form of what [`shifted`] finds.
    fn values(&self) -> [f64; 7] {
        let unloaded = self.turn - 2.0 * (1.0 - self.back());
        [
            self.turn,
            self.a * libm::cbrt(1.0 - self.turn),
            unloaded,
            self.a * libm::cbrt(self.back()),
            -self.turn,
            self.turn,
            self.dissipated(),
        ]
    }
}

const WHAT: [&str; 7] = [
    "Q/(mu N) at the first turn",
    "radius of stick at the first turn (m), over a",
    "Q/(mu N) on the way back at no shift",
    "radius of stick there (m), over a",
    "Q/(mu N) at the second turn",
    "Q/(mu N) at the end of the cycle",
    "dissipated by the cycle (J)",
];

pub(crate) fn run(size: Size) -> Outcome {
    run_with(size, &[])
}

/// The problem whose runs have `planted` keys (`KEY=VALUE`) set, which the closed form does not know of.
pub(crate) fn run_with(size: Size, planted: &[&str]) -> Outcome {
    let case = case(&[])?;
    let exact = Mindlin::of(&case);
    let spacings = SPACINGS.map(|share| share * exact.a);
    let grids = sizes(size, &spacings).iter().map(|&h| (h, 1.0));
    // the last on the coarsest grid in half the step
    let runs: Vec<(f64, f64)> = grids.chain([(spacings[0], 0.5)]).collect();
    let mut found: Vec<(f64, [f64; 7])> = runs
        .par_iter()
        .map(|&(h, steps)| Ok((h, shifted(h, steps, &exact, planted)?)))
        .collect::<Result<_, Cause>>()?;
    let (_, halved) = found.pop().ok_or("no run")?;
    let mut rows = Vec::new();
    for (k, (what, reference)) in WHAT.into_iter().zip(exact.values()).enumerate() {
        let study = Convergence::by_theory(column(&found, k), 1.0);
        if what.contains("radius") {
            let h = found.last().map_or(f64::NAN, |(h, _)| *h);
            let limit = (0.5 * h / exact.a, "half a spacing, h/(2a)");
            let row = Row::new(what, [reference, study.finest()], exact.a, limit, SOURCE);
            rows.push(Row { meshes: study.samples().to_vec(), ..row });
        } else {
            // of second order in the step, as the backward difference is
            let step = 4.0 / 3.0 * (found[0].1[k] - halved[k]).abs() / reference.abs();
            let step = (step, "the time step, by half of it on the coarsest grid");
            rows.push(Row::extrapolated(what, reference, &study, step, SOURCE));
        }
    }
    Ok(rows)
}

fn case(sets: &[String]) -> Result<Case, Cause> {
    Ok(Case::from_text(CASE, Path::new(NAME), sets)?)
}

/// Runs the case on a grid of the spacing h (m), with `steps` times its time step and `planted` keys: what [`WHAT`] names.
fn shifted(h: f64, steps: f64, exact: &Mindlin, planted: &[&str]) -> Result<[f64; 7], Cause> {
    let step = steps * case(&[])?.time.step.ok_or("the case has no time.step")?;
    let mut sets = vec![format!("mesh.zone.size={h}"), format!("time.step={step}")];
    sets.extend(planted.iter().map(|&key| key.to_owned()));
    let case = case(&sets)?;
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("run");
    let options = RunOptions {
        case: NAME.into(),
        out: Some(out.clone()),
        threads: Some(1),
        ..RunOptions::default()
    };
    creepage::run::run(&case, &options, &AtomicBool::new(false), &mut |_| {})?;
    let history = HistoryFile::open(out.join(file::HISTORY))?;
    let read = |name: &str| history.read(name);
    let [time, force, area, stick, lost] = [
        read(&HISTORY.time.name)?,
        read(&HISTORY.tangential_force.name)?,
        read(&HISTORY.patch_area.name)?,
        read(&HISTORY.stick_fraction.name)?,
        read(&HISTORY.friction_dissipated.name)?,
    ];
    // the step that ends at a time
    let at = |t: f64| time.partition_point(|time| *time < t * (1.0 - 1e-9));
    let [first, middle, second, last] = [1.0, 2.0, 3.0, 5.0].map(|halves| at(halves * HALF));
    if last >= time.len() {
        return Err("the run ended before the cycle".into());
    }
    let share = |n: usize| force[n] / exact.bound;
    // at a turn nothing slips
    let radius = |n: usize| (stick[n] * area[n] / PI).sqrt();
    Ok([
        share(first),
        radius(first - 1),
        share(middle),
        radius(middle),
        share(second),
        share(last),
        lost[last] - lost[first],
    ])
}
