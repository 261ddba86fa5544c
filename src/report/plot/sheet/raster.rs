//! A sheet as PNG: every shape becomes elements of plotters, drawn by its bitmap backend at several times the size and averaged.
//! What the shapes are and where they lie was decided before; nothing here knows of axes or data.

use super::canvas::{Anchor, Canvas, Run, Shape, Type};
use super::compact::encode;
use super::font::{HALF_CAPITAL, advances, font};
use super::geometry::{Px, Rect};
use super::pen::{failed, rgba, text_style};
use crate::report::plot::error::FigureError;
use crate::report::plot::palette::Color;
use ab_glyph::Font;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::Color as _;

/// Figures above this many pixels are refused instead of exhausting the memory.
const MOST_PIXELS: u64 = 40_000_000;
/// Samples along each side of a pixel.
const SAMPLES: u32 = 3;
const SCALE: f32 = SAMPLES as f32;
/// The sheet as PNG.
pub(in crate::report::plot) fn png(sheet: &Canvas) -> Result<Vec<u8>, FigureError> {
    let (width, height) = (sheet.width, sheet.height);
    encode(&pixels(sheet)?, width, height)
}

/// The sheet as red, green and blue of each pixel, row by row.
fn pixels(sheet: &Canvas) -> Result<Vec<u8>, FigureError> {
    let (width, height) = (sheet.width, sheet.height);
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(FigureError::TooLarge { width, height });
    }
    let size = (width * SAMPLES, height * SAMPLES);
    let stride = size.0 as usize * 3;
    let mut samples = vec![255; stride * size.1 as usize];
    for shape in &sheet.shapes {
        let translucent = match shape {
            Shape::Stroke { pieces, width, color } if color.alpha < 1.0 => Some((heights(pieces, *width), color.alpha)),
            _ => None,
        };
        // The parts of a stroke overlap: they are drawn solid, and then made translucent as a whole.
        let backdrop = translucent.map(|((top, bottom), alpha)| {
            let row = |y: f32| ((y.max(0.0) * SCALE) as usize).min(size.1 as usize);
            let rows = row(top) * stride..row(bottom) * stride;
            (samples[rows.clone()].to_vec(), rows, alpha)
        });
        bitmap_shape(&BitMapBackend::with_buffer(&mut samples, size).into_drawing_area(), shape)?;
        if let Some((backdrop, rows, alpha)) = backdrop {
            // In 256ths, so that whole rows are blended at a time.
            let share = (alpha * 256.0).round() as u16;
            for (new, old) in samples[rows].iter_mut().zip(backdrop) {
                *new = ((u16::from(old) * (256 - share) + u16::from(*new) * share + 128) >> 8) as u8;
            }
        }
    }
    Ok(average(&samples, stride))
}

/// From the top to the bottom of a stroke, px.
fn heights(pieces: &[Vec<Px>], width: f32) -> (f32, f32) {
    let points = pieces.iter().flatten();
    let (top, bottom) = points.fold((f32::MAX, f32::MIN), |(lo, hi), p| (lo.min(p.1), hi.max(p.1)));
    (top - width - 1.0, bottom + width + 1.0)
}

/// The mean of the samples of each pixel.
fn average(samples: &[u8], stride: usize) -> Vec<u8> {
    const N: usize = SAMPLES as usize;
    const ALL: u16 = (N * N) as u16;
    let mut rgb = vec![0; samples.len() / (N * N)];
    let mut sums = vec![0u16; stride];
    for (rows, out) in samples.chunks(stride * N).zip(rgb.chunks_mut(stride / N)) {
        sums.fill(0);
        for row in rows.chunks(stride) {
            sums.iter_mut().zip(row).for_each(|(sum, &v)| *sum += u16::from(v));
        }
        for (pixel, mean) in sums.chunks_exact(3 * N).zip(out.chunks_exact_mut(3)) {
            for channel in 0..3 {
                let sum: u16 = (0..N).map(|i| pixel[3 * i + channel]).sum();
                mean[channel] = ((sum + ALL / 2) / ALL) as u8;
            }
        }
    }
    rgb
}

