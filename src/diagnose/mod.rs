//! The diagnosis: where recordings and simulation part, which physics was left out, and the proof on unseen runs.
//! One noise model (sensors, unknown force, initial states) stands behind every step.

pub mod evidence;
pub mod filter;
pub mod noise;
