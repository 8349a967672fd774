//! What finite bodies change: the disk on the bar as they are meshed beside half-spaces, and the
//! approach of blocks beside Hertz's.
//!
//! Half-spaces are compared as blocks with elements of the same size, so that the difference is that
//! of the models and not of the mesh. Hertz's patch is that of paraboloids on half-spaces: bodies of
//! radius R differ by terms of order a/R. The pressure stretches a disk and a bar differently: without
//! any force the disk turns a little more than V/R, by strains of order p0/E times a/R.
//!
//! A block that ends at L misses the part of the approach that lies beyond, d = d_inf - A/L - B/L^3:
//! far from the patch the load is a point load, and what the size of the patch adds falls with two
//! more powers of L.

use crate::body::STEEL;
use crate::convergence::Convergence;
use crate::half_space::{
    HalfSpaces, SPHERE, SPHERE_SIZES, STEPS, WHEEL, column, element, on_meshes, sizes,
};
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use mesh::{Bar, Disk, FineZone, Mesh};
use statics::{
    Influence, Lateral, Point, Press, Pressed, Rigid, Rolling, Supports, SurfaceCompliance,
    ellipsoid, press,
};

const MU: f64 = 0.5;
const TRACTIONS: [f64; 3] = [0.15, 0.28, 0.40];
const HALF_SPACE: &str = "half-spaces as blocks with elements of the same size";

pub(crate) fn run(size: Size) -> Outcome {
    let meshes: &[f64] = match size {
        Size::Quick => &[2.8e-3, 2e-3],
        Size::Full => &[2e-3, 1.4e-3, 1e-3],
    };
    let mut rows = disk_on_bar(&rolled(meshes)?, |wheel| wheel.free);
    rows.push(approach(size)?);
    Ok(rows)
}

/// The wheel and half-spaces with elements of the same size, coarse to fine, one after the other: the memory
/// of the finest is the most there is.
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

/// The rows of the wheel; `free` is the creepage that is no creepage of the contact.
pub(crate) fn disk_on_bar(found: &[(f64, [Rolled; 2])], free: impl Fn(&Rolled) -> f64) -> Vec<Row> {
    let curved = WHEEL.half_axes[0] / WHEEL.radii[1];
    let model = curved * curved + WHEEL.p0 / STEEL.young * curved;
    let row = |what: String, of: &dyn Fn(&Rolled) -> f64| {
        let ratio = |(h, [wheel, block]): &(f64, [Rolled; 2])| (*h, of(wheel) / of(block) - 1.0);
        let study = Convergence::by_theory(found.iter().map(ratio), 1.0);
        let from = format!("{}; and (a/R)^2 and p0/E a/R", study.explain());
        let limit = (study.uncertainty() + model, from.as_str());
        let what = format!("disk on bar: {what} over that of half-spaces, less 1");
        let row = Row::new(what, [0.0, study.finest()], 1.0, limit, HALF_SPACE);
        Row { meshes: study.samples().to_vec(), order: study.order(), ..row }
    };
    let mut rows: Vec<Row> = ["p0", "a", "b"]
        .into_iter()
        .enumerate()
        .map(|(k, what)| row(what.into(), &|rolled| rolled.patch[k]))
        .collect();
    if let Some((_, [wheel, _])) = found.last() {
        rows.push(Row::new(
            "disk on bar: creepage of free rolling",
            [wheel.strain[0], wheel.free],
            1.0,
            (wheel.strain[1], "how much it differs over the patch: half its range"),
            "by which pressure stretches disk and bar differently, without friction",
        ));
    }
    for (k, traction) in TRACTIONS.into_iter().enumerate() {
        let what = format!("creepage at T/N = {traction}, less that of free rolling,");
        rows.push(row(what, &|rolled| rolled.creepage[k] - free(rolled)));
    }
    rows
}

/// What a contact of the wheel shows.
pub(crate) struct Rolled {
    /// p0 (Pa), a and b (m).
    patch: [f64; 3],
    /// Creepage without force.
    free: f64,
    /// By how much pressure alone stretches the slave more than the master along x: mean over the patch, weighted
    /// with the pressure, and half the range.
    strain: [f64; 2],
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
    Ok(Rolled { patch, free, strain: stretched(influence, &pressed)?, creepage: creepages })
}

/// Mean and half the range of the difference of strain along x that pressure causes.
fn stretched(influence: &Influence, pressed: &Pressed) -> Result<[f64; 2], Cause> {
    // next to no friction: what slips over a pitch is what the surfaces stretch
    let mut rolling = Rolling::new(influence, pressed, 1e-12)?;
    rolling.roll([Rigid::Moved(0.0); 2])?;
    let strains: Vec<f64> = rolling.slip().iter().map(|s| s[0] / rolling.pitch()).collect();
    let (mut sum, mut weights) = (0.0, 0.0);
    for (strain, weight) in strains.iter().zip(rolling.bound()) {
        sum += strain * weight;
        weights += weight;
    }
    let most = strains.iter().fold(f64::MIN, |m, s| m.max(*s));
    let least = strains.iter().fold(f64::MAX, |m, s| m.min(*s));
    Ok([sum / weights, 0.5 * (most - least)])
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
    };
    let shape = Disk { radius: 0.46, hub_radius: 0.10, width: 0.06, crown: None };
    let disk = mesh::disk(&shape, &zone)?;
    let shape = Bar { length: 0.24, width: 0.06, height: 0.07, crown: Some(0.30), start: -0.12 };
    let bar = mesh::bar(&shape, &zone)?;
    let top = &bar.bodies[0].surfaces["zone"];
    let smooth = top.smooth.ok_or("the bar has no crown")?;
    let within = |x: [f64; 3]| x[0].abs() < reach[0] && x[1].abs() < reach[1];
    let tread = &disk.bodies[0].surfaces["zone"];
    let points = Point::on_surface(&disk, tread, within, |x| -smooth.offset(x));
    let nodes: Vec<u32> = points.iter().map(|p| p.node).collect();
    let condensed = |mesh: &Mesh, held: &str, nodes: &[u32]| {
        let held = mesh.bodies[0].node_sets[held].clone();
        let supports = Supports { held, tied: Vec::new() };
        SurfaceCompliance::new(mesh, &[STEEL], &element, &supports, nodes)
    };
    let (above, below) = rayon::join(
        || condensed(&disk, "hub", &nodes),
        || condensed(&bar, "bottom", &bar.bodies[0].node_sets["zone"]),
    );
    Ok(Influence::between(&above?, points, &below?, top, &bar)?)
}

/// The approach of the sphere and the flat for infinite blocks.
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
