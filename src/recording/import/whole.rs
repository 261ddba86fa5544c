//! The import of files as a whole: read, choose, decide units, make rows, cut into recordings.
//! It writes nothing: the files of a study are made from its result in `study`.

use super::columns::choose::{Choice, Choices, Chosen, Unused, choose};
use super::columns::names::{meaning, words};
use super::columns::take::{Signals, Taken, take};
use super::error::{ImportError, flag};
use super::formats::clock::{THIS_CENTURY, written};
use super::formats::nmea::UNUSED;
use super::formats::read::read;
use super::overlap::{apart, range, shifts};
use super::rows::{Rows, rows};
use super::signals::fills::take_out;
use super::signals::held::release;
use super::signals::log::{Clock, Log, Meaning, needed};
use super::signals::signal::Signal;
use crate::numerals::sig;
use crate::recording::wrap::repair;
use crate::recording::{Channel, Driven, Quantity};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// How files are imported.
#[derive(Clone, Debug, Default)]
pub struct ImportSettings {
    /// What the user says of the columns.
    pub choices: Choices,
    /// A longer gap ends a recording and a session \[s\]; [`SESSION_GAP`] when not given.
    pub session_gap: Option<f64>,
}

/// A longer gap ends a recording: after so long wind, current and loading may be others \[s\].
pub const SESSION_GAP: f64 = 1800.0;

/// Rows that a recording has at least.
const FEWEST: usize = 10;
/// A channel that no simulation needs is left out where it is missing in more than this share of the rows.
const MOSTLY: f64 = 0.02;

/// A recording made from the files.
#[derive(Clone, Debug)]
pub struct ImportedRecording {
    /// Name, fit for a file.
    pub name: String,
    /// When it began, where the date is known.
    pub start: Option<String>,
    /// The same on the clock of the files \[s\].
    pub clock_start: f64,
    /// Its rows; times from its start, or those of its file where that has a clock of its own.
    pub rows: Rows,
}

/// What was imported.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The files: path and what each is.
    pub files: Vec<(PathBuf, String)>,
    /// What each column was taken for.
    pub taken: Vec<Taken>,
    /// Columns that are not used.
    pub unused: Vec<Unused>,
    /// Notes on the import.
    pub notes: Vec<String>,
    /// Latitude and longitude of the point from which positions count \[deg\].
    pub origin: Option<[f64; 2]>,
    /// Where u and v are from.
    pub velocity: Velocity,
    /// Channels that the column map derives.
    pub derive: Vec<&'static str>,
    /// Channels that are written and not used, for want of values.
    pub leave_out: Vec<Channel>,
    /// Longest drop-out that the column map bridges \[s\].
    pub bridge: Option<f64>,
    /// The recordings, in order of time.
    pub recordings: Vec<ImportedRecording>,
}

/// Reads files of any known format and makes recordings of them.
///
/// # Errors
/// [`ImportError`]: a file that cannot be read, and everything that the files do not say.
pub fn import(files: &[PathBuf], settings: &ImportSettings) -> Result<Imported, ImportError> {
    let settings = ImportSettings { choices: settings.choices.read_names(), ..settings.clone() };
    settings.choices.check()?;
    imported(files, &settings)
}

