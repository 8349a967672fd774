//! Every problem of the ladder at its quick size.
#![allow(clippy::unwrap_used)]

use verify::{Convergence, PROBLEMS, Row, Size};

#[test]
fn every_row_of_every_problem_is_within_a_finite_limit_and_a_planted_error_is_not() {
    for problem in PROBLEMS {
        let rows = problem.run(Size::Quick).unwrap();
        assert!(!rows.is_empty(), "{}", problem.name);
        for row in rows {
            assert_eq!(row.name, problem.name);
            let numbers = [row.reference, row.computed, row.error, row.limit];
            assert!(numbers.iter().all(|x| x.is_finite()), "{row:?}");
            assert!(row.pass, "{row:?}");
            assert!(!row.source.is_empty() && !row.limit_from.is_empty(), "{row:?}");
            planted_errors_fail(&row);
        }
    }
}

/// The same row with values just within and just beyond its limit.
fn planted_errors_fail(row: &Row) {
    let distance = (row.computed - row.reference).abs();
    let scale = if row.error > 0.0 { distance / row.error } else { 1.0 };
    let with = |times: f64| {
        let computed = row.reference + times * scale * row.limit;
        Row::new("", [row.reference, computed], scale, (row.limit, ""), "")
    };
    for sign in [1.0, -1.0] {
        assert!(with(0.9 * sign).pass && !with(1.1 * sign).pass, "{row:?}");
    }
    assert!(!with(f64::NAN).pass && !with(f64::INFINITY).pass);
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
