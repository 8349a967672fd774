//! One mesh in every form in which meshio and Gmsh write it (`meshes/formats.py`).
#![allow(clippy::unwrap_used)]

use mesh::Mesh;
use mesh::import::{Fault, Foreign, Format, ImportError, Place, Set, SetNames, Unit, bodies};
use nalgebra::Vector3;
use std::fs;
use std::path::Path;

/// The files that hold the six sets by their names.
const NAMED: [&str; 10] = [
    "cells.vtu",
    "points.vtu",
    "cells.inp",
    "points.inp",
    "text-4.1.msh",
    "text-2.2.msh",
    "binary-4.1.msh",
    "binary-2.2.msh",
    "gmsh-4.1.msh",
    "gmsh-2.2.msh",
];

/// The binary ones.
const BINARY: [&str; 5] =
    ["binary-4.1.msh", "binary-2.2.msh", "gmsh-4.1.msh", "gmsh-2.2.msh", "no-sets.msh"];

fn bytes(name: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/formats").join(name)).unwrap()
}

fn foreign(name: &str) -> Foreign {
    Format::of(Path::new(name)).unwrap().read(&bytes(name)).unwrap()
}

fn import(foreign: &Foreign, names: &SetNames) -> Result<Mesh, ImportError> {
    bodies(foreign, names, Unit::Metre).map(|imported| imported.mesh)
}

#[track_caller]
fn same(a: &Mesh, b: &Mesh, name: &str) {
    assert_eq!(a.nodes, b.nodes, "{name}");
    assert_eq!(a.hexes, b.hexes, "{name}");
    for (a, b) in a.bodies.iter().zip(&b.bodies) {
        assert_eq!(a.node_sets, b.node_sets, "{name}");
        for (of, surface) in &a.surfaces {
            assert!(surface.faces == b.surfaces[of].faces, "{name}: {of}");
        }
    }
}

#[test]
fn every_form_holds_the_same_nodes_elements_and_sets() {
    let first = import(&foreign(NAMED[0]), &SetNames::default()).unwrap();
    assert_eq!((first.nodes.len(), first.hexes.len()), (297, 128));
    for name in NAMED {
        let read = foreign(name);
        assert_eq!((read.points.len(), read.hexes.len()), (297, 128), "{name}");
        let hexes = |set: &str| read.sets[set].hexes.len();
        assert_eq!((hexes("disk"), hexes("bar")), (96, 32), "{name}");
        for (set, faces, nodes) in
            [("tread", 48, 72), ("hub", 48, 72), ("top", 16, 27), ("clamp", 16, 27)]
        {
            let Set { nodes: found, faces: of, .. } = &read.sets[set];
            let expected = if name.starts_with("points") { (0, nodes) } else { (faces, 0) };
            assert_eq!((of.len(), found.len()), expected, "{name}: {set}");
        }
        same(&import(&read, &SetNames::default()).unwrap(), &first, name);
    }
}

#[test]
fn the_groups_of_gmsh_in_a_vtu_go_by_their_numbers() {
    let [disk, bar, tread, hub, top, clamp] = ["1", "2", "3", "4", "5", "6"].map(str::to_owned);
    let names = SetNames { disk, bar, hub, tread, top, clamp };
    let first = import(&foreign(NAMED[0]), &SetNames::default()).unwrap();
    same(&import(&foreign("groups.vtu"), &names).unwrap(), &first, "groups.vtu");
}

#[test]
fn the_user_is_told_which_sets_were_taken_from_one_array() {
    let notes = foreign("points.vtu").notes;
    assert_eq!(notes.len(), 2, "{notes:?}");
    assert!(notes[0].contains("`hub`, `tread`, `top`, `clamp`"), "{notes:?}");
    assert!(notes[1].contains("`disk-bar`"), "{notes:?}");
}

#[test]
fn an_array_of_its_own_is_the_set_of_its_name() {
    // the array `disk-bar` of meshio says the same of the other cells
    let text = String::from_utf8(bytes("cells.vtu")).unwrap();
    let zeros = vec!["0"; 255].join(" ");
    let array = format!(
        "<CellData>\n<DataArray type=\"Int64\" Name=\"bar\" format=\"ascii\">{zeros} 1</DataArray>"
    );
    let text = text.replacen("<CellData>", &array, 1);
    let read = Format::Vtu.read(text.as_bytes()).unwrap();
    assert_eq!((read.sets["bar"].hexes.len(), read.sets["bar"].faces.len()), (0, 1));
    assert_eq!(read.sets["disk"].hexes.len(), 96);
}