type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;

/// The edge between samples nearest to a point.
fn edge((x, y): Px) -> (i32, i32) {
    ((x * SCALE).round() as i32, (y * SCALE).round() as i32)
}

/// The sample a point is in.
fn sample((x, y): Px) -> (i32, i32) {
    ((x * SCALE).floor() as i32, (y * SCALE).floor() as i32)
}

fn bitmap_shape(area: &Area<'_>, shape: &Shape) -> Result<(), FigureError> {
    match shape {
        Shape::Polygon { corners, color } => polygon(area, corners, *color),
        Shape::Rect { rect, color } => rectangle(area, *rect, *color),
        Shape::Stroke { pieces, width, color } => {
            pieces.iter().try_for_each(|piece| stroke(area, piece, *width, Color { alpha: 1.0, ..*color }))
        }
        Shape::Disc { center, radius, color } => disc(area, *center, *radius, *color),
        Shape::Text { text, at, anchor, run, style } => letters(area, text, *at, *anchor, *run, *style),
    }
}

fn polygon(area: &Area<'_>, corners: &[Px], color: Color) -> Result<(), FigureError> {
    let corners: Vec<_> = corners.iter().map(|&p| sample(p)).collect();
    area.draw(&Polygon::new(corners, rgba(color))).map_err(failed)
}

fn rectangle(area: &Area<'_>, rect: Rect, color: Color) -> Result<(), FigureError> {
    let corners = [edge((rect.left, rect.top)), edge((rect.right, rect.bottom))];
    area.draw(&Rectangle::new(corners, rgba(color).filled())).map_err(failed)
}

fn disc(area: &Area<'_>, center: Px, radius: f32, color: Color) -> Result<(), FigureError> {
    // Of plotters' circle the sample in the middle is no part of the radius.
    let radius = (radius * SCALE - 0.5).round().max(0.0) as u32;
    area.draw(&Circle::new(sample(center), radius, rgba(color).filled())).map_err(failed)
}

/// Segments and round joins one by one: a wide path of plotters is a single polygon, and that leaves holes where a noisy
/// line folds back on itself.
fn stroke(area: &Area<'_>, path: &[Px], width: f32, color: Color) -> Result<(), FigureError> {
    for pair in path.windows(2) {
        segment(area, pair[0], pair[1], width, color)?;
    }
    for corner in path.windows(3) {
        if turns(corner) {
            disc(area, corner[1], 0.5 * width, color)?;
        }
    }
    Ok(())
}

fn segment(area: &Area<'_>, a: Px, b: Px, width: f32, color: Color) -> Result<(), FigureError> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length = dx.hypot(dy);
    if length < 1e-3 {
        return Ok(());
    }
    if dx.abs().min(dy.abs()) < 0.5 / SCALE {
        // Along the grid every line of one width is to have the same number of samples.
        let across = (width * SCALE).round().max(1.0) / SCALE;
        let corner = |v: f32| ((v - 0.5 * across) * SCALE).round() / SCALE;
        let rect = if dx.abs() > dy.abs() {
            let top = corner(0.5 * (a.1 + b.1));
            Rect { left: a.0.min(b.0), right: a.0.max(b.0), top, bottom: top + across }
        } else {
            let left = corner(0.5 * (a.0 + b.0));
            Rect { left, right: left + across, top: a.1.min(b.1), bottom: a.1.max(b.1) }
        };
        return rectangle(area, rect, color);
    }
    // plotters' polygon includes the samples under its edges: one too many across a flat line, half of one across a steep one.
    let excess = if dx.abs() > dy.abs() { dx.abs() / length } else { 0.5 * dy.abs() / length };
    let half = 0.5 * (width - excess / SCALE).max(0.0);
    let (nx, ny) = (-dy / length * half, dx / length * half);
    let corners = [(a.0 + nx, a.1 + ny), (b.0 + nx, b.1 + ny), (b.0 - nx, b.1 - ny), (a.0 - nx, a.1 - ny)];
    polygon(area, &corners, color)
}

