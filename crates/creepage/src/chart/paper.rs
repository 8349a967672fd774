//! The size of a figure on paper.

use crate::chart::layout::TEXT;
use crate::chart::{Figure, draw};

/// Points of a screen (1/96 inch) in a millimetre, and in a printer's point.
const PER_MM: f64 = 96.0 / 25.4;
const PER_PT: f64 = 96.0 / 72.0;
/// The drawing library's size of a text over that of its letters.
pub(super) const LIBRARY: f64 = 1.24;
/// Pixels per point of a screen: two, and on paper of a given width 300 per inch.
const PIXELS: [f64; 2] = [2.0, 300.0 / 96.0];
/// Least width of a panel beside another, and what of a panel's height axes and legend take (points of 1/96 inch).
const NARROWEST: f64 = 200.0;
const AROUND_PLOT: f64 = 100.0;

/// How large a figure is, and what is on it.
#[derive(Clone, Copy, Debug)]
pub struct Paper {
    /// Width (mm) [default: as on a screen].
    pub width: Option<f64>,
    /// Size of the letters (points of 1/72 inch).
    pub font_size: Option<f64>,
    /// Whether the caption stands below the panels.
    pub caption: bool,
}

impl Paper {
    /// A figure as on a screen.
    pub const SCREEN: Self = Self { width: None, font_size: None, caption: true };

    /// Size of letters over their size on a screen.
    fn enlargement(&self) -> f64 {
        self.font_size.map_or(1.0, |size| size * PER_PT * LIBRARY / TEXT)
    }

    /// Size on paper over that of a figure that is laid out for it, whose size is in whole points.
    fn scale(&self, laid_out: &Figure) -> f64 {
        let exact = |mm: f64| mm * PER_MM / f64::from(laid_out.size[0]);
        self.width.map_or(self.enlargement(), exact)
    }

    /// Width and height of a figure that is laid out, as SVG has them.
    pub(crate) fn size(&self, laid_out: &Figure) -> [String; 2] {
        let scale = self.scale(laid_out);
        laid_out.size.map(|points| match self.width {
            Some(_) => format!("{:.2}mm", f64::from(points) * scale / PER_MM),
            None => (f64::from(points) * scale).to_string(),
        })
    }

    /// The same as PDF has them (points of 1/72 inch).
    pub(crate) fn points(&self, laid_out: &Figure) -> [f64; 2] {
        laid_out.size.map(|points| f64::from(points) * self.scale(laid_out) / PER_PT)
    }

    /// Pixels in a metre, where the size on paper is known.
    pub(crate) fn per_metre(&self) -> Option<u32> {
        self.width.map(|_| (1e3 * PIXELS[1] * PER_MM).round() as u32)
    }

    /// Pixels per point of a figure that is laid out.
    pub(crate) fn pixels(&self, laid_out: &Figure) -> f64 {
        self.scale(laid_out) * PIXELS[usize::from(self.width.is_some())]
    }

    /// The figure with panels as wide as there is room, and as few beside one another as that needs. Letters keep their
    /// size.
    ///
    /// # Errors
    /// The message of the drawing library, which measures letters.
    pub(crate) fn lay_out(&self, figure: &Figure) -> Result<Figure, String> {
        let own = figure.size.map(f64::from);
        let width = self.width.map_or(own[0], |mm| mm * PER_MM) / self.enlargement();
        let height = own[1] - draw::caption_height(figure)?;
        let rows = |columns: usize| figure.panels.len().div_ceil(columns.max(1)).max(1);
        let [across, up] =
            [own[0] / figure.columns.max(1) as f64, height / rows(figure.columns) as f64];
        let most = (width / NARROWEST.min(across)).max(1.0) as usize;
        let columns = figure.columns.clamp(1, most);
        let plot = (up - AROUND_PLOT).max(0.0) * (width / columns as f64 / across);
        let mut figure = Figure { columns, ..figure.clone() };
        figure.size[0] = width.round() as u32;
        if !self.caption {
            figure.caption.clear();
        }
        let panels = rows(columns) as f64 * (plot + up.min(AROUND_PLOT));
        figure.size[1] = (panels + draw::caption_height(&figure)?).round() as u32;
        Ok(figure)
    }
}