#[test]
fn a_file_into_which_no_sets_were_written_is_told_so() {
    let error = import(&foreign("no-sets.msh"), &SetNames::default()).unwrap_err();
    assert!(matches!(error.fault, Fault::NoSets { .. }), "{error}");
}

#[test]
fn a_binary_file_cut_off_anywhere_is_refused_with_the_byte() {
    for name in BINARY {
        let all = bytes(name);
        let end = all.trim_ascii_end().len();
        for length in (60..end).step_by(7).chain(end - 200..end) {
            let error = Format::Gmsh.read(&all[..length]).map(|read| {
                // what is cut after the elements lacks nothing but the last line
                assert!(read.hexes.len() < 128, "{name} cut at {length}");
            });
            let Err(error) = error else { continue };
            let Some(Place::Byte(byte)) = error.place else { panic!("{name}: {error:?}") };
            assert!(byte <= length, "{name}: {error}");
        }
    }
}

#[test]
fn changed_bytes_of_a_binary_file_never_panic_or_take_memory_without_bound() {
    for name in BINARY {
        let all = bytes(name);
        let values = [0x00, 0x7f, 0x80, 0xff].into_iter().cycle();
        for (at, value) in (0..all.len()).step_by(37).zip(values) {
            let mut changed = all.clone();
            changed[at] = value;
            if let Ok(read) = Format::Gmsh.read(&changed) {
                let _ = import(&read, &SetNames::default());
            }
        }
    }
}

/// The bytes of a cube: its numbers in this order.
struct Bytes {
    big_endian: bool,
    made: Vec<u8>,
}

impl Bytes {
    fn text(&mut self, text: &str) {
        self.made.extend(text.as_bytes());
    }

    fn number<const N: usize>(&mut self, mut number: [u8; N]) {
        if self.big_endian {
            number.reverse();
        }
        self.made.extend(number);
    }

    fn ints(&mut self, numbers: &[i32]) {
        numbers.iter().for_each(|n| self.number(n.to_le_bytes()));
    }

    fn sizes(&mut self, numbers: &[u64]) {
        numbers.iter().for_each(|n| self.number(n.to_le_bytes()));
    }

    fn reals(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|n| self.number(n.to_le_bytes()));
    }
}

const CORNERS: [[f64; 3]; 8] = [
    [0., 0., 0.],
    [1., 0., 0.],
    [1., 1., 0.],
    [0., 1., 0.],
    [0., 0., 1.],
    [1., 0., 1.],
    [1., 1., 1.],
    [0., 1., 1.],
];

/// A cube of format 4.1 that says it has `nodes` nodes and `elements` elements.
fn cube_4(big_endian: bool, nodes: u64, elements: u64) -> Vec<u8> {
    let mut file = Bytes { big_endian, made: Vec::new() };
    file.text("$MeshFormat\n4.1 1 8\n");
    file.ints(&[1]);
    file.text("\n$EndMeshFormat\n$Comments\n");
    // lines of bytes that are no text, in a section that is not read
    file.made.extend([0xff, b'\n', 0xfe, b'$', 0x80]);
    file.text("$EndComments\n$PhysicalNames\n1\n3 4 \"the disk\"\n$EndPhysicalNames\n$Entities\n");
    file.sizes(&[0, 0, 0, 1]);
    file.ints(&[9]);
    file.reals(&[0.0; 6]);
    file.sizes(&[1]);
    file.ints(&[4]);
    file.sizes(&[2]);
    file.ints(&[7, -8]);
    file.text("\n$EndEntities\n$Nodes\n");
    file.sizes(&[1, 8, 1, 8]);
    file.ints(&[3, 9, 1]);
    file.sizes(&[nodes]);
    file.sizes(&[1, 2, 3, 4, 5, 6, 7, 8]);
    for corner in CORNERS {
        file.reals(&corner);
        // parametric coordinates
        file.reals(&corner);
    }
    file.text("\n$EndNodes\n$Elements\n");
    file.sizes(&[1, 1, 1, 1]);
    file.ints(&[3, 9, 5]);
    file.sizes(&[elements, 11, 1, 2, 3, 4, 5, 6, 7, 8]);
    file.text("\n$EndElements\n");
    file.made
}

