//! The velocity field at the start of rolling.

use mesh::{Face, Mesh, Padded};
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
            let at = At { index, node: mesh.nodes[n] };
            velocity[n] = field.velocity(at, gradients[n] * field.flow(at));
        }
    }
    velocity
}

/// [`rolling_field`] of bodies of unlike materials: at the nodes of `surfaces`, the faces of each body, u is differentiated
/// along the surface.
///
/// Gradients of elements are those half an element deep, where the strain along x below Hertz's line contact is larger by
/// (1 - nu^2) p0 h/(E a) than at the surface (Johnson 1985, section 4.2). In bodies of one material that is the same and no
/// slip comes of it. With aluminium on steel and ten elements in a it is a fifth of the slip.
pub fn rolling_field_of_unlike(
    mesh: &Mesh,
    surfaces: [&[Face]; 2],
    displacement: &[Padded],
    field: &RollingField,
) -> Vec<Padded> {
    let mut velocity = rolling_field(mesh, displacement, field);
    for (index, faces) in surfaces.into_iter().enumerate() {
        let at = |n: u32| At { index, node: mesh.at(n) };
        let moved = solid::surface_derivatives(mesh, faces, displacement, |n| field.flow(at(n)));
        for (n, moved) in moved {
            velocity[n as usize] = field.velocity(at(n), moved);
        }
    }
    velocity
}

/// A node of a body.
#[derive(Clone, Copy)]
struct At {
    /// Index of the body among the bodies.
    index: usize,
    /// Where the node is in the reference configuration (m).
    node: Vector3<f64>,
}

impl RollingField {
    /// Velocity (m/s) at which the undeformed material flows through the pattern that travels with the hub, but for that of
    /// the hub.
    fn flow(&self, at: At) -> Vector3<f64> {
        if at.index != self.upper {
            return Vector3::new(-self.speed, 0.0, 0.0);
        }
        let arm = at.node - self.centre;
        self.omega * Vector3::new(arm.z, 0.0, -arm.x)
    }

    /// Velocity of a node (m/s), where the displacement has the derivative `moved` (m/s) along the flow.
    fn velocity(&self, at: At, moved: Vector3<f64>) -> Padded {
        if at.index != self.upper {
            return moved.into();
        }
        let arm = at.node - self.centre;
        let back = 0.5 * self.dt * self.omega * self.omega;
        let moving = moved + self.flow(at) + self.speed * Vector3::x();
        (moving + back * Vector3::new(arm.x, 0.0, arm.z)).into()
    }
}
