//! What drives the disk: its rolling speed, and its angular velocity or the torque on it.

use crate::deck::Deck;
use crate::model::{Model, Symmetry, lacks};
use crate::motion::Motion;
use crate::shape::Shape;
use crate::units::Units;
use mesh::import::{Fault, ImportError};

/// The drive of a case, in SI units.
pub(crate) struct Drive {
    /// Rolling speed (m/s).
    pub(crate) speed: f64,
    pub(crate) turn: Turn,
    pub(crate) lateral_creepage: f64,
    /// Duration of the ramp (s), where curves say it.
    pub(crate) ramp: Option<f64>,
}

/// What turns the disk.
pub(crate) enum Turn {
    /// Its creepage (dimensionless).
    Creepage(f64),
    /// A torque (N m).
    Torque(f64),
}

impl Drive {
    /// The drive of a keyword file: that of the prescribed motion of the hub, or that of the initial velocity.
    ///
    /// # Errors
    /// No rolling speed; curves that are not there.
    pub(crate) fn of(
        deck: &Deck,
        model: &Model,
        shape: &Shape,
        units: Units,
        notes: &mut Vec<String>,
    ) -> Result<Self, ImportError> {
        let initial = deck.initial.filter(|initial| initial.speed > 0.0).ok_or_else(|| {
            lacks(
                "*INITIAL_VELOCITY or *INITIAL_VELOCITY_GENERATION with VX above 0: the rolling speed",
            )
        })?;
        let motion = |dof: i64| deck.motions.iter().find(|motion| motion.dof == dof);
        let last = |motion: Option<&Motion>| {
            let last = |m: &Motion| Ok(m.factor * deck.last(m.curve, m.line)?);
            motion.map(last).transpose()
        };
        let speed = last(motion(1))?.unwrap_or(initial.speed);
        let lateral_creepage = last(motion(2))?.unwrap_or(0.0) / speed;
        for m in [5, 7].into_iter().filter_map(motion) {
            let points = deck.points(m.curve, m.line)?;
            if points.iter().any(|[_, value]| *value != 0.0) {
                return Err(lacks(
                    "hub that turns about its axle alone: DOF 5 and 7 are not at rest",
                ));
            }
        }
        let torque = deck.rigid_loads.iter().find(|load| load.dof == 6);
        let turned = motion(6).filter(|motion| !motion.ends);
        let (turn, curve) = match (torque, turned, initial.spin) {
            (Some(load), _, _) => {
                let alike = if model.symmetry == Symmetry::Half { 2.0 } else { 1.0 };
                let unit = units.force() * units.length();
                let torque = alike * unit * load.factor * deck.last(load.curve, load.line)?;
                (Turn::Torque(torque), Some((load.curve, load.line)))
            }
            // free rolling is what the initial velocity is
            (None, Some(m), Some(free)) => {
                let end = m.factor * deck.last(m.curve, m.line)?;
                (Turn::Creepage(end / free - 1.0), Some((m.curve, m.line)))
            }
            (None, _, Some(spin)) => {
                let speed = initial.speed * units.velocity();
                (Turn::Creepage(spin / units.time() * shape.radius / speed - 1.0), None)
            }
            (None, _, None) => {
                notes.push("no angular velocity is given: drive.creepage = 0, change it".into());
                (Turn::Creepage(0.0), None)
            }
        };
        let ramp =
            curve.map(|(curve, line)| ramp(deck.points(curve, line)?, deck.begins)).transpose()?;
        Ok(Self {
            speed: speed * units.velocity(),
            turn,
            lateral_creepage,
            ramp: ramp.map(|t| t * units.time()),
        })
    }
}

/// How long after the time `begins` the values of a curve still change.
fn ramp(points: &[[f64; 2]], begins: f64) -> Result<f64, ImportError> {
    let last = points.last().ok_or_else(|| lacks("points of a curve"))?[1];
    let changed = points.iter().rposition(|[_, value]| *value != last);
    let end = changed.and_then(|i| points.get(i + 1)).map_or(begins, |[t, _]| *t);
    Ok((end - begins).max(0.0))
}

impl Deck {
    /// The points of a curve to which a line of the file refers.
    pub(crate) fn points(&self, curve: u64, line: usize) -> Result<&[[f64; 2]], ImportError> {
        let unknown = || {
            let (from, what) = ("the card".into(), format!("curve {curve}"));
            ImportError { line: Some(line), fault: Fault::Unknown { from, what } }
        };
        self.curves
            .get(&curve)
            .filter(|points| !points.is_empty())
            .map(Vec::as_slice)
            .ok_or_else(unknown)
    }

    /// The last value of such a curve.
    pub(crate) fn last(&self, curve: u64, line: usize) -> Result<f64, ImportError> {
        Ok(self.points(curve, line)?.last().map_or(0.0, |[_, value]| *value))
    }
}
