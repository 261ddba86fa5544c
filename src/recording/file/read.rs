//! From the text of a file to raw channels in SI units: lines, fields, columns, units, missing values.
//! What follows (time, frames, reference point, derived channels) is `convert.rs`.

use super::blank::Blank;
use super::lines::LineNumbers;
use super::map::{Column, ColumnMap, Decimal, Delimiter, SpeedReference};
use super::unit::UNITS;
use crate::files::suggestion;
use crate::recording::channel::{CHANNELS, Channel, ChannelInfo};
use crate::recording::error::RecordingError;
use crate::recording::record::Recording;
use std::borrow::Cow;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// A column of the header.
struct HeaderColumn {
    /// The whole text.
    full: String,
    /// Without the brackets.
    name: String,
    /// What stands in the brackets.
    unit: Option<String>,
}

/// A channel with its source and its conversion to SI: `value * scale + offset`.
struct Source {
    channel: Channel,
    /// Field in the row, from 0; `None` for a constant.
    field: Option<usize>,
    /// The constant, in SI.
    constant: f64,
    label: String,
    unit: String,
    scale: f64,
    offset: f64,
    /// Values as written that stand for a missing one: those of the column, and those of the map.
    blank: [Blank; 2],
}

impl Recording {
    /// Reads a recording by its column map and checks it.
    ///
    /// # Errors
    /// Any [`RecordingError`] about the file: unreadable, empty, columns, units, numbers, time, or nothing usable.
    pub fn read(path: &Path, map: &ColumnMap) -> Result<Self, RecordingError> {
        Self::read_in(path, map, "")
    }

    /// As [`Recording::read`], with the delays that the map gives for a session.
    ///
    /// # Errors
    /// As [`Recording::read`].
    pub fn read_in(path: &Path, map: &ColumnMap, session: &str) -> Result<Self, RecordingError> {
        let fail = |source| RecordingError::Read { path: path.to_owned(), source };
        let file = std::fs::File::open(path).map_err(fail)?;
        recording(Lines::new(BufReader::with_capacity(1 << 16, file)), path, map, session)
    }

    /// The channels that the first lines of a recording have, by its column map; the rows are not read.
    ///
    /// # Errors
    /// Any [`RecordingError`] about the header.
    pub fn channels_in(path: &Path, map: &ColumnMap) -> Result<Vec<Channel>, RecordingError> {
        let fail = |source| RecordingError::Read { path: path.to_owned(), source };
        let file = std::fs::File::open(path).map_err(fail)?;
        let mut lines = Lines::new(BufReader::new(file));
        let (header, header_line, _) = header(&mut lines, path, map)?;
        Ok(sources(header.as_deref(), header_line, path, map)?.into_iter().map(|source| source.channel).collect())
    }

    /// Reads a recording from the text of a file; `path` is used in messages and, without its ending, as the name.
    ///
    /// # Errors
    /// As [`Recording::read`], but for a file that cannot be opened.
    pub fn parse(text: &str, path: &Path, map: &ColumnMap) -> Result<Self, RecordingError> {
        recording(Lines::new(text.as_bytes()), path, map, "")
    }
}

/// The lines of a file one at a time, numbered from 1; what is not UTF-8 is replaced, a byte order mark left out.
struct Lines<R> {
    reader: R,
    number: usize,
    bytes: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    fn new(reader: R) -> Self {
        Self { reader, number: 0, bytes: Vec::new() }
    }

    /// The next line without its end, and its number; `None` at the end of the file.
    fn next(&mut self) -> std::io::Result<Option<(usize, Cow<'_, str>)>> {
        self.bytes.clear();
        if self.reader.read_until(b'\n', &mut self.bytes)? == 0 {
            return Ok(None);
        }
        self.number += 1;
        let mut line = self.bytes.strip_suffix(b"\n").unwrap_or(&self.bytes);
        line = line.strip_suffix(b"\r").unwrap_or(line);
        if self.number == 1 {
            line = line.strip_prefix("\u{feff}".as_bytes()).unwrap_or(line);
        }
        Ok(Some((self.number, String::from_utf8_lossy(line))))
    }
}

