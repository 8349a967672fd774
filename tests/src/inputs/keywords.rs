//! LS-DYNA keyword files.

use std::hint::black_box;

use creepage::case::Case;
use creepage::ls_dyna::{Source, Units, translate};
use creepage::scenario::Remedy;
use mesh::import::{SetNames, Unit, bodies, read_abaqus};

use crate::inputs::text::{in_a_folder, told, write};

/// A keyword file, which may include itself alone, up to the case and the mesh made of it, both read again.
pub fn keywords(data: &[u8]) {
    let Some(units) = Units::parse("mm-ton-s") else { return };
    in_a_folder(|folder| {
        let file = folder.join("model.k");
        write(&file, data);
        let source = Source { file: &file, include_outside: false };
        match translate(&source, units, "mesh.inp") {
            Ok(made) => {
                write(&folder.join("mesh.inp"), made.mesh.as_bytes());
                if let Err(error) = Case::from_text(&made.case, &folder.join("case.toml"), &[]) {
                    told(&error);
                }
                let read = read_abaqus(made.mesh.as_bytes());
                let found = read.and_then(|mesh| bodies(&mesh, &SetNames::default(), Unit::Metre));
                if let Err(error) = found {
                    black_box((error.to_string(), error.fault.remedy()));
                }
            }
            Err(error) => drop(black_box((error.to_string(), error.fault.remedy()))),
        }
    });
}
