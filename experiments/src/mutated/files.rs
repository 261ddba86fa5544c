//! The files of a sound study, in memory, and its recordings as tables of cells.
//! What is damaged in them is decided in `damage` and `edit`.

use std::collections::BTreeMap;
use std::path::Path;

use crate::conceal::case::Case;
use crate::conceal::error::ConcealError;
use crate::conceal::family::Family;
use crate::conceal::spec::Spec;
use crate::conceal::strength::ForceMeter;

/// Files by path below the folder of the study.
pub type Files = BTreeMap<String, Vec<u8>>;

/// Of the forty runs of a concealed case every third is kept: a fit takes milliseconds.
const EVERY: usize = 3;

/// A study without any fault: a case in which nothing is concealed, with ordinary sensor noise, and its model as the baseline.
///
/// # Errors
/// [`ConcealError`] if the case cannot be made.
pub fn sound(seed: u64, folder: &Path) -> Result<Files, ConcealError> {
    let study = Case::make(&Spec::null(Family::Hd, seed), &ForceMeter::default())?.write(folder)?;
    let read = |path: &Path| std::fs::read(path).map_err(|source| ConcealError::file(path, source));
    let text = String::from_utf8_lossy(&read(&study)?).into_owned();
    let (head, runs) = text.split_once("[[runs]]").unwrap_or((&text, ""));
    let (runs, settings) = runs.split_once("[fit]").unwrap_or((runs, ""));
    let kept: Vec<&str> = runs.split("[[runs]]").step_by(EVERY).collect();
    let study_text =
        format!("{head}[[runs]]{}[evaluate]\nbaseline = \"model.toml\"\n\n[fit]{settings}", kept.join("[[runs]]"));
    let beside = study.parent().unwrap_or(folder);
    let mut files = Files::from([("study.toml".to_owned(), study_text.into_bytes())]);
    let named = kept.iter().filter_map(|run| run.split('"').nth(1));
    for name in ["ship.toml", "model.toml", "columns.toml"].into_iter().chain(named) {
        files.insert(name.to_owned(), read(&beside.join(name))?);
    }
    Ok(files)
}

/// The names of the recordings.
pub fn recordings(files: &Files) -> Vec<String> {
    files.keys().filter(|name| name.ends_with(".csv")).cloned().collect()
}

/// Writes files into a folder, which is made, as are the folders below it.
///
/// # Errors
/// If one cannot be written.
pub fn write(files: &Files, folder: &Path) -> std::io::Result<()> {
    files.iter().try_for_each(|(name, bytes)| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap_or(folder))?;
        std::fs::write(path, bytes)
    })
}

/// A recording as cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Column headings.
    pub header: Vec<String>,
    /// Rows of cells.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// The cells of a file.
    pub fn read(bytes: &[u8]) -> Self {
        let text = String::from_utf8_lossy(bytes);
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<String>>());
        Self { header: lines.next().unwrap_or_default(), rows: lines.collect() }
    }

    /// The file.
    pub fn text(&self) -> Vec<u8> {
        let line = |cells: &Vec<String>| cells.join(",") + "\n";
        (line(&self.header) + &self.rows.iter().map(line).collect::<String>()).into_bytes()
    }

    /// The place of a channel, whose heading may have a unit.
    pub fn at(&self, channel: &str) -> Option<usize> {
        self.header.iter().position(|h| h.split_whitespace().next() == Some(channel))
    }

    /// The values of a column; NaN where a cell is no number.
    pub fn values(&self, column: usize) -> Vec<f64> {
        let value = |row: &Vec<String>| row.get(column).and_then(|c| c.trim().parse().ok()).unwrap_or(f64::NAN);
        self.rows.iter().map(value).collect()
    }

    /// Sets a cell; a blank stays one.
    pub fn set(&mut self, row: usize, column: usize, value: f64) {
        if let Some(cell) = self.rows.get_mut(row).and_then(|r| r.get_mut(column)).filter(|c| !c.trim().is_empty()) {
            *cell = value.to_string();
        }
    }

    /// Changes every value of a column.
    pub fn each(&mut self, column: usize, change: impl Fn(usize, f64) -> f64) {
        for (row, value) in self.values(column).into_iter().enumerate() {
            self.set(row, column, change(row, value));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sound_study_has_a_third_of_the_runs_and_its_tables_are_read_and_written_alike() {
        let folder = tempfile::tempdir().unwrap();
        let files = sound(3, folder.path()).unwrap();
        let runs = recordings(&files);
        assert_eq!(runs.len(), 14);
        let study = String::from_utf8(files["study.toml"].clone()).unwrap();
        assert_eq!(study.matches("[[runs]]").count(), 14);
        assert!(runs.iter().all(|run| study.contains(run)) && study.contains("baseline = \"model.toml\""));
        for run in &runs {
            let table = Table::read(&files[run]);
            assert_eq!(String::from_utf8_lossy(&table.text()), String::from_utf8_lossy(&files[run]));
            assert!(["t", "x", "psi", "delta"].iter().all(|c| table.at(c).is_some()) && table.at("q").is_none());
        }
    }
}
