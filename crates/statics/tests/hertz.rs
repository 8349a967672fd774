//! Normal contact of two equal blocks against Hertz.
#![allow(clippy::unwrap_used)]

mod common;
use common::{Block, Lateral, STEEL};
use statics::{Press, press};

#[test]
fn explore() {
    let load = 1e4;
    for h in [0.4e-3, 0.2e-3] {
        for (extent, growth) in [(0.02, 1.5), (0.04, 1.5), (0.04, 1.3)] {
            let a = 1.8663e-3;
            let block = Block {
                size: h,
                reach: [1.4 * a, 1.4 * a],
                depth: 1.0 * a,
                extent,
                growth,
                lateral: Lateral::Symmetric,
                material: STEEL,
            };
            let influence = block.influence(|x, y| (x * x + y * y) / 0.2);
            let t = std::time::Instant::now();
            let pressed = press(&influence, Press::Load(load / 2.0), None).unwrap();
            let p = pressed.pressure(&influence);
            let peak = p.iter().fold(0.0f64, |m, p| m.max(*p));
            let area: f64 = pressed.contact.iter().map(|&i| influence.points()[i].area).sum();
            let radius = (2.0 * area / std::f64::consts::PI).sqrt();
            println!(
                "h {h} extent {extent} growth {growth}: p0 {:.4} GPa (1.3709), a {:.4} mm (1.8663), approach {:.3} um (34.83), rounds {} {:.3} s",
                peak * 1e-9,
                radius * 1e3,
                pressed.approach * 1e6,
                pressed.rounds,
                t.elapsed().as_secs_f64()
            );
        }
    }
}
