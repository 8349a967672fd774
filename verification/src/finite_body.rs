//! The effect of finite bodies: the meshed disk on the bar compared with half-spaces, and the
//! approach of blocks compared with that of Hertz.
//!
//! The half-spaces are blocks with elements of the same size, so that the difference is that
//! of the models and not of the mesh. Hertz's patch is that of paraboloids on half-spaces: bodies of
//! radius R differ by terms of order a/R. Pressure stretches the surfaces of disk and bar differently. Therefore a disk
//! that rolls without tangential force turns slightly faster than V/R, by strains of order p0/E times a/R. This
//! creepage follows from the strains that pressure alone, without friction, causes at the surfaces, strip by strip.
//!
//! A block that ends at L lacks the part of the approach that lies beyond, d = d_inf - A/L - B/L^3:
//! far from the patch the load is a point load, and the effect of the size of the patch falls with two
//! more powers of L.

use crate::body::STEEL;
use crate::convergence::Convergence;
use crate::half_space::{
    HalfSpaces, SPHERE, SPHERE_SIZES, STEPS, WHEEL, column, element, on_meshes, sizes,
};
use crate::problem::{Cause, Outcome, Size};
use crate::reference::{
    Influence, Lateral, Point, Press, Pressed, Rigid, Rolling, SurfaceCompliance, ellipsoid, press,
};
use crate::row::Row;
use mesh::{Bar, Disk, FineZone, Grading, Mesh};
use nalgebra::Vector3;
use statics::Supports;

const MU: f64 = 0.5;
const TRACTIONS: [f64; 3] = [0.15, 0.28, 0.40];
const STRIPS: &str = "by which pressure stretches disk and bar differently, on strips that stick";
const HALF_SPACE: &str = "half-spaces as blocks with elements of the same size";

/// Element sizes at quick size (m), coarse to fine.
pub(crate) const QUICK: &[f64] = &[2.8e-3, 2e-3];

pub(crate) fn run(size: Size) -> Outcome {
    let meshes: &[f64] = match size {
        Size::Quick => QUICK,
        Size::Full => &[2e-3, 1.4e-3, 1e-3],
    };
    let mut rows = disk_on_bar(&rolled(meshes)?, |wheel| wheel.free);
    rows.push(approach(size)?);
    Ok(rows)
}

/// Results for the wheel and for half-spaces with elements of the same size (m), coarse to fine. The meshes run one
/// after the other, so that the peak of memory is that of the finest.
pub(crate) fn rolled(meshes: &[f64]) -> Result<Vec<(f64, [Rolled; 2])>, Cause> {
    let one = |&h: &f64| {
        let (wheel, block) = rayon::join(
            || roll(&wheel_and_bar(h)?, WHEEL.load),
            || {
                let blocks = HalfSpaces::new(&WHEEL, WHEEL.block(h, 0.1, Lateral::Symmetric))?;
                roll(&blocks.influence, blocks.load)
            },
        );
        Ok((h, [wheel?, block?]))
    };
    meshes.iter().map(one).collect()
}

