//! Reads text files of columns: CSV in the layouts that loggers write.
//! What a column means and its unit are not decided here, but for what its header says.

use super::clock::{
    DAY, DateOrder, FORMS, NumericTime, Stamps, are_digits_of_day, are_shares_of_day, calendar, date_order, date_time,
    digits_of_day, has_zone, is_date_alone, is_date_time, is_of_hour, numeric_time, past_midnight, past_the_hour,
    spread, stamps, time_of_day, two_orders, zone,
};
use super::header::{Header, header};
use super::jumps::{mend, words};
use super::layout::{Delimiter, Layout, comment, decimal_comma, decoded, layout, number, too_wide};
use super::marks::{Marks, signs};
use super::passes::{FEW, OTHERWISE, passes, stepped_back};
use crate::recording::Quantity;
use crate::recording::import::columns::choose::Choices;
use crate::recording::import::columns::names::{self, is_ships_name, meaning, time_rank, time_unit};
use crate::recording::import::error::ImportError;
use crate::recording::import::signals::log::{Clock, Column, Log, Meaning, of_text};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

/// Share of a column's fields that must be numbers for it to be one, where the others are not all the same few words.
const NUMBERS: f64 = 0.9;
/// Words that may stand for a missing value in one column.
const FEW_WORDS: usize = 2;
/// Rows that a run has at least, where a file contains several.
const FEWEST: usize = 10;
/// Times closer than this are one \[s\].
const SAME_TIME: f64 = 1e-6;

/// The lines of a file as fields.
struct Table<'a> {
    path: &'a Path,
    /// Name and unit of each column.
    names: Vec<(String, Option<String>)>,
    decimal_comma: bool,
    /// Number and fields of each line of data.
    rows: Vec<(usize, Vec<&'a str>)>,
    /// Columns of text: name and a sentence about each.
    texts: Vec<(String, String)>,
    notes: Vec<String>,
}

/// Reads a text file of columns, its time as the user says: a log, or one of each run where a clock of its own starts again.
///
/// # Errors
/// [`ImportError`]: no columns, no time, numbers that can be read in two ways.
pub fn read_text(path: &Path, bytes: &[u8], choices: &Choices) -> Result<Vec<Log>, ImportError> {
    let text = decoded(bytes);
    let fail = |message: &str| ImportError::File { path: path.to_owned(), message: message.to_owned() };
    if let Some(count) = too_wide(&text) {
        let next = "a log has a line for each time and a column for each quantity; are rows and columns exchanged?";
        return Err(fail(&format!("a line has {count} fields; {next}")));
    }
    let layout = layout(&text).ok_or_else(|| {
        fail("no columns are found: lines have no number of fields in common. Give a CSV (commas, semicolons, tabs, upright strokes or blanks), NMEA 0183 or Parquet file")
    })?;
    let numbered = |name: &String| name.parse::<usize>().is_ok();
    let mut table = table(path, &text, &layout, !choices.columns.values().any(numbered))?;
    one_ship(&table)?;
    one_value_a_row(&table)?;
    if table.rows.len() < 2 {
        let count = ["no line", "one line"][table.rows.len()];
        return Err(fail(&format!("there is {count} of data; give a file with at least two")));
    }
    let Times { clock, mut t, used, how } = times(&table, choices)?;
    let columns = columns(&mut table, &used, &t);
    // A clock of its own is set by nobody.
    let changes = if clock == Clock::Own { Vec::new() } else { mend(&mut t, &columns, choices) };
    if !changes.is_empty() {
        let note = words(&changes, |row| table.rows[row].0);
        table.notes.push(note);
    }
    let decimal =
        if table.decimal_comma && layout.delimiter != Delimiter::Character(',') { " and decimal commas" } else { "" };
    let format = format!("text with {}{decimal}; time is {how}", layout.delimiter.words());
    let texts = std::mem::take(&mut table.texts);
    let log = |columns, notes| Log {
        path: path.to_owned(),
        format: format.clone(),
        clock,
        columns,
        texts: texts.clone(),
        notes,
    };
    let (runs, short) = runs(&table, &columns, clock, &t);
    if let Some(first) = short.first() {
        table.notes.push(format!(
            "{} lines where its time starts again are too few for a run and are left out, the first is line {}",
            short.iter().map(Range::len).sum::<usize>(),
            table.rows[first.start].0
        ));
    }
    if let [_, second, ..] = runs.as_slice() {
        let line = table.rows[second.start].0;
        table.notes.push(match clock {
            Clock::Utc => stepped_back(runs.len(), &format!("line {line}")),
            _ => format!("its time starts again {} times: {} runs", runs.len() - 1, runs.len()),
        });
    }
    let runs: Vec<Vec<usize>> = runs.into_iter().map(|run| run.filter(|row| t[*row].is_finite()).collect()).collect();
    let late = runs.iter().flat_map(|run| run.windows(2)).filter(|rows| t[rows[1]] < t[rows[0]] - SAME_TIME).count();
    if late > 0 {
        table.notes.push(format!("{late} lines come before an earlier one and are sorted"));
    }
    let mut logs = Vec::new();
    for mut run in runs {
        run.sort_by(|a, b| t[*a].total_cmp(&t[*b]));
        let part = |(column, values): &(Column, Vec<f64>)| {
            let mut column = column.clone();
            run.iter().for_each(|row| column.push(t[*row], values[*row]));
            column
        };
        logs.push(log(
            columns.iter().map(part).filter(|c| !c.v.is_empty()).collect(),
            std::mem::take(&mut table.notes),
        ));
    }
    Ok(logs)
}

