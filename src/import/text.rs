//! Reads text files of columns: CSV in the layouts that loggers write.
//! What a column means and its unit are not decided here, but for what its header says.

use super::clock::{DateOrder, NumericTime, date_order, date_time, numeric_time, past_midnight, spread, time_of_day};
use super::error::ImportError;
use super::layout::{Delimiter, Layout, decoded, layout, number};
use super::log::{Clock, Column, Log};
use super::names::{is_date, is_unit, name_and_unit, time_rank};
use crate::recording::Quantity;
use std::path::Path;

/// Share of a column's fields that must be numbers for it to be one.
const NUMBERS: f64 = 0.9;

/// The lines of a file as fields.
struct Table<'a> {
    path: &'a Path,
    /// Name and unit of each column.
    names: Vec<(String, Option<String>)>,
    decimal_comma: bool,
    /// Number and fields of each line of data.
    rows: Vec<(usize, Vec<&'a str>)>,
    notes: Vec<String>,
}

/// Reads a text file of columns; `time` names its time column where the user does.
///
/// # Errors
/// [`ImportError`]: no columns, no time.
pub fn read_text(path: &Path, bytes: &[u8], time: Option<&str>) -> Result<Log, ImportError> {
    let text = decoded(bytes);
    let fail = |message: &str| ImportError::File { path: path.to_owned(), message: message.to_owned() };
    let layout = layout(&text).ok_or_else(|| {
        fail("no columns are found: lines have no number of fields in common. Give a CSV (commas, semicolons, tabs or blanks), NMEA 0183 or Parquet file")
    })?;
    let mut table = table(path, &text, &layout);
    if table.rows.is_empty() {
        return Err(fail("there is no line of data; give a file with at least two"));
    }
    let (clock, times, used, how) = times(&table, time)?;
    let mut columns = Vec::new();
    for field in (0..table.names.len()).filter(|f| !used.contains(f)) {
        let (column, note) = column(&table, field, &times);
        columns.extend(column);
        table.notes.extend(note);
    }
    let decimal = if table.decimal_comma { " and decimal commas" } else { "" };
    let format = format!("text with {}{decimal}; time is {how}", layout.delimiter.words());
    Ok(Log { path: path.to_owned(), format, clock, columns, notes: table.notes })
}

/// The lines below the header, and what the header says.
fn table<'a>(path: &'a Path, text: &'a str, layout: &Layout) -> Table<'a> {
    let mut lines = text.lines().enumerate().skip(layout.first - 1).map(|(i, line)| (i + 1, line)).peekable();
    let decimal_comma = layout.delimiter != Delimiter::Character(',');
    let is_value = |f: &&str| number(f, decimal_comma).is_some_and(f64::is_finite) || is_time(f);
    let header: Vec<&str> = lines.peek().map_or_else(Vec::new, |(_, line)| layout.delimiter.fields(line));
    let named = header.iter().filter(|f| is_value(f)).count() * 2 < header.len();
    let mut names: Vec<(String, Option<String>)> = if named {
        lines.next();
        header.iter().map(|f| name_and_unit(f)).collect()
    } else {
        (1..=layout.width).map(|i| (i.to_string(), None)).collect()
    };
    // A second line of the header may hold the units.
    let second: Vec<&str> = lines.peek().map_or_else(Vec::new, |(_, line)| layout.delimiter.fields(line));
    let unit_of = |f: &str| f.trim_matches(['[', ']', '(', ')']).trim().to_owned();
    if named && second.iter().any(|f| is_unit(&unit_of(f))) && !second.iter().any(is_value) {
        lines.next();
        for (name, unit) in names.iter_mut().zip(second) {
            name.1 = Some(unit_of(unit)).filter(|u| is_unit(u)).or(name.1.take());
        }
    }
    let (mut rows, mut damaged) = (Vec::new(), Vec::new());
    for (line, content) in lines.filter(|(_, l)| !l.trim().is_empty() && !l.starts_with('#')) {
        let mut fields = layout.delimiter.fields(content);
        if fields.len() > layout.width && fields[layout.width..].iter().all(|f| f.is_empty()) {
            fields.truncate(layout.width);
        }
        if fields.len() == names.len() {
            rows.push((line, fields));
        } else {
            damaged.push(line);
        }
    }
    let mut notes = Vec::new();
    if let Some(first) = damaged.first() {
        let (count, width) = (damaged.len(), names.len());
        notes.push(format!("{count} lines do not have {width} fields and are left out, the first is line {first}"));
    }
    if !named {
        notes.push(
            "there is no line of column names: columns are called by their number from 1 (`--column psi=4`)".to_owned(),
        );
    }
    Table { path, names, decimal_comma, rows, notes }
}

/// Whether a field is a date, a time, or both.
fn is_time(field: &str) -> bool {
    field.len() >= 5 && (time_of_day(field).is_some() || date_time(field, DateOrder::DayFirst).is_some())
}

