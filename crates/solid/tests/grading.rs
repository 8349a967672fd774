//! The stable step of meshes that become coarser 2:1 in all directions.
#![allow(clippy::unwrap_used, missing_docs)]

use mesh::{Bar, Disk, FineZone, Grading, Mesh, bar, block, disk};
use solid::{
    Element, Level, Material, Solid, Viscosity, element_frequency_bound, largest_frequency,
    lumped_mass,
};

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7800.0 };
const ONE_POINT: Element = Element { hourglass: 0.05 };
const DISK: Disk = Disk { radius: 0.46, hub_radius: 0.10, width: 0.06, crown: None };
const BAR: Bar = Bar { length: 0.24, width: 0.06, height: 0.07, crown: Some(0.30), start: -0.09 };

fn zone(size: f64, depth: f64) -> FineZone {
    FineZone {
        size,
        length: 0.08,
        width: 0.02,
        depth,
        start: -0.010,
        growth: 1.35,
        coarsest: 0.05,
        grading: Grading::TwoToOne,
    }
}

fn largest(mesh: &Mesh) -> f64 {
    let inverse: Vec<f64> = lumped_mass(mesh, &[STEEL.density]).iter().map(|m| 1.0 / m).collect();
    let mut solid =
        Solid::new(mesh, &[STEEL], ONE_POINT, Viscosity::default(), Level::detect()).unwrap();
    largest_frequency(&inverse, |x, y| solid.add_stiffness_product(x, y), 60)
}

#[test]
fn no_element_of_the_shells_and_neither_body_is_faster_than_the_zone_by_a_twentieth() {
    for (size, depth, least) in [
        (2e-3, 8e-3, 0.95),
        (1.3e-3, 8e-3, 0.95),
        (1e-3, 4e-3, 0.95),
        (1e-3, 8e-3, 0.95),
        // the zone itself is narrower by 3.5 % at the bottom
        (1e-3, 16e-3, 0.94),
    ] {
        let (cube, _) = element_frequency_bound(&block([1; 3], [size; 3]), &[STEEL], ONE_POINT);
        let cubes = largest(&block([16; 3], [16.0 * size; 3]));
        let zone = zone(size, depth);
        for mesh in [disk(&DISK, &zone).unwrap(), bar(&BAR, &zone).unwrap()] {
            let (bound, element) = element_frequency_bound(&mesh, &[STEEL], ONE_POINT);
            let (of_element, of_body) = (cube / bound, cubes / largest(&mesh));
            let name = &mesh.bodies[0].name;
            assert!(
                of_element >= least,
                "{name} {size} {depth}: {of_element} of element {element}"
            );
            assert!(of_body >= 0.99, "{name} {size} {depth}: {of_body}");
        }
    }
}
