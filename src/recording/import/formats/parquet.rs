//! Reads Parquet files: flat columns of numbers, times or text, of any of the usual compressions.
//! Nested columns are left out and reported.

use super::clock::{DateOrder, NumericTime, date_time, numeric_time, spread};
use super::layout::number;
use super::passes::{FEW, OTHERWISE, passes, stepped_back};
use crate::recording::import::columns::choose::Choices;
use crate::recording::import::columns::names::{meaning, name_and_unit, time_rank};
use crate::recording::import::error::ImportError;
use crate::recording::import::signals::log::{Clock, Column, Log, of_text};
use ::parquet::basic::{ConvertedType, LogicalType, TimeUnit};
use ::parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use ::parquet::data_type::{ByteArray, DataType};
use ::parquet::errors::ParquetError;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::schema::types::ColumnDescriptor;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Rows that a file may have: more is no log, or a damaged number.
const MOST_ROWS: i64 = 200_000_000;
/// Values read at a time.
const BATCH: usize = 65_536;

/// A column of a table.
struct Cells {
    name: String,
    unit: Option<String>,
    /// Seconds of one, where it is a time that counts from 1970.
    stamp: Option<f64>,
    values: Vec<f64>,
    texts: Vec<String>,
}

/// Reads a Parquet file, its time as the user says.
///
/// # Errors
/// [`ImportError::File`]: it cannot be read, or has no time.
pub fn read_parquet(path: &Path, bytes: &[u8], choices: &Choices) -> Result<Vec<Log>, ImportError> {
    let fail = |message: String| ImportError::File { path: path.to_owned(), message };
    // The decoder may meet what it does not expect in a damaged file.
    let read = catch_unwind(AssertUnwindSafe(|| columns(bytes)));
    let (mut cells, mut notes) = match read {
        Ok(Ok(read)) => read,
        Ok(Err(error)) => {
            return Err(fail(format!(
                "cannot be read as Parquet ({error}); write it again, with Snappy, Zstandard, gzip or no compression"
            )));
        }
        Err(_) => return Err(fail("is damaged and cannot be read as Parquet; write it again".to_owned())),
    };
    let at = time_column(&cells, choices.columns.get("t").map(String::as_str)).ok_or_else(|| {
        let names: Vec<&str> = cells.iter().map(|c| c.name.as_str()).collect();
        fail(format!("no column is a time; the columns are {}. Name it with `--column t=NAME`", names.join(", ")))
    })?;
    let clock_cells = cells.remove(at);
    let (clock, mut times, how) = times(&clock_cells, choices.units.get("t"));
    if times.iter().filter(|t| t.is_finite()).count() < 2 {
        return Err(fail(format!(
            "column `{}` is no time; name the time column with `--column t=NAME`",
            clock_cells.name
        )));
    }
    cells.iter_mut().for_each(Cells::read_texts);
    let texts: Vec<(String, String)> = cells.iter().filter_map(|c| Some((c.name.clone(), c.of_text()?))).collect();
    let shared = rounded(&cells, &times).then(|| spread(&mut times)).flatten();
    let spread = shared.map_or(String::new(), |k| format!(", rounded: {k} rows share a time and are spread over it"));
    let runs = passes(&times, |before, after| {
        let enough = |cells: &Cells, rows: &Range<usize>| {
            cells.in_rows(rows).iter().filter(|v| v.is_finite()).take(FEW).count() == FEW
        };
        let bits = |cells: &Cells, rows: &Range<usize>| -> Vec<u64> {
            cells.in_rows(rows).iter().map(|v| v.to_bits()).collect()
        };
        let copy = cells.iter().all(|c| bits(c, &before) == bits(c, &after));
        !copy && cells.iter().any(|c| enough(c, &before) && enough(c, &after))
    });
    if let [_, second, ..] = runs.as_slice() {
        notes.push(stepped_back(runs.len(), &format!("row {}", second.start + 1)));
    }
    let format = format!("Parquet; time is `{}`, {how}{spread}", clock_cells.name);
    let log = |run: Range<usize>| {
        let column = |cells: &Cells| {
            let mut column = Column { name: cells.name.clone(), unit: cells.unit.clone(), ..Column::default() };
            times[run.clone()].iter().zip(cells.in_rows(&run)).for_each(|(t, v)| column.push(*t, *v));
            column
        };
        let columns = cells.iter().map(column).filter(|c| !c.v.is_empty()).collect();
        let (texts, notes) = (texts.clone(), std::mem::take(&mut notes));
        Log { path: path.to_owned(), format: format.clone(), clock, columns, texts, notes }
    };
    Ok(runs.into_iter().map(log).collect())
}

