//! The keys of the two bodies and of their mesh.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::forms::Crown;

/// The disk: an annulus with a rigid hub, rolling in +x.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Disk {
    /// Rolling radius (m). Default 0.46.
    pub radius: f64,
    /// Radius of the rigid hub (m). Default 0.10.
    pub hub_radius: f64,
    /// Width in y (m). Default 0.06.
    pub width: f64,
    /// Transverse radius of the tread (m), or `"flat"` for a straight tread. Default `"flat"`.
    pub crown_radius: Crown,
    /// Height of the undeformed disk above touching at the start (m). Default 0. Above zero only
    /// with `preload.method = "none"`: a disk that does not touch cannot be preloaded.
    pub lift: f64,
    /// Material keys in which the disk differs from `[material]`. Default: none.
    #[serde(skip_serializing_if = "MaterialOverride::is_empty")]
    pub material: MaterialOverride,
}

impl Default for Disk {
    fn default() -> Self {
        Self {
            radius: 0.46,
            hub_radius: 0.10,
            width: 0.06,
            crown_radius: Crown::Flat,
            lift: 0.0,
            material: MaterialOverride::default(),
        }
    }
}

impl Disk {
    /// The shape to mesh.
    pub(crate) fn shape(&self) -> mesh::Disk {
        mesh::Disk {
            radius: self.radius,
            hub_radius: self.hub_radius,
            width: self.width,
            crown: self.crown_radius.radius(),
        }
    }
}

/// The bar: clamped at its bottom, its top's apex at z = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Bar {
    /// Length in x (m). Default 0.24.
    pub length: f64,
    /// Width in y (m). Default 0.06.
    pub width: f64,
    /// Height from the clamped bottom to the top's apex (m). Default 0.07.
    pub height: f64,
    /// Transverse radius of the top (m), or `"flat"`. Default 0.30.
    pub crown_radius: Crown,
    /// x of the bar's rear end (m); rolling starts at x = 0. Default -0.09.
    pub start: f64,
    /// `"quiet"` (Lysmer's viscous boundary, waves leave) or `"free"` ends. Default `"quiet"`.
    pub ends: Ends,
    /// Material keys in which the bar differs from `[material]`. Default: none.
    #[serde(skip_serializing_if = "MaterialOverride::is_empty")]
    pub material: MaterialOverride,
}

impl Default for Bar {
    fn default() -> Self {
        Self {
            length: 0.24,
            width: 0.06,
            height: 0.07,
            crown_radius: Crown::Radius(0.30),
            start: -0.09,
            ends: Ends::Quiet,
            material: MaterialOverride::default(),
        }
    }
}

impl Bar {
    /// The shape to mesh.
    pub(crate) fn shape(&self) -> mesh::Bar {
        mesh::Bar {
            length: self.length,
            width: self.width,
            height: self.height,
            crown: self.crown_radius.radius(),
            start: self.start,
        }
    }
}

/// The two ends of the bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Ends {
    /// Lysmer's viscous boundary: waves leave the model.
    #[default]
    Quiet,
    /// No traction: waves are reflected.
    Free,
}

/// An isotropic elastic material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Material {
    /// Young's modulus (Pa). Default 210e9.
    pub young: f64,
    /// Poisson's ratio (dimensionless). Default 0.3.
    pub poisson: f64,
    /// Density (kg/m^3). Default 7800.
    pub density: f64,
}

impl Default for Material {
    fn default() -> Self {
        Self { young: 210e9, poisson: 0.3, density: 7800.0 }
    }
}

/// Those keys of a [`Material`] in which one body differs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MaterialOverride {
    /// Young's modulus of this body (Pa). Default: `material.young`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub young: Option<f64>,
    /// Poisson's ratio of this body (dimensionless). Default: `material.poisson`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poisson: Option<f64>,
    /// Density of this body (kg/m^3). Default: `material.density`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
}

