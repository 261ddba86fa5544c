//! Lays a figure out and draws its axes: margins, titles, grid, ticks and labels.
//! It decides nothing about the data: ranges and ticks come from `axis`, layers from `marks`, pixels from `canvas`.

use super::axis::{self, Axis, Ruler, Scale};
use super::canvas::{Anchor, Canvas, Px, Rect, Run, Type, text_width};
use super::figure::{Figure, Legend, Mark, Panel};
use super::legend::Strip;
use super::marks::{Bins, cell_color, extents, has_data, heatmap, is_grouped, is_span};
use super::palette::Color;
use super::style::{FRAME, HEADING, LABEL, LEADING, NOTE, TICK, TITLE, bold, cut, fit_lines, ink};

/// Grid lines at the ticks, and between them on logarithmic axes.
const GRID: Color = Color::rgb(226, 226, 226);
const MINOR: Color = Color::rgb(241, 241, 241);
/// Around the figure, px.
const EDGE: f32 = 24.0;
/// Between the axis and its tick labels, px.
const TICK_GAP: f32 = 14.0;

/// The sheet of a figure.
pub(super) fn draw(figure: &Figure) -> Canvas {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let rows: Vec<&[Panel]> = figure.panels.chunks(columns).collect();
    let (cell_w, cell_h) = (figure.panel_width.max(300) as f32, figure.panel_height.max(200) as f32);
    let width = cell_w * columns as f32 + 2.0 * EDGE;

    let title = fit_lines(&figure.title, TITLE, true, width - 2.0 * EDGE, 3).0;
    let shared = match figure.legend {
        Legend::Shared => Strip::new(figure.panels.iter().flat_map(|p| &p.layers), width - 2.0 * EDGE),
        Legend::EachPanel | Legend::Off => Strip::default(),
    };
    let title_height = title.len() as f32 * TITLE * LEADING;
    let mut top = EDGE + title_height + if title.is_empty() { 0.0 } else { 12.0 };
    let strip_top = top;
    top += shared.height();

    let layout: Vec<(f32, Vec<Cell<'_>>)> = lay_out(figure, &rows, columns, cell_w, cell_h);
    let height = top + layout.iter().map(|row| row.0).sum::<f32>() + EDGE;
    let mut canvas = Canvas::new(width.ceil() as u32, height.ceil() as u32);

    for (i, line) in title.iter().enumerate() {
        let y = EDGE + (i as f32 + 0.5) * TITLE * LEADING;
        canvas.text(line, (EDGE, y), Anchor::Start, Run::Across, bold(TITLE));
    }
    shared.draw(&mut canvas, (EDGE, strip_top));
    for (row_height, cells) in layout {
        for (j, cell) in cells.iter().enumerate() {
            cell.draw(&mut canvas, (EDGE + j as f32 * cell_w, top));
        }
        top += row_height;
    }
    canvas
}

/// Space around a plot for titles and labels, px.
#[derive(Clone, Copy, Debug, Default)]
struct Margins {
    left: f32,
    right: f32,
    top: f32,
    bottom: f32,
}

impl Margins {
    fn max(self, other: Self) -> Self {
        Self {
            left: self.left.max(other.left),
            right: self.right.max(other.right),
            top: self.top.max(other.top),
            bottom: self.bottom.max(other.bottom),
        }
    }
}

/// Finds margins that align the plots of each column and each row. Labels depend on the size of the plot and the plot
/// on its labels, so the margins are refined a few times.
fn lay_out<'a>(
    figure: &Figure,
    rows: &[&'a [Panel]],
    columns: usize,
    cell_w: f32,
    cell_h: f32,
) -> Vec<(f32, Vec<Cell<'a>>)> {
    let strips: Vec<Vec<Strip<'_>>> = rows
        .iter()
        .map(|row| {
            row.iter()
                .map(|panel| match figure.legend {
                    Legend::EachPanel => Strip::new(&panel.layers, cell_w - 160.0),
                    Legend::Shared | Legend::Off => Strip::default(),
                })
                .collect()
        })
        .collect();
    let strip_heights: Vec<f32> = strips.iter().map(|row| row.iter().map(Strip::height).fold(0.0, f32::max)).collect();

    let mut margins = vec![vec![Margins { left: 110.0, right: 30.0, top: 40.0, bottom: 80.0 }; columns]; rows.len()];
    let rect = |m: Margins, i: usize| Rect {
        left: m.left,
        top: m.top,
        right: (cell_w - m.right).max(m.left + 40.0),
        bottom: (cell_h + strip_heights[i] - m.bottom).max(m.top + 40.0),
    };
    for _ in 0..3 {
        for (i, row) in rows.iter().enumerate() {
            for (j, panel) in row.iter().enumerate() {
                margins[i][j] = Frame::new(panel, rect(margins[i][j], i)).margins(panel, cell_w, strip_heights[i]);
            }
        }
        for i in 0..rows.len() {
            for j in 0..columns {
                let of_row = (0..columns).fold(Margins::default(), |m, j| m.max(margins[i][j]));
                let of_column = (0..rows.len()).fold(Margins::default(), |m, i| m.max(margins[i][j]));
                margins[i][j] =
                    Margins { left: of_column.left, right: of_column.right, top: of_row.top, bottom: of_row.bottom };
            }
        }
    }
    rows.iter()
        .zip(strips)
        .enumerate()
        .map(|(i, (row, strips))| {
            let cells = row
                .iter()
                .zip(strips)
                .enumerate()
                .map(|(j, (panel, strip))| Cell {
                    panel,
                    strip,
                    strip_height: strip_heights[i],
                    plot: rect(margins[i][j], i),
                })
                .collect();
            (cell_h + strip_heights[i], cells)
        })
        .collect()
}

/// A panel with its place: `plot` is measured from the corner of the cell.
struct Cell<'a> {
    panel: &'a Panel,
    strip: Strip<'a>,
    strip_height: f32,
    plot: Rect,
}

