//! The exact surfaces on which the nodes of generated faces lie.

use crate::profile::Section;
use nalgebra::{UnitVector3, Vector3};
use std::sync::Arc;

/// An exact surface in the undeformed state, by which contact on facets is corrected for curvature.
#[derive(Clone, Debug, PartialEq)]
pub enum SmoothSurface {
    /// Outside of a disk that turns about the line through `centre` parallel to `y`.
    Tread {
        /// Centre of the disk (m); its `y` is that of the crown's apex.
        centre: Vector3<f64>,
        /// Rolling radius at the apex (m).
        radius: f64,
        /// Transverse radius of the crown (m); `None` for a straight tread.
        crown: Option<f64>,
    },
    /// Top of a bar along `x`.
    Top {
        /// Height `z` of the apex, which lies at `y = 0` (m).
        apex: f64,
        /// Transverse radius of the crown (m); `None` for a flat top.
        crown: Option<f64>,
    },
    /// Outside of a disk with a profile, which turns about the line through `centre` parallel to `y`.
    ProfiledTread {
        /// Centre of the disk (m); its `y` is that of the section's middle.
        centre: Vector3<f64>,
        /// Rolling radius at the section's middle (m).
        radius: f64,
        /// Its lowest line, across.
        section: Arc<Section>,
    },
    /// Top of a bar along `x` with a profile.
    ProfiledTop {
        /// Its section, whose middle lies at `y = 0`, `z = 0`.
        section: Arc<Section>,
    },
}

impl SmoothSurface {
    /// Signed distance (m) from `p` (m), a point near the surface, to the surface: positive inside the body.
    pub fn offset(&self, p: Vector3<f64>) -> f64 {
        match self {
            Self::ProfiledTread { centre, radius, section } => {
                section.inside_tread(*radius, p - centre)
            }
            Self::ProfiledTop { section } => section.below_top(p),
            &Self::Tread { centre, radius, crown } => {
                let rho = libm::hypot(p.x - centre.x, p.z - centre.z);
                match crown {
                    None => radius - rho,
                    Some(c) => c - libm::hypot(rho - (radius - c), p.y - centre.y),
                }
            }
            &Self::Top { apex, crown } => match crown {
                None => apex - p.z,
                Some(c) => c - libm::hypot(p.z - (apex - c), p.y),
            },
        }
    }

    /// Outward unit normal at the closest-point projection of `p` (m), a point near the surface: the negative
    /// gradient of [`offset`](Self::offset). NaN on the axis of a tread.
    pub fn normal(&self, p: Vector3<f64>) -> UnitVector3<f64> {
        UnitVector3::new_unchecked(match self {
            Self::ProfiledTread { centre, radius, section } => {
                section.tread_normal(*radius, p - centre)
            }
            Self::ProfiledTop { section } => section.top_normal(p),
            &Self::Tread { centre, radius, crown } => {
                let (dx, dz) = (p.x - centre.x, p.z - centre.z);
                let rho = libm::hypot(dx, dz);
                match crown {
                    None => Vector3::new(dx / rho, 0.0, dz / rho),
                    Some(c) => {
                        let (a, b) = (rho - (radius - c), p.y - centre.y);
                        let d = libm::hypot(a, b);
                        Vector3::new(a / d * dx / rho, b / d, a / d * dz / rho)
                    }
                }
            }
            &Self::Top { apex, crown } => match crown {
                None => Vector3::z(),
                Some(c) => {
                    let (a, b) = (p.z - (apex - c), p.y);
                    let d = libm::hypot(a, b);
                    Vector3::new(0.0, b / d, a / d)
                }
            },
        })
    }
}
