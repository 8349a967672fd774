//! Implicit steps.

use super::{body_of, free_body};
use crate::{Cause, Fixed, QuietEnd, Setup, Simulation, Vertical};
use crate::{Hub, Spin};
use contact::{BodyMaterial, ContactError, ExactContact, ExactSettings};
use friction::Coulomb;
use mesh::{Mesh, Padded};
use nalgebra::Vector3;
use solid::{Element, Level, Solid, Viscosity};

/// A cube that breathes.
fn breathing(longer: f64) -> Setup {
    let mesh = mesh::block([3, 3, 3], [3e-3; 3]);
    let mut setup = free_body(&mesh, longer, Vec::new(), QuietEnd::default());
    for (v, x) in setup.velocity.iter_mut().zip(&mesh.nodes) {
        *v = Padded::from(x.map(|c| 1e-3 * (c / 1.5e-3 - 1.0)));
    }
    setup
}

/// The energy of the cube after 200 steps over that at the start.
fn energy_left(theta: f64) -> f64 {
    let mut simulation = Simulation::new(breathing(5.0));
    simulation.set_implicit(theta);
    let energies = (0..=200).map(|_| simulation.step(true).energies.unwrap().total());
    let energies: Vec<f64> = energies.collect();
    // what is left grows with the strain, 1e-3 m/s over the speed of sound
    assert!(simulation.ledger().balance_error() < 1e-6, "{}", simulation.ledger().balance_error());
    let last = simulation.ledger().damping;
    (energies[200] - last) / energies[0]
}

#[test]
fn elastic_energy_is_kept_with_theta_one_half_and_lost_with_theta_one_as_booked() {
    assert!((energy_left(0.5) - 1.0).abs() < 1e-6, "{}", energy_left(0.5));
    assert!(energy_left(1.0) < 0.1, "{}", energy_left(1.0));
}

/// Displacements of the cube after steps of `longer` times the stable one; explicit steps without `theta`.
fn breathed(longer: f64, steps: u64, theta: Option<f64>) -> Vec<Padded> {
    let mut simulation = Simulation::new(breathing(longer));
    if let Some(theta) = theta {
        simulation.set_implicit(theta);
    }
    (0..steps).for_each(|_| _ = simulation.step(false));
    simulation.displacement().to_vec()
}

#[test]
fn a_free_cube_moves_as_by_explicit_steps_up_to_the_square_of_the_step() {
    let differ = |longer: f64, steps: u64| {
        let [explicit, implicit] = [None, Some(0.5)].map(|theta| breathed(longer, steps, theta));
        let between = explicit
            .iter()
            .zip(&implicit)
            .flat_map(|(a, b)| [0, 1, 2].map(|i| (a.xyz()[i] - b.xyz()[i]).abs()));
        between.fold(0.0, f64::max)
    };
    let [long, short] = [differ(0.2, 20), differ(0.1, 40)];
    let order = libm::log2(long / short);
    assert!((order - 2.0).abs() < 0.1, "{order}: {long} and {short}");
}

/// Two cubes one upon the other, the upper pressed down and pushed sideways.
fn cubes(mu: f64) -> Result<(Mesh, Setup), ContactError> {
    let upper = mesh::block([2, 2, 2], [2e-3; 3]);
    let mut lower = mesh::block([3, 3, 2], [3e-3, 3e-3, 2e-3]);
    lower.nodes.iter_mut().for_each(|x| *x -= Vector3::new(0.6e-3, 0.4e-3, 2e-3));
    let mesh = mesh::join(&[upper, lower]);
    let material =
        BodyMaterial { bulk_modulus: super::STEEL.bulk(), density: super::STEEL.density };
    let surfaces = [&mesh.bodies[0].surfaces["z-"], &mesh.bodies[1].surfaces["z+"]];
    let settings = ExactSettings { slave: Some(0), ..ExactSettings::default() };
    let surfaces = surfaces.map(|surface| (surface, material));
    let contact = ExactContact::new(&mesh, surfaces, &settings, Box::new(Coulomb { mu }))?;
    let mass = solid::lumped_mass(&mesh, &[super::STEEL.density; 2]);
    let element = Element { hourglass: 0.05 };
    let materials = [super::STEEL; 2];
    let solid =
        Solid::new(&mesh, &materials, element, Viscosity::default(), Level::detect()).unwrap();
    let n = mass.len();
    let weight =
        crate::Load::weight(&mass, 0..mesh.bodies[0].nodes.end, Vector3::new(2e6, 0.0, -1e7));
    let below = |node: &usize| mesh.nodes[*node][2] < -1.9e-3;
    let held = (0..n).filter(below).map(|node| node as u32).collect();
    let system = crate::System {
        contact: Some(contact.into()),
        held,
        load: crate::Load { ramp: 2e-5, ..weight },
        ..crate::System::free(solid, mass)
    };
    let rest = vec![Padded::ZERO; n];
    let setup =
        Setup { system, displacement: rest.clone(), velocity: rest, dt: 1e-6, dt_limit: 2e-7 };
    Ok((mesh, setup))
}

