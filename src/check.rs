//! Audit of recordings before anything is concluded from them: gaps, frozen channels, outliers, units, signs, time skew, kinematics.
//! It reports doubts about recordings that can be read; what cannot be read is an error of `recording`, passed on here as an issue.

use crate::error::suggestion;
use crate::recording::{CHANNELS, Channel, Recording, STATE_CHANNELS, Split, local, slope};
use crate::study::{Run, Study, StudyError};
use serde::Serialize;
use std::ops::Range;
use std::path::PathBuf;

/// How much an issue weighs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Results may suffer: look before fitting.
    Warning,
    /// The recording contradicts itself, or cannot be used.
    Error,
}

/// A doubt about a recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Issue {
    /// How much it weighs.
    pub severity: Severity,
    /// The channel it is about, if one.
    pub channel: Option<Channel>,
    /// First and last line it is about, if some.
    pub lines: Option<(usize, usize)>,
    /// What was found.
    pub text: String,
    /// What to do next.
    pub next_step: String,
}

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

/// How well position, velocity, heading and yaw rate agree with one another. A gain is what the derivative of the first is, as a
/// multiple of the second: 1 when all is well, -1 for a sign, 57.3 for degrees, 1.94 for knots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Kinematics {
    /// Length of the local quadratic fits that differentiate position and heading \[s\].
    pub span: f64,
    /// Root mean square of d(position)/dt less the velocity turned by the heading \[m/s\].
    pub velocity_rms: Option<f64>,
    /// Gain of the track's velocity on the recorded one.
    pub velocity_gain: Option<f64>,
    /// Angle by which the track's velocity is turned clockwise from the recorded one \[rad\].
    pub track_angle: Option<f64>,
    /// Cosine of similarity of the two, 0 to 1.
    pub velocity_coherence: Option<f64>,
    /// Time by which velocity lags behind the track \[s\].
    pub velocity_lag: Option<f64>,
    /// Position of the recorded point forward of the point whose velocity is recorded \[m\], as sway in turns tells it.
    pub lever: Option<f64>,
    /// Root mean square of d(psi)/dt less r \[rad/s\].
    pub yaw_rate_rms: Option<f64>,
    /// Gain of d(psi)/dt on r.
    pub yaw_rate_gain: Option<f64>,
    /// Time by which r lags behind d(psi)/dt \[s\].
    pub yaw_rate_lag: Option<f64>,
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

    /// The audit of a run that could not be read.
    fn failed(run: &Run, error: &StudyError) -> Self {
        Self {
            run: run.labels.run.clone(),
            path: run.file.clone(),
            rows: 0,
            duration: 0.0,
            step: 0.0,
            stretches: Vec::new(),
            channels: Vec::new(),
            kinematics: None,
            issues: vec![failure(error)],
        }
    }
}

/// The audit of a study: every run, and what comes of cutting them.
#[derive(Clone, Debug, Serialize)]
pub struct StudyAudit {
    /// Name of the study.
    pub study: String,
    /// How the runs are split, in one sentence.
    pub split: String,
    /// One audit a run, in the order listed.
    pub recordings: Vec<Audit>,
    /// Windows to train on.
    pub train_windows: usize,
    /// Windows to test on.
    pub test_windows: usize,
    /// Doubts about the study as a whole.
    pub issues: Vec<Issue>,
}

impl StudyAudit {
    /// The gravest issue's severity, in the study or any run.
    pub fn worst(&self) -> Option<Severity> {
        let own = self.issues.iter().map(|i| i.severity).max();
        own.max(self.recordings.iter().filter_map(Audit::worst).max())
    }
}

/// Audits every run of a study and cuts it as the study says; `draught` \[m\] is the ship's. All runs are audited, whatever is wrong
/// with one.
pub fn audit_study(study: &Study, draught: f64) -> StudyAudit {
    let mut result = StudyAudit {
        study: study.name.clone(),
        split: study.split_in_words(),
        recordings: Vec::new(),
        train_windows: 0,
        test_windows: 0,
        issues: Vec::new(),
    };
    for run in &study.runs {
        let recording = match study.recording(run) {
            Ok(recording) => recording,
            Err(error) => {
                result.recordings.push(Audit::failed(run, &error));
                continue;
            }
        };
        let mut audit = audit(&recording);
        match recording.windows(&run.labels, &study.settings(run, draught)) {
            Ok(windows) => {
                let test = windows.windows.iter().filter(|w| w.split == Split::Test).count();
                result.test_windows += test;
                result.train_windows += windows.windows.len() - test;
                for skipped in windows.skipped {
                    let lines = Some((skipped.first_line, skipped.last_line));
                    let text = format!("{:.2} s, shorter than a window, are left out", skipped.length);
                    audit.issues.push(issue(Severity::Note, None, lines, text, "set a shorter `window` to use them"));
                }
            }
            Err(error) => audit.issues.insert(0, failure(&error.into())),
        }
        result.recordings.push(audit);
    }
    if !study.runs.iter().any(|r| r.labels.split == Split::Test) {
        let text = "no run is kept for testing".to_owned();
        result.issues.push(issue(
            Severity::Warning,
            None,
            None,
            text,
            "set `split = \"test\"` for some runs, or add [split]",
        ));
    }
    if !study.runs.iter().any(|r| r.labels.split == Split::Train) {
        let text = "no run is left to train on".to_owned();
        result.issues.push(issue(Severity::Error, None, None, text, "set `split = \"train\"` for some runs"));
    }
    result
}

