//! Facts about the meshes that become coarser 2:1 in all directions.
#![allow(clippy::unwrap_used, missing_docs)]

use mesh::{
    Bar, Body, Disk, FineZone, Grading, HEX_FACES, Mesh, MeshError, bar, check, disk, layers_below,
    quality,
};
use nalgebra::Vector3;
use proptest::prelude::*;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::f64::consts::PI;

const DISK: Disk = Disk { radius: 0.46, hub_radius: 0.10, width: 0.06, crown: None };
const CROWNED: Disk = Disk { crown: Some(0.30), ..DISK };
const BAR: Bar = Bar { length: 0.24, width: 0.06, height: 0.07, crown: Some(0.30), start: -0.09 };

const fn zone(size: f64) -> FineZone {
    FineZone {
        size,
        length: 0.08,
        width: 0.02,
        depth: 0.008,
        start: -0.010,
        growth: 1.35,
        coarsest: 0.05,
        grading: Grading::TwoToOne,
    }
}

fn both(zone: &FineZone) -> [Mesh; 2] {
    [disk(&DISK, zone).unwrap(), bar(&BAR, zone).unwrap()]
}

fn body(mesh: &Mesh) -> &Body {
    &mesh.bodies[0]
}

/// Faces of one element only, by their sorted nodes, and the largest number of elements of a face.
fn boundary(mesh: &Mesh) -> (HashSet<[u32; 4]>, usize) {
    let mut owners: HashMap<[u32; 4], usize> = HashMap::new();
    for hex in &mesh.hexes {
        for face in HEX_FACES {
            let mut nodes = face.map(|c| hex[c]);
            nodes.sort_unstable();
            *owners.entry(nodes).or_default() += 1;
        }
    }
    let most = owners.values().copied().max().unwrap();
    (owners.into_iter().filter(|(_, n)| *n == 1).map(|(f, _)| f).collect(), most)
}

#[test]
fn a_millimetre_takes_a_third_of_the_tensor_product_and_half_a_millimetre_half_of_it() {
    for (size, most) in [(2e-3, 10_000), (1e-3, 55_000), (0.5e-3, 320_000)] {
        let count: usize = both(&zone(size)).iter().map(|m| m.hexes.len()).sum();
        assert!(count < most, "{size}: {count}");
        // the zones alone
        assert!(count as f64 > 2.0 * 0.08 * 0.02 * 0.008 / size.powi(3));
    }
}

#[test]
fn shapes_stay_close_to_cubes_at_every_size_and_depth_of_the_zone() {
    for (size, depth) in [
        (2e-3, 8e-3),
        (1e-3, 8e-3),
        (1e-3, 4e-3),
        (1e-3, 16e-3),
        (0.8e-3, 5e-3),
        (0.7e-3, 8e-3),
        (0.5e-3, 8e-3),
    ] {
        let zone = FineZone { depth, ..zone(size) };
        for mesh in
            [disk(&DISK, &zone).unwrap(), disk(&CROWNED, &zone).unwrap(), bar(&BAR, &zone).unwrap()]
        {
            assert_eq!(check(&mesh), Ok(()));
            let q = quality(&mesh);
            assert!(q.min_scaled_jacobian >= 0.3, "{size} {depth} {q:?}");
            assert!(q.mean_scaled_jacobian > 0.8, "{size} {depth} {q:?}");
            assert!(q.max_aspect < 30.0, "{size} {depth} {q:?}");
            assert!(q.min_thickness > 0.55 * size, "{size} {depth} {q:?}");
        }
    }
}