impl Cells {
    /// Takes texts as numbers, where there are no others.
    fn read_texts(&mut self) {
        if self.values.is_empty() {
            self.values = self.texts.iter().map(|text| number(text, true).unwrap_or(f64::NAN)).collect();
        }
    }

    /// A sentence about a column of which no field is a number, with one that should be.
    fn of_text(&self) -> Option<String> {
        let wrong = |text: &&String| number(text, true).is_none();
        let (row, text) = self.texts.iter().enumerate().find(|(_, text)| wrong(text))?;
        let none = self.values.iter().all(|v| v.is_nan());
        none.then(|| of_text(&self.name, text, &format!("row {}", row + 1)))
    }

    /// The values of some rows.
    fn in_rows(&self, rows: &Range<usize>) -> &[f64] {
        self.values.get(rows.start..rows.end.min(self.values.len())).unwrap_or(&[])
    }
}

/// Whether rows that share a time are later ones, whose time was rounded, and not repeated rows or rows that each fill other columns.
fn rounded(cells: &[Cells], times: &[f64]) -> bool {
    let known: Vec<&Cells> = cells.iter().filter(|c| meaning(&c.name).is_some()).collect();
    let compared = if known.is_empty() { cells.iter().collect() } else { known };
    let pairs: Vec<usize> = (1..times.len()).filter(|i| times[*i] == times[i - 1]).collect();
    let differ = |i: &&usize| {
        let both = |c: &&Cells| Some([*c.values.get(**i - 1)?, *c.values.get(**i)?]);
        compared.iter().filter_map(both).any(|[a, b]| a.is_finite() && b.is_finite() && a != b)
    };
    let differing = pairs.iter().filter(differ).count();
    differing > 0 && differing as f64 >= OTHERWISE * pairs.len() as f64
}

/// The column with the time.
fn time_column(cells: &[Cells], wanted: Option<&str>) -> Option<usize> {
    if let Some(found) = wanted.and_then(|w| cells.iter().position(|c| c.name.eq_ignore_ascii_case(w))) {
        return Some(found);
    }
    let dated =
        |c: &Cells| c.texts.iter().find(|t| !t.is_empty()).is_some_and(|t| date_time(t, DateOrder::DayFirst).is_some());
    let rank = |i: &usize| (cells[*i].stamp.is_some() || dated(&cells[*i]), time_rank(&cells[*i].name));
    (0..cells.len()).rev().max_by_key(rank).filter(|i| rank(i) > (false, 0))
}

fn times(cells: &Cells, unit: Option<&String>) -> (Clock, Vec<f64>, &'static str) {
    if let Some(factor) = cells.stamp {
        return (Clock::Utc, cells.values.iter().map(|v| v * factor).collect(), "a timestamp");
    }
    if !cells.texts.is_empty() {
        let parsed = cells.texts.iter().map(|text| date_time(text, DateOrder::DayFirst).unwrap_or(f64::NAN));
        return (Clock::Utc, parsed.collect(), "a date and time (UTC where it has no zone)");
    }
    let unit = unit.or(cells.unit.as_ref()).and_then(|u| crate::recording::Quantity::Time.factor(u));
    let NumericTime { clock, factor, zero, words } = numeric_time(&cells.values, unit);
    (clock, cells.values.iter().map(|t| (t - zero) * factor).collect(), words)
}