/// The rows of each run, where the clock steps back over what it covered before, or a clock of its own starts again, and those of pieces that
/// are too short for a run; all rows as one where they are merely out of order.
fn runs(
    table: &Table<'_>,
    columns: &[(Column, Vec<f64>)],
    clock: Clock,
    t: &[f64],
) -> (Vec<Range<usize>>, Vec<Range<usize>>) {
    let repeats = |before: Range<usize>, after: Range<usize>| {
        let copy = before.len() == after.len()
            && before.clone().zip(after.clone()).all(|(a, b)| table.rows[a].1 == table.rows[b].1);
        let enough = |values: &[f64], rows: &Range<usize>| {
            values[rows.clone()].iter().filter(|v| v.is_finite()).take(FEW).count() == FEW
        };
        !copy && columns.iter().any(|(_, values)| enough(values, &before) && enough(values, &after))
    };
    let mut starts: BTreeSet<usize> = passes(t, repeats).into_iter().map(|run| run.start).collect();
    if clock != Clock::Utc {
        starts.extend(restarts(t));
    }
    let ends: Vec<usize> = starts.iter().copied().skip(1).chain([t.len()]).collect();
    let runs = starts.into_iter().zip(ends).map(|(start, end)| start..end);
    let (long, short): (Vec<_>, Vec<_>) = runs.partition(|run| clock == Clock::Utc || run.len() >= FEWEST);
    if long.is_empty() { (std::iter::once(0..t.len()).collect(), Vec::new()) } else { (long, short) }
}

/// First rows of runs that begin where time goes back to the first tenth of the run before.
fn restarts(t: &[f64]) -> Vec<usize> {
    let mut found = Vec::new();
    let (mut begun, mut last) = (f64::NAN, f64::NAN);
    for (row, time) in t.iter().enumerate().filter(|(_, time)| time.is_finite()) {
        if begun.is_nan() {
            begun = *time;
        }
        if *time < last && *time - begun < 0.1 * (last - begun) {
            found.push(row);
            begun = *time;
        }
        last = *time;
    }
    found
}

/// Ships that one file may name before it is taken for the log of many.
const MOST_NAMED: usize = 3;

/// Refuses a file that contains the rows of several ships: their tracks would be one.
fn one_ship(table: &Table<'_>) -> Result<(), ImportError> {
    for field in (0..table.names.len()).filter(|f| is_ships_name(&table.names[*f].0)) {
        let mut rows: BTreeMap<&str, usize> = BTreeMap::new();
        for (_, fields) in table.rows.iter().filter(|(_, fields)| !fields[field].is_empty()) {
            *rows.entry(fields[field]).or_default() += 1;
        }
        rows.retain(|_, count| *count >= FEW);
        // A column in which every row differs is no name.
        if rows.len() < 2 || 2 * rows.len() > table.rows.len() {
            continue;
        }
        let named: Vec<String> =
            rows.iter().take(MOST_NAMED).map(|(name, count)| format!("{name} ({count} lines)")).collect();
        let more = if rows.len() > MOST_NAMED { " and others" } else { "" };
        let message = format!(
            "column `{}` names {} ships: {}{more}; write the lines of each to a file of its own, and import one ship at a time",
            table.names[field].0,
            rows.len(),
            named.join(", ")
        );
        return Err(ImportError::File { path: table.path.to_owned(), message });
    }
    Ok(())
}

