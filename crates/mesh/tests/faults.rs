//! The check finds each kind of fault; the quality measures have their known values.
#![allow(clippy::unwrap_used, missing_docs)]

use mesh::{Mesh, MeshError, block, check, join, quality};
use nalgebra::Vector3;

fn cube() -> Mesh {
    block([3, 3, 3], [3.0, 3.0, 3.0])
}

#[test]
fn a_cube_has_quality_one() {
    let q = quality(&block([2, 3, 4], [0.2, 0.3, 0.4]));
    for one in [q.min_scaled_jacobian, q.mean_scaled_jacobian, q.max_aspect] {
        assert!((one - 1.0).abs() < 1e-12, "{q:?}");
    }
    for edge in [q.min_edge, q.max_edge, q.min_thickness] {
        assert!((edge - 0.1).abs() < 1e-14, "{q:?}");
    }
    assert!((q.volume - 0.024).abs() < 1e-15);
}

#[test]
fn a_brick_has_the_aspect_and_thickness_of_its_edges() {
    let q = quality(&block([1, 1, 1], [1.0, 2.0, 5.0]));
    assert!((q.max_aspect - 5.0).abs() < 1e-14);
    assert!((q.min_thickness - 1.0).abs() < 1e-14);
    assert_eq!((q.min_edge, q.max_edge), (1.0, 5.0));
}

#[test]
fn a_sheared_cube_has_the_sine_of_its_angle_and_keeps_its_volume() {
    let mut mesh = cube();
    mesh.nodes.iter_mut().for_each(|p| p[0] += p[2]);
    let q = quality(&mesh);
    assert!((q.min_scaled_jacobian - 0.5f64.sqrt()).abs() < 1e-14);
    assert!((q.volume - 27.0).abs() < 1e-12);
}

#[test]
fn the_worst_element_is_the_one_that_was_bent() {
    let mut mesh = cube();
    let corner = mesh.nodes.len() - 1;
    mesh.nodes[corner][0] -= 0.5;
    assert_eq!(quality(&mesh).worst_element, mesh.hexes.len() - 1);
}

#[test]
fn a_sound_mesh_passes_alone_and_joined_with_one_that_touches_it() {
    assert_eq!(check(&cube()), Ok(()));
    // Two bodies may share places: they are not connected.
    assert_eq!(check(&join(&[cube(), cube()])), Ok(()));
    assert_eq!(check(&Mesh::default()), Ok(()));
}

#[test]
fn sides_of_a_block_face_outwards() {
    let mesh = block([2, 3, 4], [1.0, 1.0, 1.0]);
    for (name, axis, at) in [
        ("x-", 0, 0.0),
        ("x+", 0, 1.0),
        ("y-", 1, 0.0),
        ("y+", 1, 1.0),
        ("z-", 2, 0.0),
        ("z+", 2, 1.0),
    ] {
        let body = &mesh.bodies[0];
        let count = [12, 8, 6][axis];
        assert_eq!(body.surfaces[name].faces.len(), count);
        assert!(body.node_sets[name].iter().all(|&n| mesh.nodes[n as usize][axis] == at));
        for face in &body.surfaces[name].faces {
            let p = face.nodes.map(|n| mesh.at(n));
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let turn = (p[1][u] - p[0][u]) * (p[2][v] - p[1][v])
                - (p[1][v] - p[0][v]) * (p[2][u] - p[1][u]);
            assert!(turn * (at - 0.5) > 0.0, "{name}");
        }
    }
}

#[test]
fn an_inverted_element_is_found() {
    let mut mesh = cube();
    mesh.bodies[0].surfaces.clear();
    mesh.hexes[5].swap(0, 4);
    assert!(matches!(check(&mesh), Err(MeshError::NegativeJacobian { element: 5, .. })));
}

#[test]
fn a_flat_element_is_found() {
    let mut mesh = cube();
    let side = mesh.bodies[0].node_sets["x+"].clone();
    for n in side {
        mesh.nodes[n as usize][0] = 2.0;
    }
    assert!(matches!(check(&mesh), Err(MeshError::NegativeJacobian { .. })));
}

