//! Reads logs of NMEA 0183 sentences: position, course and speed, heading, rate of turn, rudder, propeller, water speed, wind, depth.
//! Checksums are verified; lines that fail are counted and reported, and makers' own sentences are not read.

use super::clock::{DAY, DateOrder, date_time, digits_of_day, past_midnight};
use super::layout::decoded;
use super::passes::{FEW, passes, stepped_back};
use crate::recording::Channel;
use crate::recording::import::error::ImportError;
use crate::recording::import::signals::log::{Clock, Column, Log, Meaning};
use crate::recording::import::signals::signal::median;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// What sentences give: name, meaning, unit; of two for one quantity the first is taken.
const VALUES: &[(&str, Option<Meaning>, &str)] = &[
    ("RMC latitude", Some(Meaning::Latitude), "deg"),
    ("RMC longitude", Some(Meaning::Longitude), "deg"),
    ("GGA latitude", Some(Meaning::Latitude), "deg"),
    ("GGA longitude", Some(Meaning::Longitude), "deg"),
    ("GLL latitude", Some(Meaning::Latitude), "deg"),
    ("GLL longitude", Some(Meaning::Longitude), "deg"),
    ("RMC course", Some(Meaning::Course), "deg"),
    ("RMC speed", Some(Meaning::GroundSpeed), "kn"),
    ("VTG course", Some(Meaning::Course), "deg"),
    ("VTG speed", Some(Meaning::GroundSpeed), "kn"),
    ("HDT heading", Some(Meaning::Channel(Channel::Psi)), "deg"),
    ("HDG heading with variation", Some(Meaning::Channel(Channel::Psi)), "deg"),
    ("VHW heading", Some(Meaning::Channel(Channel::Psi)), "deg"),
    ("HDG magnetic heading", Some(Meaning::Channel(Channel::Psi)), "deg"),
    ("HDM magnetic heading", Some(Meaning::Channel(Channel::Psi)), "deg"),
    ("RMC variation", Some(Meaning::Variation), "deg"),
    ("ROT", Some(Meaning::Channel(Channel::R)), "deg/min"),
    ("RSA rudder", Some(Meaning::Channel(Channel::Delta)), "deg"),
    ("RSA port rudder", Some(Meaning::Channel(Channel::Delta)), "deg"),
    ("RPM shaft 0", Some(Meaning::Channel(Channel::N)), "rpm"),
    ("RPM shaft 1", Some(Meaning::Channel(Channel::N)), "rpm"),
    ("RPM shaft 2", Some(Meaning::Channel(Channel::N)), "rpm"),
    ("RPM engine 0", Some(Meaning::Channel(Channel::N)), "rpm"),
    ("RPM engine 1", Some(Meaning::Channel(Channel::N)), "rpm"),
    ("RPM engine 2", Some(Meaning::Channel(Channel::N)), "rpm"),
    (PITCH, None, "%"),
    ("VBW water speed ahead", Some(Meaning::Channel(Channel::UWater)), "kn"),
    ("VBW water speed across", Some(Meaning::Channel(Channel::VWater)), "kn"),
    ("VHW water speed", Some(Meaning::Channel(Channel::UWater)), "kn"),
    ("VBW ground speed ahead", None, "kn"),
    ("VBW ground speed across", None, "kn"),
    ("MWV apparent wind speed", Some(Meaning::Channel(Channel::ApparentWindSpeed)), "m/s"),
    ("MWV apparent wind angle", Some(Meaning::Channel(Channel::ApparentWindDirection)), "deg"),
    ("VWR apparent wind speed", Some(Meaning::Channel(Channel::ApparentWindSpeed)), "m/s"),
    ("VWR apparent wind angle", Some(Meaning::Channel(Channel::ApparentWindDirection)), "deg"),
    ("MWD wind speed", Some(Meaning::Channel(Channel::WindSpeed)), "m/s"),
    ("MWD wind direction", Some(Meaning::Channel(Channel::WindDirection)), "deg"),
    ("MWV theoretical wind speed", Some(Meaning::Channel(Channel::WindSpeed)), "m/s"),
    ("MWV theoretical wind angle", Some(Meaning::WindAngle), "deg"),
    ("DPT depth from the surface", Some(Meaning::Channel(Channel::Depth)), "m"),
    ("DPT depth below the transducer", None, "m"),
];

