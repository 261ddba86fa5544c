//! Why a figure could not be made.
//! What to do about it is in the message; nothing is drawn or written here.

use std::path::PathBuf;

/// Why a figure could not be made.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The embedded font could not be read.
    #[error("the embedded DejaVu Sans font cannot be read; rebuild from a clean checkout")]
    Font,
    /// The figure has more pixels than fit into memory.
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
