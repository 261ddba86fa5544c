//! Frozen channels: those that keep one value while the other channels show that they should not.
//! A receiver that repeats its value and then catches up is in `receiver`, since its samples can be left out.

use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{
    FROZEN_CHANGES, FROZEN_DIFFERENCES, FROZEN_LEVEL, FROZEN_RANGE, FROZEN_ROWS, FROZEN_SELDOM, FROZEN_SPANS,
};
use crate::recording::audit::motion::series::{Series, changes, constant};
use crate::recording::{Channel, STATE_CHANNELS};
use crate::statistics::{median, quantile};
use std::ops::Range;

/// Channels that keep one value while their partners show that they should not: position and heading against the integral of the rates,
/// velocities against the derivative of position and heading. Gives their rows: what these contradict besides is no fault of its own.
pub fn frozen(series: &Series<'_>, issues: &mut Vec<Issue>) -> Vec<(Channel, Vec<usize>)> {
    let t = &series.t;
    let duration = |rows: &Range<usize>| t[rows.end - 1] - t[rows.start];
    let mut stands = Vec::new();
    for channel in STATE_CHANNELS {
        let Some(values) = series.recorded(channel) else { continue };
        let still = still(series, channel, values);
        let Some(longest) = still.iter().max_by(|a, b| duration(a).total_cmp(&duration(b))) else { continue };
        let text = format!(
            "stands still while the ship's other channels move: {} of {:.1} s in all, the longest at {:.4}",
            if still.len() == 1 { "one stretch".to_owned() } else { format!("{} stretches", still.len()) },
            still.iter().map(duration).sum::<f64>(),
            values[longest.start],
        );
        let next = "leave the fields blank, so that it counts as a dropout";
        let issue = Issue::new(Severity::Warning, "frozen", text, next).of(channel);
        issues.push(issue.at(series.lines(longest)));
        stands.push((channel, still.into_iter().flatten().collect()));
    }
    stands
}

/// The stretches over which a channel keeps one value and should not.
fn still(series: &Series<'_>, channel: Channel, values: &[f64]) -> Vec<Range<usize>> {
    let t = &series.t;
    let integrates = matches!(channel, Channel::X | Channel::Y | Channel::Psi);
    let [least, of_velocity] = FROZEN_ROWS;
    let stretches: Vec<Range<usize>> = series.stretches.iter().flat_map(|s| constant(values, s.clone())).collect();
    if stretches.iter().all(|rows| rows.len() < least) {
        return Vec::new();
    }
    let partner = if integrates { rate(series, channel) } else { derivative(series, channel) };
    let Some(partner) = partner else { return Vec::new() };
    let whole_range = range(&partner);
    // Surge and sway are parts of one speed.
    let along = if channel == Channel::V { series.get(Channel::U) } else { None };
    let level = size(&partner).max(along.map_or(0.0, size));
    let long: Vec<(usize, &Range<usize>)> =
        stretches.iter().enumerate().filter(|(_, rows)| rows.len() >= least).collect();
    let stands = |(i, rows): &(usize, &Range<usize>)| {
        if integrates {
            // A channel that is only coarse also stands, but never longer than its neighbouring steps explain.
            let moved: f64 = Range::clone(rows).skip(1).map(|i| partner[i] * (t[i] - t[i - 1])).sum();
            moved.abs() > FROZEN_CHANGES * usual_change(values, &stretches, *i)
                && moved.abs() > FROZEN_DIFFERENCES * usual_difference(series, values, &partner, rows.len(), &long)
        } else {
            let longer = t[rows.end - 1] - t[rows.start] > FROZEN_SPANS * series.span;
            let own = &partner[Range::clone(rows)];
            let changes = range(own);
            // Next to nothing, in any unit, where the ship moves.
            let nothing = values[rows.start].abs() < FROZEN_LEVEL * level && size(own) > FROZEN_RANGE * level;
            let changes =
                rows.len() >= of_velocity && changes > FROZEN_RANGE * whole_range && changes > FROZEN_LEVEL * level;
            longer && (nothing || changes)
        }
    };
    long.iter().filter(|s| stands(s)).map(|(_, rows)| Range::clone(rows)).collect()
}

