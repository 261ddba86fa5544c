//! Lays a figure out on a canvas and draws it: margins, legend, axes, layers.
//! It decides nothing about the data; ranges and ticks come from `axis`, pixels from `canvas`.

use super::axis::{self, Axis, Extent, Ruler, Scale, drawable};
use super::canvas::{Anchor, Canvas, Px, Rect, Type, text_width};
use super::figure::{Figure, FigureError, Layer, Legend, Mark, Marker, Panel, Stroke};
use super::palette::{self, Color};
use super::table::{fixed, sig};

const TITLE: f32 = 30.0;
const HEADING: f32 = 25.0;
const LABEL: f32 = 24.0;
const TICK: f32 = 22.0;
const NOTE: f32 = 20.0;

const INK: Color = Color::rgb(30, 30, 30);
const FRAME: Color = Color::rgb(110, 110, 110);
const GRID: Color = Color::rgb(226, 226, 226);
const MINOR: Color = Color::rgb(241, 241, 241);

/// Around the figure.
const EDGE: f32 = 24.0;
/// Between the axis and its tick labels.
const TICK_GAP: f32 = 14.0;
/// From one line of text to the next, over the font size.
const LEADING: f32 = 1.3;
const SWATCH: f32 = 46.0;
/// Slope of category labels too long to stand flat, rad.
const SLANT: f32 = 0.7;

const fn ink(size: f32) -> Type {
    Type { size, bold: false, color: INK }
}

const fn bold(size: f32) -> Type {
    Type { size, bold: true, color: INK }
}

/// Draws a figure on the sheet that `sheet(width, height)` gives.
pub(super) fn render(
    figure: &Figure,
    sheet: impl Fn(u32, u32) -> Result<Canvas, FigureError>,
) -> Result<Canvas, FigureError> {
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
    let mut canvas = sheet(width.ceil() as u32, height.ceil() as u32)?;

    for (i, line) in title.iter().enumerate() {
        let y = EDGE + (i as f32 + 0.5) * TITLE * LEADING;
        canvas.text(line, (EDGE, y), Anchor::Start, 0.0, bold(TITLE));
    }
    shared.draw(&mut canvas, (EDGE, strip_top));
    for (row_height, cells) in layout {
        for (j, cell) in cells.iter().enumerate() {
            cell.draw(&mut canvas, (EDGE + j as f32 * cell_w, top));
        }
        top += row_height;
    }
    Ok(canvas)
}

/// Whether bars and boxes of a panel lie: the categories are on the y axis only.
pub(super) fn lies(panel: &Panel) -> bool {
    panel.y.labels().is_some() && panel.x.labels().is_none()
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
            canvas.text(line, (plot.left, y), Anchor::Start, 0.0, bold(HEADING));
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
    Turned { angle: f32, labels: Vec<String>, stride: usize },
}

/// The axes of a panel on its plot rectangle.
struct Frame {
    plot: Rect,
    x: Ruler,
    y: Ruler,
    bins: Option<Bins>,
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
    fn at(&self, x: f64, y: f64) -> Option<Px> {
        Some((self.px(self.x.fraction(x)?), self.py(self.y.fraction(y)?)))
    }

    fn px(&self, fraction: f64) -> f32 {
        (f64::from(self.plot.left) + fraction * f64::from(self.plot.width())).clamp(-1e6, 1e6) as f32
    }

    fn py(&self, fraction: f64) -> f32 {
        (f64::from(self.plot.bottom) - fraction * f64::from(self.plot.height())).clamp(-1e6, 1e6) as f32
    }

