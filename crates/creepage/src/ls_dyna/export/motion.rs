//! What moves the hub, and damping.

use super::columns::{Cards, label};
use super::{RollingMotion, by_load, by_torque, number};
use crate::case::schema::Creepage;

/// Curves of the motion.
mod curve {
    pub(super) const SPEED: u64 = 1;
    pub(super) const TURN: u64 = 2;
    pub(super) const DEPTH: u64 = 3;
    pub(super) const LOAD: u64 = 4;
    pub(super) const ACROSS: u64 = 5;
    pub(super) const TORQUE: u64 = 6;
    pub(super) const PRELOAD_DAMPING: u64 = 7;
    pub(super) const REST: u64 = 8;
}

/// Degrees of freedom of a rigid body, and what is prescribed of them.
mod degree {
    pub(super) const X: f64 = 1.0;
    pub(super) const Y: f64 = 2.0;
    pub(super) const Z: f64 = 3.0;
    pub(super) const ABOUT: [f64; 3] = [5.0, 6.0, 7.0];
    pub(super) const VELOCITY: f64 = 0.0;
    pub(super) const DISPLACEMENT: f64 = 2.0;
}

/// Pieces of a smoothstep in a curve, which is linear in between.
const PIECES: usize = 64;
/// A jump takes this share of a time step.
const JUMP: f64 = 1e-3;

/// When the preload ends and the disk rolls, how long a jump takes, and when the run ends (s).
#[derive(Clone, Copy)]
struct Times {
    preload: f64,
    jump: f64,
    end: f64,
}

impl Times {
    fn of(rolling: &RollingMotion<'_>) -> Self {
        let preload = rolling.preload_time();
        let duration = rolling.case.duration();
        // curves go on beyond the run, which may end a step late
        let end = 2.0 * (preload + duration);
        Self { preload, jump: JUMP * duration / rolling.facts.steps as f64, end }
    }

    /// A value that is nothing before the preload is over.
    fn afterwards(&self, value: f64) -> Vec<[f64; 2]> {
        vec![[0.0, 0.0], [self.preload, 0.0], [self.preload + self.jump, value], [self.end, value]]
    }

    /// A value that then goes from `first` to `last` by a smoothstep of the duration `ramp`.
    fn ramp(&self, ramp: f64, first: f64, last: f64) -> Vec<[f64; 2]> {
        let mut points = vec![[0.0, 0.0], [self.preload, 0.0]];
        points.extend(
            rise(ramp).map(|[t, share]| {
                [self.preload + self.jump.max(t), first + share * (last - first)]
            }),
        );
        points.push([self.end.max(self.preload + 2.0 * ramp), last]);
        points
    }

    /// A value that then follows a table over time, whose values `of` converts.
    fn table(&self, table: &[[f64; 2]], of: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let mut points = vec![[0.0, 0.0], [self.preload, 0.0]];
        points.extend(table.iter().map(|[t, x]| [self.preload + self.jump + t, of(*x)]));
        if let Some([t, x]) = points.last().copied() {
            points.push([self.end.max(2.0 * t), x]);
        }
        points
    }
}

/// Times (s) and shares of a smoothstep of the duration `ramp`.
fn rise(ramp: f64) -> impl Iterator<Item = [f64; 2]> {
    let pieces = if ramp > 0.0 { PIECES } else { 0 };
    (0..=pieces).map(move |i| {
        let s = if pieces == 0 { 1.0 } else { i as f64 / pieces as f64 };
        [ramp * s, s * s * (3.0 - 2.0 * s)]
    })
}

