//! The commands that make and check a study: ship, recordings, runs.
//! Those that use one are beside this folder.

pub(super) mod check;
pub mod import;
pub(super) mod new;
pub(super) mod split;
