//! Figures as plain data, written as SVG and PNG that look the same on every machine: the font
//! comes with the program.
//!
//! A [`Figure`] is a grid of [`Panel`]s with a caption below them; a panel has two axes, coloured
//! cells (a map), series of points, and vertical marks, all named in a legend above the plot, where
//! it can cover nothing.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod axis;
mod contour;
mod draw;
mod fill;
mod font;
mod thin;
mod write;

pub use axis::{Axis, Scale};
pub use contour::contour;
pub use fill::{Cell, Fill, Key, viridis};
pub use font::font_face;
pub use thin::thin;
pub use write::{FigureError, Format};

/// Colours that stay apart for the colour-blind and in greyscale (Okabe and Ito 2008).
pub mod colour {
    /// Black.
    pub const BLACK: [u8; 3] = [0, 0, 0];
    /// Grey, for bounds and references.
    pub const GREY: [u8; 3] = [130, 130, 130];
    /// Blue.
    pub const BLUE: [u8; 3] = [0, 114, 178];
    /// Vermilion.
    pub const RED: [u8; 3] = [213, 94, 0];
    /// Bluish green.
    pub const GREEN: [u8; 3] = [0, 158, 115];
    /// Reddish purple.
    pub const PURPLE: [u8; 3] = [204, 121, 167];
    /// Orange.
    pub const ORANGE: [u8; 3] = [230, 159, 0];
}

/// A grid of panels.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Width and height (points of 1/96 inch, as in SVG).
    pub size: [u32; 2],
    /// Panels in a row.
    pub columns: usize,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Text below the panels, broken into lines as it needs; may be empty.
    pub caption: String,
}

/// A plot.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Title above it; may be empty.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Coloured cells under the series.
    pub fill: Option<Fill>,
    /// What is drawn, later ones on top.
    pub series: Vec<Series>,
    /// Vertical lines.
    pub marks: Vec<Mark>,
}

/// Points joined by a line, or dots.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend; none if empty.
    pub label: String,
    /// The points in data units; those that are not finite interrupt the line.
    pub points: Vec<[f64; 2]>,
    /// How they are drawn.
    pub draw: Draw,
}

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Draw {
    /// A line of a colour.
    Line([u8; 3]),
    /// A dashed line of a colour.
    Dashed([u8; 3]),
    /// Dots of a colour and a radius (points).
    Dots([u8; 3], f64),
}

/// A vertical dashed line at a place of note.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Where (data units).
    pub x: f64,
    /// Name in the legend; none if empty.
    pub label: String,
    /// Colour.
    pub colour: [u8; 3],
}
