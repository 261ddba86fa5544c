//! What a reader makes of a file: columns of numbers, each with its own times, and what their names mean.
//! Units are not applied here: they are decided from all files together.

use crate::recording::{Channel, Quantity};
use std::path::PathBuf;

/// The sentence about a column of text, with one of its fields and where it is (`line 7`, `row 3`).
pub fn of_text(column: &str, field: &str, place: &str) -> String {
    format!("column `{column}` contains what is no number, such as `{field}` in {place}")
}

/// What times of a file count from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// Seconds since 1970 in UTC.
    Utc,
    /// Seconds since some midnight, the date not known.
    Day,
    /// Seconds since some start of the file's own.
    Own,
}

/// A file as it was read.
#[derive(Clone, Debug)]
pub struct Log {
    /// The file.
    pub path: PathBuf,
    /// What it is, in words.
    pub format: String,
    /// What its times count from.
    pub clock: Clock,
    /// Its columns, none of them a time.
    pub columns: Vec<Column>,
    /// Its columns of text, which are not used: the name of each, and a sentence that shows one of its fields.
    pub texts: Vec<(String, String)>,
    /// Notes on the file: lines left out, times repaired.
    pub notes: Vec<String>,
}

/// A column of a file.
#[derive(Clone, Debug, Default)]
pub struct Column {
    /// Name as in the file, without its unit.
    pub name: String,
    /// Unit that the file gives, as written.
    pub unit: Option<String>,
    /// What the format says it is, where the format says; otherwise its name decides.
    pub meaning: Option<Meaning>,
    /// Times of the samples \[s\].
    pub t: Vec<f64>,
    /// Values, as written; finite.
    pub v: Vec<f64>,
}

impl Column {
    /// Adds a sample; what is not finite is a missing one.
    pub fn push(&mut self, t: f64, v: f64) {
        if t.is_finite() && v.is_finite() {
            self.t.push(t);
            self.v.push(v);
        }
    }
}

/// What a column is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Meaning {
    /// Latitude, positive north.
    Latitude,
    /// Longitude, positive east.
    Longitude,
    /// Course over ground, clockwise from north.
    Course,
    /// Speed over ground.
    GroundSpeed,
    /// Velocity over ground to the north.
    VelocityNorth,
    /// Velocity over ground to the east.
    VelocityEast,
    /// Direction from which the wind blows over ground, clockwise from the bow.
    WindAngle,
    /// Magnetic variation, positive to the east: what is added to a magnetic direction.
    Variation,
    /// A channel of a recording.
    Channel(Channel),
}

/// The meanings that are no channel, by the name they have in `--column` and `--unit`.
pub const BESIDE_CHANNELS: [(&str, Meaning, Quantity, &str); 8] = [
    ("lat", Meaning::Latitude, Quantity::Angle, "latitude"),
    ("lon", Meaning::Longitude, Quantity::Angle, "longitude"),
    ("cog", Meaning::Course, Quantity::Angle, "course over ground"),
    ("sog", Meaning::GroundSpeed, Quantity::Speed, "speed over ground"),
    ("v_north", Meaning::VelocityNorth, Quantity::Speed, "velocity to the north"),
    ("v_east", Meaning::VelocityEast, Quantity::Speed, "velocity to the east"),
    ("wind_angle", Meaning::WindAngle, Quantity::Angle, "true wind angle from the bow"),
    ("variation", Meaning::Variation, Quantity::Angle, "magnetic variation"),
];

impl Meaning {
    fn beside(self) -> Option<(&'static str, Quantity, &'static str)> {
        BESIDE_CHANNELS.iter().find(|(_, meaning, ..)| *meaning == self).map(|(name, _, q, words)| (*name, *q, *words))
    }

    /// Its name in `--column` and `--unit`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Channel(channel) => channel.name(),
            other => other.beside().map_or("", |(name, ..)| name),
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Channel(channel) => channel.info().words,
            other => other.beside().map_or("", |(.., words)| words),
        }
    }

    /// What it is measured in.
    pub fn quantity(self) -> Quantity {
        match self {
            Self::Channel(channel) => channel.info().quantity,
            other => other.beside().map_or(Quantity::Number, |(_, quantity, _)| quantity),
        }
    }

    /// The meaning of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        let beside = BESIDE_CHANNELS.iter().find(|(n, ..)| *n == name).map(|(_, meaning, ..)| *meaning);
        beside.or_else(|| Channel::from_name(name).filter(|c| *c != Channel::T).map(Self::Channel))
    }

    /// Whether its values wrap round.
    pub fn wraps(self) -> bool {
        self == Self::Longitude
            || (self.quantity() == Quantity::Angle && !matches!(self, Self::Latitude) && !self.is_rudder())
    }

    /// Whether it is a propeller rate that was measured.
    pub fn is_rotation(self) -> bool {
        self == Self::Channel(Channel::N)
    }

    fn is_rudder(self) -> bool {
        matches!(self, Self::Channel(Channel::Delta | Channel::DeltaOrder))
    }
}

/// Channels without which nothing can be simulated, or which measure the motion: their unit must be known. The yaw rate follows from the heading.
pub fn needed(meaning: Meaning) -> bool {
    use Channel::{Delta, N, Psi, U, V, X, Y};
    match meaning {
        Meaning::Channel(channel) => {
            [X, Y, Psi, U, V, N, Delta].contains(&channel) || matches!(channel, Channel::Command(_))
        }
        Meaning::WindAngle | Meaning::Variation => false,
        _ => true,
    }
}
