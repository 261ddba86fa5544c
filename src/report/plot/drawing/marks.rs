//! How each kind of layer is drawn, in a frame that turns values into pixels.
//! Axes, titles and legends are drawn elsewhere.

use super::extent::{is_grouped, lies, quantile};
use super::frame::Frame;
use super::heatmap::cells;
use super::shapes::{arrow, dashes, draw_marker, hull, softened, whisker};
use super::style::{INK, NOTE, ink};
use crate::report::plot::axis::{Scale, drawable};
use crate::report::plot::figure::Panel;
use crate::report::plot::layer::{Layer, Mark, Marker};
use crate::report::plot::palette::Color;
use crate::report::plot::sheet::canvas::{Anchor, Canvas, Run, Type};
use crate::report::plot::sheet::geometry::{Px, Rect, between};

/// Draws one layer; `group` counts the layers of bars and boxes before it.
pub(in crate::report::plot) fn draw_layer(
    frame: &Frame,
    canvas: &mut Canvas,
    panel: &Panel,
    layer: &Layer,
    group: usize,
) {
    let (color, width) = (layer.color, layer.width);
    let mut brush = Brush { frame, canvas, color, width, dash: dashes(layer.stroke, width) };
    match &layer.mark {
        Mark::Line(points) => brush.line(points),
        Mark::Scatter(points, marker) => brush.points(points, *marker),
        Mark::Errors(points, marker) => brush.errors(points, *marker),
        Mark::Band(points) => brush.band(points),
        &Mark::HSpan(lo, hi) => brush.h_span(lo, hi),
        &Mark::VSpan(lo, hi) => brush.v_span(lo, hi),
        &Mark::HLine(y) => {
            if let Some(y) = frame.y_at(y) {
                brush.stroke(&[(frame.plot.left, y), (frame.plot.right, y)]);
            }
        }
        &Mark::VLine(x) => {
            if let Some(x) = frame.x_at(x) {
                brush.stroke(&[(x, frame.plot.top), (x, frame.plot.bottom)]);
            }
        }
        Mark::Bars { values, intervals } => brush.bars(&Slots::of(panel, group), values, intervals),
        Mark::Boxes(samples) => {
            let slots = Slots::of(panel, group);
            samples.iter().enumerate().for_each(|(i, values)| brush.whiskered(&slots, i, values));
        }
        Mark::Hulls { poses, length, beam } => poses.iter().for_each(|&pose| brush.hull(pose, *length, *beam)),
        Mark::Arrows(arrows) => {
            for &[from, to] in arrows {
                if let (Some(a), Some(b)) = (frame.at(from.0, from.1), frame.at(to.0, to.1)) {
                    arrow(brush.canvas, a, b, width.min(3.0), color);
                }
            }
        }
        Mark::Heatmap { values, range, annotate } => cells(frame, brush.canvas, values, *range, *annotate),
        // Written on top of everything else, after the frame.
        Mark::Text(_) => {}
    }
}

/// Writes the remarks of a panel, each anchored by the side of the plot it is on, so that it stays inside.
pub(in crate::report::plot) fn draw_remarks(frame: &Frame, canvas: &mut Canvas, panel: &Panel) {
    let plot = frame.plot;
    for layer in &panel.layers {
        let Mark::Text((x, y)) = layer.mark else { continue };
        let Some(at) = frame.at(x, y).filter(|&p| plot.contains(p)) else { continue };
        let (anchor, gap) = match (at.0 - plot.left) / plot.width() {
            s if s < 0.33 => (Anchor::Start, 10.0),
            s if s > 0.67 => (Anchor::End, -10.0),
            _ => (Anchor::Middle, 0.0),
        };
        let style = Type { color: layer.color, ..ink(NOTE) };
        canvas.text(&layer.name, (at.0 + gap, at.1), anchor, Run::Across, style);
    }
}

/// What draws a layer: where, in which colour, and with which line.
struct Brush<'a> {
    frame: &'a Frame,
    canvas: &'a mut Canvas,
    color: Color,
    width: f32,
    dash: Vec<f32>,
}

