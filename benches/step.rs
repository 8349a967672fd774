//! A whole step of the reference case: internal force, contact, boundaries, nodes and hub. Items
//! are elements.
#![allow(missing_docs)]

use contact::{BodyMaterial, Normals, PenaltyContact, PenaltySettings, Stiffness};
use divan::counter::ItemsCount;
use dynamics::{Hub, QuietEnd, RollingField, Setup, Simulation, Spin, System, Vertical};
use friction::Coulomb;
use mesh::{Bar, Disk, FineZone, Grading, Mesh, Padded};
use solid::{Element, Level, Material, Solid, Viscosity};
use std::time::Duration;

fn main() {
    divan::main();
}

const RADIUS: f64 = 0.46;
const SPEED: f64 = 38.89;
/// Hertz's approach of the bodies under 100 kN: pressed so far as rigid bodies, contact is as busy
/// as after a preload. The hub stays at that height.
const APPROACH: f64 = 104.1e-6;
const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7800.0 };
const ELEMENT: Element = Element { hourglass: 0.05 };

fn reference(size: f64) -> Mesh {
    let zone = FineZone {
        size,
        length: 80e-3,
        width: 20e-3,
        depth: 8e-3,
        start: -10e-3,
        growth: 1.35,
        coarsest: 50e-3,
        grading: Grading::Tensor,
    };
    let disk = Disk { radius: RADIUS, hub_radius: 0.1, width: 60e-3, crown: None };
    let bar = Bar { length: 0.24, width: 60e-3, height: 70e-3, crown: Some(0.3), start: -0.09 };
    mesh::join(&[
        mesh::disk(&disk, &zone).expect("the reference disk"),
        mesh::bar(&bar, &zone).expect("the reference bar"),
    ])
}

fn rolling(size: f64) -> Simulation {
    let mesh = reference(size);
    let [disk, bar] = [0, 1].map(|body| &mesh.bodies[body]);
    let solid = Solid::new(&mesh, &[STEEL; 2], ELEMENT, Viscosity::default(), Level::detect())
        .expect("two bodies of steel");
    let settings = PenaltySettings {
        normal: Stiffness::Factor(0.1),
        tangential: Stiffness::Factor(0.1),
        damping: 0.1,
        curvature: true,
        normals: Normals::Averaged,
    };
    let steel = BodyMaterial { bulk_modulus: STEEL.bulk(), density: STEEL.density };
    let surfaces = [(&disk.surfaces["tread"], steel), (&bar.surfaces["top"], steel)];
    let law = Box::new(Coulomb { mu: 0.5 });
    let contact = PenaltyContact::new(&mesh, surfaces, &settings, None, law).expect("two surfaces");
    let mass = solid::lumped_mass(&mesh, &[STEEL.density; 2]);
    let (omega_max, _) = solid::element_frequency_bound(&mesh, &[STEEL; 2], ELEMENT);
    let dt = 0.67 * 2.0 / omega_max;
    let (centre, omega) = ([0.0, 0.0, RADIUS].into(), SPEED / RADIUS);
    let spin = Spin::Creepage { free: omega, creepage: 2.4e-3, ramp: 0.74e-3 };
    let hub_nodes = &disk.node_sets["hub"];
    let mut hub = Hub::new(centre, hub_nodes, solid.reference(), &mass, 0.0, spin, Vertical::Held);
    hub.state.z = -APPROACH;
    hub.state.vx = SPEED;
    hub.state.omega = omega;
    let held = bar.node_sets["bottom"].clone();
    let ends = [&bar.surfaces["rear"], &bar.surfaces["front"]];
    let quiet = QuietEnd::new(&mesh, &ends, &STEEL, &held);
    let mut displacement = vec![Padded::ZERO; mesh.nodes.len()];
    displacement[disk.nodes.clone()].fill(Padded::new([0.0, 0.0, -APPROACH]));
    let field = RollingField { upper: 0, centre, speed: SPEED, omega, dt };
    let velocity = dynamics::rolling_field(&mesh, &displacement, &field);
    Simulation::new(Setup {
        system: System {
            contact: Some(contact.into()),
            hub: Some(hub),
            quiet,
            held,
            upper: disk.nodes.clone(),
            ..System::free(solid, mass)
        },
        displacement,
        velocity,
        dt,
        dt_limit: 2.0 / omega_max,
    })
}

/// Steps per sample: the energies are read in the first, as by default for the history, and
/// entering the pool costs nothing against so many.
const BATCH: usize = 10;

/// The reference case at a size in mm on a number of threads.
#[divan::bench(args = [(2.0, 1), (2.0, 2), (1.0, 1), (1.0, 2)], sample_count = 20, sample_size = 1)]
fn ten_steps(bencher: divan::Bencher, (millimetres, threads): (f64, usize)) {
    let mut simulation = rolling(millimetres * 1e-3);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let mut closed = 0;
    let mut advance = |simulation: &mut Simulation| {
        pool.install(|| {
            for n in 0..BATCH {
                closed = simulation.step(n == 0).contact.closed;
            }
        });
    };
    (0..2).for_each(|_| advance(&mut simulation));
    let (then, first) = (*simulation.timers(), simulation.steps());
    let elements = simulation.solid().elements();
    bencher.counter(ItemsCount::new(BATCH * elements)).bench_local(|| advance(&mut simulation));
    let now = simulation.timers();
    let element_steps = (simulation.steps() - first).max(1) as f64 * elements as f64;
    let part = |now: Duration, then: Duration| (now - then).as_secs_f64() / element_steps * 1e9;
    println!(
        "  {elements} elements, {closed} pairs closed; ns per element and step: internal force \
         {:.1}, contact {:.1}, boundary {:.1}, nodes {:.1}",
        part(now.internal_force, then.internal_force),
        part(now.contact, then.contact),
        part(now.boundary, then.boundary),
        part(now.nodes, then.nodes),
    );
}