    fn standing(&self, labels: &[String]) -> Standing {
        let slot = self.plot.width() / labels.len().max(1) as f32;
        let flat: Vec<_> = labels.iter().map(|l| fit_lines(l, TICK, false, slot - 12.0, 3)).collect();
        if flat.iter().all(|(_, whole)| *whole) {
            return Standing::Flat(flat.into_iter().map(|(lines, _)| lines).collect());
        }
        let longest = 0.8 * self.plot.height().max(220.0);
        let labels = labels.iter().map(|l| cut(l, TICK, false, longest)).collect();
        if slot >= 42.0 {
            Standing::Turned { angle: -SLANT, labels, stride: 1 }
        } else {
            let stride = (28.0 / slot).ceil().max(1.0) as usize;
            Standing::Turned { angle: -std::f32::consts::FRAC_PI_2, labels, stride }
        }
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
            Some(Standing::Turned { angle, labels, .. }) => {
                let (sin, cos) = (-angle).sin_cos();
                bottom += widest(&mut labels.iter()) * sin + TICK * 0.4;
                let slot = self.plot.width() / labels.len().max(1) as f32;
                for (i, label) in labels.iter().enumerate() {
                    left = left.max(text_width(label, TICK, false) * cos - (i as f32 + 0.5) * slot + 12.0);
                }
            }
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
            canvas.text("no data", plot.center(), Anchor::Middle, 0.0, Type { color: FRAME, ..ink(HEADING) });
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
                canvas.text(&layer.name, (at.0 + gap, at.1), anchor, 0.0, Type { color: layer.color, ..ink(NOTE) });
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
                    canvas.text(label, (x, middle), Anchor::Middle, 0.0, ink(TICK));
                }
            }
            Some(Standing::Flat(labels)) => {
                let most = labels.iter().map(Vec::len).max().unwrap_or(1);
                for (i, lines) in labels.iter().enumerate() {
                    let Some(x) = self.x.fraction(i as f64).map(|f| self.px(f)) else { continue };
                    for (k, line) in lines.iter().enumerate() {
                        let y = middle + k as f32 * TICK * LEADING;
                        canvas.text(line, (x, y), Anchor::Middle, 0.0, ink(TICK));
                    }
                }
                below += (most as f32 - 1.0) * TICK * LEADING;
            }
            Some(Standing::Turned { angle, labels, stride }) => {
                let mut longest: f32 = 0.0;
                for (i, label) in labels.iter().enumerate().step_by(stride) {
                    let Some(x) = self.x.fraction(i as f64).map(|f| self.px(f)) else { continue };
                    canvas.text(label, (x + 5.0, bottom + TICK_GAP), Anchor::End, angle, ink(TICK));
                    longest = longest.max(text_width(label, TICK, false));
                }
                below = bottom + TICK_GAP + longest * (-angle).sin() + 0.9 * TICK;
            }
        }
        let lines = fit_lines(&axis.label, LABEL, false, self.plot.width(), 2).0;
        for (i, line) in lines.iter().enumerate() {
            let y = below + 10.0 + (i as f32 + 0.5) * LABEL * LEADING;
            canvas.text(line, (0.5 * (left + right), y), Anchor::Middle, 0.0, ink(LABEL));
        }
        if let Some(factor) = &self.x.factor {
            canvas.text(factor, (right, below + 10.0 + 0.5 * LABEL * LEADING), Anchor::End, 0.0, ink(TICK));
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
                    canvas.text(line, (left - TICK_GAP, y), Anchor::End, 0.0, ink(TICK));
                    widest = widest.max(text_width(line, TICK, false));
                }
            }
        } else {
            for (v, label) in &self.y.ticks {
                let Some(y) = self.y.fraction(*v).map(|f| self.py(f)) else { continue };
                canvas.stroke(&[(left - 7.0, y), (left, y)], 1.5, &[], FRAME);
                canvas.text(label, (left - TICK_GAP, y), Anchor::End, 0.0, ink(TICK));
                widest = widest.max(text_width(label, TICK, false));
            }
        }
        let lines = fit_lines(&axis.label, LABEL, false, self.plot.height(), 2).0;
        for (i, line) in lines.iter().rev().enumerate() {
            let x = left - TICK_GAP - widest - 8.0 - (i as f32 + 0.5) * LABEL * LEADING;
            let turn = -std::f32::consts::FRAC_PI_2;
            canvas.text(line, (x, 0.5 * (top + bottom)), Anchor::Middle, turn, ink(LABEL));
        }
        if let Some(factor) = &self.y.factor {
            canvas.text(factor, (left - 8.0, top - 24.0), Anchor::End, 0.0, ink(TICK));
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
            canvas.text(label, (bar.right + 12.0, y), Anchor::Start, 0.0, ink(TICK));
            widest = widest.max(text_width(label, TICK, false));
        }
        let name = match &ruler.factor {
            Some(factor) => format!("{name} {factor}"),
            None => name.to_owned(),
        };
        let name = cut(&name, TICK, false, bar.height());
        let at = (bar.right + 12.0 + widest + 22.0, bar.center().1);
        canvas.text(&name, at, Anchor::Middle, -std::f32::consts::FRAC_PI_2, ink(TICK));
    }

    fn layer(&self, canvas: &mut Canvas, panel: &Panel, layer: &Layer, group: usize) {
        let plot = self.plot;
        let (color, width) = (layer.color, layer.width);
        let dash = dashes(layer.stroke, width);
        match &layer.mark {
            Mark::Line(points) => {
                for run in self.runs(points.iter().map(|&(x, y)| self.at(x, y))) {
                    match run[..] {
                        [alone] => canvas.disc(alone, width.max(3.0), color),
                        _ => canvas.stroke(&run, width, &dash, color),
                    }
                }
            }
            Mark::Scatter(points, marker) => {
                for at in points.iter().filter_map(|&(x, y)| self.at(x, y)) {
                    draw_marker(canvas, at, *marker, 6.0, color);
                }
            }
            Mark::Errors(points, marker) => {
                for &(x, y, lo, hi) in points {
                    if let (Some(a), Some(b)) = (self.at(x, lo), self.at(x, hi)) {
                        whisker(canvas, a, b, 9.0, 2.5, color);
                    }
                    if let Some(at) = self.at(x, y) {
                        draw_marker(canvas, at, *marker, 7.5, color);
                    }
                }
            }
            Mark::Band(points) => {
                let both = |&(x, lo, hi): &(f64, f64, f64)| Some((self.at(x, lo)?, self.at(x, hi)?));
                for run in points.iter().map(both).collect::<Vec<_>>().split(Option::is_none) {
                    let sides: (Vec<Px>, Vec<Px>) = run.iter().flatten().copied().unzip();
                    let polygon: Vec<Px> = sides.0.into_iter().chain(sides.1.into_iter().rev()).collect();
                    canvas.fill(&polygon, color.faded(0.22));
                }
            }
            &Mark::HSpan(lo, hi) => {
                if let (Some(a), Some(b)) = (self.y.fraction_or_end(lo), self.y.fraction_or_end(hi)) {
                    let (a, b) = (self.py(a), self.py(b));
                    canvas.fill_rect(Rect { top: a.min(b), bottom: a.max(b), ..plot }, color.faded(0.16));
                }
            }
            &Mark::VSpan(lo, hi) => {
                if let (Some(a), Some(b)) = (self.x.fraction_or_end(lo), self.x.fraction_or_end(hi)) {
                    let (a, b) = (self.px(a), self.px(b));
                    canvas.fill_rect(Rect { left: a.min(b), right: a.max(b), ..plot }, color.faded(0.16));
                }
            }
            &Mark::HLine(y) => {
                if let Some(y) = self.y.fraction(y).map(|f| self.py(f)) {
                    canvas.stroke(&[(plot.left, y), (plot.right, y)], width, &dash, color);
                }
            }
            &Mark::VLine(x) => {
                if let Some(x) = self.x.fraction(x).map(|f| self.px(f)) {
                    canvas.stroke(&[(x, plot.top), (x, plot.bottom)], width, &dash, color);
                }
            }
            Mark::Bars { values, intervals } => {
                let slot = Slots::of(panel, group);
                let ruler = if slot.lying { &self.x } else { &self.y };
                let foot = if panel_is_log(panel, slot.lying) { ruler.lo } else { 0f64.clamp(ruler.lo, ruler.hi) };
                for (i, &value) in values.iter().enumerate() {
                    if let (Some(a), Some(b)) = (slot.at(self, i, -0.5, foot), slot.at(self, i, 0.5, value)) {
                        canvas.fill_rect(between(a, b), softened(color));
                    }
                    let ends = intervals.get(i).copied().unwrap_or((f64::NAN, f64::NAN));
                    if let (Some(a), Some(b)) = (slot.at(self, i, 0.0, ends.0), slot.at(self, i, 0.0, ends.1)) {
                        whisker(canvas, a, b, 8.0, 2.5, INK);
                    }
                }
            }
            Mark::Boxes(samples) => {
                let slot = Slots::of(panel, group);
                for (i, values) in samples.iter().enumerate() {
                    self.draw_box(canvas, slot, i, values, color);
                }
            }
            Mark::Histogram { values, .. } => {
                let Some(bins) = self.bins else { return };
                let mut outline = vec![];
                for (k, &count) in bins.count(values).iter().enumerate() {
                    let (Some(a), Some(b)) =
                        (self.at(bins.edge(k), count as f64), self.at(bins.edge(k + 1), count as f64))
                    else {
                        continue;
                    };
                    if outline.is_empty() {
                        outline.push((a.0, plot.bottom));
                    }
                    outline.extend([a, b]);
                }
                if let Some(&(x, _)) = outline.last() {
                    outline.push((x, plot.bottom));
                }
                canvas.fill(&outline, color.faded(0.25));
                canvas.stroke(&outline, 2.5, &dash, color);
            }
            Mark::Hulls { poses, length, beam } => {
                for &pose in poses {
                    let outline: Option<Vec<Px>> =
                        hull(pose, *length, *beam).iter().map(|&(x, y)| self.at(x, y)).collect();
                    let Some(mut outline) = outline else { continue };
                    canvas.fill(&outline, color.faded(0.15));
                    outline.extend_from_within(..1);
                    canvas.stroke(&outline, width, &dash, color);
                }
            }
            Mark::Arrows(arrows) => {
                for &[from, to] in arrows {
                    if let (Some(a), Some(b)) = (self.at(from.0, from.1), self.at(to.0, to.1)) {
                        arrow(canvas, a, b, width.min(3.0), color);
                    }
                }
            }
            Mark::Heatmap { values, range, annotate } => {
                self.cells(canvas, values, color_range(values, *range), *annotate);
            }
            // Written on top of everything else, after the frame.
            Mark::Text(_) => {}
        }
    }

    /// Unbroken runs of points; those closer than a fraction of a pixel to the one before add nothing and are dropped.
    fn runs(&self, points: impl Iterator<Item = Option<Px>>) -> Vec<Vec<Px>> {
        let mut runs: Vec<Vec<Px>> = vec![vec![]];
        let mut skipped = None;
        for point in points {
            let Some(p) = point else {
                if let (Some(run), Some(end)) = (runs.last_mut(), skipped.take()) {
                    run.push(end);
                }
                runs.push(vec![]);
                continue;
            };
            let Some(run) = runs.last_mut() else { continue };
            match run.last() {
                Some(q) if (p.0 - q.0).hypot(p.1 - q.1) < 0.5 => skipped = Some(p),
                _ => {
                    run.push(p);
                    skipped = None;
                }
            }
        }
        if let (Some(run), Some(end)) = (runs.last_mut(), skipped) {
            run.push(end);
        }
        runs.retain(|run| !run.is_empty());
        runs
    }

    fn draw_box(&self, canvas: &mut Canvas, slot: Slots, i: usize, values: &[f64], color: Color) {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|&v| drawable(v)).collect();
        sorted.sort_by(f64::total_cmp);
        let (Some(q1), Some(q2), Some(q3)) = (quantile(&sorted, 0.25), quantile(&sorted, 0.5), quantile(&sorted, 0.75))
        else {
            return;
        };
        let reach = 1.5 * (q3 - q1);
        let lowest = sorted.iter().copied().find(|&v| v >= q1 - reach).unwrap_or(q1);
        let highest = sorted.iter().rev().copied().find(|&v| v <= q3 + reach).unwrap_or(q3);
        let at = |side: f64, v: f64| slot.at(self, i, side, v);
        for (from, to) in [(q1, lowest), (q3, highest)] {
            if let (Some(a), Some(b)) = (at(0.0, from), at(0.0, to)) {
                canvas.stroke(&[a, b], 2.5, &[], color);
            }
            if let (Some(a), Some(b)) = (at(-0.25, to), at(0.25, to)) {
                canvas.stroke(&[a, b], 2.5, &[], color);
            }
        }
        if let (Some(a), Some(b)) = (at(-0.5, q1), at(0.5, q3)) {
            let rect = between(a, b);
            canvas.fill_rect(rect, Color::rgb(255, 255, 255));
            canvas.fill_rect(rect, color.faded(0.3));
            canvas.stroke_rect(rect, 2.5, color);
        }
        if let (Some(a), Some(b)) = (at(-0.5, q2), at(0.5, q2)) {
            canvas.stroke(&[a, b], 4.0, &[], color);
        }
        for &v in sorted.iter().filter(|&&v| v < lowest || v > highest) {
            if let Some(p) = at(0.0, v) {
                canvas.disc(p, 4.0, color.faded(0.6));
            }
        }
    }

    fn cells(&self, canvas: &mut Canvas, values: &[Vec<f64>], range: (f64, f64), annotate: bool) {
        for (i, row) in values.iter().enumerate() {
            for (j, &v) in row.iter().enumerate() {
                let (row, column) = (i as f64, j as f64);
                let (Some(a), Some(b)) = (self.at(column - 0.5, row - 0.5), self.at(column + 0.5, row + 0.5)) else {
                    continue;
                };
                let rect = between(a, b);
                let color = if drawable(v) { cell_color(v, range) } else { Color::rgb(235, 235, 235) };
                canvas.fill_rect(rect, color);
                canvas.stroke_rect(rect, 1.5, Color::rgb(255, 255, 255));
                // A value that does not fit its cell is left to the colour bar and the CSV.
                let text = cell_text(v, range);
                let size = [TICK, NOTE, 16.0]
                    .into_iter()
                    .find(|&s| text_width(&text, s, false) < rect.width() - 6.0 && rect.height() > 1.2 * s);
                if let Some(size) = size.filter(|_| annotate && self.plot.contains(rect.center())) {
                    let color = if color.luminance() > 0.35 { INK } else { Color::rgb(255, 255, 255) };
                    canvas.text(&text, rect.center(), Anchor::Middle, 0.0, Type { size, bold: false, color });
                }
            }
        }
    }
}

