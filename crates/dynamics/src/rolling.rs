//! The velocity field at the start of rolling.

use mesh::{Mesh, Padded};
use nalgebra::Vector3;

/// What the rolling velocity field needs to know.
#[derive(Clone, Copy, Debug)]
pub struct RollingField {
    /// Index of the upper body among the bodies.
    pub upper: usize,
    /// Centre of the upper body in the reference configuration (m).
    pub centre: Vector3<f64>,
    /// Speed in x (m/s).
    pub speed: f64,
    /// Angular velocity about +y (rad/s).
    pub omega: f64,
    /// Time step (s): the field is that of half a step before t = 0.
    pub dt: f64,
}

/// Velocity of every node half a step before t = 0 (m/s): rigid motion plus the preload field that stays under
/// the contact while material flows through it.
///
/// With Y the rigidly moving reference position and the preload displacement u fixed in the frame
/// that travels with the hub, x = Y + u(Y): the upper body moves with v = V + (I + grad u) omega x Y
/// and the lower body, which flows backwards through its pattern, with v = -V du/dx. The half step back
/// takes off the centripetal acceleration of the upper body.
pub fn rolling_field(mesh: &Mesh, displacement: &[Padded], field: &RollingField) -> Vec<Padded> {
    let gradients = solid::nodal_gradients(mesh, displacement);
    let mut velocity = vec![Padded::ZERO; mesh.nodes.len()];
    for (index, body) in mesh.bodies.iter().enumerate() {
        for n in body.nodes.clone() {
            velocity[n] = if index == field.upper {
                let arm = mesh.nodes[n] - field.centre;
                let carrier = field.omega * Vector3::new(arm.z, 0.0, -arm.x);
                let back = 0.5 * field.dt * field.omega * field.omega;
                let moving = gradients[n] * carrier + carrier + field.speed * Vector3::x();
                (moving + back * Vector3::new(arm.x, 0.0, arm.z)).into()
            } else {
                (gradients[n] * Vector3::new(-field.speed, 0.0, 0.0)).into()
            };
        }
    }
    velocity
}
