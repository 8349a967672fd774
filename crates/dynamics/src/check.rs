//! When a run must stop, and what to say.
//!
//! Guards look at what a step has found anyway, wherever energies are read; two looks cost more and are
//! rarer or cheaper: the shape of every element every [`SHAPE_STEPS`](crate::SHAPE_STEPS) steps and, for runs that go wrong at
//! once or have few steps, at 10, 20, 40 ... before; and the coefficient of friction, one comparison per
//! closed pair and step. What a guard sees is a symptom; [`Simulation::check`] then
//! asks for its cause, as far as a cause can be told from the state.

use crate::dashpots::RigidMotion;
use crate::diagnosis::{Cause, Diagnosis, Location, USUAL_HOURGLASS};
use crate::guard::{GuardLimits, LostContact, allowed, looks_at_shape, violated};
use crate::ledger::Energies;
use crate::load::Fixed;
use crate::simulation::{Simulation, StepReport};
use contact::ContactTables;
use mesh::Padded;

/// Lanczos steps for the frequency of the assembly with the springs that are closed at the stop.
const LANCZOS: usize = 40;

/// A node of a contact surface and what is there.
struct Spot {
    node: usize,
    gap: f64,
    mu: f64,
    slip_speed: f64,
    pressure: f64,
}

/// The node of either surface at which `measure` is largest or no number.
fn worst_spot(contact: &dyn ContactTables, measure: impl Fn(&Spot) -> f64) -> Option<Spot> {
    let mut worst: Option<(f64, Spot)> = None;
    for side in 0..2 {
        let mut table = contact.nodal_table(side);
        contact.nodal(&mut table);
        for (i, &node) in table.nodes.iter().enumerate() {
            let slip_speed = table.slip_velocity[i].norm();
            let pressure = table.pressure[i];
            let spot = Spot {
                node: node as usize,
                gap: table.gap[i],
                // the table weighs coefficients with forces: where those are none, it knows no coefficient
                mu: if pressure.is_nan() { f64::NAN } else { table.mu[i] },
                slip_speed,
                pressure,
            };
            let value = measure(&spot);
            let value = if value.is_nan() { f64::INFINITY } else { value };
            if worst.as_ref().is_none_or(|(most, _)| value > *most) {
                worst = Some((value, spot));
            }
        }
    }
    worst.map(|(_, spot)| spot)
}

impl Simulation {
    /// Forces of the elements on the nodes (N) in the present state, without viscous parts.
    pub fn elastic_force(&mut self) -> Vec<Padded> {
        self.gather_for_good();
        let mut force = vec![Padded::ZERO; self.nodes.displacement.len()];
        self.system.solid.subtract_elastic_force(&self.nodes.displacement, &mut force, false);
        force
    }

    /// Sets what no sound run does; nothing but energy and numbers is guarded before.
    pub fn set_limits(&mut self, limits: GuardLimits) {
        self.limits = limits;
    }

    /// The diagnosis if the state after the step of `report` can be no solution, or one that nobody wants.
    /// To be called after every step; all guards but that of the coefficient of friction need
    /// `report.energies`.
    pub fn check(&mut self, report: &StepReport) -> Option<Diagnosis> {
        if let Some(unsolved) = report.unsolved {
            return Some(self.diagnosis(report, Cause::Unsolved(unsolved)));
        }
        if report.contact.largest_mu > self.limits.friction || report.contact.largest_mu.is_nan() {
            return Some(self.diagnosis(report, self.friction_cause()));
        }
        self.watch_for_lost_contact(report);
        let symptom = match &report.energies {
            Some(now) if violated(&self.ledger, now) => self.energy_cause(now),
            Some(now) => {
                let cause = self.soft_cause(report, now)?;
                self.gather_for_good();
                // what bodies inside out do is no cause
                let (element, ratio) = self.system.solid.most_folded(&self.nodes.displacement);
                if ratio <= 0.0 { self.inverted(element) } else { cause }
            }
            None => return None,
        };
        Some(self.diagnosis(report, symptom))
    }

    /// Whether positions and velocities are numbers and no element is inside out: whether a checkpoint
    /// of the state is worth keeping.
    pub fn is_sound(&self) -> bool {
        let finite = |field: &[Padded]| field.iter().all(|v| v.xyz().iter().all(|c| c.is_finite()));
        finite(&self.nodes.displacement)
            && finite(&self.nodes.velocity)
            && self.system.solid.most_folded(&self.nodes.displacement).1 > 0.0
    }

    fn watch_for_lost_contact(&mut self, report: &StepReport) {
        if self.system.contact.is_none() {
            return;
        }
        if report.contact.closed > 0 && report.contact.normal_force > self.limits.least_force {
            self.watch = LostContact { touched: true, lost: None };
        } else if self.watch.touched {
            self.watch.lost.get_or_insert(report.time);
        }
    }

    /// Where energy comes from that nothing supplied.
    fn energy_cause(&mut self, now: &Energies) -> Cause {
        self.gather_for_good();
        let ratio = self.dt / self.dt_limit;
        if ratio > 1.0 && self.implicit.is_none() {
            return Cause::UnstableStep { ratio };
        }
        if self.system.contact.is_some() && self.implicit.is_none() {
            let system = &mut self.system;
            let mut free = vec![Padded::ZERO; self.nodes.inverse_mass.len()];
            let product = |x: &[Padded], y: &mut [Padded]| {
                free.copy_from_slice(x);
                Fixed::clear(&system.fixed, &mut free);
                system.add_tangent_product(&free, y);
                Fixed::clear(&system.fixed, y);
            };
            let omega = solid::largest_frequency(&self.nodes.inverse_mass, product, LANCZOS);
            let ratio = self.dt * omega / 2.0;
            if ratio > 1.0 && ratio.is_finite() {
                return Cause::StiffContact { ratio };
            }
        }
        let (element, ratio) = self.system.solid.most_folded(&self.nodes.displacement);
        if ratio <= 0.0 {
            self.inverted(element)
        } else if self.ledger.imbalance(now).is_finite() {
            Cause::EnergyGrowth
        } else {
            Cause::NotFinite
        }
    }