/// As [`import`], with the names of columns as they are read.
fn imported(files: &[PathBuf], settings: &ImportSettings) -> Result<Imported, ImportError> {
    let mut logs: Vec<Log> = Vec::new();
    for file in files {
        logs.extend(read(file, &settings.choices)?);
    }
    for log in &mut logs {
        blank_fills(log, &settings.choices);
        release(log, |column| settings.choices.meaning(column));
    }
    refuse_texts(&logs, &settings.choices)?;
    let shifts = shifts(&logs, &settings.choices).map_err(|error| with_texts(error, &logs))?;
    for (log, shift) in logs.iter_mut().zip(&shifts) {
        log.columns.iter_mut().for_each(|c| c.t.iter_mut().for_each(|t| *t += shift));
    }
    let Choice { chosen, unused, asked, decided } = choose(&logs, &settings.choices)?;
    let driven = &settings.choices.driven;
    let taken = with_questions(take(&chosen, &settings.choices), asked);
    let taken = taken.map_err(|error| with_inputs(error, &chosen, &logs, driven));
    let mut signals = taken.map_err(|error| with_texts(error, &logs))?;
    signals.notes.splice(0..0, pitches(&unused, &logs));
    signals.unused.extend(unused);
    for (meaning, words) in decided {
        let of = |taken: &&mut Taken| taken.quantity == meaning.name();
        signals.taken.iter_mut().filter(of).for_each(|taken| taken.evidence += &format!("; {words}"));
    }
    missing(&chosen, &signals, &logs, driven).map_err(|error| with_texts(error, &logs))?;
    mend_heading(&mut signals);
    let (table, filled) = rows(&signals);
    let step = table.step;
    let longest = settings.session_gap.unwrap_or(SESSION_GAP);
    let ends: Vec<[f64; 2]> = logs.iter().map(range).collect();
    let starts: Vec<f64> = ends.iter().map(|e| e[0]).collect();
    let (mut notes, mut recordings) = (filled, Vec::new());
    for part in table.cut(longest, &starts) {
        let (Some(first), Some(last)) = (part.t.first().copied(), part.t.last().copied()) else { continue };
        if part.t.len() < FEWEST {
            notes.push(format!(
                "{} rows between longer gaps are too few for a recording and are left out",
                part.t.len()
            ));
            continue;
        }
        let own = ends.iter().position(|e| e[0] <= first + 1e-6 && last <= e[1] + 1e-6);
        let within = own.or_else(|| ends.iter().position(|e| (e[0]..=e[1]).contains(&first)));
        let shift = within.map_or(0.0, |i| shifts[i]);
        recordings.push(recording(part, own.map(|i| &logs[i]), shift, &logs));
    }
    together(&recordings, &logs, driven, step)?;
    name_apart(&mut recordings);
    for log in &logs {
        notes.extend(log.notes.iter().map(|note| format!("{}: {note}", log.path.display())));
    }
    // Notes on turned axes come first.
    signals.notes.append(&mut notes);
    let mut notes = std::mem::take(&mut signals.notes);
    notes.extend(warnings(&signals, &recordings));
    let (derive, velocity) = derived(&signals, &recordings);
    let mut read: Vec<(PathBuf, String)> = logs.iter().map(|log| (log.path.clone(), log.format.clone())).collect();
    read.dedup();
    let mut imported = Imported {
        files: read,
        taken: signals.taken,
        unused: signals.unused,
        notes,
        origin: signals.origin,
        velocity,
        derive,
        leave_out: Vec::new(),
        bridge: None,
        recordings,
    };
    imported.blank_impossible();
    imported.part_with_lonely();
    imported.tell_gaps();
    Ok(imported)
}

/// A pitch that changes by more than this share of its most is set.
const PITCHED: f64 = 0.05;

/// The warning about columns of a controllable pitch: a model that knows the rate alone is driven by half of what drives the ship.
fn pitches(unused: &[Unused], logs: &[Log]) -> Vec<String> {
    let of_propeller = |name: &str| {
        let parts = words(name);
        let any = |list: &[&str]| parts.iter().any(|p| list.contains(&p.as_str()));
        any(&["pitch", "cpp"])
            && any(&["propeller", "prop", "cpp", "cp", "blade", "shaft"])
            && !any(&["order", "setpoint"])
    };
    let range = |name: &str| {
        let values = || logs.iter().flat_map(|log| &log.columns).filter(|c| c.name == name).flat_map(|c| &c.v);
        values().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)])
    };
    let named = unused.iter().map(|u| u.column.as_str()).filter(|name| of_propeller(name));
    let varied = named.map(|name| (name, range(name))).filter(|(_, [low, high])| high - low > PITCHED * high.max(-low));
    let warn = |(name, [low, high]): (&str, [f64; 2])| {
        format!(
            "WARNING: column `{name}` goes from {} to {}: a controllable pitch, by which the thrust changes while n does not. No term knows it: keep to runs of one pitch, or write a column of rate times pitch over its most and take that with `--column n=NAME`",
            sig(low, 3),
            sig(high, 3)
        )
    };
    varied.map(warn).collect()
}

