//! Pictures of surfaces in space: panes with a camera each, one colour bar, drawn without a graphics card.
//!
//! A z-buffer and parallel projection are enough for quads that carry one value, so that a picture needs
//! nothing that is not in the program, and is the same on every machine.

mod camera;
mod labels;
mod raster;

pub use camera::Camera;
pub use labels::round_down;

use crate::chart::Key;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use output::files::made::PNG_MARK;
use std::io::Write;
use thiserror::Error;

/// Why a picture cannot be drawn.
#[derive(Debug, Error)]
#[error("cannot draw the picture: {0}")]
pub struct PictureError(String);

/// A surface of quads with a value at every point.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Points (m).
    pub points: Vec<[f64; 3]>,
    /// Corners of the quads, in order around each.
    pub quads: Vec<[u32; 4]>,
    /// Value at each point, coloured by [`Picture::key`].
    pub values: Vec<f64>,
}

/// One view of a picture.
#[derive(Clone, Debug)]
pub struct Pane {
    /// What it shows, above it.
    pub title: String,
    /// From where.
    pub camera: Camera,
    /// The surface; quads with a point that is not finite are left out.
    pub surface: Surface,
    /// Whether a light shows how faces are turned. Without it colours are those of the colour bar alone.
    pub lit: bool,
}

/// Panes side by side below a heading, and what their colours mean below them.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Line above all panes; cut where it is too long.
    pub heading: String,
    /// The panes, from left to right.
    pub panes: Vec<Pane>,
    /// What the colours mean.
    pub key: Key,
}

/// A picture as pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue of each pixel, row by row from the top.
    pub rgb: Vec<u8>,
}

impl Pixels {
    /// Writes the pixels as a PNG with the mark of this program.
    ///
    /// # Errors
    /// What `out` or the PNG library fails with.
    pub fn write_png(&self, out: impl Write) -> std::io::Result<()> {
        let mut encoder = png::Encoder::new(out, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mark = String::from_utf8_lossy(PNG_MARK);
        if let Some((keyword, text)) = mark.split_once('\0') {
            encoder.add_text_chunk(keyword.into(), text.into())?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb)?;
        Ok(writer.finish()?)
    }

    /// The pixels as a PNG in an address that an `<img>` of a page takes, so that the page needs no other file.
    ///
    /// # Errors
    /// [`PictureError`] where the PNG library fails.
    pub fn data_url(&self) -> Result<String, PictureError> {
        let mut bytes = Vec::new();
        self.write_png(&mut bytes).map_err(|error| PictureError(error.to_string()))?;
        Ok(format!("data:image/png;base64,{}", STANDARD.encode(bytes)))
    }
}

/// Width and height of a pane (points of 1/96 inch); a single pane is wider.
const PANE: [f64; 2] = [400.0, 400.0];
const SINGLE: f64 = 640.0;
/// Heights of the heading, of a pane's title and of the colour bar with its labels (points).
const HEADING: f64 = 26.0;
const TITLE: f64 = 20.0;
const KEY: f64 = 50.0;

/// Where the parts of a picture are, in pixels.
#[derive(Clone, Copy, Debug)]
struct Layout {
    /// Pixels per point.
    unit: f64,
    /// Width and height of all.
    size: [u32; 2],
    /// Width and height of a pane without its title.
    pane: [u32; 2],
}

impl Layout {
    fn new(panes: usize, width: u32) -> Self {
        let panes = panes.max(1);
        let pane = if panes == 1 { SINGLE } else { PANE[0] };
        let unit = f64::from(width) / (pane * panes as f64);
        let height = (HEADING + TITLE + PANE[1] + KEY) * unit;
        // encoders of films want even numbers
        let even = |length: f64| 2 * (length / 2.0).round().max(1.0) as u32;
        let size = [even(f64::from(width)), even(height)];
        let inner = [size[0] / panes as u32, (PANE[1] * unit).round() as u32];
        Self { unit, size, pane: inner }
    }

    /// Points as whole pixels.
    fn px(&self, points: f64) -> i32 {
        (points * self.unit).round() as i32
    }

    /// Upper left corner of a pane below its title.
    fn corner(&self, pane: usize) -> [u32; 2] {
        [pane as u32 * self.pane[0], self.px(HEADING + TITLE) as u32]
    }
}

impl Picture {
    /// Draws the picture `width` pixels wide, or one more where that is odd.
    ///
    /// # Errors
    /// [`PictureError`] where the drawing library fails.
    pub fn pixels(&self, width: u32) -> Result<Pixels, PictureError> {
        let layout = Layout::new(self.panes.len(), width);
        let [width, height] = layout.size;
        let mut rgb = vec![255; 3 * width as usize * height as usize];
        for (i, pane) in self.panes.iter().enumerate() {
            let drawn = raster::draw(pane, &self.key, layout.pane, layout.unit);
            let [left, top] = layout.corner(i).map(|at| at as usize);
            let row = 3 * layout.pane[0] as usize;
            for (j, pixels) in drawn.chunks_exact(row).enumerate() {
                let start = 3 * ((top + j) * width as usize + left);
                rgb[start..start + row].copy_from_slice(pixels);
            }
        }
        labels::draw(self, &layout, &mut rgb)?;
        Ok(Pixels { width, height, rgb })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::{Scale, viridis};

    fn square(z: f64, value: f64) -> Surface {
        Surface {
            points: [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                .map(|[x, y]| [x, y, z])
                .to_vec(),
            quads: vec![[0, 1, 2, 3]],
            values: vec![value; 4],
        }
    }

    fn picture(panes: Vec<Surface>) -> Picture {
        let camera = Camera::new([0.0; 3], [0.0, 0.0, -1.0], 4.0);
        let pane = |surface| Pane { title: "A pane".into(), camera, surface, lit: true };
        let key = Key::Values { label: "p (MPa)".into(), range: [0.0, 10.0], scale: Scale::Linear };
        let panes = panes.into_iter().map(pane).collect();
        Picture { heading: "t = 1 ms".into(), panes, key }
    }

    fn at(pixels: &Pixels, x: u32, y: u32) -> [u8; 3] {
        let at = 3 * (y * pixels.width + x) as usize;
        [0, 1, 2].map(|i| pixels.rgb[at + i])
    }

    #[test]
    fn a_square_has_the_colour_of_its_value_where_it_is_and_white_around_it() {
        let pixels = picture(vec![square(0.0, 10.0), square(0.0, 0.0)]).pixels(800).unwrap();
        assert_eq!([pixels.width, pixels.height], [800, 496]);
        for (pane, value) in [(0, 1.0), (1, 0.0)] {
            let [x, y] = [200 + 400 * pane, 246];
            let found = at(&pixels, x, y);
            // lit from the front: nearly the colour itself
            let near = found.iter().zip(viridis(value)).all(|(a, b)| a.abs_diff(b) < 40);
            assert!(near, "{found:?}, {:?}", viridis(value));
            assert_eq!(at(&pixels, x - 130, y), [255; 3]);
        }
    }

    #[test]
    fn an_empty_picture_and_odd_widths_are_drawn() {
        for width in [401, 1600] {
            let pixels = picture(vec![]).pixels(width).unwrap();
            assert_eq!(pixels.width % 2 + pixels.height % 2, 0);
            assert_eq!(pixels.rgb.len(), 3 * (pixels.width * pixels.height) as usize);
        }
    }
}
