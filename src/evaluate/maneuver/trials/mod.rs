//! The trials, each sailed with any model and measured on any track.
//! How a ship sails, and what is measured, is above.

pub(super) mod pullout;
pub(super) mod spiral;
pub(super) mod stopping;
pub(super) mod turning;
pub(super) mod zigzag;
