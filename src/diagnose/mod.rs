//! The diagnosis: where recordings and simulation part, which physics was left out, and the proof on unseen runs.
//! One noise model (sensors, unknown force, initial states) stands behind every step.
//!
//! The steps are: admit the recordings ([`admit`]), estimate parameters and noise ([`estimate`]), locate unknown forces
//! ([`locate`]), test every mechanism of the catalogue by its sensitivities ([`screen`]), refit the leaders, and compare
//! models on held-out runs ([`prove`]). [`diagnose`] runs them in order and concludes.

pub mod admit;
pub mod baseline;
pub mod candidate;
mod compete;
pub mod conclude;
pub mod covariance;
pub mod estimate;
pub mod evidence;
pub mod figures;

pub mod filter;
mod forces;
pub mod locate;
pub mod noise;
pub mod prove;
pub mod refit;
pub mod report;
pub mod screen;
pub mod sides;
pub mod signal;

pub use conclude::{Diagnosis, Finding, Settings, Verdict, diagnose};
pub use signal::Signal;
