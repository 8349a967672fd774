//! Contact of bodies that turn: gaps of a disk that is meshed as a polygon, and friction that turns with its face.
//!
//! *Gap.* A rigid disk rolls over a plane. The faces of its mesh lie inside the circle by up to the sag h^2/(8R), and
//! move under the contact as the disk rolls. Gaps with the correction of curvature are those of the circle at every
//! node of the plane and every angle. The projection of a node is found to 1e-8 of half a face, hence the gap to 1e-8
//! of the sag.
//!
//! *Friction.* A block is pressed on another and shifted so little that it sticks, which loads its friction springs.
//! Both turn together through 2 pi, about an axis oblique to the normal. Nothing moves relative to anything else,
//! and the friction force turns with the faces. Positions are rounded in each step, which stretches the springs:
//! the limit is the sum over all steps, over the stretch, for the three components of both ends.

use crate::body::{STEEL, contact_material};
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use contact::{ContactStep, Normals, PenaltyContact, PenaltySettings, Stiffness, TraceFields};
use friction::Coulomb;
use mesh::{Disk, FineZone, Grading, Mesh, Padded, Surface};
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::TAU;

const SETTINGS: PenaltySettings = PenaltySettings {
    normal: Stiffness::Factor(1.0),
    tangential: Stiffness::Factor(1.0),
    damping: 0.0,
    curvature: true,
    normals: Normals::Averaged,
};
const MU: f64 = 0.5;
const DT: f64 = 1e-7;

pub(crate) fn run(_: Size) -> Outcome {
    run_with(SETTINGS.curvature, |_, _| Ok(()))
}

/// The problem with or without the correction of curvature. `between` is called before each step of a turn with the
/// contact and the rotation vector of the step (rad).
pub(crate) fn run_with(
    curvature: bool,
    between: impl Fn(&mut PenaltyContact, Vector3<f64>) -> Result<(), Cause>,
) -> Outcome {
    Ok(vec![
        Row::new(
            "gaps under a rolling disk off the circle's, over the sag of its faces",
            [0.0, gaps(curvature)?],
            1.0,
            (1e-8, "the projection of a node, in half faces"),
            "a rigid circle on a plane",
        ),
        Row::new(
            "force of friction after a turn of both bodies, off the turned one",
            [0.0, turned_friction(between)?],
            1.0,
            (
                6.0 * f64::from(STEPS) * f64::EPSILON * EDGE / SHIFT,
                "a rounding of the positions in each step, over the stretch of the springs",
            ),
            "nothing moves relative to the faces",
        ),
    ])
}

/// Bodies with a prescribed motion.
struct Rig {
    contact: PenaltyContact,
    /// Reference and current positions of the nodes (m).
    reference: Vec<Padded>,
    at: Vec<Padded>,
    fields: TraceFields,
}

impl Rig {
    fn new(
        mesh: &Mesh,
        surfaces: [&Surface; 2],
        settings: &PenaltySettings,
    ) -> Result<Self, Cause> {
        let surfaces = surfaces.map(|s| (s, contact_material(&STEEL)));
        let law = Box::new(Coulomb { mu: MU });
        let contact = PenaltyContact::new(mesh, surfaces, settings, None, law)?;
        let reference: Vec<Padded> = mesh.nodes.iter().copied().map(Padded::from).collect();
        let still = vec![0.0; reference.len()];
        let fields = TraceFields::new(contact.trace(), &reference, &still);
        Ok(Self { contact, at: reference.clone(), reference, fields })
    }

    /// Moves every node to `place` of its index and reference position (m), and returns the force (N) on the first
    /// body.
    fn step(&mut self, place: impl Fn(usize, Vector3<f64>) -> Vector3<f64>) -> Vector3<f64> {
        let n = self.reference.len();
        let (mut displacement, mut velocity) = (vec![Padded::ZERO; n], vec![Padded::ZERO; n]);
        for i in 0..n {
            let (from, x) = (self.reference[i].vector(), self.at[i].vector());
            let to = place(i, from);
            displacement[i] = Padded::from(to - from);
            velocity[i] = Padded::from((to - x) / DT);
            self.at[i] = Padded::from(to);
        }
        self.fields.gather_positions(&displacement);
        self.fields.gather_velocities(&velocity);
        let step = self.fields.step(0.0, DT);
        self.contact.apply(&step.motion, step.force).force[0]
    }
}

