//! Reads a file of any format that is known, by its content rather than its name.
//! How each format is read is in the files beside it.

use super::error::ImportError;
use super::log::Log;
use super::nmea::{is_nmea, read_nmea};
use super::parquet::{is_parquet, read_parquet};
use super::text::read_text;
use std::path::Path;

/// Reads a file; `time` names its time column where the user does.
///
/// # Errors
/// [`ImportError`]: it cannot be read, or has no column or no time.
pub fn read(path: &Path, time: Option<&str>) -> Result<Log, ImportError> {
    let bytes = std::fs::read(path).map_err(|source| ImportError::Read { path: path.to_owned(), source })?;
    read_bytes(path, &bytes, time)
}

/// Reads the content of a file; `path` is for messages.
///
/// # Errors
/// [`ImportError`]: it has no column or no time.
pub fn read_bytes(path: &Path, bytes: &[u8], time: Option<&str>) -> Result<Log, ImportError> {
    if is_parquet(bytes) {
        read_parquet(path, bytes, time)
    } else if is_nmea(bytes) {
        read_nmea(path, bytes)
    } else {
        read_text(path, bytes, time)
    }
}
