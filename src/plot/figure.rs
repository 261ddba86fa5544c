//! Figures as data: panels, axes and layers, and their three outputs PNG, SVG and CSV.
//! How they are laid out and drawn is in `draw`; what they show is the caller's.

use super::axis::Axis;
use super::draw;
use super::marks::lies;
use super::palette::Color;
use std::path::{Path, PathBuf};

/// Why a figure could not be made.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The embedded font could not be read.
    #[error("the embedded DejaVu Sans font cannot be read; rebuild from a clean checkout")]
    Font,
    /// The figure has more pixels than can be held.
    #[error("a figure of {width} x {height} px is too large; use fewer panels or smaller ones")]
    TooLarge {
        /// Width, px.
        width: u32,
        /// Height, px.
        height: u32,
    },
    /// plotters could not draw a part of it.
    #[error("the figure could not be drawn: {0}; rebuild from a clean checkout")]
    Drawing(String),
    /// The PNG encoder failed.
    #[error("the figure could not be encoded as PNG: {0}")]
    Png(#[from] png::EncodingError),
    /// The CSV writer failed.
    #[error("the data of the figure could not be written as CSV: {0}")]
    Csv(#[from] csv::Error),
    /// A file could not be written.
    #[error("{path}: cannot write the figure: {source}; check that the folder exists and is writable")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

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

/// What a layer shows. Positions are (horizontal, vertical) in the units of the axes; for tracks see [`east_north`].
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
    /// Counts of values in equal bins, the same bins for all histograms of a panel. Zero bins: as many as the data bear
    /// (Freedman and Diaconis 1981).
    Histogram {
        /// The values counted.
        values: Vec<f64>,
        /// How many bins.
        bins: usize,
    },
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
    /// A matrix, row by row; columns along x and rows along y, which are best [`Axis::categories`].
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
    #[must_use]
    pub fn new(name: impl Into<String>, color: Color, mark: Mark) -> Self {
        let in_legend = !matches!(mark, Mark::Text(_) | Mark::Heatmap { .. });
        let width = if matches!(mark, Mark::HLine(_) | Mark::VLine(_) | Mark::Hulls { .. }) { 2.0 } else { 3.5 };
        Self { name: name.into(), color, stroke: Stroke::Solid, width, in_legend, mark }
    }

    /// A line through points.
    #[must_use]
    pub fn line(name: impl Into<String>, color: Color, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self::new(name, color, Mark::Line(points.into_iter().collect()))
    }

    /// Separate points.
    #[must_use]
    pub fn scatter(name: impl Into<String>, color: Color, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self::new(name, color, Mark::Scatter(points.into_iter().collect(), Marker::Circle))
    }

    /// Points with intervals: (x, y, lo, hi).
    #[must_use]
    pub fn errors(
        name: impl Into<String>,
        color: Color,
        points: impl IntoIterator<Item = (f64, f64, f64, f64)>,
    ) -> Self {
        Self::new(name, color, Mark::Errors(points.into_iter().collect(), Marker::Circle))
    }

    /// An area between two curves: (x, lo, hi).
    #[must_use]
    pub fn band(name: impl Into<String>, color: Color, points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        Self::new(name, color, Mark::Band(points.into_iter().collect()))
    }

    /// The region between two values of y.
    #[must_use]
    pub fn h_span(name: impl Into<String>, color: Color, lo: f64, hi: f64) -> Self {
        Self::new(name, color, Mark::HSpan(lo, hi))
    }

    /// The region between two values of x.
    #[must_use]
    pub fn v_span(name: impl Into<String>, color: Color, lo: f64, hi: f64) -> Self {
        Self::new(name, color, Mark::VSpan(lo, hi))
    }

    /// A horizontal line.
    #[must_use]
    pub fn h_line(name: impl Into<String>, color: Color, y: f64) -> Self {
        Self::new(name, color, Mark::HLine(y))
    }

    /// A vertical line.
    #[must_use]
    pub fn v_line(name: impl Into<String>, color: Color, x: f64) -> Self {
        Self::new(name, color, Mark::VLine(x))
    }

    /// Bars, one for each category.
    #[must_use]
    pub fn bars(name: impl Into<String>, color: Color, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, color, Mark::Bars { values: values.into_iter().collect(), intervals: vec![] })
    }

    /// Bars with intervals: (value, lo, hi), the ends as values.
    #[must_use]
    pub fn bars_with_intervals(
        name: impl Into<String>,
        color: Color,
        bars: impl IntoIterator<Item = (f64, f64, f64)>,
    ) -> Self {
        let (values, intervals) = bars.into_iter().map(|(value, lo, hi)| (value, (lo, hi))).unzip();
        Self::new(name, color, Mark::Bars { values, intervals })
    }

    /// Boxes and whiskers, one for each category.
    #[must_use]
    pub fn boxes(name: impl Into<String>, color: Color, samples: impl IntoIterator<Item = Vec<f64>>) -> Self {
        Self::new(name, color, Mark::Boxes(samples.into_iter().collect()))
    }

    /// A histogram with as many bins as the data bear.
    #[must_use]
    pub fn histogram(name: impl Into<String>, color: Color, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, color, Mark::Histogram { values: values.into_iter().collect(), bins: 0 })
    }

    /// Ship outlines on a track, at poses [x m north, y m east, psi rad].
    #[must_use]
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
    #[must_use]
    pub fn arrows(name: impl Into<String>, color: Color, arrows: impl IntoIterator<Item = [(f64, f64); 2]>) -> Self {
        Self::new(name, color, Mark::Arrows(arrows.into_iter().collect()))
    }

    /// A matrix as coloured cells with their values. `name` is what the colour means, with unit.
    #[must_use]
    pub fn heatmap(name: impl Into<String>, values: Vec<Vec<f64>>) -> Self {
        Self::new(name, Color::rgb(0, 0, 0), Mark::Heatmap { values, range: None, annotate: true })
    }

    /// A remark at a point.
    #[must_use]
    pub fn text(text: impl Into<String>, color: Color, at: (f64, f64)) -> Self {
        Self::new(text, color, Mark::Text(at))
    }

    /// The same layer with dashed lines.
    #[must_use]
    pub fn dashed(self) -> Self {
        Self { stroke: Stroke::Dashed, ..self }
    }

    /// The same layer with dotted lines.
    #[must_use]
    pub fn dotted(self) -> Self {
        Self { stroke: Stroke::Dotted, ..self }
    }

    /// The same layer with lines this wide, px of the PNG.
    #[must_use]
    pub fn width(self, width: f32) -> Self {
        Self { width, ..self }
    }

    /// The same layer, left out of the legend but kept by name in the CSV.
    #[must_use]
    pub fn unlisted(self) -> Self {
        Self { in_legend: false, ..self }
    }

    /// The same points with another marker.
    #[must_use]
    pub fn marker(mut self, with: Marker) -> Self {
        if let Mark::Scatter(_, marker) | Mark::Errors(_, marker) = &mut self.mark {
            *marker = with;
        }
        self
    }
}

