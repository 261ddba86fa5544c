//! Gaps: missing values, rows without time, uneven steps, columns that are not used, channels that are derived or bridged.
//! It checks only what is there; whether that can be true is checked in the other files.

use crate::files::suggestion;
use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::{CHANNELS, Channel, Recording, STATE_CHANNELS};
use std::ops::Range;

/// Everything that is not there, or not as one would expect it.
pub fn completeness(recording: &Recording, issues: &mut Vec<Issue>) {
    dropouts(recording, issues);
    time(recording, issues);
    columns(recording, issues);
    channels(recording, issues);
}

/// Rows in which a channel has no value, reported once for each set of channels that is missing together.
fn dropouts(recording: &Recording, issues: &mut Vec<Issue>) {
    let mut sets: Vec<(Vec<Channel>, Vec<Range<usize>>)> = Vec::new();
    for rows in recording.dropouts() {
        let missing = recording.missing_in(rows.clone());
        match sets.iter_mut().find(|(channels, _)| *channels == missing) {
            Some((_, all)) => all.push(rows),
            None => sets.push((missing, vec![rows])),
        }
    }
    for (missing, all) in sets {
        let Some(first) = all.first() else { continue };
        let names = missing.iter().map(|c| c.name()).collect::<Vec<_>>().join(", ");
        let rows: usize = all.iter().map(Range::len).sum();
        let places = if all.len() == 1 { String::new() } else { format!(" in {} places, the first here", all.len()) };
        let text = format!("{names}: no value in {rows} rows{places}");
        let next = "with `gaps = \"split\"` the study cuts the run here; `bridge` in a column map fills short ones";
        let lines = (recording.line(first.start), recording.line(first.end - 1));
        let issue = Issue::new(Severity::Warning, "missing", text, next).at(lines);
        issues.push(if let [one] = missing[..] { issue.of(one) } else { issue });
    }
}

/// Jumps in time, rows without one, and uneven steps.
fn time(recording: &Recording, issues: &mut Vec<Issue>) {
    let step = recording.step();
    let gaps = recording.gaps();
    if let Some(&row) = gaps.first() {
        let gap = |row: usize| recording.time()[row] - recording.time()[row - 1];
        let longest = gaps.iter().map(|row| gap(*row)).fold(0.0, f64::max);
        let more =
            if gaps.len() == 1 { String::new() } else { format!(" in {} places, up to {longest:.3} s", gaps.len()) };
        let text = format!("{:.3} s without a row, where the step is {step:.3} s{more}", gap(row));
        let lines = (recording.line(row - 1), recording.line(row));
        let next = "with `gaps = \"split\"` the study cuts the run here";
        issues.push(Issue::new(Severity::Warning, "gap", text, next).of(Channel::T).at(lines));
    }
    for &(first, last) in recording.without_time() {
        let rows = last - first + 1;
        let after_the_end = first > recording.line(recording.len() - 1);
        let (severity, text, next) = if after_the_end {
            let text = format!("the last {rows} rows are blank and are left out");
            (Severity::Note, text, "nothing, unless the run should be longer")
        } else {
            (
                Severity::Warning,
                format!("{rows} rows have no time and are left out"),
                "remove them, or restore their time",
            )
        };
        issues.push(Issue::new(severity, "no_time", text, next).of(Channel::T).at((first, last)));
    }
    let uneven = recording
        .time()
        .windows(2)
        .map(|t| t[1] - t[0])
        .filter(|s| *s <= 1.5 * step && (s - step).abs() > 0.1 * step)
        .count();
    if uneven > 0 {
        let text = format!("{uneven} steps differ from the usual {step:.4} s by more than a tenth");
        let next = "the grid is interpolated; nothing to do if the times are right";
        issues.push(Issue::new(Severity::Note, "uneven", text, next).of(Channel::T));
    }
}

/// Names of columns that contain geographic positions.
const GEOGRAPHIC: [&str; 6] = ["lat", "latitude", "lon", "long", "lng", "longitude"];

/// Name of a column, without its unit.
fn name(column: &str) -> &str {
    column.split(['[', '(']).next().unwrap_or_default().trim()
}

