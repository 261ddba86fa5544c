//! Damaged single values: rows that lie far from their neighbours, inside a run and at its ends, from which simulation starts.
//! Positions that jump are in `fixes`; jumps that last are in `receiver`, since a run is divided there.

use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{
    APART_SHARE, END_WINDOWS, FAR, FAR_SHARE, FAR_SHARE_AT_ENDS, FEW, FEW_SHARE, FEW_SHARE_APART, GOES_ON,
    HEADING_BLIP, LOST_SAME, MEDIAN_ROWS, OUTSIDE_SHARE, RUDDER_BLIP, RUDDER_OVER, SPEED_BLIP, SPEED_BLIP_SHARE, TAIL,
};
use crate::recording::{Channel, Recording, STATE_CHANNELS};
use crate::statistics::median;

/// Rows of a window, and pairs of them but one.
const WINDOW: usize = 2 * MEDIAN_ROWS + 1;
const PAIRS: usize = (WINDOW - 1) * (WINDOW - 2) / 2;

/// Channels that are set and not moved: they may change for one sample and change back.
const SET: [Channel; 9] = [
    Channel::N,
    Channel::Delta,
    Channel::Thruster,
    Channel::NOrder,
    Channel::DeltaOrder,
    Channel::WindSpeed,
    Channel::ApparentWindSpeed,
    Channel::CurrentSpeed,
    Channel::Depth,
];

/// Single rows far from the median of their neighbours (Hampel's test), in every channel but those in `reported`.
pub fn outliers(recording: &Recording, reported: &[Channel], issues: &mut Vec<Issue>) {
    let moved = STATE_CHANNELS.into_iter().chain([Channel::UWater, Channel::VWater]).map(|c| (c, false));
    for (channel, set) in moved.chain(SET.map(|c| (c, true))) {
        let known = reported.contains(&channel) || recording.derived().contains(&channel);
        let Some(values) = recording.get(channel).filter(|_| !known) else { continue };
        let far = far(channel, recording.time(), values, set);
        let (Some(&first), Some(&last)) = (far.first(), far.last()) else { continue };
        let line = |row: usize| recording.line(row);
        let factor = channel.info().quantity.factor(recording.unit(channel)).unwrap_or(1.0);
        let value = |row: usize| format!("{:.4} {}", values[row] / factor, recording.unit(channel));
        let lines: Vec<String> = far.iter().take(5).map(|&row| line(row).to_string()).collect();
        let more = if far.len() > 5 { ", ..." } else { "" };
        let text = match far.len() {
            1 => format!("one value is far from its neighbours: {} (line {})", value(first), lines[0]),
            n => format!("{n} values are far from their neighbours (lines {}{more})", lines.join(", ")),
        };
        let next = format!(
            "leave the fields blank, or use `blank = {{ outside = [...] }}` for `{channel}` in a column map, if they are no {}",
            if set { "orders" } else { "motion of the ship" }
        );
        issues.push(Issue::new(Severity::Warning, "outlier", text, next).of(channel).at((line(first), line(last))));
    }
}

