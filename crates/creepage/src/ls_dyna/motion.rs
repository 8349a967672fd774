//! Cards that move, load and damp the rigid hub, and those that start the disk.

use std::collections::BTreeMap;

use crate::ls_dyna::cards::Card;
use crate::ls_dyna::deck::{Deck, Initial, Load, Loaded, Target, Turning};
use crate::ls_dyna::error::{DeckError, DeckLine, second, unsupported};
use crate::ls_dyna::fields::{Layout, absent, number, real, real_or, rests, whole, zero};

/// A prescribed motion of a rigid body.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) place: DeckLine,
    /// The number of the body as a part, `PID`.
    pub(super) part: u64,
    pub(super) dof: i64,
    pub(super) curve: u64,
    pub(super) factor: f64,
    /// When it ends, `DEATH`.
    pub(super) death: f64,
}

/// Damping by mass and by stiffness.
#[derive(Clone, Debug, Default)]
pub(super) struct Damping {
    pub(super) relative: Option<Relative>,
    /// Coefficients of the stiffness of parts, in units of time, and their lines.
    pub(super) stiffness: BTreeMap<u64, (f64, DeckLine)>,
    /// The curve of `*DAMPING_GLOBAL` and its line.
    pub(super) global: Option<(u64, DeckLine)>,
}

/// Damping relative to the motion of a rigid body.
#[derive(Clone, Debug)]
pub(super) struct Relative {
    pub(super) place: DeckLine,
    /// Over the mass (1/time).
    pub(super) rate: f64,
    /// The number of the body as a part, `PIDRB`.
    pub(super) body: u64,
    /// The set of the parts that are damped, `PSID`.
    pub(super) parts: u64,
}

const PRESCRIBED: Layout<6> = Layout::new(&[
    number("PID"),
    whole("DOF"),
    whole("VAD"),
    number("LCID"),
    real_or("SF", 1.0),
    zero("VID"),
    real_or("DEATH", 1e28),
    zero("BIRTH"),
]);

const LOAD: Layout<4> = Layout::new(&[
    number("PID, NSID or NID"),
    whole("DOF"),
    number("LCID"),
    real_or("SF", 1.0),
    zero("CID"),
    zero("M1"),
    zero("M2"),
    zero("M3"),
]);

const INITIAL_OF: Layout<1> = Layout::new(&[
    number("NSID"),
    zero("NSIDEX"),
    zero("BOXID"),
    rests("IRIGID", &[1.0]),
    zero("ICID"),
]);

const INITIAL: Layout<1> =
    Layout::new(&[real("VX"), zero("VY"), zero("VZ"), zero("VXR"), zero("VYR"), zero("VZR")]);

const GENERATED: Layout<4> = Layout::new(&[
    number("ID"),
    whole("STYP"),
    real("OMEGA"),
    real("VX"),
    zero("VY"),
    zero("VZ"),
    zero("IVATN"),
    zero("ICID"),
]);

const AXIS: Layout<6> = Layout::new(&[
    real("XC"),
    real("YC"),
    real("ZC"),
    real("NX"),
    real("NY"),
    real("NZ"),
    zero("PHASE"),
    rests("IRIGID", &[1.0]),
]);

const START_TIME: Layout<1> = Layout::new(&[real("STIME")]);

const GLOBAL_DAMPING: Layout<1> = Layout::new(&[
    number("LCID"),
    zero("VALDMP"),
    zero("STX"),
    zero("STY"),
    zero("STZ"),
    absent("SRX"),
    absent("SRY"),
    absent("SRZ"),
]);

const RELATIVE_DAMPING: Layout<4> = Layout::new(&[
    real("CDAMP"),
    real("FREQ"),
    number("PIDRB"),
    number("PSID"),
    zero("DV2"),
    zero("LCID"),
]);

const STIFFNESS_DAMPING: Layout<2> = Layout::new(&[number("PID"), real("COEF")]);

