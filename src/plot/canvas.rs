//! A sheet that is drawn on in pixels, y down: filled polygons, stroked paths, discs and text, cut to a clip and kept in order.
//! It knows nothing of axes or data, and makes no image itself: `render` plays the sheet on the backends of plotters.
//!
//! Coordinates stay fractional until then, which is what keeps slow curves and ship outlines smooth.

use super::figure::FigureError;
use super::palette::Color;
use super::render;
use ab_glyph::{Font, FontRef};

/// A point of the sheet: px from the left, px from the top.
pub(super) type Px = (f32, f32);

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

/// The way a text runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Run {
    Across,
    /// Turned a quarter to the left, as the label of a vertical axis.
    Up,
}

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Type {
    pub size: f32,
    pub bold: bool,
    pub color: Color,
}

/// Something drawn on the sheet, already cut to its clip.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    Polygon {
        corners: Vec<Px>,
        color: Color,
    },
    Rect {
        rect: Rect,
        color: Color,
    },
    /// One pen stroke in pieces: where they overlap, a translucent stroke is no darker.
    Stroke {
        pieces: Vec<Vec<Px>>,
        width: f32,
        color: Color,
    },
    Disc {
        center: Px,
        radius: f32,
        color: Color,
    },
    Text {
        text: String,
        at: Px,
        anchor: Anchor,
        run: Run,
        style: Type,
    },
}

/// The sheet.
pub(super) struct Canvas {
    pub width: u32,
    pub height: u32,
    pub shapes: Vec<Shape>,
    clip: Rect,
}

impl Canvas {
    /// A white sheet.
    pub fn new(width: u32, height: u32) -> Self {
        let clip = Rect { left: 0.0, top: 0.0, right: width as f32, bottom: height as f32 };
        Self { width, height, shapes: vec![], clip }
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
        let corners = clip_polygon(polygon, self.clip);
        if corners.len() > 2 && color.alpha > 0.0 {
            self.shapes.push(Shape::Polygon { corners, color });
        }
    }

    /// A filled rectangle.
    pub fn fill_rect(&mut self, rect: Rect, color: Color) {
        let rect = Rect {
            left: rect.left.max(self.clip.left),
            top: rect.top.max(self.clip.top),
            right: rect.right.min(self.clip.right),
            bottom: rect.bottom.min(self.clip.bottom),
        };
        if rect.width() > 0.0 && rect.height() > 0.0 && color.alpha > 0.0 {
            self.shapes.push(Shape::Rect { rect, color });
        }
    }

    /// The outline of a rectangle.
    pub fn stroke_rect(&mut self, rect: Rect, width: f32, color: Color) {
        let [a, b, c, d] = rect.corners();
        self.stroke(&[a, b, c, d, a], width, &[], color);
    }

    /// A path with round joins; `dash` alternates drawn and left-out lengths in px, empty for a solid line.
    pub fn stroke(&mut self, path: &[Px], width: f32, dash: &[f32], color: Color) {
        let pieces: Vec<_> = clip_path(path, self.clip).iter().flat_map(|piece| cut_dashes(piece, dash)).collect();
        if !pieces.is_empty() && color.alpha > 0.0 {
            self.shapes.push(Shape::Stroke { pieces, width, color });
        }
    }

    /// A filled disc; left out when its centre is outside the clip.
    pub fn disc(&mut self, center: Px, radius: f32, color: Color) {
        if self.clip.contains(center) && color.alpha > 0.0 {
            self.shapes.push(Shape::Disc { center, radius, color });
        }
    }

    /// A text whose capitals are centred on `at` across the way it runs.
    pub fn text(&mut self, text: &str, at: Px, anchor: Anchor, run: Run, style: Type) {
        let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        if !text.trim().is_empty() {
            self.shapes.push(Shape::Text { text, at, anchor, run, style });
        }
    }

    /// The sheet as PNG.
    pub fn into_png(self) -> Result<Vec<u8>, FigureError> {
        render::png(&self)
    }

    /// The sheet as an SVG document.
    pub fn into_svg(self) -> Result<String, FigureError> {
        render::svg(&self)
    }
}

/// Width of a text in px.
pub(super) fn text_width(text: &str, size: f32, bold: bool) -> f32 {
    // Without a font no image can be made, so the width is never used.
    let Ok(font) = render::font(bold) else { return 0.0 };
    advances(font, text, size).last().map_or(0.0, |&(_, end)| end)
}

/// Where each letter of a text starts and ends, in px from the start of the text.
pub(super) fn advances(font: &FontRef<'_>, text: &str, size: f32) -> Vec<(f32, f32)> {
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

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Rect = Rect { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };

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
}
