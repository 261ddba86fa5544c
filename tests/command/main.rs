//! Promises of the command line: output, files, figures, help, exit codes, and messages that say what to do next.
//! The commands of a diagnosis and of an import are tested with these.

// A helper that cannot do its work ends the test with it.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod commands;
mod export;
mod figures;
mod files;
mod help;
mod maneuver;
mod mistakes;
mod new;
mod python;
