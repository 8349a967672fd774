//! What drives the disk: its rolling speed, and its angular velocity or the torque on it.

use std::collections::BTreeSet;

use crate::ls_dyna::cards::six;
use crate::ls_dyna::curve::Course;
use crate::ls_dyna::deck::{Deck, Initial, Turning};
use crate::ls_dyna::error::{DeckError, DeckLine, lacks, unknown, unsupported};
use crate::ls_dyna::loads;
use crate::ls_dyna::model::Model;
use crate::ls_dyna::motion::Motion;
use crate::ls_dyna::shape::Shape;
use crate::ls_dyna::units::Units;

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

/// Share by which numbers of a deck that mean one thing may differ: an axis that is off the axle by this share of the
/// radius adds as much to the speed.
const SAME: f64 = 1e-4;

impl Drive {
    /// The drive of a keyword file: that of the prescribed motion of the hub, or that of the initial velocity.
    ///
    /// # Errors
    /// No rolling speed; motions that a case does not have; curves that are not there.
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
        let spin = initial.turn.as_ref().map(|turn| about_the_axle(deck, turn, shape, units));
        let spin = spin.transpose()?;
        for motion in &deck.motions {
            deck.of_the_hub("BOUNDARY_PRESCRIBED_MOTION_RIGID", motion.part, &motion.place)?;
        }
        let speed = speed(deck, initial)?;
        turns_about_y_alone(deck)?;
        let mut ramps = Vec::new();
        let lateral_creepage = match deck.motion(2)? {
            Some((motion, course)) => {
                ramps.push(ramp(motion, &course, 0.0, units, notes)?);
                motion.factor * course.last / speed
            }
            None => 0.0,
        };
        // free rolling is what the initial velocity is
        let free = spin.unwrap_or(speed * units.length() / shape.radius);
        let turn = match (loads::torque(deck)?, deck.turned()?) {
            (Some(load), None) => {
                let course = deck.course(load.curve, &load.place)?;
                if !course.rests_before {
                    let what = "a torque before the disk begins to roll";
                    let remedy = "let its curve be 0 up to STIME";
                    return Err(unsupported(&load.place, what, remedy));
                }
                let of = Ramp { place: &load.place, curve: load.curve, factor: load.factor };
                ramps.push(of.duration(&course, 0.0, units, notes)?);
                let unit = model.alike() * units.force() * units.length();
                Turn::Torque(unit * load.factor * course.last)
            }
            (Some(load), Some((motion, _))) => {
                let what =
                    format!("a torque on a hub whose turn is prescribed in {}", motion.place);
                let remedy = "let the prescribed motion (DOF = 6) end, by DEATH, when the disk begins to roll";
                return Err(unsupported(&load.place, what, remedy));
            }
            (None, Some((motion, course))) => {
                ramps.push(ramp(motion, &course, free, units, notes)?);
                Turn::Creepage(motion.factor * course.last / free - 1.0)
            }
            (None, None) => {
                if spin.is_none() {
                    let note = "no angular velocity is given: drive.creepage = 0, change it";
                    notes.push(note.into());
                }
                Turn::Creepage(free * shape.radius / (speed * units.length()) - 1.0)
            }
        };
        Ok(Self {
            speed: speed * units.velocity(),
            turn,
            lateral_creepage,
            ramp: one_ramp(deck, &ramps)?.map(|t| t * units.time()),
        })
    }
}

/// A curve that drives the disk, times a factor.
struct Ramp<'a> {
    place: &'a DeckLine,
    curve: u64,
    factor: f64,
}

impl Ramp<'_> {
    /// How long it takes from `start` to the value at the end, in units of the deck.
    ///
    /// # Errors
    /// A curve that does otherwise than go from one to the other.
    fn duration(
        &self,
        course: &Course,
        start: f64,
        units: Units,
        notes: &mut Vec<String>,
    ) -> Result<f64, DeckError> {
        if !course.ramps_from(start / self.factor) {
            let what = format!(
                "a motion by curve {} that does not go from {start} to {} while the disk rolls",
                self.curve,
                self.factor * course.last
            );
            let remedy = "let it begin with free rolling, and go to its last value without turning back: a case has one ramp";
            return Err(unsupported(self.place, what, remedy));
        }
        if course.goes_on {
            notes.push(format!(
                "curve {} changes beyond ENDTIM: its value there counts, and drive.ramp = {:.4e} s ends there",
                self.curve,
                course.changes * units.time()
            ));
        }
        Ok(course.changes)
    }
}

