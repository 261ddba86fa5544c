//! What else pushes: thrusters, and forces without a cause in the catalogue.

pub mod asymmetric;
pub mod push;
pub mod thruster;
