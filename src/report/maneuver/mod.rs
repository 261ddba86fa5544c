//! Trials for people: figures, tables and notes.
//! The trials and their measures are [`crate::maneuver`]'s.

#[cfg(feature = "plot")]
mod annotate;
#[cfg(feature = "plot")]
mod figures;
mod tables;

#[cfg(feature = "plot")]
pub use figures::{stopping_figure, turning_figure, zigzag_figure};
pub use tables::{criteria_note, criteria_table, ended_note, stopping_table, track_csv, turning_table, zigzag_table};
