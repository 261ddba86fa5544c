//! What the commands share: arguments, loading, output, progress, errors, exit codes.
//! No command is here.

pub(super) mod answer;
pub(super) mod arguments;
pub mod audited;
pub mod error;
pub(super) mod figures;
pub(super) mod lines;
pub mod load;
pub(super) mod output;
pub mod processor;
pub(super) mod progress;
pub(super) mod style;
pub(super) mod terminal;
mod unreached;
pub(super) mod wanted;
