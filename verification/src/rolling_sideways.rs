//! Drift and spin with finite elements, beside two half-spaces that roll as far.
//!
//! The hub drifts (lateral creepage) or turns about the vertical (spin) while the disk rolls without creepage along x. On the
//! reference wheel the lateral force is still on its way after 60 mm: the disk gives way sideways. The disk of [`CASE`] gets a
//! rim of an eighth of its radius about a rigid hub. After 12 mm, six and a half half lengths of the patch, its lateral force is
//! steady: that after 24 mm is 0.08 % less (0.12 % more between half-spaces).
//!
//! The reference is the program's own solution for half-spaces without inertia
//! ([`half_space_rolling`](crate::half_space_rolling) compares its coefficients C22 and C23 with CONTACT), with the same ramp of
//! the drive and over the same distance. Both are extrapolated from two sizes with first order: the patch ends between two
//! points.

use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::rolling_dynamic::{mean, run_case};
use crate::row::Row;
use output::summary::Mean;

const CASE: &str = include_str!("../../tests/small.toml");
const NAME: &str = "small.toml";

/// Keys of every run: a shallow rim, no creepage along x, means over the last two millimetres of twelve.
const ROLL: [&str; 5] = [
    "disk.hub_radius=0.07",
    "drive.creepage=0",
    "time.roll=0.012",
    "mesh.zone.length=0.0175",
    "evaluate.last=0.002",
];

/// What the hub does, and its key.
const MOTIONS: [(&str, &str); 2] = [
    ("lateral creepage 0.002", "drive.lateral_creepage=2e-3"),
    ("spin 0.3 rad/m", "drive.spin=0.3"),
];

/// The half length of the patch over the smallest radius of the bodies, that of the bar's crown.
const BODIES: (f64, &str) =
    (1.82e-3 / 0.06, "bodies that are no half-spaces, a over the smallest radius");

pub(crate) fn run(size: Size) -> Outcome {
    // sizes of elements and of the half-spaces' squares (m)
    let (motions, meshes, spacings) = match size {
        Size::Quick => (&MOTIONS[..1], [0.8e-3, 0.64e-3], [0.5e-3, 0.4e-3]),
        Size::Full => (&MOTIONS[..], [0.8e-3, 0.5e-3], [0.4e-3, 0.2e-3]),
    };
    let mut rows = Vec::new();
    for (what, key) in motions {
        let found = study(&meshes, &["contact.enforcement=exact", key])?;
        let reference = study(&spacings, &["model=half-space", key])?;
        let row = Row::extrapolated(
            &format!("{what}: lateral force over the normal force"),
            reference.extrapolated(),
            &found,
            BODIES,
            "half-spaces, extrapolated to h = 0",
        );
        // spin moves the edge of the patch most, and differs so much between the meshes that their index says little
        rows.push(row.at_most(2.0 * BODIES.0));
    }
    Ok(rows)
}

/// Lateral over normal force of runs with elements or squares of several sizes (m).
fn study(sizes: &[f64], keys: &[&str]) -> Result<Convergence, Cause> {
    let mut found = Vec::new();
    for &h in sizes {
        let mut sets = vec![format!("mesh.zone.size={h}")];
        sets.extend(ROLL.iter().chain(keys).map(|&key| key.to_owned()));
        let summary = run_case(CASE, NAME, &sets)?;
        let number = |of| mean(&summary, of);
        found.push((h, number(Mean::LateralForce)? / number(Mean::NormalForce)?));
    }
    Ok(Convergence::by_theory(found, 1.0))
}