impl Cell<'_> {
    fn draw(&self, canvas: &mut Canvas, (left, top): Px) {
        let plot = Rect {
            left: left + self.plot.left,
            top: top + self.plot.top,
            right: left + self.plot.right,
            bottom: top + self.plot.bottom,
        };
        let frame = Frame::new(self.panel, plot);
        let title = title_lines(self.panel, plot.width());
        let title_height = title.len() as f32 * HEADING * LEADING;
        let strip_top = plot.top - 12.0 - self.strip_height;
        for (i, line) in title.iter().enumerate() {
            let y = strip_top - title_height + (i as f32 + 0.5) * HEADING * LEADING;
            canvas.text(line, (plot.left, y), Anchor::Start, Run::Across, bold(HEADING));
        }
        self.strip.draw(canvas, (plot.left, strip_top));
        frame.draw(canvas, self.panel);
    }
}

fn title_lines(panel: &Panel, width: f32) -> Vec<String> {
    fit_lines(&panel.title, HEADING, true, width, 3).0
}

/// How the labels of categories along x stand.
enum Standing {
    Flat(Vec<Vec<String>>),
    Upright { labels: Vec<Vec<String>>, stride: usize },
}

/// The axes of a panel on its plot rectangle.
pub(super) struct Frame {
    pub plot: Rect,
    pub x: Ruler,
    pub y: Ruler,
    pub bins: Option<Bins>,
}

impl Frame {
    fn new(panel: &Panel, plot: Rect) -> Self {
        let bins = Bins::of(panel);
        let (ex, ey) = extents(panel, bins);
        let (mut x, mut y) = (axis::limits(&panel.x, ex, 0.02), axis::limits(&panel.y, ey, 0.05));
        let (w, h) = (f64::from(plot.width()), f64::from(plot.height()));
        if panel.equal_aspect && panel.x.scale == Scale::Linear && panel.y.scale == Scale::Linear {
            (x, y) = axis::equal_aspect(x, y, w, h);
        }
        let wide = |label: &str| f64::from(text_width(label, TICK, false)) + 26.0;
        Self {
            plot,
            x: axis::ruler(&panel.x, x, w, 110.0, false, wide),
            y: axis::ruler(&panel.y, y, h, 48.0, true, |_| f64::from(TICK) * 1.7),
            bins,
        }
    }

    /// Where a point falls on the sheet, perhaps outside the plot.
    pub fn at(&self, x: f64, y: f64) -> Option<Px> {
        Some((self.px(self.x.fraction(x)?), self.py(self.y.fraction(y)?)))
    }

