//! The section of a running surface across, in the frame of a mesh, and bodies whose surfaces follow one.

use super::smoothing::{interpolated, part};
use crate::error::within;
use crate::{Allowed, Bar, Disk, FineZone, Mesh, MeshError, Parameter, SmoothSurface};
use nalgebra::Vector3;
use std::sync::Arc;

/// Distance of the points of a section (m). Where the curvature jumps by dk the curve is off by about its square times dk/16:
/// 0.04 um between radii of 13 and 80 mm.
const SPACING: f64 = 1e-4;
/// Slope at which a profile is followed no farther: 45 degrees.
const STEEPEST: f64 = 1.0;
/// Points on either side below which a section has no shape.
const LEAST: usize = 8;
/// The length (m) in which the slope fades beyond the part that is followed, over the length of that part on either side.
const FADE: f64 = 0.5;

/// The height z(y) (m), up, of a running surface over y (m) across, both from the point of first contact: a cubic spline through
/// equidistant points of the profile as far as it is followed, beyond which its slope fades.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// y of the first point (m).
    start: f64,
    height: Vec<f64>,
    /// Second derivatives at the points (1/m).
    bend: Vec<f64>,
    /// Length in which the slope falls to 1/e beyond the ends (m).
    fade: f64,
}

impl Section {
    /// The sections of two profiles that touch at y = 0, whose height and slope at y are `profiles[i](y)`: as far as `reach` (m) on
    /// either side, or as both are there with slopes up to 45 degrees; `None` where that is no more than a few points.
    pub(super) fn pair(
        profiles: [&dyn Fn(f64) -> Option<[f64; 2]>; 2],
        reach: f64,
    ) -> Option<[Self; 2]> {
        let place = |sign: f64, i: usize| sign * SPACING * i as f64;
        let followed = |y: f64| {
            profiles.iter().all(|of| of(y).is_some_and(|[_, slope]| slope.abs() <= STEEPEST))
        };
        let most = (reach / SPACING).ceil() as usize;
        let [left, right] =
            [-1.0, 1.0].map(|sign| (1..=most).take_while(|&i| followed(place(sign, i))).count());
        if left.min(right) < LEAST {
            return None;
        }
        let start = place(-1.0, left);
        let at = |i: usize| if i == left { 0.0 } else { start + SPACING * i as f64 };
        let y: Vec<f64> = (0..=left + right).map(at).collect();
        let [disk, bar] = profiles.map(|of| {
            let height: Option<Vec<f64>> = y.iter().map(|y| Some(of(*y)?[0])).collect();
            let height = height?;
            let bend = interpolated(&y, &height);
            Some(Self { start, height, bend, fade: FADE * reach })
        });
        Some([disk?, bar?])
    }

    /// Height and slope at y (m).
    pub fn at(&self, y: f64) -> [f64; 2] {
        let cells = self.height.len() - 1;
        let place = (y - self.start) / SPACING;
        let inside = place.clamp(0.0, cells as f64);
        let cell = (inside as usize).min(cells - 1);
        let pair = |of: &[f64]| [of[cell], of[cell + 1]];
        let [z, slope, _] =
            part(SPACING, inside - cell as f64, pair(&self.height), pair(&self.bend));
        if place == inside {
            return [z, slope];
        }
        let beyond = SPACING * (place - inside);
        // the integral of the slope's fading e^(-|x|/l)
        let faded = -libm::expm1(-beyond.abs() / self.fade);
        [z + slope * self.fade * faded.copysign(beyond), slope * (1.0 - faded)]
    }

    /// The distance (m) of the point y, z above the curve, along the normal, and that normal, up. One step of Newton's method
    /// from the point below leads to the nearest point: for points whose distance is small against the radius of curvature.
    fn above(&self, y: f64, z: f64) -> (f64, [f64; 2]) {
        let [height, slope] = self.at(y);
        let y_near = y + (z - height) * slope / (1.0 + slope * slope);
        let [height, slope] = self.at(y_near);
        let size = (1.0 + slope * slope).sqrt();
        let normal = [-slope / size, 1.0 / size];
        (normal[0] * (y - y_near) + normal[1] * (z - height), normal)
    }