/// What is said of a log without a position, and of dates that are none of a log.
fn warnings(signals: &Signals, recordings: &[ImportedRecording]) -> Vec<String> {
    let far = recordings.iter().find(|r| r.start.is_some() && r.clock_start >= THIS_CENTURY.end);
    let far = far.map(|r| {
        format!(
            "WARNING: the times begin at {}: they count from another start than 1970, or in another unit (`--unit t=`), and dates and sessions are wrong",
            written(r.clock_start)
        )
    });
    let nowhere = !signals.by.contains_key(&Meaning::Channel(Channel::X));
    let nowhere = nowhere.then(|| {
        "no column is taken for a position: if one is, name it with `--column lat=NAME --column lon=NAME` or `--column x=NAME --column y=NAME`".to_owned()
    });
    nowhere.into_iter().chain(far).collect()
}

/// No manoeuvre is seen in rows so far apart \[s\].
const SLOW: f64 = 300.0;

/// Refuses files of which no recording comes that has position or velocity, heading and every input: with steps too long for one, the unit of the time is
/// another, and where files have no time in common, their clocks differ.
fn together(recordings: &[ImportedRecording], logs: &[Log], driven: &Driven, step: f64) -> Result<(), ImportError> {
    let is_whole = |recording: &ImportedRecording| {
        let has = |channel| recording.rows.channels.iter().any(|(c, _)| *c == channel);
        let moves = has(Channel::X) || has(Channel::U);
        moves && has(Channel::Psi) && driven.missing(has).next().is_none()
    };
    let own = logs.iter().all(|log| log.clock == Clock::Own);
    if recordings.iter().any(is_whole) && !(own && step > SLOW) {
        return Ok(());
    }
    let fail = |message| {
        let path = logs.first().map_or_else(PathBuf::new, |log| log.path.clone());
        Err(ImportError::File { path, message })
    };
    if step > SLOW {
        let finer = Quantity::Time.units().filter(|unit| unit.factor < 1.0 && unit.factor * step <= 0.2 * SLOW);
        let mut flags = finer.map(|unit| {
            format!(
                "if it counts {}, so that they are {} s apart, pass `--unit t={}`",
                unit.plural(),
                sig(unit.factor * step, 3),
                unit.spellings[0]
            )
        });
        let flag = flags.next().filter(|_| own).unwrap_or_else(|| "rows a few seconds apart are needed".to_owned());
        return fail(format!(
            "the rows are {} s apart as their time is read, too far to show a manoeuvre: {flag}",
            sig(step, 3)
        ));
    }
    match apart(logs) {
        Some(text) => Err(ImportError::Choice(text)),
        None if recordings.is_empty() => fail("position and heading are never recorded together for ten rows: drop-outs of one end where those of the other begin; leave one of the columns out, or correct the times".to_owned()),
        None => Ok(()),
    }
}

