//! Heat maps: the range of their colours, their cells and the bar that explains them.
//! Nothing else of a panel is drawn here.

use super::frame::Frame;
use super::style::{FRAME, INK, NOTE, TICK, cut, ink};
use super::ticks::ruler;
use crate::numerals::{fixed, sig};
use crate::report::plot::axis::{Axis, Extent, Scale, drawable};
use crate::report::plot::figure::Panel;
use crate::report::plot::layer::Mark;
use crate::report::plot::palette::{self, Color};
use crate::report::plot::sheet::canvas::{Anchor, Canvas, Run, Type};
use crate::report::plot::sheet::font::text_width;
use crate::report::plot::sheet::geometry::{Rect, between};

/// The colour of a cell without a value.
const EMPTY: Color = Color::rgb(235, 235, 235);

/// The heat map of a panel, if it has one: the name and the range of its colours.
pub(in crate::report::plot) fn heatmap(panel: &Panel) -> Option<(&str, (f64, f64))> {
    panel.layers.iter().find_map(|layer| match &layer.mark {
        Mark::Heatmap { values, range, .. } => Some((layer.name.as_str(), color_range(values, *range))),
        _ => None,
    })
}

fn color_range(values: &[Vec<f64>], fixed: Option<(f64, f64)>) -> (f64, f64) {
    if let Some((lo, hi)) = fixed.filter(|(lo, hi)| drawable(*lo) && drawable(*hi) && lo < hi) {
        return (lo, hi);
    }
    let mut data = Extent::new(&Scale::Linear);
    values.iter().flatten().for_each(|&v| data.add(v));
    match (data.lo, data.hi) {
        _ if data.is_empty() => (0.0, 1.0),
        (lo, hi) if lo < 0.0 && hi > 0.0 => (-hi.max(-lo), hi.max(-lo)),
        (lo, hi) if lo == hi => (lo.min(0.0), if hi > 0.0 { hi } else { lo.min(0.0) + lo.abs().max(1.0) }),
        ends => ends,
    }
}

fn cell_color(v: f64, (lo, hi): (f64, f64)) -> Color {
    let t = (v - lo) / (hi - lo);
    if lo < 0.0 && hi > 0.0 { palette::diverging(t) } else { palette::sequential(t) }
}

/// The colour of every cell; those without a value are grey.
pub(in crate::report::plot) fn cell_colors(values: &[Vec<f64>], range: Option<(f64, f64)>) -> Vec<Vec<Color>> {
    let range = color_range(values, range);
    let of = |&v: &f64| if drawable(v) { cell_color(v, range) } else { EMPTY };
    values.iter().map(|row| row.iter().map(of).collect()).collect()
}

/// The value of every cell in words.
pub(in crate::report::plot) fn cell_words(values: &[Vec<f64>], range: Option<(f64, f64)>) -> Vec<Vec<String>> {
    let range = color_range(values, range);
    values.iter().map(|row| row.iter().map(|&v| cell_text(v, range)).collect()).collect()
}

/// A cell's value with as many decimals as give the largest of the map two digits.
fn cell_text(v: f64, (lo, hi): (f64, f64)) -> String {
    let largest = lo.abs().max(hi.abs());
    let text = if (1e-3..1e5).contains(&largest) {
        fixed(v, (1 - (0.99 * largest).log10().floor() as i32).max(0) as usize)
    } else {
        sig(v, 2)
    };
    text.replace('-', "\u{2212}")
}

/// The cells of a heat map, each with its value where that fits.
pub(in crate::report::plot) fn cells(
    frame: &Frame,
    canvas: &mut Canvas,
    values: &[Vec<f64>],
    range: Option<(f64, f64)>,
    annotate: bool,
) {
    let range = color_range(values, range);
    for (i, row) in values.iter().enumerate() {
        for (j, &v) in row.iter().enumerate() {
            let (row, column) = (i as f64, j as f64);
            let (Some(a), Some(b)) = (frame.at(column - 0.5, row - 0.5), frame.at(column + 0.5, row + 0.5)) else {
                continue;
            };
            let rect = between(a, b);
            let color = if drawable(v) { cell_color(v, range) } else { EMPTY };
            canvas.fill_rect(rect, color);
            canvas.stroke_rect(rect, 1.5, Color::rgb(255, 255, 255));
            // A value that does not fit its cell is left to the colour bar and the CSV.
            let text = cell_text(v, range);
            let size = [TICK, NOTE, 16.0]
                .into_iter()
                .find(|&s| text_width(&text, s, false) < rect.width() - 6.0 && rect.height() > 1.2 * s);
            if let Some(size) = size.filter(|_| annotate && frame.plot.contains(rect.center())) {
                let color = if color.luminance() > 0.35 { INK } else { Color::rgb(255, 255, 255) };
                canvas.text(&text, rect.center(), Anchor::Middle, Run::Across, Type { size, bold: false, color });
            }
        }
    }
}

/// The scale of the colours, to the right of the plot.
pub(in crate::report::plot) fn color_bar(plot: Rect, canvas: &mut Canvas, name: &str, (lo, hi): (f64, f64)) {
    let bar = Rect { left: plot.right + 22.0, right: plot.right + 46.0, ..plot };
    const STEPS: usize = 64;
    for i in 0..STEPS {
        let (a, b) = (i as f32 / STEPS as f32, (i + 1) as f32 / STEPS as f32);
        let slice = Rect { top: bar.bottom - b * bar.height(), bottom: bar.bottom - a * bar.height(), ..bar };
        let v = lo + (hi - lo) * (i as f64 + 0.5) / STEPS as f64;
        canvas.fill_rect(slice, cell_color(v, (lo, hi)));
    }
    canvas.stroke_rect(bar, 1.5, FRAME);
    let length = f64::from(bar.height());
    let ruler = ruler(&Axis::default(), (lo, hi), length, 80.0, false, |_| f64::from(TICK) * 1.3);
    let mut widest: f32 = 0.0;
    for (v, label) in &ruler.ticks {
        let Some(f) = ruler.fraction(*v) else { continue };
        let y = bar.bottom - f as f32 * bar.height();
        canvas.stroke(&[(bar.right, y), (bar.right + 6.0, y)], 1.5, &[], FRAME);
        canvas.text(label, (bar.right + 12.0, y), Anchor::Start, Run::Across, ink(TICK));
        widest = widest.max(text_width(label, TICK, false));
    }
    let name = match &ruler.factor {
        Some(factor) => format!("{name} {factor}"),
        None => name.to_owned(),
    };
    let name = cut(&name, TICK, false, bar.height());
    let at = (bar.right + 12.0 + widest + 22.0, bar.center().1);
    canvas.text(&name, at, Anchor::Middle, Run::Up, ink(TICK));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_a_heat_map_show_two_digits_of_the_largest_value() {
        assert_eq!(cell_text(0.08, (0.0, 0.9)), "0.08");
        assert_eq!(cell_text(-0.449, (-1.0, 1.0)), "−0.45");
        assert_eq!(cell_text(3.26, (0.0, 14.0)), "3");
        assert_eq!(cell_text(2.5e-6, (0.0, 4e-6)), "2.5e−6");
        assert_eq!(cell_text(f64::NAN, (0.0, 1.0)), "–");
    }
}
