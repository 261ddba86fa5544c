//! What every refit of one diagnosis shares: runs, integration, candidates, the noise's prior and the user's settings.
//! It holds them and decides nothing.

use crate::diagnose::evidence::candidate::Candidate;
use crate::diagnose::settings::{Effort, Settings};
use crate::likelihood::estimate::{Estimate, FreeParameter, estimate};
use crate::likelihood::noise::{Noise, NoisePrior};
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::Integration;

/// What every refit shares.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// How steps are integrated.
    pub integration: Integration,
    /// The runs.
    pub runs: &'a [Run],
    /// The mechanisms that may be named.
    pub candidates: &'a [Candidate],
    /// The prior of every noise estimate.
    pub prior: &'a NoisePrior,
    /// The user's settings.
    pub settings: &'a Settings,
}

impl Problem<'_> {
    /// Estimates free parameters and noise from where a model is.
    pub fn estimate(&self, model: &Model, free: &[FreeParameter], noise: &Noise, effort: Effort) -> Estimate {
        estimate(model, self.integration, self.runs, free, noise, self.prior, effort)
    }

    /// Estimates again from where an estimate is.
    pub fn again(&self, found: &Estimate, effort: Effort) -> Estimate {
        self.estimate(&found.model, &found.free, &found.noise, effort)
    }
}