/// Quantities that a column must name for a file to have a row for each value.
const QUANTITIES: usize = 2;

/// Refuses a file that has a row for each value, with the name of its quantity in a column.
fn one_value_a_row(table: &Table<'_>) -> Result<(), ImportError> {
    for field in 0..table.names.len() {
        let words: BTreeSet<&str> = table.rows.iter().map(|(_, fields)| fields[field]).collect();
        let known = words.iter().filter(|w| number(w, true).is_none() && meaning(w).is_some()).count();
        // A word that is said once in a while is a remark.
        if known < QUANTITIES || FEW * words.len() > table.rows.len() {
            continue;
        }
        let name = &table.names[field].0;
        let is_value =
            |f: &usize| *f != field && table.rows.iter().all(|(_, fields)| number(fields[*f], true).is_some());
        let value = (0..table.names.len()).rev().find(is_value).map_or("VALUE", |f| &table.names[f].0);
        let time = time_field(table, None).map_or("TIME", |f| &table.names[f].0);
        let message = format!(
            "has a row for each value: column `{name}` names {known} quantities; give it a column for each of them first, for example with pandas: `pandas.read_csv(FILE).pivot_table(index=\"{time}\", columns=\"{name}\", values=\"{value}\").to_csv(\"log.csv\")`"
        );
        return Err(ImportError::File { path: table.path.to_owned(), message });
    }
    Ok(())
}

/// The lines below the header, and what the header says; `by_name` where the user calls no column by its number.
fn table<'a>(path: &'a Path, text: &'a str, layout: &Layout, by_name: bool) -> Result<Table<'a>, ImportError> {
    let is_value = |f: &&str| number(f, true).is_some_and(f64::is_finite) || is_time(f);
    let Header { mut names, fields: header, first, misfit } = header(text, layout, is_value);
    if let Some((line, count)) = misfit.filter(|_| by_name) {
        let width = layout.width;
        let message = format!(
            "this line names columns, and has {count} fields where the lines of data have {width}: write the names in one line, each that contains a separator of fields in quotes, or take the line out and call the columns by their number (`--column psi=4`)"
        );
        return Err(ImportError::At { path: path.to_owned(), line, column: 1, message });
    }
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line)).skip(first - 1);
    let (mut rows, mut damaged, mut repeated) = (Vec::new(), Vec::new(), 0);
    for (line, content) in lines.filter(|(_, l)| !l.trim().is_empty() && comment(l).is_none()) {
        let fields = layout.fields(content);
        if header.as_ref() == Some(&fields) {
            repeated += 1;
        } else if header.as_ref().is_some_and(|names| names_again(names, &fields)) {
            let message = "a second line of column names, in another order: the logger was started anew with other columns; put what follows this \
                           line, with it, into a file of its own, and import both"
                .to_owned();
            return Err(ImportError::At { path: path.to_owned(), line, column: 1, message });
        } else if fields.len() == names.len() {
            rows.push((line, fields));
        } else {
            damaged.push(line);
        }
    }
    let mut notes = Vec::new();
    if !text.ends_with('\n') && is_cut(&rows) {
        let line = rows.pop().map_or(0, |(line, _)| line);
        notes.push(format!("line {line}, the last, has no end, and its last number fewer figures than any other there: it may be cut, and is left out"));
    }
    if let Some(first) = damaged.first() {
        let (count, width) = (damaged.len(), names.len());
        notes.push(format!("{count} lines do not have {width} fields and are left out, the first is line {first}"));
    }
    if repeated > 0 {
        notes.push(format!("the line of column names comes {repeated} times more and is left out"));
    }
    if header.is_none() {
        notes.push(
            "there is no line of column names: columns are called by their number from 1 (`--column psi=4`)".to_owned(),
        );
    }
    number_equal(&mut names);
    let decimal_comma = commas(path, &rows, layout)?;
    Ok(Table { path, names, decimal_comma, rows, texts: Vec::new(), notes })
}