/// Audits one recording.
pub fn audit(recording: &Recording) -> Audit {
    let mut issues = Vec::new();
    completeness(recording, &mut issues);
    magnitudes(recording, &mut issues);
    let segments = recording.segments();
    let span = (0.01 * recording.duration()).clamp(8.0 * recording.step(), 60.0_f64.max(8.0 * recording.step()));
    let mut kinematics = Kinematics { span, ..Kinematics::default() };
    yaw(recording, &segments, &mut kinematics, &mut issues);
    velocity(recording, &segments, &mut kinematics, &mut issues);
    rudder_sense(recording, &segments, span, &mut issues);
    frozen(recording, &segments, span, &mut issues);
    outliers(recording, &mut issues);
    issues.sort_by_key(|i| std::cmp::Reverse(i.severity));
    let t = recording.time();
    Audit {
        run: recording.name.clone(),
        path: recording.path.clone(),
        rows: recording.len(),
        duration: recording.duration(),
        step: recording.step(),
        stretches: segments
            .iter()
            .map(|s| Stretch {
                first_line: recording.line(s.start),
                last_line: recording.line(s.end - 1),
                from: t[s.start],
                to: t[s.end - 1],
            })
            .collect(),
        channels: recording.channels().map(|(c, v)| summary(recording, c, v)).collect(),
        kinematics: Some(kinematics),
        issues,
    }
}

fn issue(
    severity: Severity,
    channel: Option<Channel>,
    lines: Option<(usize, usize)>,
    text: String,
    next_step: impl Into<String>,
) -> Issue {
    Issue { severity, channel, lines, text, next_step: next_step.into() }
}