/// What is noted of kinds of sentences that are not read.
pub const UNUSED: &str = "sentences that are not used";
/// The pitch of a propeller, in per cent of its most.
const PITCH: &str = "RPM propeller pitch";

/// A sentence that passed its check.
struct Sentence<'a> {
    /// Whose it is, such as `GP`.
    talker: &'a str,
    /// Such as `RMC`; the whole address of a maker's own sentence, such as `PSXN`.
    kind: &'a str,
    fields: Vec<&'a str>,
    /// What is written before it on the line.
    before: &'a str,
}

impl Sentence<'_> {
    fn text(&self, i: usize) -> &str {
        self.fields.get(i).map_or("", |f| f.trim())
    }

    fn number(&self, i: usize) -> Option<f64> {
        self.text(i).parse().ok().filter(|v: &f64| v.is_finite())
    }

    /// A number with the letter that gives its sign: `5412.34,N`.
    fn signed(&self, i: usize, negative: &str) -> Option<f64> {
        let sign = if self.text(i + 1).eq_ignore_ascii_case(negative) { -1.0 } else { 1.0 };
        self.number(i).map(|v| sign * v)
    }

    /// Degrees and minutes with the letter of the hemisphere.
    fn place(&self, i: usize, negative: &str) -> Option<f64> {
        crate::recording::import::signals::geodesy::from_minutes(self.signed(i, negative)?)
    }

    /// Whether the status at a field is not `V`, which says that the data are not valid.
    fn valid(&self, i: usize) -> bool {
        !self.text(i).eq_ignore_ascii_case("V")
    }
}

/// Which of the values a sentence gives, and whose it is: two compasses that both send HDT are two.
type Kind = (usize, String);

/// A sentence as values and times.
#[derive(Default)]
struct Record {
    /// Whose it is.
    talker: String,
    /// Time that a logger wrote before it \[s since 1970\].
    stamp: Option<f64>,
    /// Time of day that it gives \[s\].
    time: Option<f64>,
    /// Midnight of the date that it gives \[s since 1970\].
    date: Option<f64>,
    /// Which of the values, and how much.
    values: Vec<(usize, f64)>,
}

/// Why a line gives nothing.
enum Bad {
    Checksum,
    /// It has no checksum, and all others do.
    Cut,
    Broken,
}

/// Whether most lines of a text are sentences.
pub fn is_nmea(bytes: &[u8]) -> bool {
    let text = decoded(&bytes[..bytes.len().min(20_000)]);
    let lines: Vec<&str> = text.lines().filter(|l| !l.trim().is_empty()).take(100).collect();
    let like = lines.iter().filter(|l| framed(l).is_some_and(|(_, s)| s.len() > 6)).count();
    like > 0 && 2 * like >= lines.len()
}

/// What is before a sentence on a line, and the sentence without `$`. A maker's own begins with `P` and has any length of address.
fn framed(line: &str) -> Option<(&str, &str)> {
    let at = line.find(['$', '!'])?;
    let sentence = line.get(at + 1..)?.trim_end();
    let address = sentence.split([',', '*']).next()?;
    let named = address.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit());
    let fits = match address.len() {
        5 => true,
        length => is_makers(address) && (3..=10).contains(&length),
    };
    (named && fits && address.len() < sentence.len()).then_some((&line[..at], sentence))
}

/// Whether the address of a sentence is that of a maker's own.
fn is_makers(address: &str) -> bool {
    address.starts_with('P')
}

/// Share of the sentences with a checksum from which one without is cut.
const CHECKED: f64 = 0.95;

/// Whether the sentences of a text have checksums: nearly all of them do.
fn has_checksums(text: &str) -> bool {
    let (mut all, mut checked) = (0, 0);
    for (_, sentence) in text.lines().filter_map(framed) {
        all += 1;
        checked += usize::from(sentence.contains('*'));
    }
    checked > 0 && checked as f64 >= CHECKED * f64::from(all)
}

