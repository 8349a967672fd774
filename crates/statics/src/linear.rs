//! Small displacements of the undeformed bodies under forces on their nodes.

use crate::error::StaticsError;
use crate::problem::{Iteration, Problem};
use crate::system::StaticSystem;
use mesh::Padded;
use solid::Solid;

/// The stiffness K of undeformed bodies that are held, ready for loads.
pub struct LinearStatics<'a>(StaticSystem<'a>);

impl<'a> LinearStatics<'a> {
    /// Of the bodies and supports of `problem`, whose loads and centrifugal force do not act.
    ///
    /// # Errors
    /// Supports that name nodes twice or that the mesh does not have, and bodies that they do not hold.
    pub fn new(solid: &'a mut Solid, problem: &'a Problem<'a>) -> Result<Self, StaticsError> {
        let mut system = StaticSystem::new(solid, problem)?;
        system.set_springs(Vec::new());
        Ok(Self(system))
    }

    /// The displacements u (m) of all nodes under forces f (N) on them, K u = f. Ends where the residual, in the norm of the
    /// preconditioner, has fallen by the tolerance of the problem.
    ///
    /// # Errors
    /// [`StaticsError::Linear`] and [`StaticsError::Flat`].
    ///
    /// # Panics
    /// If there is not one force for each node.
    pub fn displacement(&mut self, force: &[Padded]) -> Result<Vec<Padded>, StaticsError> {
        let (mut residual, mut displacement) = (force.to_vec(), vec![Padded::ZERO; force.len()]);
        let tolerance = self.0.problem.tolerance;
        self.0.step(&mut residual, &mut displacement, tolerance, &Iteration::default())?;
        Ok(displacement)
    }
}
