//! Tables 2, 3 and 4 of Vollebregt (2017): the printed values beside computed ones.

use crate::{BlowUp, Method, Parameters, collapse_step, run, unobserved};
use serde::Serialize;

/// The characteristic values of a run that the tables list.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Characteristics {
    /// Smallest position (m).
    pub x_min: f64,
    /// Largest position after 0.7 s (m).
    pub x_max: f64,
    /// Largest velocity (m/s).
    pub v_max: f64,
}

/// A row of a table: parameters, computed values, printed values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TableRow {
    /// Mass (kg).
    pub mass: f64,
    /// Damping (N s/m).
    pub damping: f64,
    /// Time step (s).
    pub dt: f64,
    /// Computed values.
    #[serde(flatten)]
    pub computed: Characteristics,
    /// Values printed in the paper.
    pub paper: Characteristics,
    /// Whether the run is chaotic: an explicit run with a step above dt_2 collapses out of chatter,
    /// and its digits depend on the last bit of every operation.
    pub chaotic: bool,
}

/// The three tables.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tables {
    /// Table 2: implicit method, refinement of the time step.
    pub table2: Vec<TableRow>,
    /// Table 3: implicit method, variation of mass and damping.
    pub table3: Vec<TableRow>,
    /// Table 4: explicit method, refinement of the time step.
    pub table4: Vec<TableRow>,
}

/// mass, damping, dt, and the printed x_min, x_max, v_max.
type Printed = [f64; 6];

const TABLE_2: [Printed; 4] = [
    [0.01, 0.04, 1e-3, -0.99456, -0.36352, 9.951],
    [0.01, 0.04, 1e-4, -0.99782, -0.34823, 10.260],
    [0.01, 0.04, 1e-5, -0.99816, -0.34664, 10.292],
    [0.01, 0.04, 1e-6, -0.99820, -0.34648, 10.295],
];

const TABLE_3: [Printed; 9] = [
    [0.01, 0.04, 1e-4, -0.99782, -0.34823, 10.260],
    [0.001, 0.04, 1e-4, -0.99391, -0.45659, 26.574],
    [0.0001, 0.04, 1e-4, -0.99380, -0.61447, 53.302],
    [0.01, 0.04, 1e-4, -0.99782, -0.34823, 10.260],
    [0.01, 0.004, 1e-4, -1.00141, -0.28746, 11.288],
    [0.01, 0.0004, 1e-4, -1.00177, -0.28074, 11.400],
    [0.01, 0.04, 1e-4, -0.99782, -0.34823, 10.260],
    [0.001, 0.004, 1e-4, -0.99754, -0.30947, 34.394],
    [0.0001, 0.0004, 1e-4, -0.99780, -0.30623, 109.294],
];

const TABLE_4: [Printed; 5] = [
    [0.01, 0.04, 1e-4, -0.77922, -0.52563, 4.006],
    [0.01, 0.04, 5e-5, -0.85854, -0.46069, 6.285],
    [0.01, 0.04, 3e-5, -0.90435, -0.42321, 7.601],
    [0.01, 0.04, 2e-5, -0.99825, -0.34628, 10.299],
    [0.01, 0.04, 1e-5, -0.99823, -0.34637, 10.297],
];

/// Computes all three tables.
///
/// # Errors
/// A blow-up, which none of the paper's parameters gives.
pub fn tables() -> Result<Tables, BlowUp> {
    let rows = |printed: &[Printed], method| {
        printed.iter().map(|row| compute(row, method)).collect::<Result<Vec<_>, _>>()
    };
    Ok(Tables {
        table2: rows(&TABLE_2, Method::Implicit)?,
        table3: rows(&TABLE_3, Method::Implicit)?,
        table4: rows(&TABLE_4, Method::Explicit)?,
    })
}

fn compute(
    &[mass, damping, dt, x_min, x_max, v_max]: &Printed,
    method: Method,
) -> Result<TableRow, BlowUp> {
    let p = Parameters { mass, damping, dt, ..Parameters::default() };
    let out = run(&p, method, unobserved)?;
    Ok(TableRow {
        mass,
        damping,
        dt,
        computed: Characteristics { x_min: out.x_min, x_max: out.x_max, v_max: out.v_max },
        paper: Characteristics { x_min, x_max, v_max },
        chaotic: method == Method::Explicit && collapse_step(&p).is_some_and(|limit| dt > limit),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn largest_difference(row: &TableRow) -> [f64; 2] {
        let (a, b) = (row.computed, row.paper);
        [(a.x_min - b.x_min).abs().max((a.x_max - b.x_max).abs()), (a.v_max - b.v_max).abs()]
    }

    #[test]
    fn tables_2_and_3_are_reproduced_to_every_printed_digit() {
        let tables = tables().unwrap();
        for row in tables.table2.iter().chain(&tables.table3) {
            let [x, v] = largest_difference(row);
            assert!(x <= 0.5e-5 && v <= 0.5e-3, "{row:?}");
        }
    }

    #[test]
    fn table_4_is_reproduced_where_it_is_not_chaotic() {
        for row in tables().unwrap().table4 {
            let [x, v] = largest_difference(&row);
            if row.chaotic {
                assert!((row.computed.x_min - row.paper.x_min).abs() < 0.012, "{row:?}");
            } else {
                assert!(x <= 5e-5 && v <= 0.003, "{row:?}");
            }
        }
    }
}