/// A cube of format 2.2 that says it has `nodes` nodes and `elements` elements in its block.
fn cube_2(big_endian: bool, nodes: u64, elements: i32) -> Vec<u8> {
    let mut file = Bytes { big_endian, made: Vec::new() };
    file.text("$MeshFormat\n2.2 1 8\n");
    file.ints(&[1]);
    file.text("\n$EndMeshFormat\n$PhysicalNames\n1\n3 4 \"the disk\"\n$EndPhysicalNames\n");
    file.text(&format!("$Nodes\n{nodes}\n"));
    for (id, corner) in (1..).zip(CORNERS) {
        file.ints(&[id]);
        file.reals(&corner);
    }
    file.text("\n$EndNodes\n$Elements\n1\n");
    file.ints(&[5, elements, 2, 11, 4, 9, 1, 2, 3, 4, 5, 6, 7, 8]);
    file.text("\n$EndElements\n");
    file.made
}

#[test]
fn numbers_are_read_in_either_order_of_their_bytes() {
    for big_endian in [false, true] {
        for file in [cube_4(big_endian, 8, 1), cube_2(big_endian, 8, 1)] {
            let cube = Format::Gmsh.read(&file).unwrap();
            assert_eq!(cube.points, CORNERS.map(Vector3::from));
            assert_eq!(cube.hexes, [[0, 1, 2, 3, 4, 5, 6, 7]]);
            assert_eq!((&cube.elements.ids[..], &cube.elements.lines[..]), (&[11][..], &[][..]));
            assert_eq!(cube.sets["the disk"].hexes, [0]);
        }
    }
}

#[test]
fn the_name_of_a_group_in_a_binary_file_may_be_in_latin_1() {
    for mut file in [cube_4(false, 8, 1), cube_2(true, 8, 1)] {
        let at = file.windows(8).position(|bytes| bytes == b"the disk").unwrap();
        file[at..at + 8].copy_from_slice(b"R\xe4der 20");
        assert_eq!(Format::Gmsh.read(&file).unwrap().sets["R\u{e4}der 20"].hexes, [0]);
    }
}

#[test]
fn a_wrong_order_of_bytes_and_counts_that_lie_are_refused() {
    let mut wrong = cube_4(true, 8, 1);
    wrong[20..24].copy_from_slice(&1i32.to_le_bytes());
    let mut neither = cube_4(false, 8, 1);
    neither[21] = 1;
    for (file, words) in [
        (wrong, "72057594037927936 physical groups"),
        (neither, "the number 1 in four bytes"),
        (cube_4(false, u64::MAX, 1), "the file ends where"),
        (cube_4(false, 7, 1), "is expected"),
        (cube_4(false, 8, u64::MAX), "a node of an element"),
        (cube_4(false, 8, 0), "$EndElements is expected"),
        (cube_2(false, 1 << 60, 1), "the file ends where"),
        (cube_2(false, 7, 1), "is expected"),
        (cube_2(false, 8, i32::MAX), "the file ends where"),
        (cube_2(false, 8, -1), "the number of elements is expected, found `-1`"),
        (cube_2(false, 8, 0), "element 1 is"),
    ] {
        let error = Format::Gmsh.read(&file).unwrap_err();
        assert!(error.to_string().contains(words), "{words}: {error}");
        assert!(matches!(error.place, Some(Place::Byte(_))), "{error:?}");
    }
}

#[test]
fn an_element_of_another_shape_is_refused_by_its_number_and_byte() {
    let mut file = cube_2(false, 8, 1);
    let at = file.len() - "\n$EndElements\n".len() - 14 * 4;
    file[at..at + 4].copy_from_slice(&4i32.to_le_bytes());
    let error = Format::Gmsh.read(&file).unwrap_err();
    assert!(error.to_string().contains("element 11 is a tetrahedron"), "{error}");
    assert_eq!(error.place, Some(Place::Byte(at + 12)));
}
