//! Two-pass penalty contact: the criticised method of surface-to-surface contact.

use crate::face::Positions;
use crate::penalty_point::{Pass, PenaltyPoint, scatter};
use crate::point::State;
use crate::search::{Listed, Search, neighbours};
use crate::sums::Accumulator;
use crate::surface::ContactSurface;
use crate::vector::{Vec3, axpy, dot, scale};
use crate::{
    BodyMaterial, ContactError, ContactSums, Gap, Motion, PenaltyStiffness, StabilityScale,
};
use friction::{NodeFriction, Slid};
use mesh::{Mesh, Padded, Surface};

/// Settings of [`PenaltyContact`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenaltySettings {
    /// Normal stiffness `k_n`.
    pub normal: PenaltyStiffness,
    /// Tangential stiffness `k_t`.
    pub tangential: PenaltyStiffness,
    /// Normal viscous damping as a fraction of the spring's critical damping.
    pub damping: f64,
    /// Corrects gap and normal with the exact surface where the master has one.
    pub curvature: bool,
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
    pub(crate) sides: [ContactSurface; 2],
    /// The points of each pass, ascending by slave: pass `i` has the nodes of side `i` as slaves.
    pub(crate) points: [Vec<PenaltyPoint>; 2],
    pub(crate) law: Box<dyn NodeFriction>,
    /// What the law is told about the closed points of a pass, in their order.
    slid: Vec<Slid>,
    pub(crate) search: Search,
    /// Whether the search was refreshed in the last step.
    searched: bool,
    pub(crate) settings: PenaltySettings,
    stability: Option<StabilityScale>,
    /// [`PenaltyContact::nodal_stiffness_bound`] at the nodes of each side (N/m).
    bound: [Vec<f64>; 2],
}

