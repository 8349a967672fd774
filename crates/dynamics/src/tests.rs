#![allow(clippy::unwrap_used)]
mod implicit;
mod sideways;

use super::*;
use mesh::{Mesh, Padded};
use nalgebra::Vector3;
use solid::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric, lumped_mass};

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };

const ONE_POINT: Element = Element { hourglass: 0.05 };

fn free_body(mesh: &Mesh, dt_factor: f64, held: Vec<u32>, quiet: QuietEnd) -> Setup {
    body_of(mesh, ONE_POINT.into(), dt_factor, held, quiet)
}

fn body_of(
    mesh: &Mesh,
    elements: Elements,
    dt_factor: f64,
    held: Vec<u32>,
    quiet: QuietEnd,
) -> Setup {
    let mass = lumped_mass(mesh, &[STEEL.density]);
    let mut solid =
        Solid::new(mesh, &[STEEL], elements, Viscosity::default(), Level::detect()).unwrap();
    let inverse: Vec<_> = mass.iter().map(|m| 1.0 / m).collect();
    let omega_max =
        1.01 * solid::largest_frequency(&inverse, |x, y| solid.add_stiffness_product(x, y), 40);
    let n = mass.len();
    Setup {
        system: System { quiet, held, ..System::free(solid, mass) },
        displacement: vec![Padded::ZERO; n],
        velocity: vec![Padded::ZERO; n],
        dt: dt_factor * 2.0 / omega_max,
        dt_limit: 2.0 / omega_max,
    }
}

#[test]
fn a_free_elastic_cube_in_rotation_conserves_energy_to_1e_8_over_1e4_steps() {
    let mesh = mesh::block([4, 4, 4], [4e-3, 4e-3, 4e-3]);
    let half: Vec<_> = (0..mesh.hexes.len()).map(|e| e % 2 == 0).collect();
    for elements in [
        ONE_POINT.into(),
        Volumetric::Full.into(),
        Elements::mixed(ONE_POINT, &half, Volumetric::Mean),
    ] {
        rotates(&mesh, body_of(&mesh, elements, 0.67, Vec::new(), QuietEnd::default()));
    }
}

/// Spins a free cube of 4 mm and checks its energy.
fn rotates(mesh: &Mesh, mut setup: Setup) {
    let spin = [200.0, -500.0, 800.0]; // rad/s: several turns, and it breathes under its own pull
    for (v, x) in setup.velocity.iter_mut().zip(&mesh.nodes) {
        let r = x.map(|c| c - 2e-3);
        *v = Padded::new([
            spin[1] * r[2] - spin[2] * r[1],
            spin[2] * r[0] - spin[0] * r[2],
            spin[0] * r[1] - spin[1] * r[0],
        ]);
    }
    let mut simulation = Simulation::new(setup);
    let mut worst: f64 = 0.0;
    let mut initial = None;
    for n in 0..10_000 {
        let report = simulation.step(n % 10 == 0);
        if let Some(e) = report.energies {
            assert!(simulation.check(&report).is_none());
            let start = *initial.get_or_insert(e.total());
            worst = worst.max((e.total() - start).abs() / start);
        }
    }
    assert!(worst < 1e-8, "{worst:e}");
    let turned = simulation.displacement()[0].xyz().iter().map(|c| c * c).sum::<f64>().sqrt();
    assert!(turned > 1e-3, "the cube really turned: {turned}");
}

#[test]
fn an_elastic_cube_at_rest_under_no_force_stays_at_rest() {
    let mesh = mesh::block([3, 3, 3], [1.0, 1.0, 1.0]);
    let mut simulation = Simulation::new(free_body(&mesh, 0.9, Vec::new(), QuietEnd::default()));
    (0..100).for_each(|_| {
        simulation.step(false);
    });
    assert!(simulation.displacement().iter().all(|u| *u == Padded::ZERO));
}

#[test]
fn a_step_above_the_limit_is_diagnosed_as_unstable() {
    let mesh = mesh::block([3, 3, 3], [1e-3, 1e-3, 1e-3]);
    let mut setup = free_body(&mesh, 1.6, Vec::new(), QuietEnd::default());
    setup.velocity[0] = Padded::new([1e-3, 0.0, 0.0]);
    let mut simulation = Simulation::new(setup);
    let found = (0..200).find_map(|_| {
        let report = simulation.step(true);
        simulation.check(&report)
    });
    let found = found.unwrap();
    assert!(found.step < 50, "{}", found.step);
    assert!(matches!(found.cause, Cause::UnstableStep { ratio } if ratio > 1.5));
    assert!(found.to_string().contains("1.60 times the stability limit"), "{found}");
}

