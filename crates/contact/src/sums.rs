//! Sums over the contact, which do not depend on the order of its points.

use exact_sum::ExactSum;
use nalgebra::Vector3;

/// Sums over the contact at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactSums {
    /// Resultant of the forces applied to the nodes of each side (N).
    pub force: [Vector3<f64>; 2],
    /// Sum of the normal forces of all contact points of both passes (N).
    pub normal_force: f64,
    /// Energy stored in the normal springs (J).
    pub stored_normal: f64,
    /// Energy stored in the friction springs (J).
    pub stored_tangential: f64,
    /// Work dissipated by friction in the step that ended at `x^n` (J).
    pub friction_work: f64,
    /// Work dissipated by the normal dampers in that step, and the energy of the normal springs of
    /// nodes that slid off the border of the other surface (J).
    pub damping_work: f64,
    /// Work that friction dissipates in the step that leaves `x^n` (J), of a method that knows it.
    pub friction_ahead: f64,
    /// What else contact dissipates in that step (J).
    pub damping_ahead: f64,
    /// Sweeps over the contact nodes that exact enforcement took.
    pub sweeps: usize,
    /// Change of a force in the last sweep over the largest force (dimensionless), where the sweeps ended at their limit
    /// before forces had converged; else 0.
    pub unconverged: f64,
    /// Slave nodes at which the law of friction had more than one solution.
    pub non_unique: usize,
    /// How steeply friction falls with slip velocity over how much slip velocity a force makes in an implicit step: at a node
    /// alone, the largest of all, and of all nodes together (dimensionless, `R`). Below 1 the step has one solution.
    pub steepness: [f64; 2],
    /// Mortar constraints whose integrals were taken in this step.
    pub integrated: usize,
    /// Contact points in contact.
    pub closed: usize,
    /// Contact points that stick.
    pub sticking: usize,
    /// Contact points that slip.
    pub slipping: usize,
    /// Largest penetration (m).
    pub max_penetration: f64,
    /// Largest coefficient of friction that the law gave; NaN where it gave none.
    pub largest_mu: f64,
    /// Whether the search was refreshed.
    pub searched: bool,
}

impl ContactSums {
    /// Those of bodies made of `multiplicity` parts alike, of which these are the sums of one. Counts are of the whole surfaces
    /// already. The lateral forces of mirror images cancel; here they stand as if they did not, so that action and
    /// reaction can be compared.
    pub fn times(self, multiplicity: f64) -> Self {
        Self {
            force: self.force.map(|force| multiplicity * force),
            normal_force: multiplicity * self.normal_force,
            stored_normal: multiplicity * self.stored_normal,
            stored_tangential: multiplicity * self.stored_tangential,
            friction_work: multiplicity * self.friction_work,
            damping_work: multiplicity * self.damping_work,
            friction_ahead: multiplicity * self.friction_ahead,
            damping_ahead: multiplicity * self.damping_ahead,
            ..self
        }
    }
}

/// Accumulates [`ContactSums`].
pub(crate) struct Accumulator {
    /// Forces on the nodes of each side.
    pub(crate) force: [[ExactSum; 3]; 2],
    pub(crate) normal_force: ExactSum,
    pub(crate) stored_normal: ExactSum,
    pub(crate) stored_tangential: ExactSum,
    pub(crate) friction_work: ExactSum,
    pub(crate) damping_work: ExactSum,
    pub(crate) friction_ahead: ExactSum,
    pub(crate) damping_ahead: ExactSum,
    /// What is counted or the largest of all: no order matters to it.
    pub(crate) other: ContactSums,
}

impl Accumulator {
    pub(crate) fn new(searched: bool) -> Self {
        Self {
            force: [[ExactSum::ZERO; 3]; 2],
            normal_force: ExactSum::ZERO,
            stored_normal: ExactSum::ZERO,
            stored_tangential: ExactSum::ZERO,
            friction_work: ExactSum::ZERO,
            damping_work: ExactSum::ZERO,
            friction_ahead: ExactSum::ZERO,
            damping_ahead: ExactSum::ZERO,
            other: ContactSums { searched, ..ContactSums::default() },
        }
    }

    /// Takes a force on a node of `side` (N) into the resultant.
    pub(crate) fn push(&mut self, side: usize, force: Vector3<f64>) {
        self.force[side].iter_mut().zip(&force).for_each(|(sum, f)| sum.add(*f));
    }

    /// Takes a coefficient of friction into the largest; one that is no number stays.
    pub(crate) fn meet(&mut self, mu: f64) {
        let largest = &mut self.other.largest_mu;
        if mu.is_nan() || mu > *largest {
            *largest = mu;
        }
    }

    pub(crate) fn finish(self) -> ContactSums {
        ContactSums {
            force: self.force.map(|side| side.map(|f| f.value()).into()),
            normal_force: self.normal_force.value(),
            stored_normal: self.stored_normal.value(),
            stored_tangential: self.stored_tangential.value(),
            friction_work: self.friction_work.value(),
            damping_work: self.damping_work.value(),
            friction_ahead: self.friction_ahead.value(),
            damping_ahead: self.damping_ahead.value(),
            sticking: self.other.closed - self.other.slipping,
            ..self.other
        }
    }
}
