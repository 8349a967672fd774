//! Steady rolling: Carter, Kalker, and CONTACT on the reference ellipse.
#![allow(clippy::unwrap_used)]

mod common;
use common::{
    Converging, ELLIPSE, SPHERE, STEEL, element, ellipse, ellipse_gap, over_a_pitch, sphere_gap,
};
use solid::Material;
use statics::{
    Adhesion, Block, Influence, Lateral, Press, Rigid, Rolling, peak_shear, press, stick_border,
    stick_fraction,
};

const STEPS: usize = 3000;

fn slice(size: f64, extent: f64) -> Influence {
    Block {
        size,
        reach: [9e-3, 0.0],
        depth: 7e-3,
        extent,
        growth: 1.7f64.powf(size / 1e-3),
        lateral: Lateral::PlaneStrain,
        material: STEEL,
    }
    .influence(&element, line_gap([0.0; 2]))
    .unwrap()
}

fn line_gap([apex, _]: [f64; 2]) -> impl Fn(f64, f64) -> f64 {
    move |x, _| (x - apex).powi(2) / 0.92
}

/// Steady rolling of a slice under 1e7 N/m with mu 0.3 at a fraction of the sliding force.
fn carter(influence: &Influence, width: f64, fraction: f64) -> Rolling<'_> {
    let load = 1e7 * width;
    let pressed = press(influence, Press::Load(load), None).unwrap();
    let mut rolling = Rolling::new(influence, &pressed, 0.3).unwrap();
    rolling.steady([Rigid::Forced(fraction * 0.3 * load), Rigid::Moved(0.0)], STEPS).unwrap();
    rolling
}

