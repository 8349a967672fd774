//! A hub that drifts, and turns about the vertical.

use super::free_body;
use crate::dashpots::RigidMotion;
use crate::{Hub, QuietEnd, Setup, Sideways, Simulation, Spin, Vertical};
use mesh::{Mesh, Padded};

const FREE: Spin = Spin::Torque { torque: 0.02, ramp: 0.0 };
const STEADY: Spin = Spin::Creepage { free: 1e4, creepage: 0.0, ramp: 0.0 };

fn cube() -> Mesh {
    mesh::block([3, 2, 2], [4e-3, 4e-3, 4e-3])
}

/// The cube about an axle off its centre of mass; `nodes` are the hub's.
fn setup(mesh: &Mesh, nodes: &[u32], spin: Spin, vertical: Vertical, sideways: Sideways) -> Setup {
    let mut setup = free_body(mesh, 0.67, Vec::new(), QuietEnd::default());
    let (reference, mass) = (setup.system.solid.reference(), &setup.system.mass);
    let mut hub =
        Hub::new([0.5e-3, 1e-3, 1.5e-3].into(), nodes, reference, mass, 0.0, spin, vertical);
    hub.sideways = Some(sideways);
    (hub.state.vx, hub.state.omega) = (sideways.speed, 1e4);
    setup.system.hub = Some(hub);
    setup.system.upper = 0..mesh.nodes.len();
    setup
}

fn every_node(mesh: &Mesh) -> Vec<u32> {
    (0..mesh.nodes.len() as u32).collect()
}

const CURVE: Sideways =
    Sideways { speed: 3.0, lateral_creepage: 0.4, spin: 700.0, ramp: 2e-4, behind: 0.0 };

#[test]
fn what_drives_a_rigid_hub_gives_it_momentum_and_moment_of_momentum_and_energy() {
    let mesh = cube();
    for (spin, vertical) in [
        (FREE, Vertical::Load(30.0)),
        (FREE, Vertical::Held),
        (STEADY, Vertical::Load(30.0)),
        (STEADY, Vertical::Held),
    ] {
        let setup = setup(&mesh, &every_node(&mesh), spin, vertical, CURVE);
        let mass = setup.system.mass.clone();
        let mut simulation = Simulation::new(setup);
        let momentum = |simulation: &Simulation| {
            let moving = mass.iter().zip(&simulation.nodes.velocity);
            let placed = simulation.nodes.displacement.iter().zip(&mesh.nodes);
            let mut sums = [0.0; 4];
            for ((m, v), (u, x)) in moving.zip(placed) {
                // the place at the half step
                let back = 0.5 * simulation.dt;
                let [rx, ry] = [0, 1].map(|i: usize| x[i] + u[i] - back * v[i]);
                (0..3).for_each(|i| sums[i] += m * v[i]);
                sums[3] += m * (rx * v[1] - ry * v[0]);
            }
            sums
        };
        simulation.step(true);
        let before = momentum(&simulation);
        let mut given = [0.0; 4];
        let mut largest = [0.0_f64; 4];
        for _ in 0..2500 {
            let hub = simulation.system.hub.as_ref().unwrap();
            let (x, y) = (hub.centre[0] + hub.state.x, hub.centre[1] + hub.state.y);
            let drive = simulation.step(true).drive;
            let moment = drive.moment_z + x * drive.force_y - y * drive.force_x;
            // the torque is about the axle, which lies in the plane of x and y
            let all = [drive.force_x, drive.force_y, drive.force_z, moment];
            for i in 0..4 {
                given[i] += simulation.dt * all[i];
                largest[i] = largest[i].max(given[i].abs());
            }
        }
        let after = momentum(&simulation);
        let state = simulation.system.hub.as_ref().unwrap().state;
        assert!(state.heading > 0.5 && state.angle > 1.0 && state.y > 1e-4, "{state:?}");
        for i in 0..4 {
            let error = (after[i] - before[i] - given[i]).abs() / largest[i];
            assert!(error < 2e-3, "{i}: {error:e}, {after:?} {given:?}");
        }
        let error = simulation.ledger().balance_error();
        assert!(error < 1e-5, "{error:e}");
    }
}