/// The rows of a file as columns of numbers, one a source, with the line of each row.
struct Rows {
    lines: LineNumbers,
    columns: Vec<Vec<f64>>,
    /// Rows up to the last one with a value.
    data: usize,
}

/// A recording from its lines: they are read one by one, and of each only the numbers are kept.
fn recording<R: BufRead>(
    mut lines: Lines<R>,
    path: &Path,
    map: &ColumnMap,
    session: &str,
) -> Result<Recording, RecordingError> {
    let fail = |source| RecordingError::Read { path: path.to_owned(), source };
    let empty = |line, what: &str| RecordingError::Empty { path: path.to_owned(), line, what: what.to_owned() };
    let (header, header_line, first) = header(&mut lines, path, map)?;
    let sources = sources(header.as_deref(), header_line, path, map)?;
    let needed = sources.iter().filter_map(|s| s.field).max().map_or(0, |f| f + 1);
    let shape = Shape { expected: header.as_ref().map(Vec::len), needed };
    let mut rows = Rows { lines: LineNumbers::default(), columns: vec![Vec::new(); sources.len()], data: 0 };
    if let Some((line, content)) = first {
        rows.add(line, &content, &sources, &shape, path, map)?;
    }
    while let Some((line, content)) = lines.next().map_err(fail)? {
        rows.add(line, &content, &sources, &shape, path, map)?;
    }
    if rows.data == 0 {
        return Err(empty(header_line, "no row of data follows"));
    }
    let without_time = rows.keep_timed(&sources, map);
    if rows.lines.len() == 0 {
        return Err(empty(header_line, "no row has a time"));
    }
    let used: Vec<usize> = sources.iter().filter_map(|s| s.field).collect();
    let unused = header.iter().flatten().enumerate().filter(|(i, _)| !used.contains(i)).map(|(_, h)| h.full.clone());
    let name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let mut recording = Recording::empty(name, path, header_line);
    recording.lines = rows.lines;
    recording.without_time = ranges(&without_time);
    recording.unused = unused.collect();
    for (source, column) in sources.into_iter().zip(rows.columns) {
        let slot = match (source.channel, map.speed) {
            (Channel::U, SpeedReference::ThroughWater) => Channel::UWater,
            (Channel::V, SpeedReference::ThroughWater) => Channel::VWater,
            (channel, _) => channel,
        };
        recording.data.insert(slot, column);
        recording.units.insert(slot, source.unit);
    }
    recording.finish(map, session)?;
    Ok(recording)
}

/// The header where there is one, the line at which the file begins, and the first row where there is no header.
type Beginning = (Option<Vec<HeaderColumn>>, usize, Option<(usize, String)>);

/// How a file begins.
fn header<R: BufRead>(lines: &mut Lines<R>, path: &Path, map: &ColumnMap) -> Result<Beginning, RecordingError> {
    let fail = |source| RecordingError::Read { path: path.to_owned(), source };
    for skipped in 0..map.skip_lines {
        if lines.next().map_err(fail)?.is_none() {
            let what = format!("`skip_lines` = {} passes over all of its {skipped} lines", map.skip_lines);
            return Err(RecordingError::Empty { path: path.to_owned(), line: skipped.max(1), what });
        }
    }
    let mut first = None;
    while first.is_none() {
        let Some((line, content)) = lines.next().map_err(fail)? else { break };
        if content.contains('\0') {
            return Err(RecordingError::NoText { path: path.to_owned() });
        }
        first = (!content.trim().is_empty()).then(|| (line, content.into_owned()));
    }
    let header_line = first.as_ref().map_or(1, |(line, _)| *line);
    if !map.header.0 {
        return Ok((None, header_line, first));
    }
    let what = "there is no header line".to_owned();
    let (_, line) = first.ok_or_else(|| RecordingError::Empty { path: path.to_owned(), line: 1, what })?;
    let fields = split(&line, map.delimiter);
    if let [only] = &fields[..]
        && let Some((separator, name)) =
            SEPARATORS.into_iter().find(|(separator, _)| only.matches(*separator).count() > 1)
    {
        let header = only.to_string();
        return Err(RecordingError::Delimiter { path: path.to_owned(), line: header_line, separator, name, header });
    }
    Ok((Some(fields.iter().map(|f| header_column(f)).collect()), header_line, None))
}

