//! What is computed of recordings before a mechanism is chosen: audit, unknown forces, events, places, consistency of sensors.
//! It chooses no mechanism and concludes nothing.
//!
//! | file | what |
//! |---|---|
//! | `set_aside` | runs that only prove |
//! | [`admit`] | the audit of recordings and integration step by the base model |
//! | [`candidate`] | a mechanism as columns and amplitudes of one model |
//! | [`generic`] | a free law of forces, as a rival of every name |
//! | `blocks`, [`push`] | constant forces in spans of time, and windows that share one |
//! | [`region`], [`place`], [`locate`] | where an unknown force acts |
//! | `forces` | the force that some parameters bring |
//! | `kinematic` | whether position, heading, velocity and yaw rate agree |
//! | `wald` | how far estimates are from zero |

pub mod admit;
mod blocks;
pub mod candidate;
pub(super) mod forces;
pub mod generic;
pub(super) mod kinematic;
pub mod locate;
pub mod place;
pub mod push;
pub mod region;
pub(super) mod set_aside;
pub(super) mod wald;
