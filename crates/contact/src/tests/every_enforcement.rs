//! What every enforcement keeps. A new one is tested by one line in `enforcements!` below: its name, how it is
//! built, and over how many steps its forces turn with the bodies.

use crate::constraint::{Constraint, MasterNode};
use crate::point::State;
use crate::snapshot::Points;
use crate::tests::plates::{STEEL, plate, together, tread};
use crate::tests::{K, step_on_trace};
use crate::{
    Contact, ContactState, ContactSums, ExactContact, ExactSettings, NodalContact, Normals,
    PenaltyContact, PenaltySettings, Rows, StateError, Stiffness,
};
use friction::Coulomb;
use mesh::{Mesh, Padded, Surface};
use nalgebra::{Rotation3, UnitVector3, Vector3};

const MU: f64 = 0.3;
const STEPS: usize = 60;

/// An enforcement on two surfaces, side 0 and side 1.
type Build = fn(&Mesh, [&Surface; 2]) -> Box<dyn Contact>;

fn penalty(mesh: &Mesh, [a, b]: [&Surface; 2]) -> Box<dyn Contact> {
    let settings = PenaltySettings {
        normal: Stiffness::Areal(K),
        tangential: Stiffness::Areal(0.7 * K),
        damping: 0.1,
        curvature: true,
        normals: Normals::Averaged,
    };
    let sides = [(a, STEEL), (b, STEEL)];
    let law = Box::new(Coulomb { mu: MU });
    Box::new(PenaltyContact::new(mesh, sides, &settings, None, law).unwrap())
}

fn exact<const SLAVE: usize, const MORTAR: bool>(
    mesh: &Mesh,
    [a, b]: [&Surface; 2],
) -> Box<dyn Contact> {
    let rows = if MORTAR { Rows::Mortar } else { Rows::NodeToFace };
    let settings =
        ExactSettings { slave: Some(SLAVE), curvature: true, rows, normals: Normals::Averaged };
    let sides = [(a, STEEL), (b, STEEL)];
    let law = Box::new(Coulomb { mu: MU });
    Box::new(ExactContact::new(mesh, sides, &settings, law).unwrap())
}

/// A rotation, and how far the bodies then are from where they were.
#[derive(Clone, Copy, Default)]
struct Turn {
    rotation: Rotation3<f64>,
    away: Vector3<f64>,
}

impl Turn {
    fn point(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.rotation * x + self.away
    }
}

/// A tread of nodes that are masses without springs, pressed on a plate with other cells and pushed along it.
struct Masses {
    contact: Box<dyn Contact>,
    upper: usize,
    turn: Turn,
    /// Half length and half width (m) within which the bodies are loaded.
    loaded: [f64; 2],
    reference: Vec<Padded>,
    displacement: Vec<Padded>,
    velocity: Vec<Padded>,
    inverse_mass: Vec<f64>,
    force: Vec<Padded>,
}

impl Masses {
    const DT: f64 = 1e-7;

    fn new(build: Build, turn: Turn) -> Self {
        let (upper, first) = tread(2.0, 4e-3, 8e-3, [14, 7], 1e-3);
        let (lower, second) = plate([-9e-3, -6e-3], [9e-3, 6e-3], [17, 11], 0.0, 1e-3, true);
        let count = upper.nodes.len();
        let (mesh, second) = together(upper, lower, second);
        let reference: Vec<Padded> = mesh.nodes.iter().copied().map(Padded::from).collect();
        // not yet touching: whether what just touches is closed would be decided by round-off
        let apart = |(i, x): (usize, &Padded)| {
            let lift = if i < count { 1e-7 } else { 0.0 };
            (turn.point(x.vector() + lift * Vector3::z()) - x.vector()).into()
        };
        let n = reference.len();
        let noise =
            |i: usize| f64::from((i as u32).wrapping_mul(2_654_435_761) >> 8) / 16_777_216.0;
        Self {
            contact: build(&mesh, [&first, &second]),
            upper: count,
            turn,
            loaded: [f64::INFINITY; 2],
            displacement: reference.iter().enumerate().map(apart).collect(),
            reference,
            velocity: vec![Padded::ZERO; n],
            inverse_mass: (0..n).map(|i| 1e5 * (1.0 + noise(i))).collect(),
            force: vec![Padded::ZERO; n],
        }
    }

