//! Figures as small PNG files: an index into a palette for each pixel.

use crate::chart::Pixels;
use output::files::made::PNG_MARK;
use std::collections::BTreeMap;

/// A PNG with the mark of this program and at most `most` colours, of which there can be 256: the fewer, the smaller
/// the file.
///
/// `per_metre` is the number of pixels in a metre of paper. Those of `exact` that occur are kept exactly, so that lines have the colours that the legend says. Of the others the
/// palette holds those whose change would be seen most, and the rest, shades at the edges of lines and letters, become the
/// nearest of them.
///
/// # Errors
/// What the PNG library fails with.
pub(crate) fn png(
    pixels: &Pixels,
    exact: &[[u8; 3]],
    most: usize,
    per_metre: Option<u32>,
) -> Result<Vec<u8>, png::EncodingError> {
    let (palette, index) = palette(&pixels.rgb, exact, most);
    let half = palette.len() <= 16;
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, pixels.width, pixels.height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(if half { png::BitDepth::Four } else { png::BitDepth::Eight });
    encoder.set_palette(palette.as_flattened());
    encoder.set_compression(png::Compression::Best);
    // neighbouring indices are no neighbouring colours: differences compress no better
    encoder.set_filter(png::FilterType::NoFilter);
    encoder.set_pixel_dims(per_metre.map(|n| png::PixelDimensions {
        xppu: n,
        yppu: n,
        unit: png::Unit::Meter,
    }));
    let mark = String::from_utf8_lossy(PNG_MARK);
    if let Some((keyword, text)) = mark.split_once('\0') {
        encoder.add_text_chunk(keyword.into(), text.into())?;
    }
    let mut writer = encoder.write_header()?;
    let runs = colours(&pixels.rgb).chunk_by(|a, b| a == b);
    let mut indices: Vec<u8> =
        runs.flat_map(|run| std::iter::repeat_n(index[&run[0]], run.len())).collect();
    if half {
        // two in a byte, the left one in its upper half; a row begins a byte
        let rows = indices.chunks(pixels.width.max(1) as usize).flat_map(|row| row.chunks(2));
        indices = rows.map(|two| two[0] << 4 | two.get(1).unwrap_or(&0)).collect();
    }
    writer.write_image_data(&indices)?;
    writer.finish()?;
    Ok(out)
}

fn colours(rgb: &[u8]) -> &[[u8; 3]] {
    rgb.as_chunks().0
}

/// A colour of a picture.
struct Shade {
    colour: [u8; 3],
    pixels: u64,
    /// Index of the nearest colour of the palette so far, and the square of the distance to it.
    nearest: u8,
    distance: u64,
}

impl Shade {
    fn is_grey(&self) -> bool {
        self.colour.iter().all(|part| *part == self.colour[0])
    }
}

/// Of the shades of a kind that are not in the palette, that whose change would be seen most.
fn worst(shades: &[Shade], kind: impl Fn(&Shade) -> bool) -> Option<[u8; 3]> {
    let missing = shades.iter().filter(|shade| shade.distance > 0 && kind(shade));
    missing.max_by_key(|shade| shade.pixels * shade.distance).map(|shade| shade.colour)
}

/// Greys of a palette besides black and white: those of letters and of the grid.
pub(crate) const GREYS: usize = 4;

