//! A sheet to draw on in pixels, y down: filled polygons, stroked paths, discs and text, as anti-aliased pixels or as SVG.
//! It knows nothing of axes or data. Both outputs take the same calls, so a PNG and an SVG of one figure look the same.
//!
//! Coordinates stay fractional down to the coverage of a pixel, which is what keeps slow curves and ship outlines smooth.

use super::figure::FigureError;
use super::palette::Color;
use ab_glyph::{Font, FontRef, OutlineCurve};
use ab_glyph_rasterizer::{Rasterizer, point};
use std::fmt::Write as _;
use std::sync::OnceLock;

/// A point of the sheet: px from the left, px from the top.
pub(super) type Px = (f32, f32);

/// Fonts with the same letter widths stand in where a viewer of an SVG lacks DejaVu Sans.
const FAMILY: &str = "DejaVu Sans, Bitstream Vera Sans, Verdana, sans-serif";
/// Half the height of a capital letter over the font size: text is placed by the middle of its capitals.
const HALF_CAPITAL: f32 = 0.365;
/// Sheets above this many pixels are refused instead of exhausting the memory.
const MOST_PIXELS: u64 = 200_000_000;

/// A rectangle of the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub left: f32,
    pub top: f32,
    pub right: f32,
    pub bottom: f32,
}

impl Rect {
    pub fn width(&self) -> f32 {
        self.right - self.left
    }

    pub fn height(&self) -> f32 {
        self.bottom - self.top
    }

    pub fn center(&self) -> Px {
        (0.5 * (self.left + self.right), 0.5 * (self.top + self.bottom))
    }

    pub fn contains(&self, (x, y): Px) -> bool {
        x >= self.left && x <= self.right && y >= self.top && y <= self.bottom
    }

    fn corners(&self) -> [Px; 4] {
        [(self.left, self.top), (self.right, self.top), (self.right, self.bottom), (self.left, self.bottom)]
    }
}

/// Which end of a text stands at the point it is placed on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Type {
    pub size: f32,
    pub bold: bool,
    pub color: Color,
}

struct Fonts {
    regular: FontRef<'static>,
    bold: FontRef<'static>,
}

fn fonts() -> Result<&'static Fonts, FigureError> {
    static FONTS: OnceLock<Option<Fonts>> = OnceLock::new();
    FONTS
        .get_or_init(|| {
            Some(Fonts {
                regular: FontRef::try_from_slice(dejavu::sans::regular()).ok()?,
                bold: FontRef::try_from_slice(dejavu::sans::bold()).ok()?,
            })
        })
        .as_ref()
        .ok_or(FigureError::Font)
}

enum Surface {
    Pixels { rgb: Vec<u8>, mask: Rasterizer },
    Svg(String),
}

/// The sheet.
pub(super) struct Canvas {
    width: u32,
    height: u32,
    clip: Rect,
    fonts: &'static Fonts,
    surface: Surface,
}