/// The rows that lie far from their neighbours; none where they are so many that they are no single values.
fn far(channel: Channel, t: &[f64], values: &[f64], set: bool) -> Vec<usize> {
    let rows: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_finite()).collect();
    let finite: Vec<f64> = rows.iter().map(|&i| values[i]).collect();
    // Half of n values lie within a fifth of their scatter by chance, so that the median size is a fifth of what it estimates, once in 700 runs
    // of 12 rows and once in 2 million of 30.
    if finite.len() < 10 * MEDIAN_ROWS {
        return Vec::new();
    }
    let from_median: Vec<f64> = (0..finite.len()).map(|k| finite[k] - neighbours(&finite, k)).collect();
    let mut sorted = finite.clone();
    sorted.sort_by(f64::total_cmp);
    let tail = (TAIL * sorted.len() as f64).ceil() as usize;
    let (low, high) = (sorted[tail], sorted[sorted.len() - 1 - tail]);
    // What is set may keep one value for most of a run: its size then counts for its range.
    let range = if set { (high - low).max(high.abs().max(low.abs())) } else { high - low };
    // The usual scatter, or a share of the range, since data without noise have none.
    let rudder = matches!(channel, Channel::Delta | Channel::DeltaOrder);
    let least = match channel {
        Channel::Delta | Channel::DeltaOrder => RUDDER_BLIP / APART_SHARE,
        Channel::Psi => HEADING_BLIP / APART_SHARE,
        Channel::U | Channel::UWater => SPEED_BLIP.min(SPEED_BLIP_SHARE * high.abs().max(low.abs())) / APART_SHARE,
        _ => 0.0,
    };
    let scatter = deviation(from_median.iter().copied());
    let usual = (FAR * scatter).max(FAR_SHARE * range).max(least);
    // The range of what is set: of values that do not stand alone.
    let near = FAR_SHARE * (sorted[sorted.len() - 1] - sorted[0]);
    let pairs = finite.windows(2).filter(|pair| (pair[0] - pair[1]).abs() <= near).flatten();
    let (lowest, highest) = pairs.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let outside = OUTSIDE_SHARE * (highest - lowest) + FAR_SHARE * lowest.abs().max(highest.abs());
    let possible = |k: usize| set && (lowest - outside..=highest + outside).contains(&finite[k]);
    let inner = MEDIAN_ROWS..finite.len() - MEDIAN_ROWS;
    let off = |k: &usize| from_median[*k].abs();
    let impossible: Vec<usize> = inner.filter(|k| off(k) > APART_SHARE * usual && !possible(*k)).collect();
    let mut far: Vec<usize> = impossible.iter().copied().filter(|k| off(k) > usual).collect();
    // Apart from these no value is half as far: they are no tail of what the channel does.
    let beside = |k: &usize| far.iter().any(|f| f.abs_diff(*k) <= MEDIAN_ROWS);
    let apart = impossible.iter().all(beside);
    // A set channel may have been changed just before the end.
    if !set {
        // A row differs more from a line through those on one side than from the median of both; what overlapping windows of a short run say of
        // the first is from few independent rows.
        let at_ends = |own: f64| (FAR * own.max(scatter)).max(FAR_SHARE_AT_ENDS * (high - low)).max(least);
        far.extend(far_at_ends(t, &rows, &finite, at_ends));
        far.sort_unstable();
    }
    if set && far.is_empty() {
        far.extend(set_at_ends(&finite).into_iter().filter(|k| !rudder || finite[*k].abs() > RUDDER_OVER));
    }
    if matches!(channel, Channel::N | Channel::Delta) {
        far.extend(lost(&finite, usual).filter(|k| !far.contains(k)).collect::<Vec<_>>());
        far.sort_unstable();
    }
    far.retain(|k| !is_on_its_way(&finite, *k));
    let share = if apart { FEW_SHARE_APART } else { FEW_SHARE };
    let few = FEW.max((share * finite.len() as f64) as usize);
    if far.len() > few { Vec::new() } else { far.into_iter().map(|k| rows[k]).collect() }
}

/// Whether the step to a row goes on from the one before it, or the step from it is gone on with: to the same side, and at most so many times as far: the last step of a rudder is a part of one.
/// A rudder that is put over for a moment, and a heading as a turn begins, are far from the median of their neighbours and no single values.
fn is_on_its_way(values: &[f64], k: usize) -> bool {
    let goes_on = |[before, at, after]: [Option<usize>; 3]| {
        let value = |row: Option<usize>| values.get(row?).copied();
        let (Some(before), Some(at), Some(after)) = (value(before), value(at), value(after)) else { return false };
        let (first, second) = (at - before, after - at);
        first * second > 0.0 && second.abs() <= GOES_ON * first.abs()
    };
    let back = |rows: usize| k.checked_sub(rows);
    goes_on([back(2), back(1), Some(k)]) || goes_on([Some(k + 2), Some(k + 1), Some(k)])
}

/// Single zeros of a channel that is set, between values of one sign and about one size: orders do not come back to where they were.
fn lost(values: &[f64], least: f64) -> impl Iterator<Item = usize> {
    let lost = move |three: &[f64]| {
        let (before, after) = (three[0], three[2]);
        let smaller = before.abs().min(after.abs());
        three[1] == 0.0 && before * after > 0.0 && smaller > least && (before - after).abs() <= LOST_SAME * smaller
    };
    values.windows(3).enumerate().filter(move |(_, three)| lost(three)).map(|(k, _)| k + 1)
}

/// First and last value of a channel that is set, where all others are alike and it is several times as large as any of them.
fn set_at_ends(values: &[f64]) -> Vec<usize> {
    let last = values.len() - 1;
    let largest = |rows: &[f64]| rows.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let alone = |k: usize, rest: &[f64]| {
        let most = largest(rest);
        most > 0.0 && values[k].abs() > (2.0 + OUTSIDE_SHARE) * most
    };
    let mut far = Vec::new();
    far.extend(alone(0, &values[1..]).then_some(0));
    far.extend(alone(last, &values[..last]).then_some(last));
    far
}

