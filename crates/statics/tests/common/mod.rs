//! A block that is large beside the contact, on its own mirror image: two equal half-spaces but
//! for the finite size of the block and of the elements.
#![allow(dead_code)]

use mesh::{Mesh, graded_block, graded_line};
use solid::{Element, Material, element_stiffness};
use statics::{Axis, Influence, Point, Supports, SurfaceCompliance, Tied};
use std::collections::BTreeMap;

pub const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };

/// E*: two equal bodies, 1/E* = 2 (1 - nu^2)/E.
pub fn contact_modulus(m: &Material) -> f64 {
    m.young / (2.0 * (1.0 - m.poisson * m.poisson))
}

/// How the block continues across y.
#[derive(Clone, Copy, PartialEq)]
pub enum Lateral {
    /// Both sides of y = 0.
    Full,
    /// y >= 0, the plane y = 0 one of symmetry.
    Symmetric,
    /// One slice of elements that cannot move along y.
    PlaneStrain,
}

pub struct Block {
    /// Size of the elements where contact may be (m).
    pub size: f64,
    /// Half extent of the potential contact along x and y (m).
    pub reach: [f64; 2],
    /// Depth of the fine elements (m).
    pub depth: f64,
    /// Half length, half width and height of the block (m).
    pub extent: f64,
    pub growth: f64,
    pub lateral: Lateral,
    pub material: Material,
}

impl Block {
    pub fn mesh(&self) -> Mesh {
        let Self { size: h, extent, growth, .. } = *self;
        let coarsest = 0.25 * extent;
        let whole = |r: f64| (r / h - 1e-9).ceil() * h;
        let line = |span, fine| graded_line(span, fine, h, growth, coarsest).unwrap();
        let [rx, ry] = self.reach.map(whole);
        let xs = line([-extent, extent], [-rx, rx]);
        let ys = match self.lateral {
            Lateral::Full => line([-extent, extent], [-ry, ry]),
            Lateral::Symmetric => line([0.0, extent], [0.0, ry]),
            Lateral::PlaneStrain => vec![0.0, h],
        };
        let zs = line([-extent, 0.0], [-whole(self.depth), 0.0]);
        graded_block([&xs, &ys, &zs]).unwrap()
    }

    fn supports(&self, mesh: &Mesh) -> Supports {
        let sets = &mesh.bodies[0].node_sets;
        let mut far = vec![&sets["z-"], &sets["x-"], &sets["x+"]];
        match self.lateral {
            Lateral::Full => far.extend([&sets["y-"], &sets["y+"]]),
            Lateral::Symmetric => far.push(&sets["y+"]),
            Lateral::PlaneStrain => {}
        }
        let mut held: Vec<u32> = far.into_iter().flatten().copied().collect();
        held.sort_unstable();
        held.dedup();
        let free = |n: &u32| held.binary_search(n).is_err();
        let axes = [Axis::Loaded(0.0), Axis::Moved(0.0), Axis::Loaded(0.0)];
        let tied = match self.lateral {
            Lateral::Full => Vec::new(),
            Lateral::Symmetric => sets["y-"]
                .iter()
                .copied()
                .filter(free)
                .map(|n| Tied { nodes: vec![n], axes })
                .collect(),
            Lateral::PlaneStrain => sets["y-"]
                .iter()
                .zip(&sets["y+"])
                .filter(|(n, _)| free(n))
                .map(|(&a, &b)| Tied { nodes: vec![a, b], axes })
                .collect(),
        };
        Supports { held, tied }
    }

    /// The block on its mirror image; `gap` is that of the undeformed surfaces at (x, y). On a
    /// plane of symmetry forces, areas and loads are those of the half; in plane strain those of
    /// the slice of width [`size`](Self::size).
    pub fn influence(&self, gap: impl Fn(f64, f64) -> f64) -> Influence {
        let mesh = self.mesh();
        let element =
            |x: &[[f64; 3]; 8], m: &Material| element_stiffness(x, m, Element { hourglass: 0.05 });
        let mut areas = BTreeMap::new();
        for face in &mesh.bodies[0].surfaces["z+"].faces {
            let shares = mesh::quad_corner_areas(&face.nodes.map(|n| mesh.nodes[n as usize]));
            for (node, share) in face.nodes.iter().zip(shares) {
                *areas.entry(*node).or_insert(0.0) += share;
            }
        }
        let slack = 1e-6 * self.size;
        let slice = self.lateral == Lateral::PlaneStrain;
        let points: Vec<Point> = areas
            .into_iter()
            .filter(|(n, _)| {
                let [x, y, _] = mesh.nodes[*n as usize];
                let across = if slice { y < slack } else { y.abs() <= self.reach[1] + slack };
                x.abs() <= self.reach[0] + slack && across
            })
            .map(|(node, area)| {
                let at = mesh.nodes[node as usize];
                let area = if slice { 2.0 * area } else { area };
                Point { node, at, area, gap: gap(at[0], at[1]) }
            })
            .collect();
        let nodes: Vec<u32> = points.iter().map(|p| p.node).collect();
        let start = std::time::Instant::now();
        let compliance = SurfaceCompliance::new(
            &mesh,
            &[self.material],
            &element,
            &self.supports(&mesh),
            &nodes,
        )
        .unwrap();
        let size = compliance.size();
        println!(
            "  {} elements, {} unknowns, {:.1} M entries, {} points: {:.2} s",
            mesh.hexes.len(),
            size.unknowns,
            size.entries as f64 * 1e-6,
            points.len(),
            start.elapsed().as_secs_f64()
        );
        Influence::mirrored(&compliance, points).unwrap()
    }
}