/// At most `most` colours, and for each colour of the picture the index of the nearest of them.
///
/// Begins with those of `exact` that occur. Then comes, one after the other, the colour that is farthest from those
/// before it, the square of its distance counted for each of its pixels: first [`GREYS`] greys, since letters must not get
/// edges in the colour of a line, then any.
fn palette(rgb: &[u8], exact: &[[u8; 3]], most: usize) -> (Vec<[u8; 3]>, BTreeMap<[u8; 3], u8>) {
    let mut counts = BTreeMap::<[u8; 3], u64>::new();
    for run in colours(rgb).chunk_by(|a, b| a == b) {
        *counts.entry(run[0]).or_default() += run.len() as u64;
    }
    let shade =
        |(colour, pixels)| Shade { colour, pixels, nearest: 0, distance: u64::from(u32::MAX) };
    let mut wanted = exact.iter().filter(|colour| counts.contains_key(*colour));
    let mut shades: Vec<Shade> = counts.clone().into_iter().map(shade).collect();
    let mut palette: Vec<[u8; 3]> = Vec::new();
    let mut greys = GREYS;
    while palette.len() < most {
        let next = wanted.next().copied().or_else(|| {
            let grey = worst(&shades, Shade::is_grey).filter(|_| greys > 0);
            greys = greys.saturating_sub(1);
            grey.or_else(|| worst(&shades, |_| true))
        });
        let Some(next) = next else { break };
        for shade in &mut shades {
            let distance = distance(shade.colour, next);
            if distance < shade.distance {
                (shade.nearest, shade.distance) = (palette.len() as u8, distance);
            }
        }
        palette.push(next);
    }
    (palette, shades.into_iter().map(|shade| (shade.colour, shade.nearest)).collect())
}

/// The square of the distance of two colours.
fn distance(a: [u8; 3], b: [u8; 3]) -> u64 {
    (0..3).map(|i| u64::from(a[i].abs_diff(b[i])).pow(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(bytes: &[u8]) -> Vec<u8> {
        let mut decoder = png::Decoder::new(bytes);
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut rgb).unwrap();
        rgb
    }

    #[test]
    fn few_colours_are_kept_exactly() {
        // three columns, so that a row of half bytes ends in the middle of one
        let rgb =
            vec![0, 114, 178, 255, 255, 254, 255, 255, 254, 1, 2, 3, 0, 114, 178, 0, 114, 178];
        let few = Pixels { width: 3, height: 2, rgb };
        for most in [3, 16, 256] {
            assert_eq!(decoded(&png(&few, &[], most, None).unwrap()), few.rgb);
        }
    }

    #[test]
    fn of_many_colours_the_frequent_are_kept_exactly_and_the_rare_nearly() {
        // a hundred pixels of one colour, ten thousand shades, and one pixel of yellow
        let shade = |i: usize| [(i / 100) as u8, (i % 100) as u8, 200];
        let all = std::iter::repeat_n([213, 94, 0], 100).chain((0..10_000).map(shade));
        let rgb: Vec<u8> = all.chain([[253, 231, 37]]).flatten().collect();
        let many = Pixels { width: 10_101, height: 1, rgb };
        let found = decoded(&png(&many, &[], 256, None).unwrap());
        assert_eq!(found[..300], many.rgb[..300]);
        assert_eq!(found[30_300..], many.rgb[30_300..]);
        let pairs = found.as_chunks::<3>().0.iter().zip(many.rgb.as_chunks::<3>().0);
        assert!(pairs.map(|(a, b)| distance(*a, *b)).max() < Some(15 * 15));
    }

    #[test]
    fn a_rare_line_keeps_its_colour_among_many_shades_of_grey() {
        let line = [230, 159, 0];
        let greys = (0..=255).flat_map(|grey| std::iter::repeat_n([grey; 3], 10_000));
        let rgb: Vec<u8> = greys.chain([line]).flatten().collect();
        let pixels = Pixels { width: 2_560_001, height: 1, rgb };
        let last = |exact: &[[u8; 3]]| {
            decoded(&png(&pixels, exact, 16, None).unwrap()).split_off(7_680_000)
        };
        assert_eq!(last(&[line]), line);
        assert_ne!(last(&[]), line, "the test shows nothing");
    }

    #[test]
    fn letters_keep_grey_edges_among_many_shades_of_lines() {
        let blues = (0..200u8).flat_map(|i| std::iter::repeat_n([i, i / 2 + 100, 200], 10_000));
        let greys = [[60; 3], [120; 3], [180; 3]];
        let rgb: Vec<u8> = blues.chain(greys).flatten().collect();
        let pixels = Pixels { width: 2_000_003, height: 1, rgb };
        let found = decoded(&png(&pixels, &[], 16, None).unwrap());
        assert_eq!(found[6_000_000..], *greys.as_flattened());
    }
}
