//! A sphere pressed on a flat and shifted: Cattaneo (1938), Mindlin (1949).
//!
//! Stick ends at the radius c = a (1 - Q/(mu N))^(1/3), the shift is
//! 3 mu N (2 - nu)/(16 G a) (1 - (1 - Q/(mu N))^(2/3)). What a block that ends at L misses of the shift
//! falls like 1/L, as the approach of the bodies does: the shift extrapolated from two blocks is that
//! of the half-space but for terms of (a/L)^3.

use crate::convergence::Convergence;
use crate::half_space::{
    HalfSpaces, SPHERE, SPHERE_EXTENT, SPHERE_SIZES, column, on_meshes, sizes,
};
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use statics::{Influence, Lateral, Rigid, Rolling, stick_fraction};
use std::f64::consts::PI;

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
            values[2 * k] = near[k][0];
            values[2 * k + 1] = far[k][1] + (far[k][1] - near[k][1]);
        }
        Ok(values)
    })?;
    let mut rows = Vec::new();
    for (k, [share, radius, shift]) in TABLE.into_iter().enumerate() {
        let radii = Convergence::by_theory(column(&found, 2 * k), 1.0);
        let h = radii.samples().last().map_or(f64::NAN, |s| s.size);
        let radius = radius * SPHERE.half_axes[0];
        let row = Row::new(
            format!("Q/(mu N) = {share}: radius of stick (m)"),
            [radius, radii.finest()],
            radius,
            (h / radius, "one element, h/c"),
            SOURCE,
        );
        rows.push(Row { meshes: radii.samples().to_vec(), ..row });
        let shifts = Convergence::by_theory(column(&found, 2 * k + 1), 1.0);
        let quantity = format!("Q/(mu N) = {share}: shift (m)");
        let body = SPHERE.body(2.0 * SPHERE_EXTENT);
        rows.push(Row::extrapolated(&quantity, shift, &shifts, body, SOURCE));
        let quantity = format!("{quantity} on the finest mesh");
        rows.push(Row::asked(quantity, [shift, shifts.finest()], 0.05, SOURCE));
    }
    Ok(rows)
}

/// Radius of the circle with the area that sticks, with the apex on a node (m), and shift (m), over a
/// pitch, at each share of the sliding force.
fn shifted(h: f64, extent: f64) -> Result<[[f64; 2]; 3], Cause> {
    let blocks = HalfSpaces::new(&SPHERE, SPHERE.block(h, extent, Lateral::Symmetric))?;
    let radii = contacts(&blocks, &blocks.influence)?.map(|[radius, _]| radius);
    let shifts = blocks
        .over_a_pitch(|influence, _| Ok(contacts(&blocks, influence)?.map(|[_, shift]| shift)))?;
    Ok(std::array::from_fn(|k| [radii[k], shifts[k]]))
}

fn contacts(blocks: &HalfSpaces<'_>, influence: &Influence) -> Result<[[f64; 2]; 3], Cause> {
    let pressed = blocks.press(influence)?;
    let mut found = [[0.0; 2]; 3];
    for ([share, ..], found) in TABLE.into_iter().zip(&mut found) {
        let mut contact = Rolling::new(influence, &pressed, MU)?;
        contact.shift([Rigid::Forced(share * MU * blocks.load), Rigid::Moved(0.0)])?;
        let half: f64 = contact.contact().iter().map(|&i| influence.points()[i].area).sum();
        let stick = stick_fraction(influence, &contact) * 2.0 * half / PI;
        *found = [stick.sqrt(), contact.moved()[0]];
    }
    Ok(found)
}