impl Canvas {
    /// A white sheet of pixels.
    pub fn pixels(width: u32, height: u32) -> Result<Self, FigureError> {
        if u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(FigureError::TooLarge { width, height });
        }
        let rgb = vec![255; width as usize * height as usize * 3];
        Self::new(width, height, Surface::Pixels { rgb, mask: Rasterizer::new(1, 1) })
    }

    /// A white SVG sheet, shown at half its size: figures are laid out for screens of double density.
    pub fn svg(width: u32, height: u32) -> Result<Self, FigureError> {
        let head = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"{FAMILY}\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n",
            width / 2,
            height / 2
        );
        Self::new(width, height, Surface::Svg(head))
    }

    fn new(width: u32, height: u32, surface: Surface) -> Result<Self, FigureError> {
        let clip = Rect { left: 0.0, top: 0.0, right: width as f32, bottom: height as f32 };
        Ok(Self { width, height, clip, fonts: fonts()?, surface })
    }

    /// The whole sheet.
    pub fn bounds(&self) -> Rect {
        Rect { left: 0.0, top: 0.0, right: self.width as f32, bottom: self.height as f32 }
    }

    /// Shapes drawn from now on are cut off at `clip`; text is not.
    pub fn clip_to(&mut self, clip: Rect) {
        self.clip = clip;
    }

    /// A filled polygon.
    pub fn fill(&mut self, polygon: &[Px], color: Color) {
        let inside = clip_polygon(polygon, self.clip);
        if inside.len() < 3 || color.alpha <= 0.0 {
            return;
        }
        match &mut self.surface {
            Surface::Pixels { rgb, mask } => {
                cover(rgb, mask, self.width, self.clip, color, std::slice::from_ref(&inside), false);
            }
            Surface::Svg(out) => {
                let _ = writeln!(out, "<polygon points=\"{}\" {}/>", Points(&inside), paint("fill", color));
            }
        }
    }

    /// A filled rectangle.
    pub fn fill_rect(&mut self, rect: Rect, color: Color) {
        self.fill(&rect.corners(), color);
    }

    /// The outline of a rectangle.
    pub fn stroke_rect(&mut self, rect: Rect, width: f32, color: Color) {
        let [a, b, c, d] = rect.corners();
        self.stroke(&[a, b, c, d, a], width, &[], color);
    }

    /// A path with round joins; `dash` alternates drawn and left-out lengths in px, empty for a solid line.
    pub fn stroke(&mut self, path: &[Px], width: f32, dash: &[f32], color: Color) {
        if color.alpha <= 0.0 {
            return;
        }
        let pieces = clip_path(path, self.clip);
        match &mut self.surface {
            Surface::Pixels { rgb, mask } => {
                let dashed: Vec<Vec<Px>> = pieces.iter().flat_map(|piece| cut_dashes(piece, dash)).collect();
                let shapes: Vec<Vec<Px>> = dashed.iter().flat_map(|piece| outline(piece, 0.5 * width)).collect();
                // Grouped shapes are painted once, so that a translucent line is not darker where it crosses itself.
                cover(rgb, mask, self.width, self.clip, color, &shapes, true);
            }
            Surface::Svg(out) => {
                let dash = if dash.is_empty() {
                    String::new()
                } else {
                    let lengths: Vec<String> = dash.iter().map(|d| format!("{d}")).collect();
                    format!(" stroke-dasharray=\"{}\"", lengths.join(" "))
                };
                for piece in &pieces {
                    let _ = writeln!(
                        out,
                        "<polyline points=\"{}\" fill=\"none\" stroke-width=\"{width}\" stroke-linejoin=\"round\"{dash} {}/>",
                        Points(piece),
                        paint("stroke", color)
                    );
                }
            }
        }
    }

    /// A filled disc; left out when its centre is outside the clip.
    pub fn disc(&mut self, center: Px, radius: f32, color: Color) {
        if !self.clip.contains(center) || color.alpha <= 0.0 {
            return;
        }
        match &mut self.surface {
            Surface::Pixels { rgb, mask } => {
                cover(rgb, mask, self.width, self.clip, color, &[circle(center, radius)], false);
            }
            Surface::Svg(out) => {
                let _ = writeln!(
                    out,
                    "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius:.1}\" {}/>",
                    center.0,
                    center.1,
                    paint("fill", color)
                );
            }
        }
    }

    /// A text whose capitals are centred on the height of `at`, turned by `turn` radians clockwise about `at`.
    pub fn text(&mut self, text: &str, at: Px, anchor: Anchor, turn: f32, style: Type) {
        if text.trim().is_empty() {
            return;
        }
        let Type { size, bold, color } = style;
        match &mut self.surface {
            Surface::Pixels { rgb, mask } => {
                let font = if bold { &self.fonts.bold } else { &self.fonts.regular };
                let places = advances(font, text, size);
                let width = places.last().map_or(0.0, |&(_, end)| end);
                let start = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => -0.5 * width,
                    Anchor::End => -width,
                };
                let em = size / font.units_per_em().unwrap_or(1.0);
                let (sin, cos) = turn.sin_cos();
                let whole = Rect { left: 0.0, top: 0.0, right: self.width as f32, bottom: self.height as f32 };
                for (c, (from, _)) in text.chars().zip(places) {
                    let Some(glyph) = font.outline(font.glyph_id(c)) else { continue };
                    let place = |p: ab_glyph::Point| {
                        let (x, y) = (start + from + p.x * em, HALF_CAPITAL * size - p.y * em);
                        (at.0 + x * cos - y * sin, at.1 + x * sin + y * cos)
                    };
                    cover_glyph(rgb, mask, self.width, whole, color, &glyph.curves, place);
                }
            }
            Surface::Svg(out) => {
                let anchor = match anchor {
                    Anchor::Start => "start",
                    Anchor::Middle => "middle",
                    Anchor::End => "end",
                };
                let weight = if bold { " font-weight=\"bold\"" } else { "" };
                let turned = if turn == 0.0 {
                    String::new()
                } else {
                    format!(" transform=\"rotate({:.1} {:.1} {:.1})\"", turn.to_degrees(), at.0, at.1)
                };
                let _ = writeln!(
                    out,
                    "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"{size}\" text-anchor=\"{anchor}\"{weight}{turned} {}>{}</text>",
                    at.0,
                    at.1 + HALF_CAPITAL * size,
                    paint("fill", color),
                    Escaped(text)
                );
            }
        }
    }

    /// The sheet as PNG; empty for an SVG sheet.
    pub fn into_png(self) -> Result<Vec<u8>, FigureError> {
        let mut bytes = Vec::new();
        if let Surface::Pixels { rgb, .. } = self.surface {
            let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_depth(png::BitDepth::Eight);
            encoder.set_compression(png::Compression::Balanced);
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&rgb)?;
            writer.finish()?;
        }
        Ok(bytes)
    }

    /// The sheet as an SVG document; empty for a sheet of pixels.
    pub fn into_svg(self) -> String {
        match self.surface {
            Surface::Svg(out) => out + "</svg>\n",
            Surface::Pixels { .. } => String::new(),
        }
    }
}

