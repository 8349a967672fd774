//! Friction on a patch: Coulomb's law to round-off, and what cannot be.
#![allow(clippy::unwrap_used)]

mod common;
use common::{SPHERE, sphere};
use verification::reference::{
    Adhesion, FrictionError, Influence, Lateral, Press, Rigid, Rolling, RollingError,
};
use verification::reference::{Pressed, press};

const LOAD: f64 = 1e4;
const MU: f64 = 0.3;

fn pressed(influence: &Influence) -> Pressed {
    press(influence, Press::Load(LOAD / 2.0), None).unwrap()
}

#[test]
fn the_law_of_coulomb_holds_to_round_off_in_any_direction() {
    let influence = sphere(SPHERE / 4.0, 0.02, Lateral::Full);
    let pressed = press(&influence, Press::Load(LOAD), None).unwrap();
    let mut contact = Rolling::new(&influence, &pressed, MU).unwrap();
    let forced = |x: f64, y: f64| [Rigid::Forced(x * MU * LOAD), Rigid::Forced(y * MU * LOAD)];
    // Loading, turning, rolling: every step from the state of the one before.
    contact.shift(forced(0.5, 0.0)).unwrap();
    check(&contact);
    contact.shift(forced(0.3, 0.6)).unwrap();
    check(&contact);
    for _ in 0..5 {
        contact.roll(forced(0.3, 0.6)).unwrap();
        check(&contact);
    }
    let total = contact.total();
    assert!((total[0] / (0.3 * MU * LOAD) - 1.0).abs() < 1e-9);
    assert!((total[1] / (0.6 * MU * LOAD) - 1.0).abs() < 1e-9);
}

fn check(contact: &Rolling<'_>) {
    let most = contact.slip().iter().map(|s| libm::hypot(s[0], s[1])).fold(0.0, f64::max);
    let largest = contact.bound().iter().fold(0.0f64, |m, g| m.max(*g));
    let states = contact.adhesion();
    assert!(states.contains(&Adhesion::Stick) && states.contains(&Adhesion::Slip));
    for (((p, s), g), state) in
        contact.force().iter().zip(contact.slip()).zip(contact.bound()).zip(states)
    {
        let slip = libm::hypot(s[0], s[1]);
        assert!(libm::hypot(p[0], p[1]) <= g + 1e-9 * largest, "cone");
        match state {
            Adhesion::Stick => assert!(slip <= 1e-9 * most, "stick: {slip:e} of {most:e}"),
            // p = -g s/|s|
            Adhesion::Slip => {
                let off = (0..2).map(|a| (p[a] * slip + g * s[a]).abs()).fold(0.0, f64::max);
                assert!(off <= 1e-8 * largest * most, "direction");
            }
        }
    }
}

#[test]
fn more_than_friction_carries_slides_and_a_patch_at_the_border_is_refused() {
    let influence = sphere(SPHERE / 4.0, 0.02, Lateral::Symmetric);
    let light = pressed(&influence);
    let mut contact = Rolling::new(&influence, &light, MU).unwrap();
    let fault = contact.shift([Rigid::Forced(1.01 * MU * LOAD / 2.0), Rigid::Moved(0.0)]);
    assert!(matches!(fault, Err(RollingError::Step(FrictionError::Slides { .. }))));
    // Full slip by motion: every point at its bound.
    contact.shift([Rigid::Moved(1e-3), Rigid::Moved(0.0)]).unwrap();
    assert!(contact.adhesion().iter().all(|s| *s == Adhesion::Slip));
    assert!((contact.total()[0] / (MU * LOAD / 2.0) - 1.0).abs() < 1e-6);
    let heavy = press(&influence, Press::Load(4.0 * LOAD), None).unwrap();
    assert!(matches!(Rolling::new(&influence, &heavy, MU), Err(RollingError::Border { .. })));
    assert!(matches!(Rolling::new(&influence, &light, 0.0), Err(RollingError::Friction { .. })));
}