/// Puts a heading that a logger interpolated across north on the short way round, before velocities are turned by it.
fn mend_heading(signals: &mut Signals) {
    let heading = Meaning::Channel(Channel::Psi);
    let Some(mut psi) = signals.by.remove(&heading) else { return };
    let (rate, course) = (signals.by.get(&Meaning::Channel(Channel::R)), signals.by.get(&Meaning::Course));
    // How far the yaw rate says that the ship turned meanwhile, or the course that counts turns.
    let turned = |t: &[f64]| {
        let (from, to) = (*t.first()?, *t.last()?);
        let by_course = |course: &Signal| course.at(to, course.step) - course.at(from, course.step);
        let by_rate = |r: &Signal| t.windows(2).map(|t| r.at(0.5 * (t[0] + t[1]), r.step) * (t[1] - t[0])).sum::<f64>();
        let known = [rate.map(by_rate), course.map(by_course)];
        known.into_iter().flatten().find(|turned| turned.is_finite())
    };
    let Signal { t, v, .. } = &mut psi;
    let mended = repair(t, v, |from, to| turned(&t[from..=to]));
    signals.by.insert(heading, psi);
    if mended > 0 {
        signals.notes.push(format!(
            "heading: {mended} values lie on the wrong way round between two true ones, as where a logger interpolates across north; \
             they are put on the short way"
        ));
    }
}

/// Takes the numbers that stand for missing values out of a log, and notes them.
fn blank_fills(log: &mut Log, choices: &Choices) {
    for column in &mut log.columns {
        for (fill, count) in take_out(column, choices.meaning(column)) {
            let name = &column.name;
            let why = if fill == 0.0 { "between values that do not change" } else { "far from all other values" };
            log.notes.push(format!("column `{name}` contains {fill} in {count} lines, {why}; taken as missing"));
        }
    }
}

/// Refuses a column that the user names and that is one of text.
fn refuse_texts(logs: &[Log], choices: &Choices) -> Result<(), ImportError> {
    for (quantity, column) in choices.columns.iter().filter(|(quantity, _)| Meaning::from_name(quantity).is_some()) {
        let has_numbers = logs.iter().flat_map(|log| &log.columns).any(|c| c.name.eq_ignore_ascii_case(column));
        let text = logs.iter().flat_map(|log| &log.texts).find(|(name, _)| name.eq_ignore_ascii_case(column));
        if let Some((_, words)) = text.filter(|_| !has_numbers) {
            return Err(ImportError::Choice(format!("--column {quantity}={column}: {words}; write numbers there")));
        }
    }
    Ok(())
}

/// What files lack or contradict, after the columns of text whose names are those of what every study needs: they may be the reason.
fn with_texts(error: ImportError, logs: &[Log]) -> ImportError {
    let mut texts: BTreeMap<&str, &str> = BTreeMap::new();
    for (name, words) in logs.iter().flat_map(|log| &log.texts).filter(|(name, _)| meaning(name).is_some_and(needed)) {
        texts.entry(name).or_insert(words);
    }
    let unused = texts.into_values().map(|words| format!("{words}, and is not used"));
    match error {
        ImportError::Undecided(asked) => ImportError::Undecided(unused.chain(asked).collect()),
        ImportError::Choice(words) => ImportError::Choice(unused.chain([words]).collect::<Vec<_>>().join("; ")),
        error => error,
    }
}

/// The signals, or what is asked of units that are not known with what is asked besides.
fn with_questions(taken: Result<Signals, ImportError>, mut asked: Vec<String>) -> Result<Signals, ImportError> {
    if asked.is_empty() {
        return taken;
    }
    match taken {
        Ok(_) => Err(ImportError::Undecided(asked)),
        Err(ImportError::Undecided(more)) => {
            let flag = |question: &str| {
                question.split_once("`--unit ").and_then(|(_, s)| Some(s.split_once('=')?.0.to_owned()))
            };
            let of_units: Vec<Option<String>> = asked.iter().map(|question| flag(question)).collect();
            asked.extend(more.into_iter().filter(|question| !of_units.contains(&flag(question))));
            Err(ImportError::Undecided(asked))
        }
        Err(error) => Err(error),
    }
}

/// A question for a column that is not there.
fn question(words: &str, flags: &str) -> String {
    format!("no column is {words}: name it with `{flags}`")
}

