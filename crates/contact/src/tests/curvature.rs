use super::{Rig, SETTINGS};
use crate::face::{Positions, project};
use crate::search::Listed;
use crate::surface::ContactSurface;
use crate::tests::plates::{STEEL, plate, tread};
use crate::{ContactStep, PenaltySettings};
use friction::Coulomb;
use mesh::Padded;
use nalgebra::Vector3;

const RADIUS: f64 = 0.46;
/// 2 mm faces.
const CELLS: usize = 20;
const ARC: f64 = 2e-3 * CELLS as f64 / RADIUS;
const SAG: f64 = 2e-3 * 2e-3 / (8.0 * RADIUS);

fn turned(x: Vector3<f64>, angle: f64) -> Vector3<f64> {
    let (s, c) = libm::sincos(angle);
    let z = x[2] - RADIUS;
    Vector3::new(c * x[0] + s * z, x[1], RADIUS - s * x[0] + c * z)
}

#[test]
fn facets_of_a_rotated_cylinder_give_gap_and_normal_of_the_circle() {
    let (mesh, faces) = tread(RADIUS, 0.5 * ARC, 8e-3, [CELLS, 4], 2e-3);
    let (trace, surface) = ContactSurface::alone(&mesh, &faces, STEEL).unwrap();
    let angle = 0.7;
    let nodes = trace.gather(&mesh.nodes).into_iter();
    let position: Vec<Padded> = nodes.map(|x| turned(x, angle).into()).collect();
    let positions = Positions(&position);
    let mut worst_facet = 0.0_f64;
    for i in 0..200 {
        let phi = (f64::from(i) / 199.0 - 0.5) * 0.8 * ARC;
        for gap in [-5e-5, 1e-4] {
            let r = RADIUS + gap;
            let centre = RADIUS * Vector3::z();
            let outward = Vector3::new(libm::sin(phi), 0.0, -libm::cos(phi));
            let node = turned(centre + r * outward + 1.1e-3 * Vector3::y(), angle);
            let outward = turned(centre + outward, angle) - centre;
            let exact = project(&surface, &positions, true, node, 30, 0.0, 0.0).projection.unwrap();
            assert!((exact.gap - gap).abs() < 1e-6 * SAG, "{:e}", exact.gap - gap);
            // The normal is that of the last but one iterate, at most 1e-8 half faces away.
            let error = (*exact.point.normal - outward).norm();
            assert!(error < 1e-8 * 1e-3 / RADIUS, "{error:e}");
            let facet =
                project(&surface, &positions, false, node, 30, 0.0, 0.0).projection.unwrap();
            worst_facet = worst_facet.max((facet.gap - gap).abs());
        }
    }
    assert!((worst_facet / SAG - 1.0).abs() < 0.02, "{worst_facet:e} {SAG:e}");
}

/// A rigid disk rolls over a rigid plane: largest deviation of the penetrations from the circle's.
fn rolling(curvature: bool) -> (f64, f64) {
    let settings = PenaltySettings { curvature, ..SETTINGS };
    let mut rig = Rig::new(
        tread(RADIUS, 0.5 * ARC, 6e-3, [CELLS, 3], 2e-3),
        plate([-40e-3, -4e-3], [40e-3, 4e-3], [37, 4], 0.0, 2e-3, true),
        &settings,
        Coulomb { mu: 0.3 },
    );
    let depth = 2e-5;
    let (mut worst, mut shear) = (0.0_f64, 0.0_f64);
    for step in 0..600 {
        let x = f64::from(step) * 2e-5 - 6e-3;
        let sums = rig.step(|body, at| {
            if body == 0 { turned(at, x / RADIUS) + Vector3::new(x, 0.0, -depth) } else { at }
        });
        let mut checked = 0;
        for point in rig.contact.points[1].iter().filter(|p| p.is_closed()) {
            let node = rig.contact.trace().side(1)[point.slave as usize] as usize;
            let at = rig.reference[node].xyz();
            let gap = libm::hypot(at[0] - x, at[2] - RADIUS + depth) - RADIUS;
            worst = worst.max((point.gap - gap).abs());
            checked += 1;
        }
        assert!(checked > 0);
        shear = shear.max(sums.force[0][0].abs() / sums.normal_force);
    }
    (worst, shear)
}

#[test]
fn rolling_penetration_is_the_circles_with_and_off_by_the_sag_without_the_correction() {
    let (exact, shear) = rolling(true);
    assert!(exact < 1e-6 * SAG, "{exact:e}");
    assert!(shear < 0.02, "{shear}");
    let (facets, _) = rolling(false);
    assert!((facets / SAG - 1.0).abs() < 0.05, "{facets:e} {SAG:e}");
}

#[test]
fn normals_beyond_facets_are_the_circles_whichever_corner_comes_first_and_however_skew_they_are() {
    for (turn, skew) in [(1, 0.0), (0, 0.4), (3, -0.6)] {
        let (mut mesh, mut faces) = tread(RADIUS, 0.5 * ARC, 8e-3, [CELLS, 4], 2e-3);
        mesh.nodes.iter_mut().for_each(|x| x[1] += skew * x[0]);
        faces.faces.iter_mut().for_each(|face| face.nodes.rotate_left(turn));
        let (trace, surface) = ContactSurface::alone(&mesh, &faces, STEEL).unwrap();
        let position: Vec<Padded> =
            trace.gather(&mesh.nodes).into_iter().map(Padded::from).collect();
        for i in 0..200 {
            let (s, c) = libm::sincos((f64::from(i) / 199.0 - 0.5) * 0.8 * ARC);
            let r = RADIUS + 1e-4;
            let node = Vector3::new(r * s, 1.1e-3 + skew * r * s, RADIUS - r * c);
            let found = project(&surface, &Positions(&position), true, node, 30, 0.0, 0.0);
            let found = found.projection.unwrap();
            assert!((found.gap - 1e-4).abs() < 1e-6 * SAG, "{turn} {skew}: {:e}", found.gap - 1e-4);
            for (found, exact) in [0, 1, 2].map(|i| found.point.normal[i]).iter().zip([s, 0.0, -c])
            {
                assert!((found - exact).abs() < 1e-8 * 1e-3 / RADIUS, "{turn} {skew}: {found:e}");
            }
        }
    }
}
