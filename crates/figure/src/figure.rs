//! What a figure shows, as plain data.

use crate::{Axis, Fill};

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
