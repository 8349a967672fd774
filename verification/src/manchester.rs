//! S1002 wheels on UIC 60 rails: the odd positions of case of the Manchester contact benchmark, by half-spaces without
//! inertia, beside CONTACT.
//!
//! CONTACT's values (`data/manchester.csv`) are those of one grid of 0.2 mm; its normal problem has an error of 1 to 2 %. The same case
//! was done by a commercial finite-element code in *Vehicles* 2025, 7:104. The rail of the benchmark is not quite 60E1: its arcs join
//! at 10.50 and 25.99 mm, not at 10.23 and 26.03 mm, which puts 60E1 up to 0.038 mm from its points. The problem takes the arcs of the
//! benchmark, and tells what 60E1 changes.
//!
//! On the right rail at case 11 the wheel touches in two patches, whose middles are 10 mm apart. CONTACT lets patches whose edges are
//! d = 4 to 8 mm apart (`D_COMB`, `D_SEP`) deform one another by a part of what half-spaces do, ((8 - d)/4)^0.8
//! (`combine_cpatches`). The case is reported separately, also with patches that do not deform one another, nearer to CONTACT's.

mod case;

use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use case::{BenchmarkCase, LOAD, Values, benchmark_rail, cases};
use mesh::profile::{Profile, rail_60e1};
use rayon::prelude::*;

const SOURCE: &str = "CONTACT (Vollebregt), mbench_a22, elements of 0.2 mm";
/// Points on the mean diameter of the patch, and at least on its shorter axis.
const GRIDS: [[f64; 2]; 2] = [[10.0, 4.5], [20.0, 9.0]];
/// The case whose load is shared by two patches.
const SHARED: (f64, u32) = (1.0, 11);
const MU: f64 = 0.3;
/// From this case on the right wheel touches with its flange, in a patch twenty times as long as wide, which takes some ten minutes.
const FLANGE: u32 = 15;
/// Cases whose contact lies nearer to the top of the rail than this (mm) are also done on 60E1.
const TREAD: f64 = 25.0;
/// What 60E1 may change of the first four quantities: where the arcs join at other places, the rail's slope at a place differs by up
/// to 2.6 mrad (y = -22 mm). The point of equal slopes lies by this over the difference of the curvatures of rail and wheel,
/// 12.7 - 7.3 1/m, farther: 0.5 mm, over which the wheel's slope changes by 3.5 mrad.
const STANDARD: [f64; 4] = [0.5, 3.5e-3, 0.02, 0.02];

/// A quantity: its name, column, the limit that is asked of it, and what its error is relative to.
struct Quantity {
    name: &'static str,
    column: usize,
    limit: f64,
    scale: Scale,
    /// Order of convergence by which it is extrapolated.
    order: f64,
}

/// What errors are relative to.
#[derive(Clone, Copy)]
enum Scale {
    /// One of the unit.
    Unit,
    /// The reference.
    Reference,
    /// mu N.
    Friction,
    /// mu N times the root of the area.
    Moment,
}

const QUANTITIES: [Quantity; 8] = [
    Quantity { name: "y on the rail (mm)", column: 0, limit: 0.2, scale: Scale::Unit, order: 1.0 },
    Quantity {
        name: "contact angle (rad)",
        column: 1,
        limit: 0.5e-3,
        scale: Scale::Unit,
        order: 1.0,
    },
    Quantity { name: "approach", column: 9, limit: 0.02, scale: Scale::Reference, order: 2.0 },
    Quantity {
        name: "largest pressure",
        column: 10,
        limit: 0.02,
        scale: Scale::Reference,
        order: 2.0,
    },
    Quantity { name: "normal force", column: 5, limit: 0.02, scale: Scale::Reference, order: 1.0 },
    Quantity { name: "force along", column: 6, limit: 0.02, scale: Scale::Friction, order: 1.0 },
    Quantity { name: "force across", column: 7, limit: 0.02, scale: Scale::Friction, order: 1.0 },
    Quantity { name: "moment", column: 8, limit: 0.02, scale: Scale::Moment, order: 1.0 },
];

impl Quantity {
    fn error(&self, case: &BenchmarkCase, found: &Values) -> f64 {
        let reference = case.values;
        let scale = match self.scale {
            Scale::Unit => 1.0,
            Scale::Reference => reference[self.column],
            Scale::Friction => MU * reference[5],
            Scale::Moment => MU * reference[5] * reference[11].sqrt(),
        };
        (found[self.column] - reference[self.column]).abs() / scale
    }
}

/// A case and its values extrapolated from all grids.
type Found = (BenchmarkCase, Values);

