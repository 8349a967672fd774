//! The unit of a file's coordinates.

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unit {
    /// Metre.
    #[default]
    Metre,
    /// Centimetre.
    Centimetre,
    /// Millimetre.
    Millimetre,
    /// International inch, 25.4 mm.
    Inch,
}

impl Unit {
    /// All units.
    pub const ALL: [Self; 4] = [Self::Metre, Self::Centimetre, Self::Millimetre, Self::Inch];

    /// Its symbol.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Inch => "in",
        }
    }

    /// The length `x` of this unit in metres; for centimetres and millimetres by division, so that 460 mm give
    /// exactly the number 0.46.
    pub fn metres(self, x: f64) -> f64 {
        match self {
            Self::Metre => x,
            Self::Centimetre => x / 100.0,
            Self::Millimetre => x / 1000.0,
            Self::Inch => x * 0.0254,
        }
    }
}