/// Width of a text in px.
pub(super) fn text_width(text: &str, size: f32, bold: bool) -> f32 {
    // Without a font no sheet can be made, so the width is never used.
    let Ok(fonts) = fonts() else { return 0.0 };
    let font = if bold { &fonts.bold } else { &fonts.regular };
    advances(font, text, size).last().map_or(0.0, |&(_, end)| end)
}

/// Where each letter of a text starts and ends, in px from the start of the text.
fn advances(font: &FontRef<'_>, text: &str, size: f32) -> Vec<(f32, f32)> {
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

/// The whole pixels around `points`, cut to `clip`; `None` when nothing is left.
fn pixel_box<'a>(points: impl Iterator<Item = &'a Px>, clip: Rect) -> Option<(usize, usize, usize, usize)> {
    let (mut x0, mut y0, mut x1, mut y1) = (f32::MAX, f32::MAX, f32::MIN, f32::MIN);
    for &(x, y) in points {
        (x0, y0, x1, y1) = (x0.min(x), y0.min(y), x1.max(x), y1.max(y));
    }
    let (x0, y0) = (x0.max(clip.left).floor().max(0.0), y0.max(clip.top).floor().max(0.0));
    let (x1, y1) = (x1.min(clip.right).ceil(), y1.min(clip.bottom).ceil());
    (x1 > x0 && y1 > y0).then_some((x0 as usize, y0 as usize, x1 as usize, y1 as usize))
}

/// Paints `shapes` onto the pixels. As one group their overlaps are painted once.
fn cover(
    rgb: &mut [u8],
    mask: &mut Rasterizer,
    width: u32,
    clip: Rect,
    color: Color,
    shapes: &[Vec<Px>],
    grouped: bool,
) {
    let Some((x0, y0, x1, y1)) = pixel_box(shapes.iter().flatten(), clip) else { return };
    let bounds = Rect { left: x0 as f32, top: y0 as f32, right: x1 as f32, bottom: y1 as f32 };
    // A column to spare on either side takes what rounding puts outside.
    mask.reset(x1 - x0 + 2, y1 - y0 + 1);
    let local = |(x, y): Px| point(x - x0 as f32 + 1.0, y - y0 as f32);
    for shape in shapes {
        let mut shape = clip_polygon(shape, bounds);
        if grouped && signed_area(&shape) < 0.0 {
            shape.reverse();
        }
        for i in 0..shape.len() {
            mask.draw_line(local(shape[i]), local(shape[(i + 1) % shape.len()]));
        }
    }
    blend(rgb, mask, width, (x0, y0), color);
}

