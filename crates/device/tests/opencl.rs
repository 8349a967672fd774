//! On a device of OpenCL, such as pocl's: the bits of the processor.
#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used)]

use device::opencl::Bodies;
use mesh::Padded;
use solid::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric};

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7800.0 };
const ALUMINIUM: Material = Material { young: 70e9, poisson: 0.33, density: 2700.0 };

fn bits(field: &[Padded]) -> Vec<[u64; 3]> {
    field.iter().map(|v| v.xyz().map(f64::to_bits)).collect()
}

fn has_the_bits_of_the_processor(elements: impl Fn(&[bool]) -> Elements<'_>, viscosity: Viscosity) {
    let block = |n| mesh::block(n, n.map(|n| 1e-3 * n as f64));
    let mesh = mesh::join(&[block([13, 11, 9]), block([8, 7, 5])]);
    let some: Vec<bool> = (0..mesh.hexes.len()).map(|e| e % 7 == 3 || e > 900).collect();
    let materials = [STEEL, ALUMINIUM];
    let mut solid =
        Solid::new(&mesh, &materials, elements(&some), viscosity, Level::pinned()).unwrap();
    let nodes = solid.reference().len();
    let mass = solid::lumped_mass(&mesh, &materials.map(|material| material.density));
    let inverse_mass: Vec<f64> =
        mass.iter().enumerate().map(|(n, m)| if n % 50 == 0 { 0.0 } else { 1.0 / m }).collect();
    let field = |scale: f64| -> Vec<Padded> {
        let value = |i: usize| {
            let k = i as f64;
            Padded::new([1.7 * k, 2.3 * k + 1.0, 0.9 * k].map(|x| scale * libm::sin(x)))
        };
        (0..nodes).map(value).collect()
    };
    let (mut u, mut v) = (field(1e-6), field(2.0));
    let before = v.clone();
    let mut bodies = Bodies::new(&solid, &inverse_mass).unwrap();
    bodies.set(&u, &v).unwrap();
    let dt = 5e-8;
    for _ in 0..20 {
        let mut force = vec![Padded::ZERO; nodes];
        solid.subtract_internal_force(&u, &v, &mut force, false);
        bodies.subtract_internal_force().unwrap();
        assert_eq!(bits(&bodies.get().unwrap()[2]), bits(&force));
        for n in 0..nodes {
            for i in 0..3 {
                v[n].0[i] += dt * inverse_mass[n] * force[n].0[i];
                u[n].0[i] += dt * v[n].0[i];
            }
        }
        bodies.advance(dt).unwrap();
        let [displacement, velocity, _] = bodies.get().unwrap();
        assert_eq!([bits(&displacement), bits(&velocity)], [bits(&u), bits(&v)]);
    }
    let moved = |(n, v): (usize, &Padded)| bits(&[*v]) != bits(&[before[n]]);
    assert_eq!(v.iter().enumerate().filter(|v| moved(*v)).count(), nodes - nodes.div_ceil(50));
}

#[test]
fn elements_and_nodes_have_the_bits_of_the_processor() {
    let one_point = Element { hourglass: 0.05 };
    has_the_bits_of_the_processor(|_| Elements::from(one_point), Viscosity::default());
    let viscosity = Viscosity { bulk_linear: 0.06, bulk_quadratic: 1.2, kelvin_voigt: 2e-8 };
    for volumetric in [Volumetric::Full, Volumetric::Mean] {
        has_the_bits_of_the_processor(
            |some| Elements::mixed(one_point, some, volumetric),
            viscosity,
        );
    }
}
