//! A sheet as PDF: one page of vector shapes and text, the letters that it uses embedded.
//! What the shapes are and where they lie was decided before; nothing here knows of axes or data.

use super::canvas::{Anchor, Canvas, Run, Shape, Type};
use super::font::{HALF_CAPITAL, advances, bytes, font};
use super::geometry::Px;
use crate::report::plot::error::FigureError;
use crate::report::plot::palette::Color;
use ab_glyph::Font;
use pdf_writer::types::{CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str};
use std::collections::{BTreeMap, BTreeSet};
use subsetter::GlyphRemapper;

/// Points to a pixel: figures are laid out for screens of double density, of which 192 px are an inch.
pub(in crate::report::plot) const POINTS: f32 = 72.0 / 192.0;
/// A circle in four arcs has its control points so far from their ends, over the radius.
const ARC: f32 = 0.552_284_8;
/// Level of compression, 0 to 10.
const LEVEL: u8 = 6;

/// References of one embedded font, from the first of five.
const FONT_REFS: [i32; 2] = [10, 20];
const FONT_NAMES: [&[u8]; 2] = [b"F0", b"F1"];

/// The letters of one font that a sheet uses.
#[derive(Default)]
struct Letters {
    glyphs: BTreeMap<u16, char>,
    remapper: GlyphRemapper,
}

/// The sheet as a PDF document of one page, without a date, so that the same sheet gives the same bytes.
pub(in crate::report::plot) fn pdf(sheet: &Canvas) -> Result<Vec<u8>, FigureError> {
    let mut letters = [Letters::default(), Letters::default()];
    for shape in &sheet.shapes {
        if let Shape::Text { text, style, .. } = shape {
            let own = &mut letters[usize::from(style.bold)];
            for c in text.chars() {
                own.glyphs.entry(font(style.bold)?.glyph_id(c).0).or_insert(c);
            }
        }
    }
    for own in &mut letters {
        own.glyphs.keys().for_each(|glyph| {
            own.remapper.remap(*glyph);
        });
    }
    let opacities = opacities(sheet);
    let mut content = Content::new();
    let height = sheet.height as f32;
    content.transform([POINTS, 0.0, 0.0, -POINTS, 0.0, height * POINTS]);
    content.set_line_join(LineJoinStyle::RoundJoin).set_line_cap(LineCapStyle::ButtCap);
    content.set_fill_rgb(1.0, 1.0, 1.0).rect(0.0, 0.0, sheet.width as f32, height).fill_nonzero();
    for shape in &sheet.shapes {
        draw(&mut content, shape, &letters)?;
    }
    document(sheet, &content.finish(), &letters, &opacities)
}

/// The opacities of a sheet, in thousandths.
fn opacities(sheet: &Canvas) -> BTreeSet<u32> {
    let color = |shape: &Shape| match shape {
        Shape::Polygon { color, .. }
        | Shape::Rect { color, .. }
        | Shape::Stroke { color, .. }
        | Shape::Disc { color, .. } => *color,
        Shape::Text { style, .. } => style.color,
    };
    sheet.shapes.iter().map(|shape| thousandths(color(shape))).collect()
}

fn thousandths(color: Color) -> u32 {
    (color.alpha * 1e3).round() as u32
}

fn state_name(opacity: u32) -> String {
    format!("A{opacity}")
}

