//! A mesh that follows the patch.
//!
//! The fine zone of either body is a few patches long. The mesh of the lower body moves ahead along it by a length
//! of the pattern of its zone when the hub has passed it by half of that; the mesh of the upper body turns back against the body by
//! the angle of the same length when that has turned by half of that. Each node then takes over the motion of the material
//! where it is now: that of the node that was there, as it is, or what a quadratic fit to the nodes around gives.
//! Coordinates move with the mesh: the origin goes ahead, and the hub falls back by the same length. What is stored of the
//! reference configuration, such as masses and gradients, is that of the mesh and stays.
//!
//! The upper body turns through its mesh. Its motion is the rigid motion of the hub and a rest. The rest is interpolated, by its
//! components along the radius, across, and around the axis. The nodes that interpolate then receive a small rigid motion, so
//! that the momentum of the rest and its moment are what they were. The rigid motion itself needs no such correction: the
//! hub balances the upper body in either place of the mesh (module `hub`).
//!
//! Displacements receive besides what their sources miss of those at rest ([`Missed`](crate::Missed)).
//!
//! Material that enters the lower body has the motion of its front end. The ledger books what the move brings or takes.

use crate::hub::HubState;
use crate::load::Fixed;
use crate::simulation::Simulation;
use crate::state::RestoreError;
use crate::window::{MeshMove, Window};
use contact::Renumbering;
use exact_sum::ExactSum;
use mesh::{Padded, Source};
use nalgebra::Vector3;
use std::ops::Range;

/// What a move of the mesh did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moved {
    /// Slaves in contact whose place has no node of the fine zone any more, or lies on no face of it: their contact is lost.
    pub lost: usize,
}

impl Simulation {
    /// Lets the mesh follow the patch from now on.
    pub fn set_window(&mut self, window: Window) {
        self.window = Some(window);
    }

    /// Moves the meshes if the hub has passed half of their next move. To be called before a step; that step must read the
    /// energies.
    ///
    /// # Errors
    /// None but by a fault of the program: the state is set aside and taken up again.
    pub fn move_window(&mut self) -> Result<Option<Moved>, RestoreError> {
        let Some(hub) = self.system.hub.as_ref().map(|hub| hub.state) else { return Ok(None) };
        let Some(window) = self.window.take() else { return Ok(None) };
        let turns = hub.angle > 0.5 * window.upper.by;
        let advances = hub.x > 0.5 * window.lower.by;
        let mut moved = None;
        if turns || advances {
            self.gather();
            let (before, [upper, lower]) = self.present()?;
            let mut lost = 0;
            if turns {
                lost += self.turn(&window, upper);
            }
            if advances {
                lost += self.advance(&window, lower);
            }
            Fixed::clear(&self.system.fixed, &mut self.nodes.displacement);
            Fixed::clear(&self.system.fixed, &mut self.nodes.velocity);
            self.ledger.expect(before);
            self.share_state()?;
            moved = Some(Moved { lost });
        }
        self.window = Some(window);
        Ok(moved)
    }

    /// What the energies at the present state have beyond the external work (J), as its step would read them, and the
    /// forces of contact on both bodies then (N).
    fn present(&mut self) -> Result<(f64, [Vector3<f64>; 2]), RestoreError> {
        let state = self.snapshot();
        let report = self.step(true);
        self.restore(&state)?;
        let read = report.energies.unwrap_or_default();
        let multiplicity = self.system.multiplicity;
        let force = report.contact.force.map(|force| force / multiplicity);
        Ok((read.total() - read.external_work, force))
    }

    /// Renumbers the contact after a move of one body.
    fn renumber(&mut self, range: &Range<usize>, successors: &[Option<u32>]) -> usize {
        let successor = |node: u32| {
            let node = node as usize;
            if range.contains(&node) { successors[node - range.start] } else { Some(node as u32) }
        };
        let renumbering = Renumbering { successor: &successor, origin: self.travel.x };
        let lost = self.system.contact.as_mut().map_or(0, |contact| contact.renumber(renumbering));
        self.take_heights();
        lost
    }

    /// Takes the heights of irregular surfaces where the meshes are now.
    pub(crate) fn take_heights(&mut self) {
        if let Some(trace) = &mut self.nodes.trace {
            trace.of_material([self.travel.angle, self.travel.x]);
        }
    }

