//! A numbering of points by which neighbours are near in memory.

use crate::geometry::hull;
use nalgebra::Vector3;
use std::cmp::Ordering;

/// Bits per coordinate of a cell of the curve.
const BITS: u32 = 21;

/// Indices of the points in the order of Morton's curve through their bounding cube; points of one cell are ordered
/// by their coordinates. The order of the points does not depend on how they are listed, and neighbours are near
/// each other in it.
///
/// Source: Morton (1966), "A computer oriented geodetic data base", IBM.
pub(crate) fn along_curve(points: &[Vector3<f64>]) -> Vec<u32> {
    let [low, high] = hull(points);
    let extent = (high - low).iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let most = ((1u64 << BITS) - 1) as f64;
    let cell = |p: &Vector3<f64>| {
        let [x, y, z] = [0, 1, 2].map(|a| (most * ((p[a] - low[a]) / extent)) as u64);
        spread(x) | spread(y) << 1 | spread(z) << 2
    };
    let mut order: Vec<(u64, u32)> =
        points.iter().enumerate().map(|(i, p)| (cell(p), i as u32)).collect();
    order.sort_unstable_by(|a, b| {
        let [p, q] = [points[a.1 as usize], points[b.1 as usize]];
        a.0.cmp(&b.0).then_with(|| by_coordinates(p, q)).then(a.1.cmp(&b.1))
    });
    order.into_iter().map(|(_, i)| i).collect()
}

fn by_coordinates(p: Vector3<f64>, q: Vector3<f64>) -> Ordering {
    (0..3).map(|a| p[a].total_cmp(&q[a])).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
}

/// The low 21 bits of `x` with two zeros after each.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_depends_on_the_points_and_not_on_how_they_were_listed() {
        let points: Vec<Vector3<f64>> = (0..60)
            .map(|i| {
                let z = ((i * 11) % 4) as f64 + 1e-9 * i as f64;
                Vector3::new((i % 5) as f64, ((i * 7) % 3) as f64, z)
            })
            .collect();
        let mut turned = points.clone();
        turned.reverse();
        let at =
            |p: &[Vector3<f64>]| along_curve(p).iter().map(|&i| p[i as usize]).collect::<Vec<_>>();
        assert_eq!(at(&points), at(&turned));
    }

    #[test]
    fn the_eight_corners_of_a_cube_follow_one_another_octant_by_octant() {
        let corner = |i| Vector3::from([i & 1, i >> 1 & 1, i >> 2 & 1].map(f64::from));
        let corners: Vec<_> = (0..8).map(corner).rev().collect();
        assert_eq!(along_curve(&corners), [7, 6, 5, 4, 3, 2, 1, 0]);
    }
}
