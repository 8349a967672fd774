//! The pressure of a patch: Hertz's, or values at points.

use crate::ellipse::Ellipse;

/// The pressure that a patch takes along over the material.
#[derive(Clone, Debug, PartialEq)]
pub enum Patch {
    /// Hertz's.
    Ellipse(Ellipse),
    /// Values at points.
    Field(PressureField),
}

/// Pressure at the points of a grid, of which each bears that of the square around it.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureField {
    /// Spacing (m), that of the points of the material.
    pub spacing: f64,
    /// The first point along x and y, in spacings from the point of reference.
    pub first: [i64; 2],
    /// Points along x and y.
    pub points: [usize; 2],
    /// Pressure (Pa), x fastest.
    pub pressure: Vec<f64>,
}

impl PressureField {
    /// The field without the lines and columns at its ends that bear nothing.
    #[must_use]
    pub fn trimmed(&self) -> Self {
        let [nx, ny] = self.points;
        let (mut low, mut high) = ([nx, ny], [0, 0]);
        for (k, _) in self.pressure.iter().enumerate().filter(|(_, p)| **p > 0.0) {
            for (axis, at) in [k % nx, k / nx].into_iter().enumerate() {
                low[axis] = low[axis].min(at);
                high[axis] = high[axis].max(at + 1);
            }
        }
        let points = [0, 1].map(|axis| high[axis].saturating_sub(low[axis]));
        let row = |j: usize| &self.pressure[nx * j + low[0]..][..points[0]];
        Self {
            spacing: self.spacing,
            first: [0, 1].map(|axis| self.first[axis] + low[axis] as i64),
            points,
            pressure: (low[1]..low[1] + points[1]).flat_map(row).copied().collect(),
        }
    }

    /// Mean pressure over the square of a point of the material: of the two columns between which it lies, in the share of each.
    fn mean_pressure(&self, at: [f64; 2]) -> f64 {
        let [nx, ny] = self.points;
        let [x, y] = at.map(|x| x / self.spacing);
        let line = y.round() as i64 - self.first[1];
        let along = x - self.first[0] as f64;
        let (column, part) = (along.floor(), along - along.floor());
        let value = |column: i64| {
            let inside = (0..nx as i64).contains(&column) && (0..ny as i64).contains(&line);
            if inside { self.pressure[column as usize + nx * line as usize] } else { 0.0 }
        };
        (1.0 - part) * value(column as i64) + part * value(column as i64 + 1)
    }
}

impl From<Ellipse> for Patch {
    fn from(ellipse: Ellipse) -> Self {
        Self::Ellipse(ellipse)
    }
}

impl Patch {
    /// Rear and front along x, relative to the point of reference (m).
    pub(crate) fn along(&self) -> [f64; 2] {
        match self {
            Self::Ellipse(ellipse) => [-ellipse.half_length, ellipse.half_length],
            Self::Field(field) => field.ends(0),
        }
    }

    /// The two ends along y; none in plane strain.
    pub(crate) fn across(&self) -> Option<[f64; 2]> {
        match self {
            Self::Ellipse(ellipse) => ellipse.half_width.map(|b| [-b, b]),
            Self::Field(field) => Some(field.ends(1)),
        }
    }

    /// Largest pressure (Pa).
    pub fn peak_pressure(&self) -> f64 {
        match self {
            Self::Ellipse(ellipse) => ellipse.peak_pressure,
            Self::Field(field) => field.pressure.iter().fold(0.0, |most: f64, p| most.max(*p)),
        }
    }

    /// Mean pressure (Pa) over the square of side `h` (m) about a point relative to the point of reference.
    pub(crate) fn mean_pressure(&self, at: [f64; 2], h: f64) -> f64 {
        match self {
            Self::Ellipse(ellipse) => ellipse.mean_pressure(at, h),
            Self::Field(field) => field.mean_pressure(at),
        }
    }
}

impl PressureField {
    fn ends(&self, axis: usize) -> [f64; 2] {
        let first = self.first[axis] as f64 - 0.5;
        [first, first + self.points[axis] as f64].map(|x| x * self.spacing)
    }
}