/// A line as a sentence, which has a checksum where those of its file do; `None` for a line without one.
fn sentence(line: &str, checked: bool) -> Option<Result<Sentence<'_>, Bad>> {
    let Some((before, text)) = framed(line) else {
        return line.contains(['$', '!']).then_some(Err(Bad::Broken));
    };
    let body = match text.split_once('*') {
        Some((body, sum)) => {
            let computed = body.bytes().fold(0_u8, |sum, b| sum ^ b);
            let written = sum.get(..2).and_then(|s| u8::from_str_radix(s, 16).ok());
            if written != Some(computed) {
                return Some(Err(Bad::Checksum));
            }
            body
        }
        None if checked => return Some(Err(Bad::Cut)),
        None => text,
    };
    let mut fields = body.split(',');
    let address = fields.next().unwrap_or("");
    let (talker, kind) = if is_makers(address) { ("P", address) } else { address.split_at(2.min(address.len())) };
    Some(Ok(Sentence { talker, kind, fields: fields.collect(), before }))
}

/// Hours, minutes and seconds in one number: `101530.25`.
fn time_of_day(text: &str) -> Option<f64> {
    digits_of_day(text.parse().ok()?)
}

/// Midnight of a date \[s since 1970\].
fn midnight(year: &str, month: &str, day: &str) -> Option<f64> {
    date_time(&format!("{year:0>4}-{month:0>2}-{day:0>2} 00:00:00"), DateOrder::DayFirst)
}

/// The time that a logger wrote before a sentence: ISO 8601, an epoch, or a tag block with `c:`.
fn stamp(before: &str) -> Option<f64> {
    let text = before.trim().trim_matches(|c: char| "[](),;|\"".contains(c) || c.is_whitespace());
    let epoch = |text: &str| {
        let value: f64 = text.parse().ok()?;
        let ms = value > 1e11;
        (value > 1e8).then_some(if ms { value * 1e-3 } else { value })
    };
    if let Some(tag) = text.strip_prefix('\\') {
        let fields = tag.split(['*', '\\']).next()?;
        return fields.split(',').find_map(|f| epoch(f.strip_prefix("c:")?));
    }
    epoch(text).or_else(|| date_time(text, DateOrder::DayFirst))
}

fn index(name: &str) -> Option<usize> {
    VALUES.iter().position(|(n, ..)| *n == name)
}

/// The values and times of a sentence.
fn record(s: &Sentence<'_>) -> Record {
    let mut record = Record { talker: s.talker.to_owned(), stamp: stamp(s.before), ..Record::default() };
    let mut put = |name: &str, value: Option<f64>| record.values.extend(index(name).zip(value));
    match s.kind {
        "RMC" => {
            if s.valid(1) {
                put("RMC latitude", s.place(2, "S"));
                put("RMC longitude", s.place(4, "W"));
                put("RMC speed", s.number(6));
                put("RMC course", s.number(7));
                put("RMC variation", s.signed(9, "W"));
            }
            record.time = time_of_day(s.text(0));
            if let Some([day, month, year]) =
                s.fields.get(8).and_then(|d| Some([d.get(..2)?, d.get(2..4)?, d.get(4..6)?]))
            {
                record.date = midnight(&format!("20{year}"), month, day);
            }
        }
        "GGA" => {
            if s.number(5).is_some_and(|quality| quality > 0.0) {
                put("GGA latitude", s.place(1, "S"));
                put("GGA longitude", s.place(3, "W"));
            }
            record.time = time_of_day(s.text(0));
        }
        "GLL" => {
            if s.valid(5) {
                put("GLL latitude", s.place(0, "S"));
                put("GLL longitude", s.place(2, "W"));
            }
            record.time = time_of_day(s.text(4));
        }
        "ZDA" => {
            record.time = time_of_day(s.text(0));
            record.date = midnight(s.text(3), s.text(2), s.text(1));
        }
        "VTG" if s.text(8) != "N" => {
            put("VTG course", s.number(0));
            put("VTG speed", s.number(4).or_else(|| s.number(6).map(|v| v / 1.852)));
        }
        "HDT" | "THS" => put("HDT heading", s.number(0).filter(|_| s.valid(1))),
        "HDG" => {
            let deviation = s.signed(1, "W").unwrap_or(0.0);
            let magnetic = s.number(0).map(|h| h + deviation);
            match s.signed(3, "W") {
                Some(variation) => put("HDG heading with variation", magnetic.map(|h| h + variation)),
                None => put("HDG magnetic heading", magnetic),
            }
        }
        "HDM" => put("HDM magnetic heading", s.number(0)),
        "ROT" => put("ROT", s.number(0).filter(|_| s.valid(1))),
        "RSA" => {
            put("RSA rudder", s.number(0).filter(|_| s.valid(1)));
            put("RSA port rudder", s.number(2).filter(|_| s.valid(3)));
        }
        "RPM" => {
            let source = if s.text(0).eq_ignore_ascii_case("E") { "engine" } else { "shaft" };
            put(&format!("RPM {source} {}", s.text(1)), s.number(2).filter(|_| s.valid(4)));
            put(PITCH, s.number(3).filter(|_| s.valid(4)));
        }
        _ => more(s, &mut record),
    }
    record
}