/// Numbers the columns of one name from the second on, as `Heading (2)`: they are columns of their own.
fn number_equal(names: &mut [(String, Option<String>)]) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for (name, _) in names {
        let count = counts.entry(name.clone()).or_default();
        *count += 1;
        if *count > 1 {
            *name = format!("{name} ({count})").trim().to_owned();
        }
    }
}

/// Whether the last field of the last row is shorter than in every other row.
fn is_cut(rows: &[(usize, Vec<&str>)]) -> bool {
    let Some(((_, last), others)) = rows.split_last() else { return false };
    let length = |fields: &[&str]| fields.last().map_or(0, |f| f.len());
    !others.is_empty() && others.iter().all(|(_, fields)| length(fields) > length(last))
}

/// Whether a comma separates fractions.
fn commas(path: &Path, rows: &[(usize, Vec<&str>)], layout: &Layout) -> Result<bool, ImportError> {
    match decimal_comma(rows.iter().flat_map(|(_, fields)| fields.iter().copied())) {
        Some(known) => Ok(known),
        None if layout.delimiter != Delimiter::Character(',') => Ok(true),
        None => {
            let place = rows.iter().flat_map(|(line, fields)| fields.iter().enumerate().map(move |f| (*line, f)));
            let (line, field, text) =
                place.filter(|(_, (_, f))| f.contains(',')).map(|(l, (i, f))| (l, i, *f)).next().unwrap_or((1, 0, ""));
            let message = format!("`{text}` may be a fraction or thousands; write numbers without commas");
            Err(ImportError::At { path: path.to_owned(), line, column: field + 1, message })
        }
    }
}

/// Whether a field is a date, a time, or both.
fn is_time(field: &str) -> bool {
    field.len() >= 5 && (time_of_day(field).is_some() || is_date_time(field))
}

/// The times of a table.
struct Times {
    /// What they count from.
    clock: Clock,
    /// That of each row \[s\], NaN where there is none.
    t: Vec<f64>,
    /// The fields they are from.
    used: Vec<usize>,
    /// How they were read.
    how: String,
}

/// Whether the fields of a row are names of columns: half of them or more are those of the header.
fn names_again(names: &[&str], fields: &[&str]) -> bool {
    let is_name = |field: &&&str| !field.is_empty() && names.contains(*field) && number(field, false).is_none();
    2 * fields.iter().filter(is_name).count() >= names.len().max(2)
}

/// Times whose year, month, day, hour, minute and second are in columns of their own.
fn in_columns(table: &Table<'_>) -> Option<Times> {
    let used = names::calendar::<0, 6>(table.names.iter().map(|(name, _)| name.as_str()))?;
    let time = |(_, fields): &(usize, Vec<&str>)| {
        calendar(used.map(|f| number(fields[f], table.decimal_comma).unwrap_or(f64::NAN))).unwrap_or(f64::NAN)
    };
    let t: Vec<f64> = table.rows.iter().map(time).collect();
    if 2 * t.iter().filter(|t| t.is_finite()).count() < t.len() {
        return None;
    }
    let named = used.map(|f| format!("`{}`", table.names[f].0)).join(", ");
    Some(Times { clock: Clock::Utc, t, used: used.to_vec(), how: format!("{named} (UTC)") })
}

/// Times of day whose hour, minute and second are in columns of their own, with the date of another column where there is one.
fn of_day_in_columns(table: &Table<'_>) -> Option<Times> {
    let parts = names::calendar::<3, 3>(table.names.iter().map(|(name, _)| name.as_str()))?;
    let texts = |field: usize| table.rows.iter().map(move |(_, fields)| fields[field]);
    let is_date = |f: &usize| !parts.contains(f) && texts(*f).find(|t| !t.is_empty()).is_some_and(is_date_alone);
    let date = (0..table.names.len()).find(is_date);
    let (order, unsure) = order(|| texts(date.unwrap_or(parts[0])));
    let time = |(_, fields): &(usize, Vec<&str>)| {
        let [hour, minute, second] = parts.map(|f| number(fields[f], table.decimal_comma).unwrap_or(f64::NAN));
        let is_time = (0.0..24.0).contains(&hour) && (0.0..60.0).contains(&minute) && (0.0..61.0).contains(&second);
        let day = date.map_or(Some(0.0), |date| date_time(fields[date], order));
        day.filter(|_| is_time && hour.fract() == 0.0)
            .map_or(f64::NAN, |day| day + 3600.0 * hour + 60.0 * minute + second)
    };
    let mut t: Vec<f64> = table.rows.iter().map(time).collect();
    if 2 * t.iter().filter(|t| t.is_finite()).count() < t.len() {
        return None;
    }
    let used: Vec<usize> = date.into_iter().chain(parts).collect();
    let named: Vec<String> = used.iter().map(|f| format!("`{}`", table.names[*f].0)).collect();
    let named = named.join(", ");
    let (clock, how) = if date.is_some() {
        (Clock::Utc, format!("{named} (UTC{unsure})"))
    } else {
        past_midnight(&mut t);
        (Clock::Day, format!("{named}, a time of day without a date"))
    };
    Some(Times { clock, t, used, how })
}

