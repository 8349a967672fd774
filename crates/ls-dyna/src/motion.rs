//! Cards that move, load and damp the rigid hub.

use crate::cards::{Card, Fields, TENS};
use crate::deck::{Deck, Initial, nonzero};
use crate::error::{DeckError, Place, second, unsupported};

/// A prescribed motion of a rigid body.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) place: Place,
    pub(super) dof: i64,
    pub(super) curve: u64,
    pub(super) factor: f64,
    /// Whether it ends, by `DEATH`.
    pub(super) ends: bool,
}

/// A force or a torque on a rigid body.
#[derive(Clone, Debug)]
pub(super) struct RigidLoad {
    pub(super) place: Place,
    pub(super) dof: i64,
    pub(super) curve: u64,
    pub(super) factor: f64,
}

/// Damping by mass and by stiffness.
#[derive(Clone, Debug, Default)]
pub(super) struct Damping {
    /// Relative to the motion of a rigid body (1/time).
    pub(super) relative: Option<f64>,
    /// Coefficient of the stiffness of parts, in units of time.
    pub(super) stiffness: Option<f64>,
    /// The curve of `*DAMPING_GLOBAL` and its line.
    pub(super) global: Option<(u64, Place)>,
}

impl Deck {
    /// Takes a card of the motion; whether it is one.
    pub(super) fn motion_card(&mut self, card: &Card) -> Result<bool, DeckError> {
        match card.name.as_str() {
            "BOUNDARY_PRESCRIBED_MOTION_RIGID" => self.prescribed(card)?,
            "LOAD_RIGID_BODY" => self.rigid_load(card)?,
            "INITIAL_VELOCITY" => {
                let fields = card.line(1)?.fields(&TENS);
                let remaining = [(1, "VY"), (2, "VZ"), (3, "VXR"), (4, "VYR"), (5, "VZR")];
                fields.unused(&card.name, &remaining)?;
                let speed = fields.real(0, 0.0)?;
                let place = card.place.clone();
                self.initial(card, Initial { place, speed, spin: None, of: None })?;
            }
            "INITIAL_VELOCITY_GENERATION" => self.generated_velocity(card)?,
            "INITIAL_VELOCITY_GENERATION_START_TIME" => {
                self.begins = card.line(0)?.fields(&TENS).real(0, 0.0)?;
            }
            "DAMPING_GLOBAL" => {
                let fields = card.line(0)?.fields(&TENS);
                fields.unused(&card.name, &[(1, "VALDMP")])?;
                // without curve and value the card damps nothing
                let curve = Some(fields.id(0)?).filter(|curve| *curve > 0);
                self.damping.global = curve.map(|curve| (curve, card.place.clone()));
            }
            "DAMPING_RELATIVE" => {
                let fields = card.line(0)?.fields(&TENS);
                fields.unused(&card.name, &[(4, "DV2"), (5, "LCID")])?;
                let (share, frequency) = (fields.real(0, 0.0)?, fields.real(1, 0.0)?);
                self.damping.relative = Some(4.0 * std::f64::consts::PI * share * frequency);
            }
            "DAMPING_PART_STIFFNESS" => self.stiffness_damping(card)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn stiffness_damping(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let coefficient = line.fields(&TENS).real(1, 0.0)?;
            if coefficient > 0.0 {
                let what = format!("*DAMPING_PART_STIFFNESS with COEF = {coefficient}");
                let remedy = "give it below 0: the coefficient of the stiffness in units of time";
                return Err(unsupported(&line.place(), what, remedy));
            }
            self.damping.stiffness = Some(-coefficient);
        }
        Ok(())
    }

    /// Takes `*INITIAL_VELOCITY_GENERATION`: the velocity of the axle and the angular velocity about it.
    fn generated_velocity(&mut self, card: &Card) -> Result<(), DeckError> {
        let fields = card.line(0)?.fields(&TENS);
        fields.unused(&card.name, &[(4, "VY"), (5, "VZ"), (6, "IVATN"), (7, "ICID")])?;
        let axis = card.line(1)?.fields(&TENS);
        axis.unused(&card.name, &[(3, "NX"), (5, "NZ"), (6, "PHASE")])?;
        let spin = fields.real(2, 0.0)? * axis.real(4, 0.0)?.signum();
        if spin <= 0.0 {
            let what = format!("*{} with OMEGA = {spin} about y", card.name);
            let remedy =
                "give the angular velocity of the rolling disk, above 0 about the axis NY = 1";
            return Err(unsupported(&fields.place(), what, remedy));
        }
        let (place, speed) = (card.place.clone(), fields.real(3, 0.0)?);
        let of = Some((fields.whole(1)?, fields.id(0)?));
        self.initial(card, Initial { place, speed, spin: Some(spin), of })
    }

    fn initial(&mut self, card: &Card, initial: Initial) -> Result<(), DeckError> {
        let mut further = card.all_lines().skip(2).filter(|line| !line.text.trim().is_empty());
        let further = further.next().map(|line| (line.place(), card.place.clone()));
        let another = self.initial.as_ref().map(|first| (card.place.clone(), first.place.clone()));
        if let Some((at, before)) = further.or(another) {
            return Err(second(&at, "initial velocity", &before, "keep that of the disk alone"));
        }
        self.initial = Some(initial);
        Ok(())
    }

    fn prescribed(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let fields = line.fields(&TENS);
            self.of_the_hub(card, &fields)?;
            let (dof, what) = (fields.whole(1)?, fields.whole(2)?);
            let depth = (dof, what) == (3, 2);
            let rate = matches!(dof, 1 | 2 | 5 | 6 | 7) && what == 0;
            if !(depth || rate) {
                let what = format!("*{} with DOF = {dof}, VAD = {what}", card.name);
                let remedy =
                    "prescribe velocities (VAD = 0), and in z (DOF = 3) a displacement (VAD = 2)";
                return Err(unsupported(&line.place(), what, remedy));
            }
            if let Some(before) = self.motions.iter().find(|motion| motion.dof == dof) {
                let what = format!("prescribed motion of DOF = {dof}");
                let remedy = "put both into one curve: a case has one motion of each kind";
                return Err(second(&line.place(), what, &before.place, remedy));
            }
            let factor = nonzero(fields.real(4, 1.0)?, 1.0);
            let (curve, ends) = (fields.id(3)?, fields.real(6, 0.0)? != 0.0);
            self.motions.push(Motion { place: line.place(), dof, curve, factor, ends });
        }
        Ok(())
    }

    fn rigid_load(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let fields = line.fields(&TENS);
            self.of_the_hub(card, &fields)?;
            fields.unused(&card.name, &[(4, "CID")])?;
            let dof = fields.whole(1)?;
            if !matches!(dof, 3 | 6) {
                let what = format!("*{} with DOF = {dof}", card.name);
                let remedy = "load the hub in z (DOF = 3) and turn it about y (DOF = 6)";
                return Err(unsupported(&line.place(), what, remedy));
            }
            let factor = nonzero(fields.real(3, 1.0)?, 1.0);
            let (place, curve) = (line.place(), fields.id(2)?);
            self.rigid_loads.push(RigidLoad { place, dof, curve, factor });
        }
        Ok(())
    }

    /// Refuses what moves or loads another part than the hub.
    fn of_the_hub(&self, card: &Card, fields: &Fields) -> Result<(), DeckError> {
        let part = fields.id(0)?;
        if part == self.hub_part {
            return Ok(());
        }
        let what =
            format!("*{} of PID {part}, which is not the hub's, {},", card.name, self.hub_part);
        let remedy = "move and load the hub alone: PID of *CONSTRAINED_NODAL_RIGID_BODY";
        Err(unsupported(&fields.place(), what, remedy))
    }
}