/// Sentences of water, wind and depth.
fn more(s: &Sentence<'_>, record: &mut Record) {
    let mut put = |name: &str, value: Option<f64>| record.values.extend(index(name).zip(value));
    match s.kind {
        "VHW" => {
            put("VHW heading", s.number(0));
            put("VHW water speed", s.number(4).or_else(|| s.number(6).map(|v| v / 1.852)));
        }
        "VBW" => {
            if s.valid(2) {
                put("VBW water speed ahead", s.number(0));
                put("VBW water speed across", s.number(1));
            }
            if s.valid(5) {
                put("VBW ground speed ahead", s.number(3));
                put("VBW ground speed across", s.number(4));
            }
        }
        "MWV" if s.valid(4) => {
            let factor = match s.text(3) {
                "N" => 1852.0 / 3600.0,
                "K" => 1.0 / 3.6,
                "S" => 0.44704,
                _ => 1.0,
            };
            let kind = if s.text(1).eq_ignore_ascii_case("T") { "theoretical" } else { "apparent" };
            put(&format!("MWV {kind} wind speed"), s.number(2).map(|v| v * factor));
            put(&format!("MWV {kind} wind angle"), s.number(0));
        }
        "MWD" => {
            put("MWD wind direction", s.number(0));
            put("MWD wind speed", s.number(6).or_else(|| s.number(4).map(|v| v * 1852.0 / 3600.0)));
        }
        "VWR" => {
            put("VWR apparent wind angle", s.signed(0, "L"));
            let knots = s.number(2).map(|v| v * 1852.0 / 3600.0);
            put("VWR apparent wind speed", s.number(4).or(knots).or_else(|| s.number(6).map(|v| v / 3.6)));
        }
        "DPT" => match s.number(1).filter(|offset| *offset > 0.0) {
            Some(offset) => put("DPT depth from the surface", s.number(0).map(|d| d + offset)),
            None => put("DPT depth below the transducer", s.number(0)),
        },
        _ => {}
    }
}