/// What a column of times has in each row.
struct OfDay {
    /// The numbers, NaN where there is none.
    numbers: Vec<f64>,
    /// The unit that stands beside each of them: `12.5 sec`.
    unit: Option<String>,
    /// Whether they are times of day.
    timed: bool,
    /// Those, as seconds.
    of_day: Vec<f64>,
}

/// Reads a column as times of day: hours, minutes and seconds, apart or in one number, or beside a date the share of the day that a
/// spreadsheet writes.
fn of_day(table: &Table<'_>, field: usize, dated: bool, stamps: Stamps) -> OfDay {
    let texts = || table.rows.iter().map(|(_, fields)| fields[field]);
    let marks = Marks::of(texts(), None, table.decimal_comma);
    let numbers: Vec<f64> = texts().map(|t| marks.value(t, table.decimal_comma).unwrap_or(f64::NAN)).collect();
    let (digits, share) = (are_digits_of_day(&numbers), dated && are_shares_of_day(&numbers));
    let time = |(text, number): (&str, &f64)| {
        let time = match (digits, share) {
            (true, _) => digits_of_day(*number),
            (_, true) => Some(DAY * number),
            // Only seconds have a fraction.
            _ if stamps == Stamps::MinutesSeconds => time_of_day(&format!("{text}.0")),
            _ => time_of_day(text),
        };
        time.unwrap_or(f64::NAN)
    };
    let of_day: Vec<f64> = texts().zip(&numbers).map(time).collect();
    let known = of_day.iter().filter(|t| t.is_finite()).count();
    OfDay { timed: digits || share || 2 * known >= table.rows.len(), numbers, unit: marks.unit, of_day }
}

/// What the stamps of a column are, where they are two numbers.
///
/// # Errors
/// [`ImportError::At`] where they may be minutes and seconds, or hours and minutes.
fn stamps_of(table: &Table<'_>, field: usize, dated: bool, choices: &Choices) -> Result<Stamps, ImportError> {
    let texts = || table.rows.iter().map(|(_, fields)| fields[field]);
    let (name, unit) = &table.names[field];
    let header = format!("{name} {}", unit.as_deref().unwrap_or_default());
    let found = stamps(texts(), &header, choices.units.get("t").map(String::as_str), dated);
    if found != Stamps::Either {
        return Ok(found);
    }
    let (line, fields) = &table.rows[0];
    let message = format!(
        "`{}` in column `{name}` begins a count of minutes and seconds, or it is midnight: pass `--unit t=min` for minutes and seconds, or \
         `--unit t=h` for hours and minutes",
        fields[field]
    );
    Err(ImportError::At { path: table.path.to_owned(), line: *line, column: field + 1, message })
}

