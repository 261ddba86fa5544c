//! The real hulls: studies, fits, diagnoses, and comparisons with measured trials and instruments.
//! Recordings are read from the user's folder; only numbers derived from them (errors, measures, pictures) are written.

pub mod agreement;
pub mod case;
pub mod error;
pub mod esso_osaka;
pub mod esso_osaka_diagnosed;
pub mod frame;
pub mod hull;
pub mod kvlcc2;
pub mod kvlcc2_diagnosed;
pub mod kvlcc2_hsva;
pub mod mend;
pub mod output;
pub mod published;
pub mod pull;
pub mod runs;
