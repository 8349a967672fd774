//! A case as an LS-DYNA keyword file.
//!
//! The mesh is that of the run before the preload. The hub, a nodal rigid body, presses it down by a prescribed displacement
//! to the depth that the static preload finds, while the disk stands; then the load takes the place of the displacement, since
//! another program's contact is not as stiff, and damping brings all to rest. Then the disk takes up the velocity of free rolling, as a run
//! does at t = 0. Which key becomes which card: docs/ls-dyna.md.

mod columns;
mod contact;
mod limits;
mod mesh;
mod motion;
mod requests;
#[cfg(test)]
mod tests;

pub use limits::unsayable;

use crate::case::schema::{Case, DriveMode, LoadMode};
use crate::ls_dyna::units::Units;
use crate::scenario::{BAR, DISK, InitialState, Model};
use columns::Cards;

/// A run at its start: its case, its bodies, and what the preload and the stability analysis found.
pub struct RollingMotion<'a> {
    /// The case, of which [`unsayable`] has nothing to say.
    pub case: &'a Case,
    /// Its bodies.
    pub model: &'a Model,
    /// Depth of the hub, rolling radius and time step.
    pub facts: &'a InitialState,
}

/// A keyword file, and what it says in another way than the case.
#[derive(Clone, Debug, PartialEq)]
pub struct Exported {
    /// Its text.
    pub deck: String,
    /// What keyword files say only nearly, one sentence each; the deck's head lists them.
    pub notes: Vec<String>,
}

/// Numbers of the sets, parts and curves of a deck.
mod number {
    /// The elements with one point, of the disk and of the bar.
    pub(super) const PARTS: [u64; 2] = [1, 2];
    /// The fully integrated elements of both.
    pub(super) const FULL: [u64; 2] = [3, 4];
    /// The hub as a rigid body.
    pub(super) const HUB: u64 = 5;
    /// Sections with one point and with eight.
    pub(super) const SECTIONS: [u64; 2] = [1, 2];
    /// Node sets: the hub, the clamped nodes, those that do not move along y, those whose motion is recorded.
    pub(super) const HUB_NODES: u64 = 1;
    pub(super) const CLAMPED: u64 = 2;
    pub(super) const SLIDING: u64 = 3;
    pub(super) const RECORDED: u64 = 4;
    /// Segment sets: tread and top, and the quiet ends. Some programs have one kind of set: no number stands twice.
    pub(super) const SURFACES: [u64; 2] = [11, 12];
    pub(super) const ENDS: u64 = 13;
    /// The part set of the disk.
    pub(super) const DISK_PARTS: u64 = 21;
}

/// Radii of the disk that a shear wave crosses while the hub goes down: slow beside the vibrations of the disk.
const RADII: f64 = 12.0;
/// Time in which the disk comes to rest under the load, times the angular frequency of its bounce: with critical damping 2 % of what
/// is left then remain.
const REST: f64 = 6.0;

impl RollingMotion<'_> {
    /// Duration of the preload in the deck (s): whole microseconds, all of whose digits its columns hold.
    pub fn preload_time(&self) -> f64 {
        (1e6 * (self.pressing_time() + REST / self.bounce())).ceil() / 1e6
    }

    /// Time in which the hub goes down (s).
    fn pressing_time(&self) -> f64 {
        RADII * self.case.disk.radius / self.model.materials[DISK].c_s()
    }

    /// Angular frequency (rad/s) at which the disk bounces on the contact, whose stiffness is by Hertz 3/2 of force over approach.
    fn bounce(&self) -> f64 {
        let disk = &self.model.mesh.bodies[DISK].nodes;
        let mass = self.model.multiplicity * self.model.mass[disk.clone()].iter().sum::<f64>();
        (1.5 * self.case.load.normal / (self.depth() * (mass + self.case.load.hub_mass))).sqrt()
    }

    /// How far the static preload presses the hub down (m).
    fn depth(&self) -> f64 {
        -self.facts.preload.map_or(0.0, |preload| preload.hub())
    }

    /// The node on the axle, which the elements lack: the one after those of the mesh.
    fn axle(&self) -> u32 {
        self.model.mesh.nodes.len() as u32
    }

    /// The share of the loads that the modelled bodies bear.
    fn share(&self) -> f64 {
        1.0 / self.model.multiplicity
    }
}