/// The time of each row.
fn times(table: &Table<'_>, choices: &Choices) -> Result<Times, ImportError> {
    let in_columns = || in_columns(table).or_else(|| of_day_in_columns(table));
    if let Some(times) = in_columns().filter(|_| !choices.columns.contains_key("t")) {
        return Ok(times);
    }
    let field = time_field(table, choices.columns.get("t").map(String::as_str))?;
    let texts = |field: usize| table.rows.iter().map(move |(_, fields)| fields[field]);
    let first = |field: &usize| texts(*field).find(|t| !t.is_empty()).unwrap_or("");
    let date = (0..table.names.len()).find(|f| *f != field && is_date_alone(first(f)));
    let (order, unsure) = order(|| texts(date.unwrap_or(field)));
    let most = |parse: &dyn Fn(&str) -> bool| texts(field).filter(|t| parse(t)).count() * 2 >= table.rows.len();
    let name = &table.names[field].0;
    let stamps = stamps_of(table, field, date.is_some(), choices)?;
    let OfDay { numbers, unit: beside, timed, of_day } = of_day(table, field, date.is_some(), stamps);
    let day = |row: usize, date: usize| date_time(table.rows[row].1[date], order).unwrap_or(f64::NAN);
    let rows = 0..table.rows.len();
    let dated = date.filter(|date| timed && texts(*date).any(|t| date_time(t, order).is_some()));
    // `08.05.10` beside a date is a time of day.
    let mut times = if dated.is_none() && most(&|t| date_time(t, order).is_some()) {
        let t: Vec<f64> = texts(field).map(|t| date_time(t, order).unwrap_or(f64::NAN)).collect();
        // `Time (UTC+2)` has a zone for all that have none themselves.
        let zone = zone(name).filter(|_| !texts(field).any(has_zone));
        let t = t.into_iter().map(|t: f64| t - zone.unwrap_or(0.0)).collect();
        let how = match zone {
            Some(_) => format!("`{name}`, a date and time with the zone of its name{unsure}"),
            None => format!("`{name}`, a date and time (UTC where it has no zone{unsure})"),
        };
        Times { clock: Clock::Utc, t, used: vec![field], how }
    } else if let Some(date) = dated {
        let zone = [&table.names[date].0, name].into_iter().find_map(|name| zone(name)).unwrap_or(0.0);
        let words = if zone == 0.0 { "UTC" } else { "the zone of its name" };
        let how = format!("`{}` and `{name}` ({words}{unsure})", table.names[date].0);
        let t = rows.map(|row| day(row, date) + of_day[row] - zone).collect();
        Times { clock: Clock::Utc, t, used: vec![date, field], how }
    } else if timed {
        let mut t = of_day;
        let of_hour = stamps == Stamps::MinutesSeconds || texts(field).all(|t| t.is_empty() || is_of_hour(t));
        let hours = if of_hour { past_the_hour(&mut t) } else { 0 };
        past_midnight(&mut t);
        let how = match hours {
            0 if stamps == Stamps::MinutesSeconds => format!("`{name}`, minutes and seconds"),
            0 => format!("`{name}`, a time of day without a date"),
            hours => format!(
                "`{name}`, minutes and seconds, which start again {hours} times at the full hour and are counted on"
            ),
        };
        Times { clock: Clock::Day, t, used: vec![field], how }
    } else {
        let unit = choices.units.get("t").or(table.names[field].1.as_ref()).or(beside.as_ref()).map(String::as_str);
        let unit = unit.or_else(|| time_unit(name));
        let unit = unit.and_then(|u| Quantity::Time.factor(u));
        let NumericTime { clock, factor, zero, words } = numeric_time(&numbers, unit);
        let t = numbers.iter().map(|t| (t - zero) * factor).collect();
        Times { clock, t, used: vec![field], how: format!("`{name}`, {words}") }
    };
    if times.t.iter().filter(|t| t.is_finite()).count() < 2 {
        let (line, fields) = &table.rows[0];
        let message = format!(
            "`{}` in column `{name}` is no time that is read here: these are {FORMS}. If another column is the time, name it with `--column t=NAME`",
            fields[field]
        );
        return Err(ImportError::At { path: table.path.to_owned(), line: *line, column: field + 1, message });
    }
    if rounded(table, &times)
        && let Some(shared) = spread(&mut times.t)
    {
        times.how += &format!(", rounded: {shared} rows share a time and are spread over it");
    }
    Ok(times)
}

/// Whether rows that share a time are later ones, whose time was rounded: what is known by name then differs from row to row. Rows that
/// repeat all but a counter, or that each fill other fields, were written at one time.
fn rounded(table: &Table<'_>, times: &Times) -> bool {
    let others = || (0..table.names.len()).filter(|f| !times.used.contains(f));
    let mut compared: Vec<usize> = others().filter(|f| meaning(&table.names[*f].0).is_some()).collect();
    if compared.is_empty() {
        compared = others().collect();
    }
    let pairs = || times.t.windows(2).zip(table.rows.windows(2)).filter(|(t, _)| t[0] == t[1]).map(|(_, rows)| rows);
    let differ = |rows: &&[(usize, Vec<&str>)]| {
        let [a, b] = [&rows[0].1, &rows[1].1];
        compared.iter().any(|f| !a[*f].is_empty() && !b[*f].is_empty() && a[*f] != b[*f])
    };
    let differing = pairs().filter(differ).count();
    differing > 0 && differing as f64 >= OTHERWISE * pairs().count() as f64
}