fn document(
    sheet: &Canvas,
    content: &[u8],
    letters: &[Letters; 2],
    opacities: &BTreeSet<u32>,
) -> Result<Vec<u8>, FigureError> {
    let [catalog, tree, page_ref, content_ref] = [1, 2, 3, 4].map(Ref::new);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(tree);
    pdf.pages(tree).kids([page_ref]).count(1);
    let mut page = pdf.page(page_ref);
    page.media_box(Rect::new(0.0, 0.0, sheet.width as f32 * POINTS, sheet.height as f32 * POINTS));
    page.parent(tree).contents(content_ref);
    let mut resources = page.resources();
    let mut fonts = resources.fonts();
    for (i, _) in letters.iter().enumerate().filter(|(_, l)| !l.glyphs.is_empty()) {
        fonts.pair(Name(FONT_NAMES[i]), Ref::new(FONT_REFS[i]));
    }
    fonts.finish();
    let mut states = resources.ext_g_states();
    for opacity in opacities {
        let alpha = *opacity as f32 / 1e3;
        let mut state =
            states.insert(Name(state_name(*opacity).as_bytes())).start::<pdf_writer::writers::ExtGraphicsState>();
        state.stroking_alpha(alpha).non_stroking_alpha(alpha);
    }
    states.finish();
    resources.finish();
    page.finish();
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(content, LEVEL);
    pdf.stream(content_ref, &packed).filter(Filter::FlateDecode);
    for (i, own) in letters.iter().enumerate().filter(|(_, l)| !l.glyphs.is_empty()) {
        embed(&mut pdf, i, own)?;
    }
    Ok(pdf.finish())
}

/// Embeds the letters of a font that are used, with what a reader needs to search and copy them.
fn embed(pdf: &mut Pdf, i: usize, own: &Letters) -> Result<(), FigureError> {
    let face = font(i == 1)?;
    let [composite, cid, descriptor, file, unicode] = [0, 1, 2, 3, 4].map(|k| Ref::new(FONT_REFS[i] + k));
    let name: &[u8] = if i == 1 { b"TRIMTB+DejaVuSans-Bold" } else { b"TRIMTB+DejaVuSans" };
    let system = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
    let em = 1000.0 / face.units_per_em().unwrap_or(1000.0);
    pdf.type0_font(composite)
        .base_font(Name(name))
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(cid)
        .to_unicode(unicode);
    let mut cid_font = pdf.cid_font(cid);
    cid_font.subtype(CidFontType::Type2).base_font(Name(name)).system_info(system).font_descriptor(descriptor);
    cid_font.default_width(0.0).cid_to_gid_map_predefined(Name(b"Identity"));
    let mut widths = cid_font.widths();
    for glyph in own.glyphs.keys() {
        let new = own.remapper.get(*glyph).unwrap_or(0);
        widths.same(new, new, face.h_advance_unscaled(ab_glyph::GlyphId(*glyph)) * em);
    }
    widths.finish();
    cid_font.finish();
    pdf.font_descriptor(descriptor)
        .name(Name(name))
        .flags(FontFlags::NON_SYMBOLIC)
        .bbox(Rect::new(-1021.0, -463.0, 1793.0, 1232.0))
        .italic_angle(0.0)
        .ascent(face.ascent_unscaled() * em)
        .descent(face.descent_unscaled() * em)
        .cap_height(2000.0 * HALF_CAPITAL)
        .stem_v(if i == 1 { 150.0 } else { 90.0 })
        .font_file2(file);
    let subset = subsetter::subset(bytes(i == 1), 0, &own.remapper).map_err(|_| FigureError::Font)?;
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(&subset, LEVEL);
    let mut stream = pdf.stream(file, &packed);
    stream.filter(Filter::FlateDecode).pair(Name(b"Length1"), subset.len() as i32);
    stream.finish();
    let mut cmap = UnicodeCmap::new(Name(b"Custom"), system);
    for (glyph, c) in &own.glyphs {
        cmap.pair(own.remapper.get(*glyph).unwrap_or(0), *c);
    }
    pdf.cmap(unicode, &cmap.finish());
    Ok(())
}

fn draw(content: &mut Content, shape: &Shape, letters: &[Letters; 2]) -> Result<(), FigureError> {
    let fill = |content: &mut Content, color: Color| {
        content.set_parameters(Name(state_name(thousandths(color)).as_bytes()));
        let [r, g, b] = [color.r, color.g, color.b].map(|v| f32::from(v) / 255.0);
        content.set_fill_rgb(r, g, b).set_stroke_rgb(r, g, b);
    };
    match shape {
        Shape::Polygon { corners, color } => {
            fill(content, *color);
            path(content, corners);
            content.close_path().fill_nonzero();
        }
        Shape::Rect { rect, color } => {
            fill(content, *color);
            content.rect(rect.left, rect.top, rect.width(), rect.height()).fill_nonzero();
        }
        Shape::Stroke { pieces, width, color } => {
            fill(content, *color);
            content.set_line_width(*width);
            pieces.iter().for_each(|piece| path(content, piece));
            content.stroke();
        }
        Shape::Disc { center, radius, color } => {
            fill(content, *color);
            disc(content, *center, *radius);
        }
        Shape::Text { text, at, anchor, run, style } => {
            fill(content, style.color);
            write(content, text, (*at, *anchor, *run), *style, letters)?;
        }
    }
    Ok(())
}

