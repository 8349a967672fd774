//! Normal contact by exact enforcement compared with Hertz (1882), and the bias of penalty springs.
//!
//! The size of the patch comes from the ellipsoid fitted to the nodal pressures. Convergence is of first
//! order, since the patch ends between two nodes.

use crate::body::STEEL;
use crate::convergence::Convergence;
use crate::half_space::{
    HalfSpaces, Hertz, LINE, LINE_EXTENT, LINE_SIZES, SPHERE, SPHERE_EXTENT, SPHERE_SIZES, WHEEL,
    WHEEL_EXTENT, WHEEL_SIZES, column, on_meshes, sizes,
};
use crate::problem::{Cause, Outcome, Size};
use crate::reference::{Lateral, Rigid};
use crate::row::Row;

const SOURCE: &str = "Hertz (1882)";
const SPRINGS: &str = "a half-space with springs, one pass, d = 0.5 mm, computed for this project";

/// Largest pressure and half axes on every mesh, and the rows of their extrapolation.
fn patch(
    hertz: &Hertz,
    meshes: &[f64],
    extent: f64,
    lateral: Lateral,
) -> Result<(Vec<Row>, [f64; 3]), Cause> {
    let found = on_meshes(meshes, |h| {
        let blocks = HalfSpaces::new(hertz, hertz.block(h, extent, lateral))?;
        let [p0, a, b, _] = blocks.over_a_pitch(|influence, _| blocks.patch(influence))?;
        Ok([p0, a, b])
    })?;
    let [a, b] = hertz.half_axes;
    let references = [("p0 (Pa)", hertz.p0), ("a (m)", a), ("b (m)", b)];
    let known = references.into_iter().enumerate().filter(|(_, (_, value))| *value > 0.0);
    let rows = known.map(|(k, (what, reference))| {
        let study = Convergence::by_theory(column(&found, k), 1.0);
        Row::extrapolated(what, reference, &study, hertz.body(extent), SOURCE)
    });
    let finest = found.last().map_or([f64::NAN; 3], |(_, values)| *values);
    Ok((rows.collect(), finest))
}

pub(crate) fn sphere(size: Size) -> Outcome {
    let meshes = sizes(size, &SPHERE_SIZES);
    Ok(patch(&SPHERE, meshes, SPHERE_EXTENT, Lateral::Symmetric)?.0)
}

pub(crate) fn line(size: Size) -> Outcome {
    let meshes = sizes(size, &LINE_SIZES);
    Ok(patch(&LINE, meshes, LINE_EXTENT, Lateral::PlaneStrain)?.0)
}

pub(crate) fn wheel(size: Size) -> Outcome {
    let meshes = sizes(size, &WHEEL_SIZES);
    let (mut rows, finest) = patch(&WHEEL, meshes, WHEEL_EXTENT, Lateral::Symmetric)?;
    let [a, b] = WHEEL.half_axes;
    let h = meshes.last().map_or(f64::NAN, |h| 1e3 * h);
    for (what, reference, found) in
        [("p0 (Pa)", WHEEL.p0, finest[0]), ("a (m)", a, finest[1]), ("b (m)", b, finest[2])]
    {
        rows.push(Row::asked(format!("{what} at h = {h} mm"), [reference, found], 0.01, SOURCE));
    }
    rows.extend(normal_springs()?);
    rows.extend(tangential_springs(meshes)?);
    Ok(rows)
}

/// Depth d of the elements for which the penalty method sets its springs (m): their areal stiffness is
/// SF K/d. Their bias hardly depends on the mesh on which it is measured.
const DEPTH: f64 = 0.5e-3;

/// Areal stiffness (N/m^3) of the springs with the scale factor `scale`.
fn areal(scale: f64) -> f64 {
    scale * STEEL.bulk() / DEPTH
}

/// The bias of normal penalty springs in one pass, and the pressure extrapolated to rigid ones.
fn normal_springs() -> Outcome {
    let h = WHEEL_SIZES[2];
    let blocks = HalfSpaces::new(&WHEEL, WHEEL.block(h, WHEEL_EXTENT, Lateral::Symmetric))?;
    let exact = &blocks.influence;
    let peak = |scale: Option<f64>| -> Result<f64, Cause> {
        let with_springs = exact.with_springs(scale.map(areal), None);
        let pressure = blocks.press(&with_springs)?.pressure(&with_springs);
        Ok(pressure.into_iter().fold(0.0, f64::max))
    };
    let without = peak(None)?;
    let mut biases = Vec::new();
    for scale in [0.1, 0.3, 1.0, 3.0] {
        biases.push((scale, peak(Some(scale))? / without - 1.0));
    }
    let digit = (0.005, "half of the last digit given");
    let mut rows = Vec::new();
    for (scale, given) in [(0.1, -0.21), (1.0, -0.03)] {
        let found = biases.iter().find(|(s, _)| *s == scale).map_or(f64::NAN, |(_, bias)| *bias);
        let quantity = format!("penalty SF {scale}: p0 over that of exact contact, less 1");
        rows.push(Row::new(quantity, [given, found], 1.0, digit, SPRINGS));
    }
    // p0 = exact (1 - c/SF + d/SF^2): the compliance 1/SF takes the place of a mesh size, and SF 0.3
    // shows the effect of its second power
    let compliances = biases[1..].iter().map(|(scale, bias)| (1.0 / scale, 1.0 + bias));
    let study = Convergence::new(compliances, 1.0);
    let limit = (study.uncertainty(), "convergence with 1/SF (GCI, SF 0.3, 1, 3)");
    let rigid = [1.0, study.extrapolated()];
    let quantity = "penalty SF 0.3, 1, 3: p0 over that of exact contact, extrapolated to 1/SF = 0";
    rows.push(Row::new(quantity, rigid, 1.0, limit, "exact enforcement on the same mesh"));

    Ok(rows)
}

/// The bias of tangential springs alone in the creepage at T/N = 0.28.
fn tangential_springs(meshes: &[f64]) -> Outcome {
    const GIVEN: [[f64; 3]; 2] = [[0.1, 1.5, 0.05], [1.0, 1.06, 0.005]];
    let found = on_meshes(meshes, |h| {
        let blocks = HalfSpaces::new(&WHEEL, WHEEL.block(h, WHEEL_EXTENT, Lateral::Symmetric))?;
        blocks.over_a_pitch(|influence, _| {
            let creepage = |spring: Option<f64>| -> Result<f64, Cause> {
                let with_springs = influence.with_springs(None, spring);
                let force = |_| Rigid::Forced(0.28 * blocks.load);
                let rolling = blocks.roll(&with_springs, 0.5, force)?;
                Ok(rolling.creepage()[0])
            };
            let without = creepage(None)?;
            let of = |k: usize| -> Result<f64, Cause> {
                Ok(creepage(Some(areal(GIVEN[k][0])))? / without)
            };
            Ok([of(0)?, of(1)?])
        })
    })?;
    let rows = GIVEN.into_iter().enumerate().map(|(k, [scale, given, digit])| {
        let study = Convergence::by_theory(column(&found, k), 1.0);
        let quantity =
            format!("k_t of SF {scale} alone: creepage at T/N 0.28 over that without springs");
        let digit = (digit / given, "half of the last digit given");
        Row::extrapolated(&quantity, given, &study, digit, SPRINGS)
    });
    Ok(rows.collect())
}
