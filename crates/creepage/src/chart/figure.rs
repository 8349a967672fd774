//! What a figure shows, as plain data.

use crate::chart::{Axis, Face, Fill};

/// A grid of panels.
///
/// All its texts may have subscripts, written as in TeX: `p_{n}`.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Width and height (points of 1/96 inch, as in SVG).
    pub size: [u32; 2],
    /// Number of panels in a row; zero counts as one.
    pub columns: usize,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Text below the panels, wrapped at the width of the figure; may be empty.
    pub caption: String,
}

/// One plot of a figure.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Title above it; may be empty.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Whether a unit is as long on one axis as on the other, as a map needs it; the range of one is then widened.
    pub to_scale: bool,
    /// Coloured cells under the series.
    pub fill: Option<Fill>,
    /// Faces over the cells, later ones on top.
    pub faces: Vec<Face>,
    /// The series, later ones on top.
    pub series: Vec<Series>,
    /// Vertical lines, under the series.
    pub marks: Vec<Mark>,
}

impl Panel {
    /// A panel without content.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            title: String::new(),
            x,
            y,
            to_scale: false,
            fill: None,
            faces: Vec::new(),
            series: Vec::new(),
            marks: Vec::new(),
        }
    }
}

/// Points joined by a line, dots, or arrows.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend; none if empty.
    pub label: String,
    /// Points (x, y) in the units of the axes; one that is not finite interrupts the line. Of arrows, the tail and
    /// the tip of each, one after the other.
    pub points: Vec<[f64; 2]>,
    /// How they are drawn.
    pub draw: Draw,
}

/// How points are drawn. Colours are red, green and blue, 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Draw {
    /// A continuous line of this colour.
    Line([u8; 3]),
    /// A dashed line of this colour.
    Dashed([u8; 3]),
    /// Dots of this colour and radius (points of 1/96 inch).
    Dots([u8; 3], f64),
    /// Arrows of this colour.
    Arrows([u8; 3]),
}

impl Draw {
    /// The colour.
    pub(crate) fn colour(self) -> [u8; 3] {
        let (Self::Line(colour)
        | Self::Dashed(colour)
        | Self::Dots(colour, _)
        | Self::Arrows(colour)) = self;
        colour
    }
}

/// A vertical dashed line at one x.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Where it stands, in the unit of the horizontal axis.
    pub x: f64,
    /// Name in the legend; none if empty.
    pub label: String,
    /// Its colour: red, green, blue.
    pub colour: [u8; 3],
}
