//! Steady rolling: what it does not depend on, and what it is the limit of.
#![allow(clippy::unwrap_used)]

mod common;
use common::{STEEL, element, ellipse};
use verification::reference::{
    Block, Influence, Lateral, Press, Rigid, Rolling, RollingInParts, press,
};

const STEPS: usize = 3000;

fn slice(size: f64, extent: f64) -> Influence {
    Block {
        size,
        reach: [9e-3, 0.0],
        depth: 7e-3,
        extent,
        growth: libm::pow(1.7f64, size / 1e-3),
        lateral: Lateral::PlaneStrain,
        material: STEEL,
    }
    .influence(&element, |x, _| x * x / 0.92)
    .unwrap()
}

/// Steady rolling of a slice under 1e7 N/m with mu 0.3 at a fraction of the sliding force.
fn carter(influence: &Influence, width: f64, fraction: f64) -> Rolling<'_> {
    let load = 1e7 * width;
    let pressed = press(influence, Press::Load(load), None).unwrap();
    let mut rolling = Rolling::new(influence, &pressed, 0.3).unwrap();
    rolling.steady([Rigid::Forced(fraction * 0.3 * load), Rigid::Moved(0.0)], STEPS).unwrap();
    rolling
}

/// A displacement common to all points cancels in the slip of steady rolling: the compliance of
/// the bodies at large, which doubles the shift of this slice, leaves the creepage as it is.
#[test]
fn the_compliance_of_the_bodies_at_large_does_not_change_the_creepage() {
    let h = 0.5e-3;
    let found = [0.075, 0.3].map(|extent| {
        let influence = slice(h, extent);
        let creepage = carter(&influence, h, 0.5).creepage()[0];
        let pressed = press(&influence, Press::Load(1e7 * h), None).unwrap();
        let mut shifted = Rolling::new(&influence, &pressed, 0.3).unwrap();
        shifted.shift([Rigid::Forced(0.15 * 1e7 * h), Rigid::Moved(0.0)]).unwrap();
        [creepage, shifted.moved()[0]]
    });
    println!("creepage and shift (m) at L = 75 and 300 mm: {found:.9?}");
    assert!(found[1][1] / found[0][1] > 1.2, "the shift grows with the body");
    // What is left is the strain that the far boundary adds over the patch, of order (a/L)^2.
    let left = (found[1][0] / found[0][0] - 1.0).abs();
    assert!(left < (7.125e-3f64 / 0.075).powi(2), "{left:e}");

    // The same for a compliance that is uniform to the last digit, added at every point.
    let influence = slice(h, 0.075);
    let soft = influence.with_bulk(1e3 * influence.shear(0, 0)[0][0]);
    let [a, b] = [&influence, &soft].map(|i| carter(i, h, 0.5).creepage()[0]);
    assert!((a / b - 1.0).abs() < 1e-6, "{a:e} {b:e}");
}

/// Steady rolling is what rolling tends to: found at once, or reached step by step from rest.
#[test]
fn the_steady_state_is_the_limit_of_rolling_from_rest() {
    let influence = ellipse(1.4e-3, 0.08);
    let pressed = press(&influence, Press::Load(5e4), None).unwrap();
    let rigid = |pitch: f64| [Rigid::Moved(2e-3 * pitch), Rigid::Moved(0.0)];
    let mut steady = Rolling::new(&influence, &pressed, 0.5).unwrap();
    let rigid = rigid(steady.pitch());
    let steps = steady.steady(rigid, STEPS).unwrap();
    let mut rolling = Rolling::new(&influence, &pressed, 0.5).unwrap();
    for _ in 0..200 {
        rolling.roll(rigid).unwrap();
    }
    println!("steady after {steps} steps");
    for ((a, b), g) in steady.force().iter().zip(rolling.force()).zip(steady.bound()) {
        assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-6 * g.max(steady.bound()[0]));
    }
}

/// Rolling in parts of a pitch with one part is rolling in pitches. With two, the error beside Carter (1926) is less than half
/// as large; four change little more.
#[test]
fn steps_of_half_a_pitch_take_away_most_of_the_error_of_steps_of_one_pitch() {
    let h = 1e-3;
    let whole = slice(h, 0.075);
    let place = |offset: f64| {
        let influence = whole.with_gaps(|x, _| (x - offset).powi(2) / 0.92);
        let pressed = press(&influence, Press::Load(1e7 * h), None).unwrap();
        (influence, pressed)
    };
    let creepage = |places: &[_]| {
        let mut rolling = RollingInParts::new(places, 0.3).unwrap();
        rolling.steady([Rigid::Forced(0.15 * 1e7 * h), Rigid::Moved(0.0)], STEPS).unwrap();
        rolling.creepage()[0]
    };
    let pitches = carter(&whole, h, 0.5).creepage()[0];
    assert!((creepage(&[place(0.0)]) / pitches - 1.0).abs() < 1e-6);
    let halves = creepage(&[place(0.0), place(0.5 * h)]);
    let quarters = creepage(&[0.0, 0.25, 0.5, 0.75].map(|part| place(part * h)));
    let carter = 0.3 * 7.125e-3 / 0.46 * (1.0 - 0.5f64.sqrt());
    let [one, two, four] = [pitches, halves, quarters].map(|found| (found / carter - 1.0).abs());
    println!("errors: {one:.4} {two:.4} {four:.4}");
    assert!(two < 0.5 * one && (four - two).abs() < 0.1 * one);
}
