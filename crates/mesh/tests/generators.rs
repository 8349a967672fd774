//! Facts about the generated disk and bar that hold for every shape.
#![allow(clippy::unwrap_used, missing_docs)]

use mesh::{Bar, Disk, Face, FineZone, Grading, Mesh, bar, check, disk, quality};
use nalgebra::Vector3;
use proptest::prelude::*;

fn centre(mesh: &Mesh, nodes: &[u32]) -> Vector3<f64> {
    nodes.iter().map(|&n| mesh.at(n)).sum::<Vector3<f64>>() / nodes.len() as f64
}

fn normal(mesh: &Mesh, face: &Face) -> Vector3<f64> {
    let p = face.nodes.map(|n| mesh.at(n));
    (p[2] - p[0]).cross(&(p[3] - p[1])).normalize()
}

/// Every face points away from its element; those of a smooth surface lie on it.
fn check_surfaces(mesh: &Mesh) {
    for body in &mesh.bodies {
        for (name, surface) in &body.surfaces {
            assert!(!surface.faces.is_empty(), "{name} is empty");
            for face in &surface.faces {
                let n = normal(mesh, face);
                let inner = centre(mesh, &mesh.hexes[face.hex as usize]);
                assert!(n.dot(&(centre(mesh, &face.nodes) - inner)) > 0.0, "{name} {face:?}");
                let Some(smooth) = &surface.smooth else {
                    continue;
                };
                for node in face.nodes {
                    let p = mesh.at(node);
                    assert!(smooth.offset(p).abs() < 1e-12, "{name}: {}", smooth.offset(p));
                    assert!(n.dot(&smooth.normal(p)) > 0.9, "{name} {face:?}");
                }
            }
        }
        for (name, set) in &body.node_sets {
            assert!(!set.is_empty(), "{name} is empty");
        }
    }
}

fn zones() -> impl Strategy<Value = FineZone> {
    (2e-3..5e-3, 3.0..25.0, 1.0..9.0, 1.0..8.0, -0.04..0.0, 1.15..1.6, 10.0..25.0).prop_map(
        |(size, length, width, depth, start, growth, coarsest): (
            f64,
            f64,
            f64,
            f64,
            f64,
            f64,
            f64,
        )| {
            FineZone {
                size,
                length: size * length,
                width: size * width,
                depth: (size * depth).min(0.05),
                start,
                growth,
                coarsest: size * coarsest,
                grading: Grading::Tensor,
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_disk_is_sound_and_nearly_as_fast_as_its_zone(
        zone in zones(),
        radius in 0.25..0.5f64,
        hub in 0.2..0.7f64,
        width in 0.05..0.08f64,
        crown in proptest::option::of(0.15..1.0f64),
    ) {
        let zone = FineZone { width: zone.width.min(width), ..zone };
        let shape = Disk { radius, hub_radius: hub * radius, width, crown };
        let mesh = disk(&shape, &zone).unwrap();
        prop_assert_eq!(check(&mesh), Ok(()));
        check_surfaces(&mesh);
        let q = quality(&mesh);
        prop_assert!(q.min_scaled_jacobian > 0.25, "{:?}", q);
        // The columns have tapered by this much where the first row may coarsen.
        let taper = 1.0 - (zone.depth + zone.size) / radius;
        let crown = 1.0 - width * width / (8.0 * crown.unwrap_or(f64::INFINITY) * radius);
        prop_assert!(q.min_thickness > 0.6 * taper * crown * zone.size, "{:?}", q);
    }

    #[test]
    fn every_bar_is_sound_and_as_fast_as_its_zone(
        zone in zones(),
        length in 0.2..0.4f64,
        width in 0.05..0.08f64,
        height in 0.05..0.09f64,
        crown in proptest::option::of(0.15..1.0f64),
    ) {
        let zone = FineZone { width: zone.width.min(width), ..zone };
        let shape = Bar { length, width, height, crown, start: -0.06 };
        let mesh = bar(&shape, &zone).unwrap();
        prop_assert_eq!(check(&mesh), Ok(()));
        check_surfaces(&mesh);
        let q = quality(&mesh);
        prop_assert!(q.min_scaled_jacobian > 0.35, "{:?}", q);
        // A crown squeezes the edges by its drop and slants their faces.
        let (squeeze, slant) = crown.map_or((1.0, 1.0), |c| {
            let cos = (1.0 - (0.5 * width / c).powi(2)).sqrt();
            (1.0 - c * (1.0 - cos) / height, cos)
        });
        prop_assert!(q.min_thickness > 0.75 * squeeze * slant * zone.size, "{:?}", q);
    }
}

#[test]
fn a_graded_block_fills_its_box_and_is_fine_where_asked() {
    let line =
        |from: f64, fine: [f64; 2]| mesh::graded_line([from, 0.04], fine, 1e-3, 1.5, 0.01).unwrap();
    let (xs, ys) = (line(-0.04, [-3e-3, 3e-3]), line(0.0, [0.0, 2e-3]));
    let zs = line(-0.04, [-2e-3, 0.0]);
    let block = mesh::graded_block([&xs, &ys, &zs]).unwrap();
    mesh::check(&block).unwrap();
    let volume: f64 =
        block.hexes.iter().map(|h| mesh::hex_volume(&h.map(|n| block.nodes[n as usize]))).sum();
    assert!((volume / (0.08 * 0.04 * 0.08) - 1.0).abs() < 1e-12);
    let fine = |points: &[f64], at: f64| {
        let i = points.partition_point(|x| *x <= at);
        points[i] - points[i - 1]
    };
    for (points, at) in [(&xs, 0.0), (&ys, 1.5e-3), (&zs, -0.5e-3)] {
        assert!((fine(points, at) - 1e-3).abs() < 1e-12);
    }
}

#[test]
fn a_block_or_line_that_makes_no_mesh_is_refused() {
    let good = [0.0, 1.0, 2.0];
    for bad in [&[0.0][..], &[], &[0.0, 1.0, 1.0], &[0.0, f64::NAN], &[1.0, 0.0]] {
        assert!(mesh::graded_block([&good, bad, &good]).is_err(), "{bad:?}");
    }
    let line = |fine: [f64; 2], size, growth, coarsest| {
        mesh::graded_line([0.0, 1.0], fine, size, growth, coarsest)
    };
    assert!(line([0.2, 0.4], 0.1, 1.5, 0.2).is_ok());
    assert!(line([0.2, 1.4], 0.1, 1.5, 0.2).is_err());
    assert!(line([0.4, 0.2], 0.1, 1.5, 0.2).is_err());
    assert!(line([0.2, f64::NAN], 0.1, 1.5, 0.2).is_err());
    assert!(line([0.2, 0.4], -0.1, 1.5, 0.2).is_err());
    assert!(line([0.2, 0.4], 1e-12, 1.5, 0.2).is_err());
    assert!(line([0.2, 0.4], 0.1, 1.0, 0.2).is_err());
    assert!(line([0.2, 0.4], 0.1, 1.5, 0.05).is_err());
}
