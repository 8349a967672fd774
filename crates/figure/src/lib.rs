//! Figures as plain data, written as SVG and PNG that look the same on every machine: the font
//! comes with the program.
//!
//! A [`Figure`] is a grid of [`Panel`]s with a caption below them; a panel has two axes, coloured
//! cells (a map), series of points, and vertical marks, all named in a legend above the plot, where
//! it can cover nothing. A [`Picture`] shows surfaces in space.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod arrow;
mod axes;
mod axis;
mod contour;
mod draw;
mod figure;
mod fill;
mod film;
mod font;
mod label;
mod layout;
mod legend;
mod palette;
mod picture;
mod raster;
mod thin;
mod write;

pub use axis::{Axis, Scale};
pub use contour::contour;
pub use figure::{Draw, Figure, Mark, Panel, Series};
pub use fill::{Cell, Fill, Key, viridis};
pub use film::{Film, FilmError, FilmFormat};
pub use font::font_face;
pub use picture::{Camera, Pane, Picture, PictureError, Pixels, Surface, round_down};
pub use thin::thin;
pub use write::{FigureError, Format};

/// Colours (red, green, blue; 0 to 255) that stay apart for the colour-blind (Okabe and Ito 2008).
pub mod colour {
    /// Black.
    pub const BLACK: [u8; 3] = [0, 0, 0];
    /// Grey, for bounds and references.
    pub const GREY: [u8; 3] = [130, 130, 130];
    /// Blue.
    pub const BLUE: [u8; 3] = [0, 114, 178];
    /// Vermilion.
    pub const VERMILION: [u8; 3] = [213, 94, 0];
    /// Bluish green.
    pub const GREEN: [u8; 3] = [0, 158, 115];
    /// Reddish purple.
    pub const PURPLE: [u8; 3] = [204, 121, 167];
    /// Orange.
    pub const ORANGE: [u8; 3] = [230, 159, 0];
}
