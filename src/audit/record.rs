//! The audit of one recording: every question put to it, and the ranges of its channels.
//! Each question is in a file of its own; the study as a whole is in `study`.

use super::frozen::frozen;
use super::gaps::completeness;
use super::issue::{Issue, Severity};
use super::jumps::outliers;
use super::kinematics::Kinematics;
use super::series::Series;
use super::signs::{Rudder, Track};
use super::units::{Turning, magnitudes};
use crate::recording::{Channel, Recording};
use serde::Serialize;
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
    let mut issues = Vec::new();
    completeness(recording, &mut issues);
    magnitudes(recording, &mut issues);
    let series = Series::from(recording);
    let kinematics = agreement([&series], &mut issues);
    frozen(&series, &mut issues);
    outliers(&series, &mut issues);
    issues.sort_by_key(|i| std::cmp::Reverse(i.severity));
    let t = recording.time();
    let stretch = |s: &std::ops::Range<usize>| Stretch {
        first_line: recording.line(s.start),
        last_line: recording.line(s.end - 1),
        from: t[s.start],
        to: t[s.end - 1],
    };
    Audit {
        run: recording.name.clone(),
        path: recording.path.clone(),
        rows: recording.len(),
        duration: recording.duration(),
        step: recording.step(),
        stretches: series.stretches.iter().map(stretch).collect(),
        channels: recording.channels().map(|(c, v)| summary(recording, c, v)).collect(),
        kinematics: Some(kinematics),
        issues,
    }
}

/// Whether the channels tell the same motion, over all series together.
pub fn agreement<'a>(series: impl IntoIterator<Item = &'a Series<'a>>, issues: &mut Vec<Issue>) -> Kinematics {
    let (mut turning, mut track, mut rudder) = (Turning::default(), Track::default(), Rudder::default());
    let mut kinematics = Kinematics::default();
    for one in series {
        kinematics.span = kinematics.span.max(one.span);
        turning.add(one);
        track.add(one);
        rudder.add(one);
    }
    turning.tell(&mut kinematics, issues);
    track.tell(&mut kinematics, issues);
    // Where r itself has the wrong sign, what the rudder does to it says nothing.
    if !issues.iter().any(|i| i.channel == Some(Channel::R) && i.fault == "sign_error") {
        rudder.tell(issues);
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
