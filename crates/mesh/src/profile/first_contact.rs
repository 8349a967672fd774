//! A wheel on a straight rail: the first point of contact, what is left of the gap around it, and the rigid slip there.
//!
//! Frame of the track: x forward, y to the left, z up. The wheel is the left one, so that y points away from the middle of
//! the track as in its profile; its origin is that of the rail's profile. The wheel is a surface of revolution about its
//! axle, the rail a prism along x. Where they touch the normal lies in the plane y, z: the points of the wheel whose normal
//! does so form a curve, one point on each of its circles, and the contact of that curve with the rail's profile in the
//! plane is that of the two surfaces (as CONTACT's contact locus; Vollebregt 2022, "CONTACT user guide", wheel-rail contact).

use super::{Profile, ProfileError, Section};
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Points of the wheel's profile between which contact is looked for.
const SAMPLES: usize = 4000;
/// Steps of Newton's method, and where it ends (m).
const NEWTON: usize = 30;
const CONVERGED: f64 = 1e-12;

/// A wheel over a rail.
#[derive(Clone, Debug, PartialEq)]
pub struct WheelOnRail {
    /// Profile of the wheel.
    pub wheel: Profile,
    /// Profile of the rail.
    pub rail: Profile,
    /// Radius of the wheel at y = 0 of its profile (m).
    pub radius: f64,
    /// y of the wheel's origin over that of the rail (m), positive away from the middle of the track.
    pub lateral: f64,
    /// Angle of the wheel about z (rad).
    pub yaw: f64,
    /// Angle of the wheel about x (rad).
    pub roll: f64,
    /// Angle of the rail about x (rad), positive where it leans towards the middle of the track.
    pub cant: f64,
}

/// Where wheel and rail first touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// The point relative to the wheel's centre, x, y, z (m).
    pub from_centre: Vector3<f64>,
    /// The point relative to the rail's origin, y and z (m).
    pub on_rail: [f64; 2],
    /// y of the point on the profiles of wheel and rail (m).
    pub profile_y: [f64; 2],
    /// Slope of the plane of contact about x (rad), positive where it rises in +y.
    pub angle: f64,
    /// Distance of the point from the axle (m).
    pub rolling_radius: f64,
    /// Curvature (1/m) of the gap along x and across, in the plane of contact: what Hertz's theory takes.
    pub curvature: [f64; 2],
}

/// A part of the profiles where the undeformed bodies overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// y of its two ends on the wheel (m).
    pub ends: [f64; 2],
    /// The rail's angle where the overlap is deepest (rad).
    pub angle: f64,
    /// How deep it is there, along the normal (m).
    pub depth: f64,
}

/// Velocity of the wheel against the rail at the point of contact, over the speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidSlip {
    /// Longitudinal creepage, positive when driving.
    pub longitudinal: f64,
    /// Lateral velocity of the wheel in the plane of contact, positive in +y.
    pub lateral: f64,
    /// Angular velocity of the wheel about the normal, which points up (rad/m).
    pub spin: f64,
}

/// The axes of the wheel in the frame of the track: forward, along the axle, up.
struct Axes([Vector3<f64>; 3]);