    /// Refuses the `width` (m) of a body within which the section is higher or lower than half the `thickness` (m).
    fn fits(&self, parameter: Parameter, width: f64, thickness: f64) -> Result<(), MeshError> {
        let low = |half: f64| [-half, half].iter().all(|y| self.at(*y)[0].abs() <= 0.5 * thickness);
        let steps = (0.5 * width / SPACING) as usize;
        let most = (1..=steps).map(|i| SPACING * i as f64).take_while(|half| low(*half)).last();
        let most = 2.0 * most.unwrap_or(0.0);
        let what = "within which its profile rises and falls by less than half the body";
        let allowed = Allowed::AtMost(most, what);
        within(low(0.5 * width), parameter, width, allowed)
    }

    /// As [`SmoothSurface::offset`] of the top of a bar.
    pub(crate) fn below_top(&self, p: Vector3<f64>) -> f64 {
        -self.above(p.y, p.z).0
    }

    /// As [`SmoothSurface::normal`] of the top of a bar.
    pub(crate) fn top_normal(&self, p: Vector3<f64>) -> Vector3<f64> {
        let (_, [y, z]) = self.above(p.y, p.z);
        Vector3::new(0.0, y, z)
    }

    /// As [`SmoothSurface::offset`] of the tread of a disk, `p` being relative to its centre.
    pub(crate) fn inside_tread(&self, radius: f64, p: Vector3<f64>) -> f64 {
        self.above(p.y, radius - libm::hypot(p.x, p.z)).0
    }

    /// As [`SmoothSurface::normal`] of the tread of a disk, `p` being relative to its centre.
    pub(crate) fn tread_normal(&self, radius: f64, p: Vector3<f64>) -> Vector3<f64> {
        let rho = libm::hypot(p.x, p.z);
        let (_, [y, up]) = self.above(p.y, radius - rho);
        Vector3::new(up * p.x / rho, -y, up * p.z / rho)
    }
}

/// The mesh of a bar without a crown whose top follows a section; this fades linearly to a flat bottom.
///
/// # Errors
/// As those of [`bar`](crate::bar()); a width within which the section is higher than half the bar.
pub fn profiled_bar(
    shape: &Bar,
    zone: &FineZone,
    section: &Arc<Section>,
) -> Result<Mesh, MeshError> {
    section.fits(Parameter::BarWidth, shape.width, shape.height)?;
    let mut mesh = crate::bar(&Bar { crown: None, ..*shape }, zone)?;
    for p in &mut mesh.nodes {
        let [height, _] = section.at(p[1]);
        p[2] += height * (p[2] + shape.height) / shape.height;
    }
    let smooth = SmoothSurface::ProfiledTop { section: section.clone() };
    Ok(with_surface(mesh, &smooth))
}

/// The mesh of a disk without a crown whose tread follows a section; this fades linearly to a round hub.
///
/// # Errors
/// As those of [`disk`](crate::disk()); a width within which the section is higher than half the disk's rim.
pub fn profiled_disk(
    shape: &Disk,
    zone: &FineZone,
    section: &Arc<Section>,
) -> Result<Mesh, MeshError> {
    let Disk { radius, hub_radius, width, .. } = *shape;
    section.fits(Parameter::DiskWidth, width, radius - hub_radius)?;
    let mut mesh = crate::disk(&Disk { crown: None, ..*shape }, zone)?;
    let centre = radius * Vector3::z();
    for p in &mut mesh.nodes {
        let [x, y, z] = [p[0], p[1], p[2] - radius];
        let rho = libm::hypot(x, z);
        let [height, _] = section.at(y);
        let wider = 1.0 - height * (rho - hub_radius) / (radius - hub_radius) / rho;
        (p[0], p[2]) = (x * wider, radius + z * wider);
    }
    let smooth = SmoothSurface::ProfiledTread { centre, radius, section: section.clone() };
    Ok(with_surface(mesh, &smooth))
}

