//! Meshes given as arrays: what is accepted, mended and refused.
#![allow(clippy::unwrap_used)]

use mesh::import::{
    Fault, Foreign, ImportError, Imported, Set, SetNames, SetRole, Shape, Unit, bodies, fit,
};
use mesh::{Bar, Disk, FineZone, Grading, HEX_FACES, Mesh, Parameter, bar, disk, join};
use nalgebra::Vector3;

const DISK: Disk = Disk { radius: 0.1, hub_radius: 0.05, width: 20e-3, crown: None };
const BAR: Bar = Bar { length: 0.1, width: 20e-3, height: 20e-3, crown: Some(0.3), start: -0.05 };
const ZONE: FineZone = FineZone {
    size: 2e-3,
    length: 20e-3,
    width: 8e-3,
    depth: 6e-3,
    start: -10e-3,
    growth: 1.35,
    coarsest: 50e-3,
    grading: Grading::Tensor,
};
const SHAPE: Shape = Shape { disk: DISK, bar: BAR, zone: ZONE, exact: true, ends: true };

fn generated() -> Mesh {
    join(&[disk(&DISK, &ZONE).unwrap(), bar(&BAR, &ZONE).unwrap()])
}

/// The generated mesh as another program would give it, with faces for the running surfaces.
fn foreign() -> Foreign {
    let mesh = generated();
    let mut sets = std::collections::BTreeMap::new();
    for (body, node_set, set) in [(0, "hub", "hub"), (1, "bottom", "clamp")] {
        let nodes = mesh.bodies[body].node_sets[node_set].clone();
        sets.insert(set.to_owned(), Set { nodes, ..Set::default() });
    }
    for (body, surface) in [(0, "tread"), (1, "top")] {
        let faces = mesh.bodies[body].surfaces[surface].faces.iter().map(|f| f.nodes).collect();
        sets.insert(surface.to_owned(), Set { faces, ..Set::default() });
    }
    for body in &mesh.bodies {
        let hexes = body.hexes.clone().map(|e| e as u32).collect();
        sets.insert(body.name.clone(), Set { hexes, ..Set::default() });
    }
    Foreign::from_arrays(mesh.nodes, mesh.hexes, sets)
}

fn import(foreign: &Foreign) -> Result<Imported, ImportError> {
    import_in(foreign, Unit::Metre)
}

fn import_in(foreign: &Foreign, unit: Unit) -> Result<Imported, ImportError> {
    fit(bodies(foreign, &SetNames::default(), unit)?, &SHAPE)
}

fn fault(foreign: &Foreign) -> Fault {
    import(foreign).unwrap_err().fault
}

/// Sorted, as bits.
fn places(mesh: &Mesh, nodes: impl IntoIterator<Item = u32>) -> Vec<[u64; 3]> {
    let mut places: Vec<_> =
        nodes.into_iter().map(|n| mesh.at(n).map(f64::to_bits).into()).collect();
    places.sort_unstable();
    places
}

/// A hexahedron of the disk amid the tread, that is away from rims and zone.
fn in_the_tread(foreign: &Foreign) -> ([u32; 4], u32) {
    let face = foreign.sets["tread"].faces.iter().find(|f| {
        f.iter().all(|&n| {
            let p = foreign.points[n as usize];
            p[1].abs() < 9e-3 && p[2] > 0.1
        })
    });
    let face = *face.unwrap();
    let owner = foreign.hexes.iter().position(|h| face.iter().all(|n| h.contains(n)));
    (face, owner.unwrap() as u32)
}

#[test]
fn an_imported_mesh_has_the_sets_surfaces_and_zone_of_the_generated_one() {
    let (ours, theirs) = (generated(), import(&foreign()).unwrap());
    assert_eq!(theirs.notes, [""; 0]);
    mesh::check(&theirs.mesh).unwrap();
    for (a, b) in ours.bodies.iter().zip(&theirs.mesh.bodies) {
        assert_eq!((&a.name, &a.nodes, &a.hexes), (&b.name, &b.nodes, &b.hexes));
        let names: Vec<_> = a.node_sets.keys().collect();
        assert_eq!(names, b.node_sets.keys().collect::<Vec<_>>());
        for (name, set) in &a.node_sets {
            let found = places(&theirs.mesh, b.node_sets[name].iter().copied());
            assert_eq!(places(&ours, set.iter().copied()), found, "{name}");
        }
        assert_eq!(a.surfaces.len(), b.surfaces.len());
        for (name, surface) in &a.surfaces {
            let other = &b.surfaces[name];
            assert_eq!(surface.faces.len(), other.faces.len(), "{name}");
            assert_eq!(surface.smooth, other.smooth, "{name}");
            let nodes =
                |s: &mesh::Surface| s.faces.iter().flat_map(|f| f.nodes).collect::<Vec<_>>();
            assert_eq!(places(&ours, nodes(surface)), places(&theirs.mesh, nodes(other)), "{name}");
        }
    }
}