#[test]
fn a_slender_bar_carries_waves_at_sqrt_e_over_rho() {
    let n = 200;
    let h = 1e-3;
    let mesh = mesh::block([n, 1, 1], [n as f64 * h, h, h]);
    let mut setup = free_body(&mesh, 0.5, Vec::new(), QuietEnd::default());
    let v0 = 1e-3;
    // the left end is driven at v0: an infinitely heavy layer
    for (i, x) in mesh.nodes.iter().enumerate() {
        if x[0] < 0.5 * h {
            setup.velocity[i] = Padded::new([v0, 0.0, 0.0]);
            setup.system.mass[i] = 1e9;
        }
    }
    let mut simulation = Simulation::new(setup);
    let rod = (STEEL.young / STEEL.density).sqrt();
    while simulation.time() < 0.6 * n as f64 * h / rod {
        simulation.step(false);
    }
    // Dispersion blurs the front but not the momentum behind it: p = rho A c t v0.
    let sum: f64 = (0..mesh.nodes.len())
        .filter(|&i| mesh.nodes[i][0] > 0.5 * h)
        .map(|i| simulation.velocity()[i].0[0])
        .sum();
    let speed = sum * h / 4.0 / (v0 * simulation.time());
    assert!((speed / rod - 1.0).abs() < 0.01, "{speed} against {rod}");
}

#[test]
fn quiet_ends_swallow_a_longitudinal_wave_within_one_percent_of_its_amplitude() {
    let (n, h) = (160, 1e-3);
    let mut mesh = mesh::block([n, 1, 1], [n as f64 * h, h, h]);
    mesh.bodies[0].name = "rod".into();
    // nu = 0: the wave of a rod is the confined wave, for which the dashpot is exact
    let material = Material { poisson: 0.0, ..STEEL };
    let end = mesh.bodies[0].surfaces["x+"].clone();
    let mut setup =
        free_body(&mesh, 0.5, Vec::new(), QuietEnd::new(&mesh, &[&end], &material, &[]));
    setup.system.solid = Solid::new(
        &mesh,
        &[material],
        Element { hourglass: 0.05 },
        Viscosity::default(),
        Level::detect(),
    )
    .unwrap();
    // a right-going pulse: v = -c du/dx
    let c = material.c_p();
    for (i, x) in mesh.nodes.iter().enumerate() {
        let pulse = |s: f64| 1e-8 * libm::exp(-s * s);
        let s = (x[0] - 0.08) / 0.012;
        setup.displacement[i].0[0] = pulse(s);
        // half a step earlier the pulse stood further left
        let s = s + 0.5 * c * setup.dt / 0.012;
        setup.velocity[i].0[0] = c * 2.0 * s / 0.012 * pulse(s);
    }
    let peak = setup.velocity.iter().map(|v| v.0[0].abs()).fold(0.0, f64::max);
    let mut simulation = Simulation::new(setup);
    let mut balance = 0.0;
    while simulation.time() < 0.16 / c {
        let report = simulation.step(true);
        assert!(report.energies.is_some());
        balance = simulation.ledger().balance_error();
    }
    let left = simulation.velocity().iter().map(|v| v.0[0].abs()).fold(0.0, f64::max);
    assert!(left < 0.01 * peak, "{}", left / peak);
    assert!(balance < 1e-3, "{balance:e}");
}

#[test]
fn thread_counts_give_the_same_bits() {
    let mesh = mesh::block([16, 16, 16], [0.016, 0.016, 0.016]);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut setup = free_body(&mesh, 0.67, Vec::new(), QuietEnd::default());
            for (i, v) in setup.velocity.iter_mut().enumerate() {
                v.0[0] = libm::sin(i as f64);
            }
            let mut simulation = Simulation::new(setup);
            let energies: Vec<_> = (0..50).map(|_| simulation.step(true).energies).collect();
            (simulation.displacement().to_vec(), energies)
        })
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(3));
}

#[test]
fn smoothstep_rises_from_zero_to_one_and_is_a_step_without_a_ramp() {
    assert_eq!(smoothstep(0.0, 2.0), 0.0);
    assert_eq!(smoothstep(1.0, 2.0), 0.5);
    assert_eq!(smoothstep(3.0, 2.0), 1.0);
    assert_eq!(smoothstep(0.0, 0.0), 1.0);
}