/// The time of each row, what it counts from, the fields it is from, and how it was read.
fn times(table: &Table<'_>, wanted: Option<&str>) -> Result<(Clock, Vec<f64>, Vec<usize>, String), ImportError> {
    let field = time_field(table, wanted)?;
    let date = (0..table.names.len()).find(|f| *f != field && is_date(&table.names[*f].0));
    let texts = || table.rows.iter().map(move |(_, fields)| fields[field]);
    let date_texts = || table.rows.iter().map(move |(_, fields)| fields[date.unwrap_or(field)]);
    let known = date_order(date_texts());
    let order = known.unwrap_or(DateOrder::DayFirst);
    let share =
        |parse: &dyn Fn(&str) -> bool| texts().filter(|t| parse(t)).count() as f64 >= 0.5 * table.rows.len() as f64;
    let name = &table.names[field].0;
    let unsure = if known.is_none() && date_texts().any(|t| t.contains('/') && t.find('/') < Some(4)) {
        ", day before month, which no date in it proves"
    } else {
        ""
    };
    let (clock, mut times, used, how) = if share(&|t| date_time(t, order).is_some()) {
        let times = texts().map(|t| date_time(t, order).unwrap_or(f64::NAN)).collect();
        (Clock::Utc, times, vec![field], format!("`{name}`, a date and time (UTC where it has no zone{unsure})"))
    } else if let (Some(date), true) = (date, share(&|t| time_of_day(t).is_some())) {
        let joined = table.rows.iter().map(|(_, f)| date_time(&format!("{} {}", f[date], f[field]), order));
        let times = joined.map(|t| t.unwrap_or(f64::NAN)).collect();
        (Clock::Utc, times, vec![date, field], format!("`{}` and `{name}` (UTC{unsure})", table.names[date].0))
    } else if share(&|t| time_of_day(t).is_some()) {
        let mut times: Vec<f64> = texts().map(|t| time_of_day(t).unwrap_or(f64::NAN)).collect();
        past_midnight(&mut times);
        (Clock::Day, times, vec![field], format!("`{name}`, a time of day without a date"))
    } else {
        let numbers: Vec<f64> = texts().map(|t| number(t, table.decimal_comma).unwrap_or(f64::NAN)).collect();
        let unit = table.names[field].1.as_deref().and_then(|u| Quantity::Time.factor(u));
        let NumericTime { clock, factor, zero, words } = numeric_time(&numbers, unit);
        (clock, numbers.iter().map(|t| (t - zero) * factor).collect(), vec![field], format!("`{name}`, {words}"))
    };
    let timed = times.iter().filter(|t| t.is_finite()).count();
    if timed < 2 {
        let (line, fields) = &table.rows[0];
        let message =
            format!("`{}` in column `{name}` is no time; name the time column with `--column t=NAME`", fields[field]);
        return Err(ImportError::At { path: table.path.to_owned(), line: *line, column: field + 1, message });
    }
    let shared = spread(&mut times);
    let spread = shared.map_or(String::new(), |k| format!(", rounded: {k} rows share a time and are spread over it"));
    Ok((clock, times, used, how + &spread))
}

/// The field with the time.
fn time_field(table: &Table<'_>, wanted: Option<&str>) -> Result<usize, ImportError> {
    let names = || table.names.iter().map(|(name, _)| name.as_str());
    if let Some(found) = wanted.and_then(|w| names().position(|n| n.eq_ignore_ascii_case(w))) {
        return Ok(found);
    }
    let rank = |f: &usize| {
        let name = time_rank(&table.names[*f].0);
        let written = table.rows.iter().take(20).filter(|(_, fields)| is_time(fields[*f])).count();
        let joined = date_time(table.rows[0].1[*f], DateOrder::DayFirst).is_some();
        (u8::from(written > 0) * 2 + u8::from(joined), name)
    };
    let best = (0..table.names.len()).rev().max_by_key(rank).filter(|f| rank(f) > (0, 0));
    best.ok_or_else(|| ImportError::File {
        path: table.path.to_owned(),
        message: format!(
            "no column is a time; the columns are {}. Name it with `--column t=NAME`",
            names().collect::<Vec<_>>().join(", ")
        ),
    })
}

/// A column of numbers, and what is to be told of it; no column where it has none, or holds text.
fn column(table: &Table<'_>, field: usize, times: &[f64]) -> (Option<Column>, Option<String>) {
    let (name, unit) = &table.names[field];
    let mut column = Column { name: name.clone(), unit: unit.clone(), ..Column::default() };
    let (mut wrong, mut first) = (0, None);
    for ((line, fields), t) in table.rows.iter().zip(times) {
        match number(fields[field], table.decimal_comma) {
            Some(value) => column.push(*t, value),
            None => {
                wrong += 1;
                first = first.or(Some((*line, fields[field])));
            }
        }
    }
    let readable = column.v.len() as f64 >= NUMBERS * (column.v.len() + wrong) as f64;
    if column.v.is_empty() || !readable {
        return (None, None);
    }
    let note = first.map(|(line, text)| {
        format!("column `{name}` holds what is no number in {wrong} lines, the first is line {line}, field {}: `{text}`; taken as missing", field + 1)
    });
    (Some(column), note)
}