fn cover_glyph(
    rgb: &mut [u8],
    mask: &mut Rasterizer,
    width: u32,
    sheet: Rect,
    color: Color,
    curves: &[OutlineCurve],
    place: impl Fn(ab_glyph::Point) -> Px,
) {
    let placed: Vec<Vec<Px>> = curves
        .iter()
        .map(|curve| match *curve {
            OutlineCurve::Line(a, b) => vec![place(a), place(b)],
            OutlineCurve::Quad(a, b, c) => vec![place(a), place(b), place(c)],
            OutlineCurve::Cubic(a, b, c, d) => vec![place(a), place(b), place(c), place(d)],
        })
        .collect();
    let everywhere = Rect { left: f32::MIN, top: f32::MIN, right: f32::MAX, bottom: f32::MAX };
    // Letters over the edge of the sheet are left out whole: the layout keeps text inside.
    let inside = placed.iter().flatten().all(|&p| sheet.contains(p));
    let Some((x0, y0, x1, y1)) = pixel_box(placed.iter().flatten(), everywhere).filter(|_| inside) else { return };
    mask.reset(x1 - x0 + 2, y1 - y0 + 1);
    let local = |(x, y): Px| point(x - x0 as f32 + 1.0, y - y0 as f32);
    for curve in &placed {
        match curve[..] {
            [a, b] => mask.draw_line(local(a), local(b)),
            [a, b, c] => mask.draw_quad(local(a), local(b), local(c)),
            [a, b, c, d] => mask.draw_cubic(local(a), local(b), local(c), local(d)),
            _ => {}
        }
    }
    blend(rgb, mask, width, (x0, y0), color);
}

/// Blends a colour over the pixels, weighted by how much of each the mask covers.
fn blend(rgb: &mut [u8], mask: &Rasterizer, width: u32, (x0, y0): (usize, usize), color: Color) {
    let columns = mask.dimensions().0;
    mask.for_each_pixel(|i, coverage| {
        let weight = coverage.min(1.0) * color.alpha;
        let (x, y) = (i % columns, i / columns);
        if weight < 1.0 / 512.0 || x == 0 || x0 + x > width as usize {
            return;
        }
        let start = ((y0 + y) * width as usize + x0 + x - 1) * 3;
        if let Some(pixel) = rgb.get_mut(start..start + 3) {
            for (old, new) in pixel.iter_mut().zip([color.r, color.g, color.b]) {
                *old = (f32::from(*old) + (f32::from(new) - f32::from(*old)) * weight).round() as u8;
            }
        }
    });
}

fn signed_area(polygon: &[Px]) -> f32 {
    let n = polygon.len();
    (0..n).map(|i| (polygon[i], polygon[(i + 1) % n])).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum()
}

fn circle((x, y): Px, radius: f32) -> Vec<Px> {
    let n = (12.0 + 2.0 * radius).min(64.0) as usize;
    (0..n)
        .map(|i| (i as f32 * std::f32::consts::TAU / n as f32).sin_cos())
        .map(|(sin, cos)| (x + radius * cos, y + radius * sin))
        .collect()
}

/// The area a round-jointed pen of radius `half` covers along a path, as overlapping convex shapes.
fn outline(path: &[Px], half: f32) -> Vec<Vec<Px>> {
    let mut shapes = Vec::with_capacity(2 * path.len());
    for pair in path.windows(2) {
        let ((ax, ay), (bx, by)) = (pair[0], pair[1]);
        let (dx, dy) = (bx - ax, by - ay);
        let length = dx.hypot(dy);
        if length > 1e-3 {
            let (nx, ny) = (-dy / length * half, dx / length * half);
            shapes.push(vec![(ax + nx, ay + ny), (bx + nx, by + ny), (bx - nx, by - ny), (ax - nx, ay - ny)]);
        }
    }
    // A disc fills the notch at a corner; on a nearly straight run there is none to fill.
    for corner in path.windows(3) {
        let (u, v) = (
            (corner[1].0 - corner[0].0, corner[1].1 - corner[0].1),
            (corner[2].0 - corner[1].0, corner[2].1 - corner[1].1),
        );
        let (lu, lv) = (u.0.hypot(u.1), v.0.hypot(v.1));
        if u.0 * v.0 + u.1 * v.1 < 0.995 * lu * lv {
            shapes.push(circle(corner[1], half));
        }
    }
    shapes
}

