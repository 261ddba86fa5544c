//! The layers of a panel: the room their data take, and how each kind is drawn.
//! Axes, titles and legends are not its business: it is given a frame that turns values into pixels.

use super::axis::{Extent, Scale, drawable};
use super::canvas::{Anchor, Canvas, Px, Rect, Run, Type, text_width};
use super::draw::Frame;
use super::figure::{Layer, Mark, Marker, Panel, Stroke};
use super::palette::{self, Color};
use super::style::{INK, NOTE, TICK};
use crate::numerals::{fixed, sig};

/// Whether bars and boxes of a panel lie: the categories are on the y axis only.
pub(super) fn lies(panel: &Panel) -> bool {
    panel.y.labels().is_some() && panel.x.labels().is_none()
}

impl Frame {
    /// Draws one layer; `group` counts the layers of bars and boxes before it.
    pub(super) fn layer(&self, canvas: &mut Canvas, panel: &Panel, layer: &Layer, group: usize) {
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
                    canvas.text(&text, rect.center(), Anchor::Middle, Run::Across, Type { size, bold: false, color });
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
pub(super) struct Bins {
    lo: f64,
    hi: f64,
    n: usize,
    log: bool,
}

impl Bins {
    pub fn of(panel: &Panel) -> Option<Self> {
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
pub(super) fn extents(panel: &Panel, bins: Option<Bins>) -> (Extent, Extent) {
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

pub(super) fn has_data(layer: &Layer) -> bool {
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

pub(super) fn is_span(layer: &Layer) -> bool {
    matches!(layer.mark, Mark::HSpan(..) | Mark::VSpan(..))
}

pub(super) fn is_grouped(layer: &Layer) -> bool {
    matches!(layer.mark, Mark::Bars { .. } | Mark::Boxes(_))
}

fn panel_is_log(panel: &Panel, lying: bool) -> bool {
    (if lying { &panel.x } else { &panel.y }).scale == Scale::Log
}

type Matrix = [Vec<f64>];

/// The heat map of a panel, if it has one: the name and the range of its colours.
pub(super) fn heatmap(panel: &Panel) -> Option<(&str, (f64, f64))> {
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

pub(super) fn cell_color(v: f64, (lo, hi): (f64, f64)) -> Color {
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

pub(super) fn dashes(stroke: Stroke, width: f32) -> Vec<f32> {
    match stroke {
        Stroke::Solid => vec![],
        Stroke::Dashed => vec![5.0 * width.max(2.0), 3.0 * width.max(2.0)],
        Stroke::Dotted => vec![1.2 * width.max(2.0), 2.0 * width.max(2.0)],
    }
}

/// The colour of large solid areas: opaque, so that the grid does not show through.
pub(super) fn softened(color: Color) -> Color {
    color.mix(Color::rgb(255, 255, 255), 0.12)
}

fn between(a: Px, b: Px) -> Rect {
    Rect { left: a.0.min(b.0), top: a.1.min(b.1), right: a.0.max(b.0), bottom: a.1.max(b.1) }
}

/// The outline of a ship as (east, north), bow at half a length ahead of the pose.
pub(super) fn hull([x, y, psi]: [f64; 3], length: f64, beam: f64) -> [(f64, f64); 9] {
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

pub(super) fn whisker(canvas: &mut Canvas, a: Px, b: Px, cap: f32, width: f32, color: Color) {
    canvas.stroke(&[a, b], width, &[], color);
    let lying = (a.1 - b.1).abs() < 0.01;
    let (dx, dy) = if lying { (0.0, cap) } else { (cap, 0.0) };
    for (x, y) in [a, b] {
        canvas.stroke(&[(x - dx, y - dy), (x + dx, y + dy)], width, &[], color);
    }
}

pub(super) fn arrow(canvas: &mut Canvas, a: Px, b: Px, width: f32, color: Color) {
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

pub(super) fn draw_marker(canvas: &mut Canvas, (x, y): Px, marker: Marker, r: f32, color: Color) {
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
    fn cells_of_a_heat_map_show_two_digits_of_the_largest_value() {
        assert_eq!(cell_text(0.08, (0.0, 0.9)), "0.08");
        assert_eq!(cell_text(-0.449, (-1.0, 1.0)), "−0.45");
        assert_eq!(cell_text(3.26, (0.0, 14.0)), "3");
        assert_eq!(cell_text(2.5e-6, (0.0, 4e-6)), "2.5e−6");
        assert_eq!(cell_text(f64::NAN, (0.0, 1.0)), "–");
    }
}