/// An error as an issue; its text already says what to do.
fn failure(error: &StudyError) -> Issue {
    let text = error.to_string();
    let (text, next_step) = text.rsplit_once("; ").unwrap_or((&text, "see the message"));
    issue(Severity::Error, None, None, text.to_owned(), next_step)
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

/// Missing values, gaps, rows without time, uneven steps, unused columns, derived and bridged channels.
fn completeness(recording: &Recording, issues: &mut Vec<Issue>) {
    let span = |rows: &Range<usize>| (recording.line(rows.start), recording.line(rows.end - 1));
    for rows in recording.dropouts() {
        let missing = recording.missing_in(rows.clone());
        let names = missing.iter().map(|c| c.name()).collect::<Vec<_>>().join(", ");
        let one = (missing.len() == 1).then(|| missing[0]);
        let text = format!("{names}: no value in {} rows", rows.len());
        let next = "with `gaps = \"split\"` the study cuts the run here; `bridge` in a column map fills short ones";
        issues.push(issue(Severity::Warning, one, Some(span(&rows)), text, next));
    }
    for &row in &recording.gaps() {
        let gap = recording.time()[row] - recording.time()[row - 1];
        let text = format!("{gap:.3} s without a row, where the step is {:.3} s", recording.step());
        let lines = Some((recording.line(row - 1), recording.line(row)));
        issues.push(issue(
            Severity::Warning,
            Some(Channel::T),
            lines,
            text,
            "with `gaps = \"split\"` the study cuts the run here",
        ));
    }
    for &(first, last) in recording.without_time() {
        let rows = last - first + 1;
        let after_the_end = first > recording.line(recording.len() - 1);
        let (severity, text) = if after_the_end {
            (Severity::Note, format!("the last {rows} rows are blank and are left out"))
        } else {
            (Severity::Warning, format!("{rows} rows have no time and are left out"))
        };
        let next = if after_the_end {
            "nothing, unless the run should be longer"
        } else {
            "remove them, or restore their time"
        };
        issues.push(issue(severity, Some(Channel::T), Some((first, last)), text, next));
    }
    let step = recording.step();
    let longest = 1.5 * step;
    let uneven = recording
        .time()
        .windows(2)
        .map(|t| t[1] - t[0])
        .filter(|s| *s <= longest && (s - step).abs() > 0.1 * step)
        .count();
    if uneven > 0 {
        let text = format!("{uneven} steps differ from the usual {step:.4} s by more than a tenth");
        issues.push(issue(
            Severity::Note,
            Some(Channel::T),
            None,
            text,
            "the grid is interpolated; nothing to do if the times are right",
        ));
    }
    for column in recording.unused() {
        let name = column.split(['[', '(']).next().unwrap_or_default().trim();
        let absent = CHANNELS.iter().filter(|c| !recording.has(c.channel)).map(|c| c.name);
        let near = if name.len() > 2 { suggestion(name, absent) } else { String::new() };
        let severity = if near.is_empty() { Severity::Note } else { Severity::Warning };
        let text = format!("column `{column}` is not used{near}");
        issues.push(issue(severity, None, None, text, "rename it or name it in a column map, if it should be"));
    }
    for (channel, rows) in recording.bridged() {
        let text = format!("{rows} missing values were bridged by straight lines");
        issues.push(issue(
            Severity::Note,
            Some(*channel),
            None,
            text,
            "as the column map asks; shorten `bridge` for less",
        ));
    }
    for channel in recording.derived() {
        let text = "derived from other channels, not recorded".to_owned();
        issues.push(issue(Severity::Note, Some(*channel), None, text, "its agreement with them proves nothing"));
    }
    for channel in STATE_CHANNELS.into_iter().filter(|c| !recording.has(*c)) {
        let text = format!("{} was not recorded", channel.info().words);
        issues.push(issue(Severity::Note, Some(channel), None, text, "the cost carries no weight for it"));
    }
}

/// Actuators too small for their unit.
fn magnitudes(recording: &Recording, issues: &mut Vec<Issue>) {
    // A rudder that never leaves +-1.6 deg, or a shaft under 3 rpm, is more likely radians read as degrees or rps as rpm.
    let least = [(Channel::Delta, 1.6_f64.to_radians(), "rad"), (Channel::N, 0.05, "rps")];
    for (channel, limit, unit) in least {
        let Some(values) = recording.get(channel) else { continue };
        let largest = values.iter().copied().filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
        if largest > 0.0 && largest < limit && recording.unit(channel) != unit {
            let factor = channel.info().quantity.factor(recording.unit(channel)).unwrap_or(1.0);
            let text =
                format!("{} never exceeds {:.3} {}", channel.info().words, largest / factor, recording.unit(channel));
            issues.push(issue(Severity::Warning, Some(channel), None, text, format!("is the column in {unit}?")));
        }
    }
}

/// Known wrong units and signs by the gain they cause on a speed, and what each means.
const SPEED_GAINS: [(f64, &str); 6] = [
    (-1.0, "the sign is turned"),
    (1852.0 / 3600.0, "the column is in knots and was declared m/s"),
    (3600.0 / 1852.0, "the column is in m/s and was declared kn"),
    (1.0 / 3.6, "the column is in km/h and was declared m/s"),
    (3.6, "the column is in m/s and was declared km/h"),
    (-1852.0 / 3600.0, "the column is in knots, was declared m/s, and its sign is turned"),
];

/// The same on a yaw rate.
const TURN_GAINS: [(f64, &str); 7] = [
    (-1.0, "the sign is turned"),
    (1.0 / 57.295_779_5, "the yaw rate is in deg/s and was declared rad/s, or the heading in rad and declared deg"),
    (57.295_779_5, "the yaw rate is in rad/s and was declared deg/s, or the heading in deg and declared rad"),
    (1.0 / 60.0, "the yaw rate is in deg/min and was declared deg/s"),
    (60.0, "the yaw rate is in deg/s and was declared deg/min"),
    (-1.0 / 57.295_779_5, "the yaw rate is in deg/s, was declared rad/s, and its sign is turned"),
    (-57.295_779_5, "the yaw rate is in rad/s, was declared deg/s, and its sign is turned"),
];

/// The known gain within 4 % of `gain`.
fn known_gain(gain: f64, known: &[(f64, &'static str)]) -> Option<&'static str> {
    known.iter().find(|(g, _)| (gain / g - 1.0).abs() < 0.04).map(|(_, meaning)| *meaning)
}

/// Heading against yaw rate.
fn yaw(recording: &Recording, segments: &[Range<usize>], kinematics: &mut Kinematics, issues: &mut Vec<Issue>) {
    let both = recording.get(Channel::Psi).zip(recording.get(Channel::R));
    let Some((psi, r)) = both.filter(|_| !recording.derived().contains(&Channel::R)) else { return };
    let t = recording.time();
    let pairs = |rows: &Range<usize>| {
        let turning = slope(t, psi, rows.clone(), kinematics.span);
        let smooth = local(t, r, rows.clone(), kinematics.span).into_iter().map(|c| c[0]).collect::<Vec<f64>>();
        (turning, smooth)
    };
    let all: Vec<(Vec<f64>, Vec<f64>)> = segments.iter().map(pairs).collect();
    let (a, b): (Vec<f64>, Vec<f64>) = (
        all.iter().flat_map(|p| p.0.iter().copied()).collect(),
        all.iter().flat_map(|p| p.1.iter().copied()).collect(),
    );
    let Some(fit) = Proportion::of(&a, &b) else { return };
    kinematics.yaw_rate_rms = Some(fit.rms);
    kinematics.yaw_rate_gain = Some(fit.gain);
    if fit.coherence.abs() > 0.9 {
        if let Some(meaning) = known_gain(fit.gain, &TURN_GAINS) {
            let text = format!("heading turns {:.4} times as fast as r says: {meaning}", fit.gain);
            let next = "correct the unit, or `sign` and `unit` in a column map";
            issues.push(issue(Severity::Error, Some(Channel::R), None, text, next));
            return;
        }
        if (fit.gain - 1.0).abs() > 0.1 {
            let text = format!("heading turns {:.3} times as fast as r says", fit.gain);
            issues.push(issue(
                Severity::Warning,
                Some(Channel::R),
                None,
                text,
                "check unit and calibration of yaw rate and heading",
            ));
        }
    } else if fit.rms > fit.rms_a && fit.rms_a > 0.0 {
        let text = format!("heading and r do not move together (coherence {:.2})", fit.coherence);
        issues.push(issue(
            Severity::Warning,
            Some(Channel::R),
            None,
            text,
            "check that both columns are what the map says",
        ));
    }
    if let Some((turning, smooth)) = longest(&all) {
        kinematics.yaw_rate_lag = lag(turning, smooth, recording.step());
        told_lag(kinematics.yaw_rate_lag, recording.step(), Channel::R, "the heading", issues);
    }
}

/// Track against velocity.
fn velocity(recording: &Recording, segments: &[Range<usize>], kinematics: &mut Kinematics, issues: &mut Vec<Issue>) {
    let needed = [Channel::X, Channel::Y, Channel::Psi, Channel::U, Channel::V];
    let derived = recording.derived();
    if derived.contains(&Channel::U) || derived.contains(&Channel::V) {
        return;
    }
    let [Some(x), Some(y), Some(psi), Some(u), Some(v)] = needed.map(|c| recording.get(c)) else { return };
    let (t, span) = (recording.time(), kinematics.span);
    let rows = x.len();
    let north: Vec<f64> = (0..rows).map(|i| u[i] * psi[i].cos() - v[i] * psi[i].sin()).collect();
    let east: Vec<f64> = (0..rows).map(|i| u[i] * psi[i].sin() + v[i] * psi[i].cos()).collect();
    let mut pairs: Vec<Motion> = Vec::new();
    let mut lags: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for s in segments {
        let values = |c: &[f64]| local(t, c, s.clone(), span).into_iter().map(|c| c[0]).collect::<Vec<f64>>();
        let (dx, dy) = (slope(t, x, s.clone(), span), slope(t, y, s.clone(), span));
        let (n, e, ub, vb) = (values(&north), values(&east), values(u), values(v));
        let turning = recording.get(Channel::R).map_or_else(|| slope(t, psi, s.clone(), span), values);
        let speed = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a.hypot(*b)).collect::<Vec<f64>>();
        lags.push((speed(&dx, &dy), speed(&n, &e)));
        pairs.extend((0..s.len()).map(|i| Motion {
            track: [dx[i], dy[i]],
            earth: [n[i], e[i]],
            body: [ub[i], vb[i]],
            psi: psi[s.start + i],
            r: turning[i],
        }));
    }
    pairs.retain(|p| p.track.iter().chain(&p.earth).chain(&p.body).all(|v| v.is_finite()) && p.r.is_finite());
    if pairs.is_empty() {
        return;
    }
    let sum = |f: &dyn Fn(&Motion) -> f64| pairs.iter().map(f).sum::<f64>();
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let cross = |a: [f64; 2], b: [f64; 2]| a[1] * b[0] - a[0] * b[1];
    let tt = sum(&|p| dot(p.track, p.track));
    let vv = sum(&|p| dot(p.earth, p.earth));
    if tt <= 0.0 || vv <= 0.0 {
        return;
    }
    let (along, across) = (sum(&|p| dot(p.track, p.earth)), sum(&|p| cross(p.track, p.earth)));
    let coherence = along.hypot(across) / (tt * vv).sqrt();
    let gain = along.hypot(across) / vv;
    let angle = across.atan2(along);
    let difference = |p: &Motion| [p.track[0] - p.earth[0], p.track[1] - p.earth[1]];
    let rms = (sum(&|p| dot(difference(p), difference(p))) / pairs.len() as f64).sqrt();
    kinematics.velocity_rms = Some(rms);
    kinematics.velocity_gain = Some(gain);
    kinematics.track_angle = Some(angle);
    kinematics.velocity_coherence = Some(coherence);

    // Body components of the track, for signs of single channels and the lever arm.
    let track_body = |p: &Motion| {
        let (s, c) = p.psi.sin_cos();
        [p.track[0] * c + p.track[1] * s, p.track[1] * c - p.track[0] * s]
    };
    let column = |f: &dyn Fn(&Motion) -> f64| pairs.iter().map(f).collect::<Vec<f64>>();
    let earth_fixed = sum(&|p| dot(p.track, p.body)) / (tt * vv).sqrt();
    let mirrored = sum(&|p| p.track[0] * p.earth[0] - p.track[1] * p.earth[1])
        .hypot(sum(&|p| p.track[0] * p.earth[1] + p.track[1] * p.earth[0]))
        / (tt * vv).sqrt();
    let degrees = angle.to_degrees();
    if earth_fixed > 0.97 && along / (tt * vv).sqrt() < 0.9 {
        let text = "u and v follow the track along the earth's axes, not the ship's".to_owned();
        issues.push(issue(
            Severity::Error,
            Some(Channel::U),
            None,
            text,
            "set `velocity_frame = \"earth\"` in a column map",
        ));
        return;
    }
    // On a straight course a mirror image and a turned one are the same; heading must vary for the two to differ.
    if mirrored > 0.95 && coherence < 0.98 && 1.0 - mirrored < 0.25 * (1.0 - coherence) {
        let text = "the track is the mirror image of what heading and velocity say".to_owned();
        let next =
            "are x and y exchanged, y positive to port, or heading counted anticlockwise? correct it in a column map";
        issues.push(issue(Severity::Error, Some(Channel::Psi), None, text, next));
        return;
    }
    if coherence > 0.9 {
        if degrees.abs() > 170.0 {
            let text = "the ship moves against its recorded velocity".to_owned();
            issues.push(issue(
                Severity::Error,
                Some(Channel::U),
                None,
                text,
                "turn the sign of u and v, or the heading by 180 deg",
            ));
            return;
        }
        if degrees.abs() > 3.0 {
            let severity = if degrees.abs() > 60.0 { Severity::Error } else { Severity::Warning };
            let text = format!("the track runs {degrees:.1} deg clockwise of heading and velocity");
            let next = "is the heading offset, or a current left out? `offset` in a column map corrects a heading";
            issues.push(issue(severity, Some(Channel::Psi), None, text, next));
        }
        if let Some(meaning) = known_gain(gain, &SPEED_GAINS) {
            let text = format!("the track is {gain:.3} times as fast as the velocity: {meaning}");
            issues.push(issue(
                Severity::Error,
                Some(Channel::U),
                None,
                text,
                "correct the unit of u and v, or of x and y",
            ));
            return;
        }
        if (gain - 1.0).abs() > 0.1 {
            let text = format!("the track is {gain:.3} times as fast as the velocity");
            let next = "check the log's scale, through-water against over-ground speed, and the units of x and y";
            issues.push(issue(Severity::Warning, Some(Channel::U), None, text, next));
        }
    } else {
        let text = format!("track and velocity agree poorly (coherence {coherence:.2}, rms difference {rms:.3} m/s)");
        let next = "check axes, units and reference point of x, y, u and v";
        issues.push(issue(Severity::Warning, Some(Channel::U), None, text, next));
    }
    sway(&column(&|p| track_body(p)[1]), &column(&|p| p.body[1]), &column(&|p| p.r), kinematics, issues);
    if let Some((track, speed)) = longest(&lags) {
        kinematics.velocity_lag = lag(track, speed, recording.step());
        told_lag(kinematics.velocity_lag, recording.step(), Channel::U, "the position", issues);
    }
}

/// Sway of the track against recorded sway: a lever arm between the two points, or a turned sign.
fn sway(track: &[f64], v: &[f64], r: &[f64], kinematics: &mut Kinematics, issues: &mut Vec<Issue>) {
    let difference: Vec<f64> = track.iter().zip(v).map(|(a, b)| a - b).collect();
    let Some(lever) = Proportion::of(&difference, r) else { return };
    kinematics.lever = Some(lever.gain);
    let Some(direct) = Proportion::of(track, v) else { return };
    let flipped: Vec<f64> = track.iter().zip(v).map(|(a, b)| a + b).collect();
    let rms = |v: &[f64]| (v.iter().map(|v| v * v).sum::<f64>() / v.len() as f64).sqrt();
    if rms(&flipped) < 0.3 * rms(&difference) && direct.coherence < -0.8 {
        let text = format!("sway of the track is {:.2} times the recorded v", direct.gain);
        issues.push(issue(
            Severity::Error,
            Some(Channel::V),
            None,
            text,
            "is v positive to port? set `sign = -1` in a column map",
        ));
    } else if lever.coherence.abs() > 0.9 && lever.rms_a > 0.2 * rms(v) {
        let text = format!(
            "in turns the track slides as if positions were taken {:.2} m {} of the point whose velocity is recorded",
            lever.gain.abs(),
            if lever.gain > 0.0 { "forward" } else { "aft" }
        );
        let next = "give `reference_point` and `velocity_point` in a column map";
        issues.push(issue(Severity::Warning, Some(Channel::V), None, text, next));
    }
}

/// One instant of track and velocity.
struct Motion {
    /// d(position)/dt, (north, east).
    track: [f64; 2],
    /// Recorded velocity turned by the heading, (north, east).
    earth: [f64; 2],
    /// Recorded velocity, (forward, starboard).
    body: [f64; 2],
    psi: f64,
    r: f64,
}

/// `a` as a multiple of `b`, least squares without offset.
struct Proportion {
    gain: f64,
    /// Cosine of similarity, -1 to 1.
    coherence: f64,
    /// Root mean square of `a - b`.
    rms: f64,
    /// Root mean square of `a`.
    rms_a: f64,
}

impl Proportion {
    /// `None` when one of them is zero throughout.
    fn of(a: &[f64], b: &[f64]) -> Option<Self> {
        let finite = || a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite());
        let sum = |f: fn(f64, f64) -> f64| finite().map(|(a, b)| f(*a, *b)).sum::<f64>();
        let (aa, ab, bb) = (sum(|a, _| a * a), sum(|a, b| a * b), sum(|_, b| b * b));
        let count = finite().count() as f64;
        let rms = (sum(|a, b| (a - b) * (a - b)) / count).sqrt();
        (aa > 0.0 && bb > 0.0).then(|| Self {
            gain: ab / bb,
            coherence: ab / (aa * bb).sqrt(),
            rms,
            rms_a: (aa / count).sqrt(),
        })
    }
}

/// The pair of longest series.
fn longest(all: &[(Vec<f64>, Vec<f64>)]) -> Option<(&[f64], &[f64])> {
    all.iter().max_by_key(|p| p.0.len()).map(|p| (p.0.as_slice(), p.1.as_slice()))
}

/// Time by which `b` lags behind `a` \[s\]: the shift that leaves the least difference, refined by a parabola through the least
/// and its neighbours. `None` when no shift up to an eighth of the series is clearly the best, so that none can be told.
fn lag(a: &[f64], b: &[f64], step: f64) -> Option<f64> {
    let most = (a.len() / 8).min(100) as isize;
    if most < 3 {
        return None;
    }
    let centred = |v: &[f64]| {
        let mean = v.iter().sum::<f64>() / v.len() as f64;
        v.iter().map(|x| x - mean).collect::<Vec<f64>>()
    };
    let (a, b) = (centred(a), centred(b));
    let margin = most as usize;
    let inner = margin..a.len() - margin;
    // b lags by k: b at row i + k shows what a showed at row i.
    let difference = |k: isize| {
        inner.clone().map(|i| (a[i] - b[i.wrapping_add_signed(k)]).powi(2)).sum::<f64>() / inner.len() as f64
    };
    let table: Vec<f64> = (-most..=most).map(difference).collect();
    let best = (0..table.len()).min_by(|i, j| table[*i].total_cmp(&table[*j]))?;
    let power = inner.clone().map(|i| a[i] * a[i]).sum::<f64>() / inner.len() as f64;
    let edge = best == 0 || best == table.len() - 1;
    if edge || !table[best].is_finite() || table[best] > 0.2 * power {
        return None;
    }
    // Noise alone also has a least shift: one that does not halve the difference is no lag.
    if best != margin && table[best] > 0.5 * table[margin] {
        return None;
    }
    let (before, least, after) = (table[best - 1], table[best], table[best + 1]);
    let bend = before - 2.0 * least + after;
    let shift = if bend > 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
    Some((best as f64 - margin as f64 + shift) * step)
}

fn told_lag(lag: Option<f64>, step: f64, channel: Channel, other: &str, issues: &mut Vec<Issue>) {
    if let Some(lag) = lag.filter(|l| l.abs() > 1.5 * step) {
        let severity = if lag.abs() > 5.0 * step { Severity::Warning } else { Severity::Note };
        let order = if lag > 0.0 { "behind" } else { "ahead of" };
        let text = format!("runs {:.2} s {order} {other}", lag.abs());
        let next = "shift one of the clocks, or ask the maker of the logger for its filter delay";
        issues.push(issue(severity, Some(channel), None, text, next));
    }
}

/// A rudder positive to port: fits Nomoto's `delta = (T/K) dr/dt + (1/K) r + delta_0` (1957) where the ship goes ahead; a stable ship
/// has both coefficients positive, an unstable one the first.
fn rudder_sense(recording: &Recording, segments: &[Range<usize>], span: f64, issues: &mut Vec<Issue>) {
    let [Some(delta), Some(r)] = [Channel::Delta, Channel::R].map(|c| recording.get(c)) else { return };
    let (t, u) = (recording.time(), recording.get(Channel::U));
    let mut normal = nalgebra::Matrix3::<f64>::zeros();
    let mut right = nalgebra::Vector3::<f64>::zeros();
    let mut rows: Vec<(nalgebra::Vector3<f64>, f64)> = Vec::new();
    for s in segments {
        for (i, c) in local(t, r, s.clone(), span).into_iter().enumerate() {
            let row = s.start + i;
            if u.is_none_or(|u| u[row] > 0.0) && c.iter().all(|c| c.is_finite()) {
                rows.push((nalgebra::Vector3::new(c[1], c[0], 1.0), delta[row]));
            }
        }
    }
    for (basis, d) in &rows {
        normal += basis * basis.transpose();
        right += basis * *d;
    }
    let Some(c) = normal.try_inverse().map(|inverse| inverse * right) else { return };
    let mean = rows.iter().map(|(_, d)| d).sum::<f64>() / rows.len() as f64;
    let total = rows.iter().map(|(_, d)| (d - mean).powi(2)).sum::<f64>();
    let left = rows.iter().map(|(b, d)| (d - b.dot(&c)).powi(2)).sum::<f64>();
    if c[0] < 0.0 && c[1] < 0.0 && left < 0.5 * total {
        let text = "the ship turns against its rudder".to_owned();
        issues.push(issue(
            Severity::Warning,
            Some(Channel::Delta),
            None,
            text,
            "is the rudder positive to port? set `sign = -1` in a column map",
        ));
    }
}

/// Fewest rows of one value that are called frozen: of position and heading, which integrate, and of velocities.
const FROZEN_ROWS: [usize; 2] = [10, 50];

/// Channels that stand still while their partners say they should not: position and heading against the integral of the rates,
/// velocities against the derivative of position and heading.
fn frozen(recording: &Recording, segments: &[Range<usize>], span: f64, issues: &mut Vec<Issue>) {
    let t = recording.time();
    for channel in STATE_CHANNELS.into_iter().filter(|c| !recording.derived().contains(c)) {
        let Some(values) = recording.get(channel) else { continue };
        let integrates = matches!(channel, Channel::X | Channel::Y | Channel::Psi);
        let least = FROZEN_ROWS[usize::from(!integrates)];
        let stretches: Vec<Range<usize>> = segments.iter().flat_map(|s| constant(values, s.clone())).collect();
        if stretches.iter().all(|rows| rows.len() < least) {
            continue;
        }
        let partner = if integrates { rate(recording, channel) } else { derivative(recording, channel, span) };
        let Some(partner) = partner else { continue };
        let whole_range = range(&partner);
        let duration = |rows: &Range<usize>| t[rows.end - 1] - t[rows.start];
        let mut still: Vec<Range<usize>> = Vec::new();
        for (i, rows) in stretches.iter().enumerate().filter(|(_, rows)| rows.len() >= least) {
            let stands = if integrates {
                // A channel that is only coarse also stands, but never longer than its neighbouring steps explain.
                let moved: f64 = rows.clone().skip(1).map(|i| partner[i] * (t[i] - t[i - 1])).sum();
                moved.abs() > 5.0 * usual_change(values, &stretches, i)
            } else {
                duration(rows) > 3.0 * span && range(&partner[rows.clone()]) > 0.3 * whole_range
            };
            if stands {
                still.push(rows.clone());
            }
        }
        let Some(longest) = still.iter().max_by(|a, b| duration(a).total_cmp(&duration(b))) else { continue };
        let text = format!(
            "stands still while the ship's other channels move: {} of {:.1} s in all, the longest at {:.4}",
            if still.len() == 1 { "one stretch".to_owned() } else { format!("{} stretches", still.len()) },
            still.iter().map(duration).sum::<f64>(),
            values[longest.start],
        );
        let lines = Some((recording.line(longest.start), recording.line(longest.end - 1)));
        issues.push(issue(Severity::Warning, Some(channel), lines, text, "blank it, so that it counts as a dropout"));
    }
}

/// Rate at which position or heading should change, from the recorded rates.
fn rate(recording: &Recording, channel: Channel) -> Option<Vec<f64>> {
    let get = |c| recording.get(c);
    if channel == Channel::Psi {
        return get(Channel::R).map(<[f64]>::to_vec);
    }
    let (psi, u, v) = (get(Channel::Psi)?, get(Channel::U)?, get(Channel::V)?);
    Some(
        (0..psi.len())
            .map(|i| {
                let (s, c) = psi[i].sin_cos();
                if channel == Channel::X { u[i] * c - v[i] * s } else { u[i] * s + v[i] * c }
            })
            .collect(),
    )
}

/// Velocity or yaw rate as position and heading tell it.
fn derivative(recording: &Recording, channel: Channel, span: f64) -> Option<Vec<f64>> {
    let t = recording.time();
    let psi = recording.get(Channel::Psi)?;
    if channel == Channel::R {
        return Some(slope(t, psi, 0..t.len(), span));
    }
    let (x, y) = (recording.get(Channel::X)?, recording.get(Channel::Y)?);
    let (dx, dy) = (slope(t, x, 0..t.len(), span), slope(t, y, 0..t.len(), span));
    Some(
        (0..t.len())
            .map(|i| {
                let (s, c) = psi[i].sin_cos();
                if channel == Channel::U { dx[i] * c + dy[i] * s } else { dy[i] * c - dx[i] * s }
            })
            .collect(),
    )
}

/// Largest less smallest finite value.
fn range(values: &[f64]) -> f64 {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    finite().fold(f64::MIN, f64::max) - finite().fold(f64::MAX, f64::min)
}

/// Median change of value from stretch to stretch around stretch `at`: motion in a row, or the resolution where that is coarser.
fn usual_change(values: &[f64], stretches: &[Range<usize>], at: usize) -> f64 {
    let near = &stretches[at.saturating_sub(6)..(at + 7).min(stretches.len())];
    let mut changes: Vec<f64> =
        near.windows(2).map(|s| (values[s[1].start] - values[s[0].start]).abs()).filter(|d| *d > 0.0).collect();
    changes.sort_by(f64::total_cmp);
    changes.get(changes.len() / 2).copied().unwrap_or(0.0)
}

/// Stretches of one value within `rows`.
fn constant(values: &[f64], rows: Range<usize>) -> Vec<Range<usize>> {
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for row in rows {
        match stretches.last_mut() {
            Some(last) if values[last.start] == values[row] => last.end = row + 1,
            _ => stretches.push(row..row + 1),
        }
    }
    stretches
}

/// Half-width, in rows, of the running median outliers are measured from.
const MEDIAN_ROWS: usize = 3;

/// Single rows far from the median of their neighbours (Hampel's test, at ten times the usual scatter).
fn outliers(recording: &Recording, issues: &mut Vec<Issue>) {
    for channel in STATE_CHANNELS {
        let Some(values) = recording.get(channel) else { continue };
        let median = |v: &mut Vec<f64>| {
            v.sort_by(f64::total_cmp);
            v[v.len() / 2]
        };
        let finite: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_finite()).collect();
        if finite.len() < 4 * MEDIAN_ROWS {
            continue;
        }
        let from_median: Vec<f64> = (0..finite.len())
            .map(|k| {
                let near = k.saturating_sub(MEDIAN_ROWS)..(k + MEDIAN_ROWS + 1).min(finite.len());
                (values[finite[k]] - median(&mut near.map(|j| values[finite[j]]).collect())).abs()
            })
            .collect();
        // The usual scatter; beside it a tenth of the range, since data without noise have none.
        let usual = 1.4826 * median(&mut from_median.clone());
        let (low, high) = {
            let mut sorted: Vec<f64> = finite.iter().map(|&i| values[i]).collect();
            sorted.sort_by(f64::total_cmp);
            (sorted[sorted.len() / 50], sorted[sorted.len() - 1 - sorted.len() / 50])
        };
        // Ends are left out: there the median is one-sided.
        let inner = MEDIAN_ROWS..finite.len() - MEDIAN_ROWS;
        let far: Vec<usize> = inner.filter(|&k| from_median[k] > (10.0 * usual).max(0.1 * (high - low))).collect();
        let jump = far.len() * 100 > finite.len();
        if let (Some(first), Some(last), false) = (far.first(), far.last(), jump) {
            let lines: Vec<String> = far.iter().take(5).map(|&k| recording.line(finite[k]).to_string()).collect();
            let more = if far.len() > 5 { ", ..." } else { "" };
            let text = match far.len() {
                1 => format!("one value stands far from its neighbours (line {})", lines[0]),
                n => format!("{n} values stand far from their neighbours (lines {}{more})", lines.join(", ")),
            };
            let range = Some((recording.line(finite[*first]), recording.line(finite[*last])));
            issues.push(issue(
                Severity::Warning,
                Some(channel),
                range,
                text,
                "blank them, if they are no motion of the ship",
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::ColumnMap;
    use std::f64::consts::TAU;
    use std::path::Path;

    /// A zigzag-like run: Nomoto's ship under a rudder that swings, position integrated finely from velocity.
    fn swing() -> Vec<(Channel, Vec<f64>)> {
        let (dt, fine) = (0.5, 50);
        let mut state = [0.0, 0.0, 0.3, 0.0];
        let mut columns: [Vec<f64>; 8] = Default::default();
        for i in 0..600 {
            let t = f64::from(i) * dt;
            let delta = 0.3 * (TAU * t / 80.0).sin().signum() + 0.02 * (t * 0.7).sin();
            let (u, v) = (4.0 + 0.5 * (t * 0.02).sin() - 20.0 * state[3] * state[3], -8.0 * state[3]);
            for (column, value) in columns.iter_mut().zip([state[0], state[1], state[2], u, v, state[3], delta, t]) {
                column.push(value);
            }
            for k in 0..fine {
                let h = dt / f64::from(fine);
                let s = t + h * f64::from(k);
                let (u, v) = (4.0 + 0.5 * (s * 0.02).sin() - 20.0 * state[3] * state[3], -8.0 * state[3]);
                let psi: f64 = state[2] + 0.5 * h * state[3];
                state[0] += h * (u * psi.cos() - v * psi.sin());
                state[1] += h * (u * psi.sin() + v * psi.cos());
                state[2] += h * state[3];
                state[3] += h * (0.05 * delta - state[3]) / 8.0;
            }
        }
        let [x, y, psi, u, v, r, delta, t] = columns;
        let n = vec![2.0; t.len()];
        let names = [
            Channel::X,
            Channel::Y,
            Channel::Psi,
            Channel::U,
            Channel::V,
            Channel::R,
            Channel::Delta,
            Channel::T,
            Channel::N,
        ];
        names.into_iter().zip([x, y, psi, u, v, r, delta, t, n]).collect()
    }

    fn values(channels: &mut [(Channel, Vec<f64>)], channel: Channel) -> &mut Vec<f64> {
        &mut channels.iter_mut().find(|(c, _)| *c == channel).unwrap().1
    }

    fn issues(channels: Vec<(Channel, Vec<f64>)>) -> Vec<Issue> {
        audit(&Recording::from_channels("run", channels).unwrap()).issues
    }

    /// Scales a channel of the swing and returns the issues.
    fn scaled(channels: &[Channel], factor: f64) -> Vec<Issue> {
        let mut run = swing();
        for &c in channels {
            values(&mut run, c).iter_mut().for_each(|v| *v *= factor);
        }
        issues(run)
    }

    #[test]
    fn a_consistent_run_raises_nothing() {
        let recording = Recording::from_channels("run", swing()).unwrap();
        let audit = audit(&recording);
        assert_eq!(audit.issues, []);
        let k = audit.kinematics.unwrap();
        assert!(
            (k.yaw_rate_gain.unwrap() - 1.0).abs() < 0.02 && (k.velocity_gain.unwrap() - 1.0).abs() < 0.01,
            "{k:?}"
        );
        assert!(k.yaw_rate_lag.unwrap().abs() < 0.1 && k.track_angle.unwrap().abs() < 0.01, "{k:?}");
    }

    #[test]
    fn wrong_units_and_signs_are_named_by_the_gain_they_cause() {
        let cases = [
            (vec![Channel::R], -1.0, Channel::R, "sign is turned"),
            (vec![Channel::R], 57.295_779_5, Channel::R, "in deg/s and was declared rad/s"),
            (vec![Channel::R], 1.0 / 57.295_779_5, Channel::R, "in rad/s and was declared deg/s"),
            (vec![Channel::R], 60.0, Channel::R, "deg/min"),
            (vec![Channel::U, Channel::V], 1.943_844, Channel::U, "in knots and was declared m/s"),
            (vec![Channel::U, Channel::V], 1.0 / 1.943_844, Channel::U, "in m/s and was declared kn"),
            (vec![Channel::U, Channel::V], -1.0, Channel::U, "against its recorded velocity"),
            (vec![Channel::V], -1.0, Channel::V, "sway of the track"),
            (vec![Channel::Y], -1.0, Channel::Psi, "mirror image"),
        ];
        for (channels, factor, at, words) in cases {
            let found = scaled(&channels, factor);
            let hit = found.iter().find(|i| i.severity == Severity::Error);
            let hit = hit.unwrap_or_else(|| panic!("{channels:?} x {factor}: no error in {found:?}"));
            assert!(hit.channel == Some(at) && hit.text.contains(words), "{channels:?} x {factor}: {hit:?}");
        }
    }

    #[test]
    fn velocities_along_the_earth_axes_are_recognised() {
        let mut run = swing();
        let psi: Vec<f64> = values(&mut run, Channel::Psi).iter().map(|p| p * 2.0).collect();
        // A wider swing of the heading, so that the axes differ.
        *values(&mut run, Channel::Psi) = psi.clone();
        let (u, v) = (values(&mut run, Channel::U).clone(), values(&mut run, Channel::V).clone());
        let north: Vec<f64> = (0..u.len()).map(|i| u[i] * psi[i].cos() - v[i] * psi[i].sin()).collect();
        let east: Vec<f64> = (0..u.len()).map(|i| u[i] * psi[i].sin() + v[i] * psi[i].cos()).collect();
        let integral = |rate: &[f64]| {
            let mut sum = 0.0;
            rate.iter()
                .map(|r| {
                    sum += 0.5 * r;
                    sum
                })
                .collect::<Vec<f64>>()
        };
        *values(&mut run, Channel::X) = integral(&north);
        *values(&mut run, Channel::Y) = integral(&east);
        *values(&mut run, Channel::U) = north;
        *values(&mut run, Channel::V) = east;
        let found = issues(run);
        assert!(found.iter().any(|i| i.next_step.contains("velocity_frame = \"earth\"")), "{found:?}");
    }

    #[test]
    fn a_rudder_positive_to_port_is_recognised() {
        let found = scaled(&[Channel::Delta], -1.0);
        assert!(
            found.iter().any(|i| i.channel == Some(Channel::Delta) && i.text.contains("against its rudder")),
            "{found:?}"
        );
    }

    #[test]
    fn a_late_channel_is_told_with_its_lag() {
        for late in [4_usize, 8] {
            let mut run = swing();
            let r = values(&mut run, Channel::R);
            r.rotate_right(late);
            r[..late].fill(0.0);
            let audit = audit(&Recording::from_channels("run", run).unwrap());
            let lag = audit.kinematics.unwrap().yaw_rate_lag.unwrap();
            assert!((lag - 0.5 * late as f64).abs() < 0.1, "{lag}");
            assert!(audit.issues.iter().any(|i| i.channel == Some(Channel::R) && i.text.contains("behind")));
        }
    }

    #[test]
    fn a_position_taken_off_midship_is_told_with_its_lever() {
        let mut run = swing();
        let psi = values(&mut run, Channel::Psi).clone();
        values(&mut run, Channel::X).iter_mut().zip(&psi).for_each(|(x, p)| *x += 30.0 * p.cos());
        values(&mut run, Channel::Y).iter_mut().zip(&psi).for_each(|(y, p)| *y += 30.0 * p.sin());
        let audit = audit(&Recording::from_channels("run", run).unwrap());
        assert!((audit.kinematics.unwrap().lever.unwrap() - 30.0).abs() < 1.0);
        assert!(audit.issues.iter().any(|i| i.next_step.contains("reference_point")), "{:?}", audit.issues);
    }

    #[test]
    fn a_frozen_channel_is_told_with_its_lines() {
        for channel in [Channel::X, Channel::Psi] {
            let mut run = swing();
            let v = values(&mut run, channel);
            let value = v[200];
            v[200..300].fill(value);
            let found = issues(run);
            let hit = found.iter().find(|i| i.channel == Some(channel) && i.text.contains("stands still")).unwrap();
            assert_eq!(hit.lines, Some((202, 301)));
        }
    }

    #[test]
    fn an_outlier_is_told_with_its_line() {
        let mut run = swing();
        values(&mut run, Channel::U)[123] += 3.0;
        let found = issues(run);
        let hit = found.iter().find(|i| i.channel == Some(Channel::U) && i.text.contains("far from")).unwrap();
        assert_eq!(hit.lines, Some((125, 125)));
    }

    #[test]
    fn dropouts_and_gaps_are_warnings_with_lines() {
        let mut run = swing();
        values(&mut run, Channel::U)[10..14].fill(f64::NAN);
        values(&mut run, Channel::T)[300..].iter_mut().for_each(|t| *t += 7.0);
        let found = issues(run);
        assert!(found.iter().any(|i| i.lines == Some((12, 15)) && i.severity == Severity::Warning), "{found:?}");
        assert!(found.iter().any(|i| i.lines == Some((301, 302)) && i.text.contains("7.500 s")), "{found:?}");
    }

    #[test]
    fn a_rudder_in_radians_declared_in_degrees_is_suspected() {
        let mut text = "t [s],n [rps],delta [deg]\n".to_owned();
        (0..30).for_each(|i| text.push_str(&format!("{i},2,{}\n", 0.4 * f64::from(i).sin())));
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("run.csv");
        std::fs::write(&file, text).unwrap();
        let map = ColumnMap::parse("", Path::new("columns.toml")).unwrap();
        let audit = audit(&Recording::read(&file, &map).unwrap());
        assert!(
            audit.issues.iter().any(|i| i.channel == Some(Channel::Delta) && i.next_step.contains("rad")),
            "{:?}",
            audit.issues
        );
    }
}
