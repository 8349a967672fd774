//! Coloured cells: maps over a surface, diagrams over space and time.

use crate::Scale;

/// A rectangle of one colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Lower left corner (data units).
    pub low: [f64; 2],
    /// Upper right corner.
    pub high: [f64; 2],
    /// Its colour.
    pub colour: [u8; 3],
}

/// Cells and what their colours mean.
#[derive(Clone, Debug)]
pub struct Fill {
    /// The cells, later ones on top.
    pub cells: Vec<Cell>,
    /// The legend.
    pub key: Key,
}

/// What colours mean.
#[derive(Clone, Debug)]
pub enum Key {
    /// A range of values in the colours of [`viridis`].
    Values {
        /// Name with unit.
        label: String,
        /// Ends of the colours.
        range: [f64; 2],
        /// Linear or logarithmic.
        scale: Scale,
    },
    /// A few classes, each with its name and colour.
    Classes(Vec<(String, [u8; 3])>),
}

impl Key {
    /// The colour of a value; values beyond the ends have the colour of the end. Classes have
    /// colours of their own: black.
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

/// The colour map viridis (van der Walt and Smith 2015) from 0 to 1: its lightness rises evenly, so
/// that it survives colour blindness and print in grey.
pub fn viridis(share: f64) -> [u8; 3] {
    const STOPS: [[u8; 3]; 9] = [
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