/// What separates fields, and its name in a column map.
const SEPARATORS: [(char, &str); 3] = [(';', "semicolon"), ('\t', "tab"), (',', "comma")];

/// How many fields a row has.
struct Shape {
    /// As the header has it.
    expected: Option<usize>,
    /// As the sources need it.
    needed: usize,
}

impl Rows {
    /// Adds a line as a row. A row of blanks only counts as a dropout when data follow it.
    fn add(
        &mut self,
        line: usize,
        content: &str,
        sources: &[Source],
        shape: &Shape,
        path: &Path,
        map: &ColumnMap,
    ) -> Result<(), RecordingError> {
        if content.is_empty() {
            return Ok(());
        }
        let fields = split(content, map.delimiter);
        if fields.iter().all(|f| f.is_empty()) {
            self.lines.push(line);
            self.columns.iter_mut().for_each(|c| c.push(f64::NAN));
            return Ok(());
        }
        let least = shape.expected.unwrap_or(shape.needed);
        let surplus = shape.expected.filter(|&e| fields.len() > e && fields[e..].iter().any(|f| !f.is_empty()));
        if fields.len() < least || surplus.is_some() {
            let path = path.to_owned();
            return Err(RecordingError::Ragged { path, line, expected: least, found: fields.len() });
        }
        for (source, column) in sources.iter().zip(&mut self.columns) {
            let value = source.value(&fields, map.decimal).ok_or_else(|| {
                let found = source.field.map(|f| fields[f].to_string()).unwrap_or_default();
                let next = after_no_number(&found, source.channel, map.decimal);
                RecordingError::NotANumber { path: path.to_owned(), line, column: source.label.clone(), found, next }
            })?;
            column.push(value);
        }
        self.lines.push(line);
        self.data = self.lines.len();
        Ok(())
    }

    /// Gives rows their time and drops those without one and the blank ones at the end; returns the lines of both.
    fn keep_timed(&mut self, sources: &[Source], map: &ColumnMap) -> Vec<usize> {
        let (kept, mut without) = self.lines.parted(|row| row < self.data);
        self.lines = kept;
        self.columns.iter_mut().for_each(|c| c.truncate(self.data));
        let Some(time) = sources.iter().position(|s| s.channel == Channel::T) else { return without };
        if let Some(dt) = map.dt {
            self.columns[time].iter_mut().enumerate().for_each(|(i, t)| *t = i as f64 * dt);
        }
        if self.columns[time].iter().any(|t| !t.is_finite()) {
            let timed: Vec<bool> = self.columns[time].iter().map(|t| t.is_finite()).collect();
            let (kept, untimed) = self.lines.parted(|row| timed[row]);
            self.lines = kept;
            without.extend(untimed);
            for column in &mut self.columns {
                let mut keep = timed.iter();
                column.retain(|_| keep.next().is_some_and(|k| *k));
            }
        }
        self.columns[time].iter_mut().for_each(|t| *t -= map.time_zero);
        without.sort_unstable();
        without
    }
}

