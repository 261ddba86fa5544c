//! Figures as PNG, SVG and the CSV behind them, from plain numbers and words.
//! It knows nothing about ships, fits or diagnoses, and imports nothing of the project but `numerals`.

mod axis;
mod canvas;
mod draw;
mod figure;
mod legend;
mod marks;
mod palette;
mod render;
mod style;

pub use axis::{Axis, Scale, equal_aspect};
pub use figure::{Figure, FigureError, Layer, Legend, Mark, Marker, Panel, Stroke, east_north};
pub use palette::{
    BASELINE, BLUE, CYCLE, Color, FITTED, GREEN, GREY, LIMIT, ORACLE, ORANGE, PURPLE, RECORDED, SKY, TRUTH, VERMILLION,
    YELLOW, cycle,
};
