//! Experiments.

pub mod truth;
