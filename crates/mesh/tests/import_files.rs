//! Mesh files: the formats give the same mesh, and what is wrong is told with its line.
#![allow(clippy::unwrap_used)]

use mesh::import::{
    Fault, Foreign, Format, ImportError, Place, Set, SetNames, Shape, Unit, bodies, fit,
};
use mesh::import::{read_abaqus, read_gmsh, read_vtu, write_gmsh};
use mesh::{Bar, Disk, FineZone, Grading, Mesh};
use std::fs;
use std::path::Path;

/// The shapes of `meshes/disk_on_bar.py --small`.
const SHAPE: Shape = Shape {
    disk: Disk { radius: 0.1, hub_radius: 0.05, width: 0.02, crown: None },
    bar: Bar { length: 0.1, width: 0.02, height: 0.02, crown: Some(0.30), start: -0.05 },
    zone: FineZone {
        size: 2e-3,
        length: 0.024,
        width: 0.008,
        depth: 0.004,
        start: -0.012,
        growth: 1.5,
        coarsest: 0.02,
        grading: Grading::Tensor,
    },
    exact: true,
    ends: true,
};

fn bytes(name: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes").join(name)).unwrap()
}

fn foreign(name: &str) -> Foreign {
    Format::of(Path::new(name)).unwrap().read(&bytes(name)).unwrap()
}

fn import(foreign: &Foreign) -> Result<Mesh, ImportError> {
    let imported = bodies(foreign, &SetNames::default(), Unit::Metre)?;
    Ok(fit(imported, &SHAPE)?.mesh)
}

fn same_bits(a: &Mesh, b: &Mesh) {
    let bits = |m: &Mesh| m.nodes.iter().map(|p| p.map(f64::to_bits)).collect::<Vec<_>>();
    assert!(bits(a) == bits(b), "nodes differ");
    assert!(a.hexes == b.hexes, "hexahedra differ");
    for (a, b) in a.bodies.iter().zip(&b.bodies) {
        assert_eq!((&a.nodes, &a.hexes), (&b.nodes, &b.hexes));
        assert!(a.node_sets == b.node_sets, "node sets of the {} differ", a.name);
        let keys = |b: &mesh::Body| b.surfaces.keys().cloned().collect::<Vec<_>>();
        assert_eq!(keys(a), keys(b));
        for (name, surface) in &a.surfaces {
            assert!(surface.faces == b.surfaces[name].faces, "surface {name} differs");
        }
    }
}

#[test]
fn one_mesh_from_msh_4_1_msh_2_2_inp_and_vtu_has_the_same_bits() {
    let first = import(&foreign("small.msh")).unwrap();
    mesh::check(&first).unwrap();
    assert!(first.hexes.len() > 1000);
    for other in ["small-2.2.msh", "small.inp", "small.vtu"] {
        same_bits(&first, &import(&foreign(other)).unwrap());
    }
}

#[test]
fn the_reference_mesh_holds_what_its_case_says() {
    let foreign = foreign("disk-on-bar-2mm.vtu");
    let imported = bodies(&foreign, &SetNames::default(), Unit::Metre).unwrap();
    let shape = Shape {
        disk: Disk { radius: 0.46, hub_radius: 0.10, width: 0.06, crown: None },
        bar: Bar { length: 0.24, width: 0.06, height: 0.07, crown: Some(0.30), start: -0.09 },
        zone: FineZone { length: 0.08, width: 0.02, depth: 0.008, start: -0.010, ..SHAPE.zone },
        ..SHAPE
    };
    let mesh = fit(imported, &shape).unwrap().mesh;
    let faces = |body: usize| mesh.bodies[body].surfaces["zone"].faces.len();
    assert_eq!([faces(0), faces(1)], [40 * 10, 45 * 12]);
    assert!(mesh::quality(&mesh).min_scaled_jacobian > 0.2, "{:?}", mesh::quality(&mesh));
}

/// A text with line `number`, counted from 1, replaced.
fn with_line(text: &[u8], number: usize, line: &str) -> Vec<u8> {
    let mut lines: Vec<&str> = str::from_utf8(text).unwrap().lines().collect();
    lines[number - 1] = line;
    lines.join("\n").into_bytes()
}

fn line_of(text: &[u8], words: &str) -> usize {
    let text = str::from_utf8(text).unwrap();
    1 + text.lines().position(|l| l.starts_with(words)).unwrap()
}