#[test]
fn every_inner_face_has_two_elements_and_the_others_lie_on_the_outside() {
    let on = |value: f64, at: f64| (value - at).abs() < 1e-12;
    let [d, b] = both(&zone(2e-3));
    let tread = body(&d).surfaces["tread"].smooth.clone().unwrap();
    let top = body(&b).surfaces["top"].smooth.clone().unwrap();
    type Sides<'a> = Vec<Box<dyn Fn(Vector3<f64>) -> bool + 'a>>;
    let of_disk: Sides = vec![
        Box::new(|p| on(tread.offset(p), 0.0)),
        Box::new(|p| on(libm::hypot(p[0], p[2] - 0.46), 0.10)),
        Box::new(|p| p[1] == 0.03),
        Box::new(|p| p[1] == -0.03),
    ];
    let of_bar: Sides = vec![
        Box::new(|p| on(top.offset(p), 0.0)),
        Box::new(|p| p[2] == -0.07),
        Box::new(|p| p[1] == 0.03),
        Box::new(|p| p[1] == -0.03),
        Box::new(|p| p[0] == -0.09),
        Box::new(|p| p[0] == -0.09 + 0.24),
    ];
    for (mesh, sides) in [(&d, of_disk), (&b, of_bar)] {
        let (outside, most) = boundary(mesh);
        assert_eq!(most, 2);
        for face in outside {
            let points = face.map(|n| mesh.at(n));
            assert!(sides.iter().any(|side| points.iter().all(|p| side(*p))), "{points:?}");
        }
    }
}

#[test]
fn both_meshes_are_their_own_mirror_images_to_the_last_bit() {
    for mesh in both(&zone(1e-3)) {
        let bits = |p: Vector3<f64>| [p[0].to_bits(), (p[1] + 0.0).to_bits(), p[2].to_bits()];
        let place: HashMap<_, usize> =
            mesh.nodes.iter().enumerate().map(|(n, p)| (bits(*p), n)).collect();
        let image: Vec<u32> =
            mesh.nodes.iter().map(|p| place[&bits(Vector3::new(p.x, -p.y, p.z))] as u32).collect();
        let sorted = |mut hex: [u32; 8]| {
            hex.sort_unstable();
            hex
        };
        let hexes: HashSet<[u32; 8]> = mesh.hexes.iter().map(|h| sorted(*h)).collect();
        for hex in &mesh.hexes {
            assert!(hexes.contains(&sorted(hex.map(|n| image[n as usize]))));
            let y = hex.map(|n| mesh.nodes[n as usize][1]);
            let least = y.iter().fold(f64::MAX, |a, &b| a.min(b));
            let most = y.iter().fold(f64::MIN, |a, &b| a.max(b));
            assert!(least >= 0.0 || most <= 0.0, "an element lies across y = 0: {y:?}");
        }
    }
}

#[test]
fn an_odd_number_of_columns_across_becomes_even() {
    let zone = FineZone { width: 0.019, ..zone(1e-3) };
    for mesh in both(&zone) {
        assert_eq!(body(&mesh).surfaces["zone"].faces.len(), 80 * 20);
    }
    // as wide as the body: no room for another column of full width
    let whole = FineZone { width: 0.021, ..zone };
    let narrow = bar(&Bar { width: 0.021, crown: None, ..BAR }, &whole).unwrap();
    assert_eq!(check(&narrow), Ok(()));
    assert_eq!(body(&narrow).surfaces["zone"].faces.len(), 80 * 22);
}

#[test]
fn the_surface_of_the_zone_is_that_of_the_tensor_product_node_by_node() {
    for size in [2e-3, 1e-3] {
        let tensor = FineZone { grading: Grading::Tensor, ..zone(size) };
        for (a, b) in both(&zone(size)).iter().zip(&both(&tensor)) {
            let points = |mesh: &Mesh| -> Vec<Vector3<f64>> {
                body(mesh).node_sets["zone"].iter().map(|&n| mesh.at(n)).collect()
            };
            assert!(points(a) == points(b), "{}", body(a).name);
            let middles = |mesh: &Mesh| -> Vec<Vector3<f64>> {
                let faces = &body(mesh).surfaces["zone"].faces;
                let sum =
                    |f: &mesh::Face| f.nodes.iter().map(|&n| mesh.at(n)).sum::<Vector3<f64>>();
                faces.iter().map(|f| sum(f) / 4.0).collect()
            };
            let (a, b) = (middles(a), middles(b));
            assert_eq!(a.len(), b.len());
            for (a, b) in a.iter().zip(&b) {
                assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-15), "{a:?} {b:?}");
            }
        }
    }
}

