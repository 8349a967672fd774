//! Mesh files of other programs.

use std::hint::black_box;

use creepage::scenario::Remedy;
use mesh::import::{Format, SetNames, Shape, Unit, bodies, fit, write_abaqus};
use mesh::{Bar, Disk, FineZone, Grading, quality};

/// A mesh file, from its bytes to the two bodies fitted to a case: the first byte chooses the format.
pub fn mesh(data: &[u8]) {
    let Some((&first, bytes)) = data.split_first() else { return };
    let format = [Format::Gmsh, Format::Abaqus, Format::Vtu][usize::from(first) % 3];
    let found = format.read(bytes).and_then(|foreign| {
        black_box(write_abaqus(&foreign));
        let shape = Shape {
            disk: Disk { radius: 2.0, hub_radius: 1.0, width: 1.0, crown: None },
            bar: Bar { length: 1.0, width: 1.0, height: 1.0, crown: None, start: -0.5 },
            zone: FineZone {
                size: 0.5,
                length: 1.0,
                width: 1.0,
                depth: 0.5,
                start: -0.5,
                growth: 1.5,
                coarsest: 1.0,
                grading: Grading::Tensor,
            },
            exact: first & 128 != 0,
            ends: first & 64 != 0,
        };
        fit(bodies(&foreign, &SetNames::default(), Unit::Metre)?, &shape)
    });
    match found {
        Ok(found) => drop(black_box(quality(&found.mesh))),
        Err(error) => drop(black_box((error.to_string(), error.fault.remedy()))),
    }
}