const CUBE_2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"the disk\"\n\
    $EndPhysicalNames\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n\
    9 0 1 1\n$EndNodes\n$Elements\n2\n1 1 2 5 7 1 2\n7 5 2 1 1 1 2 3 4 5 6 7 9\n$EndElements\n";

#[test]
fn a_cube_of_msh_2_2_is_read_with_its_numbers_lines_and_groups() {
    let cube = read_gmsh(CUBE_2.as_bytes()).unwrap();
    assert_eq!((cube.points.len(), cube.hexes), (8, vec![[0, 1, 2, 3, 4, 5, 6, 7]]));
    assert_eq!(cube.points[6], [1.0, 1.0, 1.0]);
    assert_eq!((cube.nodes.ids[7], cube.nodes.lines[7]), (9, 17));
    assert_eq!((cube.elements.ids[0], cube.elements.lines[0]), (7, 22));
    assert_eq!(cube.sets["the disk"].hexes, [0]);
    assert_eq!(cube.sets["5"].nodes, [0, 1], "a group without a name goes by its number");
    // names in columns
    let aligned = CUBE_2.replace("3 1 \"the disk\"", "  3   1   \"the disk\"");
    assert_eq!(read_gmsh(aligned.as_bytes()).unwrap().sets["the disk"].hexes, [0]);
}

#[test]
fn cells_other_than_hexahedra_are_refused_by_number_and_line_in_every_format() {
    for (kind, nodes, name) in
        [(4, "1 2 3 5", "tetrahedron"), (6, "1 2 3 5 6 7", "prism"), (17, "1 2", "20 nodes")]
    {
        let text = with_line(CUBE_2.as_bytes(), 22, &format!("7 {kind} 2 1 1 {nodes}"));
        let error = read_gmsh(&text).unwrap_err();
        assert_eq!(error.place, Some(Place::Line(22)));
        assert!(error.to_string().contains("element 7") && error.to_string().contains(name));
        assert!(matches!(error.fault, Fault::Cell { .. }));
    }
    let inp = "*NODE\n1,0,0,0\n2,1,0,0\n*ELEMENT, TYPE=C3D4, ELSET=disk\n31,1,2,1,2\n";
    let error = read_abaqus(inp.as_bytes()).unwrap_err();
    assert_eq!(error.place, Some(Place::Line(5)));
    assert!(error.to_string().contains("element 31") && error.to_string().contains("C3D4"));
    for kind in ["C3D20", "C3D20R", "C3D6", "SC8R"] {
        let text = inp.replace("C3D4", kind);
        assert!(matches!(read_abaqus(text.as_bytes()).unwrap_err().fault, Fault::Cell { .. }));
    }
    let error = read_vtu(vtu("1 2 3 0", "4", "10").as_bytes()).unwrap_err();
    assert!(error.to_string().contains("element 0 is a tetrahedron"), "{error}");
}

/// A VTU of the points of a cube and one cell.
fn vtu(connectivity: &str, offsets: &str, types: &str) -> String {
    let array = |name: &str, kind: &str, text: &str| {
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">{text}</DataArray>")
    };
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">\n<UnstructuredGrid>\n<Piece>\n\
         <Points>{}</Points>\n<Cells>{}{}{}</Cells>\n<PointData>{}{}</PointData>\n</Piece>\n\
         </UnstructuredGrid>\n</VTKFile>\n",
        array("Points", "Float64", "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1"),
        array("connectivity", "Int64", connectivity),
        array("offsets", "Int64", offsets),
        array("types", "UInt8", types),
        array("hub", "Float32", "1 0 0 0 0 0 0 1"),
        array("temperature", "Float64", "1 0 0 0 0 0 0 1.5"),
    )
}

#[test]
fn a_cube_of_vtu_is_read_with_its_sets_and_values_are_no_sets() {
    let cube = read_vtu(vtu("0 1 2 3 4 5 6 7", "8", "12").as_bytes()).unwrap();
    assert_eq!(cube.hexes, [[0, 1, 2, 3, 4, 5, 6, 7]]);
    assert_eq!(cube.sets["hub"].nodes, [0, 7]);
    assert_eq!(cube.sets.len(), 1);
}

