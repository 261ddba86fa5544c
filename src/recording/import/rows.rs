//! From signals with their own times to rows that have them all, cut into recordings; what was not recorded stays missing.
//! No drop-out is filled but from channels that measure the same: a row without a value keeps the field blank, and a long gap ends the recording.

use super::columns::take::Signals;
use super::signals::log::Meaning;
use super::signals::motion::Track;
use super::signals::signal::{GAP_IN_STEPS, Signal, nearest};
use crate::numerals::sig;
use crate::recording::{CHANNELS, Channel};
use std::ops::Range;

/// The rows of one recording.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Time of each row, on the clock of the files \[s\].
    pub t: Vec<f64>,
    /// Channels in SI units, NaN where a value is missing.
    pub channels: Vec<(Channel, Vec<f64>)>,
    /// Usual step \[s\].
    pub step: f64,
}

/// Signals that set the rows: measured motion, of which nothing is to be made up between samples.
fn leading(signals: &Signals) -> Vec<&Signal> {
    let of = |channel| signals.by.get(&Meaning::Channel(channel));
    let motion: Vec<&Signal> = [of(Channel::X), of(Channel::Psi)].into_iter().flatten().collect();
    if !motion.is_empty() {
        return motion;
    }
    let speeds = [signals.by.get(&Meaning::GroundSpeed), of(Channel::U), of(Channel::R)];
    speeds.into_iter().flatten().take(1).collect()
}

