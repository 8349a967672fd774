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

/// The mesh: a fine zone where contact passes, graded to coarse elements elsewhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Meshing {
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
        Self { growth: 1.35, coarsest: 0.05, plane_strain: false, zone: Zone::default() }
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
