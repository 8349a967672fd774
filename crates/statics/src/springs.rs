//! The normal springs of penalty contact in equilibrium: their forces, and their part of the tangent.

use crate::link::Link;
use contact::{ContactStep, PenaltyContact};
use mesh::Padded;

/// What the normal springs did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pressed {
    /// Sum of their forces (N).
    pub(crate) normal_force: f64,
    /// How many are closed.
    pub(crate) closed: usize,
}

/// Springs (N/m) with their projections and normals as they were at the displacements `at`, where the gaps
/// were `gaps` (m).
struct HeldSprings {
    springs: Vec<(Link, f64)>,
    gaps: Vec<f64>,
    at: Vec<Padded>,
}

impl HeldSprings {
    /// Each spring, its stiffness (N/m) and its gap (m) at `u`.
    fn at<'a>(&'a self, u: &'a [Padded]) -> impl Iterator<Item = (&'a (Link, f64), f64)> + 'a {
        self.springs.iter().zip(&self.gaps).map(move |(spring, gap)| {
            (spring, gap + spring.0.opening(u) - spring.0.opening(&self.at))
        })
    }
}

/// The springs of a contact; none without one.
pub(crate) struct Springs<'a> {
    contact: Option<&'a mut PenaltyContact>,
    /// Projections and normals that are held.
    held: Option<HeldSprings>,
}

impl<'a> Springs<'a> {
    pub(crate) fn new(contact: Option<&'a mut PenaltyContact>) -> Self {
        Self { contact, held: None }
    }

    /// Adds the forces at `u`.
    pub(crate) fn add_force(
        &mut self,
        reference: &[Padded],
        u: &[Padded],
        force: &mut [Padded],
    ) -> Pressed {
        let mut pressed = Pressed::default();
        if let Some(held) = &self.held {
            for ((link, k), gap) in held.at(u).filter(|(_, gap)| *gap < 0.0) {
                link.push(-k * gap, force);
                pressed.normal_force -= k * gap;
                pressed.closed += 1;
            }
        } else if let Some(contact) = &mut self.contact {
            contact.expect_jump();
            let trace = contact.trace();
            let (position, mut on_trace) = (trace.positions(reference, u), trace.gather(force));
            let sums = contact.apply_frictionless(&position, &mut on_trace);
            contact.trace().scatter(&on_trace, force);
            (pressed.normal_force, pressed.closed) = (sums.normal_force, sums.closed);
        }
        pressed
    }

    /// Those closed at `u`, where the forces were added last, with their stiffness (N/m).
    pub(crate) fn closed(&self, u: &[Padded]) -> Vec<(Link, f64)> {
        match (&self.held, &self.contact) {
            (Some(held), _) => {
                held.at(u).filter(|(_, gap)| *gap < 0.0).map(|(s, _)| s.clone()).collect()
            }
            (None, Some(contact)) => {
                contact.springs().map(|(gap, k)| (Link::new(&gap), k)).collect()
            }
            (None, None) => Vec::new(),
        }
    }

    /// Holds projections and normals of those closed at the last evaluation, that of `u`.
    pub(crate) fn hold(&mut self, u: &[Padded]) {
        let springs = self.contact.iter().flat_map(|c| c.springs());
        let (springs, gaps) = springs.map(|(g, k)| ((Link::new(&g), k), g.gap)).unzip();
        self.held = Some(HeldSprings { springs, gaps, at: u.to_vec() });
    }

    /// Whether projections and normals are held.
    pub(crate) fn are_held(&self) -> bool {
        self.held.is_some()
    }

    /// Lets projections and normals go.
    pub(crate) fn release(&mut self) {
        self.held = None;
    }
}
