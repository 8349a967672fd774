//! The centrifugal force of a body in a frame that turns with it.

use mesh::Padded;

/// A turn about an axis along y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Centrifugal {
    /// Where the axis is in x and z (m).
    pub axis: [f64; 2],
    /// Angular velocity (rad/s).
    pub omega: f64,
}

impl Centrifugal {
    /// The force `m omega^2 r` (N) on a mass (kg) at the position `reference + displacement` (m), at the distance `r`
    /// from the axis.
    #[inline]
    pub fn force(&self, mass: f64, reference: Padded, displacement: Padded) -> Padded {
        let pull = mass * (self.omega * self.omega);
        let along = |i: usize, axis: f64| pull * (reference[i] + displacement[i] - axis);
        Padded::new([along(0, self.axis[0]), 0.0, along(2, self.axis[1])])
    }
}
