//! The diagnosis: where recordings and simulation part, which physics was left out, and the proof on unseen runs.
//! One noise model (sensors, unknown force, initial states) stands behind every step.
//!
//! The steps are: admit the recordings ([`admit`]), estimate parameters and noise ([`estimate`]), locate unknown forces
//! ([`locate`]), test every mechanism of the catalogue by its sensitivities ([`screen`]), refit the leaders, and compare
//! models on held-out runs ([`prove`]). [`diagnose`] runs them in order and concludes.

pub mod admit;
mod algebra;
pub mod base;
pub mod baseline;
pub mod candidate;
mod compete;
pub mod covariance;
mod decide;
mod describe;
pub mod diagnosis;
mod eligible;
pub mod estimate;
mod event;
pub mod evidence;
#[cfg(test)]
mod example;
pub mod finding;
mod generic;
mod improved;
mod pipeline;
mod problem;
mod residual;
mod select;
pub mod settings;
mod summary;
mod wald;
mod words;

mod blocks;
pub mod filter;
mod forces;
pub mod locate;
pub mod noise;
pub mod noise_fit;
mod optimise;
pub mod place;
pub mod prove;
pub mod push;
pub mod receiver;
#[cfg(feature = "ipopt")]
pub mod refit;
pub mod region;
pub mod screen;
pub mod sides;
pub mod signal;

pub use decide::Verdict;
pub use diagnosis::Diagnosis;
pub use filter::Run;
pub use finding::Finding;
pub use pipeline::diagnose;
pub use settings::Settings;
pub use signal::Signal;

/// The types of the document under the name that the report and the figures import them by.
pub mod conclude {
    pub use super::decide::Verdict;
    pub use super::diagnosis::{Diagnosis, Ranked, Trace};
    pub use super::finding::{Amplitude, Finding, GENERIC, PUSH, PUSH_TITLE};
}
