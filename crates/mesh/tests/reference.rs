//! Facts about the meshes of the reference case: the disk on the bar.
#![allow(clippy::unwrap_used, missing_docs)]

use mesh::{
    Bar, Body, Disk, FineZone, Grading, Mesh, MeshError, Parameter, bar, check, disk, join, quality,
};
use nalgebra::Vector3;
use std::f64::consts::PI;

const DISK: Disk = Disk { radius: 0.46, hub_radius: 0.10, width: 0.06, crown: None };
const BAR: Bar = Bar { length: 0.24, width: 0.06, height: 0.07, crown: Some(0.30), start: -0.09 };
const CROWNED: Disk = Disk { crown: Some(0.30), ..DISK };

const fn zone(size: f64) -> FineZone {
    FineZone {
        size,
        length: 0.08,
        width: 0.02,
        depth: 0.008,
        start: -0.010,
        growth: 1.35,
        coarsest: 0.05,
        grading: Grading::Tensor,
    }
}

fn points<'a>(mesh: &'a Mesh, set: &'a [u32]) -> impl Iterator<Item = Vector3<f64>> + 'a {
    set.iter().map(|&n| mesh.at(n))
}

fn body<'a>(mesh: &'a Mesh, name: &str) -> &'a Body {
    mesh.bodies.iter().find(|b| b.name == name).unwrap()
}

/// Arc length of a point of the disk from the first contact.
fn arc(p: Vector3<f64>) -> f64 {
    DISK.radius * libm::atan2(p[0], DISK.radius - p[2])
}

#[test]
fn counts_stay_within_the_budget_of_each_size() {
    for (size, least, most) in [(2e-3, 3e4, 6e4), (1e-3, 1e5, 1.6e5), (0.5e-3, 4e5, 1e6)] {
        let count = disk(&DISK, &zone(size)).unwrap().hexes.len()
            + bar(&BAR, &zone(size)).unwrap().hexes.len();
        assert!((least..most).contains(&(count as f64)), "{size}: {count}");
    }
}

#[test]
fn no_element_is_thinner_than_three_quarters_of_the_size() {
    for size in [2e-3, 1e-3] {
        for mesh in [
            disk(&DISK, &zone(size)).unwrap(),
            disk(&CROWNED, &zone(size)).unwrap(),
            bar(&BAR, &zone(size)).unwrap(),
        ] {
            assert_eq!(check(&mesh), Ok(()));
            let q = quality(&mesh);
            assert!(q.min_thickness > 0.75 * size, "{q:?}");
            assert!(q.min_scaled_jacobian > 0.35, "{q:?}");
            assert!(q.mean_scaled_jacobian > 0.97, "{q:?}");
        }
    }
}

#[test]
fn zones_of_disk_and_bar_meet_point_by_point_in_rolling() {
    let (d, b) = (disk(&DISK, &zone(2e-3)).unwrap(), bar(&BAR, &zone(2e-3)).unwrap());
    let (on_disk, on_bar) =
        (&body(&d, "disk").node_sets["zone"], &body(&b, "bar").node_sets["zone"]);
    assert_eq!(on_disk.len(), 41 * 11);
    assert_eq!(on_disk.len(), on_bar.len());
    for (p, q) in points(&d, on_disk).zip(points(&b, on_bar)) {
        assert!((arc(p) - q[0]).abs() < 1e-14, "{p:?} {q:?}");
        assert_eq!(p[1], q[1]);
    }
    let first = points(&b, on_bar).next().unwrap();
    assert!((first[0] + 0.01).abs() < 1e-15 && (first[1] + 0.01).abs() < 1e-15);
}

