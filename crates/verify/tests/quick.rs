//! Every problem of the ladder at its quick size.
#![allow(clippy::unwrap_used)]

use verify::{Convergence, PROBLEMS, Row, Size};

#[test]
fn every_row_of_every_problem_is_within_a_finite_limit() {
    for problem in PROBLEMS {
        let rows = problem.run(Size::Quick).unwrap();
        assert!(!rows.is_empty(), "{}", problem.name);
        for row in rows {
            assert_eq!(row.name, problem.name);
            let numbers = [row.reference, row.computed, row.error, row.limit];
            assert!(numbers.iter().all(|x| x.is_finite()), "{row:?}");
            assert!(row.pass, "{row:?}");
            assert!(!row.source.is_empty() && !row.limit_from.is_empty(), "{row:?}");
        }
    }
}

#[test]
fn a_planted_error_fails() {
    for problem in PROBLEMS {
        for row in problem.run(Size::Quick).unwrap() {
            let scale = match row.error {
                0.0 => 1.0,
                error => (row.computed - row.reference).abs() / error,
            };
            let row = |computed| {
                let values = [row.reference, computed];
                Row::new("", values, scale, (row.limit, ""), "")
            };
            let wrong = |times: f64| row(0.0).reference + times * scale * row(0.0).limit;
            assert!(row(wrong(0.99)).pass && row(wrong(-0.99)).pass);
            assert!(!row(wrong(1.01)).pass && !row(wrong(-1.01)).pass, "{}", problem.name);
            assert!(!row(f64::NAN).pass && !row(f64::INFINITY).pass);
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
