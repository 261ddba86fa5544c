//! The validation of a dossier: errors on unseen runs as `trimtab evaluate` has them, and the standard manoeuvres.
//! It selects and computes nothing of its own.

use super::trials::Trials;
use crate::evaluate::{Comparison, Evaluation, Summary};
use crate::recording::Split;
use serde::Serialize;

/// Errors on unseen runs, and standard manoeuvres.
#[derive(Clone, Debug, Serialize)]
pub struct Validation {
    /// Name of the baseline that the model is compared with.
    pub baseline: String,
    /// Name of the model.
    pub model: String,
    /// The test runs together; absent without any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub test: Option<Summary>,
    /// By manoeuvre and by session of the test runs where there are several, and of the training runs.
    pub groups: Vec<Summary>,
    /// The test runs one by one.
    pub runs: Vec<Comparison>,
    /// Reference yaw rate of cVDM \[rad/s\].
    pub max_yaw_rate: f64,
    /// Resamples of the bootstrap behind the intervals.
    pub resamples: usize,
    /// Its seed.
    pub seed: u64,
    /// The standard manoeuvres; absent where the model has no approach.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub manoeuvres: Option<Trials>,
}

impl Validation {
    pub(super) fn new(evaluation: Evaluation, manoeuvres: Option<Trials>) -> Self {
        let (test, groups) = evaluation.summaries.into_iter().partition::<Vec<_>, _>(|s| s.group == "test");
        Self {
            baseline: evaluation.baseline,
            model: evaluation.fitted,
            test: test.into_iter().next(),
            groups,
            runs: evaluation.trajectories.into_iter().filter(|t| t.split == Split::Test).collect(),
            max_yaw_rate: evaluation.max_yaw_rate,
            resamples: evaluation.resamples,
            seed: evaluation.seed,
            manoeuvres,
        }
    }
}
