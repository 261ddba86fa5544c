//! A slice of each campaign on every push: concealed, injected and mutated cases through the program.
//! The whole campaigns measure; these only stop a change that breaks something.

// A helper that cannot do its work ends the test with it.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod concealed;
mod injected;
mod mutated;
