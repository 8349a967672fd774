//! Every problem of the ladder at its quick size.
#![allow(clippy::unwrap_used)]

use rayon::prelude::*;
use std::sync::LazyLock;
use verification::{Convergence, PROBLEMS, Problem, Row, Size};

/// The rows of every problem at its quick size, by its name; with `CREEPAGE_SAMPLE=K/N` those of every Nth problem from
/// the Kth on.
static ROWS: LazyLock<Vec<(&str, Vec<Row>)>> = LazyLock::new(|| {
    let (first, step) = sample();
    let problems: Vec<_> = PROBLEMS.iter().skip(first).step_by(step).collect();
    let run = |problem: &&Problem| (problem.name, problem.run(Size::Quick).unwrap());
    // one at a time to each thread: they take from milliseconds to minutes
    problems.par_iter().with_max_len(1).map(run).collect()
});

fn sample() -> (usize, usize) {
    let Ok(sample) = std::env::var("CREEPAGE_SAMPLE") else { return (0, 1) };
    let (first, step) = sample.split_once('/').expect("CREEPAGE_SAMPLE=K/N");
    (first.parse().unwrap(), step.parse().unwrap())
}

#[test]
fn every_row_of_every_problem_is_within_a_finite_limit() {
    for (name, rows) in ROWS.iter() {
        assert!(!rows.is_empty(), "{name}");
        for row in rows {
            assert_eq!(row.name, *name);
            let numbers = [row.reference, row.computed, row.error, row.limit];
            assert!(numbers.iter().all(|x| x.is_finite()), "{row:?}");
            assert!(row.pass, "{row:?}");
            assert!(!row.source.is_empty() && !row.limit_from.is_empty(), "{row:?}");
        }
    }
}

#[test]
fn a_planted_error_fails() {
    for (name, rows) in ROWS.iter() {
        for row in rows {
            let scale = match row.error {
                0.0 => 1.0,
                error => (row.computed - row.reference).abs() / error,
            };
            let row = |computed| {
                let values = [row.reference, computed];
                Row::new("", values, scale, (row.limit, ""), "")
            };
            // a limit of zero fails for any error
            let limit = f64::max(row(0.0).limit, f64::EPSILON);
            let wrong = |times: f64| row(0.0).reference + times * scale * limit;
            assert!(
                row(wrong(1.01)).pass == row(wrong(-1.01)).pass && !row(wrong(1.01)).pass,
                "{name}"
            );
            assert!(row(0.0).limit == 0.0 || (row(wrong(0.99)).pass && row(wrong(-0.99)).pass));
            assert!(!row(f64::NAN).pass && !row(f64::INFINITY).pass);
        }
    }
}

#[test]
fn no_mesh_study_leaves_more_than_a_quarter_open() {
    for (name, rows) in ROWS.iter() {
        for row in rows.iter().filter(|row| row.quantity.contains("extrapolated")) {
            assert!(row.limit < 0.25, "{name}: {}", row.quantity);
        }
    }
}

#[test]
fn a_converged_row_fails_where_the_meshes_converge_to_something_else() {
    let study = |limit: f64| Convergence::new([4.0, 2.0, 1.0].map(|h| (h, limit + 0.1 * h)), 1.0);
    let row = |limit| Row::converged("", 5.0, &study(limit), (0.0, ""), "");
    assert!(row(5.0).pass);
    assert!(!row(5.3).pass && !row(4.7).pass);
    let one_mesh = Convergence::new([(1.0, 5.1)], 1.0);
    assert!(!Row::converged("", 5.0, &one_mesh, (0.0, ""), "").limit.is_finite());
}
