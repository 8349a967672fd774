//! The rigid hub: its nodes follow one rigid body, which turns about its axle, and with the axle about the vertical.

use crate::ramp::{interpolated, smoothstep};
use crate::second_moments::SecondMoments;
use crate::sideways::Sideways;
use exact_sum::ExactSum;
use mesh::Padded;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;

/// What turns the hub about y.
#[derive(Clone, Debug, PartialEq)]
pub enum Spin {
    /// Angular velocity omega_0 (1 + creepage(t)), the creepage rising by a smoothstep over `ramp`.
    Creepage {
        /// Angular velocity of free rolling omega_0 = V/R_eff (rad/s).
        free: f64,
        /// Creepage reached after the ramp, (omega R_eff - V)/V.
        creepage: f64,
        /// Duration of the ramp (s).
        ramp: f64,
    },
    /// The same with a creepage that is [`interpolated`] between points.
    Table {
        /// Angular velocity of free rolling omega_0 = V/R_eff (rad/s).
        free: f64,
        /// Points (s, creepage).
        creepage: Arc<[[f64; 2]]>,
    },
    /// Torque about y (N m), rising by a smoothstep over `ramp`.
    Torque {
        /// Torque reached after the ramp (N m); positive drives in +x.
        torque: f64,
        /// Duration of the ramp (s).
        ramp: f64,
    },
}

/// What moves the hub in z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Vertical {
    /// A force pressing down (N).
    Load(f64),
    /// Nothing: the height stays.
    Held,
}

/// Motion of the hub: position at a full step, velocities at the half step before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HubState {
    /// Displacement of the centre in x (m).
    pub x: f64,
    /// Displacement of the centre in y (m).
    pub y: f64,
    /// Displacement of the centre in z (m).
    pub z: f64,
    /// Angle turned about the axle (rad), which is along +y at the start.
    pub angle: f64,
    /// Angle that the axle has turned about +z (rad).
    pub heading: f64,
    /// Velocity in x (m/s), prescribed.
    pub vx: f64,
    /// Velocity in y (m/s), prescribed.
    pub vy: f64,
    /// Velocity in z (m/s).
    pub vz: f64,
    /// Angular velocity about the axle (rad/s).
    pub omega: f64,
    /// Angular velocity about +z (rad/s), prescribed.
    pub turning: f64,
}

/// What the drive supplies to the hub.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DriveReaction {
    /// Force in x (N).
    pub force_x: f64,
    /// Force in y (N); of a hub that moves sideways.
    pub force_y: f64,
    /// Force in z (N).
    pub force_z: f64,
    /// Torque about the axle (N m).
    pub torque: f64,
    /// Moment about +z (N m); of a hub that moves sideways.
    pub moment_z: f64,
}

impl DriveReaction {
    /// That of `multiplicity` hubs alike.
    pub(crate) fn times(self, multiplicity: f64) -> Self {
        let Self { force_x, force_y, force_z, torque, moment_z } = self;
        Self {
            force_x: multiplicity * force_x,
            force_y: multiplicity * force_y,
            force_z: multiplicity * force_z,
            torque: multiplicity * torque,
            moment_z: multiplicity * moment_z,
        }
    }
}

/// Force (N) and moment about the hub's centre (N m), in x, y and z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultant {
    /// Force (N).
    pub force: Vector3<f64>,
    /// Moment (N m).
    pub moment: Vector3<f64>,
}

impl Resultant {
    /// That of these sums: force, then moment.
    pub(crate) fn of(sums: &[ExactSum; 6]) -> Self {
        let [fx, fy, fz, mx, my, mz] = sums.each_ref().map(ExactSum::value);
        Self { force: Vector3::new(fx, fy, fz), moment: Vector3::new(mx, my, mz) }
    }

    /// Adds another.
    pub(crate) fn add(&mut self, other: &Self) {
        self.force += other.force;
        self.moment += other.moment;
    }
}