impl WheelOnRail {
    fn axes(&self) -> Axes {
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), self.yaw)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), self.roll);
        Axes([Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| turn * axis))
    }

    /// Radius and its first two derivatives over the y of the wheel's profile.
    fn radius_at(&self, s: f64) -> Option<[f64; 3]> {
        self.wheel.at(s).map(|[z, slope, bend]| [self.radius + z, slope, bend])
    }

    /// The point of the wheel (from its centre) at `s` of the profile and the angle `theta` from straight down, positive
    /// forward, and its derivatives by both.
    fn wheel_point(&self, axes: &Axes, s: f64, theta: f64) -> Option<[Vector3<f64>; 3]> {
        let [r, slope, _] = self.radius_at(s)?;
        let Axes([forward, axle, up]) = axes;
        let (sin, cos) = libm::sincos(theta);
        let (radial, around) = (forward * sin - up * cos, forward * cos + up * sin);
        Some([axle * s + radial * r, axle + radial * slope, around * r])
    }

    /// The angle at which the normal of the wheel at `s` has no component along x.
    fn silhouette(&self, axes: &Axes, s: f64) -> Option<f64> {
        let [_, slope, _] = self.radius_at(s)?;
        let [forward, axle, up] = axes.0.map(|axis| axis.x);
        // sin(theta) forward - cos(theta) up = slope axle
        let size = libm::hypot(forward, up);
        let sine = slope * axle / size;
        (sine.abs() < 1.0).then(|| libm::asin(sine) + libm::atan2(up, forward))
    }

    /// The point on the wheel that may touch at `s` of the profile, and the slope dz/dy of the surface there.
    fn candidate(&self, axes: &Axes, s: f64) -> Option<(Vector3<f64>, f64)> {
        let theta = self.silhouette(axes, s)?;
        let [at, by_s, by_theta] = self.wheel_point(axes, s, theta)?;
        let normal = by_s.cross(&by_theta);
        Some((at, -normal.y / normal.z))
    }

    /// The point y, z of the canted rail at `u` of its profile, and its first two derivatives.
    fn rail_point(&self, u: f64) -> Option<[[f64; 2]; 3]> {
        let [z, slope, bend] = self.rail.at(u)?;
        let (sin, cos) = libm::sincos(self.cant);
        // a positive angle about x would lean a rail towards -y
        let turned = |y: f64, down: f64| [cos * y + sin * down, sin * y - cos * down];
        Some([turned(u, z), turned(1.0, slope), turned(0.0, bend)])
    }

    /// u of the rail at which its point has the coordinate `t` along the direction `along` (y, z) from `origin`.
    fn on_rail(&self, origin: [f64; 2], along: [f64; 2], t: f64, guess: f64) -> Option<f64> {
        let [low, high] = self.rail.ends();
        let mut u = guess.clamp(low, high);
        for _ in 0..NEWTON {
            let [at, by_u, _] = self.rail_point(u)?;
            let miss = dot(sub(at, origin), along) - t;
            let next = (u - miss / dot(by_u, along)).clamp(low, high);
            if (next - u).abs() < CONVERGED {
                return (miss.abs() < 1e-9).then_some(next);
            }
            u = next;
        }
        None
    }

    /// Distance of the wheel above the rail at `s`, with its centre at the height zero of the rail's origin; the difference
    /// of their slopes; u of the rail below; and the rail's slope there.
    fn height(&self, axes: &Axes, s: f64) -> Option<[f64; 4]> {
        let (at, slope) = self.candidate(axes, s)?;
        let y = at.y + self.lateral;
        let u = self.on_rail([0.0; 2], [1.0, 0.0], y, y)?;
        let [rail, by_u, _] = self.rail_point(u)?;
        let steep = by_u[1] / by_u[0];
        Some([at.z - rail[1], slope - steep, u, steep])
    }

    /// The heights at all samples of the wheel's profile that lie over the rail.
    fn heights(&self, axes: &Axes) -> Vec<[f64; 2]> {
        let [low, high] = self.wheel.ends();
        let at = |i: usize| low + (high - low) * i as f64 / SAMPLES as f64;
        let over = (0..=SAMPLES).filter_map(|i| Some([at(i), self.height(axes, at(i))?[0]]));
        over.collect()
    }

    /// The first point of contact as the wheel comes down.
    ///
    /// # Errors
    /// Profiles that do not lie over one another, or come nearest at an end.
    pub fn first_contact(&self) -> Result<ContactPoint, ProfileError> {
        let axes = self.axes();
        let heights = self.heights(&axes);
        let apart = || {
            let mm = |[low, high]: [f64; 2], shift: f64| [low, high].map(|y| 1e3 * (y + shift));
            ProfileError::Apart {
                wheel_mm: mm(self.wheel.ends(), self.lateral),
                rail_mm: mm(self.rail.ends(), 0.0),
            }
        };
        let nearest = (0..heights.len()).min_by(|&i, &j| heights[i][1].total_cmp(&heights[j][1]));
        let nearest = nearest.ok_or_else(apart)?;
        if nearest == 0 || nearest + 1 == heights.len() {
            let s = heights[nearest][0];
            let u = self.height(&axes, s).map_or(f64::NAN, |[_, _, u, _]| u);
            return Err(ProfileError::AtEnd { wheel_mm: 1e3 * s, rail_mm: 1e3 * u });
        }
        // the slopes are equal between the neighbours of the nearest sample
        let (mut low, mut high) = (heights[nearest - 1][0], heights[nearest + 1][0]);
        while high - low > 1e-3 * CONVERGED {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            let [_, slope, ..] = self.height(&axes, middle).ok_or_else(apart)?;
            if slope < 0.0 { low = middle } else { high = middle }
        }
        let s = 0.5 * (low + high);
        let [height, ..] = self.height(&axes, s).ok_or_else(apart)?;
        self.point_at(&axes, s, -height).ok_or_else(apart)
    }

    /// The point on the rail in the middle of where the undeformed bodies would overlap by `approach` (m) at most, as CONTACT takes
    /// it: each point of the overlap counts by the square of its vertical depth, and its length along x grows as the root of the
    /// depth. The angle is the mean of the rail's with the same weights.
    pub fn centre_of_overlap(&self, first: &ContactPoint, approach: f64) -> Option<ContactPoint> {
        let (mut sum, mut moment, mut turned) = (0.0, 0.0, 0.0);
        self.each_overlap(first, approach, |s, angle, depth| {
            let weight = depth * depth * depth.sqrt();
            sum += weight;
            moment += weight * s;
            turned += weight * angle;
        });
        let axes = self.axes();
        let [height, ..] = self.height(&axes, first.profile_y[0])?;
        let point = self.point_at(&axes, moment / sum, -height)?;
        Some(ContactPoint { angle: turned / sum, ..point })
    }

    /// Everything about the place at `s` of the wheel, whose centre lies at the height `centre` over the rail's origin.
    fn point_at(&self, axes: &Axes, s: f64, centre: f64) -> Option<ContactPoint> {
        let theta = self.silhouette(axes, s)?;
        let [on_wheel, _, around] = self.wheel_point(axes, s, theta)?;
        let [_, _, u, steep] = self.height(axes, s)?;
        let [on_rail, by_u, by_uu] = self.rail_point(u)?;
        let from_centre = Vector3::new(on_wheel.x, on_rail[0] - self.lateral, on_rail[1] - centre);
        let angle = libm::atan(steep);
        let size = dot(by_u, by_u).sqrt();
        let rail = (by_u[1] * by_uu[0] - by_u[0] * by_uu[1]) / (size * size * size);
        let [r, slope, bend] = self.radius_at(s)?;
        let steep = (1.0 + slope * slope).sqrt();
        // principal curvatures of the wheel, along its profile and around, and the angle of x from the latter (Euler)
        let (meridional, circular) = (-bend / (steep * steep * steep), 1.0 / (r * steep));
        let along = (around.x / around.norm()).powi(2);
        let curvature = [
            along * circular + (1.0 - along) * meridional,
            along * meridional + (1.0 - along) * circular + rail,
        ];
        let profile_y = [s, u];
        Some(ContactPoint { from_centre, on_rail, profile_y, angle, rolling_radius: r, curvature })
    }

    /// The gap (m) between the undeformed surfaces along the normal of the plane of contact, at the place `x`, `t` in it (m)
    /// from the point of contact; `None` beyond an end of a profile.
    pub fn gap(&self, point: &ContactPoint, [x, t]: [f64; 2]) -> Option<f64> {
        let axes = self.axes();
        let (sin, cos) = libm::sincos(point.angle);
        let [across, normal] = [[cos, sin], [-sin, cos]];
        let [s0, u0] = point.profile_y;
        let u = self.on_rail(point.on_rail, across, t, u0 + t * cos)?;
        let rail = dot(sub(self.rail_point(u)?[0], point.on_rail), normal);
        let [low, high] = self.wheel.ends();
        let (mut s, mut theta) = ((s0 + t * cos).clamp(low, high), self.silhouette(&axes, s0)?);
        theta += (x / point.rolling_radius).clamp(-FRAC_PI_2, FRAC_PI_2);
        for _ in 0..NEWTON {
            let [at, by_s, by_theta] = self.wheel_point(&axes, s, theta)?;
            let from = at - point.from_centre;
            let place = |v: Vector3<f64>| [v.x, dot([v.y, v.z], across)];
            let ([a, c], [b, d]) = (place(by_s), place(by_theta));
            let [along, sideways] = place(from);
            let (miss_x, miss_t, det) = (along - x, sideways - t, a * d - b * c);
            let step = [(d * miss_x - b * miss_t) / det, (a * miss_t - c * miss_x) / det];
            s -= step[0];
            theta -= step[1];
            if !(low..=high).contains(&s) {
                return None;
            }
            if step[0].abs() < CONVERGED && step[1].abs() < CONVERGED {
                let [at, ..] = self.wheel_point(&axes, s, theta)?;
                let from = at - point.from_centre;
                return Some(dot([from.y, from.z], normal) - rail);
            }
        }
        None
    }

    /// The sections of wheel and rail across, `reach` (m) to either side of the point of contact of a wheel that stands upright and
    /// straight; `None` for others, and at an end of a profile.
    pub fn sections(&self, point: &ContactPoint, reach: f64) -> Option<[Section; 2]> {
        if self.yaw != 0.0 || self.roll != 0.0 {
            return None;
        }
        let [s0, u0] = point.profile_y;
        let r0 = self.radius_at(s0)?[0];
        let wheel = |y: f64| self.radius_at(s0 + y).map(|[r, slope, _]| [r0 - r, -slope]);
        let rail = |y: f64| {
            let u = self.on_rail(point.on_rail, [1.0, 0.0], y, u0 + y)?;
            let [at, by_u, _] = self.rail_point(u)?;
            Some([at[1] - point.on_rail[1], by_u[1] / by_u[0]])
        };
        Section::pair([&wheel, &rail], reach)
    }

    /// The velocity of the wheel against the rail at the point of contact over the speed of its centre, which moves along x,
    /// where it turns by `turn` radians about its axle over a metre.
    pub fn rigid_slip(&self, point: &ContactPoint, turn: f64) -> RigidSlip {
        let Axes([_, axle, _]) = self.axes();
        let velocity = Vector3::x() + (axle * turn).cross(&point.from_centre);
        let (sin, cos) = libm::sincos(point.angle);
        RigidSlip {
            longitudinal: -velocity.x,
            lateral: velocity.y * cos + velocity.z * sin,
            spin: turn * (axle.z * cos - axle.y * sin),
        }
    }

    /// The parts of the profiles that overlap, undeformed, after the wheel has come down by `approach` (m) along the normal at the
    /// first point of contact: more than one where they touch at several places.
    pub fn overlaps(&self, first: &ContactPoint, approach: f64) -> Vec<Overlap> {
        let [low, high] = self.wheel.ends();
        let apart = 1.5 * (high - low) / SAMPLES as f64;
        let mut found: Vec<Overlap> = Vec::new();
        self.each_overlap(first, approach, |s, angle, down| {
            match (found.last_mut(), down * libm::cos(angle)) {
                (Some(part), depth) if s - part.ends[1] < apart => {
                    part.ends[1] = s;
                    if depth > part.depth {
                        (part.angle, part.depth) = (angle, depth);
                    }
                }
                (_, depth) => found.push(Overlap { ends: [s, s], angle, depth }),
            }
        });
        found
    }

    /// Hands over the samples of the wheel's profile that overlap, with the rail's angle and the vertical depth (m).
    fn each_overlap(
        &self,
        first: &ContactPoint,
        approach: f64,
        mut visit: impl FnMut(f64, f64, f64),
    ) {
        let axes = self.axes();
        let contact = self.height(&axes, first.profile_y[0]).map_or(f64::NAN, |[z, ..]| z);
        // the wheel comes down vertically
        let down = approach / libm::cos(first.angle);
        let [low, high] = self.wheel.ends();
        for i in 0..=SAMPLES {
            let s = low + (high - low) * i as f64 / SAMPLES as f64;
            let Some([z, _, _, slope]) = self.height(&axes, s) else { continue };
            let depth = down - (z - contact);
            if depth > 0.0 {
                visit(s, libm::atan(slope), depth);
            }
        }
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn sub(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::{rail_head, wheel_s1002};

    fn on_crown(wheel: Profile) -> WheelOnRail {
        let rail = Profile::crown(0.3, 0.035);
        WheelOnRail { wheel, rail, radius: 0.46, lateral: 0.0, yaw: 0.0, roll: 0.0, cant: 0.0 }
    }

    #[test]
    fn circles_touch_on_the_line_of_their_centres() {
        // centres 0.5 m apart in z, and by `lateral` in y: the normal leans by asin(lateral/0.5)
        let lateral = 4e-3;
        let pair = WheelOnRail { lateral, ..on_crown(Profile::crown(-0.2, 0.03)) };
        let point = pair.first_contact().unwrap();
        let lean = lateral / 0.5;
        assert!((point.on_rail[0] - 0.3 * lean).abs() < 1e-12, "{point:?}");
        assert!((libm::sin(point.angle) + lean).abs() < 1e-12);
        assert!((point.profile_y[0] + 0.2 * lean).abs() < 1e-12);
        let cos = (1.0 - lean * lean).sqrt();
        let radius = 0.46 - 0.2 * (1.0 - cos);
        assert!((point.rolling_radius - radius).abs() < 1e-12);
        assert!((point.curvature[0] - cos / radius).abs() < 1e-9);
        assert!((point.curvature[1] - (1.0 / 0.2 + 1.0 / 0.3)).abs() < 1e-9);
        // the gap of a circle on a circle across, and of a circle along
        let t = 5e-3;
        let circle = |r: f64| r - (r * r - t * t).sqrt();
        let gap = pair.gap(&point, [0.0, t]).unwrap();
        assert!((gap - circle(0.2) - circle(0.3)).abs() < 1e-12, "{gap}");
        assert!(pair.gap(&point, [0.0, 0.1]).is_none());
    }

    #[test]
    fn a_cone_touches_a_crown_where_their_slopes_are_equal() {
        let conicity = 0.05;
        // z down falls away from the middle of the track
        let cone = on_crown(Profile::cone(-conicity, 0.03));
        let point = cone.first_contact().unwrap();
        let lean = libm::atan(conicity);
        assert!((point.angle - lean).abs() < 1e-12, "{point:?}");
        assert!((point.on_rail[0] + 0.3 * libm::sin(lean)).abs() < 1e-12);
        let radius = 0.46 + conicity * 0.3 * libm::sin(lean);
        assert!((point.rolling_radius - radius).abs() < 1e-12);
        // rolling of the radius at y = 0: the larger circle slips backward, and the wheel spins about the normal
        let slip = cone.rigid_slip(&point, 1.0 / 0.46);
        assert!((slip.longitudinal - (radius / 0.46 - 1.0)).abs() < 1e-12);
        assert!((slip.spin + libm::sin(lean) / 0.46).abs() < 1e-12 && slip.lateral == 0.0);
        // a plane cone of half angle lean: x^2 cos/(2 r) along
        let x = 1e-3;
        let gap = cone.gap(&point, [x, 0.0]).unwrap();
        assert!((gap / (0.5 * x * x * libm::cos(lean) / radius) - 1.0).abs() < 1e-4, "{gap}");
    }

    #[test]
    fn a_yawed_wheel_touches_ahead_of_its_axle_and_slips_sideways() {
        let yaw = 0.01;
        let conicity = 0.05;
        let cone = WheelOnRail { yaw, ..on_crown(Profile::cone(-conicity, 0.03)) };
        let point = cone.first_contact().unwrap();
        // a circle of radius r on a cone leans by r tan(conicity) yaw
        let ahead = point.rolling_radius * conicity * yaw;
        let hub_x = -yaw * point.profile_y[0];
        assert!((point.from_centre.x - hub_x - ahead).abs() < 2e-3 * ahead, "{point:?}");
        let slip = cone.rigid_slip(&point, 1.0 / 0.46);
        let expected = -libm::sin(yaw) / libm::cos(point.angle) * point.rolling_radius / 0.46;
        assert!((slip.lateral / expected - 1.0).abs() < 1e-3, "{slip:?} {expected}");
        // the surfaces part in every direction from there
        for place in [[1e-3, 0.0], [-1e-3, 0.0], [0.0, 1e-3], [0.0, -1e-3], [1e-3, 1e-3]] {
            assert!(cone.gap(&point, place).unwrap() > 1e-8);
        }
    }

    #[test]
    fn a_rail_that_leans_in_touches_farther_out() {
        let cant = 1.0 / 40.0;
        let pair = WheelOnRail { cant, ..on_crown(Profile::crown(-1e3, 0.03)) };
        let point = pair.first_contact().unwrap();
        assert!((point.profile_y[1] - 0.3 * libm::sin(cant)).abs() < 1e-5, "{point:?}");
    }

    #[test]
    fn the_standards_touch_on_the_tread_and_bad_positions_say_why() {
        let pair = WheelOnRail {
            wheel: wheel_s1002(),
            // the rail of the Manchester benchmark, in the middle of its track
            rail: rail_head([10.5e-3, 25.988e-3]),
            cant: 0.025,
            lateral: -3.03e-3,
            ..on_crown(Profile::cone(0.0, 0.03))
        };
        let point = pair.first_contact().unwrap();
        // CONTACT, case 1 of
        let middle = pair.centre_of_overlap(&point, 15.96e-6).unwrap();
        assert!((middle.angle - 0.029).abs() < 1e-3, "{middle:?}");
        assert_eq!(pair.overlaps(&point, 2e-5).len(), 1);
        let far = WheelOnRail { lateral: 0.2, ..pair.clone() };
        assert!(matches!(far.first_contact(), Err(ProfileError::Apart { .. })));
        let swapped =
            WheelOnRail { wheel: pair.rail.clone(), rail: pair.wheel.clone(), ..pair.clone() };
        let error = swapped.first_contact().unwrap_err();
        assert!(error.to_string().contains("swapped"), "{error}");
    }
}
