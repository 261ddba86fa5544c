//! Headings that were interpolated across north: between 359 and 1 degree some program put values on the way through 180.
//! It finds and repairs such samples of an unwrapped heading; whether they are repaired is set in the column map.

use crate::statistics::median;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Most samples that lie between two readings of the compass: logs of 1 Hz resampled to 20 Hz.
pub const MOST_BETWEEN: usize = 20;
/// A step through the middle of the compass is so many times the usual step of the heading, and more than this angle \[rad\].
pub const BEYOND_USUAL: f64 = 5.0;
/// Smallest angle \[rad\] of a step through the middle: twenty readings share a turn less what the ship turned.
pub const LEAST_STEP: f64 = 0.15;
/// A longer step of time, in usual ones, is a gap: nothing was interpolated across it.
const GAP: f64 = 2.5;
/// How far a whole turn may be missed \[rad\], in addition to what the ship turns meanwhile.
pub const MISSED: f64 = 0.35;

/// Takes jumps of more than half a turn out of a heading; values that need no turn added stay as they are, bit for bit.
pub(super) fn unwrap(psi: &mut [f64]) {
    let mut turns = 0.0;
    let mut previous: Option<f64> = None;
    for value in psi.iter_mut().filter(|v| v.is_finite()) {
        let raw = *value;
        if let Some(before) = previous.filter(|before| (raw - before).abs() > PI) {
            turns -= ((raw - before) / TAU).round();
        }
        previous = Some(raw);
        if turns != 0.0 {
            *value = raw + turns * TAU;
        }
    }
}

/// The rows strictly between two true headings that lie on the wrong way round, in an unwrapped heading \[rad\]: over them the
/// heading runs through a whole turn in even steps that stand out from all others, or leaves and comes back (one row, across the
/// wrap of the compass). Each lies between two gaps of the times \[s\]. `turned` is how far another channel says that the ship turned from one
/// row to another \[rad\], where one does: a ship that it says went round a circle did.
pub fn across_the_wrap(t: &[f64], psi: &[f64], turned: impl Fn(usize, usize) -> Option<f64>) -> Vec<Range<usize>> {
    let longest = GAP * median(t.windows(2).map(|t| t[1] - t[0])).unwrap_or(0.0);
    let gaps = (1..t.len()).filter(|i| t[*i] - t[*i - 1] > longest);
    let ends: Vec<usize> = [0].into_iter().chain(gaps).chain([psi.len()]).collect();
    let within = |ends: &[usize]| {
        let shifted = |rows: Range<usize>| rows.start + ends[0]..rows.end + ends[0];
        across_in(&psi[ends[0]..ends[1]]).into_iter().map(shifted).collect::<Vec<_>>()
    };
    let sailed = |rows: &Range<usize>| {
        let (from, to) = (rows.start - 1, rows.end);
        let shown = psi[to] - psi[from];
        let short = shown - TAU * (shown / TAU).round();
        turned(from, to).is_some_and(|turned| (turned - shown).abs() < (turned - short).abs())
    };
    ends.windows(2).flat_map(within).filter(|rows| !sailed(rows)).collect()
}

/// The same in a heading without gaps.
fn across_in(psi: &[f64]) -> Vec<Range<usize>> {
    let mut steps: Vec<f64> = psi.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|s| s.is_finite()).collect();
    if steps.len() < 4 {
        return Vec::new();
    }
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let large = (BEYOND_USUAL * usual).max(LEAST_STEP);
    let mut found = Vec::new();
    let mut row = 0;
    while row + 2 < psi.len() {
        match turn_from(psi, row, large, usual).or_else(|| spike_at(psi, row, large, usual)) {
            Some(last) => {
                found.push(row + 1..last);
                row = last;
            }
            None => row += 1,
        }
    }
    found
}

/// The row at which a whole turn that starts after `row` is complete.
fn turn_from(psi: &[f64], row: usize, large: f64, usual: f64) -> Option<usize> {
    let sign = (psi[row + 1] - psi[row]).signum();
    for last in row + 1..psi.len().min(row + MOST_BETWEEN + 2) {
        let step = (psi[last] - psi[last - 1]) * sign;
        if step.is_nan() || step < LEAST_STEP.min(large) {
            return None;
        }
        let total = (psi[last] - psi[row]).abs();
        let next_is_quiet = psi.get(last + 1).is_none_or(|next| (next - psi[last]).abs() < large);
        let rows = (last - row) as f64;
        let largest = (row + 1..=last).map(|k| (psi[k] - psi[k - 1]).abs()).fold(0.0, f64::max);
        if last > row + 1 && next_is_quiet && largest > large && (total - TAU).abs() < MISSED + 3.0 * rows * usual {
            return Some(last);
        }
        if total > TAU + MISSED + 3.0 * rows * usual {
            return None;
        }
    }
    None
}

