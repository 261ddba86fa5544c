//! Fitting a model's parameters to recordings: from the cost and its constraints to estimates with their uncertainty.
//! It does not say which physics a model contains or how a ship is simulated; it takes both as given.
//!
//! | file | what |
//! |---|---|
//! | `objectives` | what a fit minimises: the weighted trajectory cost, and the likelihood with fixed gains |
//! | `solver` | from a start to an optimum that was checked: the problem that Ipopt is given, its limits and its stages |
//! | `settings` | section `[fit]` of a study |
//! | `covariance` | covariances, and what the data do not determine |
//! | `backwards` | actuators that push against their orders |
//! | `doubts` | what residuals say against a fit: model error, windows too long, a recording apart |
//! | `inputs` | whether one recording's rudder angle or propeller rate has another gain or zero than the others' |
//! | `summary` | the outcome: estimates, intervals, active constraints; [`fit`] joins all |
//! | [`multistart`] | the same fit from many starts |

pub(crate) mod backwards;
#[cfg(feature = "ipopt")]
mod covariance;
#[cfg(feature = "ipopt")]
mod doubts;
mod error;
#[cfg(feature = "ipopt")]
mod inputs;
#[cfg(feature = "ipopt")]
pub mod multistart;
pub mod objectives;
mod settings;
pub mod solver;
#[cfg(feature = "ipopt")]
mod summary;

#[cfg(feature = "ipopt")]
pub use crate::ipopt::Counts;
#[cfg(feature = "ipopt")]
pub use covariance::{Covariance, CovarianceKind, SANDWICH_FROM};
#[cfg(feature = "ipopt")]
pub use doubts::{Doubt, DoubtKind, GROWTH_LIMIT, MODEL_ERROR_LIMIT, ResidualStatistics};
pub use error::FitError;
#[cfg(feature = "ipopt")]
pub use inputs::{INPUT_CHANCE, InputError, InputErrorKind, SeenInput};
#[cfg(feature = "ipopt")]
pub use multistart::{MultiStart, StartOutcome, StartRow, multi_start, multi_start_over};
pub use objectives::cost::{Compared, Cost, CostOptions, Derivatives, Quadratic, Residuals};
pub use objectives::innovations::{Innovations, noise_at, with_uncertain_coefficients};
pub use settings::{FitSettings, Goal, Hessian};
pub use solver::constraints::{ConstraintSettings, Limits, Rule};
#[cfg(feature = "ipopt")]
pub use solver::likelihood::Likelihood;
#[cfg(feature = "ipopt")]
pub(crate) use solver::likelihood::within_limits;
#[cfg(feature = "ipopt")]
pub use solver::problem::Progress;
#[cfg(feature = "ipopt")]
pub use solver::task::bounds;
#[cfg(feature = "ipopt")]
pub(crate) use summary::labels;
#[cfg(feature = "ipopt")]
pub use summary::{Active, Combination, Estimate, Fit, fit, fit_over};
