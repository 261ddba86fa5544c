//! The room that the data of a panel take: the smallest ranges that show every layer.
//! It looks at numbers only; where they fall on a sheet is in `frame`.

use super::shapes::hull;
use crate::report::plot::axis::{Extent, drawable};
use crate::report::plot::figure::Panel;
use crate::report::plot::layer::{Layer, Mark};

/// Whether bars and boxes of a panel lie: the categories are on the y axis only.
pub(in crate::report::plot) fn lies(panel: &Panel) -> bool {
    panel.y.labels().is_some() && panel.x.labels().is_none()
}

/// Whether a layer is drawn below the grid.
pub(in crate::report::plot) fn is_span(layer: &Layer) -> bool {
    matches!(layer.mark, Mark::HSpan(..) | Mark::VSpan(..))
}

/// Whether a layer has one bar or box for each category.
pub(in crate::report::plot) fn is_grouped(layer: &Layer) -> bool {
    matches!(layer.mark, Mark::Bars { .. } | Mark::Boxes(_))
}

/// Whether a layer has anything to show.
pub(in crate::report::plot) fn has_data(layer: &Layer) -> bool {
    let pair = |&(x, y): &(f64, f64)| drawable(x) && drawable(y);
    match &layer.mark {
        Mark::Line(points) | Mark::Scatter(points, _) => points.iter().any(pair),
        Mark::Errors(points, _) => points.iter().any(|&(x, y, _, _)| pair(&(x, y))),
        Mark::Band(points) => points.iter().any(|&(x, lo, hi)| drawable(x) && pair(&(lo, hi))),
        Mark::Bars { values, .. } => values.iter().any(|&v| drawable(v)),
        Mark::Boxes(rows) | Mark::Heatmap { values: rows, .. } => rows.iter().flatten().any(|&v| drawable(v)),
        Mark::Hulls { poses, .. } => poses.iter().any(|pose| pose.iter().all(|&v| drawable(v))),
        Mark::Arrows(arrows) => arrows.iter().any(|ends| ends.iter().all(pair)),
        Mark::HSpan(..) | Mark::VSpan(..) | Mark::HLine(_) | Mark::VLine(_) | Mark::Text(_) => false,
    }
}

/// The smallest ranges that show all layers of a panel.
pub(in crate::report::plot) fn extents(panel: &Panel) -> (Extent, Extent) {
    let mut room = Room { x: Extent::new(&panel.x.scale), y: Extent::new(&panel.y.scale), lying: lies(panel) };
    for layer in &panel.layers {
        room.add(&layer.mark);
    }
    (room.x, room.y)
}

/// The ranges of both axes while layers are added.
struct Room {
    x: Extent,
    y: Extent,
    /// Whether bars and boxes lie.
    lying: bool,
}

impl Room {
    /// A point counts as a whole: an x whose y is missing is not drawn.
    fn point(&mut self, x: f64, y: f64) {
        if drawable(x) && drawable(y) {
            self.x.add(x);
            self.y.add(y);
        }
    }

    fn add(&mut self, mark: &Mark) {
        match mark {
            Mark::Line(points) | Mark::Scatter(points, _) => points.iter().for_each(|&(x, y)| self.point(x, y)),
            Mark::Errors(points, _) => {
                points.iter().for_each(|&(x, y, lo, hi)| [y, lo, hi].into_iter().for_each(|v| self.point(x, v)));
            }
            Mark::Band(points) => points.iter().for_each(|&(x, lo, hi)| {
                if drawable(lo) && drawable(hi) {
                    self.point(x, lo);
                    self.point(x, hi);
                }
            }),
            Mark::Arrows(arrows) => arrows.iter().flatten().for_each(|&(x, y)| self.point(x, y)),
            Mark::Text((x, y)) => self.point(*x, *y),
            Mark::Hulls { poses, length, beam } => {
                poses.iter().flat_map(|&pose| hull(pose, *length, *beam)).for_each(|(x, y)| self.point(x, y));
            }
            Mark::HSpan(lo, hi) => [*lo, *hi].into_iter().for_each(|v| self.y.add(v)),
            Mark::VSpan(lo, hi) => [*lo, *hi].into_iter().for_each(|v| self.x.add(v)),
            Mark::HLine(v) => self.y.add(*v),
            Mark::VLine(v) => self.x.add(*v),
            Mark::Bars { values, intervals } => {
                self.along().add_foot();
                values.iter().chain(intervals.iter().flat_map(|(lo, hi)| [lo, hi])).for_each(|&v| self.along().add(v));
                self.categories(values.len());
            }
            Mark::Boxes(samples) => {
                samples.iter().flatten().for_each(|&v| self.along().add(v));
                self.categories(samples.len());
            }
            Mark::Heatmap { values, .. } => {
                let columns = values.iter().map(Vec::len).max().unwrap_or(0);
                if columns > 0 {
                    self.point(-0.5, -0.5);
                    self.point(columns as f64 - 0.5, values.len() as f64 - 0.5);
                }
            }
        }
    }

    /// The axis along which bars and boxes extend.
    fn along(&mut self) -> &mut Extent {
        if self.lying { &mut self.x } else { &mut self.y }
    }

    /// Room for `n` categories; without labels they are numbered.
    fn categories(&mut self, n: usize) {
        let across = if self.lying { &mut self.y } else { &mut self.x };
        across.add(-0.5);
        across.add(n.max(1) as f64 - 0.5);
    }
}

/// Quantile of sorted values by linear interpolation; `None` for no values.
pub(in crate::report::plot) fn quantile(sorted: &[f64], q: f64) -> Option<f64> {
    let position = q * sorted.len().checked_sub(1)? as f64;
    let i = position as usize;
    let next = sorted.get(i + 1).unwrap_or(&sorted[i]);
    Some(sorted[i] + (next - sorted[i]) * (position - i as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_interpolate_between_samples() {
        let sorted = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(quantile(&sorted, 0.5), Some(2.5));
        assert_eq!(quantile(&sorted, 0.0), Some(1.0));
        assert_eq!(quantile(&sorted, 1.0), Some(4.0));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