/// A rigid hub that carries the nodes of the upper body's inner ring.
#[derive(Clone, Debug)]
pub struct Hub {
    /// Centre in the reference configuration (m).
    pub centre: Vector3<f64>,
    /// The nodes that follow it.
    pub nodes: Vec<u32>,
    /// Reference positions of the nodes relative to the centre (m).
    arms: Vec<Vector3<f64>>,
    /// Mass of the hub with its nodes (kg).
    pub mass: f64,
    /// Moment of inertia about y through the centre, with its nodes (kg m^2).
    pub inertia: f64,
    /// First moment of its mass in the reference configuration, mass times the arm of the centre of mass in x and z
    /// (kg m): not zero where the nodes do not lie evenly about the centre.
    pub(crate) moment: [f64; 2],
    /// First moment of its mass in y (kg m).
    moment_across: f64,
    /// Second moments of its mass about the centre in the reference configuration.
    second: SecondMoments,
    /// The part of the first moment that a counterweight adds (kg m).
    pub counterweight: [f64; 2],
    /// What turns it.
    pub spin: Spin,
    /// What presses it.
    pub vertical: Vertical,
    /// What moves it sideways; nothing where it rolls straight.
    pub sideways: Option<Sideways>,
    /// Its motion.
    pub state: HubState,
    /// What the drive had to supply in the last step.
    pub reaction: DriveReaction,
}

/// Work of the hub's drive around a step, split at the full step so that the ledger can be read
/// there: the half with v^{n-1/2} and the half with v^{n+1/2} (J), and 1/2 v^- M v^+ (J).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HubWork {
    pub(crate) before: f64,
    pub(crate) after: f64,
    pub(crate) kinetic: f64,
}

impl Hub {
    /// A hub about `centre` with its nodes' lumped masses plus `extra_mass` (kg), the latter a
    /// solid cylinder of the hub's radius.
    pub fn new(
        centre: Vector3<f64>,
        nodes: &[u32],
        reference: &[Padded],
        nodal_mass: &[f64],
        extra_mass: f64,
        spin: Spin,
        vertical: Vertical,
    ) -> Self {
        let arms: Vec<_> = nodes.iter().map(|&n| reference[n as usize].vector() - centre).collect();
        let [mut mass, mut inertia, mut along, mut down] = [ExactSum::ZERO; 4];
        mass.add(extra_mass);
        let mut radius_squared: f64 = 0.0;
        for (&n, arm) in nodes.iter().zip(&arms) {
            let m = nodal_mass[n as usize];
            let r2 = arm[0] * arm[0] + arm[2] * arm[2];
            mass.add(m);
            inertia.add(m * r2);
            along.add(m * arm[0]);
            down.add(m * arm[2]);
            radius_squared = radius_squared.max(r2);
        }
        inertia.add(0.5 * extra_mass * radius_squared);
        let masses = || nodes.iter().zip(&arms).map(|(&n, arm)| (nodal_mass[n as usize], *arm));
        let mut second = SecondMoments::of(masses());
        let reach = arms.iter().map(|arm| arm[1].abs()).fold(0.0, f64::max);
        second.add_cylinder(extra_mass, radius_squared.sqrt(), 2.0 * reach);
        let moment_across = exact_sum::sum(masses().map(|(m, arm)| m * arm[1]));
        Self {
            centre,
            nodes: nodes.to_vec(),
            arms,
            mass: mass.value(),
            inertia: inertia.value(),
            moment: [along.value(), down.value()],
            moment_across,
            second,
            counterweight: [0.0; 2],
            spin,
            vertical,
            sideways: None,
            state: HubState::default(),
            reaction: DriveReaction::default(),
        }
    }

    /// The hub with a counterweight that balances the upper body `nodes`, as wheels are balanced: the lumped masses of a mesh that
    /// is coarser on one side do not balance by themselves.
    pub fn balanced(
        mut self,
        nodes: Range<usize>,
        reference: &[Padded],
        nodal_mass: &[f64],
    ) -> Self {
        for (i, axis) in [0, 2].into_iter().enumerate() {
            let arm = |n: usize| reference[n].0[axis] - self.centre[axis];
            let moment = exact_sum::sum(nodes.clone().map(|n| nodal_mass[n] * arm(n)));
            self.counterweight[i] = -moment;
            self.moment[i] -= moment;
        }
        self
    }

    /// Turns the reference configuration of the hub by `angle` (rad), which the hub then has turned less, and takes the nodes
    /// along that are there then.
    pub(crate) fn turn_back(
        &mut self,
        angle: f64,
        dt: f64,
        displacement: &mut [Padded],
        velocity: &mut [Padded],
    ) {
        self.state.angle -= angle;
        let now = self.state;
        let before = HubState {
            x: now.x - dt * now.vx,
            z: now.z - dt * now.vz,
            angle: now.angle - dt * now.omega,
            ..now
        };
        self.place([before, now], dt, displacement, velocity);
    }

