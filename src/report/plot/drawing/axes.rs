//! The axes of a panel as drawn: grid, ticks, labels, and the margins they need around the plot.
//! Ranges and ticks are decided before; the layers between the axes are drawn in `marks`.

use super::frame::Frame;
use super::heatmap::heatmap;
use super::style::{FRAME, HEADING, LABEL, LEADING, TICK, fit_lines, ink};
use super::ticks::Ruler;
use crate::report::plot::axis::Axis;
use crate::report::plot::figure::Panel;
use crate::report::plot::palette::Color;
use crate::report::plot::sheet::canvas::{Anchor, Canvas, Run};
use crate::report::plot::sheet::font::text_width;
use crate::report::plot::sheet::geometry::Rect;

/// Grid lines at the ticks, and between them on logarithmic axes.
const GRID: Color = Color::rgb(226, 226, 226);
const MINOR: Color = Color::rgb(241, 241, 241);
/// Between the axis and its tick labels, px.
const TICK_GAP: f32 = 14.0;

/// Space around a plot for titles and labels, px.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::report::plot) struct Margins {
    pub left: f32,
    pub right: f32,
    pub top: f32,
    pub bottom: f32,
}

impl Margins {
    /// The larger of each.
    pub fn max(self, other: Self) -> Self {
        Self {
            left: self.left.max(other.left),
            right: self.right.max(other.right),
            top: self.top.max(other.top),
            bottom: self.bottom.max(other.bottom),
        }
    }
}

/// The title of a panel in lines that fit.
pub(in crate::report::plot) fn title_lines(panel: &Panel, width: f32) -> Vec<String> {
    fit_lines(&panel.title, HEADING, true, width, 3).0
}

/// The labels of categories along x: across where they fit, else turned, and then only every `stride`-th.
enum Columns {
    Flat(Vec<Vec<String>>),
    Upright { labels: Vec<Vec<String>>, stride: usize },
}

fn columns(plot: Rect, labels: &[String]) -> Columns {
    let slot = plot.width() / labels.len().max(1) as f32;
    let flat: Vec<_> = labels.iter().map(|l| fit_lines(l, TICK, false, slot - 12.0, 3)).collect();
    if flat.iter().all(|(_, whole)| *whole) {
        return Columns::Flat(flat.into_iter().map(|(lines, _)| lines).collect());
    }
    let pitch = TICK * LEADING;
    let lines = (slot / pitch).floor().clamp(1.0, 2.0) as usize;
    // One line may be long; of two, each is at most half of that.
    let longest = 0.95 * plot.height().max(220.0) / lines as f32;
    let labels = labels.iter().map(|l| fit_lines(l, TICK, false, longest, lines).0).collect();
    Columns::Upright { labels, stride: (pitch / slot).ceil().max(1.0) as usize }
}

/// Category labels along y: their lines, and every how many are shown.
fn row_labels(plot: Rect, labels: &[String], cell_w: f32) -> (Vec<Vec<String>>, usize) {
    let slot = plot.height() / labels.len().max(1) as f32;
    let lines = (slot / (TICK * LEADING)).floor().clamp(1.0, NAME_LINES as f32) as usize;
    let stride = (TICK * 1.15 / slot).ceil().max(1.0) as usize;
    (labels.iter().map(|l| fit_lines(l, TICK, false, NAMES * cell_w, lines).0).collect(), stride)
}

/// Share of a cell that names along y may take, and the lines of each at most.
const NAMES: f32 = 0.36;
const NAME_LINES: usize = 6;

/// The height that a plot needs so that every name along its y axis is whole, px.
pub(in crate::report::plot) fn least_height(panel: &Panel, cell_w: f32) -> f32 {
    let lines = |label: &String| fit_lines(label, TICK, false, NAMES * cell_w, NAME_LINES).0.len();
    let most = |labels: &[String]| labels.iter().map(lines).max().unwrap_or(1);
    panel.y.labels().map_or(0.0, |labels| labels.len() as f32 * (most(labels) as f32 * TICK * LEADING + 1.0))
}

