//! Panels and the figure they make, as data.
//! It has layers, axes and sizes; `output` turns a figure into PNG, SVG and CSV.

use super::axis::Axis;
use super::drawing::style::EDGE;
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

/// Where the names of the series are. A legend never covers data.
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

/// The width of a figure on a printed page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// One column of text: 89 mm.
    One,
    /// Two columns of text: 183 mm.
    Two,
}

impl Width {
    /// Millimetres.
    #[must_use]
    pub const fn millimetres(self) -> u32 {
        match self {
            Self::One => 89,
            Self::Two => 183,
        }
    }

    /// Px of the PNG, of which 192 are an inch.
    const fn pixels(self) -> u32 {
        (self.millimetres() * 1920 + 127) / 254
    }
}

/// Least width of a panel, and of one with names along an axis, px.
const PANEL: u32 = 400;
const NAMED_PANEL: u32 = 600;
/// Least height of a panel that is made lower, px.
const LOWEST: u32 = 320;

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
    /// Where the names of the series are.
    pub legend: Legend,
    /// What is to be seen, in a sentence or two, for a text beside the figure; it is not drawn.
    pub caption: String,
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
            caption: String::new(),
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

    /// The same figure with words on what is to be seen.
    pub fn caption(self, words: impl Into<String>) -> Self {
        Self { caption: words.into(), ..self }
    }

    /// The same figure laid out anew for a page: as wide as one or two columns of text, its letters as large as before, with as many
    /// panels in a row as have room.
    pub fn to_width(mut self, width: Width) -> Self {
        let room = width.pixels() - 2 * EDGE as u32;
        let named = self.panels.iter().any(|p| p.x.labels().is_some() || p.y.labels().is_some());
        let least = if named { NAMED_PANEL } else { PANEL };
        let asked = self.columns.clamp(1, self.panels.len().max(1));
        let most = ((room / least).max(1) as usize).min(asked);
        // Rows of the figure stay together where they can.
        let columns = (1..=most).rev().find(|n| asked.is_multiple_of(*n)).unwrap_or(1);
        let panel = room / columns as u32;
        let lower = self.panel_height * panel / self.panel_width.max(1);
        if !self.panels.iter().any(|p| p.y.labels().is_some()) {
            self.panel_height = lower.clamp(LOWEST.min(self.panel_height), self.panel_height);
        }
        Self { columns, panel_width: panel, ..self }
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