#[test]
fn nodes_of_tread_top_hub_and_ends_lie_exactly_where_their_names_say() {
    for (mesh, names) in [
        (disk(&CROWNED, &zone(2e-3)).unwrap(), vec!["tread", "zone"]),
        (bar(&BAR, &zone(2e-3)).unwrap(), vec!["top", "zone"]),
    ] {
        for name in names {
            let surface = &body(&mesh).surfaces[name];
            let of_faces: HashSet<u32> = surface.faces.iter().flat_map(|f| f.nodes).collect();
            let set = &body(&mesh).node_sets[name];
            assert_eq!(of_faces.len(), set.len());
            let smooth = surface.smooth.as_ref().unwrap();
            assert!(set.iter().all(|n| of_faces.contains(n)));
            assert!(set.iter().all(|&n| smooth.offset(mesh.at(n)).abs() < 1e-12));
        }
    }
    let [d, b] = both(&zone(2e-3));
    let count = |mesh: &Mesh, test: &dyn Fn(Vector3<f64>) -> bool| {
        mesh.nodes.iter().filter(|p| test(**p)).count()
    };
    let hub = |p: Vector3<f64>| (libm::hypot(p[0], p[2] - 0.46) - 0.10).abs() < 1e-12;
    assert_eq!(count(&d, &hub), body(&d).node_sets["hub"].len());
    let sets = &body(&b).node_sets;
    assert_eq!(count(&b, &|p| p[2] == -0.07), sets["bottom"].len());
    assert_eq!(count(&b, &|p| p[0] == -0.09 || p[0] == -0.09 + 0.24), sets["ends"].len());
}

#[test]
fn volumes_are_those_of_the_bodies_as_closely_as_by_the_tensor_product() {
    let flat = Bar { crown: None, ..BAR };
    let volume = |mesh: &Mesh| quality(mesh).volume;
    let exact = 0.24 * 0.06 * 0.07;
    assert!((volume(&bar(&flat, &zone(2e-3)).unwrap()) / exact - 1.0).abs() < 1e-13);

    let (c, h): (f64, f64) = (0.30, 0.03);
    let segment = 2.0 * c * h - h * (c * c - h * h).sqrt() - c * c * libm::asin(h / c);
    let crowned = 0.24 * (0.06 * 0.07 - segment);
    let round = PI * (0.46f64.powi(2) - 0.1f64.powi(2)) * 0.06;
    for size in [2e-3, 1e-3] {
        let tensor = FineZone { grading: Grading::Tensor, ..zone(size) };
        let error = |meshes: [Mesh; 2]| {
            [volume(&meshes[0]) / round - 1.0, volume(&meshes[1]) / crowned - 1.0]
        };
        let (shells, tensor) = (error(both(&zone(size))), error(both(&tensor)));
        assert!(shells.iter().all(|e| e.abs() < 2e-3), "{shells:?}");
        assert!(shells[0].abs() <= tensor[0].abs(), "{shells:?} {tensor:?}");
        assert!(shells[1].abs() < 3e-4, "{shells:?} {tensor:?}");
    }
}

#[test]
fn contiguous_ranges_of_elements_are_slabs_and_their_nodes_are_near_in_number() {
    for mesh in both(&zone(1e-3)) {
        let n = mesh.hexes.len();
        let s = |p: Vector3<f64>| match mesh.bodies[0].name.as_str() {
            "bar" => p[0],
            // the turn begins opposite to the middle of the zone
            _ => 0.46 * (libm::atan2(p[0], 0.46 - p[2]) - 0.03 / 0.46 + PI).rem_euclid(2.0 * PI),
        };
        let middles: Vec<f64> = mesh.hexes[n / 50..n - n / 50]
            .iter()
            .map(|h| h.iter().map(|&k| s(mesh.at(k))).sum::<f64>() / 8.0)
            .collect();
        // sorted within a thousandth of an element of the zone
        assert!(middles.windows(2).all(|m| m[1] > m[0] - 1e-5));
        let spread: Vec<u32> =
            mesh.hexes.iter().map(|h| h.iter().max().unwrap() - h.iter().min().unwrap()).collect();
        let mean = spread.iter().map(|&w| f64::from(w)).sum::<f64>() / n as f64;
        assert!(mean < 0.03 * mesh.nodes.len() as f64, "{mean} of {}", mesh.nodes.len());
    }
}

#[test]
fn layers_below_the_zone_are_its_own_elements() {
    for mesh in both(&zone(1e-3)) {
        let faces = &body(&mesh).surfaces["zone"].faces;
        assert_eq!(layers_below(&mesh, body(&mesh), faces, 2).len(), 2 * 80 * 20);
    }
}