    pub fn px(&self, fraction: f64) -> f32 {
        (f64::from(self.plot.left) + fraction * f64::from(self.plot.width())).clamp(-1e6, 1e6) as f32
    }

    pub fn py(&self, fraction: f64) -> f32 {
        (f64::from(self.plot.bottom) - fraction * f64::from(self.plot.height())).clamp(-1e6, 1e6) as f32
    }

    fn standing(&self, labels: &[String]) -> Standing {
        let slot = self.plot.width() / labels.len().max(1) as f32;
        let flat: Vec<_> = labels.iter().map(|l| fit_lines(l, TICK, false, slot - 12.0, 3)).collect();
        if flat.iter().all(|(_, whole)| *whole) {
            return Standing::Flat(flat.into_iter().map(|(lines, _)| lines).collect());
        }
        let pitch = TICK * LEADING;
        let lines = (slot / pitch).floor().clamp(1.0, 2.0) as usize;
        // One line may be long; of two, each is at most half of that.
        let longest = 0.95 * self.plot.height().max(220.0) / lines as f32;
        let labels = labels.iter().map(|l| fit_lines(l, TICK, false, longest, lines).0).collect();
        Standing::Upright { labels, stride: (pitch / slot).ceil().max(1.0) as usize }
    }

    /// Category labels along y: their lines, and every how many are shown.
    fn row_labels(&self, labels: &[String], cell_w: f32) -> (Vec<Vec<String>>, usize) {
        let slot = self.plot.height() / labels.len().max(1) as f32;
        let lines = (slot / (TICK * LEADING)).floor().clamp(1.0, 3.0) as usize;
        let stride = (TICK * 1.15 / slot).ceil().max(1.0) as usize;
        (labels.iter().map(|l| fit_lines(l, TICK, false, 0.36 * cell_w, lines).0).collect(), stride)
    }