/// Where a bar or box stands among those of its category.
#[derive(Clone, Copy)]
struct Slots {
    lying: bool,
    /// Offset of its middle from the category, and its breadth, in categories.
    offset: f64,
    breadth: f64,
}

impl Slots {
    fn of(panel: &Panel, group: usize) -> Self {
        let groups = panel.layers.iter().filter(|l| is_grouped(l)).count().max(1) as f64;
        let pitch = 0.78 / groups;
        let offset = (group as f64 - 0.5 * (groups - 1.0)) * pitch;
        Self { lying: lies(panel), offset, breadth: if groups > 1.0 { 0.9 * pitch } else { 0.7 * pitch } }
    }

    /// The point at `value` of category `i`, `side` breadths off the middle.
    fn at(self, frame: &Frame, i: usize, side: f64, value: f64) -> Option<Px> {
        let across = i as f64 + self.offset + side * self.breadth;
        if self.lying { frame.at(value, across) } else { frame.at(across, value) }
    }
}

/// The bins all histograms of a panel share, equal on the scale of its x axis.
#[derive(Clone, Copy)]
struct Bins {
    lo: f64,
    hi: f64,
    n: usize,
    log: bool,
}

impl Bins {
    fn of(panel: &Panel) -> Option<Self> {
        let log = panel.x.scale == Scale::Log;
        let along = |v: f64| if log { v.log10() } else { v };
        let (mut all, mut asked, mut most) = (vec![], 0, 0);
        for layer in &panel.layers {
            if let Mark::Histogram { values, bins } = &layer.mark {
                let before = all.len();
                all.extend(values.iter().copied().filter(|&v| drawable(v) && (!log || v > 0.0)).map(along));
                most = most.max(all.len() - before);
                asked = asked.max(*bins);
            }
        }
        all.sort_by(f64::total_cmp);
        let (lo, hi) = (*all.first()?, *all.last()?);
        if hi - lo <= 1e-12 * hi.abs().max(lo.abs()) {
            let half = if log { 0.5 } else { 0.5 * lo.abs().max(1.0) };
            return Some(Self { lo: lo - half, hi: hi + half, n: asked.clamp(1, 200), log });
        }
        let spread = quantile(&all, 0.75)? - quantile(&all, 0.25)?;
        let width = 2.0 * spread / (most.max(1) as f64).cbrt();
        let fitting = if width > 0.0 { ((hi - lo) / width).ceil().clamp(5.0, 60.0) as usize } else { 20 };
        Some(Self { lo, hi, n: if asked > 0 { asked.min(500) } else { fitting }, log })
    }

