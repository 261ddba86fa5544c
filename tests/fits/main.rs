//! Promises of fits: known answers are recovered, and a fit ends within its limits at the lowest cost.
//! How good a model is on real recordings is tested in the experiments.

// A helper that cannot do its work ends the test with it.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod craft;
mod fits_end;
mod inputs;
mod promises;
mod recovery;