impl Source {
    /// The value in SI, NaN when missing, `None` when it is no number.
    fn value(&self, fields: &[Cow<'_, str>], decimal: Decimal) -> Option<f64> {
        let Some(field) = self.field else { return Some(self.constant) };
        let text = fields[field].trim();
        if text.is_empty() || ["nan", "na", "n/a", "null", "none", "-nan"].iter().any(|m| text.eq_ignore_ascii_case(m))
        {
            return Some(f64::NAN);
        }
        let parsed = match decimal {
            Decimal::Point => text.parse::<f64>(),
            Decimal::Comma => text.replace(',', ".").parse::<f64>(),
        };
        let value = parsed.ok()?;
        if self.blank.iter().any(|blank| blank.takes(value)) {
            return Some(f64::NAN);
        }
        Some(if value.is_finite() { value * self.scale + self.offset } else { f64::NAN })
    }
}

/// Where each channel comes from.
fn sources(
    header: Option<&[HeaderColumn]>,
    header_line: usize,
    path: &Path,
    map: &ColumnMap,
) -> Result<Vec<Source>, RecordingError> {
    let mut sources = Vec::new();
    for info in CHANNELS.iter().chain(map.commands(header.unwrap_or_default().iter().map(|h| h.name.as_str()))) {
        if map.leave_out.iter().any(|name| name == info.name) {
            continue;
        }
        let own_name = Some(info.name.to_owned());
        let listed = map.columns.as_ref().and_then(|columns| columns.get(info.name));
        let column = match listed {
            Some(column) if column.name.is_none() && column.index.is_none() && column.value.is_none() => {
                Column { name: own_name, ..column.clone() }
            }
            Some(column) => column.clone(),
            None if header.is_none() && map.columns.is_none() => {
                return Err(map_problem(
                    map,
                    path,
                    1,
                    "a file without a header needs a [columns] table with `index` entries",
                ));
            }
            None if by_own_name(info, header, header_line, path, map)? => {
                Column { name: own_name, ..Column::default() }
            }
            None => continue,
        };
        sources.push(source(info.channel, &column, header, header_line, path, map)?);
    }
    if map.dt.is_some() && !sources.iter().any(|s| s.channel == Channel::T) {
        let unit = "s".to_owned();
        let (channel, label) = (Channel::T, "t".to_owned());
        let blank = Default::default();
        sources.insert(0, Source { channel, field: None, constant: 0.0, label, unit, scale: 1.0, offset: 0.0, blank });
    }
    let has = |channel: Channel| sources.iter().any(|s| s.channel == channel);
    let clock = (!has(Channel::T)).then_some(Channel::T);
    if let Some(channel) = clock.into_iter().chain(map.driven.missing(has)).next() {
        if map.columns.is_some() {
            let text = format!(
                "[columns] has no entry for channel `{channel}` ({}), which every run needs, and the file no column of that name and a fitting unit",
                channel.info().words
            );
            return Err(map_problem(map, path, 1, &text));
        }
        return Err(missing_column(header, header_line, path, channel.name(), channel));
    }
    Ok(sources)
}

/// Whether a channel that the map does not list is read from the column of its name. Beside a [columns] table, which is for foreign
/// layouts, that column must have a unit of the channel's quantity and not serve another channel.
fn by_own_name(
    info: &ChannelInfo,
    header: Option<&[HeaderColumn]>,
    header_line: usize,
    path: &Path,
    map: &ColumnMap,
) -> Result<bool, RecordingError> {
    let Some(columns) = &map.columns else { return Ok(find(header, header_line, path, info.name)?.is_some()) };
    // A name that is there twice is no column of that channel.
    let Ok(Some(field)) = find(header, header_line, path, info.name) else { return Ok(false) };
    let column = &header.unwrap_or_default()[field];
    let taken = columns.values().any(|c| {
        let named = c
            .name
            .as_deref()
            .is_some_and(|name| matches!(find(header, header_line, path, name), Ok(Some(f)) if f == field));
        named || c.index == Some(field + 1)
    });
    let fits = column.unit.as_deref().is_some_and(|unit| info.quantity.factor(unit).is_some());
    Ok(fits && !taken)
}

/// Resolves one channel's column, unit and conversion.
fn source(
    channel: Channel,
    column: &Column,
    header: Option<&[HeaderColumn]>,
    header_line: usize,
    path: &Path,
    map: &ColumnMap,
) -> Result<Source, RecordingError> {
    let map_line = map.line(channel.name());
    let field = match (&column.name, column.index) {
        (Some(name), _) => {
            if header.is_none() {
                let text = format!(
                    "channel `{channel}` is given by the name `{name}` in a file without a header; give its `index`"
                );
                return Err(map_problem(map, path, map_line, &text));
            }
            let found = find(header, header_line, path, name)?;
            Some(found.ok_or_else(|| missing_column(header, header_line, path, name, channel))?)
        }
        (None, Some(index)) => {
            if let Some(columns) = header.map(<[HeaderColumn]>::len).filter(|&n| index > n) {
                let text = format!("channel `{channel}` is column {index}, but the header has {columns} columns");
                return Err(map_problem(map, path, map_line, &text));
            }
            Some(index - 1)
        }
        (None, None) => None,
    };
    let quantity = channel.info().quantity;
    let in_header = field.and_then(|f| header.and_then(|h| h.get(f))).and_then(|h| h.unit.clone());
    // A unit from the map is wrong in the map; one from the header, or none at all, in the file.
    let (place, line) = match (&column.unit, &map.path) {
        (Some(_), Some(map_path)) => (map_path.clone(), map_line),
        _ => (path.to_owned(), header_line),
    };
    let unit = column.unit.clone().or(in_header);
    let problem = |problem: String, near: String| RecordingError::Unit {
        path: place.clone(),
        line,
        column: column.label(),
        problem,
        channel,
        suggestion: near,
    };
    let unit = unit.ok_or_else(|| problem("has no unit".to_owned(), String::new()))?;
    let factor = quantity.factor(&unit).ok_or_else(|| {
        let known = UNITS.iter().filter(|u| u.quantity == quantity).flat_map(|u| u.spellings.iter().copied());
        problem(format!("has the unit `{unit}`"), suggestion(&unit, known))
    })?;
    let (scale, offset) = column.linear();
    let constant = column.value.map_or(f64::NAN, |v| (v * scale + offset) * factor);
    let label = field.and_then(|f| header.and_then(|h| h.get(f))).map_or_else(|| column.label(), |h| h.full.clone());
    let blank = [column.blank.clone(), map.blank.clone()];
    Ok(Source { channel, field, constant, label, unit, scale: scale * factor, offset: offset * factor, blank })
}

/// The field of a header column by its full text, its name, or its name without regard to case.
fn find(
    header: Option<&[HeaderColumn]>,
    line: usize,
    path: &Path,
    name: &str,
) -> Result<Option<usize>, RecordingError> {
    let header = header.unwrap_or_default();
    let tests: [fn(&HeaderColumn, &str) -> bool; 3] =
        [|h, n| h.full == n, |h, n| h.name == n, |h, n| h.name.eq_ignore_ascii_case(n)];
    for test in tests {
        let mut hits = header.iter().enumerate().filter(|(_, h)| test(h, name)).map(|(i, _)| i);
        if let Some(first) = hits.next() {
            if hits.next().is_some() {
                return Err(RecordingError::RepeatedColumn { path: path.to_owned(), line, column: name.to_owned() });
            }
            return Ok(Some(first));
        }
    }
    Ok(None)
}

/// What to do about a field that is no number: what it looks like says which.
fn after_no_number(found: &str, channel: Channel, decimal: Decimal) -> &'static str {
    let comma = found.matches(',').count() == 1 && found.trim().replace(',', ".").parse::<f64>().is_ok();
    if channel == Channel::T && found.contains([':', '-', '/']) && found.contains(|c: char| c.is_ascii_digit()) {
        "times of day and dates are read by `trimtab import`, which makes a study of such logs; here a time is a number of seconds"
    } else if decimal == Decimal::Point && comma {
        "set `decimal = \"comma\"` in a column map if numbers are written 1,5"
    } else {
        "correct it, or leave the field empty for a missing value"
    }
}