#[test]
fn zone_faces_have_the_size_asked_for() {
    let z = zone(1e-3);
    for (mesh, name) in [(disk(&DISK, &z).unwrap(), "disk"), (bar(&BAR, &z).unwrap(), "bar")] {
        let surface = &body(&mesh, name).surfaces["zone"];
        assert_eq!(surface.faces.len(), 80 * 20);
        for face in &surface.faces {
            let p = face.nodes.map(|n| mesh.at(n));
            let s = p.map(|p| if name == "disk" { arc(p) } else { p[0] });
            let spread = |v: [f64; 4]| {
                v.iter().fold(f64::MIN, |a, &b| a.max(b))
                    - v.iter().fold(f64::MAX, |a, &b| a.min(b))
            };
            assert!((spread(s) - 1e-3).abs() < 1e-13, "{}", spread(s));
            assert!((spread(p.map(|p| p[1])) - 1e-3).abs() < 1e-13);
            let inner = mesh.hexes[face.hex as usize];
            let inner = inner.iter().filter(|n| !face.nodes.contains(n));
            for &n in inner {
                // Below its own node of the face: a size in depth.
                let q = mesh.nodes[n as usize];
                let depth = p
                    .iter()
                    .map(|p| {
                        ((p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2) + (p[2] - q[2]).powi(2))
                            .sqrt()
                    })
                    .fold(f64::MAX, f64::min);
                assert!((depth - 1e-3).abs() < 3e-6, "{name} {depth}");
            }
        }
    }
}

#[test]
fn sets_hold_the_nodes_that_their_names_say() {
    let (d, b) = (disk(&CROWNED, &zone(2e-3)).unwrap(), bar(&BAR, &zone(2e-3)).unwrap());
    let whole = |mesh: &Mesh, set: &[u32], test: &dyn Fn(Vector3<f64>) -> bool| {
        assert!(points(mesh, set).all(test));
        assert_eq!(mesh.nodes.iter().filter(|&&p| test(p)).count(), set.len());
    };
    let sets = &body(&d, "disk").node_sets;
    let rho = |p: Vector3<f64>| libm::hypot(p[0], p[2] - 0.46);
    whole(&d, &sets["hub"], &|p| (rho(p) - 0.10).abs() < 1e-12);
    let smooth = body(&d, "disk").surfaces["tread"].smooth.clone().unwrap();
    whole(&d, &sets["tread"], &|p| smooth.offset(p).abs() < 1e-12);

    let sets = &body(&b, "bar").node_sets;
    let smooth = body(&b, "bar").surfaces["top"].smooth.clone().unwrap();
    whole(&b, &sets["top"], &|p| smooth.offset(p).abs() < 1e-12);
    whole(&b, &sets["bottom"], &|p| p[2] == -0.07);
    whole(&b, &sets["ends"], &|p| p[0] == -0.09 || p[0] == -0.09 + 0.24);
    for (surface, x) in [("rear", -0.09), ("front", -0.09 + 0.24)] {
        let faces = &body(&b, "bar").surfaces[surface].faces;
        assert!(faces.iter().all(|f| points(&b, &f.nodes).all(|p| p[0] == x)));
    }
}

#[test]
fn flat_bar_has_the_volume_of_its_box() {
    let flat = Bar { crown: None, ..BAR };
    let volume = quality(&bar(&flat, &zone(2e-3)).unwrap()).volume;
    assert!((volume / (0.24 * 0.06 * 0.07) - 1.0).abs() < 1e-13, "{volume}");
}

#[test]
fn crowned_bar_has_the_volume_under_its_crown() {
    let volume = quality(&bar(&BAR, &zone(1e-3)).unwrap()).volume;
    // Circular segment: 2 * integral of c - sqrt(c^2 - y^2) from 0 to h.
    let (c, h): (f64, f64) = (0.30, 0.03);
    let segment = 2.0 * c * h - h * (c * c - h * h).sqrt() - c * c * libm::asin(h / c);
    let exact = 0.24 * (0.06 * 0.07 - segment);
    // The facets cut the corners of the circle: sum over faces of w^3/(12 c), 5 mm at most.
    let cut = 0.24 * 0.06 * 0.0052f64.powi(2) / (12.0 * c);
    assert!(volume < exact && volume > exact - cut, "{volume} {exact} {cut}");
}