/// The row after a single one that is far from both neighbours, where these lie on the two sides of a wrap at 180 or 360 degrees.
fn spike_at(psi: &[f64], row: usize, large: f64, usual: f64) -> Option<usize> {
    let [before, at, after] = [psi[row], psi[row + 1], psi[row + 2]];
    let away = (at - before).abs().min((at - after).abs()) > large.max(0.5);
    let near = (after - before).abs() < MISSED + 3.0 * usual;
    let across = (before / PI).floor() != (after / PI).floor();
    (away && near && across).then_some(row + 2)
}

/// Puts the rows that lie on the wrong way round on the short one, by straight lines, and takes the turn out of all rows after them.
/// Returns how many values were changed so.
pub(super) fn repair(t: &[f64], psi: &mut [f64], turned: impl Fn(usize, usize) -> Option<f64>) -> usize {
    let mut changed = 0;
    for rows in across_the_wrap(t, psi, turned) {
        let (from, to) = (rows.start - 1, rows.end);
        let turns = ((psi[to] - psi[from]) / TAU).round();
        if turns != 0.0 {
            psi[to..].iter_mut().for_each(|p| *p -= turns * TAU);
        }
        let slope = (psi[to] - psi[from]) / (t[to] - t[from]);
        for row in rows {
            psi[row] = psi[from] + slope * (t[row] - t[from]);
            changed += 1;
        }
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A turn of 1 degree a sample through north, read once in `every` samples and interpolated between, from -8 degrees on.
    fn interpolated(every: usize, rate: f64) -> (Vec<f64>, Vec<f64>) {
        let compass = |k: usize| (352.0 + rate * k as f64).rem_euclid(360.0).to_radians();
        let at = |k: usize| {
            let (from, share) = (k / every * every, (k % every) as f64 / every as f64);
            compass(from) + share * (compass(from + every) - compass(from))
        };
        let t = (0..200).map(f64::from).collect();
        let mut psi: Vec<f64> = (0..200).map(at).collect();
        unwrap(&mut psi);
        (t, psi)
    }

    #[test]
    fn samples_on_the_way_through_180_degrees_are_found_and_put_right() {
        for every in [2, 3, 5, 10, 20] {
            for rate in [1.0, 0.35] {
                let (t, mut psi) = interpolated(every, rate);
                assert_eq!(across_the_wrap(&t, &psi, |_, _| None).len(), 1, "{every} {rate}");
                assert!(repair(&t, &mut psi, |_, _| None) >= 1);
                for (k, p) in psi.iter().enumerate() {
                    let truth = (352.0 + rate * k as f64).to_radians();
                    assert!((p - truth).abs() < 1e-9, "{every} {rate}: row {k}: {p} {truth}");
                }
            }
        }
    }

    #[test]
    fn nothing_is_interpolated_across_a_gap() {
        // Ten minutes on, the ship heads elsewhere; the one row before the gap leaves and seems to come back.
        let psi: Vec<f64> = (0..40)
            .map(|k| {
                if k < 20 {
                    0.03
                } else if k == 20 {
                    2.0
                } else {
                    -0.03
                }
            })
            .collect();
        let t = |gap: f64| -> Vec<f64> { (0..40).map(|k| f64::from(k) + if k > 20 { gap } else { 0.0 }).collect() };
        assert_eq!(across_the_wrap(&t(0.0), &psi, |_, _| None).first(), Some(&(20..21)));
        assert!(across_the_wrap(&t(600.0), &psi, |_, _| None).is_empty());
    }

    #[test]
    fn a_sound_heading_is_left_alone_however_fast_the_ship_turns() {
        for degrees in [0.0, 0.1, 3.0, 30.0, 90.0] {
            let mut psi: Vec<f64> = (0..200).map(|k| (degrees * f64::from(k)).rem_euclid(360.0).to_radians()).collect();
            unwrap(&mut psi);
            let t: Vec<f64> = (0..200).map(f64::from).collect();
            assert!(across_the_wrap(&t, &psi, |_, _| None).is_empty(), "{degrees}");
        }
    }

    #[test]
    fn a_circle_that_another_channel_shows_was_sailed() {
        // A straight run, a circle in 20 rows of ten seconds, and straight on.
        let psi: Vec<f64> = (0..80).map(|k| TAU * ((f64::from(k) - 30.0) / 20.0).clamp(0.0, 1.0)).collect();
        let t: Vec<f64> = (0..80).map(|k| 10.0 * f64::from(k)).collect();
        let rate = |from: usize, to: usize| Some(psi[to] - psi[from] + 0.1);
        assert_eq!(across_the_wrap(&t, &psi, |_, _| None).len(), 1);
        assert_eq!(across_the_wrap(&t, &psi, |_, _| Some(0.05)).len(), 1);
        assert!(across_the_wrap(&t, &psi, rate).is_empty());
    }
}
