//! Import: what ships and loggers write becomes recordings in SI units, with what each column was taken for and why.
//! It asks only for what the data do not tell, fills no gap, and judges no ship: doubts about a recording are raised by `audit`.

mod agree;
mod choose;
mod clock;
mod error;
mod evidence;
mod fills;
mod foreign;
mod gaps;
mod geodesy;
mod layout;
mod log;
mod marks;
mod motion;
mod names;
mod nmea;
mod overlap;
mod parquet;
mod passes;
mod place;
mod read;
mod rows;
mod signal;
mod study;
mod take;
mod text;
mod vocabulary;
mod whole;

pub use choose::{Choices, Unused};
pub use error::ImportError;
pub use log::{Clock, Column, Log, Meaning};
pub use read::read_bytes;
pub use rows::Rows;
pub use study::{Origins, recording_csv, study_files};
pub use take::Taken;
pub use whole::{ImportSettings, Imported, ImportedRecording, SESSION_GAP, import};
