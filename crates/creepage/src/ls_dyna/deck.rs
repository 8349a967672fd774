//! What a keyword file says, card by card.

use serde::Serialize;
use std::collections::BTreeMap;

use crate::ls_dyna::cards::{AFTER_END, Card};
use crate::ls_dyna::curve::Curve;
use crate::ls_dyna::error::{DeckError, DeckLine, second};
use crate::ls_dyna::ignored::{ignored, refusal, unremarkable};
use crate::ls_dyna::motion::{Damping, Motion};

/// The model of a keyword file, in its own units and numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Deck {
    pub(super) nodes: Vec<Node>,
    pub(super) solids: Vec<Solid>,
    pub(super) parts: BTreeMap<u64, Part>,
    /// `ELFORM` of the sections, 1 or 2, by their number.
    pub(super) sections: BTreeMap<u64, i64>,
    pub(super) materials: BTreeMap<u64, Material>,
    /// `*HOURGLASS` by number; 0 stands for `*CONTROL_HOURGLASS`.
    pub(super) hourglass: BTreeMap<u64, Hourglass>,
    /// Quadratic and linear bulk viscosity of `*CONTROL_BULK_VISCOSITY`, Q1 and Q2.
    pub(super) bulk: [f64; 2],
    /// `SLSFAC`, the scale factor of penalty stiffness.
    pub(super) slsfac: f64,
    /// `TSSFAC`, the scale factor of the time step.
    pub(super) tssfac: f64,
    /// `ENDTIM`, the end time.
    pub(super) endtim: Option<f64>,
    pub(super) contact: Option<Contact>,
    pub(super) node_sets: BTreeMap<u64, Vec<u64>>,
    pub(super) segment_sets: BTreeMap<u64, Vec<[u64; 4]>>,
    pub(super) part_sets: BTreeMap<u64, Vec<u64>>,
    /// Nodes that are held in x, y and z.
    pub(super) clamped: Vec<Target>,
    /// Nodes of the rigid hub.
    pub(super) hub: Option<Target>,
    /// Its number as a part, `PID`.
    pub(super) hub_part: u64,
    /// The node of the rigid hub by which it is loaded, `PNODE`.
    pub(super) axle: Option<u64>,
    /// Nodes that are held in y alone.
    pub(super) sliding: Vec<Target>,
    /// Segment sets that do not reflect waves.
    pub(super) quiet: Vec<Target>,
    pub(super) loads: Vec<Load>,
    pub(super) motions: Vec<Motion>,
    /// When the initial velocities are given.
    pub(super) begins: f64,
    pub(super) damping: Damping,
    /// Mass of the rigid hub with its nodes and its centre, where the file gives them.
    pub(super) inertia: Option<Inertia>,
    /// Intervals of the records of fields and of interface forces; 0 where there are none.
    pub(super) intervals: [f64; 2],
    pub(super) initial: Option<Initial>,
    /// The curves by their number.
    pub(super) curves: BTreeMap<u64, Curve>,
    /// Units that the deck names: those of length, mass and time.
    pub(super) units: Option<(DeckLine, [&'static str; 3])>,
    /// Keywords that were ignored, each once.
    pub(super) passed_over: Vec<String>,
    /// Where keywords follow `*END`.
    pub(super) after_end: Vec<DeckLine>,
    pub(super) account: Account,
    /// Where things of which a deck has one, and things with a number, were given.
    given: BTreeMap<(&'static str, u64), DeckLine>,
}

/// What became of the cards of a deck.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Account {
    /// Cards whose fields the case takes.
    pub used: usize,
    /// Cards of the list of docs/ls-dyna.md that a case does without.
    pub ignored: usize,
    /// Cards that are refused; none in a deck that was read.
    pub refused: usize,
}

/// A node with its number, its line and its position.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) id: u64,
    pub(super) place: DeckLine,
    pub(super) point: [f64; 3],
}

/// A solid element with the numbers of its part and nodes.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub(super) id: u64,
    pub(super) part: u64,
    pub(super) place: DeckLine,
    pub(super) nodes: [u64; 8],
}

/// The numbers of a part's section, material and hourglass card; 0 for no hourglass card.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) section: u64,
    pub(super) material: u64,
    pub(super) hourglass: u64,
    pub(super) place: DeckLine,
}

/// RO, E and PR of an elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Material {
    pub(super) density: f64,
    pub(super) young: f64,
    pub(super) poisson: f64,
}

/// Hourglass control by stiffness.
#[derive(Clone, Debug)]
pub(super) struct Hourglass {
    /// `QM`.
    pub(super) coefficient: f64,
    /// Q1 and Q2 where the card gives them.
    pub(super) bulk: Option<[f64; 2]>,
}

/// The contact card.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    pub(super) place: DeckLine,
    pub(super) sides: [Side; 2],
    /// Coefficient of friction at rest.
    pub(super) fs: f64,
    /// Coefficient of friction at high slip velocity.
    pub(super) fd: f64,
    /// Decay of friction with slip velocity, in time over length.
    pub(super) dc: f64,
    /// Viscous damping in per cent of critical.
    pub(super) vdc: f64,
    /// `DT`, when it ends, and the line that says so.
    pub(super) ends: (DeckLine, f64),
    /// `SFS` and `SFM`, which are equal.
    pub(super) sf: f64,
}