/// Every flat column, with NaN or an empty text where a value is null.
fn columns(bytes: &[u8]) -> Result<(Vec<Cells>, Vec<String>), ParquetError> {
    let reader = SerializedFileReader::new(bytes::Bytes::copy_from_slice(bytes))?;
    let metadata = reader.metadata();
    let rows = metadata.file_metadata().num_rows();
    if !(0..=MOST_ROWS).contains(&rows) {
        return Err(ParquetError::General(format!("it says that it has {rows} rows")));
    }
    let schema = metadata.file_metadata().schema_descr_ptr();
    let (mut cells, mut notes) = (Vec::new(), Vec::new());
    for (i, column) in schema.columns().iter().enumerate() {
        let path = column.path().string();
        if column.max_rep_level() > 0 {
            notes.push(format!("column `{path}` contains lists and is left out"));
            continue;
        }
        let (name, unit) = name_and_unit(&path);
        let mut cell = Cells { name, unit, stamp: stamp(column), values: Vec::new(), texts: Vec::new() };
        for group in 0..reader.num_row_groups() {
            let group = reader.get_row_group(group)?;
            fill(&mut cell, group.get_column_reader(i)?, column)?;
        }
        cells.push(cell);
    }
    Ok((cells, notes))
}

/// Seconds of one, of a column of times that count from 1970.
fn stamp(column: &ColumnDescriptor) -> Option<f64> {
    match column.logical_type_ref() {
        Some(LogicalType::Timestamp(kind)) => Some(match kind.unit {
            TimeUnit::MILLIS => 1e-3,
            TimeUnit::MICROS => 1e-6,
            TimeUnit::NANOS => 1e-9,
        }),
        _ => match column.converted_type() {
            ConvertedType::TIMESTAMP_MILLIS => Some(1e-3),
            ConvertedType::TIMESTAMP_MICROS => Some(1e-6),
            _ if column.physical_type() == ::parquet::basic::Type::INT96 => Some(1.0),
            _ => None,
        },
    }
}

/// Adds the values of a column of one group of rows.
fn fill(cell: &mut Cells, reader: ColumnReader, column: &ColumnDescriptor) -> Result<(), ParquetError> {
    let level = column.max_def_level();
    let scale = match column.converted_type() {
        ConvertedType::DECIMAL => 10f64.powi(-column.type_scale()),
        _ => 1.0,
    };
    let none = f64::NAN;
    let text = |bytes: &ByteArray| String::from_utf8_lossy(bytes.data()).into_owned();
    match reader {
        ColumnReader::BoolColumnReader(r) => {
            each(r, level, |v| cell.values.push(v.map_or(none, |v| f64::from(u8::from(*v)))))
        }
        ColumnReader::Int32ColumnReader(r) => {
            each(r, level, |v| cell.values.push(v.map_or(none, |v| f64::from(*v) * scale)))
        }
        ColumnReader::Int64ColumnReader(r) => {
            each(r, level, |v| cell.values.push(v.map_or(none, |v| *v as f64 * scale)))
        }
        ColumnReader::Int96ColumnReader(r) => {
            each(r, level, |v| cell.values.push(v.map_or(none, |v| v.to_micros() as f64 * 1e-6)))
        }
        ColumnReader::FloatColumnReader(r) => each(r, level, |v| cell.values.push(v.map_or(none, |v| f64::from(*v)))),
        ColumnReader::DoubleColumnReader(r) => each(r, level, |v| cell.values.push(v.copied().unwrap_or(none))),
        ColumnReader::ByteArrayColumnReader(r) => {
            each(r, level, |v: Option<&ByteArray>| cell.texts.push(v.map_or_else(String::new, text)))
        }
        ColumnReader::FixedLenByteArrayColumnReader(_) => Ok(()),
    }
}

/// Hands every value of a column to `take`, `None` where it is null.
fn each<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    level: i16,
    mut take: impl FnMut(Option<&T::T>),
) -> Result<(), ParquetError> {
    loop {
        let (mut values, mut levels) = (Vec::new(), Vec::new());
        let (records, ..) = reader.read_records(BATCH, Some(&mut levels), None, &mut values)?;
        if records == 0 {
            return Ok(());
        }
        let mut given = values.iter();
        if level == 0 {
            given.for_each(|v| take(Some(v)));
        } else {
            levels.iter().for_each(|l| take(if *l == level { given.next() } else { None }));
        }
    }
}