/// Largest difference of a gap from that of the circle, over the sag, as a disk rolls over several faces.
fn gaps(curvature: bool) -> Result<f64, Cause> {
    let (radius, size, depth) = (0.46, 2e-3, 2e-5);
    let zone = FineZone {
        size,
        length: 0.04,
        width: 8e-3,
        depth: 4e-3,
        start: -0.02,
        growth: 2.0,
        coarsest: 0.1,
        grading: Grading::Tensor,
    };
    let disk = mesh::disk(&Disk { radius, hub_radius: 0.40, width: 8e-3, crown: None }, &zone)?;
    // of another pitch, so that its nodes meet all parts of a face
    let mut plane = mesh::block([21, 3, 1], [0.04, 6e-3, size]);
    plane.nodes.iter_mut().for_each(|x| *x -= Vector3::new(0.02, 3e-3, size));
    let mesh = mesh::join(&[disk, plane]);
    let [wheel, rest] = [&mesh.bodies[0], &mesh.bodies[1]];
    let surfaces = [&wheel.surfaces["zone"], &rest.surfaces["z+"]];
    let mut rig = Rig::new(&mesh, surfaces, &PenaltySettings { curvature, ..SETTINGS })?;
    let mut table = rig.contact.nodal_table(1);
    let mut worst = 0.0_f64;
    for step in 0..200 {
        let along = f64::from(step) * 6e-5 - 6e-3;
        let (s, c) = libm::sincos(along / radius);
        rig.step(|i, x| {
            let z = x[2] - radius;
            let rolled =
                Vector3::new(c * x.x + s * z + along, x.y, radius - depth - s * x.x + c * z);
            if wheel.nodes.contains(&i) { rolled } else { x }
        });
        rig.contact.nodal(&mut table);
        for (&node, gap) in table.nodes.iter().zip(&table.gap).filter(|(_, gap)| **gap < 0.0) {
            let x = rig.reference[node as usize].xyz();
            let exact = libm::hypot(x[0] - along, x[2] - radius + depth) - radius;
            worst = worst.max((gap - exact).abs());
        }
    }
    Ok(worst / (size * size / (8.0 * radius)))
}

/// Edge of the blocks (m), by how much the upper one is pressed and shifted (m), and the steps of the turn.
const EDGE: f64 = 4e-3;
const PRESSED: f64 = 4e-6;
const SHIFT: f64 = 1e-6;
const STEPS: u32 = 240;

/// Largest difference of the contact force from the turned one, over the friction force, in a turn through 2 pi.
fn turned_friction(
    between: impl Fn(&mut PenaltyContact, Vector3<f64>) -> Result<(), Cause>,
) -> Result<f64, Cause> {
    let upper = mesh::block([2; 3], [EDGE; 3]);
    let mut lower = upper.clone();
    lower.nodes.iter_mut().for_each(|x| x[2] -= EDGE);
    let mesh = mesh::join(&[upper, lower]);
    let surfaces = [&mesh.bodies[0].surfaces["z-"], &mesh.bodies[1].surfaces["z+"]];
    let mut rig = Rig::new(&mesh, surfaces, &SETTINGS)?;
    let top = mesh.bodies[0].nodes.clone();
    let placed = |i: usize, x: Vector3<f64>, share: f64| {
        if !top.contains(&i) {
            return x;
        }
        x + Vector3::new(0.8 * share * SHIFT, 0.6 * share * SHIFT, -PRESSED)
    };
    rig.step(|i, x| placed(i, x, 0.0));
    let start = rig.step(|i, x| placed(i, x, 1.0));
    let angle = TAU / f64::from(STEPS);
    let axis = UnitVector3::new_unchecked(Vector3::new(1.0, 2.0, 2.0) / 3.0);
    let mut worst = 0.0_f64;
    for step in 1..=STEPS {
        between(&mut rig.contact, *axis * angle)?;
        let turn = angle * f64::from(step);
        let force = rig.step(|i, x| turned(axis, turn, placed(i, x, 1.0)));
        let expected = turned(axis, turn, start);
        worst = worst.max((force - expected).norm() / libm::hypot(start.x, start.y));
    }
    Ok(worst)
}

/// A vector turned about a unit axis by an angle (Rodrigues).
fn turned(n: UnitVector3<f64>, angle: f64, x: Vector3<f64>) -> Vector3<f64> {
    let (s, c) = libm::sincos(angle);
    c * x + s * n.cross(&x) + (1.0 - c) * n.dot(&x) * *n
}