fn missing_column(
    header: Option<&[HeaderColumn]>,
    line: usize,
    path: &Path,
    column: &str,
    channel: Channel,
) -> RecordingError {
    let header = header.unwrap_or_default();
    // What a name stands for goes before how it is spelt: `rpm` is no `r`.
    let meant = header.iter().find(|h| Channel::meant_by(&h.name) == Some(channel)).map(|h| h.name.as_str());
    let near = meant.map_or_else(
        || suggestion(column, header.iter().map(|h| h.name.as_str()).filter(|name| Channel::meant_by(name).is_none())),
        |name| format!(", did you mean `{name}`?"),
    );
    RecordingError::MissingColumn {
        path: path.to_owned(),
        line,
        column: column.to_owned(),
        channel,
        suggestion: near,
        found: header.iter().map(|h| format!("`{}`", h.full)).collect::<Vec<_>>().join(", "),
    }
}

/// A problem of the column map, reported for the map's file, or for the recording where the map is the default one.
fn map_problem(map: &ColumnMap, path: &Path, line: usize, message: &str) -> RecordingError {
    let path: PathBuf = map.path.clone().unwrap_or_else(|| path.to_owned());
    RecordingError::Map { path, line, message: message.to_owned() }
}

/// `u [kn]` or `u (kn)` into name and unit.
fn header_column(text: &str) -> HeaderColumn {
    let full = text.to_owned();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, rest)) = full.split_once(open)
            && let Some((unit, _)) = rest.rsplit_once(close)
        {
            return HeaderColumn { name: name.trim().to_owned(), unit: Some(unit.trim().to_owned()), full };
        }
    }
    HeaderColumn { name: full.clone(), unit: None, full }
}

