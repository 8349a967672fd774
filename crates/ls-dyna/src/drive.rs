//! What drives the disk: its rolling speed, and its angular velocity or the torque on it.

use crate::deck::{Deck, Initial};
use crate::error::{DeckError, Place, lacks, unknown, unsupported};
use crate::model::Model;
use crate::motion::Motion;
use crate::shape::Shape;
use crate::units::Units;
use std::collections::BTreeSet;

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
    ) -> Result<Self, DeckError> {
        let initial = deck.initial.as_ref().filter(|initial| initial.speed > 0.0).ok_or_else(|| {
            lacks(
                "*INITIAL_VELOCITY or *INITIAL_VELOCITY_GENERATION with VX above 0: the rolling speed",
            )
        })?;
        starts_the_disk(deck, model, initial)?;
        let motion = |dof: i64| deck.motions.iter().find(|motion| motion.dof == dof);
        let last = |motion: Option<&Motion>| {
            let last = |m: &Motion| Ok(m.factor * deck.last(m.curve, &m.place)?);
            motion.map(last).transpose()
        };
        let speed = last(motion(1))?.unwrap_or(initial.speed);
        if let Some(m) = motion(1).filter(|_| speed <= 0.0) {
            let what = format!("a prescribed speed (DOF = 1) that ends at {speed}");
            return Err(unsupported(&m.place, what, "let the disk roll on, towards +x"));
        }
        let lateral_creepage = last(motion(2))?.unwrap_or(0.0) / speed;
        turns_about_y_alone(deck)?;
        let torque = deck.rigid_loads.iter().find(|load| load.dof == 6);
        let turned = motion(6).filter(|motion| !motion.ends);
        let (turn, curve) = match (torque, turned, initial.spin) {
            (Some(load), _, _) => {
                let unit = model.alike() * units.force() * units.length();
                let torque = unit * load.factor * deck.last(load.curve, &load.place)?;
                (Turn::Torque(torque), Some((load.curve, &load.place)))
            }
            // free rolling is what the initial velocity is
            (None, Some(m), Some(free)) => {
                let end = m.factor * deck.last(m.curve, &m.place)?;
                (Turn::Creepage(end / free - 1.0), Some((m.curve, &m.place)))
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
            curve.map(|(curve, at)| ramp(deck.points(curve, at)?, deck.begins)).transpose()?;
        Ok(Self {
            speed: speed * units.velocity(),
            turn,
            lateral_creepage,
            ramp: ramp.map(|t| t * units.time()),
        })
    }
}

/// Refuses a hub that turns about x or z.
fn turns_about_y_alone(deck: &Deck) -> Result<(), DeckError> {
    for m in deck.motions.iter().filter(|motion| matches!(motion.dof, 5 | 7)) {
        let points = deck.points(m.curve, &m.place)?;
        if points.iter().any(|[_, value]| *value != 0.0) {
            let what = format!("a hub that turns about DOF = {}", m.dof);
            return Err(unsupported(&m.place, what, "let it turn about y alone (DOF = 6)"));
        }
    }
    Ok(())
}

/// Refuses an initial velocity of others than the disk, or of a piece of it.
fn starts_the_disk(deck: &Deck, model: &Model, initial: &Initial) -> Result<(), DeckError> {
    let Some((kind, id)) = initial.of else { return Ok(()) };
    let at = &initial.place;
    let missing = |what: &str| unknown(at, "the card", format!("{what} {id}"));
    let whole = |given: &[u64], disk: BTreeSet<u64>, hub: Option<u64>| {
        let given: BTreeSet<u64> = given.iter().copied().filter(|id| Some(*id) != hub).collect();
        given == disk
    };
    let parts = || model.parts[0].iter().copied().collect();
    let disk = match kind {
        1 => {
            let set = deck.part_sets.get(&id).ok_or_else(|| missing("part set"))?;
            whole(set, parts(), Some(deck.hub_part))
        }
        2 => whole(&[id], parts(), None),
        3 => {
            let set = deck.node_sets.get(&id).ok_or_else(|| missing("node set"))?;
            whole(set, model.disk_nodes(), deck.axle)
        }
        _ => false,
    };
    if disk {
        return Ok(());
    }
    let what = "*INITIAL_VELOCITY_GENERATION of others than the whole disk";
    let remedy = "give it to the disk alone: a set of all its parts (STYP 1), its part (2), all its nodes (3)";
    Err(unsupported(at, what, remedy))
}

/// How long after the time `begins` the values of a curve still change.
fn ramp(points: &[[f64; 2]], begins: f64) -> Result<f64, DeckError> {
    let last = points.last().ok_or_else(|| lacks("points of a curve"))?[1];
    let changed = points.iter().rposition(|[_, value]| *value != last);
    let end = changed.and_then(|i| points.get(i + 1)).map_or(begins, |[t, _]| *t);
    Ok((end - begins).max(0.0))
}

impl Deck {
    /// The points of a curve to which a line of the file refers.
    pub(crate) fn points(&self, curve: u64, at: &Place) -> Result<&[[f64; 2]], DeckError> {
        self.curves
            .get(&curve)
            .filter(|points| !points.is_empty())
            .map(Vec::as_slice)
            .ok_or_else(|| unknown(at, "the card", format!("curve {curve}")))
    }

    /// The last value of such a curve.
    pub(crate) fn last(&self, curve: u64, at: &Place) -> Result<f64, DeckError> {
        Ok(self.points(curve, at)?.last().map_or(0.0, |[_, value]| *value))
    }
}
