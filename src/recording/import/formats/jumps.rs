//! A clock that was put forward or back while the ship sailed on: whole hours without the way that belongs to them.
//! Gaps in which the ship may have sailed stay gaps. A clock that steps back by less than half a day begins another recording, as one that
//! starts again does: which of its two passes is right nobody knows.

use crate::recording::Quantity;
use crate::recording::import::columns::choose::Choices;
use crate::recording::import::columns::names::{meaning, source};
use crate::recording::import::signals::log::{Column, Meaning};
use crate::recording::import::signals::place::places;
use crate::recording::import::signals::signal::median;

/// Seconds of an hour.
const HOUR: f64 = 3600.0;
/// Hours by which a clock without AM and PM steps back.
const HALF_A_DAY: f64 = 12.0;
/// Usual steps by which a jump may differ from whole hours: a line or two may be missing where a clock is set.
const SLACK: f64 = 3.0;
/// The same in seconds, at most: nobody sets a clock in half a minute.
const MOST_SLACK: f64 = 30.0;
/// Fixes before and after a jump from which the speed is taken.
const AROUND: usize = 20;
/// The ship sails no more than this many times the way of its speed in a step, and this many metres by the error of a fix.
const FARTHER: f64 = 3.0;
const FIX: f64 = 20.0;
/// The way that the jump would take at that speed is this many times as long: otherwise nothing shows that it was not sailed.
const CLEARLY: f64 = 10.0;

/// A change of the clock.
pub struct Change {
    /// The first row after it.
    pub row: usize,
    /// Hours by which the clock went forward.
    pub hours: f64,
    /// What the ship sailed meanwhile \[m\].
    pub metres: f64,
}

/// Takes the changes of a clock out of the times of rows, so that they go on as at first.
pub fn mend(t: &mut [f64], columns: &[(Column, Vec<f64>)], choices: &Choices) -> Vec<Change> {
    let found = track(columns, choices).map_or_else(Vec::new, |track| changes(t, &track));
    let mut ahead = 0.0;
    for (i, change) in found.iter().enumerate() {
        ahead += HOUR * change.hours;
        let until = found.get(i + 1).map_or(t.len(), |next| next.row);
        t[change.row..until].iter_mut().for_each(|t| *t -= ahead);
    }
    found
}

/// Row and place \[m\] of each fix.
fn track(columns: &[(Column, Vec<f64>)], choices: &Choices) -> Option<Vec<(usize, [f64; 2])>> {
    let of = |wanted: Meaning| {
        let named = choices.columns.get(wanted.name());
        let is = move |c: &Column| match named {
            Some(name) => c.name.eq_ignore_ascii_case(name),
            None => meaning(&c.name) == Some(wanted),
        };
        let moves = |values: &[f64]| values.iter().any(|v| v.is_finite() && *v != values[0]);
        columns.iter().filter(move |(c, values)| is(c) && moves(values))
    };
    let mut pairs = of(Meaning::Latitude)
        .filter_map(|lat| Some((lat, of(Meaning::Longitude).find(|lon| source(&lon.0.name) == source(&lat.0.name))?)));
    let (lat, lon) = pairs.next()?;
    // Rows stand for times.
    let by_row = |(column, values): &(Column, Vec<f64>)| {
        let mut rows = Column { name: column.name.clone(), ..Column::default() };
        values.iter().enumerate().for_each(|(row, v)| rows.push(row as f64, *v));
        rows
    };
    let unit = |name: &str, c: &Column| Quantity::Angle.factor(choices.units.get(name).or(c.unit.as_ref())?);
    let units = [unit("lat", &lat.0), unit("lon", &lon.0)];
    let found = places(&[&by_row(lat)], &[&by_row(lon)], units).ok()??;
    Some(found.x.t.iter().zip(found.x.v.iter().zip(&found.y.v)).map(|(t, (x, y))| (*t as usize, [*x, *y])).collect())
}