/// Reads a log of sentences.
///
/// # Errors
/// [`ImportError::File`] where no sentence gives a time.
pub fn read_nmea(path: &Path, bytes: &[u8]) -> Result<Vec<Log>, ImportError> {
    let text = decoded(bytes);
    let (mut records, mut unknown) = (Vec::new(), BTreeMap::<String, usize>::new());
    let (mut failed, mut cut, mut broken, mut unchecked, mut unsided) = (Vec::new(), Vec::new(), Vec::new(), 0, 0);
    let checked = has_checksums(&text);
    for (i, line) in text.lines().enumerate() {
        match sentence(line, checked) {
            Some(Ok(s)) => {
                unchecked += usize::from(framed(line).is_some_and(|(_, sentence)| !sentence.contains('*')));
                let record = record(&s);
                if record.values.is_empty() && record.time.is_none() && !KNOWN.contains(&s.kind) {
                    *unknown.entry(s.kind.to_owned()).or_default() += 1;
                } else if POSITIONS.contains(&s.kind) {
                    unsided += usize::from(record.values.iter().any(|(i, _)| *i < PLACES) && without_letters(&s));
                }
                records.push(record);
            }
            Some(Err(Bad::Checksum)) => failed.push(i + 1),
            Some(Err(Bad::Cut)) => cut.push(i + 1),
            Some(Err(Bad::Broken)) => broken.push(i + 1),
            None => {}
        }
    }
    let mut notes = Vec::new();
    let lost = [
        (&failed, "fail their checksum"),
        (&cut, "have no checksum where the others have one, so that they are cut,"),
        (&broken, "are broken"),
    ];
    for (lines, what) in lost {
        if let Some(first) = lines.first() {
            notes.push(format!("{} lines {what} and are left out, the first is line {first}", lines.len()));
        }
    }
    if unchecked > 0 {
        notes.push(format!("{unchecked} sentences have no checksum and are taken as they are"));
    }
    if unsided > 0 {
        notes.push(format!("{unsided} positions lack the letter N, S, E or W; they count as north and east"));
    }
    if !unknown.is_empty() {
        let own = |kind: &str| if is_makers(kind) { " (a maker's own)" } else { "" };
        let list: Vec<String> = unknown.iter().map(|(kind, count)| format!("{kind} {count}{}", own(kind))).collect();
        notes.push(format!("{UNUSED}: {}", list.join(", ")));
    }
    let (clock, times, how) = times(&records);
    if times.iter().flatten().count() < 2 {
        let message = "no sentence has a time; RMC, GGA or ZDA is needed, or a time before each sentence".to_owned();
        return Err(ImportError::File { path: path.to_owned(), message });
    }
    let untimed = records.iter().zip(&times).filter(|(r, t)| t.is_none() && !r.values.is_empty()).count();
    if untimed > 0 {
        notes.push(format!("{untimed} sentences come before the first time and are left out"));
    }
    let t: Vec<f64> = times.iter().map(|t| t.unwrap_or(f64::NAN)).collect();
    let passes = passes(&t, |before, after| repeat(&records[before], &records[after]));
    if let [_, second, ..] = passes.as_slice() {
        notes.push(stepped_back(passes.len(), &format!("sentence {}", second.start + 1)));
    }
    let format = format!("NMEA 0183; time is {how}");
    let log = |pass: Range<usize>| {
        let columns = columns(&records[pass.clone()], &times[pass]);
        let notes = std::mem::take(&mut notes);
        Log { path: path.to_owned(), format: format.clone(), clock, columns, texts: Vec::new(), notes }
    };
    Ok(passes.into_iter().map(log).collect())
}

/// Whether two stretches of sentences give the same quantity again.
fn repeat(before: &[Record], after: &[Record]) -> bool {
    let count = |records: &[Record], kind: &Kind| records.iter().filter(|r| kinds(r).any(|k| k == *kind)).count();
    let mut kinds_after: Vec<Kind> = after.iter().flat_map(kinds).collect();
    kinds_after.sort_unstable();
    kinds_after.dedup();
    let same = before.len() == after.len() && before.iter().zip(after).all(|(a, b)| a.values == b.values);
    !same && kinds_after.iter().any(|kind| count(before, kind) >= FEW && count(after, kind) >= FEW)
}

fn kinds(record: &Record) -> impl Iterator<Item = Kind> + '_ {
    record.values.iter().map(|(i, _)| (*i, record.talker.clone()))
}

/// The first of the values are those of positions.
const PLACES: usize = 6;
/// Sentences with a position.
const POSITIONS: [&str; 3] = ["RMC", "GGA", "GLL"];

/// Whether the position of a sentence lacks the letters of its hemispheres.
fn without_letters(s: &Sentence<'_>) -> bool {
    let first = match s.kind {
        "RMC" => 3,
        "GGA" => 2,
        _ => 1,
    };
    s.text(first).is_empty() || s.text(first + 2).is_empty()
}

/// Sentences that are read, also where they give no value at the moment.
const KNOWN: [&str; 18] = [
    "RMC", "GGA", "GLL", "ZDA", "VTG", "HDT", "THS", "HDG", "HDM", "ROT", "RSA", "RPM", "VHW", "VBW", "MWV", "MWD",
    "VWR", "DPT",
];

