//! Drift and spin with finite elements, beside two half-spaces that roll as far.
//!
//! The hub drifts (lateral creepage) or turns about the vertical (spin) while the disk rolls without creepage along x. The
//! reference wheel is a poor model of this: its rim gives way sideways, so that the lateral force is still on its way after
//! 60 mm. The disk of [`CASE`] has a rim of 10 mm about a rigid hub, an eighth of its radius; such a rim follows the hub
//! within a few half lengths of the patch.
//!
//! The reference is the program's own solution for half-spaces without inertia ([`half_space_rolling`](crate::half_space_rolling)
//! compares its coefficients C22 and C23 with CONTACT), with the same ramp of the drive and over the same distance. It is
//! extrapolated from two grids with first order, as is the finite elements' from two meshes: in both the patch ends between
//! two points.

use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::rolling_dynamic::numbers_of;
use crate::row::Row;

const CASE: &str = include_str!("../../tests/small.toml");
const NAME: &str = "small.toml";

/// Keys of every run: a shallow rim, no creepage along x, means over the last millimetre of six.
const ROLL: [&str; 4] =
    ["disk.hub_radius=0.07", "drive.creepage=0", "time.roll=0.006", "evaluate.last=0.001"];

/// What the hub does, and its key.
const MOTIONS: [(&str, &str); 2] =
    [("lateral creepage 0.002", "drive.lateral_creepage=2e-3"), ("spin 0.3 rad/m", "drive.spin=0.3")];

/// Spacings of the half-spaces (m).
const SPACINGS: [f64; 2] = [0.4e-3, 0.2e-3];

pub(crate) fn run(size: Size) -> Outcome {
    run_with(size, &[])
}

/// The problem whose finite elements have `planted` keys (`KEY=VALUE`) set.
pub(crate) fn run_with(size: Size, planted: &[&str]) -> Outcome {
    let meshes: &[f64] = match size {
        Size::Quick => &[0.8e-3, 0.5e-3],
        Size::Full => &[0.8e-3, 0.5e-3, 0.35e-3],
    };
    let mut rows = Vec::new();
    for (what, key) in MOTIONS {
        let elements = [&["contact.enforcement=exact", key], planted].concat();
        let found = study(meshes, &elements)?;
        let reference = study(&SPACINGS, &["model=half-space", key])?;
        rows.push(Row::extrapolated(
            &format!("{what}: lateral force over the normal force"),
            reference.extrapolated(),
            &found,
            (0.0, ""),
            "half-spaces, extrapolated to h = 0",
        ));
    }
    Ok(rows)
}

/// Lateral over normal force of runs with elements or spacings of several sizes (m).
fn study(sizes: &[f64], keys: &[&str]) -> Result<Convergence, Cause> {
    let mut found = Vec::new();
    for &h in sizes {
        let mut sets = vec![format!("mesh.zone.size={h}")];
        sets.extend(ROLL.iter().chain(keys).map(|&key| key.to_owned()));
        let number = numbers_of(CASE, NAME, &sets)?;
        found.push((h, number("contact", "lateral_force")? / number("contact", "normal_force")?));
    }
    Ok(Convergence::by_theory(found, 1.0))
}
