//! Settings of an evaluation, the section `[evaluate]` of a study.
//! How a trajectory is simulated and weighed is in the section `[fit]`.

use crate::ranges::{Limited, OutOfRange, counted};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Settings of an evaluation, the section `[evaluate]` of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EvaluationSettings {
    /// Model file of the baseline, relative to the study.
    pub baseline: Option<PathBuf>,
    /// Bootstrap resamples behind the intervals.
    pub resamples: usize,
    /// Seed of the bootstrap.
    pub seed: u64,
}

impl Limited for EvaluationSettings {
    fn limits(&self) -> Result<(), OutOfRange> {
        let meaning = "resamples of the bootstrap; 2000 give the ends of an interval to a tenth of its width";
        counted("resamples", self.resamples, &(0..=100_000), meaning)
    }
}

impl Default for EvaluationSettings {
    fn default() -> Self {
        Self { baseline: None, resamples: 2000, seed: 1 }
    }
}