impl Brush<'_> {
    fn stroke(&mut self, path: &[Px]) {
        self.canvas.stroke(path, self.width, &self.dash, self.color);
    }

    fn line(&mut self, points: &[(f64, f64)]) {
        let frame = self.frame;
        for run in unbroken(points.iter().map(|&(x, y)| frame.at(x, y))) {
            match run[..] {
                [alone] => self.canvas.disc(alone, self.width.max(3.0), self.color),
                _ => self.stroke(&run),
            }
        }
    }

    fn points(&mut self, points: &[(f64, f64)], marker: Marker) {
        for at in points.iter().filter_map(|&(x, y)| self.frame.at(x, y)) {
            draw_marker(self.canvas, at, marker, 6.0, self.color);
        }
    }

    fn errors(&mut self, points: &[(f64, f64, f64, f64)], marker: Marker) {
        for &(x, y, lo, hi) in points {
            if let (Some(a), Some(b)) = (self.frame.at(x, lo), self.frame.at(x, hi)) {
                whisker(self.canvas, a, b, 9.0, 2.5, self.color);
            }
            if let Some(at) = self.frame.at(x, y) {
                draw_marker(self.canvas, at, marker, 7.5, self.color);
            }
        }
    }

    fn band(&mut self, points: &[(f64, f64, f64)]) {
        let both = |&(x, lo, hi): &(f64, f64, f64)| Some((self.frame.at(x, lo)?, self.frame.at(x, hi)?));
        for run in points.iter().map(both).collect::<Vec<_>>().split(Option::is_none) {
            let sides: (Vec<Px>, Vec<Px>) = run.iter().flatten().copied().unzip();
            let polygon: Vec<Px> = sides.0.into_iter().chain(sides.1.into_iter().rev()).collect();
            self.canvas.fill(&polygon, self.color.faded(0.22));
        }
    }

    fn h_span(&mut self, lo: f64, hi: f64) {
        let frame = self.frame;
        if let (Some(a), Some(b)) = (frame.y.fraction_or_end(lo), frame.y.fraction_or_end(hi)) {
            let (a, b) = (frame.py(a), frame.py(b));
            self.canvas.fill_rect(Rect { top: a.min(b), bottom: a.max(b), ..frame.plot }, self.color.faded(0.16));
        }
    }

    fn v_span(&mut self, lo: f64, hi: f64) {
        let frame = self.frame;
        if let (Some(a), Some(b)) = (frame.x.fraction_or_end(lo), frame.x.fraction_or_end(hi)) {
            let (a, b) = (frame.px(a), frame.px(b));
            self.canvas.fill_rect(Rect { left: a.min(b), right: a.max(b), ..frame.plot }, self.color.faded(0.16));
        }
    }

    fn bars(&mut self, slots: &Slots, values: &[f64], intervals: &[(f64, f64)]) {
        let ruler = if slots.lying { &self.frame.x } else { &self.frame.y };
        let foot = if slots.log { ruler.lo } else { 0f64.clamp(ruler.lo, ruler.hi) };
        for (i, &value) in values.iter().enumerate() {
            let at = |side: f64, v: f64| slots.at(self.frame, i, side, v);
            if let (Some(a), Some(b)) = (at(-0.5, foot), at(0.5, value)) {
                self.canvas.fill_rect(between(a, b), softened(self.color));
            }
            let (lo, hi) = intervals.get(i).copied().unwrap_or((f64::NAN, f64::NAN));
            if let (Some(a), Some(b)) = (at(0.0, lo), at(0.0, hi)) {
                whisker(self.canvas, a, b, 8.0, 2.5, INK);
            }
        }
    }

    /// A box with whiskers, in slot `i`.
    fn whiskered(&mut self, slots: &Slots, i: usize, values: &[f64]) {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|&v| drawable(v)).collect();
        sorted.sort_by(f64::total_cmp);
        let (Some(q1), Some(q2), Some(q3)) = (quantile(&sorted, 0.25), quantile(&sorted, 0.5), quantile(&sorted, 0.75))
        else {
            return;
        };
        let reach = 1.5 * (q3 - q1);
        let lowest = sorted.iter().copied().find(|&v| v >= q1 - reach).unwrap_or(q1);
        let highest = sorted.iter().rev().copied().find(|&v| v <= q3 + reach).unwrap_or(q3);
        let (canvas, color) = (&mut *self.canvas, self.color);
        let ends = |from: (f64, f64), to: (f64, f64)| {
            Some((slots.at(self.frame, i, from.0, from.1)?, slots.at(self.frame, i, to.0, to.1)?))
        };
        for (from, to) in [(q1, lowest), (q3, highest)] {
            for (a, b) in [ends((0.0, from), (0.0, to)), ends((-0.25, to), (0.25, to))].into_iter().flatten() {
                canvas.stroke(&[a, b], 2.5, &[], color);
            }
        }
        if let Some((a, b)) = ends((-0.5, q1), (0.5, q3)) {
            let rect = between(a, b);
            canvas.fill_rect(rect, Color::rgb(255, 255, 255));
            canvas.fill_rect(rect, color.faded(0.3));
            canvas.stroke_rect(rect, 2.5, color);
        }
        if let Some((a, b)) = ends((-0.5, q2), (0.5, q2)) {
            canvas.stroke(&[a, b], 4.0, &[], color);
        }
        for &v in sorted.iter().filter(|&&v| v < lowest || v > highest) {
            if let Some(p) = slots.at(self.frame, i, 0.0, v) {
                canvas.disc(p, 4.0, color.faded(0.6));
            }
        }
    }

    fn hull(&mut self, pose: [f64; 3], length: f64, beam: f64) {
        let outline: Option<Vec<Px>> = hull(pose, length, beam).iter().map(|&(x, y)| self.frame.at(x, y)).collect();
        let Some(mut outline) = outline else { return };
        self.canvas.fill(&outline, self.color.faded(0.15));
        outline.extend_from_within(..1);
        self.stroke(&outline);
    }
}

/// Unbroken runs of points; those closer than a fraction of a pixel to the one before add nothing and are dropped.
fn unbroken(points: impl Iterator<Item = Option<Px>>) -> Vec<Vec<Px>> {
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

/// The place of a layer of bars or boxes among those of each category.
struct Slots {
    /// Whether bars lie, and whether the axis along them is logarithmic.
    lying: bool,
    log: bool,
    /// Offset of its middle from the category, and its breadth, in categories.
    offset: f64,
    breadth: f64,
}

impl Slots {
    fn of(panel: &Panel, group: usize) -> Self {
        let groups = panel.layers.iter().filter(|l| is_grouped(l)).count().max(1) as f64;
        let pitch = 0.78 / groups;
        let offset = (group as f64 - 0.5 * (groups - 1.0)) * pitch;
        let lying = lies(panel);
        let log = (if lying { &panel.x } else { &panel.y }).scale == Scale::Log;
        Self { lying, log, offset, breadth: if groups > 1.0 { 0.9 * pitch } else { 0.7 * pitch } }
    }

    /// The point at `value` of category `i`, `side` breadths off the middle.
    fn at(&self, frame: &Frame, i: usize, side: f64, value: f64) -> Option<Px> {
        let across = i as f64 + self.offset + side * self.breadth;
        if self.lying { frame.at(value, across) } else { frame.at(across, value) }
    }
}
