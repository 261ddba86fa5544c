//! Files and parts of files that record the same quantity over the same time: recordings of their own, or refused, never sorted together.
//! Parts that complete one another, such as positions in one file and rudder angles in another, share a clock.

use super::columns::actuators::by_names;
use super::columns::choose::Choices;
use super::error::{ImportError, flag};
use super::formats::clock::written;
use super::formats::passes::FEW;
use super::signals::log::{Clock, Column, Log, Meaning};
use crate::recording::Channel;
use std::collections::BTreeSet;

/// Recordings of the same time are put further apart than all of them last, by this many seconds: longer than any gap that a session has.
const APART: f64 = 1e7;
/// Times closer than this are one \[s\].
const SAME_TIME: f64 = 1e-6;

/// First and last time of a file.
pub fn range(log: &Log) -> [f64; 2] {
    let times = || log.columns.iter().flat_map(|c| c.t.iter().copied());
    [times().fold(f64::MAX, f64::min), times().fold(f64::MIN, f64::max)]
}

/// What is to be added to the times of each file \[s\]: those that record the same over the same time are recordings of their own.
///
/// # Errors
/// [`ImportError::Choice`] for files whose clocks cannot be compared, and for parts of a recording that overlap.
pub fn shifts(logs: &[Log], choices: &Choices) -> Result<Vec<f64>, ImportError> {
    let clocks: BTreeSet<u8> = logs.iter().map(|log| log.clock as u8).collect();
    if clocks.len() > 1 {
        let list: Vec<String> = logs.iter().map(|log| format!("{}: {}", log.path.display(), log.format)).collect();
        return Err(ImportError::Choice(format!(
            "the files count time from different starts, so that they cannot be joined: {}. Import them apart",
            list.join("; ")
        )));
    }
    let ranges: Vec<[f64; 2]> = logs.iter().map(range).collect();
    let lasts = ranges.iter().fold(f64::MIN, |m, r| m.max(r[1])) - ranges.iter().fold(f64::MAX, |m, r| m.min(r[0]));
    // The parts of one file need no other.
    let one_file = logs.windows(2).all(|pair| pair[0].path == pair[1].path);
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut shifts = Vec::with_capacity(logs.len());
    for (j, log) in logs.iter().enumerate() {
        let against = |i: &usize| {
            let apart = ranges[*i][0] > ranges[j][1] || ranges[j][0] > ranges[*i][1];
            if apart { None } else { repeated(&logs[*i], log, choices).map(|column| (*i, column)) }
        };
        let mut at = groups.len();
        for (g, group) in groups.iter().enumerate() {
            let Some((i, column)) = group.iter().find_map(against) else {
                at = g;
                break;
            };
            if !(one_file || is_whole(&logs[i], choices) && is_whole(log, choices)) {
                let lacking = lacks(&logs[i], choices).or_else(|| lacks(log, choices));
                return Err(refusal(&logs[i], log, column, ranges[i][0].max(ranges[j][0]), lacking));
            }
        }
        if at == groups.len() {
            groups.push(Vec::new());
        }
        groups[at].push(j);
        shifts.push(at as f64 * (lasts + APART));
    }
    Ok(shifts)
}

/// A column of the second that the first has too over the same time, with other values.
fn repeated<'a>(first: &Log, second: &'a Log, choices: &Choices) -> Option<&'a str> {
    let known = second.columns.iter().filter(|column| choices.meaning(column).is_some());
    let mut both = known.filter_map(|c| Some((first.columns.iter().find(|other| other.name == c.name)?, c)));
    // Runs that count from a start of their own may be alike to the last digit.
    let copies_join = second.clock == Clock::Utc;
    both.find(|(a, b)| tell_otherwise(a, b, copies_join)).map(|(_, b)| b.name.as_str())
}

