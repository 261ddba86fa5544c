//! Trials for people: figures, tables and notes.
//! The trials and their measures are [`crate::evaluate::maneuver`]'s.

#[cfg(feature = "plot")]
mod annotate;
#[cfg(feature = "plot")]
mod figures;
mod recorded;
mod tables;

#[cfg(feature = "plot")]
pub use figures::{pull_out_figure, spiral_figure, stopping_figure, turning_figure, zigzag_figure};
pub use recorded::{recorded_criteria, recorded_csv, recorded_heading, recorded_table};
pub use tables::{Listed, criteria_note, criteria_table, ended_note, measures_csv, measures_table, track_csv};
