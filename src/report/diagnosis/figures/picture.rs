//! A figure of a diagnosis with its caption and the part of the report it belongs to.
//! What it shows is drawn elsewhere.

use crate::report::plot::Figure;

/// A figure with its file name and the part of the report it belongs to.
#[derive(Clone, Debug)]
pub struct Picture {
    /// File name without extension.
    pub stem: &'static str,
    /// What is to be seen, in one or two sentences.
    pub caption: String,
    /// Heading of the part of the report, as in [`crate::report::diagnosis::parts`].
    pub part: &'static str,
    /// The figure.
    pub figure: Figure,
}

/// That not everything is shown; nothing where it is.
pub(in crate::report::diagnosis) fn shown(count: usize, of: usize, what: &str) -> String {
    if count < of { format!(" {count} of {of} {what} are shown.") } else { String::new() }
}