/// The questions for the inputs of the craft that are not there, the rudder first.
fn inputs_missing(has: impl Fn(Channel) -> bool, driven: &Driven) -> Vec<String> {
    let mut inputs: Vec<Channel> = driven.missing(has).collect();
    inputs.sort_by_key(|c| *c != Channel::Delta);
    inputs.into_iter().map(|c| question(&format!("the {}", c.info().words), &flag(c))).collect()
}

/// The columns that a question for one can be answered with.
fn numbers(logs: &[Log]) -> String {
    let mut names: Vec<&str> = logs.iter().flat_map(|log| log.columns.iter().map(|c| c.name.as_str())).collect();
    names.sort_unstable();
    names.dedup();
    let unread: Vec<&str> =
        logs.iter().flat_map(|log| &log.notes).filter(|n| n.starts_with(UNUSED)).map(String::as_str).collect();
    let list = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    let more =
        unread.iter().map(|note| format!("; {note}: what these alone give must be written as columns of a CSV file"));
    format!("the columns with numbers are: {list}{}", more.collect::<String>())
}

/// What is asked of columns that are there, with the questions for inputs that are not, so that one answer is enough.
fn with_inputs(error: ImportError, chosen: &Chosen<'_>, logs: &[Log], driven: &Driven) -> ImportError {
    let ImportError::Undecided(mut asked) = error else { return error };
    let lacking = inputs_missing(|channel| chosen.contains_key(&Meaning::Channel(channel)), driven);
    if !lacking.is_empty() {
        asked.extend(lacking);
        asked.push(numbers(logs));
    }
    ImportError::Undecided(asked)
}

/// Refuses files that lack what every study needs, with one message for everything.
fn missing(chosen: &Chosen<'_>, signals: &Signals, logs: &[Log], driven: &Driven) -> Result<(), ImportError> {
    let has = |channel| signals.by.contains_key(&Meaning::Channel(channel));
    let taken = |meaning: &Meaning| chosen.contains_key(meaning);
    let mut asked = inputs_missing(has, driven);
    let mut ask = |words: &str, flags: &str| asked.push(question(words, flags));
    if !has(Channel::Psi) {
        ask("the heading", "--column psi=NAME");
    }
    let moves = (has(Channel::X) && has(Channel::Y))
        || (has(Channel::U) && has(Channel::V))
        || (taken(&Meaning::Course) && taken(&Meaning::GroundSpeed))
        || (taken(&Meaning::VelocityNorth) && taken(&Meaning::VelocityEast));
    if !moves {
        let flags = "--column lat=NAME --column lon=NAME`, `--column x=NAME --column y=NAME` (north and east) or `--column cog=NAME --column sog=NAME";
        ask("position or velocity", flags);
    }
    if asked.is_empty() {
        return Ok(());
    }
    asked.push(numbers(logs));
    Err(ImportError::Undecided(asked))
}

/// A recording with its name and times; `shift` was added to the times of its files.
fn recording(mut rows: Rows, own: Option<&Log>, shift: f64, logs: &[Log]) -> ImportedRecording {
    let first = rows.t.first().copied().unwrap_or(0.0) - shift;
    let clock = logs.first().map_or(Clock::Own, |log| log.clock);
    let start = (clock == Clock::Utc).then(|| written(first));
    let zero = if clock == Clock::Own { shift } else { first + shift };
    rows.t.iter_mut().for_each(|t| *t = ((*t - zero) * 1e6).round() / 1e6);
    let stem = own.and_then(|log| log.path.file_stem().map(|s| s.to_string_lossy().into_owned()));
    let dated = start.as_ref().map(|s| s.replace(' ', "_").replace(':', ""));
    let one_file = logs.windows(2).all(|pair| pair[0].path == pair[1].path);
    let name = match (one_file, stem, dated) {
        (true, _, Some(dated)) | (_, None, Some(dated)) => dated,
        (_, Some(stem), _) => stem,
        _ => "recording".to_owned(),
    };
    let fit = |c: char| if c.is_ascii_alphanumeric() || "-_".contains(c) { c } else { '_' };
    ImportedRecording { name: name.chars().map(fit).collect(), start, clock_start: first, rows }
}