    /// The force (N) on a node besides contact: the upper body is pressed down, then pushed along.
    fn given(&self, i: usize, step: usize) -> Vector3<f64> {
        let push = if step > STEPS / 3 { 8.0 } else { 0.0 };
        let [x, y, _] = self.reference[i].xyz();
        let within = x.abs() < self.loaded[0] && y.abs() < self.loaded[1];
        let load = if i < self.upper { [push, 0.4 * push, -20.0] } else { [0.0, 0.0, 2.0] };
        self.turn.rotation * Vector3::from(if within { load } else { [0.0; 3] })
    }

    /// A step; the contact forces are left in `force`.
    fn step(&mut self, step: usize) -> ContactSums {
        let given: Vec<_> = (0..self.force.len()).map(|i| self.given(i, step)).collect();
        self.force = given.iter().map(|&f| f.into()).collect();
        let sums = step_on_trace(
            &mut *self.contact,
            [&self.reference, &self.displacement, &self.velocity],
            &self.inverse_mass,
            [step as f64 * Self::DT, Self::DT],
            &mut self.force,
        );
        for i in 0..self.force.len() {
            self.velocity[i] += Self::DT * self.inverse_mass[i] * self.force[i].vector();
            self.displacement[i] += Self::DT * self.velocity[i].vector();
            self.force[i] -= given[i];
        }
        sums
    }

    fn position(&self, i: usize) -> Vector3<f64> {
        self.reference[i].vector() + self.displacement[i].vector()
    }

    fn table(&self, side: usize) -> NodalContact {
        let mut table = self.contact.nodal_table(side);
        self.contact.nodal(&mut table);
        table
    }
}

fn every_action_has_its_reaction(build: Build) {
    let mut masses = Masses::new(build, Turn::default());
    let (mut closed, mut slipping) = (0, 0);
    for step in 0..STEPS {
        let sums = masses.step(step);
        let on = |side: usize| -> Vector3<f64> {
            let bodies = masses.force.split_at(masses.upper);
            [bodies.0, bodies.1][side].iter().map(|f| f.vector()).sum()
        };
        let scale = sums.normal_force.max(1.0);
        for side in 0..2 {
            assert!((on(side) - sums.force[side]).norm() <= 1e-12 * scale, "{side}: {sums:?}");
        }
        assert!((sums.force[0] + sums.force[1]).norm() <= 1e-13 * scale, "{sums:?}");
        closed += sums.closed;
        slipping += sums.slipping;
    }
    assert!(closed > 1000 && slipping > 100, "{closed} {slipping}: too little contact to judge");
}

fn nothing_pulls_and_shear_stays_in_the_cone(build: Build) {
    let mut masses = Masses::new(build, Turn::default());
    let mut loaded = 0;
    for step in 0..STEPS {
        masses.step(step);
        for side in 0..2 {
            let table = masses.table(side);
            // a mean may hand a node of the other side a pull by its weights, which are not all positive
            if masses.contact.enforced_on().is_some_and(|enforced| enforced != side) {
                continue;
            }
            for (p, q) in table.pressure.iter().zip(&table.shear) {
                assert!(*p >= 0.0, "{p} Pa");
                assert!(q.norm() <= MU * p * (1.0 + 1e-11), "{} of {p} Pa", q.norm());
                loaded += usize::from(*p > 0.0);
            }
        }
    }
    assert!(loaded > 1000, "{loaded}");
}

/// Both bodies turned and carried away: the forces are the same, turned. `steps` ends before mortar means are
/// integrated anew: when that is depends on when the search first listed a node, hence on the axes, and
/// these masses without springs answer the second-order difference of the gap by a force of its own.
fn forces_turn_with_the_bodies(build: Build, steps: usize) {
    let axis = UnitVector3::new_normalize(Vector3::new(1.0, 2.0, 2.0));
    let rotation = Rotation3::from_axis_angle(&axis, 0.8);
    let turn = Turn { rotation, away: Vector3::new(0.02, -0.01, 0.03) };
    let mut worst = 0.0f64;
    let [mut still, mut turned] = [Turn::default(), turn].map(|turn| Masses::new(build, turn));
    [still.loaded, turned.loaded] = [[5e-3, 2.5e-3]; 2];
    let mut closed = 0;
    for step in 0..steps {
        // the same motion but for round-off, which nodes without springs would let grow
        for i in 0..still.force.len() {
            let place = turn.point(still.position(i));
            turned.displacement[i] = (place - turned.reference[i].vector()).into();
            turned.velocity[i] = (turn.rotation * still.velocity[i].vector()).into();
        }
        let (a, b) = (still.step(step), turned.step(step));
        assert_eq!((a.closed, a.slipping), (b.closed, b.slipping), "step {step}");
        closed += a.closed;
        let largest = still.force.iter().map(|f| f.vector().norm()).fold(1.0, f64::max);
        for (f, g) in still.force.iter().zip(&turned.force) {
            let off = (turn.rotation * f.vector() - g.vector()).norm() / largest;
            worst = worst.max(off);
        }
    }
    assert!(worst < 1e-8, "{worst:e} of the largest force");
    assert!(closed > 10 * steps, "{closed}: too little contact to judge");
}

