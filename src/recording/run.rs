//! A run: a stretch of samples on a uniform grid with inputs, measured states and an initial state, as every command takes it.
//! It contains what was recorded and nothing that follows from a model; how recordings are cut into runs is in `window`.

use crate::state::{Inputs, STATES};
use serde::{Deserialize, Serialize};

/// On which side of the split a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Split {
    /// Parameters are fitted to it.
    Train,
    /// It is kept aside to judge the fit.
    Test,
}

/// A measured state `[x, y, psi, u, v, r]`; `None` in a channel that has no value at this sample.
pub type Measured = [Option<f64>; STATES];

/// States as measured in full; an entry that is not finite counts as not measured.
pub fn measured(states: &[[f64; STATES]]) -> Vec<Measured> {
    states.iter().map(|s| s.map(|v| Some(v).filter(|v| v.is_finite()))).collect()
}

/// A measured state with NaN where there is no value, for sums that are to be NaN where one of their parts is missing.
pub fn or_nan(sample: &Measured) -> [f64; STATES] {
    sample.map(|v| v.unwrap_or(f64::NAN))
}

/// A stretch of a recording on a uniform grid: `inputs` and `measured` have one entry a sample, steps + 1 in all.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Name of this stretch, unique in a study.
    pub name: String,
    /// Name of the recording it was cut from. What is cut from one recording shares conditions, and counts as one cluster where
    /// standard errors allow for that.
    pub recording: String,
    /// Session (a day, a voyage): what may share a hidden condition.
    pub session: String,
    /// Kind of manoeuvre.
    pub manoeuvre: String,
    /// Train or test.
    pub split: Split,
    /// Sample period \[s\].
    pub dt: f64,
    /// Usual time between two rows of the recording \[s\]: less than `dt` where the recording was thinned.
    pub recorded_dt: f64,
    /// Inputs at each sample.
    pub inputs: Vec<Inputs<f64>>,
    /// Measured `[x, y, psi, u, v, r]` at each sample, `None` where a channel has no value.
    pub measured: Vec<Measured>,
    /// State at the first sample, in every channel.
    pub initial: [f64; STATES],
    /// Ranges of samples, ends included, in which a known event pushed the ship: there an unknown force may be anything.
    pub disturbed: Vec<(usize, usize)>,
    /// Which channels are derived from other recorded ones, and no observation of their own.
    pub derived: [bool; STATES],
}

impl Run {
    /// What a sensor recorded of a channel at a sample; `None` where nothing was, and of a derived channel, which repeats what those say
    /// that it is derived from.
    #[inline]
    pub fn recorded(&self, sample: usize, channel: usize) -> Option<f64> {
        self.measured.get(sample)?[channel].filter(|_| !self.derived[channel])
    }

    /// Number of steps.
    pub fn steps(&self) -> usize {
        self.inputs.len().saturating_sub(1)
    }

    /// Length \[s\].
    pub fn duration(&self) -> f64 {
        self.steps() as f64 * self.dt
    }

    /// Time of the first sample on the recording's clock \[s\].
    pub fn start_time(&self) -> f64 {
        self.inputs.first().map_or(0.0, |i| i.t)
    }

    /// Time of a sample on the recording's clock \[s\].
    pub fn time(&self, sample: usize) -> f64 {
        self.start_time() + sample as f64 * self.dt
    }

    /// Which channels were measured at all.
    pub fn channels(&self) -> [bool; STATES] {
        std::array::from_fn(|c| self.measured.iter().any(|m| m[c].is_some()))
    }

    /// True at samples next to or within a known event.
    pub fn disturbed_at(&self, sample: usize) -> bool {
        self.disturbed.iter().any(|(from, to)| *from <= sample + 1 && sample <= *to + 1)
    }

    /// Length of the measured track \[m\]; from the measured speed where no position was measured.
    pub fn path_length(&self) -> f64 {
        let mut track = self.measured.iter().filter_map(|m| m[0].zip(m[1]));
        let Some(mut last) = track.next() else { return self.mean_speed() * self.duration() };
        let mut length = 0.0;
        for place in track {
            length += (place.0 - last.0).hypot(place.1 - last.1);
            last = place;
        }
        length
    }

    /// Mean of the measured speed over ground \[m/s\]; from the track where no velocity was measured, from the measured u where
    /// neither was.
    pub fn mean_speed(&self) -> f64 {
        let mean = |speed: &dyn Fn(&Measured) -> Option<f64>| {
            let (mut sum, mut count) = (0.0, 0.0);
            for value in self.measured.iter().filter_map(speed) {
                sum += value;
                count += 1.0;
            }
            (count > 0.0).then(|| sum / count)
        };
        let channels = self.channels();
        if let Some(speed) = mean(&|m| Some(m[3]?.hypot(m[4]?))) {
            speed
        } else if channels[0] && channels[1] {
            self.path_length() / self.duration()
        } else {
            mean(&|m| m[3].map(f64::abs)).unwrap_or(0.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten samples north at 2 m/s, 1 s apart.
    fn north() -> Run {
        let states: Vec<[f64; STATES]> = (0..10).map(|k| [2.0 * f64::from(k), 0.0, 0.0, 2.0, 0.0, 0.0]).collect();
        Run {
            name: "north 5 s".into(),
            recording: "north".into(),
            session: "day".into(),
            manoeuvre: "straight".into(),
            split: Split::Train,
            dt: 1.0,
            recorded_dt: 1.0,
            inputs: (0..10).map(|k| Inputs::actuators(5.0 + f64::from(k), 1.0, 0.0)).collect(),
            initial: states[0],
            measured: measured(&states),
            disturbed: vec![(3, 4)],
            derived: [false; STATES],
        }
    }

    #[test]
    fn what_is_derived_was_not_recorded() {
        let mut run = north();
        assert_eq!((run.recorded(2, 3), run.recorded(99, 3)), (Some(2.0), None));
        run.derived[3] = true;
        assert_eq!((run.recorded(2, 3), run.recorded(2, 0)), (None, Some(4.0)));
    }

    #[test]
    fn missing_values_shorten_neither_track_nor_speed() {
        let whole = north();
        assert_eq!((whole.path_length(), whole.mean_speed(), whole.duration()), (18.0, 2.0, 9.0));
        let mut run = whole.clone();
        run.measured[4] = [None; STATES];
        assert_eq!((run.path_length(), run.mean_speed()), (18.0, 2.0));
        run.measured.iter_mut().for_each(|m| m[3] = None);
        assert_eq!((run.channels()[3], run.mean_speed()), (false, 2.0));
        run = whole;
        run.measured.iter_mut().for_each(|m| m[0] = None);
        assert_eq!((run.path_length(), run.mean_speed()), (18.0, 2.0));
        run.measured.iter_mut().for_each(|m| m[4] = None);
        assert_eq!((run.path_length(), run.mean_speed()), (18.0, 2.0));
    }

    #[test]
    fn an_event_is_felt_at_the_samples_next_to_it() {
        let run = north();
        let felt: Vec<usize> = (0..10).filter(|k| run.disturbed_at(*k)).collect();
        assert_eq!(felt, [2, 3, 4, 5]);
        assert_eq!((run.start_time(), run.time(2)), (5.0, 7.0));
    }

    #[test]
    fn what_is_not_a_number_was_not_measured() {
        let sample = measured(&[[1.0, f64::NAN, f64::INFINITY, 0.0, 0.0, 0.0]]).remove(0);
        assert_eq!(&sample[..3], [Some(1.0), None, None]);
        assert!(or_nan(&sample)[1].is_nan() && or_nan(&sample)[0] == 1.0);
    }
}
