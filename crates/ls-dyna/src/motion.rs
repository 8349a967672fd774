//! Cards that move, load and damp the rigid hub.

use crate::cards::{Card, TENS, unsupported};
use crate::deck::{Deck, line, lines, nonzero};
use mesh::import::ImportError;

/// A prescribed motion of a rigid body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) line: usize,
    pub(super) dof: i64,
    pub(super) curve: u64,
    pub(super) factor: f64,
    /// Whether it ends, by `DEATH`.
    pub(super) ends: bool,
}

/// A force or a torque on a rigid body.
#[derive(Clone, Copy, Debug)]
pub(super) struct RigidLoad {
    pub(super) line: usize,
    pub(super) dof: i64,
    pub(super) curve: u64,
    pub(super) factor: f64,
}

/// Damping by mass and by stiffness.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Damping {
    /// Relative to the motion of a rigid body (1/time).
    pub(super) relative: Option<f64>,
    /// Coefficient of the stiffness of parts, in units of time.
    pub(super) stiffness: Option<f64>,
    /// The curve of `*DAMPING_GLOBAL` and its line.
    pub(super) global: Option<(u64, usize)>,
}

impl Deck {
    /// Takes a card of the motion; whether it is one.
    pub(super) fn motion_card(&mut self, card: &Card) -> Result<bool, ImportError> {
        match card.name.as_str() {
            "BOUNDARY_PRESCRIBED_MOTION_RIGID" => self.prescribed(card)?,
            "LOAD_RIGID_BODY" => self.rigid_load(card)?,
            "INITIAL_VELOCITY_GENERATION_START_TIME" => {
                self.begins = line(card, 0)?.fields(&TENS).real(0, 0.0)?;
            }
            "BOUNDARY_NON_REFLECTING" => self.quiet = true,
            "DAMPING_GLOBAL" => {
                let fields = line(card, 0)?.fields(&TENS);
                fields.unused(&card.name, &[(1, "VALDMP")])?;
                self.damping.global = Some((fields.id(0)?, card.line));
            }
            "DAMPING_RELATIVE" => {
                let fields = line(card, 0)?.fields(&TENS);
                fields.unused(&card.name, &[(4, "DV2"), (5, "LCID")])?;
                let (share, frequency) = (fields.real(0, 0.0)?, fields.real(1, 0.0)?);
                self.damping.relative = Some(4.0 * std::f64::consts::PI * share * frequency);
            }
            "DAMPING_PART_STIFFNESS" => {
                for line in lines(card) {
                    let coefficient = line.fields(&TENS).real(1, 0.0)?;
                    if coefficient > 0.0 {
                        let what = format!("*DAMPING_PART_STIFFNESS with COEF = {coefficient}");
                        let remedy =
                            "give it below 0: the coefficient of the stiffness in units of time";
                        return Err(unsupported(line.at, what, remedy));
                    }
                    self.damping.stiffness = Some(-coefficient);
                }
            }
            // of initial velocities and damping, which are the disk's anyway
            "SET_PART" | "SET_PART_LIST" => {}
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn prescribed(&mut self, card: &Card) -> Result<(), ImportError> {
        for line in lines(card) {
            let fields = line.fields(&TENS);
            let (dof, what) = (fields.whole(1)?, fields.whole(2)?);
            let depth = (dof, what) == (3, 2);
            let rate = matches!(dof, 1 | 2 | 5 | 6 | 7) && what == 0;
            if !(depth || rate) {
                let what = format!("*{} with DOF = {dof}, VAD = {what}", card.name);
                let remedy =
                    "prescribe velocities (VAD = 0), and in z (DOF = 3) a displacement (VAD = 2)";
                return Err(unsupported(line.at, what, remedy));
            }
            let factor = nonzero(fields.real(4, 1.0)?, 1.0);
            let (curve, ends) = (fields.id(3)?, fields.real(6, 0.0)? != 0.0);
            self.motions.push(Motion { line: line.at, dof, curve, factor, ends });
        }
        Ok(())
    }

    fn rigid_load(&mut self, card: &Card) -> Result<(), ImportError> {
        for line in lines(card) {
            let fields = line.fields(&TENS);
            fields.unused(&card.name, &[(4, "CID")])?;
            let dof = fields.whole(1)?;
            if !matches!(dof, 3 | 6) {
                let what = format!("*{} with DOF = {dof}", card.name);
                let remedy = "load the hub in z (DOF = 3) and turn it about y (DOF = 6)";
                return Err(unsupported(line.at, what, remedy));
            }
            let factor = nonzero(fields.real(3, 1.0)?, 1.0);
            self.rigid_loads.push(RigidLoad { line: line.at, dof, curve: fields.id(2)?, factor });
        }
        Ok(())
    }
}
