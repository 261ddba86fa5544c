//! The kinds of stretches that a recording is split into, and a stretch.
//! The rules that distinguish them are in `blocks`.

use serde::Serialize;
use std::ops::Range;

/// What is done in a stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Rudder amidships, speed steady.
    Straight,
    /// Rudder amidships, speed still changing: acceleration or the way to a manoeuvre.
    Approach,
    /// Rudder kept to one side while the heading changes by more than a right angle.
    Turn,
    /// Rudder put over to one side and the other in turns.
    Zigzag,
    /// Propeller stopped or astern while the ship moves ahead.
    Stop,
    /// Anything else.
    Free,
}

impl Kind {
    /// The word in a table of runs.
    pub fn word(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Approach => "approach",
            Self::Turn => "turn",
            Self::Zigzag => "zigzag",
            Self::Stop => "stop",
            Self::Free => "free",
        }
    }
}

/// Rows of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// What is done.
    pub kind: Kind,
    /// Rows.
    pub rows: Range<usize>,
    /// What was seen, in words.
    pub why: String,
}
