//! Shared problems, and the limits of the verification tests: what the convergence with the mesh demonstrates.
#![allow(dead_code)]

use solid::{Element, Material, element_stiffness};
use statics::{Block, Influence, Lateral};

pub const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };

pub fn element(x: &[[f64; 3]; 8], m: &Material) -> [[f64; 24]; 24] {
    element_stiffness(x, m, Element { hourglass: 0.05 })
}

/// Hertz's sphere on a flat, R = 0.1 m, 10 kN: half axis (m).
pub const SPHERE: f64 = 1.8663e-3;

/// Gap of that sphere with its apex at x and y (m).
pub fn sphere_gap([apex_x, apex_y]: [f64; 2]) -> impl Fn(f64, f64) -> f64 {
    move |x, y| ((x - apex_x).powi(2) + (y - apex_y).powi(2)) / 0.2
}

/// The same on a half block: the apex stays on the plane of symmetry.
pub fn half_sphere_gap([apex, _]: [f64; 2]) -> impl Fn(f64, f64) -> f64 {
    sphere_gap([apex, 0.0])
}

/// The block under it; the whole mesh is refined with `size`, its grading too.
pub fn sphere(size: f64, extent: f64, lateral: Lateral, material: Material) -> Influence {
    let coarse = SPHERE / 4.0;
    Block {
        size,
        reach: [1.3 * SPHERE, 1.3 * SPHERE],
        depth: SPHERE,
        extent,
        growth: 1.7f64.powf(size / coarse),
        lateral,
        material,
    }
    .influence(&element, sphere_gap([0.0; 2]))
    .unwrap()
}

/// Half axes of the reference ellipse (m): R 0.46 m along x, 0.30 m across, 100 kN.
pub const ELLIPSE: [f64; 2] = [7.1617e-3, 5.3872e-3];

/// Gap of the reference wheel and crown with its apex at x (m), on a half block.
pub fn ellipse_gap([apex, _]: [f64; 2]) -> impl Fn(f64, f64) -> f64 {
    move |x, y| (x - apex).powi(2) / 0.92 + y * y / 0.60
}

/// The half block under the reference ellipse.
pub fn ellipse(size: f64, extent: f64) -> Influence {
    Block {
        size,
        reach: [1.3 * ELLIPSE[0], 1.3 * ELLIPSE[1]],
        depth: ELLIPSE[1],
        extent,
        growth: 1.7f64.powf(size / 1.4e-3),
        lateral: Lateral::Symmetric,
        material: STEEL,
    }
    .influence(&element, ellipse_gap([0.0; 2]))
    .unwrap()
}

/// Mean of what `measure` finds with the apex at four places within one cell of the grid: which nodes the edge
/// of a patch takes in changes with its place on the grid, by a few percent on these coarse grids,
/// and is no part of the convergence.
pub fn over_a_pitch<const N: usize, G: Fn(f64, f64) -> f64>(
    influence: &Influence,
    pitch: f64,
    gap: impl Fn([f64; 2]) -> G,
    measure: impl Fn(&Influence) -> [f64; N],
) -> [f64; N] {
    // Each row and each column of a 4 x 4 subdivision of the cell once.
    let places = [[-0.375, -0.125], [-0.125, 0.375], [0.125, -0.375], [0.375, 0.125]];
    let places = places.map(|place| place.map(|s| s * pitch));
    let found = places.map(|apex| measure(&influence.with_gaps(gap(apex))));
    std::array::from_fn(|k| found.iter().map(|f| f[k]).sum::<f64>() / found.len() as f64)
}

/// A result on meshes whose sizes fall by one ratio.
pub struct Converging {
    pub what: String,
    pub ratio: f64,
    pub values: Vec<f64>,
    /// What the finite body may change, as a fraction.
    pub body: f64,
}

impl Converging {
    /// Results on three meshes or more, the coarsest first.
    pub fn new(what: impl Into<String>, ratio: f64, values: Vec<f64>, body: f64) -> Self {
        assert!(values.len() > 2);
        Self { what: what.into(), ratio, values, body }
    }

    /// What the three finest meshes leave open: Roache's (1994) grid convergence index, the first
    /// order error extrapolated from the last two with the safety factor 1.25, or half the range
    /// of all three where they oscillate (Stern et al. 2001).
    ///
    /// First order is that of the method: slip is a difference over one pitch of forces that act
    /// at its ends, and the patch ends between two nodes.
    pub fn uncertainty(&self) -> f64 {
        let [a, b, c] = self.finest();
        let index = 1.25 * (c - b).abs() / (self.ratio - 1.0);
        let range = a.max(b).max(c) - a.min(b).min(c);
        if (b - a) * (c - b) < 0.0 { index.max(0.5 * range) } else { index }
    }

    fn finest(&self) -> [f64; 3] {
        let n = self.values.len();
        [self.values[n - 3], self.values[n - 2], self.values[n - 1]]
    }

    /// The value extrapolated to size zero with first order.
    pub fn extrapolated(&self) -> f64 {
        let [_, b, c] = self.finest();
        c + (c - b) / (self.ratio - 1.0)
    }

    /// Observed order of the last three: ln((a - b)/(b - c))/ln(ratio); NaN where they oscillate.
    pub fn order(&self) -> f64 {
        let [a, b, c] = self.finest();
        ((a - b) / (b - c)).ln() / self.ratio.ln()
    }

    /// The value extrapolated to size zero agrees with the reference within what the meshes and
    /// the finite body leave open, and the meshes approach it.
    pub fn agrees(&self, reference: f64) {
        let percent = |v: f64| 100.0 * (v / reference - 1.0);
        let error = self.extrapolated() / reference - 1.0;
        let limit = (self.uncertainty() / reference).abs() + self.body;
        let meshes: Vec<String> =
            self.values.iter().map(|v| format!("{:+.2}", percent(*v))).collect();
        println!(
            "{}: {:.5e} of {reference:.5e} ({:+.2} %, limit {:.2} %), meshes {} %, order {:.1}",
            self.what,
            self.extrapolated(),
            100.0 * error,
            100.0 * limit,
            meshes.join(" "),
            self.order(),
        );
        assert!(error.abs() <= limit, "{}: off by {error:.4}, limit {limit:.4}", self.what);
        assert!(limit < 0.25, "{}: the meshes leave {limit:.3} open", self.what);
    }

    /// The finest mesh itself is within a fraction of the reference that a specification asks for.
    pub fn within(&self, fraction: f64, reference: f64) {
        let error = self.finest()[2] / reference - 1.0;
        assert!(error.abs() <= fraction, "{}: off by {error:.4}", self.what);
    }

    /// The extrapolated value is within a fraction that a specification asks for.
    pub fn extrapolated_within(&self, fraction: f64, reference: f64) {
        let error = self.extrapolated() / reference - 1.0;
        assert!(error.abs() <= fraction, "{}: off by {error:.4}", self.what);
    }
}
