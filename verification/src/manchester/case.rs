//! A position of the benchmark's wheelset, rolled by half-spaces.

use crate::problem::Cause;
use creepage::scenario::wheel_on_rail::press_wheel;
use friction::Coulomb;
use halfspace::{Along, Gap, HalfSpaces, Inertia, Patch, Rigid, Rolling, Setup, press};
use mesh::profile::{Profile, WheelOnRail, rail_head, wheel_s1002};
use std::sync::Arc;

const MU: f64 = 0.3;
/// Vertical load on the wheel (N), its radius (m), speed (m/s).
pub(super) const LOAD: f64 = 10e3;
const RADIUS: f64 = 0.46;
const SPEED: f64 = 2.0;
/// Lean of the rails.
const CANT: f64 = 1.0 / 40.0;
/// Half the gauge, 14 mm below the top of the rail, and of the wheelset from wheel to wheel, at their profiles' origins (m).
const HALF_GAUGE: f64 = 0.5 * 1.435;
const GAUGE_DEPTH: f64 = 14e-3;
const HALF_WHEELSET: f64 = 0.5 * 1.360 + 0.070;
/// Joints of the arcs of the benchmark's rail (m), by circles through its points (MBench_UIC60_v3.prr, CONTACT), which lie on
/// them within 0.1 um: they are not those of the standard.
pub(super) const JOINTS: [f64; 2] = [10.500e-3, 25.988e-3];
/// y of its highest point by the same circles (m): the file's origin, from which CONTACT counts, is not quite there.
const TOP: f64 = 5.96e-6;
/// y in the plane of contact between the two patches (m).
const BETWEEN: f64 = 5e-3;
/// Changes of the normal force within which vertical equilibrium is reached, and rounds to it.
const BALANCED: f64 = 1e-3;
const ROUNDS: usize = 30;
/// Rolling is steady when the force changes by less than this part of mu N over a spacing.
const STEADY: f64 = 1e-5;

/// What CONTACT prints of a case, or what half-spaces give, in the columns of the data after the position: y on the rail (mm),
/// angle, creepages, forces on the rail (N), moment (N mm), approach (mm), pressure (MPa), area (mm^2).
pub(super) type Values = [f64; 12];

/// A position of the wheelset and CONTACT's values.
#[derive(Clone, Copy, Debug)]
pub(super) struct BenchmarkCase {
    /// 1 for the right wheel, which is a left one in a mirror; -1 for the left one.
    pub(super) outward: f64,
    pub(super) number: u32,
    /// Lateral position of the wheelset to the right (m), roll, yaw (rad, z down) and speed of rotation (rad/s).
    position: [f64; 4],
    pub(super) values: Values,
}

/// The cases of the data.
pub(super) fn cases() -> Result<Vec<BenchmarkCase>, Cause> {
    let text = include_str!("../../data/manchester.csv");
    let lines = text.lines().filter(|line| !line.starts_with(['#', 'w']));
    lines
        .map(|line| {
            let mut words = line.split(',');
            let outward = if words.next() == Some("right") { 1.0 } else { -1.0 };
            let numbers: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>()?;
            Ok(BenchmarkCase {
                outward,
                number: numbers[0] as u32,
                position: [1e-3 * numbers[1], numbers[2], numbers[3], numbers[4]],
                values: std::array::from_fn(|k| numbers[5 + k]),
            })
        })
        .collect()
}

/// The rail of the benchmark.
pub(super) fn benchmark_rail() -> Profile {
    rail_head(JOINTS)
}

/// Place of the highest point of the leaning rail, and of its gauge point, relative to the origin of its profile: y (m).
fn top_and_gauge(rail: &Profile) -> Option<[f64; 2]> {
    let (sin, cos) = libm::sincos(libm::atan(CANT));
    let turned = |u: f64| rail.at(u).map(|[z, ..]| [cos * u + sin * z, cos * z - sin * u]);
    // on the arc of 300 mm
    let top = turned(0.3 * sin)?;
    let [mut low, mut high] = [rail.ends()[0], 0.0];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if turned(middle)?[1] - top[1] > GAUGE_DEPTH { low = middle } else { high = middle }
    }
    Some([top[0], turned(low)?[0]])
}

impl BenchmarkCase {
    /// The wheel on a rail of this profile, in the frame of a left wheel: y outward, z up.
    fn pair(&self, rail: Profile) -> Option<(WheelOnRail, f64)> {
        let [lateral, roll, yaw, _] = self.position;
        let [top, gauge] = top_and_gauge(&rail)?;
        // the wheelset turns about its middle
        let wheel = HALF_WHEELSET * libm::cos(yaw) * libm::cos(roll) + self.outward * lateral;
        let pair = WheelOnRail {
            wheel: wheel_s1002(),
            rail,
            radius: RADIUS,
            lateral: wheel - (HALF_GAUGE - gauge),
            yaw: self.outward * yaw,
            roll: -self.outward * roll,
            cant: libm::atan(CANT),
        };
        Some((pair, top))
    }