#[test]
fn numbering_order_and_kind_of_set_do_not_change_the_bits() {
    let first = import(&foreign()).unwrap().mesh;
    let mut other = foreign();
    // every node and element under another number
    let (n, m) = (other.points.len() as u32, other.hexes.len() as u32);
    let to = |i: u32| n - 1 - i;
    other.points.reverse();
    other.hexes.reverse();
    other.hexes.iter_mut().flatten().for_each(|i| *i = to(*i));
    for set in other.sets.values_mut() {
        set.nodes.iter_mut().for_each(|i| *i = to(*i));
        set.faces.iter_mut().flatten().for_each(|i| *i = to(*i));
        set.hexes.iter_mut().for_each(|e| *e = m - 1 - *e);
    }
    // running surfaces by nodes, hub and clamp as they are
    for name in ["tread", "top"] {
        let set = other.sets.get_mut(name).unwrap();
        set.nodes = set.faces.drain(..).flatten().collect();
    }
    let second = import(&other).unwrap().mesh;
    assert_eq!(first.hexes, second.hexes);
    assert_eq!(first.nodes, second.nodes);
    for (a, b) in first.bodies.iter().zip(&second.bodies) {
        assert_eq!(a.node_sets, b.node_sets);
        for (name, surface) in &a.surfaces {
            assert_eq!(surface.faces, b.surfaces[name].faces, "{name}");
        }
    }
}

#[test]
fn a_body_may_be_named_by_its_nodes_and_names_may_differ_in_case() {
    let mut mesh = foreign();
    let nodes = generated().bodies[1].nodes.clone().map(|n| n as u32).collect();
    mesh.sets.remove("bar");
    mesh.sets.insert("BAR".into(), Set { nodes, ..Set::default() });
    assert_eq!(import(&mesh).unwrap().mesh.hexes, import(&foreign()).unwrap().mesh.hexes);
}

#[test]
fn hexahedra_numbered_inside_out_are_turned_and_counted() {
    let mut mesh = foreign();
    for e in [7, 12] {
        let [a, b, c, d, e5, f, g, h] = mesh.hexes[e];
        mesh.hexes[e] = [e5, f, g, h, a, b, c, d];
    }
    let mended = import(&mesh).unwrap();
    assert!(
        mended.notes[0].starts_with("2 hexahedra are numbered inside out"),
        "{:?}",
        mended.notes
    );
    assert_eq!(mended.mesh.hexes, import(&foreign()).unwrap().mesh.hexes);
}

#[test]
fn nodes_without_elements_are_left_out_and_counted() {
    let mut mesh = foreign();
    let loose = mesh.points.len() as u32;
    mesh.points.push(Vector3::new(0.0, 0.0, 0.1));
    mesh.sets.get_mut("hub").unwrap().nodes.push(loose);
    let mended = import(&mesh).unwrap();
    assert!(mended.notes[0].contains(&format!("node {loose}")), "{:?}", mended.notes);
    assert_eq!(mended.mesh.nodes, import(&foreign()).unwrap().mesh.nodes);
}

#[test]
fn a_twisted_hexahedron_is_refused_by_its_number() {
    let mut mesh = foreign();
    mesh.hexes[5].swap(0, 1);
    assert!(matches!(fault(&mesh), Fault::Inverted { element: 5, .. }), "{}", fault(&mesh));
}

#[test]
fn a_hexahedron_that_names_a_node_twice_or_none_that_there_is_is_refused() {
    let mut mesh = foreign();
    mesh.hexes[5][0] = mesh.hexes[5][1];
    assert!(matches!(fault(&mesh), Fault::Collapsed { element: 5, .. }));
    mesh.hexes[5][0] = u32::MAX;
    assert!(matches!(fault(&mesh), Fault::Unknown { .. }));
}

#[test]
fn nodes_that_are_not_merged_are_refused_by_their_numbers() {
    let mut mesh = foreign();
    let (first, second) = (mesh.hexes[5][2], mesh.points.len() as u32);
    mesh.points.push(mesh.points[first as usize]);
    mesh.hexes[5][2] = second;
    let expected = [u64::from(first), u64::from(second)];
    let found = fault(&mesh);
    assert!(
        matches!(found, Fault::Coincident { first, second, body: "disk", .. } if [first, second] == expected),
        "{found}"
    );
}

