//! Exact contact in an implicit step of nodes that are masses without springs: their compliance over the step is `dt/m`, and
//! it must find what an explicit step finds.

use crate::tests::plates::{STEEL, plate, together, tread};
use crate::{
    ContactStep, ContactSums, ContactTables, ExactContact, ExactSettings, FreeMotion, Motion,
    NodalContact, Normals, Rows, Trace,
};
use friction::{Coulomb, Exponential, Implicit, NodeFriction};
use mesh::{Mesh, Padded, Surface};
use nalgebra::{Matrix3, Vector3};
use std::cell::RefCell;
use std::collections::BTreeSet;

const DT: f64 = 1e-7;

/// The bodies on the trace of their contact.
struct Bodies {
    mesh: Mesh,
    sides: [Surface; 2],
    trace: Trace,
    position: Vec<Padded>,
    /// Velocity without contact (m/s).
    free: Vec<Padded>,
    inverse_mass: Vec<f64>,
}

/// What a step made of them.
struct Stepped {
    sums: ContactSums,
    force: Vec<Padded>,
    velocity: Vec<Padded>,
}

impl Bodies {
    fn new(upper: (Mesh, Surface), lower: (Mesh, Surface)) -> Self {
        let first = upper.1;
        let (mesh, second) = together(upper.0, lower.0, lower.1);
        let mut bodies = Self {
            mesh,
            sides: [first, second],
            trace: Trace::default(),
            position: Vec::new(),
            free: Vec::new(),
            inverse_mass: Vec::new(),
        };
        bodies.trace = bodies.contact(0, Rows::NodeToFace, Coulomb { mu: 0.0 }).trace().clone();
        bodies.position =
            bodies.trace.nodes().iter().map(|&n| Padded::from(bodies.mesh.at(n))).collect();
        let n = bodies.position.len();
        bodies.free = vec![Padded::ZERO; n];
        let noise =
            |i: usize| f64::from((i as u32).wrapping_mul(2_654_435_761) >> 8) / 16_777_216.0;
        bodies.inverse_mass = (0..n).map(|i| 1e5 * (1.0 + noise(i))).collect();
        bodies
    }

    fn contact(&self, slave: usize, rows: Rows, law: impl NodeFriction + 'static) -> ExactContact {
        let settings =
            ExactSettings { slave: Some(slave), curvature: true, rows, normals: Normals::Averaged };
        let surfaces = [(&self.sides[0], STEEL), (&self.sides[1], STEEL)];
        ExactContact::new(&self.mesh, surfaces, &settings, Box::new(law)).unwrap()
    }

    fn motion<'a>(&'a self, velocity: &'a [Padded]) -> Motion<'a> {
        let Self { position, inverse_mass, .. } = self;
        Motion { position, velocity, inverse_mass, time: 0.0, dt: DT }
    }

    /// The velocities under these forces (N).
    fn pushed(&self, force: &[Padded]) -> Vec<Padded> {
        let of = |i: usize| {
            let by_mass = DT * self.inverse_mass[i];
            Padded::new([0, 1, 2].map(|k| self.free[i][k] + by_mass * force[i][k]))
        };
        (0..force.len()).map(of).collect()
    }

    fn explicit(&self, contact: &mut ExactContact) -> Stepped {
        let motion = self.motion(&self.free);
        contact.follow(&motion);
        let mut force = vec![Padded::ZERO; self.free.len()];
        let free = |node: u32, _: Vector3<f64>| Vector3::from(self.free[node as usize].xyz());
        let sums = contact.apply(&motion, &FreeMotion { velocity: &free }, &mut force);
        Stepped { sums, velocity: self.pushed(&force), force }
    }

    /// The same by an implicit step, `pairs` of nodes of the mesh moving as one.
    fn implicit(&self, contact: &mut ExactContact, pairs: &[[u32; 2]]) -> Stepped {
        let motion = self.motion(&self.free);
        contact.follow(&motion);
        contact.begin_implicit(&motion, pairs);
        let borne_by: BTreeSet<u32> = contact.borne_by().collect();
        let asked = RefCell::new(BTreeSet::new());
        contact.set_compliance(&|of, on| -> Matrix3<f64> {
            asked.borrow_mut().extend([of, on]);
            let own = if of == on { DT * self.inverse_mass[of as usize] } else { 0.0 };
            Matrix3::from_diagonal_element(own)
        });
        assert_eq!(asked.into_inner(), borne_by, "the nodes whose compliance the step asks for");
        let forces = |contact: &ExactContact| {
            let mut force = vec![Padded::ZERO; self.free.len()];
            contact.add_forces(&mut force);
            force
        };
        contact.solve_implicit(&self.motion(&self.pushed(&forces(contact))));
        // the compliance is that of the bodies: the first correction is the last
        let again = contact.solve_implicit(&self.motion(&self.pushed(&forces(contact))));
        assert!(again.change < 1e-9 && again.unconverged == 0.0, "{again:?}");
        let mut velocity = self.pushed(&forces(contact));
        for [first, second] in pairs.iter().map(|pair| pair.map(|node| self.on_trace(node))) {
            velocity[second] = velocity[first];
        }
        let mut force = vec![Padded::ZERO; velocity.len()];
        let sums = contact.end_implicit(&self.motion(&velocity), pairs, &mut force);
        Stepped { sums, force, velocity }
    }