fn a_state_that_is_restored_goes_on_with_the_same_bits(build: Build) {
    let mut masses = Masses::new(build, Turn::default());
    let mut again = Masses::new(build, Turn::default());
    for step in 0..STEPS {
        if step == STEPS / 2 {
            again.contact.restore(&masses.contact.snapshot()).unwrap();
            for side in 0..2 {
                let [expected, found] = [&masses, &again].map(|masses| masses.table(side));
                assert_eq!(format!("{found:?}"), format!("{expected:?}"), "side {side}");
            }
            again.displacement.clone_from(&masses.displacement);
            again.velocity.clone_from(&masses.velocity);
        }
        let expected = masses.step(step);
        if step >= STEPS / 2 {
            assert_eq!(again.step(step), expected, "step {step}");
            assert_eq!(again.force, masses.force, "step {step}");
        }
    }
}

#[test]
fn a_state_of_other_rows_or_with_places_that_there_are_not_is_refused() {
    let builds: [Build; 3] = [penalty, exact::<0, false>, exact::<0, true>];
    let mut states = Vec::new();
    for build in builds {
        let mut masses = Masses::new(build, Turn::default());
        (0..STEPS).for_each(|step| {
            masses.step(step);
        });
        states.push(masses.contact.snapshot());
    }
    let restored = |build: Build, state: &ContactState| {
        Masses::new(build, Turn::default()).contact.restore(state)
    };
    let [springs, node_to_face, mortar] = &states[..] else { panic!() };
    assert_eq!(restored(exact::<0, false>, springs), Err(StateError::Method));
    assert_eq!(restored(penalty, node_to_face), Err(StateError::Method));
    assert_eq!(restored(exact::<0, true>, node_to_face), Err(StateError::Rows));
    assert_eq!(restored(exact::<0, false>, mortar), Err(StateError::Rows));
    let changed = |change: fn(&mut Vec<Constraint>, &mut Vec<MasterNode>)| {
        let mut state = node_to_face.clone();
        let Points::Exact(constraints, master_nodes, _) = &mut state.points else { panic!() };
        change(constraints, master_nodes);
        restored(exact::<0, false>, &state)
    };
    let range = |name| Err(StateError::Range { name });
    assert_eq!(changed(|_, _| ()), Ok(()));
    assert_eq!(changed(|_, master_nodes| master_nodes.truncate(1)), range("master_nodes"));
    assert_eq!(changed(|_, master_nodes| master_nodes[0].node = u32::MAX), range("master_nodes"));
    // an open node that the search never lists: it has no face
    let off = |constraints: &mut Vec<Constraint>, _: &mut Vec<MasterNode>| {
        constraints.iter_mut().for_each(|point| point.state = State::Open);
        constraints[0].face = u32::MAX;
    };
    assert_eq!(changed(off), range("face"));
}

macro_rules! enforcements {
    ($($name:ident: $build:expr, $steps:expr;)*) => {
        $(mod $name {
            use super::*;

            #[test]
            fn every_action_has_its_reaction() {
                super::every_action_has_its_reaction($build);
            }

            #[test]
            fn nothing_pulls_and_shear_stays_in_the_cone() {
                super::nothing_pulls_and_shear_stays_in_the_cone($build);
            }

            #[test]
            fn forces_turn_with_the_bodies() {
                super::forces_turn_with_the_bodies($build, $steps);
            }

            #[test]
            fn a_state_that_is_restored_goes_on_with_the_same_bits() {
                super::a_state_that_is_restored_goes_on_with_the_same_bits($build);
            }
        })*
    };
}

enforcements! {
    springs: penalty, STEPS;
    node_to_face_from_the_disk: exact::<0, false>, STEPS;
    node_to_face_from_the_bar: exact::<1, false>, STEPS;
    mortar_from_the_disk: exact::<0, true>, STEPS / 3;
    mortar_from_the_bar: exact::<1, true>, STEPS / 3;
}