#[test]
fn an_elastic_body_on_a_hub_that_turns_keeps_its_balance_of_energy_with_dashpots_too() {
    let mesh = cube();
    let held = &mesh.bodies[0].node_sets["z+"];
    for damping in [0.0, 2e4] {
        let mut setup = setup(&mesh, held, STEADY, Vertical::Held, CURVE);
        setup.system.mass_damping = damping;
        let motion = RigidMotion::new(setup.system.hub.as_ref().unwrap());
        for (v, x) in setup.velocity.iter_mut().zip(&mesh.nodes) {
            let ([vx, vy, vz, _], _) = motion.at(Padded::from(*x));
            *v = Padded::new([vx, vy, vz]);
        }
        let mut simulation = Simulation::new(setup);
        for _ in 0..2500 {
            simulation.step(true);
        }
        let error = simulation.ledger().balance_error();
        assert!(error < 1e-4, "{error:e}");
        assert_eq!(simulation.ledger().damping > 0.0, damping > 0.0);
    }
}

#[test]
fn the_upper_body_slips_over_the_lower_by_minus_spin_y_and_spin_x_and_the_drift() {
    let mesh = cube();
    let (speed, spin, lateral_creepage) = (30.0, 0.3, 2e-3);
    let sideways = Sideways { speed, lateral_creepage, spin, ramp: 0.0, behind: 0.0 };
    let still = Spin::Creepage { free: 0.0, creepage: 0.0, ramp: 0.0 };
    let mut setup = setup(&mesh, &every_node(&mesh), still, Vertical::Held, sideways);
    let hub = setup.system.hub.as_mut().unwrap();
    hub.state.omega = 0.0;
    let centre = hub.centre;
    let mut simulation = Simulation::new(setup);
    simulation.step(false);
    for (v, x) in simulation.velocity().iter().zip(&mesh.nodes) {
        let [x, y] = [0, 1].map(|i: usize| x[i] - centre[i]);
        let wanted = [speed * (1.0 - spin * y), speed * (lateral_creepage + spin * x), 0.0];
        for i in 0..3 {
            assert!((v[i] - wanted[i]).abs() < 1e-6 * speed, "{i}: {v:?} {wanted:?}");
        }
    }
    // the dashpots know the same motion
    let motion = RigidMotion::new(simulation.hub().unwrap());
    for (v, x) in simulation.velocity().iter().zip(&mesh.nodes) {
        let (rigid, _) = motion.at(Padded::from(*x));
        assert!((0..3).all(|i| (v[i] - rigid[i]).abs() < 1e-6 * speed), "{v:?} {rigid:?}");
    }
}

#[test]
fn the_hub_follows_an_arc_and_the_patch_behind_it_keeps_its_speed() {
    let mesh = cube();
    let (speed, spin) = (30.0, 200.0);
    let sideways = Sideways { speed, lateral_creepage: 0.0, spin, ramp: 0.0, behind: 0.0 };
    let ends = [0.0, 1.0].map(|behind| {
        let sideways = Sideways { behind, ..sideways };
        let mut simulation =
            Simulation::new(setup(&mesh, &every_node(&mesh), STEADY, Vertical::Held, sideways));
        (0..500).for_each(|_| {
            simulation.step(false);
        });
        (simulation.hub().unwrap().state, simulation.time())
    });
    let (state, time) = ends[0];
    let heading = spin * speed * time;
    assert!(heading > 0.1 && (state.heading / heading - 1.0).abs() < 1e-10, "{heading}");
    let arc = [libm::sin(heading) / spin, (1.0 - libm::cos(heading)) / spin];
    assert!((state.x - arc[0]).abs() < 1e-6 / spin && (state.y - arc[1]).abs() < 1e-6 / spin);
    let (state, _) = ends[1];
    // of the patch, which is where the upper body was before it drifted
    let speed_there = state.vx * libm::cos(state.heading)
        + state.vy * libm::sin(state.heading)
        + state.turning * state.y;
    assert!((speed_there / speed - 1.0).abs() < 1e-3, "{speed_there}");
}
