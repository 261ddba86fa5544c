//! The text of a recording: the column map, names and units of its columns, missing values, lines.
//! What channels become is elsewhere.

pub(super) mod blank;
pub(super) mod lines;
pub(super) mod map;
mod meant;
mod read;
pub(super) mod unit;
