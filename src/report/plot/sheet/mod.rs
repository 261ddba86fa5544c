//! A sheet of shapes and text, and the files it is written to: PNG, SVG, PDF.
//! It depends on no figure.

pub(super) mod canvas;
mod compact;
pub(super) mod font;
pub(super) mod geometry;
pub(super) mod pdf;
mod pen;
pub(super) mod raster;
pub(super) mod svg;
