//! The standard manoeuvring trials (turning circle, zigzag, crash stop) with any model, and their measures read from a track.
//! It neither fits nor judges a model: a poor model gives poor numbers, and only the IMO criteria are compared with them.

mod approach;
pub mod imo;
mod sail;
mod stopping;
mod track;
mod turning;
mod zigzag;

pub use approach::{Approach, ManeuverSettings};
pub use stopping::{Stopping, stopping, stopping_trial};
pub use track::Track;
pub use turning::{Steady, Turning, turning, turning_execute, turning_trial};
pub use zigzag::{Zigzag, zigzag, zigzag_executes, zigzag_trial};

use serde::Serialize;

/// Why a trial could not be sailed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ManeuverError {
    /// A setting with an impossible value.
    #[error("`{key}` = {found} in [maneuver]: {expected}")]
    Setting {
        /// Key.
        key: &'static str,
        /// Value found.
        found: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// No propeller rate holds the approach speed.
    #[error(
        "no propeller rate up to {limit:.2} rps holds the approach speed of {speed:.3} m/s on a straight course; set a lower `speed`, or `speed` and `n` together to approach without balance"
    )]
    NoRate {
        /// Approach speed \[m/s\].
        speed: f64,
        /// Largest rate tried \[rps\].
        limit: f64,
    },
    /// No speed is held by the approach propeller rate.
    #[error(
        "the propeller rate {n:.3} rps holds no speed ahead on a straight course; give a rate ahead (positive), or `speed` and `n` together to approach without balance"
    )]
    NoSpeed {
        /// Propeller rate \[rps\].
        n: f64,
    },
}

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
    /// The trial was not complete after the time of 200 ship lengths at approach speed.
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
    /// IMO criteria that apply.
    pub criteria: Vec<imo::Criterion>,
    /// The simulated track.
    #[serde(skip)]
    pub track: Track,
}

#[cfg(test)]
mod tests;
