use super::step_on_trace;
use crate::tests::plates::{STEEL, plate, together, tread};
use crate::{ContactSums, ContactTables, ExactContact, ExactSettings, NodalContact, Normals, Rows};
use friction::{Coulomb, Exponential, Implicit, NodeFriction};
use mesh::{Mesh, Padded, Surface};
use nalgebra::Vector3;

/// Two bodies whose nodes are masses without springs: what contact does to them in a step.
pub(super) struct Masses {
    contact: ExactContact,
    pub upper: usize,
    pub reference: Vec<Padded>,
    pub displacement: Vec<Padded>,
    velocity: Vec<Padded>,
    pub inverse_mass: Vec<f64>,
    force: Vec<Padded>,
    dt: f64,
}

impl Masses {
    fn new(
        upper: (Mesh, Surface),
        lower: (Mesh, Surface),
        slave: usize,
        rows: Rows,
        law: impl NodeFriction + 'static,
    ) -> Self {
        let settings =
            ExactSettings { slave: Some(slave), curvature: true, rows, normals: Normals::Averaged };
        Self::with(upper, lower, &settings, law)
    }

    pub fn with(
        upper: (Mesh, Surface),
        lower: (Mesh, Surface),
        settings: &ExactSettings,
        law: impl NodeFriction + 'static,
    ) -> Self {
        let count = upper.0.nodes.len();
        let (mesh, second) = together(upper.0, lower.0, lower.1);
        let surfaces = [(&upper.1, STEEL), (&second, STEEL)];
        let contact = ExactContact::new(&mesh, surfaces, settings, Box::new(law)).unwrap();
        let n = mesh.nodes.len();
        let noise =
            |i: usize| f64::from((i as u32).wrapping_mul(2_654_435_761) >> 8) / 16_777_216.0;
        Self {
            contact,
            upper: count,
            reference: mesh.nodes.iter().copied().map(Padded::from).collect(),
            displacement: vec![Padded::ZERO; n],
            velocity: vec![Padded::ZERO; n],
            inverse_mass: (0..n).map(|i| 1e5 * (1.0 + noise(i))).collect(),
            force: vec![Padded::ZERO; n],
            dt: 1e-7,
        }
    }

    /// A tread of large radius, 4 um above the plate at half its length, on a plate with other cells.
    fn rolling(slave: usize, rows: Rows, law: impl NodeFriction + 'static) -> Self {
        Self::new(
            tread(2.0, 4e-3, 8e-3, [14, 7], 1e-3),
            plate([-9e-3, -6e-3], [9e-3, 6e-3], [17, 11], 0.0, 1e-3, true),
            slave,
            rows,
            law,
        )
    }

    /// A step under the forces `given(body, X)` (N) on every node.
    pub fn step(&mut self, given: impl Fn(usize, Vector3<f64>) -> Vector3<f64>) -> ContactSums {
        for (i, (f, x)) in self.force.iter_mut().zip(&self.reference).enumerate() {
            *f = given(usize::from(i >= self.upper), x.vector()).into();
        }
        let sums = step_on_trace(
            &mut self.contact,
            [&self.reference, &self.displacement, &self.velocity],
            &self.inverse_mass,
            [0.0, self.dt],
            &mut self.force,
        );
        for i in 0..self.force.len() {
            self.velocity[i] += self.dt * self.inverse_mass[i] * self.force[i].vector();
            self.displacement[i] += self.dt * self.velocity[i].vector();
        }
        sums
    }

    fn positions(&self) -> Vec<Vector3<f64>> {
        let nodes = self.reference.iter().zip(&self.displacement);
        nodes.map(|(x, u)| x.vector() + u.vector()).collect()
    }

    /// Resultant and moment of the forces of contact alone on nodes at `positions`, of those that `given` leaves.
    fn resultants(
        &self,
        positions: &[Vector3<f64>],
        given: impl Fn(usize, Vector3<f64>) -> Vector3<f64>,
    ) -> [Vector3<f64>; 2] {
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for (i, x) in positions.iter().enumerate() {
            let by_contact = self.force[i].vector() - given(usize::from(i >= self.upper), *x);
            force += by_contact;
            moment += x.cross(&by_contact);
        }
        [force, moment]
    }

    fn table(&self, side: usize) -> NodalContact {
        let mut table = self.contact.nodal_table(side);
        self.contact.nodal(&mut table);
        table
    }
}

const ROWS: [Rows; 2] = [Rows::NodeToFace, Rows::Mortar];

