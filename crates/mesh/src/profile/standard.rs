//! Profiles of the standards, from their published geometry.

use super::{Drawn, Piece, Profile, Shape};

/// The words for the profiles of the standards: rail, wheel.
pub const STANDARD_PROFILES: [&str; 2] = ["60E1", "S1002"];

/// Lengths of the drawings are in mm.
const MM: f64 = 1e-3;

/// Head of the rail 60E1 (EN 13674-1, once UIC 60): its arcs join at half of 20.456 and of 52.053 mm.
pub fn rail_60e1() -> Profile {
    rail_head([0.5 * 20.456e-3, 0.5 * 52.053e-3])
}

/// A rail's head of arcs of 300, 80 and 13 mm that join with a common tangent at `joints` (m from the middle), then flanks of
/// 20:1 down to 36 mm below the apex; the rail stands upright, y = z = 0 at the apex.
pub fn rail_head(joints: [f64; 2]) -> Profile {
    const FLANK: f64 = 20.0;
    const DEPTH: f64 = 36.0;
    let mut right = Vec::new();
    let (mut from, mut centre) = (0.0, [0.0, 300.0]);
    let mut radius = 300.0;
    for (next, to) in [(80.0, joints[0] / MM), (13.0, joints[1] / MM)] {
        right.push((from, to, Drawn::Arc { centre, radius, below: false }));
        let [z, ..] = Drawn::Arc { centre, radius, below: false }.at(to);
        // the centre of the next arc lies on the radius to the joint
        let joint = [to, z];
        centre = [0, 1].map(|i| joint[i] + (centre[i] - joint[i]) * next / radius);
        (from, radius) = (to, next);
    }
    let steep = (1.0 + FLANK * FLANK).sqrt();
    let (to, z) = (centre[0] + radius * FLANK / steep, centre[1] - radius / steep);
    right.push((from, to, Drawn::Arc { centre, radius, below: false }));
    let end = to + (DEPTH - z) / FLANK;
    right.push((to, end, Drawn::Polynomial(vec![z - FLANK * to, FLANK])));
    let mirrored = |(from, to, curve): &(f64, f64, Drawn)| {
        let curve = match curve {
            Drawn::Arc { centre: [y, z], radius, below } => {
                Drawn::Arc { centre: [-y, *z], radius: *radius, below: *below }
            }
            Drawn::Polynomial(c) => Drawn::Polynomial(vec![c[0], -c[1]]),
        };
        (-to, -from, curve)
    };
    let left: Vec<_> = right.iter().rev().map(mirrored).collect();
    profile(left.into_iter().chain(right))
}

/// The wheel S1002 of EN 13715 (once UIC 510-2) with a flange of 28 mm height, z = 0 at the tread datum: the sections A to H
/// of its annex, as they are printed (also in public programs, such as the course material of Netter, DLR). The printed
/// digits of C leave a step of 0.12 um at y = -35 mm.
pub fn wheel_s1002() -> Profile {
    let arc =
        |y: f64, z: f64, radius: f64, below: bool| Drawn::Arc { centre: [y, z], radius, below };
    let polynomial = |c: &[f64]| Drawn::Polynomial(c.to_vec());
    profile([
        // where the flange's tip ends, the slope would be infinite
        (-69.95, -62.764705882, arc(-49.5, 9.519259302, 20.5, true)),
        (-62.764705882, -49.662510381, arc(-55.0, 16.0, 12.0, true)),
        (-49.662510381, -39.764473993, arc(-58.558326413, 8.834924130, 20.0, true)),
        (-39.764473993, -38.426669071, polynomial(&[-93.576667419, -2.747477419])),
        (-38.426669071, -35.0, arc(-26.210665, 16.446, 13.0, false)),
        (-35.0, -26.0, polynomial(&SECTION_C)),
        (-26.0, 32.15796, polynomial(&SECTION_B)),
        (32.15796, 60.0, polynomial(&[1.364323640, -0.066666667])),
    ])
}

const SECTION_B: [f64; 9] = [
    0.0,
    -3.358537058e-02,
    1.565681624e-03,
    -2.810427944e-05,
    5.844240864e-08,
    -1.562379023e-08,
    5.309217349e-15,
    -5.957839843e-12,
    2.646656573e-13,
];

const SECTION_C: [f64; 8] = [
    -4.320221063e+03,
    -1.038384026e+03,
    -1.065501873e+02,
    -6.051367875,
    -2.054332446e-01,
    -4.169739389e-03,
    -4.687195829e-05,
    -2.252755540e-07,
];

/// A profile of pieces in mm.
fn profile(pieces: impl IntoIterator<Item = (f64, f64, Drawn)>) -> Profile {
    let in_metres = |(from, to, curve)| {
        let curve = match curve {
            Drawn::Arc { centre, radius, below } => {
                Drawn::Arc { centre: centre.map(|x| x * MM), radius: radius * MM, below }
            }
            Drawn::Polynomial(c) => {
                let scaled = c.iter().enumerate().map(|(k, c)| c * MM * 1e3f64.powi(k as i32));
                Drawn::Polynomial(scaled.collect())
            }
        };
        Piece { from: from * MM, to: to * MM, curve }
    };
    Profile { shape: Shape::Drawn(pieces.into_iter().map(in_metres).collect()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of MBench_S1002_v3.prw (CONTACT, Apache-2.0), the benchmark of the Manchester Metropolitan University, mirrored
    /// (mm).
    const MEASURED_S1002: [[f64; 2]; 4] = [
        [-62.639932, 25.253725],
        [-38.335925, 11.757921],
        [-16.59873, 1.1450915],
        [60.0, -2.6356764],
    ];

    #[test]
    fn the_head_of_60e1_is_72_mm_wide_14_1_mm_below_its_apex() {
        let rail = rail_60e1();
        let [z, ..] = rail.at(0.036).unwrap();
        // the flank has a slope of 20: 0.02 mm of half the width are 0.4 mm of height
        assert!((z - 14.1e-3).abs() < 0.4e-3, "{z}");
        let joints = [0.5 * 20.456e-3, 0.5 * 52.053e-3];
        for y in joints {
            let [a, b] = [y - 1e-9, y + 1e-9].map(|y| rail.at(y).unwrap());
            assert!((a[0] - b[0]).abs() < 1e-8 && (a[1] - b[1]).abs() < 1e-6, "{a:?} {b:?}");
            assert!((rail.at(-y).unwrap()[0] - rail.at(y).unwrap()[0]).abs() < 1e-15);
        }
    }

    #[test]
    fn s1002_meets_the_points_of_the_benchmark() {
        for [y, z] in MEASURED_S1002.map(|p| p.map(|x| 1e-3 * x)) {
            let [at, ..] = wheel_s1002().at(y).unwrap();
            assert!((at - z).abs() < 5e-9, "{at} at {y}");
        }
    }
}
