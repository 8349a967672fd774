//! Implicit steps: the theta method on velocities in the form of Moreau and Jean, with contact and friction at the end of the
//! step.
//!
//! With the mean velocity of a step, `w = (u^{n+1} - u^n)/dt = theta v^{n+1} + (1 - theta) v^n`, the method reads
//!
//! `M (w - v^n)/(theta dt) + f_int(u^n + theta dt w, w) = f + r`, `v^{n+1} = v^n + (w - v^n)/theta`
//!
//! (Jean 1999; Acary 2013). The contact forces r act over the whole step; the gap at its end and the slip velocity of w obey the
//! conditions of exact contact. With g^n >= 0 their work `dt r . G w` is never positive: contact feeds no energy. Elastic bodies lose
//! `(theta - 1/2)(|v^{n+1} - v^n|_M^2 + |u^{n+1} - u^n|_K^2)` in a step, nothing with theta = 1/2.
//!
//! The step is solved by Newton's method with the stiffness of the undeformed state, turned with the upper body, and conjugate
//! gradients; after each iteration contact corrects its forces (module `solve`). The hub takes part as a rigid body whose velocity over a step follows
//! from that over the step before and the forces of the step.

mod columns;
mod operator;
mod solve;

use crate::hub::{HubState, Resultant};
use crate::nodal_state::NodalState;
use crate::system::System;
use crate::unsolved::Effort;
use columns::{Columns, Rows};
use contact::ContactSums;
use mesh::Padded;
use operator::{Operator, Vectors};
use solid::linear::ConjugateGradients;
use std::collections::BTreeSet;

/// A step that is not solved is cut in halves, these again, so often.
pub(crate) const CUTS: usize = 4;

/// The implicit integrator: its parameter, and the arrays that it works with.
pub(crate) struct Implicit {
    pub(crate) theta: f64,
    operator: Operator,
    gradients: ConjugateGradients<Vectors>,
    /// Mean velocity over the step (m/s), that of the nodes of the hub too.
    pub(crate) w: Vec<Padded>,
    /// Displacement `u + theta dt w` (m).
    moved: Vec<Padded>,
    residual: Vectors,
    correction: Vectors,
    /// Compliance of the surfaces over the whole step, half of it, ...
    columns: Vec<Columns>,
    rows: Rows,
    pub(crate) effort: Effort,
}

impl Implicit {
    /// The integrator of a system with `theta` from 1/2 to 1.
    pub(crate) fn new(theta: f64, system: &System, nodes: &NodalState) -> Self {
        let n = nodes.displacement.len();
        let trace = system.contact.as_ref().map(|contact| contact.trace().clone());
        let centre = system.hub.as_ref().map(|hub| hub.centre);
        Self {
            theta,
            operator: Operator::new(system, nodes),
            gradients: ConjugateGradients::new(&Vectors::new(n)),
            w: vec![Padded::ZERO; n],
            moved: vec![Padded::ZERO; n],
            residual: Vectors::new(n),
            correction: Vectors::new(n),
            rows: Rows::new(&trace.unwrap_or_default(), system.solid.reference(), centre),
            columns: (0..=CUTS).map(|_| Columns::default()).collect(),
            effort: Effort::default(),
        }
    }

    /// `w . K w` of the mean velocity over the last step (W/s).
    pub(crate) fn stiffness_energy(&mut self, system: &mut System) -> f64 {
        self.operator.stiffness_energy(system, &mut self.w)
    }

    /// The nodes whose columns are in the count of products, of whole steps and of each cut.
    pub(crate) fn counted(&self) -> Vec<BTreeSet<u32>> {
        self.columns.iter().map(|columns| columns.counted.clone()).collect()
    }

    /// Takes over what an earlier part of the run counted.
    pub(crate) fn set_counted(&mut self, counted: &[BTreeSet<u32>]) {
        let of = self.columns.iter_mut().zip(counted);
        of.for_each(|(columns, counted)| columns.counted.clone_from(counted));
    }
}

/// A part of the run that is solved as one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// Where it begins (s).
    pub(crate) time: f64,
    /// How long it is (s).
    pub(crate) dt: f64,
    /// How often the step was cut to give it.
    pub(crate) cuts: usize,
}

/// What a solved step leaves.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Solved {
    pub(crate) contact: ContactSums,
    /// Power that viscous stresses, dashpots of the nodes and quiet ends dissipate (W).
    pub(crate) dissipated: f64,
    /// Power of given forces and of the reactions of the quiet ends (W).
    pub(crate) given: f64,
    /// On the hub, mass damping included.
    pub(crate) load: Resultant,
    pub(crate) hub: HubState,
}