    fn edge(self, k: usize) -> f64 {
        let v = self.lo + (self.hi - self.lo) * k as f64 / self.n as f64;
        if self.log { 10f64.powf(v) } else { v }
    }

    fn count(self, values: &[f64]) -> Vec<usize> {
        let mut counts = vec![0; self.n];
        for &v in values.iter().filter(|&&v| drawable(v) && (!self.log || v > 0.0)) {
            let along = if self.log { v.log10() } else { v };
            let k = ((along - self.lo) / (self.hi - self.lo) * self.n as f64) as usize;
            counts[k.min(self.n - 1)] += 1;
        }
        counts
    }
}

/// Quantile of sorted values by linear interpolation; `None` for no values.
fn quantile(sorted: &[f64], q: f64) -> Option<f64> {
    let position = q * sorted.len().checked_sub(1)? as f64;
    let i = position as usize;
    let next = sorted.get(i + 1).unwrap_or(&sorted[i]);
    Some(sorted[i] + (next - sorted[i]) * (position - i as f64))
}

/// The smallest ranges that show all layers of a panel.
fn extents(panel: &Panel, bins: Option<Bins>) -> (Extent, Extent) {
    let (mut x, mut y) = (Extent::new(&panel.x.scale), Extent::new(&panel.y.scale));
    let lying = lies(panel);
    for layer in &panel.layers {
        // A point counts as a whole: an x whose y is missing is not drawn.
        let mut both = |px: f64, py: f64| {
            if drawable(px) && drawable(py) {
                x.add(px);
                y.add(py);
            }
        };
        match &layer.mark {
            Mark::Line(points) | Mark::Scatter(points, _) => points.iter().for_each(|&(px, py)| both(px, py)),
            Mark::Errors(points, _) => points.iter().for_each(|&(px, py, lo, hi)| {
                [py, lo, hi].into_iter().for_each(|v| both(px, v));
            }),
            Mark::Band(points) => points.iter().for_each(|&(px, lo, hi)| {
                if drawable(lo) && drawable(hi) {
                    both(px, lo);
                    both(px, hi);
                }
            }),
            Mark::Arrows(arrows) => arrows.iter().flatten().for_each(|&(px, py)| both(px, py)),
            Mark::Text((px, py)) => both(*px, *py),
            Mark::Hulls { poses, length, beam } => {
                poses.iter().flat_map(|&pose| hull(pose, *length, *beam)).for_each(|(px, py)| both(px, py));
            }
            Mark::HSpan(lo, hi) => [*lo, *hi].into_iter().for_each(|v| y.add(v)),
            Mark::VSpan(lo, hi) => [*lo, *hi].into_iter().for_each(|v| x.add(v)),
            Mark::HLine(v) => y.add(*v),
            Mark::VLine(v) => x.add(*v),
            Mark::Bars { values, intervals } => {
                let along = if lying { &mut x } else { &mut y };
                along.add_foot();
                values.iter().chain(intervals.iter().flat_map(|(lo, hi)| [lo, hi])).for_each(|&v| along.add(v));
            }
            Mark::Boxes(samples) => {
                let along = if lying { &mut x } else { &mut y };
                samples.iter().flatten().for_each(|&v| along.add(v));
            }
            Mark::Histogram { values, .. } => {
                let Some(bins) = bins else { continue };
                x.add(bins.edge(0));
                x.add(bins.edge(bins.n));
                y.add_foot();
                bins.count(values).iter().for_each(|&c| y.add(c as f64));
            }
            Mark::Heatmap { values, .. } => {
                let columns = values.iter().map(Vec::len).max().unwrap_or(0);
                if columns > 0 {
                    both(-0.5, -0.5);
                    both(columns as f64 - 0.5, values.len() as f64 - 0.5);
                }
            }
        }
        if matches!(layer.mark, Mark::Bars { .. } | Mark::Boxes(_)) {
            // Without labels the categories are numbered.
            let n = match &layer.mark {
                Mark::Bars { values, .. } => values.len(),
                Mark::Boxes(samples) => samples.len(),
                _ => 0,
            };
            let across = if lying { &mut y } else { &mut x };
            across.add(-0.5);
            across.add(n.max(1) as f64 - 0.5);
        }
    }
    (x, y)
}

