//! Trials for people: tables of measures, notes, tracks as CSV, and figures.
//! It simulates no trial and measures nothing: that is the module `maneuver`.

#[cfg(feature = "plot")]
mod figures;
mod tables;

#[cfg(feature = "plot")]
pub use figures::{stopping_figure, turning_figure, zigzag_figure};
pub use tables::{criteria_note, criteria_table, ended_note, stopping_table, track_csv, turning_table, zigzag_table};