/// The drawn parts of a dashed path; the whole path when `dash` is empty.
fn cut_dashes(path: &[Px], dash: &[f32]) -> Vec<Vec<Px>> {
    if dash.is_empty() || dash.iter().any(|&d| d <= 0.0) {
        return vec![path.to_vec()];
    }
    let mut parts = Vec::new();
    let mut part = path.first().map_or(vec![], |&p| vec![p]);
    let (mut i, mut left) = (0, dash[0]);
    for pair in path.windows(2) {
        let (mut a, b) = (pair[0], pair[1]);
        loop {
            let length = (b.0 - a.0).hypot(b.1 - a.1);
            if length <= left || length.is_nan() {
                left -= length;
                if i % 2 == 0 {
                    part.push(b);
                }
                break;
            }
            let t = left / length;
            a = (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
            if i % 2 == 0 {
                part.push(a);
                parts.push(std::mem::take(&mut part));
            } else {
                part = vec![a];
            }
            i += 1;
            left = dash[i % dash.len()];
        }
    }
    if part.len() > 1 {
        parts.push(part);
    }
    parts
}

/// The parts of a path inside a rectangle (Liang and Barsky 1984, segment by segment).
fn clip_path(path: &[Px], clip: Rect) -> Vec<Vec<Px>> {
    let mut pieces: Vec<Vec<Px>> = Vec::new();
    let mut open = false;
    for pair in path.windows(2) {
        let Some((a, b, ends_inside)) = clip_segment(pair[0], pair[1], clip) else {
            open = false;
            continue;
        };
        match pieces.last_mut().filter(|_| open) {
            Some(piece) => piece.push(b),
            None => pieces.push(vec![a, b]),
        }
        open = ends_inside;
    }
    pieces
}

fn clip_segment(a: Px, b: Px, clip: Rect) -> Option<(Px, Px, bool)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut t0, mut t1) = (0.0f32, 1.0f32);
    for (p, q) in [(-dx, a.0 - clip.left), (dx, clip.right - a.0), (-dy, a.1 - clip.top), (dy, clip.bottom - a.1)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            t0 = t0.max(q / p);
        } else {
            t1 = t1.min(q / p);
        }
    }
    let at = |t: f32| (a.0 + t * dx, a.1 + t * dy);
    (t0 <= t1).then(|| (if t0 > 0.0 { at(t0) } else { a }, if t1 < 1.0 { at(t1) } else { b }, t1 >= 1.0))
}

/// The part of a polygon inside a rectangle (Sutherland and Hodgman 1974).
fn clip_polygon(polygon: &[Px], clip: Rect) -> Vec<Px> {
    type Side = (fn(Px, Rect) -> f32, fn(Px, Rect) -> Px);
    // Signed distance inside each side, and the projection onto it that undoes rounding.
    let sides: [Side; 4] = [
        (|p, c| p.0 - c.left, |p, c| (c.left, p.1)),
        (|p, c| c.right - p.0, |p, c| (c.right, p.1)),
        (|p, c| p.1 - c.top, |p, c| (p.0, c.top)),
        (|p, c| c.bottom - p.1, |p, c| (p.0, c.bottom)),
    ];
    let mut points = polygon.to_vec();
    for (inside, onto) in sides {
        let mut kept = Vec::with_capacity(points.len() + 4);
        for i in 0..points.len() {
            let (a, b) = (points[i], points[(i + 1) % points.len()]);
            let (da, db) = (inside(a, clip), inside(b, clip));
            if da >= 0.0 {
                kept.push(a);
            }
            if (da >= 0.0) != (db >= 0.0) {
                let t = da / (da - db);
                kept.push(onto((a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)), clip));
            }
        }
        points = kept;
    }
    points
}

fn paint(what: &str, color: Color) -> String {
    let opacity = if color.alpha < 1.0 { format!(" {what}-opacity=\"{:.2}\"", color.alpha) } else { String::new() };
    format!("{what}=\"#{:02x}{:02x}{:02x}\"{opacity}", color.r, color.g, color.b)
}

/// Points as an SVG attribute.
struct Points<'a>(&'a [Px]);

impl std::fmt::Display for Points<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, (x, y)) in self.0.iter().enumerate() {
            let gap = if i == 0 { "" } else { " " };
            write!(f, "{gap}{x:.1},{y:.1}")?;
        }
        Ok(())
    }
}

/// Text as SVG content.
struct Escaped<'a>(&'a str);

