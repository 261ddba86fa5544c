//! The real hulls, one file an experiment.
//! What the experiments share is beside this folder.

pub mod craft;
pub mod esso_osaka;
pub mod esso_osaka_diagnosed;
pub mod kvlcc2;
pub mod kvlcc2_diagnosed;
pub mod kvlcc2_hsva;
pub mod published;
