//! When a run must stop, and what to say.
//!
//! Guards look at what a step has found anyway, wherever energies are read; two looks cost more and are
//! rarer or cheaper: the shape of every element every [`SHAPE_STEPS`] steps and, for runs that go wrong at
//! once or have few steps, at 10, 20, 40 ... before; and the coefficient of friction, one comparison per
//! closed pair and step. What a guard sees is a symptom; [`Simulation::check`] then
//! asks for its cause, as far as a cause can be told from the state.

use crate::dashpots::RigidMotion;
use crate::ledger::{Energies, Ledger};
use crate::load::Fixed;
use crate::simulation::{Simulation, StepReport};
use crate::unsolved::Unsolved;
use contact::Contact;
use mesh::Padded;
use std::fmt;

/// Steps between two looks at the shape of every element; a look happens at steps alone whose energies were read.
pub const SHAPE_STEPS: usize = 500;

/// Lanczos steps for the frequency of the assembly with the springs that are closed at the stop.
const LANCZOS: usize = 40;

/// Coefficient of the hourglass stiffness that is usual (Flanagan and Belytschko 1981).
pub const USUAL_HOURGLASS: f64 = 0.05;

/// What no sound run does. Energy from nowhere and numbers that are none need no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardLimits {
    /// Hourglass over strain energy (dimensionless), with the usual coefficient 0.05 where that of the
    /// run is smaller: weak hourglass stiffness lets elements hourglass, with little energy.
    pub hourglass: f64,
    /// Energies below this are too small to judge a share (J).
    pub least_energy: f64,
    /// Penetration (m).
    pub penetration: f64,
    /// Time without contact, once there was contact (s).
    pub without_contact: f64,
    /// Normal force below which there is no contact (N).
    pub least_force: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// First and last x of the lower body, which the hub must not pass (m).
    pub track: [f64; 2],
}

impl Default for GuardLimits {
    /// None.
    fn default() -> Self {
        Self {
            hourglass: f64::INFINITY,
            least_energy: 0.0,
            penetration: f64::INFINITY,
            without_contact: f64::INFINITY,
            least_force: 0.0,
            friction: f64::INFINITY,
            track: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}

/// What the guards carry from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LostContact {
    /// Whether there was contact.
    pub touched: bool,
    /// Since when there is none (s), if there was.
    pub lost: Option<f64>,
}

/// Why the guards stopped a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The time step is larger than the stability limit.
    UnstableStep {
        /// Step over the limit 2/omega_max.
        ratio: f64,
    },
    /// Contact springs that closed after the step was chosen make it larger than the limit.
    StiffContact {
        /// Step over the limit with those springs.
        ratio: f64,
    },
    /// Energy appears that nothing supplies, although the step was within its limit.
    EnergyGrowth,
    /// Positions or energies are not numbers.
    NotFinite,
    /// An implicit step was not solved.
    Unsolved(Unsolved),
    /// The friction law gives no coefficient, or one beyond the limit.
    Friction {
        /// What it gives.
        mu: f64,
        /// The limit.
        limit: f64,
        /// Slip speed there (m/s).
        slip_speed: f64,
        /// Pressure there (Pa).
        pressure: f64,
    },
    /// An element is inside out.
    Inverted {
        /// Mean det F of the element.
        volume_ratio: f64,
    },
    /// Elements hourglass.
    Hourglass {
        /// Hourglass over strain energy.
        share: f64,
        /// The limit.
        limit: f64,
        /// Coefficient of the hourglass stiffness.
        coefficient: f64,
    },
    /// Surfaces pass through each other.
    Penetration {
        /// How deep (m).
        depth: f64,
        /// The limit (m).
        limit: f64,
        /// Normal force (N).
        force: f64,
    },
    /// The upper body has left the lower one upwards.
    ContactLost {
        /// Since when (s).
        since: f64,
        /// The longest time allowed (s).
        limit: f64,
    },
    /// The moves of a mesh that follows the patch brought or took too much energy.
    MeshMoves {
        /// What they brought (J).
        energy: f64,
    },
    /// The upper body has reached the end of the lower one.
    EndOfTrack {
        /// Where the hub is in x (m).
        hub: f64,
        /// Where the lower body ends (m).
        end: f64,
    },
}