fn ramp(
    motion: &Motion,
    course: &Course,
    start: f64,
    units: Units,
    notes: &mut Vec<String>,
) -> Result<f64, DeckError> {
    let of = Ramp { place: &motion.place, curve: motion.curve, factor: motion.factor };
    of.duration(course, start, units, notes)
}

/// The one duration of all ramps, in units of the deck.
fn one_ramp(deck: &Deck, ramps: &[f64]) -> Result<Option<f64>, DeckError> {
    let longest = ramps.iter().copied().fold(0.0, f64::max);
    let other = ramps.iter().any(|ramp| *ramp > 0.0 && (ramp - longest).abs() > SAME * longest);
    if let (true, Some(motion)) = (other, deck.motions.iter().find(|motion| motion.dof == 2)) {
        let what =
            "a lateral motion (DOF = 2) with a ramp of another duration than that of the turn";
        return Err(unsupported(&motion.place, what, "give both ramps one duration"));
    }
    Ok((!ramps.is_empty()).then_some(longest))
}

/// The rolling speed, in units of the deck: that of the initial velocity, which a prescribed motion keeps.
fn speed(deck: &Deck, initial: &Initial) -> Result<f64, DeckError> {
    let Some((motion, course)) = deck.motion(1)? else { return Ok(initial.speed) };
    let speed = motion.factor * course.last;
    let remedy = "let the disk roll on, towards +x, with the VX of its initial velocity";
    if speed <= 0.0 {
        let what = format!("a prescribed speed (DOF = 1) that ends at {speed}");
        return Err(unsupported(&motion.place, what, remedy));
    }
    if !course.is_constant() {
        let what =
            format!("a prescribed speed (DOF = 1) that changes to {speed} while the disk rolls");
        return Err(unsupported(&motion.place, what, remedy));
    }
    if (speed - initial.speed).abs() > SAME * speed {
        let vx = initial.speed;
        let what =
            format!("a prescribed speed (DOF = 1) of {speed} beside an initial velocity VX = {vx}");
        return Err(unsupported(&motion.place, what, remedy));
    }
    Ok(speed)
}

/// The angular velocity of the rolling disk, in units of the deck.
///
/// # Errors
/// One that does not roll forwards, or about another axis than the axle.
fn about_the_axle(
    deck: &Deck,
    turn: &Turning,
    shape: &Shape,
    units: Units,
) -> Result<f64, DeckError> {
    let [nx, ny, nz] = turn.axis;
    if [nx, nz] != [0.0; 2] || ny == 0.0 {
        let what = format!("an angular velocity about the axis NX, NY, NZ = {nx}, {ny}, {nz}");
        return Err(unsupported(&turn.axis_place, what, "turn the disk about y, its axle: NY = 1"));
    }
    let spin = turn.omega * ny.signum();
    if spin <= 0.0 {
        let what = format!("*INITIAL_VELOCITY_GENERATION with OMEGA = {spin} about y");
        let remedy = "give the angular velocity of the rolling disk, above 0 about the axis NY = 1";
        return Err(unsupported(&turn.place, what, remedy));
    }
    let [x, _, z] = turn.centre.map(|x| x * units.length());
    let off = libm::hypot(x - shape.axle[0], z - shape.axle[1]);
    // where the disk begins to roll late, the hub was pressed down before
    let pressed = deck.pressed() * units.length();
    if off > SAME * shape.radius + pressed {
        // a circle through nodes is as near as their digits
        let near_zero = |x: f64| x.abs() < 1e-6 * shape.radius;
        let [axle_x, axle_z] =
            shape.axle.map(|x| if near_zero(x) { 0.0 } else { x / units.length() });
        let [x, _, z] = turn.centre;
        let what = format!(
            "*INITIAL_VELOCITY_GENERATION about an axis at XC = {x}, ZC = {z}, off the axle at {}, {},",
            six(axle_x),
            six(axle_z)
        );
        let remedy = "put XC and ZC on the axle: about another axis the axle itself moves, with OMEGA times the distance";
        return Err(unsupported(&turn.axis_place, what, remedy));
    }
    Ok(spin)
}