fn widest<'a>(texts: impl Iterator<Item = &'a String>) -> f32 {
    texts.map(|t| text_width(t, TICK, false)).fold(0.0, f32::max)
}

/// The margins a panel needs in a cell this wide, with a legend strip this high above its plot.
pub(in crate::report::plot) fn margins(frame: &Frame, panel: &Panel, cell_w: f32, strip: f32) -> Margins {
    let plot = frame.plot;
    let y_ticks = match panel.y.labels() {
        Some(labels) => widest(row_labels(plot, labels, cell_w).0.iter().flatten()),
        None => widest(frame.y.ticks.iter().map(|(_, l)| l)),
    };
    let y_label = fit_lines(&panel.y.label, LABEL, false, plot.height(), 2).0;
    let mut left = y_ticks + TICK_GAP + y_label.len() as f32 * LABEL * LEADING + 14.0;
    if let Some(factor) = &frame.y.factor {
        left = left.max(text_width(factor, TICK, false) + 12.0);
    }
    let mut bottom = TICK_GAP + TICK * 0.5;
    let mut right: f32 = 30.0;
    match panel.x.labels().map(|labels| columns(plot, labels)) {
        None => {
            bottom += TICK * 0.7;
            if let Some((v, label)) = frame.x.ticks.last() {
                let beyond = frame.px(frame.x.fraction(*v).unwrap_or(1.0)) - plot.right;
                right = right.max(0.5 * text_width(label, TICK, false) + beyond + 8.0);
            }
        }
        Some(Columns::Flat(lines)) => {
            let lines = lines.iter().map(Vec::len).max().unwrap_or(1);
            bottom += (lines as f32 - 1.0) * TICK * LEADING + TICK * 0.7;
        }
        Some(Columns::Upright { labels, .. }) => bottom += widest(labels.iter().flatten()) - TICK * 0.5,
    }
    let x_label = fit_lines(&panel.x.label, LABEL, false, plot.width(), 2).0;
    bottom += x_label.len() as f32 * LABEL * LEADING + 16.0;
    if heatmap(panel).is_some() {
        right = right.max(190.0);
    }
    let title = title_lines(panel, plot.width()).len() as f32 * HEADING * LEADING;
    let top = (title + strip + 12.0).max(if frame.y.factor.is_some() { 38.0 } else { 16.0 }) + 8.0;
    Margins { left, right, top, bottom }
}

/// The grid of a panel; axes of categories have none.
pub(in crate::report::plot) fn grid(frame: &Frame, canvas: &mut Canvas, panel: &Panel) {
    let Rect { left, top, right, bottom } = frame.plot;
    let lines = |ruler: &Ruler, axis: &Axis| -> Vec<(f64, Color)> {
        let minor = ruler.minor.iter().map(|&v| (v, MINOR));
        let major = ruler.ticks.iter().map(|&(v, _)| (v, GRID)).filter(|_| axis.labels().is_none());
        minor.chain(major).collect()
    };
    for (v, color) in lines(&frame.x, &panel.x) {
        frame.x_at(v).iter().for_each(|&x| canvas.stroke(&[(x, top), (x, bottom)], 1.5, &[], color));
    }
    for (v, color) in lines(&frame.y, &panel.y) {
        frame.y_at(v).iter().for_each(|&y| canvas.stroke(&[(left, y), (right, y)], 1.5, &[], color));
    }
}

/// Ticks and labels below the plot.
pub(in crate::report::plot) fn x_axis(frame: &Frame, canvas: &mut Canvas, axis: &Axis) {
    let Rect { left, right, .. } = frame.plot;
    let below = x_ticks(frame, canvas, axis);
    let lines = fit_lines(&axis.label, LABEL, false, frame.plot.width(), 2).0;
    canvas.lines(&lines, Anchor::Middle, Run::Across, ink(LABEL), |k| {
        (0.5 * (left + right), below + 10.0 + (k + 0.5) * LABEL * LEADING)
    });
    if let Some(factor) = &frame.x.factor {
        canvas.text(factor, (right, below + 10.0 + 0.5 * LABEL * LEADING), Anchor::End, Run::Across, ink(TICK));
    }
}

