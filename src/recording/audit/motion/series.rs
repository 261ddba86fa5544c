//! The motion that an audit reads, whether of a recording or of runs cut from one: columns by channel, NaN where a value is missing.
//! It judges nothing; the checks are in the other files of this folder.

use crate::recording::audit::limits::SPAN;
use crate::recording::{Channel, Recording, Run, STATE_CHANNELS, local, slope};
use crate::state::STATES;
use crate::statistics::mean;
use std::borrow::Cow;
use std::ops::Range;

/// Rows of a recording or of a run.
pub struct Series<'a> {
    /// Time \[s\].
    pub t: Cow<'a, [f64]>,
    /// Usual step \[s\].
    pub step: f64,
    /// Length of the local quadratic fits that differentiate position and heading \[s\].
    pub span: f64,
    /// Unbroken stretches of rows.
    pub stretches: Vec<Range<usize>>,
    state: [Option<Cow<'a, [f64]>>; STATES],
    derived: [bool; STATES],
    recording: Option<&'a Recording>,
    /// Propeller rate \[1/s\].
    pub n: Option<Cow<'a, [f64]>>,
    /// Rudder angle \[rad\].
    pub delta: Option<Cow<'a, [f64]>>,
}

/// Mean square of the values that are there; `None` without any.
pub fn mean_square(values: &[f64]) -> Option<f64> {
    mean(values.iter().filter(|v| v.is_finite()).map(|v| v * v))
}

/// Stretches of one value within `rows`.
pub fn constant(values: &[f64], rows: Range<usize>) -> Vec<Range<usize>> {
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for row in rows {
        match stretches.last_mut() {
            Some(last) if values[last.start] == values[row] => last.end = row + 1,
            _ => stretches.push(row..row + 1),
        }
    }
    stretches
}

/// Sizes of the changes from stretch to stretch of one value.
pub fn changes(values: &[f64], stretches: &[Range<usize>]) -> impl Iterator<Item = f64> {
    stretches.windows(2).map(|s| (values[s[1].start] - values[s[0].start]).abs()).filter(|change| *change > 0.0)
}

/// Length of the local fits for a motion of some duration and step \[s\].
fn span(duration: f64, step: f64) -> f64 {
    let shortest = SPAN.0 * step;
    (SPAN.2 * duration).clamp(shortest, SPAN.1.max(shortest))
}

impl<'a> From<&'a Recording> for Series<'a> {
    fn from(recording: &'a Recording) -> Self {
        let column = |c: Channel| recording.get(c).map(Cow::Borrowed);
        Self {
            t: Cow::Borrowed(recording.time()),
            step: recording.step(),
            span: span(recording.duration(), recording.step()),
            stretches: recording.segments(),
            state: STATE_CHANNELS.map(column),
            derived: STATE_CHANNELS.map(|c| recording.derived().contains(&c)),
            recording: Some(recording),
            n: column(Channel::N),
            delta: column(Channel::Delta),
        }
    }
}

impl From<&Run> for Series<'static> {
    fn from(run: &Run) -> Self {
        let channels = run.channels();
        let column = |c: usize| run.measured.iter().map(|m| m[c].unwrap_or(f64::NAN)).collect();
        Self {
            t: run.inputs.iter().map(|i| i.t).collect(),
            step: run.dt,
            span: span(run.duration(), run.dt),
            stretches: std::iter::once(0..run.measured.len()).collect(),
            state: std::array::from_fn(|c| channels[c].then(|| column(c))),
            derived: run.derived,
            recording: None,
            n: Some(run.inputs.iter().map(|i| i.n).collect()),
            delta: Some(run.inputs.iter().map(|i| i.delta).collect()),
        }
    }
}

impl Series<'_> {
    /// A channel of the state, recorded or derived.
    pub fn get(&self, channel: Channel) -> Option<&[f64]> {
        let at = STATE_CHANNELS.iter().position(|c| *c == channel)?;
        self.state[at].as_deref()
    }

    /// A channel of the state as recorded: a derived one agrees with its sources, whatever they are.
    pub fn recorded(&self, channel: Channel) -> Option<&[f64]> {
        let at = STATE_CHANNELS.iter().position(|c| *c == channel)?;
        self.state[at].as_deref().filter(|_| !self.derived[at])
    }

    /// First and last line of some rows in the file they were read from; `None` for a run.
    pub fn lines(&self, rows: &Range<usize>) -> Option<(usize, usize)> {
        self.recording.map(|r| (r.line(rows.start), r.line(rows.end - 1)))
    }

    /// Values of a channel smoothed over the span, in a stretch.
    pub fn smooth(&self, values: &[f64], stretch: &Range<usize>) -> Vec<f64> {
        local(&self.t, values, stretch.clone(), self.span).into_iter().map(|c| c[0]).collect()
    }

    /// Rate of change of a channel over the span, in a stretch.
    pub fn slope(&self, values: &[f64], stretch: &Range<usize>) -> Vec<f64> {
        slope(&self.t, values, stretch.clone(), self.span)
    }
}
