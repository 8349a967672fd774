//! Steady rolling in steps of one pitch, a half and a quarter of it: a cylinder compared with Carter, the reference wheel with
//! CONTACT.
//!
//! Which part of the error of first order comes from steps of one pitch, and which from the mesh? With smaller steps
//! nodes enter and leave the patch one after the other, as in explicit dynamics.
//!
//! On the wheel whole rows of nodes lie inside the patch or outside, and this scatters by as much as smaller steps leave of
//! the error. Extrapolation would multiply the scatter, so the wheel is compared on its finest mesh.

use crate::convergence::Convergence;
use crate::half_space::{
    HalfSpaces, LINE, LINE_EXTENT, LINE_SIZES, WHEEL, WHEEL_EXTENT, WHEEL_SIZES, column, on_meshes,
    sizes,
};
use crate::problem::{Cause, Outcome, Size};
use crate::reference::Lateral;
use crate::row::Row;
use crate::{carter, steady_rolling};

/// Steps in a pitch, and their name.
const STEPS: [(usize, &str); 3] =
    [(1, "one pitch"), (2, "half a pitch"), (4, "a quarter of a pitch")];

pub(crate) fn run(size: Size) -> Outcome {
    let mut rows = line(size)?;
    rows.extend(wheel(size)?);
    Ok(rows)
}

fn line(size: Size) -> Outcome {
    let slices = on_meshes(sizes(size, &LINE_SIZES), |h| {
        HalfSpaces::new(&LINE, LINE.block(h, LINE_EXTENT, Lateral::PlaneStrain))
    })?;
    let mut rows = Vec::new();
    for [share, creepage] in carter::TABLE {
        for (steps, name) in STEPS {
            let study = study(&slices, steps, carter::MU, share * carter::MU)?;
            let quantity = format!("line, Q/(mu N) = {share}: creepage, steps of {name}");
            let body = LINE.body(LINE_EXTENT);
            rows.push(Row::extrapolated(&quantity, creepage, &study, body, carter::SOURCE));
        }
    }
    Ok(rows)
}

fn wheel(size: Size) -> Outcome {
    let blocks = on_meshes(sizes(size, &WHEEL_SIZES), |h| {
        HalfSpaces::new(&WHEEL, WHEEL.block(h, WHEEL_EXTENT, Lateral::Symmetric))
    })?;
    let mut rows = Vec::new();
    for [traction, creepage, ..] in steady_rolling::STEADY {
        for (steps, name) in STEPS {
            let study = study(&blocks, steps, steady_rolling::MU, traction)?;
            let quantity = format!("wheel, T/N = {traction}: creepage, steps of {name}");
            let values = [creepage, study.finest()];
            let row = Row::asked(quantity, values, 0.05, steady_rolling::SOURCE);
            rows.push(Row { meshes: study.samples().to_vec(), order: study.order(), ..row });
        }
    }
    Ok(rows)
}

/// Creepage at the traction coefficient `traction`, by mesh.
fn study(
    bodies: &[(f64, HalfSpaces<'_>)],
    steps: usize,
    mu: f64,
    traction: f64,
) -> Result<Convergence, Cause> {
    let found: Vec<(f64, [f64; 1])> = bodies
        .iter()
        .map(|(h, body)| Ok((*h, [body.creepage_in_parts(steps, mu, traction * body.load)?])))
        .collect::<Result<_, Cause>>()?;
    Ok(Convergence::by_theory(column(&found, 0), 1.0))
}
