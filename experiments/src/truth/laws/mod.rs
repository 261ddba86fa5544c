//! Laws that truth simulators share: screw, slipstream, cross-flow drag, and smooth transitions.
//! A simulator with all of its forces is beside this folder.

pub mod blend;
pub mod crossflow;
pub mod propeller;
pub mod slipstream;