fn changes(t: &[f64], track: &[(usize, [f64; 2])]) -> Vec<Change> {
    let step = median(t.windows(2).map(|t| t[1] - t[0]).filter(|s| *s > 0.0).collect()).unwrap_or(0.0);
    let metres = |a: usize, b: usize| (track[b].1[0] - track[a].1[0]).hypot(track[b].1[1] - track[a].1[1]);
    let last = track.len().saturating_sub(1);
    let speed = |a: usize, b: usize| metres(a, b) / (step * (track[b].0 - track[a].0).max(1) as f64);
    let mut found = Vec::new();
    for i in 1..track.len() {
        let (before, row) = (track[i - 1].0, track[i].0);
        let rows = (row - before) as f64 * step;
        let off = t[row] - t[before] - rows;
        let hours = (off / HOUR).round();
        let slack = (SLACK * step).min(MOST_SLACK) + 1.0;
        if hours == 0.0
            || (hours < 0.0 && hours > -HALF_A_DAY)
            || !off.is_finite()
            || (off - HOUR * hours).abs() > slack
        {
            continue;
        }
        let around = [speed(i.saturating_sub(AROUND + 1), i - 1), speed(i, (i + AROUND).min(last))];
        let [slow, fast] = [around[0].min(around[1]), around[0].max(around[1])];
        let most = FARTHER * fast * (rows + slack) + FIX;
        if metres(i - 1, i) <= most && slow * HOUR * hours.abs() > CLEARLY * most {
            found.push(Change { row, hours, metres: metres(i - 1, i) });
        }
    }
    found
}

/// The note on changes of a clock; `line` is the line of a row.
pub fn words(changes: &[Change], line: impl Fn(usize) -> usize) -> String {
    let each = changes.iter().map(|change| {
        let (hours, way) = (change.hours.abs(), if change.hours > 0.0 { "forward" } else { "back" });
        format!("{hours} h {way} at line {} while the ship sails {:.0} m", line(change.row), change.metres)
    });
    let twelve = changes.iter().any(|change| change.hours.abs() == HALF_A_DAY);
    let why = if twelve {
        "a clock of 12 hours without AM and PM, of which the first lines are taken for the half of the day that they say; if they are of the other, all times are 12 h off"
    } else {
        "summer time, or a clock that was set; if the first lines are those that are wrong, all times are off by as much"
    };
    format!(
        "its clock goes {}: {why}. The times after it go on from those before",
        each.collect::<Vec<_>>().join(", and ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hours of the clock taken out of a track of 200 rows a second apart, whose clock is `off` more from row 100 on, at a speed \[m/s\].
    fn taken_out(off: f64, speed: f64, sailed: f64) -> Vec<f64> {
        let t: Vec<f64> = (0..200).map(|i| f64::from(i) + if i < 100 { 0.0 } else { off }).collect();
        let place = |i: usize| speed * i as f64 + if i < 100 { 0.0 } else { sailed };
        let track: Vec<(usize, [f64; 2])> = (0..200).map(|i| (i, [place(i), 0.0])).collect();
        changes(&t, &track).iter().map(|change| change.hours).collect()
    }

    #[test]
    fn whole_hours_without_way_are_a_change_of_the_clock_and_hours_with_it_are_a_gap() {
        assert_eq!(taken_out(3600.0, 5.0, 0.0), [1.0]);
        assert!(taken_out(-3600.0, 5.0, 0.0).is_empty());
        assert_eq!(taken_out(-43_198.0, 5.0, 10.0), [-12.0]);
        // A gap in which it sailed, one that is no whole hour, and one at anchor.
        assert!(taken_out(3600.0, 5.0, 18_000.0).is_empty());
        assert!(taken_out(2000.0, 5.0, 0.0).is_empty());
        assert!(taken_out(3600.0, 0.01, 0.0).is_empty());
    }
}