/// The rows of the wheel; `free` is the creepage at which it rolls without force.
pub(crate) fn disk_on_bar(found: &[(f64, [Rolled; 2])], free: impl Fn(&Rolled) -> f64) -> Vec<Row> {
    let curved = WHEEL.half_axes[0] / WHEEL.radii[1];
    let shape = (curved * curved + WHEEL.p0 / STEEL.young * curved, "; and (a/R)^2 and p0/E a/R");
    let compared = |what: String, ratios: Vec<(f64, f64)>, model: (f64, &str), source| {
        let study = Convergence::by_theory(ratios, 1.0);
        let from = format!("{}{}", study.explain(), model.1);
        let limit = (study.uncertainty() + model.0, from.as_str());
        let row = Row::new(what, [0.0, study.finest()], 1.0, limit, source);
        Row { meshes: study.samples().to_vec(), order: study.order(), ..row }
    };
    let first = (curved, "; and a over the smaller radius");
    let row = |what: String, model: (f64, &str), of: &dyn Fn(&Rolled) -> f64| {
        let ratio = |(h, [wheel, block]): &(f64, [Rolled; 2])| (*h, of(wheel) / of(block) - 1.0);
        let what = format!("disk on bar: {what} over that of half-spaces, less 1");
        compared(what, found.iter().map(ratio).collect(), model, HALF_SPACE).at_most(curved)
    };
    let mut rows: Vec<Row> = ["p0", "a", "b"]
        .into_iter()
        .enumerate()
        .map(|(k, what)| row(what.into(), shape, &|rolled| rolled.patch[k]))
        .collect();
    let ratio = |(h, [wheel, _]): &(f64, [Rolled; 2])| (*h, free(wheel) / wheel.strips - 1.0);
    let what = "disk on bar: creepage of free rolling over that of strips, less 1".to_owned();
    rows.push(compared(what, found.iter().map(ratio).collect(), first, STRIPS));
    for (k, traction) in TRACTIONS.into_iter().enumerate() {
        let what = format!("creepage at T/N = {traction}, less that of free rolling,");
        rows.push(row(what, first, &|rolled| rolled.creepage[k] - free(rolled)));
    }
    rows
}

/// Results of one contact of the wheel.
pub(crate) struct Rolled {
    /// p0 (Pa), a and b (m).
    patch: [f64; 3],
    /// Creepage of free rolling, without tangential force.
    pub(crate) free: f64,
    /// The same from the strains that pressure alone causes, strip by strip.
    strips: f64,
    /// Creepage at each of [`TRACTIONS`].
    creepage: Vec<f64>,
}

fn roll(influence: &Influence, load: f64) -> Result<Rolled, Cause> {
    let pressed = press(influence, Press::Load(load), None)?;
    let fit = ellipsoid(influence, &pressed).ok_or("the pressures show no ellipsoid")?;
    let creepage = |traction: f64| -> Result<f64, Cause> {
        let mut rolling = Rolling::new(influence, &pressed, MU)?;
        rolling.steady([Rigid::Forced(traction * load), Rigid::Moved(0.0)], STEPS)?;
        Ok(rolling.creepage()[0])
    };
    let creepages = TRACTIONS.map(creepage).into_iter().collect::<Result<_, _>>()?;
    let (patch, free) = ([fit.p0, fit.a, fit.b], creepage(0.0)?);
    Ok(Rolled { patch, free, strips: stretched(influence, &pressed)?, creepage: creepages })
}

/// The creepage xi of free rolling. Pressure causes a difference e of strain along x between the surfaces. In a strip
/// that sticks the force is the integral of `xi - e` with the weight `sqrt((a + x)/(a - x))`, where a is half its
/// length and x is counted from its middle towards the leading edge (Johnson 1985, Secs. 8.2 and 8.3). The forces of
/// all strips together vanish.
fn stretched(influence: &Influence, pressed: &Pressed) -> Result<f64, Cause> {
    // with almost no friction the slip over a pitch is the strain of the surfaces times the pitch
    let mut rolling = Rolling::new(influence, pressed, 1e-12)?;
    rolling.roll([Rigid::Moved(0.0); 2])?;
    let h = rolling.pitch();
    let mut strips = std::collections::BTreeMap::<i64, Vec<(f64, f64)>>::new();
    for (slip, &i) in rolling.slip().iter().zip(rolling.contact()) {
        let point = &influence.points()[i];
        let strip = strips.entry((point.at[1] / h).round() as i64).or_default();
        strip.push((point.at[0], slip[0] / h));
    }
    let (mut sum, mut weights) = (0.0, 0.0);
    for strip in strips.values() {
        let ends = strip.iter().fold([f64::MAX, f64::MIN], |[a, b], (x, _)| [a.min(*x), b.max(*x)]);
        let (middle, a) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]) + 0.5 * h);
        let integral = |x: f64| {
            let s = (x - middle).clamp(-a, a);
            a * libm::asin(s / a) - (a * a - s * s).sqrt()
        };
        for (x, strain) in strip {
            let weight = integral(x + h) - integral(*x);
            sum += weight * strain;
            weights += weight;
        }
    }
    Ok(sum / weights)
}