#[test]
fn an_abaqus_file_may_wrap_lines_generate_sets_and_name_faces() {
    let cube = "*Heading\n a cube\n*Node, nset=ALL\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n\
        4, 0., 1., 0.\n5, 0., 0., 1.\n6, 1., 0., 1.\n7, 1., 1., 1.\n8, 0., 1., 1.\n** note\n\
        *Element, type=C3D8R, elset=Disk\n11, 1, 2, 3, 4,\n5, 6, 7, 8\n*Nset, nset=hub, generate\n\
        1, 7, 2\n*Nset, nset=both\nHUB, 8\n*Surface, name=tread\ndisk, S2\n*Material, name=steel\n\
        *Elastic\n210e9, 0.3\n";
    let found = read_abaqus(cube.as_bytes()).unwrap();
    assert_eq!(found.hexes, [[0, 1, 2, 3, 4, 5, 6, 7]]);
    assert_eq!((found.elements.ids[0], found.elements.lines[0]), (11, 14));
    assert_eq!(found.sets["hub"].nodes, [0, 2, 4, 6]);
    assert_eq!(found.sets["both"].nodes, [0, 2, 4, 6, 7]);
    assert_eq!(found.sets["Disk"].hexes, [0]);
    assert_eq!(found.sets["tread"].faces, [[4, 5, 6, 7]]);
    assert!(found.notes[0].contains("*ELASTIC, *MATERIAL"), "{:?}", found.notes);
}

#[test]
fn the_faces_of_abaqus_are_those_of_its_manual() {
    // Abaqus Elements Guide, three-dimensional solid elements: nodes of the faces of C3D8.
    let faces =
        [[1, 2, 3, 4], [5, 8, 7, 6], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 8, 4], [4, 8, 5, 1]];
    let nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n";
    for (i, expected) in faces.iter().enumerate() {
        let text = format!(
            "{nodes}*ELEMENT,TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n*SURFACE,NAME=S\n1,S{}\n",
            i + 1
        );
        let mut found = read_abaqus(text.as_bytes()).unwrap().sets["S"].faces[0].map(|n| n + 1);
        let mut expected = *expected;
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected, "S{}", i + 1);
    }
}

#[test]
fn what_is_not_read_is_refused_by_line_with_what_to_do() {
    for (text, line, word) in [
        ("*HEADING\n*INCLUDE, INPUT=a.inp\n", 2, "*INCLUDE"),
        ("*PART, NAME=disk\n", 1, "*PART"),
        ("*NODE, INPUT=nodes.txt\n", 1, "INPUT="),
        ("*NODE, SYSTEM=C\n1,0,0,0\n", 1, "SYSTEM="),
        ("*NODE\n1,0,0,0\n*NGEN\n1,5\n", 3, "*NGEN"),
    ] {
        let error = read_abaqus(text.as_bytes()).unwrap_err();
        assert_eq!(error.place, Some(Place::Line(line)), "{text}");
        assert!(matches!(error.fault, Fault::Unsupported { remedy, .. } if !remedy.is_empty()));
        assert!(error.to_string().contains(word), "{error}");
    }
    for (format, place, word) in [
        ("4 0 8", Place::Line(2), "MSH format 4"),
        ("4.1 1 4", Place::Byte(12), "numbers of 4 bytes"),
        ("3 1 8", Place::Byte(12), "MSH format 3"),
    ] {
        let text = format!("$MeshFormat\n{format}\n$EndMeshFormat\n");
        let error = read_gmsh(text.as_bytes()).unwrap_err();
        assert_eq!(error.place, Some(place), "{error}");
        assert!(error.to_string().contains(word), "{error}");
    }
    for (text, word) in [
        ("<VTKFile type=\"PolyData\"><PolyData/></VTKFile>", "PolyData"),
        (
            "<VTKFile compressor=\"vtkLZ4DataCompressor\"><UnstructuredGrid/></VTKFile>",
            "vtkLZ4DataCompressor",
        ),
    ] {
        assert!(read_vtu(text.as_bytes()).unwrap_err().to_string().contains(word));
    }
}

#[test]
fn elements_nested_without_end_are_refused_by_line() {
    let text = format!("<?xml version=\"1.0\"?>\n{}", "<a>".repeat(100_000));
    for text in [text.clone(), text.clone() + &"</a>".repeat(100_000), text + "<AppendedData>_"] {
        let error = read_vtu(text.as_bytes()).unwrap_err();
        assert_eq!(error.place, Some(Place::Line(2)), "{error}");
        assert!(error.to_string().contains("32 deep"), "{error}");
    }
}

