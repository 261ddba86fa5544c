//! A track: the motion of a ship over time, simulated or recorded, from which a trial's measures are read.
//! It does not know which trial it belongs to.

use crate::recording::{Run, or_nan};
use crate::state::STATES;
use std::ops::RangeInclusive;

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

    /// The samples of a range.
    pub fn part(&self, samples: RangeInclusive<usize>) -> Self {
        Self {
            t: self.t[samples.clone()].to_vec(),
            states: self.states[samples.clone()].to_vec(),
            delta: self.delta[samples.clone()].to_vec(),
            n: self.n[samples].to_vec(),
        }
    }

    /// The track through the water: positions less what the current has carried the ship since the first sample, and velocities less
    /// the current in body axes. `current` is where the water sets to over ground, (north, east) \[m/s\], at each sample.
    #[must_use]
    pub fn through_water(&self, current: &[[f64; 2]]) -> Self {
        let mut track = self.clone();
        let mut carried = [0.0; 2];
        for (k, s) in track.states.iter_mut().enumerate().take(current.len()) {
            if k > 0 {
                let dt = self.t[k] - self.t[k - 1];
                for (sum, j) in carried.iter_mut().zip(0..) {
                    *sum += 0.5 * dt * (current[k - 1][j] + current[k][j]);
                }
            }
            let ([north, east], (sin, cos)) = (current[k], s[2].sin_cos());
            (s[0], s[1]) = (s[0] - carried[0], s[1] - carried[1]);
            (s[3], s[4]) = (s[3] - north * cos - east * sin, s[4] + north * sin - east * cos);
        }
        track
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
