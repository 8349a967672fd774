//! A figure as pixels.

use crate::chart::layout::Medium;
use crate::chart::{Figure, draw};
use plotters::prelude::*;

/// A picture as pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pixels {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue of each pixel, row by row from the top.
    pub rgb: Vec<u8>,
}

/// A pixel is the mean of so many in each direction: the drawing library places lines on whole pixels.
const FINE: u32 = 3;
/// Most fine pixels; a larger figure is drawn with fewer.
const MOST: u64 = 100_000_000;

/// The figure with `unit` pixels per point; why it cannot be drawn.
pub(crate) fn pixels(figure: &Figure, unit: f64) -> Result<Pixels, String> {
    let [width, height] = figure.size.map(|points| (f64::from(points) * unit).round() as u32);
    let count = |fine: u32| u64::from(width * fine) * u64::from(height * fine);
    let fine = (1..=FINE).rev().find(|fine| count(*fine) <= MOST).unwrap_or(1);
    let mut rgb = vec![255; 3 * count(fine) as usize];
    {
        let size = (width * fine, height * fine);
        let area = BitMapBackend::with_buffer(&mut rgb, size).into_drawing_area();
        let drawn = draw::figure(figure, &area, unit * f64::from(fine), Medium::Bitmap(fine));
        drawn.and_then(|()| area.present()).map_err(|error| error.to_string())?;
    }
    Ok(Pixels { width, height, rgb: means(&rgb, width as usize, fine as usize) })
}

/// The means over squares of `fine` pixels; a row of the result has `width`.
fn means(rgb: &[u8], width: usize, fine: usize) -> Vec<u8> {
    let row = 3 * width * fine;
    let mut out = Vec::with_capacity(rgb.len() / (fine * fine));
    let mut sums = vec![0u32; 3 * width];
    for rows in rgb.chunks_exact(row * fine) {
        sums.fill(0);
        for (i, pixel) in rows.as_chunks::<3>().0.iter().enumerate() {
            let at = 3 * (i % (width * fine) / fine);
            (0..3).for_each(|c| sums[at + c] += u32::from(pixel[c]));
        }
        let count = (fine * fine) as u32;
        out.extend(sums.iter().map(|sum| ((sum + count / 2) / count) as u8));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_is_the_mean_of_its_fine_pixels() {
        // two by one pixels of two by two fine ones
        let fine = [[0, 0, 0], [4, 8, 0], [9, 9, 9], [9, 9, 9]];
        let rgb: Vec<u8> = fine.iter().chain(&fine).flatten().copied().collect();
        assert_eq!(means(&rgb, 2, 2), [2, 4, 0, 9, 9, 9]);
    }
}