    /// Places the nodes in the second of two states, `dt` (s) after the first.
    pub(crate) fn place(
        &self,
        states: [HubState; 2],
        dt: f64,
        displacement: &mut [Padded],
        velocity: &mut [Padded],
    ) {
        for (n, u, v) in self.placed(states, dt) {
            (displacement[n], velocity[n]) = (u, v);
        }
    }

    /// Resultant of `force` on the hub's nodes (N); where the hub rolls straight, force in x and z and moment about y alone.
    pub fn resultant(&self, displacement: &[Padded], force: &[Padded]) -> Resultant {
        let HubState { x, y, z, .. } = self.state;
        self.resultant_about(Vector3::new(x, y, z), displacement, force)
    }

    /// The sums of [`resultant`](Self::resultant) over the nodes that `counts`: force, then moment.
    pub(crate) fn resultant_sums(
        &self,
        displacement: &[Padded],
        force: &[Padded],
        counts: impl Fn(u32) -> bool,
    ) -> [ExactSum; 6] {
        let HubState { x, y, z, .. } = self.state;
        self.sums_about(Vector3::new(x, y, z), displacement, force, counts)
    }

    /// The same, the moment about the centre displaced by `centre` (m).
    pub(crate) fn resultant_about(
        &self,
        centre: Vector3<f64>,
        displacement: &[Padded],
        force: &[Padded],
    ) -> Resultant {
        Resultant::of(&self.sums_about(centre, displacement, force, |_| true))
    }

    fn sums_about(
        &self,
        centre: Vector3<f64>,
        displacement: &[Padded],
        force: &[Padded],
        counts: impl Fn(u32) -> bool,
    ) -> [ExactSum; 6] {
        let mut sums = [ExactSum::ZERO; 6];
        for (&n, arm) in self.nodes.iter().zip(&self.arms).filter(|(n, _)| counts(**n)) {
            let f = force[n as usize].vector();
            let moment = (arm + displacement[n as usize].vector() - centre).cross(&f);
            sums[0].add(f.x);
            sums[2].add(f.z);
            sums[4].add(moment.y);
            if self.sideways.is_some() {
                sums[1].add(f.y);
                sums[3].add(moment.x);
                sums[5].add(moment.z);
            }
        }
        sums
    }

    /// The displacement (m) of any reference position (m) that moves with the hub as one rigid body.
    pub fn rigid_motion(&self) -> impl Fn(Vector3<f64>) -> Vector3<f64> + use<> {
        let (placement, centre) = (Placement::new(self.state), self.centre);
        move |x| placement.displacement(&(x - centre))
    }

    /// Acceleration of the centre in z (m/s^2) and angular acceleration (rad/s^2) at a full step with the first moment
    /// `s` of the mass, turned with the hub, the angular velocity `omega`, and `load`, force in z and torque about y (N, N m).
    fn accelerations(
        &self,
        [sx, sz]: [f64; 2],
        omega: f64,
        [fz, torque]: [f64; 2],
        given: Given,
        dt: f64,
    ) -> (f64, f64) {
        let pulled = fz + omega * omega * sz;
        match (self.vertical, given) {
            (Vertical::Load(load), Given::Acceleration(alpha)) => {
                ((pulled - load + alpha * sx) / self.mass, alpha)
            }
            (Vertical::Load(load), Given::Torque(applied)) => {
                let (force, torque) = (pulled - load, torque + applied);
                let determinant = self.mass * self.inertia - sx * sx;
                (
                    (self.inertia * force + sx * torque) / determinant,
                    (self.mass * torque + sx * force) / determinant,
                )
            }
            (Vertical::Held, Given::Acceleration(alpha)) => (-self.state.vz / dt, alpha),
            (Vertical::Held, Given::Torque(applied)) => {
                let az = -self.state.vz / dt;
                (az, (torque + applied + sx * az) / self.inertia)
            }
        }
    }

