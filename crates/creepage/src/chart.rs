//! Figures as plain data, written as SVG, PDF and PNG that look the same on every machine: the font
//! comes with the program.
//!
//! A [`Figure`] is a grid of [`Panel`]s with a caption below them; a panel has two axes, coloured
//! cells (a map), series of points, and vertical marks, all named in a legend above the plot, where
//! it can cover nothing.

mod arrow;
mod axes;
mod axis;
pub mod colour;
mod contour;
mod draw;
mod figure;
mod fill;
mod font;
mod group;
mod label;
mod layout;
mod legend;
mod palette;
mod paper;
mod pdf;
mod raster;
mod thin;
mod write;

pub use axis::{Axis, Scale};
pub use contour::contour;
pub use figure::{Draw, Figure, Mark, Panel, Series};
pub use fill::{Cell, Face, Fill, Key, viridis};
pub use font::font_face;
pub(crate) use label::{NO_BREAK, minus};
pub use paper::Paper;
pub(crate) use raster::Pixels;
pub use thin::thin;
pub use write::{FigureError, Format};
