//! Penalty contact on the reference wheel pressed on its bar: `cargo bench -p
//! creepage-benches --bench contact`.
#![allow(missing_docs)]

use contact::{
    BodyMaterial, ContactStep, FreeMotion, Normals, PenaltyContact, PenaltySettings, Stiffness,
    TraceFields,
};
use friction::{Exponential, Lagged};
use mesh::{Bar, Disk, FineZone, Grading, Padded, bar, disk, join};

fn main() {
    divan::main();
}

const RADIUS: f64 = 0.46;
const SPEED: f64 = 38.89;
const APPROACH: f64 = 104.1e-6;

/// The disk of the reference case over the bar, whose top is pressed to about a Hertzian patch by
/// giving either body half the overlap of the undeformed shapes.
struct Rolling {
    contact: PenaltyContact,
    reference: Vec<Padded>,
    displacement: Vec<Padded>,
    velocity: Vec<Padded>,
    fields: TraceFields,
    force: Vec<Padded>,
    disk_nodes: usize,
    dt: f64,
    steps: f64,
}

impl Rolling {
    fn new(size: f64) -> Self {
        let zone = FineZone {
            size,
            length: 80e-3,
            width: 20e-3,
            depth: 8e-3,
            start: -15e-3,
            growth: 1.4,
            coarsest: 20e-3,
            grading: Grading::Tensor,
        };
        let disk_shape = Disk { radius: RADIUS, hub_radius: 0.1, width: 60e-3, crown: None };
        let bar_shape =
            Bar { length: 0.24, width: 60e-3, height: 70e-3, crown: Some(0.3), start: -0.09 };
        let parts = [disk(&disk_shape, &zone), bar(&bar_shape, &zone)].map(|m| match m {
            Ok(mesh) => mesh,
            Err(error) => panic!("{error}"),
        });
        let disk_nodes = parts[0].nodes.len();
        let mesh = join(&parts);
        let steel = BodyMaterial { bulk_modulus: 175e9, density: 7800.0 };
        let settings = PenaltySettings {
            normal: Stiffness::Factor(0.1),
            tangential: Stiffness::Factor(0.1),
            damping: 0.1,
            curvature: true,
            normals: Normals::Averaged,
        };
        let law = Lagged(Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 });
        let surfaces =
            [(&mesh.bodies[0].surfaces["tread"], steel), (&mesh.bodies[1].surfaces["top"], steel)];
        let contact = match PenaltyContact::new(&mesh, surfaces, &settings, None, Box::new(law)) {
            Ok(contact) => contact,
            Err(error) => panic!("{error}"),
        };
        let n = mesh.nodes.len();
        let reference: Vec<Padded> = mesh.nodes.iter().copied().map(Padded::from).collect();
        let mut rolling = Self {
            fields: TraceFields::new(contact.trace(), &reference, &vec![1e5; n]),
            contact,
            reference,
            displacement: vec![Padded::ZERO; n],
            velocity: vec![Padded::ZERO; n],
            force: vec![Padded::ZERO; n],
            disk_nodes,
            dt: 0.67 * size / 6001.0,
            steps: 0.0,
        };
        rolling.advance();
        rolling.apply();
        rolling
    }

    /// Rolls on by one step: the rigid motion of the disk, flattened where it meets the bar.
    fn advance(&mut self) {
        self.steps += 1.0;
        let x = SPEED * self.dt * self.steps;
        let (s, c) = (1.002 * x / RADIUS).sin_cos();
        // Hertz's patch and its flanks: half the overlap less what the spring carries.
        for i in 0..self.reference.len() {
            let at = self.reference[i];
            let mut p = at.xyz();
            if i < self.disk_nodes {
                let z = at[2] - RADIUS;
                p = [c * at[0] + s * z + x, at[1], RADIUS + c * z - s * at[0] - APPROACH];
            }
            let (dx, y) = (p[0] - x, p[1]);
            let overlap = APPROACH - dx * dx / (2.0 * RADIUS) - y * y / 0.6;
            // Deformation brings the overlap down to 25 um in the patch, and opens the flanks.
            let give = 0.5 * (overlap - 25e-6 * (overlap / APPROACH - 0.45)).max(0.0);
            let depth = if i < self.disk_nodes { p[2] } else { -p[2] };
            let share = (1.0 - depth / 10e-3).clamp(0.0, 1.0);
            p[2] += if i < self.disk_nodes { give * share } else { -give * share };
            for k in 0..3 {
                let u = p[k] - at[k];
                self.velocity[i][k] = (u - self.displacement[i][k]) / self.dt;
                self.displacement[i][k] = u;
            }
        }
    }

    fn apply(&mut self) -> contact::ContactSums {
        let fields = &mut self.fields;
        fields.gather_positions(&self.displacement);
        fields.gather_velocities(&self.velocity);
        let contact: &mut dyn ContactStep = &mut self.contact;
        contact.follow(&fields.motion(0.0, self.dt));
        fields.gather_forces(contact.loaded().iter().copied(), &self.force);
        let step = fields.step(0.0, self.dt);
        let free = FreeMotion { velocity: &|_, _| [0.0; 3].into() };
        let sums = contact.apply(&step.motion, &free, step.force);
        fields.scatter_forces(contact.loaded().iter().copied(), &mut self.force);
        sums
    }
}

/// One call per step of a rolling disk, motion not timed, searches included as they fall due.
#[divan::bench(args = [2.0, 1.0, 0.5], sample_count = 400, sample_size = 1)]
fn rolling(bencher: divan::Bencher, millimetres: f64) {
    let mut rolling = Rolling::new(millimetres * 1e-3);
    let sums = rolling.apply();
    let searches = std::cell::Cell::new(0);
    let shared = std::cell::RefCell::new(&mut rolling);
    bencher.with_inputs(|| shared.borrow_mut().advance()).bench_local_refs(|()| {
        let sums = shared.borrow_mut().apply();
        searches.set(searches.get() + usize::from(sums.searched));
        sums.normal_force
    });
    println!(
        "  {} pairs closed, {:.0} kN, {} searches",
        sums.closed,
        sums.normal_force / 1e3,
        searches.get()
    );
}
