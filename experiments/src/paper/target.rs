//! Where the tables and figures of the paper go, and how figures are drawn.
//! What is in them is decided by each table or figure.

use std::path::{Path, PathBuf};

use super::error::PaperError;
use trimtab::report::Table;
use trimtab::report::plot::{Figure, Format, Width};

/// A folder, and the formats and width of figures.
#[derive(Clone, Debug)]
pub struct Target {
    /// The folder, created if absent.
    pub folder: PathBuf,
    /// Formats of every figure.
    pub formats: Vec<Format>,
    /// Width on a page; as wide as a figure needs to be if not given.
    pub width: Option<Width>,
    /// Whether tables are written as LaTeX (booktabs) too.
    pub latex: bool,
}

impl Target {
    /// A folder with figures as PNG.
    pub fn new(folder: impl AsRef<Path>) -> Self {
        Self { folder: folder.as_ref().to_owned(), formats: vec![Format::Png], width: None, latex: false }
    }

    /// Writes a figure and the CSV behind it.
    ///
    /// # Errors
    /// A figure that cannot be drawn or written.
    pub fn figure(&self, name: &str, figure: Figure) -> Result<(), PaperError> {
        let figure = match self.width {
            Some(width) => figure.to_width(width),
            None => figure,
        };
        figure.save_as(&self.folder.join(name), &self.formats)?;
        Ok(())
    }

    /// Writes a table as `NAME.tex`, if LaTeX is asked for.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn table(&self, name: &str, table: &Table) -> Result<(), PaperError> {
        if !self.latex {
            return Ok(());
        }
        let path = self.folder.join(format!("{name}.tex"));
        std::fs::create_dir_all(&self.folder)
            .and_then(|()| std::fs::write(&path, table.latex()))
            .map_err(|source| PaperError::Write { path, source: source.into() })
    }
}