#[test]
fn sizes_follow_the_growth_that_is_asked_for() {
    let count = |growth: f64| -> usize {
        both(&FineZone { growth, ..zone(2e-3) }).iter().map(|m| m.hexes.len()).sum()
    };
    let counts = [1.1, 1.2, 1.35].map(count);
    assert!(counts.windows(2).all(|c| c[0] > c[1]), "{counts:?}");
}

#[test]
fn meshes_too_large_for_any_machine_are_refused_before_they_are_made() {
    let many =
        |result: Result<Mesh, MeshError>| matches!(result, Err(MeshError::TooManyElements { .. }));
    let fine = FineZone { size: 5e-5, ..zone(5e-5) };
    assert!(many(disk(&DISK, &fine)) && many(bar(&BAR, &fine)));
    // the zone alone is small enough; its shells are not
    let endless = FineZone { growth: 1.0 + 1e-12, ..zone(2e-4) };
    assert!(many(disk(&DISK, &endless)));
}

#[test]
fn a_zone_that_ends_at_the_bottom_but_for_round_off_has_no_layer_below_it() {
    let size = 0.002_533_729_670_033_313;
    let zone = FineZone {
        size,
        length: size,
        width: size,
        depth: 0.023_319_991_476_736_177,
        start: 0.0,
        growth: 1.1,
        coarsest: 8.0 * size,
        grading: Grading::TwoToOne,
    };
    let height = 0.026_180_563_775_017_776;
    let shape = Bar { length: 0.1, width: 0.01, height, crown: None, start: -0.06 };
    assert_eq!(check(&bar(&shape, &zone).unwrap()), Ok(()));
}

fn zones() -> impl Strategy<Value = FineZone> {
    let counts = (1.0..40.0f64, 1.0..30.0f64, 1.0..20.0f64);
    (2e-3..5e-3, counts, -0.05..0.0, 1.1..2.5, 8.0..25.0).prop_map(
        |(size, (length, width, depth), start, growth, coarsest)| FineZone {
            size,
            length: size * length,
            width: size * width,
            depth: size * depth,
            start,
            growth,
            coarsest: size * coarsest,
            grading: Grading::TwoToOne,
        },
    )
}

/// A mesh is sound, or its shape is refused. A zone that is shallow beside the `depth` of the body leaves its corners
/// room.
fn sound(
    result: Result<Mesh, MeshError>,
    zone: &FineZone,
    depth: f64,
) -> Result<(), TestCaseError> {
    match result {
        Err(MeshError::OutOfRange { .. } | MeshError::TooManyElements { .. }) => Ok(()),
        Err(other) => Err(TestCaseError::fail(other.to_string())),
        Ok(mesh) => {
            prop_assert_eq!(check(&mesh), Ok(()));
            let (_, most) = boundary(&mesh);
            prop_assert_eq!(most, 2);
            if zone.depth < 0.5 * depth {
                let q = quality(&mesh);
                prop_assert!(q.min_scaled_jacobian > 0.1, "{:?}", q);
                prop_assert!(q.min_thickness > 0.15 * zone.size, "{:?}", q);
            }
            let mut sets = BTreeMap::new();
            for (name, surface) in &body(&mesh).surfaces {
                prop_assert!(!surface.faces.is_empty(), "{}", name);
                sets.insert(name.clone(), surface.faces.len());
            }
            prop_assert!(body(&mesh).node_sets.values().all(|set| !set.is_empty()), "{:?}", sets);
            Ok(())
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_disk_is_sound_or_refused(
        zone in zones(),
        radius in 0.1..0.5f64,
        hub in 0.2..0.9f64,
        width in 0.01..0.2f64,
        crown in proptest::option::of(0.15..1.0f64),
    ) {
        let shape = Disk { radius, hub_radius: hub * radius, width, crown };
        sound(disk(&shape, &zone), &zone, radius - shape.hub_radius)?;
    }

    #[test]
    fn every_bar_is_sound_or_refused(
        zone in zones(),
        length in 0.1..0.4f64,
        width in 0.01..0.2f64,
        height in 0.01..0.2f64,
        crown in proptest::option::of(0.15..1.0f64),
    ) {
        let shape = Bar { length, width, height, crown, start: -0.06 };
        sound(bar(&shape, &zone), &zone, height)?;
    }
}