/// The columns: one for each value, or for each talker where several give it.
fn columns(records: &[Record], times: &[Option<f64>]) -> Vec<Column> {
    let mut found: BTreeMap<Kind, Column> = BTreeMap::new();
    for (record, t) in records.iter().zip(times) {
        for (i, value) in &record.values {
            let Some(t) = t else { continue };
            let column = found.entry((*i, record.talker.clone())).or_insert_with(|| {
                let (name, meaning, unit) = VALUES[*i];
                Column { name: name.to_owned(), unit: Some(unit.to_owned()), meaning, ..Column::default() }
            });
            column.push(*t, *value);
        }
    }
    found.retain(|_, column| !column.v.is_empty());
    let several: Vec<usize> =
        found.keys().zip(found.keys().skip(1)).filter(|(a, b)| a.0 == b.0).map(|(a, _)| a.0).collect();
    for ((i, talker), column) in &mut found {
        if several.contains(i) {
            column.name += &format!(" of {talker}");
        }
    }
    found.into_values().collect()
}

/// The time of each record, what it counts from, and how it was determined.
fn times(records: &[Record]) -> (Clock, Vec<Option<f64>>, &'static str) {
    let stamped = records.iter().filter(|r| r.stamp.is_some()).count();
    if 10 * stamped >= 9 * records.len().max(1) {
        return (Clock::Utc, records.iter().map(|r| r.stamp).collect(), "what the logger wrote before each sentence");
    }
    let dated = records.iter().find_map(|r| r.date);
    // Times of day, each with its day.
    let mut epochs: Vec<Option<f64>> = Vec::with_capacity(records.len());
    let (mut day, mut last) = (dated.unwrap_or(0.0), f64::NAN);
    for r in records {
        day = r.date.unwrap_or(day);
        if let Some(time) = r.time {
            let turned = r.date.is_none() && day + time < last - 0.5 * DAY;
            day += if turned { DAY } else { 0.0 };
            last = day + time;
        }
        epochs.push(r.time.map(|time| day + time));
    }
    let clock = if dated.is_some() { Clock::Utc } else { Clock::Day };
    if dated.is_none() {
        let mut all: Vec<f64> = epochs.iter().map(|e| e.unwrap_or(f64::NAN)).collect();
        past_midnight(&mut all);
        epochs = all.into_iter().map(|t| Some(t).filter(|t| t.is_finite())).collect();
    }
    (clock, within_epochs(records, &epochs), "that of RMC, GGA and ZDA; sentences without one follow the last")
}

/// A time between fixes that is longer than so many usual ones is a gap.
const GAP: f64 = 2.5;

