//! What every refit of one diagnosis shares: runs, integration, candidates, the noise's prior and the user's settings.
//! It holds them and decides nothing.

use super::candidate::Candidate;
use super::improved::inside_bounds;
use super::settings::{Effort, Settings};
#[cfg(feature = "ipopt")]
use crate::fit::within_limits;
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

    /// An estimate as a fit by likelihood ends, within bounds and constraints: what a file may hold. In the search a hull coefficient that is
    /// carried is kept by its prior alone, which knows no sign, so that it may have ended where it drives the ship. Where no fit is possible
    /// the values are put back within their bounds.
    #[cfg(feature = "ipopt")]
    pub fn within_limits(&self, found: &Estimate) -> Estimate {
        let constraints = self.settings.constraints;
        let fitted = within_limits(found, self.integration, self.runs, self.prior, constraints);
        fitted.unwrap_or_else(|_| inside_bounds(found))
    }

    /// An estimate with its values within their bounds: this build has no Ipopt to fit the others to that.
    #[cfg(not(feature = "ipopt"))]
    pub fn within_limits(&self, found: &Estimate) -> Estimate {
        inside_bounds(found)
    }
}
