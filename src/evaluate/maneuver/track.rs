//! A track: the motion of a ship over time, simulated or recorded, from which a trial's measures are read.
//! It does not know which trial it belongs to.

use crate::recording::{Run, or_nan};
use crate::state::STATES;

/// States and actuators over time, one entry a sample. Units and signs of [`crate::state::State`]; heading not wrapped.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Time \[s\].
    pub t: Vec<f64>,
    /// States `[x, y, psi, u, v, r]`.
    pub states: Vec<[f64; STATES]>,
    /// Rudder angle \[rad\].
    pub delta: Vec<f64>,
    /// Propeller rate \[rps\].
    pub n: Vec<f64>,
}

impl Track {
    /// The measured track of a run; NaN in what was not measured.
    pub fn recorded(run: &Run) -> Self {
        Self {
            t: (0..run.measured.len()).map(|k| run.time(k)).collect(),
            states: run.measured.iter().map(or_nan).collect(),
            delta: run.inputs.iter().map(|i| i.delta).collect(),
            n: run.inputs.iter().map(|i| i.n).collect(),
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// True when there is no sample.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// Speed over ground at a sample \[m/s\].
    pub fn speed(&self, k: usize) -> f64 {
        self.states[k][3].hypot(self.states[k][4])
    }

    /// Distance sailed along the track from sample `from` to sample `to` \[m\].
    pub fn distance(&self, from: usize, to: usize) -> f64 {
        let steps = self.states[from..=to.max(from)].windows(2);
        steps.map(|s| (s[1][0] - s[0][0]).hypot(s[1][1] - s[0][1])).sum()
    }

    /// Position relative to sample `origin`, along and to starboard of a course \[rad\]: (ahead, abeam) \[m\].
    pub(super) fn ahead_abeam(&self, origin: usize, course: f64, at: [f64; 2]) -> [f64; 2] {
        let (north, east) = (at[0] - self.states[origin][0], at[1] - self.states[origin][1]);
        let (sin, cos) = course.sin_cos();
        [north * cos + east * sin, east * cos - north * sin]
    }

    /// The first passage of a quantity through a level, upwards, from sample `from` on: sample before it and fraction of
    /// the step.
    pub(super) fn first_above(
        &self,
        from: usize,
        level: f64,
        quantity: impl Fn(&[f64; STATES]) -> f64,
    ) -> Option<Instant> {
        (from..self.len().saturating_sub(1)).find_map(|k| {
            let (a, b) = (quantity(&self.states[k]) - level, quantity(&self.states[k + 1]) - level);
            (a < 0.0 && b >= 0.0).then(|| Instant { sample: k, fraction: a / (a - b) })
        })
    }

    /// Time of an instant \[s\].
    pub(super) fn time(&self, i: Instant) -> f64 {
        self.t[i.sample] + i.fraction * (self.t[i.sample + 1] - self.t[i.sample])
    }

    /// State at an instant, linear between samples.
    pub(super) fn state(&self, i: Instant) -> [f64; STATES] {
        let (a, b) = (&self.states[i.sample], &self.states[i.sample + 1]);
        std::array::from_fn(|j| a[j] + i.fraction * (b[j] - a[j]))
    }
}

/// An instant between two samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    /// Sample before.
    pub sample: usize,
    /// Fraction of the step after it.
    pub fraction: f64,
}
