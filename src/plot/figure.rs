//! Panels and the figure they make, as data.
//! It holds layers, axes and sizes; `output` turns a figure into PNG, SVG and CSV.

use super::axis::Axis;
use super::layer::Layer;

/// A position in the earth frame (x m north, y m east) as a point of a track panel: (east, north).
#[must_use]
pub fn east_north(x: f64, y: f64) -> (f64, f64) {
    (y, x)
}

/// One set of axes with its layers.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
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
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, y, equal_aspect: false, layers: vec![] }
    }

    /// An empty panel for tracks: east to the right, north up, metres of equal length.
    pub fn track(title: impl Into<String>) -> Self {
        Self { equal_aspect: true, ..Self::new(title, Axis::new("east y [m]"), Axis::new("north x [m]")) }
    }

    /// The same panel with one more layer on top.
    pub fn with(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// The same panel with more layers on top.
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
#[must_use]
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
    pub fn columns(self, columns: usize) -> Self {
        Self { columns, ..self }
    }

    /// The same figure with panels of this size, px of the PNG.
    pub fn panel_size(self, width: u32, height: u32) -> Self {
        Self { panel_width: width, panel_height: height, ..self }
    }

    /// The same figure with its legend elsewhere.
    pub fn legend(self, legend: Legend) -> Self {
        Self { legend, ..self }
    }

    /// The same figure with one more panel.
    pub fn with(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// The same figure with more panels.
    pub fn with_all(mut self, panels: impl IntoIterator<Item = Panel>) -> Self {
        self.panels.extend(panels);
        self
    }
}
