//! Coloured cells: maps over a surface, diagrams over space and time.

use crate::chart::Scale;

/// A rectangle of one colour, with sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Lower left corner (x, y) in the units of the axes.
    pub low: [f64; 2],
    /// Upper right corner (x, y).
    pub high: [f64; 2],
    /// Its colour: red, green, blue, 0 to 255.
    pub colour: [u8; 3],
}

/// A quadrilateral of one colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Its corners (x, y) in the units of the axes, in order around it.
    pub corners: [[f64; 2]; 4],
    /// Its colour: red, green, blue, 0 to 255.
    pub colour: [u8; 3],
}

/// Cells and what their colours mean.
#[derive(Clone, Debug)]
pub struct Fill {
    /// The cells, later ones on top.
    pub cells: Vec<Cell>,
    /// What their colours mean, shown above the plot.
    pub key: Key,
}

/// What colours mean.
#[derive(Clone, Debug)]
pub enum Key {
    /// A range of values, coloured by [`viridis`].
    Values {
        /// Name of the quantity with its unit.
        label: String,
        /// Values of the first and of the last colour; both positive on a logarithmic scale.
        range: [f64; 2],
        /// Whether the colours follow the value or its logarithm.
        scale: Scale,
    },
    /// A few classes, each with its name and colour.
    Classes(Vec<(String, [u8; 3])>),
}

impl Key {
    /// The colour of a value. Beyond an end of the range it is that of the end; of NaN, that of the lower end.
    /// Black for [`Key::Classes`], which have no colour by value.
    pub fn colour(&self, value: f64) -> [u8; 3] {
        match self {
            Self::Values { range: [low, high], scale: Scale::Linear, .. } => {
                viridis((value - low) / (high - low))
            }
            Self::Values { range: [low, high], scale: Scale::Log, .. } => {
                viridis(libm::log(value / low) / libm::log(high / low))
            }
            Self::Classes(_) => [0; 3],
        }
    }
}

/// Colours of [`viridis`], evenly spaced from its lower to its upper end.
pub(crate) const STOPS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// The colour map viridis (van der Walt and Smith 2015) at `share`, 0 to 1 and clamped to it; NaN counts as 0.
/// Its lightness rises evenly, so that it remains legible with colour blindness and in grey print. Linear
/// between nine of its colours.
pub fn viridis(share: f64) -> [u8; 3] {
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    let place = share * (STOPS.len() - 1) as f64;
    let below = (place as usize).min(STOPS.len() - 2);
    let part = place - below as f64;
    [0, 1, 2].map(|i| {
        let (from, to) = (f64::from(STOPS[below][i]), f64::from(STOPS[below + 1][i]));
        (from + part * (to - from)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lightness_of_the_colour_map_rises_all_the_way() {
        let light = |share: f64| {
            let [r, g, b] = viridis(share).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let shades: Vec<f64> = (0..=40).map(|i| light(f64::from(i) / 40.0)).collect();
        assert!(shades.windows(2).all(|w| w[1] > w[0]), "{shades:?}");
    }

    #[test]
    fn values_beyond_the_range_and_no_numbers_have_a_colour() {
        let key = Key::Values { label: String::new(), range: [0.1, 10.0], scale: Scale::Log };
        assert_eq!(key.colour(1e-9), viridis(0.0));
        assert_eq!(key.colour(1e9), viridis(1.0));
        assert_eq!(key.colour(f64::NAN), viridis(0.0));
        assert_eq!(key.colour(1.0), viridis(0.5));
    }
}
