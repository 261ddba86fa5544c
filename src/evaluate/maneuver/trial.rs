//! One trial with its side, its end and its measures of any kind.
//! It simulates and measures nothing.

use super::approach::Approach;
use super::imo::Criterion;
use super::track::Track;
use serde::Serialize;
use std::collections::BTreeMap;

/// Which way a trial begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// First rudder to starboard.
    Starboard,
    /// First rudder to port.
    Port,
}

impl Side {
    /// Both, in the order in which trials are listed.
    pub const BOTH: [Self; 2] = [Self::Starboard, Self::Port];

    /// 1 to starboard, -1 to port.
    pub fn sign(self) -> f64 {
        match self {
            Self::Starboard => 1.0,
            Self::Port => -1.0,
        }
    }

    /// The side of a rudder angle or a change of heading \[rad\]; zero counts as starboard.
    pub fn of(angle: f64) -> Self {
        if angle < 0.0 { Self::Port } else { Self::Starboard }
    }

    /// `starboard` or `port`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Starboard => "starboard",
            Self::Port => "port",
        }
    }
}

/// How a trial ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "how")]
pub enum Ended {
    /// Every measure was reached.
    Complete,
    /// The trial was not complete after the longest time that it is sailed: 200 ship lengths at approach speed, more for pull-out and spiral.
    TimeOut {
        /// Time sailed \[s\].
        after: f64,
    },
    /// The simulation diverged.
    Diverged {
        /// Time of the first state that was not finite or absurdly fast \[s\].
        after: f64,
    },
}

/// 95 % intervals of measures, by name.
pub type Intervals = BTreeMap<&'static str, [f64; 2]>;

/// One trial: approach, track, and measures.
#[derive(Clone, Debug, Serialize)]
pub struct Trial<M> {
    /// In words: `turning 35 deg starboard`.
    pub name: String,
    /// First rudder.
    pub side: Side,
    /// How it was approached.
    pub approach: Approach,
    /// How it ended.
    pub ended: Ended,
    /// The measures; one that was not reached is absent.
    pub measures: M,
    /// 95 % intervals of the measures, in their units, where the model's covariance is known; see [`super::Measured`].
    #[serde(skip_serializing_if = "Intervals::is_empty")]
    pub intervals: Intervals,
    /// IMO criteria that apply.
    pub criteria: Vec<Criterion>,
    /// The simulated track.
    #[serde(skip)]
    pub track: Track,
}
