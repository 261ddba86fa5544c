//! Figures as PNG, SVG, PDF and the CSV behind them, from plain numbers and words.
//! It knows nothing about ships, fits or diagnoses, and imports nothing of the project but `numerals`.

mod axes;
mod axis;
mod canvas;
mod compact;
mod csv;
mod data;
mod error;
mod extent;
mod figure;
mod font;
mod frame;
mod geometry;
mod heatmap;
mod layer;
mod layout;
mod legend;
mod marks;
mod output;
mod palette;
mod pdf;
mod pen;
mod raster;
mod shapes;
mod style;
mod svg;
mod ticks;

pub use axis::{Axis, Scale, equal_aspect};
pub use error::FigureError;
pub use figure::{Figure, Legend, Panel, Width, east_north};
pub use layer::{Layer, Mark, Marker, Stroke};
pub use output::Format;
pub use palette::{
    BASELINE, BLUE, Color, FITTED, GREEN, GREY, LIMIT, ORACLE, ORANGE, PURPLE, RECORDED, SKY, TRUTH, VERMILLION, cycle,
};
pub use ticks::nice_step;
