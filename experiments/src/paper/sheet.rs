//! Numbers as CSV files beside the pictures, at full precision.
//! How numbers read in a terminal is `trimtab::report`'s.

use super::PaperError;
use std::path::Path;

/// A cell: empty where there is no number.
pub fn cell(value: impl Into<Option<f64>>) -> String {
    value.into().filter(|v| v.is_finite()).map(|v| v.to_string()).unwrap_or_default()
}

/// Writes `name.csv` into a folder, making the folder if need be.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn save<const N: usize>(
    out: &Path,
    name: &str,
    header: [&str; N],
    rows: impl IntoIterator<Item = [String; N]>,
) -> Result<(), PaperError> {
    let path = out.join(format!("{name}.csv"));
    let write = || -> Result<(), csv::Error> {
        std::fs::create_dir_all(out)?;
        let mut writer = csv::Writer::from_path(&path)?;
        writer.write_record(header)?;
        for row in rows {
            writer.write_record(row)?;
        }
        Ok(writer.flush()?)
    };
    write().map_err(|source| PaperError::Write { path: path.clone(), source })
}
