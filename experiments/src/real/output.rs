//! Tables and pictures of the real hulls, written into the folder of figures.
//! Only derived numbers are written, never a recorded series.

use std::path::Path;

use trimtab::report::Table;
use trimtab::report::plot::Figure;

use super::error::RealError;

/// Writes a table as CSV.
///
/// # Errors
/// [`RealError::Write`].
pub fn write_csv(path: &Path, table: &Table) -> Result<(), RealError> {
    let quoted = |cell: &String| if cell.contains(',') { format!("\"{cell}\"") } else { cell.clone() };
    let line = |cells: &[String]| cells.iter().map(quoted).collect::<Vec<_>>().join(",") + "\n";
    let text = std::iter::once(line(table.header())).chain(table.rows().iter().map(|r| line(r))).collect::<String>();
    write(path, text.as_bytes())
}

/// Writes a figure as PNG without a CSV: the series behind it are recordings, which are not ours to publish.
///
/// # Errors
/// [`RealError::Figure`] or [`RealError::Write`].
pub fn write_png(path: &Path, figure: &Figure) -> Result<(), RealError> {
    write(path, &figure.png()?)
}

/// Writes a file, and makes its folder where there is none.
fn write(path: &Path, bytes: &[u8]) -> Result<(), RealError> {
    let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    let written = folder.and_then(|()| std::fs::write(path, bytes));
    written.map_err(|source| RealError::Write { path: path.to_owned(), source })
}
