//! The audit of one recording: every question put to it, and the ranges of its channels.
//! Each question is in a file of its own; the study as a whole is in `study`.

use super::agreement::reckoning::Reckoned;
use super::agreement::signs::{Actuators, Track};
use super::agreement::units::{Turning, magnitudes, still};
use super::issue::{Issue, Severity};
use super::motion::kinematics::Kinematics;
use super::motion::response::{Curve, gyro, propeller, receiver, rudder, sway};
use super::motion::series::Series;
use super::values::fill::fills;
use super::values::fixes::{fixes, headings};
use super::values::frozen::frozen;
use super::values::gaps::completeness;
use super::values::jumps::outliers;
use crate::recording::{Channel, Recording};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Range of a channel in a run, SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelSummary {
    /// The channel.
    pub channel: Channel,
    /// Its SI unit.
    pub unit: &'static str,
    /// The unit in the file.
    pub recorded_in: String,
    /// Smallest value; absent when there is none.
    pub min: Option<f64>,
    /// Mean.
    pub mean: Option<f64>,
    /// Largest value.
    pub max: Option<f64>,
    /// Rows without a value.
    pub missing: usize,
    /// Derived from other channels, not recorded.
    pub derived: bool,
}

/// An unbroken stretch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stretch {
    /// First line.
    pub first_line: usize,
    /// Last line.
    pub last_line: usize,
    /// First time \[s\].
    pub from: f64,
    /// Last time \[s\].
    pub to: f64,
}

/// The audit of a recording.
#[derive(Clone, Debug, Serialize)]
pub struct Audit {
    /// Name of the run.
    pub run: String,
    /// The file.
    pub path: PathBuf,
    /// Rows with a time.
    pub rows: usize,
    /// Length \[s\].
    pub duration: f64,
    /// Usual step \[s\].
    pub step: f64,
    /// Unbroken stretches.
    pub stretches: Vec<Stretch>,
    /// Ranges of the channels there are.
    pub channels: Vec<ChannelSummary>,
    /// Agreement of the state channels; absent when the file could not be read.
    pub kinematics: Option<Kinematics>,
    /// Doubts, the gravest first.
    pub issues: Vec<Issue>,
}

impl Audit {
    /// The gravest issue's severity.
    pub fn worst(&self) -> Option<Severity> {
        self.issues.iter().map(|i| i.severity).max()
    }
}

/// Audits one recording.
pub fn audit(recording: &Recording) -> Audit {
    examined(recording).0
}

/// How the motion of a recording answers what is recorded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Responses {
    /// Yaw to rudder.
    pub rudder: Option<Curve>,
    /// Surge to propeller.
    pub propeller: Option<Curve>,
    /// Sway to the turn.
    pub sway: Option<Curve>,
    /// Heading to yaw rate.
    pub gyro: Option<Curve>,
    /// Position to velocity and heading.
    pub receiver: Option<Curve>,
    /// Track to dead reckoning.
    pub reckoned: Option<Reckoned>,
}

impl Responses {
    /// Those of some rows.
    pub fn of(series: &Series<'_>) -> Self {
        Self {
            rudder: rudder(series),
            propeller: propeller(series),
            sway: sway(series),
            gyro: gyro(series),
            receiver: receiver(series),
            reckoned: Reckoned::of(series),
        }
    }
}

/// Audits one recording, and gives what is compared with other recordings.
pub(super) fn examined(recording: &Recording) -> (Audit, Responses) {
    let mut issues = Vec::new();
    completeness(recording, &mut issues);
    // What was found so far would be found again and again in what follows.
    let filled = fills(recording, &mut issues);
    let recording = filled.as_ref().unwrap_or(recording);
    let mut reported = Vec::new();
    if fixes(recording, &mut issues) {
        reported.extend([Channel::X, Channel::Y]);
    }
    let turned = headings(recording, &mut issues).then(|| recording.with_repaired_heading());
    reported.extend(turned.as_ref().map(|_| Channel::Psi));
    let recording = turned.as_ref().unwrap_or(recording);
    magnitudes(recording, &mut issues);
    still(recording, &mut issues);
    let whole = Series::from(recording);
    let stands = frozen(&whole, &mut issues);
    let without = |left: Option<Recording>, (channel, rows): &(Channel, Vec<usize>)| {
        Some(left.as_ref().unwrap_or(recording).without(*channel, rows))
    };
    let moving = stands.iter().fold(None, without);
    let series = moving.as_ref().map_or(whole, Series::from);
    let responses = Responses::of(&series);
    let kinematics = agreement([(&series, &responses)], &mut issues);
    outliers(recording, &reported, &mut issues);
    issues.sort_by_key(|i| std::cmp::Reverse(i.severity));
    let t = recording.time();
    let stretch = |s: &std::ops::Range<usize>| Stretch {
        first_line: recording.line(s.start),
        last_line: recording.line(s.end - 1),
        from: t[s.start],
        to: t[s.end - 1],
    };
    let audit = Audit {
        run: recording.name.clone(),
        path: recording.path.clone(),
        rows: recording.len(),
        duration: recording.duration(),
        step: recording.step(),
        stretches: series.stretches.iter().map(stretch).collect(),
        channels: recording.channels().map(|(c, v)| summary(recording, c, v)).collect(),
        kinematics: Some(kinematics),
        issues,
    };
    (audit, responses)
}

/// Whether the channels show the same motion, over all series together.
pub fn agreement<'a>(
    series: impl IntoIterator<Item = (&'a Series<'a>, &'a Responses)>,
    issues: &mut Vec<Issue>,
) -> Kinematics {
    let (mut turning, mut track, mut actuators) = (Turning::default(), Track::default(), Actuators::default());
    let mut course = Track::default();
    let mut kinematics = Kinematics::default();
    for (one, responses) in series {
        kinematics.span = kinematics.span.max(one.span);
        turning.add(one);
        track.add(one);
        course.add_course(one);
        actuators.add(one, responses.rudder.as_ref());
    }
    let (turn, speed) = (turning.gain(), track.gain());
    let axes = issues.len();
    turning.tell(&mut kinematics, speed, issues);
    track.tell(&mut kinematics, turn, issues);
    issues.extend(course.mirrored(turn));
    // A mirror image turns against every rudder.
    let mirrored = issues[axes..].iter().any(|i| i.fault == "axes_error" && i.blocking());
    // Where r itself has the wrong sign, what the rudder does to it says nothing.
    let of = |issues: &[Issue], channels: &[Channel]| {
        issues.iter().any(|i| i.fault == "sign_error" && i.channel.is_some_and(|c| channels.contains(&c)))
    };
    if !mirrored && !of(issues, &[Channel::R, Channel::U]) {
        actuators.tell(issues);
    }
    kinematics
}

fn summary(recording: &Recording, channel: Channel, values: &[f64]) -> ChannelSummary {
    let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let over = |f: fn(f64, f64) -> f64| finite.iter().copied().reduce(f);
    ChannelSummary {
        channel,
        unit: channel.info().quantity.si(),
        recorded_in: recording.unit(channel).to_owned(),
        min: over(f64::min),
        mean: over(|a, b| a + b).map(|sum| sum / finite.len() as f64),
        max: over(f64::max),
        missing: values.len() - finite.len(),
        derived: recording.derived().contains(&channel),
    }
}
