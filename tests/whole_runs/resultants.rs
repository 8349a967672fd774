//! Contact forces on the generated meshes: a rigid disk is pressed into a rigid bar, rolled and
//! slid, and the nodal forces are summed up apart from the contact's own sums.

use contact::{
    BodyMaterial, ContactStep, ContactSums, PenaltyContact, PenaltySettings, TraceFields,
};
use friction::Coulomb;
use mesh::{Bar, Disk, FineZone, Mesh, Padded};

const RADIUS: f64 = 0.46;
const DT: f64 = 2e-7;
/// Depth to which the undeformed shapes overlap.
const DEPTH: f64 = 20e-6;

struct Rig {
    mesh: Mesh,
    contact: PenaltyContact,
    reference: Vec<Padded>,
    displacement: Vec<Padded>,
    fields: TraceFields,
    force: Vec<Padded>,
}

impl Rig {
    fn new(size: f64, curvature: bool) -> Self {
        let zone = FineZone {
            size,
            length: 0.032,
            width: 0.012,
            depth: 0.004,
            start: -0.016,
            growth: 2.0,
            coarsest: 0.05,
            grading: Default::default(),
        };
        let disk = Disk { radius: RADIUS, hub_radius: 0.1, width: 0.06, crown: None };
        let bar = Bar { length: 0.1, width: 0.06, height: 0.03, crown: Some(0.3), start: -0.05 };
        let mesh =
            mesh::join(&[mesh::disk(&disk, &zone).unwrap(), mesh::bar(&bar, &zone).unwrap()]);
        let steel = BodyMaterial { bulk_modulus: 175e9, density: 7800.0 };
        let settings = PenaltySettings {
            normal: contact::Stiffness::Factor(0.1),
            tangential: contact::Stiffness::Factor(0.1),
            damping: 0.1,
            curvature,
            normals: contact::Normals::Averaged,
        };
        let surfaces =
            [(&mesh.bodies[0].surfaces["tread"], steel), (&mesh.bodies[1].surfaces["top"], steel)];
        let law = Box::new(Coulomb { mu: 0.3 });
        let contact = PenaltyContact::new(&mesh, surfaces, &settings, None, law).unwrap();
        let n = mesh.nodes.len();
        let reference: Vec<Padded> = mesh.nodes.iter().copied().map(Padded::from).collect();
        Self {
            fields: TraceFields::new(contact.trace(), &reference, &vec![1e4; n]),
            contact,
            reference,
            displacement: vec![Padded::ZERO; n],
            force: vec![Padded::ZERO; n],
            mesh,
        }
    }

    /// Moves the disk to centre `x`, `y`, turned by `angle`, and applies contact.
    fn step(&mut self, x: f64, y: f64, angle: f64) -> ContactSums {
        let (s, c) = angle.sin_cos();
        let mut velocity = vec![Padded::ZERO; self.reference.len()];
        for n in self.mesh.bodies[0].nodes.clone() {
            let [px, _, pz] = self.mesh.nodes[n].into();
            let z = pz - RADIUS;
            let u = [c * px + s * z + x - px, y, c * z - s * px - DEPTH - z];
            for i in 0..3 {
                velocity[n].0[i] = (u[i] - self.displacement[n].0[i]) / DT;
            }
            self.displacement[n] = Padded::new(u);
        }
        self.force.fill(Padded::ZERO);
        let fields = &mut self.fields;
        fields.gather_positions(&self.displacement);
        fields.gather_velocities(&velocity);
        fields.gather_forces(fields.all(), &self.force);
        let step = fields.step(0.0, DT);
        let sums = self.contact.apply(&step.motion, step.force);
        fields.scatter_forces(fields.all(), &mut self.force);
        sums
    }

    /// Force (N) and moment about the origin (N m) of the nodal forces on a body.
    fn resultant(&self, body: usize) -> [[f64; 3]; 2] {
        let mut sums = [[0.0; 3]; 2];
        for n in self.mesh.bodies[body].nodes.clone() {
            let (f, r, u) = (self.force[n].xyz(), self.reference[n], self.displacement[n]);
            let x = [0, 1, 2].map(|i| r.0[i] + u.0[i]);
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                sums[0][i] += f[i];
                sums[1][i] += x[j] * f[k] - x[k] * f[j];
            }
        }
        sums
    }
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

#[test]
fn nodal_forces_on_both_bodies_are_equal_and_opposite_while_rolling_and_sliding() {
    let mut rig = Rig::new(2e-3, true);
    let mut slipped = false;
    for step in 0..400 {
        // Rolls 8 mm with 2 % creepage and drifts sideways.
        let x = 2e-5 * f64::from(step);
        let sums = rig.step(x, 0.01 * x, 1.02 * x / RADIUS);
        slipped |= sums.slipping > 0 && sums.sticking > 0;
        let [[on_disk, _], [on_bar, _]] = [0, 1].map(|body| rig.resultant(body));
        assert!(sums.normal_force > 1e3, "{}", sums.normal_force);
        let both = [0, 1, 2].map(|i| on_disk[i] + on_bar[i]);
        assert!(length(both) < 1e-10 * sums.normal_force, "{both:?} of {}", sums.normal_force);
        for (mine, reported) in [on_disk, on_bar].iter().zip(sums.force) {
            let off = [0, 1, 2].map(|i| mine[i] - reported[i]);
            assert!(length(off) < 1e-10 * sums.normal_force, "{off:?}");
        }
    }
    assert!(slipped, "part of the patch slipped");
}

/// Largest over smallest normal force, less one, while the disk turns on the spot by three
/// elements, so that the nodes of the tread pass between those of the bar.
fn unevenness(curvature: bool) -> f64 {
    let size = 2e-3;
    let mut rig = Rig::new(size, curvature);
    rig.step(0.0, 0.0, 0.0); // the dampers answer to the jump to the depth
    let forces = (1..300).map(|step| {
        let arc = 3.0 * size * f64::from(step) / 300.0;
        rig.step(0.0, 0.0, arc / RADIUS).force[0][2]
    });
    let (low, high) = forces.fold((f64::MAX, 0.0_f64), |(low, high), f| (low.min(f), high.max(f)));
    assert!(low > 1e3, "{low}");
    high / low - 1.0
}

#[test]
fn the_normal_force_of_a_turning_disk_is_smoother_with_the_curvature_correction() {
    let (with, without) = (unevenness(true), unevenness(false));
    println!("{with:e} with, {without:e} without");
    assert!(with < 0.5 * without, "{with:e} with, {without:e} without the correction");
}
