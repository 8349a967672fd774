//! Friction on a patch: Cattaneo–Mindlin, and Coulomb's law to round-off.
#![allow(clippy::unwrap_used)]

mod common;
use common::{Converging, SPHERE, STEEL, sphere};
use statics::{Adhesion, FrictionError, Influence, Lateral, Press, Rigid, Rolling, RollingError};
use statics::{Pressed, press, stick_fraction};

const LOAD: f64 = 1e4;
const MU: f64 = 0.3;

fn pressed(influence: &Influence) -> Pressed {
    press(influence, Press::Load(LOAD / 2.0), None).unwrap()
}

/// Stick radius (m) and shift (m) at a fraction of the sliding force.
fn cattaneo(influence: &Influence, pressed: &Pressed, fraction: f64) -> [f64; 2] {
    let mut contact = Rolling::new(influence, pressed, MU).unwrap();
    contact.shift([Rigid::Forced(fraction * MU * LOAD / 2.0), Rigid::Moved(0.0)]).unwrap();
    let area: f64 = contact.contact().iter().map(|&i| influence.points()[i].area).sum();
    let stick = stick_fraction(influence, &contact) * 2.0 * area / std::f64::consts::PI;
    [stick.sqrt(), contact.moved()[0]]
}

/// Cattaneo (1938), Mindlin (1949), as tabulated in physics.md, section 9.
#[test]
fn a_sphere_shifted_sticks_inside_the_circle_of_cattaneo() {
    let meshes = [4.0, 5.6, 7.84].map(|n| SPHERE / n);
    let near = meshes.map(|h| sphere(h, 0.02, Lateral::Symmetric, STEEL));
    let far = meshes.map(|h| sphere(h, 0.04, Lateral::Symmetric, STEEL));
    for (fraction, radius, shift) in
        [(0.25, 0.9086, 2.214e-6), (0.5, 0.7937, 4.695e-6), (0.75, 0.63, 7.653e-6)]
    {
        let mut shifts = Vec::new();
        for (k, h) in meshes.into_iter().enumerate() {
            let [stick, near] = cattaneo(&near[k], &pressed(&near[k]), fraction);
            let [_, far] = cattaneo(&far[k], &pressed(&far[k]), fraction);
            let off = (stick - radius * SPHERE) / h;
            println!("Q/muN {fraction}: stick radius {:.4} mm, off by {off:.2} h", stick * 1e3);
            assert!(off.abs() < 1.0, "within one element");
            // What the block misses falls like 1/L, as the approach does.
            shifts.push(far + (far - near));
        }
        let what = format!("shift at {fraction} (m)");
        let shifts = Converging::new(what, 1.4, shifts, (SPHERE / 0.04).powi(3));
        shifts.agrees(shift);
        shifts.within(0.05, shift);
    }
}

#[test]
fn the_law_of_coulomb_holds_to_round_off_in_any_direction() {
    let influence = sphere(SPHERE / 4.0, 0.02, Lateral::Full, STEEL);
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
    let most = contact.slip().iter().map(|s| s[0].hypot(s[1])).fold(0.0, f64::max);
    let largest = contact.bound().iter().fold(0.0f64, |m, g| m.max(*g));
    let states = contact.adhesion();
    assert!(states.contains(&Adhesion::Stick) && states.contains(&Adhesion::Slip));
    for (((p, s), g), state) in
        contact.force().iter().zip(contact.slip()).zip(contact.bound()).zip(states)
    {
        let slip = s[0].hypot(s[1]);
        assert!(p[0].hypot(p[1]) <= g + 1e-9 * largest, "cone");
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
    let influence = sphere(SPHERE / 4.0, 0.02, Lateral::Symmetric, STEEL);
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