/// The times of all records, given those of the records that have one. What comes several times between two of these is spread
/// evenly: headings ten times a second are a tenth of a second apart. Before a gap nothing says whether a sentence is of its beginning or of
/// its end, and none has a time but those that come all through it.
fn within_epochs(records: &[Record], epochs: &[Option<f64>]) -> Vec<Option<f64>> {
    let kind = |r: &Record| kinds(r).next();
    // How often each kind comes in an epoch.
    let mut counts: BTreeMap<Kind, Vec<f64>> = BTreeMap::new();
    let mut now: BTreeMap<Kind, usize> = BTreeMap::new();
    let (mut epoch, mut starts) = (None::<f64>, Vec::<f64>::new());
    let next = |epoch: Option<f64>, t: &Option<f64>| t.filter(|t| epoch.is_none_or(|e| (e - t).abs() > 1e-3));
    for (r, t) in records.iter().zip(epochs) {
        if let Some(t) = next(epoch, t) {
            for (kind, count) in std::mem::take(&mut now) {
                counts.entry(kind).or_default().push(count as f64);
            }
            epoch = Some(t);
            starts.push(t);
        }
        if let Some(kind) = kind(r) {
            *now.entry(kind).or_default() += 1;
        }
    }
    let steps: Vec<f64> = starts.windows(2).map(|s| s[1] - s[0]).filter(|s| *s > 0.0).collect();
    let step = median(steps).unwrap_or(0.0);
    let usual: BTreeMap<Kind, f64> = counts.into_iter().filter_map(|(k, c)| Some((k, median(c)?.max(1.0)))).collect();
    let mut times = Vec::with_capacity(records.len());
    let mut seen: BTreeMap<Kind, usize> = BTreeMap::new();
    // Kinds that go on through a gap after this epoch; `None` without a gap.
    let mut go_on: Option<Vec<Kind>> = None;
    let (mut epoch, mut of_epoch) = (None, 0);
    for (i, (r, t)) in records.iter().zip(epochs).enumerate() {
        if let Some(t) = next(epoch, t) {
            let lasts = starts.get(of_epoch + 1).map_or(0.0, |after| after - t);
            go_on = (lasts > GAP * step).then(|| {
                let mut counts: BTreeMap<Kind, f64> = BTreeMap::new();
                let until = |(_, other): &(&Record, &Option<f64>)| next(Some(t), other).is_none();
                for kind in records[i..].iter().zip(&epochs[i..]).take_while(until).filter_map(|(r, _)| kind(r)) {
                    *counts.entry(kind).or_default() += 1.0;
                }
                let fills = |kind: &Kind, count: f64| 2.0 * count * step / usual.get(kind).unwrap_or(&1.0) >= lasts;
                counts.into_iter().filter(|(kind, count)| fills(kind, *count)).map(|(kind, _)| kind).collect()
            });
            (epoch, of_epoch) = (Some(t), of_epoch + 1);
            seen.clear();
        }
        let before = kind(r).map_or(0, |k| {
            let count = seen.entry(k).or_default();
            *count += 1;
            *count - 1
        });
        let apart = kind(r).and_then(|k| usual.get(&k)).map_or(step, |usual| step / usual);
        let known = go_on.as_ref().is_none_or(|kinds| kind(r).is_some_and(|k| kinds.contains(&k)));
        times.push(if t.is_some() { *t } else { epoch.filter(|_| known).map(|e| e + before as f64 * apart) });
    }
    times
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Log {
        read_nmea(Path::new("log.nmea"), text.as_bytes()).unwrap().remove(0)
    }

    fn summed(body: &str) -> String {
        format!("${body}*{:02X}\n", body.bytes().fold(0_u8, |s, b| s ^ b))
    }

    fn value(log: &Log, name: &str) -> (f64, f64) {
        let column = log.columns.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("{name}"));
        (column.t[0], column.v[0])
    }

    #[test]
    fn every_sentence_is_read_with_its_unit_and_sign() {
        let bodies = [
            "GPZDA,100000.00,01,05,2024,00,00",
            "GPRMC,100000.00,A,5412.000,S,01030.000,W,10.0,090.0,010524,,,A",
            "GPGGA,100000.00,5412.000,N,01030.000,E,1,08,1.0,10,M,,M,,",
            "GPVTG,091.0,T,,M,10.5,N,,K,A",
            "HEHDT,271.5,T",
            "HCHDG,100.0,2.0,E,3.0,W",
            "TIROT,-12.0,A",
            "AGRSA,-5.0,A,,V",
            "IIRPM,S,1,120.0,,A",
            "VWVHW,,T,,M,9.5,N,,K",
            "VDVBW,9.4,-0.1,A,9.9,0.2,A",
            "WIMWV,045.0,R,20.0,N,A",
            "SDDPT,12.5,3.0",
        ];
        let text: String = bodies.iter().map(|b| summed(b)).collect();
        let log = read(&(text.clone() + &text.replace("100000", "100001")));
        let expected = [
            ("RMC latitude", -54.2),
            ("RMC longitude", -10.5),
            ("GGA latitude", 54.2),
            ("RMC speed", 10.0),
            ("VTG course", 91.0),
            ("HDT heading", 271.5),
            ("HDG heading with variation", 99.0),
            ("ROT", -12.0),
            ("RSA rudder", -5.0),
            ("RPM shaft 1", 120.0),
            ("VHW water speed", 9.5),
            ("VBW water speed across", -0.1),
            ("MWV apparent wind speed", 20.0 * 1852.0 / 3600.0),
            ("DPT depth from the surface", 15.5),
        ];
        for (name, v) in expected {
            let (t, found) = value(&log, name);
            assert!((found - v).abs() < 1e-9 && t == 1_714_557_600.0, "{name}: {found} at {t}");
        }
        assert!(log.columns.iter().all(|c| c.name != "RSA port rudder"));
    }

    #[test]
    fn sentences_that_fail_their_checksum_are_counted() {
        let good = summed("GPRMC,100000.00,A,5412.000,N,01030.000,E,10.0,090.0,010524,,,A");
        let later = summed("GPRMC,100001.00,A,5412.000,N,01030.000,E,10.0,090.0,010524,,,A");
        let log = read(&format!("{good}{}{later}$GARBAGE\n", good.replace("5412", "5413")));
        assert!(
            log.notes[0].starts_with("1 lines fail their checksum") && log.notes[0].ends_with("line 2"),
            "{:?}",
            log.notes
        );
        assert!(log.notes[1].contains("broken"), "{:?}", log.notes);
        assert_eq!(log.columns[0].v.len(), 2);
    }

    #[test]
    fn a_sentence_without_its_checksum_is_cut_where_the_others_have_one() {
        let second = |s: usize| {
            summed(&format!("GPRMC,1000{s:02}.00,A,5412.000,N,01030.000,E,10.0,090.0,010524,,,A"))
                + &summed("ERRPM,S,1,220.0,100,A")
        };
        let whole: String = (0..20).map(second).collect();
        let rates = |log: &Log| log.columns.iter().find(|c| c.name == "RPM shaft 1").unwrap().v.clone();
        // The checksum of a tag block is not that of the sentence behind it.
        for before in ["", "\\s:VDR01,c:1714557619*1A\\"] {
            let log = read(&format!("{whole}{before}$ERRPM,S,1,2\n"));
            assert_eq!(rates(&log), vec![220.0; 20], "{before}");
            assert!(log.notes[0].starts_with("1 lines have no checksum where the others have one"), "{:?}", log.notes);
        }
        let unsummed: String = whole.lines().map(|l| format!("{}\n", l.split('*').next().unwrap_or(l))).collect();
        let log = read(&unsummed);
        assert_eq!(rates(&log).len(), 20);
        assert!(log.notes[0].starts_with("40 sentences have no checksum and are taken"), "{:?}", log.notes);
    }

    #[test]
    fn a_sentence_at_a_gap_has_no_time_and_those_that_come_all_through_it_have() {
        let fix = |s: usize| summed(&format!("GPRMC,1000{s:02}.00,A,5412.000,N,01030.000,E,10.0,090.0,010524,,,A"));
        let headings = |from: usize, count: usize| -> String {
            (from..from + count).map(|i| summed(&format!("HEHDT,{i}.0,T"))).collect()
        };
        let until: String = (0..6).map(|s| fix(s) + &headings(5 * s, 5)).collect();
        let times = |text: String| -> Vec<f64> {
            let log = read(&text);
            let of_heading = log.columns.into_iter().find(|c| c.name == "HDT heading").unwrap();
            of_heading.t.iter().map(|t| t - of_heading.t[0]).collect()
        };
        // The first headings after the gap come before their fix.
        let parted = times(until.clone() + &fix(6) + &headings(200, 5) + &fix(50) + &headings(205, 5) + &fix(51));
        assert!(parted.len() == 35 && parted.iter().all(|t| *t < 6.0 || *t > 49.0), "{parted:?}");
        let lost_fixes = times(until + &fix(6) + &headings(30, 100) + &fix(26) + &headings(130, 5) + &fix(27));
        assert!(lost_fixes.len() == 135 && (lost_fixes[129] - 25.8).abs() < 0.01, "{lost_fixes:?}");
    }

    #[test]
    fn headings_between_two_fixes_are_spread_and_loggers_times_are_taken() {
        let mut text = String::new();
        for s in 0..4 {
            text += &summed(&format!("GPRMC,10000{s}.00,A,5412.000,N,01030.000,E,10.0,090.0,010524,,,A"));
            (0..5).for_each(|i| text += &summed(&format!("HEHDT,{}.0,T", 10 + i)));
        }
        let log = read(&text);
        let heading = log.columns.iter().find(|c| c.name == "HDT heading").unwrap();
        let steps: Vec<f64> = heading.t.windows(2).map(|t| t[1] - t[0]).collect();
        assert!(steps.iter().all(|s| (s - 0.2).abs() < 1e-6), "{steps:?}");
        let line = summed("HEHDT,10.0,T");
        let log = read(&format!("2024-05-01T10:00:00.5Z,{line}\\c:1714557601*00\\{line}[1714557602.25] {line}"));
        assert_eq!(log.columns[0].t, [1_714_557_600.5, 1_714_557_601.0, 1_714_557_602.25]);
    }
}
