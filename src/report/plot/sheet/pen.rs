//! Colours, fonts and errors in the types of plotters.
//! It draws nothing: `raster` and `svg` do, each with its own elements.

use super::canvas::{Anchor, Run, Type};
use super::font::FAMILY;
use crate::report::plot::error::FigureError;
use crate::report::plot::palette::Color;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub(in crate::report::plot) fn rgba(color: Color) -> RGBAColor {
    // Three digits of an opacity are plenty, and spare an SVG the tail of the conversion.
    RGBAColor(color.r, color.g, color.b, (f64::from(color.alpha) * 1e3).round() / 1e3)
}

pub(in crate::report::plot) fn text_style(style: Type, size: f64, run: Run, anchor: Anchor) -> TextStyle<'static> {
    let weight = if style.bold { FontStyle::Bold } else { FontStyle::Normal };
    let turn = match run {
        Run::Across => FontTransform::None,
        Run::Up => FontTransform::Rotate270,
    };
    let side = match anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    FontDesc::new(FontFamily::Name(FAMILY), size, weight)
        .transform(turn)
        .color(&rgba(style.color))
        .pos(Pos::new(side, VPos::Top))
}

pub(in crate::report::plot) fn failed<E: std::error::Error + Send + Sync>(
    error: DrawingAreaErrorKind<E>,
) -> FigureError {
    FigureError::Drawing(error.to_string())
}
