//! A sheet as SVG: every shape becomes one element of plotters, in tenths of a pixel since its backend takes whole numbers.
//! What the shapes are and where they lie was decided before; nothing here knows of axes or data.

use super::canvas::{Canvas, Run, Shape};
use super::font::HALF_CAPITAL;
use super::geometry::Px;
use super::pen::{failed, rgba, text_style};
use crate::report::plot::error::FigureError;
use plotters::coord::Shift;
use plotters::prelude::*;

/// Units of the SVG to a pixel.
const TENTHS: f32 = 10.0;

/// The sheet as an SVG document, shown at half its size: figures are laid out for screens of double density.
pub(in crate::report::plot) fn svg(sheet: &Canvas) -> Result<String, FigureError> {
    let size = (sheet.width * TENTHS as u32, sheet.height * TENTHS as u32);
    let mut drawn = String::new();
    {
        let area = SVGBackend::with_string(&mut drawn, size).into_drawing_area();
        area.fill(&WHITE).map_err(failed)?;
        for shape in &sheet.shapes {
            svg_shape(&area, shape)?;
        }
        area.present().map_err(failed)?;
    }
    // The first line is the opening tag, to which plotters adds neither the size to be shown at nor round joins.
    let body = drawn.split_once('\n').map_or("", |(_, body)| body);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
         stroke-linejoin=\"round\">\n{body}",
        sheet.width / 2,
        sheet.height / 2,
        size.0,
        size.1
    ))
}

fn svg_shape(area: &DrawingArea<SVGBackend<'_>, Shift>, shape: &Shape) -> Result<(), FigureError> {
    let tenths = |v: f32| (v * TENTHS).round();
    let place = |&(x, y): &Px| (tenths(x) as i32, tenths(y) as i32);
    let places = |points: &[Px]| points.iter().map(place).collect::<Vec<_>>();
    match shape {
        Shape::Polygon { corners, color } => area.draw(&Polygon::new(places(corners), rgba(*color))),
        Shape::Rect { rect, color } => {
            let corners = [place(&(rect.left, rect.top)), place(&(rect.right, rect.bottom))];
            area.draw(&Rectangle::new(corners, rgba(*color).filled()))
        }
        Shape::Stroke { pieces, width, color } => {
            let pen = rgba(*color).stroke_width(tenths(*width) as u32);
            pieces.iter().try_for_each(|piece| area.draw(&PathElement::new(places(piece), pen)))
        }
        Shape::Disc { center, radius, color } => {
            area.draw(&Circle::new(place(center), tenths(*radius) as u32, rgba(*color).filled()))
        }
        Shape::Text { text, at, anchor, run, style } => {
            // The SVG of plotters has a font 1/1.24 of the size it is given, and the baseline 0.76 of that below the point.
            let down = (HALF_CAPITAL - 0.76) * style.size;
            let corner = match run {
                Run::Across => (at.0, at.1 + down),
                Run::Up => (at.0 + down, at.1),
            };
            let pen = text_style(*style, 1.24 * f64::from(style.size * TENTHS), *run, *anchor);
            area.draw(&Text::new(text.as_str(), place(&corner), pen))
        }
    }
    .map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::palette::Color;
    use crate::report::plot::sheet::canvas::{Anchor, Type};

    #[test]
    fn text_in_svg_is_escaped() {
        let mut canvas = Canvas::new(100, 100);
        let style = Type { size: 12.0, bold: false, color: Color::rgb(0, 0, 0) };
        canvas.text("R'(u) > 0 & <b>\u{1}", (5.0, 5.0), Anchor::Start, Run::Across, style);
        let svg = svg(&canvas).unwrap();
        assert!(svg.contains("R&apos;(u) &gt; 0 &amp; &lt;b&gt; \n"), "{svg}");
    }
}
