#![allow(clippy::unwrap_used)]
mod common;
use common::{Block, Lateral, STEEL, contact_modulus};
use statics::{Adhesion, Press, Rigid, Rolling, press};
use std::time::Instant;

#[test]
fn cattaneo() {
    let (load, mu) = (1e4, 0.3);
    let a = 1.8663e-3;
    for h in [0.4e-3, 0.2e-3] {
        let block = Block {
            size: h,
            reach: [1.4 * a, 1.4 * a],
            depth: a,
            extent: 0.04,
            growth: 1.5,
            lateral: Lateral::Symmetric,
            material: STEEL,
        };
        let influence = block.influence(|x, y| (x * x + y * y) / 0.2);
        let pressed = press(&influence, Press::Load(load / 2.0), None).unwrap();
        for (q, c, shift) in [(0.25, 0.9086, 2.214), (0.5, 0.7937, 4.695), (0.75, 0.63, 7.653)] {
            let t = Instant::now();
            let mut r = Rolling::new(&influence, &pressed, mu).unwrap();
            r.shift([Rigid::Forced(q * mu * load / 2.0), Rigid::Moved(0.0)]).unwrap();
            let stick: f64 = r
                .contact()
                .iter()
                .zip(r.adhesion())
                .filter(|(_, s)| *s == Adhesion::Stick)
                .map(|(&i, _)| influence.points()[i].area)
                .sum();
            let all: f64 = r.contact().iter().map(|&i| influence.points()[i].area).sum();
            println!(
                "h {h} q {q}: c/a {:.4} ({c}) shift {:.4} um ({shift}) {:.3} s",
                (stick / all).sqrt(),
                r.moved()[0] * 1e6,
                t.elapsed().as_secs_f64()
            );
        }
    }
}

#[test]
fn carter() {
    let mu = 0.3;
    let a = 7.125e-3;
    for h in [0.5e-3, 0.25e-3] {
        for extent in [0.15, 0.3] {
            let block = Block {
                size: h,
                reach: [1.3 * a, 0.0],
                depth: a,
                extent,
                growth: 1.3,
                lateral: Lateral::PlaneStrain,
                material: STEEL,
            };
            let load = 1e7 * h;
            let influence = block.influence(|x, _| x * x / 0.92);
            let pressed = press(&influence, Press::Load(load), None).unwrap();
            let p = pressed.pressure(&influence);
            println!(
                "p0 {:.4} GPa (.8936) contact {}",
                p.iter().fold(0.0f64, |m, p| m.max(*p)) * 1e-9,
                pressed.contact.len()
            );
            for (q, xi) in [(0.25, 6.225e-4), (0.5, 1.3609e-3), (0.75, 2.3232e-3), (0.9, 3.1771e-3)]
            {
                let t = Instant::now();
                let mut r = Rolling::new(&influence, &pressed, mu).unwrap();
                let steps = r.steady([Rigid::Forced(q * mu * load), Rigid::Moved(0.0)], 2000);
                let states: Vec<_> = r
                    .adhesion()
                    .iter()
                    .map(|s| if *s == Adhesion::Stick { '-' } else { 's' })
                    .collect();
                let s: String = states.iter().collect();
                println!(
                    "h {h} L {extent} q {q}: {:.4e} ({xi:.4e}) {:.2}% {steps:?} {:.3} s {s}",
                    r.creepage()[0],
                    (r.creepage()[0] / xi - 1.0) * 100.0,
                    t.elapsed().as_secs_f64()
                );
            }
        }
    }
}

#[test]
fn kalker() {
    let mu = 0.3;
    let a = 1.8663e-3;
    let load = 1e4;
    for h in [0.3e-3, 0.2e-3] {
        let block = Block {
            size: h,
            reach: [1.3 * a, 1.3 * a],
            depth: a,
            extent: 0.02,
            growth: 1.5,
            lateral: Lateral::Full,
            material: STEEL,
        };
        let influence = block.influence(|x, y| (x * x + y * y) / 0.2);
        let pressed = press(&influence, Press::Load(load), None).unwrap();
        let g = STEEL.young / 2.6;
        for axis in 0..2 {
            for xi in [1e-5, 2e-5, 4e-5] {
                let t = Instant::now();
                let mut r = Rolling::new(&influence, &pressed, 100.0 * mu).unwrap();
                let mut rigid = [Rigid::Moved(0.0); 2];
                rigid[axis] = Rigid::Moved(xi * r.pitch());
                let steps = r.steady(rigid, 1000);
                println!(
                    "h {h} axis {axis} xi {xi}: C {:.4} (4.294, 3.728) {steps:?} {:.3} s",
                    r.total()[axis] / (g * a * a * xi),
                    t.elapsed().as_secs_f64()
                );
            }
        }
    }
    let _ = contact_modulus(&STEEL);
}

#[test]
fn steady() {
    let mu = 0.5;
    let (a, b) = (7.162e-3, 5.387e-3);
    let load = 1e5;
    for h in [1e-3, 0.7e-3, 0.5e-3] {
        let block = Block {
            size: h,
            reach: [1.25 * a, 1.25 * b],
            depth: b,
            extent: 0.1,
            growth: 1.5,
            lateral: Lateral::Symmetric,
            material: STEEL,
        };
        let influence = block.influence(|x, y| x * x / 0.92 + y * y / 0.6);
        let pressed = press(&influence, Press::Load(load / 2.0), None).unwrap();
        let p = pressed.pressure(&influence);
        println!(
            "p0 {:.1} MPa (1237.6), approach {:.2} um (104.1)",
            p.iter().fold(0.0f64, |m, p| m.max(*p)) * 1e-6,
            pressed.approach * 1e6
        );
        for (q, xi, peak) in
            [(0.15, 1.1554e-3, 416.), (0.28, 2.4348e-3, 553.), (0.40, 4.137e-3, 618.)]
        {
            let t = Instant::now();
            let mut r = Rolling::new(&influence, &pressed, mu).unwrap();
            let steps = r.steady([Rigid::Forced(q * load / 2.0), Rigid::Moved(0.0)], 2000);
            let f = r.force();
            let pk = r
                .contact()
                .iter()
                .zip(&f)
                .map(|(&i, f)| f[0].hypot(f[1]) / influence.points()[i].area)
                .fold(0.0f64, f64::max);
            let line: String = r
                .contact()
                .iter()
                .zip(r.adhesion())
                .filter(|(i, _)| influence.points()[**i].at[1] == 0.0)
                .map(|(_, s)| if s == Adhesion::Stick { '-' } else { 's' })
                .collect();
            println!(
                "h {h} q {q}: {:.4e} ({xi:.4e}) {:.2}% peak {:.1} ({peak}) {steps:?} {:.3} s {line}",
                r.creepage()[0],
                (r.creepage()[0] / xi - 1.0) * 100.0,
                pk * 1e-6,
                t.elapsed().as_secs_f64()
            );
        }
    }
}