/// Rows at the ends that are far from the line through the other rows of their window, by what such rows are all along the run.
fn far_at_ends(t: &[f64], rows: &[usize], values: &[f64], limit: impl Fn(f64) -> f64) -> Vec<usize> {
    let windows = values.len() + 1 - WINDOW;
    let stride = windows.div_ceil(END_WINDOWS);
    let off = |start: usize, j: usize| {
        let others: [usize; WINDOW - 1] = std::array::from_fn(|k| start + k + usize::from(k >= j));
        let slope = |a: usize, b: usize| (values[b] - values[a]) / (t[rows[b]] - t[rows[a]]);
        let slopes = others.iter().enumerate().flat_map(|(i, a)| others[i + 1..].iter().map(move |b| slope(*a, *b)));
        let slope = middle(slopes).unwrap_or(0.0);
        let at = start + j;
        let level = middle(others.iter().map(|k| values[*k] - slope * (t[rows[*k]] - t[rows[at]]))).unwrap_or(0.0);
        values[at] - level
    };
    let mut far = Vec::new();
    for j in 0..MEDIAN_ROWS {
        for (start, j) in [(0, j), (windows - 1, WINDOW - 1 - j)] {
            let own = off(start, j).abs();
            let usual = || deviation((0..windows).step_by(stride).map(|start| off(start, j)));
            // Most rows are near by the range alone, and what is usual along the run is not asked.
            if own > limit(0.0) && own > limit(usual()) {
                far.push(start + j);
            }
        }
    }
    // A damaged row shifts the line through the rows next to it: of adjacent rows only the first or last one of the run is reported.
    let ends = |k: &usize| *k == 0 || *k == values.len() - 1;
    if far.iter().any(ends) { far.into_iter().filter(ends).collect() } else { far }
}

/// The median of a row's neighbours. The row itself does not count: where a value rises it would be the median, and the scatter 0.
fn neighbours(values: &[f64], k: usize) -> f64 {
    let (before, after) = (k.saturating_sub(MEDIAN_ROWS)..k, k + 1..(k + 1 + MEDIAN_ROWS).min(values.len()));
    middle(before.chain(after).map(|i| values[i])).unwrap_or(values[k])
}

/// The median of the values of a window, or of the slopes between them, stored without allocating memory: windows are many.
fn middle(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut few, mut count) = ([0.0; PAIRS], 0);
    for value in values.filter(|v| v.is_finite()).take(PAIRS) {
        few[count] = value;
        count += 1;
    }
    let (few, half) = (&mut few[..count], count / 2);
    few.sort_unstable_by(f64::total_cmp);
    match count {
        0 => None,
        odd if odd % 2 == 1 => Some(few[half]),
        _ => Some(0.5 * (few[half - 1] + few[half])),
    }
}