/// Whether a column contains geographic positions, by its name.
fn is_geographic(column: &str) -> bool {
    GEOGRAPHIC.contains(&name(column).to_lowercase().as_str())
}

/// Columns that became no channel: those that may have been meant for an absent one, each; the others in one note.
fn columns(recording: &Recording, issues: &mut Vec<Issue>) {
    let (geographic, unused): (Vec<&String>, Vec<&String>) =
        recording.unused().iter().partition(|column| is_geographic(column));
    if let (Some(first), false) = (geographic.first(), recording.has(Channel::X)) {
        let more = geographic.get(1).map_or(String::new(), |second| format!(" and `{second}`"));
        let text = format!("the positions of columns `{first}`{more} are not used, and x and y are missing");
        let next = "`trimtab import` makes a study with x and y of them; or give x = 111120 (lat - lat0) and y = 111120 cos(lat0) (lon - lon0), degrees to m: `x = { column = \"lat\", unit = \"m\", scale = 111120, offset = ... }` in a column map";
        issues.push(Issue::new(Severity::Warning, "not_used", text, next).of(Channel::X));
    }
    let mut others = Vec::new();
    for column in unused {
        let absent = CHANNELS.iter().filter(|c| !recording.has(c.channel)).map(|c| c.name);
        let name = name(column).to_lowercase();
        // A column of a channel's own name is left out by the column map.
        if CHANNELS.iter().any(|c| c.name == name) {
            continue;
        }
        let near = if name.len() > 2 { suggestion(&name, absent) } else { String::new() };
        if near.is_empty() {
            others.push(format!("`{column}`"));
            continue;
        }
        let text = format!("column `{column}` is not used{near}");
        let next = "rename it or name it in a column map, if it should be";
        issues.push(Issue::new(Severity::Warning, "unused", text, next));
    }
    if !others.is_empty() {
        let text = match &others[..] {
            [one] => format!("column {one} is not used"),
            all if all.len() <= NAMED => format!("{} columns are not used: {}", all.len(), all.join(", ")),
            all => format!("{} columns are not used: {}, ...", all.len(), all[..NAMED].join(", ")),
        };
        issues.push(Issue::new(Severity::Note, "unused", text, "name those in a column map that should be"));
    }
}

/// Most columns that a note names.
const NAMED: usize = 5;

/// Channels whose values were bridged or derived, and those of the state that are not there.
fn channels(recording: &Recording, issues: &mut Vec<Issue>) {
    let mut note = |fault, channel, text: String, next: &str| {
        issues.push(Issue::new(Severity::Note, fault, text, next).of(channel));
    };
    for (channel, rows) in recording.bridged() {
        let text = format!("{rows} missing values were bridged by straight lines");
        note("bridged", *channel, text, "as the column map asks; shorten `bridge` for less");
    }
    for channel in recording.derived() {
        let text = "derived from other channels, not recorded".to_owned();
        note("derived", *channel, text, "its agreement with them proves nothing");
    }
    if recording.repaired() > 0 {
        let text = format!("{} headings interpolated across north were put right", recording.repaired());
        note("repaired", Channel::Psi, text, "as `wrap_repair` in the column map asks");
    }
    for channel in STATE_CHANNELS.into_iter().filter(|c| !recording.has(*c)) {
        let text = format!("{} was not recorded", channel.info().words);
        let meant = recording.unused().iter().find(|c| Channel::meant_by(name(c)) == Some(channel));
        let geographic = recording.unused().iter().any(|c| is_geographic(c));
        let next = match (meant, channel) {
            (Some(column), _) => format!(
                "column `{column}` looks like {channel}: name its column in a column map, `{channel} = {{ column = \"{}\", unit = ... }}` under `[columns]`",
                name(column)
            ),
            (None, Channel::X | Channel::Y) if geographic => {
                "`trimtab import` makes a study with x and y of latitude and longitude".into()
            }
            (None, Channel::U | Channel::V | Channel::R) => {
                "the cost carries no weight for it: `derive` in a column map takes it from the others".into()
            }
            (None, _) => "the cost carries no weight for it: name its column in a column map, if there is one".into(),
        };
        issues.push(Issue::new(Severity::Warning, "not_recorded", text, next).of(channel));
    }
}
