//! A diagnosis for people and for programs: the summary of the terminal, the JSON document, the HTML page and its figures.
//! It computes no statistics; everything it says is in [`Diagnosis`](crate::diagnose::Diagnosis), turned into units that people
//! use (kN, degrees).

#[cfg(feature = "plot")]
mod appendix;
#[cfg(feature = "plot")]
mod change;
mod document;
#[cfg(feature = "plot")]
mod evidence;
#[cfg(feature = "plot")]
mod finding;
mod findings;
#[cfg(feature = "plot")]
mod force;
mod law;
mod limits;
mod location;
mod names;
mod next;
#[cfg(feature = "plot")]
mod opening;
#[cfg(feature = "plot")]
mod page;
mod parts;
#[cfg(feature = "plot")]
mod pattern;
mod phrases;
#[cfg(feature = "plot")]
mod picture;
#[cfg(feature = "plot")]
mod pictures;
mod proof;
#[cfg(feature = "plot")]
mod quantity;
#[cfg(feature = "plot")]
mod runs;
#[cfg(feature = "plot")]
mod stages;
mod summary;
mod verdict;

#[cfg(feature = "plot")]
pub use appendix::{Provenance, SourceFile};
pub use document::{document, keys, keys_listing};
pub use names::mechanism_names;
pub use next::{NEXT_WORDS, next_commands};
#[cfg(feature = "plot")]
pub use page::page;
pub use parts::{Part, parts};
#[cfg(feature = "plot")]
pub use picture::Picture;
#[cfg(feature = "plot")]
pub use pictures::pictures;
pub use summary::summary;
pub use verdict::{subject, verdict_words};
