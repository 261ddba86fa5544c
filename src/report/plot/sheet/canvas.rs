//! A sheet that is drawn on in pixels, y down: filled polygons, stroked paths, discs and text, cut to a clip and kept in order.
//! It has no axes and no data, and makes no image itself: `raster` and `svg` do.
//!
//! Coordinates stay fractional until then, which is what keeps slow curves and ship outlines smooth.

use super::geometry::{Px, Rect, clip_path, clip_polygon, cut_dashes};
use crate::report::plot::palette::Color;

/// The end of a text that is at the point it is placed on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::report::plot) enum Anchor {
    Start,
    Middle,
    End,
}

/// The way a text runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::report::plot) enum Run {
    Across,
    /// Turned a quarter to the left, as the label of a vertical axis.
    Up,
}

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub(in crate::report::plot) struct Type {
    pub size: f32,
    pub bold: bool,
    pub color: Color,
}

/// Something drawn on the sheet, already cut to its clip.
#[derive(Clone, Debug)]
pub(in crate::report::plot) enum Shape {
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
pub(in crate::report::plot) struct Canvas {
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

    /// Lines of text, the `k`-th placed at `at(k)`, each as [`Self::text`].
    pub fn lines(&mut self, lines: &[String], anchor: Anchor, run: Run, style: Type, at: impl Fn(f32) -> Px) {
        for (k, line) in lines.iter().enumerate() {
            self.text(line, at(k as f32), anchor, run, style);
        }
    }

    /// A text whose capitals are centred on `at` across the way it runs.
    pub fn text(&mut self, text: &str, at: Px, anchor: Anchor, run: Run, style: Type) {
        let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        if !text.trim().is_empty() {
            self.shapes.push(Shape::Text { text, at, anchor, run, style });
        }
    }
}
