//! The legend: a strip that names the series with a sample of each, and never lies over the data.
//! Which strips a figure has and where they go is decided in `layout`.

use super::shapes::{arrow, dashes, draw_marker, hull, softened, whisker};
use super::style::{LABEL, cut, ink};
use crate::report::plot::layer::{Layer, Mark};
use crate::report::plot::sheet::canvas::{Anchor, Canvas, Run};
use crate::report::plot::sheet::font::text_width;
use crate::report::plot::sheet::geometry::{Px, Rect};

/// Width of a sample, px.
const SWATCH: f32 = 46.0;
/// Height of a row, px.
const ROW: f32 = 36.0;

/// Names of series with a sample of each, in rows.
#[derive(Default)]
pub(in crate::report::plot) struct Strip<'a> {
    rows: Vec<Vec<Entry<'a>>>,
}

struct Entry<'a> {
    name: String,
    width: f32,
    /// All layers of this name: a line and its band are one entry.
    layers: Vec<&'a Layer>,
}

impl<'a> Strip<'a> {
    pub fn new(layers: impl IntoIterator<Item = &'a Layer>, width: f32) -> Self {
        let mut names: Vec<(&str, Vec<&Layer>)> = vec![];
        for layer in layers.into_iter().filter(|l| l.in_legend && !l.name.is_empty()) {
            match names.iter_mut().find(|(name, _)| *name == layer.name) {
                Some((_, same)) => {
                    // The same series in another panel adds nothing; its line, band or hulls do.
                    let kind = std::mem::discriminant(&layer.mark);
                    if same.iter().all(|l| std::mem::discriminant(&l.mark) != kind) {
                        same.push(layer);
                    }
                }
                None => names.push((&layer.name, vec![layer])),
            }
        }
        let mut rows: Vec<Vec<Entry<'_>>> = vec![];
        let mut used = f32::MAX;
        for (name, layers) in names {
            let name = cut(name, LABEL, false, width - SWATCH - 12.0);
            let wide = SWATCH + 12.0 + text_width(&name, LABEL, false) + 38.0;
            if used + wide - 38.0 > width {
                rows.push(vec![]);
                used = 0.0;
            }
            used += wide;
            if let Some(row) = rows.last_mut() {
                row.push(Entry { name, width: wide, layers });
            }
        }
        Self { rows }
    }

    pub fn height(&self) -> f32 {
        if self.rows.is_empty() { 0.0 } else { self.rows.len() as f32 * ROW + 10.0 }
    }

    pub fn draw(&self, canvas: &mut Canvas, (left, top): Px) {
        for (i, row) in self.rows.iter().enumerate() {
            let (mut x, y) = (left, top + (i as f32 + 0.5) * ROW);
            for entry in row {
                for layer in &entry.layers {
                    sample(canvas, layer, (x, y));
                }
                canvas.text(&entry.name, (x + SWATCH + 12.0, y), Anchor::Start, Run::Across, ink(LABEL));
                x += entry.width;
            }
        }
    }
}

/// A sample of a layer for the legend, `SWATCH` wide, centred on the height of `at`.
fn sample(canvas: &mut Canvas, layer: &Layer, (x, y): Px) {
    let color = layer.color;
    let block = Rect { left: x, right: x + SWATCH, top: y - 10.0, bottom: y + 10.0 };
    let (a, b, middle) = ((x, y), (x + SWATCH, y), (x + 0.5 * SWATCH, y));
    match &layer.mark {
        Mark::Line(_) | Mark::HLine(_) | Mark::VLine(_) => {
            canvas.stroke(&[a, b], layer.width, &dashes(layer.stroke, layer.width), color);
        }
        Mark::Scatter(_, marker) => draw_marker(canvas, middle, *marker, 7.0, color),
        Mark::Errors(_, marker) => {
            whisker(canvas, (middle.0, y - 13.0), (middle.0, y + 13.0), 8.0, 2.5, color);
            draw_marker(canvas, middle, *marker, 7.0, color);
        }
        Mark::Band(_) => canvas.fill_rect(block, color.faded(0.22)),
        Mark::HSpan(..) | Mark::VSpan(..) => canvas.fill_rect(block, color.faded(0.16)),
        Mark::Bars { .. } => canvas.fill_rect(block, softened(color)),
        Mark::Boxes(_) => {
            canvas.fill_rect(block, color.faded(0.3));
            canvas.stroke_rect(block, 2.5, color);
        }
        Mark::Hulls { .. } => {
            let heading = std::f64::consts::FRAC_PI_2;
            let outline: Vec<Px> = hull([0.0, 0.0, heading], f64::from(SWATCH), 14.0)
                .iter()
                .map(|&(dx, dy)| (middle.0 + dx as f32, middle.1 - dy as f32))
                .collect();
            canvas.fill(&outline, color.faded(0.15));
            let closed: Vec<Px> = outline.iter().chain(outline.first()).copied().collect();
            canvas.stroke(&closed, layer.width, &dashes(layer.stroke, layer.width), color);
        }
        Mark::Arrows(_) => arrow(canvas, a, b, layer.width.min(3.0), color),
        Mark::Heatmap { .. } | Mark::Text(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::palette;

    #[test]
    fn names_are_once_in_the_legend() {
        let layers = [
            Layer::line("fitted", palette::FITTED, []),
            Layer::band("fitted", palette::FITTED, []),
            Layer::line("fitted", palette::FITTED, []),
            Layer::line("", palette::TRUTH, []),
            Layer::line("baseline", palette::BASELINE, []).unlisted(),
        ];
        let strip = Strip::new(&layers, 900.0);
        assert_eq!(strip.rows.len(), 1);
        assert_eq!(strip.rows[0].len(), 1);
        assert_eq!(strip.rows[0][0].layers.len(), 2);
    }
}