#[test]
fn a_weight_on_a_free_body_gives_its_acceleration_and_its_work_is_booked() {
    let mesh = mesh::block([2, 2, 2], [2e-3, 2e-3, 2e-3]);
    let mut setup = free_body(&mesh, 0.67, Vec::new(), QuietEnd::default());
    let g = Vector3::new(30.0, -20.0, 10.0);
    setup.system.load = Load::weight(&setup.system.mass, 0..mesh.nodes.len(), g);
    let mass: f64 = setup.system.mass.iter().sum();
    let dt = setup.dt;
    let mut simulation = Simulation::new(setup);
    let energies = (0..=100).map(|_| simulation.step(true).energies.unwrap()).last().unwrap();
    // v^{n+1/2} = n g dt + g dt from rest at -dt/2
    for v in simulation.velocity() {
        for i in 0..3 {
            assert!((v.0[i] / (101.0 * dt * g[i]) - 1.0).abs() < 1e-9);
        }
    }
    // at n = 100: T = 1/2 m g^2 dt^2 n (n + 1)
    let kinetic = 0.5 * mass * 1400.0 * dt * dt * 100.0 * 101.0;
    assert!((energies.kinetic / kinetic - 1.0).abs() < 1e-9, "{} {kinetic}", energies.kinetic);
    assert!((energies.external_work / kinetic - 1.0).abs() < 1e-9);
    assert!(simulation.ledger().balance_error() < 1e-9);
}

#[test]
fn fixed_directions_do_not_move_and_their_supports_do_no_work() {
    let mesh = mesh::block([4, 2, 2], [4e-3, 2e-3, 2e-3]);
    let mut setup = free_body(&mesh, 0.67, Vec::new(), QuietEnd::default());
    let sides = &mesh.bodies[0].node_sets["y-"];
    setup.system.fixed =
        sides.iter().map(|&node| Fixed { node, axes: [false, true, false] }).collect();
    setup.velocity.iter_mut().zip(&mesh.nodes).for_each(|(v, x)| {
        // strains near 1e-10: the trapezoidal work is exact for a linear force
        *v = Padded::new([1e-4 * x[0], 3e-6 - 5e-4 * x[2], 2e-4 * x[1]]);
    });
    let mut simulation = Simulation::new(setup);
    for _ in 0..500 {
        simulation.step(true);
    }
    let u = simulation.displacement();
    assert!(sides.iter().all(|&n| u[n as usize].0[1] == 0.0));
    assert!(sides.iter().any(|&n| u[n as usize].0[0] != 0.0));
    assert!(u.iter().any(|u| u.0[1] != 0.0));
    let error = simulation.ledger().balance_error();
    assert!(error < 1e-9, "{error:e}");
}

/// A free cube of 4 mm whose hub, its upper face, moves at 10 m/s in x.
fn carried() -> Simulation {
    let mesh = mesh::block([4, 4, 4], [4e-3, 4e-3, 4e-3]);
    let mut setup = free_body(&mesh, 0.67, Vec::new(), QuietEnd::default());
    setup.velocity.fill(Padded::new([10.0, 0.0, 0.0]));
    let mut hub = Hub::new(
        [2e-3; 3].into(),
        &mesh.bodies[0].node_sets["z+"],
        setup.system.solid.reference(),
        &setup.system.mass,
        0.0,
        Spin::Creepage { free: 0.0, creepage: 0.0, ramp: 0.0 },
        Vertical::Held,
    );
    hub.state.vx = 10.0;
    setup.system.hub = Some(hub);
    setup.system.upper = 0..mesh.nodes.len();
    Simulation::new(setup)
}