#[test]
fn a_node_of_both_bodies_is_refused() {
    let mut mesh = foreign();
    let [disk, bar] = [0, mesh.hexes.len() - 1];
    let node = mesh.hexes[disk][0];
    mesh.hexes[bar][0] = node;
    assert_eq!(fault(&mesh), Fault::SharedNode { node: u64::from(node) });
}

#[test]
fn elements_of_no_body_or_of_both_are_refused() {
    let mut mesh = foreign();
    let e = mesh.sets["bar"].hexes[3];
    mesh.sets.get_mut("disk").unwrap().hexes.push(e);
    assert!(
        matches!(fault(&mesh), Fault::NoBody { element, of: "both", .. } if element == u64::from(e))
    );
    mesh.sets.get_mut("disk").unwrap().hexes.pop();
    mesh.sets.get_mut("bar").unwrap().hexes.remove(3);
    assert!(
        matches!(fault(&mesh), Fault::NoBody { element, of: "neither", .. } if element == u64::from(e))
    );
}

#[test]
fn a_missing_set_is_refused_with_those_that_there_are() {
    let mut mesh = foreign();
    let set = mesh.sets.remove("tread").unwrap();
    mesh.sets.insert("running surface".into(), set);
    let error = import(&mesh).unwrap_err();
    let text = error.to_string();
    for word in ["`tread`", "running surface", "`running surface`", "`hub`", "`clamp`"] {
        assert!(text.contains(word), "{text}");
    }
}

#[test]
fn empty_sets_and_sets_that_name_both_bodies_are_refused() {
    let mut mesh = foreign();
    let hub = std::mem::take(&mut mesh.sets.get_mut("hub").unwrap().nodes);
    assert!(matches!(fault(&mesh), Fault::EmptySet { role: SetRole::Hub, .. }));
    mesh.sets.get_mut("hub").unwrap().nodes = hub;
    let other = mesh.sets["clamp"].nodes[0];
    mesh.sets.get_mut("hub").unwrap().nodes.push(other);
    let found = fault(&mesh);
    assert!(
        matches!(found, Fault::BothBodies { role: SetRole::Hub, node, body: "disk", .. } if node == u64::from(other)),
        "{found}"
    );
}

#[test]
fn a_hole_in_the_tread_is_refused_by_the_element_behind_it() {
    let mut mesh = foreign();
    let (face, owner) = in_the_tread(&mesh);
    mesh.sets.get_mut("tread").unwrap().faces.retain(|f| *f != face);
    let found = fault(&mesh);
    assert!(
        matches!(found, Fault::Hole { element, edges: 4, .. } if element == u64::from(owner)),
        "{found}"
    );
}

#[test]
fn a_hole_where_an_element_is_missing_is_refused() {
    let mut mesh = foreign();
    let (face, owner) = in_the_tread(&mesh);
    mesh.sets.get_mut("tread").unwrap().faces.retain(|f| *f != face);
    mesh.hexes.remove(owner as usize);
    for set in mesh.sets.values_mut() {
        set.hexes.retain(|&e| e != owner);
        set.hexes.iter_mut().filter(|e| **e > owner).for_each(|e| *e -= 1);
    }
    assert!(matches!(fault(&mesh), Fault::Hole { edges: 4, .. }), "{}", fault(&mesh));
}

#[test]
fn a_tread_that_does_not_go_round_the_disk_is_refused() {
    let mut mesh = foreign();
    let points = mesh.points.clone();
    let front = |f: &[u32; 4]| f.iter().any(|&n| points[n as usize][0] < 0.09);
    mesh.sets.get_mut("tread").unwrap().faces.retain(front);
    assert!(matches!(fault(&mesh), Fault::Open { .. }), "{}", fault(&mesh));
}

#[test]
fn a_wheel_on_another_axis_is_told_by_that_axis_and_not_as_a_hole() {
    for (turned, expected) in [(2, 'z'), (0, 'x')] {
        let mut mesh = foreign();
        // a quarter turn that takes y there
        let other = 2 - turned;
        for p in &mut mesh.points {
            let mut q = *p;
            (q[turned], q[1]) = (p[1], -p[turned]);
            q[other] = p[other];
            *p = q;
        }
        let found = fault(&mesh);
        assert!(
            matches!(found, Fault::Axis { role: SetRole::Tread, axis, .. } if axis == expected),
            "{found}"
        );
    }
}

