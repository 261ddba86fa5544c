//! The truth: ship simulators, ships, data sets, trials and captive tests that replace the real ship in the experiments.
//! It is not part of the library: nothing here may enter the model, the fit or the diagnosis, and nothing here uses their code.
//!
//! Three simulators with different physics implement one trait, [`simulator::Truth`]: [`mmg`] after Yasukawa & Yoshimura (2015),
//! [`large_drift`], a reconstruction of a large-drift simulator with a flapped rudder, and [`hd`], the paper's equation written
//! again. Axes: x forward, y starboard, psi clockwise from north, r > 0 bow to starboard, delta > 0 turns the ship to starboard;
//! origin midship; SI units, radians, rps.

pub mod captive;
pub mod dataset;
pub mod hd;
pub mod helmsman;
pub mod integrate;
pub mod large_drift;
pub mod laws;
pub mod mmg;
pub mod motion;
pub mod programme;
pub mod reference;
pub mod ships;
pub mod simulator;
pub mod trial;

#[cfg(test)]
mod tests;
