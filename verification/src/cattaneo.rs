//! A sphere pressed on a flat and shifted: Cattaneo (1938), Mindlin (1949).
//!
//! Stick ends at the radius c = a (1 - Q/(mu N))^(1/3), and the relative shift of two equal bodies is
//! 3 mu N (2 - nu)/(8 G a) (1 - (1 - Q/(mu N))^(2/3)). The part of the shift that a block ending at L lacks
//! falls as 1/L, as for the approach of the bodies: the shift extrapolated from two blocks is that
//! of the half-space up to terms of (a/L)^3.
//!
//! The reserve of friction, mu p - q, is mu p_0 (c/a) sqrt(1 - r^2/c^2) where the surfaces stick and zero
//! where they slip. This is an ellipsoid like Hertz's, whose radius c follows from its mean of r^2. A radius from the
//! number of sticking nodes would change by whole nodes and, since a node sticks with its whole area, be too large by
//! half an element.

use crate::convergence::Convergence;
use crate::half_space::{
    HalfSpaces, SPHERE, SPHERE_EXTENT, SPHERE_SIZES, column, on_meshes, sizes,
};
use crate::problem::{Cause, Outcome, Size};
use crate::reference::{Influence, Lateral, Rigid, Rolling};
use crate::row::Row;

const MU: f64 = 0.3;
const SOURCE: &str = "Cattaneo (1938), Mindlin (1949)";
/// Q/(mu N), c/a and shift (m).
const TABLE: [[f64; 3]; 3] =
    [[0.25, 0.9086, 2.214e-6], [0.5, 0.7937, 4.695e-6], [0.75, 0.63, 7.653e-6]];

pub(crate) fn run(size: Size) -> Outcome {
    let found = on_meshes(sizes(size, &SPHERE_SIZES), |h| {
        let near = shifted(h, SPHERE_EXTENT)?;
        let far = shifted(h, 2.0 * SPHERE_EXTENT)?;
        let mut values = [0.0; 6];
        for k in 0..TABLE.len() {
            values[2 * k] = near[2 * k];
            values[2 * k + 1] = far[2 * k + 1] + (far[2 * k + 1] - near[2 * k + 1]);
        }
        Ok(values)
    })?;
    let mut rows = Vec::new();
    for (k, [share, radius, shift]) in TABLE.into_iter().enumerate() {
        let radii = Convergence::by_theory(column(&found, 2 * k), 1.0);
        let quantity = format!("Q/(mu N) = {share}: radius of stick (m)");
        let (radius, body) = (radius * SPHERE.half_axes[0], SPHERE.body(SPHERE_EXTENT));
        rows.push(Row::extrapolated(&quantity, radius, &radii, body, SOURCE));
        let shifts = Convergence::by_theory(column(&found, 2 * k + 1), 1.0);
        let quantity = format!("Q/(mu N) = {share}: shift (m)");
        let body = SPHERE.body(2.0 * SPHERE_EXTENT);
        rows.push(Row::extrapolated(&quantity, shift, &shifts, body, SOURCE));
        let quantity = format!("{quantity} on the finest mesh");
        rows.push(Row::asked(quantity, [shift, shifts.finest()], 0.01, SOURCE));
    }
    Ok(rows)
}

/// Radius of stick (m) and shift (m) at each Q/(mu N) of [`TABLE`], means over a pitch.
fn shifted(h: f64, extent: f64) -> Result<[f64; 6], Cause> {
    let blocks = HalfSpaces::new(&SPHERE, SPHERE.block(h, extent, Lateral::Symmetric))?;
    blocks.over_a_pitch(|influence, apex| contacts(&blocks, influence, apex))
}

fn contacts(blocks: &HalfSpaces<'_>, influence: &Influence, apex: f64) -> Result<[f64; 6], Cause> {
    let pressed = blocks.press(influence)?;
    let mut found = [0.0; 6];
    for ([share, ..], found) in TABLE.into_iter().zip(found.chunks_exact_mut(2)) {
        let mut contact = Rolling::new(influence, &pressed, MU)?;
        contact.shift([Rigid::Forced(share * MU * blocks.load), Rigid::Moved(0.0)])?;
        let (mut reserve, mut moment) = (0.0, 0.0);
        for (k, &i) in contact.contact().iter().enumerate() {
            let [fx, fy] = contact.force()[k];
            let left = (contact.bound()[k] - libm::hypot(fx, fy)).max(0.0);
            let [x, y, _] = influence.points()[i].at.into();
            reserve += left;
            moment += left * ((x - apex).powi(2) + y * y);
        }
        // of an ellipsoid of radius c the mean of r^2 is 2 c^2/5
        let radius = (2.5 * moment / reserve).sqrt();
        found.copy_from_slice(&[radius, contact.moved()[0]]);
    }
    Ok(found)
}
