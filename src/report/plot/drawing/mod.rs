//! How a figure becomes shapes on a sheet: ranges, ticks, axes, legend, and each kind of layer.
//! What a figure shows is data, and is elsewhere.

mod axes;
pub(super) mod extent;
mod frame;
pub(super) mod heatmap;
pub(super) mod layout;
mod legend;
mod marks;
mod shapes;
pub(super) mod style;
pub(super) mod ticks;
