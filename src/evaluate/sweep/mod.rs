//! What the data determine: profiles of the likelihood by parameter and by pair, and what each parameter moves.
//! It fits through `fit` and sails trials through `maneuver`; how these work is described there.
//!
//! # Definitions
//! The profile of a parameter is the least cost with the parameter fixed at a value and all others fitted again. With cost and priors
//! `C`, its least value `C*`, `N` runs, variance `s^2` of the weighted residuals and the design effect `d` of the fit (how many
//! residuals count as one), twice the fall of the log-likelihood is `(C - C*) N / (s^2 d)`; for a quadratic cost it is the square of
//! the distance from the estimate in standard errors. The 95 % interval of a profile contains the values at which it is below the square
//! of the 97.5 % quantile of Student's t with the fit's degrees of freedom. Source: Pawitan 2001, In All Likelihood, section 3.4.

mod profile;
mod sensitivity;

pub use profile::{Pair, Point, Profile, SweepSettings, pair, profile};
pub use sensitivity::{Sensitivity, sensitivities};
