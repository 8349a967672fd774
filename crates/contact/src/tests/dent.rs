//! A tread on a plate with the same cells, both bent to one dent, the nodes of the tread a little beside those of the
//! plate: a disk pressed on a bar by meshes that match.

use super::exact::Masses;
use super::{Rig, SETTINGS};
use crate::tests::plates::{plate, tread};
use crate::{ContactSums, ExactSettings, Normals, PenaltySettings, Rows};
use friction::Coulomb;
use mesh::{Mesh, Surface};
use nalgebra::Vector3;

const CELL: f64 = 1e-3;
/// How far the nodes of the tread lie beside those of the plate.
const BESIDE: f64 = 1e-2 * CELL;
/// Radius of the tread; that of the dent is twice as large.
const RADIUS: f64 = 0.25;
/// Half length of the loaded part.
const HALF_LENGTH: f64 = 3.5e-3;

fn bodies() -> [(Mesh, Surface); 2] {
    let half = 5.0 * CELL;
    let disk = tread(RADIUS, half / RADIUS, 2.0 * CELL, [10, 2], CELL);
    [disk, plate([-7e-3, -CELL], [7e-3, CELL], [14, 2], 0.0, CELL, true)]
}

fn dented(body: usize, place: Vector3<f64>) -> Vector3<f64> {
    let (x, dent) = (place.x, |x: f64| x * x / (4.0 * RADIUS));
    // a node of the tread touches the chord between two nodes of the plate
    let lift = BESIDE * (CELL - BESIDE) / (4.0 * RADIUS);
    let round = x * x / (2.0 * RADIUS);
    if body == 0 {
        place + Vector3::new(BESIDE, 0.0, dent(x + BESIDE) + lift - round)
    } else {
        place + dent(x) * Vector3::z()
    }
}

/// One in the middle of the loaded part, zero at its ends and beyond.
fn parabola(x: f64) -> f64 {
    (1.0 - (x / HALF_LENGTH).powi(2)).max(0.0)
}

/// Force along over force across the tread.
fn along(sums: &ContactSums) -> f64 {
    assert!(sums.closed >= 7 * 3, "{sums:?}");
    (sums.force[0][0] / sums.force[0][2]).abs()
}

fn springs(normals: Normals) -> f64 {
    let settings = PenaltySettings { normals, ..SETTINGS };
    let [disk, bar] = bodies();
    let mut rig = Rig::new(disk, bar, &settings, Coulomb { mu: 0.0 });
    along(&rig.step(|body, place| {
        let place = dented(body, place);
        let deep = if body == 0 { 1e-7 * parabola(place.x) } else { 0.0 };
        place - deep * Vector3::z()
    }))
}

fn exactly(slave: usize, rows: Rows, normals: Normals) -> f64 {
    let settings = ExactSettings { slave: Some(slave), curvature: true, rows, normals };
    let [disk, bar] = bodies();
    let mut masses = Masses::with(disk, bar, &settings, Coulomb { mu: 0.0 });
    masses.inverse_mass.fill(1e5);
    for (i, (u, x)) in masses.displacement.iter_mut().zip(&masses.reference).enumerate() {
        *u = (dented(usize::from(i >= masses.upper), x.vector()) - x.vector()).into();
    }
    let load = |x| -100.0 * parabola(x) * Vector3::z();
    along(&masses.step(|body, place| if body == 0 { load(place.x) } else { Vector3::zeros() }))
}

/// Half the kink between two facets of the dent.
const HALF_KINK: f64 = 0.5 * CELL / (2.0 * RADIUS);

#[test]
fn springs_push_along_a_dent_with_normals_of_faces_and_not_with_averaged_ones() {
    let [averaged, face] = [Normals::Averaged, Normals::Face].map(springs);
    assert!((0.85..1.05).contains(&(face / HALF_KINK)), "{face:e} of {HALF_KINK:e}");
    assert!(averaged < 0.03 * HALF_KINK, "{averaged:e} of {HALF_KINK:e}");
}

#[test]
fn exact_contact_pushes_along_a_dent_with_normals_of_faces_and_not_with_averaged_ones() {
    for slave in [0, 1] {
        let pushes = |normals| exactly(slave, Rows::NodeToFace, normals);
        let [averaged, face] = [Normals::Averaged, Normals::Face].map(pushes);
        assert!((0.85..1.05).contains(&(face / HALF_KINK)), "{slave}: {face:e} of {HALF_KINK:e}");
        assert!(averaged < 0.03 * HALF_KINK, "{slave}: {averaged:e} of {HALF_KINK:e}");
    }
}
