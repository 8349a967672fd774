//! Two bodies moved by hand against one another.
#![allow(clippy::unwrap_used)]

mod curvature;
mod every_enforcement;
mod exact;
mod normal;
mod search;
mod slip;

use crate::plates::{STEEL, plate, together};
use crate::vector::{Vec3, add, sub};
use crate::{ContactSums, Motion, PenaltyContact, PenaltySettings, PenaltyStiffness};
use friction::NodeFriction;
use mesh::{Mesh, Padded, Surface};

/// Areal stiffness of both passes together (N/m^3).
pub(crate) const K: f64 = 2e13;

pub(crate) const SETTINGS: PenaltySettings = PenaltySettings {
    normal: PenaltyStiffness::Areal(K),
    tangential: PenaltyStiffness::Areal(0.7 * K),
    damping: 0.0,
    curvature: true,
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
            reference: mesh.nodes.iter().map(|&x| Padded::new(x)).collect(),
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
    pub fn step(&mut self, place: impl Fn(usize, Vec3) -> Vec3) -> ContactSums {
        for (i, x) in self.reference.iter().enumerate() {
            let u = sub(place(usize::from(i >= self.upper), x.xyz()), x.xyz());
            let moved = sub(u, self.displacement[i].xyz());
            self.velocity[i] = Padded::new(moved.map(|d| d / self.dt));
            self.displacement[i] = Padded::new(u);
        }
        self.apply()
    }

    /// Shifts the upper body to `by`.
    pub fn shift(&mut self, by: Vec3) -> ContactSums {
        self.step(|body, x| if body == 0 { add(x, by) } else { x })
    }

    pub fn apply(&mut self) -> ContactSums {
        self.force.fill(Padded::ZERO);
        let motion = Motion {
            reference: &self.reference,
            displacement: &self.displacement,
            velocity: &self.velocity,
            inverse_mass: &self.inverse_mass,
            time: 0.0,
            dt: self.dt,
        };
        self.contact.apply(&motion, &mut self.force)
    }
}
