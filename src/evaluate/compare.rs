//! Runs under two models: what each predicts of a run, and how far both are from what was measured.
//! Which numbers sum up many runs is in `summary`.

use super::cvdm::{Outcome, outcome};
use super::steady::steady_motion;
use crate::model::Model;
use crate::recording::{Run, Split};
use crate::simulate::{Integration, Scenario, Trajectory, reported};
use crate::state::STATES;
use crate::statistics::mean;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A window under two models.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Name of the run.
    pub run: String,
    /// Session.
    pub session: String,
    /// Manoeuvre.
    pub manoeuvre: String,
    /// Train or test.
    pub split: Split,
    /// Time of the first sample in the recording \[s\].
    pub start_time: f64,
    /// Length \[s\].
    pub duration: f64,
    /// Under the baseline.
    pub baseline: Outcome,
    /// Of steady motion.
    pub steady: Outcome,
    /// Under the fitted model.
    pub fitted: Outcome,
}

impl Comparison {
    /// `(cVDM~ - cVDM*)/cVDM~` of this trajectory \[-\]; absent where a simulation diverged or the baseline is exact.
    pub fn improvement(&self) -> Option<f64> {
        let (before, after) = (self.baseline.deviation()?.cvdm, self.fitted.deviation()?.cvdm);
        (before > 0.0).then(|| 1.0 - after / before)
    }

    /// Mean over the measured dimensions of `(MD~ - MD*)/MD~` \[-\]; a dimension in which the baseline is exact is left out.
    pub fn average_relative_improvement(&self) -> Option<f64> {
        let (before, after) = (self.baseline.deviation()?, self.fitted.deviation()?);
        let relative = before.md.iter().zip(&after.md).filter_map(|(b, a)| match (b, a) {
            (Some(b), Some(a)) if *b > 0.0 => Some(1.0 - a / b),
            _ => None,
        });
        mean(relative)
    }
}

/// The scenario of a window: its inputs and initial state.
impl From<&Run> for Scenario {
    fn from(window: &Run) -> Self {
        Self { dt: window.dt, inputs: window.inputs.clone(), initial: window.initial }
    }
}

/// What a model predicts the sensors to report over a window that starts where they report its initial state, with the parameter
/// additions of the window's session.
pub fn predict(model: &Model, window: &Run, integration: Integration) -> Trajectory {
    predict_from(model, window, integration, window.initial)
}

/// As [`predict`], from another initial state that the sensors report.
pub(super) fn predict_from(
    model: &Model,
    window: &Run,
    integration: Integration,
    initial: [f64; STATES],
) -> Trajectory {
    let theta = model.values_in(&window.session);
    let scenario = Scenario { initial, ..Scenario::from(window) };
    reported(model, &theta, integration, &scenario, &window.channels())
}

/// Predictions of every window, in order.
pub fn predict_all(model: &Model, windows: &[Run], integration: Integration) -> Vec<Trajectory> {
    windows.par_iter().map(|w| predict(model, w, integration)).collect()
}

/// Compares two predictions of a window, the baseline's first.
pub fn compare(
    window: &Run,
    model: &Model,
    max_yaw_rate: f64,
    (baseline, fitted): (&Trajectory, &Trajectory),
) -> Comparison {
    let ship = &model.ship;
    Comparison {
        run: window.recording.clone(),
        session: window.session.clone(),
        manoeuvre: window.manoeuvre.clone(),
        split: window.split,
        start_time: window.start_time(),
        duration: window.duration(),
        baseline: outcome(window, baseline, ship, max_yaw_rate),
        steady: outcome(window, &steady_motion(window), ship, max_yaw_rate),
        fitted: outcome(window, fitted, ship, max_yaw_rate),
    }
}