/// A position in the earth frame (x m north, y m east) as a point of a track panel: (east, north).
#[must_use]
pub fn east_north(x: f64, y: f64) -> (f64, f64) {
    (y, x)
}

/// One set of axes with its layers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// Heading; empty for none.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Whether one unit is as long on both axes (tracks). Only for two linear axes.
    pub equal_aspect: bool,
    /// Drawn in this order, spans below the grid and everything else above.
    pub layers: Vec<Layer>,
}

impl Panel {
    /// An empty panel.
    #[must_use]
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, y, equal_aspect: false, layers: vec![] }
    }

    /// An empty panel for tracks: east to the right, north up, metres of equal length.
    #[must_use]
    pub fn track(title: impl Into<String>) -> Self {
        Self { equal_aspect: true, ..Self::new(title, Axis::new("east y [m]"), Axis::new("north x [m]")) }
    }

    /// The same panel with one more layer on top.
    #[must_use]
    pub fn with(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// The same panel with more layers on top.
    #[must_use]
    pub fn with_all(mut self, layers: impl IntoIterator<Item = Layer>) -> Self {
        self.layers.extend(layers);
        self
    }
}

/// Where the names of the series stand. A legend never covers data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Legend {
    /// One strip under the title of the figure; a series that is in several panels is named once.
    #[default]
    Shared,
    /// A strip above each panel.
    EachPanel,
    /// None.
    Off,
}