/// The keyword file of a run in consistent `units`.
pub fn export(rolling: &RollingMotion<'_>, units: Units) -> Exported {
    let notes = limits::nearly(rolling);
    let mut cards = Cards::new(units);
    head(&mut cards, rolling, &notes);
    control(&mut cards, rolling);
    mesh::bodies(&mut cards, rolling);
    contact::contact(&mut cards, rolling);
    motion::motion(&mut cards, rolling);
    motion::damping(&mut cards, rolling);
    requests::requests(&mut cards, rolling);
    mesh::mesh(&mut cards, rolling);
    cards.keyword("END");
    Exported { deck: cards.text(), notes }
}

fn head(cards: &mut Cards, rolling: &RollingMotion<'_>, notes: &[String]) {
    let case = rolling.case;
    // a title of several lines would be read as cards
    let name = case
        .title
        .as_deref()
        .unwrap_or(&case.name)
        .replace(|c: char| !(' '..='~').contains(&c), " ");
    cards.comment(&format!("{name}: a deck by creepage export-k {}", env!("CARGO_PKG_VERSION")));
    cards.comment(&format!("units: {}", cards.units().name()));
    cards.comment(
        "x: rolling direction, z: up; the bar's apex at z = 0, the disk's centre above x = 0",
    );
    let begins = rolling.preload_time();
    cards.comment(&format!(
        "preload: until {begins:.6e} s the hub is pressed down; then the disk rolls"
    ));
    for note in notes {
        cards.comment(&format!("nearly: {note}"));
    }
    cards.keyword("KEYWORD");
    cards.keyword("TITLE");
    cards.line(&name.chars().take(80).collect::<String>());
}

fn control(cards: &mut Cards, rolling: &RollingMotion<'_>) {
    let units = cards.units();
    let end = rolling.preload_time() + rolling.case.duration();
    cards.card("CONTROL_TERMINATION", &[("ENDTIM", end / units.time())]);
    let factor = rolling.facts.stability.factor;
    cards.card("CONTROL_TIMESTEP", &[("DTINIT", 0.0), ("TSSFAC", factor)]);
    let energies = ["HGEN", "RWEN", "SLNTEN", "RYLEN"].map(|field| (field, 2.0));
    cards.card("CONTROL_ENERGY", &energies);
    let case = rolling.case;
    cards.card("CONTROL_HOURGLASS", &[("IHQ", 4.0), ("QH", some(case.element.hourglass))]);
    let (quadratic, linear) = (case.damping.bulk_quadratic, case.damping.bulk_linear);
    cards.card("CONTROL_BULK_VISCOSITY", &[("Q1", some(quadratic)), ("Q2", some(linear))]);
    // materials of disk and bar, with the numbers of their parts
    for body in [DISK, BAR] {
        let m = &rolling.model.materials[body];
        let fields = [
            ("MID", number::PARTS[body] as f64),
            ("RO", m.density / units.density()),
            ("E", m.young / units.stress()),
            ("PR", m.poisson),
        ];
        cards.card("MAT_ELASTIC", &fields);
    }
}

/// A coefficient; for zero, which stands for the default, a number that does as little.
fn some(coefficient: f64) -> f64 {
    if coefficient == 0.0 { NONE } else { coefficient }
}

/// Stands for none where 0 stands for the default.
pub(crate) const NONE: f64 = 1e-20;

/// Whether the torque is prescribed and not the angular velocity.
fn by_torque(case: &Case) -> bool {
    case.drive.mode == DriveMode::Torque
}

/// Whether the load presses while the disk rolls, and not the height of the hub.
fn by_load(case: &Case) -> bool {
    case.load.mode == LoadMode::Load
}