#[test]
fn a_node_without_a_place_is_to_be_given_one() {
    let mut mesh = foreign();
    mesh.points[7][1] = f64::NAN;
    let found = fault(&mesh);
    assert!(matches!(found, Fault::NotFinite { node: 7, .. }), "{found}");
}

#[test]
fn a_top_in_two_pieces_and_a_face_inside_the_bar_are_refused() {
    let mut mesh = foreign();
    let points = mesh.points.clone();
    let apart = |f: &[u32; 4]| {
        let x: f64 = f.iter().map(|&n| points[n as usize][0]).sum();
        !(0.08..0.13).contains(&x)
    };
    mesh.sets.get_mut("top").unwrap().faces.retain(apart);
    assert!(matches!(fault(&mesh), Fault::Pieces { role: SetRole::Top, .. }), "{}", fault(&mesh));
    let mut mesh = foreign();
    let hex = mesh.hexes[mesh.hexes.len() / 2 + 1000];
    let inner = HEX_FACES[0].map(|c| hex[c]);
    mesh.sets.get_mut("top").unwrap().faces.push(inner);
    assert!(matches!(fault(&mesh), Fault::NotOutside { .. } | Fault::BothBodies { .. }));
}

#[test]
fn millimetres_where_metres_are_expected_are_named_and_the_unit_mends_them() {
    let mut mesh = foreign();
    mesh.points.iter_mut().flatten().for_each(|x| *x *= 1000.0);
    let error = import(&mesh).unwrap_err();
    assert!(error.to_string().contains("are in mm"), "{error}");
    assert!(matches!(error.fault, Fault::Unit { unit: Unit::Millimetre, .. }));
    import_in(&mesh, Unit::Millimetre).unwrap();
}

#[test]
fn a_wrong_unit_is_told_as_such_with_the_one_that_fits() {
    for fits in Unit::ALL {
        let mut mesh = foreign();
        mesh.points.iter_mut().flatten().for_each(|x| *x /= fits.metres(1.0));
        for wrong in Unit::ALL.into_iter().filter(|unit| *unit != fits) {
            let error = import_in(&mesh, wrong).unwrap_err();
            let Fault::Unit { unit, .. } = error.fault else { panic!("{wrong:?}: {error}") };
            assert_eq!(unit, fits, "read in {wrong:?}");
        }
    }
}

#[test]
fn sizes_places_and_shapes_other_than_the_case_gives_are_refused() {
    let with = |shape: Shape| {
        let imported = bodies(&foreign(), &SetNames::default(), Unit::Metre).unwrap();
        fit(imported, &shape).unwrap_err().fault
    };
    let disk = |disk: Disk| Shape { disk, ..SHAPE };
    let bar = |bar: Bar| Shape { bar, ..SHAPE };
    let zone = |zone: FineZone| Shape { zone, ..SHAPE };
    for (shape, expected) in [
        (disk(Disk { radius: 0.12, ..DISK }), Parameter::DiskRadius),
        (disk(Disk { hub_radius: 0.04, ..DISK }), Parameter::HubRadius),
        (disk(Disk { width: 0.03, ..DISK }), Parameter::DiskWidth),
        (bar(Bar { length: 0.2, ..BAR }), Parameter::BarLength),
        (bar(Bar { width: 0.03, ..BAR }), Parameter::BarWidth),
        (bar(Bar { height: 0.03, ..BAR }), Parameter::BarHeight),
    ] {
        let found = with(shape);
        let sized = matches!(found, Fault::Size { parameter, .. } if parameter == expected);
        assert!(sized, "{expected}: {found}");
    }
    assert!(matches!(with(bar(Bar { start: -0.04, ..BAR })), Fault::Place { .. }));
    let off = with(bar(Bar { crown: Some(0.29), ..BAR }));
    assert!(matches!(off, Fault::OffSurface { .. }), "{off}");
    let fine = with(zone(FineZone { size: 1e-3, ..ZONE }));
    assert!(matches!(fine, Fault::ZoneSize { .. }), "{fine}");
    let far = with(zone(FineZone { start: 0.045, ..ZONE }));
    assert!(matches!(far, Fault::Uncovered { .. }), "{far}");
    let mut mesh = foreign();
    mesh.points.iter_mut().for_each(|p| p[2] += 1e-3);
    assert!(matches!(fault(&mesh), Fault::Place { .. }), "{}", fault(&mesh));
}
