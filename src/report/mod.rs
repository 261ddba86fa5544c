//! What a person reads: tables, self-contained HTML pages, and fits, trials, terms and diagnoses in words and figures.
//! It computes nothing beyond units, and no calculation imports it.

pub mod diagnosis;
mod fit;
mod html;
pub mod maneuver;
mod table;
pub mod terms;
mod units;

pub use html::{Page, Section};
pub use table::Table;
