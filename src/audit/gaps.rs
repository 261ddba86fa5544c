//! Gaps: missing values, rows without time, uneven steps, columns that are not used, channels that are derived or bridged.
//! It asks only what is there; whether what is there can be true is asked by the other files.

use super::issue::{Issue, Severity};
use crate::error::suggestion;
use crate::recording::{CHANNELS, Channel, Recording, STATE_CHANNELS};

/// Everything that is not there, or not as one would expect it.
pub fn completeness(recording: &Recording, issues: &mut Vec<Issue>) {
    dropouts(recording, issues);
    time(recording, issues);
    columns(recording, issues);
    channels(recording, issues);
}

/// Rows in which a channel has no value.
fn dropouts(recording: &Recording, issues: &mut Vec<Issue>) {
    for rows in recording.dropouts() {
        let missing = recording.missing_in(rows.clone());
        let names = missing.iter().map(|c| c.name()).collect::<Vec<_>>().join(", ");
        let text = format!("{names}: no value in {} rows", rows.len());
        let next = "with `gaps = \"split\"` the study cuts the run here; `bridge` in a column map fills short ones";
        let lines = (recording.line(rows.start), recording.line(rows.end - 1));
        let issue = Issue::new(Severity::Warning, "missing", text, next).at(lines);
        issues.push(if let [one] = missing[..] { issue.of(one) } else { issue });
    }
}

/// Jumps in time, rows without one, and uneven steps.
fn time(recording: &Recording, issues: &mut Vec<Issue>) {
    let step = recording.step();
    for &row in &recording.gaps() {
        let gap = recording.time()[row] - recording.time()[row - 1];
        let text = format!("{gap:.3} s without a row, where the step is {step:.3} s");
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

/// Columns that became no channel.
fn columns(recording: &Recording, issues: &mut Vec<Issue>) {
    for column in recording.unused() {
        let name = column.split(['[', '(']).next().unwrap_or_default().trim();
        let absent = CHANNELS.iter().filter(|c| !recording.has(c.channel)).map(|c| c.name);
        let near = if name.len() > 2 { suggestion(name, absent) } else { String::new() };
        let severity = if near.is_empty() { Severity::Note } else { Severity::Warning };
        let text = format!("column `{column}` is not used{near}");
        issues.push(Issue::new(severity, "unused", text, "rename it or name it in a column map, if it should be"));
    }
}

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
    for channel in STATE_CHANNELS.into_iter().filter(|c| !recording.has(*c)) {
        let text = format!("{} was not recorded", channel.info().words);
        note("not_recorded", channel, text, "the cost carries no weight for it");
    }
}
