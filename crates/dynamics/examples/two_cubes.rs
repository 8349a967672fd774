//! Two elastic cubes: the upper one is pressed on the lower one and slides over it. Everything that a
//! scenario must say of itself: mesh, what is held, what presses, contact, start.
//!
//! ```sh
//! cargo run --release -p creepage-dynamics --example two_cubes
//! ```
#![allow(clippy::unwrap_used)]

use contact::{BodyMaterial, ExactContact, ExactSettings};
use dynamics::{Load, Setup, Simulation, System};
use friction::Coulomb;
use mesh::{Mesh, Padded};
use nalgebra::Vector3;
use solid::{Element, Level, Material, Solid, Viscosity};

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };
const MU: f64 = 0.3;
/// Sides of the upper and of the lower cube (m).
const SIDES: [f64; 2] = [6e-3, 10e-3];
/// Elements along a side.
const CELLS: [usize; 2] = [6, 8];
/// Pressing force (N), and how long it rises (s).
const FORCE: f64 = 50.0;
const RAMP: f64 = 2e-5;
/// Velocity of the upper cube at the start (m/s).
const SPEED: f64 = 5.0;
const STEPS: usize = 1000;

fn main() {
    let mesh = cubes();
    let mass = solid::lumped_mass(&mesh, &[STEEL.density; 2]);
    let element = Element { hourglass: 0.05 };
    let viscosity = Viscosity { bulk_linear: 0.06, ..Viscosity::default() };
    let mut solid = Solid::new(&mesh, &[STEEL; 2], element, viscosity, Level::detect()).unwrap();
    let inverse: Vec<f64> = mass.iter().map(|m| 1.0 / m).collect();
    let omega_max =
        1.01 * solid::largest_frequency(&inverse, |x, y| solid.add_stiffness_product(x, y), 40);

    let behind = BodyMaterial { bulk_modulus: STEEL.bulk(), density: STEEL.density };
    let surfaces =
        [(&mesh.bodies[0].surfaces["z-"], behind), (&mesh.bodies[1].surfaces["z+"], behind)];
    let settings = ExactSettings { slave: Some(0), ..ExactSettings::default() };
    let contact =
        ExactContact::new(&mesh, surfaces, &settings, Box::new(Coulomb { mu: MU })).unwrap();

    let top = &mesh.bodies[0].node_sets["z+"];
    let share = -FORCE / top.len() as f64;
    let system = System {
        contact: Some(contact.into()),
        held: mesh.bodies[1].node_sets["z-"].clone(),
        load: Load { forces: top.iter().map(|&n| (n, share * Vector3::z())).collect(), ramp: RAMP },
        ..System::free(solid, mass)
    };
    let nodes = mesh.nodes.len();
    let mut velocity = vec![Padded::ZERO; nodes];
    velocity[mesh.bodies[0].nodes.clone()].fill(Padded::new([SPEED, 0.0, 0.0]));
    let displacement = vec![Padded::ZERO; nodes];
    let dt_limit = 2.0 / omega_max;
    let dt = 0.67 * dt_limit;
    let mut simulation = Simulation::new(Setup { system, displacement, velocity, dt, dt_limit });

    println!("  t (us)      N (N)      T/N   closed");
    for n in 0..STEPS {
        let report = simulation.step(n % 10 == 0);
        if let Some(diagnosis) = simulation.check(&report) {
            println!("{diagnosis}");
            return;
        }
        if n % 100 == 99 {
            let tangential = report.contact.force[1][0];
            let ratio = tangential / report.contact.normal_force;
            let (time, closed) = (report.time * 1e6, report.contact.closed);
            println!("{time:8.2} {:10.1} {ratio:8.5} {closed:8}", report.contact.normal_force);
        }
    }
    println!("energy balance: off by {:.1e}", simulation.ledger().balance_error());
}

/// The upper cube (body 0) in the middle of the lower one.
fn cubes() -> Mesh {
    let cube = |body: usize, at: [f64; 3], name: &str| {
        let mut mesh = mesh::block([CELLS[body]; 3], [SIDES[body]; 3]);
        mesh.nodes.iter_mut().for_each(|x| (0..3).for_each(|i| x[i] += at[i]));
        mesh.bodies[0].name = name.into();
        mesh
    };
    let beside = 0.5 * (SIDES[1] - SIDES[0]);
    mesh::join(&[cube(0, [beside, beside, SIDES[1]], "upper"), cube(1, [0.0; 3], "lower")])
}