#[test]
fn disk_volume_converges_to_the_annulus_with_the_square_of_the_size() {
    let exact = PI * (0.46f64.powi(2) - 0.1f64.powi(2)) * 0.06;
    let error = |coarsest: f64| {
        let z = FineZone { coarsest, ..zone(5e-3) };
        1.0 - quality(&disk(&DISK, &z).unwrap()).volume / exact
    };
    let (coarse, fine) = (error(0.04), error(0.02));
    assert!(coarse > 0.0 && coarse < 2e-3, "{coarse}");
    assert!(coarse / fine > 3.0, "{coarse} {fine}");
}

#[test]
fn elements_run_along_the_rolling_direction_in_slabs() {
    let b = bar(&BAR, &zone(2e-3)).unwrap();
    let middle = |mesh: &Mesh, hex: &[u32; 8], f: &dyn Fn(Vector3<f64>) -> f64| {
        points(mesh, hex).map(f).sum::<f64>() / 8.0
    };
    let xs: Vec<f64> = b.hexes.iter().map(|h| middle(&b, h, &|p| p[0])).collect();
    assert!(xs.windows(2).all(|x| x[1] > x[0] - 1e-12));

    let d = disk(&DISK, &zone(2e-3)).unwrap();
    let top = middle(&d, &d.hexes[0], &|p| p[2]);
    assert!(top > DISK.radius, "the seam is on the side of the contact: {top}");
    // Angle from the far side of the zone's middle, which is at the arc 30 mm.
    let start = 0.03 / DISK.radius - PI;
    let angle =
        |p: Vector3<f64>| (libm::atan2(p[0], DISK.radius - p[2]) - start).rem_euclid(2.0 * PI);
    let n = d.hexes.len();
    let angles: Vec<f64> =
        d.hexes[n / 20..n - n / 20].iter().map(|h| middle(&d, h, &angle)).collect();
    // Coarse columns are placed by their middle column, off by less than half their width.
    assert!(angles.windows(2).all(|a| a[1] > a[0] - 0.1));
    assert!(angles[angles.len() - 1] - angles[0] > PI);
}

#[test]
fn join_moves_nodes_elements_sets_and_faces_behind_those_before() {
    let (d, b) = (disk(&DISK, &zone(2e-3)).unwrap(), bar(&BAR, &zone(2e-3)).unwrap());
    let both = join(&[d.clone(), b.clone()]);
    assert_eq!(check(&both), Ok(()));
    let joined = body(&both, "bar");
    assert_eq!(joined.nodes, d.nodes.len()..d.nodes.len() + b.nodes.len());
    assert_eq!(joined.hexes, d.hexes.len()..d.hexes.len() + b.hexes.len());
    let alone = body(&b, "bar");
    for (name, set) in &alone.node_sets {
        assert!(points(&b, set).eq(points(&both, &joined.node_sets[name])), "{name}");
    }
    for (name, surface) in &alone.surfaces {
        let moved = &joined.surfaces[name];
        assert_eq!(moved.smooth, surface.smooth);
        for (f, g) in surface.faces.iter().zip(&moved.faces) {
            assert!(points(&b, &f.nodes).eq(points(&both, &g.nodes)), "{name}");
            assert_eq!(f.hex as usize + d.hexes.len(), g.hex as usize);
        }
    }
}