/// Presses and pushes the upper body.
fn pressed(body: usize, _: Vector3<f64>) -> Vector3<f64> {
    if body == 0 { [4.0, 1.5, -20.0] } else { [0.0, 0.0, 2.0] }.into()
}

#[test]
fn contact_forces_have_no_resultant_and_no_moment() {
    for (slave, rows) in [0, 1].into_iter().flat_map(|s| ROWS.map(|rows| (s, rows))) {
        let mut masses = Masses::rolling(slave, rows, Coulomb { mu: 0.3 });
        let (mut closed, mut slipping) = (0, 0);
        for _ in 0..40 {
            let positions = masses.positions();
            let sums = masses.step(pressed);
            let [force, moment] = masses.resultants(&positions, pressed);
            closed += sums.closed;
            slipping += sums.slipping;
            let both = sums.force[0] + sums.force[1];
            assert!(both.norm() <= 1e-14 * sums.normal_force, "{both:?}");
            assert!(force.norm() <= 1e-12 * sums.normal_force.max(1.0), "{force:?}");
            // half the length of the patch as the arm
            assert!(moment.norm() <= 1e-9 * sums.normal_force * 4e-3, "{moment:?}");
        }
        assert!(closed > 400 && slipping > 100, "{closed} {slipping}");
    }
}

#[test]
fn the_conditions_hold_at_the_end_of_the_step() {
    let mu = 0.3;
    for rows in ROWS {
        let mut masses = Masses::rolling(0, rows, Coulomb { mu });
        let (mut sticks, mut slips) = (0, 0);
        for _ in 0..60 {
            let sums = masses.step(pressed);
            assert!(sums.sweeps < 40, "{}", sums.sweeps);
            assert!(sums.friction_ahead >= 0.0);
            let table = masses.table(0);
            for i in 0..table.nodes.len() {
                let (p, shear, slip) = (table.pressure[i], table.shear[i], table.slip_velocity[i]);
                assert!(p >= 0.0);
                assert!(shear.norm() <= mu * p * (1.0 + 1e-14));
                match table.state[i] {
                    1 => {
                        assert!(slip.norm() < 1e-9, "{slip:?}");
                        sticks += 1;
                    }
                    2 => {
                        assert!((shear.norm() / (mu * p) - 1.0).abs() < 1e-12);
                        let along = -shear.dot(&slip) / (shear.norm() * slip.norm());
                        assert!(along > 1.0 - 1e-9, "{along}");
                        slips += 1;
                    }
                    _ => assert_eq!(p, 0.0),
                }
            }
        }
        assert!(sticks > 100 && slips > 100, "{sticks} {slips}");
    }
}

#[test]
fn sweeps_that_end_before_forces_converge_say_by_how_much() {
    let mut masses = Masses::rolling(0, Rows::NodeToFace, Coulomb { mu: 0.3 });
    assert_eq!(masses.step(pressed).unconverged, 0.0);
    // on masters so much lighter the slaves that share one are as good as coupled rigidly
    let upper = masses.upper;
    masses.inverse_mass[upper..].iter_mut().for_each(|inverse| *inverse *= 1e5);
    let told: Vec<f64> = (0..10)
        .map(|_| masses.step(pressed))
        .map(|sums| if sums.sweeps < 100 { 0.0 } else { sums.unconverged })
        .collect();
    assert!(told.iter().any(|part| *part > 1e-12 && *part < 1.0), "{told:?}");
}

#[test]
fn nodes_that_were_pressed_end_the_step_without_a_gap() {
    for rows in ROWS {
        let mut masses = Masses::rolling(0, rows, Coulomb { mu: 0.3 });
        for _ in 0..30 {
            masses.step(pressed);
        }
        let before = masses.table(0);
        masses.step(pressed);
        let after = masses.table(0);
        let pressed = (0..before.nodes.len()).filter(|&i| before.pressure[i] > 0.0);
        let largest = pressed.map(|i| after.gap[i].abs()).fold(0.0, f64::max);
        // second order in the motion of a step: tilt of faces times slip
        let motion =
            masses.velocity.iter().map(|v| v.vector().norm() * masses.dt).fold(0.0, f64::max);
        assert!(largest < 1e-3 * motion, "{rows:?} {largest:e} {motion:e}");
    }
}