/// Numbers names that are there twice.
fn name_apart(recordings: &mut [ImportedRecording]) {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for recording in recordings.iter_mut() {
        let count = seen.entry(recording.name.clone()).or_default();
        *count += 1;
        if *count > 1 {
            recording.name = format!("{}_part{count}", recording.name);
        }
    }
}

/// Where u and v are from.
#[derive(Clone, Copy, Debug)]
pub struct Velocity {
    /// In words.
    pub words: &'static str,
    /// Whether they were made with the recorded heading, so that its error is in them.
    pub by_heading: bool,
}

/// Which channels are to be derived, and where the velocity is from.
fn derived(signals: &Signals, recordings: &[ImportedRecording]) -> (Vec<&'static str>, Velocity) {
    let has = |channel| recordings.iter().all(|r| r.rows.channels.iter().any(|(c, _)| *c == channel));
    let turned = |words| Velocity { words, by_heading: true };
    let mut derive = Vec::new();
    let velocity = if has(Channel::U) && has(Channel::V) {
        let own = signals.by.contains_key(&Meaning::Channel(Channel::U));
        let parts = signals.by.contains_key(&Meaning::VelocityNorth);
        match (own, parts) {
            (true, _) => Velocity { words: "u and v are the recorded ones", by_heading: false },
            (_, true) => turned("u and v are the velocities to the north and east, turned by the heading"),
            _ => turned("u = SOG cos(COG - heading), v = SOG sin(COG - heading): over ground, at the antenna"),
        }
    } else {
        derive.extend(["u", "v"]);
        turned("u and v are derived from position and heading: over ground, at the antenna")
    };
    if !has(Channel::R) {
        derive.push("r");
    }
    (derive, velocity)
}

impl Imported {
    /// The session of each recording: those that follow one another without a long gap share one. With a date it is called by it.
    pub fn sessions(&self, session_gap: Option<f64>) -> Vec<String> {
        let longest = session_gap.unwrap_or(SESSION_GAP);
        let mut groups: Vec<usize> = Vec::new();
        let mut last: Option<f64> = None;
        for recording in &self.recordings {
            let group = groups.last().copied().unwrap_or(0);
            let (begin, end) = (recording.clock_start, recording.clock_start + recording.rows.duration());
            // Without a date nothing says that days differ.
            let another = recording.start.is_some() && last.is_some_and(|last| begin - last > longest);
            groups.push(group + usize::from(another));
            last = Some(end);
        }
        let date = |i: usize| self.recordings[i].start.as_ref().and_then(|s| s.get(..10)).unwrap_or("").to_owned();
        let dates: Vec<String> = (0..groups.len())
            .map(|i| groups.iter().position(|g| *g == groups[i]).map_or_else(String::new, date))
            .collect();
        let name = |i: usize| {
            let mut same: Vec<usize> =
                groups.iter().zip(&dates).filter(|(_, d)| **d == dates[i]).map(|(g, _)| *g).collect();
            same.dedup();
            match (dates[i].as_str(), same.len(), same.iter().position(|g| *g == groups[i])) {
                ("", ..) => format!("session {}", groups[i] + 1),
                (date, 1, _) => date.to_owned(),
                (date, _, at) => format!("{date} part {}", at.unwrap_or(0) + 1),
            }
        };
        (0..groups.len()).map(name).collect()
    }

    fn blank_impossible(&mut self) {
        let mut found: BTreeMap<Channel, (usize, f64)> = BTreeMap::new();
        for recording in &mut self.recordings {
            for (channel, count, value) in recording.rows.blank_impossible() {
                found.entry(channel).or_insert((0, value)).0 += count;
            }
        }
        for (channel, (count, value)) in found {
            let (words, si) = (channel.info().words, channel.info().quantity.si());
            self.notes.push(format!(
                "{words}: {count} values no ship reaches, such as {value:.4} {si}, are taken as missing"
            ));
        }
    }

