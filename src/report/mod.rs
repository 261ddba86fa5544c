//! What a person reads: figures (PNG, SVG and the CSV behind them), terminal tables and self-contained HTML pages.
//! It knows how to draw and lay out, and nothing about ships, fits or diagnoses: callers hand it plain numbers and words.

mod axis;
mod canvas;
mod draw;
mod figure;
mod html;
mod legend;
mod marks;
mod palette;
mod render;
mod style;
mod table;

pub use axis::{Axis, Scale, equal_aspect};
pub use figure::{Figure, FigureError, Layer, Legend, Mark, Marker, Panel, Stroke, east_north};
pub use html::{Page, Section};
pub use palette::{
    BASELINE, BLUE, CYCLE, Color, FITTED, GREEN, GREY, LIMIT, ORACLE, ORANGE, PURPLE, RECORDED, SKY, TRUTH, VERMILLION,
    YELLOW, cycle,
};
pub use table::{DASH, Table, fixed, interval, sig};
