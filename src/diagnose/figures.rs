//! The pictures of a diagnosis.
//! They show what is in [`Diagnosis`] and compute nothing beyond means in bins.

use super::conclude::Diagnosis;
use crate::report::Figure;

/// A figure with its file name and the part of the report it belongs to.
#[derive(Clone, Debug)]
pub struct Picture {
    /// File name without extension.
    pub stem: &'static str,
    /// What is to be seen, in one or two sentences.
    pub caption: String,
    /// Index of the part of the report, from 0.
    pub part: usize,
    /// The figure.
    pub figure: Figure,
}

/// Every picture that the diagnosis gives cause to.
#[must_use]
pub fn all(_d: &Diagnosis) -> Vec<Picture> {
    Vec::new()
}
