//! What is measured on a trial, drawn into its figure: advance, transfer and tactical diameter on a circle, overshoots on a zigzag.
//! The measures are those of the trial; nothing is measured here.

use crate::evaluate::maneuver::{Intervals, Side, Track, Trial, Turning, Zigzag};
use crate::numerals::{fixed, sig};
use crate::report::plot::{Color, Layer, Marker, east_north};

/// The state of a track at a time \[s\], or the last one before it.
fn state_at(track: &Track, time: f64) -> Option<[f64; 6]> {
    let after = track.t.partition_point(|t| *t <= time);
    track.states.get(after.saturating_sub(1)).copied()
}

/// The point of a track panel that is so far ahead of the first state and abeam of it to starboard \[m\].
fn point(track: &Track, ahead: f64, abeam: f64) -> Option<(f64, f64)> {
    let [x, y, psi, ..] = *track.states.first()?;
    let (s, c) = psi.sin_cos();
    Some(east_north(x + c * ahead - s * abeam, y + s * ahead + c * abeam))
}

/// Rows of words below the circles, and from one to the next, in ship lengths.
const BELOW: f64 = 0.9;
const ROW: f64 = 0.5;
/// Measures of a circle: rows of words for each side.
const MEASURES: usize = 3;

/// An arrow of a side.
fn arrow(color: Color, ends: [(f64, f64); 2]) -> Layer {
    Layer::arrows("measures", color, [ends]).unlisted().width(2.5)
}

/// The 95 % interval of a measure in words; nothing where there is none.
fn within(intervals: &Intervals, key: &str, number: impl Fn(f64) -> String) -> String {
    intervals.get(key).map_or(String::new(), |[low, high]| format!(" [{}, {}]", number(*low), number(*high)))
}

/// Advance, transfer and tactical diameter of circles as far as they were reached: arrows, and words in rows below the circles, port to
/// the left. Lengths are in ship lengths of `length` \[m\]. Also the lowest row, as a value of the vertical axis.
pub(super) fn circles(trials: &[Trial<Turning>], length: f64, color: fn(Side) -> Color) -> (Vec<Layer>, f64) {
    let mut layers = Vec::new();
    // With intervals a row has room for one side.
    let wide = trials.iter().any(|t| !t.intervals.is_empty());
    let mut lowest = 0.0_f64;
    for (i, trial) in trials.iter().enumerate() {
        layers.extend(arrows(trial, color(trial.side)));
        let first = if wide { i * MEASURES } else { 0 };
        let side = if trial.side == Side::Starboard { 1.0 } else { -1.0 };
        let [x, y, ..] = trial.track.states.first().copied().unwrap_or_default();
        let reach = trial.measures.tactical_diameter.unwrap_or(length);
        for (k, words) in words(trial, length).into_iter().enumerate() {
            let below = x - length * (BELOW + ROW * (first + k) as f64);
            lowest = lowest.min(below);
            layers.push(Layer::text(words, color(trial.side), east_north(below, y + side * reach)));
        }
    }
    (layers, lowest - ROW * length)
}

/// The measures of a circle in words, with their intervals.
fn words(trial: &Trial<Turning>, length: f64) -> Vec<String> {
    let m = &trial.measures;
    let all = [("advance", m.advance), ("transfer", m.transfer), ("tactical diameter", m.tactical_diameter)];
    let one = |(name, value): (&str, Option<f64>)| {
        let lengths = |v: f64| sig(v / length, 3);
        let interval = within(&trial.intervals, &name.replace(' ', "_"), lengths);
        Some(format!("{name} {} L{interval}", lengths(value?)))
    };
    all.into_iter().filter_map(one).collect()
}

/// The measures of a circle as arrows.
fn arrows(trial: &Trial<Turning>, color: Color) -> Vec<Layer> {
    let (m, track) = (&trial.measures, &trial.track);
    let side = if trial.side == Side::Starboard { 1.0 } else { -1.0 };
    let mut layers = Vec::new();
    if let (Some(advance), Some(transfer)) = (m.advance, m.transfer) {
        let ends = [point(track, 0.0, 0.0), point(track, advance, 0.0), point(track, advance, side * transfer)];
        if let [Some(start), Some(corner), Some(quarter)] = ends {
            layers.extend([arrow(color, [start, corner]), arrow(color, [corner, quarter])]);
        }
    }
    let half = m.time_180.zip(track.t.first()).and_then(|(time, start)| state_at(track, start + time));
    if let (Some(diameter), Some(s), Some([x, y, psi, ..])) = (m.tactical_diameter, half, track.states.first()) {
        let ahead = (s[0] - x) * psi.cos() + (s[1] - y) * psi.sin();
        if let (Some(foot), Some(end)) = (point(track, ahead, 0.0), point(track, ahead, side * diameter)) {
            layers.push(arrow(color, [foot, end]));
        }
    }
    layers
}

/// The peaks of heading after each execute but the first, with the overshoot in words.
pub(super) fn overshoots(trial: &Trial<Zigzag>, color: Color) -> Vec<Layer> {
    let (m, track) = (&trial.measures, &trial.track);
    let start = track.t.first().copied().unwrap_or(0.0);
    let mut layers = Vec::new();
    // Height of the words at the last peaks to either side.
    let mut words = [f64::NAN; 2];
    for (i, overshoot) in m.overshoots.iter().enumerate() {
        let Some(from) = m.executes.get(i + 1).map(|t| start + t) else { continue };
        let to = m.executes.get(i + 2).map_or(f64::INFINITY, |t| start + t);
        let sign = if (trial.side == Side::Starboard) == (i % 2 == 0) { 1.0 } else { -1.0 };
        let between = (0..track.len()).filter(|k| (from..=to).contains(&track.t[*k]));
        let height = |k: &usize| sign * track.states[*k][2];
        let Some(peak) = between.max_by(|a, b| height(a).total_cmp(&height(b))) else { continue };
        let at = (track.t[peak], track.states[peak][2].to_degrees());
        let size = m.heading.to_degrees().max(1.0);
        let mut above = (at.0, at.1 + 0.12 * sign * size + 1.4 * sign);
        // Words as high as those of the peak before to this side would run into them: a line further out.
        if (above.1 - words[i % 2]).abs() < 0.3 * size {
            above.1 = words[i % 2] + 0.36 * sign * size;
        }
        words[i % 2] = above.1;
        layers.push(Layer::scatter("overshoot", color, [at]).marker(Marker::Diamond));
        let degrees = |v: f64| fixed(v.to_degrees(), 1);
        let interval = within(&trial.intervals, &format!("overshoot_{}", i + 1), degrees);
        layers.push(Layer::text(format!("{} deg{interval}", degrees(*overshoot)), color, above));
    }
    layers
}