/// Refuses a hub that turns about x or z.
fn turns_about_y_alone(deck: &Deck) -> Result<(), DeckError> {
    for dof in [5, 7] {
        let Some((motion, course)) = deck.motion(dof)? else { continue };
        if course.last != 0.0 || !course.is_constant() {
            let what = format!("a hub that turns about DOF = {dof}");
            return Err(unsupported(&motion.place, what, "let it turn about y alone (DOF = 6)"));
        }
    }
    Ok(())
}

/// Refuses an initial velocity of others than the disk, or of a piece of it.
fn starts_the_disk(deck: &Deck, model: &Model, initial: &Initial) -> Result<(), DeckError> {
    let (kind, id) = initial.of;
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
        // without a set all nodes move, those of the bar as well
        3 if id == 0 => false,
        3 => {
            let set = deck.node_sets.get(&id).ok_or_else(|| missing("node set"))?;
            whole(set, model.disk_nodes(), deck.axle)
        }
        _ => false,
    };
    if disk {
        return Ok(());
    }
    let what = format!("*{} of others than the whole disk", initial.card);
    let remedy = if initial.turn.is_some() {
        "give it to the disk alone: a set of all its parts (STYP 1), its part (2), all its nodes (3)"
    } else {
        "give it to the disk alone: NSID is the set of all its nodes"
    };
    Err(unsupported(at, what, remedy))
}

impl Deck {
    /// The prescribed motion of a degree of freedom while the disk rolls, and the course of its curve.
    ///
    /// # Errors
    /// A motion that ends before `ENDTIM`.
    fn motion(&self, dof: i64) -> Result<Option<(&Motion, Course)>, DeckError> {
        let Some(motion) = self.motions.iter().find(|motion| motion.dof == dof) else {
            return Ok(None);
        };
        if motion.death < self.end()? {
            let what =
                format!("a prescribed motion of DOF = {dof} with DEATH = {}", six(motion.death));
            let remedy = "let it last to ENDTIM; in z (DOF = 3), and about y (DOF = 6) where a torque follows, it may end when the disk begins to roll";
            return Err(unsupported(&motion.place, what, remedy));
        }
        let course = self.course(motion.curve, &motion.place)?;
        if dof != 3 && !course.rests_before {
            let what = format!("a prescribed motion of DOF = {dof} before the disk begins to roll");
            let remedy = "let its curve be 0 up to STIME: the disk is pressed down at rest";
            return Err(unsupported(&motion.place, what, remedy));
        }
        Ok(Some((motion, course)))
    }

    /// The prescribed turn about the axle while the disk rolls; none where it ends before and a torque takes its place.
    fn turned(&self) -> Result<Option<(&Motion, Course)>, DeckError> {
        let hands_over = |motion: &Motion| motion.dof == 6 && motion.death <= self.begins;
        if self.motions.iter().any(hands_over) && loads::torque(self)?.is_some() {
            return Ok(None);
        }
        self.motion(6)
    }

    /// Whether the height of the hub is held while the disk rolls.
    ///
    /// # Errors
    /// A displacement in z that changes meanwhile, or ends then.
    pub(crate) fn held(&self) -> Result<bool, DeckError> {
        // a displacement that ends with the preload hands over to the load
        if self.motions.iter().any(|motion| motion.dof == 3 && motion.death <= self.begins) {
            return Ok(false);
        }
        let Some((motion, course)) = self.motion(3)? else { return Ok(false) };
        if !course.is_constant() {
            let what = "a displacement in z (DOF = 3) that changes while the disk rolls";
            let remedy =
                "let it stay, or end when the disk begins to roll and a load takes its place";
            return Err(unsupported(&motion.place, what, remedy));
        }
        Ok(true)
    }

    /// How far the hub is pressed down before the disk rolls, at most, in units of the deck.
    fn pressed(&self) -> f64 {
        let motion = self.motions.iter().find(|motion| motion.dof == 3);
        let deepest = motion.and_then(|motion| {
            let deepest = self.curves.get(&motion.curve)?.largest_until(self.begins);
            Some((motion.factor * deepest).abs())
        });
        deepest.unwrap_or(0.0)
    }

    /// Refuses what moves or loads another part than the hub.
    pub(crate) fn of_the_hub(&self, card: &str, part: u64, at: &DeckLine) -> Result<(), DeckError> {
        if part == self.hub_part {
            return Ok(());
        }
        let what = format!("*{card} of PID {part}, which is not the hub's, {},", self.hub_part);
        let remedy = "move and load the hub alone: PID of *CONSTRAINED_NODAL_RIGID_BODY";
        Err(unsupported(at, what, remedy))
    }
}
