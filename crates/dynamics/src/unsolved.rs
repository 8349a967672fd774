//! What implicit steps took, and what is said of one that was not solved.

/// A step that was not solved, not even in 16 parts.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Unsolved {
    /// The part of the step that was tried last (s).
    pub step: f64,
    /// Newton iterations taken.
    pub iterations: usize,
    /// Norm of the residual over that of the forces (dimensionless).
    pub residual: f64,
    /// Change of a contact force in the last iteration over the largest (dimensionless).
    pub change: f64,
}

/// What implicit steps took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Effort {
    /// Steps solved, parts of cut steps counted one by one.
    pub solved: usize,
    /// Parts that were not solved, and cut.
    pub cut: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Products with the stiffness in all of conjugate gradients, but for what a resumed run does a second time.
    pub products: usize,
}