/// Rate at which position or heading should change, from the recorded rates.
fn rate(series: &Series<'_>, channel: Channel) -> Option<Vec<f64>> {
    if channel == Channel::Psi {
        return series.get(Channel::R).map(<[f64]>::to_vec);
    }
    let [psi, u, v] = [Channel::Psi, Channel::U, Channel::V].map(|c| series.get(c));
    let (psi, u, v) = (psi?, u?, v?);
    let at = |i: usize| {
        let (s, c) = psi[i].sin_cos();
        if channel == Channel::X { u[i] * c - v[i] * s } else { u[i] * s + v[i] * c }
    };
    Some((0..psi.len()).map(at).collect())
}

/// Velocity or yaw rate, derived from position and heading.
fn derivative(series: &Series<'_>, channel: Channel) -> Option<Vec<f64>> {
    let all = 0..series.t.len();
    let psi = series.get(Channel::Psi)?;
    if channel == Channel::R {
        return Some(series.slope(psi, &all));
    }
    let (dx, dy) = (series.slope(series.get(Channel::X)?, &all), series.slope(series.get(Channel::Y)?, &all));
    let at = |i: usize| {
        let (s, c) = psi[i].sin_cos();
        if channel == Channel::U { dx[i] * c + dy[i] * s } else { dy[i] * c - dx[i] * s }
    };
    Some(all.map(at).collect())
}

/// Root mean square of the finite values.
fn size(values: &[f64]) -> f64 {
    let (sum, count) = values.iter().filter(|v| v.is_finite()).fold((0.0, 0.0), |(s, n), v| (s + v * v, n + 1.0));
    (sum / f64::max(count, 1.0)).sqrt()
}

/// Largest less smallest finite value.
fn range(values: &[f64]) -> f64 {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    finite().fold(f64::MIN, f64::max) - finite().fold(f64::MAX, f64::min)
}

/// Median change of value from stretch to stretch before or after stretch `at`, the larger one: motion in a row, or the resolution
/// where that is coarser, which may change with the digits of the value.
fn usual_change(values: &[f64], stretches: &[Range<usize>], at: usize) -> f64 {
    let usual = |near: &[Range<usize>]| median(changes(values, near)).unwrap_or(0.0);
    let (before, after) = (&stretches[at.saturating_sub(6)..=at], &stretches[at..(at + 7).min(stretches.len())]);
    usual(before).max(usual(after))
}

/// Difference, over so many rows, between the change of a channel and the integral of its rate, that is seldom exceeded where the channel
/// does not stand still: noise, rounding, and the error of the rate. `long` are the stretches over which it does.
fn usual_difference(
    series: &Series<'_>,
    values: &[f64],
    rate: &[f64],
    length: usize,
    long: &[(usize, &Range<usize>)],
) -> f64 {
    let t = &series.t;
    let mut differences = Vec::new();
    for stretch in series.stretches.iter().filter(|s| s.len() > length) {
        let mut said = vec![0.0];
        for i in stretch.start + 1..stretch.end {
            said.push(said[said.len() - 1] + rate[i] * (t[i] - t[i - 1]));
        }
        let mut next = 0;
        for i in 0..stretch.len() - length + 1 {
            let (from, to) = (stretch.start + i, stretch.start + i + length - 1);
            while next < long.len() && long[next].1.end <= from {
                next += 1;
            }
            if long.get(next).is_none_or(|(_, rows)| rows.start > to) {
                differences.push((values[to] - values[from] - (said[i + length - 1] - said[i])).abs());
            }
        }
    }
    differences.retain(|d| d.is_finite());
    differences.sort_by(f64::total_cmp);
    quantile(&differences, FROZEN_SELDOM).unwrap_or(0.0)
}