    /// The case on points of which about the first of `across` lie on the mean diameter of the patch and at least the second on its
    /// shorter axis; `rail` is the rail's profile, and `guess` the normal force (N) with which to begin. Also the spacing (m).
    pub(super) fn rolled(
        &self,
        across: [f64; 2],
        guess: f64,
        rail: Profile,
    ) -> Result<(f64, Values), Cause> {
        let bodies = bodies();
        let (pair, top) = self.pair(rail).ok_or("the rail's profile is too short")?;
        let h = spacing(&pair, across)?;
        let mut normal = guess;
        for _ in 0..ROUNDS {
            let pressed = press_wheel(&bodies, &pair, normal, h)?;
            let middle = pressed.middle;
            let slip = pair.rigid_slip(&middle, -self.position[3] / SPEED);
            let rigid = Rigid {
                along: Along::Creepage(slip.longitudinal),
                lateral: slip.lateral,
                spin: slip.spin,
            };
            let field = pressed.pressed.field.trimmed();
            let peak = Patch::Field(field.clone()).peak_pressure();
            let points = field.pressure.iter().filter(|p| **p > 0.0).count();
            let [along, across, moment] = steady(bodies, Patch::Field(field), rigid, h)?;
            // upward, on the wheel: the share of the normal force that bears the load
            let (sin, cos) = libm::sincos(middle.angle);
            let balanced = LOAD / (cos + across / normal * sin);
            if (balanced / normal - 1.0).abs() > BALANCED {
                normal = balanced;
                continue;
            }
            let s = self.outward;
            // CONTACT's creepages are relative to the mean of the speeds of wheel and rail
            let mean = 1.0 + 0.5 * slip.longitudinal;
            return Ok((
                h,
                [
                    1e3 * s * (middle.on_rail[0] - top + TOP),
                    -s * middle.angle,
                    slip.longitudinal / mean,
                    -s * slip.lateral / mean,
                    -s * 1e-3 * slip.spin / mean,
                    normal,
                    -along,
                    -s * across,
                    -s * 1e3 * moment,
                    1e3 * pressed.pressed.approach,
                    1e-6 * peak,
                    1e6 * points as f64 * h * h,
                ],
            ));
        }
        Err("vertical equilibrium was not reached".into())
    }

    /// The approach (mm) and the largest pressure (MPa) under CONTACT's normal force of a case with two places, which share it as if
    /// neither deformed the other, on points as those of [`Self::rolled`]. Also the spacing (m).
    pub(super) fn without_influence(
        &self,
        across: [f64; 2],
        rail: Profile,
    ) -> Result<(f64, [f64; 2]), Cause> {
        let bodies = bodies();
        let (pair, _) = self.pair(rail).ok_or("the rail's profile is too short")?;
        let (h, normal) = (spacing(&pair, across)?, self.values[5]);
        let pressed = press_wheel(&bodies, &pair, normal, h)?;
        let field = &pressed.pressed.field;
        let [low, left] = [field.first[1], field.first[0]];
        let [high, right] = [1, 0].map(|axis| field.first[axis] + field.points[axis] as i64);
        let cut = (BETWEEN / h) as i64;
        let [one, other] = [low..cut, cut..high].map(|lines| {
            let points = [right - left, lines.end - lines.start].map(|n| n as usize);
            let first = [left, lines.start];
            let places = lines.flat_map(|j| (left..right).map(move |i| [i, j]));
            let gap = places.map(|place| pair.gap(&pressed.middle, place.map(|k| k as f64 * h)));
            let gap = gap.map(|gap| gap.unwrap_or(f64::INFINITY)).collect();
            Gap { spacing: h, first, points, gap }
        });
        let [mut least, mut most] = [0.0, normal];
        loop {
            let share = 0.5 * (least + most);
            let first = press(&bodies, &one, share)?;
            let second = press(&bodies, &other, normal - share)?;
            if first.cut || second.cut {
                return Err("the grid is smaller than a patch".into());
            }
            if most - least < BALANCED {
                let peaks = [first.field, second.field].map(|f| Patch::Field(f).peak_pressure());
                return Ok((h, [1e3 * first.approach, 1e-6 * peaks[0].max(peaks[1])]));
            }
            if first.approach < second.approach { least = share } else { most = share }
        }
    }
}

fn bodies() -> HalfSpaces {
    HalfSpaces::new(2.0 * 1.28 * 82e9, 0.28, 7800.0)
}

/// Forces on the wheel along x and across (N) and moment about the normal (N m) in steady rolling.
fn steady(bodies: HalfSpaces, patch: Patch, rigid: Rigid, h: f64) -> Result<[f64; 3], Cause> {
    let setup = Setup {
        bodies,
        spacing: h,
        patch,
        offset: 0.0,
        speed: SPEED,
        start: 0.0,
        step: h / SPEED,
        inertia: Inertia::Static,
        law: Arc::new(Coulomb { mu: MU }),
        pressure_factor: None,
    };
    let mut rolling = Rolling::new(setup)?;
    let mut before = [0.0; 2];
    for _ in 0..rolling.grid()[0] * 10 {
        let sums = rolling.step(rigid);
        let change = libm::hypot(sums.shear[0] - before[0], sums.shear[1] - before[1]);
        before = sums.shear;
        if change < STEADY * MU * sums.normal && sums.unconverged == 0.0 {
            let moment: f64 =
                rolling.patch().map(|p| p.at[0] * p.shear[1] - p.at[1] * p.shear[0]).sum();
            return Ok([sums.shear[0], sums.shear[1], h * h * moment]);
        }
    }
    Err("rolling did not become steady".into())
}

/// A spacing (m) on which the patch of the load has about so many points on its mean diameter, and at least so many on its shorter
/// axis, by Hertz's theory: the axes are nearly as the curvatures to the power of 2/3 (Greenwood 1997).
fn spacing(pair: &WheelOnRail, [mean, shorter]: [f64; 2]) -> Result<f64, Cause> {
    let [along, sideways] = pair.first_contact()?.curvature;
    let sideways = sideways.max(0.1 * along);
    // a sphere of the mean curvature: a^3 = 3 N R/(4 E*), E* = G/(1 - nu)
    let half_axis = libm::cbrt(0.75 * LOAD * 0.72 / (82e9 * (along * sideways).sqrt()));
    let narrower = libm::cbrt((along / sideways).min(sideways / along));
    Ok(2.0 * half_axis * (1.0 / mean).min(narrower / shorter))
}