    fn on_trace(&self, node: u32) -> usize {
        self.trace.nodes().iter().position(|&n| n == node).unwrap()
    }

    fn table(&self, contact: &ExactContact, side: usize) -> NodalContact {
        let mut table = contact.nodal_table(side);
        contact.nodal(&mut table);
        table
    }
}

/// A tread of large radius that comes down on a plate with other cells while it spins about the vertical: some nodes stick.
fn spun() -> Bodies {
    let mut bodies = Bodies::new(
        tread(2.0, 4e-3, 8e-3, [14, 7], 1e-3),
        plate([-9e-3, -6e-3], [9e-3, 6e-3], [17, 11], 0.0, 1e-3, true),
    );
    let upper = bodies.trace.side(0).len();
    for (x, v) in bodies.position.iter_mut().zip(&mut bodies.free).take(upper) {
        *v = Padded::new([-3e3 * x[1], 3e3 * x[0], -1.0]);
        x[2] -= 3e-6;
    }
    bodies
}

#[test]
fn with_the_compliance_of_masses_an_implicit_step_finds_the_forces_of_an_explicit_one() {
    for rows in [Rows::NodeToFace, Rows::Mortar] {
        for slave in 0..2 {
            let bodies = spun();
            let law = Coulomb { mu: 0.3 };
            let expected = bodies.explicit(&mut bodies.contact(slave, rows, law));
            let found = bodies.implicit(&mut bodies.contact(slave, rows, law), &[]);
            let counts = |sums: &ContactSums| [sums.closed, sums.sticking, sums.slipping];
            assert_eq!(counts(&found.sums), counts(&expected.sums), "{rows:?} {slave}");
            let [_, sticking, slipping] = counts(&found.sums);
            assert!(sticking > 3 && slipping > 10, "{sticking} {slipping}: too few to judge");
            let largest = expected.force.iter().map(|f| f[2].abs()).fold(0.0, f64::max);
            for (a, b) in found.force.iter().zip(&expected.force) {
                for k in 0..3 {
                    assert!((a[k] - b[k]).abs() < 1e-9 * largest, "{rows:?} {slave}: {a:?} {b:?}");
                }
            }
            let [found, expected] = [found.sums.friction_ahead, expected.sums.friction_ahead];
            assert!((found / expected - 1.0).abs() < 1e-9, "{rows:?} {slave}: {found} {expected}");
        }
    }
}

#[test]
fn what_an_implicit_step_dissipates_is_the_work_that_its_forces_take_from_the_bodies() {
    for rows in [Rows::NodeToFace, Rows::Mortar] {
        let bodies = spun();
        let Stepped { sums, force, velocity } =
            bodies.implicit(&mut bodies.contact(0, rows, Coulomb { mu: 0.3 }), &[]);
        let power = |(f, v): (&Padded, &Padded)| f[0] * v[0] + f[1] * v[1] + f[2] * v[2];
        let work = DT * force.iter().zip(&velocity).map(power).sum::<f64>();
        let dissipated = sums.friction_ahead + sums.damping_ahead;
        assert!(sums.friction_ahead > 0.0);
        assert!((work / dissipated + 1.0).abs() < 1e-9, "{rows:?}: {work:e} {dissipated:e}");
    }
}