    /// The state at t^{n+1} under `load`, of a hub that stays where it is. Velocities along z and about the axle that forces decide on
    /// are those of `unknown` (m/s, rad/s), where it is given.
    pub(crate) fn predicted(
        &mut self,
        [time, dt]: [f64; 2],
        load: &Resultant,
        unknown: Option<[f64; 2]>,
    ) -> HubState {
        let (old, reaction) = (self.state, self.reaction);
        self.advance(time, dt, load);
        let mut new = self.state;
        (self.state, self.reaction) = (old, reaction);
        let [z, turn] = self.free();
        if let Some([vz, omega]) = unknown {
            if z {
                (new.vz, new.z) = (vz, old.z + dt * vz);
            }
            if turn {
                (new.omega, new.angle) = (omega, old.angle + dt * omega);
            }
        }
        new
    }

    /// Whether forces decide on the velocities along z and about the axle.
    pub(crate) fn free(&self) -> [bool; 2] {
        [matches!(self.vertical, Vertical::Load(_)), matches!(self.spin, Spin::Torque { .. })]
    }

    /// The mass that goes with these velocities (kg, kg m, kg m^2).
    pub(crate) fn mass_matrix(&self) -> [[f64; 2]; 2] {
        let [sx, _] = Placement::new(self.state).turned(self.moment);
        [[self.mass, -sx], [-sx, self.inertia]]
    }

