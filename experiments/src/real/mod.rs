//! The real hulls: studies, fits, diagnoses, and comparisons with measured trials and instruments.
//! Recordings are read from the user's folder; only numbers derived from them (errors, measures, pictures) are written.

pub mod agreement;
pub mod case;
pub mod error;
pub mod frame;
pub mod hull;
pub mod hulls;
pub mod mend;
pub mod output;
pub mod pull;
pub mod runs;
