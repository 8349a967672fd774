//! How fast a device of OpenCL steps a block of steel, after one step that is compared with the processor's, bit by bit.
//!
//! `speed [elements along an edge ...]`; for each element and node the kernels of the elements move 288 bytes, the sum over the elements of a
//! node 292, central difference 200.

#![allow(clippy::unwrap_used)]

use device::opencl::Bodies;
use mesh::Padded;
use solid::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric};
use std::time::Instant;

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7800.0 };
const STEPS: u32 = 50;

/// Bytes that central difference moves for a node.
const ADVANCE: f64 = 200.0;

fn main() {
    let edges: Vec<usize> = std::env::args().skip(1).map(|n| n.parse().unwrap()).collect();
    for n in if edges.is_empty() { vec![50, 100, 126] } else { edges } {
        let one_point = || Elements::from(Element { hourglass: 0.05 });
        let viscous = Viscosity { bulk_linear: 0.06, bulk_quadratic: 1.2, kelvin_voigt: 2e-8 };
        step(n, "one-point", one_point(), Viscosity::default());
        step(n, "viscous one-point", one_point(), viscous);
        step(n, "fully integrated", Elements::from(Volumetric::Mean), Viscosity::default());
    }
}

fn step(n: usize, name: &str, elements: Elements<'_>, viscosity: Viscosity) {
    let mesh = mesh::block([n; 3], [1e-3 * n as f64; 3]);
    let mut solid = Solid::new(&mesh, &[STEEL], elements, viscosity, Level::pinned()).unwrap();
    let mass = solid::lumped_mass(&mesh, &[STEEL.density]);
    let inverse_mass: Vec<f64> = mass.iter().map(|m| 1.0 / m).collect();
    let field = |scale: f64| -> Vec<Padded> {
        let value = |x: &Padded| Padded::new(x.xyz().map(|x| scale * (x - 0.4 * x * x)));
        solid.reference().iter().map(value).collect()
    };
    let (u, v) = (field(1e-4), field(3.0));
    let mut bodies = Bodies::new(&solid, &inverse_mass).unwrap();
    bodies.set(&u, &v).unwrap();
    let dt = 1e-7;
    has_the_bits_of_the_processor(&mut bodies, &mut solid, [u, v], &inverse_mass, dt);
    let seconds = |bodies: &mut Bodies, kernels: &dyn Fn(&mut Bodies)| {
        kernels(bodies);
        bodies.finish().unwrap();
        let begun = Instant::now();
        (0..STEPS).for_each(|_| kernels(bodies));
        bodies.finish().unwrap();
        begun.elapsed().as_secs_f64() / f64::from(STEPS)
    };
    let step = seconds(&mut bodies, &|bodies| {
        bodies.subtract_internal_force().unwrap();
        bodies.advance(dt).unwrap();
    });
    let advance = seconds(&mut bodies, &|bodies| bodies.advance(dt).unwrap());
    let (count, nodes) = (mesh.hexes.len() as f64, mesh.nodes.len() as f64);
    let (device, is_graphics_processor) = bodies.device().unwrap();
    let kind = if is_graphics_processor { "" } else { ", no graphics processor" };
    println!(
        "{device}{kind}: {count:.0} {name} elements: {:.0} M element-steps/s, {:.3} ms a step; central difference {:.0} GB/s",
        1e-6 * count / step,
        1e3 * step,
        1e-9 * ADVANCE * nodes / advance,
    );
}

/// Compares one step with the processor's.
fn has_the_bits_of_the_processor(
    bodies: &mut Bodies,
    solid: &mut Solid,
    [mut u, mut v]: [Vec<Padded>; 2],
    inverse_mass: &[f64],
    dt: f64,
) {
    let mut force = vec![Padded::ZERO; u.len()];
    solid.subtract_internal_force(&u, &v, &mut force, false);
    bodies.subtract_internal_force().unwrap();
    let on_device = bodies.get().unwrap();
    let bits =
        |field: &[Padded]| -> Vec<_> { field.iter().map(|v| v.xyz().map(f64::to_bits)).collect() };
    assert!(bits(&on_device[2]) == bits(&force), "the forces differ from the processor's");
    for n in 0..u.len() {
        for i in 0..3 {
            v[n].0[i] += dt * inverse_mass[n] * force[n].0[i];
            u[n].0[i] += dt * v[n].0[i];
        }
    }
    bodies.advance(dt).unwrap();
    let on_device = bodies.get().unwrap();
    assert!(bits(&on_device[0]) == bits(&u), "the displacements differ from the processor's");
    assert!(bits(&on_device[1]) == bits(&v), "the velocities differ from the processor's");
}