fn has_data(layer: &Layer) -> bool {
    let pair = |&(x, y): &(f64, f64)| drawable(x) && drawable(y);
    match &layer.mark {
        Mark::Line(points) | Mark::Scatter(points, _) => points.iter().any(pair),
        Mark::Errors(points, _) => points.iter().any(|&(x, y, _, _)| pair(&(x, y))),
        Mark::Band(points) => points.iter().any(|&(x, lo, hi)| drawable(x) && pair(&(lo, hi))),
        Mark::Bars { values, .. } | Mark::Histogram { values, .. } => values.iter().any(|&v| drawable(v)),
        Mark::Boxes(rows) | Mark::Heatmap { values: rows, .. } => rows.iter().flatten().any(|&v| drawable(v)),
        Mark::Hulls { poses, .. } => poses.iter().any(|pose| pose.iter().all(|&v| drawable(v))),
        Mark::Arrows(arrows) => arrows.iter().any(|ends| ends.iter().all(pair)),
        Mark::HSpan(..) | Mark::VSpan(..) | Mark::HLine(_) | Mark::VLine(_) | Mark::Text(_) => false,
    }
}

fn is_span(layer: &Layer) -> bool {
    matches!(layer.mark, Mark::HSpan(..) | Mark::VSpan(..))
}