/// The reference disk, its hub held, on the reference bar, its bottom held.
fn wheel_and_bar(size: f64) -> Result<Influence, Cause> {
    let reach = WHEEL.half_axes.map(|r| 1.5 * r);
    let n = reach.map(|r| (r / size).ceil());
    let zone = FineZone {
        size,
        length: 2.0 * n[0] * size,
        width: 2.0 * n[1] * size,
        depth: 5e-3f64.max(2.0 * size),
        start: -n[0] * size,
        growth: 1.5,
        coarsest: 0.03,
        grading: Grading::Tensor,
    };
    let shape = Disk { radius: 0.46, hub_radius: 0.10, width: 0.06, crown: None };
    let disk = mesh::disk(&shape, &zone)?;
    let shape = Bar { length: 0.24, width: 0.06, height: 0.07, crown: Some(0.30), start: -0.12 };
    let bar = mesh::bar(&shape, &zone)?;
    let top = &bar.bodies[0].surfaces["zone"];
    let smooth = top.smooth.as_ref().ok_or("the bar has no crown")?;
    let within = |x: Vector3<f64>| x[0].abs() < reach[0] && x[1].abs() < reach[1];
    let tread = &disk.bodies[0].surfaces["zone"];
    let points = Point::on_surface(&disk, tread, within, |x| -smooth.offset(x));
    let nodes: Vec<u32> = points.iter().map(|p| p.node).collect();
    let condensed = |mesh: &Mesh, held: &str, nodes: &[u32]| {
        let held = mesh.bodies[0].node_sets[held].clone();
        let supports = Supports { held, tied: Vec::new(), ..Supports::default() };
        SurfaceCompliance::new(mesh, &[STEEL], &element, &supports, nodes)
    };
    let (above, below) = rayon::join(
        || condensed(&disk, "hub", &nodes),
        || condensed(&bar, "bottom", &bar.bodies[0].node_sets["zone"]),
    );
    Ok(Influence::between(&above?, points, &below?, top, &bar)?)
}

/// The approach of the sphere and the flat, extrapolated to infinite blocks.
fn approach(size: Size) -> Result<Row, Cause> {
    const EXTENTS: [f64; 3] = [0.015, 0.03, 0.06];
    let found = on_meshes(sizes(size, &SPHERE_SIZES), |h| {
        let of = |extent: f64| -> Result<f64, Cause> {
            let blocks = HalfSpaces::new(&SPHERE, SPHERE.block(h, extent, Lateral::Symmetric))?;
            let [.., approach] = blocks.over_a_pitch(|influence, _| blocks.patch(influence))?;
            Ok(approach)
        };
        let [near, middle, far] = [of(EXTENTS[0])?, of(EXTENTS[1])?, of(EXTENTS[2])?];
        // d = d_inf - A/L through two blocks, and d = d_inf - A/L - B/L^3 through three
        let two = 2.0 * far - middle;
        let three = (16.0 * two - 2.0 * (2.0 * middle - near)) / 14.0;
        Ok([three, two])
    })?;
    const HERTZ: f64 = 34.83e-6;
    let [three, two] = [0, 1].map(|k| Convergence::by_theory(column(&found, k), 1.0));
    let left = (two.finest() - three.finest()).abs() / HERTZ;
    let model = (left, "what a third block changes of the extrapolation in 1/L");
    Ok(Row::extrapolated(
        "sphere on a flat: approach (m) of infinite blocks",
        HERTZ,
        &three,
        model,
        "Hertz (1882)",
    ))
}
