//! Mesh files: the formats give the same mesh, and what is wrong is told with its line.
#![allow(clippy::unwrap_used)]

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use mesh::import::{
    Fault, Foreign, Format, ImportError, Place, Set, SetNames, Shape, Unit, bodies, fit,
};
use mesh::import::{read_abaqus, read_gmsh, read_vtu, write_gmsh};
use mesh::{Bar, Disk, FineZone, Grading, Mesh};
use nalgebra::Vector3;
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
    assert_eq!(cube.points[6], Vector3::repeat(1.0));
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
        assert_eq!(read_vtu(&raw).unwrap().points, [Vector3::new(0.5, -1.0, 0.25)]);
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

/// A cube for Abaqus, and what comes after it.
fn inp(rest: &str) -> String {
    format!(
        "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n\
         *ELEMENT, TYPE=C3D8, ELSET=cube\n11,1,2,3,4,5,6,7,8\n{rest}"
    )
}

#[track_caller]
fn sets(rest: &str) -> Foreign {
    read_abaqus(inp(rest).as_bytes()).unwrap()
}

#[test]
fn a_keyword_line_that_ends_with_a_comma_goes_on_in_the_next() {
    for (lines, nodes) in [
        ("*NSET, NSET=s,\nGENERATE\n2, 8, 3\n", &[1, 4, 7][..]),
        ("*nset,\n** a comment\n\n nset = s , \n internal,\n unsorted\n3, 1\n", &[0, 2]),
        ("*NSET,\nNSET=s,\nELSET=cube\n*NSET, NSET=t\n1\n", &[0, 1, 2, 3, 4, 5, 6, 7]),
        ("*N SET, N SET=s,\nGENER ATE\n1, 2,\n", &[0, 1]),
        // no parameter begins with a digit
        ("*NSET, NSET=s,\n1, 2, 3\n", &[0, 1, 2]),
        ("*NSET, NSET=\"s\",\n*NSET, NSET=s\n5\n", &[4]),
    ] {
        assert_eq!(sets(lines).sets["s"].nodes, nodes, "{lines}");
    }
    let cube = inp("*ELSET,\nELSET=s\n11\n*SURFACE, TYPE=ELEMENT,\nNAME=f\ncube, S2\n");
    let cube =
        cube.replace("TYPE=C3D8, ELSET", "TYPE=C3D8,\nELSET").replace("*NODE", "*NODE,\nNSET=n");
    let cube = read_abaqus(cube.as_bytes()).unwrap();
    assert_eq!((&cube.sets["s"].hexes[..], &cube.sets["cube"].hexes[..]), (&[0][..], &[0][..]));
    assert_eq!(cube.sets["n"].nodes.len(), 8);
    assert_eq!(cube.sets["f"].faces, [[4, 5, 6, 7]]);
    let error = read_abaqus(inp("*NSET, NSET=s,\nhub, 3\n").as_bytes()).unwrap_err();
    assert_eq!((error.place, error.to_string().contains("HUB")), (Some(Place::Line(12)), true));
}

#[test]
fn names_in_quotes_are_found_in_data_lines_whatever_they_hold() {
    for name in ["my set", "a, b", "12", "Straße"] {
        let lines = format!(
            "*NSET, NSET=\"{name}\"\n1, 2\n*NSET, NSET=s\n\"{name}\", 8\n*ELSET, ELSET=\"{name}\"\n11\n\
             *SURFACE, NAME=f\n\"{name}\", S1\n*SURFACE, TYPE=NODE, NAME=g\n\"{name}\", 0.5\n"
        );
        let read = sets(&lines).sets;
        assert_eq!(read["s"].nodes, [0, 1, 7], "{name}");
        assert_eq!((&read[name].nodes[..], &read[name].hexes[..]), (&[0, 1][..], &[0][..]));
        assert_eq!((read["f"].faces.len(), &read["g"].nodes[..]), (1, &[0, 1][..]));
    }
    // without quotes neither blanks nor letter case tell names apart
    assert_eq!(sets("*NSET, NSET=My Set\n1\n*NSET, NSET=s\nMYSET, 2\n").sets["s"].nodes, [0, 1]);
    let two = inp("*NSET, NSET=\"Hub\"\n1\n*NSET, NSET=\"hub\"\n2\n");
    let error = read_abaqus(two.as_bytes()).unwrap_err();
    assert!(error.to_string().contains("`hub` beside a set `Hub`"), "{error}");
}

