//! One series of a panel as data: what it shows, in which colour, and how its lines are drawn.
//! It contains what the caller gave; where that falls on a sheet is decided elsewhere.

use super::palette::Color;

/// How a line is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stroke {
    /// Unbroken.
    #[default]
    Solid,
    /// Long dashes.
    Dashed,
    /// Dots.
    Dotted,
}

/// The shape of a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Marker {
    /// A disc.
    #[default]
    Circle,
    /// A square.
    Square,
    /// A square on its corner.
    Diamond,
    /// A triangle, point up.
    Triangle,
    /// A diagonal cross.
    Cross,
}

/// What a layer shows. Positions are (horizontal, vertical) in the units of the axes; for tracks see [`east_north`](super::east_north).
/// Values that are not finite are gaps: they break lines and are left out elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// Points joined in their order.
    Line(Vec<(f64, f64)>),
    /// Separate points.
    Scatter(Vec<(f64, f64)>, Marker),
    /// Points with an interval: (x, y, lo, hi), the ends as values of y.
    Errors(Vec<(f64, f64, f64, f64)>, Marker),
    /// The area between lo and hi: (x, lo, hi).
    Band(Vec<(f64, f64, f64)>),
    /// The region lo <= y <= hi over the whole width; an infinite end reaches the edge.
    HSpan(f64, f64),
    /// The region lo <= x <= hi over the whole height; an infinite end reaches the edge.
    VSpan(f64, f64),
    /// A line at this y.
    HLine(f64),
    /// A line at this x.
    VLine(f64),
    /// One bar for each category, with an optional interval (ends as values; empty for none). Bars lie when the
    /// categories are on the y axis, the better choice for long names. Several layers of bars or boxes in a panel stand side by side.
    Bars {
        /// Length of each bar.
        values: Vec<f64>,
        /// Interval of each bar.
        intervals: Vec<(f64, f64)>,
    },
    /// One box for each category: median, quartiles, whiskers to the last sample within 1.5 interquartile ranges, and
    /// the samples beyond. Orientation and grouping as for bars.
    Boxes(Vec<Vec<f64>>),
    /// Ship outlines at poses [x m north, y m east, psi rad clockwise from north] of the midship point, on a panel whose
    /// horizontal axis is east and whose vertical axis is north.
    Hulls {
        /// Positions and headings.
        poses: Vec<[f64; 3]>,
        /// Length over all, m.
        length: f64,
        /// Beam, m.
        beam: f64,
    },
    /// Arrows from the first to the second point.
    Arrows(Vec<[(f64, f64); 2]>),
    /// A matrix, row by row; columns along x and rows along y, which are best [`Axis::categories`](super::Axis::categories).
    Heatmap {
        /// The rows.
        values: Vec<Vec<f64>>,
        /// Values at the ends of the colour scale; `None` fits them to the data, evenly about zero if signs differ.
        range: Option<(f64, f64)>,
        /// Whether each cell shows its value.
        annotate: bool,
    },
    /// The name of the layer written at a point.
    Text((f64, f64)),
}

/// One series of a panel.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Layer {
    /// Name in the legend and in the CSV; layers without a name are not in the legend.
    pub name: String,
    /// Colour, by preference one with a fixed meaning.
    pub color: Color,
    /// How its lines are drawn.
    pub stroke: Stroke,
    /// Width of its lines, px of the PNG.
    pub width: f32,
    /// Whether the legend names it.
    pub in_legend: bool,
    /// What it shows.
    pub mark: Mark,
}

impl Layer {
    /// A layer of any kind.
    pub fn new(name: impl Into<String>, color: Color, mark: Mark) -> Self {
        let in_legend = !matches!(mark, Mark::Text(_) | Mark::Heatmap { .. });
        let width = if matches!(mark, Mark::HLine(_) | Mark::VLine(_) | Mark::Hulls { .. }) { 2.0 } else { 3.5 };
        Self { name: name.into(), color, stroke: Stroke::Solid, width, in_legend, mark }
    }

    /// A line through points.
    pub fn line(name: impl Into<String>, color: Color, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self::new(name, color, Mark::Line(points.into_iter().collect()))
    }

    /// Separate points.
    pub fn scatter(name: impl Into<String>, color: Color, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self::new(name, color, Mark::Scatter(points.into_iter().collect(), Marker::Circle))
    }