    /// Moves the mesh of the lower body ahead.
    fn advance(&mut self, window: &Window, force: Vector3<f64>) -> usize {
        let MeshMove { nodes, sources, by, missed } = &window.lower;
        let missed = missed.under([force.x, force.z, 0.0]);
        let (u, v) = (&mut self.nodes.displacement, &mut self.nodes.velocity);
        let placed = sources.iter().zip(missed);
        let placed = placed.map(|(source, missed)| sum(source.of(|n| u[n as usize]), missed));
        let placed: Vec<Padded> = placed.collect();
        let moving: Vec<Padded> =
            sources.iter().map(|source| source.of(|n| v[n as usize])).collect();
        u[nodes.clone()].copy_from_slice(&placed);
        v[nodes.clone()].copy_from_slice(&moving);
        for &n in &self.system.held {
            self.nodes.displacement[n as usize] = Padded::ZERO;
            self.nodes.velocity[n as usize] = Padded::ZERO;
        }
        self.nodes.displacement[window.upper.nodes.clone()].iter_mut().for_each(|u| u[0] -= by);
        if let Some(hub) = &mut self.system.hub {
            hub.state.x -= by;
        }
        self.travel.x += by;
        self.renumber(nodes, &window.successors[1])
    }

    /// Turns the mesh of the upper body back against the body.
    fn turn(&mut self, window: &Window, force: Vector3<f64>) -> usize {
        let MeshMove { nodes, sources, by, missed } = &window.upper;
        let Some(hub) = &mut self.system.hub else { return 0 };
        // at the lowest point of the upper body, outward is down
        let missed = missed.under([force.x, -force.z, hub.state.omega * hub.state.omega]);
        let reference = self.system.solid.reference();
        let (from, to) = (hub.state, HubState { angle: hub.state.angle - by, ..hub.state });
        let [from, to] = [from, to].map(|state| Carrier::new(hub.centre, state));
        let (u, v) = (&mut self.nodes.displacement, &mut self.nodes.velocity);
        let free = |n: usize| self.nodes.inverse_mass[n] > 0.0;
        let mass = &self.system.mass;
        let momentum = |u: &[Padded], v: &[Padded]| {
            let upper = nodes.clone().filter(|&n| free(n));
            momentum_of(upper.map(|n| {
                let (arm, rigid) =
                    (to.arm(reference[n], u[n]), to.rigid_velocity(reference[n], u[n]));
                (mass[n], arm, [v[n][0] - rigid[0], v[n][2] - rigid[1]])
            }))
        };
        let before = momentum(u, v);
        let mut interpolated = Vec::new();
        let mut carried_over = Vec::with_capacity(sources.len());
        for (n, (source, missed)) in nodes.clone().zip(sources.iter().zip(missed)) {
            if matches!(source, Source::Between { .. }) && free(n) {
                interpolated.push(n);
            }
            let elastic = |m: u32| from.elastic(reference[m as usize], u[m as usize]);
            let place = to.placed(reference[n], sum(source.of(elastic), missed));
            let moving = |m: u32| {
                let m = m as usize;
                from.relative(reference[m], u[m], v[m])
            };
            let velocity = to.moving(reference[n], place, source.of(moving));
            carried_over.push((place, velocity));
        }
        for (n, (place, velocity)) in nodes.clone().zip(carried_over) {
            (u[n], v[n]) = (place, velocity);
        }
        let gained = momentum(u, v) - before;
        let carriers = interpolated.iter().map(|&n| (mass[n], to.arm(reference[n], u[n])));
        if let Some([ax, az, alpha]) = rigid_motion(gained, carriers) {
            for &n in &interpolated {
                let [x, z] = to.arm(reference[n], u[n]);
                v[n][0] -= ax + alpha * z;
                v[n][2] -= az - alpha * x;
            }
        }
        hub.turn_back(*by, self.dt, u, v);
        self.travel.angle += by;
        self.renumber(nodes, &window.successors[0])
    }
}

fn sum(a: Padded, b: Padded) -> Padded {
    Padded::from(a.vector() + b.vector())
}

/// The hub's rigid motion, which carries the upper body.
struct Carrier {
    centre: Vector3<f64>,
    state: HubState,
    sin: f64,
    cos: f64,
}

impl Carrier {
    fn new(centre: Vector3<f64>, state: HubState) -> Self {
        let (sin, cos) = libm::sincos(state.angle);
        Self { centre, state, sin, cos }
    }

    /// Arm of a point that moves with the hub, from its centre in x and z (m).
    fn rigid_arm(&self, reference: Padded) -> [f64; 2] {
        let (x, z) = (reference[0] - self.centre[0], reference[2] - self.centre[2]);
        [self.cos * x + self.sin * z, self.cos * z - self.sin * x]
    }