/// Which of day and month comes first, and a note where no date proves it: then the order is taken in which the days
/// follow one another, or the day is first.
fn order<'a, I: Iterator<Item = &'a str>>(texts: impl Fn() -> I) -> (DateOrder, &'static str) {
    if let Some(order) = date_order(texts()) {
        return (order, "");
    }
    if !texts().any(two_orders) {
        return (DateOrder::DayFirst, "");
    }
    let length = |order: DateOrder| {
        let times = || texts().filter_map(|t| date_time(t, order));
        times().fold(f64::MIN, f64::max) - times().fold(f64::MAX, f64::min)
    };
    let (day, month) = (length(DateOrder::DayFirst), length(DateOrder::MonthFirst));
    if month < day {
        (DateOrder::MonthFirst, ", month before day, since only so the days follow one another")
    } else if day < month {
        (DateOrder::DayFirst, ", day before month, since only so the days follow one another")
    } else {
        (
            DateOrder::DayFirst,
            ", day before month, which no date in it proves: if it is not so, write dates as 2024-05-01",
        )
    }
}

/// The field with the time.
fn time_field(table: &Table<'_>, wanted: Option<&str>) -> Result<usize, ImportError> {
    let names = || table.names.iter().map(|(name, _)| name.as_str());
    if let Some(found) = wanted.and_then(|w| names().position(|n| n.eq_ignore_ascii_case(w))) {
        return Ok(found);
    }
    let rank = |f: &usize| {
        let texts = || table.rows.iter().take(20).map(|(_, fields)| fields[*f]).filter(|t| !is_date_alone(t));
        let joined = texts().any(|t| t.len() >= 8 && is_date_time(t));
        (joined, texts().any(is_time), time_rank(&table.names[*f].0))
    };
    let best = (0..table.names.len()).rev().max_by_key(rank).filter(|f| rank(f) > (false, false, 0));
    best.ok_or_else(|| ImportError::File {
        path: table.path.to_owned(),
        message: format!(
            "no column is a time; the columns are {}. Name it with `--column t=NAME`; times that are read are {FORMS}",
            names().collect::<Vec<_>>().join(", ")
        ),
    })
}

/// The columns of numbers, each with its values by row, NaN where one is missing; letters next to them or in a column of their own are
/// understood. Fields that are no number are reported.
fn columns(table: &mut Table<'_>, used: &[usize], times: &[f64]) -> Vec<(Column, Vec<f64>)> {
    let mut found: Vec<(usize, Column, Vec<f64>)> = Vec::new();
    let (mut others, mut unused) = (Vec::new(), Vec::new());
    let mut notes = Vec::new();
    for field in (0..table.names.len()).filter(|f| !used.contains(f)) {
        match column(table, field, &mut notes) {
            Some((column, values)) => found.push((field, column, values)),
            None => others.push(field),
        }
    }
    join_arcs(&mut found, &mut notes);
    let timed = |row: &usize| times[*row].is_finite();
    for field in others {
        let name = &table.names[field].0;
        let texts = || table.rows.iter().map(|(_, fields)| fields[field]);
        // The column before it, that of the same name, or the one after it.
        let near = |by: usize| found.iter().position(|(f, ..)| *f + 1 == field + by);
        let alike = found.iter().position(|(_, c, _)| meaning(name).is_some() && meaning(&c.name) == meaning(name));
        // A telegraph may stand anywhere, where there is one propeller.
        let rates =
            || found.iter().enumerate().filter(|(_, (_, c, _))| meaning(&c.name).is_some_and(Meaning::is_rotation));
        let one = rates().next().filter(|_| rates().count() == 1).map(|(at, _)| at);
        let signed = [near(0), alike, near(2), one].into_iter().flatten().find_map(|at| {
            let (_, column, values) = &found[at];
            let free = values.iter().all(|v| v.is_nan() || *v >= 0.0);
            Some((at, signs(texts(), meaning(&column.name)).filter(|_| free)?))
        });
        if let Some((at, signs)) = signed {
            notes.push(format!("column `{name}` says the sign of `{}`", found[at].1.name));
            // Nought needs no side.
            let sign = |(v, s): (&mut f64, f64)| *v *= if *v == 0.0 { 1.0 } else { s };
            found[at].2.iter_mut().zip(signs).for_each(sign);
        } else if let Some((row, text)) =
            texts().enumerate().filter(|(row, _)| timed(row)).find(|(_, t)| number(t, true).is_none())
        {
            let line = table.rows[row].0;
            let words = of_text(name, text, &format!("line {line}"));
            if meaning(name).is_some() {
                notes.push(format!("{words}, and is not used"));
            }
            unused.push((name.clone(), words));
        }
    }
    table.texts.append(&mut unused);
    table.notes.append(&mut notes);
    found.into_iter().map(|(_, column, values)| (column, values)).collect()
}

