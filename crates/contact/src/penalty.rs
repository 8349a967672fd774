//! Two-pass penalty contact, node to face in both directions.

use crate::face::Positions;
use crate::nodal_normals::{NodalNormals, Normals};
use crate::penalty_point::{Pass, PenaltyPoint, scatter};
use crate::point::State;
use crate::search::{Listed, Search};
use crate::sums::Accumulator;
use crate::surface::ContactSurface;
use crate::{BodyMaterial, ContactError, ContactSums, Motion, StabilityScale, Stiffness, Trace};
use friction::{NodeFriction, NodeHistory};
use mesh::{Mesh, Padded, Surface};
use nalgebra::Vector3;

/// Settings of [`PenaltyContact`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenaltySettings {
    /// Normal stiffness `k_n`.
    pub normal: Stiffness,
    /// Tangential stiffness `k_t`.
    pub tangential: Stiffness,
    /// Normal viscous damping as a fraction of the spring's critical damping.
    pub damping: f64,
    /// Corrects gap and normal with the exact surface where the master has one.
    pub curvature: bool,
    /// The normal along which a node meets a face.
    pub normals: Normals,
}

/// Two-pass penalty contact of two surfaces with friction springs.
///
/// In each pass every slave node that has penetrated the other surface is pushed out by a spring
/// and a damper along the master's normal and held by a friction spring (Eqs 10 and 11 of
/// Vollebregt 2017) in its tangent plane; the face's corners take the reaction by their shape
/// functions. In motion a point keeps the stiffness with which it closed until it opens, so that
/// its springs give back what they stored.
#[derive(Debug)]
pub struct PenaltyContact {
    pub(crate) trace: Trace,
    pub(crate) sides: [ContactSurface; 2],
    /// The points of each pass, ascending by slave: pass `i` has the nodes of side `i` as slaves.
    pub(crate) points: [Vec<PenaltyPoint>; 2],
    pub(crate) law: Box<dyn NodeFriction>,
    /// The nodes of the trace that bear the closed points.
    pub(crate) loaded: Vec<u32>,
    /// What the law is told about the closed points of a pass, in their order.
    slid: Vec<NodeHistory>,
    pub(crate) search: Search,
    /// Whether the search was refreshed in the last step.
    searched: bool,
    pub(crate) settings: PenaltySettings,
    /// Averaged normals of both sides, unless nodes meet faces along theirs.
    normals: Option<[NodalNormals; 2]>,
    stability: Option<StabilityScale>,
    /// [`PenaltyContact::nodal_stiffness_bound`] at the nodes of each side (N/m).
    pub(crate) bound: [Vec<f64>; 2],
}

impl PenaltyContact {
    /// Contact of two `surfaces` of `mesh`, side 0 and side 1.
    ///
    /// `stability` is needed for [`Stiffness::Stability`] only. A law of the same instant has the slip velocity of the step just
    /// taken, springs included; one whose coefficient vanishes at rest, such as rate and state, cannot hold.
    ///
    /// # Errors
    /// Surfaces that are empty, degenerate, outside the mesh or in touch by a common node, and
    /// numbers out of range.
    pub fn new(
        mesh: &Mesh,
        surfaces: [(&Surface, BodyMaterial); 2],
        settings: &PenaltySettings,
        stability: Option<StabilityScale>,
        law: Box<dyn NodeFriction>,
    ) -> Result<Self, ContactError> {
        check(settings, stability, &surfaces, &*law)?;
        let (trace, sides) = ContactSurface::both(mesh, surfaces)?;
        let normals = || [0, 1].map(|s: usize| NodalNormals::new(&sides[s], settings.curvature));
        let mut contact = Self {
            normals: (settings.normals == Normals::Averaged).then(normals),
            search: Search::new(&sides),
            searched: false,
            trace,
            sides,
            loaded: Vec::new(),
            points: [Vec::new(), Vec::new()],
            law,
            slid: Vec::new(),
            settings: *settings,
            stability,
            bound: [Vec::new(), Vec::new()],
        };
        contact.bound = contact.stiffness_bounds(mesh);
        Ok(contact)
    }

    /// Adds the contact forces (N) at `x^n` to `force`, on the nodes of the [trace](crate::ContactStep::trace).
    ///
    /// # Panics
    /// If a slice has fewer entries than the trace has nodes.
    pub fn apply(&mut self, motion: &Motion<'_>, force: &mut [Padded]) -> ContactSums {
        self.follow(motion);
        self.load(&Positions(motion.position), force)
    }

    /// Adds the forces (N) of the normal springs alone at `position` (m), without damper or friction, to `force`,
    /// both on the nodes of the trace; the friction springs are unloaded. For solvers of equilibrium.
    ///
    /// # Panics
    /// If a slice has fewer entries than the trace has nodes.
    pub fn apply_frictionless(&mut self, position: &[Padded], force: &mut [Padded]) -> ContactSums {
        self.update(&Positions(position), None);
        self.load(&Positions(position), force)
    }

    /// Follows the points to `x^n`, with their springs, dampers and friction.
    pub(crate) fn follow(&mut self, motion: &Motion<'_>) {
        self.update(&Positions(motion.position), Some(motion));
    }