fn path(content: &mut Content, points: &[Px]) {
    for (k, (x, y)) in points.iter().enumerate() {
        if k == 0 {
            content.move_to(*x, *y)
        } else {
            content.line_to(*x, *y)
        };
    }
}

fn disc(content: &mut Content, (x, y): Px, r: f32) {
    let k = ARC * r;
    content.move_to(x + r, y);
    content.cubic_to(x + r, y + k, x + k, y + r, x, y + r);
    content.cubic_to(x - k, y + r, x - r, y + k, x - r, y);
    content.cubic_to(x - r, y - k, x - k, y - r, x, y - r);
    content.cubic_to(x + k, y - r, x + r, y - k, x + r, y);
    content.fill_nonzero();
}

/// A text, letter by letter with the kerning that its width was measured with.
fn write(
    content: &mut Content,
    text: &str,
    (at, anchor, run): (Px, Anchor, Run),
    style: Type,
    letters: &[Letters; 2],
) -> Result<(), FigureError> {
    let face = font(style.bold)?;
    let places = advances(face, text, style.size);
    let width = places.last().map_or(0.0, |&(_, end)| end);
    let start = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * width,
        Anchor::End => -width,
    };
    let down = HALF_CAPITAL * style.size;
    // The page is upside down here, so that letters are turned over again.
    let matrix = match run {
        Run::Across => [1.0, 0.0, 0.0, -1.0, at.0 + start, at.1 + down],
        Run::Up => [0.0, -1.0, -1.0, 0.0, at.0 + down, at.1 - start],
    };
    let which = usize::from(style.bold);
    content.begin_text().set_font(Name(FONT_NAMES[which]), style.size).set_text_matrix(matrix);
    let mut shown = content.show_positioned();
    let mut items = shown.items();
    let mut end = 0.0;
    for (c, (from, to)) in text.chars().zip(places) {
        if (from - end).abs() > 1e-4 {
            items.adjust(-(from - end) / style.size * 1000.0);
        }
        let glyph = letters[which].remapper.get(face.glyph_id(c).0).unwrap_or(0);
        items.show(Str(&glyph.to_be_bytes()));
        end = to;
    }
    items.finish();
    shown.finish();
    content.end_text();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet() -> Canvas {
        let mut canvas = Canvas::new(400, 200);
        let black = Color::rgb(0, 0, 0);
        canvas.fill(&[(10.0, 10.0), (90.0, 10.0), (40.0, 80.0)], black.faded(0.5));
        canvas.disc((200.0, 100.0), 20.0, black);
        let style = Type { size: 22.0, bold: false, color: black };
        canvas.text("ψ [deg], R'(u) ≥ 0", (20.0, 150.0), Anchor::Start, Run::Across, style);
        canvas.text("AVATAR", (350.0, 150.0), Anchor::Middle, Run::Up, Type { bold: true, ..style });
        canvas
    }

    #[test]
    fn a_pdf_embeds_its_letters_has_the_size_of_the_sheet_and_the_same_bytes_each_time() {
        let bytes = pdf(&sheet()).unwrap();
        assert_eq!(bytes, pdf(&sheet()).unwrap());
        assert!(bytes.starts_with(b"%PDF-1.") && bytes.len() < 60_000, "{}", bytes.len());
        let text = String::from_utf8_lossy(&bytes);
        for part in ["/FontFile2", "/MediaBox [0 0 150 75]", "DejaVuSans-Bold", "/ToUnicode", "/ca 0.5"] {
            assert!(text.contains(part), "{part}");
        }
        assert!(!text.contains("Date"), "a date would change the bytes");
    }
}
