//! The gap of one slave.

use nalgebra::UnitVector3;

/// A slave node over its projection on the master surface.
///
/// To first order its gap changes by `n . (u_s - sum w_J u_J)`, with the nodes `J` of the master that its
/// projection is a mean of.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// The slave (mesh index).
    pub node: u32,
    /// The nodes of the master (mesh indices) and their weights `w_J`, which add up to one: the corners of
    /// the face under the slave, or the nodes that its mortar function meets.
    pub projection: Vec<(u32, f64)>,
    /// Unit normal of the master surface at the projection, out of the master body. From a
    /// [`GapFunction`](crate::GapFunction) it is continuous over the surface: the mean of the facets' normals at each
    /// corner, interpolated, or the mortar function's mean; from
    /// [`PenaltyContact::springs`](crate::PenaltyContact::springs) it is the facet's.
    pub normal: UnitVector3<f64>,
    /// Gap (m), negative where the slave has penetrated.
    pub gap: f64,
    /// Tributary area of the slave in the reference configuration (m^2).
    pub area: f64,
    /// Nodes of the whole surface that it stands for: two where the slave has a mirror image, else one.
    pub nodes: usize,
}
