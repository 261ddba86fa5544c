//! What a person reads: tables, self-contained HTML pages, and fits, trials, plans, terms and diagnoses in words and figures.
//! It computes nothing beyond units, and no calculation imports it.

pub mod diagnosis;
pub mod dossier;
#[cfg(feature = "ipopt")]
mod fit;
#[cfg(feature = "plot")]
mod html;
pub mod maneuver;
mod paragraph;
pub mod plan;
mod table;
pub mod terms;
mod units;

#[cfg(feature = "plot")]
pub use html::{Page, Section};
pub use table::Table;
