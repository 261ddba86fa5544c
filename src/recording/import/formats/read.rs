//! Reads a file of any format that is known, by its content rather than its name.
//! How each format is read is in the other files of this folder.

use super::foreign::foreign;
use super::nmea::{is_nmea, read_nmea};
#[cfg(feature = "parquet")]
use super::parquet::read_parquet;
use super::text::read_text;
use crate::files::written::bytes_of;
use crate::recording::import::columns::choose::Choices;
use crate::recording::import::error::ImportError;
use crate::recording::import::signals::attitude::add_heading;
use crate::recording::import::signals::log::Log;
use std::path::Path;

/// Reads a file, its time as the user says. A file whose own clock starts again several times is as many logs.
///
/// # Errors
/// [`ImportError`]: it cannot be read, is no log, or has no column or no time.
pub fn read(path: &Path, choices: &Choices) -> Result<Vec<Log>, ImportError> {
    if path.is_dir() {
        let message = "is a folder; give the files in it".to_owned();
        return Err(ImportError::File { path: path.to_owned(), message });
    }
    let bytes = bytes_of(path).map_err(|source| ImportError::Read { path: path.to_owned(), source })?;
    read_bytes(path, &bytes, choices)
}

/// Reads the content of a file; `path` is for messages.
///
/// # Errors
/// [`ImportError`]: it is no log, or has no column or no time.
pub fn read_bytes(path: &Path, bytes: &[u8], choices: &Choices) -> Result<Vec<Log>, ImportError> {
    if let Some(message) = foreign(bytes) {
        return Err(ImportError::File { path: path.to_owned(), message });
    }
    let mut logs = if is_parquet(bytes) {
        read_parquet(path, bytes, choices)
    } else if is_nmea(bytes) {
        read_nmea(path, bytes)
    } else {
        read_text(path, bytes, choices)
    }?;
    logs.iter_mut().for_each(add_heading);
    Ok(logs)
}

/// Whether bytes are those of a Parquet file.
fn is_parquet(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PAR1")
}

#[cfg(not(feature = "parquet"))]
fn read_parquet(path: &Path, _bytes: &[u8], _choices: &Choices) -> Result<Vec<Log>, ImportError> {
    Err(unread_parquet(path))
}

/// A build without the decoders says how to add them.
#[cfg(any(not(feature = "parquet"), test))]
fn unread_parquet(path: &Path) -> ImportError {
    let message = "is a Parquet file, which this build does not read; build it with `cargo build --release --features parquet` \
                   (in a crate of your own: `cargo add trimtab --features parquet`), or write the log as CSV: \
                   `pandas.read_parquet(FILE).to_csv(\"log.csv\")`";
    ImportError::File { path: path.to_owned(), message: message.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_without_the_decoders_names_the_line_that_adds_them() {
        let said = unread_parquet(Path::new("log.parquet")).to_string();
        for part in ["log.parquet", "is a Parquet file", "cargo build --release --features parquet", "log.csv"] {
            assert!(said.contains(part), "{said}");
        }
    }
}