/// Carter (1926): creepage mu a/R (1 - sqrt(1 - Q/muN)), physics.md, section 9.
#[test]
fn carters_creepage_and_his_stick_zone_at_the_leading_edge() {
    let sizes = [1e-3, 0.5e-3, 0.25e-3];
    let slices = sizes.map(|h| slice(h, 0.15));
    for (fraction, creepage) in
        [(0.25, 6.225e-4), (0.5, 1.3609e-3), (0.75, 2.3232e-3), (0.9, 3.1771e-3)]
    {
        let mut found = Vec::new();
        for (influence, h) in slices.iter().zip(sizes) {
            let rolling = carter(influence, h, fraction);
            // Stick from x = a - 2 a' to the leading edge a, a'/a = sqrt(1 - Q/muN).
            let a = 7.125e-3;
            let border = a - 2.0 * a * (1.0f64 - fraction).sqrt();
            let at = stick_border(influence, &rolling).unwrap();
            println!("Q/muN {fraction}, h {h}: border {:.3} of {:.3} mm", at * 1e3, border * 1e3);
            assert!((at - border).abs() < h, "within one element");
            for (&i, state) in rolling.contact().iter().zip(rolling.adhesion()) {
                let ahead = influence.points()[i].at[0] > at - 0.5 * h;
                assert_eq!(state == Adhesion::Stick, ahead, "one zone, at the leading edge");
            }
            let creepage = |i: &Influence| [carter(i, h, fraction).creepage()[0]];
            found.push(over_a_pitch(influence, h, line_gap, creepage)[0]);
        }
        let what = format!("Carter at {fraction}");
        let found = Converging::new(what, 2.0, found, (7.125e-3f64 / 0.15).powi(2));
        found.agrees(creepage);
        found.within(0.05, creepage);
    }
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

/// C11 and C22 of a circle: force over G a^2 times the creepage, twice the slope at a small
/// creepage less that at twice as much (the slope falls linearly with the creepage).
fn kalker(influence: &Influence, material: &Material, axis: usize) -> f64 {
    let pressed = press(influence, Press::Load(1e4), None).unwrap();
    let slope = |creepage: f64| {
        let mut rolling = Rolling::new(influence, &pressed, 0.3).unwrap();
        let mut rigid = [Rigid::Moved(0.0); 2];
        rigid[axis] = Rigid::Moved(creepage * rolling.pitch());
        rolling.steady(rigid, STEPS).unwrap();
        rolling.total()[axis] / (material.shear() * SPHERE * SPHERE * creepage)
    };
    2.0 * slope(1e-4) - slope(2e-4)
}

/// Kalker (1990); values of CONTACT extrapolated to h = 0 (circ_nu025, circ_nu030, their fits).
#[test]
fn kalkers_coefficients_of_a_circle() {
    const EXTENT: f64 = 0.015;
    for (poisson, c11, c22) in [(0.25, 4.1125, 3.6676), (0.3, 4.2941, 3.7281)] {
        // The same E* makes the same patch.
        let young = 210e9 * (1.0 - poisson * poisson) / 0.91;
        let material = Material { poisson, young, ..STEEL };
        let found = [5.0, 7.0, 9.8].map(|n| SPHERE / n).map(|h| {
            // A coarse far mesh: what it changes is common to all points, and cancels.
            let block = Block {
                size: h,
                reach: [1.15 * SPHERE, 1.15 * SPHERE],
                depth: 0.7 * SPHERE,
                extent: EXTENT,
                growth: 1.6,
                lateral: Lateral::Full,
                material,
            };
            let influence = block.influence(&element, sphere_gap([0.0; 2])).unwrap();
            let of = |i: &Influence| [0, 1].map(|axis| kalker(i, &material, axis));
            over_a_pitch(&influence, h, sphere_gap, of)
        });
        for (axis, reference) in [(0, c11), (1, c22)] {
            let values = found.iter().map(|f| f[axis]).collect();
            let what = format!("C{0}{0}, nu {poisson}", axis + 1);
            let found = Converging::new(what, 1.4, values, (SPHERE / EXTENT).powi(3));
            found.agrees(reference);
            found.extrapolated_within(0.05, reference);
        }
    }
}

/// Steady rolling is what rolling tends to: found at once, or reached step by step from rest.
#[test]
fn the_steady_state_is_the_limit_of_rolling_from_rest() {
    let influence = ellipse(1.4e-3, BODY);
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

/// CONTACT at h -> 0 (zl_2_steady_fit, zl_2_steady_summary): creepage, stick area, border of stick
/// on y = 0 (m) and peak shear (Pa) at T/N with mu 0.5.
const STEADY: [[f64; 5]; 3] = [
    [0.15, 1.1554e-3, 0.8333, -5.275e-3, 416.2e6],
    [0.28, 2.4348e-3, 0.6517, -3.225e-3, 552.8e6],
    [0.40, 4.1370e-3, 0.4242, -0.425e-3, 617.6e6],
];

const SIZES: [f64; 3] = [1.4e-3, 1e-3, 0.714e-3];
const BODY: f64 = 0.08;

/// The block under the reference ellipse rolling steadily.
fn rolled(influence: &Influence, mu: f64, along: impl Fn(f64) -> Rigid) -> Rolling<'_> {
    let pressed = press(influence, Press::Load(5e4), None).unwrap();
    let mut rolling = Rolling::new(influence, &pressed, mu).unwrap();
    let rigid = [along(rolling.pitch()), Rigid::Moved(0.0)];
    rolling.steady(rigid, STEPS).unwrap();
    rolling
}

#[test]
fn steady_rolling_of_the_reference_ellipse_agrees_with_contact() {
    let blocks = SIZES.map(|h| ellipse(h, BODY));
    let body = (ELLIPSE[0] / BODY).powi(3);
    for [traction, creepage, stick, border, peak] in STEADY {
        let mut found = [const { Vec::new() }; 4];
        for (influence, h) in blocks.iter().zip(SIZES) {
            let of = |i: &Influence| {
                let rolling = rolled(i, 0.5, |_| Rigid::Forced(traction * 5e4));
                let at = stick_border(i, &rolling).unwrap();
                let share = stick_fraction(i, &rolling);
                [rolling.creepage()[0], peak_shear(i, &rolling), at, share]
            };
            // With the apex on a node the border is that of the profile along y = 0.
            let at = of(influence)[2];
            println!("T/N {traction}, h {h}: border {:.2} mm of {:.2}", at * 1e3, border * 1e3);
            assert!((at - border).abs() <= h, "within one element");
            let mean = over_a_pitch(influence, h, ellipse_gap, of);
            found.iter_mut().zip(mean).for_each(|(list, value)| list.push(value));
        }
        let [creepages, peaks, _, shares] = found;
        for (share, h) in shares.iter().zip(SIZES) {
            println!("T/N {traction}, h {h}: stick {share:.3} of {stick:.3}");
            // Half an element all along the border: pi (a + b) h/2 of pi a b.
            let half = 0.5 * h * (1.0 / ELLIPSE[0] + 1.0 / ELLIPSE[1]);
            assert!((share - stick).abs() < half, "stick area");
        }
        let check = |what: &str, values, reference| {
            let what = format!("{what} at T/N {traction}");
            Converging::new(what, 1.4, values, body).agrees(reference);
        };
        check("creepage", creepages, creepage);
        check("peak shear", peaks, peak);
    }
}

/// CONTACT's creep–force curve at h -> 0 (zl_3_creepforce_fit): T/N at creepage, mu 0.5 and 0.32.
#[test]
fn the_creep_force_curve_agrees_with_contact() {
    const CURVE: [(f64, f64, f64); 8] = [
        (0.5, 0.0005, 0.068871),
        (0.5, 0.0015, 0.188622),
        (0.5, 0.003, 0.326197),
        (0.5, 0.006, 0.472259),
        (0.5, 0.010, 0.499670),
        (0.32, 0.0005, 0.067163),
        (0.32, 0.0015, 0.174037),
        (0.32, 0.004, 0.305938),
    ];
    let blocks = SIZES.map(|h| ellipse(h, BODY));
    let body = (ELLIPSE[0] / BODY).powi(3);
    for (mu, creepage, force) in CURVE {
        let of = |i: &Influence| [rolled(i, mu, |h| Rigid::Moved(creepage * h)).total()[0] / 5e4];
        let found = blocks.iter().zip(SIZES).map(|(i, h)| over_a_pitch(i, h, ellipse_gap, of)[0]);
        let what = format!("T/N at {creepage}, mu {mu}");
        Converging::new(what, 1.4, found.collect(), body).agrees(force);
    }
}
