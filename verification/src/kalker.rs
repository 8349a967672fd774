//! Kalker's coefficients: the slope of the creep–force curve at zero creepage.
//!
//! F_x = G c^2 C11 xi_x, F_y = G c^2 C22 xi_y with c^2 = a b (Kalker 1990). The secant slope falls linearly
//! with a small creepage: twice the slope at xi less that at 2 xi is the slope at zero.
//! A displacement common to all points cancels in the slip of steady rolling, and with it the
//! compliance far from the contact: the effect of the finite block is of order (a/L)^3.

use crate::body::STEEL;
use crate::convergence::Convergence;
use crate::half_space::{
    HalfSpaces, Hertz, SPHERE, STEPS, WHEEL, WHEEL_EXTENT, column, on_meshes, sizes,
};
use crate::problem::{Cause, Outcome, Size};
use crate::reference::{Block, Influence, Lateral, Rigid, Rolling};
use crate::row::Row;
use solid::Material;

const MU: f64 = 0.3;
const SMALL: f64 = 1e-4;
/// The patch gains and loses whole nodes, so that its area oscillates by half a per cent from mesh to mesh, and with it a
/// coefficient. First order from meshes whose sizes differ by the factor 1.4 takes 3.5 times the finer value less 2.5 times the
/// coarser one.
const SCATTER: f64 = (3.5 + 2.5) * 0.005;
const SOURCE: &str = "CONTACT (Vollebregt), extrapolated to h = 0";

/// Growth of elements far from the contact: a coarse mesh there changes displacements common to all points, which
/// cancel.
const GROWTH: f64 = 1.6;

pub(crate) fn circle(size: Size) -> Outcome {
    const EXTENT: f64 = 0.015;
    const SIZES: [f64; 4] = [1.8663e-3 / 5.0, 1.8663e-3 / 7.0, 1.8663e-3 / 9.8, 1.8663e-3 / 13.72];
    let mut rows = Vec::new();
    for (poisson, references) in [(0.25, [4.1125, 3.6676]), (0.3, [4.2941, 3.7281])] {
        // the same E* gives the same patch
        let one = |nu: f64| 1.0 - nu * nu;
        let young = STEEL.young * one(poisson) / one(STEEL.poisson);
        let material = Material { poisson, young, ..STEEL };
        let found = coefficients(&SPHERE, sizes(size, &SIZES), EXTENT, material)?;
        rows.extend(compared(&format!("nu {poisson}"), &found, references, SPHERE.body(EXTENT)));
    }
    Ok(rows)
}

pub(crate) fn ellipse(size: Size) -> Outcome {
    const SIZES: [f64; 4] = [1.4e-3, 1e-3, 0.714e-3, 0.51e-3];
    let found = coefficients(&WHEEL, sizes(size, &SIZES), WHEEL_EXTENT, STEEL)?;
    Ok(compared("a/b 1.33, nu 0.3", &found, [4.6200, 4.1722], WHEEL.body(WHEEL_EXTENT)))
}

fn compared(
    what: &str,
    found: &[(f64, [f64; 2])],
    references: [f64; 2],
    body: (f64, &str),
) -> Vec<Row> {
    let mut rows = Vec::new();
    for (axis, reference) in references.into_iter().enumerate() {
        let study = Convergence::by_theory(column(found, axis), 1.0);
        let quantity = format!("C{0}{0}, {what}", axis + 1);
        let row = Row::extrapolated(&quantity, reference, &study, body, SOURCE);
        let values = [reference, row.computed];
        rows.push(row);
        let quantity = format!("{quantity}, extrapolated");
        let limit = (SCATTER, "patches of whole nodes, six times half a per cent");
        rows.push(Row::new(quantity, values, reference, limit, SOURCE));
    }
    rows
}

/// C11 and C22 by mesh size.
fn coefficients(
    hertz: &Hertz,
    meshes: &[f64],
    extent: f64,
    material: Material,
) -> Result<Vec<(f64, [f64; 2])>, Cause> {
    on_meshes(meshes, |h| {
        let fine = hertz.block(h, extent, Lateral::Full);
        let [a, b] = hertz.half_axes;
        let block =
            Block { reach: [1.15 * a, 1.15 * b], depth: 0.7 * b, growth: GROWTH, material, ..fine };
        let blocks = HalfSpaces::new(hertz, block)?;
        let scale = material.shear() * a * b;
        blocks.over_a_pitch(|influence, _| {
            Ok([slope(&blocks, influence, 0)? / scale, slope(&blocks, influence, 1)? / scale])
        })
    })
}

/// Force over creepage along an axis, extrapolated to zero creepage (N).
fn slope(blocks: &HalfSpaces<'_>, influence: &Influence, axis: usize) -> Result<f64, Cause> {
    let pressed = blocks.press(influence)?;
    let secant = |creepage: f64| -> Result<f64, Cause> {
        let mut rolling = Rolling::new(influence, &pressed, MU)?;
        let mut rigid = [Rigid::Moved(0.0); 2];
        rigid[axis] = Rigid::Moved(creepage * rolling.pitch());
        rolling.steady(rigid, STEPS)?;
        Ok(rolling.total()[axis] / creepage)
    };
    Ok(2.0 * secant(SMALL)? - secant(2.0 * SMALL)?)
}
