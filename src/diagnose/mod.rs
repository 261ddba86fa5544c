//! The diagnosis: where recordings and simulation part, which physics was left out, and the proof on unseen runs.
//! It draws and prints nothing: its one answer is the document in [`answer::diagnosis`].
//!
//! | room | what | uses |
//! |---|---|---|
//! | [`settings`] | every number that can turn a verdict | |
//! | [`evidence`] | what is computed of recordings before a mechanism is chosen | `settings` |
//! | [`search`] | which mechanisms are selected, and the decision on all tests | `evidence` |
//! | [`proof`] | every finding by itself, on unseen runs | `search` |
//! | [`law`] | a law for what is not in the catalogue; port against starboard | `proof` |
//! | [`answer`] | verdict, error rates, document | `law` |
//! | `pipeline` | the steps in order | all |
//! | [`plan`] | what planned trials and sensors would show | `answer` |
//!
//! The steps, each a function from one named type to the next ([`diagnose`] runs them in order):
//!
//! | step | what it gives |
//! |---|---|
//! | audit of the recordings | [`search::base::AuditedRuns`] |
//! | fit of the base model, its parameters and noise | [`search::base::BaseFit`] |
//! | location of unknown forces, score test of every mechanism | `search::event::BaseTests` |
//! | a push that is found before any mechanism | `search::event::Opening` |
//! | forward selection: comparison of refits, removal, replacement | `search::select::Selection` |
//! | tests of what the selected mechanisms leave | `search::residual::Residual` |
//! | table of tests | [`search::decide::TestTable`] |
//! | decision, a pure function of the table | [`search::decide::Decision`] |
//! | every finding by itself: interval, size, unseen runs | `proof::weigh::Weight` |
//! | its grade, a pure function of these | [`proof::grade::Grade`] |
//! | verdict and what is named, withdrawn findings taken out | `answer::analysis::Answer` |
//! | the same analysis on transformed recordings | [`proof::stability::Stability`] |
//! | where what is missing is not in the catalogue, a law for it | [`law::Law`] |
//! | the same analysis on simulated recordings | [`answer::calibrate::ErrorRates`] |
//! | proof of all findings on held-out runs | [`proof::prove::HeldOut`] |
//! | document | [`answer::diagnosis::Diagnosis`] |
//!
//! One noise model (sensors, unknown force, initial states) is behind every step. A room uses what its line names and all above that.

pub mod answer;
mod error;
pub mod evidence;
#[cfg(test)]
pub(crate) mod example;
pub mod law;
mod pipeline;
pub mod plan;
pub mod proof;
pub mod search;
pub mod settings;

pub use answer::diagnosis::Diagnosis;
pub use error::DiagnoseError;
pub use pipeline::diagnose;
pub use proof::finding::Finding;
pub use proof::grade::Grade;
pub use search::decide::Verdict;
pub use settings::Settings;
