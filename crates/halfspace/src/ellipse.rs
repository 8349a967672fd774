//! The pressure of a patch.

/// The pressure of Hertz's contact: an ellipse, or in plane strain a strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Half axis along x (m).
    pub half_length: f64,
    /// Half axis along y (m); `None` in plane strain.
    pub half_width: Option<f64>,
    /// Largest pressure (Pa).
    pub peak_pressure: f64,
}

impl Ellipse {
    /// Mean pressure (Pa) over a square of the side `h` (m; in plane strain over the length h) about a point relative to the
    /// centre (m): so that a patch that moves over the points bears the same load at any place.
    ///
    /// Exact along x; across by the midpoint rule on four lines.
    pub fn mean_pressure(&self, [x, y]: [f64; 2], h: f64) -> f64 {
        let a = self.half_length;
        // of the integral of sqrt(c^2 - x^2)
        let area = |x: f64, c: f64| {
            let x = x.clamp(-c, c);
            0.5 * (x * (c * c - x * x).max(0.0).sqrt() + c * c * libm::asin(x / c))
        };
        let line = |inside: f64| {
            if inside <= 0.0 {
                return 0.0;
            }
            let c = a * inside.sqrt();
            self.peak_pressure / a * (area(x + 0.5 * h, c) - area(x - 0.5 * h, c)) / h
        };
        let Some(b) = self.half_width else { return line(1.0) };
        let across = (0..LINES).map(|i| y + ((f64::from(i) + 0.5) / f64::from(LINES) - 0.5) * h);
        across.map(|y| line(1.0 - (y / b).powi(2))).sum::<f64>() / f64::from(LINES)
    }
}

/// Lines across a square over which the pressure is taken.
const LINES: u32 = 4;
