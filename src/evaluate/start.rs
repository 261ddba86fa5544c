//! What the noise of the recorded start does to cVDM: a simulation starts where the sensors say, and they err.
//! What the model lacks, and noise that lasts longer than a row, are not in it.

use super::compare::predict_from;
use super::cvdm::outcome;
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::{Integration, Trajectory};
use crate::state::STATES;
use crate::statistics::median;
use trimtab_ad::smooth::wrap_angle;

/// Samples from which the noise of a channel is estimated; of longer windows every n-th is taken.
const SAMPLES: usize = 5000;

/// Standard deviation of the noise of each channel (m, m, rad, m/s, m/s, rad/s): that of the second differences of measured less
/// simulated, by their median size, `1.48 |d_(k-1) - 2 d_k + d_(k+1)| / sqrt(6)`; 0 where the start was not measured.
fn noise(window: &Run, predicted: &Trajectory) -> [f64; STATES] {
    let difference = |k: usize, i: usize| {
        let d = window.measured.get(k)?[i]? - predicted.states.get(k)?[i];
        Some(if i == 2 { wrap_angle(d) } else { d })
    };
    let samples = window.measured.len().saturating_sub(1);
    let of = |i: usize| {
        window.measured.first()?[i]?;
        let every = (1..samples).step_by(samples.div_ceil(SAMPLES).max(1));
        let bends = every.filter_map(|k| {
            let (before, after) = (difference(k - 1, i)?, difference(k + 1, i)?);
            Some((before - 2.0 * difference(k, i)? + after).abs())
        });
        median(bends)
    };
    std::array::from_fn(|i| of(i).map_or(0.0, |bend| 1.4826 * bend / 6.0_f64.sqrt()))
}

/// Standard error of the cVDM of a prediction \[%\] by the noise of the recorded start: for each channel the root mean square of what
/// its noise to either side changes, and of these the root of the sum of squares. `None` where a simulation diverges.
pub fn start_error(
    model: &Model,
    window: &Run,
    integration: Integration,
    predicted: &Trajectory,
    max_yaw_rate: f64,
) -> Option<f64> {
    let cvdm = |trajectory: &Trajectory| {
        outcome(window, trajectory, &model.ship, max_yaw_rate).deviation().map(|deviation| deviation.cvdm)
    };
    let as_recorded = cvdm(predicted)?;
    let mut square = 0.0;
    for (channel, noise) in noise(window, predicted).into_iter().enumerate().filter(|(_, noise)| *noise > 0.0) {
        for side in [noise, -noise] {
            let mut initial = window.initial;
            initial[channel] += side;
            let moved = cvdm(&predict_from(model, window, integration, initial))? - as_recorded;
            square += 0.5 * moved * moved;
        }
    }
    Some(square.sqrt())
}
