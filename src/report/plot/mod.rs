//! Figures as PNG, SVG, PDF and the CSV behind them, from plain numbers and words.
//! It is independent of ships, fits and diagnoses, and imports nothing of the project but `numerals`.

mod axis;
mod csv;
mod data;
mod drawing;
mod error;
mod figure;
mod layer;
mod output;
mod palette;
mod sheet;

pub use axis::{Axis, Scale, equal_aspect};
pub use drawing::ticks::nice_step;
pub use error::FigureError;
pub use figure::{Figure, Legend, Panel, Width, east_north};
pub use layer::{Layer, Mark, Marker, Stroke};
pub use output::Format;
pub use palette::{
    BASELINE, BLUE, Color, FITTED, GREEN, GREY, LIMIT, ORACLE, ORANGE, PURPLE, RECORDED, SKY, TRUTH, VERMILLION, cycle,
};
