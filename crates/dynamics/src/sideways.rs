//! What moves the hub sideways: it drifts, or turns about the vertical and rolls along a curve.

use crate::ramp::smoothstep;

/// Lateral creepage and spin of the hub, both rising by a smoothstep.
///
/// A body that turned about the vertical on a straight path would creep laterally the more, the further it has turned. So the
/// hub follows its heading: its path is an arc, and the turn is spin alone.
///
/// The patch stays where the surfaces are parallel across. On a crowned lower body that is behind the upper body as it drifts, by the share
/// `behind` of the drift. The speed is prescribed there, so that the upper body turns about the vertical through the patch, and the
/// creepage does not change as it drifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sideways {
    /// Speed V along the heading, where the patch is (m/s).
    pub speed: f64,
    /// Lateral velocity over V (dimensionless), positive to the left of the heading: towards +y at the start.
    pub lateral_creepage: f64,
    /// Angular velocity about +z over V (rad/m): the curvature of the path.
    pub spin: f64,
    /// Duration of the ramp of both (s).
    pub ramp: f64,
    /// How far the patch lies behind the middle of the upper body, over the drift: curvature of the lower body across over that of both
    /// bodies; 1 for an upper body that is flat across, 0 for such a lower one.
    pub behind: f64,
}

impl Sideways {
    /// Velocity in x and y (m/s) and angular velocity about +z (rad/s) at the time `half` (s), half a step `dt` (s) after
    /// the hub had drifted by `y` (m) and turned to `heading` (rad).
    pub(crate) fn velocities(&self, [y, heading]: [f64; 2], half: f64, dt: f64) -> [f64; 3] {
        let share = smoothstep(half, self.ramp);
        let turning = share * self.spin * self.speed;
        let (sin, cos) = libm::sincos(heading + 0.5 * dt * turning);
        let along = self.speed - turning * self.behind * y;
        let across = share * self.lateral_creepage * self.speed;
        [along * cos - across * sin, along * sin + across * cos, turning]
    }
}