    fn update(&mut self, positions: &Positions<'_>, motion: Option<&Motion<'_>>) {
        self.searched = self.search.is_due(&self.sides, positions, &self.points);
        if self.searched {
            self.search.refresh(&self.sides, positions, &mut self.points);
        }
        let mut points = std::mem::take(&mut self.points);
        let mut slid = std::mem::take(&mut self.slid);
        let mut normals = self.normals.take();
        normals.iter_mut().flatten().for_each(NodalNormals::expire);
        let most = points.iter().map(Vec::len).max().unwrap_or(0);
        slid.clear();
        slid.reserve(most);
        for (slave, list) in points.iter_mut().enumerate() {
            let pass = self.pass(slave);
            for point in list.iter_mut() {
                let of_master = normals.as_mut().map(|normals| &mut normals[1 - slave]);
                pass.update(point, positions, motion, of_master);
            }
            let Some(motion) = motion else { continue };
            slid.clear();
            let closed = list.iter().filter(|point| point.is_closed());
            slid.extend(closed.map(|point| pass.slid(point, positions, motion.time)));
            pass.law.advance_all(&mut slid, motion.dt);
            let closed = list.iter_mut().filter(|point| point.is_closed());
            closed.zip(&slid).for_each(|(point, slid)| pass.return_mapping(point, slid, motion.dt));
        }
        self.points = points;
        self.slid = slid;
        self.normals = normals;
        self.note_loaded();
    }

    /// Notes which nodes the closed points load.
    fn note_loaded(&mut self) {
        let mut loaded = std::mem::take(&mut self.loaded);
        loaded.clear();
        loaded.reserve(5 * self.points.iter().map(Vec::len).sum::<usize>());
        for (slave, list) in self.points.iter().enumerate() {
            let closed = list.iter().filter(|point| point.is_closed());
            loaded.extend(closed.flat_map(|point| self.bearing(slave, point)));
        }
        self.loaded = loaded;
    }

    /// The nodes of the trace that a closed point of a pass loads: the slave and the corners of the face.
    pub(crate) fn bearing(&self, slave: usize, point: &PenaltyPoint) -> [u32; 5] {
        let [a, b, c, d] = self.sides[1 - slave].faces[point.face as usize].nodes;
        [self.sides[slave].node(point.slave), a, b, c, d]
    }

    /// Adds the forces of the points to `force`.
    pub(crate) fn load(&self, positions: &Positions<'_>, force: &mut [Padded]) -> ContactSums {
        let mut sums = Accumulator::new(self.searched);
        for (slave, list) in self.points.iter().enumerate() {
            for point in list {
                sums.friction_work.add(point.enforcement.friction_work);
                sums.damping_work.add(point.enforcement.damping_work);
                if !point.is_closed() {
                    continue;
                }
                let on_slave = point.friction + point.normal_force * *point.normal;
                let [node, corners @ ..] = self.bearing(slave, point);
                scatter(point, node, corners, on_slave, force);
                // the forces that really reach the nodes of either side
                sums.push(slave, on_slave);
                let on_corners = point.enforcement.weights.iter().map(|w| -w * on_slave);
                sums.push(1 - slave, on_corners.sum::<Vector3<f64>>());
                sums.normal_force.add(point.normal_force);
                sums.stored_normal.add(point.stored_normal());
                sums.stored_tangential.add(point.stored_tangential());
                sums.meet(point.mu);
                let other = &mut sums.other;
                let nodes = self.sides[slave].nodes_of_whole(positions.at(node));
                other.closed += nodes;
                other.slipping += nodes * usize::from(point.state == State::Slip);
                other.max_penetration = other.max_penetration.max(-point.gap);
            }
        }
        sums.finish()
    }

    pub(crate) fn pass(&self, slave: usize) -> Pass<'_> {
        Pass {
            slave: &self.sides[slave],
            master: &self.sides[1 - slave],
            normal: self.settings.normal,
            tangential: self.settings.tangential,
            stability: self.stability,
            damping: self.settings.damping,
            curvature: self.settings.curvature,
            margin: self.search.margin,
            law: &*self.law,
        }
    }

    /// Says that the next positions may lie anywhere: the search looks at them at the next call.
    ///
    /// A time loop need not, since it moves by small steps; a solver of equilibrium must.
    pub fn expect_jump(&mut self) {
        self.search.expect_jump();
    }
}

fn check(
    settings: &PenaltySettings,
    stability: Option<StabilityScale>,
    surfaces: &[(&Surface, BodyMaterial); 2],
    law: &dyn NodeFriction,
) -> Result<(), ContactError> {
    positive("the normal contact stiffness", settings.normal.value())?;
    let tangential = settings.tangential.value();
    in_range("the tangential contact stiffness", tangential, tangential >= 0.0, "at least zero")?;
    let damping = settings.damping;
    in_range("the contact damping", damping, (0.0..=1.0).contains(&damping), "from 0 to 1")?;
    check_common(surfaces, law)?;
    let fraction =
        [settings.normal, settings.tangential].iter().any(|s| matches!(s, Stiffness::Stability(_)));
    if fraction {
        let scale = stability.ok_or(ContactError::NoStabilityScale)?;
        positive("the time step", scale.dt)?;
        let omega = scale.omega_elastic;
        let stable = omega >= 0.0 && scale.omega_squared() > 0.0;
        in_range("the elastic frequency", omega, stable, "at least zero and below 2/dt")?;
    }
    Ok(())
}

/// What every enforcement asks of materials and friction.
pub(crate) fn check_common(
    surfaces: &[(&Surface, BodyMaterial); 2],
    law: &dyn NodeFriction,
) -> Result<(), ContactError> {
    for (_, material) in surfaces {
        positive("the bulk modulus", material.bulk_modulus)?;
        positive("the density", material.density)?;
    }
    let mu = law.mu_static();
    in_range("the coefficient of friction", mu, mu >= 0.0, "at least zero")
}

fn positive(name: &'static str, value: f64) -> Result<(), ContactError> {
    in_range(name, value, value > 0.0, "positive and finite")
}

pub(crate) fn in_range(
    name: &'static str,
    value: f64,
    holds: bool,
    range: &'static str,
) -> Result<(), ContactError> {
    if holds && value.is_finite() {
        Ok(())
    } else {
        Err(ContactError::Value { name, value, range })
    }
}
