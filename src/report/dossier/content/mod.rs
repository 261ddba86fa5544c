//! The dossier of a model for its validation, in the order of ITTC Recommended Procedure 7.5-02-06-03: claim, ship, inputs, model,
//! verification, validation, error rates, causes of error, limits. It judges nothing that was not computed, and lays out no page.
//!
//! Every number is computed by the function behind the command of the same name: those of [`crate::evaluate`], [`crate::evaluate::maneuver`],
//! [`mod@crate::diagnose`] and [`crate::recording::audit`]. What was not computed is listed as missing, section by section.

mod assembly;
mod causes;
mod check;
mod claim;
mod conservation;
mod document;
mod particulars;
mod structure;
mod symmetry;
mod trials;
mod validation;
mod verification;

pub use assembly::{Question, dossier};
pub use causes::Causes;
pub use check::{Bound, Check};
pub use claim::{Claim, Span};
pub use document::{Dossier, Heading, SECTIONS};
pub use particulars::{ChannelUse, Particular, Recorded, RecordedDoubt, ShipPart};
pub use structure::{Parameter, Structure, TermPart};
pub use trials::Trials;
pub use validation::Validation;
pub use verification::Verification;