pub(crate) fn run(size: Size) -> Outcome {
    let all = cases()?;
    // in the middle of the track both wheels are alike
    let wanted = |case: &BenchmarkCase| match size {
        Size::Full => case.outward < 0.0 || (2..FLANGE).contains(&case.number),
        Size::Quick => [3, 7].contains(&case.number),
    };
    let all: Vec<BenchmarkCase> = all.into_iter().filter(wanted).collect();
    let is_shared = |case: &BenchmarkCase| (case.outward, case.number) == SHARED;
    let (shared, apart): (Vec<_>, Vec<_>) = all.into_iter().partition(is_shared);
    let found = rolled(&apart, benchmark_rail)?;
    let mut rows = Vec::new();
    for quantity in &QUANTITIES {
        rows.extend(summed_up(quantity, &found, "", quantity.limit));
    }
    for case in rolled(&shared, benchmark_rail)? {
        for quantity in &QUANTITIES {
            let what = format!("right, case 11, two patches: {}", quantity.name);
            rows.push(row(quantity, &case, what, quantity.limit));
        }
    }
    if let Some(case) = shared.first() {
        rows.extend(without_influence(case)?);
    }
    // what the rail of the standard changes
    let on_tread: Vec<_> = apart.into_iter().filter(|case| case.values[0].abs() < TREAD).collect();
    let standard = rolled(&on_tread, rail_60e1)?;
    for (quantity, limit) in QUANTITIES[..4].iter().zip(STANDARD) {
        rows.extend(summed_up(quantity, &standard, " with 60E1", limit).into_iter().take(1));
    }
    Ok(rows)
}

/// The cases on the rail of a profile, extrapolated.
fn rolled(cases: &[BenchmarkCase], rail: fn() -> Profile) -> Result<Vec<Found>, Cause> {
    cases
        .par_iter()
        .map(|case| {
            let mut grids: Vec<(f64, Values)> = Vec::new();
            for across in GRIDS {
                let guess = grids.last().map_or(LOAD, |(_, values)| values[5]);
                grids.push(case.rolled(across, guess, rail())?);
            }
            let mut found = case.values;
            for quantity in &QUANTITIES {
                let samples = grids.iter().map(|(h, values)| (*h, values[quantity.column]));
                found[quantity.column] =
                    Convergence::by_theory(samples, quantity.order).extrapolated();
            }
            Ok((*case, found))
        })
        .collect()
}

/// Approach and pressure of a case with two patches that do not deform one another, extrapolated.
fn without_influence(case: &BenchmarkCase) -> Result<[Row; 2], Cause> {
    let grids = GRIDS.map(|across| case.without_influence(across, benchmark_rail()));
    let [coarse, fine] = grids;
    let grids = [coarse?, fine?];
    let mut found = case.values;
    Ok([(&QUANTITIES[2], 0), (&QUANTITIES[3], 1)].map(|(quantity, at)| {
        let samples = grids.iter().map(|(h, values)| (*h, values[at]));
        found[quantity.column] = Convergence::by_theory(samples, quantity.order).extrapolated();
        let what = format!("right, case 11, patches apart: {}", quantity.name);
        row(quantity, &(*case, found), what, quantity.limit)
    }))
}

/// The largest error of a quantity over the cases, with its case, and the mean absolute and the root mean square error.
fn summed_up(quantity: &Quantity, found: &[Found], with: &str, limit: f64) -> Vec<Row> {
    let errors: Vec<f64> =
        found.iter().map(|(case, values)| quantity.error(case, values)).collect();
    let worst = (0..errors.len()).max_by(|&i, &j| errors[i].total_cmp(&errors[j]));
    let Some(worst) = worst else { return Vec::new() };
    let (case, n) = (found[worst].0, errors.len() as f64);
    let side = if case.outward > 0.0 { "right" } else { "left" };
    let what = format!("{}{with}, farthest at {side}, case {}", quantity.name, case.number);
    let mean = errors.iter().sum::<f64>() / n;
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / n).sqrt();
    let of_all = |name: &str, value: f64| {
        let what = format!("{}{with}: {name} error", quantity.name);
        Row::new(what, [0.0, value], 1.0, (limit, "asked of this problem"), SOURCE)
    };
    vec![
        row(quantity, &found[worst], what, limit),
        of_all("mean absolute", mean),
        of_all("root mean square", rms),
    ]
}

/// A quantity of a case.
fn row(quantity: &Quantity, found: &Found, what: String, limit: f64) -> Row {
    let (case, values) = found;
    let pair = [case.values[quantity.column], values[quantity.column]];
    let row = Row::new(what, pair, 1.0, (limit, "asked of this problem"), SOURCE);
    let error = quantity.error(case, values);
    Row { error, pass: error <= limit, ..row }
}
