//! The diagnosis: where recordings and simulation part, which physics was left out, and the proof on unseen runs.
//! It draws and prints nothing: its one answer is the document in [`diagnosis`].
//!
//! The steps, each a function from one named type to the next ([`diagnose`] runs them in order):
//!
//! | step | what it gives |
//! |---|---|
//! | audit of the recordings | [`base::AuditedRuns`] |
//! | fit of the base model, its parameters and noise | [`base::BaseFit`] |
//! | location of unknown forces, score test of every mechanism | `event::BaseTests` |
//! | a push that is found before any mechanism | `event::Opening` |
//! | forward selection: comparison of refits, removal, replacement | `select::Selection` |
//! | tests of what the selected mechanisms leave | `residual::Residual` |
//! | table of tests | [`decide::TestTable`] |
//! | decision, a pure function of the table | [`decide::Decision`] |
//! | every finding by itself: interval, size, unseen runs | `weigh::Weight` |
//! | its grade, a pure function of these | [`grade::Grade`] |
//! | verdict and what is named, withdrawn findings taken out | `answer::Answer` |
//! | the same analysis on recordings told otherwise | [`stability::Stability`] |
//! | where the catalogue does not hold what is missing, a law for it | [`law::Law`] |
//! | the same analysis on simulated recordings | [`calibrate::ErrorRates`] |
//! | proof of all findings on held-out runs | [`prove::HeldOut`] |
//! | document | [`diagnosis::Diagnosis`] |
//!
//! One noise model (sensors, unknown force, initial states) is behind every step, and every number that can turn a verdict is in
//! [`settings`].

pub mod admit;
mod alike;
mod answer;
pub mod base;
pub mod baseline;
mod blocks;
pub mod calibrate;
pub mod candidate;
mod compete;
mod conclude;
pub mod decide;
mod describe;
pub mod diagnosis;
mod eligible;
mod error;
mod event;
#[cfg(test)]
pub(crate) mod example;
pub mod finding;
mod forces;
pub mod generic;
pub mod grade;
mod improved;
pub mod influence;
mod kinematic;
pub mod law;
pub mod locate;
mod monomial;
mod pipeline;
pub mod place;
pub mod present;
mod problem;
pub mod prove;
pub mod push;
pub mod region;
mod residual;
pub mod sailed;
pub mod screen;
mod select;
mod selected;
mod set_aside;
pub mod settings;
pub mod sides;
pub mod signal;
mod sparse;
pub mod stability;
pub(crate) mod summary;
mod together;
pub mod unseen;
mod wald;
mod weigh;
mod words;

pub use decide::Verdict;
pub use diagnosis::Diagnosis;
pub use error::DiagnoseError;
pub use finding::Finding;
pub use grade::Grade;
pub use pipeline::diagnose;
pub use settings::Settings;
pub use signal::Signal;
