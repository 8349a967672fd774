//! Two bodies moved by hand against one another.
#![allow(clippy::unwrap_used)]

mod curvature;
mod dent;
mod every_enforcement;
mod exact;
mod implicit;
mod normal;
pub(crate) mod plates;
mod search;
mod slip;

use self::plates::{STEEL, plate, together};
use crate::{
    Contact, ContactSums, FreeMotion, Normals, PenaltyContact, PenaltySettings, Stiffness,
    TraceFields, TraceStep,
};
use friction::NodeFriction;
use mesh::{Mesh, Padded, Surface};
use nalgebra::Vector3;

/// Areal stiffness of both passes together (N/m^3).
pub(crate) const K: f64 = 2e13;

pub(crate) const SETTINGS: PenaltySettings = PenaltySettings {
    normal: Stiffness::Areal(K),
    tangential: Stiffness::Areal(0.7 * K),
    damping: 0.0,
    curvature: true,
    normals: Normals::Averaged,
};

/// Body 0 above (side 0), body 1 below (side 1), both with prescribed motion.
pub(crate) struct Rig {
    pub contact: PenaltyContact,
    /// Nodes of body 0 come first.
    pub upper: usize,
    pub reference: Vec<Padded>,
    pub displacement: Vec<Padded>,
    pub velocity: Vec<Padded>,
    pub inverse_mass: Vec<f64>,
    pub force: Vec<Padded>,
    pub dt: f64,
}

impl Rig {
    pub fn new(
        upper: (Mesh, Surface),
        lower: (Mesh, Surface),
        settings: &PenaltySettings,
        law: impl NodeFriction + 'static,
    ) -> Self {
        let count = upper.0.nodes.len();
        let (mesh, second) = together(upper.0, lower.0, lower.1);
        let surfaces = [(&upper.1, STEEL), (&second, STEEL)];
        let contact = PenaltyContact::new(&mesh, surfaces, settings, None, Box::new(law)).unwrap();
        let n = mesh.nodes.len();
        Self {
            contact,
            upper: count,
            reference: mesh.nodes.iter().copied().map(Padded::from).collect(),
            displacement: vec![Padded::ZERO; n],
            velocity: vec![Padded::ZERO; n],
            inverse_mass: vec![1e3; n],
            force: vec![Padded::ZERO; n],
            dt: 1e-7,
        }
    }

    /// Square plates of 8 mm: `fine` cells above, `coarse` below.
    pub fn plates(fine: usize, coarse: usize, law: impl NodeFriction + 'static) -> Self {
        Self::new(
            plate([0.0, 0.0], [8e-3, 8e-3], [fine, fine], 0.0, 1e-3, false),
            plate([0.0, 0.0], [8e-3, 8e-3], [coarse, coarse], 0.0, 1e-3, true),
            &SETTINGS,
            law,
        )
    }

    /// A plate of 4 mm on a longer one with other cells.
    pub fn slider(law: impl NodeFriction + 'static, settings: &PenaltySettings) -> Self {
        Self::new(
            plate([2.3e-3, 2.1e-3], [6.3e-3, 6.1e-3], [5, 5], 0.0, 1e-3, false),
            plate([0.0, 0.0], [20e-3, 8e-3], [23, 9], 0.0, 1e-3, true),
            settings,
            law,
        )
    }

    /// Moves every node to `place(body, X)` in one step and applies contact.
    pub fn step(&mut self, place: impl Fn(usize, Vector3<f64>) -> Vector3<f64>) -> ContactSums {
        for (i, x) in self.reference.iter().enumerate() {
            let u = place(usize::from(i >= self.upper), x.vector()) - x.vector();
            self.velocity[i] = ((u - self.displacement[i].vector()) / self.dt).into();
            self.displacement[i] = u.into();
        }
        self.apply()
    }

    /// Shifts the upper body to `by`.
    pub fn shift(&mut self, by: impl Into<Vector3<f64>>) -> ContactSums {
        let by = by.into();
        self.step(|body, x| if body == 0 { x + by } else { x })
    }

    pub fn apply(&mut self) -> ContactSums {
        let mut fields = self.fields();
        let step = fields.step(0.0, self.dt);
        let sums = self.contact.apply(&step.motion, step.force);
        self.take_forces(&fields);
        sums
    }

    /// The same with the normal springs alone.
    pub fn apply_frictionless(&mut self) -> ContactSums {
        let mut fields = self.fields();
        let step = fields.step(0.0, self.dt);
        let sums = self.contact.apply_frictionless(step.motion.position, step.force);
        self.take_forces(&fields);
        sums
    }

    fn fields(&self) -> TraceFields {
        let mut fields = TraceFields::new(&self.contact.trace, &self.reference, &self.inverse_mass);
        fields.gather_positions(&self.displacement);
        fields.gather_velocities(&self.velocity);
        fields
    }

    fn take_forces(&mut self, fields: &TraceFields) {
        self.force.fill(Padded::ZERO);
        fields.scatter_forces(fields.all(), &mut self.force);
    }
}

/// A step of masses without springs at a time and with a step (s): `force` on the nodes of the mesh (N) gets that of
/// contact, `motion` are their reference positions, displacements and velocities. Contact may neither ask for nor
/// change the force on a node of the trace that it does not name.
fn step_on_trace(
    contact: &mut dyn Contact,
    motion: [&[Padded]; 3],
    inverse_mass: &[f64],
    [time, dt]: [f64; 2],
    force: &mut [Padded],
) -> ContactSums {
    let [reference, displacement, velocity] = motion;
    let mut fields = TraceFields::new(contact.trace(), reference, inverse_mass);
    fields.gather_positions(displacement);
    fields.gather_velocities(velocity);
    contact.follow(&fields.motion(time, dt));
    let loaded = contact.loaded().to_vec();
    fields.step(time, dt).force.fill(Padded([f64::NAN; 4]));
    fields.gather_forces(loaded.iter().copied(), force);
    let TraceStep { motion, force: on_trace, .. } = fields.step(time, dt);
    let free = |node: u32, force: Vector3<f64>| {
        let i = node as usize;
        motion.velocity[i].vector() + dt * motion.inverse_mass[i] * force
    };
    let sums = contact.apply(&motion, &FreeMotion { velocity: &free }, on_trace);
    for (node, f) in on_trace.iter().enumerate() {
        assert!(loaded.contains(&(node as u32)) || f.0.iter().all(|c| c.is_nan()), "{node}: {f:?}");
    }
    fields.scatter_forces(loaded.into_iter(), force);
    sums
}
