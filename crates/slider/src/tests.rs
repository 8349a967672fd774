//! What the methods do over a whole run.

use crate::*;
use friction::{Coulomb, Exponential, Expression, FrictionLaw, Memory, Table};
use std::ops::ControlFlow;
use std::sync::Arc;

fn at(dt: f64) -> Parameters {
    Parameters { dt, ..Parameters::default() }
}

#[test]
fn chatter_in_adhesion_ends_at_dt_1_although_x_min_is_right_below_dt_2() {
    // rms s over s_adhes: 12.4, 6.0, 0.29 at 2e-5, 1e-5, 2e-6 s
    for (dt, expected, tolerance) in [(2e-5, 12.4, 0.1), (1e-5, 6.0, 0.05), (2e-6, 0.29, 0.005)] {
        let p = at(dt);
        let out = run(&p, Method::Explicit, unobserved).unwrap();
        assert!((out.x_min + 0.9982).abs() < 1e-4, "{dt}: {}", out.x_min);
        let slip = out.adhesion_slip / p.adhesion;
        assert!((slip - expected).abs() < tolerance, "{dt}: {slip}");
    }
}

#[test]
fn exact_friction_has_the_collapse_at_every_step_and_no_slip_in_stick() {
    for dt in [1e-3, 1e-4, 1e-5, 1e-6] {
        let p = at(dt);
        let (mut stuck, mut wrong) = (0u64, 0.0f64);
        let out = run(&p, Method::Exact, |_, state| {
            let traction = state.friction.abs() / p.normal_force;
            if state.slip == 0.0 {
                stuck += 1;
                wrong = wrong.max(traction - 0.5);
            } else {
                // on the bound, against the slip
                wrong = wrong.max((traction - state.mu).abs());
                assert!(state.friction * state.slip < 0.0);
            }
            ControlFlow::Continue(())
        })
        .unwrap();
        assert!((-1.0004..=-0.997).contains(&out.x_min), "{dt}: {}", out.x_min);
        assert_eq!(out.adhesion_slip, 0.0);
        assert_eq!(out.ringing.map(|r| r.peak), Some(0.0));
        assert!(stuck as f64 * dt > 3.0, "sticks {stuck} of {} steps", out.steps);
        assert!(wrong < 1e-9, "{dt}: off the conditions by {wrong:e}");
    }
}

#[test]
fn penalty_tends_to_exact_friction_as_its_spring_stiffens() {
    let exact = run(&at(1e-6), Method::Exact, unobserved).unwrap().x_min;
    let distance = |stiffness: f64| {
        let p = Parameters { stiffness, ..at(1e-6) };
        (run(&p, Method::Penalty, unobserved).unwrap().x_min - exact).abs()
    };
    let [soft, middle, stiff] = [1e5, 1e6, 1e7].map(distance);
    assert!(soft > middle && middle > stiff, "{soft:e} {middle:e} {stiff:e}");
    assert!(soft < 5e-4 && stiff < 2e-5, "{soft:e} {stiff:e}");
}

#[test]
fn nothing_in_the_penalty_method_damps_the_ringing_of_a_block_that_sticks() {
    // friction spring 1e6 N/m, mass 0.01 kg: 0.01 m/s of slip is 1 N of 10 N that would hold
    let p = Parameters { spring: 0.0, damping: 0.0, v0: -0.99, end: 1.0, ..at(1e-5) };
    let mut late = 0.0f64;
    run(&p, Method::Penalty, |time, state| {
        if time > 0.99 {
            late = late.max(state.slip.abs());
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!((late / 0.01 - 1.0).abs() < 0.01, "{late}");
}

#[test]
fn after_a_capture_the_penalty_spring_rings_as_hard_as_the_bound_lets_it() {
    for stiffness in [1e5, 1e6, 1e7] {
        let p = Parameters { damping: 0.0, stiffness, ..at(1e-6) };
        let ringing = run(&p, Method::Penalty, unobserved).unwrap().ringing.unwrap();
        let mut force = 0.0f64;
        run(&p, Method::Penalty, |time, state| {
            if (0.1..0.2).contains(&(time - ringing.capture)) {
                let stretch = state.slip.abs() * (stiffness * p.mass).sqrt();
                force = force.max(stretch + p.spring * state.x.abs());
            }
            ControlFlow::Continue(())
        })
        .unwrap();
        // the bound with mu at the largest slip and at rest
        let bound = [p.mu(ringing.peak), p.mu_static()].map(|mu| mu * p.normal_force);
        assert!((bound[0]..1.01 * bound[1]).contains(&force), "{stiffness:e}: {force} {bound:?}");
    }
}

#[test]
fn memory_tends_to_exact_friction_as_its_distance_vanishes() {
    let exact = run(&at(1e-5), Method::Exact, unobserved).unwrap();
    let distance = |distance: f64| {
        let memory = Memory { distance, floor: 1e-2 };
        let p = Parameters { memory, ..at(1e-5) };
        let out = run(&p, Method::Memory, unobserved).unwrap();
        assert_eq!(out.adhesion_slip, 0.0);
        (out.x_min - exact.x_min).abs() + (out.x_max - exact.x_max).abs()
    };
    let distances = [1e-2, 1e-4, 1e-6, 1e-8].map(distance);
    assert!(distances.windows(2).all(|d| d[1] < 0.5 * d[0]), "{distances:?}");
    assert!(distances[3] < 1e-4, "{distances:?}");
}

#[test]
fn one_law_in_three_forms_gives_one_motion() {
    let forms = |method| {
        let points = (0..=30_000).map(|i| f64::from(i) * 5e-4);
        let law = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
        let table = points.map(|s| [s, law.mu(s)]).collect();
        [
            Arc::new(law) as Arc<dyn FrictionLaw>,
            Arc::new(Expression::new("0.32 + 0.18*exp(-6*s)").unwrap()),
            Arc::new(Table::new(table).unwrap()),
        ]
        .map(|law| run(&Parameters { law, ..at(1e-4) }, method, unobserved).unwrap())
    };
    for method in [Method::Implicit, Method::Exact, Method::Memory, Method::Penalty] {
        let [first, formula, table] = forms(method);
        assert!((first.x_max - formula.x_max).abs() < 1e-9, "{}", method.name());
        assert!((first.x_max - table.x_max).abs() < 1e-4, "{}", method.name());
    }
}

#[test]
fn constant_friction_makes_the_block_stick_and_then_slide_steadily() {
    let law: Arc<dyn FrictionLaw> = Arc::new(Coulomb { mu: 0.5 });
    for method in Method::ALL {
        let p = Parameters { law: law.clone(), damping: 1.0, end: 20.0, ..at(1e-5) };
        let mut last = p.start();
        let out = run(&p, method, |_, state| {
            last = *state;
            ControlFlow::Continue(())
        })
        .unwrap();
        assert!((last.x + 1.0).abs() < 2e-3, "{}: {last:?}", method.name());
        assert!(last.v.abs() < 1e-2 && out.x_min >= -1.01, "{}: {last:?}", method.name());
    }
}

#[test]
fn a_step_beyond_the_springs_limit_is_reported_as_a_blow_up() {
    let p = Parameters { spring: 1e6, ..at(1e-2) };
    let error = run(&p, Method::Explicit, unobserved).unwrap_err();
    assert!(error.step > 1 && error.to_string().contains("blew up"), "{error}");
}

#[test]
fn an_observer_can_stop_a_run() {
    let mut seen = 0;
    let out = run(&at(1e-4), Method::Explicit, |_, _| {
        seen += 1;
        if seen == 100 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
    .unwrap();
    assert!(out.stopped && out.steps == 99);
}
