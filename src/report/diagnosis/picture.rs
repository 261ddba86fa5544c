//! A figure of a diagnosis with its caption and the part of the report it belongs to.
//! What it shows is drawn in `figures`.

use crate::plot::{Figure, FigureError};

/// A figure, drawn, with its file name and the part of the report it belongs to.
#[derive(Clone, Debug)]
pub struct Picture {
    /// File name without extension.
    pub stem: &'static str,
    /// Title of the figure.
    pub title: String,
    /// What is to be seen, in one or two sentences.
    pub caption: &'static str,
    /// Heading of the part of the report, as in [`super::parts`].
    pub part: &'static str,
    /// As [`Figure::png`].
    pub png: Vec<u8>,
    /// As [`Figure::csv`].
    pub csv: String,
}

/// A figure before it is drawn.
pub(super) struct Sketch {
    pub stem: &'static str,
    pub part: &'static str,
    pub caption: &'static str,
    pub figure: Figure,
}

impl Sketch {
    /// Draws it.
    pub fn drawn(self) -> Result<Picture, FigureError> {
        let Self { stem, part, caption, figure } = self;
        Ok(Picture { stem, caption, part, png: figure.png()?, csv: figure.csv()?, title: figure.title })
    }
}
