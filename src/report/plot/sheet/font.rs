//! The embedded font: how wide a text is, letter by letter.
//! It draws nothing; the font is also registered with plotters here, so that none of the system is needed.

use crate::report::plot::error::FigureError;
use ab_glyph::{Font, FontRef};
use plotters::style::{FontStyle, register_font};
use std::sync::OnceLock;

/// The name DejaVu Sans is registered under. Viewers of an SVG that lack it fall back on fonts of the same letter widths.
pub(in crate::report::plot) const FAMILY: &str = "DejaVu Sans, Bitstream Vera Sans, Verdana, sans-serif";
/// Half the height of a capital letter over the font size: text is placed by the middle of its capitals.
pub(in crate::report::plot) const HALF_CAPITAL: f32 = 0.365;
struct Fonts {
    regular: FontRef<'static>,
    bold: FontRef<'static>,
}

/// The embedded font, registered with plotters at the first call.
pub(in crate::report::plot) fn font(bold: bool) -> Result<&'static FontRef<'static>, FigureError> {
    static FONTS: OnceLock<Option<Fonts>> = OnceLock::new();
    let load = |style: FontStyle, bytes: &'static [u8]| {
        register_font(FAMILY, style, bytes).ok()?;
        FontRef::try_from_slice(bytes).ok()
    };
    FONTS
        .get_or_init(|| {
            Some(Fonts { regular: load(FontStyle::Normal, bytes(false))?, bold: load(FontStyle::Bold, bytes(true))? })
        })
        .as_ref()
        .map(|fonts| if bold { &fonts.bold } else { &fonts.regular })
        .ok_or(FigureError::Font)
}

/// The file of the embedded font.
pub(in crate::report::plot) fn bytes(bold: bool) -> &'static [u8] {
    if bold { dejavu::sans::bold() } else { dejavu::sans::regular() }
}

/// Width of a text in px.
pub(in crate::report::plot) fn text_width(text: &str, size: f32, bold: bool) -> f32 {
    // Without a font no image can be made, so the width is never used.
    let Ok(font) = font(bold) else { return 0.0 };
    advances(font, text, size).last().map_or(0.0, |&(_, end)| end)
}

/// Where each letter of a text starts and ends, in px from the start of the text.
pub(in crate::report::plot) fn advances(font: &FontRef<'_>, text: &str, size: f32) -> Vec<(f32, f32)> {
    let em = size / font.units_per_em().unwrap_or(1.0);
    let mut previous = None;
    let mut end = 0.0;
    text.chars()
        .map(|c| {
            let id = font.glyph_id(c);
            let start = end + previous.map_or(0.0, |p| font.kern_unscaled(p, id) * em);
            end = start + font.h_advance_unscaled(id) * em;
            previous = Some(id);
            (start, end)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greek_letters_superscripts_and_signs_have_glyphs() {
        for c in "ψδρΔβαη²³⁻⁶·×±−–≤≥°→".chars() {
            for bold in [false, true] {
                assert_ne!(font(bold).unwrap().glyph_id(c).0, 0, "{c}");
            }
        }
    }
}
