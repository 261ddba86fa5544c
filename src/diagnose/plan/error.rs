//! Why there is no plan.
//! A mechanism that no trial shows is an answer and no error.

use crate::evaluate::maneuver::ManeuverError;
use crate::model::ModelError;
use crate::ranges::OutOfRange;

/// Why there is no plan.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A planned trial with a value that cannot be used.
    #[error("[[plan.trials]] number {number}: {error}")]
    Trial {
        /// Its number in the list, from 1.
        number: usize,
        /// What cannot be used.
        error: OutOfRange,
    },
    /// A setting with a value that cannot be used.
    #[error("{0}")]
    Setting(#[from] OutOfRange),
    /// The approach of a trial.
    #[error("{trial}: {error}")]
    Approach {
        /// The trial.
        trial: String,
        /// What is wrong with it.
        error: ManeuverError,
    },
    /// A trial that the model cannot sail.
    #[error(
        "{trial}: the simulation diverged {after:.1} s after its start; check the model's parameters, or give `--model`"
    )]
    Diverged {
        /// The trial.
        trial: String,
        /// When \[s\].
        after: f64,
    },
    /// A trial with too few samples or too many.
    #[error(
        "{trial}: {samples} samples of {step} s; set `step` in [plan.sensors] or `duration` so that there are 10 to 100000"
    )]
    Samples {
        /// The trial.
        trial: String,
        /// Samples that it would have.
        samples: usize,
        /// Sample period \[s\].
        step: f64,
    },
    /// A mechanism that is not in the catalogue of the model, or needs more than these trials.
    #[error("{0}")]
    Mechanism(String),
    /// A term of the catalogue cannot be added to the model.
    #[error(transparent)]
    Model(#[from] ModelError),
}