fn is_grouped(layer: &Layer) -> bool {
    matches!(layer.mark, Mark::Bars { .. } | Mark::Boxes(_))
}

fn panel_is_log(panel: &Panel, lying: bool) -> bool {
    (if lying { &panel.x } else { &panel.y }).scale == Scale::Log
}

type Matrix = [Vec<f64>];

/// The heat map of a panel, if it has one: the name and the range of its colours.
fn heatmap(panel: &Panel) -> Option<(&str, (f64, f64))> {
    panel.layers.iter().find_map(|layer| match &layer.mark {
        Mark::Heatmap { values, range, .. } => Some((layer.name.as_str(), color_range(values, *range))),
        _ => None,
    })
}

fn color_range(values: &Matrix, fixed: Option<(f64, f64)>) -> (f64, f64) {
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

fn dashes(stroke: Stroke, width: f32) -> Vec<f32> {
    match stroke {
        Stroke::Solid => vec![],
        Stroke::Dashed => vec![5.0 * width.max(2.0), 3.0 * width.max(2.0)],
        Stroke::Dotted => vec![1.2 * width.max(2.0), 2.0 * width.max(2.0)],
    }
}

/// The colour of large solid areas: opaque, so that the grid does not show through.
fn softened(color: Color) -> Color {
    color.mix(Color::rgb(255, 255, 255), 0.12)
}

fn between(a: Px, b: Px) -> Rect {
    Rect { left: a.0.min(b.0), top: a.1.min(b.1), right: a.0.max(b.0), bottom: a.1.max(b.1) }
}

/// The outline of a ship as (east, north), bow at half a length ahead of the pose.
fn hull([x, y, psi]: [f64; 3], length: f64, beam: f64) -> [(f64, f64); 9] {
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

fn whisker(canvas: &mut Canvas, a: Px, b: Px, cap: f32, width: f32, color: Color) {
    canvas.stroke(&[a, b], width, &[], color);
    let lying = (a.1 - b.1).abs() < 0.01;
    let (dx, dy) = if lying { (0.0, cap) } else { (cap, 0.0) };
    for (x, y) in [a, b] {
        canvas.stroke(&[(x - dx, y - dy), (x + dx, y + dy)], width, &[], color);
    }
}

fn arrow(canvas: &mut Canvas, a: Px, b: Px, width: f32, color: Color) {
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

fn draw_marker(canvas: &mut Canvas, (x, y): Px, marker: Marker, r: f32, color: Color) {
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

/// The legend: names of series with a sample of each, in rows.
#[derive(Default)]
struct Strip<'a> {
    rows: Vec<Vec<Entry<'a>>>,
}

struct Entry<'a> {
    name: String,
    width: f32,
    /// All layers of this name: a line and its band are one entry.
    layers: Vec<&'a Layer>,
}

const ROW: f32 = 36.0;

impl<'a> Strip<'a> {
    fn new(layers: impl IntoIterator<Item = &'a Layer>, width: f32) -> Self {
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

    fn height(&self) -> f32 {
        if self.rows.is_empty() { 0.0 } else { self.rows.len() as f32 * ROW + 10.0 }
    }

    fn draw(&self, canvas: &mut Canvas, (left, top): Px) {
        for (i, row) in self.rows.iter().enumerate() {
            let (mut x, y) = (left, top + (i as f32 + 0.5) * ROW);
            for entry in row {
                for layer in &entry.layers {
                    sample(canvas, layer, (x, y));
                }
                canvas.text(&entry.name, (x + SWATCH + 12.0, y), Anchor::Start, 0.0, ink(LABEL));
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
        Mark::Boxes(_) | Mark::Histogram { .. } => {
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

/// Breaks a text at its spaces into at most `most` lines of `width` px; tells whether it did so without cutting anything.
fn fit_lines(text: &str, size: f32, bold: bool, width: f32, most: usize) -> (Vec<String>, bool) {
    let mut lines: Vec<String> = vec![];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size, bold) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    let mut whole = lines.len() <= most;
    if !whole {
        let rest = lines.split_off(most.max(1) - 1).join(" ");
        lines.push(rest);
    }
    for line in &mut lines {
        let short = cut(line, size, bold, width);
        whole &= short == *line;
        *line = short;
    }
    (lines, whole)
}

/// A text, ended by an ellipsis where it would be wider than `width` px.
fn cut(text: &str, size: f32, bold: bool, width: f32) -> String {
    if text_width(text, size, bold) <= width {
        return text.to_owned();
    }
    let mut short: String = text.to_owned();
    while short.pop().is_some() {
        let candidate = format!("{}…", short.trim_end());
        if text_width(&candidate, size, bold) <= width {
            return candidate;
        }
    }
    "…".to_owned()
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

    #[test]
    fn tracks_have_the_same_metres_per_pixel_on_both_axes() {
        let panel = Panel::track("").with(Layer::line("a", palette::TRUTH, [(0.0, 0.0), (1000.0, 40.0)]));
        let frame = Frame::new(&panel, Rect { left: 100.0, top: 20.0, right: 880.0, bottom: 520.0 });
        let (Some(a), Some(b), Some(c)) = (frame.at(0.0, 0.0), frame.at(500.0, 0.0), frame.at(0.0, 500.0)) else {
            panic!("finite points have a place");
        };
        assert!(((b.0 - a.0) - (a.1 - c.1)).abs() < 0.01, "{} {}", b.0 - a.0, a.1 - c.1);
    }

    #[test]
    fn quantiles_interpolate_between_samples() {
        let sorted = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(quantile(&sorted, 0.5), Some(2.5));
        assert_eq!(quantile(&sorted, 0.0), Some(1.0));
        assert_eq!(quantile(&sorted, 1.0), Some(4.0));
        assert_eq!(quantile(&[], 0.5), None);
    }

    #[test]
    fn histograms_of_a_panel_share_their_bins_and_count_every_value_once() {
        let values: Vec<f64> = (0..300).map(|i| f64::from(i).sin()).collect();
        let panel = Panel::default().with(Layer::histogram("a", palette::BLUE, values.clone())).with(Layer::histogram(
            "b",
            palette::GREEN,
            [-3.0, f64::NAN, 4.0],
        ));
        let bins = Bins::of(&panel).unwrap();
        assert_eq!((bins.edge(0), bins.edge(bins.n)), (-3.0, 4.0));
        assert_eq!(bins.count(&values).iter().sum::<usize>(), 300);
        assert_eq!(bins.count(&[-3.0, f64::NAN, 4.0]).iter().sum::<usize>(), 2);
    }

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

    #[test]
    fn cells_of_a_heat_map_show_two_digits_of_the_largest_value() {
        assert_eq!(cell_text(0.08, (0.0, 0.9)), "0.08");
        assert_eq!(cell_text(-0.449, (-1.0, 1.0)), "−0.45");
        assert_eq!(cell_text(3.26, (0.0, 14.0)), "3");
        assert_eq!(cell_text(2.5e-6, (0.0, 4e-6)), "2.5e−6");
        assert_eq!(cell_text(f64::NAN, (0.0, 1.0)), "–");
    }

    #[test]
    fn long_texts_are_wrapped_and_at_last_cut() {
        let (lines, whole) = fit_lines("propeller race on the rudder", TICK, false, 200.0, 3);
        assert!(whole && lines.len() > 1, "{lines:?}");
        assert!(lines.iter().all(|l| text_width(l, TICK, false) <= 200.0));
        let (lines, whole) = fit_lines("Donaudampfschifffahrtsgesellschaft", TICK, false, 200.0, 3);
        assert!(!whole && lines[0].ends_with('…'));
        assert_eq!(fit_lines("", TICK, false, 200.0, 3), (vec![], true));
    }
}