#[test]
fn malformed_texts_are_refused_by_line() {
    let cube = CUBE_2.as_bytes();
    let nowhere = line_of(cube, "$EndNodes");
    for (line, text) in [
        (2, "2.2 zero 8"),
        (9, "-1"),
        (10, "1 0 zero 0"),
        (11, "1 1 0 0"),
        (22, "7 5 2 1 1 1 2 3 4 5 6 7 8"),
        (nowhere, "$EndElements"),
    ] {
        let error = read_gmsh(&with_line(cube, line, text)).unwrap_err();
        assert_eq!(error.place, Some(Place::Line(line)), "{text}: {error}");
    }
    for text in [
        "*NODE\n1,0,zero,0\n",
        "*NODE\n1\n1\n",
        "*NODE\n*ELEMENT,TYPE=C3D8\n1,1,2,3\n",
        "1,2,3\n",
        "*NODE\n1\n*ELEMENT,TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n",
        "*NSET\n1\n",
        "*NODE\n1\n*ELEMENT,TYPE=C3D8\n1,1,2,3,4,5,6,7,8,9,10\n",
    ] {
        assert!(read_abaqus(text.as_bytes()).is_err(), "{text}");
    }
    for (connectivity, offsets, types) in [
        ("0 1 2 3 4 5 6 8", "8", "12"),
        ("0 1 2 3 4 5 6 -1", "8", "12"),
        ("0 1 2 3 4 5 6 7", "9", "12"),
        ("0 1 2 3 4 5 6 7", "-1", "12"),
        ("0 1 2 3 4 5 6 7", "8", ""),
        ("0 1 2 3 4 5 6 x", "8", "12"),
    ] {
        assert!(read_vtu(vtu(connectivity, offsets, types).as_bytes()).is_err());
    }
}

#[test]
fn a_file_cut_off_anywhere_is_refused_and_never_panics() {
    for name in ["small.msh", "small-2.2.msh", "small.inp", "small.vtu"] {
        let (all, format) = (bytes(name), Format::of(Path::new(name)).unwrap());
        for part in 1..60 {
            let cut = &all[..all.len() * part / 60];
            let whole = format.read(cut).and_then(|f| import(&f));
            assert!(whole.is_err(), "{name} cut at {} of {}", cut.len(), all.len());
        }
    }
}

#[test]
fn counts_in_a_header_are_not_believed() {
    let text = CUBE_2.replace("$Nodes\n8\n", "$Nodes\n9999999999999\n");
    assert!(read_gmsh(text.as_bytes()).is_err());
    // an array of a raw section that says it is longer than the file
    let mut raw = b"<VTKFile header_type=\"UInt64\"><UnstructuredGrid><Piece><Points><DataArray type=\"Float64\" \
        format=\"appended\" offset=\"0\"/></Points><Cells/></Piece></UnstructuredGrid>\
        <AppendedData encoding=\"raw\">_"
        .to_vec();
    raw.extend(u64::MAX.to_le_bytes());
    assert!(read_vtu(&raw).is_err());
}

#[test]
fn a_mesh_that_creepage_writes_raw_and_appended_is_read() {
    // a header of 8 bytes, three points, then nothing else
    let head = "<VTKFile header_type=\"UInt64\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece>\
        <Points><DataArray type=\"Float32\" format=\"appended\" offset=\"0\"/></Points><Cells>\
        <DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\"></DataArray>\
        <DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\"></DataArray>\
        <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\"></DataArray>\
        </Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_";
    for head in [head.to_owned(), head.replace("\"raw\"", "'raw'")] {
        let mut raw = head.into_bytes();
        raw.extend(12u64.to_le_bytes());
        [0.5f32, -1.0, 0.25].iter().for_each(|x| raw.extend(x.to_le_bytes()));
        raw.extend(b"</AppendedData></VTKFile>");
        assert_eq!(read_vtu(&raw).unwrap().points, [[0.5, -1.0, 0.25]]);
    }
}

#[test]
fn a_mesh_written_for_gmsh_reads_back_with_the_same_bits_and_sets() {
    let first = foreign("small.msh");
    let again = read_gmsh(write_gmsh(&first).as_bytes()).unwrap();
    // a file has elements in the order of their sets, so that sets are compared by their sizes
    let sizes = |mesh: &Foreign| -> Vec<_> {
        let size = |set: &Set| (set.hexes.len(), set.faces.len());
        mesh.sets.iter().map(|(name, set)| (name.clone(), size(set))).collect()
    };
    assert_eq!(sizes(&first), sizes(&again));
    same_bits(&import(&first).unwrap(), &import(&again).unwrap());
}
