//! The solution of a static problem, by the method that its contact asks for.

use crate::error::StaticsError;
use crate::problem::{Contact, Equilibrium, Iteration, Problem};
use crate::springs::Springs;
use crate::{exact, newton, system::StaticSystem};
use mesh::Padded;
use solid::Solid;

/// Equilibrium of `solid` with `contact` from the displacements `start` (m).
///
/// Supports override `start`; nodes tied along a loaded axis start with their first node. `observe`
/// sees every iteration and returns false to stop.
///
/// The result does not depend on the number of threads.
///
/// # Errors
/// See [`StaticsError`].
///
/// # Panics
/// If `start` or `spin.mass` has fewer entries than the mesh has nodes, or `solid` and `contact`
/// belong to another mesh.
pub fn solve(
    solid: &mut Solid,
    contact: Contact<'_>,
    problem: &Problem<'_>,
    start: &[Padded],
    mut observe: impl FnMut(&Iteration) -> bool,
) -> Result<Equilibrium, StaticsError> {
    let mut system = StaticSystem::new(solid, problem)?;
    let start = system.admissible(start)?;
    match contact {
        Contact::None => newton::solve(&mut system, &mut Springs::new(None), start, &mut observe),
        Contact::Penalty(contact) => {
            newton::solve(&mut system, &mut Springs::new(Some(contact)), start, &mut observe)
        }
        Contact::Multipliers(gaps) => exact::solve(&mut system, gaps, start, &mut observe),
    }
}