/// Where the trouble is worst.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Location {
    /// The contact node that the cause names, else the node that moves fastest relative to its body's
    /// rigid motion.
    pub node: usize,
    /// What its body is called.
    pub body: &'static str,
    /// Its reference position (m).
    pub position: [f64; 3],
    /// Its speed relative to its body (m/s).
    pub speed: f64,
    /// The element with the smallest det F at a corner.
    pub element: usize,
    /// That determinant; negative where the element is inside out.
    pub jacobian: f64,
}

/// What the guards found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagnosis {
    /// Step number.
    pub step: usize,
    /// Simulated time (s).
    pub time: f64,
    /// Likely cause.
    pub cause: Cause,
    /// Energy that nothing supplied (J).
    pub imbalance: f64,
    /// Where.
    pub place: Location,
    /// What the upper and the lower body are called.
    pub bodies: [&'static str; 2],
}

/// The energy that nothing supplied, in brackets, where it is one.
fn from_nowhere(imbalance: f64) -> String {
    if imbalance.is_finite() && imbalance != 0.0 {
        format!(" ({imbalance:.3e} J from nowhere)")
    } else {
        String::new()
    }
}

impl fmt::Display for Diagnosis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { step, time, imbalance, place, bodies: [upper, lower], .. } = self;
        write!(f, "stopped at step {step}, t = {:.6} ms: ", time * 1e3)?;
        match self.cause {
            Cause::UnstableStep { ratio } => write!(
                f,
                "the time step is {ratio:.2} times the stability limit 2/omega_max and the motion \
                 grows without bound{}",
                from_nowhere(*imbalance)
            )?,
            Cause::StiffContact { ratio } => write!(
                f,
                "contact springs that closed after the time step was chosen are too stiff for it: it \
                 is {ratio:.2} times the stability limit with them, and the motion grows without \
                 bound{}",
                from_nowhere(*imbalance)
            )?,
            Cause::EnergyGrowth => write!(
                f,
                "{imbalance:.3e} J appeared that neither load nor drive supplied, although the \
                 time step was within its limit; contact springs are the likely source"
            )?,
            Cause::NotFinite => write!(f, "positions are no longer numbers")?,
            Cause::Unsolved(Unsolved { step, iterations, residual, change }) => write!(
                f,
                "an implicit step was not solved, not even in parts of {step:.3e} s: after {iterations} iterations \
                 the residual is {residual:.1e} of the forces, and contact forces still change by {change:.1e}"
            )?,
            Cause::Friction { mu, limit, slip_speed, pressure } => {
                if mu.is_finite() {
                    write!(f, "the friction law gives mu = {mu:.4}, beyond {limit}")?;
                } else {
                    write!(f, "the friction law gives no coefficient of friction")?;
                }
                if slip_speed.is_finite() {
                    write!(f, ", at a slip speed of {slip_speed:.3e} m/s")?;
                }
                write!(f, ", under {pressure:.3e} Pa")?;
            }
            Cause::Inverted { volume_ratio } if volume_ratio > 0.0 => write!(
                f,
                "an element is inside out at a corner (negative Jacobian), at {volume_ratio:.3} of \
                 its volume: it hourglasses, or the load is more than it can take"
            )?,
            Cause::Inverted { .. } => write!(
                f,
                "an element is inside out (negative Jacobian): it was strained more than a linear \
                 material can take"
            )?,
            Cause::Hourglass { share, limit, coefficient } => {
                write!(
                    f,
                    "the elements hourglass: {share:.3} of the strain energy, beyond {limit}"
                )?;
                if coefficient < USUAL_HOURGLASS {
                    write!(
                        f,
                        ", reckoned with the usual coefficient {USUAL_HOURGLASS}; it is {coefficient} \
                         here, too weak to hold them"
                    )?;
                }
            }
            Cause::Penetration { depth, limit, force } => write!(
                f,
                "the surfaces penetrate each other by {:.4} mm, beyond {:.4} mm: contact is too soft \
                 for the normal force of {force:.3e} N",
                depth * 1e3,
                limit * 1e3
            )?,
            Cause::ContactLost { since, limit } => write!(
                f,
                "contact is lost: the {upper} has left the {lower}, without normal force since t = {:.6} ms \
                 (allowed: {:.6} ms)",
                since * 1e3,
                limit * 1e3
            )?,
            Cause::MeshMoves { energy } => write!(
                f,
                "the mesh that follows the patch does not carry the motion along: its moves brought {energy:.3e} J, more \
                 than a quarter of the energy exchanged"
            )?,
            Cause::EndOfTrack { hub, end } => write!(
                f,
                "the {upper} has reached the end of the {lower}: its hub is at x = {:.3} mm, the {lower} ends \
                 at {:.3} mm",
                hub * 1e3,
                end * 1e3
            )?,
        }
        let [x, y, z] = place.position.map(|c| c * 1e3);
        write!(
            f,
            ". {} node {} of the {} (reference position {x:.3}, {y:.3}, {z:.3} mm), {:.3e} m/s \
             relative to its body; smallest det F {} in element {}",
            if self.is_contact() { "At" } else { "Worst at" },
            place.node,
            place.body,
            place.speed,
            // what has blown up would fill the line with digits
            if place.jacobian.abs() < 1e3 {
                format!("{:.4}", place.jacobian)
            } else {
                format!("{:.3e}", place.jacobian)
            },
            place.element
        )
    }
}