/// The parameter that a shape is refused by; none where it has too many elements.
#[track_caller]
fn refused<T>(result: Result<T, MeshError>) -> Option<Parameter> {
    match result {
        Err(MeshError::OutOfRange { parameter, .. }) => Some(parameter),
        Err(MeshError::TooManyElements { .. }) => None,
        Ok(_) => panic!("it is accepted"),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn a_bad_shape_is_refused_by_the_name_of_its_parameter() {
    let z = zone(2e-3);
    let on = |shape: Disk| refused(disk(&shape, &z));
    assert_eq!(on(Disk { radius: f64::NAN, ..DISK }), Some(Parameter::DiskRadius));
    assert_eq!(on(Disk { radius: f64::INFINITY, ..DISK }), Some(Parameter::DiskRadius));
    assert_eq!(on(Disk { hub_radius: 0.46, ..DISK }), Some(Parameter::HubRadius));
    assert_eq!(on(Disk { hub_radius: 0.0, ..DISK }), Some(Parameter::HubRadius));
    assert_eq!(on(Disk { width: -0.06, ..DISK }), Some(Parameter::DiskWidth));
    assert_eq!(on(Disk { width: 0.01, ..DISK }), Some(Parameter::ZoneWidth));
    assert_eq!(on(Disk { crown: Some(0.029), ..DISK }), Some(Parameter::DiskCrown));
    assert_eq!(on(Disk { hub_radius: 0.455, ..DISK }), Some(Parameter::ZoneDepth));

    let on = |shape: Bar| refused(bar(&shape, &z));
    assert_eq!(on(Bar { length: 0.0, ..BAR }), Some(Parameter::BarLength));
    assert_eq!(on(Bar { length: 0.07, ..BAR }), Some(Parameter::ZoneLength));
    assert_eq!(on(Bar { width: f64::NAN, ..BAR }), Some(Parameter::BarWidth));
    assert_eq!(on(Bar { height: 0.007, crown: None, ..BAR }), Some(Parameter::ZoneDepth));
    assert_eq!(on(Bar { start: 0.0, ..BAR }), Some(Parameter::ZoneStart));
    assert_eq!(on(Bar { start: f64::NAN, ..BAR }), Some(Parameter::BarStart));
    assert_eq!(on(Bar { crown: Some(0.02), ..BAR }), Some(Parameter::BarCrown));
    assert_eq!(on(Bar { crown: Some(0.03), height: 0.02, ..BAR }), Some(Parameter::BarCrown));

    for (parameter, bad) in [
        (Some(Parameter::ZoneSize), FineZone { size: 0.0, ..z }),
        (Some(Parameter::ZoneSize), FineZone { size: 0.01, ..z }),
        (Some(Parameter::ZoneLength), FineZone { length: f64::INFINITY, ..z }),
        (Some(Parameter::ZoneLength), FineZone { length: 2.0, ..z }),
        (Some(Parameter::ZoneWidth), FineZone { width: 0.07, ..z }),
        (Some(Parameter::ZoneDepth), FineZone { depth: -1.0, ..z }),
        (Some(Parameter::ZoneStart), FineZone { start: f64::NAN, ..z }),
        (Some(Parameter::ZoneStart), FineZone { start: 2.0, ..z }),
        (Some(Parameter::Growth), FineZone { growth: 1.0, ..z }),
        (Some(Parameter::Growth), FineZone { growth: f64::NAN, ..z }),
        (Some(Parameter::Growth), FineZone { growth: 3.1, ..z }),
        (Some(Parameter::Coarsest), FineZone { coarsest: 1e-3, ..z }),
        (None, FineZone { size: 5e-5, ..z }),
        (None, FineZone { size: 1e-300, ..z }),
    ] {
        assert_eq!(refused(disk(&DISK, &bad)), parameter, "disk: {bad:?}");
        assert_eq!(refused(bar(&BAR, &bad)), parameter, "bar: {bad:?}");
    }
}

#[test]
fn a_ring_of_too_many_rows_is_refused_while_it_is_made() {
    // One layer of the zone's depth passes the estimate; its uniform rows to the hub do not.
    let z = FineZone {
        size: 2e-5,
        length: 2e-5,
        width: 2e-5,
        depth: 2e-5,
        start: 0.0,
        growth: 3.0,
        coarsest: 2e-5,
        grading: Grading::Tensor,
    };
    let narrow = Disk { width: 2e-3, ..DISK };
    assert!(matches!(disk(&narrow, &z), Err(MeshError::TooManyElements { estimate, .. })
        if estimate > 1e11 && estimate < 1e12));
}
