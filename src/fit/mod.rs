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
//! | `summary` | the outcome: estimates, intervals, active constraints; [`fit`] joins all |
//! | [`report`] | a fit in words and tables |
//! | [`multistart`] | the same fit from many starts |

pub mod constraints;
pub mod cost;
mod covariance;
mod error;
pub mod multistart;
mod problem;
pub mod report;
mod settings;
mod solve;
mod stages;
mod subspace;
mod summary;
mod task;

pub use crate::ipopt::Counts;
pub use constraints::{ConstraintSettings, Limits, Rule};
pub use cost::{Cost, CostOptions, Derivatives, FitRun, Quadratic};
pub use covariance::{Covariance, CovarianceKind, SANDWICH_FROM};
pub use error::FitError;
pub use multistart::{MultiStart, StartOutcome, multi_start};
pub use problem::Progress;
pub use settings::{FitSettings, Hessian};
pub use summary::{Active, Combination, Estimate, Fit, fit};
