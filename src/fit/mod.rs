//! Fitting a model's parameters to recordings: from the cost and its constraints to estimates with their uncertainty.
//! It does not say which physics a model contains or how a ship is simulated; it takes both as given.
//!
//! | file | what |
//! |---|---|
//! | [`cost`] | the weighted trajectory cost and its derivatives |
//! | `sums` | sums over samples behind the cost, its gradient and the Gauss-Newton matrix |
//! | [`constraints`] | the constraints as data: curves bounded on grids |
//! | `settings` | section `[fit]` of a study |
//! | `objective` | what a fit minimises, as its solver sees it |
//! | `evaluations` | the last evaluations of an objective, each made once |
//! | `task` | what stays fixed during a fit: model, cost, constraints, scales, start |
//! | `scaling` | scales of the parameters, sizes of the rows |
//! | `curvature` | the matrix of second derivatives that Ipopt is given |
//! | `rows` | which of the constraint rows the solver gets |
//! | `limits` | what ends a fit before its optimum |
//! | `problem` | the task with the priors, scaled, as Ipopt wants it |
//! | `stages` | runs in shorter pieces, or a few of them, to be fitted first |
//! | `descent` | one solve through Ipopt, with its restarts |
//! | `solve` | from the start through the stages to an optimum that was checked |
//! | `innovations` | the likelihood with the gains of the filter fixed |
//! | `likelihood` | the fit by likelihood: noise, gains and parameters in turn |
//! | `subspace` | directions that constraints leave free |
//! | `covariance` | covariances, and what the data do not determine |
//! | `doubts` | what residuals say against a fit: model error, windows too long, residuals alike |
//! | `summary` | the outcome: estimates, intervals, active constraints; [`fit`] joins all |
//! | [`multistart`] | the same fit from many starts |

pub mod constraints;
pub mod cost;
#[cfg(feature = "ipopt")]
mod covariance;
#[cfg(feature = "ipopt")]
mod curvature;
#[cfg(feature = "ipopt")]
mod descent;
#[cfg(feature = "ipopt")]
mod doubts;
mod error;
#[cfg(feature = "ipopt")]
mod evaluations;
mod innovations;
#[cfg(feature = "ipopt")]
mod likelihood;
#[cfg(feature = "ipopt")]
mod limits;
#[cfg(feature = "ipopt")]
pub mod multistart;
#[cfg(feature = "ipopt")]
mod objective;
#[cfg(feature = "ipopt")]
mod problem;
#[cfg(feature = "ipopt")]
mod rows;
#[cfg(feature = "ipopt")]
mod scaling;
mod settings;
#[cfg(feature = "ipopt")]
mod solve;
#[cfg(feature = "ipopt")]
mod stages;
#[cfg(feature = "ipopt")]
mod subspace;
#[cfg(feature = "ipopt")]
mod summary;
mod sums;
#[cfg(feature = "ipopt")]
mod task;

#[cfg(feature = "ipopt")]
pub use crate::ipopt::Counts;
pub use constraints::{ConstraintSettings, Limits, Rule};
pub use cost::{Compared, Cost, CostOptions, Derivatives, Quadratic, Residuals};
#[cfg(feature = "ipopt")]
pub use covariance::{Covariance, CovarianceKind, SANDWICH_FROM};
#[cfg(feature = "ipopt")]
pub use doubts::{Doubt, DoubtKind, GROWTH_LIMIT, LIKENESS_LIMIT, MODEL_ERROR_LIMIT, ResidualStatistics};
pub use error::FitError;
pub use innovations::{Innovations, noise_at, with_uncertain_coefficients};
#[cfg(feature = "ipopt")]
pub use likelihood::Likelihood;
#[cfg(feature = "ipopt")]
pub(crate) use likelihood::within_limits;
#[cfg(feature = "ipopt")]
pub use multistart::{MultiStart, StartOutcome, StartRow, multi_start, multi_start_over};
#[cfg(feature = "ipopt")]
pub use problem::Progress;
pub use settings::{FitSettings, Goal, Hessian};
#[cfg(feature = "ipopt")]
pub(crate) use summary::labels;
#[cfg(feature = "ipopt")]
pub use summary::{Active, Combination, Estimate, Fit, fit, fit_over};
#[cfg(feature = "ipopt")]
pub use task::bounds;