    /// The sum over its nodes of a stiffness (N/m) of each, and of that about the axle (N m).
    pub(crate) fn stiffness(&self, of: impl Fn(usize) -> f64) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (&n, arm) in self.nodes.iter().zip(&self.arms) {
            let k = of(n as usize);
            sum[0] += k;
            sum[1] += k * (arm[0] * arm[0] + arm[2] * arm[2]);
        }
        sum
    }

    /// Gives its nodes the velocities along z and about its axle (m/s, rad/s).
    pub(crate) fn add_motion(
        &self,
        [vz, omega]: [f64; 2],
        displacement: &[Padded],
        velocity: &mut [Padded],
    ) {
        for (&n, arm) in self.nodes.iter().zip(&self.arms) {
            let r = arm + displacement[n as usize].vector();
            let [x, z] = [r.x - self.state.x, r.z - self.state.z];
            velocity[n as usize] = Padded::new([omega * z, 0.0, vz - omega * x]);
        }
    }

    /// Gives its nodes the mean velocities (m/s) between two states, `dt` (s) apart.
    pub(crate) fn place_velocities(&self, states: [HubState; 2], dt: f64, velocity: &mut [Padded]) {
        self.placed(states, dt).for_each(|(n, _, v)| velocity[n] = v);
    }

    /// Its nodes, their displacements (m) in the second of two states, and their mean velocities (m/s) since the first, `dt` (s)
    /// before.
    fn placed(
        &self,
        states: [HubState; 2],
        dt: f64,
    ) -> impl Iterator<Item = (usize, Padded, Padded)> + '_ {
        let [from, to] = states.map(Placement::new);
        self.nodes.iter().zip(&self.arms).map(move |(&n, arm)| {
            let (u, before) = (to.displacement(arm), from.displacement(arm));
            (n as usize, u.into(), ((u - before) / dt).into())
        })
    }

    /// Kinetic energy (J).
    pub(crate) fn kinetic(&self) -> f64 {
        self.kinetic_between(self.state, self.state)
    }

    /// Kinetic energy (J) of the change of velocity since another state.
    pub(crate) fn kinetic_of_change(&self, old: HubState) -> f64 {
        let new = self.state;
        let change = HubState {
            vx: new.vx - old.vx,
            vy: new.vy - old.vy,
            vz: new.vz - old.vz,
            omega: new.omega - old.omega,
            turning: new.turning - old.turning,
            ..new
        };
        self.kinetic_between(change, change)
    }

    /// 1/2 v M w of the velocities of two states (J), the mass as it is placed in the first.
    fn kinetic_between(&self, v: HubState, w: HubState) -> f64 {
        let placement = Placement::new(v);
        let [sx, sz] = placement.turned(self.moment);
        let second = placement.turned_about_the_axle(&self.second);
        let across = self.moment_across;
        let coupled = |v: HubState, w: HubState| {
            let v_h = placement.along_and_across(&Vector3::new(v.vx, v.vy, v.vz));
            0.5 * w.omega * (v_h.x * sz - v_h.z * sx)
                + 0.5 * w.turning * (v_h.y * sx - v_h.x * across - v.omega * second.yz)
        };
        0.5 * self.mass * (v.vx * w.vx + v.vz * w.vz + v.vy * w.vy)
            + 0.5 * self.inertia * v.omega * w.omega
            + 0.5 * (second.xx + second.yy) * v.turning * w.turning
            + coupled(v, w)
            + coupled(w, v)
    }

    /// Moves the hub from t^n to t^{n+1} under `load` and takes its nodes along.
    pub(crate) fn step(
        &mut self,
        time: f64,
        dt: f64,
        load: &Resultant,
        displacement: &mut [Padded],
        velocity: &mut [Padded],
    ) -> HubWork {
        let old = self.state;
        let work = self.advance(time, dt, load);
        self.place([old, self.state], dt, displacement, velocity);
        work
    }

    /// Takes the motion of the hub from t^n to t^{n+1} under `load`.
    ///
    /// A rigid body whose centre of mass lies off its centre, with the first moment of mass S (kg m), the acceleration a
    /// of the centre and the angular acceleration alpha:
    /// M a_x + alpha S_z - omega^2 S_x = F_x, M a_z - alpha S_x - omega^2 S_z = F_z and
    /// I alpha + S_z a_x - S_x a_z = T, where a_x = 0 on a straight path. x is along the heading here.
    ///
    /// Where the axle turns about z at psi' besides, a mass at the arm r has the further acceleration
    /// psi'' (-r_y, r_x) - psi'^2 (r_x, r_y) + 2 psi' omega (0, r_z) in x and y; [`Self::sideways_load`] has its sums.
    pub(crate) fn advance(&mut self, time: f64, dt: f64, load: &Resultant) -> HubWork {
        let old = self.state;
        let placement = Placement::new(old);
        let [sx, sz] = placement.turned(self.moment);
        let half = time + 0.5 * dt;
        let [vx, vy, turning] = match &self.sideways {
            Some(sideways) => sideways.velocities([old.y, old.heading], half, dt),
            None => [old.vx, old.vy, old.turning],
        };
        let change = Vector3::new(vx - old.vx, vy - old.vy, 0.0);
        let a = placement.along_and_across(&(change / dt));
        let turn = Turn { rate: 0.5 * (old.turning + turning), rise: (turning - old.turning) / dt };
        let second = placement.turned_about_the_axle(&self.second);
        let force = placement.along_and_across(&load.force);
        let about_axle = placement.along_and_across(&load.moment).y;
        let torque =
            about_axle - (sz * a.x - turn.rise * second.yz - turn.rate * turn.rate * second.xz);
        let turned_at = |omega: f64| Given::Acceleration((omega - old.omega) / dt);
        let given = match &self.spin {
            &Spin::Creepage { free, creepage, ramp } => {
                turned_at(free * (1.0 + creepage * smoothstep(half, ramp)))
            }
            Spin::Table { free, creepage } => {
                turned_at(free * (1.0 + interpolated(creepage, half)))
            }
            &Spin::Torque { torque, ramp } => Given::Torque(torque * smoothstep(time, ramp)),
        };
        // omega at the full step is the mean of the half steps about it
        let (_, about) = self.accelerations([sx, sz], old.omega, [force.z, torque], given, dt);
        let omega = old.omega + 0.5 * dt * about;
        let (az, alpha) = self.accelerations([sx, sz], omega, [force.z, torque], given, dt);
        let [pull_x, pull_z] = [sx, sz].map(|s| omega * omega * s);
        let [more_x, more_y, moment_z] =
            self.sideways_load([sx, sz], &second, [a.x, a.y], turn, [omega, alpha]);
        let drive_x = alpha * sz - pull_x - force.x + more_x;
        let drive_y = more_y - force.y;
        let drive_z = match self.vertical {
            Vertical::Load(load) => -load,
            Vertical::Held => self.mass * az - alpha * sx - pull_z - force.z,
        };
        let drive_torque = match given {
            Given::Acceleration(_) => self.inertia * alpha - sx * az - torque,
            Given::Torque(applied) => applied,
        };
        let drive_turn = moment_z - load.moment[2];
        let new = &mut self.state;
        (new.vx, new.vy, new.turning) = (vx, vy, turning);
        new.vz += dt * az;
        new.omega += dt * alpha;
        new.x += dt * new.vx;
        new.y += dt * new.vy;
        new.z += dt * new.vz;
        new.angle += dt * new.omega;
        new.heading += dt * new.turning;
        let new = *new;
        let drive = placement.in_x_and_y(&Vector3::new(drive_x, drive_y, drive_z));
        self.reaction = DriveReaction {
            force_x: drive.x,
            force_y: drive.y,
            force_z: drive.z,
            torque: drive_torque,
            moment_z: drive_turn,
        };
        let drive = self.reaction;
        let power = |s: HubState| {
            drive.force_x * s.vx
                + drive.force_z * s.vz
                + drive.torque * s.omega
                + drive.force_y * s.vy
                + drive.moment_z * s.turning
        };
        HubWork {
            before: 0.5 * dt * power(old),
            after: 0.5 * dt * power(new),
            kinetic: self.kinetic_between(old, new),
        }
    }

    /// Forces along and across the heading (N) and moment about z (N m) that accelerate the hub sideways, besides those in
    /// the plane of rolling: with its first moment `s` and `second` moments now, the acceleration along and across the
    /// heading (m/s^2), and omega and alpha (rad/s, rad/s^2). Zero on a straight path.
    fn sideways_load(
        &self,
        [sx, sz]: [f64; 2],
        second: &SecondMoments,
        [ax, ay]: [f64; 2],
        Turn { rate, rise }: Turn,
        [omega, alpha]: [f64; 2],
    ) -> [f64; 3] {
        if self.sideways.is_none() {
            return [0.0; 3];
        }
        let sy = self.moment_across;
        [
            self.mass * ax - rise * sy - rate * rate * sx,
            self.mass * ay + rise * sx - rate * rate * sy + 2.0 * rate * omega * sz,
            sx * ay - sy * ax + rise * (second.xx + second.yy) + 2.0 * rate * omega * second.xz
                - alpha * second.yz
                + omega * omega * second.xy,
        ]
    }
}