#[test]
fn what_a_keyword_says_is_used_or_harmless_or_refused_by_name() {
    sets("*ELSET, ELSET=s, INTERNAL, UNSORTED\n11\n*SURFACE, NAME=f, TRIM=NO, INTERNAL\n11, S1\n");
    for (lines, word) in [
        ("*NSET, NSET=s, GEN\n1, 2\n", "*NSET with GEN "),
        ("*NSET, NSET=s, GENERATE=NO\n1, 2\n", "GENERATE=NO"),
        ("*NSET, NSET=s, NSET=t\n1, 2\n", "NSET=t"),
        ("*NSET, NSET=s, INSTANCE=wheel-1\n1, 2\n", "INSTANCE=wheel-1"),
        ("*NSET, NSET=s, ELSET=cube, GENERATE\n", "GENERATE"),
        ("*NSET, NSET=s, ELSET=cube\n1\n", "a keyword that starts with *"),
        ("*NSET, NSET=\n1\n", "*NSET needs NSET="),
        ("*NSET, NSET=\"s\n1\n", "not closed"),
        ("*NSET NSET=s\n1\n", "a comma is expected"),
        ("*ELSET, ELSET=s, COMBINE=UNION\n11\n", "COMBINE=UNION"),
        ("*ELEMENT, TYPE=C3D8, OFFSET=100\n", "OFFSET=100"),
        ("*SURFACE, NAME=f, COMBINE=INTERSECTION\ncube, s\n", "COMBINE=INTERSECTION"),
        ("*SURFACE, NAME=f\ncube, S7\n", "found `S7`"),
        ("*ELEMENT, TYPE=CAX4, ELSET=q\n12, 1, 2, 3, 4\n*SURFACE, NAME=f\nq, S1\n", "found `S1`"),
        ("*ELEM, TYPE=C3D8\n", "*ELEM, which may stand for *ELEMENT,"),
        ("*NCOP, CHANGE NUMBER=8\n", "*NCOPY"),
        ("*SYMMETRIC MODEL GENERATION, PERIODIC\n", "*SYMMETRICMODELGENERATION"),
        ("*INCLUDE,\nINPUT=a.inp\n", "*INCLUDE"),
        ("*NSET, NSET=s, GENERATE\n1, 8, 3\n", "first, last and increment"),
        ("*NSET, NSET=s, GENERATE\n1, 8, 0\n", "first, last and increment"),
        ("*NSET, NSET=s, GENERATE\n8, 1\n", "first, last and increment"),
        ("*NSET, NSET=s, GENERATE\n1, 2, 1, 4\n", "first, last and increment"),
        ("*NODE\n9, 0.5, 0.2,\n10\n", "node 9 ends with a comma"),
    ] {
        let error = read_abaqus(inp(lines).as_bytes()).unwrap_err();
        assert!(error.to_string().contains(word), "{lines}{error}");
        assert!(matches!(error.place, Some(Place::Line(12..))), "{error:?}");
    }
}

#[test]
fn a_set_of_the_case_that_names_what_is_not_there_is_refused() {
    let small = String::from_utf8(bytes("small.inp")).unwrap();
    let end = small.lines().count();
    for (lines, line, word) in [
        ("*NSET, NSET=clamp\n1, 99999\n", 2, "set `clamp` names node 99999"),
        ("*NSET, NSET=clamp, GENERATE\n99000, 99999\n", 2, "set `clamp` names node 99000"),
        ("*NSET, NSET=clamp\nrail foot\n", 2, "set `clamp` names the node set `rail foot`"),
        ("*NSET, NSET=clamp, ELSET=foot\n", 1, "set `clamp` names the element set `foot`"),
        ("*NSET, NSET=a\n99999\n*NSET, NSET=clamp\na\n", 2, "set `a` names node 99999"),
        ("*ELSET, ELSET=disk\n99999\n", 2, "set `disk` names element 99999"),
        ("*SURFACE, NAME=tread\n99999, S1\n", 2, "set `tread` names element 99999"),
        ("*ELSET, ELSET=a\n99999\n*SURFACE, NAME=tread\na, S1\n", 2, "set `a` names element 99999"),
    ] {
        let read = read_abaqus(format!("{small}\n{lines}").as_bytes()).unwrap();
        let error = import(&read).unwrap_err();
        assert!(error.to_string().contains(word), "{lines}{error}");
        assert!(matches!(error.place, Some(Place::Line(n)) if n + 1 >= end + line), "{error:?}");
    }
    // of other sets the case knows nothing
    let other = format!("{small}\n*NSET, NSET=other, GENERATE\n1, 99999\n");
    import(&read_abaqus(other.as_bytes()).unwrap()).unwrap();
}

#[test]
fn letters_of_latin_1_in_comments_headings_and_names_are_read() {
    let latin_1 = |text: &str| text.chars().map(|c| u8::try_from(c).unwrap()).collect::<Vec<_>>();
    let lines = "** geändert am 3. März\n*HEADING\nRad auf Schiene, 20 °C\n*NSET, NSET=räder\n1\n\
                 *NSET, NSET=s\nRÄDER, 2\n";
    let cube = read_abaqus(&latin_1(&inp(lines))).unwrap();
    assert_eq!(cube, sets(lines));
    assert_eq!((&cube.sets["räder"].nodes[..], &cube.sets["s"].nodes[..]), (&[0][..], &[0, 1][..]));

    let named = CUBE_2.replace("the disk", "räder");
    let named = format!("{named}$Comments\n20 °C\n$EndComments\n");
    let read = read_gmsh(&latin_1(&named)).unwrap();
    assert_eq!(read, read_gmsh(named.as_bytes()).unwrap());
    assert_eq!(read.sets["räder"].hexes, [0]);

    let grid = vtu("0 1 2 3 4 5 6 7", "8", "12").replace("\"hub\"", "\"räder\"");
    let grid = grid.replace("?>\n", " encoding=\"ISO-8859-1\"?>\n<!-- 20 °C -->\n");
    assert_eq!(read_vtu(&latin_1(&grid)).unwrap().sets["räder"].nodes, [0, 7]);
}

