//! Shared problems. What they give beside closed forms and CONTACT is verified in the problems of this package.
#![allow(dead_code)]

use nalgebra::Vector3;
use solid::{Element, Material, element_stiffness};
use verification::reference::{Block, Influence, Lateral};

pub const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };

pub fn element(x: &[Vector3<f64>; 8], m: &Material) -> [[f64; 24]; 24] {
    element_stiffness(x, m, Element { hourglass: 0.05 })
}

/// Hertz's sphere on a flat, R = 0.1 m, 10 kN: half axis (m).
pub const SPHERE: f64 = 1.8663e-3;

/// The block under it; the whole mesh is refined with `size`, its grading too.
pub fn sphere(size: f64, extent: f64, lateral: Lateral) -> Influence {
    let coarse = SPHERE / 4.0;
    Block {
        size,
        reach: [1.3 * SPHERE, 1.3 * SPHERE],
        depth: SPHERE,
        extent,
        growth: libm::pow(1.7f64, size / coarse),
        lateral,
        material: STEEL,
    }
    .influence(&element, |x, y| (x * x + y * y) / 0.2)
    .unwrap()
}

/// Half axes of the reference ellipse (m): R 0.46 m along x, 0.30 m across, 100 kN.
pub const ELLIPSE: [f64; 2] = [7.1617e-3, 5.3872e-3];

/// The half block under the reference ellipse.
pub fn ellipse(size: f64, extent: f64) -> Influence {
    Block {
        size,
        reach: [1.3 * ELLIPSE[0], 1.3 * ELLIPSE[1]],
        depth: ELLIPSE[1],
        extent,
        growth: libm::pow(1.7f64, size / 1.4e-3),
        lateral: Lateral::Symmetric,
        material: STEEL,
    }
    .influence(&element, |x, y| x * x / 0.92 + y * y / 0.60)
    .unwrap()
}