#[test]
fn nodes_that_move_as_one_bear_what_the_first_of_them_is_solved_for() {
    // one row of faces, the nodes of either long edge moving as those of the other
    let mut bodies = Bodies::new(
        plate([0.3e-3, 0.0], [4.3e-3, 1e-3], [4, 1], 0.0, 1e-3, false),
        plate([0.0, 0.0], [7e-3, 1e-3], [5, 1], 0.0, 1e-3, true),
    );
    let mut pairs = Vec::new();
    for side in 0..2 {
        let nodes = bodies.trace.side(side).to_vec();
        let half = nodes.len() / 2;
        pairs.extend((0..half).map(|i| [nodes[i], nodes[half + i]]));
    }
    pairs.sort_unstable();
    for pair in &pairs {
        let [first, second] = pair.map(|node| bodies.on_trace(node));
        bodies.inverse_mass[second] = bodies.inverse_mass[first];
    }
    let upper = bodies.trace.side(0).len();
    bodies.free[..upper].fill(Padded::new([0.5, 0.0, -1.0]));
    let mut contact = bodies.contact(0, Rows::NodeToFace, Coulomb { mu: 0.3 });
    let Stepped { sums, force, .. } = bodies.implicit(&mut contact, &pairs);
    assert_eq!([sums.closed, sums.slipping], [10, 10]);
    let on = |pair: &[u32; 2]| pair.map(|node| force[bodies.on_trace(node)]);
    for [first, second] in pairs.iter().map(on) {
        for k in 0..3 {
            assert!(
                (first[k] - second[k]).abs() < 1e-12 * sums.normal_force,
                "{first:?} {second:?}"
            );
        }
    }
    let table = bodies.table(&contact, 0);
    assert!(table.pressure.iter().all(|p| *p > 0.0), "{:?}", table.pressure);
}

#[test]
fn the_steepness_of_falling_friction_is_that_of_a_node_alone_and_of_all_together() {
    let law = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
    // four slaves half-way from the middle of one face to its corners
    let mut bodies = Bodies::new(
        plate([1e-3, 1e-3], [3e-3, 3e-3], [1, 1], 0.0, 1e-3, false),
        plate([0.0, 0.0], [4e-3, 4e-3], [1, 1], 0.0, 1e-3, true),
    );
    let (slave, master, closing) = (2e5, 5e5, 0.1);
    bodies.inverse_mass = [[slave; 4], [master; 4]].concat();
    bodies.free[..4].fill(Padded::new([0.7, 0.0, -closing]));
    let mut contact = bodies.contact(0, Rows::NodeToFace, Implicit(law));
    let sums = bodies.implicit(&mut contact, &[]).sums;
    assert_eq!(sums.slipping, 4);
    // the normal forces stop the bodies on one another, dt (1/m_s + 1/m_m) r = v
    let together = law.decay * (law.mu_static - law.mu_dynamic) * closing;
    // of one slave alone only the sum of the squares of its weights, 3/4 and 1/4 along either edge, yields
    let squares = (0.75_f64 * 0.75 + 0.25 * 0.25) * (0.75 * 0.75 + 0.25 * 0.25);
    let alone = together * (slave + squares * master) / (slave + master);
    for (found, expected) in sums.steepness.iter().zip([alone, together]) {
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }
    let sums =
        bodies.implicit(&mut bodies.contact(0, Rows::NodeToFace, Coulomb { mu: 0.3 }), &[]).sums;
    assert_eq!(sums.steepness, [0.0; 2], "constant friction does not fall");
}

#[test]
fn a_master_shows_the_gap_of_the_slaves_that_it_bears_and_their_slip_reversed() {
    let height = 1e-6;
    for rows in [Rows::NodeToFace, Rows::Mortar] {
        let mut bodies = Bodies::new(
            plate([0.0, 0.0], [8e-3, 8e-3], [5, 5], height, 1e-3, false),
            plate([0.0, 0.0], [8e-3, 8e-3], [4, 4], 0.0, 1e-3, true),
        );
        // on a flat that is held, twice as fast as it takes to close the gap in the step
        let upper = bodies.trace.side(0).len();
        bodies.free[..upper].fill(Padded::new([3.0, 0.0, -2.0 * height / DT]));
        bodies.inverse_mass[upper..].fill(0.0);
        let mut contact = bodies.contact(0, rows, Coulomb { mu: 0.0 });
        assert_eq!(bodies.explicit(&mut contact).sums.closed, 36);
        for (side, slip) in [(0, 3.0), (1, -3.0)] {
            let table = bodies.table(&contact, side);
            for found in &table.slip_velocity {
                assert!((found[0] - slip).abs() < 1e-12, "{rows:?} {side}: {found:?}");
            }
            for (pressure, gap) in table.pressure.iter().zip(&table.gap) {
                assert!(
                    *pressure > 0.0 && (gap - height).abs() < 1e-15,
                    "{rows:?} {side}: {gap:e}"
                );
            }
        }
    }
}
