//! Plain numbers, whatever they stand for: how they are written, the ranges they must be in, statistics and covariances of them.
//! No ship and no recording is here.

pub mod moderated;
pub mod numerals;
pub mod ranges;
pub mod statistics;
pub mod uncertainty;