#[test]
fn a_file_in_utf_16_is_called_so() {
    let text = inp("");
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let marked: Vec<u8> =
        [0xfe, 0xff].into_iter().chain(text.encode_utf16().flat_map(u16::to_be_bytes)).collect();
    for bytes in [wide, marked] {
        for read in [read_abaqus, read_gmsh, read_vtu] {
            let error = read(&bytes).unwrap_err();
            assert!(error.to_string().contains("UTF-16"), "{error}");
        }
    }
}

/// An array in base64, the header of `word` bytes with the data or apart from them.
fn base64(data: &[u8], word: usize, apart: bool) -> String {
    let header = &(data.len() as u64).to_le_bytes()[..word];
    if apart {
        STANDARD.encode(header) + &STANDARD.encode(data)
    } else {
        STANDARD.encode([header, data].concat())
    }
}

/// The grid of [`vtu`] with one hexahedron, its arrays in base64 by `encode`, inline or appended.
fn vtu_in_base64(word: usize, appended: bool, encode: impl Fn(&[u8]) -> String) -> Vec<u8> {
    let points = "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1".split(' ');
    let points: Vec<u8> = points.flat_map(|x| x.parse::<f64>().unwrap().to_le_bytes()).collect();
    let nodes: Vec<u8> = (0..8i64).flat_map(i64::to_le_bytes).collect();
    let mut section = String::new();
    let mut array = |name: &str, kind: &str, data: &[u8]| {
        let head = format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=");
        if !appended {
            return format!("{head}\"binary\">\n{}\n</DataArray>", encode(data));
        }
        let offset = section.len();
        section += &encode(data);
        format!("{head}\"appended\" offset=\"{offset}\"/>")
    };
    let text = format!(
        "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt{}\"><UnstructuredGrid><Piece>\
         <PointData>{}{}</PointData><Points>{}</Points><Cells>{}{}{}</Cells></Piece></UnstructuredGrid>",
        8 * word,
        array("hub", "UInt8", &[1, 0, 0, 0, 0, 0, 0, 1]),
        array("none", "String", &[]),
        array("Points", "Float64", &points),
        array("connectivity", "Int64", &nodes),
        array("offsets", "Int64", &8i64.to_le_bytes()),
        // a header and one byte more, which ends with a sign = too
        array("types", "UInt8", &[12]),
    );
    let section = format!("<AppendedData encoding=\"base64\">\n_{section}\n</AppendedData>");
    format!("{text}{}</VTKFile>", if appended { section } else { String::new() }).into_bytes()
}

#[test]
fn the_header_of_base64_data_may_be_encoded_with_them_or_apart() {
    let expected = read_vtu(vtu("0 1 2 3 4 5 6 7", "8", "12").as_bytes()).unwrap();
    for (word, appended, apart, wrapped) in
        (0..16).map(|i| (4 << (i & 1), i & 2 > 0, i & 4 > 0, i & 8 > 0))
    {
        let encode = |data: &[u8]| {
            let text = base64(data, word, apart);
            // lines of a length that no header ends at
            let lines = text.as_bytes().chunks(if wrapped { 7 } else { usize::MAX });
            lines.map(|line| str::from_utf8(line).unwrap()).collect::<Vec<_>>().join("\n")
        };
        let file = vtu_in_base64(word, appended, encode);
        let read = read_vtu(&file).unwrap();
        assert_eq!(read, expected, "{word} {appended} {apart} {wrapped}");
        // a header that says more than there is
        let long = vtu_in_base64(word, appended, |data| {
            let more = base64(&[data, &[0]].concat(), word, apart);
            let header = if apart { word.div_ceil(3) * 4 } else { 0 };
            if apart {
                more[..header].to_owned() + &STANDARD.encode(data)
            } else {
                more[..more.len() - 4].into()
            }
        });
        assert!(read_vtu(&long).is_err(), "{word} {appended} {apart}");
    }
}

#[test]
fn an_empty_array_may_have_a_header_or_none() {
    for none in ["", "AAAAAA==", "\n AAAA AA== \n"] {
        let text = vtu("0 1 2 3 4 5 6 7", "8", "12").replace(
            "<Cells>",
            &format!(
                "<FieldData/><CellData><DataArray type=\"UInt8\" NumberOfComponents=\"1\" Name=\"e\" \
                 format=\"binary\">{none}</DataArray></CellData><Cells>"
            ),
        );
        let error = read_vtu(text.as_bytes()).unwrap_err();
        assert!(error.to_string().contains("e has 0 values, not 1"), "{error}");
    }
}
