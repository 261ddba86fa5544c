//! Numbers as CSV files beside the pictures, at full precision.
//! How numbers read in a terminal belongs to `trimtab::report`.

use std::path::Path;

use super::error::PaperError;

/// A cell: empty where there is no number.
pub fn cell(value: impl Into<Option<f64>>) -> String {
    value.into().filter(|v| v.is_finite()).map(|v| v.to_string()).unwrap_or_default()
}

/// A CSV file of `N` columns in the making.
pub struct Sheet<const N: usize> {
    name: &'static str,
    header: [&'static str; N],
    rows: Vec<[String; N]>,
}

impl<const N: usize> Sheet<N> {
    /// An empty `name.csv`.
    pub fn new(name: &'static str, header: [&'static str; N]) -> Self {
        Self { name, header, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, row: [String; N]) {
        self.rows.push(row);
    }

    /// Writes the file into a folder, which is created if absent.
    ///
    /// # Errors
    /// A folder or file that cannot be written.
    pub fn save(self, out: &Path) -> Result<(), PaperError> {
        let path = out.join(format!("{}.csv", self.name));
        let write = || -> Result<(), csv::Error> {
            std::fs::create_dir_all(out)?;
            let mut writer = csv::Writer::from_path(&path)?;
            writer.write_record(self.header)?;
            for row in &self.rows {
                writer.write_record(row)?;
            }
            Ok(writer.flush()?)
        };
        write().map_err(|source| PaperError::Write { path: path.clone(), source })
    }
}