    /// Points with intervals: (x, y, lo, hi).
    pub fn errors(
        name: impl Into<String>,
        color: Color,
        points: impl IntoIterator<Item = (f64, f64, f64, f64)>,
    ) -> Self {
        Self::new(name, color, Mark::Errors(points.into_iter().collect(), Marker::Circle))
    }

    /// A line through points with intervals, (x, y, lo, hi), and the intervals, under one name.
    pub fn line_with_intervals(name: &str, color: Color, points: Vec<(f64, f64, f64, f64)>) -> [Self; 2] {
        let line = Self::line(name, color, points.iter().map(|p| (p.0, p.1)));
        [line, Self::errors(name, color, points).unlisted()]
    }

    /// An area between two curves: (x, lo, hi).
    pub fn band(name: impl Into<String>, color: Color, points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        Self::new(name, color, Mark::Band(points.into_iter().collect()))
    }

    /// The region between two values of y.
    pub fn h_span(name: impl Into<String>, color: Color, lo: f64, hi: f64) -> Self {
        Self::new(name, color, Mark::HSpan(lo, hi))
    }

    /// The region between two values of x.
    pub fn v_span(name: impl Into<String>, color: Color, lo: f64, hi: f64) -> Self {
        Self::new(name, color, Mark::VSpan(lo, hi))
    }

    /// A horizontal line.
    pub fn h_line(name: impl Into<String>, color: Color, y: f64) -> Self {
        Self::new(name, color, Mark::HLine(y))
    }

    /// A vertical line.
    pub fn v_line(name: impl Into<String>, color: Color, x: f64) -> Self {
        Self::new(name, color, Mark::VLine(x))
    }

    /// Bars, one for each category.
    pub fn bars(name: impl Into<String>, color: Color, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, color, Mark::Bars { values: values.into_iter().collect(), intervals: vec![] })
    }

    /// Bars with intervals: (value, lo, hi), the ends as values.
    pub fn bars_with_intervals(
        name: impl Into<String>,
        color: Color,
        bars: impl IntoIterator<Item = (f64, f64, f64)>,
    ) -> Self {
        let (values, intervals) = bars.into_iter().map(|(value, lo, hi)| (value, (lo, hi))).unzip();
        Self::new(name, color, Mark::Bars { values, intervals })
    }

    /// Boxes and whiskers, one for each category.
    pub fn boxes(name: impl Into<String>, color: Color, samples: impl IntoIterator<Item = Vec<f64>>) -> Self {
        Self::new(name, color, Mark::Boxes(samples.into_iter().collect()))
    }

    /// Ship outlines on a track, at poses [x m north, y m east, psi rad].
    pub fn hulls(
        name: impl Into<String>,
        color: Color,
        poses: impl IntoIterator<Item = [f64; 3]>,
        length: f64,
        beam: f64,
    ) -> Self {
        Self::new(name, color, Mark::Hulls { poses: poses.into_iter().collect(), length, beam })
    }

    /// Arrows, each from its first to its second point.
    pub fn arrows(name: impl Into<String>, color: Color, arrows: impl IntoIterator<Item = [(f64, f64); 2]>) -> Self {
        Self::new(name, color, Mark::Arrows(arrows.into_iter().collect()))
    }

    /// A matrix as coloured cells with their values. `name` is what the colour means, with unit.
    pub fn heatmap(name: impl Into<String>, values: Vec<Vec<f64>>) -> Self {
        Self::new(name, Color::rgb(0, 0, 0), Mark::Heatmap { values, range: None, annotate: true })
    }

    /// A remark at a point.
    pub fn text(text: impl Into<String>, color: Color, at: (f64, f64)) -> Self {
        Self::new(text, color, Mark::Text(at))
    }

    /// The same layer with dashed lines.
    pub fn dashed(self) -> Self {
        Self { stroke: Stroke::Dashed, ..self }
    }

    /// The same layer with dotted lines.
    pub fn dotted(self) -> Self {
        Self { stroke: Stroke::Dotted, ..self }
    }

    /// The same layer with lines this wide, px of the PNG.
    pub fn width(self, width: f32) -> Self {
        Self { width, ..self }
    }

    /// The same layer, left out of the legend but kept by name in the CSV.
    pub fn unlisted(self) -> Self {
        Self { in_legend: false, ..self }
    }

    /// The same points with another marker.
    pub fn marker(mut self, with: Marker) -> Self {
        if let Mark::Scatter(_, marker) | Mark::Errors(_, marker) = &mut self.mark {
            *marker = with;
        }
        self
    }
}
