//! Fitting a model's parameters to recordings: from the cost and its constraints to estimates with their uncertainty.
//! It does not say which physics a model contains or how a ship is simulated; it takes both as given.
//!
//! | file | what |
//! |---|---|
//! | [`cost`] | the weighted trajectory cost and its derivatives |
//! | [`constraints`] | the constraints as data: curves bounded on grids |
//! | `settings` | section `[fit]` of a study |
//! | `task` | what stays fixed during a fit: model, cost, constraints, scales, start |
//! | `problem` | the task with the priors, scaled, as Ipopt wants it |
//! | `stages` | runs in shorter pieces, to be fitted first |
//! | `solve` | from the start through Ipopt to the best point |
//! | `subspace` | directions that constraints leave free |
//! | `covariance` | covariances, and what the data do not determine |
//! | `doubts` | what residuals say against a fit: model error, windows too long, residuals alike |
//! | `summary` | the outcome: estimates, intervals, active constraints; [`fit`] joins all |
//! | [`multistart`] | the same fit from many starts |

pub mod constraints;
pub mod cost;
mod covariance;
mod doubts;
mod error;
pub mod multistart;
mod problem;
mod settings;
mod solve;
mod stages;
mod subspace;
mod summary;
mod task;

pub use crate::ipopt::Counts;
pub use constraints::{ConstraintSettings, Limits, Rule};
pub use cost::{Cost, CostOptions, Derivatives, Quadratic};
pub use covariance::{Covariance, CovarianceKind, SANDWICH_FROM};
pub use doubts::{Doubt, DoubtKind, GROWTH_LIMIT, LIKENESS_LIMIT, MODEL_ERROR_LIMIT, ResidualStatistics};
pub use error::FitError;
pub use multistart::{MultiStart, StartOutcome, multi_start};
pub use problem::Progress;
pub use settings::{FitSettings, Hessian};
pub use summary::{Active, Combination, Estimate, Fit, fit};