impl MaterialOverride {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// These keys over those of `[material]`.
    pub(crate) fn over(&self, common: Material) -> Material {
        Material {
            young: self.young.unwrap_or(common.young),
            poisson: self.poisson.unwrap_or(common.poisson),
            density: self.density.unwrap_or(common.density),
        }
    }
}

/// The mesh: a fine zone where contact passes, graded to coarse elements elsewhere; or a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Meshing {
    /// Mesh of another program, relative to this file: Gmsh `.msh`, Abaqus `.inp` or `.vtu`. `[disk]`,
    /// `[bar]` and `mesh.zone` then say what the mesh is, and must agree with it; `growth`, `coarsest`
    /// and `zone.depth` are without meaning. Default: the mesh is generated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// SHA-256 of the file, in hexadecimal. Written into the case of a run, so that no other mesh
    /// takes its place unseen. Default with `file`: that of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// Unit of the file's coordinates: `"m"`, `"cm"`, `"mm"` or `"in"`. Default with `file`: `"m"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<LengthUnit>,
    /// Names of the sets in the file.
    #[serde(skip_serializing_if = "MeshSets::is_empty")]
    pub sets: MeshSets,
    /// Ratio of neighbouring element sizes outside the fine zone (dimensionless). Default 1.35.
    pub growth: f64,
    /// Largest element size (m). Default 0.05.
    pub coarsest: f64,
    /// Whether no node moves in y (true or false): plane strain, the contact of two cylinders, by a
    /// slice one element wide. Both bodies and the fine zone must then be flat across and of one
    /// width, which only scales the forces; one near that of the coarsest elements keeps these well
    /// shaped. Default false.
    pub plane_strain: bool,
    /// The fine zone.
    pub zone: Zone,
}

impl Default for Meshing {
    fn default() -> Self {
        Self {
            file: None,
            sha256: None,
            unit: None,
            sets: MeshSets::default(),
            growth: 1.35,
            coarsest: 0.05,
            plane_strain: false,
            zone: Zone::default(),
        }
    }
}

impl Meshing {
    /// The fine zone and the grading around it.
    pub(crate) fn fine_zone(&self) -> mesh::FineZone {
        let Zone { size, length, width, depth, start } = self.zone;
        mesh::FineZone {
            size,
            length,
            width,
            depth,
            start,
            growth: self.growth,
            coarsest: self.coarsest,
        }
    }
}

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum LengthUnit {
    /// Metre.
    #[default]
    #[serde(rename = "m")]
    Metre,
    /// Centimetre.
    #[serde(rename = "cm")]
    Centimetre,
    /// Millimetre.
    #[serde(rename = "mm")]
    Millimetre,
    /// Inch.
    #[serde(rename = "in")]
    Inch,
}

/// Names of the sets in a mesh file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MeshSets {
    /// The disk's elements. Default with `mesh.file`: `"disk"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub disk: Option<String>,
    /// The bar's elements. Default with `mesh.file`: `"bar"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bar: Option<String>,
    /// Nodes or faces of the rigid hub. Default with `mesh.file`: `"hub"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hub: Option<String>,
    /// Faces or nodes of the disk's running surface. Default with `mesh.file`: `"tread"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tread: Option<String>,
    /// Faces or nodes of the bar's running surface. Default with `mesh.file`: `"top"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub top: Option<String>,
    /// Nodes or faces by which the bar is clamped. Default with `mesh.file`: `"clamp"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clamp: Option<String>,
}

impl MeshSets {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// The fine zone of both bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Zone {
    /// Element size in the fine zone (m); the one key that refines everything. Default 1e-3.
    pub size: f64,
    /// Length in x (m). Default 0.08.
    pub length: f64,
    /// Width in y, centred on y = 0 (m). Default 0.02.
    pub width: f64,
    /// Depth below the surface (m). Default 0.008.
    pub depth: f64,
    /// x of the zone's rear end (m); rolling starts at x = 0. Default -0.010.
    pub start: f64,
}

impl Default for Zone {
    fn default() -> Self {
        Self { size: 1e-3, length: 0.08, width: 0.02, depth: 0.008, start: -0.010 }
    }
}