impl Deck {
    /// Takes a card of the motion; whether it is one.
    pub(super) fn motion_card(&mut self, card: &Card) -> Result<bool, DeckError> {
        match card.name.as_str() {
            "BOUNDARY_PRESCRIBED_MOTION_RIGID" => self.prescribed(card)?,
            "LOAD_NODE_SET" | "LOAD_NODE_POINT" | "LOAD_RIGID_BODY" => self.load(card)?,
            "INITIAL_VELOCITY" => self.initial_velocity(card)?,
            "INITIAL_VELOCITY_GENERATION" => self.generated_velocity(card)?,
            "INITIAL_VELOCITY_GENERATION_START_TIME" => {
                let line = card.line(0)?;
                [self.begins] = line.take(&START_TIME)?;
                card.ends_after(1)?;
                if self.begins < 0.0 {
                    let what = format!("*{} with STIME = {}", card.name, self.begins);
                    return Err(unsupported(&line.place(), what, "give a time from 0 on"));
                }
            }
            "DAMPING_GLOBAL" => {
                let [curve] = card.line(0)?.take(&GLOBAL_DAMPING)?.map(|id| id as u64);
                card.ends_after(1)?;
                // without curve and value the card damps nothing
                self.damping.global = (curve > 0).then(|| (curve, card.place.clone()));
            }
            "DAMPING_RELATIVE" => {
                let line = card.line(0)?;
                let [share, frequency, body, parts] = line.take(&RELATIVE_DAMPING)?;
                card.ends_after(1)?;
                let rate = 4.0 * std::f64::consts::PI * share * frequency;
                let (place, body, parts) = (line.place(), body as u64, parts as u64);
                self.damping.relative = Some(Relative { place, rate, body, parts });
            }
            "DAMPING_PART_STIFFNESS" => self.stiffness_damping(card)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn stiffness_damping(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let [part, coefficient] = line.take(&STIFFNESS_DAMPING)?;
            if coefficient > 0.0 {
                let what = format!("*DAMPING_PART_STIFFNESS with COEF = {coefficient}");
                let remedy = "give it below 0: the coefficient of the stiffness in units of time";
                return Err(unsupported(&line.place(), what, remedy));
            }
            self.first("stiffness damping of part", part as u64, &line.place())?;
            self.damping.stiffness.insert(part as u64, (-coefficient, line.place()));
        }
        Ok(())
    }

    fn initial_velocity(&mut self, card: &Card) -> Result<(), DeckError> {
        let [nodes] = card.line(0)?.take(&INITIAL_OF)?;
        let [speed] = card.line(1)?.take(&INITIAL)?;
        let (place, name) = (card.place.clone(), card.name.clone());
        self.initial(card, Initial { place, card: name, speed, turn: None, of: (3, nodes as u64) })
    }

    /// Takes `*INITIAL_VELOCITY_GENERATION`: a velocity, and an angular velocity about an axis.
    fn generated_velocity(&mut self, card: &Card) -> Result<(), DeckError> {
        let (line, axis_line) = (card.line(0)?, card.line(1)?);
        let [id, kind, omega, speed] = line.take(&GENERATED)?;
        let [xc, yc, zc, axis @ ..] = axis_line.take(&AXIS)?;
        let (place, axis_place, centre) = (line.place(), axis_line.place(), [xc, yc, zc]);
        let turn = Some(Turning { place, omega, axis_place, centre, axis });
        let (place, name) = (card.place.clone(), card.name.clone());
        let of = (kind as i64, id as u64);
        self.initial(card, Initial { place, card: name, speed, turn, of })
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
            let [part, dof, what, curve, factor, death] = line.take(&PRESCRIBED)?;
            let (dof, what) = (dof as i64, what as i64);
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
            let (part, curve) = (part as u64, curve as u64);
            self.motions.push(Motion { place: line.place(), part, dof, curve, factor, death });
        }
        Ok(())
    }

    fn load(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let [id, dof, curve, factor] = line.take(&LOAD)?;
            let (id, place) = (id as u64, line.place());
            let set = card.name.ends_with("SET");
            let on = match card.name.as_str() {
                "LOAD_RIGID_BODY" => Loaded::Rigid(id),
                _ => Loaded::Nodes(Target { set, id, place: place.clone() }),
            };
            let (card, dof, curve) = (card.name.clone(), dof as i64, curve as u64);
            self.loads.push(Load { on, place, card, dof, curve, factor });
        }
        Ok(())
    }
}