#[test]
fn the_master_bears_what_the_slaves_do() {
    for rows in ROWS {
        let mut masses = Masses::rolling(0, rows, Coulomb { mu: 0.3 });
        for _ in 0..20 {
            masses.step(pressed);
        }
        let [normal, friction] = [0, 1].map(|side: usize| {
            let t = masses.table(side);
            let sum = |value: &dyn Fn(usize) -> f64| {
                (0..t.nodes.len()).map(|i| value(i) * t.area[i]).sum::<f64>()
            };
            [sum(&|i| t.pressure[i]), sum(&|i| t.shear[i][0])]
        });
        assert!((normal[0] / friction[0] - 1.0).abs() < 1e-12);
        assert!((normal[1] / friction[1] + 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_common_rotation_gives_no_slip_velocity_across_the_sag_of_facets() {
    // pressed together at rest, then turning as one: slaves lie up to 0.4 um above the facets
    for rows in ROWS {
        let mut masses = Masses::rolling(1, rows, Coulomb { mu: 0.5 });
        for _ in 0..60 {
            masses.velocity.fill(Padded::ZERO);
            masses.step(pressed);
        }
        let turn = Vector3::new(20.0, 70.0, -30.0);
        for (i, x) in masses.positions().into_iter().enumerate() {
            masses.velocity[i] = turn.cross(&x).into();
        }
        let sums = masses.step(|_, _| Vector3::zeros());
        assert!(sums.normal_force < 1e-9, "nothing presses: {sums:?}");
        let sums = masses.step(|body, _| if body == 0 { -1e-3 } else { 0.0 } * Vector3::z());
        assert!(sums.closed > 5, "{sums:?}");
        let table = masses.table(1);
        let slip = table.slip_velocity.iter().map(|s| s.norm()).fold(0.0, f64::max);
        assert!(slip < 1e-6, "{rows:?} {slip:e}");
    }
}

#[test]
fn falling_friction_of_the_same_instant_obeys_equation_8_and_counts_where_it_has_more_solutions() {
    let law = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
    // R = dt W p_n A k dmu is about 10
    let mut masses = Masses::new(
        plate([-3e-3, -3e-3], [3e-3, 3e-3], [7, 7], 0.0, 1e-3, false),
        plate([-9e-3, -6e-3], [9e-3, 6e-3], [17, 11], 0.0, 1e-3, true),
        0,
        Rows::NodeToFace,
        Implicit(law),
    );
    let (mut slips, mut non_unique) = (0, 0);
    for n in 0..80 {
        let push = 5.0 * f64::from(n);
        let given = |body: usize, _: Vector3<f64>| -> Vector3<f64> {
            if body == 0 { [push, 0.0, -400.0] } else { [0.0, 0.0, 40.0] }.into()
        };
        let sums = masses.step(given);
        assert!(sums.sweeps < 100, "step {n}");
        non_unique += sums.non_unique;
        let table = masses.table(0);
        for i in (0..table.nodes.len()).filter(|&i| table.state[i] == 2) {
            let mu = friction::FrictionLaw::mu(&law, table.slip_velocity[i].norm());
            assert!((table.shear[i].norm() / (mu * table.pressure[i]) - 1.0).abs() < 1e-9);
            slips += 1;
        }
    }
    assert!(slips > 100 && non_unique > 0, "{slips} {non_unique}");
}

#[test]
fn mortar_rows_slide_over_a_mesh_that_does_not_match_without_gap_moment_or_allocation() {
    // at 300 m/s weights grow old every other step
    let mut masses = Masses::new(
        plate([-3e-3, -3e-3], [3e-3, 3e-3], [7, 7], 0.0, 1e-3, false),
        plate([-9e-3, -6e-3], [9e-3, 6e-3], [17, 11], 0.0, 1e-3, true),
        0,
        Rows::Mortar,
        Coulomb { mu: 0.3 },
    );
    // the lower plate is held and stays flat
    masses.inverse_mass[masses.upper..].fill(0.0);
    masses.velocity[..masses.upper].fill(Padded::new([300.0, 70.0, 0.0]));
    let given = |body: usize, _: Vector3<f64>| if body == 0 { -200.0 } else { 0.0 } * Vector3::z();
    let (mut integrated, mut room) = (0, None);
    for n in 0..60 {
        let positions = masses.positions();
        let sums = masses.step(given);
        assert_eq!(sums.closed, 64);
        assert!(sums.friction_ahead > 0.0);
        assert!(sums.max_penetration < 1e-15, "{:e}", sums.max_penetration);
        let [force, moment] = masses.resultants(&positions, given);
        assert!(force.norm() <= 1e-12 * sums.normal_force, "{force:?}");
        assert!(moment.norm() <= 1e-12 * sums.normal_force * 6e-3, "{moment:?}");
        integrated += sums.integrated;
        if n == 20 {
            room = Some(masses.contact.room());
        }
    }
    assert!(integrated > 20 * 64, "{integrated}");
    assert_eq!(room, Some(masses.contact.room()));
}