/// A figure: panels in rows, a title and a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Title; empty for none.
    pub title: String,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels in a row.
    pub columns: usize,
    /// Width of a panel with its axis labels, px of the PNG.
    pub panel_width: u32,
    /// Height of a panel with its axis labels, px of the PNG.
    pub panel_height: u32,
    /// Where the names of the series stand.
    pub legend: Legend,
}

impl Figure {
    /// An empty figure with one column of panels of 900 x 600 px.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            panels: vec![],
            columns: 1,
            panel_width: 900,
            panel_height: 600,
            legend: Legend::Shared,
        }
    }

    /// The same figure with this many panels in a row.
    #[must_use]
    pub fn columns(self, columns: usize) -> Self {
        Self { columns, ..self }
    }

    /// The same figure with panels of this size, px of the PNG.
    #[must_use]
    pub fn panel_size(self, width: u32, height: u32) -> Self {
        Self { panel_width: width, panel_height: height, ..self }
    }

    /// The same figure with its legend elsewhere.
    #[must_use]
    pub fn legend(self, legend: Legend) -> Self {
        Self { legend, ..self }
    }

    /// The same figure with one more panel.
    #[must_use]
    pub fn with(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// The same figure with more panels.
    #[must_use]
    pub fn with_all(mut self, panels: impl IntoIterator<Item = Panel>) -> Self {
        self.panels.extend(panels);
        self
    }

    /// The figure as PNG, meant to be shown at half its size in px.
    ///
    /// # Errors
    /// [`FigureError::TooLarge`] above 40 million pixels; [`FigureError::Font`], [`FigureError::Drawing`] and
    /// [`FigureError::Png`] if the program is damaged.
    pub fn png(&self) -> Result<Vec<u8>, FigureError> {
        draw::draw(self).into_png()
    }

    /// The figure as an SVG document without external references.
    ///
    /// # Errors
    /// [`FigureError::Font`] and [`FigureError::Drawing`] if the program is damaged.
    pub fn svg(&self) -> Result<String, FigureError> {
        draw::draw(self).into_svg()
    }

    /// The data behind the figure, one row for each point: `panel,series,kind,x,y,z,lo,hi`.
    ///
    /// `x` and `y` are as on the axes, categories by their label; `z` is the value of a heat map cell and the heading
    /// (rad) of a hull; `lo` and `hi` are the ends of an interval, band or span. What is missing is an empty field.
    /// An arrow is two rows, `arrow-from` and `arrow-to`; histograms and boxes are given by their samples.
    ///
    /// # Errors
    /// [`FigureError::Csv`] if the writer fails.
    pub fn csv(&self) -> Result<String, FigureError> {
        let mut writer = csv::Writer::from_writer(vec![]);
        writer.write_record(["panel", "series", "kind", "x", "y", "z", "lo", "hi"])?;
        for (i, panel) in self.panels.iter().enumerate() {
            let name = if panel.title.is_empty() { format!("{}", i + 1) } else { panel.title.clone() };
            for layer in &panel.layers {
                for row in rows(panel, layer) {
                    let values = row.values.map(|v| v.unwrap_or_default());
                    writer.write_record(
                        [&name, &layer.name, row.kind].into_iter().chain(values.iter().map(String::as_str)),
                    )?;
                }
            }
        }
        let bytes = writer.into_inner().map_err(|e| csv::Error::from(e.into_error()))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Writes `stem.png` and `stem.csv`, making the folder if need be, and returns their paths.
    ///
    /// # Errors
    /// [`FigureError::Io`] if a file cannot be written, and as [`Self::png`] and [`Self::csv`].
    pub fn save(&self, stem: &Path) -> Result<Vec<PathBuf>, FigureError> {
        Ok(vec![write(stem, "png", &self.png()?)?, write(stem, "csv", self.csv()?.as_bytes())?])
    }

    /// Writes `stem.svg`, making the folder if need be, and returns its path.
    ///
    /// # Errors
    /// [`FigureError::Io`] if the file cannot be written, and as [`Self::svg`].
    pub fn save_svg(&self, stem: &Path) -> Result<PathBuf, FigureError> {
        write(stem, "svg", self.svg()?.as_bytes())
    }
}

fn write(stem: &Path, extension: &str, bytes: &[u8]) -> Result<PathBuf, FigureError> {
    // Appended, not replaced: a stem may have dots of its own.
    let mut name = stem.as_os_str().to_owned();
    name.push(".");
    name.push(extension);
    let path = PathBuf::from(name);
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| FigureError::Io { path, source }
    };
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(failed(folder))?;
    }
    std::fs::write(&path, bytes).map_err(failed(&path))?;
    Ok(path)
}

