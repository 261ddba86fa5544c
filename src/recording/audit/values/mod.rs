//! Doubts about single values: missing, repeated, frozen, jumping, out of reach of a receiver or of gear.
//! Whether channels agree with each other is checked elsewhere.

pub(super) mod fill;
pub(super) mod fixes;
pub(super) mod frozen;
pub(super) mod gaps;
pub(super) mod gear;
pub(super) mod held;
pub(super) mod jumps;
pub(super) mod length;
pub(super) mod orders;
pub(super) mod receiver;
