//! A diagnosis for people and for programs: the summary of the terminal, the JSON document, the HTML page and its figures.
//! It computes no statistics; everything it says is in [`Diagnosis`](crate::diagnose::Diagnosis), turned into units that people
//! use (kN, degrees).

mod change;
mod document;
mod evidence;
mod findings;
mod force;
mod limits;
mod location;
mod names;
mod page;
mod parts;
mod pattern;
mod phrases;
mod picture;
mod pictures;
mod proof;
mod stages;
mod summary;
mod verdict;

pub use document::{document, keys, keys_listing};
pub use names::{mechanism_names, title_of};
pub use page::page;
pub use parts::{Part, parts};
pub use picture::Picture;
pub use pictures::pictures;
pub use summary::summary;
pub use verdict::{subject, verdict_words};
