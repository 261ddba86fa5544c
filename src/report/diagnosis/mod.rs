//! A diagnosis for people and for programs: the summary of the terminal, the JSON document, the HTML page and its figures.
//! It computes no statistics; everything it says is in [`Diagnosis`](crate::diagnose::Diagnosis).

pub mod figures;
mod text;

pub use text::{KEYS, document, keys_listing, mechanism_names, page, parts, summary, title_of};