#[test]
fn a_coordinate_that_is_not_finite_is_found() {
    let mut mesh = cube();
    mesh.nodes[7][1] = f64::NAN;
    assert!(matches!(check(&mesh), Err(MeshError::NotFinite { node: 7, .. })));
}

#[test]
fn a_crack_between_coinciding_nodes_is_found() {
    let mut mesh = join(&[cube(), cube()]);
    // The second cube begins where the first ends, without being connected.
    for p in &mut mesh.nodes[64..] {
        p[0] += 3.0;
    }
    let second = mesh.bodies.pop().unwrap();
    mesh.bodies[0].nodes.end = second.nodes.end;
    mesh.bodies[0].hexes.end = second.hexes.end;
    assert!(matches!(check(&mesh), Err(MeshError::DuplicateNodes { .. })));
}

#[test]
fn a_hanging_node_is_found() {
    // A unit cube and, connected at the four corners only, two by two elements beside it.
    let mut mesh = join(&[block([1, 1, 1], [1.0; 3]), block([1, 2, 2], [1.0; 3])]);
    for p in &mut mesh.nodes[8..] {
        p[0] += 1.0;
    }
    let (mut nodes, mut new) = (Vec::<Vector3<f64>>::new(), Vec::new());
    for &p in &mesh.nodes {
        let known = nodes.iter().position(|q| *q == p);
        new.push(known.unwrap_or(nodes.len()) as u32);
        if known.is_none() {
            nodes.push(p);
        }
    }
    mesh.nodes = nodes;
    mesh.hexes.iter_mut().flatten().for_each(|n| *n = new[*n as usize]);
    let mut body = mesh.bodies.remove(0);
    body.node_sets.clear();
    body.surfaces.clear();
    (body.nodes, body.hexes) = (0..mesh.nodes.len(), 0..5);
    mesh.bodies = vec![body];
    let fault = check(&mesh).unwrap_err();
    assert!(matches!(fault, MeshError::HangingNode { element: 0, .. }), "{fault}");
}

#[test]
fn an_element_given_twice_is_found() {
    let mut mesh = cube();
    mesh.bodies[0].surfaces.clear();
    mesh.hexes[1] = mesh.hexes[0];
    assert!(matches!(check(&mesh), Err(MeshError::FaceShared { .. })));
}

#[test]
fn indices_outside_the_body_are_found() {
    let mut mesh = cube();
    mesh.hexes[3][2] = 64;
    assert!(matches!(check(&mesh), Err(MeshError::BadIndex { index: 64, .. })));

    let mut mesh = cube();
    mesh.bodies[0].node_sets.insert("odd".into(), vec![64]);
    assert!(matches!(check(&mesh), Err(MeshError::BadIndex { index: 64, .. })));

    let mut mesh = cube();
    mesh.bodies[0].surfaces.get_mut("x-").unwrap().faces[0].hex = 27;
    assert!(matches!(check(&mesh), Err(MeshError::BadIndex { index: 27, .. })));

    let mut mesh = join(&[cube(), cube()]);
    mesh.hexes[30][0] = 0;
    assert!(matches!(check(&mesh), Err(MeshError::BadIndex { index: 0, .. })));
}

#[test]
fn sets_and_surfaces_that_break_their_promise_are_found() {
    let mut mesh = cube();
    mesh.bodies[0].node_sets.insert("twice".into(), vec![1, 1]);
    assert!(matches!(check(&mesh), Err(MeshError::UnsortedSet { .. })));

    let mut mesh = cube();
    mesh.bodies[0].surfaces.get_mut("z+").unwrap().faces[2].nodes.reverse();
    assert!(matches!(check(&mesh), Err(MeshError::NotAFace { .. })));
}

#[test]
fn nodes_without_elements_and_ranges_with_gaps_are_found() {
    let mut mesh = cube();
    mesh.nodes.push(Vector3::repeat(9.0));
    assert!(matches!(check(&mesh), Err(MeshError::BodyRange { .. })));
    mesh.bodies[0].nodes.end += 1;
    assert_eq!(check(&mesh), Err(MeshError::LooseNode { node: 64 }));
}
