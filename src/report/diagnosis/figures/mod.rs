//! The figures of a diagnosis.
//! What the page says beside them is elsewhere.

mod change;
mod evidence;
mod force;
mod pattern;
pub(super) mod picture;
pub(super) mod pictures;
mod stages;
