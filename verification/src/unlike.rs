//! Rolling of unlike materials: an aluminium disk on a steel bar, in plane strain and with friction 0.05.
//!
//! Pressure stretches the surfaces of unlike materials differently, so that they slip, have shear tractions without
//! a tangential force, and roll freely at a creepage (Bufler 1959; Bentall and Johnson 1967). CONTACT's example `bentall`
//! is two rollers with a/R = 0.004: creepage 4.294e-4, and 125 of 200 elements stick. A solution of our own for half-planes,
//! with shear that changes the pressure, finds 4.2945e-4 and 0.625 on as many elements.
//!
//! Creepage is proportional to p0 and so to a/R. Here a/R is ten times as large: at 0.004 the centrifugal stretch of the rim, of
//! order rho V^2/E, is no longer small beside the creepage. Then the bodies' shape counts: a disk that its rim's load P per width
//! presses against a hub at its centre has the hoop strain (1 + nu) P/(2 pi R E) beside the load (the forces of Flamant at
//! both ends of the diameter and of Kelvin at the centre, and Michell's r^3 cos to free the rim). The disk rolls freely at so
//! much less creepage. The clamped bar and strains that are not small leave what is of order a/R.
//!
//! R_eff has the stretch of both bodies as well, so that the creepage relative to it is that of half-planes. The slip of the
//! preloaded half-planes without friction is 2 beta p/E* of V. Its mean with the pressure p as weight is 16/(3 pi) beta p0/E*,
//! and half-planes roll freely at CONTACT's creepage less that.
//!
//! Without torque the disk swings for long about its hub, and stick depends much on the force: in half-planes it is 0.625, 0.695
//! and 0.78 of the patch at T/(mu N) = 0, 0.05 and 0.1. So the hub's creepage is prescribed. The rim still swings a little, by one
//! period in four millimetres, over which means are taken, and free rolling follows from the small force with the slope of
//! half-planes.

use crate::convergence::Convergence;
use crate::half_space::column;
use crate::problem::{Outcome, Size};
use crate::rolling_dynamic::{mean, run_case};
use crate::row::Row;
use output::summary::Mean;
use std::f64::consts::PI;

const CASE: &str = r#"
deterministic = true
disk.radius = 25e-3
disk.hub_radius = 2.5e-3
disk.width = 0.5e-3
disk.crown_radius = "flat"
disk.material = { young = 60.26e9, poisson = 0.31, density = 2700 }
bar.width = 0.5e-3
bar.length = 120e-3
bar.height = 60e-3
bar.start = -50e-3
bar.crown_radius = "flat"
bar.material = { young = 209.92e9, poisson = 0.28 }
mesh.plane_strain = true
mesh.coarsest = 4e-3
mesh.zone.width = 0.5e-3
mesh.zone.start = -2.5e-3
mesh.zone.length = 12e-3
mesh.zone.depth = 1e-3
load.normal = 810.095
drive.speed = 40
drive.ramp = 1e-6
friction.static = 0.05
contact.enforcement = "exact"
contact.rows = "mortar"
damping.kelvin_voigt = 2e-9
time.roll = 7e-3
evaluate.last = 4e-3
"#;

const MU: f64 = 0.05;
const SOURCE: &str = "CONTACT (Vollebregt), its example bentall, times ten";
/// CONTACT's creepage of free rolling and share of stick, at ten times its a/R.
const FREE: f64 = 4.294e-3;
const STICK: f64 = 0.625;
/// Creepage over T/(mu N) about free rolling, of half-planes.
const SLOPE: f64 = 1.57e-3;
/// a over the radius of the disk.
const BODIES: (f64, &str) = (0.04, "bodies that are no half-planes, a/R");

pub(crate) fn run(size: Size) -> Outcome {
    run_with(size, &[])
}

/// The problem, where no key of the runs is `planted`.
pub(crate) fn run_with(size: Size, planted: &[&str]) -> Outcome {
    let meshes: &[f64] = match size {
        Size::Quick => &[0.28e-3, 0.2e-3],
        Size::Full => &[0.2e-3, 0.1e-3],
    };
    // E* (Pa), beta, Hertz's p0 (Pa) under P (N/m) at an effective radius of 25 mm, and the hoop strain of the rim
    let (modulus, beta, p0, load) = (51.573e9, 0.14383, 1.03145e9, 1.62019e6);
    let slip = 16.0 / (3.0 * PI) * beta * p0 / modulus;
    let rim = 1.31 * load / (2.0 * PI * 25e-3 * 60.26e9);
    let (free, relative) = (FREE - rim, FREE - slip);
    let mut found = Vec::new();
    for &h in meshes {
        let mut sets = vec![format!("mesh.zone.size={h}"), format!("drive.creepage={relative}")];
        sets.extend(planted.iter().map(|&key| key.to_owned()));
        let summary = run_case(CASE, "unlike.toml", &sets)?;
        let excess = SLOPE * mean(&summary, Mean::TractionCoefficient)? / MU;
        let nominal = summary.contact.nominal_creepage.unwrap_or(f64::NAN);
        let creepage = mean(&summary, Mean::Creepage)?;
        let stick = mean(&summary, Mean::StickFraction)?;
        found.push((h, [nominal - excess, creepage - excess, stick]));
    }
    let study = |k: usize| Convergence::by_theory(column(&found, k), 1.0);
    let row = Row::extrapolated("(omega R - V)/V of free rolling", free, &study(0), BODIES, SOURCE);
    Ok(vec![row.at_most(2.0 * BODIES.0), effective(&study(1), relative), stick(&study(2))])
}

/// The creepage of free rolling, relative to R_eff.
fn effective(found: &Convergence, relative: f64) -> Row {
    let from = format!("{}; and {}", found.explain(), BODIES.1);
    let limit = found.uncertainty() / FREE + BODIES.0;
    let row = Row::new(
        "creepage of free rolling relative to R_eff, error over 4.294e-3",
        [relative, found.finest()],
        FREE,
        (limit, from.as_str()),
        SOURCE,
    );
    Row { meshes: found.samples().to_vec(), ..row }.at_most(1.5 * BODIES.0)
}

fn stick(found: &Convergence) -> Row {
    // the patch is two half lengths of 1 mm
    let element = found.samples().last().map_or(f64::NAN, |finest| 0.5 * finest.size / 1e-3);
    let row = Row::new(
        "share of the patch that sticks",
        [STICK, found.finest()],
        1.0,
        (2.0 * element, "half an element at each of the four ends of slip"),
        SOURCE,
    );
    Row { meshes: found.samples().to_vec(), ..row }
}