/// A turn about z.
#[derive(Clone, Copy)]
struct Turn {
    /// Angular velocity (rad/s).
    rate: f64,
    /// Angular acceleration (rad/s^2).
    rise: f64,
}

/// What the drive gives the rotation of the hub in a step.
#[derive(Clone, Copy)]
enum Given {
    /// Angular acceleration (rad/s^2).
    Acceleration(f64),
    /// Torque about y (N m).
    Torque(f64),
}

/// The rigid displacement in a state of the hub: it turns about +y, then with the axle about +z, and moves.
///
/// The rotations are kept as `R - I`, so that displacements much smaller than arms have their digits.
struct Placement {
    moved: Vector3<f64>,
    /// `R_y - I` and `R_z - I`.
    roll: Matrix3<f64>,
    heading: Matrix3<f64>,
}

impl Placement {
    fn new(state: HubState) -> Self {
        // cos - 1 = -2 sin^2(angle/2), without cancellation
        let turn = |angle: f64| {
            let half = libm::sin(0.5 * angle);
            [libm::sin(angle), -2.0 * half * half]
        };
        let ([s, c], [s_z, c_z]) = (turn(state.angle), turn(state.heading));
        Self {
            moved: Vector3::new(state.x, state.y, state.z),
            roll: Matrix3::new(c, 0.0, s, 0.0, 0.0, 0.0, -s, 0.0, c),
            heading: Matrix3::new(c_z, -s_z, 0.0, s_z, c_z, 0.0, 0.0, 0.0, 0.0),
        }
    }

    /// A vector in x and z of the reference configuration, turned about the axle: in x along the heading, and z.
    fn turned(&self, [x, z]: [f64; 2]) -> [f64; 2] {
        let (sin, cos_minus_one) = (self.roll.m13, self.roll.m11);
        [x + cos_minus_one * x + sin * z, z + cos_minus_one * z - sin * x]
    }

    /// Second moments of the reference configuration, turned about the axle.
    fn turned_about_the_axle(&self, second: &SecondMoments) -> SecondMoments {
        second.turned(self.roll.m13, 1.0 + self.roll.m11)
    }

    /// The vector `R_z^T v` of components along and across the heading, and along z.
    fn along_and_across(&self, v: &Vector3<f64>) -> Vector3<f64> {
        v + self.heading.tr_mul(v)
    }

    /// The vector `R_z v` of such components.
    fn in_x_and_y(&self, v: &Vector3<f64>) -> Vector3<f64> {
        v + self.heading * v
    }

    /// Displacement `(R_z R_y - I) r + u` (m) of the point at `arm` r from the centre.
    fn displacement(&self, arm: &Vector3<f64>) -> Vector3<f64> {
        let rolled = self.roll * arm;
        rolled + self.heading * (arm + rolled) + self.moved
    }
}