impl PenaltyContact {
    /// Contact of two `surfaces` of `mesh`, side 0 and side 1.
    ///
    /// `stability` is needed for [`PenaltyStiffness::StabilityFraction`] only.
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
        if law.is_implicit() {
            return Err(ContactError::ImplicitLaw);
        }
        let sides = ContactSurface::both(mesh, surfaces)?;
        let mut contact = Self {
            search: Search::new(&sides),
            searched: false,
            sides,
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

    /// Mesh indices of the surface nodes of a side, ascending.
    pub fn nodes(&self, side: usize) -> &[u32] {
        &self.sides[side].nodes
    }

    /// Adds the contact forces (N) at `x^n = X + u^n` to `force`.
    ///
    /// # Panics
    /// If a slice has fewer entries than the mesh has nodes.
    pub fn apply(&mut self, motion: &Motion<'_>, force: &mut [Padded]) -> ContactSums {
        self.follow(motion);
        self.load(force)
    }

    /// Adds the forces of the normal springs alone, without damper or friction; the friction
    /// springs are unloaded. For dynamic relaxation.
    ///
    /// # Panics
    /// If a slice has fewer entries than the mesh has nodes.
    pub fn apply_frictionless(
        &mut self,
        reference: &[Padded],
        displacement: &[Padded],
        force: &mut [Padded],
    ) -> ContactSums {
        self.update(&Positions { reference, displacement }, None);
        self.load(force)
    }

    /// Follows the points to `x^n`, with their springs, dampers and friction.
    pub(crate) fn follow(&mut self, motion: &Motion<'_>) {
        let positions =
            Positions { reference: motion.reference, displacement: motion.displacement };
        self.update(&positions, Some(motion));
    }

    fn update(&mut self, positions: &Positions<'_>, motion: Option<&Motion<'_>>) {
        self.searched = self.search.is_due(&self.sides, positions, &self.points);
        if self.searched {
            self.search.refresh(&self.sides, positions, &mut self.points);
        }
        let mut points = std::mem::take(&mut self.points);
        let mut slid = std::mem::take(&mut self.slid);
        let most = points.iter().map(Vec::len).max().unwrap_or(0);
        slid.clear();
        slid.reserve(most);
        for (slave, list) in points.iter_mut().enumerate() {
            let pass = self.pass(slave);
            list.iter_mut().for_each(|point| pass.update(point, positions, motion));
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
    }

    /// Adds the forces of the points to `force`.
    pub(crate) fn load(&self, force: &mut [Padded]) -> ContactSums {
        let mut sums = Accumulator::new(self.searched);
        for (slave, list) in self.points.iter().enumerate() {
            let sides = [&self.sides[slave], &self.sides[1 - slave]];
            for point in list {
                sums.friction_work.add(point.enforcement.friction_work);
                sums.damping_work.add(point.enforcement.damping_work);
                if !point.is_closed() {
                    continue;
                }
                let on_slave = axpy(point.friction, point.normal_force, point.normal);
                scatter(sides, point, on_slave, force);
                // the forces that really reach the nodes of either side
                sums.push(slave, on_slave);
                let on_corners = point
                    .enforcement
                    .weights
                    .iter()
                    .fold([0.0; 3], |sum, w| axpy(sum, -w, on_slave));
                sums.push(1 - slave, on_corners);
                sums.normal_force.add(point.normal_force);
                sums.stored_normal.add(point.stored_normal());
                sums.stored_tangential.add(point.stored_tangential());
                sums.meet(point.mu);
                let other = &mut sums.other;
                other.closed += 1;
                other.slipping += usize::from(point.state == State::Slip);
                other.max_penetration = other.max_penetration.max(-point.gap);
            }
        }
        sums.finish()
    }

    fn pass(&self, slave: usize) -> Pass<'_> {
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

    /// `y += K_c x` with the stiffness of the points closed at the last call: for slave
    /// displacement relative to the projection `w`, the spring force `k_n n (n.w) + k_t (w - n (n.w))`.
    ///
    /// # Panics
    /// If a slice has fewer entries than the mesh has nodes.
    pub fn stiffness_product(&self, x: &[Padded], y: &mut [Padded]) {
        for (slave, list) in self.points.iter().enumerate() {
            let (own, master) = (&self.sides[slave], &self.sides[1 - slave]);
            for point in list.iter().filter(|p| p.is_closed()) {
                let corners = master.faces[point.face as usize].nodes;
                let mut w = x[own.nodes[point.slave as usize] as usize].xyz();
                for (weight, corner) in point.enforcement.weights.iter().zip(corners) {
                    w = axpy(w, -weight, x[corner as usize].xyz());
                }
                let [normal, tangential] = point.enforcement.stiffness;
                let along = (normal - tangential) * dot(point.normal, w);
                let on_slave: Vec3 = axpy(scale(tangential, w), along, point.normal);
                scatter([own, master], point, on_slave, y);
            }
        }
    }

    /// Adds to each contact node an upper bound (N/m) of the contact stiffness acting on it, for
    /// any state of contact near the reference configuration.
    ///
    /// With `phi` the weights of the face's corners, a spring's matrix is bounded by a diagonal
    /// one: `k (x_s - sum phi x)^2 <= 2 k x_s^2 + 2 k sum phi x^2` (convexity; `sum phi = 1`).
    /// A node so bears twice its own spring and `2 sum phi k` of the slaves over its faces, where
    /// `sum phi A_s` is at most `9/8` per direction of the larger of the two tributary areas on
    /// rectangular grids. Hence `K_c <= diag(bound)`, and a mass `bound/4` added to a node makes
    /// contact stable at unit time step.
    pub fn nodal_stiffness_bound(&self, bound: &mut [f64]) {
        for (side, values) in self.sides.iter().zip(&self.bound) {
            for (&node, value) in side.nodes.iter().zip(values) {
                bound[node as usize] += value;
            }
        }
    }

    fn stiffness_bounds(&self, mesh: &Mesh) -> [Vec<f64>; 2] {
        const SIZES: f64 = 4.0;
        const CORNERS: [[f64; 4]; 4] = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ];
        let reference: Vec<Padded> = mesh.nodes.iter().map(|&x| Padded::new(x)).collect();
        let displacement = vec![Padded::ZERO; reference.len()];
        let positions = Positions { reference: &reference, displacement: &displacement };
        // Per node: largest own stiffness, areal stiffness of slaves above, their largest area.
        let mut own = [0, 1].map(|s: usize| vec![0.0_f64; self.sides[s].nodes.len()]);
        let mut over = own.clone();
        let mut area = own.clone();
        neighbours(&self.sides, &positions, SIZES, |f, g| {
            for (slave, its, master, face) in [(0, f, 1, g), (1, g, 0, f)] {
                let pass = self.pass(slave);
                let face = &self.sides[master].faces[face];
                for node in self.sides[slave].faces[its].local {
                    let node = node as usize;
                    // the largest over the face is that at a corner
                    let at_corners = CORNERS.iter().map(|it| pass.stiffness(node, face, it));
                    let k = at_corners.flatten().fold(0.0, f64::max);
                    own[slave][node] = own[slave][node].max(k);
                    let slave_area = self.sides[slave].area[node];
                    for corner in face.local {
                        let corner = corner as usize;
                        over[master][corner] = over[master][corner].max(k / slave_area);
                        area[master][corner] = area[master][corner].max(slave_area);
                    }
                }
            }
        });
        [0, 1].map(|side: usize| {
            (0..own[side].len())
                .map(|i| {
                    let covered = 81.0 / 64.0 * area[side][i].max(self.sides[side].area[i]);
                    2.0 * own[side][i] + 2.0 * over[side][i] * covered
                })
                .collect()
        })
    }

    /// The normal springs of both passes that were closed at the last call, each with its
    /// stiffness (N/m), in a fixed order.
    pub fn springs(&self) -> impl Iterator<Item = (Gap, f64)> + '_ {
        (0..2).flat_map(move |slave: usize| {
            let closed = self.points[slave].iter().filter(|p| p.is_closed());
            closed.map(move |point| (self.spring(slave, point), point.enforcement.stiffness[0]))
        })
    }