/// One line of the CSV: x, y, z, lo, hi.
struct Row {
    kind: &'static str,
    values: [Option<String>; 5],
}

fn rows(panel: &Panel, layer: &Layer) -> Vec<Row> {
    let number = |v: f64| v.is_finite().then(|| v.to_string());
    let row = |kind, x, y, z: f64, lo: f64, hi: f64| Row { kind, values: [x, y, number(z), number(lo), number(hi)] };
    let point = |kind, x: f64, y: f64, z: f64, lo: f64, hi: f64| row(kind, number(x), number(y), z, lo, hi);
    let category = |axis: &Axis, i: usize| {
        Some(axis.labels().and_then(|labels| labels.get(i).cloned()).unwrap_or_else(|| i.to_string()))
    };
    let lying = lies(panel);
    let slot = |kind, i: usize, v: f64, lo, hi| {
        if lying {
            row(kind, number(v), category(&panel.y, i), f64::NAN, lo, hi)
        } else {
            row(kind, category(&panel.x, i), number(v), f64::NAN, lo, hi)
        }
    };
    const NO: f64 = f64::NAN;
    match &layer.mark {
        Mark::Line(points) => points.iter().map(|&(x, y)| point("line", x, y, NO, NO, NO)).collect(),
        Mark::Scatter(points, _) => points.iter().map(|&(x, y)| point("scatter", x, y, NO, NO, NO)).collect(),
        Mark::Errors(points, _) => points.iter().map(|&(x, y, lo, hi)| point("errors", x, y, NO, lo, hi)).collect(),
        Mark::Band(points) => points.iter().map(|&(x, lo, hi)| point("band", x, NO, NO, lo, hi)).collect(),
        Mark::HSpan(lo, hi) => vec![point("h-span", NO, NO, NO, *lo, *hi)],
        Mark::VSpan(lo, hi) => vec![point("v-span", NO, NO, NO, *lo, *hi)],
        Mark::HLine(y) => vec![point("h-line", NO, *y, NO, NO, NO)],
        Mark::VLine(x) => vec![point("v-line", *x, NO, NO, NO, NO)],
        Mark::Bars { values, intervals } => values
            .iter()
            .enumerate()
            .map(|(i, &v)| {
                let (lo, hi) = intervals.get(i).copied().unwrap_or((NO, NO));
                slot("bar", i, v, lo, hi)
            })
            .collect(),
        Mark::Boxes(samples) => samples
            .iter()
            .enumerate()
            .flat_map(|(i, values)| values.iter().map(move |&v| (i, v)))
            .map(|(i, v)| slot("sample", i, v, NO, NO))
            .collect(),
        Mark::Histogram { values, .. } => values.iter().map(|&v| point("count", v, NO, NO, NO, NO)).collect(),
        Mark::Hulls { poses, .. } => poses.iter().map(|&[x, y, psi]| point("hull", y, x, psi, NO, NO)).collect(),
        Mark::Arrows(arrows) => arrows
            .iter()
            .flat_map(|&[a, b]| [point("arrow-from", a.0, a.1, NO, NO, NO), point("arrow-to", b.0, b.1, NO, NO, NO)])
            .collect(),
        Mark::Heatmap { values, .. } => values
            .iter()
            .enumerate()
            .flat_map(|(i, cells)| cells.iter().enumerate().map(move |(j, &v)| (i, j, v)))
            .map(|(i, j, v)| row("cell", category(&panel.x, j), category(&panel.y, i), v, NO, NO))
            .collect(),
        Mark::Text((x, y)) => vec![point("text", *x, *y, NO, NO, NO)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{BLUE, GREEN, TRUTH};

    const NAN: f64 = f64::NAN;

    /// Every kind of layer over the same numbers.
    fn every_layer(v: &[f64]) -> Vec<Layer> {
        let pairs = || v.iter().enumerate().map(|(i, &y)| (i as f64, y));
        let mut layers = vec![
            Layer::line("line", TRUTH, pairs()),
            Layer::line("dashed", BLUE, pairs()).dashed(),
            Layer::line("dotted", BLUE, pairs()).dotted().width(6.0),
            Layer::errors("errors", GREEN, pairs().map(|(x, y)| (x, y, y - 1.0, y + 1.0))),
            Layer::band("band", BLUE, pairs().map(|(x, y)| (x, y - 1.0, y + 1.0))),
            Layer::h_span("h-span", GREEN, f64::NEG_INFINITY, v.first().copied().unwrap_or(NAN)),
            Layer::v_span("v-span", GREEN, 0.0, f64::INFINITY),
            Layer::h_line("h-line", TRUTH, v.first().copied().unwrap_or(NAN)),
            Layer::v_line("v-line", TRUTH, v.last().copied().unwrap_or(NAN)),
            Layer::bars("bars", BLUE, v.iter().copied()),
            Layer::bars_with_intervals("intervals", BLUE, v.iter().map(|&y| (y, y - 1.0, y + 1.0))),
            Layer::boxes("boxes", BLUE, [v.to_vec(), vec![], vec![NAN], vec![1.0]]),
            Layer::histogram("histogram", BLUE, v.iter().copied()),
            Layer::hulls("hulls", TRUTH, v.iter().map(|&y| [y, 2.0 * y, 0.1 * y]), 80.0, 12.0),
            Layer::arrows("arrows", TRUTH, pairs().map(|p| [p, (p.0 + 1.0, p.1 + 1.0)])),
            Layer::heatmap("heatmap", vec![v.to_vec(), vec![], vec![NAN, 1.0]]),
            Layer::text("a remark", TRUTH, (0.0, v.first().copied().unwrap_or(NAN))),
        ];
        for marker in [Marker::Circle, Marker::Square, Marker::Diamond, Marker::Triangle, Marker::Cross] {
            layers.push(Layer::scatter("scatter", GREEN, pairs()).marker(marker));
        }
        layers
    }

    fn samples() -> Vec<Vec<f64>> {
        vec![
            (0..40).map(|i| f64::from(i).sin() * 3.0).collect(),
            vec![],
            vec![2.5],
            vec![4.0; 12],
            vec![0.0; 3],
            vec![1.0, NAN, 3.0, f64::INFINITY, f64::NEG_INFINITY, 2.0, -1.0],
            vec![NAN; 4],
            vec![1e-300, 1e300, -1e299, 5e299, f64::MAX, f64::MIN_POSITIVE],
        ]
    }

    #[test]
    fn every_layer_draws_on_normal_empty_single_constant_missing_and_extreme_data() {
        let axes = |label: &str| {
            [
                Axis::new(label),
                Axis::new(label).log(),
                Axis::categories(label, ["first", "a second one of some length", "third"]),
                Axis::categories(label, Vec::<String>::new()),
                Axis::new(label).range(2.0, -1.0).every(0.5),
            ]
        };
        for values in samples() {
            for layer in every_layer(&values) {
                let panels = axes("x [m]").into_iter().zip(axes("y [m]").into_iter().rev()).map(|(x, y)| {
                    let mut panel = Panel::new(layer.name.clone(), x, y).with(layer.clone());
                    panel.equal_aspect = true;
                    panel
                });
                let figure = Figure::new("every layer").with_all(panels).columns(5).panel_size(300, 200);
                let svg = figure.svg().unwrap();
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{} {values:?}", layer.name);
                assert!(!figure.csv().unwrap().contains("NaN"));
            }
            let figure = Figure::new("all").with(Panel::default().with_all(every_layer(&values)));
            assert!(figure.png().unwrap().starts_with(b"\x89PNG"));
        }
    }

    #[test]
    fn a_panel_without_data_says_so() {
        let says = |layers: Vec<Layer>| {
            let svg = Figure::new("").with(Panel::default().with_all(layers)).svg().unwrap();
            svg.contains("\nno data\n")
        };
        assert!(says(vec![]));
        assert!(says(vec![Layer::line("a", TRUTH, [(1.0, NAN), (NAN, 2.0)]), Layer::h_line("limit", TRUTH, 3.0)]));
        assert!(!says(vec![Layer::line("a", TRUTH, [(1.0, 2.0)])]));
        assert!(Figure::new("").png().unwrap().starts_with(b"\x89PNG"));
    }

    #[test]
    fn a_missing_value_breaks_the_line() {
        let lines = |points: Vec<(f64, f64)>| {
            let svg = Figure::new("")
                .legend(Legend::Off)
                .with(Panel::default().with(Layer::line("", BLUE, points)))
                .svg()
                .unwrap();
            svg.lines().filter(|l| l.starts_with("<polyline") && l.contains("#0072B2")).count()
        };
        assert_eq!(lines(vec![(0.0, 1.0), (1.0, 2.0), (2.0, 3.0), (3.0, 1.0)]), 1);
        assert_eq!(lines(vec![(0.0, 1.0), (1.0, 2.0), (1.5, NAN), (2.0, 3.0), (3.0, 1.0)]), 2);
    }

    #[test]
    fn the_csv_reads_back_to_the_same_numbers() {
        let points = [(0.1 + 0.2, -1.0 / 3.0), (1e-17, 6.02e23), (f64::MIN_POSITIVE, NAN)];
        let figure = Figure::new("").with(
            Panel::new("track, \"A\"", Axis::new("x"), Axis::new("y"))
                .with(Layer::line("fitted, 95 %", BLUE, points))
                .with(Layer::band("band", BLUE, [(1.0, 2.0, 3.0)]))
                .with(Layer::hulls("hull", BLUE, [[10.0, 20.0, 0.5]], 80.0, 12.0)),
        );
        let text = figure.csv().unwrap();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        assert_eq!(reader.headers().unwrap(), vec!["panel", "series", "kind", "x", "y", "z", "lo", "hi"]);
        let records: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        for (record, (x, y)) in records.iter().zip(points) {
            assert_eq!((&record[0], &record[1], &record[2]), ("track, \"A\"", "fitted, 95 %", "line"));
            assert_eq!(record[3].parse(), Ok(x));
            assert_eq!(record[4].parse().ok(), y.is_finite().then_some(y));
        }
        assert_eq!(records[3].iter().skip(2).collect::<Vec<_>>(), ["band", "1", "", "", "2", "3"]);
        assert_eq!(records[4].iter().skip(2).collect::<Vec<_>>(), ["hull", "20", "10", "0.5", "", ""]);
    }

    #[test]
    fn bars_and_cells_are_named_by_their_category_in_the_csv() {
        let mechanisms = || Axis::categories("", ["current", "wind"]);
        let lying = Panel::new("1", Axis::new("SNR"), mechanisms()).with(Layer::bars_with_intervals(
            "score",
            BLUE,
            [(3.0, 2.0, 4.0), (1.0, NAN, NAN)],
        ));
        let map = Panel::new("2", mechanisms(), mechanisms())
            .with(Layer::heatmap("share", vec![vec![1.0, 0.0], vec![0.25, 0.75]]));
        let text = Figure::new("").with(lying).with(map).csv().unwrap();
        assert!(text.contains("1,score,bar,3,current,,2,4\n1,score,bar,1,wind,,,\n"), "{text}");
        assert!(text.contains("2,share,cell,current,wind,0.25,,\n"), "{text}");
    }

    #[test]
    fn the_same_figure_gives_the_same_bytes() {
        let figure = Figure::new("ψ").with(Panel::default().with_all(every_layer(&samples()[0])));
        assert_eq!(figure.png().unwrap(), figure.png().unwrap());
        assert_eq!(figure.svg().unwrap(), figure.svg().unwrap());
    }

    #[test]
    fn files_are_written_beside_each_other_and_failures_name_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let figure = Figure::new("").with(Panel::default());
        let paths = figure.save(&folder.path().join("new/fig.3a")).unwrap();
        assert_eq!(paths, [folder.path().join("new/fig.3a.png"), folder.path().join("new/fig.3a.csv")]);
        assert!(paths.iter().all(|p| p.exists()));
        let error = figure.save(&paths[0].join("inside-a-file")).unwrap_err();
        assert!(error.to_string().contains("fig.3a.png"), "{error}");
    }
}
