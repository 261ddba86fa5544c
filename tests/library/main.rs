//! Promises of the library: laws of every term and of the motion, files that are read, recordings, trials and the filter.
//! No command is run and nothing is fitted with the solver.

// A helper that cannot do its work ends the test with it.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod actuators;
mod bad_input;
mod baseline;
mod catalogue;
mod filter;
mod laws;
mod mmg;
mod model_file;
mod recordings;
mod reference;
mod trials;