/// A mesh whose running surfaces, those with an exact one, have this one.
fn with_surface(mut mesh: Mesh, smooth: &SmoothSurface) -> Mesh {
    let surfaces = mesh.bodies.iter_mut().flat_map(|body| body.surfaces.values_mut());
    surfaces.filter(|s| s.smooth.is_some()).for_each(|s| s.smooth = Some(smooth.clone()));
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::{Profile, WheelOnRail, rail_60e1, wheel_s1002};
    use crate::{Grading, quality};

    const ZONE: FineZone = FineZone {
        size: 2e-3,
        length: 20e-3,
        width: 16e-3,
        depth: 6e-3,
        start: -10e-3,
        growth: 1.5,
        coarsest: 20e-3,
        grading: Grading::TwoToOne,
    };
    const REACH: f64 = 10e-3;
    const DISK: Disk = Disk { radius: 0.46, hub_radius: 0.2, width: 0.05, crown: None };
    const BAR: Bar = Bar { length: 0.1, width: 0.05, height: 0.07, crown: None, start: -0.05 };

    fn standards(lateral: f64) -> WheelOnRail {
        WheelOnRail {
            wheel: wheel_s1002(),
            rail: rail_60e1(),
            radius: 0.46,
            lateral,
            yaw: 0.0,
            roll: 0.0,
            cant: 0.025,
        }
    }

    /// The meshes that follow the profiles of a pair, and their sections.
    fn meshes(pair: &WheelOnRail, grading: Grading) -> ([Mesh; 2], [Arc<Section>; 2]) {
        let point = pair.first_contact().unwrap();
        let sections = pair.sections(&point, REACH).unwrap().map(Arc::new);
        let disk = Disk { radius: point.rolling_radius, ..DISK };
        let zone = FineZone { grading, ..ZONE };
        let meshes = [
            profiled_disk(&disk, &zone, &sections[0]).unwrap(),
            profiled_bar(&BAR, &zone, &sections[1]).unwrap(),
        ];
        (meshes, sections)
    }

    /// Nodes of the running surfaces of a body.
    fn running(mesh: &Mesh) -> Vec<Vector3<f64>> {
        let body = &mesh.bodies[0];
        let set = body.node_sets.get("tread").or_else(|| body.node_sets.get("top")).unwrap();
        set.iter().map(|&n| mesh.at(n)).collect()
    }

    #[test]
    fn bodies_with_circles_for_profiles_are_those_with_crowns() {
        let pair = WheelOnRail {
            wheel: Profile::crown(-0.4, 0.05),
            rail: Profile::crown(0.3, 0.05),
            cant: 0.0,
            ..standards(0.0)
        };
        let (profiled, _) = meshes(&pair, ZONE.grading);
        let crowned = [
            crate::disk(&Disk { crown: Some(0.4), ..DISK }, &ZONE).unwrap(),
            crate::bar(&Bar { crown: Some(0.3), ..BAR }, &ZONE).unwrap(),
        ];
        for (ours, exact) in profiled.iter().zip(&crowned) {
            let followed = |p: &Vector3<f64>| p.y.abs() <= REACH;
            let pairs = ours.nodes.iter().zip(&exact.nodes).filter(|(_, p)| followed(p));
            let apart = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            assert!(apart < 1e-10, "{apart}");
            let [ours, theirs] =
                [ours, exact].map(|mesh| mesh.bodies[0].surfaces["zone"].smooth.clone().unwrap());
            for p in running(exact).into_iter().filter(followed) {
                let p = p + Vector3::new(0.0, 3e-6, 1e-5);
                assert!((ours.offset(p) - theirs.offset(p)).abs() < 1e-10, "{p}");
                assert!((*ours.normal(p) - *theirs.normal(p)).norm() < 1e-6, "{p}");
            }
        }
    }

    #[test]
    fn wheel_and_rail_follow_their_profiles_with_sound_elements_to_the_root_of_the_flange() {
        let gradings = [Grading::TwoToOne, Grading::Tensor];
        let places = [-10e-3, -3e-3, 0.0, 3e-3];
        for (lateral, grading) in places.into_iter().flat_map(|y| gradings.map(|g| (y, g))) {
            let pair = standards(lateral);
            let (meshes, [_, section]) = meshes(&pair, grading);
            let point = pair.first_contact().unwrap();
            for mesh in &meshes {
                let least = quality(mesh).min_scaled_jacobian;
                assert!(least > 0.3, "{lateral}: {least}");
                let smooth = mesh.bodies[0].surfaces["zone"].smooth.as_ref().unwrap();
                for p in running(mesh) {
                    assert!(smooth.offset(p).abs() < 1e-12, "{p}");
                }
            }
            // the rail's nodes against its profile, turned by hand
            let [_, u0] = point.profile_y;
            let turned = |u: f64| {
                let (sin, cos) = libm::sincos(pair.cant);
                pair.rail.at(u).map(|[z, ..]| [cos * u + sin * z, sin * u - cos * z])
            };
            let [y0, z0] = turned(u0).unwrap();
            let place = |i: i32| turned(u0 + 1e-5 * f64::from(i));
            let drawn = (-2000..2000).filter_map(place).map(|[y, z]| [y - y0, z - z0]);
            let drawn: Vec<[f64; 2]> = drawn.collect();
            let near = |p: &Vector3<f64>| p.y.abs() < 8e-3 && p.y > section.start;
            for p in running(&meshes[1]).into_iter().filter(near) {
                let next = drawn.partition_point(|[y, _]| *y <= p.y);
                let [[y, z], [y_next, z_next]] = [drawn[next - 1], drawn[next]];
                let height = z + (z_next - z) * (p.y - y) / (y_next - y);
                assert!((p.z - height).abs() < 3e-7, "{lateral} {p} {height}");
            }
        }
    }

    #[test]
    fn both_sections_end_where_one_is_steeper_than_45_degrees_and_level_out() {
        let pair = standards(3e-3);
        let point = pair.first_contact().unwrap();
        let sections = pair.sections(&point, REACH).unwrap();
        // the flange of the wheel and the gauge corner of the rail lie towards the middle of the track
        let [wheel, rail] = &sections;
        assert_eq!(wheel.start, rail.start);
        let end = rail.start;
        let slopes = sections.each_ref().map(|section| section.at(end)[1]);
        assert!(slopes[0].max(slopes[1]) > 0.95 && slopes[0].max(slopes[1]) <= 1.0, "{slopes:?}");
        for (section, steep) in sections.iter().zip(slopes) {
            let [[before, slope], [after, _], [far, level]] =
                [end, end - 1e-7, -0.2].map(|y| section.at(y));
            assert!((before - after - 1e-7 * slope).abs() < 1e-11);
            assert!(level.abs() < 1e-12 && (before - far - steep * 5e-3).abs() < 1e-9);
        }
        assert_eq!(wheel.at(0.0)[0], 0.0);
        let yawed = WheelOnRail { yaw: 1e-3, ..pair };
        assert!(yawed.sections(&point, REACH).is_none());
        let low = profiled_bar(&Bar { height: 9e-3, ..BAR }, &ZONE, &Arc::new(rail.clone()));
        let error = low.unwrap_err();
        let width = matches!(error, MeshError::OutOfRange { parameter: Parameter::BarWidth, .. });
        assert!(width, "{error}");
    }
}
