//! Doubts from comparing channels, and runs, with one another: units, signs, clocks, dead reckoning, one run against all others.
//! Single values are looked at elsewhere.

pub(super) mod across;
pub(super) mod lone;
pub(super) mod propeller;
pub(super) mod reckoning;
mod scales;
mod scatter;
pub(super) mod signs;
mod stuck;
pub(super) mod units;
