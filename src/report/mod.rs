//! What a person reads: tables, self-contained HTML pages, and fits, trials, plans, terms and diagnoses in words and figures.
//! It computes nothing beyond units, and no calculation imports it.

#[cfg(feature = "ipopt")]
mod active;
pub mod diagnosis;
pub mod dossier;
#[cfg(feature = "ipopt")]
mod fit;
#[cfg(feature = "plot")]
mod html;
pub mod maneuver;
mod paragraph;
pub mod plan;
#[cfg(feature = "plot")]
pub mod plot;
#[cfg(feature = "ipopt")]
pub mod sweep;
mod table;
pub mod terms;
mod units;
mod width;

#[cfg(feature = "plot")]
pub use html::{Page, Section};
pub use table::Table;
pub use width::{USUAL, at_width, set_width, width};