/// The ticks of the x axis with their labels; returns where they end, px from the top.
fn x_ticks(frame: &Frame, canvas: &mut Canvas, axis: &Axis) -> f32 {
    let bottom = frame.plot.bottom;
    let middle = bottom + TICK_GAP + 0.5 * TICK;
    let below = middle + 0.7 * TICK;
    match axis.labels().map(|labels| columns(frame.plot, labels)) {
        None => {
            for (v, label) in &frame.x.ticks {
                let Some(x) = frame.x_at(*v) else { continue };
                canvas.stroke(&[(x, bottom), (x, bottom + 7.0)], 1.5, &[], FRAME);
                canvas.text(label, (x, middle), Anchor::Middle, Run::Across, ink(TICK));
            }
            below
        }
        Some(Columns::Flat(labels)) => {
            for (i, lines) in labels.iter().enumerate() {
                let Some(x) = frame.x_at(i as f64) else { continue };
                let at = |k: f32| (x, middle + k * TICK * LEADING);
                canvas.lines(lines, Anchor::Middle, Run::Across, ink(TICK), at);
            }
            below + (labels.iter().map(Vec::len).max().unwrap_or(1) as f32 - 1.0) * TICK * LEADING
        }
        Some(Columns::Upright { labels, stride }) => {
            for (i, lines) in labels.iter().enumerate().step_by(stride) {
                let Some(x) = frame.x_at(i as f64) else { continue };
                let first = 0.5 * (lines.len() as f32 - 1.0);
                let at = |k: f32| (x + (k - first) * TICK * LEADING, bottom + TICK_GAP);
                canvas.lines(lines, Anchor::End, Run::Up, ink(TICK), at);
            }
            bottom + TICK_GAP + widest(labels.iter().step_by(stride).flatten())
        }
    }
}

/// Ticks and labels to the left of the plot, in a cell this wide.
pub(in crate::report::plot) fn y_axis(frame: &Frame, canvas: &mut Canvas, axis: &Axis, cell_w: f32) {
    let Rect { left, top, bottom, .. } = frame.plot;
    let ticks = if let Some(labels) = axis.labels() {
        let (labels, stride) = row_labels(frame.plot, labels, cell_w);
        for (i, lines) in labels.iter().enumerate().step_by(stride) {
            let Some(y) = frame.y_at(i as f64) else { continue };
            let first = 0.5 * (lines.len() as f32 - 1.0);
            let at = |k: f32| (left - TICK_GAP, y + (k - first) * TICK * LEADING);
            canvas.lines(lines, Anchor::End, Run::Across, ink(TICK), at);
        }
        widest(labels.iter().step_by(stride).flatten())
    } else {
        for (v, label) in &frame.y.ticks {
            let Some(y) = frame.y_at(*v) else { continue };
            canvas.stroke(&[(left - 7.0, y), (left, y)], 1.5, &[], FRAME);
            canvas.text(label, (left - TICK_GAP, y), Anchor::End, Run::Across, ink(TICK));
        }
        widest(frame.y.ticks.iter().filter(|(v, _)| frame.y_at(*v).is_some()).map(|(_, l)| l))
    };
    let mut lines = fit_lines(&axis.label, LABEL, false, frame.plot.height(), 2).0;
    lines.reverse();
    canvas.lines(&lines, Anchor::Middle, Run::Up, ink(LABEL), |k| {
        (left - TICK_GAP - ticks - 8.0 - (k + 0.5) * LABEL * LEADING, 0.5 * (top + bottom))
    });
    if let Some(factor) = &frame.y.factor {
        canvas.text(factor, (left - 8.0, top - 24.0), Anchor::End, Run::Across, ink(TICK));
    }
}