/// Times of the rows and their step: those of the slower of position and heading, and in its gaps those of the other where it is
/// as slow.
fn times(signals: &Signals) -> (Vec<f64>, f64) {
    let leading = leading(signals);
    let Some(slowest) = leading.iter().max_by(|a, b| a.step.total_cmp(&b.step)) else { return (Vec::new(), 0.0) };
    let mut times = slowest.t.clone();
    for other in leading.iter().filter(|s| s.step > 0.9 * slowest.step) {
        times.extend(other.t.iter().filter(|t| !slowest.has_near(**t, 0.75 * slowest.step)));
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    if slowest.is_uneven() {
        return even(slowest);
    }
    (times, slowest.step)
}

/// Even times in the unbroken stretches of a signal whose own times are uneven, as many as it has samples.
fn even(signal: &Signal) -> (Vec<f64>, f64) {
    let stretches: Vec<Range<usize>> = signal.stretches().into_iter().filter(|s| s.len() > 1).collect();
    let lasts = |s: &Range<usize>| signal.t[s.end - 1] - signal.t[s.start];
    let steps: usize = stretches.iter().map(|s| s.len() - 1).sum();
    let step = stretches.iter().map(lasts).sum::<f64>() / steps.max(1) as f64;
    // To a millisecond, so that the rows of a recording are as even as they are written.
    let step = ((step * 1e3).round() * 1e-3).max(1e-3);
    let mut times = Vec::new();
    for stretch in stretches {
        let count = (lasts(&stretch) / step + 1e-6) as usize;
        times.extend((0..=count).map(|i| signal.t[stretch.start] + i as f64 * step));
    }
    (times, step)
}

/// A channel that is missing in more than this share of the rows in which others give it is taken from them there, and one that is
/// missing in less keeps its blanks.
const OFTEN: f64 = 0.02;

/// Takes the yaw rate from the heading, and the velocity from position and heading, where they are blank and the others are not; says
/// how many values and of what.
fn complete(signals: &Signals, rows: &mut Rows) -> Vec<String> {
    let of = |channel| signals.by.get(&Meaning::Channel(channel));
    let Some(psi) = of(Channel::Psi) else { return Vec::new() };
    let rate = psi.rate(psi.span());
    let track = of(Channel::X).zip(of(Channel::Y)).and_then(|(x, y)| Track::of(x, y));
    let mut notes = Vec::new();
    for (channel, from) in
        [(Channel::R, "the heading"), (Channel::U, "position and heading"), (Channel::V, "position and heading")]
    {
        let Some((_, values)) = rows.channels.iter_mut().find(|(c, _)| *c == channel) else { continue };
        let given = |t: f64| match (channel, &track) {
            (Channel::R, _) => rate.at(t, rows.step),
            (_, None) => f64::NAN,
            (_, Some(track)) => {
                let (sin, cos) = psi.at(t, rows.step).sin_cos();
                let (north, east) = (track.north.at(t, rows.step), track.east.at(t, rows.step));
                if channel == Channel::U { north * cos + east * sin } else { east * cos - north * sin }
            }
        };
        let blank: Vec<(usize, f64)> = values
            .iter()
            .zip(&rows.t)
            .enumerate()
            .filter(|(_, (v, _))| v.is_nan())
            .map(|(i, (_, t))| (i, given(*t)))
            .filter(|(_, v)| v.is_finite())
            .collect();
        if blank.is_empty() || (channel != Channel::R && blank.len() as f64 <= OFTEN * values.len() as f64) {
            continue;
        }
        notes.push(format!(
            "{channel}: {} of {} values are blank and follow from {from}, so that no run ends there",
            blank.len(),
            values.len()
        ));
        blank.into_iter().for_each(|(i, v)| values[i] = v);
    }
    notes
}

/// Every channel at every row.
pub fn rows(signals: &Signals) -> (Rows, Vec<String>) {
    let (t, step) = times(signals);
    let at = |meaning: Meaning| {
        let signal = signals.by.get(&meaning)?;
        // A direction counts no turns; a heading goes on, so that turns can be seen.
        let counts = !meaning.wraps() || meaning == Meaning::Channel(Channel::Psi);
        let within = |v: f64| if counts || v.is_nan() { v } else { nearest(v) };
        Some(t.iter().map(|t| within(signal.at(*t, step))).collect::<Vec<f64>>())
    };
    let mut channels: Vec<(Channel, Vec<f64>)> = Vec::new();
    for info in CHANNELS.iter().filter(|c| c.channel != Channel::T) {
        channels.extend(at(Meaning::Channel(info.channel)).map(|v| (info.channel, v)));
    }
    let commands = signals.by.keys().filter_map(|m| match m {
        Meaning::Channel(channel @ Channel::Command(_)) => Some(*channel),
        _ => None,
    });
    channels.extend(commands.filter_map(|channel| Some((channel, at(Meaning::Channel(channel))?))));
    let has = |channel| channels.iter().any(|(c, _)| *c == channel);
    let has_wind = has(Channel::WindDirection);
    let psi = channels.iter().find(|(c, _)| *c == Channel::Psi).map(|(_, v)| v.clone());
    if let (false, Some(psi)) = (has(Channel::U) || has(Channel::V), psi) {
        let polar = at(Meaning::GroundSpeed).zip(at(Meaning::Course)).map(|(speed, course)| {
            speed.iter().zip(course).map(|(s, c)| [s * c.cos(), s * c.sin()]).collect::<Vec<[f64; 2]>>()
        });
        let parts = at(Meaning::VelocityNorth).zip(at(Meaning::VelocityEast));
        let velocity = polar.or_else(|| parts.map(|(n, e)| n.into_iter().zip(e).map(|(n, e)| [n, e]).collect()));
        if let Some(velocity) = velocity {
            let body = |axis: usize| {
                let along = |(v, psi): (&[f64; 2], &f64)| {
                    let (sin, cos) = psi.sin_cos();
                    [v[0] * cos + v[1] * sin, v[1] * cos - v[0] * sin][axis]
                };
                velocity.iter().zip(&psi).map(along).collect::<Vec<f64>>()
            };
            channels.push((Channel::U, body(0)));
            channels.push((Channel::V, body(1)));
        }
    }
    let heading = at(Meaning::Channel(Channel::Psi));
    if let (false, Some(angle), Some(psi)) = (has_wind, at(Meaning::WindAngle), heading) {
        let direction =
            angle.iter().zip(&psi).map(|(a, psi)| if a.is_nan() || psi.is_nan() { f64::NAN } else { nearest(a + psi) });
        channels.push((Channel::WindDirection, direction.collect()));
    }
    channels.sort_by_key(|(channel, _)| *channel);
    let mut rows = Rows { t, channels, step };
    let mut notes = complete(signals, &mut rows);
    if leading(signals).iter().any(|s| s.is_uneven()) {
        notes.push(format!(
            "the rows come at uneven times; they are brought to even steps of {} s by straight lines",
            sig(step, 4)
        ));
    }
    (rows, notes)
}

impl Rows {
    /// Time from the first to the last row \[s\].
    pub fn duration(&self) -> f64 {
        self.t.last().zip(self.t.first()).map_or(0.0, |(last, first)| last - first)
    }

    /// Cuts the rows where more than `longest` seconds pass, and at the times in `boundaries` where anything is missing.
    pub fn cut(&self, longest: f64, boundaries: &[f64]) -> Vec<Self> {
        let mut parts = Vec::new();
        let mut start = 0;
        for i in 1..=self.t.len() {
            let ends = i == self.t.len() || {
                let (before, after) = (self.t[i - 1], self.t[i]);
                let passes = boundaries.iter().any(|b| before < *b && *b <= after);
                after - before > longest || (passes && after - before > GAP_IN_STEPS * self.step)
            };
            if ends {
                let channels = self.channels.iter().map(|(c, v)| (*c, v[start..i].to_vec()));
                let part = Self { t: self.t[start..i].to_vec(), channels: channels.collect(), step: self.step };
                parts.push(part.without_empty_rows());
                start = i;
            }
        }
        parts
    }

    /// The same without rows that have no value at all, and without channels that have none.
    fn without_empty_rows(mut self) -> Self {
        let kept: Vec<bool> = (0..self.t.len()).map(|i| self.channels.iter().any(|(_, v)| v[i].is_finite())).collect();
        let keep = |values: &mut Vec<f64>| {
            let mut kept = kept.iter();
            values.retain(|_| kept.next().is_some_and(|k| *k));
        };
        keep(&mut self.t);
        self.channels.iter_mut().for_each(|(_, v)| keep(v));
        self.channels.retain(|(_, v)| v.iter().any(|v| v.is_finite()));
        self
    }

    /// Takes values no ship reaches for missing, and says how many of which channel.
    pub fn blank_impossible(&mut self) -> Vec<(Channel, usize, f64)> {
        let mut found = Vec::new();
        for (channel, values) in &mut self.channels {
            let (low, high) = channel.info().limits;
            // A heading may turn as often as it likes until the file is written, where it is wrapped.
            if *channel == Channel::Psi {
                continue;
            }
            let mut first = None;
            let mut count = 0;
            for v in values.iter_mut().filter(|v| v.is_finite()) {
                if !(low..=high).contains(v) {
                    first = first.or(Some(*v));
                    count += 1;
                    *v = f64::NAN;
                }
            }
            found.extend(first.map(|v| (*channel, count, v)));
        }
        found
    }
}
