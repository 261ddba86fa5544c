//! Import: what ships and loggers write becomes recordings in SI units, with what each column was taken for and why.
//! It asks only for what the data do not show, fills no gap, and judges no ship: doubts about a recording are raised by `audit`.

mod columns;
mod error;
mod formats;
mod gaps;
mod overlap;
mod rows;
mod signals;
mod study;
mod whole;

pub use columns::choose::{Choices, Unused};
pub use columns::take::Taken;
pub use error::ImportError;
pub use formats::clock::moment;
pub use formats::read::read_bytes;
pub use rows::Rows;
pub use signals::log::{Clock, Column, Log, Meaning};
pub use study::{Origins, recording_csv, study_files};
pub use whole::{ImportSettings, Imported, ImportedRecording, SESSION_GAP, Velocity, import};
