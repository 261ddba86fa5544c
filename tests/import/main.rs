//! Promises of the import and of the audit: logs come back as they were, damage is seen, and nothing in a file stops a reader.
//! The single rules are tested beside their code.

// A helper that cannot do its work ends the test with it.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod damaged;
mod fuzz;
mod loggers;
mod logs;
