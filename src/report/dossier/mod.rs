//! A dossier for people: a summary for the terminal and one HTML page, both read from the JSON document.
//! It computes nothing beyond units, and says only what is in the document; the document is made in [`content`].

pub mod content;
#[cfg(feature = "plot")]
mod page;
#[cfg(feature = "plot")]
mod reader;
mod summary;
#[cfg(feature = "plot")]
mod tables;

#[cfg(feature = "plot")]
pub use page::page;
pub use summary::summary;