/// Joins whole degrees of latitude or longitude with the minutes, and the seconds, in the columns behind them: `Lat deg`, `Lat min`.
fn join_arcs(found: &mut Vec<(usize, Column, Vec<f64>)>, notes: &mut Vec<String>) {
    let first = |c: &Column| names::words(&c.name).first().cloned().unwrap_or_default();
    let is_part = |whole: &Column, part: &(usize, Column, Vec<f64>), begin: char| {
        let (_, column, values) = part;
        let named = column.unit.clone().or_else(|| names::words(&column.name).get(1).cloned());
        named.is_some_and(|name| name.starts_with(begin))
            && first(column) == first(whole)
            && values.iter().all(|v| v.is_nan() || (0.0..60.0).contains(v))
    };
    for at in (0..found.len()).rev() {
        let place = meaning(&first(&found[at].1)).filter(|m| matches!(m, Meaning::Latitude | Meaning::Longitude));
        let is_whole = found[at].2.iter().all(|v| v.is_nan() || v.fract() == 0.0);
        let part =
            |at: usize, by: usize, begin: char| found.get(at + by).is_some_and(|p| is_part(&found[at].1, p, begin));
        let parts = usize::from(part(at, 1, 'm')) * (1 + usize::from(part(at, 2, 's')));
        if place.is_none() || !is_whole || parts == 0 {
            continue;
        }
        let mut name = format!("`{}`", found[at].1.name);
        for (by, share) in [60.0, 3600.0].iter().enumerate().take(parts) {
            let (field, part, values) = found.remove(at + 1);
            name += &format!("{} `{}`", if by + 1 == parts { " and" } else { "," }, part.name);
            found[at].0 = field;
            // Nought degrees may be negative.
            found[at].2.iter_mut().zip(values).for_each(|(v, part)| *v += (part / share).copysign(*v));
        }
        let joined = &mut found[at].1;
        (joined.meaning, joined.unit) = (place, Some("deg".to_owned()));
        notes.push(format!("columns {name} are the degrees and parts of one arc, and are joined"));
    }
}

/// A column of numbers without its samples, and its values; `None` where it has none, or contains text.
fn column(table: &Table<'_>, field: usize, notes: &mut Vec<String>) -> Option<(Column, Vec<f64>)> {
    let (name, unit) = &table.names[field];
    let texts = || table.rows.iter().map(|(_, fields)| fields[field]);
    let marks = Marks::of(texts(), meaning(name), table.decimal_comma);
    let name = &if marks.magnetic { format!("{name} magnetic") } else { name.clone() };
    let values: Vec<Option<f64>> = texts().map(|text| marks.value(text, table.decimal_comma)).collect();
    let known = values.iter().flatten().filter(|v| v.is_finite()).count();
    let wrong =
        || texts().zip(&values).zip(&table.rows).filter(|((_, v), _)| v.is_none()).map(|((t, _), row)| (row.0, t));
    let (count, words) = (wrong().count(), wrong().map(|(_, text)| text).collect::<BTreeSet<&str>>());
    let few = words.len() <= FEW_WORDS && known > count;
    if known == 0 || !(few || known as f64 >= NUMBERS * (known + count) as f64) {
        return None;
    }
    if let Some((line, text)) = wrong().next() {
        notes.push(format!("column `{name}` contains what is no number in {count} lines, the first is line {line}, field {}: `{text}`; taken as missing", field + 1));
    }
    let column = Column { name: name.clone(), unit: unit.clone().or(marks.unit), ..Column::default() };
    Some((column, values.into_iter().map(|v| v.unwrap_or(f64::NAN)).collect()))
}