    /// What is wrong with a motion whose energies balance.
    fn soft_cause(&mut self, report: &StepReport, now: &Energies) -> Option<Cause> {
        let limits = self.limits;
        let sums = &report.contact;
        if sums.max_penetration > limits.penetration {
            return Some(Cause::Penetration {
                depth: sums.max_penetration,
                limit: limits.penetration,
                force: sums.normal_force,
            });
        }
        if let Some(since) = self.watch.lost
            && report.time - since > limits.without_contact
        {
            return Some(Cause::ContactLost { since, limit: limits.without_contact });
        }
        if let Some(hub) = &self.system.hub {
            let x = hub.centre[0] + hub.state.x;
            let [first, last] = limits.track;
            if x < first || x > last {
                let end = if x < first { first } else { last };
                return Some(Cause::EndOfTrack { hub: x, end });
            }
        }
        if self.ledger.moved.abs() > allowed(&self.ledger) {
            return Some(Cause::MeshMoves { energy: self.ledger.moved });
        }
        let looks = looks_at_shape(report.step);
        if looks {
            self.gather();
        }
        if let Some(usual) = self.usual_hourglass(now, looks)
            && usual > limits.least_energy
            && usual > limits.hourglass * now.internal
        {
            return Some(Cause::Hourglass {
                share: usual / now.internal,
                limit: limits.hourglass,
                coefficient: self.system.solid.hourglass(),
            });
        }
        if looks {
            let (element, ratio) = self.system.solid.most_folded(&self.nodes.displacement);
            if ratio <= 0.0 {
                return Some(self.inverted(element));
            }
        }
        None
    }

    /// Hourglass energy with at least the usual coefficient (J): of a run without hourglass stiffness
    /// only where the shape of elements is looked at.
    fn usual_hourglass(&self, now: &Energies, looks: bool) -> Option<f64> {
        let coefficient = self.system.solid.hourglass();
        if self.limits.hourglass.is_infinite() {
            None
        } else if coefficient > 0.0 {
            Some((USUAL_HOURGLASS / coefficient).max(1.0) * now.hourglass)
        } else {
            let displacement = &self.nodes.displacement;
            let energy = || self.system.solid.hourglass_energy(displacement, USUAL_HOURGLASS);
            looks.then(|| self.system.multiplicity * energy())
        }
    }

    /// The cause that an element is inside out: the step, where that is too long.
    fn inverted(&self, element: usize) -> Cause {
        let ratio = self.dt / self.dt_limit;
        if ratio > 1.0 && self.implicit.is_none() {
            return Cause::UnstableStep { ratio };
        }
        let volume_ratio =
            self.system.solid.element_state(&self.nodes.displacement, element).volume_ratio;
        Cause::Inverted { volume_ratio }
    }

    fn friction_cause(&self) -> Cause {
        let spot = self.system.contact.as_deref().and_then(|c| worst_spot(c, |spot| spot.mu));
        let (mu, slip_speed, pressure) =
            spot.map_or([f64::NAN; 3].into(), |s| (s.mu, s.slip_speed, s.pressure));
        Cause::Friction { mu, limit: self.limits.friction, slip_speed, pressure }
    }

    fn diagnosis(&mut self, report: &StepReport, cause: Cause) -> Diagnosis {
        self.gather_for_good();
        let spot = self.system.contact.as_deref().and_then(|contact| match cause {
            Cause::Friction { .. } => worst_spot(contact, |spot| spot.mu),
            Cause::Penetration { .. } => worst_spot(contact, |spot| -spot.gap),
            _ => None,
        });
        let node = spot.map_or_else(|| self.fastest(), |spot| spot.node);
        let (element, jacobian) = self.system.solid.most_folded(&self.nodes.displacement);
        let [upper, lower] = self.system.names;
        Diagnosis {
            step: report.step,
            time: report.time,
            cause,
            imbalance: report.energies.map_or(0.0, |now| self.ledger.imbalance(&now)),
            place: Location {
                node,
                body: if self.system.upper.contains(&node) { upper } else { lower },
                position: self.system.solid.reference()[node].vector(),
                speed: self.relative_speed(node),
                element,
                jacobian,
            },
            bodies: [upper, lower],
        }
    }

    /// Speed of a node relative to the rigid motion of its body (m/s).
    fn relative_speed(&self, node: usize) -> f64 {
        let at = match &self.system.hub {
            Some(hub) if self.system.upper.contains(&node) => {
                RigidMotion::new(hub).at(self.system.solid.reference()[node]).0
            }
            _ => [0.0; 4],
        };
        let v = &self.nodes.velocity[node];
        (0..3).map(|i| (v.0[i] - at[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// The node that moves fastest relative to its body, the first whose speed is no number.
    fn fastest(&self) -> usize {
        let mut worst = (0, 0.0);
        for node in 0..self.nodes.velocity.len() {
            let speed = self.relative_speed(node);
            if !speed.is_finite() {
                return node;
            }
            if speed > worst.1 {
                worst = (node, speed);
            }
        }
        worst.0
    }
}