impl std::fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for c in self.0.chars() {
            match c {
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '&' => f.write_str("&amp;")?,
                c if c.is_control() => f.write_str(" ")?,
                c => write!(f, "{c}")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Rect = Rect { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };
    const BLACK: Color = Color::rgb(0, 0, 0);

    fn ink(canvas: &Canvas) -> f64 {
        match &canvas.surface {
            Surface::Pixels { rgb, .. } => rgb.iter().map(|&v| 1.0 - f64::from(v) / 255.0).sum::<f64>() / 3.0,
            Surface::Svg(_) => f64::NAN,
        }
    }

    #[test]
    fn a_filled_shape_covers_its_area_wherever_it_lies_on_the_grid() {
        for shift in [0.0, 0.25, 0.7] {
            let mut canvas = Canvas::pixels(40, 40).unwrap();
            canvas.fill(&[(5.0 + shift, 5.0), (25.0 + shift, 5.0 + shift), (12.0, 30.0 + shift)], BLACK);
            let area = 0.5 * signed_area(&[(5.0 + shift, 5.0), (25.0 + shift, 5.0 + shift), (12.0, 30.0 + shift)]);
            assert!((ink(&canvas) - f64::from(area)).abs() < 1.0, "{} {area}", ink(&canvas));
        }
    }

    #[test]
    fn a_line_covers_its_length_times_its_width_in_any_direction() {
        for angle in [0.0f32, 0.3, 1.0, std::f32::consts::FRAC_PI_2, 2.5] {
            let mut canvas = Canvas::pixels(100, 100).unwrap();
            let (sin, cos) = angle.sin_cos();
            let path: Vec<Px> =
                (0..=10).map(|i| (i as f32 - 5.0) * 8.0).map(|s| (50.0 + s * cos, 50.0 + s * sin)).collect();
            canvas.stroke(&path, 4.0, &[], BLACK);
            assert!((ink(&canvas) - 320.0).abs() < 8.0, "{angle} {}", ink(&canvas));
        }
    }

    #[test]
    fn a_translucent_line_is_not_darker_where_it_crosses_itself() {
        let mut canvas = Canvas::pixels(40, 40).unwrap();
        canvas.stroke(&[(5.0, 20.0), (35.0, 20.0), (20.0, 35.0), (20.0, 5.0)], 6.0, &[], BLACK.faded(0.5));
        if let Surface::Pixels { rgb, .. } = &canvas.surface {
            assert!(rgb.iter().all(|&v| v >= 127));
        }
    }

    #[test]
    fn nothing_is_painted_outside_the_clip() {
        let mut canvas = Canvas::pixels(20, 20).unwrap();
        canvas.clip_to(BOX);
        canvas.fill(&[(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)], BLACK);
        assert!((ink(&canvas) - 100.0).abs() < 1e-6);
        canvas.stroke(&[(-50.0, 15.0), (60.0, 15.0)], 3.0, &[], BLACK);
        canvas.disc((14.0, 14.0), 5.0, BLACK);
        assert!((ink(&canvas) - 100.0).abs() < 1e-6);
    }

    #[test]
    fn a_path_that_leaves_and_returns_is_cut_in_two() {
        let pieces = clip_path(&[(2.0, 5.0), (20.0, 5.0), (20.0, 8.0), (2.0, 8.0)], BOX);
        assert_eq!(pieces, vec![vec![(2.0, 5.0), (10.0, 5.0)], vec![(10.0, 8.0), (2.0, 8.0)]]);
    }

    #[test]
    fn dashes_keep_their_share_of_the_path() {
        let parts = cut_dashes(&[(0.0, 0.0), (30.0, 0.0), (30.0, 30.0)], &[6.0, 4.0]);
        let drawn: f32 =
            parts.iter().flat_map(|p| p.windows(2)).map(|s| (s[1].0 - s[0].0).hypot(s[1].1 - s[0].1)).sum();
        assert!((drawn - 36.0).abs() < 1e-3);
    }

    #[test]
    fn greek_letters_superscripts_and_signs_have_glyphs() {
        let fonts = fonts().unwrap();
        for c in "ψδρΔβαη²³⁻⁶·×±−–≤≥°→".chars() {
            assert_ne!(fonts.regular.glyph_id(c).0, 0, "{c}");
            assert_ne!(fonts.bold.glyph_id(c).0, 0, "{c}");
        }
    }

    #[test]
    fn text_in_svg_is_escaped() {
        let mut canvas = Canvas::svg(100, 100).unwrap();
        canvas.text("R'(u) > 0 & <b>", (5.0, 5.0), Anchor::Start, 0.0, Type { size: 12.0, bold: false, color: BLACK });
        let svg = canvas.into_svg();
        assert!(svg.contains("R'(u) &gt; 0 &amp; &lt;b&gt;"), "{svg}");
    }

    #[test]
    fn a_sheet_too_large_for_the_memory_is_refused() {
        assert!(matches!(Canvas::pixels(100_000, 100_000), Err(FigureError::TooLarge { .. })));
    }
}
