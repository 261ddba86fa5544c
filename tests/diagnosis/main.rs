//! Promises of the diagnosis and of what is made of it: the verdict where the truth is known, its documents, plans and sweeps.
//! Cases that other simulators made are in the experiments.

// A helper that cannot do its work ends the test with it.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod actuators;
mod command;
mod dossier;
mod known_truth;
mod plan;
mod report_page;
mod sweep;
