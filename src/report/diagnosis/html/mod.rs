//! The HTML page of a diagnosis.
//! It computes nothing; its words are those of the summary.

pub(super) mod appendix;
mod finding;
mod opening;
pub(super) mod page;
mod runs;