    /// Arm of a displaced point from the hub's centre in x and z (m).
    fn arm(&self, reference: Padded, u: Padded) -> [f64; 2] {
        let arm = |i: usize, moved: f64| reference[i] + u[i] - self.centre[i] - moved;
        [arm(0, self.state.x), arm(2, self.state.z)]
    }

    /// Components of a vector around the axis, across and along the radius, at the place of a point that moves with the hub.
    fn polar(&self, reference: Padded, [x, y, z]: [f64; 3]) -> Padded {
        let [sin, cos] = direction(self.rigid_arm(reference));
        Padded::new([z * sin - x * cos, y, x * sin + z * cos])
    }

    /// The vector of such components.
    fn cartesian(&self, reference: Padded, polar: Padded) -> [f64; 3] {
        let [sin, cos] = direction(self.rigid_arm(reference));
        let [around, y, radial] = polar.xyz();
        [radial * sin - around * cos, y, radial * cos + around * sin]
    }

    /// Polar components of the displacement beyond the hub's (m).
    fn elastic(&self, reference: Padded, u: Padded) -> Padded {
        let (now, rigid) = (self.arm(reference, u), self.rigid_arm(reference));
        self.polar(reference, [now[0] - rigid[0], u[1], now[1] - rigid[1]])
    }

    /// The displacement (m) with these polar components beyond the hub's.
    fn placed(&self, reference: Padded, elastic: Padded) -> Padded {
        let [x, y, z] = self.cartesian(reference, elastic);
        let rigid = self.rigid_arm(reference);
        let place = |i: usize, arm: f64, moved: f64| self.centre[i] + moved + arm - reference[i];
        Padded::new([place(0, rigid[0] + x, self.state.x), y, place(2, rigid[1] + z, self.state.z)])
    }

    /// The hub's velocity at a displaced point (m/s), in x and z.
    fn rigid_velocity(&self, reference: Padded, u: Padded) -> [f64; 2] {
        let [x, z] = self.arm(reference, u);
        [self.state.vx + self.state.omega * z, self.state.vz - self.state.omega * x]
    }

    /// Polar components of the velocity beyond the hub's (m/s).
    fn relative(&self, reference: Padded, u: Padded, v: Padded) -> Padded {
        let [x, z] = self.rigid_velocity(reference, u);
        self.polar(reference, [v[0] - x, v[1], v[2] - z])
    }

    /// The velocity (m/s) with these polar components beyond the hub's.
    fn moving(&self, reference: Padded, u: Padded, relative: Padded) -> Padded {
        let [x, z] = self.rigid_velocity(reference, u);
        let [rx, ry, rz] = self.cartesian(reference, relative);
        Padded::new([rx + x, ry, rz + z])
    }
}

/// Unit vector along an arm.
fn direction([x, z]: [f64; 2]) -> [f64; 2] {
    let length = libm::hypot(x, z);
    [x / length, z / length]
}

/// Momentum in x and z, and its moment about y through the hub's centre (N s, N m s), of masses (kg) with arms (m) and
/// velocities (m/s).
fn momentum_of(bodies: impl Iterator<Item = (f64, [f64; 2], [f64; 2])>) -> Vector3<f64> {
    let mut sum = [ExactSum::ZERO; 3];
    for (m, [x, z], [vx, vz]) in bodies {
        sum[0].add(m * vx);
        sum[1].add(m * vz);
        sum[2].add(m * (z * vx - x * vz));
    }
    sum.map(|s| s.value()).into()
}

/// The rigid motion, velocity in x and z and angular velocity, with which masses at these arms have this momentum.
fn rigid_motion(
    momentum: Vector3<f64>,
    masses: impl Iterator<Item = (f64, [f64; 2])>,
) -> Option<[f64; 3]> {
    let mut sums = [ExactSum::ZERO; 4];
    for (m, [x, z]) in masses {
        sums[0].add(m);
        sums[1].add(m * x);
        sums[2].add(m * z);
        sums[3].add(m * (x * x + z * z));
    }
    let [mass, sx, sz, inertia] = sums.map(|s| s.value());
    let [px, pz, l] = momentum.into();
    // p = m a + alpha (sz, -sx), l = sz ax - sx az + inertia alpha
    let about_centroid = inertia - (sx * sx + sz * sz) / mass;
    let alpha = (l - (sz * px - sx * pz) / mass) / about_centroid;
    let motion = [(px - alpha * sz) / mass, (pz + alpha * sx) / mass, alpha];
    motion.iter().all(|c| c.is_finite()).then_some(motion)
}
