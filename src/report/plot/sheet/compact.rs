//! Pixels as a small PNG: with a table of at most 256 colours, where no pixel changes visibly by that, and whole otherwise.
//! It draws nothing.

use std::collections::HashMap;

use crate::report::plot::error::FigureError;

/// Colours that a table may have: an index is a byte.
const COLORS: usize = 256;
/// By how much a channel of a pixel may change, of 255. Only rare colours at the soft edges of lines and letters do, and there the eye
/// sees no step of this height.
const CHANGE: u8 = 16;

/// The bytes of a PNG of red, green and blue of each pixel, row by row.
pub(super) fn encode(rgb: &[u8], width: u32, height: u32) -> Result<Vec<u8>, FigureError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    // Figures are flat: rows as they are have longer repetitions than differences of neighbours.
    encoder.set_filter(png::Filter::NoFilter);
    let indexed = Indexed::new(rgb);
    let data = match &indexed {
        Some(indexed) => {
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(indexed.table.concat());
            &indexed.pixels[..]
        }
        None => {
            encoder.set_color(png::ColorType::Rgb);
            rgb
        }
    };
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    writer.finish()?;
    Ok(bytes)
}

type Rgb = [u8; 3];

/// Pixels as places in a table of colours.
struct Indexed {
    table: Vec<Rgb>,
    pixels: Vec<u8>,
}

impl Indexed {
    /// `None` where a pixel would change by more than [`CHANGE`].
    fn new(rgb: &[u8]) -> Option<Self> {
        let colors = by_frequency(rgb);
        let table = (0..=CHANGE).find_map(|change| table(&colors, change))?;
        let nearest = |color: &Rgb| (0..table.len()).min_by_key(|i| distance(table[*i], *color)).unwrap_or(0) as u8;
        let place: HashMap<Rgb, u8> = colors.iter().map(|color| (*color, nearest(color))).collect();
        let mut pixels = Vec::with_capacity(rgb.len() / 3);
        for run in runs(rgb) {
            pixels.resize(pixels.len() + run.len(), place[&run[0]]);
        }
        Some(Self { table, pixels })
    }
}

/// Pixels in runs of one colour: neighbours are mostly alike.
fn runs(rgb: &[u8]) -> impl Iterator<Item = &[Rgb]> {
    rgb.as_chunks::<3>().0.chunk_by(|a, b| a == b)
}

/// Every colour once, the most frequent first.
fn by_frequency(rgb: &[u8]) -> Vec<Rgb> {
    let mut counts: HashMap<Rgb, usize> = HashMap::new();
    for run in runs(rgb) {
        *counts.entry(run[0]).or_default() += run.len();
    }
    let mut colors: Vec<(Rgb, usize)> = counts.into_iter().collect();
    colors.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    colors.into_iter().map(|(color, _)| color).collect()
}

/// A table in which every colour has an entry within `change` in each channel; `None` where it would be too long.
fn table(colors: &[Rgb], change: u8) -> Option<Vec<Rgb>> {
    let mut table: Vec<Rgb> = Vec::with_capacity(COLORS);
    for color in colors {
        let near = |entry: &Rgb| entry.iter().zip(color).all(|(a, b)| a.abs_diff(*b) <= change);
        if !table.iter().any(near) {
            if table.len() == COLORS {
                return None;
            }
            table.push(*color);
        }
    }
    Some(table)
}

/// The largest difference of a channel of two colours, and for equal ones the sum of all.
fn distance(a: Rgb, b: Rgb) -> (u8, u16) {
    let differences = [0, 1, 2].map(|i| a[i].abs_diff(b[i]));
    (differences.into_iter().fold(0, u8::max), differences.into_iter().map(u16::from).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pixels of a PNG, and whether it has a table of colours.
    fn decoded(bytes: &[u8]) -> (Vec<u8>, bool) {
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let indexed = reader.info().color_type == png::ColorType::Indexed;
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let size = reader.next_frame(&mut pixels).unwrap().buffer_size();
        pixels.truncate(size);
        (pixels, indexed)
    }

    /// A square of which each pixel has the colour of its number.
    fn square_of(side: u32, color: impl Fn(u32) -> Rgb) -> Vec<u8> {
        (0..side * side).flat_map(color).collect()
    }

    #[test]
    fn up_to_256_colours_are_kept_exactly() {
        let rgb = square_of(32, |i| [(i % 256) as u8, 255 - (i % 256) as u8, 7]);
        assert_eq!(decoded(&encode(&rgb, 32, 32).unwrap()), (rgb, true));
    }

    #[test]
    fn many_similar_colours_change_by_no_more_than_the_eye_sees() {
        // Shades of two lines on white, as at soft edges.
        let shade = |i: u32| (255 - i % 256) as u8;
        let rgb = square_of(64, |i| if i % 2 == 0 { [shade(i / 2), 255, 255] } else { [255, 255, shade(i / 3)] });
        let (seen, indexed) = decoded(&encode(&rgb, 64, 64).unwrap());
        assert!(indexed && seen != rgb);
        assert!(seen.iter().zip(&rgb).all(|(a, b)| a.abs_diff(*b) <= CHANGE));
    }

    #[test]
    fn a_picture_of_all_colours_is_kept_whole() {
        let rgb = square_of(64, |i| [(i % 16 * 17) as u8, (i / 16 % 16 * 17) as u8, (i / 256 * 17) as u8]);
        assert_eq!(decoded(&encode(&rgb, 64, 64).unwrap()), (rgb, false));
    }
}
