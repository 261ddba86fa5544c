//! Trials for people: figures, tables and notes.
//! The trials and their measures are [`crate::evaluate::maneuver`]'s.

#[cfg(feature = "plot")]
mod annotate;
#[cfg(feature = "plot")]
mod figures;
mod tables;

#[cfg(feature = "plot")]
pub use figures::{stopping_figure, turning_figure, zigzag_figure};
pub use tables::{Listed, criteria_note, criteria_table, ended_note, measures_csv, measures_table, track_csv};
