//! What is measured on a trial, drawn into its figure: advance, transfer and tactical diameter on a circle, overshoots on a zigzag.
//! The measures are those of the trial; nothing is measured here.

use crate::maneuver::{Intervals, Side, Track, Trial, Turning, Zigzag};
use crate::numerals::{fixed, sig};
use crate::plot::{Color, GREY, Layer, Marker, east_north};

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

/// An arrow with its words at a share of its length.
fn measure(words: &str, [from, to]: [(f64, f64); 2], share: f64) -> Vec<Layer> {
    let at = (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
    vec![Layer::arrows("measures", GREY, [[from, to]]).width(2.0), Layer::text(words, GREY, at)]
}

/// The 95 % interval of a measure in words; nothing where there is none.
fn within(intervals: &Intervals, key: &str, number: impl Fn(f64) -> String) -> String {
    intervals.get(key).map_or(String::new(), |[low, high]| format!(" [{}, {}]", number(*low), number(*high)))
}

/// Advance, transfer and tactical diameter of a circle, as far as they were reached; lengths in ship lengths of `length` \[m\].
pub(super) fn circle(trial: &Trial<Turning>, length: f64) -> Vec<Layer> {
    let (m, track) = (&trial.measures, &trial.track);
    let side = if trial.side == Side::Starboard { 1.0 } else { -1.0 };
    let mut layers = Vec::new();
    let words = |name: &str, v: f64| {
        let key = name.replace(' ', "_");
        format!("{name} {} L{}", sig(v / length, 3), within(&trial.intervals, &key, |v| sig(v / length, 3)))
    };
    if let (Some(advance), Some(transfer)) = (m.advance, m.transfer) {
        let corner = point(track, advance, 0.0);
        // The advances of both sides are on one line: their words are apart.
        let share = if side > 0.0 { 0.82 } else { 0.62 };
        if let (Some(start), Some(corner), Some(quarter)) =
            (point(track, 0.0, 0.0), corner, point(track, advance, side * transfer))
        {
            layers.extend(measure(&words("advance", advance), [start, corner], share));
            layers.extend(measure(&words("transfer", transfer), [corner, quarter], 0.5));
        }
    }
    let half = m.time_180.zip(track.t.first()).and_then(|(time, start)| state_at(track, start + time));
    if let (Some(diameter), Some(s), Some([x, y, psi, ..])) = (m.tactical_diameter, half, track.states.first()) {
        let ahead = (s[0] - x) * psi.cos() + (s[1] - y) * psi.sin();
        if let (Some(foot), Some(end)) = (point(track, ahead, 0.0), point(track, ahead, side * diameter)) {
            layers.extend(measure(&words("tactical diameter", diameter), [foot, end], 0.55));
        }
    }
    layers
}

/// The peaks of heading after each execute but the first, with the overshoot in words.
pub(super) fn overshoots(trial: &Trial<Zigzag>, color: Color) -> Vec<Layer> {
    let (m, track) = (&trial.measures, &trial.track);
    let start = track.t.first().copied().unwrap_or(0.0);
    let mut layers = Vec::new();
    for (i, overshoot) in m.overshoots.iter().enumerate() {
        let Some(from) = m.executes.get(i + 1).map(|t| start + t) else { continue };
        let to = m.executes.get(i + 2).map_or(f64::INFINITY, |t| start + t);
        let sign = if (trial.side == Side::Starboard) == (i % 2 == 0) { 1.0 } else { -1.0 };
        let between = (0..track.len()).filter(|k| (from..=to).contains(&track.t[*k]));
        let height = |k: &usize| sign * track.states[*k][2];
        let Some(peak) = between.max_by(|a, b| height(a).total_cmp(&height(b))) else { continue };
        let at = (track.t[peak], track.states[peak][2].to_degrees());
        let above = (at.0, at.1 + 0.12 * sign * m.heading.to_degrees().max(1.0) + 1.4 * sign);
        layers.push(Layer::scatter("overshoot", color, [at]).marker(Marker::Diamond));
        let degrees = |v: f64| fixed(v.to_degrees(), 1);
        let interval = within(&trial.intervals, &format!("overshoot_{}", i + 1), degrees);
        layers.push(Layer::text(format!("{} deg{interval}", degrees(*overshoot)), color, above));
    }
    layers
}