/// Letter by letter: plotters drops the space a letter has on its left, which sets whole words unevenly.
fn letters(area: &Area<'_>, text: &str, at: Px, anchor: Anchor, run: Run, style: Type) -> Result<(), FigureError> {
    let font = font(style.bold)?;
    let em = style.size / font.units_per_em().unwrap_or(1.0);
    // For plotters the size of a font is the height of its line, and the baseline half of that below the point.
    let line = font.height_unscaled() * em;
    let pen = text_style(style, f64::from(line * SCALE), run, Anchor::Start);
    let places = advances(font, text, style.size);
    let width = places.last().map_or(0.0, |&(_, end)| end);
    let start = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * width,
        Anchor::End => -width,
    };
    let down = HALF_CAPITAL * style.size - 0.5 * line;
    let mut letter = [0; 4];
    for (c, (from, _)) in text.chars().zip(places) {
        let Some(outline) = font.outline(font.glyph_id(c)) else { continue };
        let along = start + from + outline.bounds.min.x * em;
        let corner = match run {
            Run::Across => (at.0 + along, at.1 + down),
            Run::Up => (at.0 + down, at.1 - along),
        };
        area.draw(&Text::new(&*c.encode_utf8(&mut letter), sample(corner), pen.clone())).map_err(failed)?;
    }
    Ok(())
}