/// Standard deviation of values around 0 by their median size, which single large ones do not change.
fn deviation(values: impl Iterator<Item = f64>) -> f64 {
    1.4826 * median(values.map(f64::abs).filter(|v| v.is_finite())).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::audit::example::noise;

    /// Rows that are reported of a channel that moves or of a rudder, after damage to them.
    fn found(channel: Channel, values: impl Fn(usize) -> f64, damage: impl Fn(&mut [f64])) -> Vec<usize> {
        let set = SET.contains(&channel);
        let t: Vec<f64> = (0..121).map(|i| 2.0 * i as f64).collect();
        let mut values: Vec<f64> = (0..121).map(values).collect();
        damage(&mut values);
        far(channel, &t, &values, set)
    }

    fn speed(seed: u32) -> Vec<f64> {
        let mut noise = noise(seed);
        (0..121).map(|i| 4.0 + 1.5 * (0.05 * f64::from(i)).sin() + 0.1 * noise()).collect()
    }

    #[test]
    fn the_middle_of_a_window_is_its_median() {
        let mut noise = noise(5);
        for count in 0..=PAIRS {
            let values: Vec<f64> = (0..count).map(|_| noise()).collect();
            assert_eq!(middle(values.iter().copied()), median(values));
        }
    }

    #[test]
    fn single_rows_are_reported_however_many_they_are_as_long_as_none_is_half_way() {
        let u = speed(1);
        let damaged = |rows: &'static [usize], to: f64| {
            found(Channel::U, |i| u[i], move |u| rows.iter().for_each(|row| u[*row] = to))
        };
        assert!(damaged(&[], 0.0).is_empty());
        assert_eq!(damaged(&[20], 0.0), [20]);
        assert_eq!(damaged(&[18, 73, 103, 109], 0.0), [18, 73, 103, 109]);
        // A channel that leaps by any size is not damaged in single rows.
        let leaps = found(Channel::U, |i| u[i], |u| (10..115).step_by(10).for_each(|row| u[row] += 0.03 * row as f64));
        assert!(leaps.is_empty(), "{leaps:?}");
    }

    #[test]
    fn noise_alone_is_not_reported_however_short_the_run() {
        let mut noise = noise(11);
        for rows in [12, 20, 30, 45] {
            let t: Vec<f64> = (0..rows).map(f64::from).collect();
            let mut run = || -> Vec<f64> { (0..rows).map(|_| 9e-4 * noise()).collect() };
            let reported = (0..1000).filter(|_| !far(Channel::R, &t, &run(), false).is_empty()).count();
            assert!(reported <= 1, "{reported} of 1000 runs of {rows} rows");
        }
    }

    #[test]
    fn a_rudder_at_rest_may_show_one_digit_and_one_on_its_way_over_may_end_a_run() {
        let rests = |i: usize| if i.is_multiple_of(7) { 5e-4 } else { 0.0 };
        assert!(found(Channel::Delta, |_| 0.0, |d| d[60] = 0.0017).is_empty());
        assert!(found(Channel::Delta, rests, |d| d[120] = 0.0908).is_empty());
        assert!(found(Channel::Delta, rests, |d| d[0] = -0.0908).is_empty());
        assert_eq!(found(Channel::Delta, rests, |d| d[60] = 0.3), [60]);
        assert_eq!(found(Channel::Delta, rests, |d| d[120] = 1.2), [120]);
    }

    #[test]
    fn one_digit_of_a_log_of_a_tenth_of_a_knot_is_no_single_value() {
        let rests = |i: usize| 7.716 + 1e-4 * (i % 5) as f64;
        assert!(found(Channel::U, rests, |u| [30, 77].iter().for_each(|row| u[*row] += 0.0514)).is_empty());
        assert_eq!(found(Channel::U, rests, |u| u[60] = 0.0), [60]);
        // Of a model that is a twentieth as fast it is one.
        assert_eq!(found(Channel::U, |i| 0.05 * rests(i), |u| u[60] += 0.0514), [60]);
    }

    #[test]
    fn what_is_on_its_way_is_no_single_value_and_one_digit_of_a_heading_is_none() {
        // Put over by four degrees and back at the rate of its gear.
        let checked = |i: usize| if (56..=60).contains(&i) { -0.04 * (3.0 - 58_usize.abs_diff(i) as f64) } else { 0.0 };
        assert!(found(Channel::Delta, checked, |_| ()).is_empty());
        assert_eq!(found(Channel::Delta, checked, |d| d[90] = 0.3), [90]);
        // A turn that begins before the end of the run.
        let turns = |i: usize| -3.05 + if i > 117 { 0.006 * ((i - 117) as f64).powi(2) } else { 2e-4 * (i % 3) as f64 };
        assert!(found(Channel::Psi, turns, |_| ()).is_empty());
        assert_eq!(found(Channel::Psi, |i| -3.05 + 2e-4 * (i % 3) as f64, |p| p[120] = -2.9), [120]);
        let digits = |i: usize| if [4, 30, 77].contains(&i) { -0.8201 } else { -0.8236 };
        assert!(found(Channel::Psi, digits, |_| ()).is_empty());
    }

    #[test]
    fn a_rudder_that_is_zero_for_one_row_was_lost_and_one_that_is_turned_was_not() {
        let zigzag = |i: usize| if (i / 20).is_multiple_of(2) { 0.175 } else { -0.175 };
        let lost =
            |rows: &'static [usize]| found(Channel::Delta, zigzag, move |d| rows.iter().for_each(|row| d[*row] = 0.0));
        assert!(lost(&[]).is_empty());
        assert_eq!(lost(&[5, 47, 70, 90]), [5, 47, 70, 90]);
        // On its way to the other side.
        assert!(lost(&[20, 40]).is_empty());
        assert!(found(Channel::Thruster, zigzag, |d| d[47] = 0.0).is_empty());
        // Turned at the start of the run, and kept there.
        let turned = |side: f64| found(Channel::Delta, |i| side * (0.09 * i as f64).min(0.61), |_| ());
        assert!(turned(1.0).is_empty() && turned(-1.0).is_empty());
        // A propeller at one rate that is read ten times too large in four rows.
        let tenfold = |n: &mut [f64]| [4, 29, 68, 98].iter().for_each(|row| n[*row] *= 10.0);
        assert_eq!(found(Channel::N, |_| 2.57, tenfold), [4, 29, 68, 98]);
    }
}
