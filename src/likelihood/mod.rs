//! The state-space likelihood of recordings: sensor noise, an unknown force, initial states, and parameters with their priors.
//! It gives log-likelihood, scores and information of a model; which mechanisms a model has, and what is concluded, is decided elsewhere.
//!
//! | file | what |
//! |---|---|
//! | [`settings`] | its numbers |
//! | [`pass`] | what a pass of the filter is asked for, and gives |
//! | `directions`, `step_map`, `covariance`, `side_by_side` | the filter's parts: sensitivities, steps, covariances, four runs at a time |
//! | [`filter`] | the extended Kalman filter with exact sensitivities |
//! | [`evidence`] | sums of scores and information, and score tests on them |
//! | [`parameters`] | what is free in an estimate |
//! | [`noise`] | the noise, its prior, and its estimate by maximum likelihood |
//! | `optimise` | the damped Newton steps of the searches for a structure |
//! | [`estimate`] | the best model of a given structure |

pub(crate) mod algebra;
pub mod covariance;
mod directions;
pub mod estimate;
pub mod evidence;
pub mod filter;
pub mod noise;
pub(crate) mod optimise;
pub mod parameters;
pub mod pass;
pub mod settings;
mod side_by_side;
mod step_map;
