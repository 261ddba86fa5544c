//! A table or figure of the paper: its name, its title, and the function that makes it.
//! It makes none itself.

use super::case::Case;
use super::error::PaperError;
use super::target::Target;

/// A table or figure of the paper.
#[derive(Debug)]
pub struct Artefact {
    /// Name on the command line of `paper`, and stem of its files.
    pub name: &'static str,
    /// What it shows.
    pub about: &'static str,
    /// Writes its files into a folder and gives a text with the tables.
    pub make: fn(&[Case], &Target) -> Result<String, PaperError>,
}
