//! What was measured, over time: columns as they were read, signals, tracks, positions in metres, and what is no sample in them.
//! Which column is what is decided in `columns`.

pub(super) mod attitude;
pub(super) mod fills;
pub(super) mod geodesy;
pub(super) mod held;
pub(super) mod log;
pub(super) mod motion;
pub(super) mod place;
pub(super) mod signal;
pub(super) mod wind;