    /// Leaves out channels that no simulation needs and that are mostly missing, or lack their partner.
    fn part_with_lonely(&mut self) {
        use Channel::*;
        let pairs = [
            [WindSpeed, WindDirection],
            [ApparentWindSpeed, ApparentWindDirection],
            [CurrentSpeed, CurrentDirection],
            [WaveHeight, WaveDirection],
            [X, Y],
        ];
        let core = [T, X, Y, Psi, U, V, R, N, Delta];
        let all: BTreeSet<Channel> =
            self.recordings.iter().flat_map(|r| r.rows.channels.iter().map(|(c, _)| *c)).collect();
        for channel in all.iter().copied() {
            let of = |r: &ImportedRecording, c: Channel| {
                r.rows.channels.iter().find(|(other, _)| *other == c).map(|(_, v)| v.clone())
            };
            let partner = pairs.iter().find(|p| p.contains(&channel)).map(|[a, b]| if *a == channel { *b } else { *a });
            let lonely =
                partner.is_some_and(|p| self.recordings.iter().any(|r| of(r, channel).is_some() != of(r, p).is_some()));
            let (mut rows, mut absent) = (0, 0);
            for r in &self.recordings {
                let own = of(r, channel);
                for i in 0..r.rows.t.len() {
                    let complete =
                        r.rows.channels.iter().filter(|(c, _)| core.contains(c)).all(|(_, v)| v[i].is_finite());
                    rows += usize::from(complete);
                    absent += usize::from(complete && own.as_ref().is_none_or(|v| !v[i].is_finite()));
                }
            }
            let sparse = !core.contains(&channel) && channel.interrupts() && absent as f64 > MOSTLY * rows as f64;
            if lonely {
                self.recordings.iter_mut().for_each(|r| r.rows.channels.retain(|(c, _)| *c != channel));
                let partner = partner.map_or("", Channel::name);
                self.notes.push(format!("{channel} is left out: without {partner} it says nothing"));
            } else if sparse && !self.leave_out.contains(&channel) {
                // The other half of a pair says nothing by itself.
                let other = partner.filter(|p| all.contains(p) && !core.contains(p));
                self.leave_out.extend([Some(channel), other].into_iter().flatten());
                let channel = other.map_or(channel.to_string(), |other| format!("{channel}, and with it {other},"));
                self.notes.push(format!(
                    "{channel} is in the recordings and not used: it is missing in {absent} of {rows} rows, each of which would end a run (`leave_out` in columns.toml)"
                ));
            }
        }
    }

    fn tell_gaps(&mut self) {
        let mut notes = Vec::new();
        for recording in &self.recordings {
            let rows = &recording.rows;
            let gaps: Vec<f64> = rows.t.windows(2).map(|t| t[1] - t[0]).filter(|g| *g > 1.5 * rows.step).collect();
            let longest = gaps.iter().copied().fold(0.0, f64::max);
            if !gaps.is_empty() {
                notes.push(format!(
                    "{}: gaps in time: {}, the longest {longest:.1} s; none is filled",
                    recording.name,
                    gaps.len()
                ));
            }
            let absent = rows.channels.iter().filter(|(c, _)| !self.leave_out.contains(c));
            let absent = absent.map(|(c, v)| (c, v.iter().filter(|v| !v.is_finite()).count())).filter(|(_, n)| *n > 0);
            let list: Vec<String> = absent.map(|(c, n)| format!("{c} {n}")).collect();
            if !list.is_empty() {
                let (name, of) = (&recording.name, rows.t.len());
                notes.push(format!("{name}: missing values in its {of} rows: {}; none is filled", list.join(", ")));
            }
        }
        self.notes.extend(notes);
    }
}