/// What makes up a side of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    /// The segments of a set.
    Segments(u64),
    /// The outer faces of a part.
    Part(u64),
    /// The outer faces of the parts of a set.
    PartSet(u64),
}

/// Nodes that a card acts on: a node set, or one node.
#[derive(Clone, Debug)]
pub(super) struct Target {
    /// Whether `id` is the number of a set.
    pub(super) set: bool,
    pub(super) id: u64,
    pub(super) place: DeckLine,
}

/// A force or a torque: `factor` times a curve.
#[derive(Clone, Debug)]
pub(super) struct Load {
    pub(super) on: Loaded,
    pub(super) place: DeckLine,
    /// The keyword.
    pub(super) card: String,
    /// 1 to 3 for forces along x, y and z, 5 to 7 for torques about them.
    pub(super) dof: i64,
    pub(super) curve: u64,
    pub(super) factor: f64,
}

/// What a load acts on.
#[derive(Clone, Debug)]
pub(super) enum Loaded {
    /// Each of these nodes.
    Nodes(Target),
    /// The rigid body of this part.
    Rigid(u64),
}

/// What the card of the hub says of its mass.
#[derive(Clone, Debug)]
pub(super) struct Inertia {
    pub(super) place: DeckLine,
    /// `TM`.
    pub(super) mass: f64,
    /// `XC`, `YC` and `ZC`.
    pub(super) centre: [f64; 3],
    /// `IYY`.
    pub(super) moment: f64,
    /// `NODEID`, the node that is the centre instead, where it is above 0.
    pub(super) node: u64,
}

/// The initial velocity.
#[derive(Clone, Debug)]
pub(super) struct Initial {
    /// The line of the keyword.
    pub(super) place: DeckLine,
    /// The keyword.
    pub(super) card: String,
    /// Velocity in x.
    pub(super) speed: f64,
    pub(super) turn: Option<Turning>,
    /// `STYP` and the number of the part, part set or node set that has the velocity.
    pub(super) of: (i64, u64),
}

/// An angular velocity about an axis.
#[derive(Clone, Debug)]
pub(super) struct Turning {
    /// The line of `OMEGA`.
    pub(super) place: DeckLine,
    pub(super) omega: f64,
    /// The line of the axis.
    pub(super) axis_place: DeckLine,
    /// `XC`, `YC` and `ZC`, a point of the axis.
    pub(super) centre: [f64; 3],
    /// `NX`, `NY` and `NZ`, its direction.
    pub(super) axis: [f64; 3],
}

/// Cards that a deck has once.
const ONCE: [&str; 11] = [
    "CONTROL_BULK_VISCOSITY",
    "CONTROL_CONTACT",
    "CONTROL_HOURGLASS",
    "CONTROL_TERMINATION",
    "CONTROL_TIMESTEP",
    "CONTROL_UNITS",
    "DAMPING_GLOBAL",
    "DAMPING_RELATIVE",
    "DATABASE_BINARY_D3PLOT",
    "DATABASE_BINARY_INTFOR",
    "INITIAL_VELOCITY_GENERATION_START_TIME",
];

impl Deck {
    /// Takes the cards of a deck.
    ///
    /// # Errors
    /// What is not read: the first card that is refused, with the others.
    pub(super) fn read(cards: &[Card]) -> Result<Self, DeckError> {
        // LS-DYNA's defaults
        let mut deck = Self { bulk: [1.5, 0.06], slsfac: 0.1, tssfac: 0.9, ..Self::default() };
        let mut refused = cards.iter().filter_map(|card| deck.card(card).err());
        let Some(first) = refused.next() else { return Ok(deck) };
        let further = refused.collect();
        Err(first.with(further))
    }

    /// Takes a card into the model, ignores it or refuses it.
    fn card(&mut self, card: &Card) -> Result<(), DeckError> {
        if card.name == AFTER_END {
            self.after_end.push(card.place.clone());
            return Ok(());
        }
        if let Some(name) = ONCE.into_iter().find(|name| *name == card.name) {
            self.first(name, 0, &card.place)?;
        }
        if self.body_card(card)?
            || self.set_card(card)?
            || self.control_card(card)?
            || self.motion_card(card)?
            || self.curve_card(card)?
            || card.is_of_the_file()?
        {
            self.account.used += 1;
            return Ok(());
        }
        if !ignored(card)? {
            return Err(refusal(card));
        }
        self.account.ignored += 1;
        let name = format!("*{}", card.name);
        if !unremarkable(&card.name) && !self.passed_over.contains(&name) {
            self.passed_over.push(name);
        }
        Ok(())
    }

    /// Refuses a second thing of a kind with the same number, which would take the place of the first.
    pub(super) fn first(
        &mut self,
        kind: &'static str,
        id: u64,
        at: &DeckLine,
    ) -> Result<(), DeckError> {
        let Some(before) = self.given.insert((kind, id), at.clone()) else { return Ok(()) };
        let what = if id == 0 { format!("*{kind}") } else { format!("{kind} {id}") };
        Err(second(at, what, &before, "keep one of the two"))
    }
}
