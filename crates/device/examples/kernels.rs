//! Prints the kernels in CUDA C++ of steel with one-point and fully integrated elements.

#![allow(clippy::unwrap_used)]

use device::program;
use solid::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric};

fn main() {
    let mesh = mesh::block([4, 4, 4], [4e-3; 3]);
    let steel = Material { young: 210e9, poisson: 0.3, density: 7800.0 };
    let some: Vec<bool> = (0..mesh.hexes.len()).map(|element| element < 16).collect();
    let elements = Elements::mixed(Element { hourglass: 0.05 }, &some, Volumetric::Mean);
    let solid =
        Solid::new(&mesh, &[steel], elements, Viscosity::default(), Level::pinned()).unwrap();
    print!("{}", program::text(program::CUDA, &solid.on_device()));
}