    fn margins(&self, panel: &Panel, cell_w: f32, strip: f32) -> Margins {
        let widest =
            |texts: &mut dyn Iterator<Item = &String>| texts.map(|t| text_width(t, TICK, false)).fold(0.0, f32::max);
        let y_ticks = match panel.y.labels() {
            Some(labels) => {
                let (lines, _) = self.row_labels(labels, cell_w);
                widest(&mut lines.iter().flatten())
            }
            None => widest(&mut self.y.ticks.iter().map(|(_, l)| l)),
        };
        let y_label = fit_lines(&panel.y.label, LABEL, false, self.plot.height(), 2).0;
        let mut left = y_ticks + TICK_GAP + y_label.len() as f32 * LABEL * LEADING + 14.0;
        if let Some(factor) = &self.y.factor {
            left = left.max(text_width(factor, TICK, false) + 12.0);
        }
        let mut bottom = TICK_GAP + TICK * 0.5;
        let mut right: f32 = 30.0;
        match panel.x.labels().map(|labels| self.standing(labels)) {
            None => {
                bottom += TICK * 0.7;
                if let Some((v, label)) = self.x.ticks.last() {
                    let beyond = self.px(self.x.fraction(*v).unwrap_or(1.0)) - self.plot.right;
                    right = right.max(0.5 * text_width(label, TICK, false) + beyond + 8.0);
                }
            }
            Some(Standing::Flat(lines)) => {
                let lines = lines.iter().map(Vec::len).max().unwrap_or(1);
                bottom += (lines as f32 - 1.0) * TICK * LEADING + TICK * 0.7;
            }
            Some(Standing::Upright { labels, .. }) => bottom += widest(&mut labels.iter().flatten()) - TICK * 0.5,
        }
        let x_label = fit_lines(&panel.x.label, LABEL, false, self.plot.width(), 2).0;
        bottom += x_label.len() as f32 * LABEL * LEADING + 16.0;
        if heatmap(panel).is_some() {
            right = right.max(190.0);
        }
        let title = title_lines(panel, self.plot.width()).len() as f32 * HEADING * LEADING;
        let top = (title + strip + 12.0).max(if self.y.factor.is_some() { 38.0 } else { 16.0 }) + 8.0;
        Margins { left, right, top, bottom }
    }

    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        let plot = self.plot;
        canvas.clip_to(plot);
        for layer in panel.layers.iter().filter(|l| is_span(l)) {
            self.layer(canvas, panel, layer, 0);
        }
        if heatmap(panel).is_none() {
            self.grid(canvas, panel);
        }
        let mut group = 0;
        for layer in panel.layers.iter().filter(|l| !is_span(l)) {
            self.layer(canvas, panel, layer, group);
            group += usize::from(is_grouped(layer));
        }
        canvas.clip_to(canvas.bounds());
        canvas.stroke_rect(plot, 1.5, FRAME);
        self.x_axis(canvas, &panel.x);
        self.y_axis(canvas, &panel.y);
        if !panel.layers.iter().any(has_data) {
            canvas.text("no data", plot.center(), Anchor::Middle, Run::Across, Type { color: FRAME, ..ink(HEADING) });
        }
        for layer in &panel.layers {
            if let Mark::Text((x, y)) = layer.mark
                && let Some(at) = self.at(x, y).filter(|&p| plot.contains(p))
            {
                // Anchored by the side of the plot it is on, so that a remark stays inside.
                let side = (at.0 - plot.left) / plot.width();
                let (anchor, gap) = match side {
                    s if s < 0.33 => (Anchor::Start, 10.0),
                    s if s > 0.67 => (Anchor::End, -10.0),
                    _ => (Anchor::Middle, 0.0),
                };
                canvas.text(
                    &layer.name,
                    (at.0 + gap, at.1),
                    anchor,
                    Run::Across,
                    Type { color: layer.color, ..ink(NOTE) },
                );
            }
        }
        if let Some((name, range)) = heatmap(panel) {
            self.color_bar(canvas, name, range);
        }
    }

    fn grid(&self, canvas: &mut Canvas, panel: &Panel) {
        let Rect { left, top, right, bottom } = self.plot;
        let lines = |canvas: &mut Canvas, ruler: &Ruler, vertical: bool, categories: bool| {
            let minor = ruler.minor.iter().map(|&v| (v, MINOR));
            let major = ruler.ticks.iter().map(|&(v, _)| (v, GRID)).filter(|_| !categories);
            for (v, color) in minor.chain(major) {
                let Some(f) = ruler.fraction(v) else { continue };
                let ends = if vertical {
                    [(self.px(f), top), (self.px(f), bottom)]
                } else {
                    [(left, self.py(f)), (right, self.py(f))]
                };
                canvas.stroke(&ends, 1.5, &[], color);
            }
        };
        lines(canvas, &self.x, true, panel.x.labels().is_some());
        lines(canvas, &self.y, false, panel.y.labels().is_some());
    }

    fn x_axis(&self, canvas: &mut Canvas, axis: &Axis) {
        let Rect { left, right, bottom, .. } = self.plot;
        let middle = bottom + TICK_GAP + 0.5 * TICK;
        let mut below = middle + 0.7 * TICK;
        match axis.labels().map(|labels| self.standing(labels)) {
            None => {
                for (v, label) in &self.x.ticks {
                    let Some(x) = self.x.fraction(*v).map(|f| self.px(f)) else { continue };
                    canvas.stroke(&[(x, bottom), (x, bottom + 7.0)], 1.5, &[], FRAME);
                    canvas.text(label, (x, middle), Anchor::Middle, Run::Across, ink(TICK));
                }
            }
            Some(Standing::Flat(labels)) => {
                let most = labels.iter().map(Vec::len).max().unwrap_or(1);
                for (i, lines) in labels.iter().enumerate() {
                    let Some(x) = self.x.fraction(i as f64).map(|f| self.px(f)) else { continue };
                    for (k, line) in lines.iter().enumerate() {
                        let y = middle + k as f32 * TICK * LEADING;
                        canvas.text(line, (x, y), Anchor::Middle, Run::Across, ink(TICK));
                    }
                }
                below += (most as f32 - 1.0) * TICK * LEADING;
            }
            Some(Standing::Upright { labels, stride }) => {
                let mut longest: f32 = 0.0;
                for (i, lines) in labels.iter().enumerate().step_by(stride) {
                    let Some(x) = self.x.fraction(i as f64).map(|f| self.px(f)) else { continue };
                    for (k, line) in lines.iter().enumerate() {
                        let x = x + (k as f32 - 0.5 * (lines.len() as f32 - 1.0)) * TICK * LEADING;
                        canvas.text(line, (x, bottom + TICK_GAP), Anchor::End, Run::Up, ink(TICK));
                        longest = longest.max(text_width(line, TICK, false));
                    }
                }
                below = bottom + TICK_GAP + longest;
            }
        }
        let lines = fit_lines(&axis.label, LABEL, false, self.plot.width(), 2).0;
        for (i, line) in lines.iter().enumerate() {
            let y = below + 10.0 + (i as f32 + 0.5) * LABEL * LEADING;
            canvas.text(line, (0.5 * (left + right), y), Anchor::Middle, Run::Across, ink(LABEL));
        }
        if let Some(factor) = &self.x.factor {
            canvas.text(factor, (right, below + 10.0 + 0.5 * LABEL * LEADING), Anchor::End, Run::Across, ink(TICK));
        }
    }

    fn y_axis(&self, canvas: &mut Canvas, axis: &Axis) {
        let Rect { left, top, bottom, .. } = self.plot;
        let mut widest: f32 = 0.0;
        if let Some(labels) = axis.labels() {
            let (labels, stride) = self.row_labels(labels, self.plot.right - self.plot.left + left);
            for (i, lines) in labels.iter().enumerate().step_by(stride) {
                let Some(y) = self.y.fraction(i as f64).map(|f| self.py(f)) else { continue };
                for (k, line) in lines.iter().enumerate() {
                    let y = y + (k as f32 - 0.5 * (lines.len() as f32 - 1.0)) * TICK * LEADING;
                    canvas.text(line, (left - TICK_GAP, y), Anchor::End, Run::Across, ink(TICK));
                    widest = widest.max(text_width(line, TICK, false));
                }
            }
        } else {
            for (v, label) in &self.y.ticks {
                let Some(y) = self.y.fraction(*v).map(|f| self.py(f)) else { continue };
                canvas.stroke(&[(left - 7.0, y), (left, y)], 1.5, &[], FRAME);
                canvas.text(label, (left - TICK_GAP, y), Anchor::End, Run::Across, ink(TICK));
                widest = widest.max(text_width(label, TICK, false));
            }
        }
        let lines = fit_lines(&axis.label, LABEL, false, self.plot.height(), 2).0;
        for (i, line) in lines.iter().rev().enumerate() {
            let x = left - TICK_GAP - widest - 8.0 - (i as f32 + 0.5) * LABEL * LEADING;
            canvas.text(line, (x, 0.5 * (top + bottom)), Anchor::Middle, Run::Up, ink(LABEL));
        }
        if let Some(factor) = &self.y.factor {
            canvas.text(factor, (left - 8.0, top - 24.0), Anchor::End, Run::Across, ink(TICK));
        }
    }

    fn color_bar(&self, canvas: &mut Canvas, name: &str, (lo, hi): (f64, f64)) {
        let bar = Rect { left: self.plot.right + 22.0, right: self.plot.right + 46.0, ..self.plot };
        const STEPS: usize = 64;
        for i in 0..STEPS {
            let (a, b) = (i as f32 / STEPS as f32, (i + 1) as f32 / STEPS as f32);
            let slice = Rect { top: bar.bottom - b * bar.height(), bottom: bar.bottom - a * bar.height(), ..bar };
            let v = lo + (hi - lo) * (i as f64 + 0.5) / STEPS as f64;
            canvas.fill_rect(slice, cell_color(v, (lo, hi)));
        }
        canvas.stroke_rect(bar, 1.5, FRAME);
        let length = f64::from(bar.height());
        let ruler = axis::ruler(&Axis::default(), (lo, hi), length, 80.0, false, |_| f64::from(TICK) * 1.3);
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Layer, palette};

    #[test]
    fn tracks_have_the_same_metres_per_pixel_on_both_axes() {
        let panel = Panel::track("").with(Layer::line("a", palette::TRUTH, [(0.0, 0.0), (1000.0, 40.0)]));
        let frame = Frame::new(&panel, Rect { left: 100.0, top: 20.0, right: 880.0, bottom: 520.0 });
        let (Some(a), Some(b), Some(c)) = (frame.at(0.0, 0.0), frame.at(500.0, 0.0), frame.at(0.0, 500.0)) else {
            panic!("finite points have a place");
        };
        assert!(((b.0 - a.0) - (a.1 - c.1)).abs() < 0.01, "{} {}", b.0 - a.0, a.1 - c.1);
    }
}
