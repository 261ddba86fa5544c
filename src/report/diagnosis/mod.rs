//! A diagnosis for people and for programs: the summary of the terminal, the JSON document, the HTML page and its figures.
//! It computes no statistics; everything it says is in [`Diagnosis`](crate::diagnose::Diagnosis), turned into units that people
//! use (kN, degrees).

mod document;
#[cfg(feature = "plot")]
mod figures;
mod findings;
#[cfg(feature = "plot")]
mod html;
mod law;
mod limits;
mod location;
mod names;
mod next;
mod parts;
mod phrases;
mod proof;
#[cfg(feature = "plot")]
mod quantity;
mod summary;
mod verdict;

pub use document::{document, keys, keys_listing};
#[cfg(feature = "plot")]
pub use figures::picture::Picture;
#[cfg(feature = "plot")]
pub use figures::pictures::pictures;
#[cfg(feature = "plot")]
pub use html::appendix::{Provenance, SourceFile};
#[cfg(feature = "plot")]
pub use html::page::page;
pub use names::mechanism_names;
pub use next::{NEXT_WORDS, next_commands};
pub use parts::{Part, parts};
pub use summary::summary;
pub use verdict::{subject, verdict_words};
