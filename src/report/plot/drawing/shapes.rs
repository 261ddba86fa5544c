//! Shapes that a plot and its legend share: markers, arrows, whiskers, dashes and ship outlines.
//! They are drawn where they are asked for; no axis is known here.

use crate::report::plot::layer::{Marker, Stroke};
use crate::report::plot::palette::Color;
use crate::report::plot::sheet::canvas::Canvas;
use crate::report::plot::sheet::geometry::{Px, Rect};

/// Drawn and left-out lengths of a line, px; none for a solid one.
pub(in crate::report::plot) fn dashes(stroke: Stroke, width: f32) -> Vec<f32> {
    match stroke {
        Stroke::Solid => vec![],
        Stroke::Dashed => vec![5.0 * width.max(2.0), 3.0 * width.max(2.0)],
        Stroke::Dotted => vec![1.2 * width.max(2.0), 2.0 * width.max(2.0)],
    }
}

/// The colour of large solid areas: opaque, so that the grid does not show through.
pub(in crate::report::plot) fn softened(color: Color) -> Color {
    color.mix(Color::rgb(255, 255, 255), 0.12)
}

/// The outline of a ship as (east, north), bow at half a length ahead of the pose.
pub(in crate::report::plot) fn hull([x, y, psi]: [f64; 3], length: f64, beam: f64) -> [(f64, f64); 9] {
    const SHAPE: [(f64, f64); 9] = [
        (0.5, 0.0),
        (0.42, 0.27),
        (0.26, 0.5),
        (-0.42, 0.5),
        (-0.5, 0.36),
        (-0.5, -0.36),
        (-0.42, -0.5),
        (0.26, -0.5),
        (0.42, -0.27),
    ];
    let (sin, cos) = psi.sin_cos();
    SHAPE.map(|(a, b)| {
        let (ahead, starboard) = (a * length, b * beam);
        (y + ahead * sin + starboard * cos, x + ahead * cos - starboard * sin)
    })
}

/// An interval: a line with a cap at each end.
pub(in crate::report::plot) fn whisker(canvas: &mut Canvas, a: Px, b: Px, cap: f32, width: f32, color: Color) {
    canvas.stroke(&[a, b], width, &[], color);
    let lying = (a.1 - b.1).abs() < 0.01;
    let (dx, dy) = if lying { (0.0, cap) } else { (cap, 0.0) };
    for (x, y) in [a, b] {
        canvas.stroke(&[(x - dx, y - dy), (x + dx, y + dy)], width, &[], color);
    }
}

/// An arrow from `a` to `b`.
pub(in crate::report::plot) fn arrow(canvas: &mut Canvas, a: Px, b: Px, width: f32, color: Color) {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length = dx.hypot(dy);
    if length < 1.5 {
        return;
    }
    let (ux, uy) = (dx / length, dy / length);
    let head = (4.5 * width + 3.0).min(0.6 * length);
    let neck = (b.0 - ux * head, b.1 - uy * head);
    let half = 0.42 * head;
    canvas.stroke(&[a, neck], width, &[], color);
    canvas.fill(&[b, (neck.0 - uy * half, neck.1 + ux * half), (neck.0 + uy * half, neck.1 - ux * half)], color);
}

/// A point of a series, `r` px in radius.
pub(in crate::report::plot) fn draw_marker(canvas: &mut Canvas, (x, y): Px, marker: Marker, r: f32, color: Color) {
    match marker {
        Marker::Circle => canvas.disc((x, y), r, color),
        Marker::Square => {
            let r = 0.9 * r;
            canvas.fill_rect(Rect { left: x - r, top: y - r, right: x + r, bottom: y + r }, color);
        }
        Marker::Diamond => {
            let r = 1.25 * r;
            canvas.fill(&[(x, y - r), (x + r, y), (x, y + r), (x - r, y)], color);
        }
        Marker::Triangle => {
            let r = 1.2 * r;
            canvas.fill(&[(x, y - r), (x + 0.87 * r, y + 0.5 * r), (x - 0.87 * r, y + 0.5 * r)], color);
        }
        Marker::Cross => {
            for s in [-1.0, 1.0] {
                canvas.stroke(&[(x - r, y - s * r), (x + r, y + s * r)], 0.45 * r, &[], color);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_points_along_its_heading_and_keeps_its_length_and_beam() {
        let bow = |psi: f64| hull([100.0, 50.0, psi], 80.0, 12.0)[0];
        assert_eq!(bow(0.0), (50.0, 140.0));
        let (east, north) = bow(std::f64::consts::FRAC_PI_2);
        assert!((east - 90.0).abs() < 1e-9 && (north - 100.0).abs() < 1e-9);
        let outline = hull([0.0, 0.0, 0.7], 80.0, 12.0);
        let along: Vec<f64> = outline.iter().map(|(e, n)| e * 0.7f64.sin() + n * 0.7f64.cos()).collect();
        let span = along.iter().copied().fold(f64::MIN, f64::max) - along.iter().copied().fold(f64::MAX, f64::min);
        assert!((span - 80.0).abs() < 1e-9);
    }
}
