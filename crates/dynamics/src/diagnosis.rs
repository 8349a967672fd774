//! What the guards say of a run that they stop.

use crate::unsolved::Unsolved;
use nalgebra::Vector3;
use std::fmt;

/// Coefficient of the hourglass stiffness that is usual (Flanagan and Belytschko 1981).
pub const USUAL_HOURGLASS: f64 = 0.05;

/// Why the guards stopped a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The time step is larger than the stability limit.
    UnstableStep {
        /// Step over the longest stable one.
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
    pub position: Vector3<f64>,
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
                "the time step is {ratio:.2} times the stability limit and the motion \
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
        let [x, y, z] = (1e3 * place.position).into();
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
