//! The exact surfaces on which the nodes of generated faces lie.

/// An exact surface in the undeformed state, by which contact on facets is corrected for curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SmoothSurface {
    /// Outside of a disk that turns about the line through `centre` parallel to `y`.
    Tread {
        /// Centre of the disk (m); its `y` is that of the crown's apex.
        centre: [f64; 3],
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
}

impl SmoothSurface {
    /// Signed distance (m) from `p` (m), a point near the surface, to the surface: positive inside the body.
    pub fn offset(&self, p: [f64; 3]) -> f64 {
        match *self {
            Self::Tread { centre, radius, crown } => {
                let rho = libm::hypot(p[0] - centre[0], p[2] - centre[2]);
                match crown {
                    None => radius - rho,
                    Some(c) => c - libm::hypot(rho - (radius - c), p[1] - centre[1]),
                }
            }
            Self::Top { apex, crown } => match crown {
                None => apex - p[2],
                Some(c) => c - libm::hypot(p[2] - (apex - c), p[1]),
            },
        }
    }

    /// Outward unit normal at the closest-point projection of `p` (m), a point near the surface: the negative
    /// gradient of [`offset`](Self::offset). NaN on the axis of a tread.
    pub fn normal(&self, p: [f64; 3]) -> [f64; 3] {
        match *self {
            Self::Tread { centre, radius, crown } => {
                let (dx, dz) = (p[0] - centre[0], p[2] - centre[2]);
                let rho = libm::hypot(dx, dz);
                match crown {
                    None => [dx / rho, 0.0, dz / rho],
                    Some(c) => {
                        let (a, b) = (rho - (radius - c), p[1] - centre[1]);
                        let d = libm::hypot(a, b);
                        [a / d * dx / rho, b / d, a / d * dz / rho]
                    }
                }
            }
            Self::Top { apex, crown } => match crown {
                None => [0.0, 0.0, 1.0],
                Some(c) => {
                    let (a, b) = (p[2] - (apex - c), p[1]);
                    let d = libm::hypot(a, b);
                    [0.0, b / d, a / d]
                }
            },
        }
    }
}