/// The fields of a line, trimmed and without quotes.
fn split(line: &str, delimiter: Delimiter) -> Vec<Cow<'_, str>> {
    let separator = match delimiter {
        Delimiter::Whitespace => return line.split_whitespace().map(|f| f.trim_matches('"').into()).collect(),
        Delimiter::Comma => ',',
        Delimiter::Semicolon => ';',
        Delimiter::Tab => '\t',
    };
    if !line.contains('"') {
        return line.split(separator).map(|f| f.trim().into()).collect();
    }
    let mut fields = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            c if c == separator && !quoted => fields.push(String::new()),
            c => {
                if let Some(last) = fields.last_mut() {
                    last.push(c);
                }
            }
        }
    }
    fields.into_iter().map(|f| f.trim().to_owned().into()).collect()
}

/// Consecutive numbers as (first, last).
fn ranges(lines: &[usize]) -> Vec<(usize, usize)> {
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for &line in lines {
        match ranges.last_mut() {
            Some(last) if last.1 + 1 == line => last.1 = line,
            _ => ranges.push((line, line)),
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "t [s],x [m],y [m],psi [deg],u [kn],v [m/s],r [deg/s],n [rpm],delta [deg]\n\
                         0,0,0,359,10,0,1,60,-5\n1,5,0,0.5,10,0,1,60,-5\n2,10,0,1.5,10,0,1,60,-5\n";

    fn read(text: &str, map: &str) -> Result<Recording, RecordingError> {
        let map = ColumnMap::parse(map, Path::new("columns.toml")).unwrap();
        Recording::parse(text, Path::new("run.csv"), &map)
    }

    #[test]
    fn a_canonical_file_is_read_into_si_units() {
        let r = read(TABLE, "").unwrap();
        assert_eq!((r.len(), r.line(0), r.step()), (3, 2, 1.0));
        let at = |c| r.get(c).unwrap()[1];
        assert!((at(Channel::U) - 5.144_444).abs() < 1e-6);
        assert!((at(Channel::N) - 1.0).abs() < 1e-12);
        assert!((at(Channel::Delta) + 5_f64.to_radians()).abs() < 1e-12);
        assert!((at(Channel::Psi) - 360.5_f64.to_radians()).abs() < 1e-12, "unwrapped across north");
    }

    #[test]
    fn a_map_changes_delimiter_sign_unit_and_name() {
        let text = "made by a logger\n\ntime;n;rudder\n0,0;60;5\n0,5;60;-5\n";
        let map = "delimiter = \"semicolon\"\ndecimal = \"comma\"\nskip_lines = 1\n[columns]\n\
                   t = { column = \"time\", unit = \"s\" }\nn = { column = \"n\", unit = \"rpm\" }\n\
                   delta = { column = \"rudder\", unit = \"deg\", sign = -1 }\nu = { value = 2.0, unit = \"m/s\" }\n";
        let r = read(text, map).unwrap();
        assert_eq!(r.time(), [0.0, 0.5]);
        assert!((r.get(Channel::Delta).unwrap()[0] + 5_f64.to_radians()).abs() < 1e-12);
        assert_eq!(r.get(Channel::U).unwrap(), [2.0, 2.0]);
        assert_eq!(r.line(0), 4);
    }

    #[test]
    fn a_map_of_one_channel_leaves_the_others_under_their_own_names() {
        let plain = read(TABLE, "").unwrap();
        let turned = read(TABLE, "[columns]\ndelta = { sign = -1 }\n").unwrap();
        for (channel, values) in plain.channels() {
            let sign = if channel == Channel::Delta { -1.0 } else { 1.0 };
            let expected: Vec<f64> = values.iter().map(|v| sign * v).collect();
            assert_eq!(turned.get(channel), Some(&expected[..]), "{channel}");
        }
        let less = read(TABLE, "leave_out = [\"r\"]\n[columns]\nu = { scale = 0.5 }\n").unwrap();
        assert!(!less.has(Channel::R) && less.get(Channel::U).unwrap()[0] == 0.5 * plain.get(Channel::U).unwrap()[0]);
        // A column that serves another channel, or has no fitting unit, is not taken for the channel of its name.
        let foreign = "t [s],n [rps],rudder [deg],delta [m],u [kn]\n0,1,3,0,9\n1,1,3,0,9\n2,1,3,0,9\n";
        let map =
            "[columns]\ndelta = \"rudder\"\nwind_speed = \"u\"\nwind_direction = { value = 0.0, unit = \"deg\" }\n";
        let r = read(foreign, map).unwrap();
        assert!(!r.has(Channel::U) && r.has(Channel::WindSpeed) && r.unused() == ["delta [m]"]);
    }

    #[test]
    fn what_a_map_blanks_is_missing() {
        let rows: String = (0..12).map(|i| format!("{i},{},1,0\n", if i % 4 == 3 { -9999.0 } else { 2.0 })).collect();
        let text = format!("t [s],u [kn],n [rps],delta [rad]\n{rows}");
        for map in [
            "blank = -9999",
            "[columns]\nu = { blank = [1e20, -9999] }",
            "[columns]\nu = { blank = { outside = [-40, 40] } }",
        ] {
            let r = read(&text, map).unwrap();
            let missing: Vec<usize> = (0..12).filter(|i| r.get(Channel::U).unwrap()[*i].is_nan()).collect();
            assert_eq!(missing, [3, 7, 11], "{map}");
        }
        let message = read(&text, "").unwrap_err().to_string();
        assert!(message.contains("run.csv:5: ") && message.contains("`blank = -9999`"), "{message}");
    }

    #[test]
    fn a_delay_of_a_channel_takes_it_back_to_when_it_happened() {
        let late = 3.0;
        let rows: String =
            (0..40).map(|i| format!("{i},{},1,{}\n", 0.1 * f64::from(i), 0.01 * (f64::from(i) - late))).collect();
        let text = format!("t [s],u [m/s],n [rps],delta [rad]\n{rows}");
        let r = read(&text, "[columns]\ndelta = { delay = 3.0 }\nu = { delay = -0.5 }\n").unwrap();
        let t = r.time();
        assert_eq!((t[0], t[t.len() - 1], r.line(0)), (1.0, 36.0, 3));
        for (row, t) in t.iter().enumerate() {
            let found = [Channel::Delta, Channel::U].map(|c| r.get(c).unwrap()[row]);
            assert!(
                (found[0] - 0.01 * t).abs() < 1e-12 && (found[1] - 0.1 * (t - 0.5)).abs() < 1e-12,
                "{t}: {found:?}"
            );
        }
        let message = read(&text, "[columns]\ndelta = { delay = 300.0 }\n").unwrap_err().to_string();
        assert!(message.contains("correct `delay`"), "{message}");
    }

    #[test]
    fn columns_can_be_counted_and_time_rebuilt() {
        let map = "delimiter = \"whitespace\"\nheader = false\ndt = 0.5\n[columns]\nt = { index = 1, unit = \"s\" }\n\
                   n = { index = 2, unit = \"rps\" }\ndelta = { index = 3, unit = \"rad\" }\n";
        let r = read("0.0  1 0.1\n 1.0 1 0.1\n1.0\t1 0.1\n", map).unwrap();
        assert_eq!(r.time(), [0.0, 0.5, 1.0]);
    }

    /// Reads a text as a file and as a text, which must be one recording, and gives it.
    fn both_ways(bytes: &[u8], map: &str) -> Recording {
        let map = ColumnMap::parse(map, Path::new("columns.toml")).unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        let from_file = Recording::read(file.path(), &map).unwrap();
        let from_text = Recording::parse(&String::from_utf8_lossy(bytes), file.path(), &map).unwrap();
        let bits = |r: &Recording| -> Vec<_> {
            r.channels().map(|(c, v)| (c, v.iter().map(|x| x.to_bits()).collect::<Vec<_>>())).collect()
        };
        assert_eq!(bits(&from_file), bits(&from_text));
        assert!((0..from_file.len()).all(|row| from_file.line(row) == from_text.line(row)));
        from_file
    }

    #[test]
    fn line_ends_a_byte_order_mark_and_a_missing_last_line_end_change_nothing() {
        let plain = both_ways(TABLE.as_bytes(), "");
        let windows = format!("\u{feff}{}", TABLE.replace('\n', "\r\n"));
        let cut = TABLE.trim_end().to_owned();
        for text in [windows, cut.clone(), format!("{cut}\r"), format!("\n\n{TABLE}\n\n")] {
            let r = both_ways(text.as_bytes(), "");
            assert!(plain.channels().eq(r.channels()), "{text:?}");
        }
        assert_eq!(both_ways(format!("\n\n{TABLE}").as_bytes(), "").line(0), 4);
    }

    #[test]
    fn a_quoted_field_may_contain_the_delimiter_and_blanks() {
        let text = "\"t [s]\",\"n [rps]\",delta [rad],\"remark, long\"\n\
                    0,\" 1 \",0.1,\"calm, clear\"\n1,1,\"0.2\",\"a \"\"turn\"\"\"\n2,1,0.3,\n";
        let r = both_ways(text.as_bytes(), "");
        assert_eq!(r.get(Channel::Delta).unwrap(), [0.1, 0.2, 0.3]);
        assert_eq!(r.unused(), ["remark, long"]);
        let map = "delimiter = \"semicolon\"\ndecimal = \"comma\"\n";
        let semicolons = "t [s];n [rps];delta [rad];remark\n0,0;1;\"0,1\";\"a;b\"\n0,5;1;0,2;\n";
        let r = both_ways(semicolons.as_bytes(), map);
        assert_eq!((r.time(), r.get(Channel::Delta).unwrap()), (&[0.0, 0.5][..], &[0.1, 0.2][..]));
    }

    #[test]
    fn a_file_wider_than_the_buffer_and_letters_of_another_encoding_are_read() {
        let columns = 20_000;
        let mut bytes = b"t [s],n [rps],delta [rad],rem\xe4rk".to_vec();
        (0..columns).for_each(|i| bytes.extend(format!(",channel {i}").bytes()));
        for row in 0..5 {
            bytes.extend(format!("\n{row},1,0.{row},\u{fc}").bytes());
            (0..columns).for_each(|i| bytes.extend(format!(",{i}.5").bytes()));
        }
        let r = both_ways(&bytes, "");
        assert_eq!((r.len(), r.unused().len(), r.line(4)), (5, columns + 1, 6));
        assert_eq!(r.get(Channel::Delta).unwrap(), [0.0, 0.1, 0.2, 0.3, 0.4]);
    }

    #[test]
    fn rows_that_are_blank_or_without_a_time_keep_their_lines() {
        let text = "t [s],n [rps],delta [rad]\n0,1,0\n\n1,1,0\n,,\n2,1,0\n,1,0\n3,1,0\n,,\n,,\n";
        let r = both_ways(text.as_bytes(), "");
        assert_eq!((0..r.len()).map(|row| r.line(row)).collect::<Vec<_>>(), [2, 4, 6, 8]);
        assert_eq!(r.without_time(), [(5, 5), (7, 7), (9, 10)]);
        // A line that starts with another sign is no comment: it is reported, with its line.
        let message = read("t [s],n [rps],delta [rad]\n# calm\n0,1,0\n", "").unwrap_err().to_string();
        assert!(message.starts_with("run.csv:2: "), "{message}");
        let message = read("t [s],n [rps],delta [rad]\n0,1,0\n1,1,0,7\n", "").unwrap_err().to_string();
        assert!(message.starts_with("run.csv:3: "), "{message}");
    }

    #[test]
    fn written_recordings_are_read_back_bit_for_bit() {
        let r = read(TABLE, "").unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        r.write(file.path()).unwrap();
        let again = Recording::read(file.path(), &ColumnMap::default()).unwrap();
        for (channel, values) in r.channels() {
            assert_eq!(Some(values), again.get(channel), "{channel}");
        }
    }
}
