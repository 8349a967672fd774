//! Friction that falls with the slip velocity and remembers a distance of slip, in rolling.
#![allow(clippy::unwrap_used)]

mod common;
use common::ellipse;
use friction::{Coulomb, Exponential, Memory, Remembering};
use std::sync::Arc;
use verification::reference::press;
use verification::reference::{
    FrictionError, Influence, Press, Pressed, Rigid, Rolling, RollingError, SlipLaw,
};

const LOAD: f64 = 5e4;
const SPEED: f64 = 38.89;
const FALLING: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
const MEMORY: Memory = Memory { distance: 3e-6, floor: 1e-3 };

fn wheel() -> (Influence, Pressed) {
    let influence = ellipse(1.4e-3, 0.08);
    let pressed = press(&influence, Press::Load(LOAD), None).unwrap();
    (influence, pressed)
}

fn remembering(speed: f64) -> SlipLaw {
    SlipLaw { law: Arc::new(Remembering { steady: FALLING, memory: MEMORY }), speed }
}

fn creeps(rolling: &Rolling<'_>, creepage: f64) -> [Rigid; 2] {
    [Rigid::Moved(creepage * rolling.pitch()), Rigid::Moved(0.0)]
}

fn size(v: &[f64; 2]) -> f64 {
    libm::hypot(v[0], v[1])
}

/// The same numbers, not only the same to round-off.
#[test]
fn a_law_with_one_coefficient_rolls_as_that_coefficient_does() {
    let (influence, pressed) = wheel();
    let mut constant = Rolling::new(&influence, &pressed, 0.4).unwrap();
    let law = SlipLaw { law: Arc::new(Coulomb { mu: 0.4 }), speed: SPEED };
    let mut law = Rolling::with_law(&influence, &pressed, law).unwrap();
    for rolling in [&mut constant, &mut law] {
        rolling.shift([Rigid::Forced(0.1 * LOAD), Rigid::Moved(0.0)]).unwrap();
        for _ in 0..5 {
            rolling.roll(creeps(rolling, 2e-3)).unwrap();
        }
    }
    assert_eq!(constant.force(), law.force());
    assert_eq!(constant.slip(), law.slip());
}

/// Each particle's coefficient, integrated here along its path from the slip of the steps.
#[test]
fn the_coefficient_of_a_particle_is_that_of_its_slip_since_it_came_into_contact() {
    let (influence, pressed) = wheel();
    let mut rolling = Rolling::with_law(&influence, &pressed, remembering(SPEED)).unwrap();
    let dt = rolling.pitch() / SPEED;
    let at = |i: usize| influence.points()[i].at;
    let mut mu = vec![FALLING.mu_static; rolling.contact().len()];
    for _ in 0..12 {
        rolling.roll(creeps(&rolling, 4e-3)).unwrap();
        let contact = rolling.contact();
        let upstream = |i: usize| {
            let ahead = |j: &usize| {
                let [[x, y, _], [u, v, _]] = [at(i), at(*j)].map(Into::into);
                (u - x - rolling.pitch()).abs() + (v - y).abs() < 1e-6
            };
            contact.iter().position(ahead)
        };
        let slip = rolling.slip();
        let moved = contact.iter().zip(&slip).map(|(&i, s)| {
            let Some(up) = upstream(i) else { return FALLING.mu_static };
            let speed = size(s) / dt;
            let steady = 0.32 + 0.18 * libm::exp(-6.0 * speed);
            steady + (mu[up] - steady) * libm::exp(-f64::max(speed, 1e-3) * dt / 3e-6)
        });
        mu = moved.collect();
        for ((g, mu), &i) in rolling.bound().iter().zip(&mu).zip(contact) {
            assert!((g - mu * pressed.force[i]).abs() < 1e-12 * g, "{g} {mu}");
        }
        for ((p, s), g) in rolling.force().iter().zip(&slip).zip(rolling.bound()) {
            assert!(size(p) <= g * (1.0 + 1e-6), "cone");
            let sticks = size(s) < 1e-12;
            assert!(sticks || size(p) >= g * (1.0 - 1e-6), "a point slips below its bound");
        }
    }
    assert!(mu.iter().any(|mu| *mu < 0.4), "friction fell somewhere");
}

#[test]
fn the_steady_state_with_memory_is_the_limit_of_rolling_from_rest() {
    let (influence, pressed) = wheel();
    let new = || Rolling::with_law(&influence, &pressed, remembering(SPEED)).unwrap();
    let mut steady = new();
    let rigid = creeps(&steady, 2.5e-3);
    let steps = steady.steady(rigid, 400).unwrap();
    assert!(steps < 5, "found at once, not by rolling: {steps} steps");
    let mut rolling = new();
    for _ in 0..200 {
        rolling.roll(rigid).unwrap();
    }
    let largest = steady.bound().iter().fold(0.0f64, |m, g| m.max(*g));
    for (a, b) in steady.force().iter().zip(rolling.force()) {
        assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-6 * largest);
    }
}

/// Slow rolling has the static coefficient, fast rolling the dynamic one.
#[test]
fn the_speed_of_rolling_decides_how_far_friction_falls() {
    let (influence, pressed) = wheel();
    let carried = |speed: f64| {
        let memory = Memory { distance: 1e-9, floor: 1e-12 };
        let law = SlipLaw { law: Arc::new(Remembering { steady: FALLING, memory }), speed };
        let mut rolling = Rolling::with_law(&influence, &pressed, law).unwrap();
        rolling.steady(creeps(&rolling, 0.03), 400).unwrap();
        rolling.total()[0] / LOAD
    };
    let [slow, fast] = [1e-4, 1e4].map(carried);
    assert!((slow - 0.5).abs() < 1e-3, "{slow}");
    // points at the front, which have just come into contact, still have the coefficient at rest
    assert!(fast > 0.32 && fast < 0.36, "{fast}");
}

/// A memory far shorter than the slip of a step: over the step friction falls as steeply as its steady law.
#[test]
fn a_step_that_finds_no_solution_is_an_error_and_leaves_the_state_before_it() {
    let (influence, pressed) = wheel();
    let memory = Memory { distance: 3e-7, ..MEMORY };
    let law = SlipLaw { law: Arc::new(Remembering { steady: FALLING, memory }), speed: SPEED };
    let mut rolling = Rolling::with_law(&influence, &pressed, law).unwrap();
    let rigid = creeps(&rolling, 4e-3);
    for _ in 0..40 {
        let before = (rolling.force(), rolling.bound().to_vec(), rolling.slip());
        let Err(error) = rolling.roll(rigid) else { continue };
        assert!(matches!(error, RollingError::Step(FrictionError::Stalled { .. })), "{error}");
        assert_eq!(before, (rolling.force(), rolling.bound().to_vec(), rolling.slip()));
        return;
    }
    panic!("every step found a solution");
}

#[test]
fn speeds_and_laws_without_friction_are_refused() {
    let (influence, pressed) = wheel();
    for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let found = Rolling::with_law(&influence, &pressed, remembering(speed)).map(|_| ());
        assert!(matches!(found, Err(RollingError::Speed { .. })), "{speed}: {found:?}");
    }
    for mu in [0.0, -0.3, f64::NAN] {
        let law = SlipLaw { law: Arc::new(Coulomb { mu }), speed: SPEED };
        let found = Rolling::with_law(&influence, &pressed, law).map(|_| ());
        assert!(matches!(found, Err(RollingError::Friction { .. })), "{mu}: {found:?}");
    }
}