/// The hub: a rigid body that is pressed down, then rolls.
pub(super) fn motion(cards: &mut Cards, rolling: &RollingMotion<'_>) {
    let (case, units) = (rolling.case, cards.units());
    let times = Times::of(rolling);
    rigid_hub(cards, rolling);

    let speed = case.drive.speed;
    let free = speed / rolling.facts.radius.effective;
    prescribe(cards, degree::X, degree::VELOCITY, curve::SPEED, 0.0);
    cards.curve(curve::SPEED, &times.afterwards(speed / units.velocity()));
    let across = case.drive.lateral_creepage * speed / units.velocity();
    let [about_x, about_y, about_z] = degree::ABOUT;
    let mut at_rest = vec![about_x, about_z];
    if across == 0.0 {
        at_rest.push(degree::Y);
    } else {
        prescribe(cards, degree::Y, degree::VELOCITY, curve::ACROSS, 0.0);
        cards.curve(curve::ACROSS, &times.ramp(case.drive.ramp(), 0.0, across));
    }
    for dof in at_rest {
        prescribe(cards, dof, degree::VELOCITY, curve::REST, 0.0);
    }
    cards.curve(curve::REST, &[[0.0, 0.0], [times.end, 0.0]]);

    turn(cards, rolling, &times, free, about_y);
    press(cards, rolling, &times);

    // part sets are for the disk alone: the bar does not move
    cards
        .card("INITIAL_VELOCITY_GENERATION_START_TIME", &[("STIME", times.preload / units.time())]);
    cards.keyword("INITIAL_VELOCITY_GENERATION");
    cards.fields(&[
        ("ID", number::DISK_PARTS as f64),
        ("STYP", 1.0),
        ("OMEGA", free * units.time()),
        ("VX", speed / units.velocity()),
    ]);
    let height = case.axle_height() - rolling.depth();
    cards.fields(&[
        ("XC", 0.0),
        ("YC", 0.0),
        ("ZC", height / units.length()),
        ("NX", 0.0),
        ("NY", 1.0),
        ("NZ", 0.0),
    ]);
    cards.card("SET_PART_LIST", &[("SID", number::DISK_PARTS as f64)]);
    let full = rolling.model.fully_integrated() > 0;
    let parts = [(true, number::PARTS[0]), (full, number::FULL[0])];
    cards.numbers(parts.into_iter().filter(|(there, _)| *there).map(|(_, part)| part as f64));
}

/// The hub as a rigid body about its axle: its motion is that of its centre of mass, and its nodes do not lie evenly about
/// the axle.
fn rigid_hub(cards: &mut Cards, rolling: &RollingMotion<'_>) {
    let (case, model, units) = (rolling.case, rolling.model, cards.units());
    let axle = label(rolling.axle()) as f64;
    cards.keyword("CONSTRAINED_NODAL_RIGID_BODY_INERTIA");
    cards.fields(&[
        ("PID", number::HUB as f64),
        ("CID", 0.0),
        ("NSID", number::HUB_NODES as f64),
        ("PNODE", axle),
    ]);
    let height = case.axle_height();
    // the hub's own mass is a cylinder, whose moment about y counts alone
    let own = rolling.share() * case.load.hub_mass;
    let radius = case.disk.hub_radius;
    let (mut mass, mut moments) = (own, [0.25, 0.5, 0.25].map(|part| part * own * radius * radius));
    for &n in &model.hub {
        let [x, y, z] = model.mesh.at(n).into();
        let (m, z) = (model.mass[n as usize], z - height);
        mass += m;
        let about = [y * y + z * z, x * x + z * z, x * x + y * y];
        (0..3).for_each(|i| moments[i] += m * about[i]);
    }
    cards.fields(&[
        ("XC", 0.0),
        ("YC", 0.0),
        ("ZC", height / units.length()),
        ("TM", mass / units.mass()),
        ("IRCS", 0.0),
        ("NODEID", axle),
    ]);
    let [ixx, iyy, izz] = moments.map(|i| i / (units.mass() * units.length() * units.length()));
    cards.fields(&[
        ("IXX", ixx),
        ("IXY", 0.0),
        ("IXZ", 0.0),
        ("IYY", iyy),
        ("IYZ", 0.0),
        ("IZZ", izz),
    ]);
    // velocities at the start
    cards.fields(&["VTX", "VTY", "VTZ", "VRX", "VRY", "VRZ"].map(|field| (field, 0.0)));
}

/// What turns the hub about its axle once the disk rolls: its angular velocity, or a torque.
fn turn(cards: &mut Cards, rolling: &RollingMotion<'_>, times: &Times, free: f64, about: f64) {
    let (drive, units) = (&rolling.case.drive, cards.units());
    if by_torque(rolling.case) {
        prescribe(cards, about, degree::VELOCITY, curve::TURN, times.preload / units.time());
        cards.curve(curve::TURN, &[[0.0, 0.0], [times.end, 0.0]]);
        let torque = rolling.share() * drive.torque.unwrap_or(0.0);
        let unit = units.force() * units.length();
        cards.card("LOAD_NODE_POINT", &loaded(rolling, about, curve::TORQUE, 1.0));
        cards.curve(curve::TORQUE, &times.ramp(drive.ramp(), 0.0, torque / unit));
    } else {
        prescribe(cards, about, degree::VELOCITY, curve::TURN, 0.0);
        let turn = |creepage: f64| free * (1.0 + creepage) * units.time();
        let points = match &drive.creepage {
            Some(Creepage::Table(points)) => times.table(points, turn),
            Some(Creepage::Number(creepage)) => {
                times.ramp(drive.ramp(), turn(0.0), turn(*creepage))
            }
            None => times.ramp(drive.ramp(), turn(0.0), turn(0.0)),
        };
        cards.curve(curve::TURN, &points);
    }
}