    fn spring(&self, slave: usize, point: &PenaltyPoint) -> Gap {
        let (own, master) = (&self.sides[slave], &self.sides[1 - slave]);
        Gap {
            node: own.nodes[point.slave as usize],
            projection: master.faces[point.face as usize]
                .nodes
                .into_iter()
                .zip(point.enforcement.weights)
                .collect(),
            normal: point.normal,
            gap: point.gap,
            area: own.area[point.slave as usize],
        }
    }

    /// Says that the next positions may lie anywhere: the search looks at them at the next call.
    ///
    /// A time loop need not, since it moves by small steps; a solver of equilibrium must.
    pub fn expect_jump(&mut self) {
        self.search.expect_jump();
    }

    /// Upper bound (1/s^2) of the largest eigenvalue of `M^-1 K_c` with the points closed at the
    /// last call, from the diagonal bound of
    /// [`nodal_stiffness_bound`](Self::nodal_stiffness_bound) with the actual weights.
    ///
    /// # Panics
    /// If `inverse_mass` has fewer entries than the mesh has nodes.
    pub fn rigorous_omega_squared(&self, inverse_mass: &[f64]) -> f64 {
        let mut diagonal = [0, 1].map(|s: usize| vec![0.0; self.sides[s].nodes.len()]);
        for (slave, list) in self.points.iter().enumerate() {
            for point in list.iter().filter(|p| p.is_closed()) {
                let twice =
                    2.0 * point.enforcement.stiffness[0].max(point.enforcement.stiffness[1]);
                diagonal[slave][point.slave as usize] += twice;
                let corners = self.sides[1 - slave].faces[point.face as usize].local;
                for (weight, corner) in point.enforcement.weights.iter().zip(corners) {
                    diagonal[1 - slave][corner as usize] += twice * weight;
                }
            }
        }
        let mut largest = 0.0_f64;
        for (side, diagonal) in self.sides.iter().zip(&diagonal) {
            for (&node, d) in side.nodes.iter().zip(diagonal) {
                largest = largest.max(d * inverse_mass[node as usize]);
            }
        }
        largest
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
    let fraction = [settings.normal, settings.tangential]
        .iter()
        .any(|s| matches!(s, PenaltyStiffness::StabilityFraction(_)));
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
