//! A file of results: a row is appended whole as its case ends, so that a campaign continues after a kill at any instant.
//! A last row that was cut off is dropped, and its case is run again; the campaign decides what is in a row.

use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::conceal::error::ConcealError;

/// A file of rows, open for further ones.
pub struct Rows<R> {
    path: PathBuf,
    file: Mutex<File>,
    /// Rows that were there.
    pub rows: Vec<R>,
}

/// A row as CSV with its line end, below the header if that is wanted.
fn text<R: Serialize>(row: &R, header: bool) -> Result<String, ConcealError> {
    let fail = |e: &dyn std::fmt::Display| ConcealError::content(Path::new("a row of results"), &e.to_string());
    let mut writer = csv::WriterBuilder::new().has_headers(header).from_writer(Vec::new());
    writer.serialize(row).map_err(|e| fail(&e))?;
    let bytes = writer.into_inner().map_err(|e| fail(&e))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

impl<R: Serialize + DeserializeOwned + Default> Rows<R> {
    fn header() -> Result<String, ConcealError> {
        Ok(text(&R::default(), true)?.split_inclusive('\n').next().unwrap_or_default().to_owned())
    }

    /// The rows of a file and the number of bytes that contain them whole; no cell has a line end, so that a line is a row.
    fn whole(path: &Path, bytes: &[u8]) -> Result<(Vec<R>, usize), ConcealError> {
        let end = bytes.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
        if end == 0 {
            return Ok((Vec::new(), 0));
        }
        let text = String::from_utf8_lossy(&bytes[..end]).into_owned();
        if !text.starts_with(&Self::header()?) {
            let message = "its columns are not those of this program; move it away, or give another folder with --out";
            return Err(ConcealError::content(path, &message));
        }
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows = reader.deserialize().collect::<Result<_, _>>().map_err(|e| ConcealError::content(path, &e))?;
        Ok((rows, end))
    }

    /// Opens the file, made if absent, and reads its rows.
    ///
    /// # Errors
    /// [`ConcealError`] if it cannot be read or written, or has other columns.
    pub fn open(path: &Path) -> Result<Self, ConcealError> {
        let fail = |source| ConcealError::file(path, source);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(fail)?;
        }
        let bytes = if path.exists() { std::fs::read(path).map_err(fail)? } else { Vec::new() };
        let (rows, end) = Self::whole(path, &bytes)?;
        let mut file = OpenOptions::new().create(true).truncate(false).write(true).open(path).map_err(fail)?;
        file.set_len(end as u64).map_err(fail)?;
        file.seek(SeekFrom::Start(end as u64)).map_err(fail)?;
        if end == 0 {
            file.write_all(Self::header()?.as_bytes()).map_err(fail)?;
        }
        Ok(Self { path: path.to_owned(), file: Mutex::new(file), rows })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends a row in one piece, and waits until it is on the disk.
    ///
    /// # Errors
    /// [`ConcealError`] if it cannot be written.
    pub fn append(&self, row: &R) -> Result<(), ConcealError> {
        self.append_all(std::slice::from_ref(row))
    }

    /// Appends the rows of a case in one piece, and waits until they are on the disk.
    ///
    /// # Errors
    /// [`ConcealError`] if they cannot be written.
    pub fn append_all(&self, rows: &[R]) -> Result<(), ConcealError> {
        let text = rows.iter().map(|row| text(row, false)).collect::<Result<String, _>>()?;
        let fail = |source| ConcealError::file(&self.path, source);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(text.as_bytes()).map_err(fail)?;
        file.sync_data().map_err(fail)
    }

    /// The whole rows of a file.
    ///
    /// # Errors
    /// [`ConcealError`] if it cannot be read or has other columns.
    pub fn read(path: &Path) -> Result<Vec<R>, ConcealError> {
        let bytes = std::fs::read(path).map_err(|source| ConcealError::file(path, source))?;
        Ok(Self::whole(path, &bytes)?.0)
    }

    /// Rows as a file.
    ///
    /// # Errors
    /// [`ConcealError`] if one has no form as CSV.
    pub fn table(rows: &[R]) -> Result<String, ConcealError> {
        rows.iter().try_fold(Self::header()?, |all, row| Ok(all + &text(row, false)?))
    }
}
