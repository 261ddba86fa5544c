//! The file of results: a row is appended whole as its case ends, so that a campaign continues after a kill at any instant.
//! A last row that was cut off is dropped, and its case is run again.

use std::collections::{BTreeMap, HashMap};
use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::error::InjectedError;
use super::plan::Planned;
use super::row::Row;

/// The file of results, open for further rows.
pub struct Results {
    path: PathBuf,
    file: Mutex<File>,
    /// Rows that were there.
    pub rows: Vec<Row>,
}

/// A row as CSV with its line end, below the header if that is wanted.
fn text(row: &Row, header: bool) -> Result<String, InjectedError> {
    let fail = |e: &dyn std::fmt::Display| InjectedError::content(Path::new(&row.case), &e.to_string());
    let mut writer = csv::WriterBuilder::new().has_headers(header).from_writer(Vec::new());
    writer.serialize(row).map_err(|e| fail(&e))?;
    let bytes = writer.into_inner().map_err(|e| fail(&e))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn header() -> Result<String, InjectedError> {
    Ok(text(&Row::default(), true)?.split_inclusive('\n').next().unwrap_or_default().to_owned())
}

/// The rows of a file and the number of bytes that hold them whole; no cell has a line end, so that a line is a row.
fn whole(path: &Path, bytes: &[u8]) -> Result<(Vec<Row>, usize), InjectedError> {
    let header = header()?;
    let end = bytes.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
    if end == 0 {
        return Ok((Vec::new(), 0));
    }
    let text = String::from_utf8_lossy(&bytes[..end]).into_owned();
    if !text.starts_with(&header) {
        let message = "its columns are not those of this program; move it away, or give another folder with --out";
        return Err(InjectedError::content(path, &message));
    }
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows = reader.deserialize().collect::<Result<_, _>>().map_err(|e| InjectedError::content(path, &e))?;
    Ok((rows, end))
}

impl Results {
    /// Opens the file, made if absent, and reads its rows.
    ///
    /// # Errors
    /// [`InjectedError::Case`] if it cannot be read or written, or has other columns.
    pub fn open(path: &Path) -> Result<Self, InjectedError> {
        let fail = |source| InjectedError::file(path, source);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(fail)?;
        }
        let bytes = if path.exists() { std::fs::read(path).map_err(fail)? } else { Vec::new() };
        let (rows, end) = whole(path, &bytes)?;
        let mut file = OpenOptions::new().create(true).truncate(false).write(true).open(path).map_err(fail)?;
        file.set_len(end as u64).map_err(fail)?;
        file.seek(SeekFrom::Start(end as u64)).map_err(fail)?;
        if end == 0 {
            file.write_all(header()?.as_bytes()).map_err(fail)?;
        }
        Ok(Self { path: path.to_owned(), file: Mutex::new(file), rows })
    }

    /// Appends a row in one piece, and waits until it is on the disk.
    ///
    /// # Errors
    /// [`InjectedError::Case`].
    pub fn append(&self, row: &Row) -> Result<(), InjectedError> {
        let text = text(row, false)?;
        let fail = |source| InjectedError::file(&self.path, source);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(text.as_bytes()).map_err(fail)?;
        file.sync_data().map_err(fail)
    }

    /// The cases of a plan that have no row yet. A row without an answer because the program was stopped or missing has one.
    ///
    /// # Errors
    /// [`InjectedError::Case`] if a row is of a plan with another seed.
    pub fn missing(&self, plan: &[Planned]) -> Result<Vec<Planned>, InjectedError> {
        let seeds: BTreeMap<&str, u64> = self.rows.iter().map(|r| (r.case.as_str(), r.seed)).collect();
        let mut missing = Vec::new();
        for case in plan {
            match seeds.get(case.key.as_str()) {
                None => missing.push(case.clone()),
                Some(seed) if *seed == case.seed => {}
                Some(_) => {
                    let message = format!("case {} is of a campaign with another seed; give another folder", case.key);
                    return Err(InjectedError::content(&self.path, &message));
                }
            }
        }
        Ok(missing)
    }
}

/// Reads the rows of a file and puts them in the order of the plan: they end in another order each time.
///
/// # Errors
/// [`InjectedError::Case`].
pub fn in_order(path: &Path, plan: &[Planned]) -> Result<Vec<Row>, InjectedError> {
    let fail = |source| InjectedError::file(path, source);
    let (mut rows, _) = whole(path, &std::fs::read(path).map_err(fail)?)?;
    let place: HashMap<&str, usize> = plan.iter().enumerate().map(|(i, c)| (c.key.as_str(), i)).collect();
    rows.sort_by_key(|r| place.get(r.case.as_str()).copied().unwrap_or(usize::MAX));
    let written = path.with_extension("part");
    let mut all = header()?;
    for row in &rows {
        all += &text(row, false)?;
    }
    // Renamed whole: a kill leaves the old order or the new one.
    std::fs::write(&written, all).map_err(|source| InjectedError::file(&written, source))?;
    std::fs::rename(&written, path).map_err(fail)?;
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::injected::plan::plan;

    fn row(case: &Planned) -> Row {
        Row { truth: "[[\"a\",1.0]]".into(), headline: "one, \"two\"".into(), ..Row::planned(case) }
    }

    #[test]
    fn a_row_that_was_cut_off_at_any_byte_is_dropped_and_its_case_run_again() {
        let all = plan(31).unwrap();
        let cases = &all[..3];
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cases.csv");
        let results = Results::open(&path).unwrap();
        for case in cases {
            results.append(&row(case)).unwrap();
        }
        drop(results);
        let bytes = std::fs::read(&path).unwrap();
        let lines: Vec<usize> = (0..bytes.len()).filter(|i| bytes[*i] == b'\n').map(|i| i + 1).collect();
        assert_eq!(lines.len(), 4);
        let near = |cut: &usize| cut.is_multiple_of(97) || lines.iter().any(|end| end.abs_diff(*cut) < 2);
        for cut in (0..=bytes.len()).filter(near) {
            std::fs::write(&path, &bytes[..cut]).unwrap();
            let results = Results::open(&path).unwrap();
            let kept = lines.iter().filter(|end| **end <= cut).count().saturating_sub(1);
            assert_eq!(results.rows.len(), kept, "cut at byte {cut}");
            let missing = results.missing(cases).unwrap();
            assert_eq!(missing.len(), 3 - kept);
            for case in &missing {
                results.append(&row(case)).unwrap();
            }
            assert_eq!(std::fs::read(&path).unwrap(), bytes, "cut at byte {cut}");
        }
    }

    #[test]
    fn rows_are_put_in_the_order_of_the_plan_and_those_of_another_seed_are_refused() {
        let all = plan(31).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cases.csv");
        let results = Results::open(&path).unwrap();
        for case in all[..3].iter().rev() {
            results.append(&row(case)).unwrap();
        }
        let rows = in_order(&path, &all).unwrap();
        assert!(rows.iter().zip(&all).all(|(r, c)| r.case == c.key) && rows.len() == 3);
        let again = Results::open(&path).unwrap();
        assert_eq!(again.rows, rows);
        assert!(again.missing(&plan(32).unwrap()).is_err());
        std::fs::write(&path, "other,columns\n1,2\n").unwrap();
        assert!(Results::open(&path).is_err());
    }
}