#[test]
fn a_hub_whose_centre_of_mass_lies_off_its_axis_keeps_momentum_and_energy() {
    let mesh = mesh::block([2, 2, 2], [4e-3, 4e-3, 4e-3]);
    let all: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    let run = |spin, vertical| {
        let mut setup = free_body(&mesh, 0.67, Vec::new(), QuietEnd::default());
        let (reference, mass) = (setup.system.solid.reference(), &setup.system.mass);
        let mut hub =
            Hub::new([0.5e-3, 0.0, 1e-3].into(), &all, reference, mass, 0.0, spin, vertical);
        (hub.state.vx, hub.state.omega) = (3.0, 1e4);
        let total: f64 = mass.iter().sum();
        setup.system.hub = Some(hub);
        setup.system.upper = 0..mesh.nodes.len();
        let mass = setup.system.mass.clone();
        let mut simulation = Simulation::new(setup);
        let momentum = |simulation: &Simulation| -> f64 {
            let v = &simulation.nodes.velocity;
            mass.iter().zip(v).map(|(m, v)| m * v.0[2]).sum()
        };
        simulation.step(true);
        let before = momentum(&simulation);
        for _ in 0..2000 {
            simulation.step(true);
        }
        let turned = simulation.system.hub.as_ref().unwrap().state.angle;
        assert!(turned > 1.0, "{turned}");
        let scale = total * 1e4 * 1.5e-3;
        let gained = (momentum(&simulation) - before).abs() / scale;
        (gained, simulation.ledger().balance_error())
    };
    let free = Spin::Torque { torque: 0.0, ramp: 0.0 };
    let steady = Spin::Creepage { free: 1e4, creepage: 0.0, ramp: 0.0 };
    for spin in [free, steady] {
        let (gained, error) = run(spin.clone(), Vertical::Load(0.0));
        assert!(gained < 3e-4 && error < 1e-5, "{gained:e} {error:e}");
        let (gained, error) = run(spin, Vertical::Held);
        assert!(gained > 0.1 && error < 1e-5, "{gained:e} {error:e}");
    }
}

#[test]
fn a_counterweight_leaves_nothing_that_turns_unevenly() {
    let mesh = mesh::block([2, 2, 2], [4e-3, 4e-3, 4e-3]);
    let all: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    let setup = free_body(&mesh, 0.67, Vec::new(), QuietEnd::default());
    let (reference, mass) = (setup.system.solid.reference(), &setup.system.mass);
    let (spin, vertical) = (Spin::Torque { torque: 0.0, ramp: 0.0 }, Vertical::Load(0.0));
    let hub = Hub::new([0.5e-3, 0.0, 1e-3].into(), &all, reference, mass, 0.0, spin, vertical);
    let alone = hub.moment;
    let hub = hub.balanced(0..mesh.nodes.len(), reference, mass);
    assert_eq!(hub.counterweight, alone.map(|moment| -moment));
    assert_eq!(hub.moment, [0.0; 2]);
}

#[test]
fn moves_of_the_mesh_that_bring_as_much_energy_as_is_exchanged_stop_the_run() {
    let kicked = |by: f64| {
        let mut simulation = carried();
        let read = simulation.step(true).energies.unwrap();
        simulation.ledger.expect(read.total() - read.external_work);
        simulation.nodes.velocity.iter_mut().for_each(|v| v[1] += by);
        let report = simulation.step(true);
        simulation.check(&report).map(|found| found.cause)
    };
    let found = kicked(1.0);
    assert!(matches!(found, Some(Cause::MeshMoves { energy }) if energy > 0.0), "{found:?}");
    assert_eq!(kicked(0.0), None);
}

#[test]
fn the_end_of_the_track_stops_a_hub_that_passes_it() {
    let mut simulation = carried();
    simulation.set_limits(GuardLimits { track: [0.0, 2.1e-3], ..GuardLimits::default() });
    let found = (0..1000).find_map(|n| {
        let report = simulation.step(n % 10 == 0);
        simulation.check(&report)
    });
    let found = found.unwrap();
    assert!(matches!(found.cause, Cause::EndOfTrack { end: 2.1e-3, .. }), "{found}");
    // ten steps are read at a time
    let passed = 0.1e-3 / 10.0;
    assert!((found.time - passed).abs() <= 11.0 * simulation.dt(), "{} {passed}", found.time);
    assert!(
        found.to_string().contains("the upper body has reached the end of the lower body"),
        "{found}"
    );
}

#[test]
fn a_node_pushed_through_its_element_makes_the_state_unsound_and_so_does_one_that_is_no_number() {
    let mut simulation = carried();
    assert!(simulation.is_sound());
    let node = 62;
    simulation.nodes.displacement[node].0[2] -= 2.2e-3;
    assert!(!simulation.is_sound());
    let (element, ratio) = simulation.solid().most_folded(simulation.displacement());
    assert!(ratio < 0.0 && simulation.solid().nodes_of(element).contains(&(node as u32)));
    simulation.nodes.displacement[node].0[2] = f64::NAN;
    assert!(!simulation.is_sound());
}

#[test]
fn shapes_are_looked_at_early_and_then_every_500_steps() {
    let looks: Vec<_> = (0..1600).filter(|&n| guard::looks_at_shape(n)).collect();
    assert_eq!(looks, [0, 10, 20, 40, 80, 160, 320, 500, 1000, 1500]);
}
