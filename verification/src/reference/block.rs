//! Two equal half-spaces as finite bodies: a block that is large compared with the contact, pressed on its own
//! mirror image.

use crate::reference::sparse::{ElementStiffness, SparseError};
use crate::reference::{Influence, InfluenceError, Point, SurfaceCompliance};
use mesh::{Mesh, MeshError, graded_block, graded_line};
use nalgebra::Vector3;
use solid::Material;
use statics::{Axis, Supports, Tied};
use thiserror::Error;

/// Size of the largest elements over the half extent of the block.
const COARSEST: f64 = 0.25;

/// How the block continues across y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lateral {
    /// Both sides of y = 0.
    Full,
    /// y >= 0 alone, y = 0 being a plane of symmetry: forces, areas and loads are those of the
    /// half.
    Symmetric,
    /// One slice of elements, as wide as they are long, that cannot move along y: forces, areas
    /// and loads are those of the slice.
    PlaneStrain,
}

/// A block below z = 0 with its far sides held, finely meshed around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Size of the elements where contact may be (m).
    pub size: f64,
    /// Half extent of the potential contact along x and y (m), rounded up to whole elements; in plane strain y is not
    /// used.
    pub reach: [f64; 2],
    /// Depth of the fine elements (m), rounded up to whole elements.
    pub depth: f64,
    /// Half length, half width and height of the block (m).
    pub extent: f64,
    /// Ratio of successive element sizes outside the fine part.
    pub growth: f64,
    /// How the block continues across y.
    pub lateral: Lateral,
    /// Its material.
    pub material: Material,
}

/// Why a block has no influence matrix.
#[derive(Debug, Error)]
pub enum BlockError {
    /// Its mesh cannot be generated.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Its stiffness cannot be factored.
    #[error(transparent)]
    Sparse(#[from] SparseError),
    /// It has no contact points.
    #[error(transparent)]
    Influence(#[from] InfluenceError),
}

impl Block {
    /// The mesh of the block.
    ///
    /// # Errors
    /// [`MeshError`] for sizes of which no graded mesh can be made.
    pub fn mesh(&self) -> Result<Mesh, MeshError> {
        let Self { size: h, extent, growth, .. } = *self;
        let whole = |r: f64| ((r / h - 1e-9).ceil() * h).max(h);
        let line = |span, fine| graded_line(span, fine, h, growth, h.max(COARSEST * extent));
        let [rx, ry] = self.reach.map(whole);
        let xs = line([-extent, extent], [-rx, rx])?;
        let ys = match self.lateral {
            Lateral::Full => line([-extent, extent], [-ry, ry])?,
            Lateral::Symmetric => line([0.0, extent], [0.0, ry])?,
            Lateral::PlaneStrain => vec![0.0, h],
        };
        let zs = line([-extent, 0.0], [-whole(self.depth), 0.0])?;
        graded_block([&xs, &ys, &zs])
    }

    /// The far sides are held; on a plane of symmetry and in plane strain nodes cannot move along
    /// y, in plane strain those of both faces of the slice move together.
    fn supports(&self, mesh: &Mesh) -> Supports {
        let sets = &mesh.bodies[0].node_sets;
        let far: &[&str] = match self.lateral {
            Lateral::Full => &["z-", "x-", "x+", "y-", "y+"],
            Lateral::Symmetric => &["z-", "x-", "x+", "y+"],
            Lateral::PlaneStrain => &["z-", "x-", "x+"],
        };
        let mut held: Vec<u32> = far.iter().flat_map(|s| &sets[*s]).copied().collect();
        held.sort_unstable();
        held.dedup();
        let axes = [Axis::Loaded(0.0), Axis::Moved(0.0), Axis::Loaded(0.0)];
        let near = sets["y-"].iter().zip(&sets["y+"]);
        let free = |(near, _): &(&u32, &u32)| held.binary_search(near).is_err();
        let tied = match self.lateral {
            Lateral::Full => Vec::new(),
            Lateral::Symmetric => {
                near.filter(free).map(|(&n, _)| Tied { nodes: vec![n], axes }).collect()
            }
            Lateral::PlaneStrain => {
                near.filter(free).map(|(&n, &f)| Tied { nodes: vec![n, f], axes }).collect()
            }
        };
        Supports { held, tied, sliding: Vec::new() }
    }

    /// The influence matrix of the block and its mirror image ([`Influence::mirrored`]). `element` is the stiffness of
    /// an element; `gap` is the gap of the undeformed surfaces (m) at x and y (m).
    ///
    /// # Errors
    /// [`BlockError`]: no mesh, a stiffness that cannot be factored, or no node in the potential contact.
    pub fn influence(
        &self,
        element: &ElementStiffness<'_>,
        gap: impl Fn(f64, f64) -> f64,
    ) -> Result<Influence, BlockError> {
        let mesh = self.mesh()?;
        let slack = 1e-6 * self.size;
        let reach = self.reach.map(|r| ((r / self.size - 1e-9).ceil()) * self.size + slack);
        let slice = self.lateral == Lateral::PlaneStrain;
        let within = |at: Vector3<f64>| {
            let across = if slice { at.y < slack } else { at.y.abs() <= reach[1] };
            at.x.abs() <= reach[0] && across
        };
        let top = &mesh.bodies[0].surfaces["z+"];
        let mut points = Point::on_surface(&mesh, top, within, |at| gap(at.x, at.y));
        if slice {
            // A point stands for both of its tied nodes.
            points.iter_mut().for_each(|p| p.area *= 2.0);
        }
        let nodes: Vec<u32> = points.iter().map(|p| p.node).collect();
        let supports = self.supports(&mesh);
        let compliance =
            SurfaceCompliance::new(&mesh, &[self.material], element, &supports, &nodes)?;
        Ok(Influence::mirrored(&compliance, points)?)
    }
}