/// Whether two columns both have samples in a common time, and not the same ones where copies join.
fn tell_otherwise(a: &Column, b: &Column, copies_join: bool) -> bool {
    let ends = |c: &Column| c.t.iter().fold([f64::MAX, f64::MIN], |[l, h], t| [l.min(*t), h.max(*t)]);
    let ([a0, a1], [b0, b1]) = (ends(a), ends(b));
    let (from, to) = (a0.max(b0) - SAME_TIME, a1.min(b1) + SAME_TIME);
    let inside = |c: &Column| {
        let mut samples: Vec<[f64; 2]> = c.t.iter().zip(&c.v).map(|(t, v)| [*t, *v]).collect();
        samples.retain(|s| (from..=to).contains(&s[0]));
        samples.sort_by(|a, b| a[0].total_cmp(&b[0]));
        samples
    };
    let (a, b) = (inside(a), inside(b));
    let same = |[t, v]: &[f64; 2]| {
        let at = a.partition_point(|s| s[0] < t - SAME_TIME);
        a.get(at).is_some_and(|s| (s[0] - t).abs() <= SAME_TIME && s[1] == *v)
    };
    a.len() >= FEW && b.len() >= FEW && !(copies_join && b.iter().all(same))
}

/// Whether a file has what a recording of this craft needs, by itself: the heading, and every input.
fn is_whole(log: &Log, choices: &Choices) -> bool {
    lacks(log, choices).is_none()
}

/// The first channel that a file lacks to be a recording of this craft by itself.
fn lacks(log: &Log, choices: &Choices) -> Option<Channel> {
    let driven = &choices.driven;
    let names: Vec<(&str, Option<&str>)> = log.columns.iter().map(|c| (c.name.as_str(), c.unit.as_deref())).collect();
    let of_actuators = by_names(&names, &driven.commands);
    let has = |channel: Channel| {
        of_actuators.values().any(|c| *c == channel)
            || log.columns.iter().any(|c| choices.meaning(c) == Some(Meaning::Channel(channel)))
    };
    (!has(Channel::Psi)).then_some(Channel::Psi).or_else(|| driven.missing(has).next())
}

/// Steps of the zones of the world \[s\], and the largest difference of two of them.
const ZONES: f64 = 900.0;
const FARTHEST: f64 = 26.0 * 3600.0;

/// What to do about files that record parts of one voyage and have no time in common; `None` where all of them have some.
pub fn apart(logs: &[Log]) -> Option<String> {
    let ranges: Vec<[f64; 2]> = logs.iter().map(range).collect();
    let pairs = (0..logs.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let disjoint = |(i, j): &(usize, usize)| ranges[*i][0] > ranges[*j][1] || ranges[*j][0] > ranges[*i][1];
    let (i, j) = pairs.filter(|(i, j)| logs[*i].path != logs[*j].path).find(disjoint)?;
    let (first, later) = if ranges[i][0] < ranges[j][0] { (i, j) } else { (j, i) };
    let time = |t: f64| if logs[i].clock == Clock::Utc { written(t) } else { format!("{t:.0} s") };
    let [a, b] = [first, later].map(|k| {
        let [from, to] = ranges[k].map(time);
        format!("{} ({from} to {to})", logs[k].path.display())
    });
    let by = ranges[later][0] - ranges[first][0];
    let hours = (by / ZONES).round() * ZONES / 3600.0;
    let zone = (logs[i].clock == Clock::Utc && (by - 3600.0 * hours).abs() < 60.0 && by < FARTHEST).then(|| {
        let (whole, minutes) = (hours.trunc(), (60.0 * hours.fract()).round());
        let zone = if minutes == 0.0 { format!("UTC+{whole}") } else { format!("UTC+{whole}:{minutes:02}") };
        format!(
            "if the clock of {} shows a local time, write its zone into the name of its time, as in `Time ({zone})`; otherwise ",
            logs[later].path.display()
        )
    });
    Some(format!(
        "{a} and {b} have no time in common, and none is a recording by itself: the second begins {by:.0} s after the first; {}correct the times of one of them, or import each with the files of its own time",
        zone.unwrap_or_default()
    ))
}

fn refusal(first: &Log, second: &Log, column: &str, from: f64, lacking: Option<Channel>) -> ImportError {
    let [a, b] = [first, second].map(|log| log.path.display());
    let from = if first.clock == Clock::Utc { written(from) } else { format!("{from:.0} s") };
    let what = if first.path == second.path {
        format!("{a} has `{column}` twice over the same time, from {from} on, since its clock steps back")
    } else {
        format!("{a} and {b} both have `{column}` over the same time, from {from} on, and not the same")
    };
    let reason = lacking.map_or(String::new(), |c| {
        format!(
            "; neither is a recording by itself, since no column is the {} (name it with `{}` where one is)",
            c.info().words,
            flag(c)
        )
    });
    ImportError::Choice(format!(
        "{what}{reason}; nothing says which one belongs to the other files: take the column out of one of them, or import each recording with its own files"
    ))
}