/// What presses the hub down: a displacement, and the load in its place once the depth is reached.
fn press(cards: &mut Cards, rolling: &RollingMotion<'_>, times: &Times) {
    let (case, units) = (rolling.case, cards.units());
    let pressed = rolling.pressing_time();
    let death = if by_load(case) { pressed / units.time() } else { 0.0 };
    prescribe(cards, degree::Z, degree::DISPLACEMENT, curve::DEPTH, death);
    let down = -rolling.depth() / units.length();
    let mut points: Vec<[f64; 2]> = rise(pressed).map(|[t, share]| [t, share * down]).collect();
    points.push([times.end, down]);
    cards.curve(curve::DEPTH, &points);
    let force = -rolling.share() * case.load.normal / units.force();
    cards.card("LOAD_NODE_POINT", &loaded(rolling, degree::Z, curve::LOAD, force));
    let pressing = Times { preload: pressed, ..*times };
    cards.curve(curve::LOAD, &pressing.afterwards(1.0));
}

/// Prescribes a degree of freedom of the hub by a curve, until the time `death` in units of the deck, or to the end
/// where that is 0.
fn prescribe(cards: &mut Cards, dof: f64, what: f64, curve: u64, death: f64) {
    cards.card(
        "BOUNDARY_PRESCRIBED_MOTION_RIGID",
        &[
            ("PID", number::HUB as f64),
            ("DOF", dof),
            ("VAD", what),
            ("LCID", curve as f64),
            ("SF", 1.0),
            ("VID", 0.0),
            ("DEATH", death),
        ],
    );
}

/// A force or a torque on the hub, at its axle.
fn loaded(
    rolling: &RollingMotion<'_>,
    dof: f64,
    curve: u64,
    factor: f64,
) -> [(&'static str, f64); 4] {
    let node = label(rolling.axle()) as f64;
    [("NID", node), ("DOF", dof), ("LCID", curve as f64), ("SF", factor)]
}

/// Mass damping of all motion until the disk rolls, then relative to the hub as the case says; Kelvin–Voigt damping.
pub(super) fn damping(cards: &mut Cards, rolling: &RollingMotion<'_>) {
    let (case, units) = (rolling.case, cards.units());
    let Times { preload, end, .. } = Times::of(rolling);
    cards.card("DAMPING_GLOBAL", &[("LCID", curve::PRELOAD_DAMPING as f64)]);
    // critical for the bounce of the disk
    let value = 2.0 * rolling.bounce() * units.time();
    let still = preload * (1.0 - 1e-6);
    cards
        .curve(curve::PRELOAD_DAMPING, &[[0.0, value], [still, value], [preload, 0.0], [end, 0.0]]);
    if case.damping.mass != 0.0 {
        // a share of critical at a frequency: 2 CDAMP 2 pi FREQ is the damping over the mass
        let frequency = case.damping.mass * units.time() / (4.0 * std::f64::consts::PI);
        cards.card(
            "DAMPING_RELATIVE",
            &[
                ("CDAMP", 1.0),
                ("FREQ", frequency),
                ("PIDRB", number::HUB as f64),
                ("PSID", number::DISK_PARTS as f64),
            ],
        );
    }
    if case.kelvin_voigt() != 0.0 {
        let full = rolling.model.fully_integrated() > 0;
        let parts = number::PARTS.into_iter().chain(number::FULL.into_iter().filter(|_| full));
        for part in parts {
            // below zero: the coefficient of the stiffness in units of time
            let coefficient = -case.kelvin_voigt() / units.time();
            cards.card("DAMPING_PART_STIFFNESS", &[("PID", part as f64), ("COEF", coefficient)]);
        }
    }
}
