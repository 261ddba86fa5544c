//! Fixes that a table repeats in every row until the next: a receiver of 1 Hz in a table of 10 Hz.
//! A repeated row is no sample. Whether a receiver failed, and so repeated its last fix, is judged elsewhere.

use super::log::{Column, Log, Meaning};
use crate::recording::Channel;

/// Share of the changes of another column that come with a new fix where it is of the same receiver.
const TOGETHER: f64 = 0.99;
/// Changes of a column from which on this can be seen.
const CHANGES: usize = 10;

/// The columns of a position.
const POSITIONS: [[Meaning; 2]; 2] =
    [[Meaning::Latitude, Meaning::Longitude], [Meaning::Channel(Channel::X), Meaning::Channel(Channel::Y)]];

/// Leaves one row of each fix that is repeated, in the columns of its receiver, and notes it. `meaning` says what a column is.
pub fn release(log: &mut Log, meaning: impl Fn(&Column) -> Option<Meaning>) {
    let meanings: Vec<Option<Meaning>> = log.columns.iter().map(meaning).collect();
    for [north, east] in POSITIONS {
        for first in (0..meanings.len()).filter(|i| meanings[*i] == Some(north)) {
            let with = |j: &usize| meanings[*j] == Some(east) && log.columns[*j].t == log.columns[first].t;
            let Some(second) = (0..meanings.len()).filter(with).min_by_key(|j| j.abs_diff(first)) else { continue };
            let (a, b) = (&log.columns[first], &log.columns[second]);
            // Rows of one time are written twice, and no fix is held in them.
            let doubled = a.t.windows(2).filter(|t| t[1] <= t[0]).count();
            if 20 * doubled > a.t.len() {
                continue;
            }
            let new: Vec<bool> =
                (0..a.v.len()).map(|i| i == 0 || a.v[i] != a.v[i - 1] || b.v[i] != b.v[i - 1]).collect();
            let Some(kept) = samples(&new) else { continue };
            let whole = a.t.clone();
            let of_receiver = |i: usize, column: &Column| {
                i == first || i == second || (column.t == whole && changes_with(&column.v, &kept))
            };
            let released: Vec<usize> = (0..log.columns.len()).filter(|i| of_receiver(*i, &log.columns[*i])).collect();
            for i in &released {
                thin(&mut log.columns[*i], &kept);
            }
            let names: Vec<String> = released.iter().map(|i| format!("`{}`", log.columns[*i].name)).collect();
            let (rows, left) = (kept.len(), kept.iter().filter(|k| **k).count());
            log.notes.push(format!(
                "the fix is repeated in most rows until the next: {left} of {rows} rows of {} are measured",
                names.join(", ")
            ));
        }
    }
}

/// The rows that are measured, where most rows repeat the fix of the one before: those with a new fix, and as many of a fix that stays
/// (a ship at rest) as its receiver would give.
fn samples(new: &[bool]) -> Option<Vec<bool>> {
    let starts: Vec<usize> = (0..new.len()).filter(|i| new[*i]).collect();
    let mut lengths: Vec<usize> = starts.windows(2).map(|s| s[1] - s[0]).collect();
    if lengths.len() < CHANGES {
        return None;
    }
    let middle = lengths.len() / 2;
    let usual = *lengths.select_nth_unstable(middle).1;
    if usual < 2 {
        return None;
    }
    let mut since = 0;
    let kept = new.iter().map(|is_new| {
        since = if *is_new { 0 } else { since + 1 };
        since % usual == 0
    });
    // A row too many after a fix that came late is none.
    let kept: Vec<bool> = kept.collect();
    let late = |i: usize| !new[i] && kept[i] && new.get(i + 1).is_some_and(|next| *next);
    Some((0..new.len()).map(|i| kept[i] && !late(i)).collect())
}

/// Whether a column changes with the fixes alone.
fn changes_with(values: &[f64], fixes: &[bool]) -> bool {
    let changed = || (1..values.len()).filter(|i| values[*i] != values[*i - 1]);
    let (all, together) = (changed().count(), changed().filter(|i| fixes[*i]).count());
    all >= CHANGES && together as f64 >= TOGETHER * all as f64
}

fn thin(column: &mut Column, kept: &[bool]) {
    for values in [&mut column.t, &mut column.v] {
        let mut kept = kept.iter();
        values.retain(|_| kept.next().is_some_and(|k| *k));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::import::signals::log::Clock;

    fn log(columns: &[(&str, Meaning, fn(usize) -> f64)]) -> Log {
        let column = |(name, meaning, value): &(&str, Meaning, fn(usize) -> f64)| Column {
            name: (*name).to_owned(),
            meaning: Some(*meaning),
            t: (0..200).map(|i| 0.1 * f64::from(i)).collect(),
            v: (0..200).map(value).collect(),
            ..Column::default()
        };
        Log {
            path: "log.csv".into(),
            format: "text".into(),
            clock: Clock::Own,
            columns: columns.iter().map(column).collect(),
            texts: Vec::new(),
            notes: Vec::new(),
        }
    }

    #[test]
    fn a_fix_repeated_until_the_next_is_one_sample_in_the_columns_of_its_receiver_and_in_no_other() {
        // Fixes every ten rows, of which the longitude does not change before row 50; from row 150 on the ship is at rest.
        let mut log = log(&[
            ("lat", Meaning::Latitude, |i| (i.min(150) / 10) as f64),
            ("lon", Meaning::Longitude, |i| (i.clamp(50, 150) / 10) as f64),
            ("SOG", Meaning::GroundSpeed, |i| 5.0 + (i / 10) as f64),
            ("gyro", Meaning::Channel(Channel::Psi), |i| i as f64),
            ("rudder", Meaning::Channel(Channel::Delta), |i| if i < 77 { 0.0 } else { 10.0 }),
        ]);
        release(&mut log, |c| c.meaning);
        let counts: Vec<usize> = log.columns.iter().map(|c| c.v.len()).collect();
        assert_eq!(counts, [20, 20, 20, 200, 200]);
        assert_eq!(log.columns[0].v[..4], [0.0, 1.0, 2.0, 3.0]);
        assert!(log.columns[0].t.iter().enumerate().all(|(k, t)| (t - k as f64).abs() < 1e-9));
        assert!(log.notes.len() == 1 && log.notes[0].contains("`SOG`") && log.notes[0].contains("20 of 200 rows"));
    }

    #[test]
    fn a_table_with_a_fix_in_every_row_stays_as_it_is_also_where_its_ship_rests() {
        let columns: [(&str, Meaning, fn(usize) -> f64); 2] =
            [("lat", Meaning::Latitude, |i| i.saturating_sub(80) as f64), ("lon", Meaning::Longitude, |_| 7.0)];
        let mut log = log(&columns);
        release(&mut log, |c| c.meaning);
        assert!(log.notes.is_empty() && log.columns.iter().all(|c| c.v.len() == 200));
    }
}