impl Diagnosis {
    /// Whether the place is a contact node that the cause is about.
    fn is_contact(&self) -> bool {
        matches!(self.cause, Cause::Friction { .. } | Cause::Penetration { .. })
    }
}

/// Whether `now` can no longer be a solution: not finite, or energy from nowhere beyond what is allowed.
pub(crate) fn violated(ledger: &Ledger, now: &Energies) -> bool {
    let total = now.total() - now.external_work;
    !total.is_finite() || ledger.imbalance(now).abs() > allowed(ledger)
}

/// Energy that may be in error (J): a quarter of all that was exchanged, with a floor of 1e-5 of the initial energy, far
/// above round-off.
fn allowed(ledger: &Ledger) -> f64 {
    let floor = ledger.initial().map_or(0.0, |i| 1e-5 * i.total().abs());
    0.25 * ledger.largest_exchange() + floor
}

/// Whether the shape of the elements is looked at after a step.
pub(crate) fn looks_at_shape(step: usize) -> bool {
    let early = step < SHAPE_STEPS && step.is_multiple_of(10) && (step / 10).is_power_of_two();
    early || step.is_multiple_of(SHAPE_STEPS)
}

/// A node of a contact surface and what is there.
struct Spot {
    node: usize,
    gap: f64,
    mu: f64,
    slip_speed: f64,
    pressure: f64,
}

/// The node of either surface at which `measure` is largest or no number.
fn worst_spot(contact: &dyn Contact, measure: impl Fn(&Spot) -> f64) -> Option<Spot> {
    let mut worst: Option<(f64, Spot)> = None;
    for side in 0..2 {
        let mut table = contact.nodal_table(side);
        contact.nodal(&mut table);
        for (i, &node) in table.nodes.iter().enumerate() {
            let slip_speed = table.slip_velocity[i].iter().map(|c| c * c).sum::<f64>().sqrt();
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
        let ratio = self.dt * self.omega_max / 2.0;
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
        let ratio = self.dt * self.omega_max / 2.0;
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

    fn diagnosis(&self, report: &StepReport, cause: Cause) -> Diagnosis {
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
                position: self.system.solid.reference()[node].xyz(),
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
