//! Figures as small PNG files: an index into a palette for each pixel.

use crate::Pixels;
use files::output::PNG_MARK;
use std::collections::BTreeMap;

/// A PNG with the mark of this program. Its palette holds the most frequent colours, which are those of lines, cells
/// and paper, exactly; the other shades, those at the edges of lines, become the nearest of them.
///
/// `most` is the number of colours, at most 256: the fewer, the smaller the file.
///
/// # Errors
/// What the PNG library fails with.
pub(crate) fn png(pixels: &Pixels, most: usize) -> Result<Vec<u8>, png::EncodingError> {
    let (palette, index) = palette(&pixels.rgb, most);
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, pixels.width, pixels.height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.as_flattened());
    encoder.set_compression(png::Compression::Best);
    // neighbouring indices are no neighbouring colours: differences compress no better
    encoder.set_filter(png::FilterType::NoFilter);
    let mark = String::from_utf8_lossy(PNG_MARK);
    if let Some((keyword, text)) = mark.split_once('\0') {
        encoder.add_text_chunk(keyword.into(), text.into())?;
    }
    let mut writer = encoder.write_header()?;
    let runs = colours(&pixels.rgb).chunk_by(|a, b| a == b);
    let indices: Vec<u8> =
        runs.flat_map(|run| std::iter::repeat_n(index[&run[0]], run.len())).collect();
    writer.write_image_data(&indices)?;
    writer.finish()?;
    Ok(out)
}

/// Colours of a palette that may be rare.
const RARE: usize = 96;

fn colours(rgb: &[u8]) -> &[[u8; 3]] {
    rgb.as_chunks().0
}

/// At most `most` colours, the most frequent first, and for each colour the index of the nearest of them.
///
/// The most frequent are taken as they are; of the last [`RARE`] one is left out if it is near one that is more
/// frequent. How near is the least of a few distances with which the colours are few enough, so that a rare colour
/// does not become another.
fn palette(rgb: &[u8], most: usize) -> (Vec<[u8; 3]>, BTreeMap<[u8; 3], u8>) {
    let mut counts = BTreeMap::<[u8; 3], usize>::new();
    for run in colours(rgb).chunk_by(|a, b| a == b) {
        *counts.entry(run[0]).or_default() += run.len();
    }
    let mut frequent: Vec<[u8; 3]> = counts.keys().copied().collect();
    frequent.sort_by_key(|colour| std::cmp::Reverse(counts[colour]));
    let distances = (0..).map(|i| 3 * i * i);
    let palette =
        distances.map(|least| apart(&frequent, least, most)).find(|all| all.len() <= most);
    let palette = palette.unwrap_or_default();
    let nearest = |colour: [u8; 3]| {
        let indices = (0..palette.len()).min_by_key(|i| distance(palette[*i], colour));
        indices.unwrap_or(0) as u8
    };
    let index = counts.keys().map(|colour| (*colour, nearest(*colour))).collect();
    (palette, index)
}

/// The first of `colours`, and of the others those that are farther than the square root of `least` from all before
/// them; one more than `most` where there are more.
fn apart(colours: &[[u8; 3]], least: u32, most: usize) -> Vec<[u8; 3]> {
    let mut kept: Vec<[u8; 3]> = Vec::new();
    for colour in colours {
        let far = || kept.iter().all(|other| distance(*colour, *other) > least);
        if kept.len() <= most && (kept.len() < most.saturating_sub(RARE) || far()) {
            kept.push(*colour);
        }
    }
    kept
}

/// The square of the distance of two colours.
fn distance(a: [u8; 3], b: [u8; 3]) -> u32 {
    (0..3).map(|i| u32::from(a[i].abs_diff(b[i])).pow(2)).sum()
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
        let few = Pixels { width: 2, height: 1, rgb: vec![0, 114, 178, 255, 255, 254] };
        assert_eq!(decoded(&png(&few, 2).unwrap()), few.rgb);
    }

    #[test]
    fn of_many_colours_the_frequent_are_kept_exactly_and_the_rare_nearly() {
        // a hundred pixels of one colour, ten thousand shades, and one pixel of yellow
        let shade = |i: usize| [(i / 100) as u8, (i % 100) as u8, 200];
        let all = std::iter::repeat_n([213, 94, 0], 100).chain((0..10_000).map(shade));
        let rgb: Vec<u8> = all.chain([[253, 231, 37]]).flatten().collect();
        let many = Pixels { width: 10_101, height: 1, rgb };
        let found = decoded(&png(&many, 256).unwrap());
        assert_eq!(found[..300], many.rgb[..300]);
        assert_eq!(found[30_300..], many.rgb[30_300..]);
        let pairs = found.as_chunks::<3>().0.iter().zip(many.rgb.as_chunks::<3>().0);
        assert!(pairs.map(|(a, b)| distance(*a, *b)).max() < Some(15 * 15));
    }
}