#[test]
fn a_step_taken_up_again_has_the_same_bits() {
    let mut whole = Simulation::new(cubes(0.1).unwrap().1);
    whole.set_implicit(0.6);
    (0..20).for_each(|_| _ = whole.step(true));
    let state = whole.snapshot();
    let mut resumed = Simulation::new(cubes(0.1).unwrap().1);
    resumed.set_implicit(0.6);
    resumed.restore(&state).unwrap();
    for _ in 0..20 {
        assert_eq!(whole.step(true), resumed.step(true));
    }
    assert!(whole.ledger().friction > 0.0, "the block slid");
    assert_eq!(whole.displacement(), resumed.displacement());
    assert_eq!(whole.effort(), resumed.effort());
}

#[test]
fn forces_of_contact_keep_momentum_and_the_law_holds_at_the_end_of_the_step() {
    let (_, setup) = cubes(0.1).unwrap();
    let mut simulation = Simulation::new(setup);
    simulation.set_implicit(0.5);
    for _ in 0..40 {
        let report = simulation.step(true);
        assert_eq!(simulation.check(&report), None);
        for i in 0..3 {
            let [a, b] = [0, 1].map(|side: usize| report.contact.force[side][i]);
            assert!((a + b).abs() <= 1e-12 * report.contact.normal_force.abs(), "{a} {b}");
        }
    }
    let contact = simulation.contact().unwrap();
    let mut table = contact.nodal_table(0);
    contact.nodal(&mut table);
    let mut slipping = 0;
    for i in 0..table.state.len() {
        let [shear, slip] = [table.shear[i], table.slip_velocity[i]];
        assert!(shear.norm() <= 0.1 * table.pressure[i] * (1.0 + 1e-12));
        if table.state[i] == 2 {
            slipping += 1;
            let along = shear.dot(&slip);
            // unless it creeps at the tolerance of the step
            assert!(slip.norm() < 1e-6 || along < -0.999 * shear.norm() * slip.norm());
        }
    }
    assert!(slipping > 0);
}

#[test]
fn a_step_that_cannot_be_solved_is_cut_and_then_stops_the_run_with_its_state_as_it_was() {
    let (_, mut setup) = cubes(0.3).unwrap();
    setup.velocity[0] = Padded::new([f64::NAN, 0.0, 0.0]);
    let mut simulation = Simulation::new(setup);
    simulation.set_implicit(0.6);
    let report = simulation.step(false);
    let found = simulation.check(&report).unwrap();
    assert!(matches!(found.cause, Cause::Unsolved(_)), "{found}");
    assert_eq!(simulation.effort().unwrap().cut, 4);
    assert!(found.to_string().contains("not even in parts"), "{found}");
}

#[test]
fn the_load_on_a_hub_reaches_the_ground_through_long_steps() {
    // a cube on the ground by its lowest nodes, pressed by a hub at its top
    let mesh = mesh::block([2, 2, 4], [2e-3, 2e-3, 4e-3]);
    let level = |z: f64| {
        let nodes = mesh.nodes.iter().enumerate().filter(move |(_, x)| (x[2] - z).abs() < 1e-6);
        nodes.map(|(n, _)| n as u32).collect::<Vec<_>>()
    };
    let mut setup = body_of(&mesh, super::ONE_POINT.into(), 50.0, level(0.0), QuietEnd::default());
    let (reference, mass) = (setup.system.solid.reference(), &setup.system.mass);
    let spin = Spin::Creepage { free: 0.0, creepage: 0.0, ramp: 0.0 };
    let top = level(4e-3);
    let hub = Hub::new(
        [1e-3, 1e-3, 4e-3].into(),
        &top,
        reference,
        mass,
        1e-3,
        spin,
        Vertical::Load(100.0),
    );
    setup.system.hub = Some(hub);
    setup.system.upper = 0..mesh.nodes.len();
    setup.system.fixed = (0..mesh.nodes.len() as u32)
        .map(|node| Fixed { node, axes: [false, true, false] })
        .collect();
    let mut simulation = Simulation::new(setup);
    simulation.set_implicit(1.0);
    for _ in 0..400 {
        let report = simulation.step(false);
        assert_eq!(report.unsolved, None);
    }
    let force = simulation.elastic_force();
    let ground: f64 = level(0.0).iter().map(|&n| force[n as usize][2]).sum();
    assert!((ground + 100.0).abs() < 0.1, "{ground}");
}
