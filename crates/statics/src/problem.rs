//! The static problem, and what its solution is.

use crate::supports::Supports;
use contact::{GapFunction, PenaltyContact};
use mesh::{Mesh, Padded};
use nalgebra::Vector3;
use std::ops::Range;

/// The contact of two bodies, without friction.
#[derive(Debug)]
pub enum Contact<'a> {
    /// None.
    None,
    /// The normal springs of penalty contact, in two passes, without damper and friction. They are
    /// left in the state of the solution.
    Penalty(&'a mut PenaltyContact),
    /// Lagrange multipliers: gap and pressure are complementary at every slave.
    Multipliers(&'a mut GapFunction),
}

/// The centrifugal force of a body that turns about y: m omega^2 times the distance from the axis.
#[derive(Clone, Debug)]
pub struct Spin<'a> {
    /// A point of the axis in the reference configuration (m).
    pub centre: Vector3<f64>,
    /// Angular velocity (rad/s).
    pub omega: f64,
    /// Nodes of the body.
    pub nodes: Range<usize>,
    /// Lumped masses of all nodes (kg).
    pub mass: &'a [f64],
    /// The group of tied nodes, by its place in [`Supports::tied`], that the axis moves with.
    pub hub: usize,
}

/// A static problem.
#[derive(Clone, Debug)]
pub struct Problem<'a> {
    /// The mesh of the solid.
    pub mesh: &'a Mesh,
    /// What holds and presses.
    pub supports: &'a Supports,
    /// Centrifugal force, if a body turns.
    pub spin: Option<Spin<'a>>,
    /// Residual over load at which the solution is accepted.
    pub tolerance: f64,
    /// Newton iterations after which it gives up.
    pub max_iterations: usize,
}

/// A look at the solution under way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Iteration {
    /// Newton iterations done.
    pub iteration: usize,
    /// Euclidean norm of the residual over the load; where nothing is loaded, over that of the
    /// largest forces met, those at supports included.
    pub residual: f64,
    /// Sum of the contact's normal forces (N).
    pub normal_force: f64,
    /// Contact points, pairs of a slave and its projection, closed.
    pub closed: usize,
    /// Conjugate-gradient iterations in the last step.
    pub cg_iterations: usize,
    /// Length of the last step over Newton's.
    pub step: f64,
}

/// What ended the iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The residual fell below the tolerance.
    Tolerance,
    /// The residual fell no further: the round-off of the forces.
    RoundOff,
}

/// How the solution went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonReport {
    /// The last state.
    pub last: Iteration,
    /// Conjugate-gradient iterations in all.
    pub cg_iterations: usize,
    /// What ended it.
    pub ending: Ending,
    /// The residual over the load once normals that had to be held follow the facets again; zero
    /// where none were held. Slaves over the edge of two facets, whose normals differ, cause it; it
    /// acts along the surface.
    pub facets: f64,
    /// Strain and hourglass energy (J).
    pub internal: f64,
}

/// An equilibrium.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// Displacements (m).
    pub displacement: Vec<Padded>,
    /// Forces on all nodes (N), contact included: minus the reaction at supports, else the
    /// residual.
    pub force: Vec<Padded>,
    /// Slaves under pressure by [`Contact::Multipliers`], ascending by node: gap and normal force (N).
    pub pressed: Vec<(contact::Gap, f64)>,
    /// How it went.
    pub report: NewtonReport,
}