/// Whether a path turns so much at the middle of three points that there is a notch to fill.
fn turns(corner: &[Px]) -> bool {
    let (u, v) = (
        (corner[1].0 - corner[0].0, corner[1].1 - corner[0].1),
        (corner[2].0 - corner[1].0, corner[2].1 - corner[1].1),
    );
    u.0 * v.0 + u.1 * v.1 < 0.995 * u.0.hypot(u.1) * v.0.hypot(v.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLACK: Color = Color::rgb(0, 0, 0);

    /// Pixels covered by what was drawn in black.
    fn ink(canvas: &Canvas) -> f64 {
        pixels(canvas).unwrap().iter().map(|&v| 1.0 - f64::from(v) / 255.0).sum::<f64>() / 3.0
    }

    #[test]
    fn a_filled_shape_covers_its_area_wherever_it_lies_on_the_grid() {
        for shift in [0.0, 0.25, 0.7] {
            let mut canvas = Canvas::new(80, 80);
            canvas.fill(&[(10.0 + shift, 10.0), (70.0 + shift, 10.0 + shift), (30.0, 70.0 + shift)], BLACK);
            // Half the cross product of two sides.
            let ((ux, uy), (vx, vy)) = ((60.0, shift), (20.0 - shift, 60.0 + shift));
            let area = f64::from(0.5 * (ux * vy - uy * vx));
            assert!((ink(&canvas) - area).abs() < 0.025 * area, "{} {area}", ink(&canvas));
            let mut canvas = Canvas::new(80, 80);
            canvas.fill_rect(Rect { left: 3.0 + shift, top: 8.0, right: 43.0 + shift, bottom: 28.0 }, BLACK);
            assert!((ink(&canvas) - 800.0).abs() < 1e-6, "{}", ink(&canvas));
        }
    }

    #[test]
    fn a_line_covers_its_length_times_its_width_in_any_direction() {
        for angle in [0.0f32, 0.3, 1.0, std::f32::consts::FRAC_PI_2, 2.5] {
            let mut canvas = Canvas::new(100, 100);
            let (sin, cos) = angle.sin_cos();
            let path: Vec<Px> =
                (0..=10).map(|i| (i as f32 - 5.0) * 8.0).map(|s| (50.0 + s * cos, 50.0 + s * sin)).collect();
            canvas.stroke(&path, 4.0, &[], BLACK);
            assert!((ink(&canvas) - 320.0).abs() < 16.0, "{angle} {}", ink(&canvas));
        }
    }

    #[test]
    fn a_line_that_folds_back_on_itself_has_no_holes() {
        let mut canvas = Canvas::new(60, 60);
        let path: Vec<Px> = (0..40).map(|i| (10.0 + i as f32, if i % 2 == 0 { 15.0 } else { 45.0 })).collect();
        canvas.stroke(&path, 4.0, &[], BLACK);
        let rgb = pixels(&canvas).unwrap();
        let (row, from, to) = (30, 12, 47);
        assert!(rgb[(row * 60 + from) * 3..(row * 60 + to) * 3].iter().all(|&v| v == 0));
    }

    #[test]
    fn a_translucent_line_is_not_darker_where_it_crosses_itself() {
        let mut canvas = Canvas::new(40, 40);
        canvas.stroke(&[(5.0, 20.0), (35.0, 20.0), (20.0, 35.0), (20.0, 5.0)], 6.0, &[], BLACK.faded(0.5));
        let rgb = pixels(&canvas).unwrap();
        assert!(rgb.iter().all(|&v| v >= 127) && rgb.contains(&128));
    }

    #[test]
    fn nothing_is_painted_outside_the_clip() {
        let mut canvas = Canvas::new(20, 20);
        canvas.clip_to(Rect { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 });
        canvas.fill_rect(Rect { left: -50.0, top: -50.0, right: 50.0, bottom: 50.0 }, BLACK);
        assert!((ink(&canvas) - 100.0).abs() < 1e-6);
        canvas.stroke(&[(-50.0, 15.0), (60.0, 15.0)], 3.0, &[], BLACK);
        canvas.disc((14.0, 14.0), 5.0, BLACK);
        assert!((ink(&canvas) - 100.0).abs() < 1e-6);
    }

    #[test]
    fn text_stands_with_its_capitals_about_the_point_and_as_wide_as_measured() {
        let (size, at) = (40.0, (150.0, 150.0));
        let width = crate::report::plot::sheet::font::text_width("HHHHH", size, false);
        for (run, anchor, from) in [
            (Run::Across, Anchor::Start, 150.0),
            (Run::Across, Anchor::Middle, 150.0 - 0.5 * width),
            (Run::Across, Anchor::End, 150.0 - width),
            (Run::Up, Anchor::Start, 150.0 - width),
            (Run::Up, Anchor::End, 150.0),
        ] {
            let mut canvas = Canvas::new(300, 300);
            canvas.text("HHHHH", at, anchor, run, Type { size, bold: false, color: BLACK });
            let rgb = pixels(&canvas).unwrap();
            let dark: Vec<Px> = (0..300 * 300)
                .filter(|i| rgb[3 * i] < 128)
                .map(|i| ((i % 300) as f32 + 0.5, (i / 300) as f32 + 0.5))
                .map(|(x, y)| if run == Run::Up { (y, x) } else { (x, y) })
                .collect();
            let ends = |of: fn(&Px) -> f32| {
                (dark.iter().map(of).fold(f32::MAX, f32::min), dark.iter().map(of).fold(f32::MIN, f32::max))
            };
            let (along, across) = (ends(|p| p.0), ends(|p| p.1));
            assert!(
                (along.0 + along.1 - 2.0 * from - width).abs() < 3.0,
                "{run:?} {anchor:?} {along:?} {from} {width}"
            );
            assert!(along.1 - along.0 < width && along.1 - along.0 > 0.9 * width, "{along:?} {width}");
            assert!((across.0 + across.1 - 300.0).abs() < 2.0, "{run:?} {across:?}");
            assert!((across.1 - across.0 - 2.0 * HALF_CAPITAL * size).abs() < 2.0, "{across:?}");
        }
    }

    #[test]
    fn a_figure_too_large_for_the_memory_is_refused() {
        assert!(matches!(png(&Canvas::new(100_000, 100_000)), Err(FigureError::TooLarge { .. })));
    }
}
