//! Layers of hexahedra with a contact surface, for tests.

use crate::BodyMaterial;
use mesh::{Face, Mesh, SmoothSurface, Surface};
use nalgebra::Vector3;

pub(crate) const STEEL: BodyMaterial = BodyMaterial { bulk_modulus: 175e9, density: 7850.0 };

/// One layer of `cells` hexahedra over the rectangle `low`..`high` with its contact surface at
/// height `z`, which looks up (`up`) with the body below it, or down with the body above.
pub(crate) fn plate(
    low: [f64; 2],
    high: [f64; 2],
    cells: [usize; 2],
    z: f64,
    depth: f64,
    up: bool,
) -> (Mesh, Surface) {
    mapped(cells, up, None, |s, t, inside| {
        let x = low[0] + s * (high[0] - low[0]);
        let y = low[1] + t * (high[1] - low[1]);
        Vector3::new(x, y, if up { z - depth * inside } else { z + depth * inside })
    })
}

/// The lowest `2 half_angle` of a disk of `radius`, centre above the origin, `width` in y.
pub(crate) fn tread(
    radius: f64,
    half_angle: f64,
    width: f64,
    cells: [usize; 2],
    depth: f64,
) -> (Mesh, Surface) {
    let smooth = SmoothSurface::Tread { centre: radius * Vector3::z(), radius, crown: None };
    mapped(cells, false, Some(smooth), |s, t, inside| {
        let (angle, r) = ((2.0 * s - 1.0) * half_angle, radius - depth * inside);
        Vector3::new(r * libm::sin(angle), (t - 0.5) * width, radius - r * libm::cos(angle))
    })
}

fn mapped(
    cells: [usize; 2],
    up: bool,
    smooth: Option<SmoothSurface>,
    place: impl Fn(f64, f64, f64) -> Vector3<f64>,
) -> (Mesh, Surface) {
    let [nx, ny] = cells;
    let mut mesh = Mesh::default();
    for layer in [0.0, 1.0] {
        for j in 0..=ny {
            for i in 0..=nx {
                mesh.nodes.push(place(i as f64 / nx as f64, j as f64 / ny as f64, layer));
            }
        }
    }
    let plane = ((nx + 1) * (ny + 1)) as u32;
    let mut surface = Surface { faces: Vec::new(), smooth, irregularity: None };
    for j in 0..ny {
        for i in 0..nx {
            let a = (j * (nx + 1) + i) as u32;
            let (b, d) = (a + 1, a + nx as u32 + 1);
            let top = [a, b, d + 1, d];
            let under = top.map(|n| n + plane);
            let (lower, upper) = if up { (under, top) } else { (top, under) };
            let hex = mesh.hexes.len() as u32;
            mesh.hexes.push([
                lower[0], lower[1], lower[2], lower[3], upper[0], upper[1], upper[2], upper[3],
            ]);
            let nodes = if up { top } else { [a, d, d + 1, b] };
            surface.faces.push(Face { nodes, hex });
        }
    }
    (mesh, surface)
}

/// Two meshes in one; the second surface's indices are shifted.
pub(crate) fn together(first: Mesh, second: Mesh, surface: Surface) -> (Mesh, Surface) {
    let (nodes, hexes) = (first.nodes.len() as u32, first.hexes.len() as u32);
    let mut mesh = first;
    mesh.nodes.extend(second.nodes);
    mesh.hexes.extend(second.hexes.iter().map(|h| h.map(|n| n + nodes)));
    let faces = surface
        .faces
        .iter()
        .map(|f| Face { nodes: f.nodes.map(|n| n + nodes), hex: f.hex + hexes })
        .collect();
    (mesh, Surface { faces, ..surface })
}
